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
/// What is between the end of a branch and an event is no farther from the end than the event, to this factor.
const BEYOND: f64 = 1.5;
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
    at_periods(orbit)
}

/// States at the beginnings of the periods of an orbit.
pub(super) fn at_periods(orbit: &Orbit) -> Vec<Vec<f64>> {
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
    let near = |near: &Point| {
        let shooting = response.clone().by(Shooting::new()).stability(false);
        let near = shooting.period(states.len()).near_orbit(&near.orbit);
        let found = near.orbit(value).ok();
        found.filter(|found| passes(found, states))
    };
    match branch.plainly_at(value) {
        // A series may not resolve a state.
        Ok(found) => {
            let mut ends = at_ends(branch, begin, value);
            found
                .iter()
                .any(|found| passes(found, states) || near(found).is_some())
                || ends.any(|end| near(end.point).is_some_and(|found| end.reaches(&found)))
        }
        // An orbit between two others is lost.
        Err(_) => around(branch, begin, value).any(|point| near(point).is_some()),
    }
}

/// The first or the last point of a branch, beside the event where it begins on another one or joins it, if that is known.
struct End<'b> {
    point: &'b Point,
    event: Option<&'b Point>,
}

impl End<'_> {
    /// Whether an orbit is no farther from the end than the event is, whatever period that begins at. Where that is not known, the difference to the orbit half its period later tells: where it joins one of half the period, that
    /// vanishes.
    fn reaches(&self, found: &Point) -> bool {
        let own = beginnings(&self.point.orbit);
        let state = self.point.orbit.state();
        let whole = match self.event {
            Some(event) => {
                let others = beginnings(&event.orbit);
                let others = others.iter().map(|other| apart(self.point, &state, other));
                others.fold(f64::INFINITY, f64::min)
            }
            None if own.len() == self.point.orbit.period && own.len() > 1 => {
                apart(self.point, &own[0], &own[own.len() / 2])
            }
            None => self.point.size(),
        };
        apart(self.point, &state, &found.orbit.state()) <= BEYOND * whole
    }
}

/// The points of a branch that are nearest to where it passes a value: of every two neighbours the nearer one, and an end if the value is between it and its event.
pub(super) fn around<'b>(
    branch: &'b Branch,
    begin: Option<&'b Event>,
    value: f64,
) -> impl Iterator<Item = &'b Point> {
    let off = move |point: &Point| (point.value - value).abs();
    let nearer = neighbours(branch, value).map(move |[a, b]| if off(a) < off(b) { a } else { b });
    nearer.chain(at_ends(branch, begin, value).map(|end| end.point))
}

/// The ends of a branch if a value is between them and where they begin on another branch or join it.
fn at_ends<'b>(
    branch: &'b Branch,
    begin: Option<&'b Event>,
    value: f64,
) -> impl Iterator<Item = End<'b>> {
    let joined = |end: Option<Stop>| match end {
        Some(Stop::Joined { value, .. }) => Some(value),
        _ => None,
    };
    let ends = [
        (
            branch.points.first(),
            first_event(branch, begin),
            joined(branch.begin),
        ),
        (
            branch.points.last(),
            last_event(branch),
            joined(Some(branch.stopped)),
        ),
    ];
    ends.into_iter().filter_map(move |(point, event, joined)| {
        let (point, event) = (point?, event.map(|event| &event.point));
        let end = event.map(|event| event.value).or(joined)?;
        is_between([point.value, end], value).then_some(End { point, event })
    })
}

/// The event before the first point of a branch, on the branch where it begins or on itself.
fn first_event<'b>(branch: &'b Branch, begin: Option<&'b Event>) -> Option<&'b Event> {
    begin.or_else(|| branch.events.iter().find(|event| event.after == 0))
}

/// The event behind the last point of a branch.
fn last_event(branch: &Branch) -> Option<&Event> {
    let behind = |event: &&Event| event.after >= branch.points.len();
    branch.events.iter().rfind(behind)
}

/// Every two neighbours on a branch between which it passes a value: points of it, the first and the event where it begins, the last and the event
/// where it joins another one, which a branch of the balance does not have.
pub(super) fn beside<'b>(
    branch: &'b Branch,
    begin: Option<&'b Event>,
    value: f64,
) -> impl Iterator<Item = [&'b Point; 2]> {
    let first = || Some([&first_event(branch, begin)?.point, branch.points.first()?]);
    let last = || Some([branch.points.last()?, &last_event(branch)?.point]);
    let ends = [first(), last()].into_iter().flatten();
    let ends = ends.filter(move |pair| is_between(pair.map(|point| point.value), value));
    neighbours(branch, value).chain(ends)
}

/// Every two points of a branch that follow each other and between which it passes a value.
fn neighbours(branch: &Branch, value: f64) -> impl Iterator<Item = [&Point; 2]> {
    let pairs = branch.points.windows(2).map(|pair| [&pair[0], &pair[1]]);
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
    // At a branch point states are known to the root of what the value is known to.
    apart(point, one, other) <= SAME.sqrt() * 2.0 * point.size()
}

/// The largest difference of two states of an orbit's frequency, rates as coordinates.
fn apart(point: &Point, one: &[f64], other: &[f64]) -> f64 {
    let n = other.len() / 2;
    let pairs = one.iter().zip(other).enumerate();
    pairs.fold(0.0, |most: f64, (i, (x, y))| {
        let unit = if i < n { 1.0 } else { point.orbit.omega };
        most.max((x - y).abs() / unit)
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
