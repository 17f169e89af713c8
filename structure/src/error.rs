//! What can be wrong with a structure.

/// What is wrong with a structure. Coordinates are counted from zero.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum StructureError {
    /// There are no coordinates.
    #[error("the mass matrix is empty")]
    Empty,
    /// A matrix has another size than the mass matrix.
    #[error(
        "the {matrix} matrix is {rows} by {columns}; the mass matrix has {coordinates} rows, and all must be square and of one size"
    )]
    Size {
        /// Which one.
        matrix: &'static str,
        /// Its rows.
        rows: usize,
        /// Its columns.
        columns: usize,
        /// Rows of the mass matrix.
        coordinates: usize,
    },
    /// A matrix is not symmetric, or not skew-symmetric, as it must be.
    #[error(
        "the {matrix} matrix is not {kind}: {value} in row {row} and column {column}, {mirrored} the other way round (counted from zero)"
    )]
    Symmetry {
        /// Which one.
        matrix: &'static str,
        /// What it must be.
        kind: &'static str,
        /// Row.
        row: usize,
        /// Column.
        column: usize,
        /// What stands there.
        value: f64,
        /// What stands in its mirror image.
        mirrored: f64,
    },
    /// A mass is negative.
    #[error("the mass of coordinate {coordinate} is {mass}: it must not be negative")]
    NegativeMass {
        /// The coordinate.
        coordinate: usize,
        /// Its mass.
        mass: f64,
    },
    /// The direction of a contact turns, and its force has another one.
    #[error("the direction of {what} turns: its force cannot have another one")]
    TurningForce {
        /// Which contact.
        what: String,
    },
    /// A damping ratio or factor is negative or not finite.
    #[error("damping of {value}: ratios and factors must be finite and not negative")]
    Damping {
        /// The number.
        value: f64,
    },
    /// Frequencies of a table do not ascend.
    #[error("the frequencies of a table of damping ratios must ascend")]
    Table,
    /// A coordinate that is not there.
    #[error("{what} is at coordinate {coordinate}, counted from zero; there are {coordinates}")]
    NoCoordinate {
        /// What stands there.
        what: String,
        /// The coordinate.
        coordinate: usize,
        /// How many there are.
        coordinates: usize,
    },
    /// A direction is zero.
    #[error("{what} has no coordinate with a factor other than zero")]
    NoDirection {
        /// What it is of.
        what: String,
    },
    /// A number is infinite or not a number.
    #[error("{what} is {value}")]
    NotFinite {
        /// What it is of.
        what: String,
        /// The number.
        value: f64,
    },
}
