//! The subcommand `fit`: parameters of an oscillator from measured curves.

pub mod options;
pub mod run;

use std::process::ExitCode;

use crate::program;

/// Does what is asked for, and says by the exit code how it went.
pub fn start(options: &options::Options) -> ExitCode {
    program::run("hertzian fit", options.quiet, |cancel, progress| {
        run::run(options, cancel, progress)
    })
}
