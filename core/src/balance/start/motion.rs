//! Orbits that motions settle to: the last resort, for any model whose motions do not fly away.
//!
//! Motions begin at rest and go on, over more and more periods. What is left of them is sampled over the last period, and averaged over
//! several: where a motion settles to an orbit of a longer period, or to none, the mean of its periods is near an unstable orbit of period
//! one. Newton's method starts from there, and from some way before the motion has settled, since that may take long.
//!
//! From rest on a level beside which a stiffness is unbounded no motion can be computed, since it may leave in any way. Then it begins a little
//! beside: what it settles to does not depend on that.
//!
//! How motions are computed this room does not know: it is given a function.
//!
//! Source: Nayfeh and Balachandran (1995), Applied Nonlinear Dynamics, section 6.3 (periodic solutions by long integration, and from there
//! by Newton's method).

use super::effort::Effort;
use super::fixed::Fixed;
use super::{Motion, Moving, StartRequest};
use crate::balance::Resolution;
use crate::continuation::newton::NewtonOptions;
use crate::model::layout::constant;
use crate::numeric::fourier::sampled::SampledTransform;
use crate::numeric::linear::dot;

/// Periods of the declaration after which Newton's method is tried.
const TRIED_AFTER: [usize; 5] = [12, 48, 192, 576, 1152];
/// Periods whose mean is taken: a multiple of the lengths 2, 3, 4, 6 and 12.
const AVERAGED: usize = 12;
/// Samples for each harmonic.
const OVERSAMPLED: usize = 8;
/// Samples of a period, at least.
const LEAST_SAMPLES: usize = 256;

/// An orbit near what motions from these positions at rest come to.
pub(super) fn orbit(
    request: StartRequest<'_>,
    from: &[Vec<f64>],
    effort: &mut Effort,
) -> Option<Vec<f64>> {
    let motion = request.motion?;
    // A step that the tail spoils costs more than it saves.
    let request = StartRequest {
        resolution: Resolution {
            core: request.resolution.harmonics,
            ..request.resolution
        },
        ..request
    };
    let mut fixed = Fixed::new(request, request.resolution.harmonics);
    let beside = beside(&mut fixed, effort);
    for positions in from {
        let aside = positions.iter().zip(&beside).map(|(x, d)| x + d).collect();
        for positions in [positions.clone(), aside] {
            let mut state = positions;
            state.resize(2 * beside.len(), 0.0);
            match settled(&mut fixed, request, motion, state, effort) {
                Settled::Found(u) => return Some(u),
                Settled::Not => break,
                Settled::Unmoved => {}
            }
            if effort.is_spent() {
                return None;
            }
        }
    }
    None
}

/// What a motion comes to.
enum Settled {
    Found(Vec<f64>),
    Not,
    /// It cannot be computed from the first.
    Unmoved,
}

/// The orbit near what the motion from a state comes to.
fn settled(
    fixed: &mut Fixed<'_>,
    request: StartRequest<'_>,
    motion: &Motion<'_>,
    mut state: Vec<f64>,
    effort: &mut Effort,
) -> Settled {
    let samples = (OVERSAMPLED * request.resolution.harmonics)
        .max(LEAST_SAMPLES)
        .next_power_of_two();
    let mut passed = 0;
    for periods in TRIED_AFTER {
        let moved = motion(Moving {
            omega: request.omega,
            variable: request.variable,
            value: request.value,
            state: &mut state,
            skipped: periods - AVERAGED - passed,
            recorded: AVERAGED,
            samples,
            most: effort.remaining(),
        });
        effort.take_operations(moved.operations);
        let Some(positions) = moved.positions else {
            return if passed == 0 {
                Settled::Unmoved
            } else {
                Settled::Not
            };
        };
        passed = periods;
        for guess in guesses(fixed, &positions, samples) {
            if let Some(u) = solved(fixed, &guess, request, effort) {
                return Settled::Found(u);
            }
        }
        if effort.is_spent() {
            break;
        }
    }
    Settled::Not
}

/// As far as what drives the system moves a free mass; each coordinate a little farther than the one before, so that no gap between two
/// stays as it was.
fn beside(fixed: &mut Fixed<'_>, effort: &mut Effort) -> Vec<f64> {
    let origin = fixed.zeros();
    fixed.residual(&origin, effort);
    let Fixed {
        balance, residual, ..
    } = fixed;
    let force = residual
        .chunks_exact(balance.length())
        .map(|of| dot(&of[1..], &of[1..]).sqrt())
        .fold(0.0, f64::max);
    let coordinates = balance.layout().coordinates;
    let mass = constant(&balance.layout().mass, balance.coefficients(), coordinates);
    let size = force / (mass.amax() * balance.omega().powi(2));
    let size = if size.is_finite() { size } else { 0.0 };
    let farther = |i: usize| 1.0 + i as f64 / coordinates as f64;
    (0..coordinates).map(|i| size * farther(i)).collect()
}

/// The last period as extended unknowns, and the mean of all recorded, from positions coordinate by coordinate.
fn guesses(fixed: &Fixed<'_>, positions: &[f64], samples: usize) -> [Vec<f64>; 2] {
    let (mut last, mut mean) = (fixed.zeros(), fixed.zeros());
    let length = fixed.balance.length();
    let mut transform = SampledTransform::new(samples);
    let mut averaged = vec![0.0; samples];
    for (i, positions) in positions.chunks_exact(AVERAGED * samples).enumerate() {
        averaged.fill(0.0);
        for period in positions.chunks_exact(samples) {
            for (to, x) in averaged.iter_mut().zip(period) {
                *to += x / AVERAGED as f64;
            }
        }
        let part = i * length..(i + 1) * length;
        transform.analyse(&averaged, &mut mean[part.clone()]);
        transform.analyse(&positions[(AVERAGED - 1) * samples..], &mut last[part]);
    }
    let partition = fixed.balance.partition();
    partition.clear_others(&mut last);
    partition.clear_others(&mut mean);
    [last, mean]
}

/// What Newton's method makes of a guess: quickly where it is near, with halved updates otherwise.
fn solved(
    fixed: &mut Fixed<'_>,
    guess: &[f64],
    request: StartRequest<'_>,
    effort: &mut Effort,
) -> Option<Vec<f64>> {
    let quick = NewtonOptions {
        iterations: 8,
        damped: false,
        ..request.newton
    };
    [quick, request.damped(40)].into_iter().find_map(|options| {
        let mut u = guess.to_vec();
        fixed.solve(&mut u, options, effort).is_ok().then_some(u)
    })
}
