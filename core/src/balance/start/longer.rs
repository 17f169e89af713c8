//! Orbits of a longer period than the excitation's: near the orbit of period one, disturbed in its lowest subharmonic.
//!
//! Disturbances of several sizes and phases are tried with few harmonics, and what they lead to is solved with all. Of several
//! orbits the one of smallest amplitude is taken.

use std::f64::consts::FRAC_PI_4;

use super::StartRequest;
use super::effort::Effort;
use super::fixed::{Fixed, oscillation, spread};
use crate::balance::Resolution;
use crate::balance::subharmonics::has_shortest_period;
use crate::branches::error::Attempts;
use crate::continuation::newton::NewtonOptions;
use crate::numeric::fourier::series;

/// Sizes of a disturbance, three a decade from a tenth of the orbit's own oscillation.
const SIZES: u32 = 8;
/// Phases of a disturbance in eighths of its period. Those far apart come first, in case that the work ends the search.
const PHASES: [u32; 8] = [0, 4, 2, 6, 1, 5, 3, 7];
/// Relative difference of oscillations and means up to which orbits found with few harmonics are one.
const SAME: f64 = 1e-4;

/// An orbit whose shortest period is the one asked for.
///
/// # Errors
/// What the attempts came to.
pub(super) fn orbit(
    request: StartRequest<'_>,
    simple: &[f64],
    effort: &mut Effort,
) -> Result<Vec<f64>, Attempts> {
    let Resolution {
        harmonics,
        samples,
        period,
        ..
    } = request.resolution;
    let (few_harmonics, few_samples) = search_resolution(period);
    let coarse = Resolution {
        harmonics: harmonics.min(few_harmonics * period),
        samples: samples.min(few_samples * period),
        ..request.resolution
    };
    let searched = StartRequest {
        resolution: coarse,
        ..request
    };
    let (candidates, attempts) = candidates(searched, simple, effort);
    let mut full = Fixed::new(request, harmonics);
    let length = full.balance.length();
    for candidate in candidates {
        let mut u = spread(&candidate, &full);
        let solved = full.solve(&mut u, request.damped(60), effort).is_ok();
        if solved && has_shortest_period(&u, length, period) {
            return Ok(u);
        }
        if effort.is_spent() {
            break;
        }
    }
    Err(attempts)
}

/// Harmonics and samples per excitation period in the search: fewer harmonics for very long periods.
fn search_resolution(period: usize) -> (usize, usize) {
    ((60 / period).clamp(3, 10), 1024)
}

/// Different orbits of the period that Newton's method finds from the disturbances, smallest first.
fn candidates(
    request: StartRequest<'_>,
    simple: &[f64],
    effort: &mut Effort,
) -> (Vec<Vec<f64>>, Attempts) {
    let mut fixed = Fixed::new(request, request.resolution.harmonics);
    let stretched = stretch(simple, &fixed, request.resolution.period);
    let length = fixed.balance.length();
    let coordinates = fixed.balance.layout().coordinates;
    let size = oscillation(&stretched, length)
        .sqrt()
        .max(f64::MIN_POSITIVE);
    let options = NewtonOptions {
        tolerance: request.newton.tolerance.max(1e-5),
        ..request.damped(40)
    };
    let mut attempts = Attempts {
        planned: PHASES.len() * SIZES as usize,
        ..Attempts::default()
    };
    let mut found: Vec<Vec<f64>> = Vec::new();
    let disturbances = PHASES
        .iter()
        .flat_map(|phase| (0..SIZES).map(move |size| (phase, size)));
    for (&phase, step) in disturbances {
        if effort.is_spent() {
            break;
        }
        let amplitude = size * 0.1 * 10_f64.powf(f64::from(step) / 3.0);
        let (sine, cosine) = (f64::from(phase) * FRAC_PI_4).sin_cos();
        let mut u = stretched.clone();
        for i in 0..coordinates {
            u[i * length + 1] += amplitude * cosine;
            u[i * length + 2] += amplitude * sine;
        }
        attempts.made += 1;
        if fixed.solve(&mut u, options, effort).is_err() {
            continue;
        }
        if !has_shortest_period(&u, length, request.resolution.period) {
            attempts.shorter += 1;
        } else if !found.iter().any(|other| is_same(other, &u, length)) {
            found.push(u);
        }
    }
    found.sort_by(|a, b| oscillation(a, length).total_cmp(&oscillation(b, length)));
    attempts.evaluations = effort.evaluations();
    (found, attempts)
}

/// Whether two orbits are one, or the same but for a shift in time.
fn is_same(a: &[f64], b: &[f64], length: usize) -> bool {
    let size = oscillation(a, length);
    let means = (0..a.len() - 1).step_by(length);
    let moved: f64 = means.map(|i| (a[i] - b[i]) * (a[i] - b[i])).sum();
    (oscillation(b, length) - size).abs() <= SAME * size && moved <= SAME * SAME * size
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
