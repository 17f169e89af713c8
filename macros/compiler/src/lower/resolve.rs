//! Pieces from expressions: absolute values, signs and steps of the gap are decided on stretches of it, so that none is left.

use std::cmp::Ordering;
use std::collections::{HashMap, HashSet};

use crate::dag::{Dag, Function, Id, Node, Rational, Variable};
use crate::errors::Extent;

use super::algebra::affine;
use super::expand::Expander;
use super::interval::Stretch;
use super::rules::{pieces, powers, rates};
use super::written::{Written, followed, quote_of_switch};

/// More levels than a law has.
pub(super) const MOST_SEGMENTS: usize = 64;

/// What is said of more.
pub(super) const TOO_MANY: &str = "more than 64 pieces in one law";

/// A force on a stretch of the gap, smooth inside.
#[derive(Debug, Clone)]
pub struct Segment {
    /// Where it holds.
    pub stretch: Stretch,
    /// Whether the lower end belongs to it rather than to the segment below.
    pub holds_low: bool,
    /// The force.
    pub force: Id,
    /// Its powers and switches, for messages.
    pub written: Vec<Written>,
}

/// Splits a force into smooth segments, in increasing order of the gap.
///
/// Switches are decided from the inside out: `||g| - 1|` first splits at `g = 0`, then each side at its own root.
///
/// # Errors
/// If a level cannot be found or ordered, or a rule on powers or rates is broken; at `extent`, or at the power.
pub fn resolve(
    context: &mut Expander,
    whole: Segment,
    extent: Extent,
) -> syn::Result<Vec<Segment>> {
    let mut smooth = Vec::new();
    let mut pending = vec![whole];
    while let Some(mut segment) = pending.pop() {
        context.work_is_left(extent)?;
        if smooth.len() + pending.len() > MOST_SEGMENTS {
            return Err(extent.fault(TOO_MANY));
        }
        let switches = innermost_switches(&context.dag, segment.force);
        let Some(&first) = switches.first() else {
            remove_steps(context, &mut segment);
            rates::force_does_not_jump_with_the_rate(
                context,
                segment.force,
                &segment.written,
                extent,
            )?;
            powers::powers_are_defined(
                context,
                segment.force,
                segment.stretch,
                &segment.written,
                extent,
            )?;
            remove_powers_of_zero(&mut context.dag, &mut segment);
            smooth.push(segment);
            continue;
        };
        if decide_known(context, &mut segment, &switches)
            || take_apart(context, &mut segment, first)
        {
            pending.push(segment);
        } else {
            let [below, above] = split(context, segment, first, extent)?;
            pending.push(above);
            pending.push(below);
        }
    }
    Ok(smooth)
}

/// The operands of the absolute values, signs and steps of the gap whose own operands hold none.
fn innermost_switches(dag: &Dag, force: Id) -> Vec<Id> {
    let mut holding: HashSet<Id> = HashSet::new();
    let mut seen = HashSet::new();
    let mut found = Vec::new();
    // Operands come before their use.
    for id in dag.reachable(&[force]) {
        let holds = dag.operands(id).iter().any(|part| holding.contains(part));
        let switch = match *dag.node(id) {
            Node::Call(Function::Absolute | Function::Sign | Function::Step, operand)
                if dag.depends_on(operand, Variable::Gap) && !is_mixed_with_rate(dag, operand) =>
            {
                Some(operand)
            }
            _ => None,
        };
        found.extend(switch.filter(|operand| !holds && seen.insert(*operand)));
        if holds || switch.is_some() {
            holding.insert(id);
        }
    }
    found
}

/// Left to the rule on rates, unless it is a product, whose factors can be looked at one by one.
fn is_mixed_with_rate(dag: &Dag, operand: Id) -> bool {
    dag.depends_on(operand, Variable::Rate)
        && !matches!(dag.node(operand), Node::Product(_) | Node::Power(..))
}

/// Replaces the switches whose sign the ranges tell; false if there are none.
fn decide_known(context: &mut Expander, segment: &mut Segment, switches: &[Id]) -> bool {
    let mut replacements = HashMap::new();
    for &switch in switches {
        let bounds = context
            .ranges
            .bounds(&mut context.dag, switch, segment.stretch);
        let positive = bounds.is_not_negative();
        if positive || bounds.is_not_positive() {
            let values = decided(&mut context.dag, switch, positive);
            replacements.extend(calls_of(&mut context.dag, switch, values));
        }
    }
    let any = !replacements.is_empty();
    if any {
        substitute(&mut context.dag, segment, replacements);
    }
    any
}

/// The absolute value, sign and step of an operand whose sign is known.
fn decided(dag: &mut Dag, switch: Id, positive: bool) -> [Id; 3] {
    let (zero, one) = (dag.integer(0), dag.integer(1));
    if positive {
        [switch, one, one]
    } else {
        [dag.negate(switch), dag.negate(one), zero]
    }
}

/// The absolute value, sign and step of an operand, each with what it is replaced by.
fn calls_of(dag: &mut Dag, switch: Id, values: [Id; 3]) -> [(Id, Id); 3] {
    let [absolute, sign, step] = values;
    [
        (Function::Absolute, absolute),
        (Function::Sign, sign),
        (Function::Step, step),
    ]
    .map(|(function, value)| (dag.intern(Node::Call(function, switch)), value))
}

fn substitute(dag: &mut Dag, segment: &mut Segment, replacements: HashMap<Id, Id>) {
    let rebuilt = dag.rebuilt(segment.force, replacements);
    segment.force = rebuilt[&segment.force];
    segment.written = followed(&segment.written, &rebuilt);
}

/// `|a b| = |a| |b|`, `sgn(a b) = sgn(a) sgn(b)`, and the same for whole powers; false where the operand is neither.
fn take_apart(context: &mut Expander, segment: &mut Segment, switch: Id) -> bool {
    let (absolute, sign) = match context.dag.node(switch).clone() {
        Node::Product(factors) => {
            let (mut absolute, mut sign) = (Vec::new(), Vec::new());
            for factor in factors {
                let [magnitude, own] = magnitude_and_sign(context, factor, segment.stretch);
                absolute.push(magnitude);
                sign.push(own);
            }
            (context.dag.product(&absolute), context.dag.product(&sign))
        }
        Node::Power(base, exponent)
            if context
                .dag
                .as_number(exponent)
                .is_some_and(Rational::is_integer) =>
        {
            let [magnitude, own] = magnitude_and_sign(context, base, segment.stretch);
            (
                context.dag.power(magnitude, exponent),
                context.dag.power(own, exponent),
            )
        }
        _ => return false,
    };
    let dag = &mut context.dag;
    let one = dag.integer(1);
    let sum = dag.sum(&[sign, one]);
    let two = dag.integer(2);
    let step = dag.quotient(sum, two);
    let replacements = calls_of(dag, switch, [absolute, sign, step]);
    substitute(dag, segment, replacements.into());
    true
}

/// `|u|` and `sgn u`, decided where the ranges do.
fn magnitude_and_sign(context: &mut Expander, operand: Id, stretch: Stretch) -> [Id; 2] {
    let bounds = context.ranges.bounds(&mut context.dag, operand, stretch);
    let dag = &mut context.dag;
    if bounds.is_not_negative() {
        [operand, dag.integer(1)]
    } else if bounds.is_not_positive() {
        [dag.negate(operand), dag.integer(-1)]
    } else {
        [Function::Absolute, Function::Sign].map(|function| dag.call(function, operand))
    }
}

/// Splits a segment at the root of an operand that is affine in the gap.
fn split(
    context: &mut Expander,
    segment: Segment,
    switch: Id,
    extent: Extent,
) -> syn::Result<[Segment; 2]> {
    let Some((slope, rest)) = affine(&mut context.dag, switch, Variable::Gap) else {
        let shown = shown(context, switch, &segment.written);
        return Err(extent.fault(format!(
            "where `{shown}` changes sign is not known: the operand of `| |`, `sgn` and `H` must be linear in the gap"
        )));
    };
    let bounds = context.ranges.bounds(&mut context.dag, slope, Stretch::ALL);
    if !bounds.excludes_zero() {
        let shown = shown(context, switch, &segment.written);
        let slope_shown = context.show(slope);
        let advice = powers::advice_on_ranges(context, slope, ">");
        return Err(extent.fault(format!(
            "whether `{shown}` rises or falls with the gap depends on the sign of `{slope_shown}`, which is not known: {advice}"
        )));
    }
    let quotient = context.dag.quotient(rest, slope);
    let root = context.dag.negate(quotient);
    for (end, expected) in [
        (segment.stretch.low, Ordering::Less),
        (segment.stretch.high, Ordering::Greater),
    ] {
        if let Some(end) = end
            && pieces::order_is_known(context, end, root, extent)? == expected.reverse()
        {
            return Err(extent.fault(
                "the order of the levels is contradictory: check the ranges of the parameters",
            ));
        }
    }
    let rising = bounds.is_positive();
    let is_step = context.dag.intern(Node::Call(Function::Step, switch));
    let has_step = context.dag.reachable(&[segment.force]).contains(&is_step);
    let mut below = segment.clone();
    below.stretch.high = Some(root);
    let mut above = segment;
    above.stretch.low = Some(root);
    // A step is zero at its root itself, which therefore belongs to the side where it is zero.
    above.holds_low = has_step && !rising;
    for (side, positive) in [(&mut below, !rising), (&mut above, rising)] {
        let values = decided(&mut context.dag, switch, positive);
        let replacements = calls_of(&mut context.dag, switch, values);
        substitute(&mut context.dag, side, replacements.into());
    }
    Ok([below, above])
}

/// A switch as written, or else as it is.
pub(crate) fn shown(context: &mut Expander, switch: Id, written: &[Written]) -> String {
    quote_of_switch(&mut context.dag, written, switch)
        .map_or_else(|| context.show(switch), str::to_owned)
}

/// What is left are steps of the rate; the runtime knows only their sign.
fn remove_steps(context: &mut Expander, segment: &mut Segment) {
    for id in context.dag.reachable(&[segment.force]) {
        if let Node::Call(Function::Step, operand) = *context.dag.node(id) {
            let value = step_as_sign(&mut context.dag, operand);
            segment.force = context.dag.replace(segment.force, id, value);
        }
    }
}

/// `0^n` is zero, as an exponent that is not known has been found positive. (`max(0, x)^n` comes to that.)
fn remove_powers_of_zero(dag: &mut Dag, segment: &mut Segment) {
    let zero = dag.integer(0);
    for id in dag.reachable(&[segment.force]) {
        if matches!(*dag.node(id), Node::Power(base, _) if base == zero) {
            segment.force = dag.replace(segment.force, id, zero);
        }
    }
}

/// `H(u) = (1 + sgn u)/2`, which differs only at zero.
pub fn step_as_sign(dag: &mut Dag, operand: Id) -> Id {
    let sign = dag.call(Function::Sign, operand);
    let (one, two) = (dag.integer(1), dag.integer(2));
    let sum = dag.sum(&[one, sign]);
    dag.quotient(sum, two)
}
