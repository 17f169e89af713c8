//! Powers as code: products and roots where the exponent is a known multiple of 1/2, 1/3 or 1/4; otherwise one logarithm
//! per base, one exponential per exponent modulo one.
//!
//! `g^(alpha-1)` and `g^alpha` share an exponential: the lower power is computed and the other is its product with `g`.
//! (The other way round, `g^alpha / g`, would be zero over zero where `g^alpha` underflows.) Where `g` is zero the product
//! is zero, which is the limit only of a positive exponent; one that may not be positive gets its own exponential.

use std::collections::HashMap;

use super::tape::{Builder, Operation};
use crate::dag::{Dag, Id, Node, Rational};

/// Fractional powers above this one are computed by logarithm and exponential.
const MAX_WHOLE: i128 = 64;

/// How many multiplications by the base are worth less than an exponential.
const MAX_STEPS: i128 = 4;

/// For a base and an exponent, the lower exponent to start from, and how many times to multiply by the base.
#[derive(Default)]
pub struct Exponents {
    from: HashMap<(Id, Id), (Id, i128)>,
}

impl Exponents {
    /// Plans the powers of all expressions under `roots`.
    pub fn of(dag: &mut Dag, roots: &[Id], positive: &dyn Fn(&mut Dag, Id) -> bool) -> Self {
        let mut groups: HashMap<(Id, Id), Vec<(Rational, Id)>> = HashMap::new();
        for id in dag.reachable(roots) {
            let (Node::Power(base, exponent) | Node::PowerLog(base, exponent)) = *dag.node(id)
            else {
                continue;
            };
            if dag.as_number(exponent).is_some_and(is_simple) {
                continue;
            }
            if let Some((rest, offset)) = split_offset(dag, exponent) {
                groups
                    .entry((base, rest))
                    .or_default()
                    .push((offset, exponent));
            }
        }
        let mut from = HashMap::new();
        for ((base, _), mut group) in groups {
            group.sort();
            let (least, lowest) = group[0];
            for &(offset, exponent) in &group[1..] {
                let steps = offset.checked_sub(least).filter(|steps| steps.is_integer());
                if let Some(steps) = steps.map(Rational::numerator)
                    && (1..=MAX_STEPS).contains(&steps)
                    && positive(dag, exponent)
                {
                    from.insert((base, exponent), (lowest, steps));
                }
            }
        }
        Self { from }
    }
}

/// An exponent without its whole part, and the whole part; of a symbolic one, without its number, and the number.
fn split_offset(dag: &mut Dag, exponent: Id) -> Option<(Id, Rational)> {
    if let Some(number) = dag.as_number(exponent) {
        let whole = Rational::integer(number.numerator().div_euclid(number.denominator()));
        let rest = number.checked_sub(whole)?;
        return Some((dag.number(rest), whole));
    }
    let offset = match dag.node(exponent) {
        Node::Sum(terms) => terms.iter().find_map(|&term| dag.as_number(term)),
        _ => None,
    };
    let offset = offset.unwrap_or(Rational::ZERO);
    let number = dag.number(offset);
    Some((dag.difference(exponent, number), offset))
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
        if let Some(&(lowest, steps)) = self.exponents.from.get(&(base, exponent)) {
            let mut power = self.code_power(base, lowest);
            for _ in 0..steps {
                power = self.push(Operation::Multiply(power, self.at[&base]));
            }
            return power;
        }
        let base = self.at[&base];
        let logarithm = self.push(Operation::Logarithm(base));
        let exponent = match self.at.get(&exponent) {
            Some(&position) => position,
            None => self.lower(exponent),
        };
        self.push(Operation::Raise(base, logarithm, exponent))
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
