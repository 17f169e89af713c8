//! Laws: from a declaration's pieces to levels and forces.

use std::collections::HashMap;

use crate::ast::{Comparison, Condition, Law};
use crate::dag::{Dag, Id, Node, Variable};
use crate::errors::{Diagnostics, Extent};
use crate::ir;

use super::algebra::{addends, affine, split_factor};
use super::expand::{Expander, Meaning};
use super::interval::{Interval, Stretch};
use super::resolve::{MOST_SEGMENTS, Segment, TOO_MANY, resolve};
use super::rules::pieces::{self, Piece};
use super::written::{Written, followed};

/// A law and what its arguments beyond the written ones stand for.
#[derive(Debug, Clone)]
pub struct Lowered {
    /// The law.
    pub law: ir::Law,
    /// What is passed beyond the written arguments: parameters, `omega`, and exponents that are expressions of them
    /// and of the written arguments.
    pub captured: Vec<Id>,
}

/// Lowers a declared law. `ranges` are those of its written arguments, from the calls.
pub fn declared(
    context: &mut Expander,
    law: &Law,
    ranges: Vec<Interval>,
    diagnostics: &mut Diagnostics,
) -> Option<Lowered> {
    let outer = enter(context, law, ranges);
    let segments = segments(context, law, diagnostics);
    let lowered = segments.map(|segments| finish(context, law.name.to_string(), segments));
    context.names = outer;
    context.arguments.clear();
    context.ranges.arguments.clear();
    lowered
}

/// Puts the names of a law in place of the coordinates; the names outside are returned.
fn enter(context: &mut Expander, law: &Law, ranges: Vec<Interval>) -> HashMap<String, Meaning> {
    let mut names = context.names.clone();
    names.retain(|_, meaning| match meaning {
        Meaning::Constant(_) => true,
        Meaning::Coordinate(_) | Meaning::Array(..) => false,
        Meaning::Value(terms) => terms.iter().all(|term| !term.moves()),
    });
    names.insert(law.gap.to_string(), Meaning::Coordinate(0));
    for (index, argument) in law.arguments.iter().enumerate() {
        names.insert(
            argument.to_string(),
            Meaning::Constant(Variable::Argument(index)),
        );
    }
    context.gap = law.gap.to_string();
    context.arguments = law.arguments.iter().map(ToString::to_string).collect();
    context.ranges.arguments = ranges;
    std::mem::replace(&mut context.names, names)
}

fn segments(
    context: &mut Expander,
    law: &Law,
    diagnostics: &mut Diagnostics,
) -> Option<Vec<Segment>> {
    if law.pieces.len() > MOST_SEGMENTS {
        diagnostics.report(Extent::at(law.name.span()), TOO_MANY);
        return None;
    }
    let written = Pieces::of(context, law, diagnostics)?;
    let place = Extent::at(law.name.span());
    let arranged = pieces::arranged(context, written.bounded, written.rest, place, diagnostics)?;
    let mut segments = Vec::new();
    let mut faulty = Vec::new();
    for piece in arranged {
        // `else` may hold on several stretches.
        if faulty.contains(&piece.index) {
            continue;
        }
        let (force, written) = written.forces[piece.index].clone();
        let stretch = Stretch {
            low: piece.low.map(|low| low.0),
            high: piece.high.map(|high| high.0),
        };
        let holds_low = piece.low.is_some_and(|low| low.1);
        let extent = law.pieces[piece.index].force.extent;
        let whole = Segment {
            stretch,
            holds_low,
            force,
            written,
        };
        match diagnostics.keep(resolve(context, whole, extent)) {
            Some(resolved) => segments.extend(resolved),
            None => faulty.push(piece.index),
        }
    }
    faulty.is_empty().then_some(segments)
}

/// The pieces of a law as they are written.
struct Pieces {
    /// The force of each.
    forces: Vec<Force>,
    /// Those with conditions.
    bounded: Vec<Piece>,
    /// The one that holds everywhere else, and where that is written.
    rest: Option<(usize, Extent)>,
}

impl Pieces {
    /// `None` if something was reported.
    fn of(context: &mut Expander, law: &Law, diagnostics: &mut Diagnostics) -> Option<Self> {
        let mut forces = Vec::new();
        let mut bounded = Vec::new();
        let mut rest = None;
        let mut sound = true;
        for (index, piece) in law.pieces.iter().enumerate() {
            let force = diagnostics.keep(force(context, &piece.force));
            sound &= force.is_some();
            forces.extend(force);
            match &piece.condition {
                Condition::Else(extent) if rest.is_some() || index + 1 < law.pieces.len() => {
                    diagnostics.report(*extent, "`else` must be the last piece");
                    sound = false;
                }
                Condition::Else(extent) => rest = Some((index, *extent)),
                Condition::Always => rest = Some((index, piece.force.extent)),
                Condition::All(comparisons, extent) => {
                    let piece = diagnostics.keep(ends(context, comparisons, index, *extent));
                    sound &= piece.is_some();
                    bounded.extend(piece);
                }
            }
        }
        sound.then_some(Self {
            forces,
            bounded,
            rest,
        })
    }
}

type Force = (Id, Vec<Written>);

/// The force of one piece as an expression in gap and rate, and what messages quote of it.
fn force(context: &mut Expander, expression: &crate::ast::Expr) -> syn::Result<Force> {
    context.written.clear();
    let terms = context.expand(expression)?;
    if let Some(term) = terms.iter().find(|term| !term.is_steady()) {
        return Err(term.extent.fault(
            "a law depends on its gap, not on time: multiply it in the equation, as in `(1 + e*cos(omega*t))*contact(x)`",
        ));
    }
    let force = context.value(&terms, expression.extent)?;
    let rebuilt = in_gap(&mut context.dag, force);
    let written = std::mem::take(&mut context.written);
    Ok((rebuilt[&force], followed(&written, &rebuilt)))
}

/// The only coordinate in a law is its gap.
fn in_gap(dag: &mut Dag, id: Id) -> HashMap<Id, Id> {
    let (gap, rate) = (dag.variable(Variable::Gap), dag.variable(Variable::Rate));
    dag.substituted(
        id,
        &HashMap::from([
            (Variable::Coordinate(0), gap),
            (Variable::Velocity(0), rate),
        ]),
    )
}

/// The ends that the comparisons of a condition set.
fn ends(
    context: &mut Expander,
    comparisons: &[Comparison],
    index: usize,
    extent: Extent,
) -> syn::Result<Piece> {
    let mut piece = Piece {
        low: None,
        high: None,
        index,
        extent,
    };
    for comparison in comparisons {
        let place = comparison.smaller.extent.to(comparison.larger.extent);
        let place = if comparisons.len() == 1 {
            extent
        } else {
            place
        };
        let (smaller, _) = force(context, &comparison.smaller)?;
        let (larger, _) = force(context, &comparison.larger)?;
        let difference = context.dag.difference(larger, smaller);
        let (level, rising) = level(context, difference, place)?;
        let end = (level, comparison.or_equal);
        let known = if rising {
            &mut piece.low
        } else {
            &mut piece.high
        };
        // Of two bounds on one side the tighter one counts.
        let tighter = match *known {
            None => true,
            Some((other, _)) => {
                let order = pieces::order_is_known(context, other, level, place)?;
                if rising { order.is_lt() } else { order.is_gt() }
            }
        };
        if tighter {
            *known = Some(end);
        }
    }
    Ok(piece)
}

/// The root of a condition `difference > 0`, and whether it holds above it.
fn level(context: &mut Expander, difference: Id, extent: Extent) -> syn::Result<(Id, bool)> {
    let gap = context.label(Variable::Gap);
    if context.dag.depends_on(difference, Variable::Rate) {
        return Err(extent.fault(format!(
            "a piece is bounded by the gap, not by its rate: compare `{gap}` with numbers and parameters"
        )));
    }
    let affine = affine(&mut context.dag, difference, Variable::Gap);
    let Some((slope, rest)) = affine.filter(|_| context.dag.depends_on(difference, Variable::Gap))
    else {
        return Err(extent.fault(format!(
            "compare `{gap}` with numbers and parameters, as in `{gap} > play`"
        )));
    };
    let bounds = context.ranges.bounds(&mut context.dag, slope, Stretch::ALL);
    if !bounds.excludes_zero() {
        return Err(extent.fault(format!(
            "divide this condition so that `{gap}` stands alone on one side"
        )));
    }
    let quotient = context.dag.quotient(rest, slope);
    Ok((context.dag.negate(quotient), bounds.is_positive()))
}

/// Makes the law of adjacent segments; those with one force are joined, and parameters become arguments.
pub fn finish(context: &mut Expander, name: String, segments: Vec<Segment>) -> Lowered {
    let mut forces: Vec<Id> = Vec::new();
    let mut levels: Vec<ir::Level> = Vec::new();
    for segment in segments {
        if forces.last() == Some(&segment.force) {
            continue;
        }
        if let (Some(value), false) = (segment.stretch.low, forces.is_empty()) {
            levels.push(ir::Level {
                value,
                belongs_above: segment.holds_low,
            });
        }
        forces.push(segment.force);
    }
    let written = context.arguments.len();
    let mut captured = capture_exponents(&mut context.dag, &mut forces, written);
    let mut variables: Vec<Variable> = Vec::new();
    for id in forces
        .iter()
        .copied()
        .chain(levels.iter().map(|level| level.value))
    {
        variables.extend(context.dag.variables(id));
    }
    variables.retain(|variable| matches!(variable, Variable::Parameter(_) | Variable::Omega));
    variables.sort_unstable();
    variables.dedup();
    let mut by = HashMap::new();
    for variable in variables {
        let argument = Variable::Argument(written + captured.len());
        by.insert(variable, context.dag.variable(argument));
        captured.push(context.dag.variable(variable));
    }
    for force in &mut forces {
        *force = context.dag.substitute(*force, &by);
    }
    for level in &mut levels {
        level.value = context.dag.substitute(level.value, &by);
    }
    let mut arguments = context.arguments.clone();
    let mut known = context.ranges.arguments.clone();
    for &id in &captured {
        let plain = matches!(context.dag.node(id), Node::Variable(_));
        let shown = context.show(id);
        arguments.push(if plain { shown } else { format!("({shown})") });
        known.push(context.ranges.bounds(&mut context.dag, id, Stretch::ALL));
    }
    let ranges = known.into_iter().map(Interval::to_range).collect();
    let law = ir::Law {
        name,
        arguments,
        ranges,
        levels,
        pieces: forces,
    };
    Lowered { law, captured }
}

/// Makes arguments of exponents that are neither a number nor a variable plus a number, which is all that the runtime's
/// quadrature rules know. Returns what the new arguments stand for.
fn capture_exponents(dag: &mut Dag, forces: &mut [Id], written: usize) -> Vec<Id> {
    let mut captured = Vec::new();
    for index in 0..forces.len() {
        for id in dag.reachable(&[forces[index]]) {
            let Node::Power(_, exponent) = *dag.node(id) else {
                continue;
            };
            if !is_plain_exponent(dag, exponent) && !captured.contains(&exponent) {
                captured.push(exponent);
            }
        }
    }
    for (index, &exponent) in captured.iter().enumerate() {
        let argument = dag.variable(Variable::Argument(written + index));
        for force in forces.iter_mut() {
            *force = dag.replace(*force, exponent, argument);
        }
    }
    captured
}

fn is_plain_exponent(dag: &Dag, exponent: Id) -> bool {
    let is_variable = |id: Id| matches!(dag.node(id), Node::Variable(_));
    match dag.node(exponent) {
        Node::Number(_) | Node::Variable(_) => true,
        Node::Sum(terms) => {
            terms.len() == 2
                && terms.iter().any(|&term| is_variable(term))
                && terms.iter().any(|&term| dag.as_number(term).is_some())
        }
        _ => false,
    }
}

/// The coefficients of gap and rate and the constant of a law that is linear everywhere: a spring or damper that needs no contact.
pub fn linear(dag: &mut Dag, law: &ir::Law) -> Option<[Id; 3]> {
    let [force] = law.pieces[..] else { return None };
    let (gap, rate) = (dag.variable(Variable::Gap), dag.variable(Variable::Rate));
    let one = dag.integer(1);
    let mut parts: [Vec<Id>; 3] = Default::default();
    for term in addends(dag, force) {
        let (coefficient, motion) = split_factor(dag, term, &[Variable::Gap, Variable::Rate]);
        let position = [gap, rate, one]
            .into_iter()
            .position(|basis| basis == motion)?;
        parts[position].push(coefficient);
    }
    Some(parts.map(|part| dag.sum(&part)))
}
