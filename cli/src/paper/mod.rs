//! The subcommand `paper`: every figure and the table of Wang, Zhang, Ying and Pang (2021), Appl. Sci. 11, 7722, beside exact values.

mod chaos;
mod curves;
mod cycles;
pub mod exact;
pub mod figure;
pub mod figures;
pub mod options;
mod page;
mod resonances;
pub mod run;

use std::fmt::Write;
use std::process::ExitCode;

use crate::program::{self, Ended};
use figure::Value;
use options::Options;
use run::{Drawn, run};

/// Does what is asked for, and says by the exit code how it went: 0 all was drawn, 2 bad input or a file that
/// cannot be written, 3 a figure failed or was not reached, or a value is missing or not the exact one.
pub fn start(options: &Options) -> ExitCode {
    program::run("hertzian paper", options.quiet, |cancel, progress| {
        let drawn = run(options, cancel, progress)?;
        let ended_early = cancel.is_cancelled();
        let complaints = complaints(&drawn, ended_early);
        Ok(Ended {
            summary: summary(options, &drawn),
            complete: complaints.is_empty() && !ended_early,
            complaints,
        })
    })
}

/// Figures that failed; and values that are missing or not the exact ones, unless the computation was ended early.
pub fn complaints(drawn: &[Drawn], ended_early: bool) -> Vec<String> {
    let mut complaints = Vec::new();
    for one in drawn {
        let id = one.figure.id;
        match &one.drawing {
            Err(error) => complaints.push(format!("{id}: {error}")),
            Ok(drawing) if !ended_early => {
                let faults = drawing.values.iter().filter_map(Value::fault);
                complaints.extend(faults.map(|fault| format!("{id}: {fault}")));
            }
            Ok(_) => {}
        }
    }
    complaints
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
