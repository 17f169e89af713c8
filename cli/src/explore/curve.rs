//! What the page draws of branches, and what it lists.

use clap::ValueEnum;
use hertzian::bifurcation::Reason;
use hertzian::chart::{Line, Run};
use hertzian::export;
use hertzian::observe::{Measure, Wanted};
use hertzian::{Branch, Error, Event, Point, Stop, Verdict};
use serde::Serialize;

use super::asked::Effort;
use super::fault::{Fault, Kind};
use super::traced::Traced;
use crate::response::options::By;
use crate::response::value::of_varied;
use crate::response::{covered, run};

/// A curve as the page has it.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Curve {
    /// What is drawn, as `x:p2p`.
    pub plot: String,
    /// The same in words.
    pub label: String,
    /// Its unit; empty where there is none.
    pub unit: String,
    /// What varies.
    pub varied: String,
    /// Its unit.
    pub varied_unit: String,
    /// How exactly.
    pub effort: Effort,
    /// The method.
    pub method: String,
    /// The branches.
    pub branches: Vec<Drawn>,
    /// The events of all branches.
    pub events: Vec<Marked>,
    /// How the branches ended, and what is unusual.
    pub notes: Vec<String>,
    /// The command line that computes the same.
    pub command: String,
    /// Number of orbits.
    pub points: usize,
    /// How long it took, in milliseconds.
    pub milliseconds: f64,
    /// Whether more is being looked for.
    pub lacks: bool,
}

/// A branch as the page draws it.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Drawn {
    /// Parts of one stability each, bent between orbits, in the digits that a screen shows.
    pub runs: Vec<Stretch>,
    /// The orbits: value, what is drawn, verdict.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub orbits: Vec<(f64, Option<f64>, &'static str)>,
    /// Period in periods of the declaration.
    pub period: usize,
    /// Why it ended.
    pub stopped: String,
}

/// A part of a branch.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Stretch {
    /// `stable`, `unstable` or `undecided`.
    pub verdict: &'static str,
    /// Values, and what is drawn, one after the other.
    pub places: Vec<Option<f32>>,
}

/// An event as the page marks and lists it.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Marked {
    /// What happens.
    pub kind: String,
    /// Number of its branch.
    pub branch: usize,
    /// Where, in what varies.
    pub value: f64,
    /// The error that is stated of it; nothing where it is not known.
    pub error: Option<f64>,
    /// What is drawn there.
    pub size: Option<f64>,
    /// The value with as many digits as its error bears.
    pub written: String,
    /// All in words.
    pub said: String,
}

/// The word of a verdict.
pub fn word(verdict: Verdict) -> &'static str {
    match verdict {
        Verdict::Stable => "stable",
        Verdict::Unstable => "unstable",
        Verdict::Undecided => "undecided",
    }
}

/// What is drawn: what was asked for, or else what leads.
///
/// # Errors
/// If it is nothing of this model.
pub fn wanted(plot: &str, branch: &Branch) -> Result<Wanted, Fault> {
    if plot.is_empty() {
        return Ok(branch.leading());
    }
    let wanted: Wanted = plot.parse().map_err(Error::from)?;
    branch.model.check(&wanted)?;
    Ok(wanted)
}

/// The curve of what is drawn.
///
/// # Errors
/// If it is nothing of this model, or cannot be computed.
pub fn of(traced: &Traced, plot: &str, effort: Effort) -> Result<Curve, Fault> {
    let mut branches = traced.branches();
    let first = branches
        .next()
        .ok_or_else(|| Fault::new(Kind::Computation, "there is no branch"))?;
    let wanted = wanted(plot, first)?;
    if let Some(point) = first.points.first() {
        first.measured(&wanted, point)?;
    }
    let by = traced.by();
    let mut notes = Vec::new();
    if effort == Effort::Full {
        notes.extend(run::remarks_on(first, &*traced.model));
        notes.extend(run::windings(traced.branches()));
    }
    notes.extend(ends(traced));
    let drawn = traced.branches();
    let drawn: Vec<Drawn> = drawn.map(|branch| draw(branch, &wanted, effort)).collect();
    let events = traced.branches().enumerate();
    let events = events.flat_map(|(number, branch)| {
        let wanted = &wanted;
        branch
            .events
            .iter()
            .map(move |event| mark(branch, number, event, wanted))
    });
    Ok(Curve {
        label: format!("{} of {}", wanted.measure.in_words(), wanted.name),
        unit: wanted.measure.unit(first.model.unit_of(&wanted.name)),
        plot: wanted.to_string(),
        varied: first.varied.clone(),
        varied_unit: first.model.unit_of_varied(&first.varied).to_owned(),
        effort,
        method: name_of(by),
        events: events.collect(),
        notes,
        command: command(traced, first, &wanted),
        points: traced.branches().map(|branch| branch.points.len()).sum(),
        milliseconds: 1e3 * traced.elapsed.as_secs_f64(),
        lacks: effort == Effort::Full && traced.lacks(),
        branches: drawn,
    })
}

/// The command line that computes the same; what leads is drawn anyway.
fn command(traced: &Traced, first: &Branch, wanted: &Wanted) -> String {
    let command = traced.asked.command(traced.by());
    if *wanted == first.leading() {
        command
    } else {
        format!("{command} --plot {wanted}")
    }
}

/// The name of a method.
fn name_of(by: By) -> String {
    let name = by.to_possible_value();
    name.map_or_else(String::new, |name| name.get_name().to_owned())
}

/// What a search found, as the page says it.
fn in_sentences(line: &str) -> String {
    for (word, said) in [
        (
            "searched",
            "Motions were simulated where no stable one was known yet:",
        ),
        ("missed", "Not all could be searched at"),
        ("no orbit", "Nothing that repeats was found for"),
    ] {
        if let Some(rest) = line.strip_prefix(word) {
            return format!("{said} {}", rest.trim_start());
        }
    }
    line.to_owned()
}

/// How branches ended that did not reach the end of the range, and what was searched.
fn ends(traced: &Traced) -> Vec<String> {
    let several = traced.diagram.branches.len() > 1;
    let mut notes = Vec::new();
    for (number, branch) in traced.branches().enumerate() {
        let of = if several {
            format!("branch {}: ", number + 1)
        } else {
            String::new()
        };
        if branch.stopped != Stop::ReachedEnd {
            notes.push(format!("{of}{}", branch.stopped));
        }
        for turn in &branch.turns {
            let value = of_varied(branch, export::rounded(turn.value, 6));
            notes.push(format!("{of}{value}: not confirmed as a {}", turn.kind));
        }
    }
    let mut text = String::new();
    // Writing to a string does not fail.
    let _ = covered::write_search(&mut text, &traced.diagram, &traced.asked.varied);
    notes.extend(text.lines().map(in_sentences));
    for omitted in &traced.diagram.omitted {
        let failed = matches!(
            omitted.reason,
            Reason::Failed(_) | Reason::Budget | Reason::Period
        );
        let branch = &traced.diagram.branches[omitted.branch].branch;
        let event = branch.events.get(omitted.event).filter(|_| failed);
        notes.extend(event.map(|event| {
            let value = of_varied(branch, export::rounded(event.point.value, 6));
            let (number, reason) = (omitted.branch + 1, &omitted.reason);
            format!("branch {number}: what begins at {value} was not followed: {reason}")
        }));
    }
    notes
}

/// What is measured of an orbit, if it is known.
fn measure(branch: &Branch, wanted: &Wanted, point: &Point) -> Option<f64> {
    let measured = branch.measured(wanted, point).ok().flatten();
    measured.filter(|value| value.is_finite())
}

fn draw(branch: &Branch, wanted: &Wanted, effort: Effort) -> Drawn {
    let size = |point: &Point| measure(branch, wanted, point);
    let mut runs = branch.runs_of(|point| [point.value, size(point).unwrap_or(f64::NAN)]);
    if let Measure::Phase(_) = wanted.measure {
        // An angle that jumps by a turn is no line.
        runs = runs.into_iter().flat_map(cut_at_turns).collect();
    }
    let exact = branch.points.iter().filter(|_| effort == Effort::Full);
    let orbits = exact.map(|point| (point.value, size(point), word(point.stability.verdict)));
    Drawn {
        orbits: orbits.collect(),
        period: branch.period(),
        stopped: branch.stopped.to_string(),
        runs: runs.iter().map(Stretch::of).collect(),
    }
}

impl Stretch {
    fn of(run: &Run) -> Self {
        let places = run.points.iter().flatten();
        Self {
            verdict: match run.line {
                Line::Stable => "stable",
                Line::Unstable => "unstable",
                _ => "undecided",
            },
            places: places
                .map(|value| value.is_finite().then_some(*value as f32))
                .collect(),
        }
    }
}

/// A run without the lines between angles that are more than half a turn apart.
fn cut_at_turns(run: Run) -> Vec<Run> {
    let mut parts = vec![Vec::new()];
    for place in run.points {
        let part = parts.last().and_then(|part: &Vec<[f64; 2]>| part.last());
        let jumps = part.is_some_and(|last| (last[1] - place[1]).abs() > std::f64::consts::PI);
        if jumps {
            parts.push(Vec::new());
        }
        if let Some(part) = parts.last_mut() {
            part.push(place);
        }
    }
    let line = run.line;
    let parts = parts.into_iter();
    parts.map(|points| Run { line, points }).collect()
}

fn mark(branch: &Branch, number: usize, event: &Event, wanted: &Wanted) -> Marked {
    let value = event.point.value;
    Marked {
        kind: event.kind.to_string(),
        branch: number,
        value,
        error: event.error.is_finite().then_some(event.error),
        size: measure(branch, wanted, &event.point),
        written: of_varied(branch, export::to_error(value, event.error)),
        said: branch.describe(event),
    }
}
