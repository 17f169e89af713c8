//! `--basin`: basins of attraction on a grid of initial states.

use std::cmp::Ordering;
use std::fmt::Write;
use std::ops::ControlFlow;

use hertzian::attractors::basin::{Attractor, Axis, Basin, Basins, Fate, Grid};
use hertzian::chart::{Chart, Colour, Raster, Series};
use hertzian::export;
use hertzian::{Complex, Progress};

use super::output::{Results, entries, number};
use super::run::{Failure, Task};

/// Classes besides the periodic orbits.
const OTHERS: [(Fate, &str, Colour); 5] = [
    (Fate::Chaotic, "chaotic", Colour::Middle),
    (Fate::Long, "no period found", Colour::Light),
    (Fate::Escaped, "escapes", Colour::None),
    (Fate::Failed, "not computable", Colour::Fault),
    (Fate::Unknown, "not looked at", Colour::None),
];
/// Periodic orbits that get a colour of their own; the palette has fifteen, with the other classes.
const COLOURED: usize = 9;

/// Computes the basins.
///
/// # Errors
/// If an option cannot be used, or the checkpoint not.
pub fn run(task: &Task<'_>) -> Result<Results, Failure> {
    let grid = grid(task, task.options.grid)?;
    let request = request(task).grid(grid.clone());
    let checkpoint = task.checkpoint()?;
    let visit = |progress: Progress<'_>| {
        said(task, progress);
        ControlFlow::Continue(())
    };
    let basins = match checkpoint {
        Some((path, model)) => request.resume(path, &model, visit),
        None => request.run_with(visit),
    }?;
    let facts = task.system.facts();
    let names = ["attractor", "period", "cells", "point"].map(str::to_owned);
    let multipliers = (1..=2 * facts.coordinates.len())
        .flat_map(|i| ["re", "im"].map(|part| format!("multiplier_{i}_{part}")));
    let columns = grid.columns.count;
    let labels: Vec<i16> = basins.fates.iter().map(|fate| fate.label()).collect();
    let names: Vec<String> = names
        .into_iter()
        .chain(entries(&facts.coordinates))
        .chain(multipliers)
        .collect();
    Ok(Results {
        rows: rows(&basins, names.len()),
        names,
        array: export::npy_of_labels(columns, &labels)?,
        svg: chart(task, &grid, &basins)?.to_svg(),
        summary: summary(&basins),
        complete: basins.complete,
    })
}

/// Says how many motions are looked at.
pub fn said(task: &Task<'_>, progress: Progress<'_>) {
    let all = progress.total.unwrap_or(progress.done);
    task.say(|| format!("{} of {all} motions", progress.done));
}

/// The request, but for its grid.
pub fn request(task: &Task<'_>) -> Basin {
    let options = task.options;
    Basin::of(task.system)
        .omega(options.model.frequency())
        .longest(options.longest)
        .patience(options.patience)
        .escape(options.escape)
        .tolerance(options.tolerance)
        .threads(task.threads())
        .cancel(task.cancel)
}

/// The initial states, with so many cells along each side.
///
/// # Errors
/// If the ranges are empty, or the start has the wrong number of entries.
pub fn grid(task: &Task<'_>, count: usize) -> Result<Grid, Failure> {
    let options = task.options;
    let axis = |entry: usize, range: &[f64]| {
        let [from, to] = *range else {
            return Err(Failure::Option("a range has two ends".to_owned()));
        };
        // Nor is there one where an end is NaN.
        if from.partial_cmp(&to) != Some(Ordering::Less) {
            let message = format!("the range from {from} to {to} is empty");
            return Err(Failure::Option(message));
        }
        Ok(Axis::of(entry).from(from).to(to).cells(count))
    };
    Ok(Grid::new(
        task.start()?,
        axis(0, &options.x_range)?,
        axis(task.system.facts().coordinates.len(), &options.v_range)?,
    ))
}

/// A row for every point of every periodic orbit, then one for each other class; all have so many columns.
fn rows(basins: &Basins, columns: usize) -> Vec<Vec<String>> {
    let mut rows = Vec::new();
    for (index, attractor) in basins.attractors.iter().enumerate() {
        let cells = basins.count(Fate::Periodic(index)).to_string();
        let parts = attractor.multipliers.iter();
        let parts: Vec<String> = parts.flat_map(|m| [number(m.re), number(m.im)]).collect();
        for (point, state) in attractor.points.iter().enumerate() {
            let head = [
                index.to_string(),
                attractor.period.to_string(),
                cells.clone(),
                point.to_string(),
            ];
            let state: Vec<String> = state.iter().map(|&x| number(x)).collect();
            rows.push([&head[..], &state, &parts].concat());
        }
    }
    for (fate, name, _) in OTHERS {
        let count = basins.count(fate);
        if count > 0 {
            let mut row = vec![fate.label().to_string(), name.to_owned(), count.to_string()];
            row.resize(columns, String::new());
            rows.push(row);
        }
    }
    rows
}

/// What is said of a periodic orbit; those of one period are told apart by letters.
pub fn name(attractors: &[Attractor], index: usize) -> String {
    format!("period {}", numbered(attractors, index))
}

/// The period with the letter.
fn numbered(attractors: &[Attractor], index: usize) -> String {
    let period = attractors[index].period;
    let same = |range: &[Attractor]| range.iter().filter(|a| a.period == period).count();
    let letter = if same(attractors) > 1 {
        let letter = u8::try_from(same(&attractors[..index]))
            .unwrap_or(25)
            .min(25);
        char::from(b'a' + letter).to_string()
    } else {
        String::new()
    };
    format!("{period}{letter}")
}

fn chart(task: &Task<'_>, grid: &Grid, basins: &Basins) -> Result<Chart, Failure> {
    let Grid { columns, rows, .. } = grid;
    let shown = basins.attractors.len().min(COLOURED);
    let mut classes: Vec<(String, Colour)> = (0..shown)
        .map(|index| (name(&basins.attractors, index), Colour::Class(index)))
        .collect();
    classes.push(("further periods".to_owned(), Colour::Class(COLOURED)));
    let others = OTHERS.map(|(_, name, colour)| (name.to_owned(), colour));
    classes.extend(others);
    let class = |fate: &Fate| match fate {
        Fate::Periodic(index) => (*index).min(COLOURED.min(shown)),
        other => {
            let position = OTHERS.iter().position(|class| class.0 == *other);
            shown + 1 + position.unwrap_or(0)
        }
    };
    let coordinate = &task.system.facts().coordinates[0];
    let mut chart = Chart::new(task.title(None, "")?)
        .x(format!("initial {coordinate}"))
        .y(format!("initial rate of {coordinate}"))
        .raster(Raster {
            x: [columns.from, columns.to],
            y: [rows.from, rows.to],
            columns: columns.count,
            cells: basins.fates.iter().map(|fate| class(fate) as u8).collect(),
            classes,
        });
    for (index, attractor) in basins.attractors.iter().enumerate().take(shown) {
        let entry = |state: &Vec<f64>| [state[columns.entry], state[rows.entry]];
        let points: Vec<[f64; 2]> = attractor.points.iter().map(entry).collect();
        chart = chart.letters(Series::new(numbered(&basins.attractors, index), points));
    }
    Ok(chart
        .remark("numbers: the orbit of that period itself, once in each period of the excitation"))
}

fn summary(basins: &Basins) -> String {
    let mut text = String::new();
    let cells = basins.fates.len() as f64;
    let share = |count: usize| 100.0 * count as f64 / cells;
    // Writing to a string does not fail.
    for (index, attractor) in basins.attractors.iter().enumerate() {
        let count = basins.count(Fate::Periodic(index));
        let Complex { re, im } = attractor.multipliers[0];
        let _ = writeln!(
            text,
            "{:<10} {:5.1} %, from x = {:.9}, largest multiplier {re:.6} {im:+.6} i",
            name(&basins.attractors, index),
            share(count),
            attractor.points[0][0],
        );
    }
    for (fate, name, _) in OTHERS {
        let count = basins.count(fate);
        if count > 0 {
            let _ = writeln!(text, "{name:<10} {:5.1} %", share(count));
        }
    }
    let _ = writeln!(
        text,
        "motions    {} of {cells}, {:.0} periods each, with all it took to recognise orbits",
        basins.fates.len() - basins.count(Fate::Unknown),
        basins.periods as f64 / cells
    );
    text
}
