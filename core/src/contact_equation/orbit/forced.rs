//! What the forces of an interval have done to the states up to a part of it. Of slow pairs the polynomial through what is known at the targets
//! tells it. Fast ones ring between the targets, and are followed there by (1) of [`partway`](crate::contact_equation::collocation::partway): all of them at once,
//! as loops over arrays, with the forces at each point of its rule.
//!
//! Source: Berrut and Trefethen (2004), Barycentric Lagrange interpolation, equation (4.2).

use super::fast::Fast;
use super::motion::Room;
use crate::contact_equation::collocation::nodes::Nodes;
use crate::contact_equation::equations::Equations;
use crate::contact_equation::equations::pass_results::Passed;
use crate::contact_equation::linear_part::block::{Block, Pair, pair};
use crate::contact_equation::linear_part::linear::Linear;

/// At one place of an interval.
pub(super) struct Forced<'e> {
    linear: &'e Linear,
    passed: &'e Passed,
    nodes: &'static Nodes,
    /// The time of the interval.
    whole: f64,
    /// All pairs are slow.
    slow: bool,
}

impl<'e> Forced<'e> {
    /// At a part of an interval; the room has the weights of what is known then.
    pub(super) fn new(
        equations: &'e Equations,
        interval: usize,
        psi: f64,
        room: &mut Room,
    ) -> Self {
        let Equations {
            values,
            skeleton,
            passed,
            ..
        } = equations;
        let (of, passed) = (&skeleton.intervals[interval], &passed[interval]);
        let nodes = of.nodes;
        let whole = (passed.phases[1] - passed.phases[0]) / values.base;
        let blocks = values.linear.blocks.iter();
        let fastest = blocks.map(Block::rate).fold(0.0, f64::max) * whole.abs();
        let slow = nodes.follows(fastest);
        if !slow {
            nodes.partway(psi, fastest, &mut room.partway);
        }
        nodes.through_ends(psi, &mut room.weights);
        Self {
            linear: &values.linear,
            passed,
            nodes,
            whole,
            slow,
        }
    }

    fn follows(&self, block: &Block) -> bool {
        self.slow || self.nodes.follows(block.rate() * self.whole.abs())
    }

    /// Of one pair.
    pub(super) fn of(&self, r: usize, room: &Room) -> Pair {
        if self.passed.forced.is_empty() {
            return [0.0; 2];
        }
        let block = &self.linear.blocks[r];
        let order = 2 * self.linear.blocks.len();
        if self.follows(block) {
            let mut sum = [0.0; 2];
            let targets = self.passed.forced.chunks_exact(order);
            for (weight, forced) in room.weights.iter().zip(targets) {
                for (i, sum) in sum.iter_mut().enumerate() {
                    *sum += weight * forced[2 * r + i];
                }
            }
            return sum;
        }
        let n = self.nodes.count();
        let load = &self.passed.load[2 * r * n..][..2 * n];
        let known = room.partway.done.map_or([0.0; 2], |target| {
            pair(&self.passed.forced[target * order..][..order], r)
        });
        room.partway
            .carry(block, self.whole, known, load.split_at(n).into())
    }

    /// Adds that of all pairs to the states, with those that are too fast.
    pub(super) fn add(&self, fast: &Fast, room: &mut Room) {
        let order = room.states.len();
        room.slow.clone_from(&room.states);
        let targets = self.passed.forced.chunks_exact(order);
        for (weight, forced) in room.weights.iter().zip(targets) {
            for (state, forced) in room.states.iter_mut().zip(forced) {
                *state += weight * forced;
            }
        }
        if self.slow {
            return;
        }
        let Room {
            states,
            slow,
            partway,
            fast: found,
            ..
        } = room;
        fast.follow(self.passed, partway, self.whole, found);
        for (place, &r) in fast.pairs().iter().enumerate() {
            for i in 0..2 {
                let at = 2 * r + i;
                states[at] = slow[at] + found.states[i][place];
            }
        }
    }
}
