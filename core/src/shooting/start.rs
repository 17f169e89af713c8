//! The first orbit: from a guess to a solution, with what is known of it.

use super::equations::{Equations, Frame, Span};
use super::extremes;
use super::minimal_period::{MinimalPeriod, SameState};
use super::past_fold;
use super::problem::ShootingProblem;
use super::run::no_orbit;
use crate::branches::error::Attempts;
use crate::branches::error::OrbitError;
use crate::branches::observed::Motion;
use crate::branches::point::Point;
use crate::branches::request::Guess;
use crate::branches::solve;
use crate::continuation::newton::Newton;
use crate::error::Error;
use crate::time::MotionError;
use crate::time::{FlowError, Stretch};

/// A solution.
pub(super) struct First {
    pub(super) equations: Equations,
    pub(super) u: Vec<f64>,
    /// Largest entry of its state, of velocities in units of the frequency, from the middle of the motion.
    pub(super) size: f64,
}

/// The orbit at a value, from a guess; frequencies count by `omega`.
pub(super) fn first(
    problem: &ShootingProblem,
    guess: &Guess,
    value: f64,
    omega: f64,
) -> Result<First, Error> {
    let span = Span {
        period: problem.period,
        half: false,
        segments: problem.segments,
    };
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
    let recurrence = MinimalPeriod::of(&mut first.equations, &first.u, same, problem.odd);
    let recurrence = recurrence.map_err(motion)?;
    if recurrence.period < problem.period {
        return Err(OrbitError::NoSuchPeriod {
            period: problem.period,
            value,
            attempts: Attempts {
                planned: 1,
                made: 1,
                shorter: 1,
                evaluations: 0,
            },
        }
        .into());
    }
    if recurrence.odd {
        first.halve(problem)?;
    }
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
        point.orbit.period,
        point.orbit.symmetric,
        &point.orbit.states,
    )
}

/// The same with other states at the beginnings of the segments, over another period, or half of it.
///
/// # Errors
/// If there is no flow.
pub(super) fn through(
    problem: &ShootingProblem,
    point: &Point,
    period: usize,
    half: bool,
    states: &[f64],
) -> Result<(Equations, Vec<f64>), Error> {
    let coordinates = point.orbit.coordinates;
    let span = Span {
        period,
        half,
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
    let span = equations.span;
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

    /// Goes over to the equations of half a period.
    fn halve(&mut self, problem: &ShootingProblem) -> Result<(), Error> {
        let value = self.u[self.u.len() - 1];
        let motion = |reason| MotionError { value, reason };
        let mut state = self.equations.states_of(&self.u);
        state.truncate(self.equations.order());
        self.equations.frame.reference.fill(0.0);
        self.equations.frame.ratio = 1.0;
        let span = Span {
            half: true,
            segments: self.equations.span.segments.div_ceil(2),
            ..self.equations.span
        };
        self.equations.divide(span);
        let states = self.equations.states_from(&state, value).map_err(motion)?;
        self.u = self.equations.unknowns_of(&states, value);
        let mut newton = Newton::new(&self.equations);
        let options = problem.newton(problem.source.tolerance, 1.0);
        solve::at_value(&mut self.equations, &mut newton, &mut self.u, options)
            .map_err(|reason| no_orbit(value, reason, self.equations.failure))?;
        Ok(())
    }
}
