//! What every program does around its work: Ctrl-C, a line that shows how far it is, what is printed, and the exit code.

use std::error::Error;
use std::io::{self, IsTerminal, Write};
use std::process::ExitCode;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

use crate::response::progress::Progress;

/// What came of the work.
#[derive(Debug, Clone, PartialEq)]
pub struct Ended {
    /// What is printed.
    pub summary: String,
    /// What is said on standard error.
    pub complaints: Vec<String>,
    /// Whether everything was done that was asked for.
    pub complete: bool,
}

/// Why nothing came of it.
#[derive(Debug, Clone, PartialEq)]
pub struct Failed {
    /// What is said on standard error.
    pub message: String,
    /// The exit code.
    pub code: u8,
}

impl<E: Error> From<E> for Failed {
    fn from(error: E) -> Self {
        Self {
            message: error.to_string(),
            code: 2,
        }
    }
}

/// Works, prints, and says by the exit code how it went: 0 done, 2 failed or what the failure says, 3 not complete. A first
/// Ctrl-C sets the flag, a second one ends the program at once.
pub fn run(
    name: &str,
    quiet: bool,
    work: impl FnOnce(&AtomicBool, &mut Progress) -> Result<Ended, Failed>,
) -> ExitCode {
    let interrupted = Arc::new(AtomicBool::new(false));
    let flag = Arc::clone(&interrupted);
    // Without a handler, Ctrl-C ends the program at once: a nuisance, but no reason not to compute.
    let _ = ctrlc::set_handler(move || {
        if flag.swap(true, Ordering::Relaxed) {
            std::process::exit(130);
        }
    });
    let mut progress = Progress::new(!quiet && io::stderr().is_terminal());
    let outcome = work(&interrupted, &mut progress);
    progress.end();
    // Whoever reads the output may have stopped reading: not an error.
    let complain = |message: &str| {
        let _ = writeln!(io::stderr(), "{name}: {message}");
    };
    match outcome {
        Ok(ended) => {
            for complaint in &ended.complaints {
                complain(complaint);
            }
            if !quiet {
                let _ = io::stdout().write_all(ended.summary.as_bytes());
            }
            ExitCode::from(if ended.complete { 0 } else { 3 })
        }
        Err(failed) => {
            complain(&failed.message);
            ExitCode::from(failed.code)
        }
    }
}
