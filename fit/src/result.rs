//! What came of a fit.

use nalgebra::{DMatrix, DVector};
use serde::Serialize;

use crate::error::FitError;
use crate::fit::{Fit, Loss};
use crate::minimise::{Outcome, Trials};
use crate::problem::Problem;
use crate::statistics::{self, Linear};
use crate::trial::Trial;

/// The estimate of a parameter.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[non_exhaustive]
pub struct Estimate {
    /// Its name; of a parameter that each data set has for itself, with that of the set: `drive of rising`.
    pub name: String,
    /// Its unit; empty where there is none.
    pub unit: String,
    /// The estimate.
    pub value: f64,
    /// Its standard error; `None` where the estimate is at the end of its range, the data do not determine it, or as many parameters as values are
    /// free and no deviations are known.
    pub error: Option<f64>,
    /// Its 95 % interval; `None` where there is no standard error.
    pub interval: Option<[f64; 2]>,
    /// Whether it is at the end of its range.
    pub at_limit: bool,
    /// Whether the data do not determine it.
    pub undetermined: bool,
}

/// A measured value beside the fit.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[non_exhaustive]
pub struct FittedValue {
    /// Where it was measured.
    pub place: f64,
    /// The value.
    pub value: f64,
    /// The standard deviation that it counted by.
    pub deviation: f64,
    /// The nearest point of the curve, place and reading: what the model says.
    pub foot: [f64; 2],
    /// The distance from the curve, positive above, in standard deviations.
    pub residual: f64,
    /// How far the value determines its own fit, from zero to one.
    pub leverage: f64,
    /// The residual from a fit without this value, in its standard deviations.
    pub studentised: f64,
    /// How far the estimates move when this value is left out: the largest change, in standard errors.
    pub influence: f64,
    /// Whether so large a residual is not to be expected of any of so many values, at 5 %.
    pub is_outlier: bool,
    /// The row of its data set, from zero on.
    pub row: usize,
}

/// A part of a curve between folds.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[non_exhaustive]
pub struct Part {
    /// Whether the number of folds before it is even: other parts are unstable.
    pub may_be_stable: bool,
    /// Its points.
    pub points: Vec<[f64; 2]>,
}

/// A data set beside the fit.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[non_exhaustive]
pub struct FittedSet {
    /// Its name.
    pub name: String,
    /// What was measured.
    pub wanted: String,
    /// Its unit; empty where there is none.
    pub unit: String,
    /// Whether deviations of its values were stated.
    pub stated: bool,
    /// What varied, and its unit.
    pub varied: [String; 2],
    /// The values, in the order of the sweep.
    pub values: Vec<FittedValue>,
    /// Residuals of the jumps, in standard deviations.
    pub jumps: Vec<f64>,
    /// The curve of the fit, part by part.
    pub curve: Vec<Part>,
}

/// Where a search went on from.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[non_exhaustive]
pub struct Started {
    /// The parameters that the coarse search came to, in the order of the estimates.
    pub values: Vec<f64>,
    /// The root of the mean square of the coarse residuals there.
    pub rms: f64,
}

impl Started {
    pub(crate) fn of(trial: &Trial) -> Self {
        let mean = crate::minimise::square(&trial.residuals) / trial.residuals.len() as f64;
        Self {
            values: trial.unknowns.clone(),
            rms: mean.sqrt(),
        }
    }
}

/// What came of a fit.
#[derive(Debug, Clone, Serialize)]
#[non_exhaustive]
pub struct Fitted {
    /// The estimates, in the order in which parameters were freed.
    pub estimates: Vec<Estimate>,
    /// Covariance of the estimates; not a number where one has no standard error.
    pub covariance: Vec<Vec<f64>>,
    /// Their correlation.
    pub correlation: Vec<Vec<f64>>,
    /// Singular values of the derivatives of the residuals by relative changes of the estimates, largest first: what a change of one hundred per cent
    /// along each of so many independent directions would change.
    pub singular_values: Vec<f64>,
    /// What the data cannot tell, in words; empty where they determine all parameters.
    pub untold: Vec<String>,
    /// The data sets.
    pub sets: Vec<FittedSet>,
    /// Sum of the squares of the residuals.
    pub chi_square: f64,
    /// Values and jumps that say something: all but bounds that are met, and what has no derivatives.
    pub count: usize,
    /// These less the estimates that follow from them.
    pub degrees: usize,
    /// How probable a larger sum of squares is, if model and deviations are right; `None` where deviations are not known.
    pub probability: Option<f64>,
    /// The standard deviation of the residuals: one if model and deviations are right, and where none were stated in hundredths of the largest
    /// value of a set. Not a number where as many parameters as values are free and no deviations are known.
    pub scatter: f64,
    /// Whether deviations of a set were stated; those of the others, if there are any, were found by how far their values scatter.
    pub is_absolute: bool,
    /// Whether the search ended by itself, and not because it was cancelled or took too long.
    pub converged: bool,
    /// Curves of all sets that were followed, each a trial.
    pub trials: usize,
    /// Why trials were rejected because their curves could not be followed or compared, with how often.
    pub rejected: Vec<(String, usize)>,
    /// Where the search went on from, best first.
    pub starts: Vec<Started>,
    /// The fit that was asked for.
    #[serde(skip)]
    pub(crate) asked: Fit,
}

impl Fitted {
    /// The estimate of a parameter, by its name.
    pub fn estimate(&self, name: &str) -> Option<&Estimate> {
        self.estimates.iter().find(|estimate| estimate.name == name)
    }

    /// All residuals.
    pub(crate) fn all_residuals(&self) -> Vec<f64> {
        let sets = self.sets.iter().flat_map(|set| {
            let values = set.values.iter().map(|value| value.residual);
            values.chain(set.jumps.iter().copied())
        });
        sets.collect()
    }

    /// The root of the mean square of all residuals.
    pub fn rms(&self) -> f64 {
        let count: usize = self
            .sets
            .iter()
            .map(|set| set.values.len() + set.jumps.len())
            .sum();
        (self.chi_square / count.max(1) as f64).sqrt()
    }

    /// Fits again with a parameter at a value instead of free, from these estimates.
    ///
    /// # Errors
    /// As of [`Fit::run`], if that parameter is not free, and if nothing would be free.
    pub fn without(&self, name: &str, value: f64) -> Result<Self, FitError> {
        if self.asked.free.iter().all(|free| free.name != name) {
            let names = self.asked.free.iter().map(|free| free.name.as_str());
            let names = names.collect::<Vec<_>>().join(", ");
            let message = format!("it is not free, so that nothing is left out: there are {names}");
            return Err(FitError::free(name, message));
        }
        self.asked.from(self).held(name, value).run()
    }

    pub(crate) fn of(
        problem: &Problem,
        outcome: Outcome,
        starts: Vec<Started>,
        trials: &mut Trials<'_>,
    ) -> Self {
        let Outcome {
            mut trial,
            mut converged,
        } = outcome;
        let jacobian = trial.jacobian(problem);
        converged &= !trials.is_stopped;
        let linear = Linear::of(problem, &trial, &jacobian);
        let jacobian = jacobian.map_or_else(
            |_| DMatrix::zeros(trial.residuals.len(), problem.unknowns.len()),
            |own| own.matrix,
        );
        let degrees = linear.degrees;
        let chi_square = crate::minimise::square(&trial.residuals);
        let probability = (problem.is_absolute && problem.loss == Loss::Squares && degrees > 0)
            .then(|| statistics::exceeds(chi_square, degrees));
        Self {
            estimates: estimates(problem, &trial, &linear),
            covariance: rows(&linear.covariance),
            correlation: rows(&statistics::correlation(&linear.covariance)),
            singular_values: linear.singular.iter().copied().collect(),
            untold: linear.in_words(problem),
            sets: sets(problem, &trial, &jacobian, &linear),
            chi_square,
            count: linear.count,
            degrees,
            probability,
            scatter: linear.scatter,
            is_absolute: problem.is_absolute,
            converged,
            trials: trials.count,
            rejected: std::mem::take(&mut trials.failed),
            starts,
            asked: problem.asked.clone(),
        }
    }
}

fn rows(matrix: &DMatrix<f64>) -> Vec<Vec<f64>> {
    matrix
        .row_iter()
        .map(|row| row.iter().copied().collect())
        .collect()
}

fn estimates(problem: &Problem, trial: &Trial, linear: &Linear) -> Vec<Estimate> {
    let wide = linear.quantile();
    let unknowns = problem.unknowns.iter().enumerate().map(|(index, unknown)| {
        let value = trial.unknowns[index];
        let error = linear.covariance[(index, index)].sqrt();
        let error = error.is_finite().then_some(error);
        Estimate {
            name: unknown.name.clone(),
            unit: problem.model.parameters[unknown.parameter].unit.clone(),
            value,
            error,
            interval: error.map(|error| [value - wide * error, value + wide * error]),
            at_limit: linear.at_limit[index],
            undetermined: linear.undetermined[index],
        }
    });
    unknowns.collect()
}

fn sets(
    problem: &Problem,
    trial: &Trial,
    jacobian: &DMatrix<f64>,
    linear: &Linear,
) -> Vec<FittedSet> {
    let sets = problem.sets.iter().enumerate().map(|(number, set)| {
        let first = trial.first[number];
        let values = trial.feet(number).enumerate().map(|(index, foot)| {
            let row = first + index;
            let residual = trial.residuals[row];
            let gradient: DVector<f64> = jacobian.row(row).transpose();
            let left_out = linear.left_out(residual, &gradient);
            FittedValue {
                place: set.places[index],
                value: set.values[index],
                deviation: set.deviations[index],
                foot,
                residual,
                leverage: left_out.leverage,
                studentised: left_out.studentised,
                influence: left_out.influence,
                is_outlier: left_out.is_outlier,
                row: set.given[index],
            }
        });
        let values: Vec<FittedValue> = values.collect();
        let jumps = trial.residuals[first + values.len()..][..set.jumps.len()].to_vec();
        let varied = &problem.groups[set.group].varied;
        FittedSet {
            name: set.name.clone(),
            wanted: set.wanted.to_string(),
            unit: set
                .wanted
                .measure
                .unit(problem.model.unit_of(&set.wanted.name)),
            stated: set.is_known,
            varied: [
                varied.clone(),
                problem.model.unit_of_varied(varied).to_owned(),
            ],
            values,
            jumps,
            curve: trial.drawn(number),
        }
    });
    sets.collect()
}
