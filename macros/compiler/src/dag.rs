//! Hash-consed expressions.

use std::collections::HashMap;

/// Position of an expression in its [`Dag`]. Equal expressions have equal positions.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct Id(pub(crate) u32);

/// An exact rational number, in lowest terms, with a positive denominator.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub struct Rational {
    numerator: i128,
    denominator: i128,
}

/// What an expression may depend on.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Variable {
    /// Gap of a law.
    Gap,
    /// Rate of the gap.
    Rate,
    /// Argument of a law.
    Argument(usize),
    /// Parameter of the model.
    Parameter(usize),
    /// Excitation frequency.
    Omega,
    /// Time.
    Time,
    /// Coordinate `q_i`.
    Coordinate(usize),
    /// Its first derivative by time.
    Velocity(usize),
    /// Its second derivative by time.
    Acceleration(usize),
}

/// Functions of one operand.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
#[allow(missing_docs)]
pub enum Function {
    Absolute,
    Sign,
    /// Heaviside step: one for a positive operand, zero otherwise.
    Step,
    Sine,
    Cosine,
    Exponential,
    Tanh,
}

/// One expression; operands are positions. Sums and products are flattened, sorted and have at least two operands.
#[derive(Debug, Clone, PartialEq, Eq, Hash)]
#[allow(missing_docs)]
pub enum Node {
    Number(Rational),
    /// The number pi.
    Pi,
    Variable(Variable),
    Sum(Vec<Id>),
    Product(Vec<Id>),
    /// Guarded power; quotients are powers of exponent -1.
    Power(Id, Id),
    /// `base^exponent * ln(base)`, guarded: what the derivative of a power by its exponent is.
    PowerLog(Id, Id),
    Call(Function, Id),
}

/// The graph: every expression once.
#[derive(Debug, Default)]
pub struct Dag {
    nodes: Vec<Node>,
    positions: HashMap<Node, Id>,
}
