//! Interval reasoning: what ranges of parameters and the ends of a piece imply for an expression.

use std::collections::HashMap;

use hertzian_contract::system::Bound;

use crate::dag::{Dag, Function, Id, Node, Rational, Variable};

/// One end of an interval.
#[derive(Debug, Clone, Copy, PartialEq)]
struct End {
    value: f64,
    /// It is only approached, not reached.
    is_open: bool,
}

impl End {
    const ZERO: Self = Self::reached(0.0);

    const fn reached(value: f64) -> Self {
        Self {
            value,
            is_open: false,
        }
    }

    const fn approached(value: f64) -> Self {
        Self {
            value,
            is_open: true,
        }
    }

    /// The same end of the interval of opposite numbers.
    fn negated(self) -> Self {
        Self {
            value: -self.value,
            ..self
        }
    }
}

/// All values an expression may have. An end may be reached or only approached.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Interval {
    low: End,
    high: End,
}

impl Interval {
    /// Every finite number.
    pub const ALL: Self = Self {
        low: End::approached(f64::NEG_INFINITY),
        high: End::approached(f64::INFINITY),
    };

    /// The range of a parameter.
    pub fn of_range(minimum: Bound, maximum: Bound) -> Self {
        let end = |bound, unbounded| match bound {
            Bound::Unbounded => End::approached(unbounded),
            Bound::Included(value) => End::reached(value),
            Bound::Excluded(value) => End::approached(value),
        };
        Self {
            low: end(minimum, f64::NEG_INFINITY),
            high: end(maximum, f64::INFINITY),
        }
    }

    /// The same as bounds.
    pub fn to_range(self) -> (Bound, Bound) {
        let bound = |end: End| match end {
            End { value, .. } if value.is_infinite() => Bound::Unbounded,
            End {
                value,
                is_open: true,
            } => Bound::Excluded(value),
            End { value, .. } => Bound::Included(value),
        };
        (bound(self.low), bound(self.high))
    }

    fn point(value: f64) -> Self {
        Self {
            low: End::reached(value),
            high: End::reached(value),
        }
    }

    fn between(low: f64, high: f64) -> Self {
        Self {
            low: End::reached(low),
            high: End::reached(high),
        }
    }

    /// A value inside, at a fraction of a bounded interval or near the end of an unbounded one.
    pub fn inside(self, fraction: f64) -> f64 {
        match (self.low.value.is_finite(), self.high.value.is_finite()) {
            (true, true) => self.low.value + fraction * (self.high.value - self.low.value),
            (true, false) => self.low.value + 0.5 + fraction,
            (false, true) => self.high.value - 0.5 - fraction,
            (false, false) => 0.5 + fraction,
        }
    }

    /// The smallest interval around two.
    pub fn hull(self, other: Self) -> Self {
        Self {
            low: lower(self.low, other.low),
            high: upper(self.high, other.high),
        }
    }

    /// Never below zero.
    pub fn is_not_negative(self) -> bool {
        self.low.value >= 0.0
    }

    /// Never above zero.
    pub fn is_not_positive(self) -> bool {
        self.high.value <= 0.0
    }

    /// Always above zero.
    pub fn is_positive(self) -> bool {
        self.low.value > 0.0 || self.low == End::approached(0.0)
    }

    /// Always below zero.
    pub fn is_negative(self) -> bool {
        self.high.value < 0.0 || self.high == End::approached(0.0)
    }

    /// Zero is not among the values.
    pub fn excludes_zero(self) -> bool {
        self.is_positive() || self.is_negative()
    }

    fn add(self, other: Self) -> Self {
        let end = |a: End, b: End| End {
            value: a.value + b.value,
            is_open: a.is_open || b.is_open,
        };
        Self {
            low: end(self.low, other.low),
            high: end(self.high, other.high),
        }
    }

    fn multiply(self, other: Self) -> Self {
        let mut result: Option<Self> = None;
        for a in [self.low, self.high] {
            for b in [other.low, other.high] {
                let corner = product(a, b);
                let corner = Self {
                    low: corner,
                    high: corner,
                };
                result = Some(result.map_or(corner, |hull| hull.hull(corner)));
            }
        }
        result.unwrap_or(Self::ALL)
    }

    fn negate(self) -> Self {
        Self {
            low: self.high.negated(),
            high: self.low.negated(),
        }
    }

    fn absolute(self) -> Self {
        if self.is_not_negative() {
            self
        } else if self.is_not_positive() {
            self.negate()
        } else {
            let high = upper(self.low.negated(), self.high);
            Self {
                low: End::ZERO,
                high,
            }
        }
    }

    /// The values on one side of zero; zero for the others.
    fn on_side(self, positive: bool) -> Self {
        let zero = End::ZERO;
        if positive {
            Self {
                low: zero,
                high: upper(self.high, zero),
            }
        } else {
            Self {
                low: lower(self.low, zero),
                high: zero,
            }
        }
    }

    /// An increasing function of every value.
    fn map(self, function: impl Fn(f64) -> f64) -> Self {
        let end = |end: End| End {
            value: function(end.value),
            ..end
        };
        Self {
            low: end(self.low),
            high: end(self.high),
        }
    }
}

/// The lower of two lower ends; of equal ones the one that is reached.
fn lower(a: End, b: End) -> End {
    if a.value < b.value || (a.value == b.value && !a.is_open) {
        a
    } else {
        b
    }
}

fn upper(a: End, b: End) -> End {
    if a.value > b.value || (a.value == b.value && !a.is_open) {
        a
    } else {
        b
    }
}

/// Product of two ends. A zero that is reached makes a zero that is reached, whatever the other end.
fn product(a: End, b: End) -> End {
    if [a, b].contains(&End::ZERO) {
        End::ZERO
    } else if a.value == 0.0 || b.value == 0.0 {
        End::approached(0.0)
    } else {
        End {
            value: a.value * b.value,
            is_open: a.is_open || b.is_open,
        }
    }
}

/// A stretch of the gap, with ends that are functions of parameters.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Stretch {
    /// Lower end; `None` where unbounded.
    pub low: Option<Id>,
    /// Upper end; `None` where unbounded.
    pub high: Option<Id>,
}

impl Stretch {
    /// Every gap.
    pub const ALL: Self = Self {
        low: None,
        high: None,
    };
}

/// What is known of variables.
#[derive(Debug, Clone, Default)]
pub struct Ranges {
    /// Of the parameters.
    pub parameters: Vec<Interval>,
    /// Of the arguments of the law at hand.
    pub arguments: Vec<Interval>,
}

impl Ranges {
    /// What is known of one variable.
    pub fn of(&self, variable: Variable) -> Interval {
        match variable {
            Variable::Parameter(index) => {
                self.parameters.get(index).copied().unwrap_or(Interval::ALL)
            }
            Variable::Argument(index) => {
                self.arguments.get(index).copied().unwrap_or(Interval::ALL)
            }
            Variable::Omega => Interval {
                low: End::approached(0.0),
                high: End::approached(f64::INFINITY),
            },
            _ => Interval::ALL,
        }
    }

    /// The values of an expression while the gap is in a stretch, its ends included.
    ///
    /// Sums that are affine in the gap are bounded by their values at the two ends, where parameters cancel exactly: on
    /// `gap >= play` the base `gap - play` is not negative, whatever the play.
    pub fn bounds(&self, dag: &mut Dag, id: Id, stretch: Stretch) -> Interval {
        let mut known: HashMap<Id, Interval> = HashMap::new();
        for current in dag.reachable(&[id]) {
            let value = match dag.node(current).clone() {
                Node::Number(number) => Interval::point(number.to_f64()),
                Node::Pi => Interval::point(std::f64::consts::PI),
                Node::Variable(variable) => self
                    .affine_bounds(dag, current, stretch)
                    .unwrap_or_else(|| self.of(variable)),
                Node::Sum(terms) => {
                    self.affine_bounds(dag, current, stretch)
                        .unwrap_or_else(|| {
                            terms
                                .iter()
                                .fold(Interval::point(0.0), |sum, term| sum.add(known[term]))
                        })
                }
                Node::Product(factors) => product_of(dag, &factors, &known),
                Node::Power(base, exponent) => {
                    let whole = dag.as_number(exponent).and_then(Rational::to_integer);
                    power(known[&base], known[&exponent], whole)
                }
                Node::PowerLog(..) => Interval::ALL,
                Node::Call(function, operand) => call(function, known[&operand]),
            };
            known.insert(current, value);
        }
        known[&id]
    }

    fn affine_bounds(&self, dag: &mut Dag, id: Id, stretch: Stretch) -> Option<Interval> {
        if stretch == Stretch::ALL || !dag.depends_on(id, Variable::Gap) {
            return None;
        }
        let (slope, _) = super::algebra::affine(dag, id, Variable::Gap)?;
        let slope = self.bounds(dag, slope, Stretch::ALL);
        let mut end = |gap: Option<Id>, outward: f64| match gap {
            Some(gap) => {
                let value = super::algebra::put(dag, id, Variable::Gap, gap);
                Some(self.bounds(dag, value, Stretch::ALL))
            }
            None if slope.is_positive() => Some(Interval {
                low: End::approached(outward),
                high: End::approached(outward),
            }),
            None if slope.is_negative() => Some(Interval {
                low: End::approached(-outward),
                high: End::approached(-outward),
            }),
            None => None,
        };
        Some(end(stretch.low, f64::NEG_INFINITY)?.hull(end(stretch.high, f64::INFINITY)?))
    }
}

/// A product. With the step of one of its factors, as in `u H(u)`, which is how `max(0, u)` is written, that factor
/// counts on one side of zero only.
fn product_of(dag: &mut Dag, factors: &[Id], known: &HashMap<Id, Interval>) -> Interval {
    let all = |factors: &[Id]| {
        factors
            .iter()
            .fold(Interval::point(1.0), |product, factor| {
                product.multiply(known[factor])
            })
    };
    for (position, &step) in factors.iter().enumerate() {
        let mut others = factors.to_vec();
        others.remove(position);
        for (position, &part) in others.iter().enumerate() {
            if let Some(positive) = is_step_of(dag, step, part) {
                let mut rest = others.clone();
                rest[position] = step;
                return known[&part].on_side(positive).multiply(all(&rest));
            }
        }
        let together = dag.product(&others);
        if let Some(positive) = is_step_of(dag, step, together) {
            return all(&others).on_side(positive).multiply(known[&step]);
        }
    }
    all(factors)
}

/// Whether a factor is positive where a part is and zero where it is negative (`true`), or the other way round: a
/// step, or a multiple of `1 + sgn`.
fn is_step_of(dag: &mut Dag, step: Id, part: Id) -> Option<bool> {
    let opposite = dag.negate(part);
    let [of_part, of_opposite] = match dag.node(step).clone() {
        Node::Call(Function::Step, _) => {
            [part, opposite].map(|operand| dag.call(Function::Step, operand))
        }
        Node::Sum(terms) if terms.len() == 2 => {
            let mut numbers = terms.iter().filter_map(|&term| dag.as_number(term));
            let number = numbers.next().filter(|number| number.is_positive())?;
            let number = dag.number(number);
            [part, opposite].map(|operand| {
                let sign = dag.call(Function::Sign, operand);
                let term = dag.product(&[number, sign]);
                dag.sum(&[number, term])
            })
        }
        _ => return None,
    };
    if step == of_part {
        Some(true)
    } else {
        (step == of_opposite).then_some(false)
    }
}

fn power(base: Interval, exponent: Interval, whole: Option<i32>) -> Interval {
    let positive = Interval {
        low: End::approached(0.0),
        high: End::approached(f64::INFINITY),
    };
    match whole {
        Some(exponent) if exponent > 0 && exponent % 2 == 1 => {
            base.map(|value| value.powi(exponent))
        }
        Some(exponent) if exponent > 0 => base.absolute().map(|value| value.powi(exponent)),
        Some(_) if base.is_positive() => positive,
        Some(exponent) if base.is_negative() && exponent % 2 != 0 => positive.negate(),
        Some(exponent) if exponent % 2 != 0 => Interval::ALL,
        _ if base.is_positive() => positive,
        _ if exponent.is_positive() && exponent == Interval::point(exponent.low.value) => {
            base.absolute().map(|value| value.powf(exponent.low.value))
        }
        _ => Interval {
            low: End::ZERO,
            high: End::approached(f64::INFINITY),
        },
    }
}

fn call(function: Function, operand: Interval) -> Interval {
    match function {
        Function::Absolute => operand.absolute(),
        Function::Sign => operand.map(|value| if value == 0.0 { 0.0 } else { value.signum() }),
        Function::Step => operand.map(|value| f64::from(value > 0.0)),
        Function::Sine | Function::Cosine => Interval::between(-1.0, 1.0),
        Function::Exponential if operand.low.value == f64::NEG_INFINITY => Interval {
            low: End::approached(0.0),
            high: End {
                value: operand.high.value.exp(),
                ..operand.high
            },
        },
        Function::Exponential => operand.map(f64::exp),
        Function::Tanh => operand.map(f64::tanh),
    }
}
