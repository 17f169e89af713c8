//! Where an event is, and how its place moves with every variable.
//!
//! A fold is a zero of the tangent's component along what is varied, found by secants along the branch; it moves as (4) of
//! [`cycle`](super::cycle) says. An orbit grazes where a gap has an extreme on a level,
//!
//! ```text
//! g(s, lambda, p) = gap(tau*) - level = 0,   gap'(tau*) = 0,   dlambda/dp = - (g_s s_p + g_p) / (g_s s_lambda + g_lambda),   (1)
//! ```
//!
//! with the derivatives of the states at a fixed value of what is varied, since the place `tau*` of an extreme counts by its square only.
//!
//! Source: Govaerts (2000), Numerical Methods for Bifurcations of Dynamical Equilibria, chapter 3; di Bernardo, Budd, Champneys and
//! Kowalczyk (2008), Piecewise-smooth Dynamical Systems, section 6.2 (grazing).

use std::sync::Arc;

use nalgebra::{DMatrix, DVector};

use super::cycle::{AtStop, Cycle, Evaluated, Stop};
use super::error::SensitivityError;
use super::orbit::Start;
use super::scan::{Scan, Turn};
use super::slopes::{Direction, Slopes};
use crate::system::{System, Variable};

/// Secants along the branch, and corrections to it.
const STEPS: usize = 30;
/// A fold is looked for within this length of the branch, where the orbit's size and the value of what is varied are one.
const FARTHEST: f64 = 0.5;
/// So many steps in a row that come no nearer are the last.
const IDLE: usize = 3;
/// The first step, and the one below which the place does not change any more.
const FIRST: f64 = 1e-5;
const LAST: f64 = 1e-12;
/// A fold is one if the tangent's component along what is varied fell below this.
const LEVEL: f64 = 1e-7;
/// An extreme of a gap is taken to be on a level within this part of the orbit.
const TOUCH: f64 = 1e-2;

/// A place with its derivatives by variables.
#[derive(Debug, Clone)]
pub(super) struct Moving {
    pub(super) states: Vec<f64>,
    /// Of what is varied.
    pub(super) value: f64,
    pub(super) by: Vec<f64>,
    /// What is known of their errors without another flow.
    pub(super) errors: Vec<f64>,
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
    let null = null_vectors(&evaluated.jacobian)?.1;
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
    let left = null_vectors(&evaluated.jacobian)?.0;
    let along: Vec<f64> = evaluated.by.iter().map(|by| left.dot(by)).collect();
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

/// The orbit near states that grazes, and how its place moves.
///
/// # Errors
/// If there is none, or its motion cannot be continued.
pub(super) fn grazing(
    cycle: &mut Cycle,
    system: &Arc<dyn System>,
    states: &[f64],
    value: f64,
    variables: &[Variable],
) -> Result<Moving, SensitivityError> {
    let mut slopes = Slopes::new(system, &[]);
    let (mut states, mut value) = (states.to_vec(), value);
    let mut touch: Option<(usize, usize, Turn)> = None;
    for _ in 0..STEPS {
        cycle.set(cycle.varied, value)?;
        cycle.solve(&mut states)?;
        slopes.set(&cycle.values, cycle.omega);
        let scan = Scan::of(cycle, &slopes, &states, true)?;
        let near = nearest(&slopes, &scan, touch)
            .filter(|(_, distance)| distance.abs() <= TOUCH * cycle.size(&states));
        let ((contact, level, turn), distance) = near.ok_or(SensitivityError::NoTouch)?;
        if slopes.jumps(contact, level) {
            return Err(SensitivityError::Jumps);
        }
        let arc = &scan.arcs[turn.arc];
        let stop = Stop {
            segment: arc.segment,
            phase: turn.phase,
        };
        let grows = distances(
            cycle,
            &slopes,
            &states,
            &[cycle.varied],
            stop,
            |at, along| {
                let at = slopes.at(turn.phase, &at.state, &arc.pieces);
                slopes.distance_along(&at, contact, level, along)[0]
            },
        )?;
        let step = -distance / grows[0];
        touch = Some((contact, level, turn));
        if step.abs() <= LAST * value.abs() || !step.is_finite() {
            let asked: Vec<Variable> = std::iter::once(cycle.varied)
                .chain(variables.iter().copied())
                .collect();
            let grows = distances(cycle, &slopes, &states, &asked, stop, |at, along| {
                let at = slopes.at(turn.phase, &at.state, &arc.pieces);
                slopes.distance_along(&at, contact, level, along)[0]
            })?;
            let by = grows[1..].iter().map(|by| -by / grows[0]).collect();
            return Ok(Moving {
                states,
                value,
                by,
                errors: vec![0.0; variables.len()],
            });
        }
        value += step.clamp(-0.01 * value.abs(), 0.01 * value.abs());
    }
    Err(SensitivityError::NoTouch)
}

/// How a distance at a stop grows with variables, at a fixed value of all others.
fn distances(
    cycle: &mut Cycle,
    slopes: &Slopes,
    states: &[f64],
    variables: &[Variable],
    stop: Stop,
    of: impl Fn(&AtStop, Direction<'_>) -> f64,
) -> Result<Vec<f64>, SensitivityError> {
    let order = cycle.order();
    let evaluated = cycle.evaluate(states, variables, &[stop])?;
    let lu = evaluated.jacobian.clone().lu();
    let at = &evaluated.stops[0];
    let grows = variables.iter().enumerate().map(|(index, &variable)| {
        let moved = lu
            .solve(&-&evaluated.by[index])
            .ok_or(SensitivityError::Singular)?;
        let begin = &moved.as_slice()[stop.segment * order..][..order];
        let own = (0..variables.len()).map(|other| f64::from(u8::from(other == index)));
        let mut here = vec![0.0; order];
        at.moved(begin, own, &mut here);
        let by = slopes.by(variable);
        Ok(of(
            at,
            Direction {
                state: &here,
                by: Some(&by),
                phase: 0.0,
            },
        ))
    });
    grows.collect()
}

/// The extreme of a gap that is nearest to a level, and how far it is above it: of the contact, the level and the phase of the last one, if
/// that is known.
fn nearest(
    slopes: &Slopes,
    scan: &Scan,
    last: Option<(usize, usize, Turn)>,
) -> Option<((usize, usize, Turn), f64)> {
    let mut found: Option<((usize, usize, Turn), f64, f64)> = None;
    for turn in &scan.turns {
        for level in 0..slopes.levels(turn.contact) {
            let distance = turn.gap - slopes.level(turn.contact, level);
            let away = match last {
                None => distance.abs(),
                Some((contact, own, before)) if contact == turn.contact && own == level => {
                    (turn.phase - before.phase).abs()
                }
                Some(_) => continue,
            };
            if found.as_ref().is_none_or(|(_, _, least)| away < *least) {
                found = Some(((turn.contact, level, *turn), distance, away));
            }
        }
    }
    found.map(|(place, distance, _)| (place, distance))
}
