//! The motion of an orbit at any phase, by (1) of [`equations`](crate::contact_equation::equations): what forces have done is known at the nodes and the end
//! of an interval, and between these by a polynomial, or, of pairs of states too fast for it, by [`partway`](crate::contact_equation::collocation::partway).
//!
//! Source: Berrut and Trefethen (2004), Barycentric Lagrange interpolation, equation (4.2).

use std::cell::{OnceCell, RefCell};

use super::extremes::{Sampled, extremes_of_coordinates, extremes_of_gaps};
use super::fast::{Fast, FastRoom};
use super::forced::Forced;
use crate::contact_equation::collocation::partway::Partway;
use crate::contact_equation::equations::Equations;
use crate::contact_equation::equations::pass_results::GapExtreme;
use crate::contact_equation::linear_part::block::{Block, pair};
use crate::contact_equation::linear_part::configuration::Configuration;
use crate::contact_equation::linear_part::contact::Contact;
use crate::contact_equation::linear_part::kernels::Found;
use crate::contact_equation::linear_part::linear::{Seen, of_states};
use crate::contact_equation::linear_part::values::Values;
use crate::numeric::roots::Place;
use crate::time;

/// One of so many pairs of states is worth to be followed alone.
const FEW: usize = 4;

/// The motion that the last pass has left.
pub(in crate::contact_equation) struct Motion<'e> {
    pub(in crate::contact_equation) equations: &'e Equations,
    room: RefCell<Room>,
    /// Made when it is asked for.
    sampled: OnceCell<Vec<Sampled>>,
    /// Pairs that are too fast for polynomials, interval by interval.
    fast: Vec<OnceCell<Fast>>,
}

/// Room for one instant.
pub(super) struct Room {
    pub(super) states: Vec<f64>,
    pub(super) weights: Vec<f64>,
    steady: Vec<f64>,
    /// States of a configuration.
    own: Vec<f64>,
    pub(super) partway: Partway,
    pub(super) kernels: Found,
    pub(super) slow: Vec<f64>,
    pub(super) fast: FastRoom,
}

impl<'e> Motion<'e> {
    pub(in crate::contact_equation) fn of(equations: &'e Equations) -> Self {
        let states = || vec![0.0; equations.skeleton.order];
        let room = Room {
            states: states(),
            weights: Vec::new(),
            steady: states(),
            own: states(),
            partway: Partway::default(),
            kernels: Found::default(),
            slow: Vec::new(),
            fast: FastRoom::default(),
        };
        Self {
            equations,
            room: RefCell::new(room),
            sampled: OnceCell::new(),
            fast: equations.passed.iter().map(|_| OnceCell::new()).collect(),
        }
    }

    /// Number of intervals.
    pub(in crate::contact_equation) fn intervals(&self) -> usize {
        self.equations.passed.len()
    }

    /// Where an interval begins and ends.
    pub(in crate::contact_equation) fn phases(&self, interval: usize) -> [f64; 2] {
        self.equations.passed[interval].phases
    }

    /// The states at the beginnings of so many parts of equal length.
    pub(in crate::contact_equation) fn states_of_parts(&self, parts: usize) -> Vec<f64> {
        let skeleton = &self.equations.skeleton;
        let mut states = vec![0.0; skeleton.order * parts];
        let part = skeleton.length / parts as f64;
        for (index, state) in states.chunks_exact_mut(skeleton.order).enumerate() {
            self.at(part * index as f64, state);
        }
        states
    }

    /// Writes positions and velocities at any phase.
    pub(in crate::contact_equation) fn at(&self, phase: f64, state: &mut [f64]) {
        let skeleton = &self.equations.skeleton;
        let (interval, within) = self.interval(phase);
        self.state(interval, within, state);
        let image = &skeleton.recurrence().image;
        if !image.is_identity() {
            let turns = ((phase - within) / skeleton.length).round() as i64;
            let turns = turns.rem_euclid(image.order() as i64) as usize;
            let moved = image.power(turns).of_states(state, state.len() / 2);
            state.copy_from_slice(&moved);
        }
    }

    /// The interval that a phase is in; phases outside of what is followed are shifted into it.
    pub(in crate::contact_equation) fn interval(&self, phase: f64) -> (usize, f64) {
        let (begin, length) = (
            self.equations.skeleton.begin,
            self.equations.skeleton.length,
        );
        let phase = begin + (phase - begin).rem_euclid(length);
        let passed = self.equations.passed.iter();
        let mut found = 0;
        for (index, passed) in passed.enumerate() {
            if passed.phases[0] <= phase && passed.phases[1] > passed.phases[0] {
                found = index;
            }
        }
        (found, phase)
    }

    /// Writes the states within an interval.
    fn write(&self, interval: usize, phase: f64, room: &mut Room) {
        let passed = &self.equations.passed;
        let configuration = self.configuration(interval);
        let values = self.values(interval);
        let passed = &passed[interval];
        let [from, to] = passed.phases;
        let time = (phase - from) / values.base;
        let psi = part([from, to], phase);
        values.write_steady(phase, &mut room.steady, None);
        let linear = &values.linear;
        linear.kernels.find(&linear.blocks, time, &mut room.kernels);
        for (r, block) in linear.blocks.iter().enumerate() {
            let free = block.carried(room.kernels.kernel(r), pair(&passed.free, r));
            for i in 0..2 {
                let at = 2 * r + i;
                room.states[at] = free[i] + room.steady[at];
            }
        }
        if !passed.forced.is_empty() {
            let fast = self.fast[interval].get_or_init(|| Fast::of(self, interval));
            Forced::new(self.equations, interval, psi, room).add(fast, room);
        }
        values.add_resonant(from, time, &mut room.states);
        if let Some(of) = configuration {
            of.give(&room.states, &mut room.own);
            std::mem::swap(&mut room.states, &mut room.own);
        }
    }

    /// The phase of a node of an interval with forces, and the states that the pass has left there: behind those at the beginning.
    pub(in crate::contact_equation) fn at_node(
        &self,
        interval: usize,
        node: usize,
    ) -> (f64, &'e [f64]) {
        let Equations {
            skeleton, passed, ..
        } = self.equations;
        let [from, to] = passed[interval].phases;
        let psi = skeleton.intervals[interval].nodes.targets[node];
        let states = &passed[interval].states[(node + 1) * skeleton.order..][..skeleton.order];
        (from + psi * (to - from), states)
    }

    /// What has the forces of an interval, where they are affine.
    pub(super) fn configuration(&self, interval: usize) -> Option<&'e Configuration> {
        let of = &self.equations.skeleton.intervals[interval];
        of.configuration
            .map(|index| &self.equations.configurations[index])
    }

    /// The linear part on an interval.
    pub(super) fn values(&self, interval: usize) -> &'e Values {
        let own = &self.equations.values;
        self.configuration(interval).map_or(own, |of| &of.values)
    }

    /// Nothing is unknown at nodes and no wave is in resonance: the motion is in closed form.
    pub(in crate::contact_equation) fn is_closed(&self, interval: usize) -> bool {
        self.equations.passed[interval].forced.is_empty() && !self.values(interval).has_resonance()
    }

    /// Forces at nodes make pairs of states ring between these.
    pub(super) fn is_rung(&self, interval: usize) -> bool {
        let Equations {
            values,
            skeleton,
            passed,
            ..
        } = self.equations;
        if passed[interval].forced.is_empty() {
            return false;
        }
        let of = &skeleton.intervals[interval];
        let [from, to] = passed[interval].phases;
        let whole = (to - from) / values.base;
        let blocks = values.linear.blocks.iter();
        let fastest = blocks.map(Block::rate).fold(0.0, f64::max);
        !of.nodes.follows(fastest * whole.abs())
    }

    /// A position and its rate at a phase within an interval, of the pairs that a row sees: where these are few, they alone are followed.
    pub(in crate::contact_equation) fn seen(
        &self,
        row: &[Seen],
        interval: usize,
        phase: f64,
    ) -> [f64; 2] {
        let room = &mut *self.room.borrow_mut();
        let values = self.values(interval);
        let blocks = &values.linear.blocks;
        let alone = FEW * row.len() <= blocks.len() && !values.has_resonance();
        if !alone || self.configuration(interval).is_some() {
            self.write(interval, phase, room);
            return of_states(row, &room.states);
        }
        let passed = &self.equations.passed[interval];
        let [from, to] = passed.phases;
        let time = (phase - from) / values.base;
        let forced = Forced::new(self.equations, interval, part([from, to], phase), room);
        let mut sums = [0.0; 2];
        for seen in row {
            let block = &blocks[seen.block];
            let free = block.carried(block.kernel(time), pair(&passed.free, seen.block));
            let steady = values.steady(seen.block, phase);
            let forced = forced.of(seen.block, room);
            let states = [0, 1].map(|i| free[i] + steady[i] + forced[i]);
            sums[0] += seen.position[0] * states[0] + seen.position[1] * states[1];
            sums[1] += seen.rate[0] * states[0] + seen.rate[1] * states[1];
        }
        sums
    }

    /// Gap of a contact and its slope by the phase, within an interval.
    pub(in crate::contact_equation) fn gap(
        &self,
        contact: usize,
        interval: usize,
        phase: f64,
    ) -> [f64; 2] {
        let room = &mut *self.room.borrow_mut();
        self.write(interval, phase, room);
        self.gap_of(contact, phase, &room.states)
    }

    /// The same in these states.
    pub(in crate::contact_equation) fn gap_of(
        &self,
        contact: usize,
        phase: f64,
        states: &[f64],
    ) -> [f64; 2] {
        let values = &self.equations.values;
        let [gap, rate] = values.contacts[contact].gap_in(phase, values.base, states);
        [gap, rate / values.base]
    }

    /// Writes positions and velocities at a phase within an interval.
    pub(in crate::contact_equation) fn state(
        &self,
        interval: usize,
        phase: f64,
        state: &mut [f64],
    ) {
        let room = &mut *self.room.borrow_mut();
        self.write(interval, phase, room);
        let linear = &self.equations.values.linear;
        linear.write_physical(&room.states, state);
    }

    /// Writes the states at a phase within an interval.
    pub(in crate::contact_equation) fn states(
        &self,
        interval: usize,
        phase: f64,
        states: &mut [f64],
    ) {
        let room = &mut *self.room.borrow_mut();
        self.write(interval, phase, room);
        states.copy_from_slice(&room.states);
    }

    /// Intervals with samples.
    pub(in crate::contact_equation) fn sampled(&self) -> &[Sampled] {
        self.sampled.get_or_init(|| Sampled::of(self))
    }

    /// Per coordinate, where it is smallest and largest over the period. They are looked for once.
    pub(in crate::contact_equation) fn coordinate_extremes(&self) -> &'e [[Place; 2]] {
        let known = &self.equations.extremes.coordinates;
        known.get_or_init(|| extremes_of_coordinates(self))
    }

    /// Extremes of the gaps, the same.
    pub(in crate::contact_equation) fn gap_extremes(&self) -> &'e [Vec<GapExtreme>] {
        let known = &self.equations.extremes.gaps;
        known.get_or_init(|| extremes_of_gaps(self))
    }

    /// Periods in a unit of phase of the fastest of the load on an interval and of the directions that move.
    pub(super) fn moves(&self, interval: usize) -> f64 {
        let contacts = &self.equations.values.contacts;
        let values = self.values(interval);
        let waves = values.load.iter().map(|wave| wave.harmonic);
        // A gap whose direction moves has the sum of both.
        let gaps = contacts.iter().map(Contact::harmonic);
        let moving = gaps.fold(0.0, f64::max);
        (moving + waves.fold(1.0, f64::max)) / std::f64::consts::TAU
    }
}

/// What part of an interval is behind at a phase.
fn part([from, to]: [f64; 2], phase: f64) -> f64 {
    if to > from {
        (phase - from) / (to - from)
    } else {
        0.0
    }
}

/// One interval as a stretch of motion.
pub(in crate::contact_equation) struct Within<'m, 'e> {
    pub(in crate::contact_equation) motion: &'m Motion<'e>,
    pub(in crate::contact_equation) interval: usize,
}

impl time::Stretch for Within<'_, '_> {
    fn phases(&self) -> (f64, f64) {
        self.motion.phases(self.interval).into()
    }

    fn state(&self, phase: f64, state: &mut [f64]) {
        self.motion.state(self.interval, phase, state);
    }
}
