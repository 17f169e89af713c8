//! From options to files and a summary.

use std::io;
use std::num::NonZeroUsize;
use std::path::{Path, PathBuf};
use std::sync::Mutex;

use hertzian::error::chain;
use hertzian::time;
use hertzian::time::stroboscope::Stroboscope;
use hertzian::time::{Flow, FlowError};
use hertzian::{Cancel, Error, System};

use super::options::{Options, Swept};
use super::output::{self, Results};
use super::{basin, history, lyapunov, phase, sweep};
use crate::model::FREQUENCY_VARIES;
use crate::response::model_file::{self, ModelError, Varied};
use crate::response::models;
use crate::response::places;
use crate::response::progress::Progress;
use crate::values::{self, MOST_ROWS, MOST_THREADS};

/// What came of a run.
#[derive(Debug, Clone, PartialEq)]
pub struct Outcome {
    /// For people.
    pub summary: String,
    /// Whether all was computed.
    pub complete: bool,
}

/// Why nothing came of a run.
#[derive(Debug)]
#[non_exhaustive]
pub enum Failure {
    /// The library says no.
    Library(Error),
    /// An option cannot be used.
    Option(String),
    /// The file of the oscillator is at fault.
    Model(PathBuf, ModelError),
    /// The motion cannot be computed.
    Motion(FlowError),
    /// A file cannot be written.
    File(PathBuf, io::Error),
}

impl std::fmt::Display for Failure {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::Library(error) => chain(error).fmt(f),
            Self::Option(message) => f.write_str(message),
            Self::Model(path, error) => f.write_str(&error.describe(path)),
            Self::Motion(error) => error.fmt(f),
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

impl From<FlowError> for Failure {
    fn from(error: FlowError) -> Self {
        Self::Motion(error)
    }
}

/// What a task works with.
pub struct Task<'t> {
    /// What was asked for.
    pub options: &'t Options,
    /// The oscillator.
    pub system: &'t dyn System,
    /// Ends the task when it is cancelled.
    pub cancel: &'t Cancel,
    /// The line on the terminal.
    pub progress: Mutex<&'t mut Progress>,
}

/// Does the task, writes the files and sums up. Cancelling ends the task where it is.
///
/// # Errors
/// If the options are not usable, a motion cannot be computed, or a file cannot be written.
pub fn run(
    options: &Options,
    cancel: &Cancel,
    progress: &mut Progress,
) -> Result<Outcome, Failure> {
    output::check(&options.out)?;
    let written = output::paths(&options.out);
    let others = [options.model.path(), options.checkpoint.as_deref()];
    let written_paths = written.iter().map(PathBuf::as_path);
    if let Some(path) = places::shared(others.into_iter().flatten().chain(written_paths)) {
        let message = format!("{} is asked for more than once", path.display());
        return Err(Failure::Option(message));
    }
    let results = compute(options, cancel, progress)?;
    output::write(&options.out, &results)?;
    let paths = written.map(|path| path.display().to_string());
    Ok(Outcome {
        summary: format!("{}written    {}\n", results.summary, paths.join(", ")),
        complete: results.complete,
    })
}

/// Does the task and writes no file but the checkpoint.
///
/// # Errors
/// If the options are not usable, or a motion cannot be computed.
pub fn compute(
    options: &Options,
    cancel: &Cancel,
    progress: &mut Progress,
) -> Result<Results, Failure> {
    let options = &Options {
        model: options.model.resolved().map_err(Failure::Option)?,
        ..options.clone()
    };
    check(options)?;
    let varied = Varied {
        name: options.sweep.map_or("omega", Swept::name),
        value: options.from,
    };
    let system = models::model(&options.model, varied).map_err(|error| {
        let path = options.model.file.clone().unwrap_or_default();
        Failure::Model(path, error)
    })?;
    let task = Task {
        options,
        system: &*system,
        cancel,
        progress: Mutex::new(progress),
    };
    task.check()?;
    let mut results = match options.sweep {
        Some(swept) => sweep::run(&task, swept),
        None if options.basin => basin::run(&task),
        None if options.lyapunov => lyapunov::run(&task),
        None if options.phase => phase::run(&task),
        None => history::run(&task),
    }?;
    let facts = task.system.facts();
    let head = format!("{}: {}\n", facts.name, facts.equation);
    results.summary.insert_str(0, &head);
    Ok(results)
}

/// Options that do not go together.
fn check(options: &Options) -> Result<(), Failure> {
    let faults = [
        (
            options.sweep == Some(Swept::Omega) && options.model.omega.is_some(),
            FREQUENCY_VARIES,
        ),
        (
            options.checkpoint.is_some() && options.sweep.is_none() && !options.basin,
            "--checkpoint is for --basin and --sweep",
        ),
        (
            options.lyapunov && options.batches < 2,
            "--batches must be at least 2: a standard error is that of their means",
        ),
    ];
    let mut faults = faults.into_iter().filter(|(is_at_fault, _)| *is_at_fault);
    if let Some((_, message)) = faults.next() {
        return Err(Failure::Option(message.to_owned()));
    }
    let unrepeatable = |path: &Path| !path.is_file();
    if options.checkpoint.is_some() && options.model.path().is_some_and(unrepeatable) {
        let message = "--checkpoint needs --model in a file: it is read again, to tell what the checkpoint belongs to";
        return Err(Failure::Option(message.to_owned()));
    }
    numbers(options).map_err(Failure::Option)
}

/// What the numbers must be, whatever the oscillator is.
fn numbers(options: &Options) -> Result<(), String> {
    values::positive("--escape", options.escape)?;
    for (option, value) in [("--section", options.section), ("--mark", options.mark)] {
        value.map_or(Ok(()), |value| values::finite(option, value))?;
    }
    for &drive in &options.drives {
        values::finite("--drives", drive)?;
    }
    if let [left, right, low, high] = options.zoom[..] {
        values::interval("--zoom", &[left, right])?;
        values::interval("--zoom", &[low, high])?;
    }
    if options.basin || options.phase && options.starts > 0 {
        values::interval("--x-range", &options.x_range)?;
        values::interval("--v-range", &options.v_range)?;
    }
    if let Some(threads) = options.threads {
        values::counted("--threads", threads.get(), 1..=MOST_THREADS)?;
    }
    rows(options)?;
    options.model.check()
}

/// What is kept of each period fits into memory.
fn rows(options: &Options) -> Result<(), String> {
    if options.lyapunov {
        return values::counted("--batches", options.batches, 2..=MOST_ROWS);
    }
    let Some(periods) = options.periods else {
        return Ok(());
    };
    // A sweep itself says that its values are too many.
    let values = options.sweep.map_or(1, |_| options.values.max(1));
    let directions = if options.up && options.down { 2 } else { 1 };
    let most = MOST_ROWS / values.saturating_mul(directions).min(MOST_ROWS);
    values::counted("--periods", periods, 0..=most)
}

impl Task<'_> {
    /// Whether there is a motion at all that was asked for, before the first of them is followed.
    fn check(&self) -> Result<(), Failure> {
        self.start()?;
        let options = self.options;
        let on_grid = options.basin || options.phase && options.starts > 0;
        let one = self.system.facts().coordinates.len() == 1;
        if on_grid && one && !options.start.is_empty() {
            let message = "--start would do nothing here: motions start from a grid of x and x'";
            return Err(Failure::Option(message.to_owned()));
        }
        let marked = self.options.mark.map(Some);
        let drives = self.drives().into_iter().chain(marked);
        // Where a value is swept, that of the oscillator may be none.
        if self.options.sweep.is_none() {
            for drive in drives {
                self.flow(drive)?;
            }
        }
        Ok(())
    }

    /// Whether to go on.
    pub fn goes_on(&self) -> bool {
        !self.cancel.is_cancelled()
    }

    /// Applies the map so many times; false if the task was ended before.
    ///
    /// # Errors
    /// If the motion cannot be continued.
    pub fn settle(
        &self,
        map: &mut Stroboscope,
        state: &mut [f64],
        times: usize,
    ) -> Result<bool, FlowError> {
        for _ in 0..times {
            if !self.goes_on() {
                return Ok(false);
            }
            map.map(state)?;
        }
        Ok(true)
    }

    /// Says how far the task is.
    pub fn say(&self, text: impl FnOnce() -> String) {
        // Where another thread has panicked, this is of no use any more.
        if let Ok(mut progress) = self.progress.lock() {
            progress.update(text);
        }
    }

    /// Values of the parameters, at an amplitude if one is given.
    ///
    /// # Errors
    /// If the oscillator has no amplitude.
    pub fn values(&self, drive: Option<f64>) -> Result<Vec<f64>, Failure> {
        let facts = self.system.facts();
        let mut values = vec![0.0; facts.parameters.len()];
        self.system.values(&mut values);
        if let Some(drive) = drive {
            let position = facts.parameters.iter().position(|p| p.name == "drive");
            let index = position.ok_or_else(|| {
                Failure::Option("--drives and --mark need a parameter `drive`".to_owned())
            })?;
            values[index] = drive;
        }
        Ok(values)
    }

    /// The amplitude that is given, or else that of the oscillator; NaN if it has none.
    ///
    /// # Errors
    /// If the oscillator has no amplitude, and one is given.
    pub fn amplitude(&self, drive: Option<f64>) -> Result<f64, Failure> {
        let values = self.values(drive)?;
        let mut parameters = self.system.facts().parameters.iter();
        let position = parameters.position(|parameter| parameter.name == "drive");
        Ok(position.map_or(f64::NAN, |index| values[index]))
    }

    /// The flow, at an amplitude if one is given.
    ///
    /// # Errors
    /// If the values or the tolerance are outside of their ranges.
    pub fn flow(&self, drive: Option<f64>) -> Result<Box<dyn Flow>, Failure> {
        let values = self.values(drive)?;
        Ok(time::at(
            self.system,
            &values,
            self.options.model.frequency(),
            self.options.tolerance,
        )?)
    }

    /// The flow as a map over a period.
    ///
    /// # Errors
    /// As [`Task::flow`].
    pub fn map(&self, drive: Option<f64>) -> Result<Stroboscope, Failure> {
        Ok(Stroboscope::new(self.flow(drive)?))
    }

    /// Number of threads: as many as there are processors, if none was asked for.
    pub fn threads(&self) -> usize {
        let processors = || std::thread::available_parallelism().map_or(1, NonZeroUsize::get);
        self.options
            .threads
            .map_or_else(processors, NonZeroUsize::get)
    }

    /// The state that motions start from.
    ///
    /// # Errors
    /// If it has another number of entries than the oscillator, or one that is not finite.
    pub fn start(&self) -> Result<Vec<f64>, Failure> {
        let order = 2 * self.system.facts().coordinates.len();
        let start = &self.options.start;
        if start.is_empty() {
            return Ok(vec![0.0; order]);
        }
        if start.len() != order || start.iter().any(|x| !x.is_finite()) {
            let message =
                format!("--start needs {order} finite numbers: coordinates, then their rates");
            return Err(Failure::Option(message));
        }
        Ok(start.clone())
    }

    /// The path of the checkpoint, if one was asked for, and the oscillator that it belongs to.
    ///
    /// # Errors
    /// If the file of the oscillator cannot be read.
    pub fn checkpoint(&self) -> Result<Option<(&Path, String)>, Failure> {
        let Some(path) = &self.options.checkpoint else {
            return Ok(None);
        };
        let facts = self.system.facts();
        let (omega, tolerance) = (self.options.model.frequency(), self.options.tolerance);
        // The equation does not say what its laws are.
        let model = &self.options.model;
        let laws = match &model.file {
            Some(path) => model_file::text(path)
                .map_err(|error| Failure::Model(path.clone(), ModelError::Unreadable(error)))?,
            None => format!("continuous {}, alpha {:?}", model.continuous, model.alpha),
        };
        // A section's own text does not say where it is.
        let section = self.options.section;
        let section = section.map_or_else(String::new, |value| format!(", section {value:?}"));
        let identity = format!(
            "hertzian {}, {}, {laws}, with {:?}, omega {omega:?}, tolerance {tolerance:?}{section}",
            env!("CARGO_PKG_VERSION"),
            facts.equation,
            self.values(None)?,
        );
        Ok(Some((path, identity)))
    }

    /// The amplitudes that were asked for; none for that of the oscillator.
    pub fn drives(&self) -> Vec<Option<f64>> {
        if self.options.drives.is_empty() {
            return vec![None];
        }
        self.options.drives.iter().copied().map(Some).collect()
    }

    /// The title of a picture: the oscillator with its values, without those that vary.
    ///
    /// # Errors
    /// If the oscillator has no amplitude, and one is given.
    pub fn title(&self, drive: Option<f64>, varied: &str) -> Result<String, Failure> {
        let facts = self.system.facts();
        let values = self.values(drive)?;
        let named = facts.parameters.iter().zip(values);
        let parameters = named
            .filter(|(parameter, _)| parameter.name != varied)
            .map(|(parameter, value)| format!("{} = {value}", symbol(&parameter.name)));
        let omega = Some(format!("ω = {}", self.options.model.frequency()));
        let omega = omega.filter(|_| varied != "omega");
        let all: Vec<String> = parameters.chain(omega).collect();
        let name = match self.options.model.file {
            Some(_) => facts.name.to_string(),
            None if self.options.model.continuous => format!("Continuous, {}", self.exponent()),
            None => format!("One-sided, {}", self.exponent()),
        };
        Ok(format!("{name}: {}", all.join(", ")))
    }

    /// The exponent, which is no parameter where it is compiled in.
    fn exponent(&self) -> String {
        let facts = self.system.facts();
        if facts
            .parameters
            .iter()
            .any(|parameter| parameter.name == "alpha")
        {
            return "any exponent".to_owned();
        }
        format!("α = {}", self.options.model.alpha)
    }
}

/// The letter of the paper for a parameter of the declared oscillators.
fn symbol(name: &str) -> &str {
    match name {
        "alpha" => "α",
        "zeta" => "ζ",
        "load" => "W",
        "drive" => "A",
        other => other,
    }
}
