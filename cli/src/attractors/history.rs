//! `--history`: a motion in time.

use std::fmt::Write;

use hertzian::chart::{Chart, Page, Series};
use hertzian::time::history;
use hertzian::time::stroboscope::Stroboscope;

use super::output::{Results, Table, entries};
use super::run::{Failure, Task};

/// Periods of the enlargement.
const WINDOW: usize = 40;
/// Points of its curve in each period.
const SAMPLES: usize = 60;

/// Follows one motion.
///
/// # Errors
/// If an option cannot be used, or the motion cannot be computed.
pub fn run(task: &Task<'_>) -> Result<Results, Failure> {
    let options = task.options;
    let facts = task.system.facts();
    let mut map = task.map(None)?;
    let mut state = task.start()?;
    // Where this is ended, so is what follows.
    task.settle(&mut map, &mut state, options.transient.unwrap_or(0))?;
    let periods = options.periods.unwrap_or(1000);
    let mut states = vec![state.clone()];
    for period in 0..periods {
        if !task.goes_on() {
            break;
        }
        map.map(&mut state)?;
        states.push(state.clone());
        task.say(|| format!("{} of {periods} periods", period + 1));
    }
    let every = options.every.get();
    let mut table = Table::new([vec!["period".to_owned()], entries(&facts.coordinates)].concat());
    let mut dots = Vec::new();
    for (index, state) in states.iter().enumerate().step_by(every) {
        table.row(&[&[index as f64], &state[..]].concat());
        dots.push([index as f64, state[0]]);
    }
    let whole = whole(task, dots)?;
    let part = enlargement(task, &mut map, &states)?;
    let svg = Page::new(1).chart(whole).chart(part).to_svg();
    let mut summary = String::new();
    let all = || states.iter().map(|state| state[0]);
    // Writing to a string does not fail.
    let _ = writeln!(
        summary,
        "periods    {}, {} at their beginnings from {:.6} to {:.6}",
        states.len() - 1,
        facts.coordinates[0],
        all().fold(f64::INFINITY, f64::min),
        all().fold(f64::NEG_INFINITY, f64::max)
    );
    Ok(table.with(svg, summary, states.len() == periods + 1)?)
}

/// All of the motion, as often as it is looked at.
fn whole(task: &Task<'_>, dots: Vec<[f64; 2]>) -> Result<Chart, Failure> {
    let name = &task.system.facts().coordinates[0];
    let looked = match task.options.every.get() {
        1 => "at the beginning of each period".to_owned(),
        n => format!("at the beginning of every {n}th period"),
    };
    let chart = Chart::new(task.title(None, "")?)
        .x("time in excitation periods")
        .y(format!("{name} {looked}"));
    Ok(chart.cloud(Series {
        label: String::new(),
        points: dots,
    }))
}

/// Some periods of the motion with the curve between their beginnings.
fn enlargement(
    task: &Task<'_>,
    map: &mut Stroboscope,
    states: &[Vec<f64>],
) -> Result<Chart, Failure> {
    let from = window(states, task.options.every.get());
    let last = (from + WINDOW).min(states.len() - 1);
    let mut curve = Vec::new();
    let mut moving = states[from].clone();
    history::record(
        map,
        &mut moving,
        last - from,
        SAMPLES,
        &mut |time, state| {
            curve.push([from as f64 + time, state[0]]);
        },
    )?;
    let shown = states.iter().enumerate().take(last + 1).skip(from);
    let chart = Chart::new(format!("enlargement: periods {from} to {last}"))
        .x("time in excitation periods")
        .y(task.system.facts().coordinates[0].to_string());
    Ok(chart
        .trace(Series {
            label: String::new(),
            points: curve,
        })
        .markers(Series {
            label: "beginning of each period".to_owned(),
            points: shown
                .map(|(index, state)| [index as f64, state[0]])
                .collect(),
        }))
}

/// Where the enlargement begins: so that the largest change from one point to the next is in its second half.
fn window(states: &[Vec<f64>], every: usize) -> usize {
    let change = |index: &usize| (states[index + every][0] - states[*index][0]).abs();
    let places = 0..states.len().saturating_sub(every);
    let largest = places.max_by(|a, b| change(a).total_cmp(&change(b)));
    let before = 3 * WINDOW / 5;
    let latest = states.len().saturating_sub(WINDOW + 1);
    largest.unwrap_or(0).saturating_sub(before).min(latest)
}
