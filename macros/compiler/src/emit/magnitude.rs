//! One logarithm for both sides: where one piece raises `g` and another `-g`, each on its own side of zero, both raise
//! `|g|` where all pieces are computed together, so that their powers are computed once.
//!
//! On its own piece either base is not negative, so `|g|` is the base; elsewhere the result means nothing either way.

use std::collections::{HashMap, HashSet};

use crate::dag::{Dag, Function, Id, Node, Rational};

/// The values of pieces with bases that occur with both signs replaced by their magnitude; `None` where there is no such base.
pub fn share_magnitudes(dag: &mut Dag, pieces: &[Vec<Id>]) -> Option<Vec<Vec<Id>>> {
    let roots = pieces.concat();
    let reachable = dag.reachable(&roots);
    let bases: HashSet<Id> = reachable.iter().filter_map(|&id| base(dag, id)).collect();
    let mut magnitudes = HashMap::new();
    let mut sorted: Vec<Id> = bases.iter().copied().collect();
    sorted.sort_unstable();
    for base in sorted {
        if bases.contains(&dag.negate(base)) {
            magnitudes.insert(base, dag.call(Function::Absolute, base));
        }
    }
    if magnitudes.is_empty() {
        return None;
    }
    let mut new: HashMap<Id, Id> = HashMap::new();
    for id in reachable {
        let magnitude = base(dag, id).and_then(|base| magnitudes.get(&base));
        let rebuilt = match (magnitude, dag.node(id).clone()) {
            (Some(&magnitude), Node::Power(_, exponent)) => dag.power(magnitude, exponent),
            (Some(&magnitude), Node::PowerLog(_, exponent)) => dag.power_log(magnitude, exponent),
            _ => dag.rebuild_node(id, &new),
        };
        new.insert(id, rebuilt);
    }
    let pieces = pieces.iter();
    Some(
        pieces
            .map(|values| values.iter().map(|value| new[value]).collect())
            .collect(),
    )
}

/// The base of a guarded power, which is not negative where it is used. Of a whole power it may be.
fn base(dag: &Dag, id: Id) -> Option<Id> {
    match *dag.node(id) {
        Node::Power(base, exponent) => {
            let whole = dag.as_number(exponent).is_some_and(Rational::is_integer);
            (!whole).then_some(base)
        }
        Node::PowerLog(base, _) => Some(base),
        _ => None,
    }
}
