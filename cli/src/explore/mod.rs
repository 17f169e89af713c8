//! The subcommand `explore`: a page on this machine, to change a model by hand and see its curve, its stability and its motions move.
//!
//! [`server`] takes requests and refuses what is not from the page; [`work`] runs them on threads, of which a newer one cancels the older;
//! [`asked`] turns what a page says into the options of `hertzian response`, so that both compute the same numbers; [`traced`] computes the
//! branches, [`curve`], [`orbits`] and [`exported`] say what is on them, and [`declared`] what a declaration has. [`measured`] fits
//! parameters to measured values.

pub mod asked;
pub mod curve;
pub mod declared;
pub mod exported;
pub mod fault;
pub mod guard;
mod lines;
pub mod measured;
pub mod models;
pub mod options;
pub mod orbits;
mod pages;
pub mod server;
pub mod traced;
pub mod work;

use std::process::ExitCode;

use crate::program;
use options::Options;

/// Serves the page until Ctrl-C, and says by the exit code how it went.
pub fn start(options: &Options) -> ExitCode {
    program::run("hertzian explore", false, |cancel, _| {
        server::run(options, cancel)
    })
}
