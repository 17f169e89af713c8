//! Test functions of a branch. What a change of sign means is told by the [engine](crate::branches::engine).
//!
//! With the map `M` of [`equations`](super::equations) and the slope `l'` of the parameter along the branch:
//!
//! | event | test function |
//! |---|---|
//! | fold | `l'` |
//! | branch point | `b = det(M - I) / l'`, the determinant of the bordered matrix of Newton's method but for a factor |
//! | period doubling | `det(M + I)`; where coordinates have to be in each other's place twice to be in their own, that symmetry breaks there |
//! | Neimark-Sacker | the [moduli](crate::branches::moduli) of multipliers, where a complex pair passes one |
//! | grazing | an extreme of a gap less its level ([`grazing`](crate::branches::engine)) |
//!
//! At a fold `b` stays away from zero. Where both `l'` and `b` change their sign, a branch ends on another one, as of twice the
//! period at a period doubling; or there is a fold, and a crossing beside it.
//!
//! Source: Govaerts (2000), Numerical Methods for Bifurcations of Dynamical Equilibria, chapters 3 and 4 (test functions);
//! Keller (1977), Numerical solution of bifurcation and nonlinear eigenvalue problems, for the determinant.

use nalgebra::{Complex, DMatrix};

use crate::branches::moduli;
use crate::branches::problem::{self as engine, Watched};
use crate::event::EventKind;
use crate::numeric::leading;

/// Beside the largest multiplier, one that is near the unit circle is known to its rounding. Where that is so large, determinants have
/// signs by chance.
const UNRESOLVED: f64 = 1e-2;

/// Places among those that are watched: branch point, period doubling, and the first of the moduli.
const CROSSING: usize = 0;
pub(crate) const DOUBLING: usize = 1;
const MODULI: usize = 2;
/// Multipliers nearer to one, to minus one or to the unit circle may be on either side of it by rounding.
const TOLD: f64 = 1e-6;

/// The test functions at one orbit.
#[derive(Debug, Clone)]
pub(crate) struct Tests {
    slope: f64,
    /// `det(M - I)`
    minus: f64,
    /// `det(M + I)`
    plus: f64,
    /// No logarithm of a modulus is told from what is less.
    least: f64,
    /// Of `M`, largest modulus first; none where nothing is known.
    pub(crate) multipliers: Vec<Complex<f64>>,
}

/// Which of them.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Test {
    Slope,
    /// `b`
    Bordered,
    Plus,
    /// Of the multiplier at a place in the order of moduli.
    Modulus(usize),
}

/// Those that are watched of a system of so many states, in the order of [`Test::watched`].
/// What begins where the multiplier over the part that is followed is minus one is told.
pub(crate) fn watched(doubling: EventKind, states: usize) -> Vec<Watched> {
    let of = |kind| Watched {
        kind,
        bordered: kind == EventKind::BranchPoint,
    };
    let moduli = std::iter::repeat_n(EventKind::NeimarkSacker, states);
    let kinds = [EventKind::BranchPoint, doubling].into_iter().chain(moduli);
    kinds.map(of).collect()
}

impl Test {
    /// By its place among those that are watched.
    pub(crate) fn watched(index: usize) -> Self {
        match index {
            CROSSING => Self::Bordered,
            DOUBLING => Self::Plus,
            _ => Self::Modulus(index - MODULI),
        }
    }

    pub(crate) fn of(test: engine::Test) -> Self {
        match test {
            engine::Test::Slope => Self::Slope,
            engine::Test::Watched(index) => Self::watched(index),
        }
    }
}

impl Tests {
    pub(crate) fn of(map: Option<&DMatrix<f64>>, slope: f64) -> Self {
        let multipliers = map.map_or_else(Vec::new, moduli::of_map);
        Self::with(map, multipliers, slope)
    }

    /// Of a map whose eigenvalues are known, all of them or those that are not small.
    pub(crate) fn with(
        map: Option<&DMatrix<f64>>,
        multipliers: Vec<Complex<f64>>,
        slope: f64,
    ) -> Self {
        let largest = multipliers.first().map_or(0.0, |m| m.norm());
        let resolved = map.filter(|_| f64::EPSILON * largest < UNRESOLVED);
        let states = map.map_or(0, DMatrix::nrows);
        let left_out = states.saturating_sub(multipliers.len());
        let determinant = |shift: f64| {
            resolved.map_or(f64::NAN, |map| {
                if left_out == 0 || multipliers.is_empty() {
                    let shifted = map + DMatrix::identity(states, states) * shift;
                    return shifted.determinant();
                }
                // Of those that are left out, which are small, the sign alone.
                let sign = if left_out.is_multiple_of(2) {
                    1.0
                } else {
                    shift
                };
                let factors = multipliers.iter().map(|m| m + shift);
                sign * factors.product::<Complex<f64>>().re
            })
        };
        let least = if left_out == 0 {
            f64::NEG_INFINITY
        } else {
            leading::least(largest).ln()
        };
        Self {
            slope,
            minus: determinant(-1.0),
            plus: determinant(1.0),
            least,
            multipliers,
        }
    }

    /// Whether determinants have the signs of others, and as many multipliers are outside of the unit circle, as far as rounding lets that be told.
    pub(crate) fn tell_as(&self, other: &Self) -> bool {
        let both = [self, other];
        let is_told = |at: f64| {
            let mut multipliers = both.iter().flat_map(|tests| &tests.multipliers);
            multipliers.all(|m| (m - at).norm() > TOLD)
        };
        let alike = |a: f64, b: f64, at: f64| a * b >= 0.0 || (a * b).is_nan() || !is_told(at);
        let outside = |tests: &Self, radius: f64| {
            let multipliers = tests.multipliers.iter();
            multipliers.filter(|m| m.norm() > radius).count()
        };
        let [least, most] =
            [1.0 + TOLD, 1.0 - TOLD].map(|radius| both.map(|of| outside(of, radius)));
        alike(self.minus, other.minus, 1.0)
            && alike(self.plus, other.plus, -1.0)
            && least[0] <= most[1]
            && least[1] <= most[0]
    }

    pub(crate) fn value(&self, test: Test) -> f64 {
        match test {
            Test::Slope => self.slope,
            Test::Bordered => self.minus / self.slope,
            Test::Plus => self.plus,
            Test::Modulus(place) => {
                let logarithm = moduli::logarithm(&self.multipliers, place);
                // What is not known stays so.
                if logarithm < self.least {
                    self.least
                } else {
                    logarithm
                }
            }
        }
    }

    /// What happens where the modulus at a place was driven to one, if anything does that a determinant does not
    /// [tell](moduli::seen_by_moduli). A multiplier of minus one has the name `doubling`.
    pub(crate) fn seen_by_modulus(
        &self,
        place: usize,
        tells: bool,
        doubling: EventKind,
    ) -> Option<EventKind> {
        let seen = moduli::seen_by_moduli(&self.multipliers, place, tells)?;
        Some(match seen {
            EventKind::PeriodDoubling => doubling,
            other => other,
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Determinants of a map whose product of multipliers is `1/4`, in states that mix them.
    #[test]
    fn determinants_by_chance_are_unknown() {
        for (largest, known) in [(1e2, true), (1e8, true), (1e15, false), (1e20, false)] {
            let multipliers = DMatrix::from_row_slice(2, 2, &[largest, 0.0, 0.0, 0.25 / largest]);
            let states = DMatrix::from_row_slice(2, 2, &[0.8, -0.6, 0.6, 0.8]);
            let map = &states * multipliers * states.transpose();
            let tests = Tests::of(Some(&map), 0.5);
            for (test, exact) in [
                (Test::Plus, largest + 1.25 + 0.25 / largest),
                (Test::Bordered, 2.0 * (1.25 - largest - 0.25 / largest)),
            ] {
                let found = tests.value(test);
                assert_eq!(known, !found.is_nan(), "{largest:e}: {found}");
                let off = (found / exact - 1.0).abs();
                assert!(!known || off < 1e-15 * largest, "{largest:e}: {off:e}");
            }
        }
    }
}
