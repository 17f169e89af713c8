//! The subcommand `study`: thousands of variants of an oscillator, on threads or in parts, as one table.

pub mod options;
#[cfg(feature = "mpi")]
mod ranks;
mod read;
pub mod run;

use std::process::ExitCode;

use crate::program;

/// Does what is asked for, and says by the exit code how it went.
pub fn start(options: &options::Options) -> ExitCode {
    program::run("hertzian study", options.quiet, |cancel, progress| {
        run::run(options, cancel, progress)
    })
}
