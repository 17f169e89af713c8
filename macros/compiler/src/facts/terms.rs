//! The additive terms of a force and of its derivatives, with their exponents at the ends of a piece.

use std::collections::HashMap;

use hertzian_contract::law::{Exponent, Quantity, TermFacts};

use super::Piece;
use super::limit::shifted_argument;
use crate::dag::{Dag, Id, Node, Variable};
use crate::differentiate::differentiate;
use crate::simplify::{addends_of, expand, factors_of};

/// A base is tried for a zero of up to this order at a level.
const MAX_ORDER: i32 = 4;

/// The terms of force and derivatives of a piece, equal ones once.
pub fn of_piece(
    dag: &mut Dag,
    piece: &Piece,
    lower: Option<Id>,
    upper: Option<Id>,
) -> Vec<TermFacts> {
    let mut quantities = vec![
        (Quantity::Force, piece.force),
        (Quantity::ByGap, piece.by_gap),
        (Quantity::ByRate, piece.by_rate),
    ];
    for (index, &id) in piece.by_argument.iter().enumerate() {
        quantities.push((Quantity::ByArgument(index), id));
    }
    let mut terms = Vec::new();
    for (of, id) in quantities {
        let expanded = expand(dag, id);
        for addend in addends_of(dag, expanded) {
            let at_upper = behaviours(dag, addend, upper);
            for (lower, lower_logarithm) in behaviours(dag, addend, lower) {
                for &(upper, upper_logarithm) in &at_upper {
                    let logarithm = lower_logarithm || upper_logarithm;
                    let term = TermFacts::new(of, lower, upper).logarithm(logarithm);
                    if !terms.contains(&term) {
                        terms.push(term);
                    }
                }
            }
        }
    }
    terms
}

/// The exponent of a term at a level, and whether it carries a logarithm there. A factor that is regular itself but
/// contains a power that is not, as `exp(-g^1.5)`, adds the term that its expansion begins with.
fn behaviours(dag: &mut Dag, term: Id, level: Option<Id>) -> Vec<(Exponent, bool)> {
    let Some(level) = level else {
        return vec![(Exponent::ZERO, false)];
    };
    let mut exponents = Vec::new();
    let mut logarithm = false;
    let mut nested = Vec::new();
    for factor in factors_of(dag, term) {
        let (base, exponent, is_logarithm) = match *dag.node(factor) {
            Node::Power(base, exponent) => (base, exponent, false),
            Node::PowerLog(base, exponent) => (base, exponent, true),
            _ => (factor, dag.integer(1), false),
        };
        if !dag.depends_on(base, Variable::Gap) {
            continue;
        }
        let inner = nested_powers(dag, base, level);
        // A base that is not smooth has no order; what it contains says how it behaves.
        let order = if inner.is_empty() {
            order_of_zero(dag, base, level)
        } else {
            0
        };
        if order > 0 {
            let order = dag.integer(order);
            exponents.push(dag.product(&[order, exponent]));
            logarithm |= is_logarithm;
        }
        nested.extend(inner);
    }
    let total = dag.sum(&exponents);
    let mut behaviours = vec![(as_exponent(dag, total), logarithm)];
    for (exponent, is_logarithm) in nested {
        let sum = dag.sum(&[total, exponent]);
        let behaviour = (as_exponent(dag, sum), logarithm || is_logarithm);
        if behaviour.0 != Exponent::ZERO && !behaviours.contains(&behaviour) {
            behaviours.push(behaviour);
        }
    }
    behaviours
}

/// The exponents of powers inside an expression that are not smooth at a level.
fn nested_powers(dag: &mut Dag, id: Id, level: Id) -> Vec<(Id, bool)> {
    let mut found = Vec::new();
    for inner in dag.reachable(&[id]) {
        let (base, exponent, is_logarithm) = match *dag.node(inner) {
            Node::Power(base, exponent) => (base, exponent, false),
            Node::PowerLog(base, exponent) => (base, exponent, true),
            _ => continue,
        };
        if dag.depends_on(base, Variable::Gap) {
            let order = order_of_zero(dag, base, level);
            if order > 0 {
                let order = dag.integer(order);
                let exponent = dag.product(&[order, exponent]);
                if is_logarithm || as_exponent(dag, exponent) != Exponent::ZERO {
                    found.push((exponent, is_logarithm));
                }
            }
        }
    }
    found
}

/// How many times an expression vanishes at a level; zero where it does not, or not as a power with a whole exponent.
fn order_of_zero(dag: &mut Dag, base: Id, level: Id) -> i32 {
    let zero = dag.integer(0);
    let at_level = HashMap::from([(Variable::Gap, level)]);
    let mut derivative = base;
    for order in 0..=MAX_ORDER {
        let value = dag.substitute(derivative, &at_level);
        if expand(dag, value) != zero {
            return order;
        }
        derivative = differentiate(dag, derivative, Variable::Gap);
    }
    0
}

/// A whole exponent that is not negative is smooth; one that is not an argument plus a number has no place in the
/// contract, and lowering makes an argument of it.
fn as_exponent(dag: &mut Dag, exponent: Id) -> Exponent {
    if let Some(number) = dag.as_number(exponent) {
        let smooth = number.is_integer() && !number.is_negative();
        return if smooth {
            Exponent::ZERO
        } else {
            Exponent::new(number.to_f64())
        };
    }
    match shifted_argument(dag, exponent) {
        Some((argument, number, true)) => Exponent::of_argument(number.to_f64(), argument),
        _ => Exponent::ZERO,
    }
}
