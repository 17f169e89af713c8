//! Short ways to write facts and data as constants.

use std::borrow::Cow;

use crate::data::LawData;
use crate::law::{Exponent, LawFacts, RateDependence, TermFacts, Variation};
use crate::system::{ContactFacts, OutputFacts, ParameterFacts, Place, SystemFacts, Wave};

pub use crate::data::Node;
pub use crate::data::Node::*;
pub use crate::data::{LevelData, PieceData};
pub use crate::law::Quantity::{self, *};
pub use crate::law::Variation::*;
pub use crate::law::{ArgumentFacts, LevelFacts, PieceFacts};
pub use crate::system::Bound::{self, *};
pub use crate::system::Signal;

/// The force does not depend on the rate.
pub const INDEPENDENT: RateDependence = RateDependence::None;
/// The force is linear in the rate.
pub const LINEAR: RateDependence = RateDependence::Linear;
/// The force depends on the rate in any other way.
pub const GENERAL: RateDependence = RateDependence::General;

/// The level belongs to the piece above it.
pub const BELONGS_ABOVE: u8 = 1;
/// The force jumps.
pub const FORCE_JUMPS: u8 = 2;
/// The derivative by the gap jumps.
pub const BY_GAP_JUMPS: u8 = 4;
/// The derivative by the rate jumps.
pub const BY_RATE_JUMPS: u8 = 8;
/// The derivative by the gap is unbounded.
pub const UNBOUNDED_BY_GAP: u8 = 16;

/// The facts of a level, where two pieces meet; what is listed holds.
pub const fn meeting(list: &[u8]) -> LevelFacts {
    let mut flags = 0;
    let mut index = 0;
    while index < list.len() {
        flags |= list[index];
        index += 1;
    }
    LevelFacts {
        belongs_above: flags & BELONGS_ABOVE != 0,
        force_jumps: flags & FORCE_JUMPS != 0,
        by_gap_jumps: flags & BY_GAP_JUMPS != 0,
        by_rate_jumps: flags & BY_RATE_JUMPS != 0,
        unbounded_by_gap: flags & UNBOUNDED_BY_GAP != 0,
    }
}

/// The facts of a law.
pub const fn law_facts(
    name: &'static str,
    arguments: &'static [ArgumentFacts],
    levels: &'static [LevelFacts],
    pieces: &'static [PieceFacts],
    rate: RateDependence,
    odd: bool,
) -> LawFacts {
    LawFacts {
        name: Cow::Borrowed(name),
        arguments: Cow::Borrowed(arguments),
        levels: Cow::Borrowed(levels),
        pieces: Cow::Borrowed(pieces),
        rate,
        odd,
    }
}

/// The facts of a system.
#[allow(
    clippy::too_many_arguments,
    reason = "written by the compiler, in the order of the fields"
)]
pub const fn system_facts(
    name: &'static str,
    equation: &'static str,
    coordinates: &'static [Cow<'static, str>],
    parameters: &'static [ParameterFacts],
    divisor: u32,
    laws: usize,
    contacts: &'static [ContactFacts],
    places: &'static [Place],
) -> SystemFacts {
    measured_system(
        name,
        equation,
        coordinates,
        &[],
        parameters,
        divisor,
        laws,
        contacts,
        places,
        &[],
    )
}

/// The facts of a system with units or outputs.
#[allow(
    clippy::too_many_arguments,
    reason = "written by the compiler, in the order of the fields"
)]
pub const fn measured_system(
    name: &'static str,
    equation: &'static str,
    coordinates: &'static [Cow<'static, str>],
    units: &'static [Cow<'static, str>],
    parameters: &'static [ParameterFacts],
    divisor: u32,
    laws: usize,
    contacts: &'static [ContactFacts],
    places: &'static [Place],
    outputs: &'static [OutputFacts],
) -> SystemFacts {
    SystemFacts {
        name: Cow::Borrowed(name),
        equation: Cow::Borrowed(equation),
        coordinates: Cow::Borrowed(coordinates),
        units: Cow::Borrowed(units),
        parameters: Cow::Borrowed(parameters),
        divisor,
        laws,
        contacts: Cow::Borrowed(contacts),
        places: Cow::Borrowed(places),
        outputs: Cow::Borrowed(outputs),
    }
}

/// The facts of an output.
pub const fn output(
    name: &'static str,
    documentation: &'static str,
    unit: &'static str,
) -> OutputFacts {
    OutputFacts {
        name: Cow::Borrowed(name),
        documentation: Cow::Borrowed(documentation),
        unit: Cow::Borrowed(unit),
    }
}

/// A coefficient of an output.
pub const fn output_term(output: usize, of: Signal, wave: Wave) -> Place {
    Place::Output { output, of, wave }
}

/// An argument of a law that may have any value.
pub const fn free(name: &'static str) -> ArgumentFacts {
    ArgumentFacts::named(Cow::Borrowed(name))
}

/// An argument of a law, and its range.
pub const fn ranged(name: &'static str, minimum: Bound, maximum: Bound) -> ArgumentFacts {
    ArgumentFacts {
        name: Cow::Borrowed(name),
        minimum,
        maximum,
    }
}

/// No power.
pub const ZERO: Exponent = Exponent::ZERO;

/// The constant function of the phase.
pub const CONSTANT: Wave = Wave::CONSTANT;

/// The facts of a piece; force, by gap and by rate vary as given.
pub const fn piece(
    affine: bool,
    [force, by_gap, by_rate]: [Variation; 3],
    by_argument: &'static [Variation],
    terms: &'static [TermFacts],
) -> PieceFacts {
    PieceFacts {
        affine,
        force,
        by_gap,
        by_rate,
        by_argument: Cow::Borrowed(by_argument),
        terms: Cow::Borrowed(terms),
    }
}

/// A term with powers at the ends of its piece.
pub const fn term(of: Quantity, lower: Exponent, upper: Exponent) -> TermFacts {
    TermFacts::new(of, lower, upper)
}

/// A term with powers and a logarithm at the ends of its piece.
pub const fn term_with_logarithm(of: Quantity, lower: Exponent, upper: Exponent) -> TermFacts {
    TermFacts::new(of, lower, upper).logarithm(true)
}

/// A smooth term.
pub const fn smooth(of: Quantity) -> TermFacts {
    term(of, ZERO, ZERO)
}

/// An exponent known at compile time.
pub const fn exponent(number: f64) -> Exponent {
    Exponent::new(number)
}

/// A number plus the argument at a position.
pub const fn exponent_of(number: f64, argument: usize) -> Exponent {
    Exponent::of_argument(number, argument)
}

/// A law as data.
pub const fn data(
    nodes: &'static [Node],
    levels: &'static [LevelData],
    pieces: &'static [PieceData],
) -> LawData {
    LawData {
        nodes: Cow::Borrowed(nodes),
        levels: Cow::Borrowed(levels),
        pieces: Cow::Borrowed(pieces),
    }
}

/// The nodes of a level.
pub const fn level(value: usize, by_argument: &'static [usize]) -> LevelData {
    LevelData {
        value,
        by_argument: Cow::Borrowed(by_argument),
    }
}

/// Where a piece is among the nodes: force, by gap and by rate; and by each argument.
pub const fn at([force, by_gap, by_rate]: [usize; 3], by_argument: &'static [usize]) -> PieceData {
    PieceData {
        force,
        by_gap,
        by_rate,
        by_argument: Cow::Borrowed(by_argument),
    }
}

/// The facts of a parameter.
pub const fn parameter(
    name: &'static str,
    documentation: &'static str,
    minimum: Bound,
    maximum: Bound,
) -> ParameterFacts {
    parameter_in(name, documentation, "", minimum, maximum)
}

/// The facts of a parameter with a unit.
pub const fn parameter_in(
    name: &'static str,
    documentation: &'static str,
    unit: &'static str,
    minimum: Bound,
    maximum: Bound,
) -> ParameterFacts {
    ParameterFacts {
        name: Cow::Borrowed(name),
        documentation: Cow::Borrowed(documentation),
        unit: Cow::Borrowed(unit),
        minimum,
        maximum,
    }
}

/// `cos h tau`
pub const fn cos(harmonic: u32) -> Wave {
    Wave::cosine(harmonic)
}

/// `sin h tau`
pub const fn sin(harmonic: u32) -> Wave {
    Wave::sine(harmonic)
}

/// A contact of a law.
pub const fn contact(law: usize) -> ContactFacts {
    ContactFacts::new(law)
}

/// A contact of a law, with the unit of what that gives.
pub const fn contact_in(law: usize, unit: &'static str) -> ContactFacts {
    ContactFacts {
        law,
        unit: Cow::Borrowed(unit),
    }
}

/// An entry of `M`.
pub const fn mass(row: usize, column: usize) -> Place {
    Place::Mass { row, column }
}

/// An entry of `C`.
pub const fn damping(row: usize, column: usize) -> Place {
    Place::Damping { row, column }
}

/// An entry of `K`, times a wave.
pub const fn stiffness(row: usize, column: usize, wave: Wave) -> Place {
    Place::Stiffness { row, column, wave }
}

/// A term of the right-hand side.
pub const fn load(row: usize, wave: Wave) -> Place {
    Place::Load { row, wave }
}

/// An entry of the force direction of a contact.
pub const fn force_direction(contact: usize, row: usize, wave: Wave) -> Place {
    Place::ForceDirection { contact, row, wave }
}

/// An entry of the gap direction of a contact.
pub const fn gap_direction(contact: usize, column: usize, wave: Wave) -> Place {
    Place::GapDirection {
        contact,
        column,
        wave,
    }
}

/// A term of the offset of a contact.
pub const fn offset(contact: usize, wave: Wave) -> Place {
    Place::Offset { contact, wave }
}

/// An argument of the law of a contact.
pub const fn argument(contact: usize, index: usize) -> Place {
    Place::Argument { contact, index }
}
