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
    /// Integer power. One of zero to a negative exponent is zero.
    Integer(usize, i32),
    /// Guarded power `base^exponent` of a base that is not negative where it is used.
    Power(usize, usize),
    /// Guarded `base^exponent * ln base`.
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

impl Node {
    /// The positions of its operands.
    #[inline]
    pub fn operands(self) -> [Option<usize>; 2] {
        match self {
            Self::Number(_) | Self::Gap | Self::Rate | Self::Argument(_) => [None, None],
            Self::Add(a, b)
            | Self::Subtract(a, b)
            | Self::Multiply(a, b)
            | Self::Divide(a, b)
            | Self::Power(a, b)
            | Self::PowerLog(a, b) => [Some(a), Some(b)],
            Self::Negate(a)
            | Self::Absolute(a)
            | Self::Sign(a)
            | Self::Integer(a, _)
            | Self::Sine(a)
            | Self::Cosine(a)
            | Self::Exponential(a)
            | Self::Tanh(a) => [Some(a), None],
        }
    }
}
