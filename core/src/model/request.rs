//! What can be wrong with a request.

use std::str::FromStr;

use crate::error::ErrorKind;
use crate::event::EventKind;
use crate::numeric::decimal::Decimal;

/// What is wrong with a request.
#[derive(Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum RequestError {
    /// A parameter is outside its declared range, or not finite.
    #[error("parameter {name} = {} is outside its range {range}", Decimal::plain(*.value))]
    Parameter {
        /// Its name.
        name: String,
        /// Its value.
        value: f64,
        /// The range, as declared.
        range: String,
    },
    /// There is no parameter of this name.
    #[error("there is no parameter {name}; there are {}", listed(.known))]
    UnknownParameter {
        /// The name asked for.
        name: String,
        /// The names there are.
        known: Vec<String>,
    },
    /// An option of a computation is outside its range.
    #[error("{name} = {}: {must}", Decimal::plain(*.value))]
    Option {
        /// The option.
        name: &'static str,
        /// Its value.
        value: f64,
        /// What it must be.
        must: &'static str,
    },
    /// An option that has no default has not been given: an end of the range, or the frequency at which a parameter is varied.
    #[error("{why}: `{name}(...)` has not been called")]
    Missing {
        /// The option.
        name: &'static str,
        /// What is not known without it.
        why: &'static str,
    },
    /// What was asked for cannot be varied.
    #[error("what is varied is {name}: it {must}")]
    Varied {
        /// Its name.
        name: String,
        /// What it must be.
        must: &'static str,
    },
    /// Both ends of the range are the same.
    #[error("the range is empty: from and to are both {}", Decimal::plain(*.value))]
    EmptyRange {
        /// The value of both.
        value: f64,
    },
    /// Too few samples for the harmonics.
    #[error("{samples} samples are too few for {harmonics} harmonics: take {least} or more")]
    Samples {
        /// Samples asked for.
        samples: usize,
        /// The least that can be used.
        least: usize,
        /// Harmonics of the balance.
        harmonics: usize,
    },
    /// More unknowns than a dense matrix can be afforded for.
    #[error(
        "{unknowns} unknowns are too many, at most {most}: take fewer harmonics or a shorter period"
    )]
    Unknowns {
        /// Coordinates times harmonics, cosine and sine and mean.
        unknowns: usize,
        /// The most there may be.
        most: usize,
    },
    /// The declaration has harmonics that the balance does not carry.
    #[error(
        "the declaration has harmonic {highest} of the orbit, and the balance only {harmonics}: take more harmonics"
    )]
    Harmonics {
        /// Harmonics of the balance.
        harmonics: usize,
        /// The highest harmonic of loads, stiffness and directions, counted in the orbit's own period.
        highest: usize,
    },
    /// A state has another number of entries than the system.
    #[error(
        "the state has {entries} entries instead of {expected}: all positions, then all velocities"
    )]
    State {
        /// Entries given.
        entries: usize,
        /// Twice the number of coordinates.
        expected: usize,
    },
    /// A branch that was read from a file was asked for what takes its model.
    #[error("the branch was read from a file and has no model: give it one by `attach(&model)`")]
    Detached,
    /// A backbone was asked for orbits that are not in it, or for derivatives or multipliers, which are those at a fixed frequency.
    #[error(
        "the branch is a backbone, whose frequency goes with the orbit: it has no orbits but its own, and neither derivatives nor multipliers; ask for them by a frequency response"
    )]
    Backbone,
    /// The model given to a branch is not its own.
    #[error("the branch is one of {expected}, and {found} has another name or other equations")]
    OtherModel {
        /// Name of the branch's own model.
        expected: String,
        /// Name of the one given.
        found: String,
    },
    /// Neither an output nor a coordinate nor a contact has this name.
    #[error("no output, coordinate or contact is called {name}: there are {}", listed(.known))]
    UnknownSignal {
        /// The name.
        name: String,
        /// The names of all of them.
        known: Vec<String>,
    },
    /// No coordinate has this name.
    #[error("no coordinate is called {name}: there are {}", listed(.known))]
    UnknownCoordinate {
        /// The name.
        name: String,
        /// The names of all of them.
        known: Vec<String>,
    },
    /// Neither an output nor a coordinate has the name that accuracy is asked of.
    #[error("accuracy is that of an output or a coordinate, and none is called {name}: there are {}", listed(.known))]
    NoAccuracy {
        /// The name.
        name: String,
        /// The names of all of them.
        known: Vec<String>,
    },
    /// What is asked of a signal is none of what can be.
    #[error(
        "nothing is measured by `{name}`: p2p, max, min, mean, rms, crest, h1 or phase1 with the number of a harmonic, and of contacts impulse, impacts and piece1"
    )]
    UnknownMeasure {
        /// What was asked for.
        name: String,
    },
    /// What only a contact has was asked of something else.
    #[error("{measure} is one of contacts, and {name} is none")]
    NoContactMeasure {
        /// The name of the signal.
        name: String,
        /// What was asked for.
        measure: String,
    },
    /// The law of a contact has no such piece.
    #[error("{name} has no piece {piece}: its law has {pieces}")]
    NoPiece {
        /// The name of the contact.
        name: String,
        /// The number that was asked for, from one on.
        piece: usize,
        /// How many there are.
        pieces: usize,
    },
    /// Orbits have no such harmonic.
    #[error("harmonic {harmonic} of {name} was not computed: these orbits have {highest} of them")]
    NoHarmonic {
        /// The name of the signal.
        name: String,
        /// The number that was asked for.
        harmonic: usize,
        /// The highest number of an orbit.
        highest: usize,
    },
    /// No kind of events has this name.
    #[error("no event is called {name}: there are {}", listed(.known))]
    UnknownEvent {
        /// What was asked for.
        name: String,
        /// The names there are.
        known: Vec<String>,
    },
    /// What a branch goes on from does not belong to it: the file that it was read from has been changed.
    #[error("what the branch goes on from is none of this model and request")]
    Rest,
    /// There are not as many values as parameters.
    #[error("{values} values were given for {expected} parameters")]
    Values {
        /// Values given.
        values: usize,
        /// Number of parameters.
        expected: usize,
    },
}

crate::error::room_error! {
    RequestError, |_| ErrorKind::Request;
    Parameter { name, value, range }
    UnknownParameter { name, known }
    Option { name, value, must }
    Missing { name, why }
    Varied { name, must }
    EmptyRange { value }
    Samples { samples, least, harmonics }
    Unknowns { unknowns, most }
    Harmonics { harmonics, highest }
    State { entries, expected }
    Detached {}
    Backbone {}
    OtherModel { expected, found }
    UnknownSignal { name, known }
    UnknownCoordinate { name, known }
    NoAccuracy { name, known }
    UnknownMeasure { name }
    NoContactMeasure { name, measure }
    NoPiece { name, piece, pieces }
    NoHarmonic { name, harmonic, highest }
    UnknownEvent { name, known }
    Rest {}
    Values { values, expected }
    ;
}

fn listed(names: &[String]) -> String {
    match names {
        [] => "none".to_owned(),
        names => names.join(", "),
    }
}

/// By the name that is shown: `fold`, `period-doubling` and so on.
impl FromStr for EventKind {
    type Err = RequestError;

    fn from_str(text: &str) -> Result<Self, RequestError> {
        let found = Self::ALL.into_iter().find(|kind| kind.to_string() == text);
        found.ok_or_else(|| RequestError::UnknownEvent {
            name: text.to_owned(),
            known: Self::ALL.iter().map(ToString::to_string).collect(),
        })
    }
}

impl RequestError {
    /// An end of the range is missing: `from` or `to`.
    pub(crate) fn no_end(name: &'static str) -> Self {
        let why = "the range is not complete";
        Self::Missing { name, why }
    }

    /// The frequency is missing at which something else is varied or moves.
    pub(crate) fn no_omega() -> Self {
        let (name, why) = (
            "omega",
            "there is one excitation frequency, and it is not known",
        );
        Self::Missing { name, why }
    }
}
