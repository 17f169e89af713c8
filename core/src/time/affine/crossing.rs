//! The first zero of a polynomial in a cell, proven to be the first.
//!
//! For a distance `d` with `d >= 0` at the left end and a bound on its derivatives, an interval of half width `w` about `m` is
//! decided by the first of
//!
//! ```text
//! d(m) - |d'(m)| w - b2 w^2 / 2 > 0                          no zero                                         (1)
//! |d'(m)| > b2 w                                             monotone: one zero or none, as the ends say     (2)
//! d''(m) + b3 w < 0 and d >= 0 at the left end               concave: the same                               (3)
//! ```
//!
//! and is divided otherwise, the left half first. Here `b2 = |d''(m)| + b3 w` bounds the second derivative and `b3` the third.
//! Where a zero is known to be single it is found by Newton's method, [guarded](Guarded) by the bracket. A touch, whose depth is below
//! the rounding error of the distance, is no crossing.

use super::table::{COEFFICIENTS, Polynomial};
use crate::numeric::roots::{Guarded, STEPS};

/// Where a distance falls below zero first in `[from, to]`, both within half a cell of its middle. `begins`: it begins at zero,
/// and that zero does not count. `noise` is its rounding error.
pub(super) fn first_zero(
    p: &Polynomial,
    from: f64,
    to: f64,
    begins: bool,
    noise: f64,
) -> Option<f64> {
    if to <= from || p.iter().any(|x| !x.is_finite()) {
        return None;
    }
    let mut p = *p;
    if begins {
        p[0] -= value(&p, from);
    } else if value(&p, from) < 0.0 {
        return Some(from);
    }
    if p[1].abs() <= slope_variation(&p) {
        return divide(&p, from, to, noise);
    }
    // Monotone over the whole cell: (2).
    if p[1] > 0.0 {
        None
    } else if begins {
        Some(from)
    } else {
        (value(&p, to) < 0.0).then(|| newton(&p, from, to))
    }
}

/// A bound on the change of the slope between the middle and the ends of the cell.
pub(super) fn slope_variation(p: &Polynomial) -> f64 {
    let mut sum = 0.0;
    let mut power = 0.5;
    for k in 2..COEFFICIENTS {
        sum += k as f64 * p[k].abs() * power;
        power *= 0.5;
    }
    sum
}

/// A bound on the third derivative within the cell.
fn third_derivative_bound(p: &Polynomial) -> f64 {
    let mut sum = 0.0;
    let mut power = 1.0;
    for k in 3..COEFFICIENTS {
        sum += (k * (k - 1) * (k - 2)) as f64 * p[k].abs() * power;
        power *= 0.5;
    }
    sum
}

/// Divides an interval until every part is decided.
fn divide(p: &Polynomial, from: f64, to: f64, noise: f64) -> Option<f64> {
    let third = third_derivative_bound(p);
    let mut left = from;
    // The right ends of parts that wait, the next one last.
    let mut waiting = [0.0; 64];
    waiting[0] = to;
    let mut count = 1;
    while count > 0 {
        let right = waiting[count - 1];
        let middle = 0.5 * (left + right);
        match decide(p, left, right, third, noise) {
            Decision::None => {
                left = right;
                count -= 1;
            }
            Decision::One => return Some(newton(p, left, right)),
            Decision::Open if count < waiting.len() && left < middle && middle < right => {
                waiting[count] = middle;
                count += 1;
            }
            Decision::Open => {
                if value(p, right) < 0.0 {
                    return Some(right);
                }
                left = right;
                count -= 1;
            }
        }
    }
    None
}

/// What is known of an interval.
enum Decision {
    None,
    One,
    Open,
}

fn decide(p: &Polynomial, left: f64, right: f64, third: f64, noise: f64) -> Decision {
    let (middle, w) = (0.5 * (left + right), 0.5 * (right - left));
    let [d, slope, curvature] = derivatives(p, middle);
    let second = curvature.abs() + third * w;
    if d - slope.abs() * w - 0.5 * second * w * w >= -noise {
        return Decision::None;
    }
    let monotone = slope.abs() > second * w;
    let concave = curvature + third * w < 0.0;
    if monotone || concave {
        return if value(p, right) < 0.0 {
            Decision::One
        } else {
            Decision::None
        };
    }
    Decision::Open
}

/// The value at a phase.
pub(super) fn value(p: &Polynomial, s: f64) -> f64 {
    p.iter().rev().fold(0.0, |sum, x| sum * s + x)
}

/// Value and derivative.
pub(super) fn value_and_slope(p: &Polynomial, s: f64) -> (f64, f64) {
    p.iter().rev().fold((0.0, 0.0), |(value, slope), x| {
        (value * s + x, slope * s + value)
    })
}

/// Value and two derivatives.
pub(super) fn derivatives(p: &Polynomial, s: f64) -> [f64; 3] {
    let [d, slope, half] = p.iter().rev().fold([0.0; 3], |[d, d1, d2], x| {
        [d * s + x, d1 * s + d, d2 * s + d1]
    });
    [d, slope, 2.0 * half]
}

/// The zero between two ends of which the right one is negative; the left one is not, or the zero at it does not count.
fn newton(p: &Polynomial, left: f64, right: f64) -> f64 {
    let mut bracket = Guarded::new(left, right);
    // From the right end: if the distance is concave, the zero that counts is the nearest.
    let mut s = right;
    for _ in 0..STEPS {
        let (d, slope) = value_and_slope(p, s);
        bracket.cut(s, d >= 0.0);
        let step = -d / slope;
        if step.abs() <= f64::EPSILON || bracket.width() <= f64::EPSILON {
            break;
        }
        (s, _) = bracket.next(s, step);
    }
    s
}
