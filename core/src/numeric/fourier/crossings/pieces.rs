//! Intervals cut into pieces whose shape is proved.
//!
//! On an interval of length `h` let `H` be the cubic with the values and slopes of `x` at both ends. Then
//! (Birkhoff and Priver (1967), Hermite interpolation errors for derivatives, J. Math. and Phys. 46, 440-447)
//!
//! ```text
//! |x - H| <= M_4 h^4 / 384,   |x' - H'| <= sqrt(3) M_4 h^3 / 216,   |x'' - H''| <= M_4 h^2 / 12               (1)
//! ```
//!
//! A cubic lies between the least and the largest of its four Bernstein coefficients, and its derivatives between those
//! of theirs (Farin (2002), Curves and Surfaces for CAGD). With (1), and a margin for rounding, that
//! encloses `x`, `x'` and `x''` on the interval. An interval of which they prove nothing is halved. This ends: where
//! value, slope and curvature may all vanish, `|x|` is at most a constant times `h^3`, so it soon is as small as rounding.

use super::waves::{Bounds, Waves};

/// Halvings at most; never reached but by rounding.
const DEPTH: usize = 32;

#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Point {
    pub tau: f64,
    pub x: f64,
    pub slope: f64,
}

/// What is known of a piece.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Shape {
    /// Outside the range that is searched.
    Outside,
    Monotone,
    /// The curvature has one sign: at most one extremum.
    Curved,
    /// It varies no more than rounding may account for.
    Flat,
}

/// The four Bernstein coefficients of a cubic.
#[derive(Debug, Clone, Copy)]
pub(super) struct Cubic(pub [f64; 4]);

impl Cubic {
    pub fn between(a: &Point, b: &Point) -> Self {
        let third = (b.tau - a.tau) / 3.0;
        Self([a.x, a.x + third * a.slope, b.x - third * b.slope, b.x])
    }

    /// Least and largest coefficient.
    pub fn range(&self) -> (f64, f64) {
        let [a, b, c, d] = self.0;
        (
            least(least(a, b), least(c, d)),
            largest(largest(a, b), largest(c, d)),
        )
    }

    /// Distance of the series from its cubic over a length `h`, (1), with rounding.
    pub fn error(h: f64, bounds: &Bounds) -> f64 {
        let square = h * h;
        bounds.fourth * square * square / 384.0 + bounds.value
    }
}

// Unlike `f64::min` and `f64::max` these are one instruction; nothing here is NaN.
fn least(a: f64, b: f64) -> f64 {
    if a < b { a } else { b }
}

fn largest(a: f64, b: f64) -> f64 {
    if a > b { a } else { b }
}

/// Calls `act` with both ends and the shape of each piece of `[left, right]`, in order. `outside` is told bounds of the
/// values on a piece and says whether it may be left as it is.
pub(super) fn pieces(
    waves: &Waves,
    mut left: Point,
    right: Point,
    outside: impl Fn(f64, f64) -> bool,
    mut act: impl FnMut(&Point, &Point, Shape),
) {
    // Right ends of what has been cut off, the nearest last.
    let mut ends = [Point::default(); DEPTH];
    ends[0] = right;
    let mut count = 1;
    while count > 0 {
        let right = ends[count - 1];
        let shape = shape(&left, &right, waves.bounds(), &outside);
        if shape.is_none() && count < DEPTH {
            let tau = 0.5 * (left.tau + right.tau);
            let jet = waves.at(tau);
            ends[count] = Point {
                tau,
                x: jet.x,
                slope: jet.slope,
            };
            count += 1;
        } else {
            act(&left, &right, shape.unwrap_or(Shape::Flat));
            left = right;
            count -= 1;
        }
    }
}

fn shape(
    a: &Point,
    b: &Point,
    bounds: &Bounds,
    outside: &impl Fn(f64, f64) -> bool,
) -> Option<Shape> {
    let h = b.tau - a.tau;
    let cubic = Cubic::between(a, b);
    let (low, high) = cubic.range();
    let error = Cubic::error(h, bounds);
    if outside(low - error, high + error) {
        return Some(Shape::Outside);
    }
    let middle = 3.0 * (cubic.0[2] - cubic.0[1]) / h;
    let error =
        3.0_f64.sqrt() / 216.0 * bounds.fourth * h * h * h + bounds.slope + 6.0 * bounds.value / h;
    if one_sign(&[a.slope, middle, b.slope], error) {
        return Some(Shape::Monotone);
    }
    let curvatures = [2.0 * (middle - a.slope) / h, 2.0 * (b.slope - middle) / h];
    let error =
        bounds.fourth * h * h / 12.0 + 2.0 * (2.0 * bounds.slope + 6.0 * bounds.value / h) / h;
    if one_sign(&curvatures, error) {
        return Some(Shape::Curved);
    }
    (high - low <= 4.0 * bounds.value).then_some(Shape::Flat)
}

fn one_sign(values: &[f64], error: f64) -> bool {
    values.iter().all(|&value| value > error) || values.iter().all(|&value| value < -error)
}
