//! An interval whose states are asked for at hundreds of phases, as outputs are read off: with many modes what takes the time is to go over from
//! states of these to positions and velocities.

use std::cell::RefCell;

use crate::contact_equation::orbit::motion::Within;
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
