//! The variable of a graded stretch.
//!
//! ```text
//! psi = int_0^t v^(p - 1) (1 - v)^(q - 1) dv / B(p, q),    t = (1 + y) / 2                                     (1)
//! ```
//!
//! With whole `p` and `q` that is a polynomial: `t^p` times one of degree `q - 1`, and from the other end likewise.
//!
//! Source: Abramowitz and Stegun (1964), Handbook of Mathematical Functions, equation 26.5.1 (incomplete beta function).

/// The largest power of (1), and that of fewer nodes than so many: what is smooth in time is of a higher degree in `y`, which takes more of them, and a
/// higher power only pays where the ends are what is left.
pub(in crate::contact_equation) const STEEPEST: usize = 3;
const STEEPEST_OF_FEW: usize = 2;
const MANY: usize = 16;
/// Steps of Newton's method at most. Near an end, where the root is of order `p`, each leaves `1 - 1 / p` of the error.
const STEPS: usize = 60;

/// (1)
#[derive(Debug, Clone, Copy)]
pub(super) struct Grading {
    powers: [usize; 2],
    /// Of the polynomials from both ends.
    coefficients: [[f64; STEEPEST]; 2],
    /// `1 / B(p, q)`
    unit: f64,
}

/// The power that so many nodes have at an end that asks for this one.
pub(super) fn power_with(nodes: usize, asked: usize) -> usize {
    let most = if nodes < MANY {
        STEEPEST_OF_FEW
    } else {
        STEEPEST
    };
    asked.clamp(1, most)
}

impl Grading {
    pub(in crate::contact_equation) fn new(powers: [usize; 2]) -> Self {
        let [p, q] = powers;
        let factorial = |n: usize| (1..=n).map(|k| k as f64).product::<f64>();
        let unit = factorial(p + q - 1) / (factorial(p - 1) * factorial(q - 1));
        let from = |p: usize, q: usize| {
            let mut coefficients = [0.0; STEEPEST];
            let mut binomial = unit;
            for (k, coefficient) in coefficients.iter_mut().enumerate().take(q) {
                *coefficient = binomial / (p + k) as f64;
                binomial *= -((q - 1 - k) as f64) / (k + 1) as f64;
            }
            coefficients
        };
        Self {
            powers,
            coefficients: [from(p, q), from(q, p)],
            unit,
        }
    }

    /// (1), from the nearer end.
    pub(in crate::contact_equation) fn psi(&self, y: f64) -> f64 {
        let side = usize::from(y > 0.0);
        let t = 0.5 * (1.0 - y.abs());
        let polynomial = self.coefficients[side].iter().rev();
        let value = polynomial.fold(0.0, |sum, c| sum * t + c) * power(t, self.powers[side]);
        if side == 0 { value } else { 1.0 - value }
    }

    /// `d psi / dy`
    pub(in crate::contact_equation) fn slope(&self, y: f64) -> f64 {
        let (t, s) = (0.5 * (1.0 + y), 0.5 * (1.0 - y));
        let [p, q] = self.powers;
        0.5 * self.unit * power(t, p - 1) * power(s, q - 1)
    }

    /// The inverse as the power at the nearer end has it.
    fn guess(&self, psi: f64) -> f64 {
        let side = usize::from(psi > 0.5);
        let way = if side == 0 { psi } else { 1.0 - psi };
        let part = way / self.coefficients[side][0];
        let t = match self.powers[side] {
            1 => part,
            2 => part.sqrt(),
            _ => part.cbrt(),
        };
        let t = t.min(0.5);
        if side == 0 {
            2.0 * t - 1.0
        } else {
            1.0 - 2.0 * t
        }
    }

    /// By Newton's method between bounds.
    pub(in crate::contact_equation) fn inverse(&self, psi: f64) -> f64 {
        if self.powers == [1, 1] {
            return 2.0 * psi - 1.0;
        }
        let psi = psi.clamp(0.0, 1.0);
        let (mut below, mut above) = (-1.0, 1.0);
        let mut y = self.guess(psi);
        for _ in 0..STEPS {
            let excess = self.psi(y) - psi;
            if excess == 0.0 {
                break;
            }
            if excess > 0.0 {
                above = y;
            } else {
                below = y;
            }
            let next = y - excess / self.slope(y);
            let next = if next > below && next < above {
                next
            } else {
                0.5 * (below + above)
            };
            if (next - y).abs() <= f64::EPSILON {
                return next;
            }
            y = next;
        }
        y
    }
}

fn power(x: f64, exponent: usize) -> f64 {
    (0..exponent).fold(1.0, |product, _| product * x)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Of `3 t^2 - 2 t^3` and `10 t^3 - 15 t^4 + 6 t^5`.
    #[test]
    fn the_map_is_the_incomplete_beta_function() {
        for y in [-1.0_f64, -0.9, -0.1, 0.0, 0.3, 0.99, 1.0] {
            let t = 0.5 * (1.0 + y);
            let exact = t * t * (3.0 - 2.0 * t);
            assert!((Grading::new([2, 2]).psi(y) - exact).abs() < 1e-15);
            let exact = t * t * t * (10.0 - 15.0 * t + 6.0 * t * t);
            assert!((Grading::new([3, 3]).psi(y) - exact).abs() < 1e-14);
        }
    }

    #[test]
    fn the_inverse_leads_back() {
        for p in 1..=STEEPEST {
            for q in 1..=STEEPEST {
                let grading = Grading::new([p, q]);
                for y in [-0.999, -0.6, 1e-9, 0.2, 0.95] {
                    let psi = grading.psi(y);
                    let back = grading.inverse(psi);
                    let known = f64::EPSILON * (1.0 + psi / grading.slope(y));
                    assert!((back - y).abs() < 10.0 * known, "{p} {q} {y} {back}");
                }
            }
        }
    }
}
