//! An interval whose states are asked for at hundreds of phases, as outputs are read off: with many modes what takes the time is to go over from
//! states of these to positions and velocities.

use std::cell::RefCell;

use crate::contact_equation::collocation::nodes::Nodes;
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

/// An interval with forces at nodes, which has its states there.
pub(in crate::contact_equation) struct ReadAtNodes<'m, 'e> {
    read: Read<'m, 'e>,
    nodes: &'static Nodes,
}

impl<'m, 'e> ReadAtNodes<'m, 'e> {
    /// Nothing where no force is unknown.
    pub(in crate::contact_equation) fn new(within: Within<'m, 'e>) -> Option<Self> {
        let Within { motion, interval } = within;
        let of = &motion.equations.skeleton.intervals[interval];
        (!of.active.is_empty()).then(|| Self {
            read: Read::new(within),
            nodes: of.nodes,
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

    fn last(&self, values: &[f64]) -> f64 {
        self.nodes.tail(values)
    }
}
