//! Contacts that take each other's place after a part of the period.
//!
//! `N` balls at angles `theta + 2 pi i / N` are where they were, but for their names, after the time in which the cage turns by one
//! of them. Let a shift by `1 / m` of the period take loads and stiffness into themselves and every contact into one of the contacts:
//! then there are orbits that come back after that part, and their harmonics are multiples of `m`. The forces of single contacts have
//! others, which cancel in the sum.
//!
//! A part that is common to all waves is no more than the period in which the declaration counts: it is chosen by whoever declares, as
//! for a stiffness of twice the frequency, whose orbits of interest have the period of the declaration. So a shift counts if it takes
//! at least one contact into another one.
//!
//! Source: Golubitsky, Stewart and Schaeffer (1988), Singularities and Groups in Bifurcation Theory II, chapter XVI (spatio-temporal
//! symmetry).

use super::{BROKEN_SHARE, Over, cancels, contacts};
use crate::branches::orbit::Orbit;
use crate::model::layout::Entry;

/// Parts of the period that are looked for, at most: a cage of more steps has more than there are harmonics.
const MOST: usize = 10_000;

impl Over<'_> {
    /// The largest number of parts of the period that are alike, one if no contact takes the place of another.
    pub(crate) fn stride(&self) -> usize {
        let coefficients: Vec<Vec<f64>> = self.coefficients().collect();
        let waves = coefficients
            .iter()
            .flat_map(|values| {
                [
                    (&self.place.layout.load, values),
                    (&self.place.layout.stiffness, values),
                ]
            })
            .fold(0, |common, (entries, values)| {
                divisor(common, entries, values)
            });
        let harmonics = contacts::harmonics(self.place.layout);
        let count = self.place.layout.contacts.len();
        let highest = harmonics.last().copied().unwrap_or(0);
        // Every wave is itself again after as many parts as there are contacts, or fewer.
        let again = |harmonic: usize, parts: usize| {
            (1..=count).any(|times| (times * harmonic).is_multiple_of(parts))
        };
        let alike = |&parts: &usize| {
            waves.is_multiple_of(parts)
                && harmonics.iter().all(|&harmonic| again(harmonic, parts))
                && self.moves(parts, &coefficients)
        };
        let most = (highest * count).min(MOST);
        (2..=most).rev().find(alike).unwrap_or(1)
    }

    /// Whether a shift by one of so many parts takes all contacts into contacts, and at least one into another one.
    fn moves(&self, parts: usize, coefficients: &[Vec<f64>]) -> bool {
        let mut moved = false;
        let alike = coefficients.iter().all(|values| {
            let shifted = contacts::shifted(self.place.system, self.place.layout, values, parts);
            moved |= shifted == Some(true);
            shifted.is_some()
        });
        alike && moved
    }
}

/// The greatest common divisor of a number and the harmonics of the waves that do not cancel.
fn divisor(number: usize, entries: &[Entry], values: &[f64]) -> usize {
    let waves = entries
        .iter()
        .filter(|entry| !cancels(entries, values, entry));
    waves.fold(number, |common, entry| {
        let (mut a, mut b) = (common, entry.wave.harmonic as usize);
        while b > 0 {
            (a, b) = (b, a % b);
        }
        a
    })
}

/// Whether an orbit oscillates in multiples of a harmonic only. The rest is what Newton's method leaves.
pub(crate) fn has_stride(orbit: &Orbit, stride: usize) -> bool {
    let (mut others, mut all) = (0.0, 0.0);
    for i in 0..orbit.coordinates {
        for (index, x) in orbit.row(i).iter().enumerate().skip(1) {
            all += x * x;
            if !index.div_ceil(2).is_multiple_of(stride) {
                others += x * x;
            }
        }
    }
    others <= BROKEN_SHARE * all
}
