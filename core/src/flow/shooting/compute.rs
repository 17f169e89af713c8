//! One orbit, or a branch of them, from a guess.

use std::ops::ControlFlow;
use std::time::Instant;

use super::companion::Companion;
use super::cycle::{Cycle, CycleBranch};
use super::run::Run;
use super::setting::Setting;
use super::start::{First, Guess, first};
use crate::error::Error;
use crate::system::Variable;

/// The orbit near a guess where what is varied has a value.
///
/// # Errors
/// If none is found.
pub(super) fn cycle(setting: &Setting<'_>, guess: &Guess, value: f64) -> Result<Cycle, Error> {
    let found = first(setting, guess, value, setting.omega_at(value))?;
    let (
        mut run,
        First {
            mut equations,
            u,
            iterations,
            ..
        },
    ) = run(setting, found, value, value)?;
    let read = run.read(&mut equations, &u);
    let (cycle, _) = read.map_err(|reason| Error::Motion {
        parameter: value,
        reason,
    })?;
    Ok(Cycle {
        iterations,
        ..cycle
    })
}

/// The branch from near a guess at the first value to the second.
///
/// # Errors
/// If there is no first orbit.
pub(super) fn branch(
    setting: &Setting<'_>,
    guess: &Guess,
    [from, to]: [f64; 2],
    visit: &mut dyn FnMut(&Cycle) -> ControlFlow<()>,
) -> Result<CycleBranch, Error> {
    let started = Instant::now();
    let omega = match setting.variable {
        Variable::Omega => (from * to).sqrt(),
        Variable::Parameter(_) => setting.omega,
    };
    let found = first(setting, guess, from, omega)?;
    let (
        mut run,
        First {
            mut equations, u, ..
        },
    ) = run(setting, found, from, to)?;
    let options = setting.follow(from, to, equations.frame.ratio);
    let end = run.follow(&mut equations, u, options, visit)?;
    let Run {
        cycles,
        events,
        turns,
        statistics,
        work,
        ..
    } = run;
    Ok(CycleBranch {
        varied: setting.varied.clone(),
        cycles,
        events,
        turns,
        end,
        statistics,
        work,
        elapsed: started.elapsed(),
    })
}

/// A run that begins at a solution.
fn run<'r, 'a>(
    setting: &'r Setting<'a>,
    found: First<'a>,
    from: f64,
    to: f64,
) -> Result<(Run<'r, 'a>, First<'a>), Error> {
    let First {
        equations, size, ..
    } = &found;
    let frame = equations.frame.clone();
    let companion = Companion::new(setting, equations.span, frame, *size)?;
    let options = setting.follow(from, to, equations.frame.ratio).newton;
    Ok((Run::new(setting, options, companion, *size), found))
}
