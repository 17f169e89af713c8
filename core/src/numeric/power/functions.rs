//! Logarithm and power of one number, without a branch and without a table, so that a loop of them becomes vectors.
//!
//! A positive number is `x = 2^k z` with `z` between `sqrt(1/2)` and `sqrt(2)`. With `s = (z - 1)/(z + 1)`,
//!
//! ```text
//! log2 x = k + l,   l = log2 z = s P(s^2),   |s| <= 3 - 2 sqrt(2)                                            (1)
//! x^a    = 2^n 2^r,   n = round(a k + a l),   r = (a k - n) + a l,   |r| <= 1/2 and a rounding                (2)
//! 2^r    = 1 + r Q(r)                                                                                        (3)
//! ```
//!
//! Sources: Tang (1990), Table-driven implementation of the logarithm function, ACM TOMS 16:378 (the argument of (1));
//! Muller (2016), Elementary Functions, 3rd ed., ch. 11 (the reductions); Brisebarre and Chevillard (2007), Efficient
//! polynomial L-infinity approximations (the coefficients: `fpminimax` of Sollya 8.0, `log2((1+sqrt(x))/(1-sqrt(x)))/sqrt(x)`
//! on `[0, (3 - 2 sqrt(2))^2]` and `2^x` on `[-1/2, 1/2]` with constant term one, doubles, relative error).
//!
//! # Error
//!
//! With `u = 2^-53`: (1) rounds `z + 1`, the quotient, `P` and its product with `s`, so `l` carries `4.3 u` of itself; `k`
//! is exact. In (2) `a k - n` is rounded once (fused) or not at all (`a` has its last 12 bits apart, so that its
//! product with `k` is exact), and `a l` once. So the error of `r` is
//!
//! ```text
//! |dr| <= u + 6.3 u |a l|,   |l| <= 1/2                                                                      (4)
//! ```
//!
//! and that of the power relative to itself, in units of `2 u = 2^-52`, `1.2 + 2.2 |a l|`: it does not grow with `k`,
//! as it would if the two parts of the logarithm were added first.

// Short functions that are meaningless unless merged into the loop that calls them.
#![allow(clippy::inline_always)]

use super::instructions::Target;
use super::polynomial::polynomial;

/// How `k` and `z` are taken from the bits of a number: the bits of `sqrt(1/2)`, and where the fraction is.
const LOWEST: u64 = 0x3fe6_a09e_667f_3bcd;
const FRACTION: u64 = (1 << 52) - 1;
/// Added to the bits of a number, it leaves `k + ORDINARY`, modulo `2^12`, in the place of the exponent.
const SHIFT: u64 = (ORDINARY << 52).wrapping_sub(LOWEST);

/// `2^52`: its last bits count ones.
const COUNTS_ONES: f64 = 4_503_599_627_370_496.0;
/// Added to a number below `2^51` in size, it leaves the nearest whole number in the last bits.
pub(super) const ROUNDS: f64 = 1.5 * COUNTS_ONES;
/// The exponent of one as it is stored.
const BIAS: u64 = 1023;

/// Numbers and powers between `2^-512` and `2^512` take the short way. It leaves out what is needed for numbers that are
/// subnormal, infinite or not numbers, and for powers that overflow or underflow.
const ORDINARY: u64 = 512;

/// Bits that are set in an unusual [`Logarithm::key`] or [`Raised::key`] and never in an ordinary one.
pub(super) const UNUSUAL: u64 = !(2 * ORDINARY - 1);

/// No power is finite and not zero beyond this exponent of two.
const BEYOND: f64 = 1100.0;

/// `P` of (1).
const P: [f64; 8] = [
    f64::from_bits(0x4007_1547_652b_82fe),
    f64::from_bits(0x3fee_c709_dc3a_062a),
    f64::from_bits(0x3fe2_776c_50eb_d140),
    f64::from_bits(0x3fda_6176_3075_bcca),
    f64::from_bits(0x3fd4_84ae_ba27_0fa6),
    f64::from_bits(0x3fd0_ca42_1afc_1f77),
    f64::from_bits(0x3fcc_3f12_ebc8_68d4),
    f64::from_bits(0x3fcb_9ff1_18d0_cc49),
];

/// `Q` of (3).
const Q: [f64; 11] = [
    f64::from_bits(0x3fe6_2e42_fefa_39ef),
    f64::from_bits(0x3fce_bfbd_ff82_c5a6),
    f64::from_bits(0x3fac_6b08_d704_a12c),
    f64::from_bits(0x3f83_b2ab_6fb9_fda6),
    f64::from_bits(0x3f55_d87f_e789_e96f),
    f64::from_bits(0x3f24_3091_30f6_cbde),
    f64::from_bits(0x3eef_fcbf_c668_5ef3),
    f64::from_bits(0x3eb6_2bfc_6596_ae43),
    f64::from_bits(0x3e7b_5252_2bc1_be43),
    f64::from_bits(0x3e3e_61d4_334a_5775),
    f64::from_bits(0x3dfe_9731_78d3_5d07),
];

/// A logarithm to base two, in parts.
pub(super) struct Logarithm {
    /// `k`
    pub(super) whole: f64,
    /// `l`
    pub(super) part: f64,
    /// Says whether the number was an ordinary one, see [`UNUSUAL`].
    pub(super) key: u64,
}

/// (1) for an ordinary number, or zero for one that is not positive.
#[inline(always)]
pub(super) fn logarithm<T: Target>(x: f64) -> Logarithm {
    normal_logarithm::<T, false>(x)
}

/// (1) for a number that is not subnormal; `ANY`: for those that are not ordinary too.
#[inline(always)]
fn normal_logarithm<T: Target, const ANY: bool>(x: f64) -> Logarithm {
    let x = if x <= 0.0 { 1.0 } else { x };
    let shifted = x.to_bits().wrapping_add(SHIFT);
    let exponent = shifted >> 52;
    let k = f64::from_bits(exponent | COUNTS_ONES.to_bits()) - (COUNTS_ONES + ORDINARY as f64);
    let k = if ANY && exponent >= 2048 {
        k - 4096.0
    } else {
        k
    };
    let z = f64::from_bits((shifted & FRACTION).wrapping_add(LOWEST));
    let s = (z - 1.0) / (z + 1.0);
    Logarithm {
        whole: k,
        part: s * polynomial::<T, 8>(&P, s * s),
        key: exponent,
    }
}

/// (1) for any number: minus infinity is never asked for, zero for one that is not positive.
#[inline(always)]
pub(super) fn careful_logarithm<T: Target>(x: f64) -> Logarithm {
    const SCALE: f64 = (1_u64 << 54) as f64;
    let subnormal = x < f64::MIN_POSITIVE;
    let scaled = if subnormal { x * SCALE } else { x };
    let mut log = normal_logarithm::<T, true>(scaled);
    let correction = if subnormal && x > 0.0 { 54.0 } else { 0.0 };
    // An infinite number, and what is not a number, is its own logarithm.
    let own = x == f64::INFINITY || x.is_nan();
    log.whole = if own { x } else { log.whole - correction };
    log.part = if own { 0.0 } else { log.part };
    log
}

/// The exponent of a batch of powers.
#[derive(Clone, Copy)]
pub(super) struct Exponent {
    value: f64,
    /// Its leading 41 bits, whose product with a whole number below `2^11` is exact.
    high: f64,
    low: f64,
}

impl Exponent {
    pub(super) fn new(value: f64) -> Self {
        let high = f64::from_bits(value.to_bits() & !0xfff);
        let low = value - high;
        Self { value, high, low }
    }
}

/// A power.
pub(super) struct Raised {
    pub(super) power: f64,
    /// Says whether it is an ordinary one, see [`UNUSUAL`].
    pub(super) key: u64,
}

/// (2) and (3) for an ordinary power.
#[inline(always)]
pub(super) fn raise<T: Target>(exponent: &Exponent, [whole, part]: [f64; 2]) -> Raised {
    let Reduced { rounded, r, .. } = reduce::<T>(exponent, [whole, part]);
    let fraction = power_of_two::<T>(r);
    let bits = rounded.to_bits();
    Raised {
        power: f64::from_bits(fraction.to_bits().wrapping_add(bits << 52)),
        key: bits.wrapping_sub(ROUNDS.to_bits() - ORDINARY),
    }
}

/// (2) and (3) for any power.
#[inline(always)]
pub(super) fn careful_raise<T: Target>(exponent: &Exponent, [whole, part]: [f64; 2]) -> Raised {
    let infinite = whole + part == f64::INFINITY;
    let reduced = reduce::<T>(exponent, [whole, part]);
    // A product with an infinite logarithm may be the difference of two infinite ones when it is taken in parts.
    let y = if infinite {
        exponent.value * f64::INFINITY
    } else {
        reduced.y
    };
    let within = y.abs() <= BEYOND;
    let n = if within {
        reduced.rounded - ROUNDS
    } else if y > 0.0 {
        BEYOND
    } else {
        -BEYOND
    };
    let r = if within { reduced.r } else { 0.0 };
    // In two halves, each of which is a number where the whole is not.
    let half = (0.5 * n + ROUNDS) - ROUNDS;
    let power = power_of_two::<T>(r) * scale(half) * scale(n - half);
    let power = if y.is_nan() { y } else { power };
    Raised { power, key: 0 }
}

/// `2^n` for a whole number between -1022 and 1023.
#[inline(always)]
fn scale(n: f64) -> f64 {
    f64::from_bits((n + (ROUNDS + BIAS as f64)).to_bits() << 52)
}

/// The arguments of (3).
struct Reduced {
    /// `a k + a l`
    y: f64,
    /// `n + ROUNDS`
    rounded: f64,
    r: f64,
}

#[inline(always)]
fn reduce<T: Target>(exponent: &Exponent, [whole, part]: [f64; 2]) -> Reduced {
    let a = exponent.value;
    if T::FUSED {
        let of_part = a * part;
        let y = a.mul_add(whole, of_part);
        let rounded = y + ROUNDS;
        let r = a.mul_add(whole, ROUNDS - rounded) + of_part;
        return Reduced { y, rounded, r };
    }
    let of_whole = exponent.high * whole;
    let rest = a * part + exponent.low * whole;
    let y = of_whole + rest;
    let rounded = y + ROUNDS;
    let r = (of_whole - (rounded - ROUNDS)) + rest;
    Reduced { y, rounded, r }
}

/// (3)
#[inline(always)]
fn power_of_two<T: Target>(r: f64) -> f64 {
    T::add_product(r, polynomial::<T, 11>(&Q, r), 1.0)
}
