//! Reads the table and the oscillator, fits, writes and sums up.

use std::fmt::{self, Write as _};
use std::fs;
use std::ops::ControlFlow;
use std::path::Path;

use hertzian::error::chain;
use hertzian::generic::Declaration;
use hertzian::{Cancel, System};
use hertzian_fit::{Comparison, DataSet, Fit, FitError, Fitted, Jump, Loss};

use super::options::Options;
use crate::program::{Ended, Failed};
use crate::response::model_file::{self, ModelError};
use crate::response::models;
use crate::response::progress::Progress;

/// A table that is longer than this many bytes is none that a curve is fitted to.
const LONGEST: u64 = 50_000_000;

/// Fits, writes what was asked for, and sums up. Cancelling keeps the best values until then.
///
/// # Errors
/// If the oscillator, the table or an option cannot be used, or a file cannot be written.
pub fn run(options: &Options, cancel: &Cancel, progress: &mut Progress) -> Result<Ended, Failed> {
    let system = system(options).map_err(Failed::new)?;
    let path = options.data();
    let sets = table(path, &*system, options.model.omega).map_err(Failed::new)?;
    let sets = jumped(sets, options).map_err(Failed::new)?;
    let asked = asked(options, &*system, sets).cancel(cancel);
    let fitted = fitted(&asked, progress)?;
    let mut summary = fitted.to_string();
    let mut complaints = Vec::new();
    if !fitted.converged {
        complaints.push("it did not converge: these are the best values until then".to_owned());
    }
    if !options.against.is_empty() && fitted.converged {
        summary += &compared(options, &fitted, &mut complaints).map_err(Failed::new)?;
    }
    written(options, &fitted, &mut summary)?;
    Ok(Ended {
        complete: complaints.is_empty(),
        summary,
        complaints,
    })
}

/// The oscillator. What is free, or has a value in the table, needs none here.
fn system(options: &Options) -> Result<Box<dyn System>, String> {
    let model = options.model().resolved()?;
    model.check()?;
    let Some(path) = &model.file else {
        let names = options
            .free
            .iter()
            .chain(&options.own)
            .map(|free| &free.name);
        let has_alpha = names.clone().any(|name| name == "alpha");
        return Ok(if has_alpha {
            models::of_any_exponent(&model)
        } else {
            models::declared(&model)
        });
    };
    let described = |error: ModelError| error.describe(path);
    let text = model_file::text(path).map_err(|error| described(ModelError::Unreadable(error)))?;
    let mut declared =
        Declaration::parse(&text).map_err(|error| described(ModelError::Faulty(error)))?;
    for (name, value) in &model.set {
        let set = declared.set(name, *value);
        set.map_err(|error| described(ModelError::Parameter(error.to_string())))?;
    }
    Ok(Box::new(declared))
}

/// The data sets of the table.
fn table(path: &Path, system: &dyn System, omega: Option<f64>) -> Result<Vec<DataSet>, String> {
    let shown = path.display();
    let unreadable = |error: &dyn fmt::Display| format!("cannot read {shown}: {error}");
    let length = fs::metadata(path)
        .map_err(|error| unreadable(&error))?
        .len();
    if length > LONGEST {
        return Err(format!(
            "{shown} is longer than {LONGEST} bytes, and no table of measured values"
        ));
    }
    let text = fs::read_to_string(path).map_err(|error| unreadable(&error))?;
    hertzian_fit::read(&text, system, omega).map_err(|error| match error {
        FitError::Table { line, message } => format!("{shown}:{line}: {message}"),
        other => format!("{shown}: {}", chain(&other)),
    })
}

/// The data sets with their jumps and the deviation of their places.
fn jumped(sets: Vec<DataSet>, options: &Options) -> Result<Vec<DataSet>, String> {
    for jump in &options.jump {
        if !sets.iter().any(|set| set.name() == jump.set) {
            let names: Vec<&str> = sets.iter().map(DataSet::name).collect();
            return Err(format!(
                "--jump: there is no data set `{}`; there are `{}`",
                jump.set,
                names.join("`, `")
            ));
        }
    }
    let sets = sets.into_iter().map(|mut set| {
        let name = set.name().to_owned();
        for jump in options.jump.iter().filter(|jump| jump.set == name) {
            let of = if jump.is_bound {
                Jump::not_before
            } else {
                Jump::at
            };
            set = set.jump(of(jump.value, jump.deviation));
        }
        match options.place_sd {
            Some(deviation) => set.place_deviation(deviation),
            None => set,
        }
    });
    Ok(sets.collect())
}

/// What is asked for.
fn asked(options: &Options, system: &dyn System, sets: Vec<DataSet>) -> Fit {
    let mut fit = sets.into_iter().fold(Fit::of(system), Fit::data);
    for free in &options.free {
        fit = match free.range {
            Some(range) => fit.free_in(&free.name, range),
            None => fit.free(&free.name),
        };
    }
    for own in &options.own {
        fit = match own.range {
            Some(range) => fit.own_in(&own.name, range),
            None => fit.own(&own.name),
        };
    }
    if let Some(limit) = options.huber {
        fit = fit.loss(Loss::Huber(limit));
    }
    fit.starts(options.starts.into())
}

fn fitted(asked: &Fit, progress: &mut Progress) -> Result<Fitted, FitError> {
    asked.run_with(|told| {
        progress.update(|| {
            format!(
                "{}: {} trials, residuals {:.3}",
                told.stage, told.trials, told.rms
            )
        });
        ControlFlow::Continue(())
    })
}

/// The fits with parameters held beside the one without.
fn compared(
    options: &Options,
    fitted: &Fitted,
    complaints: &mut Vec<String>,
) -> Result<String, String> {
    let mut held: Vec<(String, Fitted)> = Vec::new();
    for (name, value) in &options.against {
        if !options.free.iter().any(|free| free.name == *name) {
            return Err(format!("--against {name}: it is not free"));
        }
        let without = fitted.without(name, *value);
        let without = without.map_err(|error| format!("--against {name}: {}", chain(&error)))?;
        if !without.converged {
            complaints.push(format!("the fit with {name} = {value} did not converge"));
        }
        held.push((format!("{name} = {value}"), without));
    }
    let free: Vec<&str> = options.free.iter().map(|free| free.name.as_str()).collect();
    let name = format!("free {}", free.join(", "));
    let mut fits = vec![(name.as_str(), fitted)];
    fits.extend(held.iter().map(|(name, fit)| (name.as_str(), fit)));
    Ok(format!("\n{}", Comparison::of(&fits)))
}

/// Writes the files that were asked for, and says which.
fn written(options: &Options, fitted: &Fitted, summary: &mut String) -> Result<(), Failed> {
    let mut write = |path: &Path, contents: String| -> Result<(), Failed> {
        let written = hertzian_file::write(path, contents);
        written
            .map_err(|error| Failed::new(format!("cannot write {}: {error}", path.display())))?;
        // Writing to a string does not fail.
        let _ = writeln!(summary, "written    {}", path.display());
        Ok(())
    };
    write(&options.svg, fitted.picture().to_svg())?;
    if let Some(path) = &options.csv {
        write(path, fitted.to_csv())?;
    }
    if let Some(path) = &options.json {
        write(path, fitted.to_json())?;
    }
    Ok(())
}
