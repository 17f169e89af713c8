//! Orbits that motions settle to: the last resort, for any model whose motions do not fly away.
//!
//! Motions begin at rest and go on, over more and more periods. What is left of them is sampled over the last period, and averaged over
//! several: where a motion settles to an orbit of a longer period, or to none, the mean of its periods is near an unstable orbit of period
//! one. Newton's method starts from there, and from some way before the motion has settled, since that may take long.
//!
//! How motions are computed this room does not know: it is given a function.
//!
//! Source: Nayfeh and Balachandran (1995), Applied Nonlinear Dynamics, section 6.3 (periodic solutions by long integration, and from there
//! by Newton's method).

use super::effort::Effort;
use super::fixed::Fixed;
use super::{Moving, StartRequest};
use crate::balance::Resolution;
use crate::continuation::newton::NewtonOptions;
use crate::numeric::fourier::sampled::SampledTransform;

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
    let samples = (OVERSAMPLED * request.resolution.harmonics)
        .max(LEAST_SAMPLES)
        .next_power_of_two();
    for positions in from {
        let mut state = positions.clone();
        state.resize(2 * positions.len(), 0.0);
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
            passed = periods;
            effort.take_operations(moved.operations);
            let Some(positions) = moved.positions else {
                break;
            };
            for guess in guesses(&fixed, &positions, samples) {
                if let Some(u) = solved(&mut fixed, &guess, request, effort) {
                    return Some(u);
                }
            }
            if effort.is_spent() {
                return None;
            }
        }
    }
    None
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
