//! How far two correct evaluations of a node may differ.
//!
//! Each node carries its value, the sum of the absolute terms that make it up, and a bound of the difference of two
//! evaluations. A sum adds a rounding of that sum of absolute terms, a power adds `4 ulp (1 + |b ln a|)` (the logarithm
//! is rounded before it is multiplied); everything passes on the bounds of its operands.

use hertzian::emitted::{power, power_log, sign};
use hertzian::generic::LawData;

use crate::agreement::tree::{Numbers, evaluate};

#[derive(Debug, Clone, Copy)]
pub struct Bound {
    pub value: f64,
    /// Sum of absolute terms.
    pub terms: f64,
    pub error: f64,
}

/// Results below this are subnormal, where a rounding is not relative.
const SUBNORMAL: f64 = f64::MIN_POSITIVE;

pub fn nodes(data: &LawData, gap: f64, rate: f64, arguments: &[f64]) -> Vec<Bound> {
    let arguments: Vec<Bound> = arguments.iter().map(|&a| Bound::number(a)).collect();
    evaluate(data, Bound::number(gap), Bound::number(rate), &arguments)
}

impl Bound {
    /// A value with the bound inherited from its operands, to which its own rounding is added.
    fn rounded(value: f64, terms: f64, inherited: f64, ulps: f64) -> Self {
        let error = inherited + ulps * f64::EPSILON * terms + SUBNORMAL;
        Self {
            value,
            terms,
            error,
        }
    }

    /// A function whose slope is at most `slope` in absolute value.
    fn function(self, value: f64, slope: f64) -> Self {
        Self::rounded(value, value.abs(), slope * self.error, 4.0)
    }
}

impl Numbers for Bound {
    fn number(value: f64) -> Self {
        Self {
            value,
            terms: value.abs(),
            error: 0.0,
        }
    }

    fn add(self, other: Self) -> Self {
        let terms = self.terms + other.terms;
        Self::rounded(
            self.value + other.value,
            terms,
            self.error + other.error,
            2.0,
        )
    }

    fn negate(self) -> Self {
        Self {
            value: -self.value,
            ..self
        }
    }

    fn multiply(self, other: Self) -> Self {
        let inherited = self.error * other.terms + other.error * self.terms;
        let terms = self.terms * other.terms;
        Self::rounded(self.value * other.value, terms, inherited, 2.0)
    }

    fn divide(self, other: Self) -> Self {
        let terms = self.terms / other.value.abs();
        let inherited = (self.error + terms * other.error) / other.value.abs();
        Self::rounded(self.value / other.value, terms, inherited, 2.0)
    }

    fn absolute(self) -> Self {
        Self {
            value: self.value.abs(),
            ..self
        }
    }

    fn sign(self) -> Self {
        Self::number(sign(self.value))
    }

    fn integer(self, exponent: i32) -> Self {
        if exponent < 0 && self.value == 0.0 {
            return Self::number(0.0);
        }
        let n = f64::from(exponent.abs());
        let terms = self.terms.powi(exponent);
        let inherited = n * self.terms.powi(exponent - 1) * self.error;
        Self::rounded(self.value.powi(exponent), terms, inherited, 2.0 * n)
    }

    fn power(self, exponent: Self) -> Self {
        let value = power(self.value, exponent.value);
        if self.value <= 0.0 {
            return Self::number(value);
        }
        let logarithm = self.value.ln().abs();
        let relative = exponent.value.abs() * self.error / self.value + exponent.error * logarithm;
        let ulps = 4.0 * (1.0 + exponent.value.abs() * logarithm);
        Self::rounded(value, value, value * relative, ulps)
    }

    fn power_log(self, exponent: Self) -> Self {
        let value = power_log(self.value, exponent.value);
        if self.value <= 0.0 {
            return Self::number(value);
        }
        let power = self.power(exponent);
        let inherited = power.error * self.value.ln().abs() + power.value * self.error / self.value;
        Self::rounded(value, value.abs(), inherited, 2.0)
    }

    fn sine(self) -> Self {
        self.function(self.value.sin(), 1.0)
    }

    fn cosine(self) -> Self {
        self.function(self.value.cos(), 1.0)
    }

    fn exponential(self) -> Self {
        let value = self.value.exp();
        self.function(value, value)
    }

    fn tanh(self) -> Self {
        self.function(self.value.tanh(), 1.0)
    }
}
