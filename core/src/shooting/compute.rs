//! One orbit, or a branch of them, from a guess.

use std::time::Instant;

use super::branch_switch::{self, Begun};
use super::error_reference::ErrorReference;
use super::problem::ShootingProblem;
use super::resume_state::Rest;
use super::run::Run;
use super::start::{First, first};
use crate::branches::branch::Branch;
use crate::branches::point::{Event, Point};
use crate::branches::progress::See;
use crate::branches::request::Guess;
use crate::branches::solve::Toward;
use crate::continuation::follow::{Start, Stop};
use crate::error::Error;
use crate::model::request::RequestError;
use crate::system::Variable;
use crate::time::MotionError;

/// A branch, and what it goes on from, where it was interrupted.
pub(crate) struct Followed {
    pub(crate) branch: Branch,
    pub(crate) rest: Option<Box<Rest>>,
}

/// The orbit near a guess where what is varied has a value.
///
/// # Errors
/// If none is found.
pub(crate) fn orbit(problem: &ShootingProblem, guess: &Guess, value: f64) -> Result<Point, Error> {
    let found = first(problem, guess, value, problem.omega_at(value))?;
    read(problem, found, value)
}

/// A solution as an orbit.
///
/// # Errors
/// If its motion cannot be computed.
pub(super) fn read(problem: &ShootingProblem, found: First, value: f64) -> Result<Point, Error> {
    let (mut run, mut found) = run(problem, found)?;
    let read = run.read(&mut found.equations, &found.u);
    let (point, _) = read.map_err(|reason| MotionError { value, reason })?;
    Ok(point)
}

/// The branch from near a guess at the first value to the second.
///
/// # Errors
/// If there is no first orbit.
pub(crate) fn branch(
    problem: &ShootingProblem,
    guess: &Guess,
    [from, to]: [f64; 2],
    visit: See<'_>,
) -> Result<Followed, Error> {
    let started = Instant::now();
    let found = first(problem, guess, from, omega_between(problem, [from, to]))?;
    let near = |u: Vec<f64>| Start::Near(u);
    followed(problem, found, near, [from, to], visit, started)
}

/// The branch that begins at an event, on one side of it, within a range.
///
/// # Errors
/// If there is none.
pub(crate) fn branch_at(
    problem: &ShootingProblem,
    event: &Event,
    side: f64,
    [from, to]: [f64; 2],
    visit: See<'_>,
) -> Result<Followed, Error> {
    let started = Instant::now();
    let Begun { first, point } =
        branch_switch::switch_branch(problem, event, side, (to - from).abs())?;
    let along = |_| Start::Along(Box::new(point));
    followed(problem, first, along, [from, to], visit, started)
}

/// The first orbit of the branch that begins at an event, on one side of it, and the way that this branch goes from there; a range has this
/// length.
///
/// # Errors
/// If there is none.
pub(crate) fn beginning(
    problem: &ShootingProblem,
    event: &Event,
    side: f64,
    range: f64,
) -> Result<(Point, Toward), Error> {
    let Begun { first, point } = branch_switch::switch_branch(problem, event, side, range)?;
    let side = point.parameter_slope().signum();
    let found = read(problem, first, point.parameter())?;
    Ok((found, Toward { side, range }))
}

/// The branch from the orbit near a guess at a value to the end of a range that the value is in.
///
/// # Errors
/// If there is no such orbit.
pub(crate) fn branch_from(
    problem: &ShootingProblem,
    guess: &Guess,
    value: f64,
    [from, to]: [f64; 2],
    visit: See<'_>,
) -> Result<Followed, Error> {
    let started = Instant::now();
    let found = first(problem, guess, value, problem.omega_at(value))?;
    let side = (to - from).signum();
    let Begun { first, point } = branch_switch::resume(problem, found, side, (to - from).abs())?;
    let along = |_| Start::Along(Box::new(point));
    followed(problem, first, along, [from, to], visit, started)
}

/// Goes on with a branch that was interrupted.
///
/// # Errors
/// If what it goes on from does not belong to it.
pub(crate) fn resume(
    problem: &ShootingProblem,
    branch: &Branch,
    rest: &Rest,
    [from, to]: [f64; 2],
    visit: See<'_>,
) -> Result<Followed, Error> {
    let started = Instant::now();
    let first = rest.first(problem, branch)?.ok_or(RequestError::Rest)?;
    let (mut run, First { equations, .. }) = run(problem, first)?;
    if !run.take_up(rest, branch) {
        return Err(RequestError::Rest.into());
    }
    let options = problem.follow(from, to, equations.frame.ratio);
    let stopped = run.resume(equations, rest, options, visit)?;
    Ok(as_branch(problem, run, stopped, started))
}

/// A frequency that velocities count by.
fn omega_between(problem: &ShootingProblem, [from, to]: [f64; 2]) -> f64 {
    match problem.variable {
        Variable::Omega => (from * to).sqrt(),
        Variable::Parameter(_) => problem.omega,
    }
}

/// The branch from a solution on.
fn followed(
    problem: &ShootingProblem,
    found: First,
    start: impl FnOnce(Vec<f64>) -> Start,
    [from, to]: [f64; 2],
    visit: See<'_>,
    started: Instant,
) -> Result<Followed, Error> {
    let (mut run, First { equations, u, .. }) = run(problem, found)?;
    let options = problem.follow(from, to, equations.frame.ratio);
    let stopped = run.follow(equations, start(u), options, visit)?;
    Ok(as_branch(problem, run, stopped, started))
}

/// The branch that a run has gathered.
fn as_branch(problem: &ShootingProblem, run: Run<'_>, stopped: Stop, started: Instant) -> Followed {
    let Run {
        mut record,
        statistics,
        work,
        mut rest,
        ..
    } = run;
    record.sort(rest.as_mut().map(|rest| &mut rest.walk.kept));
    let (system, varied) = (problem.system.as_ref(), problem.varied.clone());
    let branch = Branch {
        statistics,
        work,
        elapsed: started.elapsed(),
        ..record.into_branch(system, varied, stopped)
    };
    let rest = rest.filter(|_| stopped.can_be_resumed());
    Followed { branch, rest }
}

/// A run that begins at a solution.
fn run(problem: &ShootingProblem, found: First) -> Result<(Run<'_>, First), Error> {
    let First {
        equations, size, ..
    } = &found;
    let frame = equations.frame.clone();
    let reference = ErrorReference::new(problem, equations.span.clone(), frame, *size)?;
    Ok((Run::new(problem, reference, *size), found))
}
