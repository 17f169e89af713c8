//! What a user asks for, checked before any work.

use std::ops::ControlFlow;

use super::cycle::{Cycle, CycleBranch, CycleEvent};
use super::setting::{Setting, Source};
use super::start::Guess;
use super::trace::{self, Track};
use super::{compute, series};
use crate::branch::{EventKind, Orbit, Point};
use crate::continuation::step::StepControl;
use crate::error::Error;
use crate::flow::affine::Affine;
use crate::flow::{self, Options};
use crate::layout::Layout;
use crate::response::FrequencyResponse;
use crate::symmetry::is_odd;
use crate::system::{System, Variable};
use crate::validate;

/// The dense matrix of more unknowns would take more than 300 megabytes.
const MOST_UNKNOWNS: usize = 6000;

/// The side of an event on which a branch is followed.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
#[cfg_attr(feature = "serde", serde(rename_all = "kebab-case"))]
pub enum Side {
    /// One of the two.
    One,
    /// The other one.
    Other,
}

impl Side {
    /// One or minus one.
    pub(crate) fn sign(self) -> f64 {
        match self {
            Self::One => 1.0,
            Self::Other => -1.0,
        }
    }
}

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
pub struct Shooting<'a> {
    system: &'a dyn System,
    vary: Option<String>,
    omega: Option<f64>,
    from: Option<f64>,
    to: Option<f64>,
    near: Option<Guess>,
    period: usize,
    segments: Option<usize>,
    tolerance: f64,
    max_points: usize,
    largest_step: f64,
    stability: bool,
}

impl std::fmt::Debug for Shooting<'_> {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Shooting")
            .field("system", &self.system.facts().name)
            .field("vary", &self.vary)
            .field("from", &self.from)
            .field("to", &self.to)
            .finish_non_exhaustive()
    }
}

impl<'a> Shooting<'a> {
    /// Of this system, at the parameters it has when the computation starts.
    pub fn of(system: &'a dyn System) -> Self {
        Self {
            system,
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
    /// [`Verdict::Undecided`](crate::Verdict::Undecided), and of events only folds are found.
    #[must_use]
    pub fn stability(mut self, wanted: bool) -> Self {
        self.stability = wanted;
        self
    }

    /// Largest step along the branch, as [`FrequencyResponse::largest_step`] measures it. Default: 0.1.
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

    /// The one orbit at a value of what is varied.
    ///
    /// # Errors
    /// If a parameter or an option is not usable, or no orbit is found; [`Error::Beyond`] if the branch that comes near turns back
    /// before the value.
    pub fn orbit(&self, value: f64) -> Result<Cycle, Error> {
        let setting = self.setting(value, value)?;
        let guess = self.guess(value)?;
        compute::cycle(&setting, &guess, value)
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
        compute::branch(&setting, &guess, [from, to], &mut visit)
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
        let doubles = event.kind == EventKind::PeriodDoubling;
        let request = Self {
            period: event.cycle.period * if doubles { 2 } else { 1 },
            segments: None,
            ..self.clone()
        };
        let ([from, to], setting) = request.ranged()?;
        compute::branch_at(&setting, event, side.sign(), [from, to], &mut visit)
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
        let guess = self.guess(value)?;
        compute::branch_through(&setting, &guess, value, [from, to], &mut visit)
    }

    /// An orbit as a point of a branch by harmonic balance: its Fourier series, of 20 harmonics for each period of the excitation,
    /// with everything that is read off an orbit.
    ///
    /// # Errors
    /// If a parameter or an option is not usable, or the motion cannot be computed.
    pub fn point(&self, cycle: &Cycle) -> Result<Point, Error> {
        let request = Self {
            period: cycle.period,
            segments: None,
            ..self.clone()
        };
        let setting = request.setting(cycle.value, cycle.value)?;
        series::point(self.system, &setting, cycle)
    }

    /// The curve of bifurcations through an event of a branch, as a second parameter (or `"omega"`) varies between two values: of
    /// folds, period doublings, points where an odd symmetry breaks, or grazing. What is varied here stays in the range from
    /// [`from`](Self::from) to [`to`](Self::to).
    ///
    /// # Errors
    /// If a parameter or an option is not usable, or there is no such curve.
    pub fn track(
        &self,
        event: &CycleEvent,
        second: &str,
        [low, high]: [f64; 2],
    ) -> Result<Track, Error> {
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
            return Err(Error::Varied { name, must });
        }
        let plane = trace::Plane {
            system: self.system,
            second: variable,
            name: second.to_owned(),
            ranges: [[from, to], [low, high]],
        };
        trace::track(&setting, event, &plane)
    }

    /// The range, and everything else that was asked for, checked.
    fn ranged(&self) -> Result<([f64; 2], Setting<'a>), Error> {
        let from = self.from.ok_or(Error::Missing { name: "from" })?;
        let to = self.to.ok_or(Error::Missing { name: "to" })?;
        let setting = self.setting(from, to)?;
        validate::range(self.system.facts(), setting.variable, from, to)?;
        Ok(([from, to], setting))
    }

    /// Checks everything that was asked for.
    fn setting(&self, from: f64, to: f64) -> Result<Setting<'a>, Error> {
        let facts = self.system.facts();
        if facts.coordinates.is_empty() {
            return Err(Error::NoCoordinates);
        }
        self.check_options()?;
        let variable = validate::variable(facts, self.vary.as_deref())?;
        let mut parameters = vec![0.0; facts.parameters.len()];
        self.system.values(&mut parameters);
        let given = match (variable, self.omega) {
            (Variable::Omega, None) => None,
            (Variable::Omega, Some(value)) => {
                let must = "is what is varied: it has its own value";
                return Err(Error::Option {
                    name: "omega",
                    value,
                    must,
                });
            }
            (Variable::Parameter(_), None) => return Err(Error::Missing { name: "omega" }),
            (Variable::Parameter(_), Some(omega)) => Some(omega),
        };
        for value in [to, from] {
            let omega = validate::omega(given.unwrap_or(value))?;
            if let Variable::Parameter(index) = variable {
                parameters[index] = value;
            }
            validate::parameters(facts, &parameters)?;
            validate::levels(self.system, &parameters, omega)?;
            validate::mass(self.system, &parameters, omega)?;
        }
        let omega = given.unwrap_or(from);
        let layout = Layout::of(self.system);
        let range = [from, to];
        let odd = is_odd(self.system, &layout, &parameters, omega, variable, range);
        Ok(Setting {
            source: self.source(&parameters, omega),
            varied: self.vary.clone().unwrap_or_else(|| "omega".to_owned()),
            parameters,
            omega,
            variable,
            divisor: facts.divisor,
            period: self.period,
            segments: self.segments.unwrap_or(self.period),
            odd: odd && !self.period.is_multiple_of(2),
            stability: self.stability,
            points: validate::max_points(self.max_points)?,
            steps: validate::largest_step(self.largest_step)?,
        })
    }

    /// Checks the numbers among the options.
    fn check_options(&self) -> Result<(), Error> {
        let coordinates = self.system.facts().coordinates.len();
        let segments = self.segments.unwrap_or(self.period);
        for (name, value, range, must) in [
            (
                "period",
                self.period as f64,
                1.0..=1000.0,
                "must be from 1 to 1000",
            ),
            (
                "tolerance",
                self.tolerance,
                1e-14..=1e-3,
                "must be from 1e-14 to 1e-3",
            ),
            (
                "segments",
                segments as f64,
                1.0..=(MOST_UNKNOWNS / (2 * coordinates)) as f64,
                "must be at least 1, and 3000 at most, divided by the number of coordinates",
            ),
        ] {
            validate::option(name, value, range, must)?;
        }
        let (entries, state) = match &self.near {
            None => return Ok(()),
            Some(Guess::State(state)) => (state.len(), &state[..]),
            Some(Guess::Series(orbit)) => (2 * orbit.coordinates, &[][..]),
        };
        if entries != 2 * coordinates {
            let expected = 2 * coordinates;
            return Err(Error::State { entries, expected });
        }
        let bad = state.iter().find(|x| !x.is_finite());
        bad.map_or(Ok(()), |&value| {
            Err(Error::Option {
                name: "near",
                value,
                must: "must be finite",
            })
        })
    }

    /// Where flows of the system come from.
    fn source(&self, parameters: &[f64], omega: f64) -> Source<'a> {
        let system = self.system;
        let parameters = parameters.to_vec();
        let exact = Affine::new(system, &parameters, omega).is_ok();
        Source {
            make: Box::new(move |tolerance| {
                flow::at(system, &parameters, omega, Options { tolerance })
            }),
            exact,
            tolerance: self.tolerance,
        }
    }

    /// What the orbit at a value is near.
    fn guess(&self, value: f64) -> Result<Guess, Error> {
        if let Some(guess) = &self.near {
            return Ok(guess.clone());
        }
        let mut request = FrequencyResponse::of(self.system)
            .period(self.period)
            .stability(false);
        if let (Some(name), Some(omega)) = (&self.vary, self.omega) {
            request = request.vary(name).omega(omega);
        }
        Ok(Guess::Series(request.orbit(value)?.orbit))
    }
}
