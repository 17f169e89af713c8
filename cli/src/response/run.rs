//! From options to files and a summary.

use std::io;
use std::ops::ControlFlow;
use std::path::{Path, PathBuf};

use hertzian::chart::{Chart, Reference};
use hertzian::error::{ErrorKind, chain};
use hertzian::export::{self, Table};
use hertzian::{
    Branch, Cancel, Error, FrequencyResponse, OrbitError, Point, Stop, System, remarks,
};

use super::backbone::{self, Backbone};
use super::bifurcations;
use super::boundary::loss_of_contact;
use super::files::{self, Record};
use super::model_file::{ModelError, Varied};
use super::models::model;
use super::options::Options;
use super::progress::Progress;
use super::search;
use super::summary;
use crate::model::FREQUENCY_VARIES;
use crate::values;

/// What came of a run.
#[derive(Debug, Clone, PartialEq)]
pub struct Outcome {
    /// For people.
    pub summary: String,
    /// What could not be done, besides.
    pub warnings: Vec<String>,
    /// Whether the end of the range was reached.
    pub complete: bool,
}

/// Why nothing came of a run.
#[derive(Debug)]
#[non_exhaustive]
pub enum Failure {
    /// The library says no.
    Library(Error),
    /// A value of `--at` is not a number that could be reached.
    At(f64),
    /// The backbone was asked for of an oscillator from a file, or over a parameter.
    Backbone,
    /// An option cannot be used.
    Option(String),
    /// The file of the oscillator is at fault.
    Model(PathBuf, ModelError),
    /// A file cannot be written.
    File(PathBuf, io::Error),
}

impl Failure {
    /// 3 if the branch could not begin or was cancelled before, 2 if what was asked for is at fault.
    pub fn exit_code(&self) -> u8 {
        match self {
            Self::Library(error) if error.kind() == ErrorKind::Cancelled => 3,
            Self::Library(error) => match error.downcast_ref() {
                Some(OrbitError::NoStart { .. } | OrbitError::NoSuchPeriod { .. }) => 3,
                _ => 2,
            },
            _ => 2,
        }
    }
}

impl std::fmt::Display for Failure {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::Library(error) => chain(error).fmt(f),
            Self::Option(message) => f.write_str(message),
            Self::Model(path, error) => f.write_str(&error.describe(path)),
            Self::At(value) => write!(f, "at = {value}: must be finite"),
            Self::Backbone => f.write_str(
                "--backbone is over the frequency, and not for --model: which of its parameters are damping and drive is not known",
            ),
            Self::File(path, error) => write!(f, "cannot write {}: {error}", path.display()),
        }
    }
}

impl std::error::Error for Failure {}

impl From<Error> for Failure {
    fn from(error: Error) -> Self {
        Self::Library(error)
    }
}

/// Traces the branch, writes the files and sums up. Cancelling ends the branch where it is.
///
/// # Errors
/// If the options are not usable, no orbit was found to start from, or a file cannot be written.
pub fn run(
    options: &Options,
    cancel: &Cancel,
    progress: &mut Progress,
) -> Result<Outcome, Failure> {
    let options = &Options {
        model: options.model.resolved().map_err(Failure::Option)?,
        ..options.clone()
    };
    check(options)?;
    let varied = Varied {
        name: options.varied(),
        value: options.from,
    };
    let model = model(&options.model, varied).map_err(|error| {
        let path = options.model.file.clone().unwrap_or_default();
        Failure::Model(path, error)
    })?;
    search::check(options, &*model)?;
    bifurcations::check(options, &*model)?;
    let mut count = 0_usize;
    let mut see = |value: f64| {
        count += 1;
        progress.update(|| format!("{count} points, {} = {value:.6}", options.varied()));
    };
    let request = request(options, &*model).cancel(cancel);
    let branch = request.run_with(|progress| {
        see(progress.value.unwrap_or(options.from));
        ControlFlow::Continue(())
    })?;

    let omega = branch.points.first().map_or(1.0, |point| point.orbit.omega);
    let remarks = remarks::of(&*model, omega).into_iter();
    let mut warnings: Vec<String> = remarks.map(|remark| remark.to_string()).collect();
    let at = solutions_at(options, &branch, &mut warnings);
    let found = match branch.stopped {
        Stop::Interrupted => None,
        _ => bifurcations::find(options, &*model, cancel, &mut see)?,
    };
    let mut chart = match &found {
        Some(found) => found.chart(options, &*model),
        None => picture(options, &branch, &*model, cancel),
    };
    let mut backbone = Backbone::default();
    if options.backbone && !cancel.is_cancelled() {
        let missing;
        (backbone, missing) = backbone::of(options, &*model, &branch, cancel);
        chart = backbone.references().fold(chart, Chart::reference);
        warnings.extend(missing);
    }
    let mut branches = vec![branch];
    if let Some(found) = &found {
        branches.extend(found.branches()?);
        warnings.extend(found.warnings.iter().cloned());
    }
    let record = Record {
        version: export::JSON_VERSION,
        branches: &branches,
        at: &at,
        tracks: found.as_ref().map_or(&[], |found| &found.tracks),
        backbone: &backbone,
    };
    let written = write(options, &*model, &record, &chart)?;
    let branch = &branches[0];
    let reached = branch.stopped == Stop::ReachedEnd;
    if !reached {
        warnings.push(format!("the branch ended early: {}", branch.stopped));
    } else if cancel.is_cancelled() {
        warnings.push("interrupted: what was found until then is kept".to_owned());
    }
    let complete = reached && !cancel.is_cancelled();
    let further = found.map_or_else(String::new, |found| found.summary());
    Ok(Outcome {
        summary: summary::of(options, branch, &at, &written) + &further,
        warnings,
        complete,
    })
}

/// What the library does not check: options that do not go together, values to look at, and files.
fn check(options: &Options) -> Result<(), Failure> {
    if let Some(&value) = options.at.iter().find(|value| !value.is_finite()) {
        return Err(Failure::At(value));
    }
    if options.backbone && (options.model.file.is_some() || !options.over_frequency()) {
        return Err(Failure::Backbone);
    }
    if options.over_frequency() && options.model.omega.is_some() {
        return Err(Failure::Option(FREQUENCY_VARIES.to_owned()));
    }
    numbers(options).map_err(Failure::Option)?;
    for path in paths(options) {
        files::check(path).map_err(|error| Failure::File(path.to_path_buf(), error))?;
    }
    let read = options.model.path();
    if let Some(path) = files::shared(read.into_iter().chain(paths(options))) {
        let message = format!("{} is asked for more than once", path.display());
        return Err(Failure::Option(message));
    }
    Ok(())
}

/// What the numbers and names of options must be where the library does not see them, or only later.
fn numbers(options: &Options) -> Result<(), String> {
    let two = |count| count == 0 || count == 2;
    if !two(options.plane.len()) {
        return Err("--in takes two names: --in omega,drive".to_owned());
    }
    values::once("--in", options.plane.iter().map(String::as_str))?;
    if !two(options.within.len()) {
        return Err("--within takes two values: --within 0.05,0.5".to_owned());
    }
    if !options.within.is_empty() {
        values::interval("--within", &options.within)?;
    }
    options.model.check()
}

fn paths(options: &Options) -> impl Iterator<Item = &Path> {
    let optional = options.csv.iter().chain(&options.json);
    std::iter::once(&options.svg)
        .chain(optional)
        .map(PathBuf::as_path)
}

/// The options in the library's terms.
fn request(options: &Options, model: &dyn System) -> FrequencyResponse {
    let mut request = FrequencyResponse::of(model)
        .from(options.from)
        .to(options.to)
        .period(options.period)
        .tolerance(options.tolerance)
        .aft(options.aft.into())
        .multipliers(options.multipliers.into())
        .max_points(options.max_points);
    if !options.over_frequency() {
        request = request
            .vary(options.varied())
            .omega(options.model.frequency());
    }
    if let Some(harmonics) = options.harmonics {
        request = request.harmonics(harmonics);
    }
    if let Some(samples) = options.samples {
        request = request.samples(samples);
    }
    request
}

/// Every orbit of the branch at each value that was asked for.
fn solutions_at(options: &Options, branch: &Branch, warnings: &mut Vec<String>) -> Vec<Point> {
    let name = options.varied();
    let mut solutions = Vec::new();
    for &value in &options.at {
        match branch.at(value) {
            Ok(found) if found.is_empty() => {
                warnings.push(format!("the branch does not pass {name} = {value}"));
            }
            Ok(found) => solutions.extend(found),
            Err(error) => warnings.push(format!("at {name} = {value}: {}", chain(&error))),
        }
    }
    solutions
}

/// The library's picture of the branch, with the boundary of lost contact.
fn picture(options: &Options, branch: &Branch, model: &dyn System, cancel: &Cancel) -> Chart {
    if options.model.file.is_some() {
        return branch.chart();
    }
    let chart = branch.chart().title(summary::title(options, model, &[]));
    if !options.over_frequency() {
        return chart;
    }
    let values = branch.points.iter().map(|point| point.value);
    let (low, high) = values.fold((f64::INFINITY, 0.0), |(low, high): (f64, f64), value| {
        (low.min(value), high.max(value))
    });
    chart.reference(Reference {
        label: "loss of contact".to_owned(),
        points: loss_of_contact(&options.model, low..=high, cancel),
    })
}

/// Writes the files that were asked for; returns their paths.
fn write<'a>(
    options: &'a Options,
    model: &dyn System,
    record: &Record<'_>,
    chart: &Chart,
) -> Result<Vec<&'a Path>, Failure> {
    let failed = |path: &Path| {
        let path = path.to_path_buf();
        move |error| Failure::File(path, error)
    };
    let svg = &options.svg;
    export::write(svg, chart.to_svg()).map_err(failed(svg))?;
    if let Some(path) = &options.csv {
        let mut table = Table::of(model);
        for (number, branch) in record.branches.iter().enumerate() {
            branch
                .points
                .iter()
                .for_each(|point| table.add(number, point));
        }
        export::write(path, table.to_csv()).map_err(failed(path))?;
    }
    if let Some(path) = &options.json {
        files::write_json(path, record).map_err(failed(path))?;
    }
    Ok(paths(options).collect())
}
