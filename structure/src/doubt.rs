//! What a reduction does not know of damping.
//!
//! Vectors besides modes stand for modes that are left out, whose ratios of damping may differ: all of that part of the compliance that the
//! damping of these vectors makes is in doubt, times the part by which the ratios differ.
//!
//! A damping matrix `C` that is given by its entries, and gyroscopic matrices, couple the vectors `V` with what is left out, whose compliance
//! is `R`. To first order that changes the compliance between directions `d` and `b` at a frequency `s` by
//!
//! ```text
//! s^2 (Z^-T d)^T [(C^T V)^T R (C V)] (Z^-1 b),    Z = diag(w^2) - s^2 + i s V^T C V                            (1)
//! ```
//!
//! Source: Guyan (1965), AIAA J. 3, 380, and its extension to dynamic coupling, as in Craig and Kurdila (2006), Fundamentals of Structural
//! Dynamics, section 17.

use hertzian::Complex;
use hertzian::structure::DMatrix;

use crate::description::damping::Damping;
use crate::description::structure::SparseStructure;
use crate::reduced::Reduced;

/// Harmonics up to this one know that vectors are coupled by their damping.
pub(crate) const COUPLED: usize = 16;

/// What is left out answers a fast motion by so many times as much as a slow one: that is twice at 0.7 of its lowest frequency.
const DYNAMIC: f64 = 2.0;

/// A mode that is left out may be so near to the last one that is kept, as a part of its frequency.
const NEAR: f64 = 1e-2;

/// What is not known of the compliances of a reduced structure at the harmonics of an orbit.
#[derive(Debug, Default)]
pub(crate) struct Doubt {
    /// By which part ratios of damping differ among modes that are left out.
    spread: f64,
    /// What stands in square brackets in (1), where there is something.
    inner: Option<DMatrix<f64>>,
    /// The lowest frequency that what is left out may have.
    next: f64,
    /// (1) of each harmonic from the first one on, of what is read along all directions by what is driven.
    coupled: Vec<DMatrix<f64>>,
}

impl Doubt {
    /// At an orbit of this base frequency, where matrices that turn have these speeds.
    pub(crate) fn of_orbit(
        reduced: &Reduced,
        structure: &SparseStructure,
        speeds: &[f64],
        base: f64,
    ) -> Self {
        let spread = match &structure.damping {
            Damping::Modal(ratios) => {
                let beyond = reduced.squares.get(reduced.modes).copied().unwrap_or(0.0);
                ratios.spread(reduced.modes, beyond.max(0.0).sqrt())
            }
            _ => 0.0,
        };
        let given = matches!(structure.damping, Damping::Matrix(_));
        let inner = inner(reduced, given, speeds);
        let coupled = inner
            .as_ref()
            .map(|inner| coupled(reduced, inner, speeds, base));
        Self {
            spread,
            next: next(reduced),
            coupled: coupled.unwrap_or_default(),
            inner,
        }
    }

    /// Whether all is known.
    pub(crate) fn is_none(&self) -> bool {
        self.spread == 0.0 && self.inner.is_none()
    }

    /// How much a Floquet mode changes its exponent at most, by ratios that differ and by what vectors are coupled with, for its motion at a
    /// frequency: the harmonics of positions of all vectors, and of the adjoint motion.
    pub(crate) fn of_exponent(
        &self,
        reduced: &Reduced,
        frequency: f64,
        positions: &[Complex<f64>],
        adjoint: &[Complex<f64>],
    ) -> [f64; 2] {
        let m = reduced.vectors();
        let of_vector = |i: usize| {
            let rate = frequency.abs() * positions[i].norm();
            self.spread * reduced.damping[i * m + i].abs() * rate * adjoint[i].norm()
        };
        let by_ratios: f64 = (reduced.modes..m).map(of_vector).sum();
        let by_coupling = self.inner.as_ref().map_or(0.0, |inner| {
            let pairs = (0..m).flat_map(|i| (0..m).map(move |j| (i, j)));
            let terms = pairs.map(|(i, j)| adjoint[i] * positions[j] * inner[(i, j)]);
            // Near the lowest frequency of what is left out it answers by more.
            let beyond = self.next * self.next;
            let answers = (1.0 / (1.0 - frequency * frequency / beyond)).abs();
            let answers = if answers.is_nan() {
                DYNAMIC
            } else {
                answers.max(DYNAMIC)
            };
            answers * frequency * frequency * terms.sum::<Complex<f64>>().norm()
        });
        [by_ratios, by_coupling]
    }

    /// Of the compliance between a direction that is read and one that is driven.
    pub(crate) fn of(
        &self,
        reduced: &Reduced,
        places: [usize; 2],
        harmonic: usize,
        base: f64,
    ) -> f64 {
        let [read, driven] = places;
        let place = harmonic.checked_sub(1);
        let coupled = place.and_then(|place| self.coupled.get(place));
        let coupled = coupled.map_or(0.0, |coupled| coupled[(read, driven)]);
        if self.spread == 0.0 {
            return coupled;
        }
        let frequency = harmonic as f64 * base;
        let m = reduced.vectors();
        let of = |i: usize| {
            let stiffness = reduced.squares[i] - frequency * frequency;
            let damped = Complex::new(stiffness, frequency * reduced.damping[i * m + i]);
            let push = reduced.rows[read][i] * reduced.rows[driven][i];
            push / damped - push / Complex::new(stiffness, 0.0)
        };
        let sum: Complex<f64> = (reduced.modes..m).map(of).sum();
        let by_ratios = self.spread * sum.norm();
        // In resonance without damping nothing is known.
        coupled
            + if by_ratios.is_finite() {
                by_ratios
            } else {
                0.0
            }
    }
}

/// A frequency little above that of the last mode, or that of the first vector besides modes where it is lower.
fn next(reduced: &Reduced) -> f64 {
    let frequencies = reduced.frequencies();
    let next = frequencies[reduced.modes - 1] * (1.0 + NEAR);
    let first = frequencies.get(reduced.modes);
    first.map_or(next, |first| first.min(next))
}

/// The damping matrix of the vectors with gyroscopic ones at their speeds.
pub(crate) fn damping(reduced: &Reduced, speeds: &[f64]) -> DMatrix<f64> {
    let m = reduced.vectors();
    let mut damping = DMatrix::from_row_slice(m, m, &reduced.damping);
    for (matrix, speed) in reduced.gyroscopic.iter().zip(speeds) {
        damping += *speed * DMatrix::from_row_slice(m, m, matrix);
    }
    damping
}

/// `Z` of (1).
pub(crate) fn dynamic(
    reduced: &Reduced,
    damping: &DMatrix<f64>,
    frequency: f64,
) -> DMatrix<Complex<f64>> {
    let m = reduced.vectors();
    DMatrix::from_fn(m, m, |i, j| {
        let damped = Complex::new(0.0, frequency * damping[(i, j)]);
        if i == j {
            damped + (reduced.squares[i] - frequency * frequency)
        } else {
            damped
        }
    })
}

/// What the vectors are coupled by.
fn inner(reduced: &Reduced, given: bool, speeds: &[f64]) -> Option<DMatrix<f64>> {
    if reduced.coupling.is_empty() {
        return None;
    }
    let m = reduced.vectors();
    // Of the transposed matrices gyroscopic ones have the other sign.
    let own = given.then_some([1.0, 1.0]);
    let turning = speeds.iter().map(|speed| [-speed, *speed]);
    let factors: Vec<[f64; 2]> = own.into_iter().chain(turning).collect();
    let mut inner = DMatrix::zeros(m, m);
    let count = factors.len();
    for (place, block) in reduced.coupling.iter().enumerate() {
        let by = factors[place / count][0] * factors[place % count][1];
        inner += by * DMatrix::from_row_slice(m, m, block);
    }
    Some(inner)
}

fn coupled(
    reduced: &Reduced,
    inner: &DMatrix<f64>,
    speeds: &[f64],
    base: f64,
) -> Vec<DMatrix<f64>> {
    let m = reduced.vectors();
    let inner = inner.map(|x| Complex::new(x, 0.0));
    let damping = damping(reduced, speeds);
    let columns = reduced
        .checked
        .first()
        .map_or(0, |c| c.errors.len() / reduced.rows.len().max(1));
    let read = DMatrix::from_fn(m, reduced.rows.len(), |i, j| {
        Complex::new(reduced.rows[j][i], 0.0)
    });
    let driven = read.columns(0, columns).into_owned();
    let at = |harmonic: usize| {
        let frequency = harmonic as f64 * base;
        let dynamic = dynamic(reduced, &damping, frequency);
        let left = dynamic.transpose().lu().solve(&read);
        let right = dynamic.lu().solve(&driven);
        let none = || DMatrix::zeros(reduced.rows.len(), columns);
        left.zip(right).map_or_else(none, |(left, right)| {
            let change = left.transpose() * &inner * right;
            change.map(|x| DYNAMIC * frequency * frequency * x.norm())
        })
    };
    (1..=COUPLED).map(at).collect()
}
