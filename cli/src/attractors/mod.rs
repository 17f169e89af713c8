//! The subcommand `attractors`: what motions settle to, as bifurcation diagrams, basins, Lyapunov exponents, phase portraits and
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

use std::process::ExitCode;

use crate::program::{self, Ended};
use options::Options;
use run::{Outcome, run};

/// Does what is asked for, and says by the exit code how it went.
pub fn start(options: &Options) -> ExitCode {
    program::run("hertzian attractors", options.quiet, |cancel, progress| {
        let Outcome { summary, complete } = run(options, cancel, progress)?;
        let early = "ended before it was complete; what was computed is written";
        Ok(Ended {
            summary,
            complaints: (!complete).then(|| early.to_owned()).into_iter().collect(),
            complete,
        })
    })
}
