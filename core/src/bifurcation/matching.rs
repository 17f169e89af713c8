//! Recognising what is known already.

use std::f64::consts::TAU;

use super::diagram::DiagramBranch;
use crate::branches::orbit::Orbit;
use crate::branches::point::{Event, Point};
use crate::response::{FrequencyResponse, OrbitMethod};

/// Values of one event, found on two branches, differ by no more than this part of the range, or by their stated errors.
const SAME: f64 = 1e-6;
/// Stated errors are heeded up to this part of the range.
const LARGEST: f64 = 1e-3;

/// Whether an event at the end of a branch is this event of a more regular one, in a range of some length.
pub(super) fn is_same_place(end: &Event, event: &Event, range: f64) -> bool {
    let (a, b) = (end.point.value, event.point.value);
    let error = (end.error + event.error).min(LARGEST * range);
    (a - b).abs() <= SAME * range + error && visits(&end.point, &event.point.orbit.state())
}

/// Whether a branch that ends at a value ends at this event, in a range of some length.
pub(super) fn is_same_value(end: f64, event: &Event, range: f64) -> bool {
    let error = (2.0 * event.error).min(LARGEST * range);
    (end - event.point.value).abs() <= SAME * range + error
}

/// States at the beginnings of the segments of an orbit, or of its periods where those are not known.
fn beginnings(orbit: &Orbit) -> Vec<Vec<f64>> {
    if !orbit.states.is_empty() {
        return orbit.states().map(<[f64]>::to_vec).collect();
    }
    let period = TAU / orbit.base / orbit.period as f64;
    let state = |number: usize| {
        let time = number as f64 * period;
        let coordinates = (0..orbit.coordinates).filter_map(|i| orbit.state_at(i, time));
        let (positions, velocities): (Vec<f64>, Vec<f64>) = coordinates.unzip();
        [positions, velocities].concat()
    };
    (0..orbit.period).map(state).collect()
}

/// Whether an orbit passes through a state at the beginning of one of its segments.
pub(super) fn visits(point: &Point, state: &[f64]) -> bool {
    let size = 2.0 * point.size();
    let n = state.len() / 2;
    beginnings(&point.orbit).iter().any(|other| {
        let mut pairs = other.iter().zip(state).enumerate();
        pairs.all(|(i, (x, y))| {
            let unit = if i < n { 1.0 } else { point.orbit.omega };
            // At a branch point states are known to the root of what the value is known to.
            (x - y).abs() <= SAME.sqrt() * size * unit
        })
    })
}

/// Whether an orbit is on a branch: one of those near its value leads to it.
pub(super) fn contains<M: OrbitMethod>(
    response: &FrequencyResponse<M>,
    branch: &DiagramBranch,
    orbit: &Point,
) -> bool {
    if branch.period() != orbit.orbit.period {
        return false;
    }
    let passes = |pair: &&[Point]| {
        let [a, b] = [pair[0].value, pair[1].value];
        (a - orbit.value) * (b - orbit.value) <= 0.0
    };
    branch.branch.points.windows(2).filter(passes).any(|pair| {
        let nearer = |point: &Point| (point.value - orbit.value).abs();
        let start = if nearer(&pair[0]) < nearer(&pair[1]) {
            &pair[0]
        } else {
            &pair[1]
        };
        let request = response.clone().period(orbit.orbit.period);
        let found = request.near_orbit(&start.orbit).orbit(orbit.value);
        found.is_ok_and(|found| {
            visits(&found, &orbit.orbit.state()) || is_later(response, &found, orbit)
        })
    })
}

/// Whether a symmetric orbit of several periods begins in another one of them: its segments are parts of half of it, which need not
/// be whole periods.
fn is_later<M: OrbitMethod>(response: &FrequencyResponse<M>, found: &Point, orbit: &Point) -> bool {
    let several = orbit.orbit.symmetric && orbit.orbit.period > 1;
    let returns = || response.request.returns(response.shooting(), orbit);
    several && returns().is_ok_and(|states| states.iter().any(|state| visits(found, state)))
}
