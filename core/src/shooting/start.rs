//! The first orbit: from a guess to a solution, with what is known of it.

use super::equations::{Equations, Frame, Span};
use super::extremes;
use super::minimal_period::{SameState, earlier};
use super::past_fold;
use super::problem::ShootingProblem;
use super::run::no_orbit;
use crate::branches::error::OrbitError;
use crate::branches::observed::Motion;
use crate::branches::point::Point;
use crate::branches::recurrence::Recurrence;
use crate::branches::request::Guess;
use crate::branches::solve;
use crate::continuation::newton::Newton;
use crate::error::{Error, ErrorKind};
use crate::time::MotionError;
use crate::time::{FlowError, Stretch};

/// A solution.
pub(super) struct First {
    pub(super) equations: Equations,
    pub(super) u: Vec<f64>,
    /// Largest entry of its state, of velocities in units of the frequency, from the middle of the motion.
    pub(super) size: f64,
}

/// Segments, in units of those asked for, where fewer lead to no orbit: motions part from an unstable one by its multiplier, and over a
/// part of the period by a root of it.
const MORE_SEGMENTS: [usize; 2] = [4, 16];

/// The orbit at a value, from a guess; frequencies count by `omega`. From a series in more segments too, if need be.
///
/// # Errors
/// If none is found.
pub(super) fn first(
    problem: &ShootingProblem,
    guess: &Guess,
    value: f64,
    omega: f64,
) -> Result<First, Error> {
    let found = first_in(problem, guess, value, omega, problem.segments);
    if !matches!(guess, Guess::Orbit(orbit) if orbit.has_series()) {
        return found;
    }
    let more = MORE_SEGMENTS.map(|times| times * problem.segments);
    more.into_iter().fold(found, |found, segments| match found {
        Err(reason) if is_lost(&reason) => {
            let found = first_in(problem, guess, value, omega, segments);
            found.map_err(|other| if is_lost(&other) { reason } else { other })
        }
        found => found,
    })
}

/// Whether no orbit was found at all.
fn is_lost(reason: &Error) -> bool {
    let of_shorter = matches!(reason.downcast_ref(), Some(OrbitError::NoSuchPeriod { .. }));
    matches!(reason.kind(), ErrorKind::NoOrbit | ErrorKind::Motion) && !of_shorter
}

/// The same in so many segments.
fn first_in(
    problem: &ShootingProblem,
    guess: &Guess,
    value: f64,
    omega: f64,
    segments: usize,
) -> Result<First, Error> {
    let span = Span::of(Recurrence::whole(problem.period), segments);
    let coordinates = problem.flow(problem.source.tolerance)?.coordinates();
    let frame = Frame::plain(problem.variable, coordinates, omega);
    let mut equations = Equations::new(problem, problem.source.tolerance, span, frame)?;
    let motion = |reason| MotionError { value, reason };
    let states = states(problem, &mut equations, guess, value).map_err(motion)?;
    let mut u = equations.unknowns_of(&states, value);
    let mut newton = Newton::new(&equations);
    let options = problem.newton_at_start();
    let solved = solve::at_value(&mut equations, &mut newton, &mut u, options);
    if let Err(reason) = solved {
        let reason = no_orbit(value, reason, equations.failure);
        u = past_fold::search(problem, &mut equations, &u, value, reason)?;
    }
    let mut first = First {
        equations,
        u,
        size: 1.0,
    };
    first.settle(problem).map_err(motion)?;
    let same = first.same_state(problem);
    let found = earlier(&mut first.equations, &first.u, same, &problem.symmetries);
    let Some(recurrence) = found.map_err(motion)? else {
        return Ok(first);
    };
    if recurrence.period < problem.period {
        return Err(OrbitError::of_shorter_period(problem.period, value).into());
    }
    first.follow_part(problem, recurrence)?;
    Ok(first)
}

/// The equations of an orbit that is known, and the orbit as a solution of them.
///
/// # Errors
/// If there is no flow.
pub(super) fn of_point(
    problem: &ShootingProblem,
    point: &Point,
) -> Result<(Equations, Vec<f64>), Error> {
    through(
        problem,
        point,
        point.orbit.recurrence(),
        &point.orbit.states,
    )
}

/// The same with other states at the beginnings of the segments, over another time.
///
/// # Errors
/// If there is no flow.
pub(super) fn through(
    problem: &ShootingProblem,
    point: &Point,
    recurrence: Recurrence,
    states: &[f64],
) -> Result<(Equations, Vec<f64>), Error> {
    let coordinates = point.orbit.coordinates;
    let span = Span {
        recurrence,
        segments: states.len() / (2 * coordinates),
    };
    let frame = Frame::plain(problem.variable, coordinates, point.orbit.omega);
    let equations = Equations::new(problem, problem.source.tolerance, span, frame)?;
    let u = equations.unknowns_of(states, point.value);
    Ok((equations, u))
}

/// States at the beginnings of the segments.
fn states(
    problem: &ShootingProblem,
    equations: &mut Equations,
    guess: &Guess,
    value: f64,
) -> Result<Vec<f64>, FlowError> {
    let span = equations.span.clone();
    match guess {
        Guess::Orbit(orbit) if orbit.has_series() => {
            let n = orbit.coordinates();
            let mut states = Vec::with_capacity(2 * n * span.segments);
            for segment in 0..span.segments {
                let time = span.begins(segment) * f64::from(problem.divisor) / orbit.omega;
                let motions = (0..n).filter_map(|i| orbit.state_at(i, time));
                let (positions, velocities): (Vec<f64>, Vec<f64>) = motions.unzip();
                states.extend(positions);
                states.extend(velocities);
            }
            Ok(states)
        }
        // Where motions part fast, its own states are nearer than what comes of the first.
        Guess::Orbit(orbit) if orbit.parts == 1 && orbit.states().count() == span.segments => {
            Ok(orbit.states.clone())
        }
        Guess::Orbit(orbit) => equations.states_from(&orbit.state(), value),
        Guess::State(state) => equations.states_from(state, value),
    }
}

impl First {
    /// How near two states are that are one.
    pub(super) fn same_state(&self, problem: &ShootingProblem) -> SameState {
        SameState {
            size: self.size,
            part: problem.same(self.equations.frame.ratio),
        }
    }

    /// Counts positions from the middle of the motion, and finds its size.
    pub(super) fn settle(&mut self, problem: &ShootingProblem) -> Result<(), FlowError> {
        let value = self.u[self.u.len() - 1];
        let n = self.equations.order() / 2;
        let rate = problem.rate_at(value);
        let mut extremes = vec![Motion::NONE; n];
        let see = &mut |stretch: &dyn Stretch| extremes::include(stretch, rate, &mut extremes);
        self.equations.trace(&self.u, see)?;
        extremes::over_images(&mut extremes, &self.equations.span.recurrence.image);
        let states = self.equations.states_of(&self.u);
        self.equations.frame.reference = extremes.iter().map(Motion::middle).collect();
        self.u = self.equations.unknowns_of(&states, value);
        let largest = |m: f64, extremes: &Motion| m.max(0.5 * extremes.peak_to_peak());
        let size = extremes.iter().fold(0.0, largest);
        self.size = if size > 0.0 { size } else { 1.0 };
        let frame = &mut self.equations.frame;
        let farthest = |m: f64, x: &f64| m.max(x.abs());
        frame.ratio = 1.0 + frame.reference.iter().fold(0.0, farthest) / self.size;
        Ok(())
    }

    /// Goes over to the equations of the time after which the orbit comes back.
    fn follow_part(
        &mut self,
        problem: &ShootingProblem,
        recurrence: Recurrence,
    ) -> Result<(), Error> {
        let value = self.u[self.u.len() - 1];
        let motion = |reason| MotionError { value, reason };
        let mut state = self.equations.states_of(&self.u);
        state.truncate(self.equations.order());
        let segments = self.equations.span.segments;
        self.equations.divide(Span::of(recurrence, segments));
        let states = self.equations.states_from(&state, value).map_err(motion)?;
        self.u = self.equations.unknowns_of(&states, value);
        let mut newton = Newton::new(&self.equations);
        let options = problem.newton(problem.source.tolerance, self.equations.frame.ratio);
        solve::at_value(&mut self.equations, &mut newton, &mut self.u, options)
            .map_err(|reason| no_orbit(value, reason, self.equations.failure))?;
        self.settle(problem).map_err(motion)?;
        Ok(())
    }
}
