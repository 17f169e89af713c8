//! `--sweep`: bifurcation diagrams.

use std::fmt::Write;
use std::ops::ControlFlow;

use hertzian::Progress;
use hertzian::attractors::sweep::{Row, Sweep};
use hertzian::chart::{Chart, Frequency, Series};
use hertzian::observe::outputs_at;
use hertzian::time::FlowError;
use hertzian::time::poincare::Section;

use super::options::Swept;
use super::output::{Results, Table, entries};
use super::run::{Failure, Task};
use crate::look::Axis;
use crate::response::files::page;

/// Sweeps up, down, or up and then down.
///
/// # Errors
/// If an option cannot be used, or the checkpoint not.
pub fn run(task: &Task<'_>, swept: Swept) -> Result<Results, Failure> {
    check(task, swept)?;
    let request = request(task, swept)?;
    let checkpoint = task.checkpoint()?;
    let visit = |progress: Progress<'_>| {
        let value = progress.value.unwrap_or(f64::NAN);
        task.say(|| format!("{} = {value:.6}", swept.name()));
        ControlFlow::Continue(())
    };
    let found = match checkpoint {
        Some((path, model)) => request.resume(path, &model, visit),
        None => request.run_with(visit),
    }?;
    results(task, swept, &found)
}

/// The options in the library's terms.
fn request(task: &Task<'_>, swept: Swept) -> Result<Sweep, Failure> {
    let options = task.options;
    let (low, high) = (options.from, options.to);
    let [from, to] = if options.down && !options.up {
        [high, low]
    } else {
        [low, high]
    };
    let mut request = Sweep::of(task.system)
        .from(from)
        .to(to)
        .values(options.values)
        .back(options.up && options.down)
        .start(&task.start()?)
        .transient(options.transient.unwrap_or(400))
        .periods(options.periods.unwrap_or(100))
        .escape(options.escape)
        .tolerance(options.tolerance)
        .cancel(task.cancel);
    if swept != Swept::Omega {
        let omega = options.model.frequency();
        request = request.vary(swept.name()).omega(omega);
    }
    if let Some(value) = options.section {
        request = request.section(Section::entry(0, value));
    }
    Ok(request)
}

/// Both ends are in the range of what is swept.
fn check(task: &Task<'_>, swept: Swept) -> Result<(), Failure> {
    let options = task.options;
    let facts = task.system.facts();
    let parameter = facts.parameters.iter().find(|p| p.name == swept.name());
    for value in [options.from, options.to] {
        let admitted = parameter.map_or(value > 0.0 && value.is_finite(), |p| p.admits(value));
        if !admitted {
            let message = format!("{} = {value} is outside its range", swept.name());
            return Err(Failure::Option(message));
        }
    }
    if options.from >= options.to || options.values < 2 {
        let message = "a sweep needs --from below --to, and at least two values".to_owned();
        return Err(Failure::Option(message));
    }
    if options.axis != Axis::Omega && swept != Swept::Omega {
        let message = "--axis is for --sweep omega: nothing else is a frequency".to_owned();
        return Err(Failure::Option(message));
    }
    shown(task).map(|_| ())
}

/// What is drawn of a state.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Shown {
    /// A coordinate, or its rate.
    Entry(usize),
    /// An output.
    Output(usize),
}

/// What was asked for, or else the first coordinate, or its rate where it passes a value.
fn shown(task: &Task<'_>) -> Result<Vec<Shown>, Failure> {
    let (options, facts) = (task.options, task.system.facts());
    let count = facts.coordinates.len();
    if options.plot.is_empty() {
        let first = options.section.map_or(0, |_| count);
        return Ok(vec![Shown::Entry(first)]);
    }
    let found = options.plot.iter().map(|name| {
        let coordinate = facts.coordinates.iter().position(|own| own == name);
        if let Some(index) = coordinate {
            return Ok(Shown::Entry(index));
        }
        let output = facts.outputs.iter().position(|own| own.name == *name);
        let message = match output {
            Some(_) if options.section.is_some() => format!(
                "--plot {name}: outputs are those at the beginning of each period, and --section looks elsewhere"
            ),
            Some(index) => return Ok(Shown::Output(index)),
            None => {
                let outputs = facts.outputs.iter().map(|own| own.name.to_string());
                let names = facts.coordinates.iter().map(ToString::to_string);
                let known: Vec<String> = outputs.chain(names).collect();
                format!(
                    "--plot {name}: no output or coordinate is called that: there are {}",
                    known.join(", ")
                )
            }
        };
        Err(Failure::Option(message))
    });
    found.collect()
}

/// The values that are drawn of a state, where what is swept has a value.
fn values_of(
    task: &Task<'_>,
    swept: Swept,
    shown: &[Shown],
    value: f64,
    state: &[f64],
) -> Result<Vec<f64>, Failure> {
    let mut outputs = Vec::new();
    if shown.iter().any(|shown| matches!(shown, Shown::Output(_))) {
        let mut parameters = task.values(None)?;
        let mut omega = task.options.model.frequency();
        let mut names = task.system.facts().parameters.iter();
        match names.position(|own| own.name == swept.name()) {
            Some(place) => parameters[place] = value,
            None => omega = value,
        }
        outputs = outputs_at(task.system, &parameters, omega, 0.0, state)?;
    }
    let values = shown.iter().map(|shown| match *shown {
        Shown::Entry(index) => state[index],
        Shown::Output(index) => outputs[index],
    });
    Ok(values.collect())
}

/// What stands at the axis of what is drawn.
fn label_of(task: &Task<'_>, shown: Shown) -> String {
    let facts = task.system.facts();
    let count = facts.coordinates.len();
    let (name, unit) = match shown {
        Shown::Output(index) => {
            let output = &facts.outputs[index];
            (output.name.to_string(), output.unit.as_ref())
        }
        Shown::Entry(index) if index < count => {
            let unit = facts.units.get(index).map_or("", AsRef::as_ref);
            (facts.coordinates[index].to_string(), unit)
        }
        Shown::Entry(index) => (format!("rate of {}", facts.coordinates[index - count]), ""),
    };
    let text = match task.options.section {
        Some(value) => format!(
            "{name} where {} rises through {value}",
            facts.coordinates[0]
        ),
        None => format!("{name} at the beginning of each period"),
    };
    if unit.is_empty() {
        text
    } else {
        format!("{text} [{unit}]")
    }
}

/// What stands at the axis of what is swept.
fn label_of_swept(task: &Task<'_>, swept: Swept) -> String {
    let units = !task.system.facts().units.is_empty();
    match (task.options.axis, units) {
        (Axis::Omega, _) => swept.label().to_owned(),
        (Axis::Hz, true) => "excitation frequency [Hz]".to_owned(),
        (Axis::Hz, false) => "excitation frequency ω/2π".to_owned(),
        (Axis::Rpm, true) => "excitation frequency [rpm]".to_owned(),
        (Axis::Rpm, false) => "excitation frequency 60 ω/2π".to_owned(),
    }
}

fn results(
    task: &Task<'_>,
    swept: Swept,
    found: &hertzian::attractors::sweep::Swept,
) -> Result<Results, Failure> {
    let rows = &found.rows;
    let facts = task.system.facts();
    let order = 2 * facts.coordinates.len();
    let names = ["direction", swept.name()].map(str::to_owned);
    let mut table = Table::new([names.to_vec(), entries(&facts.coordinates)].concat());
    let rising = match (task.options.up, task.options.down) {
        (false, true) => 0,
        _ => task.options.values,
    };
    let shown = shown(task)?;
    let frequency = Frequency::from(task.options.axis);
    let mut clouds = vec![[Vec::new(), Vec::new()]; shown.len()];
    let mut line = Vec::new();
    for (index, row) in rows.iter().enumerate() {
        let falls = index >= rising;
        let place = match swept {
            Swept::Omega => frequency.of(row.value),
            _ => row.value,
        };
        for state in row.points.chunks_exact(order) {
            line.clear();
            line.extend([if falls { -1.0 } else { 1.0 }, row.value]);
            line.extend(state);
            table.row(&line);
            let values = values_of(task, swept, &shown, row.value, state)?;
            for (clouds, value) in clouds.iter_mut().zip(values) {
                clouds[usize::from(falls)].push([place, value]);
            }
        }
    }
    let title = task.title(None, swept.name())?;
    let charts = shown.iter().zip(clouds).map(|(shown, [up, down])| {
        Chart::new(&title)
            .x(label_of_swept(task, swept))
            .y(label_of(task, *shown))
            .cloud(Series {
                label: format!("{} falls", symbol(swept)),
                points: down,
            })
            .cloud(Series {
                label: format!("{} rises", symbol(swept)),
                points: up,
            })
    });
    let picture = page(charts.collect());
    let summary = summary(rows, swept, order);
    Ok(table.with(picture, summary, found.complete)?)
}

/// How many values there were, and at how many of them nothing was seen.
fn summary(rows: &[Row], swept: Swept, order: usize) -> String {
    let mut summary = String::new();
    let points: usize = rows.iter().map(|row| row.points.len() / order).sum();
    // Writing to a string does not fail.
    let _ = writeln!(
        summary,
        "swept      {} values of {}, {points} points",
        rows.len(),
        swept.name()
    );
    let ends: Vec<_> = rows.iter().filter_map(|row| row.ended).collect();
    let escaped = ends
        .iter()
        .filter(|&&end| end == FlowError::Escaped)
        .count();
    if escaped > 0 {
        let _ = writeln!(
            summary,
            "escaped    at {escaped} of them; the motion started again"
        );
    }
    if let Some(first) = ends.iter().find(|&&end| end != FlowError::Escaped) {
        let _ = writeln!(
            summary,
            "failed     at {} of them, first: {first}; the motion started again",
            ends.len() - escaped
        );
    }
    summary
}

fn symbol(swept: Swept) -> &'static str {
    match swept {
        Swept::Drive => "A",
        Swept::Omega => "ω",
        Swept::Load => "W",
    }
}
