//! Recognising what is known already.

use std::f64::consts::TAU;

use crate::branches::branch::Branch;
use crate::branches::orbit::Orbit;
use crate::branches::point::{Event, Point};
use crate::continuation::follow::Stop;
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

/// Whether the orbit at a value with these states at the beginnings of its periods is on a branch, which begins at an event if it begins at one.
pub(super) fn contains<M: OrbitMethod>(
    response: &FrequencyResponse<M>,
    branch: &Branch,
    begin: Option<&Event>,
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
        Ok(found) => {
            found
                .iter()
                .any(|found| passes(found, states) || is_near(found))
                || at_ends(branch, begin, value).any(is_near)
        }
        // An orbit between two others is lost.
        Err(_) => around(branch, begin, value).any(is_near),
    }
}

/// The points of a branch that are nearest to where it passes a value: of every two neighbours the nearer one, and its ends.
pub(super) fn around<'b>(
    branch: &'b Branch,
    begin: Option<&'b Event>,
    value: f64,
) -> impl Iterator<Item = &'b Point> {
    let off = move |point: &Point| (point.value - value).abs();
    let pairs = branch.points.windows(2).map(|pair| [&pair[0], &pair[1]]);
    let passing = pairs.filter(move |pair| is_between(pair.map(|point| point.value), value));
    let nearer = passing.map(move |[a, b]| if off(a) < off(b) { a } else { b });
    nearer.chain(at_ends(branch, begin, value))
}

/// The first point of a branch if a value is between it and where the branch begins at another one, the last if it is between that and where it
/// joins another one.
fn at_ends<'b>(
    branch: &'b Branch,
    begin: Option<&Event>,
    value: f64,
) -> impl Iterator<Item = &'b Point> {
    let joined = |end: Option<Stop>| match end {
        Some(Stop::Joined { value, .. }) => Some(value),
        _ => None,
    };
    let begin = begin.map(|event| event.point.value);
    let first = (branch.points.first(), begin.or(joined(branch.begin)));
    let last = (branch.points.last(), joined(Some(branch.stopped)));
    [first, last].into_iter().filter_map(move |(point, end)| {
        let point = point?;
        is_between([point.value, end?], value).then_some(point)
    })
}

/// Every two neighbours on a branch between which it passes a value: points of it, the first and the event where it begins, the last and the event
/// where it joins another one.
pub(super) fn beside<'b>(
    branch: &'b Branch,
    begin: Option<&'b Event>,
    value: f64,
) -> impl Iterator<Item = [&'b Point; 2]> {
    let (points, events) = (&branch.points, &branch.events);
    let before = begin.or_else(|| events.iter().find(|event| event.after == 0));
    let behind = events.iter().rfind(|event| event.after == points.len());
    let first = before.and_then(|event| Some([&event.point, points.first()?]));
    let last = behind.and_then(|event| Some([points.last()?, &event.point]));
    let pairs = points.windows(2).map(|pair| [&pair[0], &pair[1]]);
    let pairs = first.into_iter().chain(pairs).chain(last);
    pairs.filter(move |pair| is_between(pair.map(|point| point.value), value))
}

/// Whether a value is between two others, or one of them.
fn is_between([a, b]: [f64; 2], value: f64) -> bool {
    (a - value) * (b - value) <= 0.0
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::balance_branch::options::HarmonicBalance;
    use crate::bifurcation::Bifurcations;
    use crate::bifurcation::diagram::Origin;
    use crate::response::FrequencyResponse;
    use crate::testing::one_sided::one_sided;

    /// What is between the first orbit of a branch and the doubling where it begins, or between the last one and where it joins, is on it; by the
    /// balance too, whose branches have no event where they join.
    fn ends_are_known(by_balance: bool) {
        let model = one_sided(1.0);
        let request = Bifurcations::of(&model)
            .from(0.5)
            .to(1.5)
            .depth(1)
            .tolerance(1e-6);
        let found = if by_balance {
            request.by(HarmonicBalance::new()).run()
        } else {
            request.run()
        };
        let diagram = found.expect("branches");
        let response = FrequencyResponse::of(&model).from(0.5).to(1.5);
        let mut known = [0; 2];
        for branch in &diagram.branches {
            let (Origin::Event { .. }, Stop::Joined { value: end, .. }) =
                (branch.origin, branch.branch.stopped)
            else {
                continue;
            };
            let begin = diagram.begin(branch).expect("an event");
            let points = &branch.branch.points;
            let [first, last] = [&points[0], &points[points.len() - 1]];
            let ends = [(first, begin.point.value), (last, end)];
            for (place, (point, event)) in ends.into_iter().enumerate() {
                let value = 0.5 * (point.value + event);
                let near = response.clone().by(Shooting::new()).period(2);
                let orbit = near
                    .near_orbit(&point.orbit)
                    .orbit(value)
                    .expect("an orbit");
                let states = beginnings(&orbit.orbit);
                assert_eq!(states.len(), 2);
                assert!(!is_same_state(&orbit, &states[0], &states[1]));
                assert!(contains(
                    &response,
                    &branch.branch,
                    Some(begin),
                    value,
                    &states
                ));
                known[place] += 1;
            }
        }
        assert!(known[0] > 0 && known[1] > 0, "{known:?}");
    }

    #[test]
    fn what_is_beside_the_ends_of_a_branch_is_on_it() {
        ends_are_known(false);
    }

    #[test]
    fn what_is_beside_the_ends_of_a_branch_of_the_balance_is_on_it() {
        ends_are_known(true);
    }
}
