//! An orbit of shooting with its Fourier series, and everything that is read off one.
//!
//! Positions are sampled along the motion itself and transformed, so coefficients err by aliasing only: those of displacements
//! fall at least as `k^-3`, and there are hundreds of samples for each harmonic that is kept.

use std::f64::consts::TAU;

use super::closed;
use super::equations::Equations;
use super::problem::ShootingProblem;
use super::signals::{Found, Reader};
use super::start;
use crate::balance::aft::Aft;
use crate::balance::{Balance, Parity, Resolution};
use crate::branches::observed::{EXTREMES, Motion};
use crate::branches::orbit::Orbit;
use crate::branches::point::Point;
use crate::error::Error;
use crate::numeric::fourier::sampled::SampledTransform;
use crate::numeric::fourier::series;
use crate::orbit::observe::Observer;
use crate::time::history;
use crate::time::signals::Asked;
use crate::time::stroboscope::Stroboscope;
use crate::time::{FlowError, MotionError};

/// Samples for each period of the declaration, and harmonics that are kept, for each unit of the divisor.
const SAMPLES: usize = 1024;
const HARMONICS: usize = 20;

/// What is read off a motion over the period of an orbit.
pub(crate) struct Readings<'r> {
    pub(crate) outputs: Vec<Motion>,
    /// Positions at equal distances, [so many](samples) in each period of the declaration, coordinate by coordinate.
    pub(crate) samples: Vec<f64>,
    /// What coordinates do, where the orbit does not say so.
    pub(crate) extremes: Vec<Motion>,
    /// Along which the forces of contacts were read.
    pub(crate) contacts: Reader<'r>,
}

/// Samples in a period of the declaration.
pub(crate) fn samples(problem: &ShootingProblem) -> usize {
    SAMPLES * problem.divisor as usize
}

/// Harmonics that are kept of an orbit of so many periods of the declaration.
pub(crate) fn harmonics(problem: &ShootingProblem, period: usize) -> usize {
    HARMONICS * problem.divisor as usize * period
}

/// An orbit with its series, and everything that is read off.
///
/// # Errors
/// If the motion cannot be computed.
pub(crate) fn complete(problem: &ShootingProblem, point: &Point) -> Result<Point, Error> {
    let (outputs, closed) = read(problem, point, Asked::Outputs, 0)?;
    let (given, point) = (point, &closed);
    let extremes = if point.observed.sampled {
        read_along(problem, point, Asked::Coordinates)?.motions()
    } else {
        Vec::new()
    };
    let readings = Readings {
        outputs: outputs.motions(),
        samples: sampled(problem, point, samples(problem))?,
        extremes,
        contacts: read_along(problem, point, Asked::Contacts)?,
    };
    Ok(assembled(problem, given, readings))
}

/// An orbit with what was read off its motion.
pub(crate) fn assembled(problem: &ShootingProblem, point: &Point, readings: Readings<'_>) -> Point {
    let Readings {
        outputs,
        samples,
        extremes,
        contacts,
    } = readings;
    let count = samples.len() / point.orbit.coordinates;
    let harmonics = harmonics(problem, point.orbit.period);
    let mut transform = SampledTransform::new(count);
    let mut u = vec![0.0; point.orbit.coordinates * series::length(harmonics) + 1];
    let parts = u.chunks_exact_mut(series::length(harmonics));
    for (samples, series) in samples.chunks_exact(count).zip(parts) {
        transform.analyse(samples, series);
    }
    let n = u.len() - 1;
    u[n] = point.value;
    let resolution = Resolution {
        harmonics,
        core: harmonics,
        parity: Parity::All,
        stride: 1,
        samples: count,
        aft: Aft::Switched,
        period: point.orbit.period,
    };
    let mut balance = Balance::new(
        problem.system.as_ref(),
        &point.parameters,
        point.orbit.omega,
        problem.variable,
        resolution,
    );
    balance.set(point.value);
    let mut observed = Observer::default().observe(&mut balance, &u);
    let extremes = if point.observed.sampled {
        &extremes
    } else {
        &point.observed.motions
    };
    let parts = samples.chunks_exact(count).zip(extremes);
    for (motion, (samples, extremes)) in observed.motions.iter_mut().zip(parts) {
        let square: f64 = samples.iter().map(|x| x * x).sum();
        motion.maximum = extremes.maximum;
        motion.minimum = extremes.minimum;
        motion.rms = Some((square / count as f64).sqrt());
    }
    u.truncate(n);
    observed.switches = point.observed.switches;
    // Outputs and contacts from the motion itself: forces take more harmonics than positions.
    observed.outputs = kept(&point.observed.outputs, outputs);
    (observed.contacts, observed.on_pieces) = contacts.contacts(TAU / point.orbit.base);
    Point {
        orbit: Orbit {
            series: u,
            ..point.orbit.clone()
        },
        observed,
        ..point.clone()
    }
}

/// Outputs that were looked for, with the extremes that were read together with the orbit where these are the same but for rounding: of a number that is
/// asked for twice the last digit is the same.
fn kept(read: &[Motion], mut looked_for: Vec<Motion>) -> Vec<Motion> {
    let same = |a: f64, b: f64| (a - b).abs() <= EXTREMES * f64::EPSILON * a.abs().max(b.abs());
    for (motion, read) in looked_for.iter_mut().zip(read) {
        if same(motion.maximum, read.maximum) && same(motion.minimum, read.minimum) {
            motion.maximum = read.maximum;
            motion.minimum = read.minimum;
        }
    }
    looked_for
}

/// Signals of an orbit of shooting, with the harmonics that [`complete`] keeps.
///
/// # Errors
/// If the motion cannot be computed.
pub(crate) fn reading(
    problem: &ShootingProblem,
    point: &Point,
    asked: Asked,
) -> Result<Vec<Found>, Error> {
    let harmonics = harmonics(problem, point.orbit.period);
    let (reader, _) = read(problem, point, asked, harmonics)?;
    Ok(reader.found())
}

/// What is asked for, along the motion from the states of an orbit, and the orbit with states from which that is [closed](super::closed).
fn read<'p>(
    problem: &'p ShootingProblem,
    point: &Point,
    asked: Asked,
    harmonics: usize,
) -> Result<(Reader<'p>, Point), Error> {
    let (mut equations, u) = start::of_point(problem, point)?;
    let value = point.value;
    let failed = |reason| MotionError { value, reason };
    let along = |equations: &mut Equations, u: &[f64]| {
        reader_along(problem, equations, u, asked, harmonics)
    };
    let (reader, apart) = along(&mut equations, &u).map_err(failed)?;
    let mut closed = point.clone();
    if closed::is_closed(problem, point, apart) {
        return Ok((reader, closed));
    }
    let nearer = closed::states(problem, &mut equations, &u, point, apart).and_then(|states| {
        let u = equations.unknowns_of(&states, value);
        let (reader, nearer) = along(&mut equations, &u).ok()?;
        (nearer < apart).then_some((reader, states))
    });
    if problem.cancel.is_cancelled() {
        return Err(failed(FlowError::Cancelled { phase: 0.0 }).into());
    }
    // What was read stands where the other motion is not, or closes no better.
    let Some((reader, states)) = nearer else {
        return Ok((reader, closed));
    };
    closed.orbit.states = states;
    Ok((reader, closed))
}

/// What is asked for, along the motion from the states of an orbit as they are.
fn read_along<'p>(
    problem: &'p ShootingProblem,
    point: &Point,
    asked: Asked,
) -> Result<Reader<'p>, Error> {
    let (mut equations, u) = start::of_point(problem, point)?;
    let value = point.value;
    let (reader, _) = reader_along(problem, &mut equations, &u, asked, 0)
        .map_err(|reason| MotionError { value, reason })?;
    Ok(reader)
}

/// What is asked for, along the motion from `u`, and how far it is from closed.
fn reader_along<'p>(
    problem: &'p ShootingProblem,
    equations: &mut Equations,
    u: &[f64],
    asked: Asked,
    harmonics: usize,
) -> Result<(Reader<'p>, f64), FlowError> {
    let recurrence = &equations.span.recurrence;
    let mut reader = problem.reader(u[u.len() - 1], asked, recurrence, harmonics);
    let apart = equations.trace(u, &mut |stretch| reader.include(stretch))?;
    Ok((reader, apart))
}

/// Positions at equal distances over the period, so many in each period of the declaration, coordinate by coordinate.
fn sampled(problem: &ShootingProblem, point: &Point, each: usize) -> Result<Vec<f64>, Error> {
    let coordinates = point.orbit.coordinates;
    let count = each * point.orbit.period;
    let mut flow = problem.flow(problem.source.tolerance)?;
    let motion = |reason| MotionError {
        value: point.value,
        reason,
    };
    flow.set(problem.variable, point.value).map_err(motion)?;
    let mut samples = vec![0.0; coordinates * count];
    let mut index = 0;
    let mut keep = |_: f64, state: &[f64]| {
        // The last one is the first again.
        if index < count {
            for (i, x) in state[..coordinates].iter().enumerate() {
                samples[i * count + index] = *x;
            }
        }
        index += 1;
    };
    let mut map = Stroboscope::new(flow);
    let mut state = point.orbit.state();
    let periods = point.orbit.period;
    history::record(&mut map, &mut state, periods, each, &mut keep).map_err(motion)?;
    Ok(samples)
}
