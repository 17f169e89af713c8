//! What generated code calls. Public because expanded macros live in the user's crate; not meant to be called by hand.

/// Guarded power `base^exponent` for a base that the declaration proves is not negative.
///
/// The limits, for `base -> 0+`: zero for a positive exponent, one for zero. A negative exponent is unbounded
/// there, and the value *at* zero is defined as zero (see [`Law`](crate::law::Law)). A negative base is outside the
/// piece the power belongs to; it is treated as zero, so that a result which is selected away is still finite.
#[inline(always)]
pub fn power(base: f64, exponent: f64) -> f64 {
    if base > 0.0 {
        base.powf(exponent)
    } else if exponent == 0.0 {
        1.0
    } else {
        0.0
    }
}

/// Guarded `base^exponent * ln(base)`, the derivative of [`power`] by its exponent.
///
/// For `base -> 0+` and a positive exponent the limit is zero; for the others the value at zero is defined as zero.
#[inline(always)]
pub fn power_log(base: f64, exponent: f64) -> f64 {
    if base > 0.0 { base.powf(exponent) * base.ln() } else { 0.0 }
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
