//! An interval whose states are asked for at hundreds of phases, as outputs are read off: with many modes what takes the time is to go over from
//! states of these to positions and velocities.

use std::cell::RefCell;

use crate::contact_equation::collocation::nodes::Nodes;
use crate::contact_equation::linear_part::block::Block;
use crate::contact_equation::linear_part::values::Values;
use crate::contact_equation::orbit::motion::Within;
use crate::shooting::signals::at_nodes::AtNodes;
use crate::time::Stretch;

/// An interval, and room for the states of its modes.
pub(in crate::contact_equation) struct Read<'m, 'e> {
    within: Within<'m, 'e>,
    states: RefCell<Vec<f64>>,
}

impl<'m, 'e> Read<'m, 'e> {
    pub(in crate::contact_equation) fn new(within: Within<'m, 'e>) -> Self {
        let states = vec![0.0; within.motion.equations.skeleton.order];
        Self {
            within,
            states: states.into(),
        }
    }
}

impl Stretch for Read<'_, '_> {
    fn phases(&self) -> (f64, f64) {
        self.within.phases()
    }

    fn state(&self, phase: f64, state: &mut [f64]) {
        let Within { motion, interval } = self.within;
        let states = &mut *self.states.borrow_mut();
        motion.states(interval, phase, states);
        let linear = &motion.equations.values.linear;
        linear.write_physical(states, state);
    }
}

/// Last coefficients of signals, in parts of their largest value, up to which their nodes tell all of an integral: where nothing turns by more radians than
/// half of the nodes, so that what follows is ever smaller; and where it may ring between them, which then is noise.
const SLOW: f64 = 1e-6;
const FAST: f64 = 1e-7;

/// An interval with forces at nodes, which has its states there.
pub(in crate::contact_equation) struct ReadAtNodes<'m, 'e> {
    read: Read<'m, 'e>,
    nodes: &'static Nodes,
    /// Last coefficients up to which a signal is known, in parts of its largest value.
    least: f64,
}

impl<'m, 'e> ReadAtNodes<'m, 'e> {
    /// Nothing where no force is unknown.
    pub(in crate::contact_equation) fn new(within: Within<'m, 'e>) -> Option<Self> {
        let Within { motion, interval } = within;
        let of = &motion.equations.skeleton.intervals[interval];
        let Values { base, linear, .. } = &motion.equations.values;
        let [from, to] = motion.phases(interval);
        let fastest = linear.blocks.iter().map(Block::rate).fold(0.0, f64::max);
        let is_slow = fastest * (to - from) / base <= 0.5 * of.nodes.count() as f64;
        (!of.active.is_empty()).then(|| Self {
            read: Read::new(within),
            nodes: of.nodes,
            least: if is_slow { SLOW } else { FAST },
        })
    }
}

impl Stretch for ReadAtNodes<'_, '_> {
    fn phases(&self) -> (f64, f64) {
        self.read.phases()
    }

    fn state(&self, phase: f64, state: &mut [f64]) {
        self.read.state(phase, state);
    }
}

impl AtNodes for ReadAtNodes<'_, '_> {
    fn count(&self) -> usize {
        self.nodes.count()
    }

    fn node(&self, node: usize) -> [f64; 2] {
        let (from, to) = self.phases();
        let psi = self.nodes.targets[node];
        [
            from + psi * (to - from),
            self.nodes.weights()[node] * (to - from),
        ]
    }

    fn state_at(&self, node: usize, state: &mut [f64]) {
        let Within { motion, interval } = self.read.within;
        let (_, states) = motion.at_node(interval, node);
        let linear = &motion.equations.values.linear;
        linear.write_physical(states, state);
    }

    fn is_known(&self, values: &[f64]) -> bool {
        let largest = values.iter().fold(0.0, |most: f64, x| most.max(x.abs()));
        self.nodes.tail(values) <= self.least * largest
    }
}
