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

    /// Coordinate, wave and coefficient of every term of `d`.
    pub(crate) fn direction(&self) -> impl Iterator<Item = (usize, Wave, f64)> {
        self.direction.iter().copied()
    }

    /// The same of `delta`, without coordinate.
    pub(crate) fn offset(&self) -> impl Iterator<Item = (Wave, f64)> {
        self.offset.iter().copied()
    }

    /// The gap and its rate.
    pub(crate) fn at(&self, phase: f64, state: &[f64]) -> (f64, f64) {
        let (q, v) = state.split_at(state.len() / 2);
        let (mut gap, mut rate) = (0.0, 0.0);
        let mut waves = Waves::at(phase);
        // Of many coordinates one after the other has the wave of the one before.
        let mut known = Wave::CONSTANT;
        let (mut value, mut slope) = (waves.value(known), waves.slope(known));
        for &(index, wave, d) in &self.direction {
            if wave != known {
                known = wave;
                (value, slope) = (waves.value(wave), waves.slope(wave));
            }
            let here = d * value;
            gap += here * q[index];
            rate += here * v[index] + d * self.base * slope * q[index];
        }
        for &(wave, delta) in &self.offset {
            gap -= delta * waves.value(wave);
            rate -= delta * self.base * waves.slope(wave);
        }
        (gap, rate)
    }
}

/// Waves at a phase. The terms of a direction that turns have one harmonic, whose sine and cosine are computed once: of many coordinates that was
/// nearly all of the time of a gap.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Waves {
    phase: f64,
    /// Of the harmonic that was asked for last.
    harmonic: u32,
    sine: f64,
    cosine: f64,
}

impl Waves {
    pub(crate) fn at(phase: f64) -> Self {
        Self {
            phase,
            harmonic: 0,
            sine: 0.0,
            cosine: 1.0,
        }
    }

    /// A wave there.
    pub(crate) fn value(&mut self, wave: Wave) -> f64 {
        if wave.harmonic != self.harmonic {
            let angle = f64::from(wave.harmonic) * self.phase;
            (self.sine, self.cosine) = angle.sin_cos();
            self.harmonic = wave.harmonic;
        }
        match wave.part {
            Part::Cosine => self.cosine,
            Part::Sine => self.sine,
        }
    }

    /// Its derivative by the phase.
    fn slope(&mut self, wave: Wave) -> f64 {
        let (derivative, sign) = wave.derivative();
        sign * f64::from(wave.harmonic) * self.value(derivative)
    }
}
