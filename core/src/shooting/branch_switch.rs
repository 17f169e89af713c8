//! From an event of one branch onto the branch that begins there. Where branches cross without a symmetry, see
//! [`branch_switch_at_crossing`](super::branch_switch_at_crossing).
//!
//! Let `P` be the derivative of the flow over the part of the orbit that is followed, and `S` as in
//! [`equations`](super::equations). At a period doubling, and where a symmetry breaks, `M = S^-1 P` has the eigenvalue minus
//! one, so
//!
//! ```text
//! P v = -S v                                                                                                 (1)
//! ```
//!
//! The orbit taken twice, `q` and then `S q`, is an orbit of the new branch too, and the direction of that branch is `v` along
//! the first part and `-S v` along the second. It leaves the old branch at a right angle, as a pitchfork does: for a step `e`
//! in that direction the parameter changes by `e^2` only. So the first orbit is solved for with its component in that direction
//! held, from there, and not with the parameter held.
//!
//! Source: Govaerts (2000), Numerical Methods for Bifurcations of Dynamical Equilibria, chapter 8 (branch switching); Seydel
//! (2010), Practical Bifurcation and Stability Analysis, section 5.6.

use nalgebra::DMatrix;

use super::equations::Equations;
use super::minimal_period::earlier;
use super::problem::ShootingProblem;
use super::start::{self, First};
use crate::branches::branch_start::BranchSwitch;
use crate::branches::error::OrbitError;
use crate::branches::point::{Event, Point};
use crate::branches::recurrence::SignedPermutation;
use crate::branches::solve::{Toward, along};
use crate::continuation::follow::CurvePoint;
use crate::continuation::newton::Newton;
use crate::continuation::problem::Scale;
use crate::error::Error;
use crate::event::EventKind;
use crate::numeric::spectrum::eigenvalues;
use crate::time::MotionError;

/// Components of the first orbit in the direction of the new branch, in units of the orbit's size: the first that leads to an
/// orbit of the new branch is taken.
pub(super) const FIRST_STEPS: [f64; 5] = [1e-2, 3e-3, 3e-2, 1e-3, 1e-1];

/// An orbit with the direction in which a branch is followed from it.
pub(super) struct Begun {
    pub(super) first: First,
    pub(super) point: CurvePoint,
}

/// The first orbit of the branch that begins at an event, on one side of it; `range` is the length that counts as one for the
/// parameter.
///
/// # Errors
/// [`OrbitError::NoBranch`] if no branch begins there, or its first orbit was not found.
pub(super) fn switch_branch(
    problem: &ShootingProblem,
    event: &Event,
    side: f64,
    range: f64,
) -> Result<Begun, Error> {
    let nothing = OrbitError::NoBranch {
        kind: event.kind,
        value: event.point.value,
    };
    if event.kind == EventKind::BranchPoint || is_crossing(problem, event)? {
        return super::branch_switch_at_crossing::switch_branch(problem, event, side, range);
    }
    if !matches!(
        event.kind,
        EventKind::PeriodDoubling | EventKind::SymmetryBreaking
    ) {
        return Err(nothing.into());
    }
    let (mut equations, u) = twice(problem, &event.point)?;
    let Some(direction) = direction(&mut equations, &u, &event.point.orbit.image) else {
        return Err(nothing.into());
    };
    let mut first = First {
        equations,
        u,
        size: 1.0,
    };
    let motion = |reason| MotionError {
        value: event.point.value,
        reason,
    };
    first.settle(problem).map_err(motion)?;
    for part in FIRST_STEPS {
        let step = side * part;
        if let Some(point) = first_orbit(problem, &mut first, &direction, step, range) {
            let same = first.same_state(problem);
            let found = earlier(&mut first.equations, &point.u, same, &problem.symmetries);
            if found.is_ok_and(|found| found.is_none()) {
                first.u.clone_from(&point.u);
                return Ok(Begun { first, point });
            }
        }
    }
    Err(nothing.into())
}

/// Whether a symmetry breaks by a multiplier of one: coordinates cease to be in each other's place at every time.
pub(super) fn is_crossing(problem: &ShootingProblem, event: &Event) -> Result<bool, Error> {
    if event.kind != EventKind::SymmetryBreaking {
        return Ok(false);
    }
    let value = event.point.value;
    let (mut equations, u) = start::of_point(problem, &event.point)?;
    let map = equations.map(&u, &mut |_| {});
    let map = map.map_err(|reason| MotionError { value, reason })?;
    let nearest = |critical: f64| {
        let distances = eigenvalues(&map).into_iter().map(|m| (m - critical).norm());
        distances.fold(f64::INFINITY, f64::min)
    };
    Ok(nearest(1.0) < nearest(-1.0))
}

/// An orbit that is known, with the direction of its branch: to larger values of the parameter for a positive side.
///
/// # Errors
/// If it does not solve the equations.
pub(super) fn resume(
    problem: &ShootingProblem,
    mut first: First,
    side: f64,
    range: f64,
) -> Result<Begun, Error> {
    let mut newton = Newton::new(&first.equations);
    let options = problem.newton(problem.source.tolerance, first.equations.frame.ratio);
    let value = first.u[first.u.len() - 1];
    let toward = Toward { side, range };
    let point = along(
        &mut first.equations,
        &mut newton,
        first.u.clone(),
        toward,
        options,
    )
    .map_err(|reason| super::run::no_orbit(value, reason, first.equations.failure))?;
    first.u.clone_from(&point.u);
    Ok(Begun { first, point })
}

/// The equations of the new branch, and the orbit as a solution of them.
fn twice(problem: &ShootingProblem, point: &Point) -> Result<(Equations, Vec<f64>), Error> {
    let orbit = &point.orbit;
    let again = orbit.image.of_states(&orbit.states, orbit.coordinates);
    let states = [&orbit.states[..], &again].concat();
    start::through(problem, point, orbit.recurrence().doubled(), &states)
}

/// The direction of the new branch in extended unknowns, from (1) with the image `S` of coordinates on the known one; its entry for the
/// parameter is zero.
pub(super) fn direction(
    equations: &mut Equations,
    u: &[f64],
    image: &SignedPermutation,
) -> Option<Vec<f64>> {
    let order = equations.order();
    let maps = equations.segment_maps(u).ok()?;
    let part = &maps[..maps.len() / 2];
    let identity = DMatrix::<f64>::identity(order, order);
    let whole = part.iter().fold(identity, |p, map| map * p);
    let mut sum = whole;
    for i in 0..order {
        let (place, sign) = image.state_entry(i, order / 2);
        sum[(i, place)] += sign;
    }
    let svd = sum.svd(false, true);
    let smallest = svd.singular_values.imin();
    let mut v = svd.v_t?.row(smallest).transpose();
    let mut direction = Vec::with_capacity(u.len());
    for map in &maps {
        direction.extend(v.iter().enumerate().map(|(i, x)| x * equations.unit(i)));
        v = map * v;
    }
    direction.push(0.0);
    direction.iter().all(|x| x.is_finite()).then_some(direction)
}

/// The orbit whose component in the direction is `step` times the size, and the tangent there, away from the old branch.
fn first_orbit(
    problem: &ShootingProblem,
    first: &mut First,
    direction: &[f64],
    step: f64,
    range: f64,
) -> Option<CurvePoint> {
    let equations = &mut first.equations;
    let mut newton = Newton::new(equations);
    let scale = scale_of(&newton, &first.u, range);
    let length = newton.norm().length(scale, direction);
    let unit: Vec<f64> = direction.iter().map(|x| x / length).collect();
    let mut row = vec![0.0; unit.len()];
    newton.norm().linear_form(scale, &unit, &mut row);
    let switch = BranchSwitch {
        from: &first.u,
        along: &unit,
        held: &row,
        scale,
    };
    let options = problem.newton(problem.source.tolerance, equations.frame.ratio);
    switch.first_point(equations, &mut newton, step, options)
}

fn scale_of(newton: &Newton, u: &[f64], range: f64) -> Scale {
    newton.norm().scale_at(u, range, &mut [0.0; 2])
}
