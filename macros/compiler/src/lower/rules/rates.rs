//! Rules on the rate of a gap.

use std::collections::HashMap;

use crate::dag::{Dag, Function, Id, Node, Rational, Variable};
use crate::errors::Extent;
use crate::lower::algebra::{addends, affine, put, split_factor};
use crate::lower::expand::Expander;
use crate::lower::interval::Stretch;
use crate::lower::resolve::shown;
use crate::lower::written::Written;

/// A sum that is smaller than this part of its terms is rounding.
const ROUNDING: f64 = 8.0 * f64::EPSILON;

/// The force does not jump with the rate. (Across a level it may: the level is crossed at the same speed on both sides. A jump in the rate sticks and
/// slides, which is another kind of mathematics.)
pub fn force_does_not_jump_with_the_rate(
    context: &mut Expander,
    force: Id,
    written: &[Written],
    extent: Extent,
) -> syn::Result<()> {
    for switch in switches(&context.dag, force) {
        let above = on_side(&mut context.dag, force, switch, true);
        let below = on_side(&mut context.dag, force, switch, false);
        let jump = context.dag.difference(above, below);
        if vanishes_with(context, jump, switch) {
            continue;
        }
        let rate = context.label(Variable::Rate);
        let message = if context.dag.depends_on(switch, Variable::Gap) {
            format!(
                "the force jumps where `{}` changes sign, which depends on gap and rate; a force may jump at a level of the gap alone: make it continuous there, as `max(0, ...)` is",
                shown(context, switch, written)
            )
        } else {
            format!(
                "the force jumps with the rate: this is dry friction, which sticks and slides and is not supported; write a smooth law such as `tanh({rate}/0.01)`, or a continuous one such as `|{rate}|*{rate}`"
            )
        };
        return Err(extent.fault(message));
    }
    Ok(())
}

/// Whether a jump is zero wherever its switch is: the switch is solved for a variable in which it is affine, and the
/// jump taken there.
fn vanishes_with(context: &mut Expander, jump: Id, switch: Id) -> bool {
    let mut variables = context.dag.variables(switch);
    variables.sort_by_key(|&variable| variable != Variable::Rate);
    let solved = variables.into_iter().find_map(|variable| {
        let (slope, rest) = affine(&mut context.dag, switch, variable)?;
        Some((variable, slope, rest))
    });
    let Some((variable, slope, rest)) = solved else {
        return vanishes(context, jump) || vanishes_with_a_term(context, jump, switch);
    };
    let quotient = context.dag.quotient(rest, slope);
    let root = context.dag.negate(quotient);
    let jump = put(&mut context.dag, jump, variable, root);
    vanishes(context, jump)
}

/// The same, where the switch is solved for one of its terms instead: `dot(g)^2` in `1 - dot(g)^2`.
fn vanishes_with_a_term(context: &mut Expander, jump: Id, switch: Id) -> bool {
    addends(&mut context.dag, switch).into_iter().any(|term| {
        let dag = &mut context.dag;
        let (factor, power) = split_factor(dag, term, &[Variable::Gap, Variable::Rate]);
        if !dag.depends_on(power, Variable::Rate) {
            return false;
        }
        let rest = dag.difference(switch, term);
        let quotient = dag.quotient(rest, factor);
        let root = dag.negate(quotient);
        let replaced = dag.replace(jump, power, root);
        let terms = addends(dag, replaced);
        let jump = dag.sum(&terms);
        vanishes(context, jump)
    })
}

/// What the rate enters through an absolute value, sign or step.
fn switches(dag: &Dag, force: Id) -> Vec<Id> {
    let mut found = Vec::new();
    for id in dag.reachable(&[force]) {
        if let Node::Call(Function::Absolute | Function::Sign | Function::Step, operand) =
            *dag.node(id)
            && dag.depends_on(operand, Variable::Rate)
            && !found.contains(&operand)
        {
            found.push(operand);
        }
    }
    found
}

fn on_side(dag: &mut Dag, force: Id, switch: Id, above: bool) -> Id {
    let one = dag.integer(1);
    let (absolute, sign, step) = if above {
        (switch, one, one)
    } else {
        (dag.negate(switch), dag.integer(-1), dag.integer(0))
    };
    let replacements = [
        (Function::Absolute, absolute),
        (Function::Sign, sign),
        (Function::Step, step),
    ];
    let replacements: HashMap<Id, Id> = replacements
        .map(|(function, value)| (dag.intern(Node::Call(function, switch)), value))
        .into();
    dag.rebuild(force, replacements)
}

/// Whether a sum of numbers is zero but for rounding. Products of numbers with many digits are not exact.
fn cancels(dag: &Dag, terms: &[Id]) -> bool {
    if terms.iter().any(|term| !dag.variables(*term).is_empty()) {
        return false;
    }
    let values = terms.iter().map(|term| dag.evaluate(*term, &|_| f64::NAN));
    let [sum, sizes] = values.fold([0.0, 0.0], |[sum, sizes], value| {
        [sum + value, sizes + value.abs()]
    });
    sum.abs() <= ROUNDING * sizes
}

/// Whether an expression is zero, powers of zero with positive exponents included.
fn vanishes(context: &mut Expander, id: Id) -> bool {
    let mut known: HashMap<Id, bool> = HashMap::new();
    for current in context.dag.reachable(&[id]) {
        let zero = match context.dag.node(current).clone() {
            Node::Number(number) => number == Rational::ZERO,
            Node::Pi
            | Node::Variable(_)
            | Node::PowerLog(..)
            | Node::Call(Function::Cosine | Function::Exponential, _) => false,
            Node::Sum(terms) => {
                terms.iter().all(|term| known[term]) || cancels(&context.dag, &terms)
            }
            Node::Product(factors) => factors.iter().any(|factor| known[factor]),
            Node::Power(base, exponent) => {
                known[&base]
                    && context
                        .ranges
                        .bounds(&mut context.dag, exponent, Stretch::ALL)
                        .is_positive()
            }
            Node::Call(_, operand) => known[&operand],
        };
        known.insert(current, zero);
    }
    known[&id]
}
