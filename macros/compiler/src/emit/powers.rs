//! Powers as code: products and roots where the exponent is a known multiple of 1/2, 1/3 or 1/4; otherwise one logarithm
//! per base, one exponential per exponent modulo one.
//!
//! # Accuracy
//!
//! Powers of one base whose exponents differ by whole numbers share an exponential: one of them is computed, the others
//! are its products with, or quotients by, the base. `exp(a ln g)` carries a relative error of about `1 + |a ln g|` ulp,
//! and the powers made from it inherit that error. So the one to compute is that of the exponent of smallest size: its
//! error is within the bound of all the others. A symbolic exponent is chosen when a batch is, which costs nothing.
//!
//! The same choice keeps the shared power away from the ends of the range of numbers: where it underflows or overflows,
//! those made from it do too. At `g = 0` each is zero, as its guarded power is: one of exponent zero would be the
//! smallest, and is not made from another.

use std::collections::HashMap;

use super::tape::{Builder, Operation};
use crate::dag::{Dag, Id, Node, Rational};

/// Fractional powers above this one are computed by logarithm and exponential; beyond it no exponential is shared.
const MAX_WHOLE: i128 = 64;

/// How many multiplications or divisions by the base are worth less than an exponential.
const MAX_STEPS: i128 = 4;

/// Exponents of one base that differ by whole numbers.
#[derive(Clone, Copy)]
struct Shared {
    /// The exponent that the others are counted from.
    reference: Id,
    /// The lowest of them, as steps from the reference.
    lowest: i128,
    /// The highest of them.
    highest: i128,
}

/// For a base and an exponent, what it shares an exponential with, and its steps from the reference.
#[derive(Default)]
pub struct Exponents {
    shared: HashMap<(Id, Id), (Shared, i128)>,
}

impl Exponents {
    /// Plans the powers of all expressions under `roots`.
    pub fn of(dag: &mut Dag, roots: &[Id]) -> Self {
        let mut groups: HashMap<(Id, Id), Vec<(i128, Id)>> = HashMap::new();
        for id in dag.reachable(roots) {
            let (Node::Power(base, exponent) | Node::PowerLog(base, exponent)) = *dag.node(id)
            else {
                continue;
            };
            if dag.as_number(exponent).is_some_and(is_simple) {
                continue;
            }
            if let Some((rest, whole)) = split_whole(dag, exponent) {
                let group = groups.entry((base, rest)).or_default();
                if !group.contains(&(whole, exponent)) {
                    group.push((whole, exponent));
                }
            }
        }
        let mut shared = HashMap::new();
        for ((base, _), group) in groups {
            for (exponent, member) in share(dag, group) {
                shared.insert((base, exponent), member);
            }
        }
        Self { shared }
    }
}

/// Members of a group that are close enough to share an exponential. The reference is the exponent of smallest size if
/// it is a number, and otherwise the one with the smallest number beside the symbols: `alpha` itself, rather than
/// `alpha - 1`, is exact.
fn share(dag: &Dag, mut group: Vec<(i128, Id)>) -> Vec<(Id, (Shared, i128))> {
    let size = |&(whole, exponent): &(i128, Id)| match dag.as_number(exponent) {
        Some(number) => number.to_f64().abs(),
        None => whole.abs() as f64,
    };
    group.sort_by(|a, b| size(a).total_cmp(&size(b)).then(a.cmp(b)));
    let Some(&(origin, reference)) = group.first() else {
        return Vec::new();
    };
    group.retain(|(whole, _)| (whole - origin).abs() <= MAX_STEPS);
    if group.len() < 2 {
        return Vec::new();
    }
    let steps = || group.iter().map(|(whole, _)| whole - origin);
    let shared = Shared {
        reference,
        lowest: steps().min().unwrap_or(0),
        highest: steps().max().unwrap_or(0),
    };
    let members = group.iter();
    members
        .map(|&(whole, exponent)| (exponent, (shared, whole - origin)))
        .collect()
}

/// An exponent as a rest plus a whole number; of a symbolic one, the rest keeps the symbols.
fn split_whole(dag: &mut Dag, exponent: Id) -> Option<(Id, i128)> {
    let number = match dag.node(exponent) {
        Node::Number(number) => Some(*number),
        Node::Sum(terms) => terms.iter().find_map(|&term| dag.as_number(term)),
        _ => None,
    };
    let number = number.unwrap_or(Rational::ZERO);
    let whole = number.numerator().div_euclid(number.denominator());
    if whole.abs() > MAX_WHOLE {
        return None;
    }
    let offset = dag.number(Rational::integer(whole));
    Some((dag.difference(exponent, offset), whole))
}

/// Whether products and roots suffice.
fn is_simple(exponent: Rational) -> bool {
    let bound = Rational::integer(MAX_WHOLE);
    let small = exponent
        .absolute()
        .is_some_and(|magnitude| magnitude <= bound);
    exponent.is_integer() || (small && exponent.denominator() <= 4)
}

impl Builder<'_> {
    pub(super) fn code_power(&mut self, base: Id, exponent: Id) -> usize {
        if let Some(exact) = self
            .dag
            .as_number(exponent)
            .filter(|&exact| is_simple(exact))
        {
            return self.simple_power(base, exact);
        }
        if let Some(&(shared, steps)) = self.exponents.shared.get(&(base, exponent)) {
            return self.shared_power(base, shared, steps);
        }
        let exponent = self.position_of(exponent);
        self.raise(self.at[&base], exponent)
    }

    /// One of the powers that share an exponential.
    fn shared_power(&mut self, base: Id, shared: Shared, steps: i128) -> usize {
        let position = self.at[&base];
        let reference = self.position_of(shared.reference);
        if self.dag.as_number(shared.reference).is_some() {
            let mut power = self.raise(position, reference);
            for _ in 0..steps.abs() {
                power = self.push(if steps > 0 {
                    Operation::Multiply(power, position)
                } else {
                    Operation::Over(power, position)
                });
            }
            return power;
        }
        let [lowest, highest, steps_to] =
            [shared.lowest, shared.highest, steps].map(|whole| self.number(whole as f64));
        let nearest = self.push(Operation::Nearest(reference, lowest, highest));
        let exponent = self.push(Operation::Add(reference, nearest));
        let power = self.raise(position, exponent);
        let steps_from = self.push(Operation::Subtract(steps_to, nearest));
        self.push(Operation::Shift {
            power,
            base: position,
            steps: steps_from,
            up: (steps - shared.lowest) as usize,
            down: (shared.highest - steps) as usize,
        })
    }

    fn raise(&mut self, base: usize, exponent: usize) -> usize {
        let logarithm = self.push(Operation::Logarithm(base));
        self.push(Operation::Raise(base, logarithm, exponent))
    }

    /// Where an exponent is; one that only the plan asks for is lowered now.
    fn position_of(&mut self, exponent: Id) -> usize {
        match self.at.get(&exponent) {
            Some(&position) => position,
            None => self.lower(exponent),
        }
    }

    pub(super) fn code_power_log(&mut self, base: Id, exponent: Id) -> usize {
        let position = self.at[&base];
        let logarithm = self.push(Operation::Logarithm(position));
        if self.dag.as_number(exponent) == Some(Rational::ZERO) {
            return logarithm;
        }
        let power = self.code_power(base, exponent);
        self.push(Operation::Multiply(power, logarithm))
    }

    /// `base^(k + j/n)` with `n` at most 4. The root is zero for a negative base, and so is the product.
    fn simple_power(&mut self, base: Id, exponent: Rational) -> usize {
        let magnitude = exponent.absolute().unwrap_or(exponent);
        let whole = magnitude.numerator() / magnitude.denominator();
        let part = magnitude.numerator() % magnitude.denominator();
        let position = self.at[&base];
        if part == 0 && exponent.is_negative() && self.varies(base) {
            // The negative powers of one base share its reciprocal.
            let reciprocal = self.push(Operation::Reciprocal(position));
            return self.whole_power(reciprocal, whole);
        }
        let mut power = None;
        if whole > 0 {
            power = Some(self.whole_power(position, whole));
        }
        if part > 0 {
            let root = self.root(position, part, magnitude.denominator());
            power = Some(match power {
                Some(power) => self.push(Operation::Multiply(power, root)),
                None => root,
            });
        }
        let Some(power) = power else {
            return self.number(1.0);
        };
        if !exponent.is_negative() {
            power
        } else if self.varies(base) {
            self.push(Operation::Reciprocal(power))
        } else {
            let one = self.number(1.0);
            self.push(Operation::Divide(one, power))
        }
    }

    /// `base^(part/of)` for a proper fraction.
    fn root(&mut self, base: usize, part: i128, of: i128) -> usize {
        if of == 3 {
            let root = self.push(Operation::CubeRoot(base));
            return self.whole_power(root, part);
        }
        let half = self.push(Operation::Root(base));
        if of == 2 {
            return half;
        }
        let quarter = self.push(Operation::Root(half));
        if part == 1 {
            quarter
        } else {
            self.push(Operation::Multiply(half, quarter))
        }
    }

    /// A positive whole power by squaring.
    fn whole_power(&mut self, base: usize, exponent: i128) -> usize {
        if exponent == 1 {
            return base;
        }
        let half = self.whole_power(base, exponent / 2);
        let even = self.push(Operation::Multiply(half, half));
        if exponent % 2 == 0 {
            even
        } else {
            self.push(Operation::Multiply(even, base))
        }
    }
}
