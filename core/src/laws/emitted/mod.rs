//! What generated code calls. Public because expanded macros live in the user's crate; not meant to be called by hand.
//!
//! # Guarded powers
//!
//! A power that is not an integer belongs to a piece on which its base is not negative. The code is also run outside of
//! its piece, for samples whose result is selected away, and at the ends of the piece, where the base is zero. So every
//! power here is finite for a base that is zero or negative:
//!
//! - `b^e` for `b -> 0+` goes to zero for `e > 0` and is one for `e = 0`. For `e < 0` it is unbounded, and the value *at*
//!   zero is defined as zero (see [`Law`](crate::law::Law)).
//! - `b^e ln b` for `b -> 0+` goes to zero for `e > 0`; otherwise it is unbounded, and zero at zero by definition.
//! - `1 / b` is zero for `b = 0` by definition.
//! - A negative base is treated as zero.
//!
//! Each guard is a selection between two computed values, so that a loop of them has no branch.

// Short functions that are meaningless unless merged into the loop that calls them.
#![allow(clippy::inline_always)]

mod batch;
mod law;
mod outputs;
mod parts;
mod workspace;

pub use hertzian_contract::constants;
pub use hertzian_contract::declared::Declared;
pub use hertzian_macros::{law, oscillator};

pub use batch::{Batch, Group, Kernel, Nothing, Raising, Uses, cube_root_group, group, uses};
pub use law::{ByArgument, Generated, Kernels};
pub use parts::{Primitive, Spring};

use crate::numeric::power::{Baseline, cube_root as cube_root_of};

/// Guarded power `base^exponent` for a base that the declaration proves is not negative.
#[inline(always)]
pub fn power(base: f64, exponent: f64) -> f64 {
    if base > 0.0 {
        base.powf(exponent)
    } else {
        at_zero(exponent)
    }
}

/// Guarded `base^exponent * ln(base)`, the derivative of [`power`] by its exponent.
#[inline(always)]
pub fn power_log(base: f64, exponent: f64) -> f64 {
    if base > 0.0 {
        base.powf(exponent) * base.ln()
    } else {
        0.0
    }
}

/// Guarded power of zero.
#[inline(always)]
fn at_zero(exponent: f64) -> f64 {
    if exponent == 0.0 { 1.0 } else { 0.0 }
}

/// Guarded square root.
#[inline(always)]
pub fn root(base: f64) -> f64 {
    not_negative(base).sqrt()
}

/// Guarded cube root.
#[inline(always)]
pub fn cube_root(base: f64) -> f64 {
    cube_root_of::<Baseline>(not_negative(base))
}

/// The greater of a number and zero; what is not a number stays so. Unlike `f64::max` it is one instruction.
#[inline(always)]
fn not_negative(base: f64) -> f64 {
    if 0.0 > base { 0.0 } else { base }
}

/// Guarded reciprocal.
#[inline(always)]
pub fn reciprocal(x: f64) -> f64 {
    if x == 0.0 { 0.0 } else { 1.0 / x }
}

/// Sign: `-1`, `0` or `1`.
#[inline(always)]
pub fn sign(x: f64) -> f64 {
    if x > 0.0 {
        1.0
    } else if x < 0.0 {
        -1.0
    } else {
        0.0
    }
}

/// Heaviside step: one for a positive operand, zero otherwise.
#[inline(always)]
pub fn step(x: f64) -> f64 {
    if x > 0.0 { 1.0 } else { 0.0 }
}

/// Absolute value.
#[inline(always)]
pub fn absolute(x: f64) -> f64 {
    x.abs()
}

/// Sine.
#[inline(always)]
pub fn sine(x: f64) -> f64 {
    x.sin()
}

/// Cosine.
#[inline(always)]
pub fn cosine(x: f64) -> f64 {
    x.cos()
}

/// Exponential, up to 8e99: in `exp(x) / (1 + exp(x))^2`, the slope of a logistic curve, infinities would leave no number where the
/// slope vanishes.
#[inline(always)]
pub fn exponential(x: f64) -> f64 {
    if x > LARGEST_EXPONENT {
        LARGEST_EXPONENT.exp()
    } else {
        x.exp()
    }
}

/// So that powers up to the third are finite.
const LARGEST_EXPONENT: f64 = 230.0;

/// Hyperbolic tangent.
#[inline(always)]
pub fn tanh(x: f64) -> f64 {
    x.tanh()
}

/// Replaces a value where a condition holds, by selection.
#[inline(always)]
pub fn choose(value: &mut f64, condition: bool, other: f64) {
    *value = if condition { other } else { *value };
}

/// Replaces values where a condition holds, by selection.
#[inline(always)]
pub fn select<const V: usize>(values: &mut [f64; V], condition: bool, others: [f64; V]) {
    for (value, other) in values.iter_mut().zip(others) {
        choose(value, condition, other);
    }
}

/// A slice of arguments or parameters as an array.
///
/// # Panics
/// If the slice has another length.
#[inline]
pub fn arguments<const N: usize>(slice: &[f64]) -> [f64; N] {
    slice
        .try_into()
        .unwrap_or_else(|_| panic!("{N} arguments are needed, {} were given", slice.len()))
}

/// A piece was asked for that a law does not have.
///
/// # Panics
/// Always.
#[cold]
pub fn no_such_piece(index: usize) -> ! {
    panic!("the law has no piece {index}")
}

/// An argument was asked for that a law does not have.
///
/// # Panics
/// Always.
#[cold]
pub fn no_such_argument(index: usize) -> ! {
    panic!("the law has no argument {index}")
}

/// A parameter was asked for that a system does not have.
///
/// # Panics
/// Always.
#[cold]
pub fn no_such_parameter(index: usize) -> ! {
    panic!("the system has no parameter {index}")
}

/// A law was asked for that a system does not have.
///
/// # Panics
/// Always.
#[cold]
pub fn no_such_law(index: usize) -> ! {
    panic!("the system has no law {index}")
}

/// Stands in for a model whose declaration was refused; such a program does not compile, so this never runs.
///
/// # Panics
/// Always.
#[cold]
pub fn refused() -> ! {
    panic!("the declaration was refused")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn guarded_functions_are_finite_at_and_below_zero() {
        for base in [0.0, -0.0, -1e-300, -2.0, -1e300] {
            for exponent in [-3.0, -0.4, 0.0, 0.6, 1.0, 2.5] {
                let expected = if exponent == 0.0 { 1.0 } else { 0.0 };
                assert_eq!(power(base, exponent), expected);
                assert_eq!(power_log(base, exponent), 0.0);
            }
            assert_eq!(root(base), 0.0);
            assert_eq!(cube_root(base), 0.0);
        }
        assert_eq!(reciprocal(0.0), 0.0);
        assert_eq!(reciprocal(-4.0), -0.25);
    }

    #[test]
    fn sign_and_step_are_zero_at_zero() {
        assert_eq!([-2.0, 0.0, 3.0].map(sign), [-1.0, 0.0, 1.0]);
        assert_eq!([-2.0, 0.0, 3.0].map(step), [0.0, 0.0, 1.0]);
    }
}
