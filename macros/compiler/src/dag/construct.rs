//! The smart constructors: every expression is built through these, in canonical form.

use super::{Dag, Function, Id, Node, Rational, Variable};

/// Powers of logarithms are merged up to this exponent.
const MAX_LOGARITHMS: i32 = 64;

/// A product taken apart: a number, powers (base and exponent), and factors that are not powers.
#[derive(Default)]
struct Factors {
    numbers: Vec<Rational>,
    powers: Vec<(Id, Id)>,
    logarithms: Vec<(Id, Id)>,
}

impl Dag {
    /// An exact number.
    pub fn number(&mut self, value: Rational) -> Id {
        self.intern(Node::Number(value))
    }

    /// A whole number.
    pub fn integer(&mut self, value: i32) -> Id {
        self.number(Rational::integer(i128::from(value)))
    }

    /// The number pi.
    pub fn pi(&mut self) -> Id {
        self.intern(Node::Pi)
    }

    /// A variable.
    pub fn variable(&mut self, variable: Variable) -> Id {
        self.intern(Node::Variable(variable))
    }

    /// `-a`
    pub fn negate(&mut self, a: Id) -> Id {
        let minus = self.integer(-1);
        self.product(&[minus, a])
    }

    /// `a - b`
    pub fn difference(&mut self, a: Id, b: Id) -> Id {
        let negative = self.negate(b);
        self.sum(&[a, negative])
    }

    /// `a / b`, a product with a power of exponent -1.
    pub fn quotient(&mut self, a: Id, b: Id) -> Id {
        let minus = self.integer(-1);
        let reciprocal = self.power(b, minus);
        self.product(&[a, reciprocal])
    }

    /// Sum of any number of terms.
    pub fn sum(&mut self, terms: &[Id]) -> Id {
        if self.is_spent() {
            return self.integer(0);
        }
        let mut collected: Vec<(Id, Rational)> = Vec::new();
        for &term in terms {
            let parts = match self.node(term) {
                Node::Sum(parts) => parts.clone(),
                _ => vec![term],
            };
            for part in parts {
                let (coefficient, rest) = self.split_coefficient(part);
                collected.push((rest, coefficient));
            }
        }
        self.charge(1 + 2 * collected.len());
        collected.sort_by_key(|&(rest, _)| rest);
        let mut merged: Vec<(Id, Rational)> = Vec::new();
        for (rest, coefficient) in collected {
            let previous = merged.last_mut().filter(|(last, _)| *last == rest);
            // Where the exact sum of two coefficients does not fit, both terms stay.
            match previous.and_then(|last| Some((last.1.checked_add(coefficient)?, last))) {
                Some((total, last)) => last.1 = total,
                None => merged.push((rest, coefficient)),
            }
        }
        merged.retain(|(_, coefficient)| !coefficient.is_zero());
        let mut terms: Vec<Id> = merged
            .into_iter()
            .map(|(rest, c)| self.scale(c, rest))
            .collect();
        terms.sort_unstable();
        match terms.as_slice() {
            [] => self.integer(0),
            [only] => *only,
            _ => self.intern(Node::Sum(terms)),
        }
    }

    /// Product of any number of factors.
    pub fn product(&mut self, factors: &[Id]) -> Id {
        if self.is_spent() {
            return self.integer(0);
        }
        let mut parts = Factors::default();
        for &factor in factors {
            match self.node(factor) {
                Node::Product(inner) => {
                    for inner in inner.clone() {
                        self.take_factor(&mut parts, inner);
                    }
                }
                _ => self.take_factor(&mut parts, factor),
            }
        }
        self.charge(1 + 2 * (parts.numbers.len() + parts.powers.len() + parts.logarithms.len()));
        if parts.numbers.iter().any(|number| number.is_zero()) {
            return self.integer(0);
        }
        self.cancel_numbers(&mut parts);
        let logarithms = self.merge_logarithms(&mut parts);
        let (mut rest, again) = self.merge_powers(parts.powers);
        rest.extend(logarithms);
        if again {
            for number in parts.numbers {
                rest.push(self.number(number));
            }
            return self.product(&rest);
        }
        self.assemble(parts.numbers, rest)
    }

    /// Numbers without an exact reciprocal, divided by themselves.
    fn cancel_numbers(&mut self, parts: &mut Factors) {
        parts.numbers.retain(|&number| {
            if number.reciprocal().is_some() {
                return true;
            }
            let below = (self.number(number), self.integer(-1));
            let place = parts.powers.iter().position(|power| *power == below);
            place.map(|place| parts.powers.swap_remove(place)).is_none()
        });
    }

    /// Multiplies numbers and puts a product together.
    fn assemble(&mut self, numbers: Vec<Rational>, mut rest: Vec<Id>) -> Id {
        let mut coefficients: Vec<Rational> = Vec::new();
        for number in numbers {
            let product = coefficients
                .last()
                .and_then(|last| last.checked_mul(number));
            match (product, coefficients.last_mut()) {
                (Some(product), Some(last)) => *last = product,
                _ => coefficients.push(number),
            }
        }
        coefficients.retain(|&coefficient| coefficient != Rational::ONE);
        rest.sort_unstable();
        if let ([coefficient], [only]) = (coefficients.as_slice(), rest.as_slice())
            && let Node::Sum(terms) = self.node(*only)
        {
            let (coefficient, terms) = (*coefficient, terms.clone());
            if let Some(scaled) = self.scale_terms(coefficient, &terms) {
                return self.sum(&scaled);
            }
        }
        let mut operands: Vec<Id> = coefficients
            .into_iter()
            .map(|number| self.number(number))
            .collect();
        operands.append(&mut rest);
        match operands.as_slice() {
            [] => self.integer(1),
            [only] => *only,
            _ => self.intern(Node::Product(operands)),
        }
    }

    /// Multiplies a number into every term of a sum; `None` where one does not fit.
    fn scale_terms(&mut self, coefficient: Rational, terms: &[Id]) -> Option<Vec<Id>> {
        let mut scaled = Vec::with_capacity(terms.len());
        for &term in terms {
            let (own, rest) = self.split_coefficient(term);
            scaled.push(self.scale(own.checked_mul(coefficient)?, rest));
        }
        Some(scaled)
    }

    fn take_factor(&mut self, parts: &mut Factors, factor: Id) {
        match *self.node(factor) {
            Node::Number(number) => parts.numbers.push(number),
            Node::Power(base, exponent) => {
                if let Node::PowerLog(inner, own) = *self.node(base)
                    && let Some(count @ 1..=MAX_LOGARITHMS) = self.whole(exponent)
                {
                    parts.logarithms.extend((0..count).map(|_| (inner, own)));
                } else {
                    parts.powers.push((base, exponent));
                }
            }
            Node::PowerLog(base, exponent) => parts.logarithms.push((base, exponent)),
            _ => {
                let one = self.integer(1);
                parts.powers.push((factor, one));
            }
        }
    }

    /// `x^a (x^b ln x) (x^c ln x)^n = x^(a+b+nc) ln x (ln x)^n`: one factor carries the power, and the other logarithms
    /// are a power of the plain one.
    fn merge_logarithms(&mut self, parts: &mut Factors) -> Vec<Id> {
        let mut merged = Vec::new();
        while let Some(&(base, _)) = parts.logarithms.first() {
            let mut exponents = Vec::new();
            parts.logarithms.retain(|&(other, exponent)| {
                if other == base {
                    exponents.push(exponent);
                }
                other != base
            });
            let count = exponents.len();
            parts.powers.retain(|&(other, exponent)| {
                if other == base {
                    exponents.push(exponent);
                }
                other != base
            });
            let total = self.sum(&exponents);
            let carrier = self.power_log(base, total);
            let plain = if self.as_number(total) == Some(Rational::ZERO) {
                count
            } else {
                count - 1
            };
            if plain < count {
                merged.push(carrier);
            }
            if plain > 0 {
                let zero = self.integer(0);
                let logarithm = self.power_log(base, zero);
                let exponent = self.number(Rational::integer(plain as i128));
                merged.push(self.power_as_is(logarithm, exponent));
            }
        }
        merged
    }

    /// Adds the exponents of equal bases. Also whether a merged power has become something else, as in
    /// `2^(1/2) 2^(1/2) = 2` or `|x| |x| = x^2`, so that the product must be collected once more.
    fn merge_powers(&mut self, mut powers: Vec<(Id, Id)>) -> (Vec<Id>, bool) {
        powers.sort_unstable();
        let mut merged = Vec::new();
        let mut again = false;
        let mut index = 0;
        while index < powers.len() {
            let base = powers[index].0;
            let count = powers[index..]
                .iter()
                .take_while(|(other, _)| *other == base)
                .count();
            let exponents: Vec<Id> = powers[index..index + count]
                .iter()
                .map(|&(_, exponent)| exponent)
                .collect();
            let exponent = self.sum(&exponents);
            // A single factor is canonical already.
            let power = if count == 1 {
                self.power_as_is(base, exponent)
            } else {
                self.power(base, exponent)
            };
            if self.as_number(power) != Some(Rational::ONE) {
                again |= match self.node(power) {
                    Node::Power(other, _) => *other != base,
                    Node::Number(_) | Node::Product(_) => true,
                    _ => power != base,
                };
                merged.push(power);
            }
            index += count;
        }
        (merged, again)
    }

    fn whole(&self, id: Id) -> Option<i32> {
        self.as_number(id).and_then(Rational::to_integer)
    }

    fn power_as_is(&mut self, base: Id, exponent: Id) -> Id {
        if self.as_number(exponent) == Some(Rational::ONE) {
            base
        } else {
            self.intern(Node::Power(base, exponent))
        }
    }

    /// Guarded power `base^exponent`.
    pub fn power(&mut self, base: Id, exponent: Id) -> Id {
        let exact = self.as_number(exponent);
        if exact == Some(Rational::ONE) {
            return base;
        }
        if exact == Some(Rational::ZERO) || self.as_number(base) == Some(Rational::ONE) {
            return self.integer(1);
        }
        if let (Some(number), Some(exact)) = (self.as_number(base), exact) {
            if number.is_zero() && exact.is_positive() {
                return base;
            }
            if let Some(value) = exact.to_integer().and_then(|n| number.integer_power(n)) {
                return self.number(value);
            }
        }
        let repeats = exact
            .and_then(Rational::to_integer)
            .filter(|count| (2..=MAX_LOGARITHMS).contains(count))
            .and_then(|count| usize::try_from(count).ok());
        match self.node(base).clone() {
            Node::Power(inner, first) => self.power_of_power(base, inner, first, exponent),
            // `(a b)^n = a^n b^n` for whole n, whatever the signs.
            Node::Product(factors) if exact.is_some_and(Rational::is_integer) => {
                let powers: Vec<Id> = factors
                    .iter()
                    .map(|&factor| self.power(factor, exponent))
                    .collect();
                self.product(&powers)
            }
            Node::PowerLog(..) if repeats.is_some() => {
                self.product(&vec![base; repeats.unwrap_or(1)])
            }
            Node::Call(Function::Absolute, inner) if exact.is_some_and(Rational::is_even) => {
                self.power(inner, exponent)
            }
            Node::Call(Function::Step, _) if exact.is_some_and(Rational::is_positive) => base,
            _ => self.intern(Node::Power(base, exponent)),
        }
    }

    /// `(inner^first)^second`. With an even `first` the inner base may be negative: `(x^2)^(1/2) = |x|`.
    fn power_of_power(&mut self, base: Id, inner: Id, first: Id, second: Id) -> Id {
        let exact = |id| self.as_number(id);
        let even = exact(first).is_some_and(Rational::is_even);
        let whole = exact(second).is_some_and(Rational::is_integer);
        if exact(first)
            .zip(exact(second))
            .is_some_and(|(a, b)| a.checked_mul(b).is_none())
        {
            return self.intern(Node::Power(base, second));
        }
        let inner = if even && !whole {
            self.call(Function::Absolute, inner)
        } else {
            inner
        };
        let exponent = self.product(&[first, second]);
        self.power(inner, exponent)
    }

    /// Guarded `base^exponent ln(base)`.
    pub fn power_log(&mut self, base: Id, exponent: Id) -> Id {
        if self.as_number(base) == Some(Rational::ONE) {
            return self.integer(0);
        }
        if self.as_number(base) == Some(Rational::ZERO) {
            return base;
        }
        self.intern(Node::PowerLog(base, exponent))
    }

    /// A function of one operand.
    pub fn call(&mut self, function: Function, operand: Id) -> Id {
        if let Some(value) = self.call_of_number(function, operand) {
            return value;
        }
        match function {
            Function::Absolute => self.absolute(operand),
            Function::Sign | Function::Sine | Function::Tanh => {
                let (negative, operand) = self.without_sign(operand, function == Function::Sign);
                let value = self.intern(Node::Call(function, operand));
                if negative { self.negate(value) } else { value }
            }
            Function::Cosine => {
                let (_, operand) = self.without_sign(operand, false);
                self.intern(Node::Call(function, operand))
            }
            Function::Step => {
                let (negative, magnitude) = self.without_sign(operand, true);
                let operand = if negative {
                    self.negate(magnitude)
                } else {
                    magnitude
                };
                self.intern(Node::Call(function, operand))
            }
            Function::Exponential => self.intern(Node::Call(function, operand)),
        }
    }

    fn call_of_number(&mut self, function: Function, operand: Id) -> Option<Id> {
        let number = self.as_number(operand)?;
        let value = match function {
            Function::Absolute => number.absolute()?,
            Function::Sign => number.sign(),
            Function::Step => Rational::integer(i128::from(number.is_positive())),
            Function::Sine | Function::Tanh if number.is_zero() => Rational::ZERO,
            Function::Cosine | Function::Exponential if number.is_zero() => Rational::ONE,
            _ => return None,
        };
        Some(self.number(value))
    }

    fn absolute(&mut self, operand: Id) -> Id {
        if let (coefficient, rest) = self.split_coefficient(operand)
            && coefficient != Rational::ONE
            && let Some(magnitude) = coefficient.absolute()
        {
            let value = self.call(Function::Absolute, rest);
            let magnitude = self.number(magnitude);
            return self.product(&[magnitude, value]);
        }
        let never_negative = match *self.node(operand) {
            Node::Call(Function::Absolute | Function::Step | Function::Exponential, _)
            | Node::Pi => true,
            Node::Power(_, exponent) => self
                .as_number(exponent)
                .is_none_or(|exact| !exact.is_integer() || exact.is_even()),
            _ => false,
        };
        if never_negative {
            return operand;
        }
        let (_, operand) = self.without_sign(operand, false);
        self.intern(Node::Call(Function::Absolute, operand))
    }

    /// What `sgn` is really taken of: the operand without a constant factor, the same for `a - b` and `2*b - 2*a`.
    pub fn up_to_a_factor(&mut self, operand: Id) -> Id {
        self.without_sign(operand, true).1
    }

    /// Whether the leading coefficient is negative, and the operand with that sign taken out; the positive factor goes
    /// too where only the sign matters. The leading term of a sum is, of those that are not numbers, the first by what
    /// its coefficient multiplies, which a change of sign leaves alone.
    fn without_sign(&mut self, operand: Id, only_sign_matters: bool) -> (bool, Id) {
        let terms = match self.node(operand) {
            Node::Sum(terms) => terms.clone(),
            _ => vec![operand],
        };
        let split = terms.iter().map(|&term| self.split_coefficient(term));
        let split: Vec<(Rational, Id)> = split.collect();
        let one = self.integer(1);
        let leading = split
            .into_iter()
            .min_by_key(|&(_, rest)| (rest == one, rest));
        let Some((coefficient, _)) = leading else {
            return (false, operand);
        };
        let factor = if only_sign_matters {
            coefficient
        } else {
            coefficient.sign()
        };
        let Some(inverse) = factor.reciprocal() else {
            return (false, operand);
        };
        let inverse = self.number(inverse);
        (coefficient.is_negative(), self.product(&[inverse, operand]))
    }

    /// The number a term is multiplied by, and the rest; the rest of a number is one.
    pub fn split_coefficient(&mut self, id: Id) -> (Rational, Id) {
        match self.node(id) {
            Node::Number(value) => {
                let value = *value;
                (value, self.integer(1))
            }
            Node::Product(factors) => match self.as_number(factors[0]) {
                Some(coefficient) => {
                    let rest = factors[1..].to_vec();
                    let rest = if rest.len() == 1 {
                        rest[0]
                    } else {
                        self.intern(Node::Product(rest))
                    };
                    (coefficient, rest)
                }
                None => (Rational::ONE, id),
            },
            _ => (Rational::ONE, id),
        }
    }

    /// A number times an expression that carries none.
    fn scale(&mut self, coefficient: Rational, rest: Id) -> Id {
        if coefficient == Rational::ONE {
            return rest;
        }
        if self.as_number(rest) == Some(Rational::ONE) {
            return self.number(coefficient);
        }
        let number = self.number(coefficient);
        match self.node(rest) {
            Node::Product(factors) => {
                let mut operands = vec![number];
                operands.extend_from_slice(factors);
                self.intern(Node::Product(operands))
            }
            _ => self.intern(Node::Product(vec![number, rest])),
        }
    }
}
