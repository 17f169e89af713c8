//! Maps of `[0, 1]` onto itself that flatten an end where an integrand is singular.
//!
//! Where the integrand behaves as a power `beta` of the distance from the start, `t = I_s(p, q)` (the regularised
//! incomplete beta function) gives `t ~ s^p` there, and the integrand times `dt/ds` becomes `s^(p (beta + 1) - 1)`: smooth
//! enough for a rule of order `m` when `p (beta + 1) >= m`, and analytic when `p beta` is a whole number. The same holds at
//! the end with `q`. A larger `p` than needed crowds the middle.
//!
//! Source: Davis and Rabinowitz (1984), Methods of Numerical Integration, section 2.12; Sidi (1993), A new variable
//! transformation for numerical integration.

/// Largest power that is tried to make exponents whole.
const LARGEST_WHOLE: u32 = 10;
/// `p (beta + 1)` where no power makes the exponents whole: a Gauss rule of `N` nodes then errs as `N^(-2 * 5)` at worst.
const GENERAL: f64 = 5.0;
/// Largest such power.
const LARGEST_GENERAL: u32 = 14;

/// How a panel is graded towards its ends; one means not at all.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Grading {
    /// `p`
    pub(crate) start: u32,
    /// `q`
    pub(crate) end: u32,
}

impl Grading {
    /// No grading.
    pub(crate) const NONE: Self = Self { start: 1, end: 1 };

    /// Graded at both ends alike where only one needs it: with `q = 1` the nodes would be `p` times sparser at that end.
    pub(crate) fn balanced(self) -> Self {
        match (self.start, self.end) {
            (1, power) | (power, 1) => Self {
                start: power,
                end: power,
            },
            _ => self,
        }
    }

    /// Distance of `s` from the nearer end of `[0, 1]` after mapping, the slope of the map, and whether that end is the
    /// start.
    pub(crate) fn distance(self, s: f64) -> (f64, f64, bool) {
        let from_start = s <= 0.5;
        let (p, q, s) = if from_start {
            (self.start, self.end, s)
        } else {
            (self.end, self.start, 1.0 - s)
        };
        let (distance, slope) = if p == 1 && q == 1 {
            (s, 1.0)
        } else {
            beta(p, q, s)
        };
        (distance, slope, from_start)
    }

    /// Largest slope of the map, about: where the nodes are sparsest.
    pub(crate) fn stretch(self) -> f64 {
        let (p, q) = (f64::from(self.start), f64::from(self.end));
        if p + q <= 2.0 {
            return 1.0;
        }
        let peak = (p - 1.0) / (p + q - 2.0);
        let (_, slope, _) = self.distance(peak);
        slope
    }
}

/// The power that makes an end with these exponents analytic, or else smooth enough: one if all are whole already. The flag
/// says that a logarithm comes with the power.
pub(crate) fn power_for(exponents: &(impl Iterator<Item = (f64, bool)> + Clone)) -> u32 {
    let singular =
        |(exponent, logarithm): (f64, bool)| logarithm || exponent < 0.0 || exponent.fract() != 0.0;
    if !exponents.clone().any(singular) {
        return 1;
    }
    let lowest = exponents
        .clone()
        .filter(|&term| singular(term))
        .fold(f64::INFINITY, |m, (exponent, _)| m.min(exponent));
    let general = (GENERAL / (lowest + 1.0).max(0.1)).ceil() as u32;
    let general = general.clamp(2, LARGEST_GENERAL);
    let whole = |p: u32| {
        exponents.clone().all(|(exponent, logarithm)| {
            let scaled = f64::from(p) * exponent;
            !logarithm && (scaled - scaled.round()).abs() < 1e-9 && scaled + f64::from(p) >= 1.0
        })
    };
    (2..=LARGEST_WHOLE.min(general))
        .find(|&p| whole(p))
        .unwrap_or(general)
}

/// `I_s(p, q)` and its derivative: with `n = p + q - 1`,
/// `I = sum over j from p to n of (n choose j) s^j (1 - s)^(n - j)`, a sum of positive terms.
fn beta(p: u32, q: u32, s: f64) -> (f64, f64) {
    let n = p + q - 1;
    let rest = 1.0 - s;
    // (n choose p), and from it the other terms.
    let choose = (0..p).fold(1.0, |product, i| {
        product * f64::from(n - i) / f64::from(i + 1)
    });
    let mut term = choose * s.powi(p as i32) * rest.powi((q - 1) as i32);
    let slope = f64::from(p) * choose * s.powi(p as i32 - 1) * rest.powi(q as i32 - 1);
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
        for start in 1..=LARGEST_WHOLE {
            for end in 1..=LARGEST_WHOLE {
                let grading = Grading { start, end };
                let at = |s: f64| {
                    let (distance, slope, from_start) = grading.distance(s);
                    (if from_start { distance } else { 1.0 - distance }, slope)
                };
                assert!(at(0.0).0.abs() < 1e-14);
                assert!((at(1.0).0 - 1.0).abs() < 1e-14);
                for s in [0.1, 0.3, 0.5, 0.7, 0.9] {
                    let h = 1e-5;
                    let difference = (at(s + h).0 - at(s - h).0) / (2.0 * h);
                    let slope = at(s).1;
                    assert!(
                        (difference - slope).abs() < 1e-7 * slope.max(1e-3),
                        "{grading:?} {s}"
                    );
                }
            }
        }
    }

    #[test]
    fn powers_make_exponents_whole() {
        let power = |exponents: &[f64]| power_for(&exponents.iter().map(|e| (*e, false)));
        assert_eq!(power(&[1.0, 2.0, 0.0]), 1);
        assert_eq!(power(&[1.5, 0.5, 1.0]), 2);
        assert_eq!(power(&[0.6, -0.4]), 5);
        assert_eq!(power(&[1.0 / 3.0, -2.0 / 3.0]), 3);
        assert_eq!(power(&[0.31, -0.69]), 14);
        assert_eq!(power(&[2.37, 1.37]), 3);
        assert_eq!(power_for(&[(1.5, true)].into_iter()), 2);
        assert_eq!(power(&[]), 1);
    }
}
