//! The subcommand `multipliers`: how far the methods are from the multipliers of the exact orbit, by harmonics and by time.

pub mod charts;
pub mod study;

use std::fmt::Write;
use std::io;
use std::path::{Path, PathBuf};
use std::process::ExitCode;

use clap::Parser;
use hertzian::Cancel;
use hertzian::error::chain;

use crate::program::{self, Ended, Failed};
use crate::response::files;
use crate::response::places;
use crate::response::progress::Progress;
use crate::values;
use study::{Measured, decay, measure, oscillators};

/// Measures every method for Floquet multipliers against the multipliers of the exact orbit, Hill's with all its sortings.
///
/// Writes multipliers.csv, multipliers-harmonics.svg and multipliers-time.svg, and prints the orders that were observed.
#[derive(Debug, Clone, PartialEq, Parser)]
#[command(
    name = "multipliers",
    version,
    after_help = "Examples:\n  \
        hertzian multipliers --folder multipliers\n  \
        hertzian multipliers --harmonics 5 10 20            quicker: three numbers of harmonics\n\n\
        Exit codes: 0 all was measured; 2 bad input, or a file that cannot be written; 3 ended early."
)]
pub struct Options {
    /// Folder for the table and the pictures; made if there is none
    #[arg(long, value_name = "FOLDER", default_value = ".")]
    pub folder: PathBuf,

    /// Harmonics per period of the excitation
    #[arg(long, value_name = "COUNT", num_args = 1.., default_values_t = [5, 7, 10, 14, 20, 28, 40, 56, 80])]
    pub harmonics: Vec<usize>,
}

/// The dense matrices of more would not fit into memory well.
const MOST_HARMONICS: usize = 2999;

/// Does what is asked for, and says by the exit code how it went.
pub fn start(options: &Options) -> ExitCode {
    program::run("hertzian multipliers", false, |cancel, progress| {
        run(options, cancel, progress).map_err(|failure| Failed {
            message: chain(&*failure).to_string(),
            code: 2,
        })
    })
}

/// Measures and writes; returns what is printed. Cancelling ends it after the oscillator at hand.
///
/// # Errors
/// If an orbit is not found or a file cannot be written.
pub fn run(
    options: &Options,
    cancel: &Cancel,
    progress: &mut Progress,
) -> Result<Ended, Box<dyn std::error::Error>> {
    for &harmonics in &options.harmonics {
        values::counted("--harmonics", harmonics, 1..=MOST_HARMONICS)?;
    }
    let folder = &options.folder;
    places::make_folder(folder)
        .map_err(|error| format!("cannot write {}: {error}", folder.display()))?;
    let mut summary = String::new();
    writeln!(
        summary,
        "coefficients of the displacement fall as k to the power"
    )?;
    let mut all = Vec::new();
    let oscillators = oscillators();
    for oscillator in &oscillators {
        if cancel.is_cancelled() {
            break;
        }
        progress.update(|| format!("{}: every method", oscillator.name));
        writeln!(summary, "  {}: {:.2}", oscillator.name, decay(oscillator)?)?;
        all.push((oscillator.name, measure(oscillator, &options.harmonics)?));
    }
    writeln!(summary, "observed orders of the error in the harmonics")?;
    for (name, measured) in &all {
        for (method, order) in study::orders(measured) {
            writeln!(summary, "  {name}, {method}: {order:.1}")?;
        }
    }
    let file = |name: &str| folder.join(name);
    let table = file("multipliers.csv");
    write_table(&table, &all)
        .map_err(|error| format!("cannot write {}: {error}", table.display()))?;
    charts::by_harmonics(&all).write(file("multipliers-harmonics.svg"))?;
    charts::by_time(&all).write(file("multipliers-time.svg"))?;
    Ok(Ended {
        summary,
        complaints: Vec::new(),
        complete: all.len() == oscillators.len(),
    })
}

fn write_table(path: &Path, all: &[(&str, Vec<Measured>)]) -> io::Result<()> {
    files::write_csv(path, |table| {
        table.write_record([
            "oscillator",
            "method",
            "harmonics",
            "error",
            "corrected_error",
            "estimate",
            "microseconds",
        ])?;
        for (name, measured) in all {
            for m in measured {
                table.write_record([
                    (*name).to_owned(),
                    m.method.to_string(),
                    m.harmonics.to_string(),
                    format!("{:.2e}", m.error),
                    format!("{:.2e}", m.corrected),
                    format!("{:.2e}", m.estimate),
                    format!("{:.1}", m.microseconds),
                ])?;
            }
        }
        Ok(())
    })
}
