//! The program `paper`: every figure and the table of Wang, Zhang, Ying and Pang (2021), Appl. Sci. 11, 7722, beside exact values.

mod chaos;
mod curves;
mod cycles;
mod exact;
pub mod figure;
pub mod figures;
pub mod options;
mod page;
mod resonances;
pub mod run;

use std::fmt::Write as _;
use std::io::{self, IsTerminal, Write};
use std::process::ExitCode;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

use clap::Parser;

use crate::response::progress::Progress;
use options::Options;
use run::{Drawn, run};

/// Reads the command line, does what it asks for, and says by the exit code how it went: 0 all was drawn, 2 bad input or a file that
/// cannot be written, 3 a figure failed or was not reached.
pub fn main() -> ExitCode {
    let options = Options::parse();
    let interrupted = Arc::new(AtomicBool::new(false));
    let flag = Arc::clone(&interrupted);
    // Without a handler, Ctrl-C ends the program at once: a nuisance, but no reason not to compute.
    let _ = ctrlc::set_handler(move || {
        if flag.swap(true, Ordering::Relaxed) {
            std::process::exit(130);
        }
    });
    let shown = !options.quiet && io::stderr().is_terminal();
    let mut progress = Progress::new(shown);
    let outcome = run(&options, &interrupted, &mut progress);
    progress.end();
    match outcome {
        Ok(drawn) => {
            let mut complete = !interrupted.load(Ordering::Relaxed);
            for Drawn {
                figure, drawing, ..
            } in &drawn
            {
                if let Err(error) = drawing {
                    complain(&format!("{}: {error}", figure.id));
                    complete = false;
                }
            }
            if !options.quiet {
                // Whoever reads the output may have stopped reading: not an error.
                let _ = io::stdout().write_all(summary(&options, &drawn).as_bytes());
            }
            ExitCode::from(if complete { 0 } else { 3 })
        }
        Err(failure) => {
            complain(&failure.to_string());
            ExitCode::from(2)
        }
    }
}

/// A line for each figure: its time, and the largest difference from an exact value.
fn summary(options: &Options, drawn: &[Drawn]) -> String {
    let mut text = String::new();
    for Drawn {
        figure,
        drawing,
        elapsed,
    } in drawn
    {
        let values = drawing.iter().flat_map(|drawing| &drawing.values);
        let (missing, errors): (Vec<_>, Vec<_>) = values.partition(|value| value.ours.is_none());
        let errors: Vec<f64> = errors.iter().filter_map(|value| value.error()).collect();
        let largest = errors.iter().copied().fold(0.0, f64::max);
        let time = 1e3 * elapsed.as_secs_f64();
        // Writing to a string does not fail.
        let _ = write!(text, "{:<8} {time:>7.0} ms", figure.id);
        if !errors.is_empty() {
            let count = errors.len();
            let _ = write!(
                text,
                "  {count} exact values, largest difference {largest:.0e}"
            );
        }
        if !missing.is_empty() {
            let _ = write!(text, "  {} not found", missing.len());
        }
        text.push('\n');
    }
    text + &format!("written  {}\n", options.out.join("index.html").display())
}

fn complain(message: &str) {
    let _ = writeln!(io::stderr(), "paper: {message}");
}
