//! Every orbit of a branch at a value of what it varies.
//!
//! Where the branch turns has been located, so that it passes a value at most once between two neighbours of its orbits and turns. There
//! the orbit is searched along the chord of the two, or by the other ways of [`value`](crate::branches::value). Of these, in more segments: of a
//! limb with a multiplier of hundreds, motions from near the chord go to another one.

use super::compute;
use super::equations::Span;
use super::problem::ShootingProblem;
use super::start::{self, First};
use crate::branches::branch::Branch;
use crate::branches::error::OrbitError;
use crate::branches::point::Point;
use crate::branches::solve;
use crate::branches::value::{Chord, orbits_at};
use crate::continuation::newton::Newton;
use crate::error::Error;
use crate::time::MotionError;

/// The value is met to this part of the distance of the neighbours, and then exactly.
const MET: f64 = 1e-6;
/// Segments that an orbit is looked for in, in units of those that its neighbours have: first as many.
const SEGMENTS: [usize; 3] = [1, 4, 16];
/// Ways in which the orbit between two neighbours is looked for.
pub(crate) const WAYS: usize = SEGMENTS.len();
/// States that differ by this part of the orbit's size are the same.
const SAME: f64 = 1e-9;

/// The orbits at a value, in branch order.
///
/// # Errors
/// If the orbit between two neighbours is not found.
pub(crate) fn at(
    problem: &ShootingProblem,
    branch: &Branch,
    value: f64,
) -> Result<Vec<Point>, Error> {
    let search = |ends: [&Point; 2], value: f64, way: usize| between(problem, ends, value, way);
    orbits_at(branch, value, WAYS, search, is_same)
}

/// The orbit at a value from near the chord of two others, in one of the ways.
///
/// # Errors
/// If it is not found.
pub(crate) fn between(
    problem: &ShootingProblem,
    [a, b]: [&Point; 2],
    value: f64,
    way: usize,
) -> Result<Point, Error> {
    let times = SEGMENTS[way];
    let motion = |reason| MotionError { value, reason };
    let (equations, u) = start::of_point(problem, a)?;
    let mut first = First {
        u,
        equations,
        size: a.size(),
    };
    first.settle(problem).map_err(motion)?;
    let First { equations, u, .. } = &mut first;
    let mut ends = [u.clone(), equations.unknowns_of(&b.orbit.states, b.value)];
    let span = equations.span.clone();
    if times > 1 {
        let segments = times * span.segments;
        equations.divide(Span {
            segments,
            ..span.clone()
        });
        for (end, point) in ends.iter_mut().zip([a, b]) {
            let states = equations.states_from(&point.orbit.state(), point.value);
            *end = equations.unknowns_of(&states.map_err(motion)?, point.value);
        }
    }
    let mut newton = Newton::new(equations);
    let options = problem.newton(problem.source.tolerance, equations.frame.ratio);
    let chord = Chord {
        ends,
        range: (b.value - a.value).abs(),
        tolerance: MET,
    };
    let located = chord.at(equations, &mut newton, value, options);
    let lost = || OrbitError::Lost {
        value,
        from: a.value,
        to: b.value,
    };
    *u = located.ok_or_else(lost)?.point.u;
    let end = u.len() - 1;
    u[end] = value;
    solve::at_value(equations, &mut newton, u, options).map_err(|_| lost())?;
    if times > 1 {
        let states = equations.states_of(u);
        equations.divide(span);
        let order = 2 * a.orbit.coordinates;
        let fewer = states.chunks(order).step_by(times).flatten();
        let fewer: Vec<f64> = fewer.copied().collect();
        *u = equations.unknowns_of(&fewer, value);
        let mut newton = Newton::new(equations);
        solve::at_value(equations, &mut newton, u, options).map_err(|_| lost())?;
    }
    compute::read(problem, first, value)
}

fn is_same(a: &Point, b: &Point) -> bool {
    is_within(a, b, 0.0)
}

/// Whether the states of two orbits differ by rounding, or by so much more, as a part of the orbit's size.
pub(crate) fn is_within(a: &Point, b: &Point, more: f64) -> bool {
    let size = a.size();
    let (first, second) = (a.orbit.state(), b.orbit.state());
    let mut pairs = first.iter().zip(&second).enumerate();
    pairs.all(|(i, (x, y))| {
        let unit = if i < a.orbit.coordinates {
            1.0
        } else {
            a.orbit.omega
        };
        (x - y).abs() <= (SAME + more) * size * unit
    })
}
