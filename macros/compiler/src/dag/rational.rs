//! Exact rational numbers with checked arithmetic.

use std::cmp::Ordering;
use std::fmt;

/// Doubles are fractions if their numerator and their denominator are below two to this.
const LARGEST_POWER: i32 = 126;

/// A number: an exact rational one, or a double where a literal does not fit into one.
///
/// Operations return `None` where they would not be exact: where a numerator or denominator would not fit into 128 bits, and where
/// the arithmetic of doubles would round.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub struct Rational {
    /// Carries the sign.
    numerator: i128,
    /// Positive; zero where the numerator is the bits of a double, which so takes no space of its own.
    denominator: i128,
}

/// What a number is.
enum Form {
    /// In lowest terms, with a positive denominator.
    Fraction { numerator: i128, denominator: i128 },
    /// A finite double that is no fraction of such numbers.
    Double(f64),
}

impl Rational {
    /// Zero.
    pub const ZERO: Self = Self::integer(0);
    /// One.
    pub const ONE: Self = Self::integer(1);

    /// An integer.
    pub const fn integer(value: i128) -> Self {
        Self::in_lowest_terms(value, 1)
    }

    const fn in_lowest_terms(numerator: i128, denominator: i128) -> Self {
        Self {
            numerator,
            denominator,
        }
    }

    fn double(value: f64) -> Self {
        Self::in_lowest_terms(i128::from(value.to_bits()), 0)
    }

    fn form(self) -> Form {
        match u64::try_from(self.numerator) {
            Ok(bits) if self.denominator == 0 => Form::Double(f64::from_bits(bits)),
            _ => Form::Fraction {
                numerator: self.numerator,
                denominator: self.denominator,
            },
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
        let numerator = if negative {
            -numerator_magnitude
        } else {
            numerator_magnitude
        };
        Some(Self::in_lowest_terms(numerator, denominator_magnitude))
    }

    /// The value of a decimal literal such as `1.5`, `2e-3` or `1_000`: exact where that fits, otherwise the nearest double.
    /// `None` where it is not a literal, above all doubles, or below all of them and not zero.
    pub fn from_decimal(text: &str) -> Option<Self> {
        let text = text.replace('_', "");
        let (mantissa, exponent) = text.split_once(['e', 'E']).unwrap_or((&text, "0"));
        Self::exact_decimal(mantissa, exponent).or_else(|| {
            let digits = |c: char| c.is_ascii_digit();
            let is_decimal = text.chars().all(|c| digits(c) || "eE.+-".contains(c));
            let value = text.parse().ok().filter(|_| is_decimal)?;
            let is_zero = !mantissa.contains(|c: char| digits(c) && c != '0');
            (is_zero || value != 0.0).then(|| Self::of_double(value))?
        })
    }

    fn exact_decimal(mantissa: &str, exponent: &str) -> Option<Self> {
        let exponent = exponent.parse::<i32>().ok()?;
        let (whole, fraction) = mantissa.split_once('.').unwrap_or((mantissa, ""));
        let fraction = fraction.trim_end_matches('0');
        let digits = format!("{whole}{fraction}");
        let value = Self::integer(digits.parse::<i128>().ok()?);
        let exponent = exponent.checked_sub(i32::try_from(fraction.len()).ok()?)?;
        value.checked_mul(Self::integer(10).integer_power(exponent)?)
    }

    /// The value of a double; `None` if it is not finite.
    fn of_double(value: f64) -> Option<Self> {
        if !value.is_finite() {
            return None;
        }
        // Scaling by a power of two is exact.
        let mut scales = (0..=LARGEST_POWER).map(|power| 2.0_f64.powi(power));
        let scale = scales.find(|scale| (value * scale).fract() == 0.0);
        let fraction = scale.and_then(|scale| {
            let fits = (value * scale).abs() < 2.0_f64.powi(LARGEST_POWER);
            fits.then(|| Self::new((value * scale) as i128, scale as i128))?
        });
        fraction.or(Some(Self::double(value)))
    }

    /// Numerator, which carries the sign, and denominator, which is positive; `None` for a double.
    pub fn fraction(self) -> Option<(i128, i128)> {
        match self.form() {
            Form::Fraction {
                numerator,
                denominator,
            } => Some((numerator, denominator)),
            Form::Double(_) => None,
        }
    }

    /// Its value if it is a whole number and not a double.
    pub fn whole(self) -> Option<i128> {
        let (numerator, denominator) = self.fraction()?;
        (denominator == 1).then_some(numerator)
    }

    /// Whether it is a whole number and not a double.
    pub fn is_integer(self) -> bool {
        self.whole().is_some()
    }

    /// Its value if it is a whole number that fits.
    pub fn to_integer(self) -> Option<i32> {
        i32::try_from(self.whole()?).ok()
    }

    /// Whether it is zero.
    pub fn is_zero(self) -> bool {
        self == Self::ZERO
    }

    /// Whether it is below zero.
    pub fn is_negative(self) -> bool {
        match self.form() {
            Form::Fraction { numerator, .. } => numerator < 0,
            Form::Double(value) => value < 0.0,
        }
    }

    /// Whether it is above zero.
    pub fn is_positive(self) -> bool {
        !self.is_negative() && !self.is_zero()
    }

    /// Whether it is an even whole number and not a double.
    pub fn is_even(self) -> bool {
        self.whole().is_some_and(|whole| whole % 2 == 0)
    }

    /// `-1`, `0` or `1`.
    #[must_use]
    pub fn sign(self) -> Self {
        Self::integer(i128::from(self.is_positive()) - i128::from(self.is_negative()))
    }

    /// Change of sign.
    pub fn negate(self) -> Option<Self> {
        Some(match self.form() {
            Form::Fraction {
                numerator,
                denominator,
            } => Self::in_lowest_terms(numerator.checked_neg()?, denominator),
            Form::Double(value) => Self::double(-value),
        })
    }

    /// Absolute value.
    pub fn absolute(self) -> Option<Self> {
        if self.is_negative() {
            self.negate()
        } else {
            Some(self)
        }
    }

    /// `1 / self`; `None` for zero.
    pub fn reciprocal(self) -> Option<Self> {
        let (numerator, denominator) = self.fraction()?;
        Self::new(denominator, numerator)
    }

    /// Sum.
    pub fn checked_add(self, other: Self) -> Option<Self> {
        if self.is_zero() {
            return Some(other);
        }
        if other.is_zero() {
            return Some(self);
        }
        if Some(self) == other.negate() {
            return Some(Self::ZERO);
        }
        let ((a, b), (c, d)) = (self.fraction()?, other.fraction()?);
        let sum = a.checked_mul(d)?.checked_add(c.checked_mul(b)?)?;
        Self::new(sum, b.checked_mul(d)?)
    }

    /// Difference.
    pub fn checked_sub(self, other: Self) -> Option<Self> {
        self.checked_add(other.negate()?)
    }

    /// Product.
    pub fn checked_mul(self, other: Self) -> Option<Self> {
        for (one, other) in [(self, other), (other, self)] {
            match one.whole() {
                Some(0) => return Some(Self::ZERO),
                Some(1) => return Some(other),
                Some(-1) => return other.negate(),
                _ => {}
            }
        }
        let ((a, b), (c, d)) = (self.fraction()?, other.fraction()?);
        // Cancelled crosswise first, so that the product overflows only where the result does.
        let (a, d) = Self::new(a, d)?.fraction()?;
        let (c, b) = Self::new(c, b)?.fraction()?;
        Some(Self::in_lowest_terms(a.checked_mul(c)?, b.checked_mul(d)?))
    }

    /// Quotient; `None` for a zero divisor.
    pub fn checked_div(self, other: Self) -> Option<Self> {
        if other == Self::ONE {
            return Some(self);
        }
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
    /// Of a fraction a long division by bits: at least 64 significant bits of the quotient, the last of them set where a remainder is
    /// left, so that the final conversion rounds once.
    pub fn to_f64(self) -> f64 {
        let (numerator, denominator) = match self.form() {
            Form::Fraction {
                numerator,
                denominator,
            } => (numerator, denominator.unsigned_abs()),
            Form::Double(value) => return value,
        };
        let magnitude = numerator.unsigned_abs();
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
        if numerator < 0 { -rounded } else { rounded }
    }
}

impl PartialOrd for Rational {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

impl Ord for Rational {
    /// Compares whole parts, then the reciprocals of what is left: exact, and nothing can overflow. A double is compared as such, and
    /// comes after the fractions that it is nearest to.
    fn cmp(&self, other: &Self) -> Ordering {
        let (Some((mut a, mut b)), Some((mut c, mut d))) = (self.fraction(), other.fraction())
        else {
            let doubles = self.to_f64().total_cmp(&other.to_f64());
            return doubles.then(self.fraction().is_none().cmp(&other.fraction().is_none()));
        };
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
        match self.form() {
            Form::Fraction {
                numerator,
                denominator: 1,
            } => write!(formatter, "{numerator}"),
            Form::Fraction {
                numerator,
                denominator,
            } => write!(formatter, "{numerator}/{denominator}"),
            Form::Double(value) => write!(formatter, "{value:e}"),
        }
    }
}

fn greatest_common_divisor(mut a: u128, mut b: u128) -> u128 {
    while b != 0 {
        (a, b) = (b, a % b);
    }
    a
}
