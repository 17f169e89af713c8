//! The nodes of a law in dual numbers: a value and its derivative by one variable.

use hertzian::emitted::{power, power_log, sign};
use hertzian::generic::LawData;
use num_dual::{Dual64, DualNum};

use crate::agreement::tree::{Numbers, evaluate};

/// What is differentiated by.
#[derive(Clone, Copy, PartialEq)]
pub enum By {
    Gap,
    Rate,
    Argument(usize),
}

pub fn nodes(data: &LawData, gap: f64, rate: f64, arguments: &[f64], by: By) -> Vec<Dual64> {
    let dual = |value, of| Dual64::new(value, if of == by { 1.0 } else { 0.0 });
    let arguments = arguments.iter().enumerate();
    let arguments: Vec<Dual64> = arguments.map(|(i, &a)| dual(a, By::Argument(i))).collect();
    evaluate(data, dual(gap, By::Gap), dual(rate, By::Rate), &arguments)
}

impl Numbers for Dual64 {
    fn number(value: f64) -> Self {
        Self::new(value, 0.0)
    }

    fn add(self, other: Self) -> Self {
        self + other
    }

    fn negate(self) -> Self {
        -self
    }

    fn multiply(self, other: Self) -> Self {
        self * other
    }

    fn divide(self, other: Self) -> Self {
        self / other
    }

    fn absolute(self) -> Self {
        Self::new(self.re.abs(), self.eps * sign(self.re))
    }

    fn sign(self) -> Self {
        Self::number(sign(self.re))
    }

    fn integer(self, exponent: i32) -> Self {
        let positive = DualNum::powi(&self, exponent.abs());
        match exponent {
            0.. => positive,
            _ if positive.re == 0.0 => Self::number(0.0),
            _ => positive.recip(),
        }
    }

    /// Dual numbers know no guarded power: away from zero it is `exp(b ln a)`, of a quarter of the exponent and then
    /// squared twice, because `a^b` may underflow where its derivative does not. Near zero `1/a` overflows, and at
    /// zero there is no derivative at all; there the rule is written out.
    fn power(self, exponent: Self) -> Self {
        if self.re > 1e-305 {
            let quarter = DualNum::powd(&self, exponent * 0.25);
            let half = quarter * quarter;
            return half * half;
        }
        let by_base = exponent.re * power(self.re, exponent.re - 1.0);
        let by_exponent = power_log(self.re, exponent.re);
        let eps = self.eps * by_base + exponent.eps * by_exponent;
        Self::new(power(self.re, exponent.re), eps)
    }

    fn power_log(self, exponent: Self) -> Self {
        if self.re > 0.0 {
            self.power(exponent) * DualNum::ln(&self)
        } else {
            Self::number(0.0)
        }
    }

    fn sine(self) -> Self {
        DualNum::sin(&self)
    }

    fn cosine(self) -> Self {
        DualNum::cos(&self)
    }

    fn exponential(self) -> Self {
        DualNum::exp(&self)
    }

    /// Dual numbers take the quotient of sinh and cosh, which both overflow where tanh is one; so does `cosh^2`, but its
    /// reciprocal is then the zero that it should be.
    fn tanh(self) -> Self {
        Self::new(self.re.tanh(), self.eps / self.re.cosh().powi(2))
    }
}
