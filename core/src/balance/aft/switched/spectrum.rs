//! How many nodes a part of a panel needs, told by the highest Legendre coefficients at hand.
//!
//! Between its ends the graded integrand is the product of the law and of a harmonic. A Gauss rule of `N` nodes is exact to
//! degree `2 N - 1`. The harmonic `k` of a part of width `w` takes about `k w / 2` degrees and leaves the others to the law,
//! whose coefficients fall as `e^(-b n)` with the degree `n`. That of degree `2 N - k w / 2` has fallen to the error `d` aimed
//! at if
//!
//! ```text
//! N >= ( k w / 2 + ln(1 / d) / b ) / 2                                                                        (1)
//! ```
//!
//! A part that would need more nodes than there are is halved. Its singularities are then twice as far away, so that
//! coefficients that are small already fall by orders. If they do not fall, they are rounding: the force on a short contact
//! is a small difference of large numbers, and no number of nodes makes it smoother.
//!
//! Source: Trefethen (2008), Is Gauss quadrature better than Clenshaw-Curtis?, sections 2 and 7 (exactness and degrees);
//! Trefethen (2013), Approximation Theory and Approximation Practice, chapter 8 (decay of coefficients).

use crate::numeric::fourier::gauss;

/// Size of a coefficient, in parts of the largest value, below which it is rounding if it does not fall where the part is halved.
const SMALL: f64 = 1e-6;
/// Noise weighs half as much in a part half as wide, a power `p` of the distance from somewhere inside `2^-p` times that.
const FALLEN: f64 = 0.36;

/// One quantity on a part of a panel; sizes are in proportion to an integral over the part.
#[derive(Debug, Clone, Copy)]
pub(super) struct Spectrum {
    /// The largest of the highest coefficients.
    highest: f64,
    /// The largest value there.
    here: f64,
    /// The largest value, there or on the parts that it is a part of.
    size: f64,
    /// Their degree.
    degree: f64,
}

impl Spectrum {
    /// Of what has not been looked at.
    pub(super) const UNKNOWN: Self = Self {
        highest: f64::INFINITY,
        here: 0.0,
        size: 0.0,
        degree: 0.0,
    };

    /// Of values at the nodes of a rule times the slopes of its map, on a part of a width.
    pub(super) fn of(
        values: &[f64],
        slopes: &[f64],
        rule: &gauss::Rule,
        width: f64,
        parent: Self,
    ) -> Self {
        let mut largest = 0.0_f64;
        let mut sums = [0.0; gauss::CHECKED];
        for (j, (value, slope)) in values.iter().zip(slopes).enumerate() {
            let graded = value * slope;
            largest = largest.max(graded.abs());
            for (sum, coefficients) in sums.iter_mut().zip(&rule.highest) {
                *sum += coefficients[j] * graded;
            }
        }
        let highest = sums.iter().fold(0.0_f64, |m, sum| m.max(sum.abs()));
        Self {
            highest: width * highest,
            here: width * largest,
            size: parent.size.max(width * largest),
            degree: rule.nodes.len() as f64 - 2.0,
        }
    }

    /// The number of nodes by (1); `degrees` are those that the harmonics take. Infinite where the coefficients do not fall at
    /// all. Values that are not finite need no more nodes.
    pub(super) fn nodes(self, parent: Self, degrees: f64, error: f64) -> f64 {
        let part = self.highest / self.size;
        if part == 0.0 || !part.is_finite() || self.is_rounding(parent) {
            return 0.0;
        }
        let fall = -part.ln() / self.degree;
        if fall > 0.0 {
            0.5 * (degrees - error.ln() / fall)
        } else if part <= error {
            0.5 * degrees
        } else {
            f64::INFINITY
        }
    }

    /// A rounding of the values, in parts of the largest here, as one of all.
    pub(super) fn rounding(self, rounding: f64) -> f64 {
        rounding * self.here / self.size
    }

    /// Whether coefficients that were small before the part was halved have not fallen since, compared at one degree.
    fn is_rounding(self, parent: Self) -> bool {
        let before = parent.highest / parent.size;
        let at_degree = parent.size * before.powf(self.degree / parent.degree);
        before < SMALL && self.highest > FALLEN * at_degree
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn on(count: usize, width: f64, parent: Spectrum, f: impl Fn(f64) -> f64) -> Spectrum {
        let rule = gauss::rule(count);
        let values: Vec<f64> = rule.nodes.iter().map(|s| f(width * s)).collect();
        Spectrum::of(&values, &vec![1.0; values.len()], rule, width, parent)
    }

    /// `1 / (x + d)` on `[0, 1]`: coefficients fall with `z + sqrt(z^2 - 1)`, `z = 1 + 2 d` (Trefethen, theorem 8.1).
    #[test]
    fn nodes_follow_the_nearest_singularity() {
        for distance in [0.1_f64, 0.3, 1.0] {
            let z = 1.0 + 2.0 * distance;
            let fall = (z + (z * z - 1.0).sqrt()).ln();
            let expected = 0.5 * (10.0 + 1e12_f64.ln() / fall);
            let found = on(16, 1.0, Spectrum::UNKNOWN, |x| 1.0 / (x + distance));
            let nodes = found.nodes(Spectrum::UNKNOWN, 10.0, 1e-12);
            assert!((nodes / expected - 1.0).abs() < 0.2, "{nodes} {expected}");
        }
    }

    #[test]
    fn what_halving_does_not_mend_is_rounding() {
        let unknown = Spectrum::UNKNOWN;
        let noisy = |x: f64| x + 3e-7 * (1e9 * x + 1.0).sin();
        let whole = on(24, 1.0, unknown, noisy);
        assert!(whole.nodes(unknown, 0.0, 1e-15) > 24.0);
        let half = on(24, 0.5, whole, noisy);
        assert_eq!(half.nodes(whole, 0.0, 1e-15), 0.0);
        let smooth = |x: f64| 1.0 / (x + 0.2);
        let whole = on(12, 1.0, unknown, smooth);
        let half = on(12, 0.5, whole, smooth);
        assert!(half.nodes(whole, 0.0, 1e-15) > 12.0);
    }

    /// The highest coefficients of noise are up to some ten times as large as that.
    #[test]
    fn what_is_smaller_than_rounding_needs_no_more() {
        let unknown = Spectrum::UNKNOWN;
        for size in [1e-6, 0.01, 3.0] {
            let noise = |x: f64| size * (1e9 * x + 1.0).sin();
            let found = on(24, 0.5, unknown, |x| 1.0 + noise(x));
            assert!(found.nodes(unknown, 10.0, 1e-15) > 24.0, "{size}");
            let error = found.rounding(10.0 * size);
            assert!(found.nodes(unknown, 10.0, error) <= 24.0, "{size}");
        }
    }

    #[test]
    fn what_is_not_finite_needs_no_more() {
        let unknown = Spectrum::UNKNOWN;
        for value in [f64::NAN, f64::INFINITY, 0.0] {
            let found = on(12, 1.0, unknown, |_| value);
            assert_eq!(found.nodes(unknown, 0.0, 1e-15), 0.0);
        }
        let rough = on(12, 1.0, unknown, |x| (1e3 * x).sin());
        assert!(rough.nodes(unknown, 0.0, 1e-15) > 128.0);
    }
}
