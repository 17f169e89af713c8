//! The gap of one contact and its rate, equations (2) and (3) of [`system`](crate::system), at one instant.

use crate::model::layout::{ContactLayout, Term};
use crate::system::{Part, Wave};

/// A gap at given values of the parameters and of `omega`.
#[derive(Debug, Clone, Default)]
pub(crate) struct Gap {
    /// Coordinate, wave and coefficient of every term of `d`.
    direction: Vec<(usize, Wave, f64)>,
    /// The same of `delta`, without coordinate.
    offset: Vec<(Wave, f64)>,
    /// `omega / divisor`
    base: f64,
}

impl Gap {
    pub(crate) fn new(contact: &ContactLayout, coefficients: &[f64], base: f64) -> Self {
        let mut gap = Self::default();
        gap.set(contact, coefficients, base);
        gap
    }

    /// Goes over to other values; it takes the same room as before.
    pub(crate) fn set(&mut self, contact: &ContactLayout, coefficients: &[f64], base: f64) {
        let value = |term: &Term| coefficients[term.coefficient];
        let direction = contact.gap.iter();
        self.direction.clear();
        self.direction
            .extend(direction.map(|d| (d.index, d.wave, value(d))));
        let offset = contact.offset.iter();
        self.offset.clear();
        self.offset
            .extend(offset.map(|delta| (delta.wave, value(delta))));
        self.base = base;
    }

    /// The gap and its rate.
    pub(crate) fn at(&self, phase: f64, state: &[f64]) -> (f64, f64) {
        let (q, v) = state.split_at(state.len() / 2);
        let (mut gap, mut rate) = (0.0, 0.0);
        for &(index, wave, d) in &self.direction {
            let here = d * value(wave, phase);
            gap += here * q[index];
            rate += here * v[index] + d * self.base * slope(wave, phase) * q[index];
        }
        for &(wave, delta) in &self.offset {
            gap -= delta * value(wave, phase);
            rate -= delta * self.base * slope(wave, phase);
        }
        (gap, rate)
    }
}

/// A wave at a phase.
pub(crate) fn value(wave: Wave, phase: f64) -> f64 {
    let angle = f64::from(wave.harmonic) * phase;
    match wave.part {
        Part::Cosine => angle.cos(),
        Part::Sine => angle.sin(),
    }
}

/// Its derivative by the phase.
fn slope(wave: Wave, phase: f64) -> f64 {
    let (derivative, sign) = wave.derivative();
    sign * f64::from(wave.harmonic) * value(derivative, phase)
}
