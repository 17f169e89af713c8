//! Every orbit of a branch at a value of what it varies.
//!
//! Where the branch turns has been located, so that it passes a value at most once between two neighbours of its orbits and turns. There
//! the orbit is searched along the chord of the two.

use super::cycle::{Cycle, CycleBranch};
use super::setting::Setting;
use super::start::{self, First};
use super::{compute, solve};
use crate::branches::error::OrbitError;
use crate::continuation::follow::CurvePoint;
use crate::continuation::locate::locate;
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
    let chain = chain(branch);
    let mut found: Vec<Cycle> = Vec::new();
    for (index, cycle) in chain.iter().enumerate() {
        let next = chain.get(index + 1);
        let passes =
            |next: &&&Cycle| next.value != value && (cycle.value < value) != (next.value < value);
        let solution = if cycle.value == value {
            (*cycle).clone()
        } else if let Some(next) = next.filter(passes) {
            between(setting, [cycle, next], value)?
        } else {
            continue;
        };
        // A closed branch ends where it began.
        if !found.iter().any(|known| is_same(known, &solution)) {
            found.push(solution);
        }
    }
    Ok(found)
}

/// Orbits and turns of a branch in their order along it.
fn chain(branch: &CycleBranch) -> Vec<&Cycle> {
    let turns_after = |index| {
        let events = branch.events.iter();
        let events = events.filter(move |event| event.after == index && event.kind.turns());
        events.map(|event| &event.cycle)
    };
    let cycles = branch.cycles.iter().enumerate();
    cycles
        .flat_map(|(index, cycle)| turns_after(index).chain([cycle]))
        .collect()
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
    let range = (b.value - a.value).abs();
    let mut largest = [0.0; 2];
    newton.norm().scale_at(&last, range, &mut largest);
    let scale = newton.norm().scale_at(u, range, &mut largest);
    let mut tangent: Vec<f64> = last.iter().zip(&*u).map(|(x, y)| x - y).collect();
    let length = newton.norm().length(scale, &tangent);
    for t in &mut tangent {
        *t /= length;
    }
    let [from, to] = [u.clone(), last].map(|u| CurvePoint {
        u,
        tangent: tangent.clone(),
        scale,
    });
    let options = setting.newton(setting.source.tolerance, equations.frame.ratio);
    let offset = |point: &CurvePoint| (point.parameter() - value) / range;
    let ends = (&from, &to);
    let located = locate(equations, &mut newton, ends, options, MET, offset);
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
