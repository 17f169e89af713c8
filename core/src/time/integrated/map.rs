//! Steps that are graded towards a level.
//!
//! Near the instant `t_c` at which a gap reaches a level, a force with a broken power `beta` of the distance is a power of
//! `t - t_c`. On a step of length `T` that begins or ends there,
//!
//! ```text
//! t = t_0 + T m(u),    m(u) = u^p  (begins),    m(u) = 1 - (1 - u)^p  (ends)                                    (1)
//! ```
//!
//! with `p beta` a whole number make the acceleration `a` analytic in `u`. It is the polynomial through its values at the
//! nodes, with Lagrange's polynomials `l_k`, and rates and positions at the nodes are
//!
//! ```text
//! v_j = v_0 + T sum_k a_k int_0^(u_j) l_k dm                                                                    (2)
//! q_j = q_0 + T m_j v_0 + T^2 sum_k a_k int_0^(u_j) l_k (m_j - m) dm                                            (3)
//! q_end - q_j = T (1 - m_j) v_0 + T^2 sum_k a_k ( (1 - m_j) int_0^(u_j) l_k dm + int_(u_j)^1 l_k (1 - m) dm )   (4)
//! ```
//!
//! so that a gap is known to a relative accuracy beside the level from which it is measured. The derivatives of `a` are
//! less smooth than `a` by a power of the distance: for these `a m'` is taken as the polynomial, with `A D` and `A D A D`
//! in place of (2) and (3), where `A` is the collocation matrix and `D = diag m'`; so it is for both without grading.
//!
//! Source: Hairer, Lubich and Wanner (2006), Geometric Numerical Integration, section II.1.4 (collocation); Davis and
//! Rabinowitz (1984), Methods of Numerical Integration, sections 2.5.6 (product integration) and 2.12 (maps).

use std::sync::Arc;

use crate::numeric::fourier::gauss;

use super::kept::kept;
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
            Self::ToEnd(_) => 1.0 - self.left(1.0 - u),
        }
    }

    /// `1 - m` at the distance `rest` from the end.
    fn left(self, rest: f64) -> f64 {
        match self {
            Self::FromStart(_) => 1.0 - self.place(1.0 - rest),
            Self::ToEnd(p) => rest.powi(p as i32),
        }
    }

    /// `m'` at `u`, with `rest = 1 - u`.
    fn slope(self, u: f64, rest: f64) -> f64 {
        let (p, distance) = match self {
            Self::FromStart(p) => (p, u),
            Self::ToEnd(p) => (p, rest),
        };
        f64::from(p) * distance.powi(p as i32 - 1)
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
    /// The factors of `a_k` in (2), (3) and (4).
    pub(super) rate: [[f64; S]; S],
    pub(super) position: [[f64; S]; S],
    pub(super) position_left: [[f64; S]; S],
    /// Those of (2) and (3) at the end.
    pub(super) end_rate: [f64; S],
    pub(super) end_position: [f64; S],
    /// `A D` and `A D A D`.
    pub(super) weak_rate: [[f64; S]; S],
    pub(super) weak_position: [[f64; S]; S],
    /// Weights of the highest Legendre coefficients of `a`.
    pub(super) highest: [[f64; S]; HIGHEST],
    /// Weights of the highest Legendre coefficients of `a m'`.
    pub(super) weak_highest: [[f64; S]; HIGHEST],
}

impl<const S: usize> Tables<S> {
    /// Those of a map, as they were made before.
    pub(super) fn kept(rule: &Rule<S>, map: Map) -> Arc<Self> {
        kept(map, || Self::new(rule, map))
    }

    pub(super) fn new(rule: &Rule<S>, map: Map) -> Self {
        let u = rule.nodes;
        // 1 - u_j is a node too.
        let rest: [f64; S] = std::array::from_fn(|j| u[S - 1 - j]);
        let plain = map.power() == 1;
        let passed = if plain { u } else { u.map(|u| map.place(u)) };
        let left = if plain {
            rest
        } else {
            rest.map(|u| map.left(u))
        };
        let slope: [f64; S] = std::array::from_fn(|j| map.slope(u[j], rest[j]));
        let scaled = |matrix: &[[f64; S]; S]| -> [[f64; S]; S] {
            std::array::from_fn(|k| matrix[k].map(|x| x * slope[k]))
        };
        let weak_rate = scaled(&rule.before);
        let end_rate: [f64; S] = std::array::from_fn(|k| rule.weights[k] * slope[k]);
        let mut tables = Self {
            map,
            passed,
            left,
            rate: [[0.0; S]; S],
            position: [[0.0; S]; S],
            position_left: [[0.0; S]; S],
            end_position: std::array::from_fn(|k| {
                (0..S).map(|l| end_rate[l] * weak_rate[k][l]).sum()
            }),
            end_rate,
            weak_position: product(&weak_rate, &weak_rate),
            weak_rate,
            highest: rule.highest,
            weak_highest: rule
                .highest
                .map(|weights| std::array::from_fn(|k| weights[k] * slope[k])),
        };
        if plain {
            tables.rate = rule.before;
            tables.position = tables.weak_position;
            tables.position_left = product(&rule.after, &rule.before);
        } else {
            tables.integrate(rule);
        }
        tables
    }

    /// The integrals of (2) to (4), by a rule that is exact for them.
    fn integrate(&mut self, rule: &Rule<S>) {
        let fine = gauss::rule(S + self.map.power() as usize);
        let mut lagrange = [0.0; S];
        for j in 0..S {
            let (end, passed, left) = (rule.nodes[j], self.passed[j], self.left[j]);
            let rest = 1.0 - end;
            for (node, weight) in fine.nodes.iter().zip(&fine.weights) {
                rule.lagrange(end * node, &mut lagrange);
                let dm = weight * end * self.map.slope(end * node, 1.0 - end * node);
                let to_node = match self.map {
                    Map::FromStart(_) => passed - self.map.place(end * node),
                    Map::ToEnd(_) => self.map.left(1.0 - end * node) - left,
                };
                for k in 0..S {
                    self.rate[k][j] += dm * lagrange[k];
                    self.position[k][j] += dm * to_node * lagrange[k];
                }
                // From the node to the end, measured from the end.
                let away = rest * node;
                rule.lagrange(1.0 - away, &mut lagrange);
                let dm = weight * rest * self.map.slope(1.0 - away, away);
                let to_end = match self.map {
                    Map::FromStart(_) => 1.0 - self.map.place(1.0 - away),
                    Map::ToEnd(_) => self.map.left(away),
                };
                for k in 0..S {
                    self.position_left[k][j] += dm * to_end * lagrange[k];
                }
            }
            for k in 0..S {
                self.position_left[k][j] += left * self.rate[k][j];
            }
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

    /// `a = t^(1/2)` from the start, `a = (1 - t)^(1/2)` towards the end: exact with the power two, and beside the end at
    /// which the map is flat to a relative accuracy.
    #[test]
    fn broken_powers_are_integrated_exactly() {
        let rule = Rule::<8>::new();
        let start = Tables::new(&rule, Map::FromStart(2));
        let end = Tables::new(&rule, Map::ToEnd(2));
        let sum = |matrix: &[[f64; 8]; 8], j: usize, t: &[f64; 8]| -> f64 {
            (0..8).map(|k| matrix[k][j] * t[k].sqrt()).sum()
        };
        for j in 0..8 {
            let t = start.passed[j];
            let exact = 4.0 / 15.0 * t.powf(2.5);
            assert!((sum(&start.position, j, &start.passed) - exact).abs() < 1e-13 * t);
            assert!((sum(&start.weak_position, j, &start.passed) - exact).abs() < 1e-15);
            let exact = 2.0 / 3.0 * t.powf(1.5);
            assert!((sum(&start.rate, j, &start.passed) - exact).abs() < 1e-13 * t);
            let s = end.left[j];
            let exact = 2.0 / 3.0 * (1.0 - s.powf(1.5));
            assert!((sum(&end.rate, j, &end.left) - exact).abs() < 1e-15);
            assert!((sum(&end.weak_rate, j, &end.left) - exact).abs() < 1e-15);
            // q_end - q_j = 2/3 s - 2/3 (2/5) s^(5/2)
            let exact = 2.0 / 3.0 * (s - 0.4 * s.powf(2.5));
            assert!((sum(&end.position_left, j, &end.left) - exact).abs() < 1e-14 * s);
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
