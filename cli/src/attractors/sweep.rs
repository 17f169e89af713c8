//! `--sweep`: bifurcation diagrams.

use std::fmt::Write;

use hertzian::attractors::sweep::{Ended, Row, Sweep};
use hertzian::chart::{Chart, Cloud};
use hertzian::system::Variable;
use hertzian::time::poincare::{Direction, Section};

use super::options::Swept;
use super::output::{Results, Table, entries};
use super::run::{Failure, Task};

/// Sweeps up, down, or up and then down.
///
/// # Errors
/// If an option cannot be used, or the checkpoint not.
pub fn run(task: &Task<'_>, swept: Swept) -> Result<Results, Failure> {
    let options = task.options;
    let variable = variable(task, swept)?;
    check(task, swept)?;
    let up = options.up || !options.down;
    let rising = Sweep::spread(options.from, options.to, options.values)?;
    let falling = rising.iter().rev();
    let mut values = Vec::new();
    values.extend(rising.iter().filter(|_| up));
    let ups = values.len();
    values.extend(falling.filter(|_| options.down));
    let request = Sweep {
        variable,
        values,
        start: task.start()?,
        transient: options.transient.unwrap_or(400),
        periods: options.periods.unwrap_or(100),
        escape: options.escape,
    };
    let section = options
        .section
        .map(|value| Section::entry(0, value, Direction::Rising));
    let mut log = task.log(&(&request, options.section))?;
    let mut map = task.map(None)?;
    let mut done = 0;
    let rows = request.run(&mut map, section.as_ref(), log.as_mut(), &mut |row| {
        done += 1;
        task.say(|| format!("{} = {:.6}", swept.name(), row.value));
        task.goes_on()
    })?;
    let complete = rows.len() == request.values.len();
    results(task, swept, (&rows, ups), complete)
}

/// The variable of the oscillator that is swept.
fn variable(task: &Task<'_>, swept: Swept) -> Result<Variable, Failure> {
    if swept == Swept::Omega {
        return Ok(Variable::Omega);
    }
    let mut parameters = task.system.facts().parameters.iter();
    let position = parameters.position(|parameter| parameter.name == swept.name());
    position
        .map(Variable::Parameter)
        .ok_or_else(|| Failure::Option(format!("the oscillator has no parameter {}", swept.name())))
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
    (rows, ups): (&[Row], usize),
    complete: bool,
) -> Result<Results, Failure> {
    let facts = task.system.facts();
    let order = 2 * facts.coordinates.len();
    let names = ["direction", swept.name()].map(str::to_owned);
    let mut table = Table::new([names.to_vec(), entries(&facts.coordinates)].concat());
    let mut clouds = [Vec::new(), Vec::new()];
    let mut line = Vec::new();
    for (index, row) in rows.iter().enumerate() {
        let falls = index >= ups;
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
    Ok(table.with(chart.to_svg(), summary, complete))
}

fn symbol(swept: Swept) -> &'static str {
    match swept {
        Swept::Drive => "A",
        Swept::Omega => "ω",
        Swept::Load => "W",
    }
}
