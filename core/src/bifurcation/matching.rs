//! Recognising what is known already.

use std::f64::consts::TAU;

use crate::branches::branch::Branch;
use crate::branches::orbit::Orbit;
use crate::branches::point::{Event, Point};
use crate::response::{FrequencyResponse, OrbitMethod};
use crate::shooting::Shooting;

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
fn visits(point: &Point, state: &[f64]) -> bool {
    let mut others = beginnings(&point.orbit).into_iter();
    others.any(|other| is_same_state(point, &other, state))
}

/// Whether the orbit at a value with these states at the beginnings of its periods is on a branch.
pub(super) fn contains<M: OrbitMethod>(
    response: &FrequencyResponse<M>,
    branch: &Branch,
    value: f64,
    states: &[Vec<f64>],
) -> bool {
    if branch.period() != states.len() {
        return false;
    }
    // From an orbit of the branch at this very value nothing else is near; from one beside it Newton's method may leave the branch.
    let is_near = |near: &Point| {
        let shooting = response.clone().by(Shooting::new()).stability(false);
        let near = shooting.period(states.len()).near_orbit(&near.orbit);
        near.orbit(value).is_ok_and(|found| passes(&found, states))
    };
    match branch.plainly_at(value) {
        // A series may not resolve a state.
        Ok(found) => found
            .iter()
            .any(|found| passes(found, states) || is_near(found)),
        // An orbit between two others is lost.
        Err(_) => around(branch, value).any(is_near),
    }
}

/// Of every two neighbours on a branch between which it passes a value, the nearer one.
pub(super) fn around(branch: &Branch, value: f64) -> impl Iterator<Item = &Point> {
    let off = move |point: &Point| (point.value - value).abs();
    beside(branch, value).map(move |[a, b]| if off(a) < off(b) { a } else { b })
}

/// Every two neighbours on a branch between which it passes a value.
pub(super) fn beside(branch: &Branch, value: f64) -> impl Iterator<Item = [&Point; 2]> {
    let off = move |point: &Point| point.value - value;
    let pairs = branch.points.windows(2);
    let passing = pairs.filter(move |pair| off(&pair[0]) * off(&pair[1]) <= 0.0);
    passing.map(|pair| [&pair[0], &pair[1]])
}

/// Whether an orbit passes through one of some states at phase zero.
pub(super) fn passes(point: &Point, states: &[Vec<f64>]) -> bool {
    let here = point.orbit.state();
    states
        .iter()
        .any(|state| is_same_state(point, &here, state))
}

/// Whether two states are the same beside the size of an orbit.
fn is_same_state(point: &Point, one: &[f64], other: &[f64]) -> bool {
    let size = 2.0 * point.size();
    let n = other.len() / 2;
    let mut pairs = one.iter().zip(other).enumerate();
    pairs.all(|(i, (x, y))| {
        let unit = if i < n { 1.0 } else { point.orbit.omega };
        // At a branch point states are known to the root of what the value is known to.
        (x - y).abs() <= SAME.sqrt() * size * unit
    })
}
