//! Vectors that move with the phase of the excitation, as sums of harmonics.

use crate::model::layout::Term;
use crate::numeric::linear;
use crate::system::Part;

/// A vector that moves with the phase, `sum_h a_h cos h tau + b_h sin h tau`.
#[derive(Debug, Clone, Default)]
pub(in crate::contact_equation) struct Moving {
    pub(super) constant: Vec<f64>,
    waves: Vec<(f64, Vec<f64>, Vec<f64>)>,
}

impl Moving {
    pub(super) fn add(&mut self, term: &Term, factor: f64, column: &[f64]) {
        if self.constant.is_empty() {
            self.constant = vec![0.0; column.len()];
        }
        let add = |to: &mut Vec<f64>| {
            for (to, x) in to.iter_mut().zip(column) {
                *to += factor * x;
            }
        };
        if term.wave.harmonic == 0 {
            add(&mut self.constant);
            return;
        }
        let harmonic = f64::from(term.wave.harmonic);
        let known = self.waves.iter().position(|(h, ..)| *h == harmonic);
        let place = known.unwrap_or_else(|| {
            let zero = vec![0.0; column.len()];
            self.waves.push((harmonic, zero.clone(), zero));
            self.waves.len() - 1
        });
        let (_, cosine, sine) = &mut self.waves[place];
        match term.wave.part {
            Part::Cosine => add(cosine),
            Part::Sine => add(sine),
        }
    }

    /// The largest entry that it may have.
    pub(in crate::contact_equation) fn size(&self) -> f64 {
        self.sizes().into_iter().fold(0.0, f64::max)
    }

    /// The largest that each entry may be.
    pub(super) fn sizes(&self) -> Vec<f64> {
        let entries = 0..self.constant.len();
        let of = |i: usize| {
            let waves = self.waves.iter();
            let waves = waves.map(|(_, cosine, sine)| cosine[i].abs() + sine[i].abs());
            self.constant[i].abs() + waves.sum::<f64>()
        };
        entries.map(of).collect()
    }

    /// It does not move.
    pub(in crate::contact_equation) fn is_constant(&self) -> bool {
        self.waves.is_empty()
    }

    /// What does not move of it, if that is anything.
    pub(in crate::contact_equation) fn constant(&self) -> &[f64] {
        &self.constant
    }

    /// Writes a derivative by the phase; the zeroth is the vector.
    pub(in crate::contact_equation) fn write(&self, tau: f64, derivative: u32, to: &mut [f64]) {
        to.fill(0.0);
        if derivative == 0 {
            to[..self.constant.len()].copy_from_slice(&self.constant);
        }
        for (harmonic, cosine, sine) in &self.waves {
            let turns = derivative_of_turn(*harmonic, tau, derivative);
            for (i, to) in to.iter_mut().enumerate().take(cosine.len()) {
                *to += turns[0] * cosine[i] + turns[1] * sine[i];
            }
        }
    }

    /// The product of a derivative by the phase and other entries.
    pub(super) fn dot(&self, tau: f64, derivative: u32, entries: &[f64]) -> f64 {
        let mut sum = if derivative == 0 {
            dot(&self.constant, entries)
        } else {
            0.0
        };
        for (harmonic, cosine, sine) in &self.waves {
            let turns = derivative_of_turn(*harmonic, tau, derivative);
            let [cosine, sine] = [cosine, sine].map(|of| linear::dot(of, entries));
            sum += turns[0] * cosine + turns[1] * sine;
        }
        sum
    }

    /// The highest harmonic.
    pub(super) fn harmonic(&self) -> f64 {
        let harmonics = self.waves.iter().map(|(harmonic, ..)| *harmonic);
        harmonics.fold(0.0, f64::max)
    }

    /// Of a single entry.
    pub(in crate::contact_equation) fn value(&self, tau: f64, derivative: u32) -> f64 {
        if self.is_constant() {
            let value = if derivative == 0 {
                self.constant.first()
            } else {
                None
            };
            return value.copied().unwrap_or(0.0);
        }
        let mut to = [0.0];
        self.write(tau, derivative, &mut to);
        to[0]
    }
}

/// A derivative of cosine and sine of a harmonic of a phase, by that.
fn derivative_of_turn(harmonic: f64, tau: f64, derivative: u32) -> [f64; 2] {
    let (s, c) = (harmonic * tau).sin_cos();
    let turns = match derivative % 4 {
        0 => [c, s],
        1 => [-s, c],
        2 => [-c, -s],
        _ => [s, -c],
    };
    let factor = harmonic.powi(derivative as i32);
    turns.map(|x| factor * x)
}

/// The product of a row and states, which are few.
pub(super) fn dot(row: &[f64], states: &[f64]) -> f64 {
    row.iter().zip(states).map(|(a, y)| a * y).sum()
}
