//! A law as data, for the interpreter.

use std::borrow::Cow;

/// A law as data.
#[derive(Debug, Clone, PartialEq)]
pub struct LawData {
    /// The nodes; operands of node `i` have positions below `i`.
    pub nodes: Cow<'static, [Node]>,
    /// The levels, in increasing order; they depend on arguments alone.
    pub levels: Cow<'static, [LevelData]>,
    /// One entry per piece.
    pub pieces: Cow<'static, [PieceData]>,
}

/// A level as data.
#[derive(Debug, Clone, PartialEq)]
pub struct LevelData {
    /// The node of its value.
    pub value: usize,
    /// The nodes of its derivatives, one per argument.
    pub by_argument: Cow<'static, [usize]>,
}

/// A piece as data: positions of nodes.
#[derive(Debug, Clone, PartialEq)]
pub struct PieceData {
    /// `phi`
    pub force: usize,
    /// `d phi / d gap`
    pub by_gap: usize,
    /// `d phi / d rate`
    pub by_rate: usize,
    /// `d phi / d argument`, one per argument.
    pub by_argument: Cow<'static, [usize]>,
}

/// One operation. A `usize` is the position of an operand.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub enum Node {
    /// A number.
    Number(f64),
    /// The gap.
    Gap,
    /// Its rate.
    Rate,
    /// An argument of the law.
    Argument(usize),
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
    /// Absolute value.
    Absolute(usize),
    /// `-1`, `0` or `1`.
    Sign(usize),
    /// Integer power. One of zero to a negative exponent is zero, see [`crate::laws::emitted`].
    Integer(usize, i32),
    /// Guarded power `base^exponent` of a base that is not negative where it is used, see [`crate::laws::emitted::power`].
    Power(usize, usize),
    /// Guarded `base^exponent * ln base`, see [`crate::laws::emitted::power_log`].
    PowerLog(usize, usize),
    /// Sine.
    Sine(usize),
    /// Cosine.
    Cosine(usize),
    /// Exponential.
    Exponential(usize),
    /// Hyperbolic tangent.
    Tanh(usize),
}
