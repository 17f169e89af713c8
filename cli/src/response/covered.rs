//! What covers the range besides the branch that was asked for: further branches, and what was searched.

use std::fmt::{self, Write};
use std::ops::ControlFlow;

use hertzian::attractors::basin::Fate;
use hertzian::bifurcation::{Bifurcations, Diagram, Reason, Searched, Settling};
use hertzian::export;
use hertzian::{ContactEquation, Error, FrequencyResponse, OrbitMethod, Progress, Shooting, Stop};

use super::bifurcations::describe;
use super::options::{By, Options};
use super::value::in_diagram;

/// How the range of a request is searched, unless one branch alone is wanted.
///
/// # Errors
/// If the request is not usable.
pub fn settling<M: OrbitMethod>(
    options: &Options,
    request: &FrequencyResponse<M>,
) -> Result<Option<Settling>, Error> {
    if options.one_branch {
        return Ok(None);
    }
    let patience = match options.patience {
        Some(periods) => periods,
        None => request.transient_periods()?,
    };
    let settling = Settling::new()
        .values(options.values)
        .starts(options.starts);
    Ok(Some(settling.patience(patience)))
}

/// The branches of a request that cover its range; the first is the one that was asked for, and alone where that is wanted, or where
/// the bifurcations of the range are followed anyway.
///
/// # Errors
/// As that of the request.
pub fn find<M: OrbitMethod>(
    options: &Options,
    request: FrequencyResponse<M>,
    visit: impl FnMut(Progress<'_>) -> ControlFlow<()>,
) -> Result<Diagram, Error> {
    let settling = settling(options, &request)?;
    let all = Bifurcations::starting_with(request);
    let all = all.depth(0).margin(0.0);
    let elsewhere = options.bifurcations || options.track.is_some();
    match settling.filter(|_| !elsewhere) {
        Some(settling) => all.cover(settling).run_with(visit),
        None => all.run_with(visit),
    }
}

/// The same by the method that was asked for, or else by the one that fits.
///
/// # Errors
/// As that of the request.
pub fn by_method(
    options: &Options,
    request: FrequencyResponse,
    visit: impl FnMut(Progress<'_>) -> ControlFlow<()>,
) -> Result<Diagram, Error> {
    match options.method() {
        None => find(options, request, visit),
        Some(By::Balance) => find(options, request.by(options.balance()), visit),
        Some(By::Shooting) => find(options, request.by(Shooting::new()), visit),
        Some(By::ContactEquation) => find(options, request.by(ContactEquation::new()), visit),
    }
}

/// Whether the range is covered, and nothing was interrupted.
pub fn is_complete(diagram: &Diagram) -> bool {
    let interrupted = |stop: Option<Stop>| stop == Some(Stop::Interrupted);
    let mut branches = diagram.branches.iter().map(|branch| &branch.branch);
    let ended =
        branches.any(|branch| interrupted(branch.begin) || interrupted(Some(branch.stopped)));
    let reasons = diagram.missed.iter().map(|(_, reason)| reason);
    let mut reasons = reasons.chain(diagram.omitted.iter().map(|omitted| &omitted.reason));
    diagram.uncovered.is_empty() && !ended && !reasons.any(|reason| *reason == Reason::Interrupted)
}

/// For people; nothing where the first branch is all.
pub fn summary(diagram: &Diagram, varied: &str) -> String {
    let mut text = String::new();
    // Writing to a string does not fail.
    let _ = write_branches(&mut text, diagram);
    let _ = write_search(&mut text, diagram, varied);
    text
}

fn write_branches(text: &mut String, diagram: &Diagram) -> fmt::Result {
    if diagram.branches.len() > 1 {
        for (number, branch) in diagram.branches.iter().enumerate() {
            describe(text, number + 1, branch)?;
        }
    }
    Ok(())
}

/// What was searched, what was not found, and where there is nothing.
///
/// # Errors
/// None: writing to a string does not fail.
pub fn write_search(text: &mut String, diagram: &Diagram, varied: &str) -> fmt::Result {
    for searched in &diagram.searched {
        let value = in_diagram(diagram, export::rounded(searched.value, 6));
        writeln!(
            text,
            "searched   {varied} {value}: {}",
            describe_search(searched)
        )?;
    }
    for (value, reason) in &diagram.missed {
        let value = in_diagram(diagram, export::plain(*value));
        writeln!(text, "missed     {varied} {value}: {reason}")?;
    }
    for [low, high] in &diagram.uncovered {
        let [low, high] = [low, high].map(|value| export::rounded(*value, 6));
        let high = in_diagram(diagram, high);
        writeln!(text, "no orbit   {varied} from {low} to {high}")?;
    }
    Ok(())
}

/// As `of 4 motions 3 settle to period 1 on branch 2, 1 are chaotic`.
fn describe_search(searched: &Searched) -> String {
    let mut parts = Vec::new();
    for (number, orbit) in searched.orbits.iter().enumerate() {
        let branch = match orbit.branch {
            Some(branch) => format!("branch {}", branch + 1),
            None => "no branch that was followed".to_owned(),
        };
        let motions = searched.count(Fate::Periodic(number));
        parts.push(format!(
            "{motions} settle to period {} on {branch}",
            orbit.period
        ));
    }
    let long = format!(
        "have not settled to periods up to {} after {} periods (slow, or never periodic)",
        searched.longest, searched.patience
    );
    for (fate, what) in [
        (Fate::Chaotic, "are chaotic"),
        (Fate::Long, &long),
        (Fate::Escaped, "escape"),
        (Fate::Failed, "cannot be computed"),
        (Fate::Unknown, "were not followed"),
    ] {
        let count = searched.count(fate);
        if count > 0 {
            parts.push(format!("{count} {what}"));
        }
    }
    let count = searched.fates.len();
    format!("of {count} motions {}", parts.join(", "))
}
