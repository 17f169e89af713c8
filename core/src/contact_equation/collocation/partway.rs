//! What the forces of a stretch have done to two states at a place between targets.
//!
//! ```text
//! X(t + h) = e^(A h) X(t) + s sum_q w_q e^(A d_q s) f_q                                                       (1)
//! ```
//!
//! which is (1) of [`integrals`](crate::contact_equation::equations::integrals) with a rule that ends where it is asked to. The force is a polynomial in either case; what
//! it does to a fast pair of states is none, and rings between the targets.

use crate::contact_equation::linear_part::block::{Block, Pair, times};

/// A rule from a target to a place before the next one.
#[derive(Debug, Default)]
pub(in crate::contact_equation) struct Partway {
    /// The target, if it is not the beginning.
    pub(in crate::contact_equation) done: Option<usize>,
    /// The way from there, as a part of the stretch.
    pub(in crate::contact_equation) left: f64,
    /// What is left to the place, and the weight, of every point.
    pub(in crate::contact_equation) points: Vec<[f64; 2]>,
    /// Every polynomial there, point by point.
    pub(in crate::contact_equation) values: Vec<f64>,
}

impl Partway {
    /// What forces have done to two states, with what is known of it at the target.
    pub(in crate::contact_equation) fn carry(
        &self,
        block: &Block,
        whole: f64,
        known: Pair,
        load: [&[f64]; 2],
    ) -> Pair {
        let mut states = times(block.exponential(self.left * whole), known);
        let rows = self.values.chunks_exact(load[0].len());
        for ([left, weight], row) in self.points.iter().zip(rows) {
            let force = load.map(|load| row.iter().zip(load).map(|(l, f)| l * f).sum::<f64>());
            let carried = block.carried(block.kernel(left * whole), force);
            for i in 0..2 {
                states[i] += weight * whole * carried[i];
            }
        }
        states
    }
}

#[cfg(test)]
mod tests {
    use super::super::nodes::Nodes;
    use super::*;

    /// `x'' + w^2 x = t^2` from rest is `(t^2 - 2/w^2)/w^2 + (2/w^4) cos w t`.
    #[test]
    fn what_rings_between_targets_is_followed() {
        let (whole, w) = (1.7, 23.0);
        let block = Block::new([[0.0, 1.0], [-w * w, 0.0]]);
        let exact = |t: f64| {
            let (sine, cosine) = (w * t).sin_cos();
            [
                (t * t - 2.0 / (w * w)) / (w * w) + 2.0 * cosine / w.powi(4),
                2.0 * t / (w * w) - 2.0 * sine / w.powi(3),
            ]
        };
        for grading in [[1, 1], [3, 1], [2, 2]] {
            let nodes = Nodes::of(16, grading);
            // Where a force is graded at an end, few nodes follow nothing that turns.
            assert_eq!(Nodes::of(8, grading).follows(0.5), grading == [1, 1]);
            assert!(!nodes.follows(w * whole));
            let n = nodes.count();
            let zeros = vec![0.0; n];
            let forces = nodes.targets[..n].iter();
            let forces: Vec<f64> = forces.map(|psi| (psi * whole).powi(2)).collect();
            let mut rule = Partway::default();
            for psi in [0.0, 1e-4, 0.1, 0.37, 0.5, 0.93, 1.0] {
                nodes.partway(psi, w * whole, &mut rule);
                let known = rule
                    .done
                    .map_or([0.0; 2], |target| exact(nodes.targets[target] * whole));
                let found = rule.carry(&block, whole, known, [&zeros, &forces]);
                let exact = exact(psi * whole);
                assert!((found[0] - exact[0]).abs() < 1e-15, "{grading:?} {psi}");
                assert!((found[1] - exact[1]).abs() < 1e-13, "{grading:?} {psi}");
            }
        }
    }
}
