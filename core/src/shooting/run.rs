//! What is done with the curve of orbits that is followed: multipliers and extremes of every orbit, events, and where it ends.

use nalgebra::DMatrix;

use super::equations::Equations;
use super::error_reference::ErrorReference;
use super::extremes;
use super::method::ShootingBranch;
use super::minimal_period::{SameState, earlier, passes_between};
use super::output_error::{At, Errors, output_error};
use super::problem::ShootingProblem;
use super::resume_state::Rest;
use super::signals::Reader;
use crate::branches::engine;
use crate::branches::error::OrbitError;
use crate::branches::moduli::{self, multipliers};
use crate::branches::observed::{Motion, Observed};
use crate::branches::orbit::Orbit;
use crate::branches::point::Point;
use crate::branches::problem::BranchProblem;
use crate::branches::progress::See;
use crate::branches::record::Record;
use crate::branches::recurrence::{Recurrence, may_be_earlier};
use crate::continuation::follow::{FollowOptions, Start, Stop};
use crate::continuation::newton::NewtonError;
use crate::continuation::statistics::Statistics;
use crate::error::Error;
use crate::event::EventKind;
use crate::model::request::RequestError;
use crate::orbit::observe::Accuracy;
use crate::orbit::stability::Stability;
use crate::time::MotionError;
use crate::time::{FlowError, Stretch, Work};

/// A first coordinate that moves by less than so many times the error of the states is at rest.
const STILL: f64 = 10.0;

/// What a run has gathered.
pub(super) struct Run<'r> {
    pub(super) problem: &'r ShootingProblem,
    pub(super) reference: ErrorReference,
    pub(super) size: f64,
    /// What the branch has met.
    pub(super) joined: Option<Recurrence>,
    /// Error of the states of the orbit read last; not a number where it is not known.
    pub(super) state_error: f64,
    pub(super) record: Record,
    /// Why an orbit that was found could not be read.
    pub(super) failure: Option<FlowError>,
    pub(super) statistics: Statistics,
    /// Work of flows that are no more.
    pub(super) work: Work,
    /// Where it was before the last step.
    pub(super) rest: Option<Box<Rest>>,
}

impl<'r> Run<'r> {
    pub(super) fn new(problem: &'r ShootingProblem, reference: ErrorReference, size: f64) -> Self {
        Self {
            problem,
            reference,
            size,
            joined: None,
            state_error: f64::NAN,
            record: Record::default(),
            failure: None,
            statistics: Statistics::default(),
            work: Work::default(),
            rest: None,
        }
    }

    /// Follows the branch from where it starts to its end.
    ///
    /// # Errors
    /// If there is no first orbit.
    pub(super) fn follow(
        &mut self,
        equations: Equations,
        start: Start,
        options: FollowOptions,
        visit: See<'_>,
    ) -> Result<Stop, Error> {
        let mut branch = ShootingBranch::new(self, equations, visit);
        let outcome = engine::run(&mut branch, start, options);
        branch.count_flows();
        let failed = branch.equations.failure;
        self.stopped(outcome, failed, options)
    }

    /// Goes on from where it was interrupted.
    ///
    /// # Errors
    /// None, but for a rest of another run.
    pub(super) fn resume(
        &mut self,
        equations: Equations,
        rest: &Rest,
        options: FollowOptions,
        visit: See<'_>,
    ) -> Result<Stop, Error> {
        let mut branch = ShootingBranch::new(self, equations, visit);
        if !rest.walk.tests(branch.watched().len()) {
            return Err(RequestError::Rest.into());
        }
        let outcome = engine::resume(&mut branch, rest.walk.clone(), options);
        branch.count_flows();
        let failed = branch.equations.failure;
        self.stopped(outcome, failed, options)
    }

    /// Why the branch ended, as the engine has.
    ///
    /// # Errors
    /// If there is no first orbit.
    fn stopped(
        &mut self,
        outcome: Result<Stop, NewtonError>,
        failed: Option<FlowError>,
        options: FollowOptions,
    ) -> Result<Stop, Error> {
        let failure = self.failure.or(failed);
        self.statistics += self.reference.newton.statistics;
        self.work += self.reference.work();
        let value = self
            .record
            .points
            .last()
            .map_or(options.from, |point| point.value);
        if let Some(joined) = &self.joined {
            return Ok(joined.joined_at(self.record.joint().unwrap_or(value)));
        }
        match (outcome, self.failure, failure) {
            (_, Some(reason), _) if self.record.points.is_empty() => {
                Err(MotionError { value, reason }.into())
            }
            (Ok(_), _, Some(FlowError::Cancelled { .. })) if !self.record.points.is_empty() => {
                Ok(Stop::Interrupted)
            }
            (Err(reason), _, failure) => Err(no_orbit(options.from, reason, failure)),
            (_, Some(reason), _) | (Ok(Stop::StepTooShort { .. }), _, Some(reason)) => {
                Ok(Stop::Motion { value, reason })
            }
            (Ok(stop), ..) => Ok(stop),
        }
    }

    /// How near two states are that are one.
    pub(super) fn same_state(&self, equations: &Equations) -> SameState {
        SameState {
            size: self.size,
            part: self.problem.same(equations.frame.ratio),
        }
    }

    /// Why the branch ends at the last event, if the orbit there is more regular than asked for: what follows is the
    /// same orbits again, looked at from elsewhere. There it turns too, and rounding may tell its fold from its branch point.
    pub(super) fn meets(&mut self, equations: &mut Equations) -> Option<Stop> {
        let symmetries = &self.problem.symmetries;
        let event = self.record.events.last()?;
        if !may_be_earlier(&equations.span.recurrence, symmetries)
            && self.problem.at_once.is_empty()
        {
            return None;
        }
        let (kind, after, value) = (event.kind, event.after, event.point.value);
        let u = equations.unknowns_of(&event.point.orbit.states, event.point.value);
        let same = self.same_state(equations).at_point();
        // Along a resonance orbits shrink by orders of magnitude.
        let own = event.point.size();
        let same = SameState {
            size: if own > 0.0 {
                same.size.min(own)
            } else {
                same.size
            },
            ..same
        };
        let state = event.point.orbit.state();
        let is_fold = kind == EventKind::Fold;
        let recurrence = match earlier(equations, &u, same, symmetries) {
            Ok(Some(recurrence)) => recurrence,
            Ok(None) if !is_fold && self.gains_symmetry(equations, &state, same) => {
                equations.span.recurrence.clone()
            }
            _ => return None,
        };
        if is_fold {
            // Of the whole step: a part of it may have the fold without the branch point.
            let [from, to] = [after.checked_sub(1)?, after].map(|place| {
                let point = self.record.points.get(place)?;
                Some(equations.unknowns_of(&point.orbit.states, point.value))
            });
            let (from, to) = (from?, to?);
            let passed = passes_between(equations, [&from, &to], &recurrence, symmetries);
            passed.ok().filter(|passed| *passed)?;
        }
        // The orbits behind the point are those before it.
        self.record.points.truncate(after);
        self.record.is_joint(after);
        let stop = recurrence.joined_at(value);
        self.joined = Some(recurrence);
        Some(stop)
    }

    /// An orbit with everything that is read off it, and its map if the stability is wanted. With a flow that has a tolerance, it
    /// is the orbit corrected for that.
    pub(super) fn read(
        &mut self,
        equations: &mut Equations,
        u: &[f64],
    ) -> Result<(Point, Option<DMatrix<f64>>), FlowError> {
        let Self {
            problem, reference, ..
        } = self;
        if !problem.stability {
            return observe(problem, equations, u);
        }
        self.statistics.monodromies += 1;
        let corrected = reference.correct(u);
        let finer = corrected.as_ref().filter(|_| reference.finer);
        let (at, known) = match finer {
            Some(finer) => (&mut reference.equations, &finer.u[..]),
            None => (&mut *equations, u),
        };
        let (mut point, map) = observe(problem, at, known)?;
        let Some(map) = map else {
            return Ok((point, None));
        };
        let found = multipliers(&map, reference.equations.span.recurrence.parts);
        let (mut spread, in_states) = reference.errors(&map, &found);
        let mut error = in_states * self.size;
        if let Some(corrected) = &corrected {
            let other = reference.multipliers_beside(corrected);
            spread += reference.part * moduli::distance(&found, &other, map.nrows());
            error += reference.part * reference.equations.apart(u, &corrected.u);
        } else {
            spread = f64::INFINITY;
            error = f64::INFINITY;
        }
        self.state_error = error;
        let stated = match (problem.accuracy, &corrected) {
            (Accuracy::Output(output), Some(corrected)) => {
                let here = At { equations, u };
                let there = At {
                    equations: &mut reference.equations,
                    u: &corrected.u,
                };
                let errors = Errors {
                    part: reference.part,
                    states: in_states,
                    size: self.size,
                };
                let (best, other) = if reference.finer {
                    (there, here)
                } else {
                    (here, there)
                };
                output_error(problem, output, &point.observed, best, other, errors)?
            }
            (accuracy, _) => relative(error, &point, accuracy),
        };
        point.error = Some(stated);
        point.stability = if found.is_empty() {
            Stability::unknown()
        } else {
            problem.stability(found, map.nrows(), spread)
        };
        Ok((point, Some(map)))
    }
}

/// An orbit without its stability, and its map if the stability is wanted.
pub(super) fn observe(
    problem: &ShootingProblem,
    equations: &mut Equations,
    u: &[f64],
) -> Result<(Point, Option<DMatrix<f64>>), FlowError> {
    let value = u[u.len() - 1];
    let rate = problem.rate_at(value);
    let mut extremes = vec![Motion::NONE; equations.order() / 2];
    let recurrence = equations.span.recurrence.clone();
    let mut outputs = problem.output_reader(value, &recurrence);
    let see = &mut |stretch: &dyn Stretch| {
        extremes::include(stretch, rate, &mut extremes);
        if let Some(outputs) = &mut outputs {
            outputs.include(stretch);
        }
    };
    let before = equations.flow.work().switches;
    let map = if problem.stability {
        Some(equations.map(u, see)?)
    } else {
        equations.trace(u, see)?;
        None
    };
    let switches = equations.flow.work().switches - before;
    extremes::over_images(&mut extremes, &recurrence.image);
    let point = Point {
        value,
        parameters: problem.parameters_at(value),
        orbit: orbit_of(equations, u, problem.omega_at(value), rate),
        stability: Stability::unknown(),
        observed: Observed {
            outputs: outputs.map_or_else(Vec::new, Reader::motions),
            ..Observed::extremes(extremes, switches * recurrence.parts)
        },
        error: None,
    };
    Ok((point, map))
}

/// The orbit of a solution at an excitation frequency, whose phase moves so fast.
pub(super) fn orbit_of(equations: &Equations, u: &[f64], omega: f64, rate: f64) -> Orbit {
    let Recurrence {
        period,
        parts,
        image,
    } = equations.span.recurrence.clone();
    Orbit {
        series: Vec::new(),
        states: equations.states_of(u),
        coordinates: equations.order() / 2,
        omega,
        base: rate / period as f64,
        period,
        parts,
        symmetric: image.is_minus(),
        image,
    }
}

/// Why there is no orbit.
pub(super) fn no_orbit(value: f64, reason: NewtonError, failure: Option<FlowError>) -> Error {
    match failure {
        Some(reason) => MotionError { value, reason }.into(),
        None => OrbitError::NoStart { value, reason }.into(),
    }
}

/// An error of states as a part of peak-to-peak: of the first coordinate's, or the one that accuracy is asked of, unless it is at rest, else
/// of the largest.
pub(super) fn relative(error: f64, point: &Point, accuracy: Accuracy) -> f64 {
    let own = match accuracy {
        Accuracy::Coordinate(_) => accuracy.peak_to_peak(&point.observed),
        Accuracy::Coordinates | Accuracy::Output(_) => point.peak_to_peak(),
    };
    error
        / if own > STILL * error {
            own
        } else {
            2.0 * point.size()
        }
}
