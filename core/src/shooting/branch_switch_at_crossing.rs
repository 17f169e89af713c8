//! From a point where two branches cross onto the other one.
//!
//! There the matrix of the equations and of the parameter, `[F_s F_lambda]`, has two null vectors: the tangent `t` of the known
//! branch, and another one, `n`, taken at a right angle to it. With the left null vector `psi`, directions of branches in that
//! plane are the zeros of the quadratic form
//!
//! ```text
//! B(d, d) = psi . F''(d, d),     d = n + s t                                                                   (1)
//! ```
//!
//! `t` is one of them, so `B(t, t) = 0` and `s = -B(n, n) / (2 B(t, n))`. `F''` is taken from second differences of `F`: a law's
//! second derivatives need not exist. The first orbit is solved for with its component along `n` held, as at a pitchfork.
//!
//! Source: Keller (1977), Numerical solution of bifurcation and nonlinear eigenvalue problems, section 5 (the algebraic bifurcation
//! equation).

use nalgebra::{DMatrix, DVector};

use super::branch_switch::{Begun, FIRST_STEPS};
use super::equations::Equations;
use super::problem::ShootingProblem;
use super::start::{self, First};
use crate::branches::branch_start::BranchSwitch;
use crate::branches::error::OrbitError;
use crate::branches::point::Event;
use crate::continuation::follow::CurvePoint;
use crate::continuation::jacobian::{Jacobian, Partition};
use crate::continuation::newton::Newton;
use crate::continuation::problem::Problem;
use crate::error::Error;
use crate::time::MotionError;

/// Step of second differences, in units of the orbit's size.
const STEP: f64 = 1e-3;
/// A direction steeper than this along the known branch is that branch.
const STEEPEST: f64 = 1e3;

/// Directions at a crossing, in extended unknowns divided by what counts as one.
struct Directions {
    /// `n`
    across: DVector<f64>,
    /// `n + s t`
    other: DVector<f64>,
}

/// The first orbit of the other branch, on one side of the event, and its direction away from it.
///
/// # Errors
/// [`OrbitError::NoBranch`] if no other branch was found.
pub(super) fn switch_branch(
    problem: &ShootingProblem,
    event: &Event,
    side: f64,
    range: f64,
) -> Result<Begun, Error> {
    let nothing = || OrbitError::NoBranch {
        kind: event.kind,
        value: event.point.value,
    };
    let mut first = same(problem, event)?;
    let u = first.u.clone();
    let scale = first.size;
    let equations = &first.equations;
    let mut units: Vec<f64> = (0..u.len() - 1)
        .map(|i| scale * equations.unit(i))
        .collect();
    units.push(range);
    let directions = directions(&mut first.equations, &u, &event.tangent, &units);
    let directions = directions.ok_or_else(nothing)?;
    for part in FIRST_STEPS {
        let step = side * part;
        let point = beside(problem, &mut first, &directions, &units, step);
        if let Some(point) = point {
            first.u.clone_from(&point.u);
            return Ok(Begun { first, point });
        }
    }
    Err(nothing().into())
}

/// The equations of the event's own orbit, and the orbit as a solution of them.
fn same(problem: &ShootingProblem, event: &Event) -> Result<First, Error> {
    let point = &event.point;
    let (equations, u) = start::of_point(problem, point)?;
    let mut first = First {
        u,
        equations,
        size: point.size(),
    };
    let value = point.value;
    let motion = |reason| MotionError { value, reason };
    first.settle(problem).map_err(motion)?;
    Ok(first)
}

/// The null vectors and the solution of (1).
fn directions(
    equations: &mut Equations,
    u: &[f64],
    tangent: &[f64],
    units: &[f64],
) -> Option<Directions> {
    let n = u.len() - 1;
    if tangent.len() != u.len() {
        return None;
    }
    let mut room = vec![0.0; n];
    let mut jacobian = Jacobian::new(Partition::dense(n));
    jacobian.clear();
    equations.evaluate(u, &mut room, Some(&mut jacobian));
    // The last column of the matrix is its border, the derivative by the parameter.
    let matrix = DMatrix::from_fn(n, n + 1, |i, j| {
        jacobian.core_mut().row_mut(i)[j] * units[j] / units[i]
    });
    let right = (matrix.transpose() * &matrix).symmetric_eigen();
    let left = (&matrix * matrix.transpose()).symmetric_eigen();
    let mut order: Vec<usize> = (0..=n).collect();
    order.sort_by(|&i, &j| right.eigenvalues[i].total_cmp(&right.eigenvalues[j]));
    let [v, w] = [0, 1].map(|k| right.eigenvectors.column(order[k]).into_owned());
    let psi = left
        .eigenvectors
        .column(left.eigenvalues.imin())
        .into_owned();
    let known = DVector::from_fn(n + 1, |i, _| tangent[i] / units[i]).normalize();
    let (along, off) = (known.dot(&v), known.dot(&w));
    let t = (&v * along + &w * off).normalize();
    let across = (&w * along - &v * off).normalize();
    let mut residual = |d: &DVector<f64>, step: f64| -> f64 {
        let moved: Vec<f64> = (0..=n).map(|i| u[i] + step * d[i] * units[i]).collect();
        equations.evaluate(&moved, &mut room, None);
        (0..n).map(|i| psi[i] * room[i] / units[i]).sum()
    };
    let here = residual(&t, 0.0);
    let mut form =
        |d: &DVector<f64>| (residual(d, STEP) + residual(d, -STEP) - 2.0 * here) / (STEP * STEP);
    // B(t + n, t + n) - B(t - n, t - n) = 4 B(t, n)
    let mixed = 0.25 * (form(&(&t + &across)) - form(&(&t - &across)));
    let s = -0.5 * form(&across) / mixed;
    (s.abs() < STEEPEST).then(|| Directions {
        other: &across + &t * s,
        across,
    })
}

/// The orbit of the other branch with this component across the known one.
fn beside(
    problem: &ShootingProblem,
    first: &mut First,
    Directions { across, other }: &Directions,
    units: &[f64],
    step: f64,
) -> Option<CurvePoint> {
    let equations = &mut first.equations;
    let mut newton = Newton::new(equations);
    let range = units[units.len() - 1];
    let scale = newton.norm().scale_at(&first.u, range, &mut [0.0; 2]);
    let row: Vec<f64> = across.iter().zip(units).map(|(x, unit)| x / unit).collect();
    let along: Vec<f64> = other.iter().zip(units).map(|(x, unit)| x * unit).collect();
    let switch = BranchSwitch {
        from: &first.u,
        along: &along,
        held: &row,
        scale,
    };
    let options = problem.newton(problem.source.tolerance, equations.frame.ratio);
    switch.first_point(equations, &mut newton, step, options)
}
