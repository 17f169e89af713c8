//! What can be wrong with a structure.

use crate::error::{ErrorKind, room_error};
use crate::numeric::decimal::Decimal;

/// What is wrong with a structure.
#[derive(Clone, PartialEq, thiserror::Error)]
pub(crate) enum StructureError {
    /// A matrix is not as many rows and columns as the structure has coordinates.
    #[error(
        "the {matrix} matrix is {rows} by {columns}; the mass matrix has {coordinates} rows, and all must be square, of one size, and not empty"
    )]
    MatrixSize {
        /// Which one.
        matrix: &'static str,
        /// Its rows.
        rows: usize,
        /// Its columns.
        columns: usize,
        /// Rows of the mass matrix.
        coordinates: usize,
    },
    /// A direction of a contact has not as many entries as there are coordinates.
    #[error(
        "a direction of contact {contact} has {entries} entries; there are {coordinates} coordinates"
    )]
    DirectionSize {
        /// Which contact.
        contact: usize,
        /// How many entries.
        entries: usize,
        /// How many there must be.
        coordinates: usize,
    },
    /// A direction turns by what is no fraction that can be followed.
    #[error(
        "the direction of contact {contact} turns by {numerator}/{denominator} of the frequency: there is a common period of all contacts and loads only where denominators in lowest terms have a common multiple of at most {most}"
    )]
    Turn {
        /// Which contact.
        contact: usize,
        /// Numerator of the fraction.
        numerator: u32,
        /// Its denominator.
        denominator: u32,
        /// The largest common multiple that there may be.
        most: u32,
    },
    /// The direction of a contact turns, and its force has another one.
    #[error("the direction of contact {contact} turns: its force cannot have another one")]
    TurningForce {
        /// Which contact.
        contact: usize,
    },
    /// A number is infinite or not a number.
    #[error("{} in {place}", Decimal::plain(*.value))]
    NotFinite {
        /// Where it stands.
        place: String,
        /// The number.
        value: f64,
    },
    /// The mass matrix has no inverse.
    #[error("the mass matrix has no inverse: its smallest pivot is {pivot:e} of the largest")]
    SingularMass {
        /// Smallest pivot, as a share of the largest.
        pivot: f64,
    },
    /// A load acts on a coordinate that is not there.
    #[error("a load on coordinate {coordinate}, counted from zero; there are {coordinates}")]
    NoCoordinate {
        /// The coordinate asked for, from zero.
        coordinate: usize,
        /// How many there are.
        coordinates: usize,
    },
    /// A law has another number of arguments.
    #[error("law `{law}` has {expected} arguments, and {given} were given")]
    Arguments {
        /// Its name.
        law: String,
        /// How many it has.
        expected: usize,
        /// How many were given.
        given: usize,
    },
    /// An argument of a law is outside the range that the law declares for it.
    #[error(
        "argument `{argument}` of law `{law}` is {}, outside its range {range}",
        Decimal::plain(*.value)
    )]
    Range {
        /// Name of the law.
        law: String,
        /// Name of the argument.
        argument: String,
        /// Its value.
        value: f64,
        /// The range, as declared.
        range: String,
    },
    /// A parameter has no name, or that of the excitation frequency, `omega`.
    #[error(
        "a parameter cannot be called `{parameter}`: it needs a name, and `omega` is the excitation frequency"
    )]
    Name {
        /// The name.
        parameter: String,
    },
    /// An output has no name, or that of something else.
    #[error(
        "an output cannot be called `{output}`: it needs a name that no coordinate, parameter or other output has"
    )]
    OutputName {
        /// The name.
        output: String,
    },
    /// An output has not as many factors as there are coordinates.
    #[error("output `{output}` has {entries} factors; there are {coordinates} coordinates")]
    OutputSize {
        /// Its name.
        output: String,
        /// How many factors.
        entries: usize,
        /// How many there must be.
        coordinates: usize,
    },
    /// An output is the force of a contact that is not there.
    #[error(
        "output `{output}` is the force of contact {contact}, counted from zero; there are {contacts}"
    )]
    NoContact {
        /// Its name.
        output: String,
        /// The contact asked for, from zero.
        contact: usize,
        /// How many there are.
        contacts: usize,
    },
    /// One name was used with two values.
    #[error("parameter `{parameter}` is {first} in one place and {second} in another")]
    TwoValues {
        /// The name.
        parameter: String,
        /// Its first value.
        first: f64,
        /// Another.
        second: f64,
    },
}

room_error! {
    StructureError, |_| ErrorKind::Model;
    MatrixSize { matrix, rows, columns, coordinates }
    DirectionSize { contact, entries, coordinates }
    Turn { contact, numerator, denominator, most }
    TurningForce { contact }
    NotFinite { place, value }
    SingularMass { pivot }
    NoCoordinate { coordinate, coordinates }
    Arguments { law, expected, given }
    Range { law, argument, value, range }
    Name { parameter }
    OutputName { output }
    OutputSize { output, entries, coordinates }
    NoContact { output, contact, contacts }
    TwoValues { parameter, first, second }
    ;
}
