//! Solutions of a branch at a value of what it varies.
//!
//! Where the branch turns has been located, so that it passes a value at most once between two neighbours among its points and turns.
//! There the solution is searched along the chord of the two, from one of them. Where that leads nowhere, as between orbits of
//! many contacts that another method has found in longer steps, or to another limb of the branch, it is searched from the other one, in the other
//! ways of the method, and by way of the orbit half-way.

use super::branch::Branch;
use super::point::{Event, Point};
use crate::continuation::follow::{CurvePoint, Step};
use crate::continuation::locate::{Located, locate};
use crate::continuation::newton::{Newton, NewtonOptions};
use crate::continuation::problem::Problem;
use crate::error::{Error, ErrorKind};

/// The way to a value is halved so often at most, and with it orbits are looked for so often: as often in each of many ways.
const HALVINGS: usize = 7;
const LOOKS: usize = 60;
const LOOKS_EACH: usize = 15;
/// What was found by other ways is no farther from both neighbours than they are apart, to this factor.
const ASIDE: f64 = 1.5;
/// The reason for which other ways are tried.
const LOST: &str = "Lost";

/// Points and turns of a branch in their order along it. Each turn comes with the number of points before it.
pub(crate) fn chain<'p, T>(points: &'p [T], turns: &[(usize, &'p T)]) -> Vec<&'p T> {
    let points = points.iter().enumerate();
    let with_turns = points.flat_map(|(index, point)| {
        let before = turns.iter().filter(move |(after, _)| *after == index);
        before.map(|(_, turn)| *turn).chain([point])
    });
    with_turns.collect()
}

/// Whether the branch turns at an event: its value is not between those of the points before and after it.
pub(crate) fn turns_at<T>(points: &[T], after: usize, value: f64, of: impl Fn(&T) -> f64) -> bool {
    let neighbours = after
        .checked_sub(1)
        .map(|before| (points.get(before), points.get(after)));
    match neighbours {
        Some((Some(a), Some(b))) => (value - of(a)) * (of(b) - value) < 0.0,
        _ => false,
    }
}

/// The orbits of a branch at a value, in its order.
///
/// # Errors
/// Those of `between`, which finds the orbit at a value between two neighbours, near the first, in so many ways; the first is the one to begin with.
pub(crate) fn orbits_at(
    branch: &Branch,
    value: f64,
    ways: usize,
    mut between: impl FnMut([&Point; 2], f64, usize) -> Result<Point, Error>,
    is_same: impl Fn(&Point, &Point) -> bool,
) -> Result<Vec<Point>, Error> {
    let chain = chain(&branch.points, &turns(branch));
    let search = |ends: [&Point; 2]| {
        let [a, b] = ends.map(|end| end.value);
        let lies_inside = |event: &Event| (event.point.value - a) * (event.point.value - b) < 0.0;
        let mut left = Left {
            ways,
            looks: LOOKS.max(LOOKS_EACH * (1 + ways)),
            alike: !branch.events.iter().any(lies_inside),
        };
        divided(&mut between, ends, value, HALVINGS, &mut left)
    };
    solutions(&chain, value, |point| point.value, search, is_same)
}

/// The ways in which an orbit is looked for, and how many may be yet.
struct Left {
    ways: usize,
    looks: usize,
    /// No event is known whose value is between those of the neighbours.
    alike: bool,
}

/// The orbit at a value between two neighbours, from one of them, or else by way of others, with so many halvings and orbits left.
fn divided(
    between: &mut impl FnMut([&Point; 2], f64, usize) -> Result<Point, Error>,
    [a, b]: [&Point; 2],
    value: f64,
    halvings: usize,
    left: &mut Left,
) -> Result<Point, Error> {
    let others = halvings > 0 && left.looks > 0;
    left.looks = left.looks.saturating_sub(1 + left.ways);
    let of_one_verdict = left.alike;
    let lies_between = |found: &Point| {
        let whole = distance(a, b);
        let alike = !of_one_verdict || is_alike([a, b, found]);
        let is_near = |end: &&Point| distance(end, found) <= ASIDE * whole;
        alike && [a, b].iter().all(is_near)
    };
    let first = match between([a, b], value, 0) {
        Err(reason) if others && reason.variant() == LOST => Err(reason),
        // It may be of another part of the branch.
        Ok(found) if others && !lies_between(&found) => Ok(found),
        found => return found,
    };
    let from_other = [([b, a], 0)].into_iter();
    for (ends, way) in from_other.chain((1..left.ways).map(|way| ([a, b], way))) {
        match between(ends, value, way) {
            Ok(found) if lies_between(&found) => return Ok(found),
            Err(other) if other.kind() == ErrorKind::Cancelled => return Err(other),
            _ => {}
        }
    }
    let mut halved =
        |ends: [&Point; 2], value: f64| divided(between, ends, value, halvings - 1, left);
    let middle = halved([a, b], 0.5 * (a.value + value)).and_then(|middle| {
        if lies_between(&middle) {
            halved([&middle, b], value)
        } else {
            first.clone()
        }
    });
    match middle {
        Ok(found) if lies_between(&found) => Ok(found),
        Err(other) if other.kind() == ErrorKind::Cancelled => Err(other),
        _ => first.clone(),
    }
}

/// Whether an orbit has as many multipliers outside of the unit circle as two others, if these have one number and all are known: on another limb of
/// the branch it is another one.
fn is_alike(points: [&Point; 3]) -> bool {
    let outside = points.map(|point| {
        let multipliers = &point.stability.multipliers;
        let outside = multipliers.iter().filter(|m| m.norm() > 1.0);
        (!multipliers.is_empty()).then(|| outside.count())
    });
    match outside {
        [Some(a), Some(b), Some(found)] => a != b || a == found,
        _ => true,
    }
}

/// How far the states of two orbits are apart.
fn distance(a: &Point, b: &Point) -> f64 {
    product([a, b], b).sqrt()
}

/// Whether the state of an orbit is between those of two others, along their chord.
pub(crate) fn is_between(ends: [&Point; 2], found: &Point) -> bool {
    (0.0..=product(ends, ends[1])).contains(&product(ends, found))
}

/// The product of the chord of two states with the way from the first one to that of another orbit.
fn product([a, b]: [&Point; 2], point: &Point) -> f64 {
    let [from, to, here] = [a, b, point].map(|point| point.orbit.state());
    let entries = from.iter().zip(&to).zip(&here).enumerate();
    let products = entries.map(|(i, ((from, to), here))| {
        let rate = i >= a.orbit.coordinates;
        let unit = if rate { a.orbit.omega } else { 1.0 };
        (to - from) * (here - from) / (unit * unit)
    });
    products.sum()
}

/// Where a branch turns, each with the number of points before it, in order along the branch. A step with a fold has other events whose values
/// are not between those of its ends, as a touch: the branch does not turn at these. Events of a step are listed as they were found, folds
/// before touches, and not in their order along it.
fn turns(branch: &Branch) -> Vec<(usize, &Point)> {
    let (points, events) = (&branch.points, &branch.events);
    let folds = |after: usize| {
        let mut here = events.iter().filter(move |event| event.after == after);
        here.any(|event| event.kind.turns())
    };
    let turning = events.iter().filter(|event| {
        let place = event.point.value;
        event.kind.turns()
            || turns_at(points, event.after, place, |point| point.value) && !folds(event.after)
    });
    let mut turns: Vec<_> = turning.map(|event| (event.after, &event.point)).collect();
    turns.sort_by(|a, b| {
        let along = |turn: &(usize, &Point)| along(points, turn.0, turn.1);
        a.0.cmp(&b.0).then_with(|| along(a).total_cmp(&along(b)))
    });
    turns
}

/// Where an orbit between two neighbours is along the chord of their states; zero before the first one.
fn along(points: &[Point], after: usize, point: &Point) -> f64 {
    let neighbours = after
        .checked_sub(1)
        .map(|before| points.get(before..=after));
    let Some(Some([a, b])) = neighbours else {
        return 0.0;
    };
    product([a, b], point)
}

/// What a branch has at a value, in its order; what is the same is there once, since a closed branch ends where it began.
///
/// # Errors
/// Those of `between`, which finds what lies between two neighbours.
pub(crate) fn solutions<T: Clone, E>(
    chain: &[&T],
    value: f64,
    value_of: impl Fn(&T) -> f64,
    mut between: impl FnMut([&T; 2]) -> Result<T, E>,
    is_same: impl Fn(&T, &T) -> bool,
) -> Result<Vec<T>, E> {
    let mut found: Vec<T> = Vec::new();
    for (index, point) in chain.iter().enumerate() {
        let here = value_of(point);
        let passes = |next: &&&T| {
            let next = value_of(next);
            next != value && (here < value) != (next < value)
        };
        let solution = if here == value {
            (*point).clone()
        } else if let Some(next) = chain.get(index + 1).filter(passes) {
            between([point, next])?
        } else {
            continue;
        };
        if !found.iter().any(|known| is_same(known, &solution)) {
            found.push(solution);
        }
    }
    Ok(found)
}

/// Where to look for the solution at a value, between two that are given as extended unknowns.
#[derive(Debug, Clone)]
pub(crate) struct Chord {
    pub(crate) ends: [Vec<f64>; 2],
    /// What counts as one for the parameter.
    pub(crate) range: f64,
    /// The value is met to this part of it.
    pub(crate) tolerance: f64,
}

impl Chord {
    /// The solution at a value; one that does not [vanish](Located::vanishes) is only near it.
    pub(crate) fn at(
        self,
        problem: &mut dyn Problem,
        newton: &mut Newton,
        value: f64,
        options: NewtonOptions,
    ) -> Option<Located> {
        let Self {
            ends: [from, to],
            range,
            tolerance,
        } = self;
        let norm = newton.norm();
        let mut largest = [0.0; 2];
        norm.scale_at(&to, range, &mut largest);
        let scale = norm.scale_at(&from, range, &mut largest);
        let mut tangent: Vec<f64> = to.iter().zip(&from).map(|(x, y)| x - y).collect();
        let length = norm.length(scale, &tangent);
        for t in &mut tangent {
            *t /= length;
        }
        let [a, b] = [from, to].map(|u| CurvePoint {
            u,
            tangent: tangent.clone(),
            scale,
        });
        let offset = |_: &mut (dyn Problem + '_), at: &CurvePoint| (at.parameter() - value) / range;
        let chord = Step {
            before: &a,
            next: &b,
        };
        locate(problem, newton, chord, options, tolerance, offset)
    }
}
