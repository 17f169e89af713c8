//! Orbits whose motion is to be read: closed as far as they are known.
//!
//! The state at the beginning of an orbit errs by as much as the orbit does anywhere. A motion from it carries that on, by up to what the
//! tangent map of a part of the way makes of it, and does not come back. The periodic motion errs by no more than is stated. So where the
//! map `M` from the beginning of a segment to the next has
//!
//! ```text
//! |M(x_i) - x_(i+1)| > c e p                                                                                   (1)
//! ```
//!
//! with the stated error `e`, as a part of peak-to-peak `p` of what it is of, Newton's method is applied to `M(x_i) = x_(i+1)` with what is varied held, until an update is
//! below a thousandth, as the first one is as a rule; `c = 0.1`, and less where an orbit has several segments, or comes back after a part of its period, since a motion over all of
//! them adds up. Of an output (1) has no `p`, which is a length of states, and it is always applied. Where no error is stated
//! nothing is known that the motion should be closed to. Beside a fold it leads away: a state that is farther off than errors explain
//! is not taken.
//!
//! Source: Parker and Chua (1989), Practical Numerical Algorithms for Chaotic Systems, section 5.3 (shooting from a state that is known nearly).

use super::equations::Equations;
use super::error_reference::ONE_UPDATE;
use super::problem::ShootingProblem;
use crate::branches::point::Point;
use crate::branches::solve;
use crate::continuation::newton::{Newton, NewtonOptions};
use crate::orbit::observe::Accuracy;

/// `c` of (1).
const CLOSED: f64 = 0.1;
/// The same where a motion goes over several segments.
const CLOSED_EACH: f64 = 1e-3;
/// States that are farther off than so many times the error are of another orbit.
const FAR: f64 = 100.0;

/// States of an orbit whose error is that of an output may err by more than that; beyond this part of the size, or the error if that is more, they
/// are of another orbit all the same.
const AT_MOST: f64 = 1e-3;

/// Whether a motion whose segments end so far from where the next ones begin is closed, by (1).
pub(super) fn is_closed(problem: &ShootingProblem, point: &Point, apart: f64) -> bool {
    let Some(error) = known(point) else {
        return true;
    };
    let one = point.orbit.parts == 1 && point.orbit.states().count() == 1;
    let part = if one { CLOSED } else { CLOSED_EACH };
    apart <= part * error * length(problem.accuracy, point)
}

/// The states of the closed orbit beside one that is not; nothing if there is none.
pub(super) fn states(
    problem: &ShootingProblem,
    equations: &mut Equations,
    u: &[f64],
    point: &Point,
    apart: f64,
) -> Option<Vec<f64>> {
    let mut closed = u.to_vec();
    let mut newton = Newton::new(equations);
    let options = problem.newton(equations.tolerance, equations.frame.ratio);
    let options = NewtonOptions {
        tolerance: options.tolerance.max(ONE_UPDATE),
        ..options
    };
    solve::at_value(equations, &mut newton, &mut closed, options).ok()?;
    let size = 2.0 * point.size();
    let far = match problem.accuracy {
        Accuracy::Output(_) => {
            let error = known(point)? * size;
            (FAR * (error + apart)).min((AT_MOST * size).max(error))
        }
        Accuracy::Coordinate(_) | Accuracy::Coordinates => FAR * known(point)? * size,
    };
    (equations.apart(&closed, u) <= far).then(|| equations.states_of(&closed))
}

/// The stated error, if there is one: one of zero is that of an output at rest.
fn known(point: &Point) -> Option<f64> {
    point
        .error
        .filter(|error| error.is_finite() && *error > 0.0)
}

/// What the error of an orbit is a part of, as a length of states: the shortest that it may be.
fn length(accuracy: Accuracy, point: &Point) -> f64 {
    let largest = 2.0 * point.size();
    let own = match accuracy {
        Accuracy::Coordinate(_) => accuracy.peak_to_peak(&point.observed),
        Accuracy::Coordinates => point.peak_to_peak(),
        Accuracy::Output(_) => return 0.0,
    };
    // One at rest has errors in parts of the largest.
    if own > f64::EPSILON * largest {
        own.min(largest)
    } else {
        largest
    }
}
