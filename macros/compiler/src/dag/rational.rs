//! Exact rational numbers with checked arithmetic.

use std::cmp::Ordering;
use std::fmt;

/// An exact rational number, in lowest terms, with a positive denominator.
///
/// Operations return `None` where a numerator or denominator would not fit into 128 bits.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub struct Rational {
    numerator: i128,
    denominator: i128,
}

impl Rational {
    /// Zero.
    pub const ZERO: Self = Self::integer(0);
    /// One.
    pub const ONE: Self = Self::integer(1);

    /// An integer.
    pub const fn integer(value: i128) -> Self {
        Self {
            numerator: value,
            denominator: 1,
        }
    }

    /// `numerator / denominator`; `None` for a zero denominator.
    pub fn new(numerator: i128, denominator: i128) -> Option<Self> {
        if denominator == 0 {
            return None;
        }
        let divisor = greatest_common_divisor(numerator.unsigned_abs(), denominator.unsigned_abs());
        let numerator_magnitude = i128::try_from(numerator.unsigned_abs() / divisor).ok()?;
        let denominator_magnitude = i128::try_from(denominator.unsigned_abs() / divisor).ok()?;
        let negative = (numerator < 0) != (denominator < 0);
        Some(Self {
            numerator: if negative {
                -numerator_magnitude
            } else {
                numerator_magnitude
            },
            denominator: denominator_magnitude,
        })
    }

    /// The exact value of a decimal literal such as `1.5`, `2e-3` or `1_000`; `None` where it is not one or does not
    /// fit.
    pub fn from_decimal(text: &str) -> Option<Self> {
        let text = text.replace('_', "");
        let (mantissa, exponent) = match text.split_once(['e', 'E']) {
            Some((mantissa, exponent)) => (mantissa, exponent.parse::<i32>().ok()?),
            None => (text.as_str(), 0),
        };
        let (whole, fraction) = mantissa.split_once('.').unwrap_or((mantissa, ""));
        let fraction = fraction.trim_end_matches('0');
        let digits = format!("{whole}{fraction}");
        let value = Self::integer(digits.parse::<i128>().ok()?);
        let exponent = exponent.checked_sub(i32::try_from(fraction.len()).ok()?)?;
        value.checked_mul(Self::integer(10).integer_power(exponent)?)
    }

    /// The numerator, which carries the sign.
    pub fn numerator(self) -> i128 {
        self.numerator
    }

    /// The denominator, which is positive.
    pub fn denominator(self) -> i128 {
        self.denominator
    }

    /// Whether it is a whole number.
    pub fn is_integer(self) -> bool {
        self.denominator == 1
    }

    /// Its value if it is a whole number that fits.
    pub fn to_integer(self) -> Option<i32> {
        if self.is_integer() {
            i32::try_from(self.numerator).ok()
        } else {
            None
        }
    }

    /// Whether it is zero.
    pub fn is_zero(self) -> bool {
        self.numerator == 0
    }

    /// Whether it is below zero.
    pub fn is_negative(self) -> bool {
        self.numerator < 0
    }

    /// Whether it is above zero.
    pub fn is_positive(self) -> bool {
        self.numerator > 0
    }

    /// Whether it is an even whole number.
    pub fn is_even(self) -> bool {
        self.is_integer() && self.numerator % 2 == 0
    }

    /// `-1`, `0` or `1`.
    #[must_use]
    pub fn sign(self) -> Self {
        Self::integer(self.numerator.signum())
    }

    /// Change of sign.
    pub fn negate(self) -> Option<Self> {
        Some(Self {
            numerator: self.numerator.checked_neg()?,
            denominator: self.denominator,
        })
    }

    /// Absolute value.
    pub fn absolute(self) -> Option<Self> {
        Some(Self {
            numerator: self.numerator.checked_abs()?,
            denominator: self.denominator,
        })
    }

    /// `1 / self`; `None` for zero.
    pub fn reciprocal(self) -> Option<Self> {
        Self::new(self.denominator, self.numerator)
    }

    /// Sum.
    pub fn checked_add(self, other: Self) -> Option<Self> {
        let left = self.numerator.checked_mul(other.denominator)?;
        let right = other.numerator.checked_mul(self.denominator)?;
        Self::new(
            left.checked_add(right)?,
            self.denominator.checked_mul(other.denominator)?,
        )
    }

    /// Difference.
    pub fn checked_sub(self, other: Self) -> Option<Self> {
        self.checked_add(other.negate()?)
    }

    /// Product.
    pub fn checked_mul(self, other: Self) -> Option<Self> {
        // Cancelled crosswise first, so that the product overflows only where the result does.
        let left = Self::new(self.numerator, other.denominator)?;
        let right = Self::new(other.numerator, self.denominator)?;
        Some(Self {
            numerator: left.numerator.checked_mul(right.numerator)?,
            denominator: left.denominator.checked_mul(right.denominator)?,
        })
    }

    /// Quotient; `None` for a zero divisor.
    pub fn checked_div(self, other: Self) -> Option<Self> {
        self.checked_mul(other.reciprocal()?)
    }

    /// `self^exponent`; `None` for a negative power of zero.
    pub fn integer_power(self, exponent: i32) -> Option<Self> {
        let mut square = if exponent < 0 {
            self.reciprocal()?
        } else {
            self
        };
        let mut remaining = exponent.unsigned_abs();
        let mut result = Self::ONE;
        while remaining > 0 {
            if remaining % 2 == 1 {
                result = result.checked_mul(square)?;
            }
            remaining /= 2;
            if remaining > 0 {
                square = square.checked_mul(square)?;
            }
        }
        Some(result)
    }

    /// The nearest double, ties to even.
    ///
    /// Long division by bits: at least 64 significant bits of the quotient, the last of them set where a remainder is
    /// left, so that the final conversion rounds once.
    pub fn to_f64(self) -> f64 {
        let denominator = self.denominator.unsigned_abs();
        let magnitude = self.numerator.unsigned_abs();
        let (mut quotient, mut remainder) = (magnitude / denominator, magnitude % denominator);
        let mut shift = 0;
        while remainder != 0 && quotient >> 63 == 0 {
            remainder *= 2;
            quotient = quotient * 2 + u128::from(remainder >= denominator);
            if remainder >= denominator {
                remainder -= denominator;
            }
            shift += 1;
        }
        let rounded = (quotient | u128::from(remainder != 0)) as f64 * 2.0_f64.powi(-shift);
        if self.numerator < 0 {
            -rounded
        } else {
            rounded
        }
    }
}

impl PartialOrd for Rational {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

impl Ord for Rational {
    /// Compares whole parts, then the reciprocals of what is left: exact, and nothing can overflow.
    fn cmp(&self, other: &Self) -> Ordering {
        let (mut a, mut b) = (self.numerator, self.denominator);
        let (mut c, mut d) = (other.numerator, other.denominator);
        let mut reversed = false;
        loop {
            let (left, right) = (a.div_euclid(b), c.div_euclid(d));
            let (left_rest, right_rest) = (a.rem_euclid(b), c.rem_euclid(d));
            let ordering = match left.cmp(&right) {
                Ordering::Equal if left_rest == 0 || right_rest == 0 => left_rest.cmp(&right_rest),
                Ordering::Equal => {
                    (a, b, c, d) = (b, left_rest, d, right_rest);
                    reversed = !reversed;
                    continue;
                }
                ordering => ordering,
            };
            return if reversed {
                ordering.reverse()
            } else {
                ordering
            };
        }
    }
}

impl fmt::Display for Rational {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        if self.denominator == 1 {
            write!(formatter, "{}", self.numerator)
        } else {
            write!(formatter, "{}/{}", self.numerator, self.denominator)
        }
    }
}

fn greatest_common_divisor(mut a: u128, mut b: u128) -> u128 {
    while b != 0 {
        (a, b) = (b, a % b);
    }
    a
}
