//! What a method says of an orbit of a branch.

use std::time::Duration;

use nalgebra::Complex;

use super::method::Cost;
use super::{Method, Stability};

/// What a [`Method`] says of one orbit: see [`Branch::multipliers`](crate::Branch::multipliers).
#[derive(Debug, Clone, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[non_exhaustive]
pub struct Answer {
    /// The method.
    pub method: Method,
    /// Multipliers of the corrected orbit, the sum of both errors, and the verdict.
    pub stability: Stability,
    /// What varies along the branch, for the corrected orbit: an orbit is corrected across its branch, and lies a little farther along
    /// the axis then. At the value of the point itself multipliers differ from those given by their slope times this distance,
    /// which no error has in it. The slope grows without bound towards a fold.
    #[cfg_attr(feature = "serde", serde(with = "crate::serialise"))]
    pub value: f64,
    /// Multipliers of the orbit as it is, largest modulus first; empty if the method found none.
    #[cfg_attr(feature = "serde", serde(with = "crate::serialise"))]
    pub uncorrected: Vec<Complex<f64>>,
    /// Estimated error of the method.
    #[cfg_attr(feature = "serde", serde(with = "crate::serialise"))]
    pub by_method: f64,
    /// Estimated error from what the harmonics and samples of the orbit leave out.
    #[cfg_attr(feature = "serde", serde(with = "crate::serialise"))]
    pub by_truncation: f64,
    /// A bound on the error of the monodromy matrix of the corrected orbit (of the orbit, if it was not corrected), with
    /// displacements and velocities scaled to be alike. Only [`Method::KoopmanHill`] has one, and only for orbits whose
    /// stiffness and damping are smooth enough that their Fourier coefficients fall exponentially: never where a contact opens.
    #[cfg_attr(feature = "serde", serde(with = "crate::serialise"))]
    pub bound: Option<f64>,
    /// What it cost, both orbits together.
    pub(crate) cost: Cost,
    /// The time that took, without that of correcting the orbit.
    #[cfg_attr(feature = "serde", serde(with = "crate::serialise"))]
    pub elapsed: Duration,
}

/// What it cost, both orbits together.
impl Answer {
    /// Evaluations of the derivatives of a contact's force at one instant.
    pub fn slopes(&self) -> usize {
        self.cost.slopes
    }

    /// Contacts whose slopes were made into Fourier coefficients.
    pub fn contacts(&self) -> usize {
        self.cost.contacts
    }

    /// Exponentials of a matrix.
    pub fn exponentials(&self) -> usize {
        self.cost.exponentials
    }

    /// Matrices whose eigenvalues were computed.
    pub fn spectra(&self) -> usize {
        self.cost.spectra
    }

    /// Order of the largest matrix among these.
    pub fn order(&self) -> usize {
        self.cost.order
    }
}
