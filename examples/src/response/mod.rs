//! The program `response`: traces a branch of periodic orbits, draws it, and says what is on it.

pub mod backbone;
pub mod bifurcations;
pub mod boundary;
pub mod files;
pub mod model_file;
pub mod models;
pub mod options;
pub mod progress;
pub mod records;
pub mod run;
pub mod summary;

use std::io::{self, IsTerminal, Write};
use std::process::ExitCode;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

use clap::Parser;

use options::Options;
use progress::Progress;
use run::{Outcome, run};

/// Reads the command line, does what it asks for, and says by the exit code how it went.
pub fn main() -> ExitCode {
    // Bad usage ends here, with clap's message and exit code 2.
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
        Ok(Outcome {
            summary,
            warnings,
            complete,
        }) => {
            for warning in warnings {
                complain(&warning);
            }
            if !options.quiet {
                // Whoever reads the output may have stopped reading: not an error.
                let _ = io::stdout().write_all(summary.as_bytes());
            }
            ExitCode::from(if complete { 0 } else { 3 })
        }
        Err(failure) => {
            complain(&failure.to_string());
            ExitCode::from(failure.exit_code())
        }
    }
}

fn complain(message: &str) {
    let _ = writeln!(io::stderr(), "response: {message}");
}
