//! Runs in turns, medians, errors and failures.

use std::time::Instant;

use hertzian::error::chain;

use super::method::{self, Family, Reference, Run, Setting};
use super::problem::Problem;

/// A run that takes longer than this is not repeated.
const LONG: f64 = 0.5;
/// Frequencies of folds that differ by more are not the same fold.
const SAME_FOLD: f64 = 0.02;

/// A method at one setting on one problem.
#[derive(Debug, Clone, PartialEq)]
pub struct Measured {
    /// The method.
    pub family: Family,
    /// Its setting.
    pub setting: Setting,
    /// Times of its runs, in order of size.
    pub seconds: Vec<f64>,
    /// Error of the fold of largest amplitude.
    pub fold: Option<f64>,
    /// Relative error of peak-to-peak of one orbit.
    pub peak_to_peak: Option<f64>,
    /// What went wrong.
    pub failure: Option<String>,
}

impl Measured {
    /// The median of the times.
    pub fn median(&self) -> Option<f64> {
        self.seconds.get(self.seconds.len() / 2).copied()
    }

    fn of(family: Family, setting: Setting) -> Self {
        Self {
            family,
            setting,
            seconds: Vec::new(),
            fold: None,
            peak_to_peak: None,
            failure: None,
        }
    }

    /// Takes a run in.
    fn add(&mut self, reference: &Reference, run: &Run) {
        self.seconds.push(run.seconds);
        self.seconds.sort_by(f64::total_cmp);
        self.fold = reference.folds.first().and_then(|exact| {
            let errors = run.folds.iter().map(|fold| (fold - exact).abs());
            let nearest = errors.min_by(f64::total_cmp);
            nearest.filter(|&error| error < SAME_FOLD)
        });
        let size = run.peak_to_peak;
        self.peak_to_peak = size.map(|size| (size / reference.peak_to_peak - 1.0).abs());
        self.failure = run.fault.clone().or_else(|| {
            let (found, there) = (run.folds.len(), reference.folds.len());
            (found != there).then(|| format!("{found} folds, where there are {there}"))
        });
    }
}

/// How long measuring may take.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Limits {
    /// Runs of each method at each setting.
    pub repeats: usize,
    /// Seconds after which a run is given up.
    pub patience: f64,
    /// Seconds after which no run is begun.
    pub budget: f64,
}

/// Measures every method on a problem: all once, then all again, so that what else the machine does falls on all alike.
pub fn measure(
    problem: &Problem,
    reference: &Reference,
    limits: Limits,
    visit: &mut dyn FnMut(usize, usize) -> bool,
) -> Vec<Measured> {
    let Limits {
        repeats,
        patience,
        budget,
    } = limits;
    let started = Instant::now();
    let mut all: Vec<Measured> = Family::ALL
        .iter()
        .filter(|&&family| family != Family::Integrated || problem.integrated.is_some())
        .flat_map(|family| {
            family
                .settings()
                .into_iter()
                .map(|setting| Measured::of(*family, setting))
        })
        .collect();
    let count = all.len();
    for turn in 0..repeats {
        for (index, measured) in all.iter_mut().enumerate() {
            if !visit(turn * count + index, repeats * count) {
                return all;
            }
            let long = measured
                .seconds
                .last()
                .is_some_and(|&seconds| seconds > LONG);
            if turn > 0 && (long || measured.seconds.is_empty()) {
                continue;
            }
            if started.elapsed().as_secs_f64() > budget {
                if turn == 0 {
                    measured.failure = Some("not run: the time was used up".to_owned());
                }
                continue;
            }
            match method::run(problem, measured.family, measured.setting, patience) {
                Ok(run) => measured.add(reference, &run),
                Err(error) => measured.failure = Some(chain(&error).to_string()),
            }
        }
    }
    all
}
