//! Symmetries of orbits, and where a branch loses one: the odd one here, permutations of contacts in `contacts`, orbits that come back
//! after a part of the period in `stride`.
//!
//! Let `S` take an orbit `q(tau)` to `-q(tau + pi)`. If `S` takes solutions of the system to solutions, there are solutions
//! with `q = S q`, which have odd harmonics only. It does if, besides odd loads and even waves of the stiffness, it takes the
//! contacts into one another ([`contacts`]).
//!
//! At a symmetric solution the Jacobian falls apart into a block of the odd and one of the even harmonics. Where the determinant
//! of the even block changes its sign, a branch of solutions without the symmetry crosses: a symmetry-breaking branch point.
//!
//! Source: Swift and Wiesenfeld (1984), Suppression of period doubling in symmetric systems (the symmetry `S`); Golubitsky,
//! Stewart and Schaeffer (1988), Singularities and Groups in Bifurcation Theory II, chapter XIII (block structure).

mod contacts;
mod permutations;
mod stride;

use crate::balance::subharmonics::Addition;
use crate::branches::orbit::Orbit;
use crate::branches::recurrence::{CyclicSymmetry, SignedPermutation};
use crate::model::layout::Entry;
use crate::model::rigid::Place;

/// Values of the variable, as parts of its range, at which coefficients are looked at: the symmetry that a system has at all of
/// them it is taken to have throughout.
const LOOKED_AT: [f64; 6] = [0.0, 0.137, 0.36, 0.618, 0.83, 1.0];
/// Sum of terms that cancel, in parts of their sizes.
const ROUNDING: f64 = 1e-14;

pub(crate) use contacts::cycles;
pub(crate) use permutations::Permutations;
pub(crate) use stride::has_stride;

/// What an orbit has beyond the odd symmetry, beside that of another one.
pub(crate) fn broken(from: &Orbit, u: &[f64]) -> Addition {
    Addition::of(from, u, |harmonic| harmonic.is_multiple_of(2))
}

/// Least share of the mean square that the mean and the even harmonics of an orbit without the symmetry have: the rest is what
/// Newton's method leaves.
const BROKEN_SHARE: f64 = 1e-8;

/// Whether an orbit, of series of a length each, lacks the odd symmetry. What comes after the last whole series does not count.
pub(crate) fn is_broken(u: &[f64], length: usize) -> bool {
    broken_share(u, length) > BROKEN_SHARE
}

/// The share of the mean square that the mean and the even harmonics have.
pub(crate) fn broken_share(u: &[f64], length: usize) -> f64 {
    let (mut even, mut all) = (0.0, 0.0);
    for series in u.chunks_exact(length) {
        for (index, x) in series.iter().enumerate() {
            all += x * x;
            if index.div_ceil(2).is_multiple_of(2) {
                even += x * x;
            }
        }
    }
    even / all
}

/// A system over a range of its variable.
#[derive(Clone, Copy)]
pub(crate) struct Over<'s> {
    pub(crate) place: Place<'s>,
    pub(crate) range: [f64; 2],
}

impl Over<'_> {
    /// Whether solutions with odd harmonics only exist.
    pub(crate) fn is_odd(&self) -> bool {
        let layout = self.place.layout;
        self.coefficients().all(|values| {
            vanish(&layout.load, &values, 0)
                && vanish(&layout.stiffness, &values, 1)
                && contacts::are_symmetric(self.place.system, layout, &values)
        })
    }

    /// The symmetry of which those that are looked for are powers: the odd one, and that of contacts that take each other's place.
    pub(crate) fn cyclic(&self) -> CyclicSymmetry {
        let (odd, stride) = (self.is_odd(), self.stride());
        if !odd {
            return CyclicSymmetry {
                parts: stride,
                image: SignedPermutation::identity(),
            };
        }
        // Only rest comes back after half of a period both with and without a sign.
        let stride = stride >> stride.trailing_zeros();
        CyclicSymmetry {
            parts: 2 * stride,
            image: SignedPermutation::minus(self.place.layout.coordinates),
        }
    }

    /// Coefficients at the values that are looked at.
    fn coefficients(&self) -> impl Iterator<Item = Vec<f64>> {
        let [from, to] = self.range;
        let values = LOOKED_AT.iter().map(move |part| from + part * (to - from));
        values.map(|value| self.place.coefficients(value))
    }
}

/// Whether the waves of one parity, even or odd, cancel in a matrix or in the load.
fn vanish(entries: &[Entry], values: &[f64], parity: u32) -> bool {
    let of_parity = |entry: &&Entry| entry.wave.harmonic % 2 == parity;
    let mut of_parity = entries.iter().filter(of_parity);
    of_parity.all(|entry| cancels(entries, values, entry))
}

/// Whether the terms at the place of an entry cancel.
fn cancels(entries: &[Entry], values: &[f64], entry: &Entry) -> bool {
    let place = |entry: &Entry| (entry.row, entry.column, entry.wave);
    let same = entries.iter().filter(|other| place(other) == place(entry));
    let (sum, size) = same.fold((0.0, 0.0), |(sum, size), other| {
        let value = values[other.coefficient];
        (sum + value, size + value.abs())
    });
    sum.abs() <= ROUNDING * size
}
