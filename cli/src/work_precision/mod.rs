//! The subcommand `work-precision`: error against time of several methods on the same curves.
//!
//! Conventions are those of work-precision diagrams as the `SciML` benchmarks have them: one point for each setting, references far more
//! accurate than anything compared, medians of repeats that take turns, hardware and versions stated, failures shown.

mod chart;
pub mod measure;
pub mod method;
pub mod multipliers;
pub mod options;
mod page;
pub mod peer;
pub mod problem;

use hertzian::Cancel;
use std::fs;
use std::io;
use std::path::{Path, PathBuf};
use std::process::ExitCode;

use hertzian::chart::Page;
use hertzian::error::chain;
use hertzian::export;

use crate::program::{self, Ended};
use crate::response::files;
use crate::response::places;
use crate::response::progress::Progress;
use crate::values;
use measure::{Limits, Measured, measure};
use method::Reference;
use multipliers::{Answer, name};
use options::Options;
use peer::Peer;
use problem::Problem;

/// A problem, and what became of it.
pub struct Section {
    /// The problem.
    pub problem: Problem,
    /// What runs were compared with.
    pub reference: Reference,
    /// Curves.
    pub measured: Vec<Measured>,
    /// Multipliers of the orbit of comparison.
    pub answers: Vec<Answer>,
    /// Other programs.
    pub peers: Vec<Peer>,
}

/// Why nothing came of it.
#[derive(Debug)]
pub enum Failure {
    /// A reference could not be computed.
    Reference(hertzian::Error),
    /// The curve of a problem does not pass its frequency of comparison.
    NoOrbit(&'static str),
    /// An option cannot be used.
    Option(String),
    /// A file could not be written.
    File(PathBuf, io::Error),
}

impl std::fmt::Display for Failure {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::Reference(error) => chain(error).fmt(f),
            Self::NoOrbit(problem) => write!(f, "{problem}: no orbit to compare with"),
            Self::Option(message) => f.write_str(message),
            Self::File(path, error) => write!(f, "cannot write {}: {error}", path.display()),
        }
    }
}

impl std::error::Error for Failure {}

/// Measures, writes, and says by the exit code how it went: 0 done, 2 failed, 3 ended early.
pub fn start(options: &Options) -> ExitCode {
    program::run(
        "hertzian work-precision",
        options.quiet,
        |cancel, progress| {
            let mut problems = problem::all();
            problems.retain(|problem| {
                options.only.is_empty() || options.only.iter().any(|id| id == problem.id)
            });
            let sections = run(options, problems, cancel, progress)?;
            Ok(Ended {
                summary: summary(options, &sections),
                complaints: Vec::new(),
                complete: !cancel.is_cancelled(),
            })
        },
    )
}

/// Measures the problems and writes the results of each as soon as it is done. Cancelling ends it.
///
/// # Errors
/// If a reference cannot be computed, or a file cannot be written.
pub fn run(
    options: &Options,
    problems: Vec<Problem>,
    cancel: &Cancel,
    progress: &mut Progress,
) -> Result<Vec<Section>, Failure> {
    check(options).map_err(Failure::Option)?;
    places::make_folder(&options.out).map_err(failed(&options.out))?;
    let limits = Limits {
        repeats: options.repeats.get(),
        patience: options.patience,
        budget: options.budget / problems.len().max(1) as f64,
    };
    let machine = machine();
    let mut sections = Vec::new();
    for problem in problems {
        if cancel.is_cancelled() {
            break;
        }
        let reference = method::reference(&problem).map_err(Failure::Reference)?;
        let reference = reference.ok_or(Failure::NoOrbit(problem.id))?;
        let measured = measure(&problem, &reference, limits, &mut |done, all| {
            progress.update(|| format!("{}: {done} of {all} runs", problem.title));
            !cancel.is_cancelled()
        });
        let section = Section {
            answers: multipliers::measure(&problem, &reference),
            peers: peer::on(&problem, &reference),
            problem,
            reference,
            measured,
        };
        let name = section.problem.id.replace('.', "_");
        let svg = options.out.join(name).with_extension("svg");
        export::write(&svg, picture(&section).to_svg()).map_err(failed(&svg))?;
        sections.push(section);
        write(options, &sections, &machine)?;
    }
    Ok(sections)
}

/// A file cannot be written.
fn failed(path: &Path) -> impl FnOnce(io::Error) -> Failure {
    let path = path.to_path_buf();
    move |error| Failure::File(path, error)
}

/// The charts of a problem, each below the last.
pub fn picture(section: &Section) -> Page {
    let Section {
        problem,
        reference,
        measured,
        answers,
        peers,
    } = section;
    let mut page = Page::new(1);
    if !reference.folds.is_empty() {
        let label = "error of ω at the fold of largest amplitude";
        let fold = chart::chart(problem, measured, label, |one| one.fold);
        page = page.chart(chart::with_peers(fold, measured, peers, |peer| peer.fold));
    }
    let label = "relative error of peak-to-peak of one orbit";
    let size = chart::chart(problem, measured, label, |one| one.peak_to_peak);
    let size = chart::with_peers(size, measured, peers, |peer| peer.peak_to_peak);
    page.chart(size).chart(chart::multipliers(problem, answers))
}

/// Writes what is known so far.
fn write(options: &Options, sections: &[Section], machine: &str) -> Result<(), Failure> {
    let csv = options.out.join("work_precision.csv");
    write_csv(&csv, sections, machine).map_err(failed(&csv))?;
    let csv = options.out.join("multipliers.csv");
    write_multipliers(&csv, sections).map_err(failed(&csv))?;
    let html = options.out.join("index.html");
    export::write(&html, page::html(sections, machine)).map_err(failed(&html))
}

/// What the numbers must be.
fn check(options: &Options) -> Result<(), String> {
    values::positive("--patience", options.patience)?;
    values::positive("--budget", options.budget)
}

fn write_csv(path: &Path, sections: &[Section], machine: &str) -> io::Result<()> {
    files::write_csv(path, |writer| {
        writer.write_record([
            "problem",
            "method",
            "setting",
            "seconds_median",
            "seconds_least",
            "seconds_most",
            "error_fold",
            "error_peak_to_peak",
            "failure",
            "machine",
        ])?;
        let number =
            |value: Option<f64>| value.map_or_else(String::new, |value| format!("{value:?}"));
        for section in sections {
            for one in &section.measured {
                writer.write_record([
                    section.problem.id.to_owned(),
                    one.family.name().to_owned(),
                    one.setting.to_string(),
                    number(one.median()),
                    number(one.seconds.first().copied()),
                    number(one.seconds.last().copied()),
                    number(one.fold),
                    number(one.peak_to_peak),
                    one.failure.clone().unwrap_or_default(),
                    machine.to_owned(),
                ])?;
            }
            for peer in &section.peers {
                let [median, least, most] = peer.seconds.map(|seconds| number(Some(seconds)));
                writer.write_record([
                    section.problem.id.to_owned(),
                    peer.name.clone(),
                    peer.setting.clone(),
                    median,
                    least,
                    most,
                    number(peer.fold),
                    number(peer.peak_to_peak),
                    peer.failure.clone().unwrap_or_default(),
                    format!("measured {}", peer.measured),
                ])?;
            }
        }
        Ok(())
    })
}

fn write_multipliers(path: &Path, sections: &[Section]) -> io::Result<()> {
    files::write_csv(path, |writer| {
        writer.write_record([
            "problem",
            "method",
            "setting",
            "seconds_median",
            "error",
            "failure",
        ])?;
        for Section {
            problem, answers, ..
        } in sections
        {
            for one in answers {
                writer.write_record([
                    problem.id.to_owned(),
                    name(one.method).to_owned(),
                    one.setting.clone(),
                    format!("{:?}", one.seconds),
                    format!("{:?}", one.error),
                    one.failure.clone().unwrap_or_default(),
                ])?;
            }
        }
        Ok(())
    })
}

/// Processor, versions and profile.
fn machine() -> String {
    let rustc = std::process::Command::new("rustc")
        .arg("--version")
        .output();
    let rustc = rustc
        .ok()
        .and_then(|said| String::from_utf8(said.stdout).ok());
    let rustc = rustc.as_deref().map_or("", str::trim);
    let profile = if cfg!(debug_assertions) {
        "with assertions"
    } else {
        "without assertions"
    };
    let info = fs::read_to_string("/proc/cpuinfo").unwrap_or_default();
    let name = info
        .lines()
        .find_map(|line| line.strip_prefix("model name")?.split_once(": "));
    let name = name.map_or(std::env::consts::ARCH, |(_, name)| name);
    let set = hertzian::power::Instructions::in_use().name();
    format!(
        "{name}, {set}, one thread, hertzian {} {profile}, {rustc}",
        env!("CARGO_PKG_VERSION")
    )
}

fn summary(options: &Options, sections: &[Section]) -> String {
    let lines = sections
        .iter()
        .map(|section| format!("{}. {}\n", section.problem.title, page::verdict(section)));
    let written = options.out.join("index.html");
    lines.collect::<String>() + &format!("written  {}\n", written.display())
}
