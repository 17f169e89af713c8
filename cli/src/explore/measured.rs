//! Measured values over the curve, and parameters that are fitted to them.

use std::ops::ControlFlow;
use std::time::Instant;

use hertzian::error::chain;
use hertzian::{Cancel, System};
use hertzian_fit::{DataSet, Estimate, Fit, FitError};
use serde::Serialize;

use super::asked::Asked;
use super::declared::Texts;
use super::fault::{Fault, Kind};
use super::traced::{INTERVAL, Tell};

/// A set of measured values.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Set {
    /// Its name.
    pub name: String,
    /// What was measured, as `x:p2p`.
    pub plot: String,
    /// What was varied.
    pub varied: String,
    /// The values of that, in units of the model.
    pub places: Vec<f64>,
    /// The measured values, in units of the model.
    pub values: Vec<f64>,
}

/// Parameters that were fitted.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Adjusted {
    /// What `hertzian fit` prints.
    pub said: String,
    /// Whether it has converged.
    pub converged: bool,
    /// Names and values of the parameters that were free.
    pub values: Vec<(String, f64)>,
}

/// The sets of a table, as `hertzian fit` reads them.
///
/// # Errors
/// Faults of the declaration, and what is wrong with the table.
pub fn read(of: &Asked, table: &str, texts: &Texts) -> Result<Vec<Set>, Fault> {
    let model = of.declared(texts)?;
    let sets = sets(of, table, &model)?;
    Ok(sets.iter().map(Set::of).collect())
}

/// Fits parameters to a table, beginning with the values that they have.
///
/// # Errors
/// Faults of the declaration, what is wrong with the table or the parameters, and if no curve can be followed.
pub fn fit(
    of: &Asked,
    table: &str,
    free: &[String],
    texts: &Texts,
    cancel: &Cancel,
    tell: &Tell,
) -> Result<Adjusted, Fault> {
    let model = of.declared(texts)?;
    if free.is_empty() {
        let fault = Fault::new(Kind::Value, "no parameter is free: choose what is fitted");
        return Err(fault.of("free"));
    }
    let data = sets(of, table, &model)?.into_iter();
    let fit = data.fold(Fit::of(&model), Fit::data);
    let fit = free.iter().fold(fit, Fit::free).cancel(cancel);
    let mut last = Instant::now();
    let fitted = fit.run_with(|told| {
        if last.elapsed() >= INTERVAL {
            last = Instant::now();
            let (stage, trials, rms) = (told.stage, told.trials, told.rms);
            tell(&format!("{stage}: {trials} trials, residuals {rms:.3}"));
        }
        ControlFlow::Continue(())
    });
    let fitted = fitted.map_err(|error| fault(&error))?;
    if cancel.is_cancelled() {
        return Err(Fault::cancelled());
    }
    let value = |name: &String| {
        let estimate: Option<&Estimate> = fitted.estimate(name);
        estimate.map(|estimate| (name.clone(), estimate.value))
    };
    Ok(Adjusted {
        said: fitted.to_string(),
        converged: fitted.converged,
        values: free.iter().filter_map(value).collect(),
    })
}

fn sets(of: &Asked, table: &str, model: &dyn System) -> Result<Vec<DataSet>, Fault> {
    let omega = Some(of.omega).filter(|omega| *omega > 0.0);
    hertzian_fit::read(table, model, omega).map_err(|error| fault(&error))
}

impl Set {
    fn of(set: &DataSet) -> Self {
        Self {
            name: set.name().to_owned(),
            plot: set.wanted().to_owned(),
            varied: set.over().to_owned(),
            places: set.places().to_vec(),
            values: set.values().to_vec(),
        }
    }
}

fn fault(error: &FitError) -> Fault {
    let field = match error {
        FitError::Cancelled => return Fault::cancelled(),
        FitError::Free { .. } | FitError::TooFew { .. } => "free",
        _ => "table",
    };
    Fault::new(Kind::Value, chain(error).to_string()).of(field)
}
