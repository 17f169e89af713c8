//! The ways from an orbit to its multipliers: one trait, and their names.

use nalgebra::Complex;

use super::monodromy::Monodromy;
use super::orbit::Orbit;

/// A way from an orbit to its multipliers.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
#[non_exhaustive]
pub enum Method {
    /// The cheapest whose estimated error clears what is wanted: see [`stability`](super).
    #[default]
    Default,
    /// The monodromy matrix, integrated from switch to switch: the authority.
    Monodromy,
}

impl Method {
    /// What computes it.
    pub(crate) fn engine(self) -> Box<dyn Floquet> {
        match self {
            Self::Default | Self::Monodromy => Box::new(Monodromy::new()),
        }
    }
}

impl std::fmt::Display for Method {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(match self {
            Self::Default => "default",
            Self::Monodromy => "monodromy",
        })
    }
}

/// What multipliers cost.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct Cost {
    /// Evaluations of the derivatives of a contact's force at one instant.
    pub slopes: usize,
    /// Exponentials of a matrix.
    pub exponentials: usize,
    /// Matrices whose eigenvalues were computed.
    pub spectra: usize,
    /// Order of the largest matrix among these.
    pub order: usize,
}

impl std::ops::AddAssign for Cost {
    fn add_assign(&mut self, other: Self) {
        self.slopes += other.slopes;
        self.exponentials += other.exponentials;
        self.spectra += other.spectra;
        self.order = self.order.max(other.order);
    }
}

impl std::fmt::Display for Cost {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(
            f,
            "{} slopes, {} exponentials, {} spectra, order {}",
            self.slopes, self.exponentials, self.spectra, self.order
        )
    }
}

/// Multipliers of an orbit as it is, whatever its own error.
#[derive(Debug, Clone)]
pub(crate) struct Found {
    /// Largest modulus first; empty if nothing is known.
    pub(crate) multipliers: Vec<Complex<f64>>,
    /// Estimated error of the method.
    pub(crate) error: f64,
}

impl Found {
    /// Nothing is known.
    pub(crate) const NOTHING: Self = Self {
        multipliers: Vec::new(),
        error: f64::INFINITY,
    };
}

/// Computes multipliers of one orbit after the other, and keeps its room.
pub(crate) trait Floquet: std::fmt::Debug {
    /// Multipliers of an orbit. An error below `aim` is of no use to the caller.
    fn multipliers(&mut self, orbit: &Orbit<'_>, aim: f64) -> Found;

    /// The work done so far.
    fn cost(&self) -> Cost;
}
