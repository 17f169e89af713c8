//! Frequency response: following periodic orbits as the excitation frequency or a parameter varies.

use std::ops::ControlFlow;
use std::time::Instant;

use crate::balance::{Balance, Resolution};
use crate::branch::{Branch, Event, EventKind, Orbit, Point, Turn};
use crate::continuation::follow::{CurvePoint, FollowOptions, Visit, follow};
use crate::continuation::locate::locate;
use crate::continuation::problem::{Norm, Problem};
use crate::continuation::step::StepControl;
use crate::error::Error;
use crate::fourier::series;
use crate::layout::{ContactLayout, Layout};
use crate::newton::{Newton, NewtonOptions};
use crate::observe::observe;
use crate::stability::judge::Judge;
use crate::start::{StartRequest, start};
use crate::statistics::Statistics;
use crate::system::{System, Variable};
use crate::truncation::Finer;
use crate::validate;

/// The test function of a fold is driven below this.
const FOLD_TOLERANCE: f64 = 1e-10;
/// A value asked for is met to this part of the range.
const VALUE_TOLERANCE: f64 = 1e-13;
/// More samples of an orbit would take more than a gigabyte.
const MOST_SAMPLES: usize = 10_000_000;
/// The dense matrix of more unknowns would take more than 300 megabytes.
const MOST_UNKNOWNS: usize = 6000;

/// What to follow, set up step by step, then [run](FrequencyResponse::run).
///
/// Only the two ends of the range have to be given. By default the excitation frequency is varied, the orbit has the
/// period of the excitation, and everything else follows from the tolerance.
#[derive(Clone)]
pub struct FrequencyResponse<'a> {
    system: &'a dyn System,
    vary: Option<String>,
    omega: Option<f64>,
    from: Option<f64>,
    to: Option<f64>,
    harmonics: Option<usize>,
    samples: Option<usize>,
    period: usize,
    tolerance: f64,
    max_points: usize,
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
            period: 1,
            tolerance: 1e-6,
            max_points: 20_000,
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

    /// Period of the orbit in excitation periods. Default: 1.
    #[must_use]
    pub fn period(mut self, period: usize) -> Self {
        self.period = period;
        self
    }

    /// Relative accuracy asked of peak-to-peak. Default: 1e-6. Harmonics, samples and the tolerance of Newton's method
    /// follow from it.
    #[must_use]
    pub fn tolerance(mut self, tolerance: f64) -> Self {
        self.tolerance = tolerance;
        self
    }

    /// Harmonics of the base frequency, which is omega over the divisor of the declaration (one, unless it has fractions of
    /// omega), for an orbit of period one; an orbit of period `n` has `n` times as many. Default: 20 times the divisor at the
    /// default tolerance, twice as many for every two digits more, and between 5 and 100.
    #[must_use]
    pub fn harmonics(mut self, harmonics: usize) -> Self {
        self.harmonics = Some(harmonics);
        self
    }

    /// Samples per excitation period. Default: at least 200 per harmonic, a power of two. The derivative of a force like
    /// `g^1.5` has a kink where contact begins; folds feel it as the power -1.5 of the samples.
    #[must_use]
    pub fn samples(mut self, samples: usize) -> Self {
        self.samples = Some(samples);
        self
    }

    /// Stop after this many points. Default: 20000.
    #[must_use]
    pub fn max_points(mut self, points: usize) -> Self {
        self.max_points = points;
        self
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
        let first = start(follower.start_request(options), &mut statistics)?;
        let mut run = Run::new(&follower);
        let mut balance = follower.balance();
        let mut newton = Newton::new(&balance);
        let outcome = follow(
            &mut balance,
            &mut newton,
            first,
            options,
            &mut |b, n, seen| run.visit(b, n, &seen, options.newton, &mut visit),
        );
        let stopped = outcome.map_err(|reason| Error::NoStart {
            parameter: options.from,
            reason,
        })?;
        statistics += newton.statistics;
        statistics.monodromies += run.judge.computed;
        Ok(Branch {
            varied: self.vary.clone().unwrap_or_else(|| "omega".to_owned()),
            points: run.points,
            events: run.events,
            turns: run.turns,
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
        let from = self.from.ok_or(Error::MissingEnd { name: "from" })?;
        let to = self.to.ok_or(Error::MissingEnd { name: "to" })?;
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
            (Variable::Parameter(_), None) => return Err(Error::MissingEnd { name: "omega" }),
        };
        validate::parameters(facts, &parameters)?;
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
        )?;
        validate::option(
            "max_points",
            self.max_points as f64,
            2.0..=1e9,
            "must be 2 or more",
        )?;
        let resolution = self.resolution()?;
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
        let steps = StepControl::default();
        let options = FollowOptions {
            from,
            to,
            points: self.max_points,
            steps,
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
                from,
                to,
            },
            options,
        ))
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
            samples,
            period: self.period,
        })
    }
}

/// What it takes to compute further orbits of a branch.
#[derive(Clone)]
pub(crate) struct Follower<'a> {
    pub(crate) system: &'a dyn System,
    parameters: Vec<f64>,
    omega: f64,
    variable: Variable,
    resolution: Resolution,
    newton: NewtonOptions,
    from: f64,
    to: f64,
}

impl std::fmt::Debug for Follower<'_> {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Follower")
            .field("variable", &self.variable)
            .finish_non_exhaustive()
    }
}

impl<'a> Follower<'a> {
    fn balance(&self) -> Balance<'a> {
        Balance::new(
            self.system,
            &self.parameters,
            self.omega,
            self.variable,
            self.resolution,
        )
    }

    fn finer(&self) -> Finer<'a> {
        Finer::new(
            self.system,
            &self.parameters,
            self.omega,
            self.variable,
            self.resolution,
        )
    }

    fn start_request(&self, options: FollowOptions) -> StartRequest<'_> {
        StartRequest {
            system: self.system,
            parameters: &self.parameters,
            omega: self.omega,
            variable: self.variable,
            value: options.from,
            resolution: self.resolution,
            newton: options.newton,
        }
    }

    /// See [`Branch::at`].
    pub(crate) fn at(
        &self,
        points: &[Point],
        events: &[Event],
        value: f64,
    ) -> Result<Vec<Point>, Error> {
        let mut balance = self.balance();
        let mut newton = Newton::new(&balance);
        let mut judge = Judge::new(self.finer());
        let mut found: Vec<Point> = Vec::new();
        // Between folds the branch is monotonic, so every part of this chain passes a value at most once.
        let chain = chain(points, events);
        for (index, point) in chain.iter().enumerate() {
            let solution = if point.value == value {
                Some((*point).clone())
            } else {
                match chain.get(index + 1) {
                    Some(next)
                        if next.value != value && (point.value < value) != (next.value < value) =>
                    {
                        let u = self.between(&mut balance, &mut newton, (point, next), value)?;
                        Some(point_of(&mut balance, &mut newton, &mut judge, &u))
                    }
                    _ => None,
                }
            };
            // A closed branch ends where it began.
            found.extend(
                solution.filter(|new| !found.iter().any(|old| is_same(&old.orbit, &new.orbit))),
            );
        }
        Ok(found)
    }

    /// The orbit at a value between those of two neighbours, searched along the chord of the two.
    fn between(
        &self,
        balance: &mut Balance<'_>,
        newton: &mut Newton,
        (a, b): (&Point, &Point),
        value: f64,
    ) -> Result<Vec<f64>, Error> {
        let extended = |point: &Point| {
            let mut u = point.orbit.series.clone();
            u.push(point.value);
            u
        };
        let (from, to) = (extended(a), extended(b));
        let range = (self.to - self.from).abs();
        let norm: &Norm = newton.norm();
        let mut largest = [0.0; 2];
        norm.scale_at(&to, range, &mut largest);
        let scale = norm.scale_at(&from, range, &mut largest);
        let mut tangent: Vec<f64> = to.iter().zip(&from).map(|(x, y)| x - y).collect();
        let length = norm.length(scale, &tangent);
        for t in &mut tangent {
            *t /= length;
        }
        let first = CurvePoint {
            u: from,
            tangent: tangent.clone(),
            scale,
        };
        let second = CurvePoint {
            u: to,
            tangent,
            scale,
        };
        let offset = |point: &CurvePoint| (point.parameter() - value) / range;
        let located = locate(
            balance,
            newton,
            (&first, &second),
            self.newton,
            VALUE_TOLERANCE,
            offset,
        );
        let lost = Error::Lost {
            value,
            from: a.value,
            to: b.value,
        };
        let mut u = located
            .filter(|located| located.vanishes)
            .ok_or(lost)?
            .point
            .u;
        let last = u.len() - 1;
        u[last] = value;
        Ok(u)
    }
}

/// Points and folds of a branch in their order along it.
fn chain<'p>(points: &'p [Point], events: &'p [Event]) -> Vec<&'p Point> {
    let mut chain = Vec::with_capacity(points.len() + events.len());
    for (index, point) in points.iter().enumerate() {
        let folds = events
            .iter()
            .filter(|event| event.after == index && event.kind == EventKind::Fold);
        chain.extend(folds.map(|event| &event.point));
        chain.push(point);
    }
    chain
}

/// Whether two orbits are one to nine digits.
fn is_same(a: &Orbit, b: &Orbit) -> bool {
    let size = a.series.iter().fold(0.0, |m: f64, x| m.max(x.abs()));
    a.omega == b.omega
        && a.series
            .iter()
            .zip(&b.series)
            .all(|(x, y)| (x - y).abs() <= 1e-9 * size)
}

/// What a run has gathered.
struct Run<'a> {
    judge: Judge<'a>,
    finer: Finer<'a>,
    points: Vec<Point>,
    events: Vec<Event>,
    turns: Vec<Turn>,
}

impl<'a> Run<'a> {
    fn new(follower: &Follower<'a>) -> Self {
        Self {
            judge: Judge::new(follower.finer()),
            finer: follower.finer(),
            points: Vec::new(),
            events: Vec::new(),
            turns: Vec::new(),
        }
    }

    fn visit(
        &mut self,
        balance: &mut Balance<'_>,
        newton: &mut Newton,
        seen: &Visit<'_>,
        options: NewtonOptions,
        visit: &mut impl FnMut(&Point) -> ControlFlow<()>,
    ) -> ControlFlow<()> {
        match seen {
            Visit::Point(at) => {
                let point = point_of(balance, newton, &mut self.judge, &at.u);
                let answer = visit(&point);
                self.points.push(point);
                answer
            }
            Visit::Turn(before, behind) => {
                self.turn(balance, newton, (before, behind), options);
                ControlFlow::Continue(())
            }
        }
    }

    /// Locates the fold between two points, or the jump that is there instead.
    fn turn(
        &mut self,
        balance: &mut Balance<'_>,
        newton: &mut Newton,
        between: (&CurvePoint, &CurvePoint),
        options: NewtonOptions,
    ) {
        // The point behind the turn has been stored already.
        let after = self.points.len() - 1;
        let slope = CurvePoint::parameter_slope;
        match locate(balance, newton, between, options, FOLD_TOLERANCE, slope) {
            Some(located) if located.vanishes => {
                let u = &located.point.u;
                let error = self.finer.fold_error(u, newton);
                let point = point_of(balance, newton, &mut self.judge, u);
                let kind = EventKind::Fold;
                self.events.push(Event {
                    kind,
                    point,
                    error,
                    test: located.test,
                    after,
                });
            }
            Some(located) => {
                let value = located.point.parameter();
                self.turns.push(Turn {
                    value,
                    test: located.test,
                    after,
                });
            }
            None => {
                let value = 0.5 * (between.0.parameter() + between.1.parameter());
                self.turns.push(Turn {
                    value,
                    test: between.0.parameter_slope(),
                    after,
                });
            }
        }
    }
}

/// Everything that is read off a solution, whose factors Newton's method holds.
fn point_of(
    balance: &mut Balance<'_>,
    newton: &mut Newton,
    judge: &mut Judge<'_>,
    u: &[f64],
) -> Point {
    let n = balance.unknowns();
    balance.set(u[n]);
    let stability = judge.stability(balance, newton, u);
    let orbit = Orbit {
        series: u[..n].to_vec(),
        coordinates: balance.layout().coordinates,
        omega: balance.omega(),
        base: balance.base(),
        period: balance.resolution().period,
    };
    let observed = observe(balance, u);
    Point {
        value: u[n],
        parameters: balance.parameters().to_vec(),
        orbit,
        stability,
        observed,
    }
}
