//! An independent flow: extrapolation with tiny steps on the system as it is declared, from switch to switch.
//!
//! Steps are those of the modified midpoint rule with 2, 4, ..., 12 parts, extrapolated to parts of no length; a crossing is found
//! by bisection of the step, also where a gap turns back within a step.
//!
//! Source: Hairer, Norsett and Wanner (1993), Solving Ordinary Differential Equations I, section II.9 (Gragg, Bulirsch, Stoer).

use nalgebra::{DMatrix, DVector};

use crate::law::On;
use crate::model::layout::{Layout, Term};
use crate::system::{Part, System, Wave};

/// Columns of the extrapolation.
const COLUMNS: usize = 6;

/// A system to be integrated.
pub(super) struct Reference<'a> {
    system: &'a dyn System,
    layout: Layout,
    coefficients: Vec<f64>,
    omega: f64,
    inverse_mass: DMatrix<f64>,
    pieces: Vec<usize>,
}

fn wave(wave: Wave, phase: f64) -> f64 {
    let angle = f64::from(wave.harmonic) * phase;
    match wave.part {
        Part::Cosine => angle.cos(),
        Part::Sine => angle.sin(),
    }
}

impl<'a> Reference<'a> {
    pub(super) fn new(system: &'a dyn System, omega: f64) -> Self {
        let facts = system.facts();
        let layout = Layout::of(system);
        let mut values = vec![0.0; facts.parameters.len()];
        system.values(&mut values);
        let mut coefficients = vec![0.0; layout.coefficients];
        system.coefficients(&values, omega, &mut coefficients);
        let n = layout.coordinates;
        let mut mass = DMatrix::zeros(n, n);
        for entry in &layout.mass {
            mass[(entry.row, entry.column)] += coefficients[entry.coefficient];
        }
        Self {
            system,
            omega,
            inverse_mass: mass.try_inverse().unwrap(),
            pieces: vec![0; layout.contacts.len()],
            layout,
            coefficients,
        }
    }

    fn base(&self) -> f64 {
        self.omega / f64::from(self.system.facts().divisor)
    }

    fn arguments(&self, contact: usize) -> Vec<f64> {
        let layout = &self.layout.contacts[contact];
        let mut arguments = vec![0.0; layout.argument_count];
        layout.arguments(&self.coefficients, &mut arguments);
        arguments
    }

    fn levels(&self, contact: usize) -> Vec<f64> {
        let law = self.system.law(self.layout.contacts[contact].law);
        let mut levels = vec![0.0; law.facts().levels.len()];
        law.levels(&self.arguments(contact), &mut levels);
        levels
    }

    /// Gap and rate of a contact.
    fn gap(&self, contact: usize, phase: f64, state: &DVector<f64>) -> (f64, f64) {
        let n = self.layout.coordinates;
        let layout = &self.layout.contacts[contact];
        let value = |term: &Term, wave: f64| self.coefficients[term.coefficient] * wave;
        let (mut gap, mut rate) = (0.0, 0.0);
        for term in &layout.gap {
            gap += value(term, wave(term.wave, phase)) * state[term.index];
            rate += value(term, wave(term.wave, phase)) * state[n + term.index];
        }
        for term in &layout.offset {
            let (derivative, sign) = term.wave.derivative();
            let factor = sign * f64::from(term.wave.harmonic) * self.base();
            gap -= value(term, wave(term.wave, phase));
            rate -= value(term, wave(derivative, phase)) * factor;
        }
        (gap, rate)
    }

    /// The derivative of the state by the phase, on the present pieces.
    fn field(&self, phase: f64, state: &DVector<f64>) -> DVector<f64> {
        let n = self.layout.coordinates;
        let mut force = DVector::zeros(n);
        let value = |coefficient: usize| self.coefficients[coefficient];
        for entry in &self.layout.load {
            force[entry.row] += value(entry.coefficient) * wave(entry.wave, phase);
        }
        for entry in &self.layout.stiffness {
            let k = value(entry.coefficient) * wave(entry.wave, phase);
            force[entry.row] -= k * state[entry.column];
        }
        for entry in &self.layout.damping {
            force[entry.row] -= value(entry.coefficient) * state[n + entry.column];
        }
        for (index, contact) in self.layout.contacts.iter().enumerate() {
            let (gap, rate) = self.gap(index, phase, state);
            let mut phi = [0.0];
            let on = On::Piece(self.pieces[index]);
            let law = self.system.law(contact.law);
            law.force(on, &self.arguments(index), &[gap], &[rate], &mut phi);
            for term in &contact.force {
                force[term.index] -= value(term.coefficient) * wave(term.wave, phase) * phi[0];
            }
        }
        let acceleration = &self.inverse_mass * force;
        DVector::from_fn(2 * n, |i, _| {
            let by_time = if i < n {
                state[n + i]
            } else {
                acceleration[i - n]
            };
            by_time / self.base()
        })
    }

    fn step(&self, phase: f64, state: &DVector<f64>, step: f64) -> DVector<f64> {
        state + self.increment(phase, state, step)
    }

    /// What one extrapolated step adds, with rounding errors in parts of it.
    fn increment(&self, phase: f64, state: &DVector<f64>, step: f64) -> DVector<f64> {
        let mut row: Vec<DVector<f64>> = Vec::new();
        for j in 1..=COLUMNS {
            let parts = 2 * j;
            let h = step / parts as f64;
            let mut before = DVector::zeros(state.len());
            let mut now = self.field(phase, state) * h;
            for i in 1..parts {
                let there = state + &now;
                let next = &before + self.field(phase + i as f64 * h, &there) * (2.0 * h);
                before = std::mem::replace(&mut now, next);
            }
            let there = state + &now;
            let smooth = (&now + &before + self.field(phase + step, &there) * h) * 0.5;
            let mut column = smooth;
            let mut next_row = vec![column.clone()];
            for (k, earlier) in row.iter().enumerate() {
                let ratio = (j as f64 / (j - k - 1) as f64).powi(2);
                column = &column + (&column - earlier) / (ratio - 1.0);
                next_row.push(column.clone());
            }
            row = next_row;
        }
        row.pop().unwrap()
    }

    /// The level that a gap of the present pieces is beyond.
    fn beyond(&self, phase: f64, state: &DVector<f64>) -> Option<(usize, bool)> {
        (0..self.pieces.len()).find_map(|contact| {
            let (gap, _) = self.gap(contact, phase, state);
            let (levels, piece) = (self.levels(contact), self.pieces[contact]);
            let above = piece < levels.len() && gap > levels[piece];
            let below = piece > 0 && gap < levels[piece - 1];
            (above || below).then_some((contact, above))
        })
    }

    /// A part of a step after which a gap is beyond a level: the whole step, or where a gap turns within it.
    fn crossing(&self, phase: f64, state: &DVector<f64>, step: f64) -> Option<f64> {
        let end = self.step(phase, state, step);
        let turns = (0..self.pieces.len()).filter_map(|contact| {
            let rate = |s: f64, state: &DVector<f64>| self.gap(contact, phase + s, state).1;
            let first = rate(0.0, state);
            if first * rate(step, &end) >= 0.0 {
                return None;
            }
            let (mut before, mut after) = (0.0, step);
            for _ in 0..60 {
                let middle = 0.5 * (before + after);
                let there = self.step(phase, state, middle);
                if first * rate(middle, &there) > 0.0 {
                    before = middle;
                } else {
                    after = middle;
                }
            }
            Some(after)
        });
        let mut candidates: Vec<f64> = turns.collect();
        candidates.sort_by(f64::total_cmp);
        candidates.push(step);
        candidates.into_iter().find(|&s| {
            let there = self.step(phase, state, s);
            self.beyond(phase + s, &there).is_some()
        })
    }

    /// Moves a state; returns the number of crossings.
    pub(super) fn advance(&mut self, from: f64, to: f64, step: f64, state: &mut [f64]) -> usize {
        let mut now = DVector::from_column_slice(state);
        for contact in 0..self.pieces.len() {
            let (gap, _) = self.gap(contact, from, &now);
            let levels = self.levels(contact);
            self.pieces[contact] = levels.iter().filter(|&&level| gap > level).count();
        }
        let (mut phase, mut crossings) = (from, 0);
        // What rounding takes from a sum is given to the next one (Kahan 1965).
        let mut lost = DVector::zeros(now.len());
        let mut lost_phase = 0.0;
        while phase < to {
            let length = step.min(to - phase);
            let Some(crossed) = self.crossing(phase, &now, length) else {
                let wanted = self.increment(phase, &now, length) + &lost;
                let next = &now + &wanted;
                lost = wanted - (&next - &now);
                now = next;
                let wanted = length + lost_phase;
                let next = phase + wanted;
                lost_phase = wanted - (next - phase);
                phase = next;
                continue;
            };
            let (mut inside, mut outside) = (0.0, crossed);
            for _ in 0..60 {
                let middle = 0.5 * (inside + outside);
                let there = self.step(phase, &now, middle);
                if self.beyond(phase + middle, &there).is_some() {
                    outside = middle;
                } else {
                    inside = middle;
                }
            }
            now = self.step(phase, &now, outside);
            phase += outside;
            if let Some((contact, above)) = self.beyond(phase, &now) {
                let piece = &mut self.pieces[contact];
                *piece = if above { *piece + 1 } else { *piece - 1 };
                crossings += 1;
            }
        }
        state.copy_from_slice(now.as_slice());
        crossings
    }
}
