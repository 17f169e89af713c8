//! Why there is no solution.

use crate::numeric::linear::Singular;

/// Why an iteration ended without a solution.
#[derive(Clone, Copy, PartialEq, thiserror::Error)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(rename_all = "kebab-case"))]
#[non_exhaustive]
pub enum NewtonError {
    /// The updates did not become small.
    #[error(
        "Newton's method did not converge in {iterations} iterations: last update {update:.1e}, residual {residual:.1e}"
    )]
    NotConverged {
        /// Number of updates.
        iterations: usize,
        /// Length of the last update, where one is the size of the orbit, or the range of what is varied.
        #[cfg_attr(feature = "serde", serde(with = "crate::serialise"))]
        update: f64,
        /// Largest residual by size, in the units of the equation it is of.
        #[cfg_attr(feature = "serde", serde(with = "crate::serialise"))]
        residual: f64,
    },
    /// The bordered matrix is singular.
    #[error(
        "the Jacobian is singular after {iterations} iterations: pivot {:.1e} in column {}",
        .at.pivot,
        .at.column
    )]
    Singular {
        /// After this many updates.
        iterations: usize,
        /// Where elimination stopped.
        at: Singular,
    },
    /// The residual is not a number.
    #[error("the residual is not finite after {iterations} iterations")]
    NotFinite {
        /// After this many updates.
        iterations: usize,
    },
    /// The work was [cancelled](crate::Cancel).
    #[error("cancelled after {iterations} iterations")]
    Cancelled {
        /// After this many updates.
        iterations: usize,
    },
}

crate::error::sentence_as_debug! {
    NewtonError:
    NotConverged { iterations, update, residual }
    Singular { iterations, at }
    NotFinite { iterations }
    Cancelled { iterations }
    ;
}

impl NewtonError {
    pub(super) fn after(self, iterations: usize) -> Self {
        match self {
            Self::Singular { at, .. } => Self::Singular { iterations, at },
            Self::NotFinite { .. } => Self::NotFinite { iterations },
            other @ (Self::NotConverged { .. } | Self::Cancelled { .. }) => other,
        }
    }
}
