//! Every orbit of a branch at a value of what it varies.
//!
//! Between two neighbours an orbit is looked for near the motion on their chord: see [`guess`](super::guess). Near a fold Newton's method may lead
//! over to the other limb, so that what is found counts where its state `x` is between those of the neighbours, `a` and `b`,
//!
//! ```text
//! 0 <= (x - a) . (b - a) <= (b - a) . (b - a)                                                                  (1)
//! ```
//!
//! and is otherwise looked for by shooting, in all its ways.

use super::compute;
use super::guess::Guess;
use super::problem::ContactProblem;
use crate::branches::branch::Branch;
use crate::branches::error::OrbitError;
use crate::branches::point::Point;
use crate::branches::value::{is_between, orbits_at};
use crate::error::{Error, ErrorKind};
use crate::shooting;

/// The orbits at a value, in branch order.
///
/// # Errors
/// If the orbit between two neighbours is not found.
pub(crate) fn at(
    problem: &ContactProblem,
    branch: &Branch,
    value: f64,
) -> Result<Vec<Point>, Error> {
    let search = |ends: [&Point; 2], value: f64, way: usize| match way.checked_sub(1) {
        None => between(problem, ends, value),
        Some(way) => shooting::at::between(&problem.asked, ends, value, way),
    };
    let ways = 1 + shooting::at::WAYS;
    orbits_at(branch, value, ways, search, shooting::at::is_same)
}

/// The orbit at a value from near the chord of two others.
fn between(problem: &ContactProblem, [a, b]: [&Point; 2], value: f64) -> Result<Point, Error> {
    let part = (value - a.value) / (b.value - a.value);
    let from = Guess::of(problem, a)?;
    let to = Guess::of(problem, b)?;
    let lost = OrbitError::Lost {
        value,
        from: a.value,
        to: b.value,
    };
    match compute::orbit_near(problem, &from.toward(to, part), value) {
        // (1)
        Ok(found) if is_between([a, b], &found) => Ok(found),
        Err(reason) if reason.kind() == ErrorKind::Cancelled => Err(reason),
        _ => Err(lost.into()),
    }
}
