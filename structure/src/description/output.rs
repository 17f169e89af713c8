//! Outputs: displacements, rates and accelerations along directions.

use super::direction::Direction;

/// What an output takes along its direction.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum OutputKind {
    /// Coordinates.
    #[default]
    Displacement,
    /// Their first derivatives by time.
    Rate,
    /// Their second derivatives by time, as the equations of motion give them: they jump where the force of a contact does.
    Acceleration,
}

impl OutputKind {
    /// How many derivatives by time it takes.
    pub(crate) fn derivatives(self) -> i32 {
        match self {
            Self::Displacement => 0,
            Self::Rate => 1,
            Self::Acceleration => 2,
        }
    }
}

/// An output: a linear combination of coordinates, of rates or of accelerations, by its name.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Output {
    pub(crate) name: String,
    pub(crate) kind: OutputKind,
    pub(crate) direction: Direction,
    pub(crate) unit: String,
    pub(crate) documentation: String,
}
