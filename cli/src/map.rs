//! The subcommand `map`: which solutions exist over two parameters, as a picture of cells, a table and a summary.

use std::ops::ControlFlow;
use std::path::{Path, PathBuf};
use std::process::ExitCode;

use clap::{Parser, ValueEnum};
use hertzian::bifurcation::{Map, Reason};
use hertzian::chart::Chart;
use hertzian::{Cancel, FrequencyResponse, Shooting, Stage, System, export};

use crate::misplaced::{Given, count};
use crate::model::{FREQUENCY_VARIES, ModelOptions};
use crate::program::{self, Ended, Failed};
use crate::range::RangeOptions;
use crate::response::files::page;
use crate::response::model_file::Varied;
use crate::response::models::model;
use crate::response::places;
use crate::response::progress::Progress;
use crate::response::run::Failure;
use crate::values;

/// More values of one parameter would take longer than anyone waits.
const MOST: usize = 10_000;

/// Looks for all periodic solutions over two parameters and draws how many are stable, how large these are, or what can be said of all.
///
/// For each value of the second parameter the range of the first one is searched: branches from both ends, what begins on them, and what
/// motions from several states settle to at every value. What none of these meets is not found. Orbits are computed by shooting.
#[derive(Debug, Clone, PartialEq, Parser)]
#[command(
    name = "map",
    version,
    allow_negative_numbers = true,
    after_help = "Examples:\n  \
        hertzian map --alpha 1 --to 1.4 --over drive --low 0.02 --high 0.2\n  \
        hertzian map --over zeta --low 0.01 --high 0.1 --what largest --csv map.csv\n  \
        hertzian map --model gear-pair --sweep torque --from 0.05 --to 0.5 --over omega --low 0.5 --high 1.5\n\n\
        Exit codes: 0 every cell was looked at; 2 bad input; 3 some were not, or have nothing (what was computed is written)."
)]
pub struct Options {
    /// The oscillator
    #[command(flatten)]
    pub model: ModelOptions,

    /// What varies, and how far
    #[command(flatten)]
    pub range: RangeOptions,

    /// So many values of it, evenly, with both ends; one is in the middle
    #[arg(long, value_name = "COUNT", default_value_t = 20, value_parser = count)]
    pub count: usize,

    /// What varies from row to row: another one
    #[arg(long, value_name = "NAME")]
    pub over: String,

    /// Lower end of its range
    #[arg(long, value_name = "VALUE", allow_hyphen_values = true)]
    pub low: f64,

    /// Upper end of its range
    #[arg(long, value_name = "VALUE", allow_hyphen_values = true)]
    pub high: f64,

    /// So many values of it, evenly, with both ends; one is in the middle
    #[arg(long, value_name = "COUNT", default_value_t = 10, value_parser = count)]
    pub rows: usize,

    /// What is drawn
    #[arg(long, value_enum, default_value_t = What::Stable)]
    pub what: What,

    /// The picture
    #[arg(long, value_name = "FILE", default_value = "map.svg")]
    pub svg: PathBuf,

    /// Write one row per cell to this file
    #[arg(long, value_name = "FILE")]
    pub csv: Option<PathBuf>,

    /// Write everything to this file
    #[arg(long, value_name = "FILE")]
    pub json: Option<PathBuf>,

    /// Say nothing but errors
    #[arg(long)]
    pub quiet: bool,
}

/// What is drawn of each cell.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub enum What {
    /// The number of stable orbits
    Stable,
    /// The largest peak-to-peak of stable orbits
    Largest,
    /// Whether all orbits are stable, some, or none, and whether motions settle
    Verdict,
}

impl What {
    fn chart(self, map: &Map) -> Chart {
        match self {
            Self::Stable => map.chart_of_stable(),
            Self::Largest => map.chart_of_largest(),
            Self::Verdict => map.chart_of_verdicts(),
        }
    }
}

impl Options {
    /// What was given and would do nothing.
    pub fn fault(&self, given: &Given<'_>) -> Option<String> {
        if let Some(fault) = self.model.fault(given) {
            return Some(fault);
        }
        for (option, name, ends) in [
            ("sweep", &self.range.sweep, "--from and --to"),
            ("over", &self.over, "--low and --high"),
        ] {
            let short = ["alpha", "zeta", "load", "drive"].contains(&name.as_str());
            let set = self.model.set.iter().any(|(set, _)| set == name);
            if set || (short && given.has(name)) {
                return Some(format!(
                    "--{option} {name} takes the place of the value of {name}: {ends} say where it begins and ends"
                ));
            }
        }
        None
    }

    /// Whether the frequency is not held.
    fn over_frequency(&self) -> bool {
        self.range.over_frequency() || self.over == "omega"
    }

    /// The files that are written.
    fn paths(&self) -> impl Iterator<Item = &Path> {
        let optional = self.csv.iter().chain(&self.json);
        std::iter::once(&self.svg)
            .chain(optional)
            .map(PathBuf::as_path)
    }

    /// What the library does not check.
    ///
    /// # Errors
    /// What cannot be used.
    fn check(&self) -> Result<(), Failure> {
        self.numbers().map_err(Failure::Option)?;
        for path in self.paths() {
            places::check(path).map_err(|error| Failure::File(path.to_path_buf(), error))?;
        }
        let read = self.model.path();
        if let Some(path) = places::shared(read.into_iter().chain(self.paths())) {
            let message = format!("{} is asked for more than once", path.display());
            return Err(Failure::Option(message));
        }
        Ok(())
    }

    fn numbers(&self) -> Result<(), String> {
        if self.over_frequency() && self.model.omega.is_some() {
            return Err(FREQUENCY_VARIES.to_owned());
        }
        if self.range.sweep == self.over {
            return Err(format!(
                "--over {}: it varies along a row, by --sweep; two different ones make a map",
                self.over
            ));
        }
        values::finite("--from", self.range.from)?;
        values::finite("--to", self.range.to)?;
        values::interval("--low and --high", &[self.low, self.high])?;
        values::counted("--count", self.count, 1..=MOST)?;
        values::counted("--rows", self.rows, 1..=MOST)?;
        self.model.check()
    }

    /// The oscillator, with values for what varies.
    ///
    /// # Errors
    /// If it is at fault.
    fn system(&self) -> Result<Box<dyn System>, Failure> {
        let mut options = self.model.clone();
        let (mut varied, mut value) = (&self.range.sweep, self.range.from);
        if options.file.is_none() && self.over == "alpha" {
            (varied, value) = (&self.over, self.low);
        } else if options.file.is_some() && self.over != "omega" {
            options.set.push((self.over.clone(), self.low));
        }
        let varied = Varied {
            name: varied,
            value,
        };
        model(&options, varied).map_err(|error| {
            let path = options.file.clone().unwrap_or_default();
            Failure::Model(path, error)
        })
    }

    /// The name in the title: what the options say of an oscillator that has its own.
    fn name(&self, map: &Map) -> String {
        if self.model.file.is_some() {
            return map.model.name.clone();
        }
        let kind = if self.model.loses_contact() {
            "One-sided"
        } else {
            "Continuous"
        };
        let mut parameters = map.model.parameters.iter();
        if parameters.any(|parameter| parameter.name == "alpha") {
            return kind.to_owned();
        }
        format!("{kind}, α = {}", self.model.alpha)
    }
}

/// Does what is asked for, and says by the exit code how it went.
pub fn start(options: &Options) -> ExitCode {
    program::run("hertzian map", options.quiet, |cancel, progress| {
        run(options, cancel, progress).map_err(|failure| Failed {
            message: failure.to_string(),
            code: failure.exit_code(),
        })
    })
}

/// Computes the map, writes the files and sums up. Cancelling ends it before the row at hand.
///
/// # Errors
/// If the options are not usable, or a file cannot be written.
pub fn run(options: &Options, cancel: &Cancel, progress: &mut Progress) -> Result<Ended, Failure> {
    let options = &Options {
        model: options.model.resolved().map_err(Failure::Option)?,
        ..options.clone()
    };
    options.check()?;
    let system = options.system()?;
    let mut request = FrequencyResponse::of(&*system)
        .by(Shooting::new())
        .from(options.range.from)
        .to(options.range.to)
        .cancel(cancel);
    if !options.range.over_frequency() {
        request = request.vary(&options.range.sweep);
        if !options.over_frequency() {
            request = request.omega(options.model.frequency());
        }
    }
    let along = evenly([options.range.from, options.range.to], options.count);
    let others = evenly([options.low, options.high], options.rows);
    let (mut rows, mut orbits) = (0, 0);
    let map = request.map_with(&along, &options.over, &others, |done| {
        if done.stage == Stage::Map {
            (rows, orbits) = (done.done, 0);
        } else {
            orbits += 1;
        }
        progress.update(|| format!("row {} of {}: {orbits} orbits", rows + 1, others.len()));
        ControlFlow::Continue(())
    })?;
    write(options, &map)?;
    Ok(ended(options, &map))
}

/// So many values from one end to the other. What is between has twelve digits, as 0.7 and not 0.7000000000000001.
fn evenly([from, to]: [f64; 2], count: usize) -> Vec<f64> {
    let between = |part: f64| {
        let value = (1.0 - part) * from + part * to;
        let short = format!("{value:.11e}").parse().unwrap_or(value);
        short.clamp(from.min(to), from.max(to))
    };
    if count == 1 {
        return vec![between(0.5)];
    }
    let part = |index: usize| index as f64 / (count - 1) as f64;
    let inner = (1..count - 1).map(|index| between(part(index)));
    [from].into_iter().chain(inner).chain([to]).collect()
}

/// Writes the files that were asked for.
fn write(options: &Options, map: &Map) -> Result<(), Failure> {
    if let Some(path) = &options.csv {
        map.write_csv(path)?;
    }
    if let Some(path) = &options.json {
        map.write(path)?;
    }
    let mut named = map.clone();
    named.model.name = options.name(map);
    let svg = options.what.chart(&named).to_svg();
    let failed = |error| Failure::File(options.svg.clone(), error);
    export::write(&options.svg, svg).map_err(failed)
}

/// Writes a map that was read from a file: all its charts, and its table.
///
/// # Errors
/// Why one cannot be written.
pub fn write_again(map: &Map, svg: Option<&Path>, csv: Option<&Path>) -> Result<(), String> {
    let charts = vec![
        map.chart_of_stable(),
        map.chart_of_largest(),
        map.chart_of_verdicts(),
    ];
    let texts = svg.map(|path| (path, page(charts)));
    let texts = texts
        .into_iter()
        .chain(csv.map(|path| (path, map.to_csv())));
    for (path, text) in texts {
        export::write(path, text)
            .map_err(|error| format!("cannot write {}: {error}", path.display()))?;
    }
    Ok(())
}

/// What is said in the end.
fn ended(options: &Options, map: &Map) -> Ended {
    let reasons = || map.cells.iter().filter_map(|cell| cell.reason.as_ref());
    let mut complaints = Vec::new();
    if reasons().any(|reason| *reason == Reason::Interrupted) {
        complaints.push("interrupted: the rows until then are kept".to_owned());
    }
    let mut failed = reasons().filter(|reason| **reason != Reason::Interrupted);
    if let Some(first) = failed.next() {
        let count = 1 + failed.count();
        complaints.push(format!("nothing is known of {count} cells, first: {first}"));
    }
    let written = options.paths().map(|path| path.display().to_string());
    let written: Vec<String> = written.collect();
    Ended {
        summary: format!("{map}written: {}\n", written.join(", ")),
        complete: complaints.is_empty(),
        complaints,
    }
}
