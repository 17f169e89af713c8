//! Phase resonance of the damped and driven system.
//!
//! At phase resonance the first harmonic of a coordinate lags a quarter of a period behind that of its load, so that the load
//! balances damping alone. With the load `a cos tau + b sin tau` and the harmonic `c cos tau + s sin tau`, the balance gets an
//! unknown more, the frequency, and an equation more:
//!
//! ```text
//! R(u, omega; A) = 0,      a c + b s = 0                                                                     (1)
//! ```
//!
//! `A` is what is varied, usually the amplitude of the load; the derivative of `R` by it is a central difference.
//!
//! Source: Peeters, Kerschen and Golinval (2011), Dynamic testing of nonlinear vibrating structures using nonlinear normal modes,
//! J. Sound Vib. 330 (phase lag quadrature); Volvert and Kerschen (2021), Phase resonance nonlinear modes of mechanical systems,
//! J. Sound Vib. 511.

use std::ops::ControlFlow;
use std::sync::Arc;
use std::time::Instant;

use crate::balance::aft::Aft;
use crate::balance::resolution::resize;
use crate::balance::{Balance, Parity, Resolution};
use crate::bifurcation::error::BifurcationError;
use crate::branches::branch::{Branch, Model};
use crate::branches::error::{OrbitError, unless_cancelled};
use crate::branches::orbit::Orbit;
use crate::branches::point::Point;
use crate::branches::progress::{Progress, Stage};
use crate::branches::recurrence::SignedPermutation;
use crate::branches::stability::Stability;
use crate::cancel::Cancel;
use crate::continuation::follow::{
    Continue, FollowOptions, Halt, Outcome, Start, Stop, Visit, follow,
};
use crate::continuation::jacobian::Jacobian;
use crate::continuation::newton::{Newton, NewtonOptions};
use crate::continuation::problem::Problem;
use crate::continuation::step_control::{self, StepControl};
use crate::error::Error;
use crate::model::request::RequestError;
use crate::model::{self, validate};
use crate::numeric::fourier::series;
use crate::orbit::observe::{Motion, Observer};
use crate::response::FrequencyResponse;
use crate::system::{System, Variable};
use crate::time::Work;

#[cfg(test)]
mod tests;

const HARMONICS: usize = 20;
const POINTS: usize = 5000;
/// Step of the difference by what is varied, relative to its value or its range, whichever is larger.
const STEP: f64 = 1e-6;

/// Where the first coordinate is in phase resonance with its load, as a parameter varies from the value that it has: set up step by
/// step, then [run](PhaseResonance::run). It gives a [`Branch`] over that parameter, along which the frequency follows the resonance. Nothing is
/// known of the stability of its orbits.
///
/// ```
/// use hertzian::backbone::PhaseResonance;
///
/// hertzian::oscillator! {
///     Linear(x) {
///         param drive;
///         ddot(x) + 0.1*dot(x) + x = drive*cos(omega*t);
///     }
/// }
///
/// let model = Linear { drive: 0.1 };
/// let curve = PhaseResonance::of(&model).vary("drive").to(0.2).between(0.5, 2.0).run()?;
/// // The load balances damping alone: omega = 1, amplitude = drive / 0.1.
/// for point in &curve.points {
///     assert!((point.omega() - 1.0).abs() < 1e-9);
///     assert!((point.peak_to_peak() - 20.0 * point.value).abs() < 1e-8);
/// }
/// # Ok::<(), hertzian::Error>(())
/// ```
#[derive(Debug, Clone)]
pub struct PhaseResonance {
    system: Arc<dyn System>,
    vary: Option<String>,
    to: Option<f64>,
    between: Option<[f64; 2]>,
    harmonics: usize,
    max_points: usize,
    largest_step: f64,
    cancel: Cancel,
}

impl PhaseResonance {
    /// Of this system, at the values that its parameters have now.
    pub fn of(system: &dyn System) -> Self {
        Self {
            system: system.shared(),
            vary: None,
            to: None,
            between: None,
            harmonics: HARMONICS,
            max_points: POINTS,
            largest_step: StepControl::default().largest,
            cancel: Cancel::new(),
        }
    }

    hertzian_contract::setters! { self:
        /// The parameter that varies, usually the amplitude of the load.
        vary(parameter: impl Into<String>) { self.vary = Some(parameter.into()) }

        /// What is computed ends when this token is cancelled, the search for the first oscillation too.
        cancel(cancel: &Cancel) { self.cancel = cancel.clone() }

        /// Where it ends. It starts at the value that the system has.
        to(value: f64) { self.to = Some(value) }

        /// The first orbit has an excitation frequency between these two: there the frequency response is computed, and searched for
        /// phase resonance.
        between(low: f64, high: f64) { self.between = Some([low, high]) }

        /// Number of harmonics. Default: 20.
        harmonics(harmonics: usize) { self.harmonics = harmonics }

        /// Largest step along the curve, as [`FrequencyResponse::largest_step`] measures it. Default: 0.1.
        largest_step(step: f64) { self.largest_step = step }

        /// Stop after this many points. Default: 5000.
        max_points(points: usize) { self.max_points = points }
    }

    /// Follows the curve.
    ///
    /// # Errors
    /// If a parameter or an option is not usable, or no orbit in phase resonance is found at the first value. A curve that ends
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
        mut visit: impl FnMut(Progress<'_>) -> ControlFlow<()>,
    ) -> Result<Branch, Error> {
        let started = Instant::now();
        let (index, parameters, options) = self.options()?;
        let value = options.from;
        let (first, response) = self.first(&parameters, value)?;
        let motion = Motion::of(first.row(0));
        let mut u = first.series.clone();
        u.push(first.omega);
        let mut u = resize(&u, first.coordinates(), series::length(self.harmonics));
        u.push(value);
        let balance = self.balance(&parameters, first.omega);
        let (size, range) = (motion.peak_to_peak(), (options.to - value).abs());
        let mut equations = Resonance::new(balance, parameters, index, size, range);
        let mut newton = Newton::new(&equations);
        let mut points: Vec<Point> = Vec::new();
        let see = &mut |equations: &mut Resonance<'_>, _: &mut Newton, seen: Visit<'_>| {
            let Visit::Point(at) = seen else {
                return Continue::Continue(());
            };
            let point = equations.read(&at.u);
            let progress = Progress {
                point: Some(&point),
                ..Progress::at(Stage::Curve, points.len() + 1, point.value)
            };
            let answer = visit(progress);
            points.push(point);
            if answer.is_break() {
                Continue::Break(Halt::Stop)
            } else {
                Continue::Continue(())
            }
        };
        let outcome = follow(&mut equations, &mut newton, Start::Near(u), options, see);
        let outcome = outcome.map_err(|reason| OrbitError::NoStart { value, reason }.into());
        let outcome = outcome.map_err(|error| unless_cancelled(&self.cancel, value, error));
        let stopped = match outcome? {
            Outcome::Stopped(stop) => stop,
            // A walk of one number of harmonics is never resized.
            Outcome::Halted(_) => Stop::Interrupted,
        };
        let mut statistics = response.statistics;
        statistics += newton.statistics;
        Ok(Branch {
            model: Model::of(&self.system),
            varied: self.vary.clone().unwrap_or_default(),
            points,
            events: Vec::new(),
            turns: Vec::new(),
            begin: None,
            stopped,
            statistics,
            work: Work::default(),
            elapsed: started.elapsed(),
            further: response.further.of_backbone(),
        })
    }

    /// What varies, the parameters where it starts, and how far it goes, checked.
    fn options(&self) -> Result<(usize, Vec<f64>, FollowOptions), Error> {
        let facts = self.system.facts();
        let name = self.vary.as_deref();
        let name = name.ok_or(RequestError::Missing {
            name: "vary",
            why: "it is not known what varies",
        })?;
        let Variable::Parameter(index) = validate::variable(facts, Some(name))? else {
            let name = name.to_owned();
            let must = "must be a parameter: the frequency follows from the resonance";
            return Err(RequestError::Varied { name, must }.into());
        };
        let parameters = model::values(&self.system);
        let from = parameters[index];
        let to = self.to.ok_or(RequestError::no_end("to"))?;
        validate::range(facts, Variable::Parameter(index), from, to)?;
        let harmonics = self.harmonics as f64;
        validate::option(
            "harmonics",
            harmonics,
            f64::from(facts.divisor)..=1000.0,
            "must be at most 1000, and at least the divisor of the declaration",
        )?;
        let options = FollowOptions {
            from,
            to,
            points: step_control::max_points(self.max_points)?,
            steps: step_control::largest_step(self.largest_step)?,
            newton: NewtonOptions {
                tolerance: 1e-10,
                iterations: 20,
                damped: false,
            },
        };
        Ok((index, parameters, options))
    }

    fn balance(&self, parameters: &[f64], omega: f64) -> Balance<'_> {
        let resolution = Resolution {
            harmonics: self.harmonics,
            core: self.harmonics,
            parity: Parity::All,
            stride: 1,
            samples: 8 * self.harmonics,
            aft: Aft::Switched,
            period: 1,
        };
        Balance::new(
            self.system.as_ref(),
            parameters,
            omega,
            Variable::Omega,
            resolution,
        )
        .until(&self.cancel)
    }

    /// The orbit of the frequency response that is next to phase resonance, and that response.
    fn first(&self, parameters: &[f64], value: f64) -> Result<(Orbit, Branch), Error> {
        let [low, high] = self.between.ok_or(RequestError::Missing {
            name: "between",
            why: "it is not known where the resonance is looked for",
        })?;
        let response = FrequencyResponse::of(&self.system).from(low).to(high);
        let response = response.harmonics(self.harmonics).stability(false);
        let response = response.cancel(&self.cancel);
        let branch = response.run()?;
        if branch.stopped == Stop::Interrupted {
            return Err(OrbitError::Cancelled { value }.into());
        }
        let mut balance = self.balance(parameters, low);
        let mut room = vec![0.0; balance.unknowns()];
        if load(&balance, &mut room).1 == [0.0; 2] {
            return Err(BifurcationError::NoLoad.into());
        }
        let mut lag = |orbit: &Orbit| {
            balance.set(orbit.omega);
            let (place, [a, b]) = load(&balance, &mut room);
            let series = orbit.row(0);
            a * series[place] + b * series[place + 1]
        };
        let lags: Vec<f64> = branch.points.iter().map(|p| lag(&p.orbit)).collect();
        let change = (1..lags.len()).find(|&i| lags[i - 1] * lags[i] <= 0.0);
        let nearest = change.map(|i| {
            let nearer = lags[i - 1].abs() < lags[i].abs();
            branch.points[i - usize::from(nearer)].orbit.clone()
        });
        let nearest = nearest.ok_or(BifurcationError::NoResonance {
            value,
            from: low,
            to: high,
        })?;
        Ok((nearest, branch))
    }
}

/// Where the harmonic of the excitation is in the series of the first coordinate, and the load there. The room is as long as the
/// unknowns of the balance.
fn load(balance: &Balance<'_>, load: &mut [f64]) -> (usize, [f64; 2]) {
    load.fill(0.0);
    balance.add_load(balance.coefficients(), 1.0, load);
    let divisor = balance.system().facts().divisor as usize;
    let place = 2 * divisor - 1;
    (place, [load[place], load[place + 1]])
}

/// The equations (1). The last of the extended unknowns is what is varied, the one before the frequency.
struct Resonance<'a> {
    balance: Balance<'a>,
    observer: Observer,
    /// Values of the parameters, but for the one that is varied.
    parameters: Vec<f64>,
    index: usize,
    /// What counts as one for displacements.
    size: f64,
    /// How far the parameter goes.
    range: f64,
    inner: Jacobian,
    ahead: Vec<f64>,
    behind: Vec<f64>,
    column: Vec<f64>,
    load: Vec<f64>,
}

impl<'a> Resonance<'a> {
    fn new(
        balance: Balance<'a>,
        parameters: Vec<f64>,
        index: usize,
        size: f64,
        range: f64,
    ) -> Self {
        let n = balance.unknowns();
        Self {
            observer: Observer::default(),
            parameters,
            inner: Jacobian::new(balance.partition()),
            ahead: vec![0.0; n],
            behind: vec![0.0; n],
            column: vec![0.0; n + 1],
            load: vec![0.0; n],
            balance,
            index,
            size: if size > 0.0 { size } else { 1.0 },
            range,
        }
    }

    fn read(&mut self, u: &[f64]) -> Point {
        let n = self.ahead.len();
        let value = u[n + 1];
        self.balance.set_parameter(self.index, value);
        self.balance.set(u[n]);
        let mut parameters = self.parameters.clone();
        parameters[self.index] = value;
        let orbit = Orbit {
            series: u[..n].to_vec(),
            coordinates: self.balance.layout().coordinates,
            omega: u[n],
            base: self.balance.base(),
            period: 1,
            states: Vec::new(),
            symmetric: false,
            parts: 1,
            image: SignedPermutation::identity(),
        };
        Point {
            value,
            parameters,
            orbit,
            stability: Stability::unknown(),
            observed: self.observer.observe(&mut self.balance, &u[..n]),
            error: None,
        }
    }
}

impl Problem for Resonance<'_> {
    fn unknowns(&self) -> usize {
        self.ahead.len() + 1
    }

    fn evaluate(&mut self, u: &[f64], residual: &mut [f64], jacobian: Option<&mut Jacobian>) {
        let n = self.ahead.len();
        let value = u[n + 1];
        if jacobian.is_some() {
            let step = STEP * value.abs().max(self.range);
            let varied = Variable::Parameter(self.index);
            let facts = self.balance.system().facts();
            let [below, above] = validate::around(facts, varied, value, step);
            for (at, to) in [(above, &mut self.ahead), (below, &mut self.behind)] {
                self.balance.set_parameter(self.index, at);
                self.balance.evaluate(&u[..=n], to, None);
            }
            let pairs = self.ahead.iter().zip(&self.behind);
            for (to, (a, b)) in self.column.iter_mut().zip(pairs) {
                *to = (a - b) / (above - below);
            }
        }
        self.balance.set_parameter(self.index, value);
        self.inner.clear();
        let inner = jacobian.is_some().then_some(&mut self.inner);
        self.balance.evaluate(&u[..=n], &mut residual[..n], inner);
        let (place, [a, b]) = load(&self.balance, &mut self.load);
        let size = a.hypot(b);
        let (a, b) = if size > 0.0 {
            (a / size, b / size)
        } else {
            (1.0, 0.0)
        };
        residual[n] = a * u[place] + b * u[place + 1];
        let Some(jacobian) = jacobian else {
            return;
        };
        for i in 0..n {
            let (from, to) = (self.inner.core_mut().row_mut(i), jacobian.core_mut());
            to.row_mut(i)[..=n].copy_from_slice(&from[..=n]);
        }
        let row = jacobian.core_mut().row_mut(n);
        row[place] = a;
        row[place + 1] = b;
        self.column[n] = 0.0;
        jacobian.set_column(&self.column);
    }

    fn is_cancelled(&self) -> bool {
        self.balance.is_cancelled()
    }

    fn weights(&self, weights: &mut [f64]) {
        let n = self.ahead.len();
        self.balance.weights(&mut weights[..n]);
        // The frequency counts relative to itself.
        let unit = self.size / self.balance.omega();
        weights[n] = unit * unit;
    }

    fn is_mean(&self, unknown: usize) -> bool {
        unknown < self.ahead.len() && self.balance.is_mean(unknown)
    }
}
