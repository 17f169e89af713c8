//! What can be wrong with a request, and why a computation has no answer.

mod debug;
mod display;

use std::io::ErrorKind;
use std::path::PathBuf;

use crate::attractors::basin::BasinError;
use crate::attractors::log::LogError;
use crate::event::EventKind;
#[cfg(feature = "text")]
use crate::laws::generic::DeclarationError;
use crate::model::structure::StructureError;
use crate::time::FlowError;

pub(crate) use debug::sentence_as_debug;

pub use crate::continuation::newton::NewtonError;
pub use crate::numeric::linear::Singular;

/// Why there is no result.
#[derive(Clone, PartialEq)]
#[non_exhaustive]
pub enum Error {
    /// A parameter is outside its declared range, or not finite.
    Parameter {
        /// Its name.
        name: String,
        /// Its value.
        value: f64,
        /// The range, as declared.
        range: String,
    },
    /// There is no parameter of this name.
    UnknownParameter {
        /// The name asked for.
        name: String,
        /// The names there are.
        known: Vec<String>,
    },
    /// An option of a computation is outside its range.
    Option {
        /// The option.
        name: &'static str,
        /// Its value.
        value: f64,
        /// What it must be.
        must: &'static str,
    },
    /// An option that has no default has not been given: an end of the range, or the frequency at which a parameter is varied.
    Missing {
        /// The option.
        name: &'static str,
    },
    /// What was asked for cannot be varied.
    Varied {
        /// Its name.
        name: String,
        /// What it must be.
        must: &'static str,
    },
    /// Both ends of the range are the same.
    EmptyRange {
        /// The value of both.
        value: f64,
    },
    /// Too few samples for the harmonics.
    Samples {
        /// Samples asked for.
        samples: usize,
        /// The least that can be used.
        least: usize,
        /// Harmonics of the balance.
        harmonics: usize,
    },
    /// More unknowns than a dense matrix can be afforded for.
    Unknowns {
        /// Coordinates times harmonics, cosine and sine and mean.
        unknowns: usize,
        /// The most there may be.
        most: usize,
    },
    /// The levels of a law are not in increasing order for these parameters.
    Levels {
        /// Name of the law.
        law: String,
        /// The levels.
        levels: Vec<f64>,
    },
    /// The declaration has harmonics that the balance does not carry.
    Harmonics {
        /// Harmonics of the balance.
        harmonics: usize,
        /// The highest harmonic of loads, stiffness and directions, counted in the orbit's own period.
        highest: usize,
    },
    /// The system has no coordinates.
    NoCoordinates,
    /// The mass matrix is singular.
    SingularMass {
        /// Its determinant.
        determinant: f64,
    },
    /// An equation holds one second derivative alone, and its mass is negative.
    NegativeMass {
        /// The coordinate.
        coordinate: String,
        /// Its mass.
        mass: f64,
    },
    /// The mass matrix is symmetric and not positive definite: there are motions of negative kinetic energy.
    IndefiniteMass {
        /// Its smallest eigenvalue.
        eigenvalue: f64,
    },
    /// Nothing holds the system along a direction, and its mean load is not zero along it: no motion is periodic.
    CarriedAway {
        /// Value of what is varied.
        value: f64,
        /// The mean load along the direction.
        load: f64,
        /// The direction, as a sum of coordinates.
        direction: String,
    },
    /// Nothing holds the system along a direction: where its orbits are along it, shooting has no equation for.
    Free {
        /// The direction, as a sum of coordinates.
        direction: String,
    },
    /// A branch passes a value between two of its points, but the orbit there could not be computed.
    Lost {
        /// The value.
        value: f64,
        /// The value at the point before.
        from: f64,
        /// The value at the point behind.
        to: f64,
    },
    /// No orbit was found at the start of the range.
    NoStart {
        /// Where.
        value: f64,
        /// What the last attempt said.
        reason: NewtonError,
    },
    /// A state has another number of entries than the system.
    State {
        /// Entries given.
        entries: usize,
        /// Twice the number of coordinates.
        expected: usize,
    },
    /// There are not as many values as parameters.
    Values {
        /// Values given.
        values: usize,
        /// Number of parameters.
        expected: usize,
    },
    /// A force is not affine on one of its pieces, or a stiffness or a direction varies in time: there is no closed form.
    NotAffine,
    /// There is no orbit: the branch that comes near turns back before.
    Beyond {
        /// The value asked for.
        value: f64,
        /// The fold.
        fold: f64,
    },
    /// The motion from a state cannot be computed.
    Motion {
        /// Where.
        value: f64,
        /// Why.
        reason: FlowError,
    },
    /// No orbit was found at the start of the range with the work that a search may take.
    SearchLimit {
        /// Where.
        value: f64,
        /// Evaluations of the balance.
        evaluations: usize,
        /// The limit that was reached: multiplications, as estimated.
        multiplications: u64,
        /// What the last attempt said.
        reason: NewtonError,
    },
    /// Orbits were found, but none whose shortest period is the one asked for.
    NoSuchPeriod {
        /// The period asked for, in periods of the declaration.
        period: usize,
        /// Where.
        value: f64,
        /// What the attempts to find one came to.
        attempts: Attempts,
    },
    /// A motion that begins at rest does not come to rest again.
    NeverAtRest {
        /// Position of the first coordinate where it begins.
        position: f64,
    },
    /// A motion that should be free does not come back: the system has damping or an excitation.
    NotFree {
        /// How far it misses its beginning, relative to its size.
        apart: f64,
    },
    /// The first coordinate has no load with the frequency of the excitation: there is no phase to speak of.
    NoLoad,
    /// No orbit in phase resonance was found.
    NoResonance {
        /// Value of what is varied.
        value: f64,
        /// The excitation frequencies between which it was looked for.
        between: [f64; 2],
    },
    /// What motions settle to could not be looked for.
    Search {
        /// Value of what is varied.
        value: f64,
        /// Why.
        reason: BasinError,
    },
    /// No branch begins at an event, or none was found.
    NoBranch {
        /// What kind of event it is.
        kind: EventKind,
        /// Value of what is varied there.
        value: f64,
    },
    /// A file could not be written.
    File {
        /// Its path.
        path: PathBuf,
        /// What the system said.
        kind: ErrorKind,
    },
    /// A motion cannot be continued.
    Flow(FlowError),
    /// What a long computation has done cannot be kept.
    Log(LogError),
    /// A structure cannot be built.
    Structure(StructureError),
    /// A declaration cannot be read.
    #[cfg(feature = "text")]
    Declaration(DeclarationError),
}

sentence_as_debug! {
    Error:
    Parameter { name, value, range }
    UnknownParameter { name, known }
    Option { name, value, must }
    Missing { name }
    Varied { name, must }
    EmptyRange { value }
    Samples { samples, least, harmonics }
    Unknowns { unknowns, most }
    Levels { law, levels }
    Harmonics { harmonics, highest }
    NoCoordinates {}
    SingularMass { determinant }
    NegativeMass { coordinate, mass }
    IndefiniteMass { eigenvalue }
    CarriedAway { value, load, direction }
    Free { direction }
    Lost { value, from, to }
    NoStart { value, reason }
    State { entries, expected }
    Values { values, expected }
    NotAffine {}
    Beyond { value, fold }
    Motion { value, reason }
    SearchLimit { value, evaluations, multiplications, reason }
    NoSuchPeriod { period, value, attempts }
    NeverAtRest { position }
    NotFree { apart }
    NoLoad {}
    NoResonance { value, between }
    Search { value, reason }
    NoBranch { kind, value }
    File { path, kind }
    ;
    Flow
    Log
    Structure
    #[cfg(feature = "text")]
    Declaration
}

impl From<FlowError> for Error {
    fn from(error: FlowError) -> Self {
        Self::Flow(error)
    }
}

impl From<LogError> for Error {
    fn from(error: LogError) -> Self {
        Self::Log(error)
    }
}

impl From<StructureError> for Error {
    fn from(error: StructureError) -> Self {
        Self::Structure(error)
    }
}

#[cfg(feature = "text")]
impl From<DeclarationError> for Error {
    fn from(error: DeclarationError) -> Self {
        Self::Declaration(error)
    }
}

/// What attempts to find an orbit of a longer period came to.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
#[non_exhaustive]
pub struct Attempts {
    /// As many as there are disturbances to begin with.
    pub planned: usize,
    /// Fewer if they took the work that a search is allowed.
    pub made: usize,
    /// Those that led to an orbit of a shorter period.
    pub shorter: usize,
    /// Evaluations of the balance.
    pub evaluations: usize,
}

impl std::fmt::Display for Attempts {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let Self {
            planned,
            made,
            shorter,
            evaluations,
        } = self;
        if made < planned {
            write!(
                f,
                "a search may take no more work after {made} of {planned} attempts and {evaluations} evaluations of the balance; {shorter}"
            )?;
        } else {
            write!(f, "{shorter} of {made} attempts")?;
        }
        write!(
            f,
            " led to an orbit of a shorter period, the others to none"
        )
    }
}

impl std::error::Error for Error {
    fn source(&self) -> Option<&(dyn std::error::Error + 'static)> {
        match self {
            Self::Motion { reason, .. } => Some(reason),
            Self::Search { reason, .. } => Some(reason),
            Self::NoStart { reason, .. } | Self::SearchLimit { reason, .. } => Some(reason),
            _ => None,
        }
    }
}
