//! Locating where a test function vanishes between two points of a curve.
//!
//! The curve between them is parametrised by the arc length `s` of the chord's first tangent; every value of the test
//! function is taken at a corrected solution. The root is bracketed and found by the method of Dowell and Jarratt
//! (1971), "A modified regula falsi method for computing the root of an equation" (the Illinois rule), with bisection
//! whenever it does not halve the bracket.

use super::follow::CurvePoint;
use super::problem::Problem;
use crate::newton::{Border, Newton, NewtonOptions};

/// A point where the test function vanishes.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Located {
    pub(crate) point: CurvePoint,
    /// Value of the test function there.
    pub(crate) test: f64,
    /// Whether it was driven to zero; otherwise it jumps here.
    pub(crate) vanishes: bool,
}

/// Where a test function changes sign between `a` and `b`: its zero, or the place where it jumps.
///
/// `None` if a correction fails on the way, or a tangent is not that of the whole system.
pub(crate) fn locate<P: Problem>(
    problem: &mut P,
    newton: &mut Newton,
    (a, b): (&CurvePoint, &CurvePoint),
    options: NewtonOptions,
    tolerance: f64,
    test: impl Fn(&CurvePoint) -> f64,
) -> Option<Located> {
    let difference: Vec<f64> = b.u.iter().zip(&a.u).map(|(x, y)| x - y).collect();
    let length = newton.norm().product(a.scale, &a.tangent, &difference);
    let mut border = vec![0.0; a.u.len()];
    newton.norm().linear_form(a.scale, &a.tangent, &mut border);
    let origin = crate::linear::dot(&border, &a.u);
    let mut low = (0.0, test(a), a.clone());
    let mut high = (length, test(b), b.clone());
    let mut bisect = false;
    for _ in 0..100 {
        let width = high.0 - low.0;
        let secant = low.0 - low.1 * width / (high.1 - low.1);
        let inside = secant > low.0 && secant < high.0;
        let s = if bisect || !inside {
            0.5 * (low.0 + high.0)
        } else {
            secant
        };
        let point = corrected(problem, newton, &low, &high, s, (&border, origin), options)?;
        let value = test(&point);
        if value.abs() <= tolerance {
            return Some(Located {
                point,
                test: value,
                vanishes: true,
            });
        }
        if value * low.1 > 0.0 {
            if s - low.0 < 0.5 * width {
                high.1 *= 0.5;
            }
            low = (s, value, point);
        } else {
            if high.0 - s < 0.5 * width {
                low.1 *= 0.5;
            }
            high = (s, value, point);
        }
        bisect = high.0 - low.0 > 0.5 * width;
        if high.0 - low.0 <= 1e-14 * length.abs() {
            break;
        }
    }
    Some(Located {
        vanishes: false,
        test: test(&low.2),
        point: low.2,
    })
}

/// The solution at arc length `s`, from the interpolation between two known ones.
fn corrected<P: Problem>(
    problem: &mut P,
    newton: &mut Newton,
    low: &(f64, f64, CurvePoint),
    high: &(f64, f64, CurvePoint),
    s: f64,
    (border, origin): (&[f64], f64),
    options: NewtonOptions,
) -> Option<CurvePoint> {
    let part = (s - low.0) / (high.0 - low.0);
    let mut u: Vec<f64> = low
        .2
        .u
        .iter()
        .zip(&high.2.u)
        .map(|(x, y)| x + part * (y - x))
        .collect();
    let scale = low.2.scale;
    let border = Border {
        row: border,
        value: origin + s,
    };
    newton
        .correct(problem, &mut u, border, scale, options)
        .ok()?;
    // Once more, so that the matrix, and with it the test function, is that of the solution itself.
    newton
        .correct(problem, &mut u, border, scale, options)
        .ok()?;
    let mut tangent = vec![0.0; u.len()];
    if !newton.tangent(problem, &u, &mut tangent, true) {
        return None;
    }
    let norm = newton.norm().length(scale, &tangent);
    for t in &mut tangent {
        *t /= norm;
    }
    Some(CurvePoint { u, tangent, scale })
}
