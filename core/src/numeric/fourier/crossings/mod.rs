//! Where a series crosses a level, and where it nearly does.
//!
//! The series is sampled with its derivative at equally spaced phases, and each interval between two samples is taken
//! for what a bound on its fourth derivative proves about it (`pieces`): away from the level, monotone, curved to one
//! side, or none of these, and then it is halved. So every change of sign is found, however close to the next one. What
//! remains is to find one root in a bracket (`roots`).
//!
//! Source: enclosures of range and bisection, Moore (1966), Interval Analysis, and Neumaier (1990), Interval Methods for
//! Systems of Equations; here the enclosure is that of the interpolating cubic, not of interval arithmetic.

#[cfg(test)]
use crate::numeric::{
    fourier::series,
    roots::{Place, root},
};

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

/// The phase in `[a, b]` where the slope of a series changes its sign.
#[cfg(test)]
pub(crate) fn extremum(of: &[f64], a: f64, b: f64) -> f64 {
    let slope = |tau: f64| series::value_and_derivatives(of, tau).1;
    let [from, to] = [a, b].map(|x| Place { x, value: slope(x) });
    root(from, to, 0.0, slope).expect("a change of sign")
}
