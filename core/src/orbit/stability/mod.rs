//! Floquet stability of periodic orbits.
//!
//! A [`Method`] computes multipliers of an orbit as it is. The verdict ([`Stability`]) compares those of the orbit with those of
//! the same orbit corrected for what its harmonics and samples leave out, and adds the method's own error.
//!
//! [`Method::Default`] is the monodromy matrix, which was the cheapest at equal error on every orbit that was tried, with as few
//! steps as the verdict needs: to 1e-6 or a part of the error of the orbit, and more exactly where the largest multiplier is near
//! the unit circle. No verdict is given of an orbit that its correction changes by more than a tenth of its size, and none of one
//! whose gap rests on a level where the slopes of the force differ.
//!
//! What the error is, and is not:
//!
//! - It is an estimate, not a bound. Of 500 random orbits 97 % were within it, and all but three, which are beside folds, within three times.
//! - An orbit is corrected across its branch, so that the multipliers are those of an orbit that lies a little farther along:
//!   [`Answer::value`]. Beside a fold that matters, since multipliers change there as the root of the distance; the verdict is
//!   about the side of the fold that the orbit is on.
//! - Where a gap just touches a level, multipliers have a root too. An orbit that is nearer to a touch than Newton's method solves
//!   for it may have another number of switches than the true one.
//! - The change by the correction may be small by chance at single orbits. Methods with a monodromy matrix see that from its change;
//!   [`Method::Hill`] has none, and does not.

mod answer;
mod hill;
mod hill_matrix;
pub(crate) mod judge;
mod koopman_hill;
mod linearised;
mod magnus;
mod method;
mod monodromy;
mod orbit;
pub(crate) mod pairs;
mod path;
mod product;
mod refined;
mod rest;
mod two;
mod walk;

use nalgebra::Complex;

use crate::model::rigid::Rigid;

pub use answer::Answer;
pub use method::{Cost, Method, Projection, Sorting};
pub(crate) use pairs::product_of_pairs;

/// What is known of the stability of an orbit.
#[derive(Debug, Clone, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
#[non_exhaustive]
pub struct Stability {
    /// The verdict.
    pub verdict: Verdict,
    /// Floquet multipliers over the orbit's own period, largest modulus first; those of the orbit corrected for the
    /// harmonics and samples that were left out. Those of [rigid motions](Self::rigid) are not among them.
    #[cfg_attr(
        feature = "serde",
        serde(serialize_with = "crate::numeric::serialise::pairs")
    )]
    pub multipliers: Vec<Complex<f64>>,
    /// Estimated error of the multipliers: of the integration, and of the orbit's own truncation.
    pub error: f64,
    /// So many multipliers more are exactly one, since nothing holds the system along some directions: shifted along them an orbit
    /// is another one, and so it is at another constant speed where nothing damps that. The verdict is about the others.
    pub rigid: usize,
}

/// Whether small perturbations die out.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Verdict {
    /// All multipliers are inside the unit circle, by more than their error.
    Stable,
    /// At least one multiplier is outside the unit circle, by more than its error.
    Unstable,
    /// The error of the largest multiplier does not allow a verdict.
    Undecided,
}

impl std::fmt::Display for Verdict {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(match self {
            Self::Stable => "stable",
            Self::Unstable => "unstable",
            Self::Undecided => "undecided",
        })
    }
}

/// Relative error that rounding alone may have left in a multiplier.
const ROUNDING: f64 = 1e-12;

impl Stability {
    /// Nothing is known.
    pub(crate) fn unknown() -> Self {
        Self {
            verdict: Verdict::Undecided,
            multipliers: Vec::new(),
            error: f64::INFINITY,
            rigid: 0,
        }
    }

    /// The same of a system with rigid motions, whose multipliers have been taken out.
    pub(crate) fn beside(self, rigid: Option<&Rigid>) -> Self {
        Self {
            rigid: rigid.map_or(0, Rigid::multipliers),
            ..self
        }
    }

    /// The verdict that multipliers allow when they are known to this error.
    pub(crate) fn of(multipliers: Vec<Complex<f64>>, error: f64) -> Self {
        let largest = multipliers.first().map_or(f64::NAN, |m| m.norm());
        // No product of step matrices is known better than to some rounding errors.
        let error = error + ROUNDING * largest.max(1.0);
        let verdict = if largest + error < 1.0 {
            Verdict::Stable
        } else if largest - error > 1.0 {
            Verdict::Unstable
        } else {
            Verdict::Undecided
        };
        Self {
            verdict,
            multipliers,
            error,
            rigid: 0,
        }
    }
}

#[cfg(test)]
mod method_tests;
#[cfg(test)]
mod monodromy_tests;

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn verdicts_need_a_margin() {
        let at = |modulus| vec![Complex::new(modulus, 0.0)];
        assert_eq!(Stability::of(at(0.9), 0.01).verdict, Verdict::Stable);
        assert_eq!(Stability::of(at(1.1), 0.01).verdict, Verdict::Unstable);
        assert_eq!(Stability::of(at(0.995), 0.01).verdict, Verdict::Undecided);
        assert_eq!(Stability::of(Vec::new(), 0.0).verdict, Verdict::Undecided);
        assert_eq!(Stability::of(at(f64::NAN), 0.0).verdict, Verdict::Undecided);
    }
}
