//! Why there is no solution.

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
        "the Jacobian is singular after {iterations} iterations: pivot {pivot:.1e} in column {column}"
    )]
    Singular {
        /// After this many updates.
        iterations: usize,
        /// Column without a usable pivot, where elimination stopped.
        column: usize,
        /// The largest candidate there, relative to the row it stands in.
        #[cfg_attr(feature = "serde", serde(with = "crate::serialise"))]
        pivot: f64,
    },
    /// The residual is not a number.
    #[error("the residual is not finite after {iterations} iterations")]
    NotFinite {
        /// After this many updates.
        iterations: usize,
    },
    /// The contacts of the orbit open and close in another order than its equations have, and none that have that order lead to it.
    #[error(
        "its contacts open and close in another order, and no equations were found that have it"
    )]
    NoEquations {},
    /// The work was [cancelled](crate::Cancel).
    #[error("cancelled after {iterations} iterations")]
    Cancelled {
        /// After this many updates.
        iterations: usize,
    },
}

crate::error::room_error! {
    NewtonError;
    NotConverged { iterations, update, residual }
    Singular { iterations, column, pivot }
    NotFinite { iterations }
    NoEquations {}
    Cancelled { iterations }
    ;
}

impl NewtonError {
    pub(super) fn after(self, iterations: usize) -> Self {
        match self {
            Self::Singular { column, pivot, .. } => Self::Singular {
                iterations,
                column,
                pivot,
            },
            Self::NotFinite { .. } => Self::NotFinite { iterations },
            other @ (Self::NotConverged { .. } | Self::NoEquations {} | Self::Cancelled { .. }) => {
                other
            }
        }
    }
}
