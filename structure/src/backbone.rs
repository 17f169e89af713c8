//! What the reduction changes of free oscillations.
//!
//! At the frequency `w` the mean of kinetic less potential energy over the period, `W`, is stationary at a free oscillation. In the forces `F` of
//! contacts and of loads that stay, whose harmonics are `F_k`, the whole structure has
//!
//! ```text
//! dW = (F_0 . E(0) F_0)/2 + sum_k (F_k . E(k w) F_k)/4                                                        (1)
//! ```
//!
//! more than the reduced one, to first order, with the error `E` of the compliance. Along a branch of free oscillations `W` changes with the
//! frequency as the action `J = w sum_k k^2 q_k . q_k / 2` says, `dW/dw = J`, so that at an equal action the frequencies differ by
//!
//! ```text
//! - d(dW)/dJ                                                                                                  (2)
//! ```
//!
//! along each [part](Branch::parts) of the branch, which is taken between one orbit and the next. Signs of `E` are not known where it is interpolated: sizes are added up,
//! with one sign of an entry for both orbits.
//!
//! Source: Landau and Lifshitz (1976), Mechanics, sections 43, 49 (the action as a function of the period, and its change where a parameter
//! changes).

use hertzian::{Branch, Cancel, Point};

use crate::description::load::LoadKind;
use crate::description::structure::SparseStructure;
use crate::reduced::{Reduced, ReducedError};

/// A free oscillation: its frequency, its action, and harmonics of forces by the places of what is driven.
struct Oscillation {
    omega: f64,
    action: f64,
    forces: Vec<(usize, Vec<f64>)>,
    measured: Reduced,
}

/// A pair of forces by their places: what is read, and what is driven.
struct Pair<'o> {
    read: usize,
    driven: usize,
    /// Harmonics of both, of one orbit and of the next.
    of: [[&'o [f64]; 2]; 2],
}

impl Reduced {
    /// What the reduction changes of the frequency of each free oscillation of a structure, as a part of it, at equal action, to first order
    /// (2). The branch is that of a [`FreeOscillation`](hertzian::backbone::FreeOscillation) of the
    /// [reduced structure](Self::structure) that is made conservative. What is not a number, where the action does not change along the branch,
    /// is unbounded, and so is that of an orbit alone between two [leaps](hertzian::Leap).
    ///
    /// # Errors
    /// If it is a reduction of [another structure](Self::is_of), or an orbit cannot be read.
    pub fn frequency_errors(
        &self,
        structure: &SparseStructure,
        free: &Branch,
    ) -> Result<Vec<f64>, ReducedError> {
        self.effects(structure, free).frequencies()
    }

    /// The same, unless it is cancelled.
    pub(crate) fn frequencies_until(
        &self,
        structure: &SparseStructure,
        free: &Branch,
        cancel: &Cancel,
    ) -> Result<Vec<f64>, ReducedError> {
        self.is_of(structure)?;
        let of = |point: &Point| self.oscillation(structure, free, point, cancel);
        let orbits: Vec<Oscillation> = free.points.iter().map(of).collect::<Result<_, _>>()?;
        let between = |pair: &[Oscillation]| {
            let action = (pair[1].action - pair[0].action).abs();
            let change = changes(structure, [&pair[0], &pair[1]]);
            let error = change / action / pair[1].omega;
            if change == 0.0 {
                0.0
            } else if error.is_nan() {
                f64::INFINITY
            } else {
                error
            }
        };
        let mut orbits = &orbits[..];
        let mut errors = Vec::with_capacity(orbits.len());
        for part in free.parts() {
            let (own, others) = orbits.split_at(part.len());
            orbits = others;
            let own: Vec<f64> = own.windows(2).map(between).collect();
            // The first has no orbit before it, and one that is alone none at all.
            let first = own.first().copied().unwrap_or(f64::INFINITY);
            errors.extend(part.first().map(|_| first));
            errors.extend(own);
        }
        Ok(errors)
    }

    fn oscillation(
        &self,
        structure: &SparseStructure,
        free: &Branch,
        point: &Point,
        cancel: &Cancel,
    ) -> Result<Oscillation, ReducedError> {
        let completed = free.complete(point)?;
        let orbit = &completed.orbit;
        if orbit.coordinates() != self.vectors() {
            return Err(ReducedError::Other);
        }
        let mut action = 0.0;
        for coordinate in 0..orbit.coordinates() {
            let series = orbit.series(coordinate).unwrap_or_default();
            let harmonics = series.get(1..).unwrap_or_default().chunks_exact(2);
            for (pair, k) in harmonics.zip(1..) {
                let rate = f64::from(k) * orbit.base;
                action += 0.5 * rate * rate * (pair[0].powi(2) + pair[1].powi(2));
            }
        }
        let mut forces = Vec::new();
        for (index, contact) in structure.contacts.iter().enumerate() {
            let series = free.reading(&contact.name, point)?.series;
            // It goes back the way it came: there are a mean and cosines alone.
            let cosines = series.iter().skip(1).step_by(2);
            let all = series.first().into_iter().chain(cosines);
            forces.push((2 * index + 1, all.copied().collect()));
        }
        let known = |name: &str| {
            let mut parameters = free.model.parameters.iter().zip(&point.parameters);
            let found = parameters.find(|(of, _)| of.name == name);
            found.map(|(_, value)| *value)
        };
        for (index, load) in structure.loads.iter().enumerate() {
            let stays =
                load.harmonic == 0 && matches!(load.kind, LoadKind::Force | LoadKind::Acceleration);
            if stays {
                // It pulls where contacts push.
                let mean = -load.amplitude.at(known, point.omega()) * load.phase.cos();
                forces.push((2 * structure.contacts.len() + index, vec![mean]));
            }
        }
        let longest = forces.iter().map(|(_, of)| of.len()).max().unwrap_or(0);
        let harmonics = (1..longest).map(|k| k as f64 * orbit.base);
        Ok(Oscillation {
            omega: point.omega(),
            action: action / orbit.base,
            measured: self.measured(structure, harmonics, cancel)?,
            forces,
        })
    }
}

/// The largest change of (1) from one orbit to the next.
fn changes(structure: &SparseStructure, orbits: [&Oscillation; 2]) -> f64 {
    let contacts = 2 * structure.contacts.len();
    let mut all = 0.0;
    for (read, a) in orbits[0].forces.iter().enumerate() {
        for (driven, b) in orbits[0].forces.iter().enumerate() {
            let pair = Pair {
                // A gap is read along the direction of the gap, where its force acts along the one behind.
                read: if a.0 < contacts { a.0 - 1 } else { a.0 },
                driven: b.0,
                of: orbits.map(|orbit| [&orbit.forces[read].1[..], &orbit.forces[driven].1[..]]),
            };
            all += pair.change(orbits);
        }
    }
    all
}

impl Pair<'_> {
    /// The largest change of its part of (1).
    fn change(&self, orbits: [&Oscillation; 2]) -> f64 {
        let lengths = self.of.iter().flatten().map(|of| of.len());
        let harmonics = 0..lengths.max().unwrap_or(0);
        let change = |k: usize| {
            let [one, next] = [0, 1].map(|i| {
                let orbit = orbits[i];
                let frequency = k as f64 * orbit.omega;
                let error = orbit
                    .measured
                    .compliance_error(self.read, self.driven, frequency);
                let [a, b] = self.of[i].map(|of| of.get(k).copied().unwrap_or(0.0));
                error * a * b
            });
            let share = if k == 0 { 0.5 } else { 0.25 };
            share * (next - one).abs()
        };
        harmonics.map(change).sum()
    }
}
