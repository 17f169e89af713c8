//! From starts to a result.
//!
//! From the values that are given near residuals are minimised. If they do not become small, the same is done from the best of other starts, which are
//! points of the additive sequence of Roberts (2018), which fills a box evenly. From the best place the exact residuals are minimised.

use std::cell::Cell;
use std::ops::ControlFlow;

use crate::error::FitError;
use crate::fit::{Loss, Progress, Stage};
use crate::minimise::{Outcome, Trials, Until, minimise, square};
use crate::problem::Problem;
use crate::result::{Fitted, Started};
use crate::trial::{How, Trial};

/// Besides the start that is given so many of the others are gone on with, the best.
const KEPT: usize = 4;
/// Where near residuals are this small, as those of data with some noise, no other start is gone on with.
const NEAR_ENOUGH: f64 = 0.5;
/// Deviations that were not stated are found so often, at most.
const WEIGHED: usize = 12;
/// Iterations with near residuals end early; those with exact ones where nothing is gained any more that noise would show, or the next step is one of
/// the seventh digit.
const NEAR: Until = Until {
    how: How::Near,
    tolerance: [0.1, 1e-3],
    iterations: 25,
};
const EXACT: Until = Until {
    how: How::Exact,
    tolerance: [1e-3, 1e-6],
    iterations: 40,
};

/// Searches, fits and says what came of it.
pub(crate) fn run(
    problem: &mut Problem,
    told: &mut dyn FnMut(&Progress) -> ControlFlow<()>,
) -> Result<Fitted, FitError> {
    let stage = Cell::new(Stage::Near);
    let mut tell = |trials: usize, rms: f64| {
        let progress = Progress {
            stage: stage.get(),
            trials,
            rms,
        };
        told(&progress).is_continue()
    };
    let mut trials = Trials {
        told: &mut tell,
        count: 0,
        failed: Vec::new(),
        is_stopped: false,
    };
    let mut found: Vec<Trial> = Vec::new();
    if let Ok(given) = trials.at(problem, &start(problem, 0), How::Near) {
        found.push(minimise(problem, given, 1.0, NEAR, &mut trials).trial);
    }
    if !is_found(&found) {
        stage.set(Stage::Starts);
        let others = starts(problem, &mut trials);
        stage.set(Stage::Near);
        for trial in others {
            if is_found(&found) || trials.is_stopped && !found.is_empty() {
                break;
            }
            found.push(minimise(problem, trial, 1.0, NEAR, &mut trials).trial);
        }
    }
    if found.is_empty() {
        if trials.is_stopped {
            return Err(FitError::Cancelled);
        }
        let reason = trials.failed.first().map(|(reason, _)| reason.clone());
        return Err(FitError::NoStart {
            tried: trials.count,
            reason: reason.unwrap_or_default(),
        });
    }
    found.sort_by(|a, b| square(&a.residuals).total_cmp(&square(&b.residuals)));
    stage.set(Stage::Fit);
    let places: Vec<Started> = found.iter().map(Started::of).collect();
    let outcome = exact(problem, found, &mut trials)?;
    let outcome = weighed(problem, outcome, &mut trials);
    stage.set(Stage::Errors);
    let _ = (trials.told)(trials.count, rms(&outcome.trial));
    Ok(Fitted::of(problem, outcome, places, &mut trials))
}

/// Root of the mean square of residuals.
fn rms(trial: &Trial) -> f64 {
    (square(&trial.residuals) / trial.residuals.len() as f64).sqrt()
}

fn is_found(found: &[Trial]) -> bool {
    found.iter().any(|found| rms(found) < NEAR_ENOUGH)
}

/// Trials at the best of the other starts.
fn starts(problem: &Problem, trials: &mut Trials<'_>) -> Vec<Trial> {
    let mut found: Vec<Trial> = Vec::new();
    let has_others = problem
        .unknowns
        .iter()
        .any(|unknown| unknown.search.is_some());
    let count = if has_others { problem.starts } else { 1 };
    for number in 1..count {
        if trials.is_stopped {
            break;
        }
        let trial = trials.at(problem, &start(problem, number), How::Near);
        found.extend(trial.ok().filter(|trial| rms(trial).is_finite()));
        let best = found.iter().map(rms).fold(f64::INFINITY, f64::min);
        trials.is_stopped |= !(trials.told)(trials.count, best);
    }
    found.sort_by(|a, b| rms(a).total_cmp(&rms(b)));
    found.truncate(KEPT);
    found
}

/// The unknowns at a start: the values of the system first.
fn start(problem: &Problem, number: usize) -> Vec<f64> {
    let ranges = problem.unknowns.iter().map(|unknown| unknown.search);
    let free = ranges.flatten().count();
    // The root of g^(d + 1) = g + 1.
    let mut golden = 2.0_f64;
    for _ in 0..60 {
        golden = (1.0 + golden).powf(1.0 / (free as f64 + 1.0));
    }
    let mut axis = 0;
    let unknowns = problem.unknowns.iter().map(|unknown| {
        if number == 0 || unknown.search.is_none() {
            return unknown.start;
        }
        axis += 1;
        let part = (0.5 + number as f64 * golden.powi(-axis)).fract();
        unknown.at(part)
    });
    unknowns.collect()
}

/// The fit with exact residuals, from the first place where these can be had.
fn exact(
    problem: &Problem,
    found: Vec<Trial>,
    trials: &mut Trials<'_>,
) -> Result<Outcome, FitError> {
    let mut found = found.into_iter();
    let mut first = None;
    for near in found.by_ref() {
        if trials.is_stopped {
            return Ok(Outcome {
                trial: near,
                converged: false,
            });
        }
        match trials.at(problem, &near.unknowns, How::Exact) {
            Ok(start) => return Ok(refined(problem, start, trials)),
            Err(reason) => first = first.or(Some(reason)),
        }
    }
    let reason = first.unwrap_or_default();
    Err(FitError::NoStart {
        tried: trials.count,
        reason,
    })
}

/// Least squares, and of a loss that needs a scale nobody has stated, again with that of the residuals.
fn refined(problem: &Problem, start: Trial, trials: &mut Trials<'_>) -> Outcome {
    if problem.is_absolute || problem.loss == Loss::Squares {
        return minimise(problem, start, 1.0, EXACT, trials);
    }
    let scale = spread(&start.residuals);
    let first = minimise(problem, start, scale, EXACT, trials);
    let scale = spread(&first.trial.residuals);
    minimise(problem, first.trial, scale, EXACT, trials)
}

/// The fit again, with deviations that were not stated as values scatter, until these settle.
fn weighed(problem: &mut Problem, mut outcome: Outcome, trials: &mut Trials<'_>) -> Outcome {
    for _ in 0..WEIGHED {
        let trial = &outcome.trial;
        if trials.is_stopped || !problem.weigh(&trial.first, &trial.residuals) {
            break;
        }
        let Ok(start) = trials.at(problem, &trial.unknowns, How::Exact) else {
            outcome.converged = false;
            break;
        };
        outcome = refined(problem, start, trials);
    }
    outcome
}

/// The standard deviation of residuals by the median of their sizes, which outliers hardly move. Source: Hampel (1974), Journal of the
/// American Statistical Association 69, 383.
pub(crate) fn spread(residuals: &[f64]) -> f64 {
    let mut sizes: Vec<f64> = residuals.iter().map(|residual| residual.abs()).collect();
    sizes.sort_by(f64::total_cmp);
    let median = sizes.get(sizes.len() / 2).copied().unwrap_or(0.0);
    (1.4826 * median).max(f64::MIN_POSITIVE.sqrt())
}
