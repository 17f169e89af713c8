//! From options to files and a summary.

use std::io;
use std::path::{Path, PathBuf};

use hertzian::bifurcation::Diagram;
use hertzian::chart::{Chart, Series, View};
use hertzian::error::{ErrorKind, chain};
use hertzian::export;
use hertzian::observe::Wanted;
use hertzian::{
    Branch, Cancel, Error, FrequencyResponse, Model, OrbitError, Point, Stop, System, remarks,
};

use super::backbone::{self, Backbone};
use super::bifurcations;
use super::boundary::loss_of_contact;
use super::completed;
use super::covered;
use super::files::{self, Record};
use super::model_file::{ModelError, Varied};
use super::models::model;
use super::near;
use super::options::Options;
use super::panels;
use super::places;
use super::progress::{Progress, Seen};
use super::resumed;
use super::search;
use super::sensitive;
use super::structure::{self, Reduced};
use super::summary;
use crate::look::Axis;
use crate::model::FREQUENCY_VARIES;
use crate::values;

/// What came of a run.
#[derive(Debug, Clone, PartialEq)]
pub struct Outcome {
    /// For people.
    pub summary: String,
    /// What could not be done, besides.
    pub warnings: Vec<String>,
    /// Whether the range is covered.
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

/// Traces the branches, writes the files and sums up. Cancelling ends the branch where it is.
///
/// # Errors
/// If the options are not usable, no orbit was found to start from, or a file cannot be written.
pub fn run(
    options: &Options,
    cancel: &Cancel,
    progress: &mut Progress,
) -> Result<Outcome, Failure> {
    let options = &Options {
        model: structure::resolved(options)
            .model
            .resolved()
            .map_err(Failure::Option)?,
        ..options.clone()
    };
    let (options, resumed) = resumed::of(options)?;
    let (model, reduced) = checked(&options, cancel, progress)?;
    let options = &structure::completed(&options, &*model);
    let mut seen = Seen::new(progress, options);
    seen.begin(reduced.as_ref().and_then(|reduced| reduced.advice(options)));
    let mut note = None;
    let mut diagram = if let Some(branch) = resumed {
        resumed::find(options, &branch, &*model, cancel, &mut seen)?
    } else {
        let plain = request(options, &*model).cancel(cancel);
        let request;
        (request, note) = near::of(options, &*model, plain)?;
        let visit = |progress: hertzian::Progress<'_>| seen.see(progress);
        covered::by_method(options, request, visit)?
    };
    let covered = diagram.branches.iter();
    let mut branches: Vec<Branch> = covered.map(|found| found.branch.clone()).collect();
    let mut warnings = remarks_on(&branches[0], &*model);
    warnings.extend(note);
    warnings.extend(windings(&branches).chain(laborious(&branches)));
    let solutions = solutions_at(options, &branches, &mut warnings);
    let missing = panels::write(options, &branches, &solutions)?;
    let all_panels = missing.is_empty();
    warnings.extend(missing);
    let at: Vec<Point> = solutions.into_iter().map(|(_, point)| point).collect();
    let found = match branches[0].stopped {
        Stop::Interrupted => None,
        _ => bifurcations::find(options, &*model, cancel, &mut seen)?,
    };
    let draw = |view: &View| {
        let (shown, chart) = match &found {
            Some(found) => (&found.diagram, found.chart(options, &*model, view)?),
            None => (&diagram, picture(options, &diagram, &*model, view, cancel)?),
        };
        sensitive::banded(options, shown, view, chart)
    };
    let (mut charts, undrawn) = drawn(options, draw)?;
    let all_drawn = undrawn.is_empty();
    warnings.extend(undrawn);
    let mut backbone = Backbone::default();
    if options.backbone && !cancel.is_cancelled() {
        let missing;
        (backbone, missing) =
            backbone::of(options, &*model, reduced.as_ref(), &branches[0], cancel);
        charts = with_backbone(&*model, &backbone, charts);
        warnings.extend(missing);
    }
    let mut further = covered::summary(&diagram, options.varied());
    let mut tracks = Vec::new();
    if let Some(found) = found {
        branches.extend(found.branches().cloned());
        further = found.summary(options.varied());
        warnings.extend(found.warnings);
        tracks = found.tracks;
        if options.bifurcations {
            diagram = found.diagram;
        }
    }
    let (sensitivities, underived) = sensitive::found(options, &branches, cancel, &mut seen);
    let all_derived = underived.is_none();
    warnings.extend(underived);
    if options.csv.is_some() || options.json.is_some() {
        // Files have a column for everything, whatever the method.
        let see = |progress: hertzian::Progress<'_>| seen.show(progress);
        warnings.extend(completed::all(&mut branches, cancel, see));
    }
    let reduction = match &reduced {
        Some(reduced) => Some(reduced.of(options, &branches, &backbone, cancel, &mut seen)?),
        None => None,
    };
    let record = Record {
        version: export::JSON_VERSION,
        branches: &branches,
        searched: &diagram.searched,
        uncovered: &diagram.uncovered,
        at: &at,
        tracks: &tracks,
        backbone: &backbone,
        reduction: reduction.as_ref(),
    };
    files::write(options, &*model, &record, &charts, &sensitivities)?;
    let written: Vec<&Path> = files::paths(options).collect();
    Ok(Outcome {
        summary: summary::of(options, &branches[0], &at, &written)
            + &backbone.summary()
            + &reduction.map_or_else(String::new, |reduction| reduction.summary())
            + &further
            + &sensitive::summary(&branches, &sensitivities),
        complete: is_complete(options, &branches[0], &diagram, cancel, &mut warnings)
            && all_drawn
            && all_derived
            && all_panels,
        warnings,
    })
}

/// The charts with the backbone, by the first output where there is one, as they are.
fn with_backbone(model: &dyn System, backbone: &Backbone, charts: Vec<Chart>) -> Vec<Chart> {
    let first = model.facts().outputs.first();
    let shown: Option<Wanted> = first.and_then(|output| output.name.parse().ok());
    let drawn = charts.into_iter().map(|chart| {
        let lines = backbone.references(shown.as_ref()).into_iter();
        lines.fold(chart, Chart::reference)
    });
    drawn.collect()
}

/// The charts that were asked for, and why one cannot be drawn: what was computed is not lost for that.
///
/// # Errors
/// If nothing can be drawn.
fn drawn(
    options: &Options,
    draw: impl Fn(&View) -> Result<Chart, Error>,
) -> Result<(Vec<Chart>, Vec<String>), Failure> {
    let (mut charts, mut undrawn) = (Vec::new(), Vec::new());
    for view in options.views() {
        match draw(&view) {
            Ok(chart) => charts.push(chart),
            Err(error) => undrawn.push(chain(&error).to_string()),
        }
    }
    if charts.is_empty() {
        charts.push(draw(&View::new().frequency(options.axis.into()))?);
    }
    Ok((charts, undrawn))
}

/// The model at the options, once everything that was asked for is checked.
fn checked(
    options: &Options,
    cancel: &Cancel,
    progress: &mut Progress,
) -> Result<(Box<dyn System>, Option<Reduced>), Failure> {
    check(options)?;
    let varied = Varied {
        name: options.varied(),
        value: options.range.from,
    };
    let (model, reduced) = if let Some(path) = &options.structure.file {
        progress.expect_long();
        progress.begin(&format!("reducing {}", path.display()), None);
        let (model, reduced) = structure::read(options, cancel)?;
        (model, Some(reduced))
    } else {
        let model = model(&options.model, varied).map_err(|error| {
            let path = options.model.file.clone().unwrap_or_default();
            Failure::Model(path, error)
        })?;
        (model, None)
    };
    let known = Model::of(&*model);
    for wanted in &options.plot {
        known.check(wanted)?;
    }
    for name in &options.path {
        let wanted: Wanted = name.parse().map_err(Error::from)?;
        known.check(&wanted)?;
    }
    search::check(options, &*model)?;
    sensitive::check(options, &*model)?;
    bifurcations::check(options, &*model)?;
    Ok((model, reduced))
}

/// Where branches wind, which takes long and is seldom what was looked for.
pub(crate) fn windings<'b>(
    branches: impl IntoIterator<Item = &'b Branch>,
) -> impl Iterator<Item = String> {
    let windings = branches.into_iter().filter_map(Branch::winding);
    windings.map(|winding| winding.to_string())
}

/// Unknowns of the balance from which on methods without harmonics are quicker wherever it was measured.
const LABORIOUS: usize = 1000;

/// Where the balance takes so many harmonics that another method is the better one.
fn laborious(branches: &[Branch]) -> Option<String> {
    let points = branches.iter().flat_map(|branch| &branch.points);
    let mut unknowns: Vec<usize> = points
        .map(|point| point.orbit.coordinates() * (2 * point.orbit.harmonics() + 1))
        .collect();
    unknowns.sort_unstable();
    let median = *unknowns.get(unknowns.len() / 2)?;
    (median >= LABORIOUS).then(|| {
        format!(
            "the balance takes {median} unknowns at most orbits, which is slow: --by shooting and --by contact-equation find the same \
             orbits without harmonics"
        )
    })
}

/// What is unusual about the model, at the frequency where the branch begins.
pub(crate) fn remarks_on(branch: &Branch, model: &dyn System) -> Vec<String> {
    let omega = branch.points.first().map_or(1.0, |point| point.orbit.omega);
    remarks::of(model, omega)
}

/// Whether everything that was asked for is there; if not, why.
fn is_complete(
    options: &Options,
    branch: &Branch,
    diagram: &Diagram,
    cancel: &Cancel,
    warnings: &mut Vec<String>,
) -> bool {
    let covered = || !options.one_branch && covered::is_complete(diagram);
    let reached = branch.stopped == Stop::ReachedEnd || covered();
    if !reached {
        warnings.push(format!("the branch ended early: {}", branch.stopped));
    } else if cancel.is_cancelled() {
        warnings.push("interrupted: what was found until then is kept".to_owned());
    }
    reached && !cancel.is_cancelled()
}

/// What the library does not check: options that do not go together, values to look at, and files.
fn check(options: &Options) -> Result<(), Failure> {
    if let Some(&value) = options.at.iter().find(|value| !value.is_finite()) {
        return Err(Failure::At(value));
    }
    let is_declared = options.structure.file.is_none() && options.model.file.is_some();
    if options.backbone && (is_declared || !options.over_frequency()) {
        return Err(Failure::Backbone);
    }
    if options.over_frequency() && options.model.omega.is_some() {
        return Err(Failure::Option(FREQUENCY_VARIES.to_owned()));
    }
    numbers(options).map_err(Failure::Option)?;
    for path in files::paths(options) {
        places::check(path).map_err(|error| Failure::File(path.to_path_buf(), error))?;
    }
    let read = options.model.path();
    if let Some(path) = places::shared(read.into_iter().chain(files::paths(options))) {
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
    if !two(options.path.len()) {
        return Err("--path takes two names: --path y,x".to_owned());
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

/// What varies, and how far, in the library's terms.
pub fn in_range(options: &Options, model: &dyn System) -> FrequencyResponse {
    let request = FrequencyResponse::of(model)
        .from(options.range.from)
        .to(options.range.to)
        .period(options.period);
    if options.over_frequency() {
        return request;
    }
    let request = request.vary(options.varied());
    request.omega(options.model.frequency())
}

/// The options in the library's terms.
pub(crate) fn request(options: &Options, model: &dyn System) -> FrequencyResponse {
    let mut request = in_range(options, model).tolerance(options.tolerance);
    if let Some(points) = options.max_points {
        request = request.max_points(points);
    }
    if let Some(name) = &options.accuracy_of {
        request = request.accuracy_of(name);
    }
    if let Some(path) = &options.keep {
        request = request.keep(path);
    }
    request
}

/// Every orbit of the branches at each value that was asked for, with the number of its branch.
fn solutions_at(
    options: &Options,
    branches: &[Branch],
    warnings: &mut Vec<String>,
) -> Vec<(usize, Point)> {
    let name = options.varied();
    let mut solutions = Vec::new();
    for &value in &options.at {
        let (before, said) = (solutions.len(), warnings.len());
        for (number, branch) in branches.iter().enumerate() {
            match branch.at(value) {
                Ok(found) => solutions.extend(found.into_iter().map(|point| (number, point))),
                Err(error) => warnings.push(format!("at {name} = {value}: {}", chain(&error))),
            }
        }
        if solutions.len() == before && warnings.len() == said {
            warnings.push(format!("the branch does not pass {name} = {value}"));
        }
    }
    solutions
}

/// The library's picture of the branches, with the boundary of lost contact.
pub(crate) fn picture(
    options: &Options,
    diagram: &Diagram,
    model: &dyn System,
    view: &View,
    cancel: &Cancel,
) -> Result<Chart, Error> {
    let chart = match &diagram.branches[..] {
        [alone] => alone.branch.chart_of(view)?,
        _ => diagram.chart_of(view)?,
    };
    let chart = summary::titled(chart, options, model);
    let peak_to_peak = options.plot.is_empty() && options.look.stack == 0;
    let is_usual = peak_to_peak && options.axis == Axis::Omega;
    if options.model.file.is_some() || !options.over_frequency() || !is_usual {
        return Ok(chart);
    }
    let branches = diagram.branches.iter();
    let points = branches.flat_map(|found| &found.branch.points);
    let values = points.map(|point| point.value);
    let (low, high) = values.fold((f64::INFINITY, 0.0), |(low, high): (f64, f64), value| {
        (low.min(value), high.max(value))
    });
    Ok(chart.reference(Series {
        label: "loss of contact".to_owned(),
        points: loss_of_contact(&options.model, low..=high, cancel),
    }))
}
