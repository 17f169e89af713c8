//! What the derivatives at a fit say of its estimates.
//!
//! With the derivatives `J` of the residuals by the unknowns, the scatter `s` of the residuals, and scales `D` (the sizes of the estimates),
//!
//! ```text
//! J D = U S V',     C = s^2 D V S^-2 V' D                                                                    (1)
//! h = g' C g / s^2,     t = r / (s sqrt(1 - h)),     change = C g r / (s^2 (1 - h))                           (2)
//! ```
//!
//! with a row `g` of `J` and its residual `r`: its leverage, its residual in a fit without it, and how that fit differs. Directions of `V` whose
//! singular value is nothing beside the largest are not determined, and left out of (1). Of a robust loss with derivative `psi` the scatter is
//!
//! ```text
//! s^2 = sum psi^2 / (n - p) / mean(psi')^2                                                                   (3)
//! ```
//!
//! Source: Seber and Wild (1989), Nonlinear Regression, sections 2.1 and 3.4; Cook and Weisberg (1982), Residuals and Influence in Regression,
//! section 2.2; Huber (1973), Annals of Statistics 1, 799.

use nalgebra::{DMatrix, DVector};
use statrs::distribution::{ChiSquared, ContinuousCDF, Normal, StudentsT};

use crate::fit::Loss;
use crate::minimise::{WITHOUT, square};
use crate::problem::Problem;
use crate::search::spread;
use crate::trial::{Jacobian, Trial};

/// A direction with a singular value below this part of the largest is not determined.
const NOTHING: f64 = 1e-6;
/// One that is known to no better than this part of the estimates is said not to be told.
const COARSE: f64 = 0.5;
/// Parameters that take less than this part of a direction are left out of words about it.
const PART: f64 = 0.1;
/// An estimate this near to the end of its range, in units of its scale, is at it.
const AT: f64 = 1e-7;
/// Residuals of a set without deviations, in hundredths of its largest value, are rounding below this.
const ROUNDED: f64 = 1e-6;
/// Probability outside of an interval, and that of one outlier among all values.
const OUTSIDE: f64 = 0.05;

/// (1)
#[derive(Debug, Clone)]
pub(crate) struct Linear {
    pub(crate) covariance: DMatrix<f64>,
    pub(crate) singular: DVector<f64>,
    directions: DMatrix<f64>,
    /// Unknowns that are not at the end of their range, with their scales.
    inner: Vec<(usize, f64)>,
    pub(crate) at_limit: Vec<bool>,
    /// Unknowns that no residual depends on.
    silent: Vec<usize>,
    /// Unknowns that are not at the end of their range, and that the data do not determine.
    pub(crate) undetermined: Vec<bool>,
    /// Residuals that say nothing for want of derivatives, and why; or all of them.
    lacking: Vec<String>,
    /// The scatter of the residuals; not a number where there are no more of them than unknowns, and deviations are not known.
    pub(crate) scatter: f64,
    pub(crate) degrees: usize,
    /// Residuals that say something.
    pub(crate) count: usize,
    square: f64,
    is_absolute: bool,
    is_robust: bool,
    determined: DMatrix<f64>,
}

/// What would change without one value.
#[derive(Debug, Clone, Copy)]
pub(crate) struct LeftOut {
    pub(crate) leverage: f64,
    pub(crate) studentised: f64,
    pub(crate) influence: f64,
    pub(crate) is_outlier: bool,
}

impl Linear {
    /// Of derivatives at a trial, or why there are none.
    pub(crate) fn of(
        problem: &Problem,
        trial: &Trial,
        derivatives: &Result<Jacobian, String>,
    ) -> Self {
        let count = problem.unknowns.len();
        let none = DMatrix::zeros(trial.residuals.len(), count);
        let jacobian = derivatives.as_ref().map_or(&none, |own| &own.matrix);
        let values = problem.unknowns.iter().zip(&trial.unknowns);
        let at_limit = at_limit(problem, trial);
        let scale = |(unknown, value): (&crate::problem::Unknown, &f64)| {
            if *value == 0.0 {
                unknown.scale
            } else {
                value.abs()
            }
        };
        let inner = values
            .map(scale)
            .enumerate()
            .filter(|(index, _)| !at_limit[*index]);
        let inner: Vec<(usize, f64)> = inner.collect();
        let size = |&(index, scale): &(usize, f64)| jacobian.column(index).norm() * scale;
        let largest = inner.iter().map(size).fold(0.0, f64::max);
        let (inner, mut silent): (Vec<_>, Vec<_>) = inner
            .into_iter()
            .partition(|column| size(column) > WITHOUT * largest);
        if derivatives.is_err() {
            // Of what is not known nothing is silent.
            silent.clear();
        }
        let silent: Vec<usize> = silent.into_iter().map(|(index, _)| index).collect();
        let scaled = DMatrix::from_fn(jacobian.nrows(), inner.len(), |i, j| {
            jacobian[(i, inner[j].0)] * inner[j].1
        });
        let (singular, directions) = decomposed(&scaled);
        let says = saying(trial, derivatives);
        let degrees = says.len().saturating_sub(inner.len());
        let scatter = scatter(problem, &says, degrees);
        let largest = singular.iter().fold(0.0, |m: f64, &x| m.max(x));
        let mut covariance = DMatrix::zeros(count, count);
        let mut determined = DMatrix::zeros(count, count);
        for (k, &value) in singular.iter().enumerate() {
            let is_nothing = value <= NOTHING * largest || value == 0.0;
            let along = DVector::from_fn(inner.len(), |i, _| directions[(i, k)]);
            for (i, &(row, a)) in inner.iter().enumerate() {
                for (j, &(column, b)) in inner.iter().enumerate() {
                    let product = along[i] * along[j] * a * b;
                    if !is_nothing {
                        determined[(row, column)] += product / (value * value);
                    } else if along[i].abs() > 1e-3 && along[j].abs() > 1e-3 {
                        covariance[(row, column)] = f64::NAN;
                    }
                }
            }
        }
        let undetermined = (0..count).map(|index| {
            let is_nothing: bool = covariance[(index, index)].is_nan();
            is_nothing || silent.contains(&index)
        });
        let undetermined = undetermined.collect();
        covariance += &determined * (scatter * scatter);
        if derivatives.is_err() {
            covariance.fill(f64::NAN);
        }
        for index in (0..count).filter(|index| at_limit[*index] || silent.contains(index)) {
            covariance.row_mut(index).fill(f64::NAN);
            covariance.column_mut(index).fill(f64::NAN);
        }
        Self {
            covariance,
            singular,
            directions,
            inner,
            at_limit,
            silent,
            undetermined,
            lacking: lacking(derivatives),
            scatter,
            degrees,
            count: says.len(),
            square: square(&says),
            is_absolute: problem.is_absolute,
            is_robust: problem.loss != Loss::Squares,
            determined,
        }
    }

    /// So many standard errors make a 95 % interval.
    pub(crate) fn quantile(&self) -> f64 {
        let part = 1.0 - 0.5 * OUTSIDE;
        self.normal_or_student(self.degrees, part)
    }

    fn normal_or_student(&self, degrees: usize, part: f64) -> f64 {
        let student = StudentsT::new(0.0, 1.0, degrees as f64);
        let student = student.ok().filter(|_| !self.is_absolute);
        match student {
            Some(student) => student.inverse_cdf(part),
            None => Normal::standard().inverse_cdf(part),
        }
    }

    /// (2)
    pub(crate) fn left_out(&self, residual: f64, gradient: &DVector<f64>) -> LeftOut {
        let moved = &self.determined * gradient;
        let leverage = gradient.dot(&moved).clamp(0.0, 1.0);
        let rest = (1.0 - leverage).max(1e-12);
        let others = self.degrees.saturating_sub(1);
        // Of a robust loss the scatter does not follow outliers, and the sum of squares does.
        let without = if self.is_absolute || self.is_robust || others == 0 {
            self.scatter
        } else {
            // Where nothing is left, rounding is.
            let sum = (self.square - residual * residual / rest).max(1e-9 * self.square);
            (sum / others as f64).sqrt()
        };
        let studentised = if without.is_nan() {
            f64::NAN
        } else {
            residual / (without.max(f64::MIN_POSITIVE) * rest.sqrt())
        };
        let part = 1.0 - 0.5 * OUTSIDE / self.count.max(1) as f64;
        let changes = (0..moved.len()).map(|i| {
            let error = self.covariance[(i, i)].sqrt();
            let change = (moved[i] * residual / rest / error).abs();
            if change.is_finite() { change } else { 0.0 }
        });
        LeftOut {
            leverage,
            studentised,
            influence: changes.fold(0.0, f64::max),
            is_outlier: others > 0
                && (self.is_absolute || self.scatter > ROUNDED)
                && studentised.abs() > self.normal_or_student(others, part),
        }
    }

    /// What the data cannot tell.
    pub(crate) fn in_words(&self, problem: &Problem) -> Vec<String> {
        let largest = self.singular.iter().fold(0.0, |m: f64, &x| m.max(x));
        let name = |index: usize| problem.unknowns[index].name.as_str();
        let silent = self.silent.iter().map(|&index| name(index));
        let silent = silent.map(|name| format!("the data say nothing of {name}"));
        let mut said: Vec<String> = self.lacking.iter().cloned().chain(silent).collect();
        if self.scatter.is_nan() && self.lacking.is_empty() {
            let what = "as many parameters as values: how far values scatter is not known, nor are standard errors";
            said.push(what.to_owned());
        }
        for (k, &value) in self.singular.iter().enumerate() {
            let is_nothing = value <= NOTHING * largest || value == 0.0;
            if !is_nothing && (self.scatter.is_nan() || self.scatter / value <= COARSE) {
                continue;
            }
            let direction = self.directions.column(k);
            let main = direction
                .iter()
                .fold(0.0, |m: f64, x| if x.abs() > m.abs() { *x } else { m });
            let parts = self.inner.iter().zip(direction.iter());
            let mut parts: Vec<(&str, f64)> = parts
                .filter(|(_, part)| part.abs() > PART)
                .map(|((index, _), part)| (problem.unknowns[*index].name.as_str(), part / main))
                .collect();
            parts.sort_by(|a, b| b.1.abs().total_cmp(&a.1.abs()));
            let names: Vec<&str> = parts.iter().map(|(name, _)| *name).collect();
            let moves: Vec<String> = parts
                .iter()
                .map(|(name, part)| format!("{name} by {:+.2} %", *part))
                .collect();
            let what = match names.as_slice() {
                [name] => format!("the data say little of {name}"),
                names => format!("the data do not tell {} apart", listed(names)),
            };
            let changes = 0.01 * value / main.abs();
            said.push(format!(
                "{what}: to change {} changes the residuals by {changes:.0e} of a standard deviation in all",
                listed(&moves.iter().map(String::as_str).collect::<Vec<_>>())
            ));
        }
        said
    }
}

/// Whether each unknown is at the end of its range.
fn at_limit(problem: &Problem, trial: &Trial) -> Vec<bool> {
    let values = problem.unknowns.iter().zip(&trial.unknowns);
    let at_limit = values.map(|(unknown, value)| {
        let mut limits = unknown.limits.iter();
        limits.any(|limit| (value - limit).abs() <= AT * unknown.scale)
    });
    at_limit.collect()
}

/// The residuals that say something: a bound that is met says nothing, nor does what has no derivatives.
fn saying(trial: &Trial, derivatives: &Result<Jacobian, String>) -> Vec<f64> {
    let says = |row: usize| match derivatives {
        Err(_) => true,
        Ok(Jacobian { matrix, without }) => {
            let is_met = trial.residuals[row] == 0.0 && matrix.row(row).iter().all(|x| *x == 0.0);
            !is_met && without.iter().all(|(own, _)| *own != row)
        }
    };
    let residuals = trial.residuals.iter().enumerate();
    let says = residuals.filter(|(row, _)| says(*row));
    says.map(|(_, residual)| *residual).collect()
}

/// What has no derivatives, in words, each once.
fn lacking(derivatives: &Result<Jacobian, String>) -> Vec<String> {
    let without = match derivatives {
        Err(reason) => {
            return vec![format!(
                "no standard errors, for want of derivatives: {reason}"
            )];
        }
        Ok(Jacobian { without, .. }) => without,
    };
    let mut said: Vec<String> = Vec::new();
    for (_, what) in without {
        let what = format!("estimates do not follow what has no derivatives: {what}");
        if !said.contains(&what) {
            said.push(what);
        }
    }
    said
}

/// `a, b and c`.
fn listed(names: &[&str]) -> String {
    match names {
        [] => String::new(),
        [name] => (*name).to_owned(),
        [first @ .., last] => format!("{} and {last}", first.join(", ")),
    }
}

/// Singular values and right vectors, by the triangle of the matrix: largest first.
fn decomposed(matrix: &DMatrix<f64>) -> (DVector<f64>, DMatrix<f64>) {
    if matrix.ncols() == 0 || matrix.iter().any(|x| !x.is_finite()) {
        let n = matrix.ncols();
        return (DVector::zeros(n), DMatrix::identity(n, n));
    }
    let triangle = matrix.clone().qr().r();
    let svd = triangle.svd(false, true);
    let n = matrix.ncols();
    let directions = svd
        .v_t
        .map_or_else(|| DMatrix::identity(n, n), |v| v.transpose());
    (svd.singular_values, directions)
}

/// The scatter of residuals (3); not a number where none is left to tell it.
fn scatter(problem: &Problem, residuals: &[f64], degrees: usize) -> f64 {
    if degrees == 0 {
        return if problem.is_absolute { 1.0 } else { f64::NAN };
    }
    let degrees = degrees as f64;
    match problem.loss {
        Loss::Squares if problem.is_absolute => 1.0,
        Loss::Squares => (square(residuals) / degrees).sqrt(),
        Loss::Huber(limit) => {
            let limit = if problem.is_absolute {
                limit
            } else {
                limit * spread(residuals)
            };
            let psi: f64 = residuals.iter().map(|r| r.abs().min(limit).powi(2)).sum();
            let inside = residuals.iter().filter(|r| r.abs() <= limit).count();
            let slope = inside as f64 / residuals.len() as f64;
            (psi / degrees).sqrt() / slope.max(f64::MIN_POSITIVE)
        }
    }
}

/// How probable a larger sum of squares is.
pub(crate) fn exceeds(chi_square: f64, degrees: usize) -> f64 {
    ChiSquared::new(degrees as f64).map_or(f64::NAN, |distribution| distribution.sf(chi_square))
}

/// Correlation of a covariance.
pub(crate) fn correlation(covariance: &DMatrix<f64>) -> DMatrix<f64> {
    DMatrix::from_fn(covariance.nrows(), covariance.ncols(), |i, j| {
        covariance[(i, j)] / (covariance[(i, i)] * covariance[(j, j)]).sqrt()
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::data::DataSet;
    use crate::fit::Fit;
    use crate::trial::How;

    hertzian::oscillator! {
        Sprung(x) {
            param c in 0.0..;
            param k > 0;
            ddot(x) + c*dot(x) + k*x = cos(omega*t);
        }
    }

    fn problem(omegas: &[f64], values: &[f64]) -> Problem {
        let set = DataSet::new("x:p2p", omegas, values);
        let fit = Fit::of(&Sprung { c: 0.2, k: 4.0 }).data(set);
        Problem::new(&fit.free("c").free("k")).expect("a problem")
    }

    fn linear(problem: &Problem, change: impl Fn(&mut Jacobian)) -> Linear {
        let trial = Trial::below(problem, &[0.2, 4.0], How::Exact, f64::INFINITY);
        let mut trial = trial.expect("a trial");
        let mut jacobian = trial.jacobian(problem).expect("derivatives");
        change(&mut jacobian);
        Linear::of(problem, &trial, &Ok(jacobian))
    }

    /// A residual without derivatives is left out, as if it had not been measured, and said; without any at all nothing is said of unknowns.
    #[test]
    fn what_has_no_derivatives_is_left_out_and_said() {
        let omegas = [1.5, 1.7, 1.9, 2.1, 2.3, 2.5];
        let values = [1.1, 1.7, 3.6, 3.4, 1.5, 0.85];
        let all = problem(&omegas, &values);
        let found = linear(&all, |jacobian| {
            jacobian.matrix.row_mut(0).fill(0.0);
            jacobian
                .without
                .push((0, "values of x:p2p: why".to_owned()));
        });
        let expected = linear(&problem(&omegas[1..], &values[1..]), |_| {});
        assert_eq!((found.count, found.degrees), (5, 3));
        let apart = (&found.covariance - &expected.covariance).norm();
        // Its curve has other points, and the slopes at feet that deviations are by are those between them.
        let size = expected.covariance.norm();
        assert!(apart < 1e-2 * size, "{apart:e} {size:e}");
        let said = found.in_words(&all);
        let what = "estimates do not follow what has no derivatives: values of x:p2p: why";
        assert_eq!(said, [what]);
        let trial = Trial::below(&all, &[0.2, 4.0], How::Exact, f64::INFINITY);
        let none = Linear::of(&all, &trial.expect("a trial"), &Err("why".to_owned()));
        assert!(none.covariance.iter().all(|x| x.is_nan()));
        let said = none.in_words(&all);
        assert_eq!(said, ["no standard errors, for want of derivatives: why"]);
    }
}
