//! Rewriting: multiplying out, for comparison and for facts; taking out common factors, for evaluation.

use std::collections::HashMap;

use crate::dag::{Dag, Id, Node, Rational, Variable};

/// Products are multiplied out only up to this many terms; beyond it an expression stays as it is.
const MAX_TERMS: usize = 2000;

/// Integer powers of sums are multiplied out up to this exponent.
const MAX_EXPONENT: i32 = 12;

/// Multiplies out products of sums and small integer powers of sums.
pub fn expand(dag: &mut Dag, id: Id) -> Id {
    let mut expanded: HashMap<Id, Id> = HashMap::new();
    for current in dag.reachable(&[id]) {
        let rebuilt = dag.rebuild_node(current, &expanded);
        let value = multiply_out(dag, rebuilt);
        expanded.insert(current, value);
    }
    expanded[&id]
}

/// Multiplies out one node whose operands are multiplied out already.
fn multiply_out(dag: &mut Dag, id: Id) -> Id {
    match dag.node(id).clone() {
        Node::Sum(terms) => {
            let terms: Vec<Id> = terms
                .iter()
                .map(|&term| multiply_out_product(dag, term))
                .collect();
            dag.sum(&terms)
        }
        _ => multiply_out_product(dag, id),
    }
}

fn multiply_out_product(dag: &mut Dag, id: Id) -> Id {
    let factors = match dag.node(id) {
        Node::Product(factors) => factors.clone(),
        Node::Power(..) => vec![id],
        _ => return id,
    };
    let one = dag.integer(1);
    let mut terms = vec![one];
    for factor in factors {
        let (sum, times) = match *dag.node(factor) {
            Node::Power(base, exponent) => {
                match dag.as_number(exponent).and_then(Rational::to_integer) {
                    Some(times @ 2..=MAX_EXPONENT) => (base, times),
                    _ => (factor, 1),
                }
            }
            _ => (factor, 1),
        };
        let addends = match dag.node(sum) {
            Node::Sum(addends) => addends.clone(),
            _ => vec![factor],
        };
        for _ in 0..if addends.len() > 1 { times } else { 1 } {
            if terms.len() * addends.len() > MAX_TERMS {
                return id;
            }
            let mut next = Vec::with_capacity(terms.len() * addends.len());
            for &term in &terms {
                for &addend in &addends {
                    next.push(dag.product(&[term, addend]));
                }
            }
            let collected = dag.sum(&next);
            terms = addends_of(dag, collected);
        }
    }
    dag.sum(&terms)
}

/// The terms of a sum; anything else is its own single term, and zero has none.
pub fn addends_of(dag: &Dag, id: Id) -> Vec<Id> {
    match dag.node(id) {
        Node::Sum(terms) => terms.clone(),
        Node::Number(number) if number.is_zero() => Vec::new(),
        _ => vec![id],
    }
}

/// The factors of a product; anything else is its own single factor.
pub fn factors_of(dag: &Dag, id: Id) -> Vec<Id> {
    match dag.node(id) {
        Node::Product(factors) => factors.clone(),
        _ => vec![id],
    }
}

/// Takes common factors out of sums, which saves multiplications: `k g^1.5 + k c g^1.5 r = k g^1.5 (1 + c r)`.
///
/// Only whole factors that every term carries are taken out, so no power is split and no rounding is added.
pub fn factor(dag: &mut Dag, id: Id) -> Id {
    let mut factored: HashMap<Id, Id> = HashMap::new();
    for current in dag.reachable(&[id]) {
        let rebuilt = dag.rebuild_node(current, &factored);
        let value = factor_sum(dag, rebuilt);
        factored.insert(current, value);
    }
    factored[&id]
}

fn factor_sum(dag: &mut Dag, id: Id) -> Id {
    let Node::Sum(terms) = dag.node(id).clone() else {
        return id;
    };
    let mut common: Vec<Id> = factors_of(dag, terms[0]);
    for &term in &terms[1..] {
        let factors = factors_of(dag, term);
        common.retain(|factor| factors.contains(factor));
    }
    if common.iter().all(|&factor| dag.as_number(factor).is_some()) {
        return id;
    }
    common.dedup();
    let mut rests = Vec::new();
    for &term in &terms {
        let mut rest = factors_of(dag, term);
        for factor in &common {
            if let Some(position) = rest.iter().position(|other| other == factor) {
                rest.remove(position);
            }
        }
        rests.push(dag.product(&rest));
    }
    let sum = dag.sum(&rests);
    common.push(sum);
    dag.product(&common)
}

/// Whether an expression is zero: by multiplying out, which proves it, or else by trial at a few points.
///
/// `probe` gives the value of a variable at trial number `n`. An expression that is zero to rounding at every trial is
/// taken to be zero; the trials catch identities that multiplying out does not see, such as `(4 g)^1.5 = 8 g^1.5`.
pub fn is_zero(dag: &mut Dag, id: Id, probe: &dyn Fn(usize, Variable) -> f64) -> bool {
    let expanded = expand(dag, id);
    if dag.as_number(expanded).is_some() {
        return dag.as_number(expanded) == Some(Rational::ZERO);
    }
    (0..8).all(|trial| {
        let at = |variable| probe(trial, variable);
        let value = dag.evaluate(expanded, &at);
        let scale: f64 = addends_of(dag, expanded)
            .into_iter()
            .map(|term| dag.evaluate(term, &at).abs())
            .sum();
        value.abs() <= 1e-12 * scale
    })
}
