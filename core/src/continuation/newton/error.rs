//! Why there is no solution.

use crate::numeric::linear::Singular;

/// Why an iteration ended without a solution.
#[derive(Clone, Copy, PartialEq)]
#[non_exhaustive]
pub enum NewtonError {
    /// The updates did not become small.
    NotConverged {
        /// Number of updates.
        iterations: usize,
        /// Length of the last update, where one is the size of the orbit, or the range of what is varied.
        update: f64,
        /// Largest residual by size, in the units of the equation it is of.
        residual: f64,
    },
    /// The bordered matrix is singular.
    Singular {
        /// After this many updates.
        iterations: usize,
        /// Where elimination stopped.
        at: Singular,
    },
    /// The residual is not a number.
    NotFinite {
        /// After this many updates.
        iterations: usize,
    },
}

crate::error::sentence_as_debug! {
    NewtonError:
    NotConverged { iterations, update, residual }
    Singular { iterations, at }
    NotFinite { iterations }
    ;
}

impl std::fmt::Display for NewtonError {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::NotConverged {
                iterations,
                update,
                residual,
            } => write!(
                f,
                "Newton's method did not converge in {iterations} iterations: last update {update:.1e}, residual {residual:.1e}"
            ),
            Self::Singular { iterations, at } => write!(
                f,
                "the Jacobian is singular after {iterations} iterations: pivot {:.1e} in column {}",
                at.pivot, at.column
            ),
            Self::NotFinite { iterations } => {
                write!(
                    f,
                    "the residual is not finite after {iterations} iterations"
                )
            }
        }
    }
}

impl std::error::Error for NewtonError {}

impl NewtonError {
    pub(super) fn after(self, iterations: usize) -> Self {
        match self {
            Self::Singular { at, .. } => Self::Singular { iterations, at },
            Self::NotFinite { .. } => Self::NotFinite { iterations },
            other @ Self::NotConverged { .. } => other,
        }
    }
}
