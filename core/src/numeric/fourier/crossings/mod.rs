//! Where a series crosses a level, and where it nearly does.
//!
//! The series is sampled with its derivative at equally spaced phases, and each interval between two samples is taken
//! for what a bound on its fourth derivative proves about it (`pieces`): away from the level, monotone, bent to one
//! side, or none of these, and then it is halved. So every change of sign is found, however close to the next one. What
//! remains is to find one root in a bracket (`roots`).
//!
//! Source: enclosures of range and bisection, Moore (1966), Interval Analysis, and Neumaier (1990), Interval Methods for
//! Systems of Equations; here the enclosure is that of the interpolating cubic, not of interval arithmetic.

#[cfg(test)]
use super::series;

mod finder;
mod grid;
pub(crate) mod levels;
mod pieces;
mod roots;
#[cfg(test)]
mod tests;
mod waves;

pub use finder::CrossingFinder;

/// A crossing of a level.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Crossing {
    /// Phase, in `[0, 2 pi]`.
    pub tau: f64,
    /// From below to above.
    pub rising: bool,
}

/// An extremum close to a level that it does not cross. Nearby,
/// `|x(t) - level| = distance + 1/2 curvature (t - tau)^2`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct NearMiss {
    /// Phase, in `[0, 2 pi]`.
    pub tau: f64,
    /// `|x - level|` at the extremum.
    pub distance: f64,
    /// Second derivative of `|x - level|` by phase, to about half of the digits; not negative.
    pub curvature: f64,
}

/// Appends the crossings in order of phase, as [`CrossingFinder`] finds them; it serves tests, for which a finder is not
/// worth keeping.
#[cfg(test)]
pub fn crossings(series: &[f64], level: f64, found: &mut Vec<Crossing>) {
    let mut finder = CrossingFinder::new(waves::highest(series));
    finder.sample(series);
    finder.crossings(level, found);
}

/// The phase in `[a, b]` where the slope of a series changes its sign; `rising` is its sign at `a`.
///
/// Newton's method kept inside a bracket by bisection: Press et al. (2007), Numerical Recipes, section 9.4.
#[cfg(test)]
pub(crate) fn extremum(of: &[f64], mut a: f64, mut b: f64, rising: bool) -> f64 {
    let mut t = 0.5 * (a + b);
    for _ in 0..100 {
        let (_, slope, bend) = series::value_and_derivatives(of, t);
        if (slope > 0.0) == rising {
            a = t;
        } else {
            b = t;
        }
        let newton = t - slope / bend;
        let next = if newton > a && newton < b {
            newton
        } else {
            0.5 * (a + b)
        };
        if (next - t).abs() <= 2.0 * f64::EPSILON * t.abs().max(1e-3) {
            return next;
        }
        t = next;
    }
    t
}
