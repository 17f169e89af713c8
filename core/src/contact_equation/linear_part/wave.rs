//! Waves of the load, and what they do to the pairs of the [linear part](super::linear).

use nalgebra::{Complex, DVector};

use super::block::{Block, Pair, times};
use super::linear::Linear;
use crate::model::layout::Layout;
use crate::system::Part;

/// A wave of the load.
#[derive(Debug, Clone)]
pub(in crate::contact_equation) struct Wave {
    pub(in crate::contact_equation) harmonic: f64,
    /// Per pair, the complex amplitude of what it does to the states.
    pub(in crate::contact_equation) input: Vec<[Complex<f64>; 2]>,
    /// Per state, the steady response and its derivative by the base frequency; zero in resonance.
    pub(in crate::contact_equation) steady: Vec<[Complex<f64>; 2]>,
    /// The pairs in resonance with it.
    pub(in crate::contact_equation) resonant: Vec<usize>,
}

impl Wave {
    /// Of what it does to the states.
    pub(in crate::contact_equation) fn new(harmonic: f64, input: &DVector<Complex<f64>>) -> Self {
        let pairs = input.as_slice().as_chunks().0;
        Self {
            harmonic,
            input: pairs.to_vec(),
            steady: vec![[Complex::new(0.0, 0.0); 2]; 2 * pairs.len()],
            resonant: Vec::new(),
        }
    }

    /// All pairs are in resonance with it.
    pub(in crate::contact_equation) fn is_resonant(&self) -> bool {
        2 * self.resonant.len() == self.steady.len()
    }

    /// It does not change, on a pair that nothing holds: states are a parabola.
    pub(in crate::contact_equation) fn is_constant_on(&self, block: &Block) -> bool {
        self.harmonic == 0.0 && block.is_free()
    }

    /// These states after a time from rest.
    pub(super) fn parabola(&self, block: &Block, r: usize, time: f64) -> Pair {
        let input = self.input[r].map(|x| x.re);
        let moved = times(block.deviation, input);
        [0, 1].map(|i| time * (input[i] + 0.5 * time * moved[i]))
    }
}

/// The waves of the load at these coefficients.
pub(super) fn waves(layout: &Layout, coefficients: &[f64], linear: &Linear) -> Vec<Wave> {
    let mut waves: Vec<(u32, DVector<Complex<f64>>)> = Vec::new();
    for entry in &layout.load {
        let harmonic = entry.wave.harmonic;
        let known = waves.iter().position(|(h, _)| *h == harmonic);
        let place = known.unwrap_or_else(|| {
            waves.push((harmonic, DVector::zeros(layout.coordinates)));
            waves.len() - 1
        });
        // a cos + b sin = Re((a - i b) e^(i h tau))
        let value = coefficients[entry.coefficient];
        waves[place].1[entry.row] += match entry.wave.part {
            Part::Cosine => Complex::new(value, 0.0),
            Part::Sine => Complex::new(0.0, -value),
        };
    }
    let waves = waves.into_iter().map(|(harmonic, amplitude)| {
        let input = linear.input.map(|x| Complex::new(x, 0.0)) * amplitude;
        Wave::new(f64::from(harmonic), &input)
    });
    waves.collect()
}

/// `e^(i angle)`
pub(in crate::contact_equation) fn turn(angle: f64) -> Complex<f64> {
    if angle == 0.0 {
        return Complex::new(1.0, 0.0);
    }
    let (sine, cosine) = angle.sin_cos();
    Complex::new(cosine, sine)
}
