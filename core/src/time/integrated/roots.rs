//! Where a polynomial first falls below zero.
//!
//! In Bernstein form `sum_i c_i (n choose i) u^i (1-u)^(n-i)` a polynomial on `[0, 1]` lies within the hull of its
//! coefficients, and has at most as many zeros as they have changes of sign. So no zero is missed, however close it is to
//! another one.
//!
//! Source: Lane and Riesenfeld (1981), Bounds on a polynomial, BIT 21, 112-117.

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
    let [a, b] = [(0.0, c[0]), (1.0, c[c.len() - 1])].map(|(x, value)| Place { x, value });
    roots::closed(a, b, LOCATED, |u| value(c, u)).map_or(1.0, |bracket| bracket.end(false))
}

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

    #[test]
    fn single_zeros_are_found() {
        let root = first(&parabola(-1.0, -0.5, 1.0)).unwrap();
        assert!((root - 0.5).abs() < 1e-13);
        assert_eq!(first(&[-1.0, 2.0, 3.0]), Some(0.0));
        assert_eq!(first(&[1.0, 2.0, 3.0]), None);
    }
}
