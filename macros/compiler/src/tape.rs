//! Expressions as straight-line code: a list of operations in which every operand comes before its use, each computed
//! once.

pub mod powers;
#[cfg(test)]
mod tests;

use std::collections::HashMap;
use std::mem::Discriminant;

use self::powers::Plan;
use crate::dag::{Dag, Function, Id, Node, Rational, Variable};

/// One operation; a `usize` is the position of an operand.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Operation {
    /// A constant.
    Number(f64),
    /// A variable.
    Input(Variable),
    /// Sum.
    Add(usize, usize),
    /// Difference.
    Subtract(usize, usize),
    /// Product.
    Multiply(usize, usize),
    /// Quotient.
    Divide(usize, usize),
    /// Change of sign.
    Negate(usize),
    /// A function.
    Call(Function, usize),
    /// Integer power (data only).
    Integer(usize, i32),
    /// Guarded power.
    Power(usize, usize),
    /// Guarded power times logarithm.
    PowerLog(usize, usize),
    /// Guarded square root (code only, as all that follow).
    Root(usize),
    /// Guarded cube root.
    CubeRoot(usize),
    /// Guarded reciprocal: zero for zero.
    Reciprocal(usize),
    /// Logarithm of the planned base at a position, see [`Plan`].
    Logarithm(usize),
    /// Planned power at a position.
    Planned(usize),
}

/// What the operations are for.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Style {
    /// Data for the interpreter: the operations of `hertzian::generic::Node`.
    Data,
    /// Code: powers are resolved into roots, products, and what is planned.
    Code,
}

/// The operations, and the positions of the roots among them.
#[derive(Debug)]
pub struct Tape {
    /// The operations.
    pub operations: Vec<Operation>,
    /// Where each root is.
    pub roots: Vec<usize>,
}

impl Tape {
    /// Lowers expressions, without a plan.
    pub fn of(dag: &mut Dag, roots: &[Id], style: Style) -> Self {
        Self::with(dag, roots, style, &Plan::default())
    }

    /// Lowers expressions to what is to be done after a plan.
    pub fn with(dag: &mut Dag, roots: &[Id], style: Style, plan: &Plan) -> Self {
        let mut builder = Builder {
            dag,
            style,
            plan,
            operations: Vec::new(),
            known: HashMap::new(),
            dependence: HashMap::new(),
            at: HashMap::new(),
        };
        for id in builder.dag.reachable(roots) {
            let dependence = builder.dependence_of(id);
            builder.dependence.insert(id, dependence);
            let position = builder.lower(id);
            builder.at.insert(id, position);
        }
        let roots = roots.iter().map(|root| builder.at[root]).collect();
        Self {
            operations: builder.operations,
            roots,
        }
        .without_unused()
    }

    /// How often each operation is used, as an operand or as a root.
    pub fn uses(&self) -> Vec<usize> {
        let mut uses = vec![0; self.operations.len()];
        for &root in &self.roots {
            uses[root] += 1;
        }
        for operation in &self.operations {
            for operand in operation.operands() {
                uses[operand] += 1;
            }
        }
        uses
    }

    fn without_unused(self) -> Self {
        let mut used = vec![false; self.operations.len()];
        for &root in &self.roots {
            used[root] = true;
        }
        for position in (0..self.operations.len()).rev() {
            if used[position] {
                for operand in self.operations[position].operands() {
                    used[operand] = true;
                }
            }
        }
        let mut moved = vec![0; self.operations.len()];
        let mut operations = Vec::new();
        for (position, operation) in self.operations.into_iter().enumerate() {
            if used[position] {
                moved[position] = operations.len();
                operations.push(operation.with_operands(|operand| moved[operand]));
            }
        }
        Self {
            operations,
            roots: self.roots.iter().map(|&root| moved[root]).collect(),
        }
    }
}

impl Operation {
    /// Positions of the operands.
    pub fn operands(self) -> Vec<usize> {
        match self {
            Self::Number(_) | Self::Input(_) | Self::Logarithm(_) | Self::Planned(_) => vec![],
            Self::Add(a, b)
            | Self::Subtract(a, b)
            | Self::Multiply(a, b)
            | Self::Divide(a, b)
            | Self::Power(a, b)
            | Self::PowerLog(a, b) => vec![a, b],
            Self::Negate(a)
            | Self::Call(_, a)
            | Self::Integer(a, _)
            | Self::Root(a)
            | Self::CubeRoot(a)
            | Self::Reciprocal(a) => vec![a],
        }
    }

    fn with_operands(self, to: impl Fn(usize) -> usize) -> Self {
        match self {
            Self::Number(_) | Self::Input(_) | Self::Logarithm(_) | Self::Planned(_) => self,
            Self::Add(a, b) => Self::Add(to(a), to(b)),
            Self::Subtract(a, b) => Self::Subtract(to(a), to(b)),
            Self::Multiply(a, b) => Self::Multiply(to(a), to(b)),
            Self::Divide(a, b) => Self::Divide(to(a), to(b)),
            Self::Power(a, b) => Self::Power(to(a), to(b)),
            Self::PowerLog(a, b) => Self::PowerLog(to(a), to(b)),
            Self::Negate(a) => Self::Negate(to(a)),
            Self::Call(function, a) => Self::Call(function, to(a)),
            Self::Integer(a, exponent) => Self::Integer(to(a), exponent),
            Self::Root(a) => Self::Root(to(a)),
            Self::CubeRoot(a) => Self::CubeRoot(to(a)),
            Self::Reciprocal(a) => Self::Reciprocal(to(a)),
        }
    }

    /// Equal operations have equal keys: the kind, what distinguishes it, and the operands.
    fn key(self) -> Key {
        let distinction = match self {
            Self::Number(value) => Distinction::Bits(value.to_bits()),
            Self::Input(variable) => Distinction::Variable(variable),
            Self::Call(function, _) => Distinction::Function(function),
            Self::Integer(_, exponent) => Distinction::Exponent(exponent),
            Self::Logarithm(position) | Self::Planned(position) => Distinction::Position(position),
            _ => Distinction::None,
        };
        (std::mem::discriminant(&self), distinction, self.operands())
    }
}

type Key = (Discriminant<Operation>, Distinction, Vec<usize>);

/// What distinguishes operations of one kind, besides their operands.
#[derive(PartialEq, Eq, Hash)]
enum Distinction {
    None,
    Bits(u64),
    Variable(Variable),
    Function(Function),
    Exponent(i32),
    Position(usize),
}

/// How an expression depends on its surroundings.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
enum Dependence {
    /// A number.
    None,
    /// Something that is the same for all samples of a batch.
    Batch,
    /// Gap or rate.
    Sample,
}

pub(super) struct Builder<'a> {
    pub(super) dag: &'a mut Dag,
    style: Style,
    pub(super) plan: &'a Plan,
    operations: Vec<Operation>,
    known: HashMap<Key, usize>,
    dependence: HashMap<Id, Dependence>,
    pub(super) at: HashMap<Id, usize>,
}

impl Builder<'_> {
    pub(super) fn push(&mut self, operation: Operation) -> usize {
        let key = operation.key();
        if let Some(&position) = self.known.get(&key) {
            return position;
        }
        self.operations.push(operation);
        self.known.insert(key, self.operations.len() - 1);
        self.operations.len() - 1
    }

    pub(super) fn number(&mut self, value: f64) -> usize {
        self.push(Operation::Number(value))
    }

    /// Whether an expression changes from sample to sample.
    pub(super) fn varies(&self, id: Id) -> bool {
        self.dependence_of(id) == Dependence::Sample
    }

    /// Of operands it is known already.
    fn dependence_of(&self, id: Id) -> Dependence {
        if let Some(&known) = self.dependence.get(&id) {
            return known;
        }
        match self.dag.node(id) {
            Node::Variable(variable) if variable.varies() => Dependence::Sample,
            Node::Variable(_) => Dependence::Batch,
            _ => {
                let operands = self.dag.operands(id).into_iter();
                operands
                    .map(|operand| self.dependence_of(operand))
                    .max()
                    .unwrap_or(Dependence::None)
            }
        }
    }

    pub(super) fn lower(&mut self, id: Id) -> usize {
        if self.dependence_of(id) == Dependence::None {
            let value = self.dag.evaluate(id, &|_| 0.0);
            return self.number(value);
        }
        match self.dag.node(id).clone() {
            Node::Number(_) | Node::Pi => unreachable!("a constant has no variables"),
            Node::Variable(variable) => self.push(Operation::Input(variable)),
            Node::Sum(terms) => self.sum(&terms),
            Node::Product(factors) => {
                let (negative, magnitude) = self.product(&factors);
                if negative {
                    self.push(Operation::Negate(magnitude))
                } else {
                    magnitude
                }
            }
            Node::Power(base, exponent) => match self.style {
                Style::Code => self.code_power(base, exponent),
                Style::Data => self.data_power(base, exponent),
            },
            Node::PowerLog(base, exponent) => match self.style {
                Style::Code => self.code_power_log(base, exponent),
                Style::Data => self.push(Operation::PowerLog(self.at[&base], self.at[&exponent])),
            },
            Node::Call(function, operand) => {
                let operand = self.at[&operand];
                match (function, self.style) {
                    (Function::Step, Style::Data) => self.data_step(operand),
                    _ => self.push(Operation::Call(function, operand)),
                }
            }
        }
    }

    /// Terms with a negative coefficient are subtracted, after the others.
    fn sum(&mut self, terms: &[Id]) -> usize {
        let mut added = None;
        let mut subtracted = Vec::new();
        for &term in terms {
            let (negative, magnitude) = self.signed(term);
            if negative {
                subtracted.push(magnitude);
            } else {
                added = Some(match added {
                    None => magnitude,
                    Some(total) => self.push(Operation::Add(total, magnitude)),
                });
            }
        }
        let mut subtracted = subtracted.into_iter();
        let mut total = match (added, subtracted.next()) {
            (Some(added), Some(first)) => self.push(Operation::Subtract(added, first)),
            (Some(added), None) => added,
            (None, Some(first)) => self.push(Operation::Negate(first)),
            (None, None) => self.number(0.0),
        };
        for magnitude in subtracted {
            total = self.push(Operation::Subtract(total, magnitude));
        }
        total
    }

    fn signed(&mut self, term: Id) -> (bool, usize) {
        match self.dag.node(term).clone() {
            Node::Number(number) => {
                let magnitude = self.number(number.to_f64().abs());
                (number.is_negative(), magnitude)
            }
            Node::Product(factors) if self.dependence_of(term) != Dependence::None => {
                self.product(&factors)
            }
            _ => (false, self.at[&term]),
        }
    }

    /// Sign and magnitude of a product. Factors that do not change from sample to sample come first, so that a loop
    /// computes them once.
    fn product(&mut self, factors: &[Id]) -> (bool, usize) {
        let mut negative = false;
        let mut above = Vec::new();
        let mut below = Vec::new();
        for vary in [false, true] {
            for &factor in factors {
                if self.varies(factor) != vary {
                    continue;
                }
                if let Some(number) = self.dag.as_number(factor) {
                    negative ^= number.is_negative();
                    if number.absolute() != Some(Rational::ONE) {
                        above.push(self.number(number.to_f64().abs()));
                    }
                } else if let Some(divisor) = self.divisor(factor) {
                    below.push(divisor);
                } else {
                    above.push(self.at[&factor]);
                }
            }
        }
        let mut factors = above.into_iter();
        let first = factors.next();
        let mut total = match first {
            Some(first) => first,
            None => self.number(1.0),
        };
        for factor in factors {
            total = self.push(Operation::Multiply(total, factor));
        }
        for divisor in below {
            total = self.push(Operation::Divide(total, divisor));
        }
        (negative, total)
    }

    /// The position of `x` for a factor `1/x` that does not change from sample to sample: it needs no guard.
    fn divisor(&mut self, factor: Id) -> Option<usize> {
        match *self.dag.node(factor) {
            Node::Power(base, exponent)
                if self.dag.as_number(exponent) == Some(Rational::integer(-1))
                    && !self.varies(base) =>
            {
                Some(self.at[&base])
            }
            _ => None,
        }
    }

    /// `H(x) = (sgn x + |sgn x|) / 2`: the interpreter knows no step.
    fn data_step(&mut self, operand: usize) -> usize {
        let sign = self.push(Operation::Call(Function::Sign, operand));
        let magnitude = self.push(Operation::Call(Function::Absolute, sign));
        let sum = self.push(Operation::Add(sign, magnitude));
        let half = self.number(0.5);
        self.push(Operation::Multiply(half, sum))
    }

    fn data_power(&mut self, base: Id, exponent: Id) -> usize {
        let whole = self.dag.as_number(exponent).and_then(Rational::to_integer);
        let (base, exponent) = (self.at[&base], self.at[&exponent]);
        match whole {
            Some(whole) => self.push(Operation::Integer(base, whole)),
            None => self.push(Operation::Power(base, exponent)),
        }
    }
}
