//! One-sided limits at a level.

use std::collections::HashMap;

use hertzian_contract::system::Bound;

use super::is_above;
use crate::dag::{Dag, Id, Node, Rational, Variable};
use crate::simplify::expand;

/// Ranges of the arguments of a law.
#[derive(Debug, Clone, Copy)]
pub struct Ranges<'a>(pub &'a [(Bound, Bound)]);

impl Ranges<'_> {
    fn of(&self, argument: usize) -> (Bound, Bound) {
        self.0
            .get(argument)
            .copied()
            .unwrap_or((Bound::Unbounded, Bound::Unbounded))
    }

    /// Whether an expression is certainly positive: a positive number, or an argument plus a number whose range says so.
    pub fn is_positive(&self, dag: &mut Dag, id: Id) -> bool {
        if let Some(number) = dag.as_number(id) {
            return number.is_positive();
        }
        let Some((argument, offset, sign)) = shifted_argument(dag, id) else {
            return false;
        };
        let (minimum, maximum) = self.of(argument);
        let offset = offset.to_f64();
        if sign {
            is_above(minimum, -offset)
        } else {
            is_above(opposite(maximum), -offset)
        }
    }

    /// Whether an expression is certainly not zero.
    pub fn is_nonzero(&self, dag: &mut Dag, id: Id) -> bool {
        let opposite = dag.negate(id);
        self.is_positive(dag, id) || self.is_positive(dag, opposite)
    }

    /// A value for trial number `trial` of an identity: of no special form, and inside the range of an argument.
    pub fn probe(&self, trial: usize, variable: Variable) -> f64 {
        let (index, range) = match variable {
            Variable::Argument(index) => (index + 3, self.of(index)),
            Variable::Gap => (1, (Bound::Unbounded, Bound::Unbounded)),
            _ => (2, (Bound::Unbounded, Bound::Unbounded)),
        };
        // Fractions of the golden ratio: evenly spread, and never the same for two variables.
        let spread = ((trial * 11 + index * 7 + 1) as f64 * 0.618_033_988_749_895).fract();
        match (end(range.0), end(range.1)) {
            (Some(low), Some(high)) => low + (high - low) * spread,
            (Some(low), None) => low + 0.1 + 3.0 * spread,
            (None, Some(high)) => high - 0.1 - 3.0 * spread,
            (None, None) => 0.1 + 3.0 * spread,
        }
    }
}

fn end(bound: Bound) -> Option<f64> {
    match bound {
        Bound::Unbounded => None,
        Bound::Included(value) | Bound::Excluded(value) => Some(value),
    }
}

fn opposite(bound: Bound) -> Bound {
    match bound {
        Bound::Unbounded => Bound::Unbounded,
        Bound::Included(value) => Bound::Included(-value),
        Bound::Excluded(value) => Bound::Excluded(-value),
    }
}

/// An argument plus a number, or minus an argument plus a number (`false`).
pub fn shifted_argument(dag: &mut Dag, id: Id) -> Option<(usize, Rational, bool)> {
    let terms = match dag.node(id) {
        Node::Sum(terms) => terms.clone(),
        _ => vec![id],
    };
    let mut offset = Rational::ZERO;
    let mut found = None;
    for term in terms {
        if let Some(number) = dag.as_number(term) {
            offset = number;
            continue;
        }
        let (coefficient, rest) = dag.split_coefficient(term);
        let unit = coefficient.absolute() == Some(Rational::ONE);
        match *dag.node(rest) {
            Node::Variable(Variable::Argument(index)) if unit && found.is_none() => {
                found = Some((index, coefficient.is_positive()));
            }
            _ => return None,
        }
    }
    found.map(|(index, sign)| (index, offset, sign))
}

/// A limit.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Limit {
    /// It exists.
    Finite(Id),
    /// It is infinite, or not certain to be finite for every admitted argument.
    Unbounded,
}

/// The limit of an expression as the gap approaches a level from within the piece.
///
/// A power whose base vanishes there goes to zero if its exponent is certainly positive, and so does its logarithm;
/// otherwise it is taken to be unbounded.
pub fn at(dag: &mut Dag, id: Id, level: Id, ranges: Ranges<'_>) -> Limit {
    let expanded = expand(dag, id);
    let mut limits: HashMap<Id, Id> = HashMap::new();
    let (zero, gap) = (dag.integer(0), dag.variable(Variable::Gap));
    for current in dag.reachable(&[expanded]) {
        let power = match *dag.node(current) {
            Node::Power(base, exponent) | Node::PowerLog(base, exponent) => {
                Some((limits[&base], limits[&exponent]))
            }
            _ => None,
        };
        let value = match power {
            Some((base, exponent)) if expand(dag, base) == zero => {
                if !ranges.is_positive(dag, exponent) {
                    return Limit::Unbounded;
                }
                zero
            }
            _ if current == gap => level,
            _ => dag.rebuild_node(current, &limits),
        };
        limits.insert(current, value);
    }
    Limit::Finite(expand(dag, limits[&expanded]))
}
