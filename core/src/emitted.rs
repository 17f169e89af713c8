//! What generated code calls. Public because expanded macros live in the user's crate; not meant to be called by hand.
//!
//! # Guarded powers
//!
//! A power that is not an integer belongs to a piece on which its base is not negative. The code is also run outside of
//! its piece, for samples whose result is selected away, and at the ends of the piece, where the base is zero. So every
//! function here is finite for a base that is zero or negative:
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
pub mod constants;
mod law;
mod parts;
mod room;

pub use batch::{Batch, Group, Raising, Uses, group, uses};
pub use law::{ByArgument, Declared, Generated, Kernels};
pub use parts::{Primitive, Spring};

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

/// Guarded logarithm: zero for a base that is not positive, so that its product with a guarded power is finite.
#[inline(always)]
pub fn logarithm(base: f64) -> f64 {
    if base > 0.0 { base.ln() } else { 0.0 }
}

/// Guarded power from the logarithm of its base, which the powers of one base share.
#[inline(always)]
pub fn raise(base: f64, logarithm: f64, exponent: f64) -> f64 {
    if base > 0.0 {
        (exponent * logarithm).exp()
    } else {
        at_zero(exponent)
    }
}

/// The whole number between two others, added to an exponent, that makes it smallest in size: among the powers of one
/// base whose exponents differ by whole numbers, the one to compute, because its error is within the bound of the others.
#[inline(always)]
pub fn nearest(exponent: f64, lowest: f64, highest: f64) -> f64 {
    (-exponent).round().clamp(lowest, highest)
}

/// Guarded quotient of a power and its base, a lower power.
#[inline(always)]
pub fn over(power: f64, base: f64) -> f64 {
    if base > 0.0 { power / base } else { 0.0 }
}

/// A power times its base to a whole number of `steps` between `-DOWN` and `UP`.
#[inline(always)]
pub fn shift<const UP: usize, const DOWN: usize>(mut power: f64, base: f64, steps: f64) -> f64 {
    for step in 0..UP {
        power = if steps > step as f64 {
            power * base
        } else {
            power
        };
    }
    for step in 0..DOWN {
        power = if -steps > step as f64 {
            over(power, base)
        } else {
            power
        };
    }
    power
}

/// Guarded power of zero.
#[inline(always)]
fn at_zero(exponent: f64) -> f64 {
    if exponent == 0.0 { 1.0 } else { 0.0 }
}

/// Guarded square root.
#[inline(always)]
pub fn root(base: f64) -> f64 {
    base.max(0.0).sqrt()
}

/// Guarded cube root.
#[inline(always)]
pub fn cube_root(base: f64) -> f64 {
    base.max(0.0).cbrt()
}

/// Guarded reciprocal.
#[inline(always)]
pub fn reciprocal(x: f64) -> f64 {
    if x == 0.0 { 0.0 } else { 1.0 / x }
}

/// Sign: `-1`, `0` or `1`.
#[inline(always)]
pub fn sign(x: f64) -> f64 {
    f64::from(i8::from(x > 0.0) - i8::from(x < 0.0))
}

/// Heaviside step: one for a positive operand, zero otherwise.
#[inline(always)]
pub fn step(x: f64) -> f64 {
    f64::from(u8::from(x > 0.0))
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

/// Exponential.
#[inline(always)]
pub fn exponential(x: f64) -> f64 {
    x.exp()
}

/// Hyperbolic tangent.
#[inline(always)]
pub fn tanh(x: f64) -> f64 {
    x.tanh()
}

/// Replaces values where a condition holds, by selection.
#[inline(always)]
pub fn select<const V: usize>(values: &mut [f64; V], condition: bool, others: [f64; V]) {
    for (value, other) in values.iter_mut().zip(others) {
        *value = if condition { other } else { *value };
    }
}

/// The kernel of a piece without force.
#[inline(always)]
pub fn nothing<const A: usize, const V: usize>(_: [f64; A], _: f64, _: f64) -> [f64; V] {
    [0.0; V]
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
                assert_eq!(raise(base, logarithm(base), exponent), expected);
                assert_eq!(power_log(base, exponent), 0.0);
            }
            assert_eq!(root(base), 0.0);
            assert_eq!(cube_root(base), 0.0);
            assert_eq!(logarithm(base), 0.0);
        }
        assert_eq!(reciprocal(0.0), 0.0);
        assert_eq!(reciprocal(-4.0), -0.25);
    }

    #[test]
    fn powers_by_one_logarithm_are_as_good_as_their_own() {
        for base in [1e-300, 1e-12, 0.3, 1.0, 7.0, 1e6_f64] {
            for exponent in [-0.4, 0.6, 1.4, 2.2] {
                let (shared, own) = (raise(base, logarithm(base), exponent), base.powf(exponent));
                let bound = 4.0 * f64::EPSILON * (1.0 + (exponent * base.ln()).abs());
                assert!((shared - own).abs() <= bound * own, "{base}^{exponent}");
            }
        }
    }

    #[test]
    fn powers_made_from_a_neighbour_keep_the_bound() {
        for base in [1e-300, 1e-12, 0.3, 1.0, 7.0, 1e6_f64] {
            for alpha in [0.05, 0.2, 0.5, 0.7, 1.0, 1.7, 2.0, 4.0_f64] {
                let steps = nearest(alpha, -2.0, 0.0);
                let shared = raise(base, logarithm(base), alpha + steps);
                for (made, exponent) in [
                    (shift::<2, 0>(shared, base, -steps), alpha),
                    (shift::<1, 1>(shared, base, -1.0 - steps), alpha - 1.0),
                    (shift::<0, 2>(shared, base, -2.0 - steps), alpha - 2.0),
                ] {
                    let own = base.powf(exponent);
                    let bound = 4.0 * f64::EPSILON * (1.0 + (exponent * base.ln()).abs());
                    let error = (made - own).abs();
                    assert!(
                        made == own || error <= bound * own + f64::MIN_POSITIVE,
                        "{base}^{exponent}: {made:e}, not {own:e}"
                    );
                }
            }
        }
        // At zero, and below, as the guarded power itself.
        for base in [0.0, -1e-320, -3.0] {
            assert_eq!(shift::<1, 1>(0.0, base, -1.0), 0.0);
            assert_eq!(shift::<1, 1>(0.0, base, 1.0), 0.0);
            assert_eq!(shift::<1, 1>(1.0, base, 0.0), 1.0);
        }
    }

    #[test]
    fn sign_and_step_are_zero_at_zero() {
        assert_eq!([-2.0, 0.0, 3.0].map(sign), [-1.0, 0.0, 1.0]);
        assert_eq!([-2.0, 0.0, 3.0].map(step), [0.0, 0.0, 1.0]);
    }
}
