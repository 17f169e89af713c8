//! Free oscillation of a conservative system.
//!
//! Without damping and excitation, a motion that starts at rest and is at rest again half a period later goes back the way it came
//! (the equations do not change when time is turned round). So an orbit is a position `q_0` and a frequency `omega` with
//!
//! ```text
//! v(pi / omega; q_0, 0) = 0                                                                                  (1)
//! ```
//!
//! Rest at the beginning is the phase condition. The first coordinate of `q_0` is what is varied, so that a frequency that does not
//! depend on the amplitude, or turns back, is followed as any other.
//!
//! Source: Kerschen, Peeters, Golinval and Vakakis (2009), Nonlinear normal modes, part I, Mech. Syst. Signal Process. 23, section
//! 3.2 (shooting with a phase condition); Lamb and Roberts (1998), Time-reversal symmetry in dynamical systems, Physica D 112
//! (orbits that return on their way).

use std::f64::consts::PI;
use std::ops::ControlFlow;
use std::sync::Arc;
use std::time::Instant;

use super::oscillation::Equations;
use crate::bifurcation::error::BifurcationError;
use crate::branches::branch::{Branch, Model};
use crate::branches::error::OrbitError;
use crate::branches::point::Point;
use crate::branches::progress::{Progress, Stage};
use crate::cancel::Cancel;
use crate::continuation::follow::{
    Continue, FollowOptions, Halt, Outcome, Start, Stop, Visit, follow,
};
use crate::continuation::newton::{Newton, NewtonError, NewtonOptions};
use crate::continuation::step_control::{self, StepControl};
use crate::error::Error;
use crate::model::error::ModelError;
use crate::model::request::RequestError;
use crate::model::{self, validate};
use crate::response::read_by_shooting;
use crate::system::System;
use crate::time::{self, FlowError, MotionError};

/// A motion that has not come back to this part of its size is not free.
const RETURNED: f64 = 1e-6;
const POINTS: usize = 5000;

/// The frequency of free oscillation over its amplitude: set up step by step, then [run](FreeOscillation::run).
///
/// It gives a [`Branch`] over the frequency, whose orbits are known by two states, at rest where they begin and half a period later:
/// [`Orbit::states`](crate::Orbit::states). What is not read off them [`Branch::complete`] has. Nothing is known of their stability: what is
/// conserved neither grows nor decays.
///
/// ```
/// use hertzian::backbone::FreeOscillation;
///
/// hertzian::oscillator! {
///     Hertz(x) {
///         ddot(x) + sgn(x)*|x|^1.5 = 0;
///     }
/// }
///
/// let curve = FreeOscillation::of(&Hertz {}).from(0.5).to(2.0).run()?;
/// // omega = 0.95469357 a^(1/4), by a quadrature of the period.
/// let last = curve.points.last().unwrap();
/// assert!((last.omega() - 0.95469356972851 * 2_f64.powf(0.25)).abs() < 1e-9);
/// assert!((last.peak_to_peak() - 4.0).abs() < 1e-9);
/// assert_eq!(curve.to_csv().lines().count(), 1 + curve.points.len());
/// # Ok::<(), hertzian::Error>(())
/// ```
#[derive(Debug, Clone)]
pub struct FreeOscillation {
    system: Arc<dyn System>,
    from: Option<f64>,
    to: Option<f64>,
    near: Option<(Vec<f64>, f64)>,
    tolerance: f64,
    max_points: usize,
    largest_step: f64,
    cancel: Cancel,
}

impl FreeOscillation {
    /// Of this system, whose damping and excitation must be zero at the parameters it has.
    pub fn of(system: &dyn System) -> Self {
        Self {
            system: system.shared(),
            from: None,
            to: None,
            near: None,
            tolerance: 1e-12,
            max_points: POINTS,
            largest_step: StepControl::default().largest,
            cancel: Cancel::new(),
        }
    }

    hertzian_contract::setters! { self:
        /// Position of the first coordinate at rest where the curve begins.
        from(position: f64) { self.from = Some(position) }

        /// The same where it ends.
        to(position: f64) { self.to = Some(position) }

        /// The first oscillation is near these positions at rest and this frequency: needed where there are several coordinates.
        near_rest(positions: &[f64], omega: f64) { self.near = Some((positions.to_vec(), omega)) }

        /// Tolerance of the flow, where it is not in closed form. Default: 1e-12.
        tolerance(tolerance: f64) { self.tolerance = tolerance }

        /// Largest step along the curve, as [`FrequencyResponse::largest_step`](crate::response::FrequencyResponse::largest_step) measures
        /// it. Default: 0.1.
        largest_step(step: f64) { self.largest_step = step }

        /// What is computed ends when this token is cancelled, the search for the first oscillation too.
        cancel(cancel: &Cancel) { self.cancel = cancel.clone() }

        /// Stop after this many points. Default: 5000.
        max_points(points: usize) { self.max_points = points }
    }

    /// Follows the curve from one position to the other.
    ///
    /// # Errors
    /// If a parameter or an option is not usable, nothing oscillates at the first position, or a motion does not come back because
    /// the system has damping or an excitation. A curve that ends early is not an error: it comes back with what was computed and
    /// with [`Branch::stopped`].
    pub fn run(&self) -> Result<Branch, Error> {
        self.run_with(|_| ControlFlow::Continue(()))
    }

    /// As [`run`](Self::run), and calls `visit` at every point as it is found: to show progress, or to stop. Its value is the position at
    /// rest.
    ///
    /// # Errors
    /// As [`run`](Self::run).
    pub fn run_with(
        &self,
        mut visit: impl FnMut(Progress<'_>) -> ControlFlow<()>,
    ) -> Result<Branch, Error> {
        let started = Instant::now();
        let options = self.options()?;
        let mut equations = self.equations()?;
        let mut u = self.first(&mut equations, options.from)?;
        u.push(options.from);
        equations.measure(&u);
        let mut newton = Newton::new(&equations);
        let mut points: Vec<Point> = Vec::new();
        let mut failure = None;
        let mut position = options.from;
        let outcome = follow(
            &mut equations,
            &mut newton,
            Start::Near(u),
            options,
            &mut |equations, _, seen| {
                let Visit::Point(at) = seen else {
                    return Continue::Continue(());
                };
                let point = match equations.read(&at.u) {
                    Ok((point, apart)) if apart <= RETURNED => point,
                    found => {
                        failure = Some(found.map(|(_, apart)| apart));
                        return Continue::Break(Halt::Stop);
                    }
                };
                position = equations.position(&at.u);
                let progress = Progress {
                    point: Some(&point),
                    ..Progress::at(Stage::Curve, points.len() + 1, position)
                };
                let answer = visit(progress);
                points.push(point);
                answer.map_break(|()| Halt::Stop)
            },
        );
        let stopped = self.stopped(points.is_empty(), position, failure, outcome)?;
        let omega = points.first().map_or(1.0, Point::omega);
        Ok(Branch {
            model: Model::of(&self.system),
            varied: "omega".to_owned(),
            points,
            events: Vec::new(),
            turns: Vec::new(),
            begin: None,
            stopped,
            statistics: newton.statistics,
            work: equations.flow.work(),
            elapsed: started.elapsed(),
            further: read_by_shooting(&self.system, self.tolerance, omega),
        })
    }

    /// Why it ended, at this position.
    ///
    /// # Errors
    /// If nothing was found, or a motion is not free.
    fn stopped(
        &self,
        nothing: bool,
        value: f64,
        failure: Option<Result<f64, FlowError>>,
        outcome: Result<Outcome, NewtonError>,
    ) -> Result<Stop, Error> {
        let cancelled = self.cancel.is_cancelled();
        Ok(match (failure, outcome) {
            _ if cancelled && !nothing => Stop::Interrupted,
            _ if cancelled => return Err(OrbitError::Cancelled { value }.into()),
            (Some(Ok(apart)), _) => return Err(BifurcationError::NotFree { apart }.into()),
            (Some(Err(reason)), _) if nothing => return Err(MotionError { value, reason }.into()),
            (Some(Err(reason)), _) => Stop::Motion { value, reason },
            (None, Err(reason)) => return Err(OrbitError::NoStart { value, reason }.into()),
            (None, Ok(Outcome::Stopped(stop))) => stop,
            // A walk along free oscillations is never resized.
            (None, Ok(Outcome::Halted(_))) => Stop::Interrupted,
        })
    }

    /// Range and accuracy, checked.
    fn options(&self) -> Result<FollowOptions, Error> {
        let from = self.from.ok_or(RequestError::no_end("from"))?;
        let to = self.to.ok_or(RequestError::no_end("to"))?;
        for (name, value) in [("from", from), ("to", to)] {
            validate::option(name, value, -1e300..=1e300, "must be finite")?;
        }
        if from == to {
            return Err(RequestError::EmptyRange { value: from }.into());
        }
        Ok(FollowOptions {
            from,
            to,
            points: step_control::max_points(self.max_points)?,
            steps: step_control::largest_step(self.largest_step)?,
            newton: NewtonOptions {
                tolerance: (100.0 * self.tolerance).clamp(1e-11, 1e-6),
                iterations: 12,
                damped: false,
            },
        })
    }

    /// The equations of the system, checked.
    fn equations(&self) -> Result<Equations, Error> {
        let facts = self.system.facts();
        if facts.coordinates.is_empty() {
            return Err(ModelError::NoCoordinates.into());
        }
        let cancel = self.cancel.clone();
        let mut flow = time::of(&self.system, 1.0, self.tolerance)?;
        flow.until(&cancel);
        let parameters = model::values(&self.system);
        Ok(Equations::new(flow, parameters, facts.divisor, cancel))
    }

    /// The unknowns of the first oscillation.
    fn first(&self, equations: &mut Equations, from: f64) -> Result<Vec<f64>, Error> {
        let n = equations.flow.coordinates();
        let Some((positions, omega)) = &self.near else {
            let time = equations.half_period(from)?;
            return Ok((1..n).map(|_| 0.0).chain([PI / time]).collect());
        };
        if positions.len() != n {
            return Err(RequestError::State {
                entries: positions.len(),
                expected: n,
            }
            .into());
        }
        let omega = validate::omega(*omega)?;
        Ok(positions[1..].iter().copied().chain([omega]).collect())
    }
}
