//! Why a structure was not reduced.

use sparse_ldlt::LdltError;

use crate::error::StructureError;

/// Why a structure was not reduced.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum ReductionError {
    /// The structure itself is at fault.
    #[error(transparent)]
    Structure(#[from] StructureError),
    /// An option cannot be used.
    #[error("{name} = {value}: must be {must}")]
    Option {
        /// Which one.
        name: &'static str,
        /// Its value.
        value: f64,
        /// What it must be.
        must: &'static str,
    },
    /// The stiffness matrix has negative eigenvalues: the structure buckles.
    #[error(
        "the stiffness matrix has {count} negative eigenvalue{}: the structure is not at a stable equilibrium", if *.count == 1 { "" } else { "s" }
    )]
    Unstable {
        /// How many.
        count: usize,
    },
    /// The damping matrix has negative eigenvalues.
    #[error(
        "the damping matrix has {count} negative eigenvalue{}: a motion gains energy by it", if *.count == 1 { "" } else { "s" }
    )]
    Damping {
        /// How many.
        count: usize,
    },
    /// The mass matrix has a negative eigenvalue, or none that is not zero.
    #[error("the mass matrix is not positive: a motion has no or negative kinetic energy")]
    Mass,
    /// A matrix of equations has no inverse.
    #[error("stiffness and mass at {frequency} rad per unit of time have no inverse: {reason}")]
    Singular {
        /// The frequency.
        frequency: f64,
        /// What the elimination met.
        reason: String,
    },
    /// There are more modes than a dense model is made for.
    #[error(
        "there are {count} modes below {frequency} rad per unit of time: ask for a number of modes, or for a lower frequency"
    )]
    ManyModes {
        /// How many.
        count: usize,
        /// Below which frequency.
        frequency: f64,
    },
    /// Not all modes that there are were found.
    #[error("{found} of {expected} modes were found")]
    Modes {
        /// As many as converged.
        found: usize,
        /// As many as there are.
        expected: usize,
    },
    /// It was stopped.
    #[error("the reduction was cancelled")]
    Cancelled,
}

/// What an elimination met at a frequency.
pub(super) fn singular(frequency: f64, error: &LdltError) -> ReductionError {
    ReductionError::Singular {
        frequency,
        reason: match error {
            LdltError::ZeroPivot(column) => format!("a pivot of zero at coordinate {column}"),
            LdltError::NearZeroPivot { column, pivot, .. } => {
                format!("a pivot of {pivot:e} at coordinate {column}")
            }
            other => format!("{other:?}"),
        },
    }
}
