//! How many harmonics a tolerance asks for, point by point along a branch.
//!
//! The error of an orbit is estimated by what the harmonics from `K` to `2 K` would change
//! ([`truncation`](crate::truncation)). Displacement coefficients of a contact fall as a power `k^-p`, so the error falls as a
//! power of `K` too, and
//!
//! ```text
//! K' = K (error / tolerance)^(1/3)                                                                           (1)
//! ```
//!
//! is enough where it falls as `K^-3`, the slowest there is for a force without jumps. Harmonics are taken away when the error
//! has been far below the tolerance for some points.
//!
//! Source: the number of harmonics follows the residual of omitted ones, as in Grolet and Thouverez (2012), On a new harmonic
//! selection technique for harmonic balance method, and Jaumouille, Sinou and Petitjean (2010), An adaptive harmonic balance
//! method for predicting the nonlinear dynamic responses of mechanical systems.

/// Errors below this part of the tolerance make room for fewer harmonics.
const CALM: f64 = 1e-2;
/// So many points in succession.
const PATIENCE: usize = 3;

/// Decides on the number of harmonics.
#[derive(Debug, Clone)]
pub(crate) struct Chooser {
    /// Relative error of peak-to-peak.
    pub(crate) tolerance: f64,
    /// Fewest harmonics.
    pub(crate) least: usize,
    /// Most harmonics.
    pub(crate) most: usize,
    calm: usize,
}

impl Chooser {
    pub(crate) fn new(tolerance: f64, least: usize, most: usize) -> Self {
        Self {
            tolerance,
            least,
            most,
            calm: 0,
        }
    }

    /// Another number of harmonics for an orbit with this error, or `None` to stay.
    pub(crate) fn decide(&mut self, harmonics: usize, error: f64) -> Option<usize> {
        let excess = error / self.tolerance;
        if excess > 1.0 || excess.is_nan() {
            self.calm = 0;
            let factor = if excess.is_finite() {
                (1.1 * excess.cbrt()).clamp(1.15, 2.0)
            } else {
                2.0
            };
            let more = ((harmonics as f64 * factor).ceil() as usize).min(self.most);
            return (more > harmonics).then_some(more);
        }
        if excess > CALM {
            self.calm = 0;
            return None;
        }
        self.calm += 1;
        if self.calm < PATIENCE {
            return None;
        }
        self.calm = 0;
        // Half of the tolerance is aimed at, so that the next points do not ask for them back.
        let factor = (2.0 * excess).cbrt().clamp(0.5, 0.8);
        let fewer = ((harmonics as f64 * factor).ceil() as usize).max(self.least);
        (fewer < harmonics).then_some(fewer)
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
        let mut chooser = Chooser::new(1e-6, 3, 100);
        assert_eq!(chooser.decide(10, 5e-7), None);
        assert_eq!(chooser.decide(10, 8e-6), Some(20));
        assert_eq!(chooser.decide(10, 1.0), Some(20));
        assert_eq!(chooser.decide(10, f64::NAN), Some(20));
        assert_eq!(chooser.decide(90, 1.0), Some(100));
        assert_eq!(chooser.decide(100, 1.0), None);
        assert_eq!(chooser.decide(10, 0.0), None);
        assert_eq!(chooser.decide(10, 0.0), None);
        assert_eq!(chooser.decide(10, 0.0), Some(5));
        for _ in 0..6 {
            assert_eq!(chooser.decide(3, 0.0), None);
        }
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
