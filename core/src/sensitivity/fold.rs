//! Where a fold is, and how its place moves with every variable.
//!
//! A fold is a zero of the tangent's component along what is varied, found by secants along the branch; it moves as (4) of
//! [`cycle`](super::cycle) says.
//!
//! Source: Govaerts (2000), Numerical Methods for Bifurcations of Dynamical Equilibria, chapter 3.

use nalgebra::{DMatrix, DVector};

use super::cycle::{Cycle, Evaluated};
use super::error::SensitivityError;
use super::orbit::Start;
use crate::system::Variable;

/// Secants along the branch, and corrections to it.
pub(super) const STEPS: usize = 30;
/// A fold is looked for within this length of the branch, where the orbit's size and the value of what is varied are one.
const FARTHEST: f64 = 0.5;
/// So many steps in a row that come no nearer are the last.
const IDLE: usize = 3;
/// The first step, and the one below which the place does not change any more.
const FIRST: f64 = 1e-5;
pub(super) const LAST: f64 = 1e-12;
/// A fold is one if the tangent's component along what is varied fell below this.
const LEVEL: f64 = 1e-7;

/// A place with its derivatives by variables.
#[derive(Debug, Clone)]
pub(super) struct Moving {
    pub(super) states: Vec<f64>,
    /// Of what is varied.
    pub(super) value: f64,
    pub(super) by: Vec<f64>,
    /// What is known of their errors without another flow.
    pub(super) errors: Vec<f64>,
    /// An orbit beside it, that tells what being beside the place changes, where the orbit is not at the place itself.
    pub(super) near: Option<Start>,
}

impl Moving {
    /// The orbit there.
    pub(super) fn start(&self) -> Start {
        Start {
            states: self.states.clone(),
            value: self.value,
        }
    }
}

/// A row of extended unknowns as that of the states and the value.
fn split(u: &DVector<f64>) -> (Vec<f64>, f64) {
    let n = u.len() - 1;
    (u.as_slice()[..n].to_vec(), u[n])
}

/// Corrects extended unknowns to the branch, in the plane across a tangent; returns the equations there.
///
/// # Errors
/// If the motion cannot be continued, or Newton's method does not converge.
pub(super) fn onto_branch(
    cycle: &mut Cycle,
    u: &mut DVector<f64>,
    across: &DVector<f64>,
) -> Result<Evaluated, SensitivityError> {
    let varied = cycle.varied;
    let n = cycle.unknowns();
    let mut before = f64::INFINITY;
    for _ in 0..STEPS {
        let (states, value) = split(u);
        cycle.set(varied, value)?;
        let evaluated = cycle.evaluate(&states, &[varied], &[])?;
        let mut right = DVector::zeros(n + 1);
        right.rows_mut(0, n).copy_from(&-&evaluated.residual);
        let update = cycle.bordered(&evaluated, across, &right)?;
        let size = cycle.size(&states).max(f64::MIN_POSITIVE);
        let moved = cycle.size(&update.as_slice()[..n]) / size;
        let length = moved.max((update[n] / value).abs());
        *u += update;
        if cycle.has_converged(length, before) {
            let (states, value) = split(u);
            cycle.set(varied, value)?;
            return Ok(cycle.evaluate(&states, &[varied], &[])?);
        }
        if !length.is_finite() {
            break;
        }
        before = length;
    }
    Err(SensitivityError::Diverged { left: before })
}

/// The fold near states, and how its place moves.
///
/// # Errors
/// If there is none, or its motion cannot be continued.
pub(super) fn fold(
    cycle: &mut Cycle,
    states: &[f64],
    value: f64,
    variables: &[Variable],
) -> Result<Moving, SensitivityError> {
    let n = cycle.unknowns();
    let first = DVector::from_iterator(n + 1, states.iter().copied().chain([value]));
    cycle.set(cycle.varied, value)?;
    let evaluated = cycle.evaluate(states, &[cycle.varied], &[])?;
    // Beside a fold the null vector is next to the tangent, and never across it.
    let null = null_vectors(&cycle.scaled(&evaluated.jacobian))?.1;
    let null = cycle.out_of_units(&null);
    let border = DVector::from_iterator(n + 1, null.iter().copied().chain([0.0]));
    let tangent = cycle.tangent(&evaluated, Some(&border))?;
    let scale = cycle.size(states).max(f64::MIN_POSITIVE) / cycle.size(&tangent.as_slice()[..n]);
    let mut at = |along: f64| -> Result<(f64, DVector<f64>), SensitivityError> {
        let mut u = &first + &tangent * (along * scale);
        let evaluated = onto_branch(cycle, &mut u, &tangent)?;
        let slope = cycle.tangent(&evaluated, Some(&tangent))?;
        Ok((slope[n] / cycle.value(cycle.varied), u))
    };
    let (mut before, mut along) = (0.0, FIRST);
    let (mut test_before, mut u) = at(before)?;
    let (mut least, mut idle) = (test_before.abs(), 0);
    for _ in 0..STEPS {
        let (test, here) = at(along)?;
        if test.abs() < least {
            (least, u, idle) = (test.abs(), here, 0);
        } else {
            // Once the test is noise, secants lead anywhere.
            idle += 1;
        }
        let step = -test * (along - before) / (test - test_before);
        if !step.is_finite() || idle == IDLE || test == 0.0 {
            break;
        }
        (before, test_before) = (along, test);
        along = (along + step.clamp(-0.1, 0.1)).clamp(-FARTHEST, FARTHEST);
        if (along - before).abs() <= LAST {
            break;
        }
    }
    if least > LEVEL {
        return Err(SensitivityError::NoFold { moved: along });
    }
    let (states, value) = split(&u);
    cycle.set(cycle.varied, value)?;
    let by = moves_of_fold(cycle, &states, variables)?;
    Ok(Moving {
        states,
        value,
        by,
        errors: vec![0.0; variables.len()],
        near: None,
    })
}

/// (4) of [`cycle`](super::cycle)
fn moves_of_fold(
    cycle: &mut Cycle,
    states: &[f64],
    variables: &[Variable],
) -> Result<Vec<f64>, SensitivityError> {
    let asked: Vec<Variable> = std::iter::once(cycle.varied)
        .chain(variables.iter().copied())
        .collect();
    let evaluated = cycle.evaluate(states, &asked, &[])?;
    let left = null_vectors(&cycle.scaled(&evaluated.jacobian))?.0;
    let along = evaluated.by.iter().map(|by| left.dot(&cycle.in_units(by)));
    let along: Vec<f64> = along.collect();
    Ok(along[1..].iter().map(|by| -by / along[0]).collect())
}

/// The left and the right null vector of a matrix that is singular, or nearly so, of length one: by a border that makes it regular, first any
/// and then the vectors that it gives.
pub(super) fn null_vectors(
    matrix: &DMatrix<f64>,
) -> Result<(DVector<f64>, DVector<f64>), SensitivityError> {
    let n = matrix.nrows();
    let any = DVector::from_fn(n, |i, _| 1.0 + 0.3 * (i as f64).sin()).normalize();
    let (mut left, mut right) = (any.clone(), any);
    for _ in 0..3 {
        let mut bordered = DMatrix::zeros(n + 1, n + 1);
        bordered.view_mut((0, 0), (n, n)).copy_from(matrix);
        bordered.view_mut((0, n), (n, 1)).copy_from(&left);
        bordered
            .view_mut((n, 0), (1, n))
            .copy_from(&right.transpose());
        let mut unit = DVector::zeros(n + 1);
        unit[n] = 1.0;
        let solved = |matrix: DMatrix<f64>| {
            let found = matrix.lu().solve(&unit);
            let found = found.filter(|found| found.iter().all(|x| x.is_finite()));
            found.ok_or(SensitivityError::Singular)
        };
        let next = solved(bordered.clone())?;
        left = solved(bordered.transpose())?.rows(0, n).normalize();
        right = next.rows(0, n).normalize();
    }
    Ok((left, right))
}
