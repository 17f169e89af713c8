//! Steps that are graded towards a level.
//!
//! Near the instant `t_c` at which a gap reaches a level, a force with a broken power `beta` of the distance is a power of
//! `t - t_c`. On a step of length `T` that begins or ends there,
//!
//! ```text
//! t = t_0 + T m(u),    m(u) = u^p  (begins),    m(u) = 1 - (1 - u)^p  (ends)                                    (1)
//! ```
//!
//! with `p beta` a whole number make the motion analytic in `u`. With `v' = a`, `q' = v` and the collocation matrix `A`,
//!
//! ```text
//! v_j = v_0 + T sum_k (A D)_jk a_k,    q_j = q_0 + T m(u_j) v_0 + T^2 sum_k (A D A D)_jk a_k,    D = diag m'      (2)
//! ```
//!
//! Source: Davis and Rabinowitz (1984), Methods of Numerical Integration, section 2.12; Hairer, Lubich and Wanner (2006),
//! Geometric Numerical Integration, section II.1.4 (collocation).

use super::rule::{HIGHEST, Rule};

/// Where a step is graded, and with which power.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Map {
    FromStart(u32),
    ToEnd(u32),
}

impl Map {
    /// No grading.
    pub(super) const PLAIN: Self = Self::FromStart(1);

    /// `p`
    pub(super) fn power(self) -> u32 {
        match self {
            Self::FromStart(p) | Self::ToEnd(p) => p,
        }
    }

    /// `u` of a part of the step that has passed, and of the part that is left.
    pub(super) fn inverse(self, passed: f64, left: f64) -> f64 {
        match self {
            Self::FromStart(1) | Self::ToEnd(1) => passed,
            Self::FromStart(p) => passed.max(0.0).powf(1.0 / f64::from(p)),
            Self::ToEnd(p) => 1.0 - left.max(0.0).powf(1.0 / f64::from(p)),
        }
    }

    /// `m(u)`
    pub(super) fn place(self, u: f64) -> f64 {
        match self {
            Self::FromStart(p) => u.powi(p as i32),
            Self::ToEnd(p) => 1.0 - (1.0 - u).powi(p as i32),
        }
    }
}

/// The collocation matrices of one map; matrices by columns.
#[derive(Debug)]
pub(super) struct Tables<const S: usize> {
    pub(super) map: Map,
    /// `m(u_j)`
    pub(super) passed: [f64; S],
    /// `1 - m(u_j)`, without cancellation.
    pub(super) left: [f64; S],
    /// `A D`
    pub(super) rate: [[f64; S]; S],
    /// `A D A D`
    pub(super) position: [[f64; S]; S],
    /// The same from a node to the end: `q_end - q_j = T (1 - m_j) v_0 + T^2 sum_k (.)_jk a_k`.
    pub(super) position_left: [[f64; S]; S],
    /// The rows of the end.
    pub(super) end_rate: [f64; S],
    pub(super) end_position: [f64; S],
    /// Weights of the highest Legendre coefficients of `a m'`.
    pub(super) highest: [[f64; S]; HIGHEST],
}

impl<const S: usize> Tables<S> {
    pub(super) fn new(rule: &Rule<S>, map: Map) -> Self {
        let u = rule.nodes;
        // 1 - u_j is a node too.
        let rest: [f64; S] = std::array::from_fn(|j| u[S - 1 - j]);
        let power = |u: [f64; S], p: u32| u.map(|u| u.powi(p as i32));
        let (passed, left, slope) = match map {
            Map::FromStart(1) | Map::ToEnd(1) => (u, rest, [1.0; S]),
            Map::FromStart(p) => {
                let passed = power(u, p);
                let slope = power(u, p - 1).map(|x| x * f64::from(p));
                (passed, passed.map(|m| 1.0 - m), slope)
            }
            Map::ToEnd(p) => {
                let left = power(rest, p);
                let slope = power(rest, p - 1).map(|x| x * f64::from(p));
                (left.map(|m| 1.0 - m), left, slope)
            }
        };
        let scaled = |matrix: &[[f64; S]; S]| -> [[f64; S]; S] {
            std::array::from_fn(|k| matrix[k].map(|x| x * slope[k]))
        };
        let rate = scaled(&rule.before);
        let rate_left = scaled(&rule.after);
        let end_rate: [f64; S] = std::array::from_fn(|k| rule.weights[k] * slope[k]);
        Self {
            map,
            passed,
            left,
            position: product(&rate, &rate),
            position_left: product(&rate_left, &rate),
            end_position: std::array::from_fn(|k| (0..S).map(|l| end_rate[l] * rate[k][l]).sum()),
            rate,
            end_rate,
            highest: rule
                .highest
                .map(|weights| std::array::from_fn(|k| weights[k] * slope[k])),
        }
    }
}

/// The product of two matrices stored by columns.
fn product<const S: usize>(left: &[[f64; S]; S], right: &[[f64; S]; S]) -> [[f64; S]; S] {
    std::array::from_fn(|k| std::array::from_fn(|j| (0..S).map(|l| left[l][j] * right[k][l]).sum()))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// `a = t^(1/2)` from the start, `a = (1 - t)^(1/2)` towards the end: exact with the power two.
    #[test]
    fn broken_powers_are_integrated_exactly() {
        let rule = Rule::<8>::new();
        let start = Tables::new(&rule, Map::FromStart(2));
        let end = Tables::new(&rule, Map::ToEnd(2));
        for j in 0..8 {
            let t = start.passed[j];
            let q: f64 = (0..8)
                .map(|k| start.position[k][j] * start.passed[k].sqrt())
                .sum();
            assert!((q - 4.0 / 15.0 * t.powf(2.5)).abs() < 1e-15);
            let s = end.left[j];
            let v: f64 = (0..8).map(|k| end.rate[k][j] * end.left[k].sqrt()).sum();
            assert!((v - 2.0 / 3.0 * (1.0 - s.powf(1.5))).abs() < 1e-15);
            // q_end - q_j = 2/3 s - 2/3 (2/5) s^(5/2)
            let rest: f64 = (0..8)
                .map(|k| end.position_left[k][j] * end.left[k].sqrt())
                .sum();
            assert!((rest - 2.0 / 3.0 * (s - 0.4 * s.powf(2.5))).abs() < 1e-15);
        }
        let total: f64 = (0..8)
            .map(|k| start.end_position[k] * start.passed[k].sqrt())
            .sum();
        assert!((total - 4.0 / 15.0).abs() < 1e-15);
    }

    #[test]
    fn places_are_inverted() {
        for map in [
            Map::PLAIN,
            Map::FromStart(5),
            Map::ToEnd(2),
            Map::FromStart(3),
        ] {
            for u in [0.0, 0.2, 0.9, 1.0] {
                let passed = map.place(u);
                assert!((map.inverse(passed, 1.0 - passed) - u).abs() < 1e-12);
            }
        }
    }
}
