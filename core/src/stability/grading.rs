//! Maps of `[0, 1]` onto itself that flatten an end where an integrand is singular.
//!
//! Where the integrand behaves as a power `beta` of the distance from an end, `t = I_s(p, p)` (the regularised incomplete
//! beta function) gives `t ~ s^p` there, and the integrand times `dt/ds` becomes `s^(p (beta + 1) - 1)`: smooth enough for a
//! rule of order `m` when `p (beta + 1) >= m`. A larger `p` than needed crowds the middle.
//!
//! Source: Davis and Rabinowitz (1984), Methods of Numerical Integration, section 2.12; Sidi (1993), A new variable
//! transformation for numerical integration.

/// The order that the graded integrand shall allow.
const ORDER: f64 = 6.0;
/// Largest `p`: beyond it the nodes crowd so much at the ends that rounding shows.
const LARGEST: u32 = 8;

/// A panel graded at both ends, or not at all.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Grading {
    /// `p`; one means no grading.
    power: u32,
}

/// A phase on a panel, and its derivative with respect to `s`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Graded {
    pub(super) tau: f64,
    pub(super) slope: f64,
}

impl Grading {
    /// No grading.
    pub(super) const NONE: Self = Self { power: 1 };

    /// For an integrand that behaves as the power `exponent` of the distance from an end; infinity if it is smooth.
    pub(super) fn for_exponent(exponent: f64) -> Self {
        if exponent == f64::INFINITY {
            return Self::NONE;
        }
        let wanted = (ORDER / (exponent + 1.0).max(0.1)).ceil();
        Self {
            power: (wanted as u32).clamp(2, LARGEST),
        }
    }

    /// The phase of `s` in `[0, 1]` on the panel from `start` to `end`. It is measured from the nearer end, so that a
    /// small distance from a singular end is not rounded away.
    pub(super) fn map(self, s: f64, start: f64, end: f64) -> Graded {
        let width = end - start;
        if self.power == 1 {
            return Graded {
                tau: start + width * s,
                slope: width,
            };
        }
        let (distance, slope) = beta(self.power, s.min(1.0 - s));
        let tau = if s <= 0.5 {
            start + width * distance
        } else {
            end - width * distance
        };
        Graded {
            tau,
            slope: width * slope,
        }
    }
}

/// `I_s(p, p)` and its derivative: with `n = 2 p - 1`,
/// `I = sum over j from p to n of (n choose j) s^j (1 - s)^(n - j)`, a sum of positive terms.
fn beta(p: u32, s: f64) -> (f64, f64) {
    let n = 2 * p - 1;
    let rest = 1.0 - s;
    // (n choose p) s^p (1 - s)^(n - p), and from it the others.
    let choose = (1..p).fold(1.0, |product, i| {
        product * f64::from(n + 1 - i) / f64::from(i)
    });
    let mut term = choose * s.powi(p as i32) * rest.powi((n - p) as i32);
    let slope = f64::from(p) * choose * (s * rest).powi(p as i32 - 1);
    let mut sum = 0.0;
    for j in p..=n {
        sum += term;
        term *= s / rest * f64::from(n - j) / f64::from(j + 1);
    }
    (sum, slope)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn maps_run_from_end_to_end_with_the_right_slope() {
        for power in 1..=LARGEST {
            let grading = Grading { power };
            assert!((grading.map(0.0, 2.0, 5.0).tau - 2.0).abs() < 1e-14);
            assert!((grading.map(1.0, 2.0, 5.0).tau - 5.0).abs() < 1e-14);
            for s in [0.1, 0.3, 0.5, 0.7, 0.9] {
                let h = 1e-5;
                let difference = (grading.map(s + h, 2.0, 5.0).tau
                    - grading.map(s - h, 2.0, 5.0).tau)
                    / (2.0 * h);
                let slope = grading.map(s, 2.0, 5.0).slope;
                assert!((difference - slope).abs() < 1e-7 * slope, "{grading:?} {s}");
            }
        }
    }
}
