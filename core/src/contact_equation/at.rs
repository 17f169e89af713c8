//! Every orbit of a branch at a value of what it varies.
//!
//! Between two neighbours an orbit is looked for near the motion on their chord: see [`guess`](super::guess). Near a fold Newton's method may lead
//! over to the other limb, so that what is found counts where it comes back as one of the neighbours does, and its state `x` is between theirs, `a` and
//! `b`,
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

/// Orbits whose states differ by less than their errors, or by this part of their size if that is less, are the same.
const SAME: f64 = 1e-5;

/// The orbits at a value, in branch order.
///
/// # Errors
/// If the orbit between two neighbours is not found.
pub(crate) fn at(
    problem: &ContactProblem,
    branch: &Branch,
    value: f64,
) -> Result<Vec<Point>, Error> {
    // By shooting as it begins alone: from either neighbour, and then in more segments.
    let search = |[a, b]: [&Point; 2], value: f64, way: usize| match way {
        0 => between(problem, [a, b], value),
        1 => shooting::at::between(&problem.asked, [a, b], value, 0),
        2 => shooting::at::between(&problem.asked, [b, a], value, 0),
        more => shooting::at::between(&problem.asked, [a, b], value, more - 2),
    };
    orbits_at(branch, value, 2 + shooting::at::WAYS, search, is_same)
}

/// The orbit at a value from near the chord of two others.
fn between(problem: &ContactProblem, [a, b]: [&Point; 2], value: f64) -> Result<Point, Error> {
    let counts = |found: &Point| {
        let recurrence = found.orbit.recurrence();
        // (1)
        [a, b]
            .iter()
            .any(|end| end.orbit.recurrence() == recurrence)
            && is_between([a, b], found)
    };
    match near_chord(problem, [a, b], value) {
        Ok(found) if counts(&found) => Ok(found),
        Err(reason) if reason.kind() == ErrorKind::Cancelled => Err(reason),
        _ => Err(OrbitError::Lost {
            value,
            from: a.value,
            to: b.value,
        }
        .into()),
    }
}

fn near_chord(problem: &ContactProblem, [a, b]: [&Point; 2], value: f64) -> Result<Point, Error> {
    let part = (value - a.value) / (b.value - a.value);
    let guess = Guess::of(problem, a)?.toward(Guess::of(problem, b)?, part);
    compute::orbit_near(problem, &guess, value)
}

/// Whether two orbits are one, as far as they are known.
fn is_same(a: &Point, b: &Point) -> bool {
    let known = |point: &Point| point.error.filter(|error| error.is_finite());
    let errors = [a, b].map(|point| known(point).unwrap_or(0.0));
    shooting::at::is_within(a, b, (errors[0] + errors[1]).min(SAME))
}
