//! How fast a distance may turn while a motion stays on one combination of pieces.
//!
//! With `A = V B V^-1`, `B` diagonal but for blocks `(a b; -b a)` of pairs of eigenvalues `l`, and `y = V^-1 z`, a row `w` of the state has
//!
//! ```text
//! |(w z)''| <= sum_m |w V_m| |l_m|^2 ( |y_m(0)| + r t max |y| ) e^(g t),    g = max(0, Re l)                   (1)
//! ```
//!
//! where a pair counts once, by the lengths of its two entries, and `r` is the norm of `V^-1 (A V - V B)`, what rounding has left. Entries of a
//! structure cancel where it moves slowly, so that bounds by their sizes are as large as its fastest oscillation would make them; those of modes
//! are not. What is computed here decides how far a step may reach, and no digit of a motion.

use nalgebra::{DMatrix, Schur};

use crate::numeric::spectrum::ITERATIONS;
use crate::numeric::triangular::eigenvectors;

/// Beyond this norm of `r t`, (1) is taken for unknown: where eigenvectors are nearly the same.
const MOST_DRIFT: f64 = 1e-3;

/// Eigenvalues that are real, or pairs of them.
#[derive(Debug, Clone, Copy)]
struct Mode {
    /// Its first row of `V^-1`, and whether it has two.
    row: usize,
    pair: bool,
    /// `|l|`
    size: f64,
}

/// The modes of one combination of pieces at present values.
#[derive(Debug)]
pub(super) struct Modes {
    order: usize,
    all: Vec<Mode>,
    /// `V^-1`, row by row.
    inverse: Vec<f64>,
    /// `|w V_m| |l_m|^2`, by row `w` and mode.
    weights: Vec<f64>,
    growth: f64,
    /// `r t` at most.
    drift: f64,
    /// `|y_m|` of a motion.
    amplitudes: Vec<f64>,
}

/// Eigenvectors as real columns `V`, and `V B`.
struct Decomposed {
    modes: Vec<Mode>,
    v: DMatrix<f64>,
    image: DMatrix<f64>,
    growth: f64,
}

impl Decomposed {
    fn of(a: &DMatrix<f64>) -> Option<Self> {
        let order = a.nrows();
        let (q, t) = Schur::try_new(a.clone(), f64::EPSILON, ITERATIONS)?.unpack();
        let mut found = Self {
            modes: Vec::new(),
            v: DMatrix::zeros(order, order),
            image: DMatrix::zeros(order, order),
            growth: 0.0,
        };
        let mut row = 0;
        for (value, vector) in eigenvectors(&q, &t) {
            if value.im < 0.0 {
                continue;
            }
            let pair = value.im > 0.0;
            if row + usize::from(pair) >= order {
                return None;
            }
            for (i, x) in vector.iter().enumerate() {
                let image = value * x;
                (found.v[(i, row)], found.image[(i, row)]) = (x.re, image.re);
                if pair {
                    (found.v[(i, row + 1)], found.image[(i, row + 1)]) = (x.im, image.im);
                }
            }
            found.growth = found.growth.max(value.re);
            let size = value.norm();
            found.modes.push(Mode { row, pair, size });
            row += 1 + usize::from(pair);
        }
        (row == order && found.growth.is_finite()).then_some(found)
    }
}

impl Modes {
    /// Of `A`, row by row, for these rows `w`, over times up to `longest`. Units make `A` alike in size: `D^-1 A D`. `None` if they are not known well
    /// enough.
    pub(super) fn new<'w>(
        matrix: &[f64],
        units: &[f64],
        rows: impl Iterator<Item = &'w [f64]>,
        longest: f64,
    ) -> Option<Self> {
        let order = units.len();
        let a = DMatrix::from_fn(order, order, |i, j| {
            matrix[i * order + j] * units[j] / units[i]
        });
        if a.iter().any(|x| !x.is_finite()) {
            return None;
        }
        let Decomposed {
            modes,
            v,
            image,
            growth,
        } = Decomposed::of(&a)?;
        let mut inverse = v.clone().try_inverse()?;
        let rest = &inverse * (&a * &v - image);
        let norm = |row: usize| rest.row(row).iter().map(|x| x.abs()).sum::<f64>();
        let norms = (0..order).map(norm);
        // What is no number counts as large.
        let drift = longest * norms.fold(0.0, |most: f64, x| if x <= most { most } else { x });
        if !(drift..).contains(&MOST_DRIFT) {
            return None;
        }
        let mut weights = Vec::new();
        for w in rows {
            let of = |column: usize| (0..order).map(|i| w[i] * units[i] * v[(i, column)]).sum();
            weights.extend(modes.iter().map(|mode| {
                let first: f64 = of(mode.row);
                let second = if mode.pair { of(mode.row + 1) } else { 0.0 };
                first.hypot(second) * mode.size * mode.size
            }));
        }
        for (mut column, unit) in inverse.column_iter_mut().zip(units) {
            column /= *unit;
        }
        Some(Self {
            order,
            amplitudes: vec![0.0; modes.len()],
            all: modes,
            inverse: inverse.transpose().as_slice().to_vec(),
            weights,
            growth,
            drift,
        })
    }

    /// Takes the amplitudes of a motion that begins at `z`.
    pub(super) fn set(&mut self, z: &[f64]) {
        let rows = self.inverse.chunks_exact(self.order);
        let mut rows = rows.map(|row| row.iter().zip(z).map(|(a, b)| a * b).sum::<f64>());
        for (amplitude, mode) in self.amplitudes.iter_mut().zip(&self.all) {
            let first = rows.next().unwrap_or(0.0);
            *amplitude = match mode.pair.then(|| rows.next()).flatten() {
                Some(second) => first.hypot(second),
                None => first.abs(),
            };
        }
        let largest = self.amplitudes.iter().copied().fold(0.0, f64::max);
        for amplitude in &mut self.amplitudes {
            *amplitude += self.drift * largest;
        }
    }

    /// The bound (1) of a row, but for its exponential.
    pub(super) fn curvature(&self, row: usize) -> f64 {
        let count = self.all.len();
        let weights = &self.weights[row * count..][..count];
        let products = weights.iter().zip(&self.amplitudes);
        products.map(|(weight, amplitude)| weight * amplitude).sum()
    }

    /// The exponential in (1).
    pub(super) fn growth(&self, time: f64) -> f64 {
        (self.growth * time).exp()
    }

    /// Part of the rates that belongs to modes which turn by more than one within a time: of all of the motion, or of one of the rows, whichever
    /// is larger. Where all of a structure moves slowly a gap may tremble.
    pub(super) fn beyond(&self, time: f64) -> f64 {
        let all = self.part_beyond(time, |mode, amplitude| mode.size * amplitude);
        let rows = self.weights.chunks_exact(self.all.len());
        let rows = rows.map(|weights| {
            let mut weights = weights.iter();
            self.part_beyond(time, |mode, amplitude| {
                let weight = weights.next().copied().unwrap_or(0.0);
                if mode.size > 0.0 {
                    weight / mode.size * amplitude
                } else {
                    0.0
                }
            })
        });
        rows.fold(all, f64::max)
    }

    /// The part of a sum over modes that those have which turn by more than one within a time.
    fn part_beyond(&self, time: f64, mut rate: impl FnMut(&Mode, f64) -> f64) -> f64 {
        let (mut fast, mut all) = (0.0, 0.0);
        for (mode, &amplitude) in self.all.iter().zip(&self.amplitudes) {
            let rate = rate(mode, amplitude);
            all += rate;
            if mode.size * time > 1.0 {
                fast += rate;
            }
        }
        if all > 0.0 { fast / all } else { 0.0 }
    }
}
