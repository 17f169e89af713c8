//! A system at values of its parameters and its frequency, in the pairs of its [linear part](super::linear), `y' = A y + ..`: contacts, and
//! waves of the load with their steady response `(i h Omega - A)^-1 b_h` (1), which a pair of states in resonance has not.
//!
//! Source: Meirovitch (2001), Fundamentals of Vibrations, section 7.15 (response of general systems by pairs of states).

use nalgebra::{Complex, DMatrix};

use super::block::Pair;
use super::configuration::Kept;
use super::contact::Contact;
use super::linear::Linear;
use super::wave::{Wave, turn, waves};
use crate::model::layout::{Layout, constant};
use crate::system::System;

/// Everything of a system at values of its parameters and its frequency.
#[derive(Debug, Clone)]
pub(in crate::contact_equation) struct Values {
    pub(in crate::contact_equation) linear: Linear,
    /// How fast the phase moves.
    pub(in crate::contact_equation) base: f64,
    pub(in crate::contact_equation) contacts: Vec<Contact>,
    pub(in crate::contact_equation) load: Vec<Wave>,
    /// Mass, damping and stiffness of the linear part.
    pub(in crate::contact_equation) matrices: [DMatrix<f64>; 3],
    /// More than the time changes along the branch.
    pub(in crate::contact_equation) changes: bool,
    /// The same while contacts are closed, as far as it was asked for.
    pub(super) kept: Kept,
}

impl Values {
    /// `None` where the mass is singular or the linear part has dependent eigenvectors.
    pub(in crate::contact_equation) fn new(
        system: &dyn System,
        layout: &Layout,
        parameters: &[f64],
        omega: f64,
    ) -> Option<Self> {
        let n = layout.coordinates;
        let mut coefficients = vec![0.0; layout.coefficients];
        system.coefficients(parameters, omega, &mut coefficients);
        let damping = constant(&layout.damping, &coefficients, n);
        let stiffness = constant(&layout.stiffness, &coefficients, n);
        let mass = layout.mass(&coefficients);
        let linear = Linear::new(&mass, &damping, &stiffness)?;
        let contacts = (0..layout.contacts.len())
            .map(|contact| Contact::new(system, layout, &coefficients, &linear, contact))
            .collect();
        let load = waves(layout, &coefficients, &linear);
        let mut values = Self {
            linear,
            base: 0.0,
            contacts,
            load,
            matrices: [mass, damping, stiffness],
            changes: true,
            kept: Kept::default(),
        };
        values.set_omega(omega, f64::from(system.facts().divisor));
        Some(values)
    }

    /// Goes over to another frequency, which no coefficient depends on.
    pub(in crate::contact_equation) fn set_omega(&mut self, omega: f64, divisor: f64) {
        self.set_base(omega / divisor);
    }

    /// The phase moves as fast as this.
    pub(in crate::contact_equation) fn set_base(&mut self, base: f64) {
        self.base = base;
        for wave in &mut self.load {
            let frequency = wave.harmonic * self.base;
            let pairs = wave.input.iter().zip(&self.linear.blocks);
            wave.resonant.clear();
            for (r, (input, block)) in pairs.enumerate() {
                let steady = block.steady(frequency, *input);
                if steady.is_none() {
                    wave.resonant.push(r);
                }
                let [response, by] = steady.unwrap_or_default();
                for i in 0..2 {
                    wave.steady[2 * r + i] = [response[i], by[i] * wave.harmonic];
                }
            }
        }
    }

    /// Number of states.
    pub(in crate::contact_equation) fn order(&self) -> usize {
        2 * self.linear.blocks.len()
    }

    /// Writes the steady response at a phase; and its derivatives by the phase, and by the base frequency.
    pub(in crate::contact_equation) fn write_steady(
        &self,
        tau: f64,
        value: &mut [f64],
        derivatives: Option<[&mut [f64]; 2]>,
    ) {
        value.fill(0.0);
        let mut derivatives = derivatives;
        if let Some(derivatives) = &mut derivatives {
            for of in derivatives.iter_mut() {
                of.fill(0.0);
            }
        }
        for wave in &self.load {
            if wave.is_resonant() {
                continue;
            }
            let turn = turn(wave.harmonic * tau);
            for (i, [response, by]) in wave.steady.iter().enumerate() {
                value[i] += turn.re * response.re - turn.im * response.im;
                if let Some([by_phase, by_base]) = &mut derivatives {
                    by_phase[i] -= wave.harmonic * (turn.re * response.im + turn.im * response.re);
                    by_base[i] += turn.re * by.re - turn.im * by.im;
                }
            }
        }
    }

    /// The steady response of a pair at a phase.
    pub(in crate::contact_equation) fn steady(&self, r: usize, tau: f64) -> Pair {
        let mut sum = [0.0; 2];
        for wave in &self.load {
            let turn = turn(wave.harmonic * tau);
            for (i, sum) in sum.iter_mut().enumerate() {
                *sum += (turn * wave.steady[2 * r + i][0]).re;
            }
        }
        sum
    }

    /// Whether there are waves in resonance.
    pub(in crate::contact_equation) fn has_resonance(&self) -> bool {
        self.load.iter().any(|wave| !wave.resonant.is_empty())
    }

    /// Adds what waves in resonance do to the states within a time from rest at a phase.
    pub(in crate::contact_equation) fn add_resonant(
        &self,
        tau: f64,
        time: f64,
        states: &mut [f64],
    ) {
        for wave in &self.load {
            for &r in &wave.resonant {
                let block = &self.linear.blocks[r];
                let state = if wave.is_constant_on(block) {
                    wave.parabola(block, r, time)
                } else {
                    self.resonance(wave, r, [tau, time])[0]
                };
                for i in 0..2 {
                    states[2 * r + i] += state[i];
                }
            }
        }
    }

    /// What a wave in resonance does to a pair within a time from rest at a phase: states, and their derivatives by the time, by the phase
    /// where it begins, and by the base frequency.
    pub(in crate::contact_equation) fn resonance(
        &self,
        wave: &Wave,
        r: usize,
        [tau, time]: [f64; 2],
    ) -> [Pair; 4] {
        let begun = wave.harmonic * tau;
        let later = turn(begun + wave.harmonic * self.base * time);
        let turn = turn(begun);
        let (block, input) = (&self.linear.blocks[r], wave.input[r]);
        let [p, k, p_by, k_by] = block.response_at_rest(wave.harmonic * self.base, time);
        let d = block.deviation;
        let turned = |i: usize| input[0] * d[i][0] + input[1] * d[i][1];
        let state = [0, 1].map(|i| turn * (p * input[i] + k * turned(i)));
        let by_time = [0, 1].map(|i| {
            let a = block.matrix[i];
            (state[0] * a[0] + state[1] * a[1] + later * input[i]).re
        });
        let by_base = |i: usize| turn * wave.harmonic * (p_by * input[i] + k_by * turned(i));
        [
            state.map(|x| x.re),
            by_time,
            state.map(|x| (x * Complex::new(0.0, wave.harmonic)).re),
            [0, 1].map(|i| by_base(i).re),
        ]
    }
}
