//! One root, one logarithm for several pieces: where pieces raise bases of their own, all of them raise one base, which is
//! that of the piece a sample lies on. So the powers of a law with two sides are computed once, not once for each side.
//!
//! The base of a power is not negative on its own piece, so where one piece raises `g` and another `-g`, each on its own side
//! of zero, that base is `|g|`. Any other is chosen by comparison with the levels. A sample on a piece without such a
//! power gets the base of another piece; what comes of it is selected away.

use std::collections::{BTreeMap, HashMap};

use crate::dag::{Dag, Function, Id, Node, Rational, Variable};
use crate::tape::powers::{Root, root_of, varies};

/// The values of pieces, as they are computed together.
pub struct Shared {
    /// The values of each piece.
    pub pieces: Vec<Vec<Id>>,
    /// What [`Variable::Base`] stands for: by position, the base of every piece that has it.
    pub bases: Vec<BTreeMap<usize, Id>>,
}

/// The bases that pieces have in common, and what is computed of them.
#[derive(Default)]
struct Slot {
    of: BTreeMap<usize, Id>,
    roots: Vec<Root>,
}

/// Gives pieces that take the same kind of root common bases; `None` where there are none.
pub fn share_bases(dag: &mut Dag, pieces: &[Vec<Id>]) -> Option<Shared> {
    let mut slots: Vec<Slot> = Vec::new();
    for (piece, values) in pieces.iter().enumerate() {
        for (base, roots) in roots_of(dag, values) {
            let fits = |slot: &Slot| {
                !slot.of.contains_key(&piece) && slot.roots.iter().any(|root| roots.contains(root))
            };
            let at = slots.iter().position(fits).unwrap_or(slots.len());
            if at == slots.len() {
                slots.push(Slot::default());
            }
            let slot = &mut slots[at];
            slot.of.insert(piece, base);
            slot.roots.extend(roots);
        }
    }
    let mut bases = Vec::new();
    let mut replaced: HashMap<(usize, Id), Id> = HashMap::new();
    for Slot { of, .. } in slots {
        let Some(common) = common(dag, &of, bases.len()) else {
            continue;
        };
        replaced.extend(of.iter().map(|(&piece, &base)| ((piece, base), common)));
        if matches!(dag.node(common), Node::Variable(_)) {
            bases.push(of);
        }
    }
    if replaced.is_empty() {
        return None;
    }
    let pieces = pieces.iter().enumerate();
    let pieces = pieces
        .map(|(piece, values)| rebuild(dag, values, &|base| replaced.get(&(piece, base)).copied()))
        .collect();
    Some(Shared { pieces, bases })
}

/// The bases of guarded powers, in order, and the kinds of roots that are taken of each.
fn roots_of(dag: &Dag, values: &[Id]) -> BTreeMap<Id, Vec<Root>> {
    let mut found: BTreeMap<Id, Vec<Root>> = BTreeMap::new();
    for id in dag.reachable(values) {
        if let Some((base, root)) = root_of(dag, id).filter(|(base, _)| varies(dag, *base)) {
            let roots = found.entry(base).or_default();
            if !roots.contains(&root) {
                roots.push(root);
            }
        }
    }
    found
}

/// What stands for the bases of several pieces; nothing if it is one base.
fn common(dag: &mut Dag, of: &BTreeMap<usize, Id>, position: usize) -> Option<Id> {
    let mut others = of.values().copied();
    let first = others.next()?;
    let negative = dag.negate(first);
    let others: Vec<Id> = others.filter(|&base| base != first).collect();
    if others.is_empty() {
        return None;
    }
    if others.iter().all(|&base| base == negative) {
        return Some(dag.call(Function::Absolute, first));
    }
    Some(dag.variable(Variable::Base(position)))
}

/// Values with the bases of their guarded powers replaced.
fn rebuild(dag: &mut Dag, values: &[Id], replaced: &dyn Fn(Id) -> Option<Id>) -> Vec<Id> {
    let mut new: HashMap<Id, Id> = HashMap::new();
    for id in dag.reachable(values) {
        let root = root_of(dag, id);
        let common = root.and_then(|(base, root)| Some((replaced(base)?, root)));
        let rebuilt = match (common, dag.node(id).clone()) {
            (Some((common, Root::Logarithm)), Node::Power(_, exponent)) => {
                dag.power(common, exponent)
            }
            (Some((common, _)), Node::Power(base, exponent)) => {
                root_of_common(dag, base, common, exponent)
            }
            (Some((common, _)), Node::PowerLog(_, exponent)) => dag.power_log(common, exponent),
            _ => dag.rebuild_node(id, &new),
        };
        new.insert(id, rebuilt);
    }
    values.iter().map(|value| new[value]).collect()
}

/// A power that is made of roots, of a common base. If that is the size of the base, `b^(n + f) = b^n |b|^f` for whole `n` and a
/// fraction `f`: pieces whose forces differ in sign then often have one expression, `g |g|^f`.
fn root_of_common(dag: &mut Dag, base: Id, common: Id, exponent: Id) -> Id {
    let known = dag.as_number(exponent);
    let fraction = known.filter(|known| !known.is_integer() && !known.is_negative());
    let size = matches!(dag.node(common), Node::Call(Function::Absolute, _));
    let Some((numerator, denominator)) = fraction.filter(|_| size).and_then(Rational::fraction)
    else {
        return dag.power(common, exponent);
    };
    let whole = dag.number(Rational::integer(numerator / denominator));
    let fraction = dag.difference(exponent, whole);
    let (whole, fraction) = (dag.power(base, whole), dag.power(common, fraction));
    dag.product(&[whole, fraction])
}
