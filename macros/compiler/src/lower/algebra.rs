//! Small questions to expressions: their terms, whether they are affine, what they are at a value.

use std::collections::HashMap;

use crate::dag::{Dag, Id, Node, Variable};

/// More terms than a declaration has; what would have more is left as it is.
const MOST_TERMS: usize = 256;

/// The terms of an expression with products multiplied out; powers are left alone.
pub(crate) fn addends(dag: &mut Dag, id: Id) -> Vec<Id> {
    let mut known: HashMap<Id, Vec<Id>> = HashMap::new();
    for current in dag.reachable(&[id]) {
        let terms = match dag.node(current).clone() {
            Node::Sum(terms) => terms.iter().flat_map(|term| known[term].clone()).collect(),
            Node::Product(factors) => {
                multiplied_out(dag, &factors, &known).unwrap_or_else(|| vec![current])
            }
            _ => vec![current],
        };
        let terms = if terms.len() > MOST_TERMS {
            vec![current]
        } else {
            terms
        };
        known.insert(current, terms);
    }
    let terms = known.remove(&id).unwrap_or_default();
    // Collects like terms, which multiplying out may have made.
    let sum = dag.sum(&terms);
    match dag.node(sum).clone() {
        Node::Sum(terms) => terms,
        _ => vec![sum],
    }
}

fn multiplied_out(dag: &mut Dag, factors: &[Id], known: &HashMap<Id, Vec<Id>>) -> Option<Vec<Id>> {
    let mut terms = vec![dag.integer(1)];
    for factor in factors {
        let factor = &known[factor];
        if terms.len() * factor.len() > MOST_TERMS {
            return None;
        }
        terms = terms
            .iter()
            .flat_map(|&term| factor.iter().map(move |&other| [term, other]))
            .map(|pair| dag.product(&pair))
            .collect();
    }
    Some(terms)
}

/// A term as a factor that is free of some variables, and the rest.
pub(crate) fn split_factor(dag: &mut Dag, term: Id, of: &[Variable]) -> (Id, Id) {
    let factors = match dag.node(term).clone() {
        Node::Product(factors) => factors,
        _ => vec![term],
    };
    let (bound, free): (Vec<Id>, Vec<Id>) = factors
        .into_iter()
        .partition(|&factor| of.iter().any(|&variable| dag.depends_on(factor, variable)));
    (dag.product(&free), dag.product(&bound))
}

/// The slope and the constant of an expression that is affine in a variable.
pub(crate) fn affine(dag: &mut Dag, id: Id, variable: Variable) -> Option<(Id, Id)> {
    let position = dag.variable(variable);
    let (mut slope, mut rest) = (Vec::new(), Vec::new());
    for term in addends(dag, id) {
        let (factor, own) = split_factor(dag, term, &[variable]);
        if own == position {
            slope.push(factor);
        } else if dag.depends_on(own, variable) {
            return None;
        } else {
            rest.push(term);
        }
    }
    Some((dag.sum(&slope), dag.sum(&rest)))
}

/// The expression with a variable replaced, collected again: `a (-b/a) + b` becomes zero.
pub(crate) fn put(dag: &mut Dag, id: Id, variable: Variable, value: Id) -> Id {
    let replaced = dag.substitute(id, &HashMap::from([(variable, value)]));
    let terms = addends(dag, replaced);
    dag.sum(&terms)
}
