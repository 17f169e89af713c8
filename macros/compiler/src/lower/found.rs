//! Laws found in the equations: nonlinear terms without a `law` block are grouped by the gap they depend on.

use std::collections::HashMap;

use crate::ast::Expr;
use crate::dag::{Dag, Id, Node, Rational, Variable};
use crate::errors::Extent;
use crate::ir;

use super::algebra::{addends, split_factor};
use super::expand::Expander;
use super::interval::Stretch;
use super::law::{Lowered, finish};
use super::polynomial::powers_of_forms;
use super::resolve::{Segment, resolve};
use super::term::{Motion, Term};
use super::wave::Wave;

/// Coefficients of the coordinates in a gap, the first of them one, in order of the coordinates.
pub type Direction = Vec<(usize, Id)>;

/// A nonlinear term of one equation, as a force of one gap.
#[derive(Debug, Clone)]
struct Part {
    row: usize,
    wave: Wave,
    direction: Direction,
    coefficient: Id,
    force: Id,
    extent: Extent,
    origin: Origin,
    powers: Vec<(Id, Extent)>,
}

/// The term as written, which a loop repeats.
pub type Origin = *const Expr;

/// A law found in the equations and where its force acts.
#[derive(Debug)]
pub struct Found {
    /// The law.
    pub lowered: Lowered,
    /// Its gap.
    pub direction: Direction,
    /// Equations, waves and factors of the force.
    pub rows: Vec<(usize, Wave, Id)>,
    /// Where it stands.
    pub extent: Extent,
}

/// Gathers nonlinear terms.
#[derive(Debug, Default)]
pub struct Gatherer {
    parts: Vec<Part>,
}

impl Gatherer {
    /// Adds a nonlinear term of an equation; what turns out linear in it is returned.
    ///
    /// # Errors
    /// If the term mixes two gaps.
    pub fn add(
        &mut self,
        context: &mut Expander,
        row: usize,
        term: &Term,
        origin: Origin,
    ) -> syn::Result<Vec<Term>> {
        let Motion::Nonlinear(id) = term.motion else {
            return Ok(vec![*term]);
        };
        let mut linear = Vec::new();
        let whole = single_direction(&mut context.dag, id);
        let parts = if whole.is_some() {
            vec![id]
        } else {
            addends(&mut context.dag, id)
        };
        let is_of_one_gap = |dag: &mut Dag, id| single_direction(dag, id).is_some();
        for part in parts {
            let parts = if is_of_one_gap(&mut context.dag, part) {
                vec![part]
            } else {
                powers_of_forms(&mut context.dag, part, is_of_one_gap)
                    .ok_or_else(|| mixed(context, part, term.extent))?
            };
            for part in parts {
                let direction = single_direction(&mut context.dag, part)
                    .ok_or_else(|| mixed(context, part, term.extent))?;
                pivot_does_not_vanish(context, &direction, term.extent)?;
                linear.extend(self.add_part(context, (row, origin), term, part, &direction));
            }
        }
        Ok(linear)
    }

    fn add_part(
        &mut self,
        context: &mut Expander,
        (row, origin): (usize, Origin),
        term: &Term,
        part: Id,
        direction: &Direction,
    ) -> Vec<Term> {
        let replacements = in_gap(&mut context.dag, direction);
        let force = context.dag.substitute(part, &replacements);
        let inside = context.dag.reachable(&[part]);
        let mut powers = context.powers.clone();
        powers.retain(|(power, _)| inside.binary_search(power).is_ok());
        let powers: Vec<(Id, Extent)> = powers
            .into_iter()
            .map(|(power, extent)| (context.dag.substitute(power, &replacements), extent))
            .collect();
        let mut linear = Vec::new();
        let (gap, rate) = (
            context.dag.variable(Variable::Gap),
            context.dag.variable(Variable::Rate),
        );
        let one = context.dag.integer(1);
        for addend in addends(&mut context.dag, force) {
            let (coefficient, rest) =
                split_factor(&mut context.dag, addend, &[Variable::Gap, Variable::Rate]);
            let scaled = term.scaled(&mut context.dag, coefficient);
            if rest == one {
                linear.push(Term {
                    motion: Motion::None,
                    ..scaled
                });
            } else if rest == gap || (rest == rate && term.is_steady()) {
                for &(index, factor) in direction {
                    let variable = if rest == gap {
                        Variable::Coordinate(index)
                    } else {
                        Variable::Velocity(index)
                    };
                    let scaled = scaled.scaled(&mut context.dag, factor);
                    linear.push(Term {
                        motion: Motion::Linear(variable),
                        ..scaled
                    });
                }
            } else {
                self.parts.push(Part {
                    row,
                    wave: term.wave,
                    direction: direction.clone(),
                    coefficient: scaled.coefficient,
                    force: rest,
                    extent: term.extent,
                    origin,
                    powers: powers.clone(),
                });
            }
        }
        linear
    }

    /// One law for each gap of each equation; laws that come out equal are one.
    pub fn laws(
        self,
        context: &mut Expander,
        diagnostics: &mut crate::errors::Diagnostics,
    ) -> Vec<Found> {
        let mut groups: Vec<Vec<Part>> = Vec::new();
        for part in self.parts {
            let same = |group: &&mut Vec<Part>| {
                let first = &group[0];
                first.row == part.row
                    && first.wave == part.wave
                    && first.direction == part.direction
            };
            match groups.iter_mut().find(same) {
                Some(group) => group.push(part),
                None => groups.push(vec![part]),
            }
        }
        let mut laws: Vec<Found> = Vec::new();
        let mut forces: Vec<Id> = Vec::new();
        let mut faulty: Vec<Origin> = Vec::new();
        for group in groups {
            let (factor, force) = common_factor(&mut context.dag, &group);
            let row = (group[0].row, group[0].wave, factor);
            let known = forces
                .iter()
                .zip(&mut laws)
                .find(|(other, law)| **other == force && law.direction == group[0].direction);
            if let Some((_, law)) = known {
                law.rows.push(row);
                continue;
            }
            if group.iter().any(|part| faulty.contains(&part.origin)) {
                continue;
            }
            context.gap = show_gap(context, &group[0].direction);
            if let Some(segments) = diagnostics.keep(segments(context, &group)) {
                let name = format!("force {}", laws.len() + 1);
                let lowered = finish(context, name, segments);
                laws.push(Found {
                    lowered,
                    direction: group[0].direction.clone(),
                    rows: vec![row],
                    extent: group[0].extent,
                });
                forces.push(force);
            } else {
                faulty.extend(group.iter().map(|part| part.origin));
            }
        }
        laws
    }
}

/// Resolves the parts of one force together, after each alone, so that a fault is reported at its own term.
fn segments(context: &mut Expander, group: &[Part]) -> syn::Result<Vec<Segment>> {
    let whole = |force, part: &Part| Segment {
        stretch: Stretch::ALL,
        holds_low: false,
        force,
        powers: part.powers.clone(),
    };
    let mut fault: Option<syn::Error> = None;
    for part in group {
        if let Err(other) = resolve(context, whole(part.force, part), part.extent) {
            match &mut fault {
                Some(fault) => fault.combine(other),
                None => fault = Some(other),
            }
        }
    }
    if let Some(fault) = fault {
        return Err(fault);
    }
    let (_, force) = common_factor(&mut context.dag, group);
    let extent = group[0].extent.to(group[group.len() - 1].extent);
    resolve(context, whole(force, &group[0]), extent)
}

/// The factor that the parts of a force have in common, up to numbers, and the force without it.
fn common_factor(dag: &mut Dag, group: &[Part]) -> (Id, Id) {
    let (_, common) = dag.split_coefficient(group[0].coefficient);
    let shared = group
        .iter()
        .all(|part| dag.split_coefficient(part.coefficient).1 == common);
    let leading = if shared {
        group[0].coefficient
    } else {
        dag.integer(1)
    };
    let mut terms = Vec::new();
    for part in group {
        let relative = dag.quotient(part.coefficient, leading);
        terms.push(dag.product(&[relative, part.force]));
    }
    (leading, dag.sum(&terms))
}

fn show_gap(context: &mut Expander, direction: &Direction) -> String {
    let mut terms = Vec::new();
    for &(index, factor) in direction {
        let coordinate = context.dag.variable(Variable::Coordinate(index));
        terms.push(context.dag.product(&[factor, coordinate]));
    }
    let gap = context.dag.sum(&terms);
    context.show(gap)
}

fn mixed(context: &mut Expander, part: Id, extent: Extent) -> syn::Error {
    let gaps: Vec<String> = directions(&mut context.dag, part)
        .into_iter()
        .flatten()
        .map(|direction| format!("`{}`", show_gap(context, &direction)))
        .collect();
    extent.fault(format!(
        "this term mixes {} nonlinearly: a force depends on one gap, a fixed combination of coordinates, and on its rate; only polynomials of coordinates, or of velocities, can be taken apart",
        if gaps.len() > 1 { gaps.join(" and ") } else { "several coordinates".to_owned() }
    ))
}

/// The one gap that an expression in coordinates and velocities depends on.
fn single_direction(dag: &mut Dag, id: Id) -> Option<Direction> {
    let mut directions = directions(dag, id)?;
    (directions.len() == 1).then(|| directions.remove(0))
}

/// The distinct gaps of an expression: the linear part of each sum is one, and so is each coordinate that stands alone.
fn directions(dag: &mut Dag, id: Id) -> Option<Vec<Direction>> {
    let mut found: Vec<Direction> = Vec::new();
    let mut pending = vec![id];
    let mut seen = std::collections::HashSet::new();
    while let Some(current) = pending.pop() {
        if !seen.insert(current) {
            continue;
        }
        let mut positions: Vec<(usize, Id)> = Vec::new();
        let mut velocities: Vec<(usize, Id)> = Vec::new();
        let terms = match dag.node(current).clone() {
            Node::Sum(terms) => terms,
            Node::Product(factors) if !is_linear(dag, current) => {
                pending.extend(factors);
                continue;
            }
            Node::Number(_) | Node::Pi => continue,
            Node::Product(_) | Node::Variable(_) => vec![current],
            _ => {
                pending.extend(dag.operands(current));
                continue;
            }
        };
        for term in terms {
            match linear_term(dag, term) {
                Some((Variable::Coordinate(index), factor)) => positions.push((index, factor)),
                Some((Variable::Velocity(index), factor)) => velocities.push((index, factor)),
                Some(_) => return None,
                None => pending.push(term),
            }
        }
        for mut direction in [positions, velocities] {
            if direction.is_empty() {
                continue;
            }
            normalise(dag, &mut direction);
            if !found.contains(&direction) {
                found.push(direction);
            }
        }
    }
    Some(found)
}

fn is_linear(dag: &mut Dag, id: Id) -> bool {
    linear_term(dag, id).is_some()
}

/// A term `factor * coordinate` or `factor * velocity`.
fn linear_term(dag: &mut Dag, term: Id) -> Option<(Variable, Id)> {
    let moving: Vec<Variable> = dag
        .variables(term)
        .into_iter()
        .filter(|&variable| super::expand::is_motion(variable))
        .collect();
    let [variable] = moving[..] else { return None };
    let (factor, rest) = split_factor(dag, term, &[variable]);
    (rest == dag.variable(variable)).then_some((variable, factor))
}

/// Collects coordinates and divides by the first coefficient that is a number, or else by the first: see
/// [`pivot_does_not_vanish`].
fn normalise(dag: &mut Dag, direction: &mut Direction) {
    direction.sort_by_key(|&(index, _)| index);
    let mut merged: Direction = Vec::new();
    for &(index, factor) in direction.iter() {
        match merged.last_mut() {
            Some(last) if last.0 == index => last.1 = dag.sum(&[last.1, factor]),
            _ => merged.push((index, factor)),
        }
    }
    merged.retain(|&(_, factor)| dag.as_number(factor) != Some(Rational::ZERO));
    let number = merged
        .iter()
        .find(|&&(_, factor)| dag.as_number(factor).is_some());
    if let Some(&(_, pivot)) = number.or(merged.first()) {
        for (_, factor) in &mut merged {
            *factor = dag.quotient(*factor, pivot);
        }
    }
    *direction = merged;
}

/// What a gap of several coordinates was divided by never vanishes; else the other coordinates would be lost with it.
fn pivot_does_not_vanish(
    context: &mut Expander,
    direction: &Direction,
    extent: Extent,
) -> Result<(), syn::Error> {
    let factors: Vec<Id> = direction.iter().map(|&(_, factor)| factor).collect();
    for id in context.dag.reachable(&factors) {
        let Node::Power(base, exponent) = *context.dag.node(id) else {
            continue;
        };
        let divides = context
            .dag
            .as_number(exponent)
            .is_some_and(Rational::is_negative);
        let bounds = context.ranges.bounds(&mut context.dag, base, Stretch::ALL);
        if divides && !bounds.excludes_zero() {
            let shown = context.show(base);
            return Err(extent.fault(format!(
                "the coefficient `{shown}` of a coordinate in this gap may be zero: declare a range without it, or declare a law and call it with this gap"
            )));
        }
    }
    Ok(())
}

/// The force depends on `g = q_i + ...` alone, so its value is that at `q_i = g` with all other coordinates zero.
fn in_gap(dag: &mut Dag, direction: &Direction) -> HashMap<Variable, Id> {
    let (zero, one) = (dag.integer(0), dag.integer(1));
    let pivot = direction.iter().position(|&(_, factor)| factor == one);
    let mut by = HashMap::new();
    for (position, &(index, _)) in direction.iter().enumerate() {
        let (gap, rate) = if Some(position) == pivot {
            (dag.variable(Variable::Gap), dag.variable(Variable::Rate))
        } else {
            (zero, zero)
        };
        by.insert(Variable::Coordinate(index), gap);
        by.insert(Variable::Velocity(index), rate);
    }
    by
}

/// Adds a law unless an equal one is there already; its index.
pub fn intern(laws: &mut Vec<ir::Law>, law: ir::Law) -> usize {
    let same = |other: &ir::Law| {
        let levels = |law: &ir::Law| -> Vec<(Id, bool)> {
            law.levels
                .iter()
                .map(|level| (level.value, level.belongs_above))
                .collect()
        };
        other.arguments == law.arguments
            && other.pieces == law.pieces
            && levels(other) == levels(&law)
    };
    laws.iter().position(same).unwrap_or_else(|| {
        laws.push(law);
        laws.len() - 1
    })
}
