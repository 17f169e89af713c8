//! The subcommand `response`: traces a branch of periodic orbits, draws it, and says what is on it.

pub mod backbone;
pub mod bifurcations;
pub mod boundary;
pub mod completed;
pub mod covered;
pub mod files;
pub mod model_file;
pub mod models;
pub mod near;
pub mod options;
pub mod panels;
pub mod places;
pub mod progress;
pub mod resumed;
pub mod run;
pub mod search;
pub mod sensitive;
pub mod structure;
pub mod summary;
pub(crate) mod value;

use std::process::ExitCode;

use crate::program::{self, Ended, Failed};
use options::Options;
use run::run;

/// Does what is asked for, and says by the exit code how it went.
pub fn start(options: &Options) -> ExitCode {
    program::run("hertzian response", options.quiet, |cancel, progress| {
        let outcome = run(options, cancel, progress).map_err(|failure| Failed {
            message: failure.to_string(),
            code: failure.exit_code(),
        })?;
        Ok(Ended {
            summary: outcome.summary,
            complaints: outcome.warnings,
            complete: outcome.complete,
        })
    })
}
