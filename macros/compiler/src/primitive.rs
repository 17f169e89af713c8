//! Rate terms integrated: for `phi = f(g) + h(g) r` the spring `f` and the primitive `G` with `G' = h`.

use std::collections::HashMap;

use hertzian_contract::law::RateDependence;

use crate::dag::{Dag, Function, Id, Node, Rational, Variable};
use crate::differentiate::differentiate;
use crate::facts::{Limit, Piece, Ranges, limit_at, rate_dependence};
use crate::ir::Law;
use crate::simplify::{addends_of, expand, factors_of};

/// Stands for the base that is integrated over; a rate term that is integrated contains no rate.
const INNER: Variable = Variable::Rate;

/// The spring and the primitive of a law that is linear in its rate, with the same arguments and levels; `None` where a
/// rate term has no primitive among the functions known here.
pub fn parts(dag: &mut Dag, law: &Law) -> Option<(Law, Law)> {
    let arguments = law.arguments.len();
    let pieces: Vec<Piece> = law
        .pieces
        .iter()
        .map(|&force| Piece::of(dag, force, arguments))
        .collect();
    if rate_dependence(dag, &pieces) != RateDependence::Linear {
        return None;
    }
    let still = HashMap::from([(Variable::Rate, dag.integer(0))]);
    let spring: Vec<Id> = law
        .pieces
        .iter()
        .map(|&force| dag.substitute(force, &still))
        .collect();
    let mut primitive = Vec::new();
    for piece in &pieces {
        primitive.push(integrate(dag, piece.by_rate, Ranges(&law.ranges))?);
    }
    let primitive = join(dag, law, &primitive)?;
    let part = |name: &str, pieces| Law {
        name: format!("{}, {name}", law.name),
        pieces,
        ..law.clone()
    };
    Some((part("spring", spring), part("primitive", primitive)))
}

/// Adds a constant to every piece so that the whole is continuous and zero at the origin: at gap zero where it is known
/// which piece that belongs to, otherwise at the lowest level.
fn join(dag: &mut Dag, law: &Law, raw: &[Id]) -> Option<Vec<Id>> {
    let ranges = Ranges(&law.ranges);
    let (home, origin) = origin(dag, law);
    let mut joined = raw.to_vec();
    let value = finite(limit_at(dag, raw[home], origin, ranges))?;
    joined[home] = dag.difference(raw[home], value);
    for index in home + 1..raw.len() {
        joined[index] = attach(
            dag,
            raw[index],
            joined[index - 1],
            law.levels[index - 1].value,
            ranges,
        )?;
    }
    for index in (0..home).rev() {
        joined[index] = attach(
            dag,
            raw[index],
            joined[index + 1],
            law.levels[index].value,
            ranges,
        )?;
    }
    Some(joined)
}

/// `piece` plus the constant that makes it meet `neighbour` at a level.
fn attach(dag: &mut Dag, piece: Id, neighbour: Id, level: Id, ranges: Ranges<'_>) -> Option<Id> {
    let there = finite(limit_at(dag, neighbour, level, ranges))?;
    let here = finite(limit_at(dag, piece, level, ranges))?;
    let constant = dag.difference(there, here);
    Some(dag.sum(&[piece, constant]))
}

fn finite(limit: Limit) -> Option<Id> {
    match limit {
        Limit::Finite(id) => Some(id),
        Limit::Unbounded => None,
    }
}

/// The piece that contains the origin of the primitive, and the origin.
fn origin(dag: &mut Dag, law: &Law) -> (usize, Id) {
    let ranges = Ranges(&law.ranges);
    let zero = dag.integer(0);
    let mut home = 0;
    for level in &law.levels {
        let opposite = dag.negate(level.value);
        if level.value == zero || ranges.is_positive(dag, level.value) {
            return (home, zero);
        }
        if !ranges.is_positive(dag, opposite) {
            return (0, law.levels[0].value);
        }
        home += 1;
    }
    (home, zero)
}

/// A primitive by the gap, term by term.
fn integrate(dag: &mut Dag, id: Id, ranges: Ranges<'_>) -> Option<Id> {
    let expanded = expand(dag, id);
    let mut primitive = Vec::new();
    for term in addends_of(dag, expanded) {
        primitive.push(integrate_term(dag, term, ranges)?);
    }
    Some(dag.sum(&primitive))
}

/// `c g^k`, `c g^k (m g + q)^e`, and `c u(m g + q)` for exponential, sine and cosine.
fn integrate_term(dag: &mut Dag, term: Id, ranges: Ranges<'_>) -> Option<Id> {
    let (varying, constant): (Vec<Id>, Vec<Id>) = factors_of(dag, term)
        .into_iter()
        .partition(|&factor| dag.depends_on(factor, Variable::Gap));
    let gap = dag.variable(Variable::Gap);
    let singular: Vec<Id> = varying
        .iter()
        .copied()
        .filter(|&f| !is_monomial(dag, f))
        .collect();
    let integral = match singular.as_slice() {
        [] => {
            let monomial = dag.product(&varying);
            integrate_power(dag, monomial, gap, ranges)?
        }
        [only] => match *dag.node(*only) {
            Node::Power(base, _) => integrate_by_base(dag, &varying, base, ranges)?,
            Node::Call(function, operand) if varying.len() == 1 => {
                integrate_call(dag, function, operand, ranges)?
            }
            _ => return None,
        },
        _ => return None,
    };
    let mut factors = constant;
    factors.push(integral);
    Some(dag.product(&factors))
}

fn is_monomial(dag: &Dag, factor: Id) -> bool {
    match *dag.node(factor) {
        Node::Variable(_) => true,
        Node::Power(base, exponent) => {
            matches!(dag.node(base), Node::Variable(_))
                && dag
                    .as_number(exponent)
                    .is_some_and(|e| e.is_integer() && e.is_positive())
        }
        _ => false,
    }
}

/// Writes the other factors in `u = m g + q`, multiplies out, and integrates every power of `u`.
fn integrate_by_base(dag: &mut Dag, factors: &[Id], base: Id, ranges: Ranges<'_>) -> Option<Id> {
    let (slope, offset) = linear(dag, base, ranges)?;
    let inner = dag.variable(INNER);
    let shifted = dag.difference(inner, offset);
    let gap = dag.quotient(shifted, slope);
    let by = HashMap::from([(Variable::Gap, gap)]);
    let mut rewritten = Vec::new();
    for &factor in factors {
        rewritten.push(match *dag.node(factor) {
            Node::Power(own, exponent) if own == base => dag.power(inner, exponent),
            _ => dag.substitute(factor, &by),
        });
    }
    let product = dag.product(&rewritten);
    let expanded = expand(dag, product);
    let mut terms = Vec::new();
    for term in addends_of(dag, expanded) {
        let (varying, mut constant): (Vec<Id>, Vec<Id>) = factors_of(dag, term)
            .into_iter()
            .partition(|&factor| dag.depends_on(factor, INNER));
        let power = dag.product(&varying);
        constant.push(integrate_power(dag, power, inner, ranges)?);
        terms.push(dag.product(&constant));
    }
    let integral = dag.sum(&terms);
    let integral = dag.substitute(integral, &HashMap::from([(INNER, base)]));
    Some(dag.quotient(integral, slope))
}

/// `x^e -> x^(e+1) / (e+1)`, where `e + 1` is certainly not zero.
fn integrate_power(dag: &mut Dag, power: Id, of: Id, ranges: Ranges<'_>) -> Option<Id> {
    let one = dag.integer(1);
    let exponent = match *dag.node(power) {
        Node::Number(number) if number == Rational::ONE => dag.integer(0),
        Node::Power(base, exponent) if base == of => exponent,
        _ if power == of => one,
        _ => return None,
    };
    let raised = dag.sum(&[exponent, one]);
    if !ranges.is_nonzero(dag, raised) {
        return None;
    }
    let power = dag.power(of, raised);
    Some(dag.quotient(power, raised))
}

fn integrate_call(
    dag: &mut Dag,
    function: Function,
    operand: Id,
    ranges: Ranges<'_>,
) -> Option<Id> {
    let (slope, _) = linear(dag, operand, ranges)?;
    let outer = match function {
        Function::Exponential => dag.call(Function::Exponential, operand),
        Function::Cosine => dag.call(Function::Sine, operand),
        Function::Sine => {
            let cosine = dag.call(Function::Cosine, operand);
            dag.negate(cosine)
        }
        _ => return None,
    };
    Some(dag.quotient(outer, slope))
}

/// Slope and value at zero of an expression that is linear in the gap, the slope certainly not zero.
fn linear(dag: &mut Dag, id: Id, ranges: Ranges<'_>) -> Option<(Id, Id)> {
    let slope = differentiate(dag, id, Variable::Gap);
    if dag.depends_on(slope, Variable::Gap) || !ranges.is_nonzero(dag, slope) {
        return None;
    }
    let origin = HashMap::from([(Variable::Gap, dag.integer(0))]);
    Some((slope, dag.substitute(id, &origin)))
}
