//! Logarithms and powers of arrays: loops over [`functions`](super::functions), compiled for every instruction set.
//!
//! A loop takes the short way and notices unusual numbers; if there was one, a second loop goes over the array again. Both
//! compute the same where the short way is right, so a number's power does not depend on its neighbours.

// The loops are merged into one function for each instruction set.
#![allow(clippy::inline_always)]

use super::Accuracy;
use super::functions::{
    Exponent, Logarithm, Raised, UNUSUAL, careful_logarithm, careful_raise, logarithm, raise,
};
use super::instructions::{Available, Work};

/// An array whose length is a multiple of this is computed without a slow rest.
pub(crate) const LANES: usize = 8;

/// Logarithms to base two of an array of bases, in two parts that are to be added; zero where a base is not positive. All
/// arrays have one length.
pub(crate) fn logarithms(set: Available, accuracy: Accuracy, base: &[f64], parts: [&mut [f64]; 2]) {
    match accuracy {
        Accuracy::Full => set.run(Logarithms::<false> { base, parts }),
        Accuracy::Fast => set.run(Logarithms::<true> { base, parts }),
    }
}

/// Powers of an array of bases from their logarithms and, if asked for, those of an exponent one higher. A base that is
/// not positive counts as zero. All arrays have one length.
pub(crate) fn powers(
    set: Available,
    accuracy: Accuracy,
    of: Bases<'_>,
    exponent: f64,
    power: &mut [f64],
    next: Option<&mut [f64]>,
) {
    if exponent == 0.0 {
        power.fill(1.0);
        if let Some(next) = next {
            multiply(set, of.base, power, next);
        }
        return;
    }
    match (accuracy, next) {
        (Accuracy::Full, None) => set.run(Powers::<false> {
            of,
            exponent,
            power,
        }),
        (Accuracy::Fast, None) => set.run(Powers::<true> {
            of,
            exponent,
            power,
        }),
        (Accuracy::Full, Some(next)) => {
            let powers = Powers::<false> {
                of,
                exponent,
                power,
            };
            set.run(TwoPowers { powers, next });
        }
        (Accuracy::Fast, Some(next)) => {
            let powers = Powers::<true> {
                of,
                exponent,
                power,
            };
            set.run(TwoPowers { powers, next });
        }
    }
}

/// Powers of an exponent one higher. A base that is not positive counts as zero. All arrays have one length.
pub(crate) fn multiply(set: Available, base: &[f64], power: &[f64], next: &mut [f64]) {
    set.run_short(Products { base, power, next });
}

/// Bases, and their logarithms in two parts.
#[derive(Clone, Copy)]
pub(crate) struct Bases<'a> {
    pub(crate) base: &'a [f64],
    pub(crate) whole: &'a [f64],
    pub(crate) part: &'a [f64],
}

struct Logarithms<'a, const FAST: bool> {
    base: &'a [f64],
    parts: [&'a mut [f64]; 2],
}

impl<const FAST: bool> Work for Logarithms<'_, FAST> {
    #[inline(always)]
    fn run<const FUSED: bool>(self) {
        let Self {
            base,
            parts: [whole, part],
        } = self;
        let keys = each_logarithm(base, whole, part, logarithm::<FUSED, FAST>);
        if keys & UNUSUAL != 0 {
            each_logarithm(base, whole, part, careful_logarithm::<FUSED, FAST>);
        }
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

struct Powers<'a, const FAST: bool> {
    of: Bases<'a>,
    exponent: f64,
    power: &'a mut [f64],
}

impl<const FAST: bool> Work for Powers<'_, FAST> {
    #[inline(always)]
    fn run<const FUSED: bool>(self) {
        let Self {
            of,
            exponent,
            power,
        } = self;
        let exponent = Exponent::new(exponent);
        let keys = each_power(of, power, |log| raise::<FUSED, FAST>(&exponent, log));
        if keys & UNUSUAL != 0 {
            each_power(of, power, |log| {
                careful_raise::<FUSED, FAST>(&exponent, log)
            });
        }
    }
}

#[inline(always)]
fn each_power(of: Bases<'_>, power: &mut [f64], raise: impl Fn([f64; 2]) -> Raised) -> u64 {
    let count = of.base.len();
    let (whole, part, power) = (&of.whole[..count], &of.part[..count], &mut power[..count]);
    let mut keys = 0;
    for i in 0..count {
        let raised = raise([whole[i], part[i]]);
        power[i] = if of.base[i] <= 0.0 { 0.0 } else { raised.power };
        keys |= raised.key;
    }
    keys
}

struct TwoPowers<'a, const FAST: bool> {
    powers: Powers<'a, FAST>,
    next: &'a mut [f64],
}

impl<const FAST: bool> Work for TwoPowers<'_, FAST> {
    #[inline(always)]
    fn run<const FUSED: bool>(self) {
        let Self {
            powers:
                Powers {
                    of,
                    exponent,
                    power,
                },
            next,
        } = self;
        let exponent = Exponent::new(exponent);
        let keys = each_two(of, power, next, |log| raise::<FUSED, FAST>(&exponent, log));
        if keys & UNUSUAL != 0 {
            each_two(of, power, next, |log| {
                careful_raise::<FUSED, FAST>(&exponent, log)
            });
        }
    }
}

#[inline(always)]
fn each_two(
    of: Bases<'_>,
    power: &mut [f64],
    next: &mut [f64],
    raise: impl Fn([f64; 2]) -> Raised,
) -> u64 {
    let count = of.base.len();
    let (whole, part) = (&of.whole[..count], &of.part[..count]);
    let (power, next) = (&mut power[..count], &mut next[..count]);
    let mut keys = 0;
    for i in 0..count {
        let (base, raised) = (of.base[i], raise([whole[i], part[i]]));
        power[i] = if base <= 0.0 { 0.0 } else { raised.power };
        next[i] = if base <= 0.0 {
            0.0
        } else {
            raised.power * base
        };
        keys |= raised.key;
    }
    keys
}

struct Products<'a> {
    base: &'a [f64],
    power: &'a [f64],
    next: &'a mut [f64],
}

impl Work for Products<'_> {
    #[inline(always)]
    fn run<const FUSED: bool>(self) {
        let Self { base, power, next } = self;
        for ((next, &power), &base) in next.iter_mut().zip(power).zip(base) {
            *next = if base <= 0.0 { 0.0 } else { power * base };
        }
    }
}
