//! Loads: forces, unbalances, motions of the base and accelerations.

use hertzian::structure::Value;

use super::direction::Direction;

/// What a load is proportional to.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum LoadKind {
    /// Its amplitude is a force.
    Force,
    /// Its amplitude is mass times eccentricity, and is multiplied by the square of the frequency of the excitation.
    Unbalance,
    /// The base moves with its amplitude along the direction, whose entries say how far coordinates move with the base; coordinates are
    /// relative to the base.
    Base,
    /// Its amplitude is an acceleration, as of gravity, along the direction.
    Acceleration,
}

/// A load.
#[derive(Debug, Clone, PartialEq)]
pub struct Load {
    pub(crate) direction: Direction,
    pub(crate) kind: LoadKind,
    pub(crate) harmonic: u32,
    pub(crate) phase: f64,
    pub(crate) amplitude: Value,
}

impl Load {
    /// `amplitude * cos(omega t)` of this kind.
    pub fn new(kind: LoadKind, direction: Direction, amplitude: impl Into<Value>) -> Self {
        Self {
            direction,
            kind,
            harmonic: 1,
            phase: 0.0,
            amplitude: amplitude.into(),
        }
    }

    /// A force `amplitude * cos(omega t)`.
    pub fn force(direction: Direction, amplitude: impl Into<Value>) -> Self {
        Self::new(LoadKind::Force, direction, amplitude)
    }

    /// Of this multiple of the frequency of the excitation; zero does not change with time.
    #[must_use]
    pub fn harmonic(mut self, harmonic: u32) -> Self {
        self.harmonic = harmonic;
        self
    }

    /// A phase in radians: `amplitude * cos(harmonic omega t + phase)`.
    #[must_use]
    pub fn phase(mut self, phase: f64) -> Self {
        self.phase = phase;
        self
    }
}
