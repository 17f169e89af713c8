//! What the compiler knows, as the types of the runtime.

use std::borrow::Cow;

use hertzian_compiler::facts as known;
use hertzian_compiler::interpret::{self as lowered, Family, Member};
use hertzian_compiler::ir;

use crate::law::{
    ArgumentFacts, Exponent, LawFacts, LevelFacts, PieceFacts, Quantity, RateDependence, TermFacts,
    Variation,
};
use crate::laws::generic::{InterpretedLaw, LawData, LevelData, Node, PieceData};
use crate::system::{Bound, ContactFacts, ParameterFacts, Part, Place, SystemFacts, Wave};

pub(super) fn system(model: &ir::Model) -> SystemFacts {
    let coordinates = model.coordinates.iter();
    let parameters = model.parameters.iter();
    let contacts = model.contacts.iter();
    SystemFacts {
        name: model.name.to_string().into(),
        equation: model.equation.clone().into(),
        coordinates: coordinates.map(|name| name.clone().into()).collect(),
        parameters: parameters
            .map(|parameter| ParameterFacts {
                name: parameter.name.to_string().into(),
                documentation: parameter.documentation.clone().into(),
                minimum: bound(parameter.minimum),
                maximum: bound(parameter.maximum),
            })
            .collect(),
        divisor: model.divisor,
        laws: model.laws.len(),
        contacts: contacts
            .map(|contact| ContactFacts { law: contact.law })
            .collect(),
        places: model
            .coefficients
            .iter()
            .map(|&(at, _)| place(at))
            .collect(),
    }
}

pub(super) fn law(family: Family) -> InterpretedLaw {
    let nodes: Cow<'static, [Node]> = nodes(&family.nodes).into();
    let part = |member: Member| {
        let data = data(&member, nodes.clone());
        InterpretedLaw::compiled(facts(member), data)
    };
    let whole = part(family.whole);
    match family.parts.map(|parts| parts.map(part)) {
        Some([spring, primitive]) => whole.with_parts(spring, primitive),
        None => whole,
    }
}

pub(super) fn nodes(nodes: &[lowered::Node]) -> Vec<Node> {
    nodes.iter().copied().map(node).collect()
}

fn node(node: lowered::Node) -> Node {
    match node {
        lowered::Node::Number(value) => Node::Number(value),
        lowered::Node::Gap => Node::Gap,
        lowered::Node::Rate => Node::Rate,
        lowered::Node::Argument(index) => Node::Argument(index),
        lowered::Node::Add(a, b) => Node::Add(a, b),
        lowered::Node::Subtract(a, b) => Node::Subtract(a, b),
        lowered::Node::Multiply(a, b) => Node::Multiply(a, b),
        lowered::Node::Divide(a, b) => Node::Divide(a, b),
        lowered::Node::Negate(a) => Node::Negate(a),
        lowered::Node::Absolute(a) => Node::Absolute(a),
        lowered::Node::Sign(a) => Node::Sign(a),
        lowered::Node::Integer(a, exponent) => Node::Integer(a, exponent),
        lowered::Node::Power(a, b) => Node::Power(a, b),
        lowered::Node::PowerLog(a, b) => Node::PowerLog(a, b),
        lowered::Node::Sine(a) => Node::Sine(a),
        lowered::Node::Cosine(a) => Node::Cosine(a),
        lowered::Node::Exponential(a) => Node::Exponential(a),
        lowered::Node::Tanh(a) => Node::Tanh(a),
    }
}

fn data(member: &Member, nodes: Cow<'static, [Node]>) -> LawData {
    let levels = member.level_data.iter();
    let pieces = member.piece_data.iter();
    LawData {
        nodes,
        levels: levels
            .map(|level| LevelData {
                value: level.value,
                by_argument: level.by_argument.clone().into(),
            })
            .collect(),
        pieces: pieces
            .map(|piece| PieceData {
                force: piece.force,
                by_gap: piece.by_gap,
                by_rate: piece.by_rate,
                by_argument: piece.by_argument.clone().into(),
            })
            .collect(),
    }
}

fn facts(member: Member) -> LawFacts {
    let facts = member.facts;
    LawFacts {
        arguments: arguments(&member.law),
        name: member.law.name.into(),
        levels: facts.levels.into_iter().map(level).collect(),
        pieces: facts.pieces.into_iter().map(piece).collect(),
        rate: match facts.rate {
            known::RateDependence::None => RateDependence::None,
            known::RateDependence::Linear => RateDependence::Linear,
            known::RateDependence::General => RateDependence::General,
        },
        odd: facts.odd,
    }
}

fn arguments(law: &ir::Law) -> Cow<'static, [ArgumentFacts]> {
    let unbounded = (ir::Bound::Unbounded, ir::Bound::Unbounded);
    let ranges = law
        .ranges
        .iter()
        .copied()
        .chain(std::iter::repeat(unbounded));
    let arguments = law.arguments.iter().cloned().zip(ranges);
    arguments
        .map(|(name, (minimum, maximum))| ArgumentFacts {
            name: name.into(),
            minimum: bound(minimum),
            maximum: bound(maximum),
        })
        .collect()
}

fn level(facts: known::LevelFacts) -> LevelFacts {
    LevelFacts {
        belongs_above: facts.belongs_above,
        force_jumps: facts.force_jumps,
        by_gap_jumps: facts.by_gap_jumps,
        by_rate_jumps: facts.by_rate_jumps,
        unbounded_by_gap: facts.unbounded_by_gap,
    }
}

fn piece(facts: known::PieceFacts) -> PieceFacts {
    PieceFacts {
        affine: facts.affine,
        force: variation(facts.force),
        by_gap: variation(facts.by_gap),
        by_rate: variation(facts.by_rate),
        by_argument: facts.by_argument.into_iter().map(variation).collect(),
        terms: facts.terms.iter().map(term).collect(),
    }
}

fn variation(variation: known::Variation) -> Variation {
    match variation {
        known::Variation::Zero => Variation::Zero,
        known::Variation::Constant => Variation::Constant,
        known::Variation::Varying => Variation::Varying,
    }
}

fn term(term: &known::Term) -> TermFacts {
    TermFacts {
        of: match term.of {
            known::Quantity::Force => Quantity::Force,
            known::Quantity::ByGap => Quantity::ByGap,
            known::Quantity::ByRate => Quantity::ByRate,
            known::Quantity::ByArgument(index) => Quantity::ByArgument(index),
        },
        lower: exponent(term.lower),
        upper: exponent(term.upper),
        logarithm: term.logarithm,
    }
}

fn exponent(exponent: known::Exponent) -> Exponent {
    Exponent {
        number: exponent.number.to_f64(),
        argument: exponent.argument,
    }
}

fn bound(bound: ir::Bound) -> Bound {
    match bound {
        ir::Bound::Unbounded => Bound::Unbounded,
        ir::Bound::Included(value) => Bound::Included(value),
        ir::Bound::Excluded(value) => Bound::Excluded(value),
    }
}

fn wave(wave: ir::Wave) -> Wave {
    Wave {
        harmonic: wave.harmonic,
        part: if wave.sine { Part::Sine } else { Part::Cosine },
    }
}

fn place(place: ir::Place) -> Place {
    match place {
        ir::Place::Mass { row, column } => Place::Mass { row, column },
        ir::Place::Damping { row, column } => Place::Damping { row, column },
        ir::Place::Stiffness {
            row,
            column,
            wave: phase,
        } => Place::Stiffness {
            row,
            column,
            wave: wave(phase),
        },
        ir::Place::Load { row, wave: phase } => Place::Load {
            row,
            wave: wave(phase),
        },
        ir::Place::ForceDirection {
            contact,
            row,
            wave: phase,
        } => Place::ForceDirection {
            contact,
            row,
            wave: wave(phase),
        },
        ir::Place::GapDirection {
            contact,
            column,
            wave: phase,
        } => Place::GapDirection {
            contact,
            column,
            wave: wave(phase),
        },
        ir::Place::Offset {
            contact,
            wave: phase,
        } => Place::Offset {
            contact,
            wave: wave(phase),
        },
        ir::Place::Argument { contact, index } => Place::Argument { contact, index },
    }
}
