//! Fits of the same data beside each other.
//!
//! With the sum of squares `S` of `n` values and `p` parameters, Akaike's criterion is, but for a constant,
//!
//! ```text
//! A = S + 2 p   where deviations are known,     A = n log(S / n) + 2 p   where they are not                  (1)
//! ```
//!
//! where of a robust loss `S` is the sum of what residuals count, by the scale of the first fit for all, over the square of its scatter, and
//! `A = S + 2 p`. A fit with `q` parameters less than the first is tested by `S' - S`, which is distributed as chi-square with `q` degrees
//! of freedom where deviations are known, and otherwise by the ratio `F = (S' - S) (n - p) / (q S)`.
//!
//! Source: Seber and Wild (1989), Nonlinear Regression, section 5.3; Akaike (1974), IEEE Transactions on Automatic Control 19, 716; Ronchetti
//! (1985), Statistics and Probability Letters 3, 21 (robust losses).

use std::fmt;

use serde::Serialize;
use statrs::distribution::{ContinuousCDF, FisherSnedecor};

use crate::fit::Loss;
use crate::minimise::{counted, square};
use crate::result::Fitted;
use crate::search::spread;
use crate::statistics::exceeds;

/// A fit beside others.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[non_exhaustive]
pub struct Compared {
    /// What it is called.
    pub name: String,
    /// Number of free parameters.
    pub parameters: usize,
    /// Sum of the squares of the residuals.
    pub chi_square: f64,
    /// Akaike's criterion less that of the best of all.
    pub criterion: f64,
    /// How probable so large a difference from the first is, if what this one leaves out is not there; `None` of the first, and of what has as many
    /// parameters.
    pub probability: Option<f64>,
}

/// Fits of the same data beside each other.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[non_exhaustive]
pub struct Comparison {
    /// The fits, in the order given.
    pub fits: Vec<Compared>,
}

impl Comparison {
    /// Of fits of the same data, with names: the first has what the others leave out.
    pub fn of(fits: &[(&str, &Fitted)]) -> Self {
        let Some((_, first)) = fits.first() else {
            return Self { fits: Vec::new() };
        };
        let criterion = |fit: &Fitted| {
            let penalty = 2.0 * fit.estimates.len() as f64;
            let n = fit.count as f64;
            match robust(first, fit) {
                Some(sum) => sum + penalty,
                None if fit.is_absolute => fit.chi_square + penalty,
                None => n * (fit.chi_square / n).max(f64::MIN_POSITIVE).ln() + penalty,
            }
        };
        let best = fits
            .iter()
            .map(|(_, fit)| criterion(fit))
            .fold(f64::INFINITY, f64::min);
        let compared = fits
            .iter()
            .enumerate()
            .map(|(index, (name, fit))| Compared {
                name: (*name).to_owned(),
                parameters: fit.estimates.len(),
                chi_square: fit.chi_square,
                criterion: criterion(fit) - best,
                probability: (index > 0).then(|| tested(first, fit)).flatten(),
            });
        Self {
            fits: compared.collect(),
        }
    }
}

/// What the residuals of a fit count by a robust loss, in squares of the scatter of the first of all; nothing by squares.
fn robust(first: &Fitted, fit: &Fitted) -> Option<f64> {
    let loss = first.asked.loss;
    if loss == Loss::Squares {
        return None;
    }
    let scale = if first.is_absolute {
        1.0
    } else {
        spread(&first.all_residuals())
    };
    let sum = square(&counted(loss, scale, &fit.all_residuals()).0);
    let by = if first.is_absolute {
        1.0
    } else {
        first.scatter
    };
    Some(sum / (by * by))
}

/// How probable the difference of two fits is.
fn tested(full: &Fitted, less: &Fitted) -> Option<f64> {
    let left_out = full
        .estimates
        .len()
        .checked_sub(less.estimates.len())
        .filter(|count| *count > 0)?;
    let robust = [less, full].map(|fit| robust(full, fit));
    let [more, own] = match robust {
        // By the square of the scatter, which has the degrees of freedom in it.
        [Some(less), Some(own)] => [(less - own).max(0.0), full.degrees as f64],
        _ => [
            (less.chi_square - full.chi_square).max(0.0),
            full.chi_square,
        ],
    };
    if full.is_absolute {
        return Some(exceeds(more, left_out));
    }
    let ratio = more * full.degrees as f64 / (left_out as f64 * own);
    let distribution = FisherSnedecor::new(left_out as f64, full.degrees as f64).ok()?;
    ratio.is_finite().then(|| distribution.sf(ratio))
}

impl fmt::Display for Comparison {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let width = self
            .fits
            .iter()
            .map(|fit| fit.name.chars().count())
            .max()
            .unwrap_or(0)
            .max(10);
        writeln!(
            f,
            "{:<width$} free  sum of squares  criterion  probability",
            "model"
        )?;
        for fit in &self.fits {
            let probability = fit
                .probability
                .map_or("-".to_owned(), |probability| format!("{probability:.2e}"));
            writeln!(
                f,
                "{:<width$} {:>4}  {:>14.5e}  {:>+9.1}  {probability:>11}",
                fit.name, fit.parameters, fit.chi_square, fit.criterion
            )?;
        }
        Ok(())
    }
}
