//! Where a polynomial first falls below zero.
//!
//! In Bernstein form `sum_i c_i (n choose i) u^i (1-u)^(n-i)` a polynomial on `[0, 1]` lies within the hull of its
//! coefficients, and has at most as many zeros as they have changes of sign. So no zero is missed, however close it is to
//! another one.
//!
//! A zero that is the only one takes ten values of the polynomial, which go by Horner's rule in `t = u/(1-u)` (1), or in `1/t` (2) in the other half:
//!
//! ```text
//! sum_i c_i (n choose i) u^i (1-u)^(n-i) = (1-u)^n sum_i b_i t^i,    b_i = (n choose i) c_i       (1)
//!                                        = u^n sum_i b_(n-i) t^-i                                 (2)
//! ```
//!
//! Sources: Lane and Riesenfeld (1981), Bounds on a polynomial, BIT 21, 112-117. Farin (2002), Curves and Surfaces for CAGD, section 5.

use crate::numeric::roots::{self, Place};

/// More coefficients than any rule has.
pub(super) const MOST: usize = 32;

/// Accuracy of a zero, in parts of the interval.
const LOCATED: f64 = 1e-13;

/// Halvings after which two zeros are taken as one.
const DEEPEST: usize = 40;

/// The first zero of a polynomial that is positive at the start; zero itself if it is negative there.
pub(super) fn first(coefficients: &[f64]) -> Option<f64> {
    let mut room = [0.0; MOST];
    let c = &mut room[..coefficients.len()];
    c.copy_from_slice(coefficients);
    search(c, [0.0, 1.0], 0)
}

/// The same on the part from `start` to `end`, where the coefficients are `c`.
fn search(c: &[f64], [start, end]: [f64; 2], depth: usize) -> Option<f64> {
    if c[0] <= 0.0 {
        return Some(start);
    }
    let changes: usize = c
        .windows(2)
        .map(|pair| usize::from((pair[0] > 0.0) != (pair[1] > 0.0)))
        .sum();
    if changes == 0 {
        return None;
    }
    if changes == 1 {
        return Some(start + (end - start) * only(c));
    }
    let middle = 0.5 * (start + end);
    if depth == DEEPEST {
        return (value(c, 0.5) <= 0.0).then_some(middle);
    }
    let (mut left, mut right) = ([0.0; MOST], [0.0; MOST]);
    let (left, right) = (&mut left[..c.len()], &mut right[..c.len()]);
    halve(c, left, right);
    search(left, [start, middle], depth + 1).or_else(|| search(right, [middle, end], depth + 1))
}

/// The only zero, from the side where the polynomial is not positive.
fn only(c: &[f64]) -> f64 {
    let degree = c.len() - 1;
    let mut room = [0.0; MOST];
    let weighted = &mut room[..c.len()];
    for ((b, c), binomial) in weighted.iter_mut().zip(c).zip(&BINOMIALS[degree]) {
        *b = c * binomial;
    }
    let value = |u: f64| {
        let left = 1.0 - u;
        if u <= 0.5 {
            left.powi(degree as i32) * horner(weighted.iter().rev(), u / left)
        } else {
            u.powi(degree as i32) * horner(weighted.iter(), left / u)
        }
    };
    let [a, b] = [(0.0, c[0]), (1.0, c[degree])].map(|(x, value)| Place { x, value });
    roots::closed(a, b, LOCATED, value).map_or(1.0, |bracket| bracket.end(false))
}

/// A polynomial by Horner's rule, from the coefficient of its highest power.
fn horner<'c>(coefficients: impl Iterator<Item = &'c f64>, t: f64) -> f64 {
    coefficients.fold(0.0, |sum, b| sum * t + b)
}

/// `n choose i`: whole numbers below `2^53`.
const BINOMIALS: [[f64; MOST]; MOST] = {
    let mut rows = [[0.0; MOST]; MOST];
    let mut n = 0;
    while n < MOST {
        rows[n][0] = 1.0;
        let mut i = 1;
        while i <= n {
            rows[n][i] = rows[n - 1][i - 1] + rows[n - 1][i];
            i += 1;
        }
        n += 1;
    }
    rows
};

/// The polynomial's value, by de Casteljau's scheme.
pub(super) fn value(c: &[f64], u: f64) -> f64 {
    let mut room = [0.0; MOST];
    room[..c.len()].copy_from_slice(c);
    for last in (1..c.len()).rev() {
        for i in 0..last {
            room[i] += u * (room[i + 1] - room[i]);
        }
    }
    room[0]
}

/// The coefficients on both halves.
fn halve(c: &[f64], left: &mut [f64], right: &mut [f64]) {
    right.copy_from_slice(c);
    for i in 0..c.len() {
        left[i] = right[0];
        for j in 0..c.len() - 1 - i {
            right[j] = 0.5 * (right[j] + right[j + 1]);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Bernstein coefficients of degree four of `s (u - a)^2 + d`.
    fn parabola(s: f64, a: f64, d: f64) -> [f64; 5] {
        std::array::from_fn(|i| {
            let i = i as f64;
            let (linear, square) = (i / 4.0, i * (i - 1.0) / 12.0);
            s * (square - 2.0 * a * linear + a * a) + d
        })
    }

    #[test]
    fn pairs_of_zeros_are_found_however_close() {
        for d in [0.04_f64, 1e-4, 1e-8, 1e-12] {
            let root = first(&parabola(1.0, 0.37, -d)).unwrap();
            assert!((root - (0.37 - d.sqrt())).abs() < 1e-3 * d.sqrt(), "{d}");
        }
        for d in [0.04, 1e-4, 1e-8, 1e-12] {
            assert_eq!(first(&parabola(1.0, 0.37, d)), None);
        }
    }

    /// The value by Horner's rule and that by de Casteljau's scheme have the same zero, in either half, up to the highest degree.
    #[test]
    fn both_ways_to_a_value_have_the_same_zero() {
        for count in [2, 3, 9, 17, MOST] {
            for zero in [1e-6, 0.2, 0.5, 0.7, 1.0 - 1e-6] {
                // `zero - u`, with its degree raised.
                let c: Vec<f64> = (0..count)
                    .map(|i| zero - i as f64 / (count - 1) as f64)
                    .collect();
                let u = first(&c).unwrap();
                assert!((u - zero).abs() < 2e-13, "{count} {zero}: {u}");
                assert!(value(&c, u).abs() < 2e-13, "{count} {zero}: {u}");
            }
        }
    }

    #[test]
    fn single_zeros_are_found() {
        let root = first(&parabola(-1.0, -0.5, 1.0)).unwrap();
        assert!((root - 0.5).abs() < 1e-13);
        assert_eq!(first(&[-1.0, 2.0, 3.0]), Some(0.0));
        assert_eq!(first(&[1.0, 2.0, 3.0]), None);
    }
}
