//! The motion from a state, near enough to look for an orbit at.
//!
//! Steps of the phase are equal. Over one, of a time `h`, forces go from `f_0` to `f_1` in a straight line, and with the response `y_p` to the load
//! pairs of states are
//!
//! ```text
//! y_1 = e^(A h) (y_0 - y_p0) + y_p1 + (P - Q) B_0 f_0 + Q B_1 f_1                                              (1)
//! P = int_0^h e^(A t) dt,    Q = int_0^h (1 - t / h) e^(A t) dt
//! ```
//!
//! so that no vibration is too fast for a step, as those of static vectors are for a numerical integration. Forces at its end depend on gaps there,
//!
//! ```text
//! f_1 = phi(g_0 + G Q B_1 f_1, r_0 + R Q B_1 f_1)                                                              (2)
//! ```
//!
//! with the rows `G` and `R` of gaps and rates, which are solved for by Newton's method: stiff contacts take no shorter steps either. Loads in resonance have no
//! `y_p`, and are forces. Where a force jumps (2) may have no solution, and the last iterate is taken.
//!
//! Source: Nigam and Jennings (1969), Calculation of response spectra from strong-motion earthquake records, Bulletin of the Seismological Society of America
//! 59(2) (loads that are straight between samples, by the exact motion); Cox and Matthews (2002), Exponential time differencing for stiff systems, Journal of
//! Computational Physics 176 (the same for forces of the state).

use super::equations::setting::Setting;
use super::linear_part::block::{Block, Kernel, Pair, add, pair};
use super::linear_part::contact::{Contact, Instant};
use super::linear_part::values::Values;
use super::linear_part::wave::turn;
use crate::law::On;
use crate::laws::single::Single;
use crate::numeric::fourier::gauss;
use crate::numeric::linear::{Lu, Matrix, dot};

/// Contacts from which on (2) takes longer than a numerical integration.
const MANY: usize = 64;
/// Iterations for (2), and the last update as a part of the largest force.
const ITERATIONS: usize = 25;
const UPDATE: f64 = 1e-9;
/// Points of the rule for `P` and `Q`, and the angle of the fastest pair over one such rule.
const POINTS: usize = 16;
const ANGLE: f64 = 4.0;

/// Steps from a state on.
pub(super) struct March<'m> {
    setting: &'m Setting,
    values: &'m Values,
    /// Phase of a step.
    step: f64,
    carries: Vec<Carry>,
    phase: f64,
    /// States where it is, and the steady response there.
    states: Vec<f64>,
    steady: Vec<f64>,
    /// `B f` there, and the forces.
    pushed: Vec<f64>,
    forces: Vec<f64>,
    /// Largest force of each contact so far.
    largest: Vec<f64>,
    /// Directions and what gaps and rates see of each other's forces, where nothing of that moves.
    coupled: Coupled,
    stands: bool,
    matrix: Matrix,
    lu: Lu,
    update: Vec<f64>,
    /// Gaps and rates at the end of a step without forces there.
    free: Vec<[f64; 2]>,
    room: [Vec<f64>; 4],
}

/// What a step does to a pair of states.
struct Carry {
    /// `e^(A h)`
    whole: Kernel,
    /// `P - Q`
    first: Kernel,
    /// `Q`
    last: Kernel,
}

impl Carry {
    fn of(block: &Block, time: f64) -> Self {
        let parts = (block.rate() * time / ANGLE).ceil().max(1.0);
        let rule = gauss::rule(POINTS);
        let [mut first, mut last] = [Kernel { c: 0.0, k: 0.0 }; 2];
        for part in 0..parts as usize {
            for (node, weight) in rule.nodes.iter().zip(&rule.weights) {
                let s = (part as f64 + node) / parts;
                let Kernel { c, k } = block.kernel(s * time);
                let weight = weight * time / parts;
                first.c += weight * s * c;
                first.k += weight * s * k;
                last.c += weight * (1.0 - s) * c;
                last.k += weight * (1.0 - s) * k;
            }
        }
        Self {
            whole: block.kernel(time),
            first,
            last,
        }
    }
}

/// What unit forces do within a step, and what gaps and rates see of it.
#[derive(Default)]
struct Coupled {
    /// `Q B`, contact by contact.
    responses: Vec<Vec<f64>>,
    /// `G` and `R`, the same.
    rows: Vec<[Vec<f64>; 2]>,
    /// `G Q B` and `R Q B`, row by row.
    gaps: Vec<f64>,
    rates: Vec<f64>,
}

impl<'m> March<'m> {
    /// Steps of such a phase. `None` where that is no way to go.
    pub(super) fn new(setting: &'m Setting, values: &'m Values, step: f64) -> Option<Self> {
        let count = values.contacts.len();
        if count > MANY {
            return None;
        }
        let order = values.order();
        let zeros = || vec![0.0; order];
        let blocks = values.linear.blocks.iter();
        let constant = |contact: &Contact| contact.stands() && contact.input.is_constant();
        Some(Self {
            setting,
            values,
            step,
            carries: blocks
                .map(|block| Carry::of(block, step / values.base))
                .collect(),
            phase: 0.0,
            states: zeros(),
            steady: zeros(),
            pushed: zeros(),
            forces: vec![0.0; count],
            largest: vec![0.0; count],
            coupled: Coupled {
                responses: vec![zeros(); count],
                rows: vec![[zeros(), zeros()]; count],
                gaps: vec![0.0; count * count],
                rates: vec![0.0; count * count],
            },
            stands: values.contacts.iter().all(constant),
            matrix: Matrix::zeros(count),
            lu: Lu::new(count),
            update: vec![0.0; count],
            free: vec![[0.0; 2]; count],
            room: [zeros(), zeros(), zeros(), zeros()],
        })
    }

    /// Begins at a phase with positions and velocities.
    pub(super) fn begin(&mut self, phase: f64, state: &[f64]) {
        self.phase = phase;
        let inverse = &self.values.linear.inverse;
        for (row, y) in self.states.iter_mut().enumerate() {
            let entries = inverse.row(row);
            *y = entries.iter().zip(state).map(|(a, x)| a * x).sum();
        }
        self.values.write_steady(phase, &mut self.steady, None);
        for (contact, of) in self.values.contacts.iter().enumerate() {
            let gap = of.gap_in(phase, self.values.base, &self.states);
            self.forces[contact] = self.law(of, gap).force;
        }
        if self.stands {
            self.couple(phase);
        }
        self.push(phase);
    }

    /// The phase where it is.
    pub(super) fn phase(&self) -> f64 {
        self.phase
    }

    /// Writes positions and velocities where it is.
    pub(super) fn write(&self, state: &mut [f64]) {
        self.values.linear.write_physical(&self.states, state);
    }

    /// One step further. Says whether there is a number.
    pub(super) fn step(&mut self) -> bool {
        let phase = self.phase + self.step;
        let mut steady = std::mem::take(&mut self.room[0]);
        self.values.write_steady(phase, &mut steady, None);
        self.carry(&steady);
        self.steady.copy_from_slice(&steady);
        self.room[0] = steady;
        if !self.stands {
            self.couple(phase);
        }
        self.add_loads(phase);
        self.solve(phase);
        for (force, response) in self.forces.iter().zip(&self.coupled.responses) {
            add(&mut self.states, *force, response);
        }
        for (largest, force) in self.largest.iter_mut().zip(&self.forces) {
            *largest = largest.max(force.abs());
        }
        self.push(phase);
        self.phase = phase;
        self.states.iter().all(|x| x.is_finite())
    }

    fn law(&self, contact: &Contact, gap: [f64; 2]) -> Single {
        let law = self.setting.system.law(contact.law);
        Single::of(law, On::AllPieces, &contact.arguments, gap)
    }

    /// (1) without what depends on the forces at the end, where the steady response is given.
    fn carry(&mut self, steady: &[f64]) {
        let blocks = self.values.linear.blocks.iter().zip(&self.carries);
        for (r, (block, carry)) in blocks.enumerate() {
            let [states, before] = [&self.states, &self.steady].map(|of| pair(of, r));
            let free = block.carried(carry.whole, [states[0] - before[0], states[1] - before[1]]);
            let pushed = block.carried(carry.first, pair(&self.pushed, r));
            for i in 0..2 {
                self.states[2 * r + i] = free[i] + steady[2 * r + i] + pushed[i];
            }
        }
    }

    /// Adds what loads in resonance at the end do.
    fn add_loads(&mut self, phase: f64) {
        let blocks = &self.values.linear.blocks;
        for wave in &self.values.load {
            for &r in &wave.resonant {
                let load = loaded(wave.input[r], wave.harmonic * phase);
                let moved = blocks[r].carried(self.carries[r].last, load);
                self.states[2 * r] += moved[0];
                self.states[2 * r + 1] += moved[1];
            }
        }
    }

    /// Writes what acts on the states at a phase with the forces there.
    fn push(&mut self, phase: f64) {
        self.pushed.fill(0.0);
        let input = &mut self.room[1];
        for (contact, force) in self.values.contacts.iter().zip(&self.forces) {
            contact.input.write(phase, 0, input);
            add(&mut self.pushed, *force, input);
        }
        for wave in &self.values.load {
            for &r in &wave.resonant {
                let load = loaded(wave.input[r], wave.harmonic * phase);
                self.pushed[2 * r] += load[0];
                self.pushed[2 * r + 1] += load[1];
            }
        }
    }

    /// Writes what contacts see of each other at a phase.
    fn couple(&mut self, phase: f64) {
        let contacts = &self.values.contacts;
        let [_, input, another, states] = &mut self.room;
        states.fill(0.0);
        let at = Instant {
            tau: phase,
            base: self.values.base,
            by_omega: 0.0,
        };
        let Coupled {
            responses,
            rows,
            gaps,
            rates,
        } = &mut self.coupled;
        for (contact, [gap, rate]) in contacts.iter().zip(&mut *rows) {
            contact.output(at, states, [gap, rate], another);
        }
        let blocks = self.values.linear.blocks.iter().zip(&self.carries);
        for (contact, response) in contacts.iter().zip(&mut *responses) {
            contact.input.write(phase, 0, input);
            for (r, (block, carry)) in blocks.clone().enumerate() {
                let moved = block.carried(carry.last, pair(input, r));
                response[2 * r..][..2].copy_from_slice(&moved);
            }
        }
        let count = contacts.len();
        for (row, [gap, rate]) in rows.iter().enumerate() {
            for (column, response) in responses.iter().enumerate() {
                gaps[row * count + column] = dot(gap, response);
                rates[row * count + column] = dot(rate, response);
            }
        }
    }

    /// Solves (2) for the forces at the end, where the states are those without them.
    fn solve(&mut self, phase: f64) {
        let (contacts, count) = (&self.values.contacts, self.forces.len());
        for (free, contact) in self.free.iter_mut().zip(contacts) {
            *free = contact.gap_in(phase, self.values.base, &self.states);
        }
        for _ in 0..ITERATIONS {
            for (row, contact) in contacts.iter().enumerate() {
                let [gaps, rates] =
                    [&self.coupled.gaps, &self.coupled.rates].map(|of| &of[row * count..][..count]);
                let mut gap = self.free[row];
                gap[0] += dot(gaps, &self.forces);
                gap[1] += dot(rates, &self.forces);
                let law = self.law(contact, gap);
                self.update[row] = law.force - self.forces[row];
                let entries = self.matrix.row_mut(row).iter_mut();
                for (entry, (gap, rate)) in entries.zip(gaps.iter().zip(rates)) {
                    *entry = -law.by_gap * gap - law.by_rate * rate;
                }
                self.matrix.row_mut(row)[row] += 1.0;
            }
            if self.lu.factorise(&mut self.matrix).is_err() {
                return;
            }
            self.lu.solve(&self.matrix, &mut self.update);
            let mut done = true;
            let sizes = self.largest.iter().zip(&self.update);
            for (force, (largest, update)) in self.forces.iter_mut().zip(sizes) {
                *force += update;
                done &= update.abs() <= UPDATE * largest.max(force.abs());
            }
            if done {
                return;
            }
        }
    }
}

/// The load of a wave on a pair where it has turned by an angle.
fn loaded(input: [nalgebra::Complex<f64>; 2], angle: f64) -> Pair {
    let turn = turn(angle);
    input.map(|x| (turn * x).re)
}
