//! Maps of `[0, 1]` onto itself that flatten an end where an integrand is singular.
//!
//! Where the integrand behaves as a power of the distance from an end, `t = I_s(p, p)` (the regularised incomplete beta
//! function, a polynomial for integer `p`) gives `t ~ s^p` there, and `s^(p (alpha + 1) - 1)` for the power `alpha` times
//! `dt/ds`: smooth enough for a high-order rule. Source: Sidi (1993), A new variable transformation for numerical
//! integration; Davis and Rabinowitz (1984), Methods of Numerical Integration, section 2.12. Here `p = 6`.

/// Which ends are graded.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Grading {
    None,
    Both,
    Start,
    End,
}

/// A phase on a panel, and its derivative with respect to `s`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Graded {
    pub(super) tau: f64,
    pub(super) slope: f64,
}

impl Grading {
    pub(super) fn new(start: bool, end: bool) -> Self {
        match (start, end) {
            (false, false) => Self::None,
            (true, true) => Self::Both,
            (true, false) => Self::Start,
            (false, true) => Self::End,
        }
    }

    /// The phase of `s` in `[0, 1]` on the panel from `start` to `end`. It is measured from the nearer end, so that a
    /// small distance from a singular end is not rounded away.
    pub(super) fn map(self, s: f64, start: f64, end: f64) -> Graded {
        let width = end - start;
        let (distance, slope, from_start) = match self {
            Self::None => (s, 1.0, true),
            Self::Start => (s.powi(6), 6.0 * s.powi(5), true),
            Self::End => ((1.0 - s).powi(6), 6.0 * (1.0 - s).powi(5), false),
            Self::Both => {
                let nearer = s.min(1.0 - s);
                (beta(nearer), 2772.0 * (s * (1.0 - s)).powi(5), s <= 0.5)
            }
        };
        let tau = if from_start {
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

/// `I_s(6, 6) = 2772 * integral of s^5 (1 - s)^5`.
fn beta(s: f64) -> f64 {
    let tail = 3465.0 + s * (-3080.0 + s * (1386.0 - 252.0 * s));
    s.powi(6) * (462.0 + s * (-1980.0 + s * tail))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn maps_run_from_end_to_end_with_the_right_slope() {
        for grading in [Grading::None, Grading::Both, Grading::Start, Grading::End] {
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
