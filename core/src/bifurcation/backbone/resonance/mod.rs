//! Phase resonance of the damped and driven system.
//!
//! At phase resonance the displacement that the load works on, in its first harmonic, lags a quarter of a period behind the load, so that the
//! load balances damping alone. With the load `a_i cos tau + b_i sin tau` on coordinate `i` and its harmonic `c_i cos tau + s_i sin tau`, the
//! balance gets an unknown more, the frequency, and an equation more:
//!
//! ```text
//! R(u, omega; A) = 0,      sum_i (a_i c_i + b_i s_i) = 0                                                     (1)
//! ```
//!
//! The first orbit is the one of a frequency response next to where (1) changes its sign, of several the one that moves most in phase with the
//! rate, `sum_i (a_i s_i - b_i c_i)`: between resonances (1) is met where hardly anything moves. `A` is what is varied, usually the amplitude of the load; the derivative of `R` by it is a central difference.
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
/// The end of the range of a response of one orbit is beside that by this part.
const BESIDE: f64 = 1e-3;
/// Step of the difference by what is varied, relative to its value or its range, whichever is larger.
const STEP: f64 = 1e-6;

/// Where a system is in phase resonance with its load, as a parameter varies from the value that it has: set up step by
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
    response: Option<Branch>,
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
            response: None,
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

        /// The first orbit is near one of this frequency response of the same system, by whatever method it was followed: instead of computing
        /// the response [between](Self::between) two frequencies.
        ///
        /// ```
        /// use hertzian::backbone::PhaseResonance;
        /// use hertzian::{FrequencyResponse, Shooting};
        ///
        /// hertzian::oscillator! {
        ///     /// Two masses, of which the second is driven.
        ///     Pair(x, y) {
        ///         param drive = 0.1;
        ///         ddot(x) + 0.02*dot(x) + 2*x - y = 0;
        ///         ddot(y) + 0.02*dot(y) + 2*y - x = drive*cos(omega*t);
        ///     }
        /// }
        ///
        /// let model = Pair::default();
        /// let response = FrequencyResponse::of(&model).by(Shooting::new()).from(0.8).to(1.2).run()?;
        /// let curve = PhaseResonance::of(&model).vary("drive").to(0.2).on(&response).run()?;
        /// // Near its first mode the masses move as one, and half of the damping is that of the mass that is driven.
        /// assert!((curve.points[0].omega() - 1.0).abs() < 1e-3);
        /// # Ok::<(), hertzian::Error>(())
        /// ```
        on(response: &Branch) { self.response = Some(response.clone()) }

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
            leaps: Vec::new(),
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

    /// The orbit of the frequency response that is next to phase resonance, and a response with its harmonics.
    fn first(&self, parameters: &[f64], value: f64) -> Result<(Orbit, Branch), Error> {
        let plain = FrequencyResponse::of(&self.system).harmonics(self.harmonics);
        let plain = plain.stability(false).cancel(&self.cancel);
        if let Some(known) = &self.response {
            let near = self.nearest(parameters, value, known)?;
            // One orbit, by harmonics.
            let omega = near.omega;
            let alone = plain.near_orbit(&near).max_points(2);
            let alone = alone.from(omega).to(omega * (1.0 + BESIDE)).run()?;
            let first = alone.points.first().map(|point| point.orbit.clone());
            return Ok((first.unwrap_or(near), alone));
        }
        let [low, high] = self.between.ok_or(RequestError::Missing {
            name: "between",
            why: "it is not known where the resonance is looked for",
        })?;
        let branch = plain.from(low).to(high).run()?;
        if branch.stopped == Stop::Interrupted {
            return Err(OrbitError::Cancelled { value }.into());
        }
        Ok((self.nearest(parameters, value, &branch)?, branch))
    }

    /// The orbit of a response that is next to phase resonance.
    fn nearest(&self, parameters: &[f64], value: f64, response: &Branch) -> Result<Orbit, Error> {
        if response.varied != "omega" {
            return Err(RequestError::Varied {
                name: response.varied.clone(),
                must: "must be the excitation frequency of the response that resonance is looked for on",
            }
            .into());
        }
        let omegas = response.points.iter().map(Point::omega);
        let [low, high] = omegas.fold([f64::INFINITY, 0.0], |[low, high], omega| {
            [omega.min(low), omega.max(high)]
        });
        let mut balance = self.balance(parameters, high.max(f64::MIN_POSITIVE));
        let mut room = vec![0.0; balance.unknowns()];
        if !Load::of(&balance, &mut room).acts(&room) {
            return Err(BifurcationError::NoLoad.into());
        }
        let mut both = Vec::with_capacity(response.points.len());
        for point in &response.points {
            let read;
            let orbit = if point.orbit.has_series() {
                &point.orbit
            } else {
                read = response.complete(point)?;
                &read.orbit
            };
            balance.set(orbit.omega);
            let load = Load::of(&balance, &mut room);
            both.push(load.phases(&room, &orbit.series, orbit.coordinates()));
        }
        let changes = (1..both.len()).filter(|&i| both[i - 1][0] * both[i][0] <= 0.0);
        let nearer = changes.map(|i| i - usize::from(both[i - 1][0].abs() < both[i][0].abs()));
        let largest = nearer.max_by(|&a, &b| both[a][1].abs().total_cmp(&both[b][1].abs()));
        let nearest = largest.ok_or(BifurcationError::NoResonance {
            value,
            from: low,
            to: high,
        })?;
        let point = &response.points[nearest];
        if point.orbit.has_series() {
            return Ok(point.orbit.clone());
        }
        Ok(response.complete(point)?.orbit)
    }
}

/// Where the harmonic of the excitation stands in the load of all coordinates, which is in a room as long as the unknowns of a balance.
#[derive(Clone, Copy)]
struct Load {
    /// In the series of a coordinate.
    place: usize,
    coordinates: usize,
    /// How long that series is.
    length: usize,
}

impl Load {
    /// Writes the load of a balance.
    fn of(balance: &Balance<'_>, room: &mut [f64]) -> Self {
        room.fill(0.0);
        balance.add_load(balance.coefficients(), 1.0, room);
        let divisor = balance.system().facts().divisor as usize;
        let coordinates = balance.layout().coordinates;
        Self {
            place: 2 * divisor - 1,
            coordinates,
            length: room.len() / coordinates.max(1),
        }
    }

    /// Where cosines are in the room, coordinate by coordinate; sines stand behind them.
    fn places(self) -> impl Iterator<Item = usize> {
        (0..self.coordinates).map(move |i| i * self.length + self.place)
    }

    /// Its size.
    fn size(self, room: &[f64]) -> f64 {
        let squares = self.places().map(|i| room[i].powi(2) + room[i + 1].powi(2));
        squares.sum::<f64>().sqrt()
    }

    fn acts(self, room: &[f64]) -> bool {
        self.size(room) > 0.0
    }

    /// What a series of all coordinates has in phase with the load, and with its rate.
    fn phases(self, room: &[f64], series: &[f64], coordinates: usize) -> [f64; 2] {
        let length = series.len() / coordinates.max(1);
        let mut both = [0.0; 2];
        for (i, load) in self.places().enumerate() {
            let own = i * length + self.place;
            let [a, b] = [room[load], room[load + 1]];
            let [c, s] = [series[own], series[own + 1]];
            both[0] += a * c + b * s;
            both[1] += a * s - b * c;
        }
        both
    }
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
        let load = Load::of(&self.balance, &mut self.load);
        let size = load.size(&self.load);
        if size > 0.0 {
            self.load.iter_mut().for_each(|x| *x /= size);
        } else {
            // Without a load any phase is as good as another.
            self.load[load.place] = 1.0;
        }
        residual[n] = load.phases(&self.load, &u[..n], load.coordinates)[0];
        let Some(jacobian) = jacobian else {
            return;
        };
        for i in 0..n {
            let (from, to) = (self.inner.core_mut().row_mut(i), jacobian.core_mut());
            to.row_mut(i)[..=n].copy_from_slice(&from[..=n]);
        }
        let row = jacobian.core_mut().row_mut(n);
        for i in load.places() {
            row[i] = self.load[i];
            row[i + 1] = self.load[i + 1];
        }
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
