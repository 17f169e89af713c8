//! Least squares by the method of Levenberg and Marquardt, with ranges, from one start.
//!
//! Unknowns are given to it in units of their scales; in the search for the neighbourhood those that are positive by their logarithms, so that
//! a long step does not end where damping or stiffness vanish, and where curves say nothing any more. A trial whose curve cannot be followed gets residuals so large that the step is rejected,
//! which shortens the next one; why it failed is kept.
//!
//! Source: Moré (1978), Lecture Notes in Mathematics 630, 105; ranges as in MPFIT, Markwardt (2009), ASP Conference Series 411, 251; (1) as
//! in Huber (1964), Annals of Mathematical Statistics 35, 73.

use rmpfit::{MPConfig, MPError, MPFitter, MPMaxFev, MPPar, MPResult, MPSide, MPSuccess};

use crate::fit::Loss;
use crate::problem::{Problem, Unknown};
use crate::trial::{How, Trial};

/// Residuals of a trial that failed, in units of the best ones: beyond ten of these a step is rejected.
const FAILED: f64 = 100.0;

/// A search by logarithms does not go farther beyond the range of starts than by this factor: a step may lead to stiff motions that take long.
const FARTHEST: f64 = 10.0;

/// The first step, where the unknowns as they are given are one: along directions that the data hardly tell, as exponent and stiffness may be, a longer
/// one leads to where nothing is like the data.
const FIRST: f64 = 0.15;
/// Trials for each iteration, at most, on the average.
const TRIALS: usize = 3;
/// The method is started again so often, while that gains this part of the sum of squares.
const RESTARTS: usize = 6;
const GAINED: f64 = 1e-3;
/// So many iterations in a row that gain less than this part of the mean square of a residual, of which one moves an estimate by its standard
/// error, are the last: what is measured at the end of a branch makes the sum of squares as steep as a wall, along which steps are short.
const HARDLY: f64 = 2e-2;
const IDLE: usize = 2;
/// A trial is hopeless, and not computed to the end, where distances from its curve have so many times the sum of squares of those of the best.
const HOPELESS: f64 = 4.0;
const ROUNDING: f64 = 8.0 * f64::EPSILON;
/// Derivatives by an unknown that are below this part of those by the others are rounding: it has no influence, and does not move.
pub(crate) const WITHOUT: f64 = 1e-9;

/// How far an iteration goes.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Until {
    pub(crate) how: How,
    /// Change of the sum of squares relative to its mean over the values, and of the unknowns, below which it ends: a change of a thousandth moves
    /// estimates by three per cent of their standard errors.
    pub(crate) tolerance: [f64; 2],
    pub(crate) iterations: usize,
}

/// What came of an iteration.
#[derive(Debug)]
pub(crate) struct Outcome {
    /// The best trial.
    pub(crate) trial: Trial,
    /// Whether it ended by its tolerance.
    pub(crate) converged: bool,
}

/// What is told and counted of all trials.
pub(crate) struct Trials<'t> {
    /// Says how far it is; whether to go on.
    pub(crate) told: &'t mut dyn FnMut(usize, f64) -> bool,
    pub(crate) count: usize,
    /// Why trials failed, with how often.
    pub(crate) failed: Vec<(String, usize)>,
    pub(crate) is_stopped: bool,
}

impl Trials<'_> {
    /// A trial, counted.
    ///
    /// # Errors
    /// If it failed; the reason is kept.
    pub(crate) fn at(
        &mut self,
        problem: &Problem,
        unknowns: &[f64],
        how: How,
    ) -> Result<Trial, String> {
        self.below(problem, unknowns, how, f64::INFINITY)
    }

    /// The same, to the end only if the sum of squares stays below a bound.
    ///
    /// # Errors
    /// As there.
    fn below(
        &mut self,
        problem: &Problem,
        unknowns: &[f64],
        how: How,
        bound: f64,
    ) -> Result<Trial, String> {
        self.count += 1;
        let trial = Trial::below(problem, unknowns, how, bound);
        self.is_stopped |= problem.cancel.is_cancelled();
        if let Err(reason) = &trial
            && !self.is_stopped
        {
            self.note(reason);
        }
        trial
    }

    fn note(&mut self, reason: &str) {
        match self.failed.iter_mut().find(|(known, _)| known == reason) {
            Some((_, count)) => *count += 1,
            None => self.failed.push((reason.to_owned(), 1)),
        }
    }
}

/// Residuals as they count, and the factors of their derivatives: the squares of these sum up to the loss
///
/// ```text
/// rho(r) = r^2 for |r| <= c,   c (2 |r| - c) beyond                                                         (1)
/// ```
pub(crate) fn counted(loss: Loss, scale: f64, residuals: &[f64]) -> (Vec<f64>, Vec<f64>) {
    let of = |&residual: &f64| match loss {
        Loss::Squares => (residual, 1.0),
        Loss::Huber(limit) => {
            let (limit, size) = (limit * scale, residual.abs());
            if size <= limit {
                (residual, 1.0)
            } else {
                let root = (limit * (2.0 * size - limit)).sqrt();
                (root * residual.signum(), limit / root)
            }
        }
    };
    residuals.iter().map(of).unzip()
}

/// Sum of squares.
pub(crate) fn square(residuals: &[f64]) -> f64 {
    residuals.iter().map(|residual| residual * residual).sum()
}

/// Least squares from a trial on.
pub(crate) fn minimise(
    problem: &Problem,
    start: Trial,
    scale: f64,
    until: Until,
    trials: &mut Trials<'_>,
) -> Outcome {
    let axes: Vec<Axis> = problem
        .unknowns
        .iter()
        .map(|unknown| Axis::of(unknown, until.how))
        .collect();
    let ranges = axes.iter().map(|axis| {
        let [low, high] = axis.limits.map(|limit| axis.scaled(limit));
        MPPar {
            limited_low: low.is_finite(),
            limit_low: if low.is_finite() { low } else { 0.0 },
            limited_up: high.is_finite(),
            limit_up: if high.is_finite() { high } else { 0.0 },
            side: MPSide::User,
            ..MPPar::new()
        }
    });
    let mut search = Search {
        ranges: ranges.collect(),
        config: MPConfig {
            ftol: until.tolerance[0] / start.residuals.len().max(1) as f64,
            xtol: until.tolerance[1],
            gtol: 1e-14,
            step_factor: FIRST,
            max_iter: until.iterations,
            max_fev: MPMaxFev::Limited(TRIALS * until.iterations),
            ..MPConfig::new()
        },
        least: square(&counted(problem.loss, scale, &start.residuals).0),
        best: start,
        last: None,
        before: f64::INFINITY,
        idle: 0,
        axes,
        problem,
        scale,
        how: until.how,
        trials,
    };
    let mut converged = false;
    // Where a step ends at the end of a range the method may end too, although others could move on.
    for _ in 0..RESTARTS {
        let before = search.least;
        let mut at: Vec<f64> = (search.axes.iter().zip(&search.best.unknowns))
            .map(|(axis, value)| axis.scaled(*value))
            .collect();
        let status = search.mpfit(&mut at);
        let is_idle = search.idle >= IDLE;
        converged = is_idle || status.is_ok_and(|status| status.success != MPSuccess::MaxIter);
        (search.before, search.idle) = (f64::INFINITY, 0);
        if !converged || search.least > (1.0 - GAINED) * before {
            break;
        }
        if !search.is_at_limit() {
            break;
        }
    }
    Outcome {
        trial: search.best,
        converged,
    }
}

/// How an unknown is given to the method.
#[derive(Debug, Clone, Copy)]
struct Axis {
    scale: f64,
    limits: [f64; 2],
    by_logarithm: bool,
}

impl Axis {
    fn of(unknown: &Unknown, how: How) -> Self {
        let by_logarithm = how == How::Near && unknown.limits[0] >= 0.0 && unknown.start > 0.0;
        let [low, high] = unknown.limits;
        let [from, to] = unknown.search.unwrap_or(unknown.limits);
        Self {
            scale: unknown.scale,
            limits: if by_logarithm {
                [low.max(from / FARTHEST), high.min(to * FARTHEST)]
            } else {
                unknown.limits
            },
            by_logarithm,
        }
    }

    fn scaled(&self, value: f64) -> f64 {
        if self.by_logarithm {
            // Of the scale itself it is one, so that steps have a size to begin with.
            1.0 + (value / self.scale).ln()
        } else {
            value / self.scale
        }
    }

    /// The value, which is the end of the range itself where only rounding is between: the method asks whether they are equal.
    fn value(&self, at: f64) -> f64 {
        let value = if self.by_logarithm {
            self.scale * (at - 1.0).exp()
        } else {
            self.scale * at
        };
        let is_end = |end: &&f64| end.is_finite() && (value - **end).abs() <= ROUNDING * end.abs();
        let end = self.limits.iter().find(is_end);
        end.copied()
            .unwrap_or_else(|| value.clamp(self.limits[0], self.limits[1]))
    }

    /// How fast a value grows with what is given.
    fn slope(&self, value: f64) -> f64 {
        if self.by_logarithm { value } else { self.scale }
    }
}

/// The problem as the method wants it.
struct Search<'s, 't> {
    problem: &'s Problem,
    how: How,
    scale: f64,
    ranges: Vec<MPPar>,
    axes: Vec<Axis>,
    config: MPConfig,
    best: Trial,
    least: f64,
    /// The last trial that is not the best.
    last: Option<Trial>,
    /// The least sum before the last iteration, and how many in a row have hardly gained.
    before: f64,
    idle: usize,
    trials: &'s mut Trials<'t>,
}

impl Search<'_, '_> {
    /// Whether an unknown is at the end of its range.
    fn is_at_limit(&self) -> bool {
        let mut both = self.axes.iter().zip(&self.best.unknowns);
        both.any(|(axis, value)| axis.limits.contains(value))
    }

    /// Whether the iterations hardly gain any more; asked once for each.
    fn is_idle(&mut self) -> bool {
        let hardly = HARDLY * self.least / self.best.residuals.len().max(1) as f64;
        if self.before - self.least <= hardly {
            self.idle += 1;
        } else {
            self.idle = 0;
        }
        self.before = self.least;
        self.idle >= IDLE
    }

    fn unscaled(&self, at: &[f64]) -> Vec<f64> {
        let values = self.axes.iter().zip(at).map(|(axis, at)| axis.value(*at));
        values.collect()
    }

    fn counted(&self, residuals: &[f64]) -> (Vec<f64>, Vec<f64>) {
        counted(self.problem.loss, self.scale, residuals)
    }
}

impl MPFitter for Search<'_, '_> {
    fn eval(&mut self, at: &[f64], deviates: &mut [f64]) -> MPResult<()> {
        let unknowns = self.unscaled(at);
        if unknowns == self.best.unknowns {
            deviates.copy_from_slice(&self.counted(&self.best.residuals).0);
            return Ok(());
        }
        let bound = match self.problem.loss {
            Loss::Squares => HOPELESS * self.least.max(self.best.distances),
            Loss::Huber(_) => f64::INFINITY,
        };
        let trial = self.trials.below(self.problem, &unknowns, self.how, bound);
        let size = (self.least / deviates.len() as f64).sqrt();
        let go_on = (self.trials.told)(self.trials.count, size);
        self.trials.is_stopped |= !go_on;
        match trial {
            Ok(trial) => {
                let (counted, _) = self.counted(&trial.residuals);
                deviates.copy_from_slice(&counted);
                let sum = square(&counted);
                // What is not a number is no smaller, and distances do not stand for residuals.
                let is_better = trial.is_complete && sum < self.least;
                let other = if is_better {
                    self.least = sum;
                    std::mem::replace(&mut self.best, trial)
                } else {
                    trial
                };
                self.last = Some(other);
            }
            Err(_) => deviates.fill(FAILED * (size + 1.0)),
        }
        if self.trials.is_stopped {
            return Err(MPError::Eval);
        }
        if !square(deviates).is_finite() {
            deviates.fill(FAILED * (size + 1.0));
        }
        Ok(())
    }

    fn number_of_points(&self) -> usize {
        self.best.residuals.len()
    }

    fn config(&self) -> &MPConfig {
        &self.config
    }

    fn parameters(&self) -> &[MPPar] {
        &self.ranges
    }

    fn jacobian(
        &mut self,
        at: &[f64],
        deviates: &mut [f64],
        columns: &mut [Option<Vec<f64>>],
    ) -> MPResult<()> {
        if self.is_idle() {
            return Err(MPError::Eval);
        }
        let unknowns = self.unscaled(at);
        let problem = self.problem;
        let trial = if unknowns == self.best.unknowns {
            &mut self.best
        } else {
            self.last
                .as_mut()
                .filter(|last| last.unknowns == unknowns)
                .ok_or(MPError::Eval)?
        };
        let jacobian = match trial.jacobian(problem) {
            Ok(jacobian) => jacobian.matrix,
            Err(reason) => {
                self.trials.note(&format!("no derivatives: {reason}"));
                return Err(MPError::Eval);
            }
        };
        let (counted, factors) = counted(problem.loss, self.scale, &trial.residuals);
        deviates.copy_from_slice(&counted);
        let slope = |j: usize| self.axes[j].slope(unknowns[j]);
        let sizes = (0..jacobian.ncols()).map(|j| jacobian.column(j).norm() * slope(j).abs());
        let sizes: Vec<f64> = sizes.collect();
        let largest = sizes.iter().fold(0.0, |m: f64, &size| m.max(size));
        for (j, column) in columns.iter_mut().enumerate() {
            let slope = if sizes[j] > WITHOUT * largest {
                slope(j)
            } else {
                0.0
            };
            let entries = column.iter_mut().flatten().enumerate();
            entries.for_each(|(i, entry)| *entry = jacobian[(i, j)] * factors[i] * slope);
        }
        Ok(())
    }
}
