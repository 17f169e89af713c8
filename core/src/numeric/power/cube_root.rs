//! Cube roots without a branch and without a table, so that a loop of them becomes vectors.
//!
//! From an estimate `y` of `x^(-1/3)`, taken from the bits of `x`: an exponent divided by minus three, and a straight line for
//! the fraction. With `e = 1 - x y^3`, at first below 0.103,
//!
//! ```text
//! y <- y (1 + e/3 + 2 e^2/9 + 14 e^3/81),   error of y: 35/243 e^4 < 1.6e-5                                  (1)
//! y <- y (1 + e/3),                         error of y: 2 (1.6e-5)^2 < 6e-10                                 (2)
//! c = x y^2,   c <- c + (x - c^3) y^2/3     error of c: below (2 6e-10)^2 and roundings                      (3)
//! ```
//!
//! (1) is the binomial series of `(1 - e)^(-1/3)`. In (3) the difference is exact, but `c^3` is rounded twice, which is a
//! third as much in `c`; with the last rounding that is less than 0.9 units in the last place.
//!
//! Source: Moroz, Samotyy, Walczyk and Cieslinski (2021), Fast calculation of cube and inverse cube roots using a magic
//! constant, Energies 14:1058, here with one more term in (1) and for double precision.

use super::instructions::Target;

/// The leading half of the bits of a one, to which an estimate adds a third of those of `x`, with the sign changed; lowered
/// so that the greatest error is smallest.
const ESTIMATE: f64 = 1_430_186_314.0;

/// `2^52`: its last bits count ones.
const COUNTS_ONES: f64 = 4_503_599_627_370_496.0;

/// The cube root of a number that is not negative: zero, subnormal, infinite, or not a number as well.
#[inline(always)]
#[allow(clippy::inline_always, reason = "part of a loop that calls it")]
pub fn cube_root<T: Target>(x: f64) -> f64 {
    // By a power of eight into the range of numbers whose bits hold their exponent.
    const SCALE: f64 = (1_u64 << 54) as f64;
    const BACK: f64 = 1.0 / (1_u64 << 18) as f64;
    let subnormal = x < f64::MIN_POSITIVE;
    let scaled = if subnormal { x * SCALE } else { x };
    let root = normal::<T>(scaled);
    let root = if subnormal { root * BACK } else { root };
    // Zero and infinity are their own.
    let root = if x == 0.0 { x } else { root };
    if x == f64::INFINITY { x } else { root }
}

#[inline(always)]
#[allow(clippy::inline_always, reason = "part of a loop that calls it")]
fn normal<T: Target>(x: f64) -> f64 {
    let leading = f64::from_bits((x.to_bits() >> 32) | COUNTS_ONES.to_bits()) - COUNTS_ONES;
    let estimate = T::add_product(leading, -1.0 / 3.0, ESTIMATE) + COUNTS_ONES;
    let y = f64::from_bits(estimate.to_bits() << 32);

    let e = T::add_product(-(x * y), y * y, 1.0);
    let series = T::add_product(e, 14.0 / 81.0, 2.0 / 9.0);
    let series = T::add_product(series, e, 1.0 / 3.0);
    let y = T::add_product(y * e, series, y);

    let e = T::add_product(-(x * y), y * y, 1.0);
    let y = T::add_product(y * (1.0 / 3.0), e, y);

    let square = y * y;
    let c = x * square;
    let rest = T::add_product(-(c * c), c, x);
    T::add_product(rest, square * (1.0 / 3.0), c)
}
