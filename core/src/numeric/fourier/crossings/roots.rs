//! One root in a bracket: of the distance from a level, and of the slope.
//!
//! The steps are Halley's and Newton's, [guarded](Guarded) by the bracket:
//!
//! ```text
//! n = -f / f',   halley = n / (1 + n f'' / (2 f')),   |error after| ~ ( (f''/f')^2 / 4 + |f'''/(6 f')| ) |halley|^3   (1)
//! ```
//!
//! (Traub (1964), Iterative Methods for the Solution of Equations). By (1) the last step needs no check. In a bracket the
//! root is known to exist: what (1) estimates is only how well it has been found.

use super::pieces::{Cubic, Point};
use super::waves::{Jet, Waves};
use crate::numeric::roots::{Guarded, STEPS};

/// Error of a phase below which it is accepted: the spacing of numbers near the end of the period.
const ENOUGH: f64 = 4.0 * f64::EPSILON;

/// The phase between `a` and `b` where the waves pass `target`. The two lie on different sides of it.
pub(super) fn crossing(waves: &Waves, target: f64, a: &Point, b: &Point) -> f64 {
    let above = a.x > target;
    let mut bracket = Guarded::new(a.tau, b.tau);
    let mut t = guess(target, a, b);
    for _ in 0..STEPS {
        let Jet {
            x,
            slope,
            curvature,
        } = waves.at(t);
        let x = x - target;
        bracket.cut(t, (x > 0.0) == above);
        let inverse = 1.0 / slope;
        let (newton, ratio) = (-x * inverse, curvature * inverse);
        let halley = newton / (1.0 + 0.5 * newton * ratio);
        let (next, good) = bracket.next(t, halley);
        let cube = halley.abs() * halley * halley;
        let error = (0.25 * ratio * ratio + waves.bounds().third * inverse.abs() / 6.0) * cube;
        if (good && error <= ENOUGH) || x == 0.0 || bracket.is_closed() {
            return if good { next } else { t };
        }
        t = next;
    }
    t
}

/// Where the cubic between the ends passes the target, roughly.
fn guess(target: f64, a: &Point, b: &Point) -> f64 {
    let [p, q, r, s] = Cubic::between(a, b).0.map(|x| x - target);
    // In powers of `u`, from 0 to 1 between the ends.
    let (c1, c2, c3) = (
        3.0 * (q - p),
        3.0 * (p - 2.0 * q + r),
        s - p + 3.0 * (q - r),
    );
    let mut u = p / (p - s);
    for _ in 0..3 {
        let x = p + u * (c1 + u * (c2 + u * c3));
        let slope = c1 + u * (2.0 * c2 + u * 3.0 * c3);
        let next = u - x / slope;
        if !(next > 0.0 && next < 1.0) {
            break;
        }
        u = next;
    }
    a.tau + u * (b.tau - a.tau)
}

/// The extremum between `a` and `b`, whose slopes differ in sign, and the curvature there.
pub(super) fn extremum(waves: &Waves, a: &Point, b: &Point) -> (Point, f64) {
    let rising = a.slope > 0.0;
    let mut bracket = Guarded::new(a.tau, b.tau);
    let length = b.tau - a.tau;
    let mut t = a.tau + length * (a.slope / (a.slope - b.slope));
    let mut found = (*a, 0.0);
    for _ in 0..STEPS {
        let Jet {
            x,
            slope,
            curvature,
        } = waves.at(t);
        bracket.cut(t, (slope > 0.0) == rising);
        found = (Point { tau: t, x, slope }, curvature);
        let (next, good) = bracket.next(t, -slope / curvature);
        let step = next - t;
        if bracket.is_closed() || slope == 0.0 {
            break;
        }
        // The step squares the error; the value changes by half of it times the slope.
        if good && waves.bounds().third * step * step <= 2.0 * f64::EPSILON * curvature.abs() {
            found.0 = Point {
                tau: next,
                x: x + 0.5 * slope * step,
                slope: 0.0,
            };
            break;
        }
        t = next;
    }
    found
}
