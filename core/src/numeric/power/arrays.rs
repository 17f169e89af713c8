//! Logarithms, powers and cube roots of arrays: loops over [`functions`](super::functions), to be merged into
//! [`Work`](super::Work) that is compiled for every instruction set.
//!
//! A loop takes the short way and notices unusual numbers; if there was one, a second loop goes over the array again. Both
//! compute the same where the short way is right, so a number's power does not depend on its neighbours.
//!
//! All arrays of a call have one length. Where it is a multiple of [`LANES`], there is no slow rest.

// Meaningless unless merged into the work that calls them.
#![allow(clippy::inline_always)]

use super::cube_root::cube_root;
use super::functions::{
    Exponent, Logarithm, Raised, UNUSUAL, careful_logarithm, careful_raise, logarithm, raise,
};
use super::instructions::Target;

/// The longest vectors have this many numbers.
pub(crate) const LANES: usize = 8;

/// Bases, and their logarithms to base two in two parts that are to be added.
#[derive(Clone, Copy)]
pub(crate) struct Bases<'a> {
    pub(crate) base: &'a [f64],
    pub(crate) whole: &'a [f64],
    pub(crate) part: &'a [f64],
}

/// Logarithms to base two, in two parts; zero where a base is not positive.
#[inline(always)]
pub(crate) fn logarithms<T: Target>(base: &[f64], whole: &mut [f64], part: &mut [f64]) {
    let keys = each_logarithm(base, whole, part, logarithm::<T>);
    if keys & UNUSUAL != 0 {
        each_logarithm(base, whole, part, careful_logarithm::<T>);
    }
}

/// All keys, one over the other.
#[inline(always)]
fn each_logarithm(
    base: &[f64],
    whole: &mut [f64],
    part: &mut [f64],
    logarithm: impl Fn(f64) -> Logarithm,
) -> u64 {
    let count = base.len();
    let (whole, part) = (&mut whole[..count], &mut part[..count]);
    let mut keys = 0;
    for i in 0..count {
        let log = logarithm(base[i]);
        whole[i] = log.whole;
        part[i] = log.part;
        keys |= log.key;
    }
    keys
}

/// Powers. That of a base that is not positive is some number.
#[inline(always)]
pub(crate) fn powers<T: Target>(of: Bases<'_>, exponent: f64, power: &mut [f64]) {
    if exponent == 0.0 {
        power.fill(1.0);
        return;
    }
    let exponent = Exponent::new(exponent);
    let keys = each_power(
        of,
        power,
        #[inline(always)]
        |log| raise::<T>(&exponent, log),
    );
    if keys & UNUSUAL != 0 {
        each_power(
            of,
            power,
            #[inline(always)]
            |log| careful_raise::<T>(&exponent, log),
        );
    }
}

#[inline(always)]
fn each_power(of: Bases<'_>, power: &mut [f64], raise: impl Fn([f64; 2]) -> Raised) -> u64 {
    let count = of.base.len();
    let (whole, part, power) = (&of.whole[..count], &of.part[..count], &mut power[..count]);
    let mut keys = 0;
    for i in 0..count {
        let raised = raise([whole[i], part[i]]);
        power[i] = raised.power;
        keys |= raised.key;
    }
    keys
}

/// Powers, and those of an exponent one higher, which is positive. Those of a base that is not positive are some numbers.
#[inline(always)]
pub(crate) fn two_powers<T: Target>(
    of: Bases<'_>,
    exponent: f64,
    power: &mut [f64],
    next: &mut [f64],
) {
    if exponent == 0.0 {
        power.fill(1.0);
        multiply(of.base, power, next);
        return;
    }
    let exponent = Exponent::new(exponent);
    let keys = each_two(
        of,
        power,
        next,
        #[inline(always)]
        |log| raise::<T>(&exponent, log),
        #[inline(always)]
        |power, base| power * base,
    );
    if keys & UNUSUAL != 0 {
        each_two(
            of,
            power,
            next,
            #[inline(always)]
            |log| careful_raise::<T>(&exponent, log),
            times,
        );
    }
}

#[inline(always)]
fn each_two(
    of: Bases<'_>,
    power: &mut [f64],
    next: &mut [f64],
    raise: impl Fn([f64; 2]) -> Raised,
    times: impl Fn(f64, f64) -> f64,
) -> u64 {
    let count = of.base.len();
    let (whole, part) = (&of.whole[..count], &of.part[..count]);
    let (power, next) = (&mut power[..count], &mut next[..count]);
    let mut keys = 0;
    for i in 0..count {
        let (base, raised) = (of.base[i], raise([whole[i], part[i]]));
        power[i] = raised.power;
        next[i] = times(raised.power, base);
        keys |= raised.key;
    }
    keys
}

/// Powers of an exponent one higher, which is positive.
#[inline(always)]
pub(crate) fn multiply(base: &[f64], power: &[f64], next: &mut [f64]) {
    for ((next, &power), &base) in next.iter_mut().zip(power).zip(base) {
        *next = times(power, base);
    }
}

/// The product of a power and its base, to an exponent that is positive: infinite where the base is, though the power may be
/// zero there.
#[inline(always)]
fn times(power: f64, base: f64) -> f64 {
    if base == f64::INFINITY {
        base
    } else {
        power * base
    }
}

/// Cube roots. That of a base that is negative is some number.
#[inline(always)]
pub(crate) fn cube_roots<T: Target>(base: &[f64], root: &mut [f64]) {
    // Two halves at once: a root is a chain of operations that wait for each other.
    let half = base.len() / 2;
    let ((first, second), (to_first, to_second)) =
        (base.split_at(half), root[..base.len()].split_at_mut(half));
    let (middle, to_middle) = (&second[..half], &mut to_second[..half]);
    for i in 0..half {
        to_first[i] = cube_root::<T>(first[i]);
        to_middle[i] = cube_root::<T>(middle[i]);
    }
    for (root, &base) in to_second[half..].iter_mut().zip(&second[half..]) {
        *root = cube_root::<T>(base);
    }
}
