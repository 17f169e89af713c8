//! Which method it is.

use std::fmt;

/// A method of computing periodic orbits, without its options: what [fits](crate::FrequencyResponse::choice), and what a branch
/// [was followed by](crate::Branch::method).
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum OrbitMethodKind {
    /// [`HarmonicBalance`](crate::HarmonicBalance).
    HarmonicBalance,
    /// [`Shooting`](crate::Shooting).
    Shooting,
    /// [`ContactEquation`](crate::ContactEquation).
    ContactEquation,
}

impl fmt::Display for OrbitMethodKind {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::HarmonicBalance => "harmonic balance",
            Self::Shooting => "shooting",
            Self::ContactEquation => "contact equation",
        })
    }
}
