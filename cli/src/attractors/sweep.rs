//! `--sweep`: bifurcation diagrams.

use std::fmt::Write;
use std::ops::ControlFlow;

use hertzian::Progress;
use hertzian::attractors::sweep::{Ended, Row, Sweep};
use hertzian::chart::{Chart, Cloud};
use hertzian::time::poincare::{Direction, Section};

use super::options::Swept;
use super::output::{Results, Table, entries};
use super::run::{Failure, Task};

/// Sweeps up, down, or up and then down.
///
/// # Errors
/// If an option cannot be used, or the checkpoint not.
pub fn run(task: &Task<'_>, swept: Swept) -> Result<Results, Failure> {
    check(task, swept)?;
    let request = request(task, swept)?;
    let mut log = task.log(&request)?;
    let visit = |progress: Progress<'_>| {
        let value = progress.value.unwrap_or(f64::NAN);
        task.say(|| format!("{} = {value:.6}", swept.name()));
        ControlFlow::Continue(())
    };
    let found = match &mut log {
        Some(log) => request.resume(log, visit),
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
        request = request.section(Section::entry(0, value, Direction::Rising));
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
    Ok(())
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
    let mut clouds = [Vec::new(), Vec::new()];
    let mut line = Vec::new();
    for (index, row) in rows.iter().enumerate() {
        let falls = index >= rising;
        for state in row.points.chunks_exact(order) {
            line.clear();
            line.extend([if falls { -1.0 } else { 1.0 }, row.value]);
            line.extend(state);
            table.row(&line);
            let shown = if task.options.section.is_some() {
                state[order / 2]
            } else {
                state[0]
            };
            clouds[usize::from(falls)].push([row.value, shown]);
        }
    }
    let [up, down] = clouds;
    let name = &facts.coordinates[0];
    let label = match task.options.section {
        Some(value) => format!("rate of {name} where it rises through {value}"),
        None => format!("{name} at the beginning of each period"),
    };
    let chart = Chart::new(task.title(None, swept.name())?)
        .x(swept.label())
        .y(label)
        .cloud(Cloud {
            label: format!("{} falls", symbol(swept)),
            points: down,
        })
        .cloud(Cloud {
            label: format!("{} rises", symbol(swept)),
            points: up,
        });
    let summary = summary(rows, swept, order);
    Ok(table.with(chart.to_svg(), summary, found.complete))
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
    let escaped = ends.iter().filter(|&&end| end == Ended::Escaped).count();
    if escaped > 0 {
        let _ = writeln!(
            summary,
            "escaped    at {escaped} of them; the motion started again"
        );
    }
    if let Some(first) = ends.iter().find(|&&end| end != Ended::Escaped) {
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
