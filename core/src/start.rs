//! The first orbit of a branch, without a guess from the user.
//!
//! 1. *At rest*: the balance with no harmonics is the static equilibrium under the mean load, switches and moving
//!    contacts included.
//! 2. *Linear response*: one step of Newton's method from rest is the response of the system linearised there; the
//!    iteration goes on from it.
//! 3. *Equivalent linearisation*: where the stiffness at rest is zero or unbounded (no load), the balance in the
//!    harmonics of the load alone, from amplitudes in geometric sequence and both phases. Source: Krylov and
//!    Bogoliubov (1943), Introduction to Non-Linear Mechanics. Of several solutions the one of smallest amplitude is
//!    taken, which is the one that small drives lead to.
//! 4. *Homotopy* in the drive, from the state at rest.
//!
//! An orbit of period `n` is found from the one of period one, disturbed in its lowest subharmonic.

use crate::balance::{Balance, Parity, Resolution};
use crate::continuation::follow::{FollowOptions, Start, Visit, follow};
use crate::continuation::problem::Problem;
use crate::continuation::step::StepControl;
use crate::error::Error;
use crate::fourier::series;
use crate::jacobian::{Jacobian, Partition};
use crate::newton::{Border, Newton, NewtonError, NewtonOptions};
use crate::statistics::Statistics;
use crate::system::{System, Variable};

/// Where to start, and how finely.
#[derive(Clone, Copy)]
pub(crate) struct StartRequest<'a> {
    pub(crate) system: &'a dyn System,
    pub(crate) parameters: &'a [f64],
    pub(crate) omega: f64,
    pub(crate) variable: Variable,
    pub(crate) value: f64,
    pub(crate) resolution: Resolution,
    pub(crate) newton: NewtonOptions,
}

/// Extended unknowns of an orbit at the requested value.
pub(crate) fn start(
    request: StartRequest<'_>,
    statistics: &mut Statistics,
) -> Result<Vec<f64>, Error> {
    let period = request.resolution.period;
    if period == 1 {
        return first_orbit(request, statistics).map_err(|reason| Error::NoStart {
            parameter: request.value,
            reason,
        });
    }
    let resolution = Resolution {
        harmonics: (request.resolution.harmonics / period).max(1),
        period: 1,
        ..request.resolution
    };
    let simple = first_orbit(
        StartRequest {
            resolution,
            ..request
        },
        statistics,
    )
    .map_err(|reason| Error::NoStart {
        parameter: request.value,
        reason,
    })?;
    subharmonic_orbit(request, &simple, statistics).ok_or(Error::NoSuchPeriod {
        period,
        parameter: request.value,
    })
}

/// One balance at a fixed value of the variable.
struct Fixed<'a> {
    balance: Balance<'a>,
    newton: Newton,
    border: Vec<f64>,
    residual: Vec<f64>,
    value: f64,
}

impl<'a> Fixed<'a> {
    fn new(request: &StartRequest<'a>, harmonics: usize) -> Self {
        // Without its harmonics a symmetric orbit has no unknowns; at rest there is but the mean.
        let resolution = Resolution {
            harmonics,
            parity: if harmonics > 0 {
                request.resolution.parity
            } else {
                Parity::All
            },
            ..request.resolution
        };
        let balance = Balance::new(
            request.system,
            request.parameters,
            request.omega,
            request.variable,
            resolution,
        );
        let n = balance.unknowns();
        let mut border = vec![0.0; n + 1];
        border[n] = 1.0;
        Self {
            newton: Newton::new(&balance),
            balance,
            border,
            residual: vec![0.0; n],
            value: request.value,
        }
    }

    /// An extended vector of zeros at the value.
    fn zeros(&self) -> Vec<f64> {
        let mut u = vec![0.0; self.border.len()];
        u[self.border.len() - 1] = self.value;
        u
    }

    fn residual(&mut self, u: &[f64]) -> f64 {
        self.balance.evaluate(u, &mut self.residual, None);
        self.newton.statistics.residuals += 1;
        crate::linear::dot(&self.residual, &self.residual).sqrt()
    }

    /// Newton's method at the fixed value.
    fn solve(&mut self, u: &mut [f64], options: NewtonOptions) -> Result<(), NewtonError> {
        let last = u.len() - 1;
        let parameter = if self.value == 0.0 {
            1.0
        } else {
            self.value.abs()
        };
        let scale = self.newton.norm().scale_at(u, parameter, &mut [0.0; 2]);
        let border = Border {
            row: &self.border,
            value: self.value,
        };
        let done = self
            .newton
            .correct(&mut self.balance, u, border, scale, options)
            .map(|_| ());
        u[last] = self.value;
        done
    }
}

fn first_orbit(
    request: StartRequest<'_>,
    statistics: &mut Statistics,
) -> Result<Vec<f64>, NewtonError> {
    let mut full = Fixed::new(&request, request.resolution.harmonics);
    let result = first_orbit_in(&request, &mut full, statistics);
    *statistics += full.newton.statistics;
    result
}

fn first_orbit_in(
    request: &StartRequest<'_>,
    full: &mut Fixed<'_>,
    statistics: &mut Statistics,
) -> Result<Vec<f64>, NewtonError> {
    let rest = at_rest(request, statistics);
    let undamped = NewtonOptions {
        iterations: 8,
        damped: false,
        ..request.newton
    };
    let from_rest = rest.as_ref().map_err(|&error| error).and_then(|rest| {
        let mut u = spread(rest, full);
        full.solve(&mut u, undamped).map(|()| u)
    });
    let Err(mut reason) = from_rest else {
        return from_rest;
    };
    let damped = NewtonOptions {
        iterations: 40,
        damped: true,
        ..request.newton
    };
    let rest = rest.ok();
    for candidate in equivalent_linearisation(request, rest.as_deref(), statistics) {
        let mut u = spread(&candidate, full);
        match full.solve(&mut u, damped) {
            Ok(()) => return Ok(u),
            Err(error) => reason = error,
        }
    }
    rest.map_or(Err(reason), |rest| {
        homotopy(request, spread(&rest, full), statistics).ok_or(reason)
    })
}

/// The static equilibrium, a balance of no harmonics; or what the last attempt to find it said.
fn at_rest(
    request: &StartRequest<'_>,
    statistics: &mut Statistics,
) -> Result<Vec<f64>, NewtonError> {
    let mut fixed = Fixed::new(request, 0);
    let n = fixed.border.len() - 1;
    let origin = fixed.zeros();
    let at_origin = fixed.residual(&origin);
    let mut found = Err(NewtonError::NotFinite { iterations: 0 });
    if at_origin == 0.0 {
        found = Ok(origin);
    } else {
        let direction: Vec<f64> = fixed.residual.iter().map(|r| -r / at_origin).collect();
        let mut along = |s: f64| {
            let mut u = origin.clone();
            for i in 0..n {
                u[i] = s * direction[i];
            }
            (fixed.residual(&u), u)
        };
        let mut trials: Vec<_> = geometric()
            .map(&mut along)
            .filter(|(r, _)| r.is_finite())
            .collect();
        trials.sort_by(|a, b| a.0.total_cmp(&b.0));
        let options = NewtonOptions {
            iterations: 60,
            damped: true,
            ..request.newton
        };
        for (_, mut u) in trials.into_iter().take(6) {
            found = fixed.solve(&mut u, options).map(|()| u);
            if found.is_ok() {
                break;
            }
        }
    }
    *statistics += fixed.newton.statistics;
    found
}

/// Amplitudes from tiny to huge, eight a decade.
fn geometric() -> impl Iterator<Item = f64> {
    (-96..=96).map(|i| 10_f64.powf(f64::from(i) / 8.0))
}

/// Solutions in the harmonics of the load alone, smallest amplitude first.
fn equivalent_linearisation(
    request: &StartRequest<'_>,
    rest: Option<&[f64]>,
    statistics: &mut Statistics,
) -> Vec<Vec<f64>> {
    let load = crate::layout::Layout::of(request.system).load_harmonic();
    let harmonics = load.clamp(1, request.resolution.harmonics.max(1));
    let mut fixed = Fixed::new(request, harmonics);
    let origin = rest.map_or_else(|| fixed.zeros(), |rest| spread(rest, &fixed));
    let mut pattern = load_pattern(&mut fixed);
    if pattern.iter().all(|x| *x == 0.0) {
        pattern[1] = 1.0;
    }
    let mut starts = Vec::new();
    for sign in [1.0, -1.0] {
        let along: Vec<_> = geometric()
            .map(|a| {
                let u: Vec<f64> = origin
                    .iter()
                    .zip(&pattern)
                    .map(|(x, p)| x + sign * a * p)
                    .collect();
                (fixed.residual(&u), u)
            })
            .collect();
        let valleys = along
            .windows(3)
            .filter(|w| w[1].0 <= w[0].0 && w[1].0 <= w[2].0);
        starts.extend(valleys.map(|w| w[1].1.clone()));
    }
    let options = NewtonOptions {
        iterations: 60,
        damped: true,
        ..request.newton
    };
    let mut found: Vec<Vec<f64>> = Vec::new();
    for mut u in starts {
        if fixed.solve(&mut u, options).is_ok() {
            found.push(u);
        }
    }
    *statistics += fixed.newton.statistics;
    let length = fixed.balance.length();
    found.sort_by(|a, b| oscillation(a, length).total_cmp(&oscillation(b, length)));
    found
}

/// The oscillating part of the load as a unit vector of the extended unknowns.
fn load_pattern(fixed: &mut Fixed<'_>) -> Vec<f64> {
    let mut pattern = vec![0.0; fixed.border.len()];
    let n = pattern.len() - 1;
    fixed.balance.set(fixed.value);
    let coefficients = fixed.balance.coefficients();
    fixed.balance.add_load(coefficients, 1.0, &mut pattern[..n]);
    let length = fixed.balance.length();
    for (index, x) in pattern[..n].iter_mut().enumerate() {
        if index % length == 0 {
            *x = 0.0;
        }
    }
    let norm = crate::linear::dot(&pattern, &pattern).sqrt();
    if norm > 0.0 {
        for x in &mut pattern {
            *x /= norm;
        }
    }
    pattern
}

/// Sum of squares of all but the means.
fn oscillation(u: &[f64], length: usize) -> f64 {
    let n = u.len() - 1;
    u[..n]
        .iter()
        .enumerate()
        .filter(|(i, _)| i % length != 0)
        .map(|(_, x)| x * x)
        .sum()
}

/// An orbit of fewer harmonics as unknowns of another balance of the same period.
fn spread(u: &[f64], to: &Fixed<'_>) -> Vec<f64> {
    let mut result = to.zeros();
    let coordinates = to.balance.layout().coordinates;
    let (from, length) = ((u.len() - 1) / coordinates, to.balance.length());
    let shared = from.min(length);
    for i in 0..coordinates {
        result[i * length..][..shared].copy_from_slice(&u[i * from..][..shared]);
    }
    // What is no unknown there, as the mean of a symmetric orbit, is zero.
    let Partition { core, tail, .. } = to.balance.partition();
    let last = result.len() - 1;
    let mut kept = vec![0.0; result.len()];
    for unknown in core.into_iter().chain(tail).chain([last]) {
        kept[unknown] = result[unknown];
    }
    kept
}

/// Follows the orbit from rest while the drive grows from nothing.
fn homotopy(
    request: &StartRequest<'_>,
    mut rest: Vec<f64>,
    statistics: &mut Statistics,
) -> Option<Vec<f64>> {
    let mut fixed = Fixed::new(request, request.resolution.harmonics);
    let mut oscillating = vec![0.0; fixed.border.len() - 1];
    fixed.balance.set(fixed.value);
    fixed
        .balance
        .add_load(fixed.balance.coefficients(), -1.0, &mut oscillating);
    fixed.balance.set_drive_factor(0.0);
    fixed
        .balance
        .add_load(fixed.balance.coefficients(), 1.0, &mut oscillating);
    let mut problem = Homotopy {
        balance: fixed.balance,
        value: request.value,
        extended: rest.clone(),
        oscillating,
    };
    let last = rest.len() - 1;
    rest[last] = 0.0;
    let mut newton = fixed.newton;
    let options = FollowOptions {
        from: 0.0,
        to: 1.0,
        points: 2000,
        steps: StepControl::default(),
        newton: NewtonOptions {
            iterations: 12,
            damped: false,
            ..request.newton
        },
    };
    let mut end = None;
    let outcome = follow(
        &mut problem,
        &mut newton,
        Start::Near(rest),
        options,
        &mut |_, _, visit| {
            if let Visit::Point(point) = visit
                && point.parameter() == 1.0
            {
                end = Some(point.u.clone());
            }
            std::ops::ControlFlow::Continue(())
        },
    );
    *statistics += newton.statistics;
    outcome.ok()?;
    let mut u = end?;
    u[last] = request.value;
    Some(u)
}

/// The balance at a fixed value, as a function of the factor of its drive.
struct Homotopy<'a> {
    balance: Balance<'a>,
    value: f64,
    extended: Vec<f64>,
    /// The oscillating load with its sign in the residual: the derivative by the factor.
    oscillating: Vec<f64>,
}

impl Problem for Homotopy<'_> {
    fn unknowns(&self) -> usize {
        self.balance.unknowns()
    }

    fn partition(&self) -> Partition {
        self.balance.partition()
    }

    fn evaluate(&mut self, u: &[f64], residual: &mut [f64], jacobian: Option<&mut Jacobian>) {
        let n = self.balance.unknowns();
        self.extended[..n].copy_from_slice(&u[..n]);
        self.extended[n] = self.value;
        self.balance.set_drive_factor(u[n]);
        let Some(jacobian) = jacobian else {
            self.balance.evaluate(&self.extended, residual, None);
            return;
        };
        self.balance
            .evaluate(&self.extended, residual, Some(&mut *jacobian));
        jacobian.set_column(&self.oscillating);
    }

    fn apply(&mut self, u: &[f64], direction: &[f64], derivative: &mut [f64]) {
        let n = self.balance.unknowns();
        self.extended[..n].copy_from_slice(&u[..n]);
        self.extended[n] = self.value;
        self.balance.set_drive_factor(u[n]);
        let mut held = direction.to_vec();
        held[n] = 0.0;
        self.balance.apply(&self.extended, &held, derivative);
        for (to, by) in derivative.iter_mut().zip(&self.oscillating) {
            *to += by * direction[n];
        }
    }

    fn weights(&self, weights: &mut [f64]) {
        self.balance.weights(weights);
    }

    fn is_mean(&self, unknown: usize) -> bool {
        self.balance.is_mean(unknown)
    }
}

/// Harmonics and samples per excitation period in the search for a longer period: fewer harmonics for very long ones.
fn search_resolution(period: usize) -> (usize, usize) {
    ((60 / period).clamp(3, 10), 1024)
}

/// An orbit whose shortest period is the one asked for, near a disturbed orbit of period one: searched with few harmonics,
/// then solved with all.
fn subharmonic_orbit(
    request: StartRequest<'_>,
    simple: &[f64],
    statistics: &mut Statistics,
) -> Option<Vec<f64>> {
    let Resolution {
        harmonics,
        samples,
        period,
        ..
    } = request.resolution;
    let (searched_harmonics, searched_samples) = search_resolution(period);
    let coarse = Resolution {
        harmonics: harmonics.min(searched_harmonics * period),
        samples: samples.min(searched_samples * period),
        ..request.resolution
    };
    let searched = StartRequest {
        resolution: coarse,
        ..request
    };
    let mut candidates = longer_orbits(searched, simple, statistics);
    let mut full = Fixed::new(&request, harmonics);
    let options = NewtonOptions {
        iterations: 60,
        damped: true,
        ..request.newton
    };
    let length = full.balance.length();
    let coarse_length = series::length(coarse.harmonics);
    candidates
        .sort_by(|a, b| oscillation(a, coarse_length).total_cmp(&oscillation(b, coarse_length)));
    let found = candidates.into_iter().find_map(|candidate| {
        let mut u = spread(&candidate, &full);
        let solved = full.solve(&mut u, options).is_ok();
        (solved && has_shortest_period(&u, length, period)).then_some(u)
    });
    *statistics += full.newton.statistics;
    found
}

/// Every orbit of the period that Newton's method finds from disturbances of eight sizes and eight phases.
fn longer_orbits(
    request: StartRequest<'_>,
    simple: &[f64],
    statistics: &mut Statistics,
) -> Vec<Vec<f64>> {
    let mut fixed = Fixed::new(&request, request.resolution.harmonics);
    let stretched = stretch(simple, &fixed, request.resolution.period);
    let length = fixed.balance.length();
    let coordinates = fixed.balance.layout().coordinates;
    let size = oscillation(&stretched, length)
        .sqrt()
        .max(f64::MIN_POSITIVE);
    let options = NewtonOptions {
        tolerance: request.newton.tolerance.max(1e-5),
        iterations: 40,
        damped: true,
    };
    let mut found = Vec::new();
    for step in 0..8 {
        let amplitude = size * 0.1 * 10_f64.powf(f64::from(step) / 3.0);
        for direction in 0..8 {
            let (sine, cosine) = (f64::from(direction) * std::f64::consts::FRAC_PI_4).sin_cos();
            let mut u = stretched.clone();
            for i in 0..coordinates {
                u[i * length + 1] += amplitude * cosine;
                u[i * length + 2] += amplitude * sine;
            }
            let solved = fixed.solve(&mut u, options).is_ok();
            if solved && has_shortest_period(&u, length, request.resolution.period) {
                found.push(u);
            }
        }
    }
    *statistics += fixed.newton.statistics;
    found
}

/// An orbit of period one as unknowns of a balance of period `n`: harmonic `k` becomes harmonic `n k`.
fn stretch(u: &[f64], to: &Fixed<'_>, period: usize) -> Vec<f64> {
    let mut result = to.zeros();
    let coordinates = to.balance.layout().coordinates;
    let (from, length) = ((u.len() - 1) / coordinates, to.balance.length());
    for i in 0..coordinates {
        result[i * length] = u[i * from];
        for k in 1..=series::harmonics(&u[..from]) {
            if k * period <= series::harmonics(&result[..length]) {
                result[i * length + 2 * k * period - 1] = u[i * from + 2 * k - 1];
                result[i * length + 2 * k * period] = u[i * from + 2 * k];
            }
        }
    }
    result
}

/// Least share of the mean square that the harmonics of a longer period must have. Samples of a force that jumps disturb a
/// simple orbit a little; that is not a longer period.
const SUBHARMONIC_SHARE: f64 = 1e-4;

/// Whether no divisor of the period is a period of the orbit: for every prime divisor some harmonic is no multiple of it.
fn has_shortest_period(u: &[f64], length: usize, period: usize) -> bool {
    let n = u.len() - 1;
    let total = oscillation(u, length);
    let primes =
        (2..=period).filter(|p| period.is_multiple_of(*p) && (2..*p).all(|q| !p.is_multiple_of(q)));
    primes.into_iter().all(|prime| {
        let other: f64 = (0..n)
            .filter(|i| !(i % length).div_ceil(2).is_multiple_of(prime))
            .map(|i| u[i] * u[i])
            .sum();
        other > SUBHARMONIC_SHARE * total
    })
}
