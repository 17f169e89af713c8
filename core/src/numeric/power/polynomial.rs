//! Polynomials `c_0 + c_1 x + c_2 x^2 + ...`, in the order that is fastest for a target.
//!
//! ```text
//! Horner            c_0 + x (c_1 + x (c_2 + ...))                                       fewest operations    (1)
//! even and odd      c_0 + x (c_1 + ...), the rest as p(x^2) + x q(x^2)                  two chains           (2)
//! Estrin            c_0 + x ((c_1 + c_2 x + (c_3 + c_4 x) x^2) + x^4 (...))             shortest chains      (3)
//! ```
//!
//! In all of them `c_0` comes last, so that one rounding only is of the size of the whole.
//!
//! Source: Muller (2016), Elementary Functions, 3rd ed., ch. 5.

// Meaningless unless merged into the loops that call them.
#![allow(clippy::inline_always)]

use super::instructions::{Order, Target};

#[inline(always)]
pub(super) fn polynomial<T: Target, const N: usize>(c: &[f64; N], x: f64) -> f64 {
    match T::ORDER {
        Order::Horner => down_to_first::<T, N>(c, x, c[N - 1], N - 1),
        Order::EvenAndOdd => even_and_odd::<T, N>(c, x),
        Order::Estrin => estrin::<T, N>(c, x),
    }
}

/// (1) from a sum that begins with the coefficient at `lowest`.
#[inline(always)]
fn down_to_first<T: Target, const N: usize>(
    c: &[f64; N],
    x: f64,
    above: f64,
    lowest: usize,
) -> f64 {
    let mut sum = above;
    for coefficient in c[..lowest].iter().rev() {
        sum = T::add_product(sum, x, *coefficient);
    }
    sum
}

/// (2)
#[inline(always)]
fn even_and_odd<T: Target, const N: usize>(c: &[f64; N], x: f64) -> f64 {
    let square = x * x;
    let (mut above, mut sum) = (c[N - 1], c[N - 2]);
    // `sum` begins with the coefficient at `lowest`, `above` with the one after it.
    let mut lowest = N - 2;
    while lowest > 2 {
        sum = T::add_product(sum, square, c[lowest - 2]);
        above = T::add_product(above, square, c[lowest - 1]);
        lowest -= 2;
    }
    down_to_first::<T, N>(c, x, T::add_product(above, x, sum), lowest)
}

/// (3)
#[inline(always)]
fn estrin<T: Target, const N: usize>(c: &[f64; N], x: f64) -> f64 {
    let square = x * x;
    let fourth = square * square;
    let mut first = 1 + (N - 2) / 4 * 4;
    let mut sum = four::<T, N>(c, first, x, square);
    while first > 1 {
        first -= 4;
        sum = T::add_product(sum, fourth, four::<T, N>(c, first, x, square));
    }
    T::add_product(sum, x, c[0])
}

/// The terms of four coefficients, or of those that there are.
#[inline(always)]
fn four<T: Target, const N: usize>(c: &[f64; N], first: usize, x: f64, square: f64) -> f64 {
    let two = |at: usize| {
        if at + 1 < N {
            T::add_product(c[at + 1], x, c[at])
        } else {
            c[at]
        }
    };
    if first + 2 < N {
        T::add_product(two(first + 2), square, two(first))
    } else {
        two(first)
    }
}
