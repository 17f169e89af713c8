//! Why there is no diagram, or no backbone curve.

use crate::attractors::basin::BasinError;
use crate::error::{ErrorKind, room_error};
use crate::numeric::decimal::Decimal;

/// Why there is no diagram, or no backbone curve.
#[derive(Clone, PartialEq, thiserror::Error)]
pub(crate) enum BifurcationError {
    /// A motion that begins at rest does not come to rest again.
    #[error("the motion from rest at {position} does not come to rest again")]
    NeverAtRest {
        /// Position of the first coordinate where it begins.
        position: f64,
    },
    /// A motion that should be free does not come back: the system has damping or an excitation.
    #[error(
        "the motion misses its beginning by {apart:.1e} of its size after a period: set damping and excitation to zero"
    )]
    NotFree {
        /// How far it misses its beginning, relative to its size.
        apart: f64,
    },
    /// Matrices or forces at rest are not symmetric: there is no potential, and no mode.
    #[error(
        "mass and stiffness at rest differ from symmetry by {off:.1e}: modes are those of forces that have a potential"
    )]
    NoPotential {
        /// The largest difference of two entries.
        off: f64,
    },
    /// The mass matrix is not positive.
    #[error("a motion has no kinetic energy: there are no modes")]
    NoKineticEnergy,
    /// A mode that is not there, that nothing holds, or that does not move what is varied.
    #[error(
        "no free oscillation begins at mode {mode}: {modes} modes move {coordinate} and come back to rest"
    )]
    NoMode {
        /// Number of the mode, from one on.
        mode: usize,
        /// How many there are.
        modes: usize,
        /// What is varied.
        coordinate: String,
    },
    /// Forces at right angles to rates keep the energy, and motions do not come to rest.
    #[error(
        "gyroscopic forces of up to {largest:.1e} for a unit rate: free oscillations are followed where they come to rest"
    )]
    Gyroscopic {
        /// The largest entry of the damping matrix that is skew-symmetric.
        largest: f64,
    },
    /// No coordinate has a load with the frequency of the excitation: there is no phase to speak of.
    #[error("no load has the frequency of the excitation: there is no phase resonance")]
    NoLoad,
    /// No orbit in phase resonance was found.
    #[error(
        "no orbit in phase resonance found at {} between the excitation frequencies {} and {}",
        Decimal::plain(*.value),
        Decimal::plain(*.from),
        Decimal::plain(*.to)
    )]
    NoResonance {
        /// Value of what is varied.
        value: f64,
        /// The excitation frequency from which it was looked for.
        from: f64,
        /// The one to which.
        to: f64,
    },
    /// What motions settle to could not be looked for.
    #[error("attractors at {} could not be looked for", Decimal::plain(*.value))]
    Search {
        /// Value of what is varied.
        value: f64,
        /// Why.
        #[source]
        reason: BasinError,
    },
}

room_error! {
    BifurcationError, BifurcationError::kind;
    NeverAtRest { position }
    NotFree { apart }
    NoPotential { off }
    NoKineticEnergy {}
    NoMode { mode, modes, coordinate }
    Gyroscopic { largest }
    NoLoad {}
    NoResonance { value, from, to }
    Search { value, reason }
    ;
}

impl BifurcationError {
    fn kind(&self) -> ErrorKind {
        match self {
            Self::NotFree { .. }
            | Self::NoPotential { .. }
            | Self::NoKineticEnergy
            | Self::Gyroscopic { .. }
            | Self::NoLoad => ErrorKind::Model,
            Self::NeverAtRest { .. } | Self::NoMode { .. } | Self::NoResonance { .. } => {
                ErrorKind::NoOrbit
            }
            Self::Search { reason, .. } => reason.kind(),
        }
    }
}
