//! Every orbit of a branch at a value of what it varies.
//!
//! Where the branch turns has been located, so that it passes a value at most once between two neighbours of its orbits and turns. There
//! the orbit is searched along the chord of the two.

use super::cycle::{Cycle, CycleBranch};
use super::setting::Setting;
use super::start::{self, First};
use super::{compute, solve};
use crate::branches::error::OrbitError;
use crate::branches::value::{Chord, chain, solutions, turns_at};
use crate::continuation::newton::Newton;
use crate::error::Error;
use crate::time::MotionError;

/// The value is met to this part of the distance of the neighbours, and then exactly.
const MET: f64 = 1e-6;
/// States that differ by this part of the orbit's size are the same.
const SAME: f64 = 1e-9;

/// The orbits at a value, in branch order.
///
/// # Errors
/// If the orbit between two neighbours is not found.
pub(super) fn at(setting: &Setting, branch: &CycleBranch, value: f64) -> Result<Vec<Cycle>, Error> {
    let turns = branch.events.iter().filter(|event| {
        let (cycles, place) = (&branch.cycles, event.cycle.value);
        event.kind.turns() || turns_at(cycles, event.after, place, |cycle| cycle.value)
    });
    let turns: Vec<_> = turns.map(|event| (event.after, &event.cycle)).collect();
    solutions(
        &chain(&branch.cycles, &turns),
        value,
        |cycle| cycle.value,
        |ends| between(setting, ends, value),
        is_same,
    )
}

fn between(setting: &Setting, [a, b]: [&Cycle; 2], value: f64) -> Result<Cycle, Error> {
    let motion = |reason| MotionError { value, reason };
    let (equations, u) = start::known(setting, a)?;
    let mut first = First {
        u,
        equations,
        iterations: 0,
        size: a.size(),
    };
    if !a.symmetric {
        first.settle(setting).map_err(motion)?;
    }
    let First { equations, u, .. } = &mut first;
    let last = equations.unknowns_of(&b.states, b.value);
    let mut newton = Newton::new(equations);
    let options = setting.newton(setting.source.tolerance, equations.frame.ratio);
    let chord = Chord {
        ends: [u.clone(), last],
        range: (b.value - a.value).abs(),
        tolerance: MET,
    };
    let located = chord.at(equations, &mut newton, value, options);
    let lost = OrbitError::Lost {
        value,
        from: a.value,
        to: b.value,
    };
    let Some(located) = located else {
        return Err(lost.into());
    };
    *u = located.point.u;
    let end = u.len() - 1;
    u[end] = value;
    solve::at_value(equations, &mut newton, u, options).map_err(|_| lost)?;
    compute::read(setting, first, value)
}

fn is_same(a: &Cycle, b: &Cycle) -> bool {
    let size = a.size();
    let coordinates = a.extremes.len();
    let mut pairs = a.state().iter().zip(b.state()).enumerate();
    pairs.all(|(i, (x, y))| {
        let unit = if i < coordinates { 1.0 } else { a.omega };
        (x - y).abs() <= SAME * size * unit
    })
}
