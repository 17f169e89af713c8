//! How many harmonics a tolerance asks for, point by point along a branch.
//!
//! The error of an orbit is estimated by what the harmonics from `K` to `2 K` would change
//! ([`truncation`](crate::balance::truncation)). Displacement coefficients of a contact fall as a power `k^-p`, so the error falls as a
//! power of `K` too, and
//!
//! ```text
//! K' = K (error / tolerance)^(1/3)                                                                           (1)
//! ```
//!
//! is enough where it falls as `K^-3`, the slowest there is for a force without jumps. Harmonics are taken away when the error
//! has been far below the tolerance for some points. Where a force is smooth the error falls exponentially, and (1) takes
//! away too many; then it is known of two numbers of harmonics what error they have, and the one between them is taken that
//!
//! ```text
//! ln error = a - b K                                                                                         (2)
//! ```
//!
//! through both gives. That is forgotten after some points, since the orbits change.
//!
//! Source: the number of harmonics follows the residual of omitted ones, as in Grolet and Thouverez (2012), On a new harmonic
//! selection technique for harmonic balance method, and Jaumouille, Sinou and Petitjean (2010), An adaptive harmonic balance
//! method for predicting the nonlinear dynamic responses of mechanical systems.

use super::Lattice;

/// Error, in parts of the tolerance, below which there may be fewer harmonics.
const CALM: f64 = 1e-2;
/// Successive points with such errors before there are fewer.
const PATIENCE: usize = 3;
/// Points for which a number of harmonics that was too few is remembered.
const MEMORY: usize = 15;
/// Points for which the number is kept after another one has failed; each further time twice as many.
const KEPT: usize = 5;
/// The number of such points ceases to grow.
const MOST_KEPT: usize = 1 << 20;

/// Decides on the number of harmonics.
#[derive(Debug, Clone, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub(crate) struct Chooser {
    /// Relative error of peak-to-peak.
    #[cfg_attr(feature = "serde", serde(with = "crate::serialise"))]
    tolerance: f64,
    /// Fewest harmonics.
    least: usize,
    /// Most harmonics.
    most: usize,
    /// Harmonics that there may be: a number between two is as good as the one below it.
    lattice: Lattice,
    calm: usize,
    too_few: Option<TooFew>,
    /// Points for which the number is kept, and how many the next time.
    kept: usize,
    keep: usize,
}

/// A number of harmonics that was not enough.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
struct TooFew {
    harmonics: usize,
    /// Error over tolerance.
    #[cfg_attr(feature = "serde", serde(with = "crate::serialise"))]
    excess: f64,
    /// Points for which it is remembered.
    points: usize,
}

impl Chooser {
    pub(crate) fn new(tolerance: f64, least: usize, most: usize, lattice: Lattice) -> Self {
        let Lattice { first, step } = lattice;
        let most = most - most.saturating_sub(first) % step;
        Self {
            tolerance,
            least,
            most,
            lattice,
            calm: 0,
            too_few: None,
            kept: 0,
            keep: KEPT,
        }
    }

    /// Most harmonics.
    pub(crate) fn most(&self) -> usize {
        self.most
    }

    /// Whether it is the other one some points later.
    pub(crate) fn continues(&self, other: &Self) -> bool {
        let same =
            (self.least, self.most, self.lattice) == (other.least, other.most, other.lattice);
        same && self.tolerance == other.tolerance && self.keep <= MOST_KEPT
    }

    /// The number nearest to one that may be taken.
    pub(crate) fn admitted(&self, harmonics: usize) -> usize {
        self.rounded(harmonics as f64).max(self.least)
    }

    /// Keeps the number for some points: another one has failed here.
    pub(crate) fn keep(&mut self) {
        self.kept = self.keep;
        self.keep = (2 * self.keep).min(MOST_KEPT);
        self.calm = 0;
    }

    /// Another number of harmonics for an orbit with this error, or `None` to stay.
    pub(crate) fn decide(&mut self, harmonics: usize, error: f64) -> Option<usize> {
        if self.kept > 0 {
            self.kept -= 1;
            return None;
        }
        self.forget();
        let excess = error / self.tolerance;
        if excess > 1.0 || excess.is_nan() {
            return self.more(harmonics, excess);
        }
        self.calm = if excess > CALM { 0 } else { self.calm + 1 };
        if self.calm < PATIENCE {
            return None;
        }
        self.calm = 0;
        self.fewer(harmonics, excess)
    }

    fn forget(&mut self) {
        self.too_few = self.too_few.and_then(|few| {
            let points = few.points.checked_sub(1)?;
            Some(TooFew { points, ..few })
        });
    }

    fn more(&mut self, harmonics: usize, excess: f64) -> Option<usize> {
        self.calm = 0;
        self.too_few = Some(TooFew {
            harmonics,
            excess,
            points: MEMORY,
        });
        let factor = if excess.is_finite() {
            (1.1 * excess.cbrt()).clamp(1.15, 2.0)
        } else {
            2.0
        };
        let more = self.rounded(harmonics as f64 * factor);
        (more > harmonics).then_some(more)
    }

    fn fewer(&self, harmonics: usize, excess: f64) -> Option<usize> {
        // Half of the tolerance is aimed at, so that the next points do not ask for them back.
        let factor = (2.0 * excess).cbrt().clamp(0.5, 0.8);
        let mut wanted = harmonics as f64 * factor;
        if let Some(few) = self.too_few.filter(|few| few.harmonics < harmonics) {
            // Without a number for one of the errors, the middle.
            let part = (2.0 * few.excess).ln() / (few.excess / excess).ln();
            let part = if part.is_finite() {
                part.clamp(0.0, 1.0)
            } else {
                0.5
            };
            let from = few.harmonics as f64;
            wanted = wanted.max(from + part * (harmonics as f64 - from));
        }
        let fewer = self.rounded(wanted).max(self.least);
        (fewer < harmonics).then_some(fewer)
    }

    /// The next whole number that makes a difference, at most the largest.
    fn rounded(&self, wanted: f64) -> usize {
        let Lattice { first, step } = self.lattice;
        let beyond = (wanted.ceil() as usize).saturating_sub(first);
        (first + beyond.next_multiple_of(step)).min(self.most)
    }
}

/// Series of one number of harmonics, coordinate by coordinate with the parameter at the end, given another number: harmonics
/// are left out, or zero.
pub(crate) fn resize(u: &[f64], coordinates: usize, length: usize) -> Vec<f64> {
    let old = (u.len() - 1) / coordinates;
    let mut resized = vec![0.0; coordinates * length + 1];
    for i in 0..coordinates {
        let shared = old.min(length);
        resized[i * length..][..shared].copy_from_slice(&u[i * old..][..shared]);
    }
    resized[coordinates * length] = u[u.len() - 1];
    resized
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn harmonics_follow_the_error() {
        let mut chooser = Chooser::new(1e-6, 3, 100, Lattice { first: 0, step: 1 });
        assert_eq!(chooser.decide(10, 5e-7), None);
        assert_eq!(chooser.decide(10, 8e-6), Some(20));
        assert_eq!(chooser.decide(10, 1.0), Some(20));
        assert_eq!(chooser.decide(10, f64::NAN), Some(20));
        assert_eq!(chooser.decide(90, 1.0), Some(100));
        assert_eq!(chooser.decide(100, 1.0), None);
        let mut chooser = Chooser::new(1e-6, 3, 100, Lattice { first: 0, step: 1 });
        assert_eq!(chooser.decide(10, 0.0), None);
        assert_eq!(chooser.decide(10, 0.0), None);
        assert_eq!(chooser.decide(10, 0.0), Some(5));
        for _ in 0..6 {
            assert_eq!(chooser.decide(3, 0.0), None);
        }
    }

    /// An error that falls as `e^(-2 K)` asks for the same number for ever, once it is found.
    #[test]
    fn an_exponential_fall_settles() {
        let mut chooser = Chooser::new(1e-6, 3, 100, Lattice { first: 0, step: 1 });
        let error = |harmonics: usize| (-2.0 * harmonics as f64).exp();
        let (mut harmonics, mut changes) = (40, Vec::new());
        for _ in 0..200 {
            if let Some(other) = chooser.decide(harmonics, error(harmonics)) {
                harmonics = other;
                changes.push(other);
            }
        }
        // 7 is the first with an error below the tolerance.
        assert!((7..10).contains(&harmonics), "{changes:?}");
        assert!(changes.len() < 8, "{changes:?}");
    }

    #[test]
    fn odd_orbits_have_odd_numbers() {
        let mut chooser = Chooser::new(1e-6, 5, 100, Lattice { first: 1, step: 2 });
        assert_eq!(chooser.decide(9, 1e-6 * 1.2), Some(11));
        assert_eq!(chooser.decide(51, 1.0), Some(99));
        assert_eq!(chooser.decide(99, 1.0), None);
    }

    #[test]
    fn after_a_failure_the_number_is_kept_for_a_while() {
        let mut chooser = Chooser::new(1e-6, 3, 100, Lattice { first: 0, step: 1 });
        for times in [KEPT, 2 * KEPT] {
            assert_eq!(chooser.decide(10, 1.0), Some(20));
            chooser.keep();
            for _ in 0..times {
                assert_eq!(chooser.decide(10, 1.0), None);
            }
        }
        assert_eq!(chooser.decide(10, 1.0), Some(20));
    }

    #[test]
    fn resizing_keeps_what_is_shared() {
        let u = [1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 9.0];
        assert_eq!(
            resize(&u, 2, 5),
            [1.0, 2.0, 3.0, 0.0, 0.0, 4.0, 5.0, 6.0, 0.0, 0.0, 9.0]
        );
        assert_eq!(resize(&u, 2, 1), [1.0, 4.0, 9.0]);
    }
}
