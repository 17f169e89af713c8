//! The same laws, interpreted: the oracle of the generated code, and what it is benchmarked against.
//!
//! A law is a list of nodes in which every operand comes before its use, and, for each piece, the nodes that are its
//! force and its derivatives. The data come from the same front end as the generated code, so the two cannot drift.

mod law;
mod program;
pub(crate) mod scales;
#[cfg(test)]
mod tests;
#[cfg(feature = "text")]
mod text;

use std::borrow::Cow;

use crate::law::Law;
use crate::system::{System, SystemFacts, Variable};

pub use law::InterpretedLaw;
#[cfg(feature = "text")]
pub use text::{Declaration, DeclarationError, Fault};

/// A system whose laws are interpreted; everything else is the system's own, and so is a law that has no
/// [data](Law::data).
///
/// It computes what the system computes, from the same declaration, without the generated kernels.
pub struct Interpreted<'a> {
    system: &'a dyn System,
    /// In the order of the system's; `None` where it has no data.
    laws: Vec<Option<InterpretedLaw>>,
}

impl std::fmt::Debug for Interpreted<'_> {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Interpreted")
            .field("system", &self.system.facts().name)
            .finish_non_exhaustive()
    }
}

impl<'a> Interpreted<'a> {
    /// The same system, its laws interpreted.
    ///
    /// # Panics
    /// If the data of a law are not what [`InterpretedLaw::new`] asks for; those of generated laws are.
    pub fn of(system: &'a dyn System) -> Self {
        let laws = (0..system.facts().laws)
            .map(|index| InterpretedLaw::of(system.law(index)))
            .collect();
        Self { system, laws }
    }
}

impl System for Interpreted<'_> {
    fn facts(&self) -> &SystemFacts {
        self.system.facts()
    }

    fn values(&self, values: &mut [f64]) {
        self.system.values(values);
    }

    fn coefficients(&self, parameters: &[f64], omega: f64, coefficients: &mut [f64]) {
        self.system.coefficients(parameters, omega, coefficients);
    }

    fn coefficients_by(
        &self,
        variable: Variable,
        parameters: &[f64],
        omega: f64,
        derivatives: &mut [f64],
    ) {
        self.system
            .coefficients_by(variable, parameters, omega, derivatives);
    }

    fn law(&self, index: usize) -> &dyn Law {
        match &self.laws[index] {
            Some(law) => law,
            None => self.system.law(index),
        }
    }
}

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
