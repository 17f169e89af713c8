//! Frequency response: what a user asks for, checked before any work.

pub(crate) mod branch;
pub(crate) mod depart;
pub(crate) mod follower;
mod multipliers;
pub(crate) mod reader;
pub(crate) mod run;
#[doc(hidden)]
pub mod stages;

mod check;
mod motion;

use std::ops::ControlFlow;
use std::sync::Arc;
use std::time::Instant;

use crate::balance::Parity;
use crate::balance::aft::Aft;
use crate::balance::start::{Moving, start, without_symmetry};
use crate::balance::symmetry::has_stride;
use crate::branches::error::{Attempts, OrbitError, unless_cancelled};
use crate::branches::orbit::Orbit;
use crate::branches::point::{Event, Point};
use crate::cancel::Cancel;
use crate::continuation::follow::Start;
use crate::continuation::statistics::Statistics;
use crate::continuation::step::StepControl;
use crate::error::Error;
use crate::event::{EventKind, Side};
use crate::orbit::stability::Method;
use crate::response::branch::Branch;
use crate::response::depart::depart;
use crate::response::follower::{Follower, Sought};
use crate::response::run::{Followed, Run};
use crate::system::System;

/// What to follow, set up step by step, then [run](FrequencyResponse::run).
///
/// Only the two ends of the range have to be given. By default the excitation frequency is varied, the orbit has the
/// period of the excitation, and everything else follows from the tolerance.
///
/// ```
/// hertzian::oscillator! {
///     Duffing(x) {
///         param drive;
///         ddot(x) + 0.1*dot(x) + x + x^3 = drive*cos(omega*t);
///     }
/// }
///
/// let model = Duffing { drive: 0.2 };
/// let request = hertzian::FrequencyResponse::of(&model).harmonics(5).samples(64);
/// let by_frequency = request.clone().from(0.5).to(1.5).run()?;
/// let by_drive = request.vary("drive").omega(1.2).from(0.01).to(0.2).run()?;
/// let (a, b) = (by_frequency.at(1.2)?, by_drive.at(0.2)?);
/// assert!((a[0].peak_to_peak() - b[0].peak_to_peak()).abs() < 1e-6);
/// # Ok::<(), hertzian::Error>(())
/// ```
#[derive(Clone)]
pub struct FrequencyResponse {
    system: Arc<dyn System>,
    vary: Option<String>,
    omega: Option<f64>,
    from: Option<f64>,
    to: Option<f64>,
    harmonics: Option<usize>,
    samples: Option<usize>,
    aft: Aft,
    period: usize,
    tolerance: f64,
    max_points: usize,
    largest_step: f64,
    stability: bool,
    method: Method,
    near: Option<Orbit>,
    sought: Sought,
    symmetric: bool,
    cancel: Cancel,
}

impl std::fmt::Debug for FrequencyResponse {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("FrequencyResponse")
            .field("system", &self.system.facts().name)
            .field("vary", &self.vary)
            .field("from", &self.from)
            .field("to", &self.to)
            .finish_non_exhaustive()
    }
}

impl FrequencyResponse {
    /// Of this system, at the values that its parameters have now.
    pub fn of(system: &dyn System) -> Self {
        Self {
            system: system.shared(),
            vary: None,
            omega: None,
            from: None,
            to: None,
            harmonics: None,
            samples: None,
            aft: Aft::default(),
            period: 1,
            tolerance: 1e-6,
            max_points: 20_000,
            largest_step: StepControl::default().largest,
            stability: true,
            near: None,
            sought: Sought::Folds,
            symmetric: true,
            cancel: Cancel::new(),
            method: Method::default(),
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

    /// Period of the orbit in periods of the declaration, `2 pi divisor / omega`: those of the excitation, unless the declaration
    /// has fractions of `omega`. Default: 1.
    #[must_use]
    pub fn period(mut self, period: usize) -> Self {
        self.period = period;
        self
    }

    /// Relative accuracy asked of peak-to-peak. Default: 1e-6. Harmonics and the tolerance of Newton's method follow from it.
    /// Harmonics are chosen at every point such that its estimated error, [`Point::error`], is below the tolerance; at most 150
    /// for each period of the excitation.
    #[must_use]
    pub fn tolerance(mut self, tolerance: f64) -> Self {
        self.tolerance = tolerance;
        self
    }

    /// The same number of harmonics at every point, whatever the tolerance. They are harmonics of the base frequency, which is
    /// omega over the divisor of the declaration (one, unless it has fractions of omega), for an orbit of period one; an orbit of
    /// period `n` has `n` times as many. Default: chosen by the tolerance; where the force is sampled, 20 times the divisor at the
    /// default tolerance, twice as many for every two digits more, and between 5 and 100.
    #[must_use]
    pub fn harmonics(mut self, harmonics: usize) -> Self {
        self.harmonics = Some(harmonics);
        self
    }

    /// How the harmonics of contact forces are found. Default: [`Aft::Switched`], exact; the others are for comparison.
    #[must_use]
    pub fn aft(mut self, aft: Aft) -> Self {
        self.aft = aft;
        self
    }

    /// Samples per period of the declaration, for the methods that sample. Default: at least 200 per harmonic, a power of two. The
    /// derivative of a force like `g^1.5` has a kink where contact begins; folds feel it as the power -1.5 of the samples.
    #[must_use]
    pub fn samples(mut self, samples: usize) -> Self {
        self.samples = Some(samples);
        self
    }

    /// Whether Floquet multipliers are computed. Default: yes; without them every verdict is
    /// [`Verdict::Undecided`](crate::orbit::stability::Verdict::Undecided) and a branch takes a fraction of the time.
    #[must_use]
    pub fn stability(mut self, wanted: bool) -> Self {
        self.stability = wanted;
        self
    }

    /// How Floquet multipliers are computed. Default: [`Method::Default`]. [`Branch::multipliers`] applies any method to an orbit
    /// that is there already.
    #[must_use]
    pub fn multipliers(mut self, method: Method) -> Self {
        self.method = method;
        self
    }

    /// Largest step along the branch, where one is as much as the size of the orbit, or the whole range. Default: 0.1; the
    /// part of the range in one step is about 0.15 of it at most. Steps are shorter where the branch bends.
    #[must_use]
    pub fn largest_step(mut self, step: f64) -> Self {
        self.largest_step = step;
        self
    }

    /// Whether doublings of the period are located too, where another balance, of twice the period, has the branch that begins.
    /// Orbits of odd symmetry have none. Default: no, since it takes about as long again. [`bifurcations`](Self::bifurcations)
    /// include doublings, whatever is said here.
    #[must_use]
    pub fn doublings(mut self, wanted: bool) -> Self {
        self.sought = match self.sought {
            Sought::All => Sought::All,
            _ if wanted => Sought::Doublings,
            _ => Sought::Folds,
        };
        self
    }

    /// Whether all bifurcations are located and not folds alone: doublings of the period, crossings with other branches,
    /// Neimark-Sacker bifurcations, and where a gap touches a level. Default: no, folds alone, or what
    /// [`doublings`](Self::doublings) says after this. Neimark-Sacker bifurcations are seen by the multipliers, so they need
    /// [`stability`](Self::stability).
    #[must_use]
    pub fn bifurcations(mut self, wanted: bool) -> Self {
        self.sought = if wanted { Sought::All } else { Sought::Folds };
        self
    }

    /// Whether orbits of period one have the symmetry that the system has. Default: yes. Of the odd symmetry, `x(t + T/2) = -x(t)`,
    /// they have odd harmonics only then, and where the symmetry breaks is located. Otherwise a first orbit without the symmetry is
    /// looked for, as in one of two wells, and one with it taken if none is found; the branch may pass from one to the other. Where
    /// contacts take each other's place after a part of the period, as the balls of a bearing or the blades of a rotor, orbits come
    /// back after that part; otherwise all harmonics are unknowns, whatever the orbits have. An orbit without the symmetry that is
    /// [given](Self::near_orbit) does not need this.
    #[must_use]
    pub fn symmetric(mut self, wanted: bool) -> Self {
        self.symmetric = wanted;
        self
    }

    /// The first orbit is near this one, and has its period.
    #[must_use]
    pub fn near_orbit(mut self, orbit: &Orbit) -> Self {
        self.period = orbit.period;
        self.near = Some(orbit.clone());
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

    /// The one orbit at a value of what is varied; the ends of a range are not needed.
    ///
    /// # Errors
    /// If a parameter or an option is not usable, or no orbit is found.
    pub fn orbit(&self, value: f64) -> Result<Point, Error> {
        let request = self.clone().from(value).to(self.aside(value)?);
        let branch = request.run_with(|_| ControlFlow::Break(()))?;
        let first = branch.points.into_iter().next();
        let none = OrbitError::NoSuchPeriod {
            period: self.period,
            value,
            attempts: Attempts::default(),
        };
        first.ok_or_else(|| none.into())
    }

    /// Computes the branch.
    ///
    /// # Errors
    /// Before any work, if a parameter or an option is not usable; and if no first orbit is found. A branch that ends
    /// early is not an error: it comes back with what was computed and with [`Branch::stopped`].
    pub fn run(&self) -> Result<Branch, Error> {
        self.run_with(|_| ControlFlow::Continue(()))
    }

    /// As [`run`](Self::run), and calls `visit` at every point as it is found: to show progress, or to stop.
    ///
    /// # Errors
    /// As [`run`](Self::run).
    pub fn run_with(
        &self,
        mut visit: impl FnMut(&Point) -> ControlFlow<()>,
    ) -> Result<Branch, Error> {
        let started = Instant::now();
        let (follower, options) = self.check()?;
        let mut statistics = Statistics::default();
        let first = match &self.near {
            None => {
                let motion = |moving: Moving<'_>| motion::moved(&follower, moving);
                let request = follower.start_request(options, &motion);
                let found = start(request, &mut statistics)
                    .map_err(|error| unless_cancelled(&self.cancel, options.from, error))?;
                let broken = follower.asymmetric;
                let broken = broken.then(|| without_symmetry(request, &found, &mut statistics));
                broken.flatten().unwrap_or(found)
            }
            Some(orbit) => follower.unknowns_of(orbit, options.from),
        };
        let run = Run::new(&follower, options, &first);
        self.followed(run, Start::Near(first), &mut visit, (statistics, started))
    }

    /// The branch that begins at an event of another one, as [`run`](Self::run) would follow it: of twice the period at a doubling
    /// ([`doublings`](Self::doublings)), of orbits without the symmetry where an odd symmetry breaks, and the other one where two cross
    /// ([`bifurcations`](Self::bifurcations)). Where a symmetry breaks the two sides are mirror images; at a doubling both are one
    /// branch.
    ///
    /// ```
    /// use hertzian::{EventKind, FrequencyResponse, Side};
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
    /// let request = FrequencyResponse::of(&model).vary("drive").omega(1.0).from(1.0).to(1.4);
    /// let request = request.harmonics(20).doublings(true).stability(false);
    /// let branch = request.run()?;
    /// // A1 of Wang et al. (2021), figure 8, to what 20 harmonics give.
    /// let doubling = branch.events(EventKind::PeriodDoubling).next().unwrap();
    /// assert!((doubling.point.value - 1.2825842).abs() < 1e-4);
    /// let longer = request.doublings(false).switch(doubling, Side::One)?;
    /// assert!(longer.points.iter().all(|point| point.orbit.period == 2));
    /// # Ok::<(), hertzian::Error>(())
    /// ```
    ///
    /// # Errors
    /// If a parameter or an option is not usable, no branch begins there, or its first orbit was not found.
    pub fn switch(&self, event: &Event, side: Side) -> Result<Branch, Error> {
        self.switch_with(event, side, |_| ControlFlow::Continue(()))
    }

    /// As [`switch`](Self::switch), and calls `visit` at every point as it is found: to show progress, or to stop.
    ///
    /// # Errors
    /// As [`switch`](Self::switch).
    pub fn switch_with(
        &self,
        event: &Event,
        side: Side,
        mut visit: impl FnMut(&Point) -> ControlFlow<()>,
    ) -> Result<Branch, Error> {
        let started = Instant::now();
        self.has(event)?;
        let doubles = event.kind == EventKind::PeriodDoubling;
        let request = Self {
            period: event.point.orbit.period * if doubles { 2 } else { 1 },
            near: None,
            ..self.clone()
        };
        let (mut follower, options) = request.check()?;
        // Of the system, where orbits of period one may have it.
        let odd = follower.asymmetric || follower.resolution.parity == Parity::Odd;
        follower.resolution.parity = Parity::All;
        follower.asymmetric = odd && !doubles;
        let orbit = &event.point.orbit;
        let mut stride = follower.resolution.stride;
        if !has_stride(orbit, stride) {
            stride = 1;
        }
        let halves = event.kind == EventKind::BranchPoint && event.tangent.is_empty();
        follower.resolution.stride = if halves && stride.is_multiple_of(2) {
            stride / 2
        } else {
            stride
        };
        if let Some(chooser) = &follower.chooser {
            let times = request.period / event.point.orbit.period;
            let known = times * event.point.orbit.harmonics();
            follower.resolution.harmonics = chooser.admitted(known);
        }
        let point = depart(&follower, event, stride, side.sign())
            .map_err(|error| unless_cancelled(&self.cancel, event.point.value, error))?;
        let run = Run::new(&follower, options, &point.u);
        let start = Start::Along(Box::new(point));
        self.followed(run, start, &mut visit, (Statistics::default(), started))
    }

    /// The branch that a run gives.
    fn followed(
        &self,
        run: Run<'_>,
        start: Start,
        visit: &mut dyn FnMut(&Point) -> ControlFlow<()>,
        (mut statistics, started): (Statistics, Instant),
    ) -> Result<Branch, Error> {
        // What is asked of the branch later is not part of this run.
        let follower = Follower {
            cancel: Cancel::new(),
            ..run.follower.clone()
        };
        let Followed {
            stopped,
            points,
            mut events,
            mut turns,
            statistics: followed,
        } = run
            .follow(start, visit)
            .map_err(|error| unless_cancelled(&self.cancel, follower.from, error))?;
        // What a step hid is found one step later.
        events.sort_by_key(|event| event.after);
        turns.sort_by_key(|turn| turn.after);
        statistics += followed;
        Ok(Branch {
            varied: self.vary.clone().unwrap_or_else(|| "omega".to_owned()),
            points,
            events,
            turns,
            stopped,
            statistics,
            elapsed: started.elapsed(),
            follower,
        })
    }
}
