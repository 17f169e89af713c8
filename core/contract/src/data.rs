//! A law as data, for the interpreter.

use std::borrow::Cow;

/// A law as data.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct LawData {
    /// The nodes; operands of node `i` have positions below `i`.
    pub nodes: Cow<'static, [Node]>,
    /// The levels, in increasing order; they depend on arguments alone.
    pub levels: Cow<'static, [LevelData]>,
    /// One entry per piece.
    pub pieces: Cow<'static, [PieceData]>,
}

impl LawData {
    /// A law of these nodes, with its levels and pieces among them.
    pub fn new(
        nodes: impl Into<Cow<'static, [Node]>>,
        levels: impl IntoIterator<Item = LevelData>,
        pieces: impl IntoIterator<Item = PieceData>,
    ) -> Self {
        Self {
            nodes: nodes.into(),
            levels: levels.into_iter().collect(),
            pieces: pieces.into_iter().collect(),
        }
    }
}

/// A level as data.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct LevelData {
    /// The node of its value.
    pub value: usize,
    /// The nodes of its derivatives, one per argument.
    pub by_argument: Cow<'static, [usize]>,
}

impl LevelData {
    /// The nodes of its value and of its derivatives by each argument.
    pub fn new(value: usize, by_argument: impl Into<Cow<'static, [usize]>>) -> Self {
        Self {
            value,
            by_argument: by_argument.into(),
        }
    }
}

/// A piece as data: positions of nodes.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
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

impl PieceData {
    /// The nodes of force, derivatives by gap and by rate, and of those by each argument.
    pub fn new(
        [force, by_gap, by_rate]: [usize; 3],
        by_argument: impl Into<Cow<'static, [usize]>>,
    ) -> Self {
        Self {
            force,
            by_gap,
            by_rate,
            by_argument: by_argument.into(),
        }
    }
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
