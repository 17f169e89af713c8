//! Coordinates that take each other's place: equal masses between equal springs, the two directions of a rotor on equal supports.
//!
//! Wanted are permutations of coordinates with signs, `(S q)_i = s_i q_(p_i)`, and parts `T/m` of the period so that with `q(t)` also
//! `S^-1 q(t + T/m)` solves the equations, of which the `i`th is that of the `i`th coordinate. Products of loads, of directions of
//! contacts and of matrices with themselves, averaged over the period, do not depend on a shift in time and tell most candidates: a
//! matrix `X` of them has `X_(p_i p_j) = s_i s_j X_ij`. What is left, found coordinate by coordinate, is compared term by term.
//!
//! Source: `McKay` and Piperno (2014), Practical graph isomorphism II, section 2 (backtracking with invariants).

use std::f64::consts::TAU;

use super::contacts::{self, Wave};
use super::{Over, ROUNDING};
use crate::branches::orbit::Orbit;
use crate::branches::recurrence::{CyclicSymmetry, SignedPermutation};
use crate::model::layout::{Entry, Layout};
use crate::numeric::fourier::series;
use crate::system::Part;

/// Coordinates that are tried, all in all, and permutations that are kept, at most.
const TRIED: usize = 20_000;
const KEPT: usize = 64;
/// Averages of products that differ by no more than this part of the largest are compared term by term.
const SIMILAR: f64 = 1e-12;

/// An orbit that differs from its image by no more than this part of its size has the symmetry, and a direction that differs by more than
/// the other one has not.
const SAME: f64 = 1e-6;
const APART: f64 = 0.5;

/// Symmetries of a system by which coordinates take each other's place.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub(crate) struct Permutations {
    /// At once: orbits may have them at every time.
    pub(crate) at_once: Vec<SignedPermutation>,
    /// A part of the period later.
    pub(crate) later: Vec<CyclicSymmetry>,
}

impl Over<'_> {
    /// Those of the whole range; without the signs of all coordinates alone.
    pub(crate) fn permutations(&self) -> Permutations {
        let mut found = Permutations::default();
        let layout = self.place.layout;
        if layout.coordinates < 2 {
            return found;
        }
        let coefficients: Vec<Vec<f64>> = self.coefficients().collect();
        let invariants = invariants(layout, &coefficients[0]);
        let size = |matrix: &Vec<f64>| matrix.iter().fold(0.0, |m: f64, x| m.max(x.abs()));
        let mut search = Search {
            sizes: invariants.iter().map(size).collect(),
            invariants,
            coordinates: layout.coordinates,
            tried: 0,
            chosen: Vec::new(),
            found: Vec::new(),
        };
        search.extend();
        for image in search.found {
            let parts = image.order();
            if self.has(&image, 1, &coefficients) {
                found.at_once.push(image.clone());
            }
            if self.has(&image, parts, &coefficients) {
                found.later.push(CyclicSymmetry { parts, image });
            }
        }
        found
    }

    /// Whether all equations go into each other.
    fn has(&self, image: &SignedPermutation, parts: usize, coefficients: &[Vec<f64>]) -> bool {
        let layout = self.place.layout;
        coefficients.iter().all(|values| {
            let matrices = [&layout.mass, &layout.damping, &layout.stiffness];
            let mut matrices = matrices.into_iter();
            matrices.all(|entries| maps(entries, values, image, [true, true], parts))
                && maps(&layout.load, values, image, [true, false], parts)
                && contacts::are_permuted(self.place.system, layout, values, image, parts)
        })
    }
}

impl Permutations {
    pub(crate) fn is_empty(&self) -> bool {
        self.at_once.is_empty() && self.later.is_empty()
    }

    /// Whether a vector, series after series, has not a symmetry that an orbit has. Those of orbits of several periods are looked at that
    /// are there at once.
    pub(crate) fn are_broken(&self, orbit: &Orbit, v: &[f64]) -> bool {
        let mut at_once = self.at_once.iter();
        let mut later = self.later.iter();
        let breaks = |image: &SignedPermutation, parts: usize| {
            let differs = |u: &[f64]| differs(u, orbit.coordinates, image, 1.0 / parts as f64);
            differs(&orbit.series) <= SAME && differs(v) > APART
        };
        at_once.any(|image| breaks(image, 1))
            || orbit.period == 1 && later.any(|later| breaks(&later.image, later.parts))
    }
}

/// Whether the terms of a matrix or of a load, of which rows or columns are those of coordinates, go into each other.
fn maps(
    entries: &[Entry],
    values: &[f64],
    image: &SignedPermutation,
    [rows, columns]: [bool; 2],
    parts: usize,
) -> bool {
    let place = |of_coordinates: bool, index: usize| {
        if of_coordinates {
            image.entry(index)
        } else {
            (index, 1.0)
        }
    };
    let at = |row: usize, column: usize, wave: &Entry| {
        let value = values[wave.coefficient];
        (((row, column), wave.wave.harmonic, wave.wave.part), value)
    };
    let (mut own, mut moved) = (Vec::new(), Vec::new());
    for entry in entries {
        own.push(at(entry.row, entry.column, entry));
        let (row, sign) = place(rows, entry.row);
        let (column, other) = place(columns, entry.column);
        let (key, value) = at(row, column, entry);
        moved.push((key, sign * other * value));
    }
    are_alike(&own, &contacts::turned(&moved, parts))
}

/// Whether two lists of waves have the same sums.
fn are_alike<P: Copy + PartialEq>(a: &[Wave<P>], b: &[Wave<P>]) -> bool {
    let size = a.iter().fold(0.0, |m: f64, (_, value)| m.max(value.abs()));
    let sum = |waves: &[Wave<P>], place| {
        let same = waves.iter().filter(|(other, _)| *other == place);
        same.map(|(_, value)| value).sum::<f64>()
    };
    let mut places = a.iter().chain(b).map(|(place, _)| *place);
    places.all(|place| (sum(a, place) - sum(b, place)).abs() <= ROUNDING * size)
}

/// Matrices that a symmetry leaves as they are, whatever the shift in time.
fn invariants(layout: &Layout, values: &[f64]) -> Vec<Vec<f64>> {
    let n = layout.coordinates;
    let mut all = Vec::new();
    for entries in [&layout.mass, &layout.damping, &layout.stiffness] {
        let mut mean = vec![0.0; n * n];
        crate::model::layout::add_constant(entries, values, n, &mut mean);
        all.push(mean);
    }
    let load = layout.load.iter();
    let load = load.map(|entry| {
        let place = (entry.row, entry.wave.harmonic, entry.wave.part);
        (place, values[entry.coefficient])
    });
    let mut loads = vec![0.0; n * n];
    add_products(&load.collect::<Vec<_>>(), n, &mut loads);
    let mut gaps = vec![0.0; n * n];
    let mut forces = vec![0.0; n * n];
    for contact in &layout.contacts {
        add_products(&contacts::gathered(&contact.gap, values), n, &mut gaps);
        add_products(&contacts::gathered(&contact.force, values), n, &mut forces);
    }
    all.extend([loads, gaps, forces]);
    all
}

/// Adds the average over the period of the product of a direction, or a load, with itself.
fn add_products(waves: &[Wave], n: usize, to: &mut [f64]) {
    for ((i, harmonic, part), x) in waves {
        for ((j, other, other_part), y) in waves {
            if harmonic == other && part == other_part {
                let mean = match part {
                    Part::Cosine if *harmonic == 0 => 1.0,
                    _ => 0.5,
                };
                to[i * n + j] += mean * x * y;
            }
        }
    }
}

/// By what part of its size a vector of series differs from its image a part of the period later.
fn differs(u: &[f64], coordinates: usize, image: &SignedPermutation, shift: f64) -> f64 {
    let length = u.len() / coordinates;
    let (mut apart, mut size) = (0.0, 0.0);
    for (i, row) in u.chunks_exact(length).enumerate() {
        let (place, sign) = image.entry(i);
        let other = &u[place * length..][..length];
        apart += (row[0] - sign * other[0]).powi(2);
        size += row[0] * row[0];
        for k in 1..=series::harmonics(row) {
            let (sine, cosine) = (TAU * (k as f64 * shift).fract()).sin_cos();
            let (c, s) = (row[2 * k - 1], row[2 * k]);
            let later = [c * cosine + s * sine, s * cosine - c * sine];
            apart += (later[0] - sign * other[2 * k - 1]).powi(2);
            apart += (later[1] - sign * other[2 * k]).powi(2);
            size += c * c + s * s;
        }
    }
    (apart / size).sqrt()
}

/// The search, coordinate by coordinate.
struct Search {
    invariants: Vec<Vec<f64>>,
    /// The largest entries of these.
    sizes: Vec<f64>,
    coordinates: usize,
    tried: usize,
    /// Places and signs of the first coordinates.
    chosen: Vec<(usize, i8)>,
    found: Vec<SignedPermutation>,
}

impl Search {
    fn extend(&mut self) {
        if self.chosen.len() == self.coordinates {
            let image = SignedPermutation::of(self.chosen.clone());
            if !image.is_identity() && !image.is_minus() {
                self.found.push(image);
            }
            return;
        }
        for place in 0..self.coordinates {
            if self.chosen.iter().any(|(other, _)| *other == place) {
                continue;
            }
            for sign in [1, -1] {
                self.tried += 1;
                if self.tried > TRIED || self.found.len() >= KEPT {
                    return;
                }
                self.chosen.push((place, sign));
                if self.agrees() {
                    self.extend();
                }
                self.chosen.pop();
            }
        }
    }

    /// Whether the coordinate chosen last is to all before as its image is to theirs.
    fn agrees(&self) -> bool {
        let n = self.coordinates;
        let last = self.chosen.len() - 1;
        let (place, sign) = self.chosen[last];
        let mut matrices = self.invariants.iter().zip(&self.sizes);
        matrices.all(|(matrix, size)| {
            let near = |x: f64, y: f64| (x - y).abs() <= SIMILAR * size;
            let mut before = self.chosen.iter().enumerate();
            before.all(|(i, &(other, other_sign))| {
                let signs = f64::from(sign * other_sign);
                near(matrix[place * n + other], signs * matrix[last * n + i])
                    && near(matrix[other * n + place], signs * matrix[i * n + last])
            })
        })
    }
}
