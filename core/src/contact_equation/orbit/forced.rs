//! What the forces of an interval have done to the states up to a part of it. Of slow pairs the polynomial through what is known at the targets
//! tells it. Fast ones ring between the targets, and are followed there by (1) of [`partway`](crate::contact_equation::collocation::partway): all of them at once,
//! with the force at each point of its rule. That is one number where one contact acts, times what it does to each state.
//!
//! Source: Berrut and Trefethen (2004), Barycentric Lagrange interpolation, equation (4.2).

use super::motion::Room;
use crate::contact_equation::collocation::nodes::Nodes;
use crate::contact_equation::equations::Equations;
use crate::contact_equation::equations::pass_results::Passed;
use crate::contact_equation::linear_part::block::{Block, Pair};
use crate::contact_equation::linear_part::linear::Linear;
use crate::contact_equation::linear_part::values::pair;

/// At one place of an interval.
pub(super) struct Forced<'e> {
    linear: &'e Linear,
    passed: &'e Passed,
    nodes: &'static Nodes,
    /// The time of the interval.
    whole: f64,
    /// What it does to all states where one contact acts, and the state that it moves most.
    alone: Option<(&'e [f64], usize)>,
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
        let alone = match &of.active[..] {
            [active] if !slow => Some(&values.contacts[active.contact].input),
            _ => None,
        };
        let alone = alone.filter(|input| input.is_constant());
        let alone = alone.and_then(|input| {
            let input = input.constant();
            let size = |state: &usize| input[*state].abs();
            let most = (0..input.len()).max_by(|a, b| size(a).total_cmp(&size(b)))?;
            (input[most] != 0.0).then_some((input, most))
        });
        Self {
            linear: &values.linear,
            passed,
            nodes,
            whole,
            alone,
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

    /// Adds that of all pairs to the states.
    pub(super) fn add(&self, room: &mut Room) {
        let order = room.states.len();
        let blocks = &self.linear.blocks;
        let mut slow = std::mem::take(&mut room.slow);
        slow.clone_from(&room.states);
        let targets = self.passed.forced.chunks_exact(order);
        for (weight, forced) in room.weights.iter().zip(targets) {
            for (state, forced) in slow.iter_mut().zip(forced) {
                *state += weight * forced;
            }
        }
        if self.slow {
            std::mem::swap(&mut room.states, &mut slow);
            room.slow = slow;
            return;
        }
        self.ring(room);
        for (r, block) in blocks.iter().enumerate() {
            for at in 2 * r..2 * r + 2 {
                if self.follows(block) {
                    room.states[at] = slow[at];
                } else {
                    room.states[at] += room.rung[at];
                }
            }
        }
        room.slow = slow;
    }

    /// Leaves in `rung` what forces have done to all pairs, as if they were fast.
    fn ring(&self, room: &mut Room) {
        let order = room.states.len();
        let n = self.nodes.count();
        let blocks = &self.linear.blocks;
        room.rung.clear();
        room.rung.resize(order, 0.0);
        if let Some(target) = room.partway.done {
            let known = &self.passed.forced[target * order..][..order];
            let time = room.partway.left * self.whole;
            self.linear.kernels.find(blocks, time, &mut room.kernels);
            for (r, block) in blocks.iter().enumerate() {
                let carried = block.carried(room.kernels.kernel(r), pair(known, r));
                room.rung[2 * r..2 * r + 2].copy_from_slice(&carried);
            }
        }
        let rows = room.partway.values.chunks_exact(n);
        for ([left, weight], row) in room.partway.points.iter().zip(rows) {
            let at = |state: usize| -> f64 {
                let load = &self.passed.load[state * n..][..n];
                row.iter().zip(load).map(|(l, f)| l * f).sum()
            };
            let alone = self
                .alone
                .map(|(input, most)| (input, at(most) / input[most]));
            let time = left * self.whole;
            self.linear.kernels.find(blocks, time, &mut room.kernels);
            for (r, block) in blocks.iter().enumerate() {
                let force = match alone {
                    Some((input, force)) => pair(input, r).map(|x| x * force),
                    None => [at(2 * r), at(2 * r + 1)],
                };
                let carried = block.carried(room.kernels.kernel(r), force);
                for i in 0..2 {
                    room.rung[2 * r + i] += weight * self.whole * carried[i];
                }
            }
        }
    }
}
