//! Logarithms and powers to about 95 bits: Taylor series in numbers that are the sum of two (Dekker 1971, A floating-point
//! technique for extending the available precision). Compared with mpmath in `the_oracle_agrees_with_mpmath`.

use std::ops::{Add, Mul, Neg};

/// `high + low`, not rounded.
#[derive(Debug, Clone, Copy)]
pub struct Pair {
    pub high: f64,
    pub low: f64,
}

/// `ln 2` in three parts; a whole number below `2^11` times the first is exact.
const LN_2: [f64; 3] = [
    f64::from_bits(0x3fe6_2e42_fefa_3800),
    f64::from_bits(0x3d2e_f357_93c7_6730),
    f64::from_bits(0x398f_97b5_7a07_9a19),
];

impl Pair {
    pub fn new(value: f64) -> Self {
        Self {
            high: value,
            low: 0.0,
        }
    }

    fn sum(a: f64, b: f64) -> Self {
        let high = a + b;
        let from_b = high - a;
        Self {
            high,
            low: (a - (high - from_b)) + (b - from_b),
        }
    }

    fn product(a: f64, b: f64) -> Self {
        let high = a * b;
        Self {
            high,
            low: a.mul_add(b, -high),
        }
    }

    /// `n ln 2`
    fn ln_2_times(n: f64) -> Self {
        Self::product(n, LN_2[0]) + (Self::product(n, LN_2[1]) + Self::product(n, LN_2[2]))
    }

    /// The exponential of a number below `1/2` in size: `e^x = (e^(x/256))^256`.
    fn exp_small(self) -> Self {
        let x = self * Self::new(1.0 / 256.0);
        let mut sum = Self::new(1.0);
        for n in (1..=12).rev() {
            sum = Self::new(1.0) + x * sum * Self::reciprocal(f64::from(n));
        }
        for _ in 0..8 {
            sum = sum * sum;
        }
        sum
    }

    fn reciprocal(n: f64) -> Self {
        let high = 1.0 / n;
        Self {
            high,
            low: (-high).mul_add(n, 1.0) / n,
        }
    }

    /// The natural logarithm of a positive number: `2 (s + s^3/3 + s^5/5 + ...)`, `s = (z - 1)/(z + 1)`.
    pub fn ln(x: f64) -> Self {
        let (z, k) = parts(x);
        let s = Self::quotient(z - 1.0, Self::sum(z, 1.0));
        let square = s * s;
        let mut sum = Self::new(0.0);
        for n in (0..24).rev() {
            sum = Self::reciprocal(f64::from(2 * n + 1)) + square * sum;
        }
        s * sum * Self::new(2.0) + Self::ln_2_times(k)
    }

    fn quotient(a: f64, b: Self) -> Self {
        let high = a / b.high;
        let rest = Self::new(a) + -(b * Self::new(high));
        Self::sum(high, (rest.high + rest.low) / b.high)
    }
}

/// A power of a positive number, as a number near one and an exponent of two.
pub fn power(x: f64, exponent: f64) -> (Pair, i32) {
    let y = Pair::ln(x) * Pair::new(exponent);
    if y.high.abs() > 3000.0 {
        return (Pair::new(1.0), if y.high > 0.0 { 5000 } else { -5000 });
    }
    let n = (y.high / std::f64::consts::LN_2).round();
    ((y + -Pair::ln_2_times(n)).exp_small(), n as i32)
}

/// How far a number is from a power, in units of the last place of the power: `2^-52` of it, or the smallest subnormal.
pub fn ulps(found: f64, x: f64, exponent: f64) -> f64 {
    let (exact, n) = power(x, exponent);
    let overflows = n > 1024 || (n == 1024 && exact.high >= 1.0);
    if overflows {
        return if found == f64::INFINITY {
            0.0
        } else {
            f64::INFINITY
        };
    }
    if n < -1080 {
        return found / 5e-324;
    }
    // In two steps, because 2^-n need not be a number.
    let found = scale(scale(found, -(n / 2)), n / 2 - n);
    let error = (found - exact.high) - exact.low;
    let unit = (f64::EPSILON * exact.high).max(scale(1.0, (-1074 - n).min(1000)));
    (error / unit).abs()
}

/// `x = 2^k z` with `z` between `sqrt(1/2)` and `sqrt(2)`.
fn parts(x: f64) -> (f64, f64) {
    let (x, below) = if x < f64::MIN_POSITIVE {
        (x * 2_f64.powi(60), 60.0)
    } else {
        (x, 0.0)
    };
    let k = (x.to_bits() >> 52) as f64 - 1023.0;
    let z = f64::from_bits((x.to_bits() & ((1 << 52) - 1)) | 1_f64.to_bits());
    if z > std::f64::consts::SQRT_2 {
        (0.5 * z, k + 1.0 - below)
    } else {
        (z, k - below)
    }
}

fn scale(x: f64, n: i32) -> f64 {
    x * 2_f64.powi(n)
}

impl Neg for Pair {
    type Output = Self;
    fn neg(self) -> Self {
        Self {
            high: -self.high,
            low: -self.low,
        }
    }
}

impl Add for Pair {
    type Output = Self;
    fn add(self, other: Self) -> Self {
        let high = Self::sum(self.high, other.high);
        let low = Self::sum(self.low, other.low);
        let high = Self::sum(high.high, high.low + low.high);
        Self::sum(high.high, high.low + low.low)
    }
}

impl Mul for Pair {
    type Output = Self;
    fn mul(self, other: Self) -> Self {
        let high = Self::product(self.high, other.high);
        let cross = self.high.mul_add(other.low, self.low * other.high);
        Self::sum(high.high, high.low + cross)
    }
}
