//! One orbit, or a branch of them, from a guess: [`newton`](crate::continuation::newton) solves for the first orbit, damped, and where that
//! leads nowhere with more nodes and from the orbit by another method; the [engine](crate::branches::engine) follows the branch.

use std::f64::consts::TAU;
use std::time::Instant;

use super::branch::accept_orbit::{REFUSALS, RELOCATED};
use super::branch::method::ContactBranch;
use super::branch::resume_state::Rest;
use super::equations::Equations;
use super::equations::setting::Frame;
use super::guess::Guess;
use super::orbit;
use super::orbit::gaps::Gaps;
use super::problem::{ContactProblem, FIRST, RESOLUTIONS};
use super::reading::minimal_period::Compared;
use super::run::Run;
use super::skeleton::Skeleton;
use super::switches::fits::Fits;
use super::switches::plan::Plan;
use crate::branches::branch::Branch;
use crate::branches::error::OrbitError;
use crate::branches::observed::Motion;
use crate::branches::point::Point;
use crate::branches::problem::BranchProblem;
use crate::branches::progress::See;
use crate::branches::recurrence::Recurrence;
use crate::branches::solve::Toward;
use crate::branches::{engine, solve};
use crate::continuation::follow::{CurvePoint, FollowOptions, Start, Stop};
use crate::continuation::newton::{Newton, NewtonError, NewtonOptions};
use crate::error::Error;
use crate::model::request::RequestError;

/// An update of Newton's method that is as small a part of the tolerance is the last one.
const UPDATE: f64 = 1e-2;
const COARSEST: f64 = 1e-6;
/// Resolutions that a first orbit is looked for with.
const TRIED: [usize; 3] = [FIRST, 5, 7];

/// Samples of the linear response that say how large it is.
const SEEN: usize = 64;
/// Parts of its size that an orbit differs by from one that comes back earlier, where it was found to six digits.
const GUESSED: f64 = 1e-5;

/// How a first orbit is solved for.
pub(super) const AT_START: NewtonOptions = NewtonOptions {
    tolerance: 1e-10,
    iterations: 40,
    damped: true,
};

/// Where a first orbit is looked for.
pub(crate) struct Guesses<'g, 'p> {
    /// What needs no search.
    pub(crate) untouched: Option<Untouched<'p>>,
    /// An orbit that is cheap to have, where that is none.
    pub(crate) first: Option<&'g Point>,
    /// How the orbit comes back, where that is known. Beside an event another one may be as near that comes back earlier, or with an image.
    pub(crate) like: Option<Recurrence>,
    /// The orbit by another method, for where that leads nowhere.
    pub(crate) better: &'g mut dyn FnMut() -> Result<Point, Error>,
}

/// The response of the linear part where no contact acts on it.
pub(crate) struct Untouched<'p>(Run<'p>, Vec<f64>);

/// A branch, and what it goes on from, where it was interrupted.
pub(crate) struct Followed {
    pub(crate) branch: Branch,
    pub(crate) rest: Option<Box<Rest>>,
}

/// A first orbit.
pub(super) struct First {
    pub(super) equations: Equations,
    pub(super) u: Vec<f64>,
    pub(super) frame: Frame,
    pub(super) resolution: usize,
}

/// The orbit near another one where what is varied has a value.
///
/// # Errors
/// If none is found.
pub(crate) fn orbit<'p>(
    problem: &'p ContactProblem,
    guesses: Guesses<'_, 'p>,
    value: f64,
) -> Result<Point, Error> {
    let (run, u) = begun(problem, guesses, value)?;
    read(run, u, value)
}

/// The orbit near a motion where what is varied has a value.
///
/// # Errors
/// If none is found.
pub(super) fn orbit_near(
    problem: &ContactProblem,
    guess: &Guess<'_>,
    value: f64,
) -> Result<Point, Error> {
    let first = first(problem, guess, value)?;
    let (run, u) = fitting(problem, first).ok_or(lost(value))?;
    read(run, u, value)
}

/// The orbit near a motion that comes back as it does, at its value: equations that fit it, and its unknowns.
pub(super) fn like<'p>(
    problem: &'p ContactProblem,
    guess: &Guess<'_>,
) -> Option<(Run<'p>, Vec<f64>)> {
    let Point { value, orbit, .. } = guess.point;
    let first = first_like(problem, guess, *value, &orbit.recurrence()).ok()?;
    fitting(problem, first)
}

/// What is read off an orbit, which is solved for again with more nodes where its own overlook something, or its errors ask for them.
///
/// # Errors
/// If it is lost where nodes overlook something.
fn read(mut run: Run<'_>, mut u: Vec<f64>, value: f64) -> Result<Point, Error> {
    let mut found = None;
    let mut relocated = 0;
    loop {
        let newton = Newton::new(&run.equations);
        let at = CurvePoint {
            scale: solve::scale_at(&newton, &u),
            tangent: vec![0.0; u.len() - 1].into_iter().chain([1.0]).collect(),
            u,
        };
        let Some(read) = run.read(&at) else {
            return found.ok_or_else(|| lost(value).into());
        };
        if (read.overlooks.is_some() || run.excess(&read.point) > 1.0)
            && relocated < RELOCATED
            && let Some(there) = at_moved_kinks(&mut run, &at.u)
        {
            relocated += 1;
            u = there;
            continue;
        }
        let wanted = if let Some(overlooked) = read.overlooks {
            // Nodes that step over a narrow place of a law have not seen the orbit.
            overlooked.needed
        } else {
            let wanted = run.is_coarse(&read.point).then_some(run.resolution + 1);
            found = Some(read.point);
            wanted
        };
        let finer = wanted.and_then(|wanted| solved_with(&mut run, &at.u, wanted));
        let Some(finer) = finer else {
            // What was found stands, with its error.
            return found.ok_or_else(|| lost(value).into());
        };
        u = finer;
    }
}

/// An orbit solved for again with another resolution, in equations that fit it.
pub(super) fn solved_with(run: &mut Run<'_>, u: &[f64], resolution: usize) -> Option<Vec<f64>> {
    run.resolution = resolution;
    let (equations, mut u) = run.replanned(u)?;
    run.equations = equations;
    let mut newton = Newton::new(&run.equations);
    solve::at_value(&mut run.equations, &mut newton, &mut u, AT_START).ok()?;
    run.clear_finer();
    // What nodes see now may have other switches.
    run.equations.compute(&u, false);
    let fits = !run.equations.failed && run.fits(&u) != Fits::No;
    fits.then_some(u)
}

fn lost(value: f64) -> OrbitError {
    OrbitError::NoStart {
        value,
        reason: NewtonError::NotFinite { iterations: 0 },
    }
}

/// The branch from near an orbit at the first value to the second.
///
/// # Errors
/// If there is no first orbit.
pub(crate) fn branch<'p>(
    problem: &'p ContactProblem,
    guesses: Guesses<'_, 'p>,
    [from, to]: [f64; 2],
    visit: See<'_>,
) -> Result<Followed, Error> {
    let started = Instant::now();
    let (mut run, u) = begun(problem, guesses, from)?;
    let options = options(problem, from, to);
    let mut branch = ContactBranch::new(&mut run, visit);
    let outcome = engine::run(&mut branch, Start::Near(u), options);
    let rest = branch.rest.take();
    ended(problem, run, rest, outcome, options.from, started)
}

/// The branch from near an orbit at a value on, one way, in a range that the value is in.
///
/// # Errors
/// If there is no such orbit.
pub(crate) fn branch_from<'p>(
    problem: &'p ContactProblem,
    guesses: Guesses<'_, 'p>,
    value: f64,
    toward: Toward,
    [from, to]: [f64; 2],
    visit: See<'_>,
) -> Result<Followed, Error> {
    let started = Instant::now();
    let (mut run, u) = begun(problem, guesses, value)?;
    let options = options(problem, from, to);
    let mut newton = Newton::new(&run.equations);
    let along = solve::along(&mut run.equations, &mut newton, u, toward, options.newton);
    let along = along.map_err(|reason| OrbitError::NoStart { value, reason })?;
    run.statistics += newton.statistics;
    let mut branch = ContactBranch::new(&mut run, visit);
    let outcome = engine::run(&mut branch, Start::Along(Box::new(along)), options);
    let rest = branch.rest.take();
    ended(problem, run, rest, outcome, value, started)
}

/// Goes on with a branch that was interrupted.
///
/// # Errors
/// If what it goes on from does not belong to it.
pub(crate) fn resume(
    problem: &ContactProblem,
    branch: &Branch,
    rest: &Rest,
    [from, to]: [f64; 2],
    visit: See<'_>,
) -> Result<Followed, Error> {
    let started = Instant::now();
    let mut run = rest.run(problem, branch).ok_or(RequestError::Rest)?;
    let options = options(problem, from, to);
    let mut branch = ContactBranch::new(&mut run, visit);
    if !rest.walk.tests(branch.watched().len()) || !branch.take_up(rest) {
        return Err(RequestError::Rest.into());
    }
    let outcome = engine::resume(&mut branch, rest.walk.clone(), options);
    let rest = branch.rest.take();
    ended(problem, run, rest, outcome, options.from, started)
}

/// How a branch is followed from a value to another one.
fn options(problem: &ContactProblem, from: f64, to: f64) -> FollowOptions {
    let mut options = problem.asked.follow(from, to, 1.0);
    // What is left after the last update is far less.
    let enough = (UPDATE * problem.tolerance).min(COARSEST);
    options.newton.tolerance = options.newton.tolerance.max(enough);
    options
}

/// The branch that a run has gathered, as the engine has ended.
///
/// # Errors
/// If there is no first orbit.
fn ended(
    problem: &ContactProblem,
    run: Run<'_>,
    mut rest: Option<Box<Rest>>,
    outcome: Result<Stop, NewtonError>,
    from: f64,
    started: Instant,
) -> Result<Followed, Error> {
    let joined = run.joined.as_ref();
    let joined = joined.map(|joined| joined.joined_at(run.record.joint().unwrap_or(from)));
    let stopped = match (outcome, joined) {
        (Ok(_), Some(joined)) => joined,
        (Ok(stopped), None) => stopped,
        (Err(reason), _) => {
            return Err(OrbitError::NoStart {
                value: from,
                reason,
            }
            .into());
        }
    };
    let Run {
        mut record,
        statistics,
        ..
    } = run;
    if let (true, Stop::StepTooShort { reason, .. }) = (record.points.is_empty(), stopped) {
        // The first orbit was solved for, and cannot be told to be one.
        return Err(OrbitError::NoStart {
            value: from,
            reason,
        }
        .into());
    }
    let asked = &problem.asked;
    let (system, varied) = (asked.system.as_ref(), asked.varied.clone());
    record.sort(rest.as_mut().map(|rest| &mut rest.walk.kept));
    let branch = Branch {
        statistics,
        elapsed: started.elapsed(),
        ..record.into_branch(system, varied, stopped)
    };
    let rest = rest.filter(|_| stopped.can_be_resumed());
    Ok(Followed { branch, rest })
}

/// A run whose equations fit a first orbit, and its unknowns.
fn begun<'p>(
    problem: &'p ContactProblem,
    guesses: Guesses<'_, 'p>,
    value: f64,
) -> Result<(Run<'p>, Vec<f64>), Error> {
    let Guesses {
        untouched,
        first: guess,
        like,
        better,
    } = guesses;
    if let Some(Untouched(run, u)) = untouched {
        return Ok((run, u));
    }
    let guess = guess.ok_or(lost(value))?;
    let fitting = |guess: &Guess<'_>| {
        let first = first(problem, guess, value)?;
        let found = fitting(problem, first);
        let is_it = |run: &Run<'_>| {
            let found = run.equations.skeleton.recurrence();
            like.as_ref().is_none_or(|like| like == found)
        };
        let found = found.filter(|(run, _)| is_it(run));
        found.ok_or_else(|| Error::from(lost(value)))
    };
    fitting(&Guess::of(problem, guess)?).or_else(|reason| {
        let Ok(better) = better() else {
            return Err(reason);
        };
        fitting(&Guess::by_motion(problem, &better)?)
    })
}

/// The response of the linear part, with the equations that fit it, where no contact acts on it: it is an orbit then. A search by the balance would end there
/// as well, since it begins with the response of the system as it is at rest, and with many modes takes longer than a branch.
pub(crate) fn untouched(problem: &ContactProblem, value: f64) -> Option<Untouched<'_>> {
    if problem.asked.period != 1 {
        return None;
    }
    let mut recurrence = Recurrence::whole(1);
    loop {
        let first = untouched_like(problem, value, &recurrence)?;
        if let Some(earlier) = problem.earlier(&first.equations, problem.same()) {
            recurrence = earlier;
            continue;
        }
        let (run, u) = fitting(problem, first)?;
        return is_untouched(&run.equations.skeleton).then_some(Untouched(run, u));
    }
}

/// No contact acts, and none is about to.
fn is_untouched(skeleton: &Skeleton) -> bool {
    let mut intervals = skeleton.intervals.iter();
    let free =
        intervals.all(|interval| interval.active.is_empty() && interval.configuration.is_none());
    free && skeleton.switches.is_empty()
}

/// The same, until it comes back like this.
fn untouched_like(problem: &ContactProblem, value: f64, recurrence: &Recurrence) -> Option<First> {
    let values = problem.setting.values(value)?;
    if values.has_resonance() {
        return None;
    }
    let coordinates = values.linear.rows.len();
    let at = |phase: f64, state: &mut [f64]| {
        let mut steady = vec![0.0; 2 * coordinates];
        values.write_steady(phase, &mut steady, None);
        values.linear.write_physical(&steady, state);
    };
    let mut motions = vec![Motion::NONE; coordinates];
    let mut state = vec![0.0; 2 * coordinates];
    for sample in 0..SEEN {
        at(TAU * sample as f64 / SEEN as f64, &mut state);
        for (motion, x) in motions.iter_mut().zip(&state) {
            motion.include(*x);
        }
    }
    let gaps = Gaps {
        values: &values,
        at: &at,
        coordinates,
    };
    let plan = Plan::sampled(&gaps, recurrence);
    let sampled = untouched_with(problem, value, &plan, &gaps, &motions)?;
    // Steps along the branch are measured by the size that the orbit has, and not by how it was sampled.
    let extremes = orbit::motion::Motion::of(&sampled.equations).coordinate_extremes();
    for (motion, [minimum, maximum]) in motions.iter_mut().zip(extremes) {
        motion.minimum = minimum.value;
        motion.maximum = maximum.value;
    }
    untouched_with(problem, value, &plan, &gaps, &motions)
}

/// The same where coordinates have these extremes.
fn untouched_with(
    problem: &ContactProblem,
    value: f64,
    plan: &Plan,
    gaps: &Gaps<'_>,
    motions: &[Motion],
) -> Option<First> {
    let ranges = motions.iter().map(|of| 0.5 * of.peak_to_peak());
    let size = ranges.fold(0.0, f64::max);
    if size == 0.0 {
        return None;
    }
    let middles = motions.iter().map(Motion::middle);
    let frame = Frame {
        reference: middles.chain(vec![0.0; motions.len()]).collect(),
        size,
        resolution: RESOLUTIONS[FIRST],
    };
    let (mut equations, mut u) = plan.equations(&problem.setting, value, gaps, &frame)?;
    if !is_untouched(&equations.skeleton) {
        return None;
    }
    let mut newton = Newton::new(&equations);
    solve::at_value(&mut equations, &mut newton, &mut u, AT_START).ok()?;
    Some(First {
        equations,
        u,
        frame,
        resolution: FIRST,
    })
}

/// Goes over to equations that fit a first orbit. A guess may have had other switches. `None` where none are found.
fn fitting(problem: &ContactProblem, first: First) -> Option<(Run<'_>, Vec<f64>)> {
    let First {
        equations,
        mut u,
        frame,
        resolution,
    } = first;
    let mut run = Run::new(problem, frame, resolution, equations);
    for tried in 0..=REFUSALS {
        run.equations.compute(&u, false);
        if run.equations.failed {
            return None;
        }
        if run.fits(&u) != Fits::No {
            // Another orbit may come back earlier than the one that was looked for.
            let other = tried > 0 && problem.earlier(&run.equations, problem.same()).is_some();
            return (!other).then(|| at_kinks(run, u));
        }
        if tried < REFUSALS {
            (run.equations, u) = run.replanned(&u)?;
            let mut newton = Newton::new(&run.equations);
            solve::at_value(&mut run.equations, &mut newton, &mut u, AT_START).ok()?;
        }
    }
    None
}

/// A first orbit with panels that end at its kinks: those of the guess are elsewhere.
fn at_kinks(mut run: Run<'_>, mut u: Vec<f64>) -> (Run<'_>, Vec<f64>) {
    for _ in 0..RELOCATED {
        let Some(there) = at_moved_kinks(&mut run, &u) else {
            break;
        };
        u = there;
    }
    (run, u)
}

/// An orbit solved for again with panels that end at its kinks, if they end elsewhere; the equations are those of the last pass where it is not found.
fn at_moved_kinks(run: &mut Run<'_>, u: &[f64]) -> Option<Vec<f64>> {
    if !run.has_moved_kinks() {
        return None;
    }
    let mut equations = run.equations.at_kinks(u)?;
    let mut there = run.equations.rearranged(&equations, u);
    let mut newton = Newton::new(&equations);
    solve::at_value(&mut equations, &mut newton, &mut there, AT_START).ok()?;
    let former = std::mem::replace(&mut run.equations, equations);
    run.equations.compute(&there, false);
    if run.equations.failed || run.fits(&there) == Fits::No {
        run.equations = former;
        run.equations.compute(u, false);
        return None;
    }
    run.clear_finer();
    Some(there)
}

/// A solution near an orbit that is given by its series. What comes back earlier is followed until then only.
fn first(problem: &ContactProblem, guess: &Guess<'_>, value: f64) -> Result<First, Error> {
    let whole = Recurrence::whole(problem.asked.period);
    let seen = seen_in(problem, guess).filter(|seen| seen.period == whole.period);
    let seen = seen.and_then(|seen| first_like(problem, guess, value, &seen).ok());
    let mut first = match seen {
        Some(first) => first,
        None => first_like(problem, guess, value, &whole)?,
    };
    // Each time it comes back in less time than the last.
    while let Some(found) = problem.earlier(&first.equations, problem.same()) {
        if found.period < whole.period {
            return Err(OrbitError::of_shorter_period(whole.period, value).into());
        }
        first = first_like(problem, guess, value, &found)?;
    }
    Ok(first)
}

/// How a guess comes back in less time than is asked for, as far as it tells.
fn seen_in(problem: &ContactProblem, guess: &Guess<'_>) -> Option<Recurrence> {
    let at = |phase: f64, state: &mut [f64]| guess.write(phase, state);
    let compared = Compared {
        begin: 0.0,
        rate: guess.rate(),
        most: GUESSED * guess.point.size(),
        coordinates: guess.point.orbit.coordinates(),
    };
    let whole = Recurrence::whole(problem.asked.period);
    compared.earlier(&at, &whole, &problem.asked.symmetries)
}

/// A solution that comes back like this.
fn first_like(
    problem: &ContactProblem,
    guess: &Guess<'_>,
    value: f64,
    recurrence: &Recurrence,
) -> Result<First, OrbitError> {
    let mut last = OrbitError::NoStart {
        value,
        reason: NewtonError::NotFinite { iterations: 0 },
    };
    for resolution in TRIED {
        match first_with(problem, guess, value, resolution, recurrence) {
            Ok(first) => return Ok(first),
            Err(reason) => last = OrbitError::NoStart { value, reason },
        }
    }
    Err(last)
}

fn first_with(
    problem: &ContactProblem,
    guess: &Guess<'_>,
    value: f64,
    resolution: usize,
    recurrence: &Recurrence,
) -> Result<First, NewtonError> {
    let mut first = planned(problem, guess, value, resolution, recurrence)?;
    let mut newton = Newton::new(&first.equations);
    solve::at_value(&mut first.equations, &mut newton, &mut first.u, AT_START)?;
    Ok(first)
}

/// The equations of an orbit near a guess, with unknowns that are not solved for.
pub(super) fn planned(
    problem: &ContactProblem,
    guess: &Guess<'_>,
    value: f64,
    resolution: usize,
    recurrence: &Recurrence,
) -> Result<First, NewtonError> {
    let unusable = NewtonError::NotFinite { iterations: 0 };
    let values = problem.setting.values(value).ok_or(unusable)?;
    let coordinates = guess.point.orbit.coordinates();
    // The orbit goes on at the pace of the value that is asked for.
    let pace = values.base / guess.rate();
    let at = |phase: f64, state: &mut [f64]| {
        guess.write(phase, state);
        for v in &mut state[coordinates..] {
            *v *= pace;
        }
    };
    let gaps = Gaps {
        values: &values,
        at: &at,
        coordinates,
    };
    let plan = Plan::sampled(&gaps, recurrence);
    let observed = &guess.point.observed;
    let middles = observed.motions.iter().map(Motion::middle);
    let frame = Frame {
        reference: middles.chain(vec![0.0; coordinates]).collect(),
        size: guess.point.size(),
        resolution: RESOLUTIONS[resolution],
    };
    let planned = plan.equations(&problem.setting, value, &gaps, &frame);
    let (equations, u) = planned.ok_or(unusable)?;
    Ok(First {
        equations,
        u,
        frame,
        resolution,
    })
}
