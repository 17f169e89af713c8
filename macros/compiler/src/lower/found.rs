//! Laws found in the equations: nonlinear terms without a `law` block are grouped by the gap they depend on.

use std::rc::Rc;

use crate::ast::Expr;
use crate::dag::{Dag, Id, Node, Rational, Variable};
use crate::errors::{Diagnostics, Extent};

use super::algebra::{addends, split_factor};
use super::expand::{Expander, is_motion};
use super::gaps::{Direction, in_gap, mixed, pivot_does_not_vanish, show_gap, single_direction};
use super::interval::Stretch;
use super::law::{Lowered, finish};
use super::polynomial::powers_of_forms;
use super::resolve::{Segment, resolve};
use super::term::{Motion, Term};
use super::wave::Wave;
use super::written::{Written, followed};

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
    /// Shared by the parts of one term.
    written: Rc<[Written]>,
}

/// The term as written, which a loop repeats.
pub type Origin = *const Expr;

/// Where a term stands: in which equation, and as what it is written.
#[derive(Debug, Clone, Copy)]
struct Site {
    row: usize,
    origin: Origin,
}

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
        context.work_is_left(term.extent)?;
        let site = Site { row, origin };
        let mut linear = Vec::new();
        let whole = single_direction(&mut context.dag, id);
        let parts = if whole.is_some() {
            vec![id]
        } else {
            addends(&mut context.dag, id)
        };
        let is_of_one_gap = |dag: &mut Dag, id| single_direction(dag, id).is_some();
        for part in parts {
            if !moves(&context.dag, part) {
                linear.push(still(&mut context.dag, term, part));
                continue;
            }
            let parts = if is_of_one_gap(&mut context.dag, part) {
                vec![part]
            } else {
                powers_of_forms(&mut context.dag, part, is_of_one_gap)
                    .ok_or_else(|| mixed(context, part, term.extent))?
            };
            for part in parts {
                if !moves(&context.dag, part) {
                    linear.push(still(&mut context.dag, term, part));
                    continue;
                }
                let direction = single_direction(&mut context.dag, part)
                    .ok_or_else(|| mixed(context, part, term.extent))?;
                pivot_does_not_vanish(context, &direction, term.extent)?;
                linear.extend(self.add_part(context, site, term, part, &direction));
            }
        }
        Ok(linear)
    }

    fn add_part(
        &mut self,
        context: &mut Expander,
        site: Site,
        term: &Term,
        part: Id,
        direction: &Direction,
    ) -> Vec<Term> {
        let replacements = in_gap(&mut context.dag, direction);
        let rebuilt = context.dag.substituted(part, &replacements);
        let force = rebuilt[&part];
        let written: Rc<[Written]> = followed(&context.written, &rebuilt);
        let mut linear = Vec::new();
        for (coefficient, rest) in split(&mut context.dag, force, term.is_steady()) {
            let scaled = term.scaled(&mut context.dag, coefficient);
            if let Some(basis) = linear_in(&context.dag, rest, term.is_steady()) {
                linear.extend(in_coordinates(context, scaled, basis, direction));
            } else {
                self.parts.push(Part {
                    row: site.row,
                    wave: term.wave,
                    direction: direction.clone(),
                    coefficient: scaled.coefficient,
                    force: rest,
                    extent: term.extent,
                    origin: site.origin,
                    written: written.clone(),
                });
            }
        }
        linear
    }

    /// One law for each gap of each equation; laws that come out equal are one.
    pub fn laws(self, context: &mut Expander, diagnostics: &mut Diagnostics) -> Vec<Found> {
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
            if diagnostics
                .keep(context.work_is_left(group[0].extent))
                .is_none()
            {
                break;
            }
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
            context.gap = show_gap(context, &group[0].direction);
            if let Some(segments) = segments(context, &group, &mut faulty, diagnostics) {
                let name = format!("force {}", laws.len() + 1);
                let lowered = finish(context, name, segments);
                laws.push(Found {
                    lowered,
                    direction: group[0].direction.clone(),
                    rows: vec![row],
                    extent: group[0].extent,
                });
                forces.push(force);
            }
        }
        laws
    }
}

/// Whether an expression depends on the motion.
fn moves(dag: &Dag, id: Id) -> bool {
    dag.variables(id).into_iter().any(is_motion)
}

/// What is left of a term where the motion has been taken out of it: `1` of `(1 + x)*(1 + y)`.
fn still(dag: &mut Dag, term: &Term, value: Id) -> Term {
    Term {
        motion: Motion::None,
        ..term.scaled(dag, value)
    }
}

/// What a linear term is a multiple of.
#[derive(Clone, Copy)]
enum Basis {
    One,
    Gap,
    Rate,
}

/// What a term is linear in, if it is linear; damping that varies with time has no place of its own.
fn linear_in(dag: &Dag, id: Id, steady: bool) -> Option<Basis> {
    match dag.node(id) {
        _ if dag.as_number(id) == Some(Rational::ONE) => Some(Basis::One),
        Node::Variable(Variable::Gap) => Some(Basis::Gap),
        Node::Variable(Variable::Rate) if steady => Some(Basis::Rate),
        _ => None,
    }
}

/// The terms of a force as coefficients and what they multiply. One without linear terms stays whole, as in a law.
fn split(dag: &mut Dag, force: Id, steady: bool) -> Vec<(Id, Id)> {
    let moving = [Variable::Gap, Variable::Rate];
    let mut terms = Vec::new();
    for addend in addends(dag, force) {
        terms.push(split_factor(dag, addend, &moving));
    }
    let is_linear = |&(_, rest): &(Id, Id)| linear_in(dag, rest, steady).is_some();
    if terms.iter().any(is_linear) {
        terms
    } else {
        vec![split_factor(dag, force, &moving)]
    }
}

/// A term that is linear in the gap or its rate, in coordinates.
fn in_coordinates(
    context: &mut Expander,
    term: Term,
    basis: Basis,
    direction: &Direction,
) -> Vec<Term> {
    let with = |motion, term| Term { motion, ..term };
    let variable = match basis {
        Basis::One => return vec![with(Motion::None, term)],
        Basis::Gap => Variable::Coordinate,
        Basis::Rate => Variable::Velocity,
    };
    direction
        .iter()
        .map(|&(index, factor)| {
            let scaled = term.scaled(&mut context.dag, factor);
            with(Motion::Linear(variable(index)), scaled)
        })
        .collect()
}

/// Resolves the parts of one force together, as those of a piece are: what jumps in one of them may be taken back by
/// another. If that fails, each term is judged alone, so that a fault is reported at its own term, and once.
fn segments(
    context: &mut Expander,
    group: &[Part],
    faulty: &mut Vec<Origin>,
    diagnostics: &mut Diagnostics,
) -> Option<Vec<Segment>> {
    let together = match resolved(context, group) {
        Ok(segments) => return Some(segments),
        Err(fault) => fault,
    };
    let mut origins: Vec<Origin> = group.iter().map(|part| part.origin).collect();
    origins.dedup();
    let mut explained = false;
    for &origin in &origins {
        if !faulty.contains(&origin) {
            let own = group.iter().filter(|part| part.origin == origin);
            let own: Vec<Part> = own.cloned().collect();
            let Err(fault) = resolved(context, &own) else {
                continue;
            };
            diagnostics.add(fault);
            faulty.push(origin);
        }
        explained = true;
    }
    if !explained {
        diagnostics.add(together);
        faulty.extend(origins);
    }
    None
}

/// The pieces of the sum of some parts.
fn resolved(context: &mut Expander, parts: &[Part]) -> syn::Result<Vec<Segment>> {
    let (_, force) = common_factor(&mut context.dag, parts);
    let mut lists: Vec<&Rc<[Written]>> = parts.iter().map(|part| &part.written).collect();
    lists.dedup_by(|a, b| Rc::ptr_eq(a, b));
    let whole = Segment {
        stretch: Stretch::ALL,
        holds_low: false,
        force,
        written: lists.into_iter().flat_map(|list| list.to_vec()).collect(),
    };
    let extent = parts[0].extent.to(parts[parts.len() - 1].extent);
    resolve(context, whole, extent)
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
