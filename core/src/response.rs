//! Frequency response: what a user asks for, checked before any work.

use std::ops::ControlFlow;
use std::time::Instant;

use crate::aft::Aft;
use crate::balance::{Parity, Resolution};
use crate::bifurcation::depart::depart;
use crate::branch::{Branch, Event, EventKind, Orbit, Point};
use crate::continuation::follow::{FollowOptions, Start};
use crate::continuation::step::StepControl;
use crate::error::{Attempts, Error};
use crate::flow::shooting::Side;
use crate::follower::Follower;
use crate::fourier::series;
use crate::harmonics::{Chooser, resize};
use crate::layout::{ContactLayout, Layout};
use crate::newton::NewtonOptions;
use crate::run::Run;
use crate::stability::Method;
use crate::start::{start, without_symmetry};
use crate::statistics::Statistics;
use crate::symmetry::{is_broken, is_odd};
use crate::system::{System, Variable};
use crate::validate;

/// More samples of an orbit would take more than a gigabyte.
const MOST_SAMPLES: usize = 10_000_000;
/// Harmonics that are coupled densely in the search for a first orbit.
const CORE_AT_START: usize = 40;
/// Harmonics beyond those of the declaration that are always taken: the estimate of the error takes higher ones for free masses.
const LEAST_BEYOND: usize = 4;
/// More harmonics of an excitation period are never chosen, only taken when given.
const MOST_HARMONICS: usize = 150;
/// Part of a value to its neighbour in a range of which only the first orbit is wanted.
const ASIDE: f64 = 1e-3;
/// The dense matrix of more unknowns would take more than 300 megabytes.
const MOST_UNKNOWNS: usize = 6000;

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
pub struct FrequencyResponse<'a> {
    system: &'a dyn System,
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
    doublings: bool,
    bifurcations: bool,
    symmetric: bool,
}

impl std::fmt::Debug for FrequencyResponse<'_> {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("FrequencyResponse")
            .field("system", &self.system.facts().name)
            .field("vary", &self.vary)
            .field("from", &self.from)
            .field("to", &self.to)
            .finish_non_exhaustive()
    }
}

impl<'a> FrequencyResponse<'a> {
    /// Of this system, at the parameters it has when the run starts.
    pub fn of(system: &'a dyn System) -> Self {
        Self {
            system,
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
            doublings: false,
            bifurcations: false,
            symmetric: true,
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
    /// [`Verdict::Undecided`](crate::Verdict::Undecided) and a branch takes a fraction of the time.
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
    /// part of the range in one step is at most 0.15 of it. Steps are shorter where the branch bends.
    #[must_use]
    pub fn largest_step(mut self, step: f64) -> Self {
        self.largest_step = step;
        self
    }

    /// Whether doublings of the period are located too, where another balance, of twice the period, has the branch that begins.
    /// Orbits of odd symmetry have none. Default: no, since it takes about as long again.
    #[must_use]
    pub fn doublings(mut self, wanted: bool) -> Self {
        self.doublings = wanted;
        self
    }

    /// Whether all bifurcations are located and not folds alone: doublings of the period, crossings with other branches,
    /// Neimark-Sacker bifurcations, and where a gap touches a level. Default: no. Neimark-Sacker bifurcations are seen by the
    /// multipliers, so they need [`stability`](Self::stability).
    #[must_use]
    pub fn bifurcations(mut self, wanted: bool) -> Self {
        self.doublings = wanted;
        self.bifurcations = wanted;
        self
    }

    /// Whether orbits of period one have the odd symmetry, `x(t + T/2) = -x(t)`, where the system has it. Default: yes; they have
    /// odd harmonics only then, and where the symmetry breaks is located. Otherwise a first orbit without the symmetry is looked
    /// for, as in one of two wells, and one with it taken if none is found; the branch may pass from one to the other. An orbit
    /// without the symmetry that is [given](Self::near_orbit) does not need this.
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

    /// The one orbit at a value of what is varied; the ends of a range are not needed.
    ///
    /// # Errors
    /// If a parameter or an option is not usable, or no orbit is found.
    pub fn orbit(&self, value: f64) -> Result<Point, Error> {
        let request = self.clone().from(value).to(self.aside(value)?);
        let branch = request.run_with(|_| ControlFlow::Break(()))?;
        let first = branch.points.into_iter().next();
        first.ok_or(Error::NoSuchPeriod {
            period: self.period,
            value,
            attempts: Attempts::default(),
        })
    }

    /// Computes the branch.
    ///
    /// # Errors
    /// Before any work, if a parameter or an option is not usable; and if no first orbit is found. A branch that ends
    /// early is not an error: it comes back with what was computed and with [`Branch::stopped`].
    pub fn run(&self) -> Result<Branch<'a>, Error> {
        self.run_with(|_| ControlFlow::Continue(()))
    }

    /// As [`run`](Self::run), and calls `visit` at every point as it is found: to show progress, or to stop.
    ///
    /// # Errors
    /// As [`run`](Self::run).
    pub fn run_with(
        &self,
        mut visit: impl FnMut(&Point) -> ControlFlow<()>,
    ) -> Result<Branch<'a>, Error> {
        let started = Instant::now();
        let (follower, options) = self.check()?;
        let mut statistics = Statistics::default();
        let first = match &self.near {
            None => {
                let request = follower.start_request(options);
                let found = start(request, &mut statistics)?;
                let broken = follower.asymmetric;
                let broken = broken.then(|| without_symmetry(request, &found, &mut statistics));
                broken.flatten().unwrap_or(found)
            }
            Some(orbit) => {
                let mut u = orbit.series.clone();
                u.push(options.from);
                let length = series::length(follower.resolution.harmonics);
                resize(&u, orbit.coordinates, length)
            }
        };
        let run = Run::new(&follower, options, &first);
        self.followed(run, Start::Near(first), &mut visit, (statistics, started))
    }

    /// The branch that begins at an event of another one, as [`run`](Self::run) would follow it: of twice the period at a doubling
    /// ([`doublings`](Self::doublings)), of orbits without the symmetry where an odd symmetry breaks. There the two sides are mirror
    /// images; at a doubling both are one branch.
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
    pub fn switch(&self, event: &Event, side: Side) -> Result<Branch<'a>, Error> {
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
    ) -> Result<Branch<'a>, Error> {
        let started = Instant::now();
        self.fits(&event.point.orbit)?;
        let doubles = event.kind == EventKind::PeriodDoubling;
        let request = Self {
            period: event.point.orbit.period * if doubles { 2 } else { 1 },
            near: None,
            ..self.clone()
        };
        let (mut follower, options) = request.check()?;
        follower.resolution.parity = Parity::All;
        follower.asymmetric = !doubles;
        let point = depart(&follower, event, side.sign())?;
        let run = Run::new(&follower, options, &point.u);
        let start = Start::Along(Box::new(point));
        self.followed(run, start, &mut visit, (Statistics::default(), started))
    }

    /// The branch that a run gives.
    fn followed(
        &self,
        mut run: Run<'_, 'a>,
        start: Start,
        visit: &mut impl FnMut(&Point) -> ControlFlow<()>,
        (mut statistics, started): (Statistics, Instant),
    ) -> Result<Branch<'a>, Error> {
        let stopped = run.follow(start, visit)?;
        let follower = run.follower.clone();
        let Run {
            points,
            events,
            turns,
            statistics: followed,
            ..
        } = run;
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

    /// Checks everything that was asked for.
    fn check(&self) -> Result<(Follower<'a>, FollowOptions), Error> {
        let facts = self.system.facts();
        if facts.coordinates.is_empty() {
            return Err(Error::NoCoordinates);
        }
        let mut parameters = vec![0.0; facts.parameters.len()];
        self.system.values(&mut parameters);
        let variable = validate::variable(facts, self.vary.as_deref())?;
        let from = self.from.ok_or(Error::Missing { name: "from" })?;
        let to = self.to.ok_or(Error::Missing { name: "to" })?;
        validate::range(facts, variable, from, to)?;
        let omega = match (variable, self.omega) {
            (Variable::Omega, None) => from,
            (Variable::Omega, Some(value)) => {
                let must = "is what is varied: give it by from and to";
                return Err(Error::Option {
                    name: "omega",
                    value,
                    must,
                });
            }
            (Variable::Parameter(index), Some(omega)) => {
                parameters[index] = from;
                validate::omega(omega)?
            }
            (Variable::Parameter(_), None) => return Err(Error::Missing { name: "omega" }),
        };
        validate::parameters(facts, &parameters)?;
        self.check_options()?;
        self.check_near()?;
        let mut resolution = self.resolution()?;
        let layout = Layout::of(self.system);
        let symmetric = is_odd(
            self.system,
            &layout,
            &parameters,
            omega,
            variable,
            [from, to],
        );
        let given = self.near.as_ref();
        let kept = self.symmetric && !given.is_some_and(|orbit| lacks_symmetry(orbit));
        if symmetric && self.period == 1 && kept {
            resolution.parity = Parity::Odd;
            if self.harmonics.is_none() {
                // An even number is as good as the one below it.
                resolution.harmonics |= 1;
            }
        }
        // Levels are affine in the parameters, so if they are in order at both ends, they are in between.
        let at_end = match variable {
            Variable::Omega => (parameters.clone(), to),
            Variable::Parameter(index) => {
                let mut parameters = parameters.clone();
                parameters[index] = to;
                (parameters, omega)
            }
        };
        for (parameters, omega) in [(&parameters, omega), (&at_end.0, at_end.1)] {
            validate::levels(self.system, parameters, omega)?;
            validate::mass(self.system, parameters, omega)?;
        }
        let newton = NewtonOptions {
            tolerance: (1e-3 * self.tolerance).clamp(1e-11, 1e-6),
            iterations: 12,
            damped: false,
        };
        let options = FollowOptions {
            from,
            to,
            points: validate::max_points(self.max_points)?,
            steps: validate::largest_step(self.largest_step)?,
            newton,
        };
        let system = self.system;
        Ok((
            Follower {
                system,
                parameters,
                omega,
                variable,
                resolution,
                newton,
                doublings: self.doublings,
                bifurcations: self.bifurcations,
                asymmetric: symmetric && self.period == 1 && !kept,
                stability: self.stability.then_some(self.method),
                chooser: self.chooser(resolution),
                from,
                to,
            },
            options,
        ))
    }

    /// Another value that what is varied may have, next to one.
    fn aside(&self, value: f64) -> Result<f64, Error> {
        let facts = self.system.facts();
        let unit = if value == 0.0 { 1.0 } else { value.abs() };
        let above = value + ASIDE * unit;
        Ok(match validate::variable(facts, self.vary.as_deref())? {
            Variable::Parameter(index) if !facts.parameters[index].admits(above) => {
                value - ASIDE * unit
            }
            _ => above,
        })
    }

    /// An orbit is one of a system with as many coordinates.
    fn fits(&self, orbit: &Orbit) -> Result<(), Error> {
        let expected = self.system.facts().coordinates.len();
        if orbit.coordinates == expected {
            return Ok(());
        }
        Err(Error::State {
            entries: 2 * orbit.coordinates,
            expected: 2 * expected,
        })
    }

    /// Checks what the first orbit is to be near.
    fn check_near(&self) -> Result<(), Error> {
        let Some(orbit) = &self.near else {
            return Ok(());
        };
        self.fits(orbit)?;
        if orbit.period == self.period {
            return Ok(());
        }
        Err(Error::Option {
            name: "period",
            value: self.period as f64,
            must: "must be that of the orbit given by `near_orbit`",
        })
    }

    /// Checks the numbers among the options.
    fn check_options(&self) -> Result<(), Error> {
        validate::option(
            "tolerance",
            self.tolerance,
            1e-12..=1e-1,
            "must be from 1e-12 to 0.1",
        )?;
        validate::option(
            "period",
            self.period as f64,
            1.0..=1000.0,
            "must be from 1 to 1000",
        )
    }

    /// How harmonics follow the tolerance: unless they were given, or the contacts are sampled.
    fn chooser(&self, resolution: Resolution) -> Option<Chooser> {
        let free = self.harmonics.is_none() && self.aft == Aft::Switched;
        let layout = Layout::of(self.system);
        let least = (layout.highest_harmonic() + LEAST_BEYOND) * self.period;
        let unknowns_allow = MOST_UNKNOWNS / (2 * layout.coordinates) - 1;
        let most = MOST_HARMONICS * self.period * self.system.facts().divisor as usize;
        free.then(|| {
            Chooser::new(
                self.tolerance,
                least.min(resolution.harmonics),
                most.min(unknowns_allow),
                resolution.parity == Parity::Odd,
            )
        })
    }

    fn resolution(&self) -> Result<Resolution, Error> {
        let digits = -self.tolerance.log10();
        let by_tolerance = (20.0 * ((digits - 6.0) / 2.0).exp2())
            .round()
            .clamp(5.0, 100.0) as usize;
        let divisor = self.system.facts().divisor as usize;
        let per_period = self.harmonics.unwrap_or(by_tolerance * divisor);
        validate::option(
            "harmonics",
            per_period as f64,
            1.0..=1e4,
            "must be from 1 to 10000",
        )?;
        let harmonics = per_period * self.period;
        let layout = Layout::of(self.system);
        let unknowns = layout.coordinates * series::length(harmonics);
        if unknowns > MOST_UNKNOWNS {
            return Err(Error::Unknowns {
                unknowns,
                most: MOST_UNKNOWNS,
            });
        }
        let highest = layout.highest_harmonic() * self.period;
        if highest > harmonics {
            return Err(Error::Harmonics { harmonics, highest });
        }
        let samples_per_period = self
            .samples
            .unwrap_or_else(|| (200 * per_period).next_power_of_two());
        validate::option(
            "samples",
            samples_per_period as f64,
            1.0..=1e7,
            "must be from 1 to 1e7",
        )?;
        let samples = samples_per_period * self.period;
        if samples > MOST_SAMPLES {
            let must = "times the period must be at most 1e7";
            return Err(Error::Option {
                name: "samples",
                value: samples as f64,
                must,
            });
        }
        // The derivatives are needed up to twice the harmonics of the balance, and the waves of directions and offsets on top.
        let contacts = layout.contacts.iter();
        let wave = |contact: &ContactLayout| {
            contact.offset_harmonic() + contact.force_harmonic() + contact.gap_harmonic()
        };
        let waves = contacts.map(wave).max().unwrap_or(0) * self.period;
        let least = 2 * (2 * harmonics + waves) + 2;
        if samples < least {
            return Err(Error::Samples {
                samples,
                least,
                harmonics,
            });
        }
        Ok(Resolution {
            harmonics,
            core: CORE_AT_START * self.period,
            parity: Parity::All,
            samples,
            aft: self.aft,
            period: self.period,
        })
    }
}

fn lacks_symmetry(orbit: &Orbit) -> bool {
    is_broken(&orbit.series, orbit.series(0).len())
}
