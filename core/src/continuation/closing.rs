//! Whether a walk along a curve has come back to where it began.
//!
//! The tangents of a closed curve are zero in sum, so that some of them point against the first one: before, nothing has closed. Then a step from `a` to `b` closes the
//! curve if it passes the first point, in the first direction, on the way that its ends with their tangents tell:
//!
//! ```text
//! p(s) = a + (3 s^2 - 2 s^3) (b - a) + |b - a| (s (1 - s)^2 t_a + s^2 (s - 1) t_b)                               (1)
//! ```
//!
//! (Hermite's cubic). Limbs that go the same way are told apart if they are farther from each other than a twentieth of a step.

use super::follow::CurvePoint;
use crate::continuation::newton::Newton;

/// A step passes a point that is no farther from (1) than this part of the chord, and this part of the scales beside: unknowns of the first point may have been cut
/// or filled up since.
const ASIDE: [f64; 2] = [0.05, 1e-5];

/// Whether the last step passed the first point in the first direction: it is on the cubic through both ends of the step with their tangents.
pub(super) fn closes(
    newton: &Newton,
    first: &CurvePoint,
    from: &CurvePoint,
    to: &CurvePoint,
) -> bool {
    let norm = newton.norm();
    let length = |a: &[f64]| norm.length(first.scale, a);
    let along = |a: &[f64]| norm.product(first.scale, a, &first.tangent);
    let to_first =
        |a: &CurvePoint| -> Vec<f64> { first.u.iter().zip(&a.u).map(|(x, y)| x - y).collect() };
    let [ahead, behind] = [from, to].map(|a| along(&to_first(a)));
    if !(ahead > 0.0 && behind <= 0.0) || [from, to].iter().all(|a| along(&a.tangent) <= 0.0) {
        return false;
    }
    let step: Vec<f64> = to.u.iter().zip(&from.u).map(|(x, y)| x - y).collect();
    let chord = length(&step);
    let part = ahead / (ahead - behind);
    // (1)
    let [whole, one, other] = [
        part * part * (3.0 - 2.0 * part),
        part * (1.0 - part).powi(2),
        part * part * (part - 1.0),
    ];
    let [one, other] =
        [(one, from), (other, to)].map(|(by, point)| by * chord / length(&point.tangent));
    let off = to_first(from).into_iter().zip(&step);
    let slopes = from.tangent.iter().zip(&to.tangent);
    let off = off
        .zip(slopes)
        .map(|((first, step), (a, b))| first - whole * step - one * a - other * b);
    let off: Vec<f64> = off.collect();
    length(&off) <= ASIDE[0] * chord + ASIDE[1]
}
