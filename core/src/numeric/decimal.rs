//! Numbers as a reader expects them: in decimals where their size allows, in powers of ten elsewhere.

use std::fmt;

/// Sizes that are written out whole: below, zeros would lead; above, they would follow.
const PLAIN: std::ops::Range<f64> = 1e-6..1e15;
/// Sizes that are written with a given number of decimals: below, digits would be lost; above, decimals mean nothing.
const ROUNDED: std::ops::Range<f64> = 1e-3..1e6;

/// Digits behind the first one: of a number of which nothing is known, and that a number has.
const FEWEST: f64 = 2.0;
const MOST: f64 = 15.0;

/// A number to be printed, with all digits that tell it from other numbers.
///
/// ```
/// use hertzian::export;
///
/// assert_eq!(export::plain(0.25).to_string(), "0.25");
/// assert_eq!(export::plain(1e-300).to_string(), "1e-300");
/// ```
pub fn plain(value: f64) -> impl fmt::Display + Copy {
    Decimal::plain(value)
}

/// A number to be printed, with so many decimals, of itself or of its power of ten.
///
/// ```
/// use hertzian::export;
///
/// assert_eq!(export::rounded(0.715119549676, 9).to_string(), "0.715119550");
/// assert_eq!(export::rounded(2.5e-8, 3).to_string(), "2.500e-8");
/// ```
pub fn rounded(value: f64, decimals: usize) -> impl fmt::Display + Copy {
    Decimal::rounded(value, decimals)
}

/// A number to be printed, with as many digits as an error bears: the first that it changes is the last. Nothing is known of a number whose
/// error is not finite, and it has three digits; without an error it has all.
///
/// ```
/// use hertzian::export;
///
/// assert_eq!(export::to_error(0.715119549676, 2e-7).to_string(), "0.7151195");
/// assert_eq!(export::to_error(1234.5678, 20.0).to_string(), "1235");
/// assert_eq!(export::to_error(2.54321e-8, 3e-11).to_string(), "2.543e-8");
/// assert_eq!(export::to_error(2.54321, f64::INFINITY).to_string(), "2.54");
/// ```
pub fn to_error(value: f64, error: f64) -> impl fmt::Display + Copy {
    Decimal::to_error(value, error)
}

/// A number to be printed.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Decimal {
    value: f64,
    decimals: Option<usize>,
}

impl Decimal {
    /// See [`plain`].
    pub(crate) const fn plain(value: f64) -> Self {
        Self {
            value,
            decimals: None,
        }
    }

    /// See [`rounded`].
    pub(crate) const fn rounded(value: f64, decimals: usize) -> Self {
        Self {
            value,
            decimals: Some(decimals),
        }
    }

    /// See [`to_error`].
    pub(crate) fn to_error(value: f64, error: f64) -> Self {
        if !value.is_finite() || value == 0.0 || error == 0.0 {
            return Self::plain(value);
        }
        let first = value.abs().log10().floor();
        let last = if error.is_finite() {
            error.abs().log10().floor().max(first - MOST)
        } else {
            first - FEWEST
        };
        let written_out = ROUNDED.contains(&value.abs());
        let decimals = if written_out { -last } else { first - last };
        Self::rounded(value, decimals.max(0.0) as usize)
    }
}

impl fmt::Display for Decimal {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { value, decimals } = *self;
        let usual = if decimals.is_some() { ROUNDED } else { PLAIN };
        let written_out = value == 0.0 || !value.is_finite() || usual.contains(&value.abs());
        match (written_out, decimals) {
            (true, None) => write!(f, "{value}"),
            (false, None) => write!(f, "{value:e}"),
            (true, Some(decimals)) => write!(f, "{value:.decimals$}"),
            (false, Some(decimals)) => write!(f, "{value:.decimals$e}"),
        }
    }
}
