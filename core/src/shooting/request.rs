//! What a user asks for, checked before any work.

use std::ops::ControlFlow;
use std::sync::Arc;

use super::cycle::{Cycle, CycleBranch, CycleEvent};
use super::start::Guess;
use super::trace::{self, Track, TrackPoint};
use super::{at, compute, series};
use crate::branches::error::unless_cancelled;
use crate::branches::orbit::Orbit;
use crate::branches::point::Point;
use crate::cancel::Cancel;
use crate::continuation::step::StepControl;
use crate::error::Error;
use crate::event::{EventKind, Side};
use crate::model::request::RequestError;
use crate::model::validate;
use crate::system::System;

/// Periodic orbits by shooting: set up step by step, then one [orbit](Shooting::orbit) or a [branch](Shooting::run).
///
/// By default the excitation frequency is varied, the orbit has the period of the excitation, and the first orbit is found by
/// harmonic balance. Systems of which every piece is affine have their motions in closed form; those of others are integrated.
///
/// ```
/// use hertzian::{EventKind, Shooting};
///
/// hertzian::oscillator! {
///     OneSided(x) {
///         param load;
///         param drive;
///         law contact(gap) { gap > 0 => 0.064*dot(gap) + gap, else => 0 }
///         ddot(x) + contact(x) = drive*cos(omega*t) + load;
///     }
/// }
///
/// let model = OneSided { load: 1.0, drive: 1.0 };
/// let shooting = Shooting::of(&model).vary("drive").omega(1.0);
/// let orbit = shooting.orbit(1.0)?;
/// let branch = shooting.near(orbit.state()).from(1.0).to(1.4).run()?;
/// let doubling = branch.events(EventKind::PeriodDoubling).next().unwrap();
/// assert!((doubling.cycle.value - 1.282584167663768).abs() < 1e-11);
/// # Ok::<(), hertzian::Error>(())
/// ```
#[derive(Clone)]
pub struct Shooting {
    pub(super) system: Arc<dyn System>,
    pub(super) vary: Option<String>,
    pub(super) omega: Option<f64>,
    pub(super) from: Option<f64>,
    pub(super) to: Option<f64>,
    pub(super) near: Option<Guess>,
    pub(super) period: usize,
    pub(super) segments: Option<usize>,
    pub(super) tolerance: f64,
    pub(super) max_points: usize,
    pub(super) largest_step: f64,
    pub(super) stability: bool,
    pub(super) cancel: Cancel,
}

impl std::fmt::Debug for Shooting {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Shooting")
            .field("system", &self.system.facts().name)
            .field("vary", &self.vary)
            .field("from", &self.from)
            .field("to", &self.to)
            .finish_non_exhaustive()
    }
}

impl Shooting {
    /// Of this system, at the values that its parameters have now.
    pub fn of(system: &dyn System) -> Self {
        Self {
            system: system.shared(),
            vary: None,
            omega: None,
            from: None,
            to: None,
            near: None,
            period: 1,
            segments: None,
            tolerance: 1e-10,
            max_points: 20_000,
            largest_step: StepControl::default().largest,
            stability: true,
            cancel: Cancel::new(),
        }
    }

    /// Where the branch starts.
    #[must_use]
    pub fn from(mut self, value: f64) -> Self {
        self.from = Some(value);
        self
    }

    /// Where it ends.
    #[must_use]
    pub fn to(mut self, value: f64) -> Self {
        self.to = Some(value);
        self
    }

    /// Varies a parameter instead of the excitation frequency, which is then [`omega`](Self::omega).
    #[must_use]
    pub fn vary(mut self, parameter: impl Into<String>) -> Self {
        self.vary = Some(parameter.into());
        self
    }

    /// The excitation frequency, in radians per unit of time, when a parameter is varied.
    #[must_use]
    pub fn omega(mut self, omega: f64) -> Self {
        self.omega = Some(omega);
        self
    }

    /// The first orbit is near this state `(q, dq/dt)` at phase zero: all positions, then all velocities.
    #[must_use]
    pub fn near(mut self, state: &[f64]) -> Self {
        self.near = Some(Guess::State(state.to_vec()));
        self
    }

    /// The first orbit is near this one, found by harmonic balance, and has its period.
    #[must_use]
    pub fn near_orbit(mut self, orbit: &Orbit) -> Self {
        self.period = orbit.period;
        self.near = Some(Guess::Series(orbit.clone()));
        self
    }

    /// Period of the orbit in periods of the declaration, `2 pi divisor / omega`: those of the excitation, unless the declaration
    /// has fractions of `omega`. Default: 1.
    #[must_use]
    pub fn period(mut self, period: usize) -> Self {
        self.period = period;
        self
    }

    /// Segments that the orbit is divided into: multiple shooting. Default: one for each period of the declaration. More of them help
    /// where neighbouring motions part fast.
    #[must_use]
    pub fn segments(mut self, segments: usize) -> Self {
        self.segments = Some(segments);
        self
    }

    /// Tolerance of the flow, relative to the size of the motion. Default: 1e-10. A flow in closed form has none.
    #[must_use]
    pub fn tolerance(mut self, tolerance: f64) -> Self {
        self.tolerance = tolerance;
        self
    }

    /// Whether Floquet multipliers are computed. Default: yes; without them every verdict is
    /// [`Verdict::Undecided`](crate::orbit::stability::Verdict::Undecided), and of events only folds are found.
    #[must_use]
    pub fn stability(mut self, wanted: bool) -> Self {
        self.stability = wanted;
        self
    }

    /// Largest step along the branch, as [`FrequencyResponse::largest_step`](crate::response::FrequencyResponse::largest_step) measures it. Default: 0.1.
    #[must_use]
    pub fn largest_step(mut self, step: f64) -> Self {
        self.largest_step = step;
        self
    }

    /// Stop after this many points. Default: 20000.
    #[must_use]
    pub fn max_points(mut self, points: usize) -> Self {
        self.max_points = points;
        self
    }

    /// What is computed ends when this token is cancelled, the search for a first orbit too.
    #[must_use]
    pub fn cancel(mut self, cancel: &Cancel) -> Self {
        self.cancel = cancel.clone();
        self
    }

    /// The token that ends what is computed.
    pub(crate) fn token(&self) -> &Cancel {
        &self.cancel
    }

    /// What a computation gave that began at a value; where it was cancelled, that it was.
    fn unless_cancelled<T>(&self, value: f64, found: Result<T, Error>) -> Result<T, Error> {
        found.map_err(|error| unless_cancelled(&self.cancel, value, error))
    }

    /// The one orbit at a value of what is varied.
    ///
    /// # Errors
    /// If a parameter or an option is not usable, or no orbit is found; [`OrbitError::Beyond`](crate::OrbitError::Beyond) if the branch that comes near turns back
    /// before the value.
    pub fn orbit(&self, value: f64) -> Result<Cycle, Error> {
        let setting = self.setting(value, value)?;
        let guess = self.guess(value)?;
        self.unless_cancelled(value, compute::cycle(&setting, &guess, value))
    }

    /// The branch from one end of the range to the other.
    ///
    /// # Errors
    /// If a parameter or an option is not usable, or no first orbit is found. A branch that ends early is not an error: it comes
    /// back with what was computed and with [`CycleBranch::end`].
    pub fn run(&self) -> Result<CycleBranch, Error> {
        self.run_with(|_| ControlFlow::Continue(()))
    }

    /// As [`run`](Self::run), and calls `visit` at every orbit as it is found: to show progress, or to stop.
    ///
    /// # Errors
    /// As [`run`](Self::run).
    pub fn run_with(
        &self,
        mut visit: impl FnMut(&Cycle) -> ControlFlow<()>,
    ) -> Result<CycleBranch, Error> {
        let ([from, to], setting) = self.ranged()?;
        let guess = self.guess(from)?;
        let branch = compute::branch(&setting, &guess, [from, to], &mut visit);
        self.unless_cancelled(from, branch)
    }

    /// The branch that begins at an event of another one, within the range from [`from`](Self::from) to [`to`](Self::to): of
    /// twice the period at a period doubling, of orbits without the symmetry where an odd symmetry breaks, and the other branch where
    /// two cross. Where a symmetry breaks the two sides are mirror images; at a period doubling both are one branch, on which
    /// orbits are looked at a period later; where branches cross they are the two directions of the other branch.
    ///
    /// # Errors
    /// If a parameter or an option is not usable, no branch begins there, or its first orbit was not found.
    pub fn switch(&self, event: &CycleEvent, side: Side) -> Result<CycleBranch, Error> {
        self.switch_with(event, side, |_| ControlFlow::Continue(()))
    }

    /// As [`switch`](Self::switch), and calls `visit` at every orbit as it is found: to show progress, or to stop.
    ///
    /// # Errors
    /// As [`switch`](Self::switch).
    pub fn switch_with(
        &self,
        event: &CycleEvent,
        side: Side,
        mut visit: impl FnMut(&Cycle) -> ControlFlow<()>,
    ) -> Result<CycleBranch, Error> {
        self.belongs(&event.cycle)?;
        let doubles = event.kind == EventKind::PeriodDoubling;
        let request = Self {
            period: event.cycle.period * if doubles { 2 } else { 1 },
            segments: None,
            ..self.clone()
        };
        let ([from, to], setting) = request.ranged()?;
        let branch = compute::branch_at(&setting, event, side.sign(), [from, to], &mut visit);
        self.unless_cancelled(event.cycle.value, branch)
    }

    /// The branch through the orbit at a value inside the range, both ways as far as it goes; [`CycleBranch::end`] is that of the
    /// part to the side where the range ends. A branch that closes upon itself (an isola) is followed once around.
    ///
    /// # Errors
    /// As [`orbit`](Self::orbit).
    pub fn through(&self, value: f64) -> Result<CycleBranch, Error> {
        self.through_with(value, |_| ControlFlow::Continue(()))
    }

    /// As [`through`](Self::through), and calls `visit` at every orbit as it is found, first on the one side of the value, then on
    /// the other: to show progress, or to stop.
    ///
    /// # Errors
    /// As [`orbit`](Self::orbit).
    pub fn through_with(
        &self,
        value: f64,
        mut visit: impl FnMut(&Cycle) -> ControlFlow<()>,
    ) -> Result<CycleBranch, Error> {
        let ([from, to], setting) = self.ranged()?;
        validate::option(
            "through",
            value,
            from.min(to)..=from.max(to),
            "must be between from and to",
        )?;
        let guess = self.guess(value)?;
        let branch = compute::branch_through(&setting, &guess, value, [from, to], &mut visit);
        self.unless_cancelled(value, branch)
    }

    /// Every orbit of a branch at a value of what it varies, in branch order; empty where the branch does not pass.
    ///
    /// ```
    /// use hertzian::Shooting;
    ///
    /// hertzian::oscillator! {
    ///     Duffing(x) {
    ///         param drive;
    ///         ddot(x) + 0.1*dot(x) + x + x^3 = drive*cos(omega*t);
    ///     }
    /// }
    ///
    /// let model = Duffing { drive: 0.2 };
    /// let shooting = Shooting::of(&model).from(0.5).to(2.0);
    /// let branch = shooting.run()?;
    /// // Between its two folds the resonance has three orbits.
    /// assert_eq!(shooting.at(&branch, 1.3)?.len(), 3);
    /// # Ok::<(), hertzian::Error>(())
    /// ```
    ///
    /// # Errors
    /// If a parameter or an option is not usable, the branch varies something else, or an orbit between two others cannot be
    /// computed.
    pub fn at(&self, branch: &CycleBranch, value: f64) -> Result<Vec<Cycle>, Error> {
        let Some(cycle) = branch.cycles.first() else {
            return Ok(Vec::new());
        };
        self.belongs(cycle)?;
        let request = Self {
            period: cycle.period,
            segments: None,
            ..self.clone()
        };
        let setting = request.setting(value, value)?;
        if setting.varied != branch.varied {
            let name = setting.varied;
            let must = "must be what the branch varies";
            return Err(RequestError::Varied { name, must }.into());
        }
        self.unless_cancelled(value, at::at(&setting, branch, value))
    }

    /// An orbit as a point of a branch by harmonic balance: its Fourier series, of 20 harmonics for each period of the excitation,
    /// with everything that is read off an orbit.
    ///
    /// # Errors
    /// If a parameter or an option is not usable, or the motion cannot be computed.
    pub fn point(&self, cycle: &Cycle) -> Result<Point, Error> {
        self.belongs(cycle)?;
        let request = Self {
            period: cycle.period,
            segments: None,
            ..self.clone()
        };
        let setting = request.setting(cycle.value, cycle.value)?;
        let point = series::point(self.system.as_ref(), &setting, cycle);
        self.unless_cancelled(cycle.value, point)
    }

    /// The curve of bifurcations through an event of a branch, as a second parameter (or `"omega"`) varies between two values: of
    /// folds, period doublings, points where an odd symmetry breaks, or grazing. What is varied here stays in the range from
    /// [`from`](Self::from) to [`to`](Self::to).
    ///
    /// # Errors
    /// If a parameter or an option is not usable, or there is no such curve.
    pub fn track(&self, event: &CycleEvent, second: &str, range: [f64; 2]) -> Result<Track, Error> {
        self.track_with(event, second, range, |_| ControlFlow::Continue(()))
    }

    /// As [`track`](Self::track), and calls `visit` at every bifurcation as it is found: to show progress, or to stop. What was found
    /// until then comes back.
    ///
    /// # Errors
    /// As [`track`](Self::track).
    pub fn track_with(
        &self,
        event: &CycleEvent,
        second: &str,
        [low, high]: [f64; 2],
        mut visit: impl FnMut(&TrackPoint) -> ControlFlow<()>,
    ) -> Result<Track, Error> {
        self.belongs(&event.cycle)?;
        let facts = self.system.facts();
        let request = Self {
            period: event.cycle.period,
            segments: None,
            ..self.clone()
        };
        let ([from, to], setting) = request.ranged()?;
        let variable = validate::variable(facts, Some(second))?;
        validate::range(facts, variable, low, high)?;
        if variable == setting.variable {
            let name = second.to_owned();
            let must = "must be another one than what the branch varies";
            return Err(RequestError::Varied { name, must }.into());
        }
        let plane = trace::Plane {
            system: self.system.as_ref(),
            second: variable,
            name: second.to_owned(),
            ranges: [[from, to], [low, high]],
        };
        let curve = trace::track(&setting, event, &plane, &mut visit);
        self.unless_cancelled(event.cycle.value, curve)
    }
}
