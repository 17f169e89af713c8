//! The gap of a nonlinear term: which fixed combination of coordinates it depends on.

use std::collections::{HashMap, HashSet};

use crate::dag::{Dag, Id, Node, Rational, Variable};
use crate::errors::Extent;

use super::algebra::split_factor;
use super::expand::{Expander, is_motion};
use super::interval::Stretch;
use super::polynomial::LARGEST_DEGREE;

/// Coefficients of the coordinates in a gap, the first of them one, in order of the coordinates.
pub type Direction = Vec<(usize, Id)>;

pub(super) fn show_gap(context: &mut Expander, direction: &Direction) -> String {
    let mut terms = Vec::new();
    for &(index, factor) in direction {
        let coordinate = context.dag.variable(Variable::Coordinate(index));
        terms.push(context.dag.product(&[factor, coordinate]));
    }
    let gap = context.dag.sum(&terms);
    context.show(gap)
}

pub(super) fn mixed(context: &mut Expander, part: Id, extent: Extent) -> syn::Error {
    let gaps: Vec<String> = directions(&mut context.dag, part)
        .into_iter()
        .flatten()
        .map(|direction| format!("`{}`", show_gap(context, &direction)))
        .collect();
    extent.fault(format!(
        "this term mixes {} nonlinearly: a force depends on one gap, a fixed combination of coordinates, and on its rate; only polynomials of coordinates, or of velocities, can be taken apart, up to the degree {LARGEST_DEGREE}",
        if gaps.len() > 1 { gaps.join(" and ") } else { "several coordinates".to_owned() }
    ))
}

/// The one gap that an expression in coordinates and velocities depends on.
pub(super) fn single_direction(dag: &mut Dag, id: Id) -> Option<Direction> {
    let mut directions = directions(dag, id)?;
    (directions.len() == 1).then(|| directions.remove(0))
}

/// The distinct gaps of an expression: the linear part of each sum is one, and so is each coordinate that stands alone.
fn directions(dag: &mut Dag, id: Id) -> Option<Vec<Direction>> {
    let mut found: Vec<Direction> = Vec::new();
    let mut pending = vec![id];
    let mut seen = HashSet::new();
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
        .filter(|&variable| is_motion(variable))
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
pub(super) fn pivot_does_not_vanish(
    context: &mut Expander,
    direction: &Direction,
    extent: Extent,
) -> syn::Result<()> {
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
pub(super) fn in_gap(dag: &mut Dag, direction: &Direction) -> HashMap<Variable, Id> {
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
