//! The program `attractors`: what motions settle to, as bifurcation diagrams, basins, Lyapunov exponents, phase portraits and
//! time histories.

pub mod basin;
pub mod figures;
pub mod history;
pub mod lyapunov;
pub mod options;
pub mod output;
pub mod phase;
pub mod run;
pub mod sweep;

use std::io::{self, IsTerminal, Write};
use std::process::ExitCode;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

use clap::Parser;

use crate::response::progress::Progress;
use options::Options;
use run::{Outcome, run};

/// Reads the command line, does what it asks for, and says by the exit code how it went.
pub fn main() -> ExitCode {
    // Bad usage ends here, with clap's message and exit code 2.
    let options = Options::parse_from(figures::expanded(std::env::args_os()));
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
        Ok(Outcome { summary, complete }) => {
            if !complete {
                complain("ended before it was complete; what was computed is written");
            }
            if !options.quiet {
                // Whoever reads the output may have stopped reading: not an error.
                let _ = io::stdout().write_all(summary.as_bytes());
            }
            ExitCode::from(if complete { 0 } else { 3 })
        }
        Err(failure) => {
            complain(&failure.to_string());
            ExitCode::from(2)
        }
    }
}

fn complain(message: &str) {
    let _ = writeln!(io::stderr(), "attractors: {message}");
}
