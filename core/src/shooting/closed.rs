//! Orbits of other methods whose motion is to be read: closed as far as they are known.
//!
//! The state at the beginning of an orbit errs by as much as the orbit does anywhere. A motion from it carries that on, by up to what the
//! tangent map of a part of the period makes of it, and does not come back. The periodic motion errs by no more than is stated. So where the
//! map `M` of the period has
//!
//! ```text
//! |M(x) - x| > 0.1 e p                                                                                         (1)
//! ```
//!
//! with the stated error `e` of peak-to-peak `p`, Newton's method solves `M(x) = x` with what is varied held. Beside a fold that leads away:
//! a solution that is farther off than errors explain is not taken.
//!
//! Source: Parker and Chua (1989), Practical Numerical Algorithms for Chaotic Systems, section 5.3 (shooting from a state that is known nearly).

use super::equations::Equations;
use super::problem::ShootingProblem;
use crate::branches::point::Point;
use crate::branches::solve;
use crate::continuation::newton::Newton;
use crate::orbit::observe::Accuracy;

/// A motion is closed to this part of the stated error.
const CLOSED: f64 = 0.1;
/// A solution that is farther off than so many times the errors is of another orbit.
const FAR: f64 = 100.0;

/// Whether a motion that ends so far from where it begins is closed, by (1).
pub(super) fn is_closed(point: &Point, apart: f64) -> bool {
    apart <= CLOSED * known_to(point)
}

/// The states of the closed orbit beside one whose motion ends so far from where it begins; nothing if there is none.
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
    solve::at_value(equations, &mut newton, &mut closed, options).ok()?;
    let far = FAR * (known_to(point) + apart);
    (equations.apart(&closed, u) <= far).then(|| equations.states_of(&closed))
}

/// The stated error as a length; nothing where none is stated.
fn known_to(point: &Point) -> f64 {
    let size = Accuracy::Coordinates.peak_to_peak(&point.observed);
    let error = point.error.filter(|error| error.is_finite());
    error.map_or(0.0, |error| error * size)
}
