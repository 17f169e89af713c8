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
//!
//! # Loops
//!
//! The loops take the kernel of one sample as a closure and are always inlined; together with the kernel they become
//! one loop over slices of one length. What the kernel computes but the loop does not store is removed.

// Short functions that are meaningless unless merged into the loop that calls them.
#![allow(clippy::inline_always)]

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

/// `yes` where the condition holds, `no` elsewhere, value by value.
#[inline(always)]
pub fn select<const N: usize>(condition: bool, yes: [f64; N], no: [f64; N]) -> [f64; N] {
    std::array::from_fn(|index| if condition { yes[index] } else { no[index] })
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

/// Declares a loop with a given number of outputs. Every output is a parameter of its own, so that the compiler knows
/// that they do not overlap.
macro_rules! loops {
    ($($name:ident: $count:literal, $($out:ident $index:literal),+;)+) => {$(
        /// Writes the outputs of a kernel for every sample.
        ///
        /// # Panics
        /// If the slices differ in length.
        #[inline(always)]
        pub fn $name(
            gap: &[f64],
            rate: &[f64],
            $($out: &mut [f64],)+
            kernel: impl Fn(f64, f64) -> [f64; $count],
        ) {
            let count = gap.len();
            assert_eq!(rate.len(), count, "gap and rate differ in length");
            $(assert_eq!($out.len(), count, "an output differs in length from the samples");)+
            for i in 0..count {
                let values = kernel(gap[i], rate[i]);
                $($out[i] = values[$index];)+
            }
        }
    )+};
}

loops! {
    write_1: 1, first 0;
    write_2: 2, first 0, second 1;
    write_3: 3, first 0, second 1, third 2;
    write_4: 4, first 0, second 1, third 2, fourth 3;
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
