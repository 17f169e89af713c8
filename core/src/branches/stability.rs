//! The stability of an orbit, as data.

use nalgebra::Complex;

use crate::model::rigid::Rigid;

/// What is known of the stability of an orbit.
#[derive(Debug, Clone, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[non_exhaustive]
pub struct Stability {
    /// The verdict.
    pub verdict: Verdict,
    /// Floquet multipliers over the orbit's own period, [whole](crate::Orbit::period) periods of the declaration, largest modulus first; those of the orbit corrected for the
    /// harmonics and samples that were left out. Those of [rigid motions](Self::rigid) are not among them. Of 130 states or more, by the contact
    /// equation and by shooting, those alone that are larger than half of the largest, or than a half if the largest is outside of the unit circle: all others are
    /// shown to be smaller than 0.8 of the same, and of those between some may be missing.
    #[cfg_attr(feature = "serde", serde(with = "crate::serialise"))]
    pub multipliers: Vec<Complex<f64>>,
    /// Estimated error of the multipliers: of the integration, and of the orbit's own truncation.
    #[cfg_attr(feature = "serde", serde(with = "crate::serialise"))]
    pub error: f64,
    /// So many multipliers more are exactly one, since nothing holds the system along some directions: shifted along them an orbit
    /// is another one, and so it is at another constant speed where nothing damps that. The verdict is about the others.
    pub rigid: usize,
}

/// Whether small perturbations die out.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(rename_all = "kebab-case"))]
pub enum Verdict {
    /// All multipliers are inside the unit circle, by more than their error.
    Stable,
    /// At least one multiplier is outside the unit circle, by more than its error.
    Unstable,
    /// The error of the largest multiplier does not allow a verdict, or is so large a part of it that it is no more than a size.
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
/// What is estimated to be wrong by a larger part of the largest multiplier, or of one, may be wrong by more than that: estimates are the first terms of
/// series, which tell an error where it is small.
const KNOWN: f64 = 0.25;

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
        let verdict = if error > KNOWN * largest.max(1.0) {
            Verdict::Undecided
        } else if largest + error < 1.0 {
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
mod tests {
    use super::*;

    #[test]
    fn verdicts_need_a_margin() {
        let at = |modulus| vec![Complex::new(modulus, 0.0)];
        assert_eq!(Stability::of(at(0.9), 0.01).verdict, Verdict::Stable);
        assert_eq!(Stability::of(at(1.1), 0.01).verdict, Verdict::Unstable);
        assert_eq!(Stability::of(at(0.995), 0.01).verdict, Verdict::Undecided);
        assert_eq!(Stability::of(at(0.3), 0.3).verdict, Verdict::Undecided);
        let wide = Stability::of(at(32.8), 22.0);
        assert_eq!(wide.verdict, Verdict::Undecided);
        assert_eq!(Stability::of(Vec::new(), 0.0).verdict, Verdict::Undecided);
        assert_eq!(Stability::of(at(f64::NAN), 0.0).verdict, Verdict::Undecided);
    }
}
