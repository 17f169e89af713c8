//! `--phase`: phase portraits of the attractors that are found from some starts.

use std::fmt::Write;
use std::ops::ControlFlow;

use hertzian::attractors::basin::{Attractor, Basins, Fate};
use hertzian::chart::{Chart, Page, Series};
use hertzian::time::history;
use hertzian::time::stroboscope::Stroboscope;

use super::basin::{grid, name, request, said};
use super::output::{Results, Table, entries};
use super::run::{Failure, Task};

/// Points of a curve in each period.
const SAMPLES: usize = 120;
/// Periods of a motion that is not periodic: of its curve, and of its points.
const CURVE: usize = 100;
const POINTS: usize = 5000;

/// Draws the attractors at each amplitude.
///
/// # Errors
/// If an option cannot be used, or a motion cannot be computed.
pub fn run(task: &Task<'_>) -> Result<Results, Failure> {
    let facts = task.system.facts();
    let head = ["drive", "attractor", "period", "point"].map(str::to_owned);
    let mut gallery = Gallery {
        table: Table::new([head.to_vec(), entries(&facts.coordinates)].concat()),
        charts: Vec::new(),
        summary: String::new(),
        marked: marked(task)?,
    };
    let mut complete = true;
    for drive in task.drives() {
        if !task.goes_on() {
            complete = false;
            break;
        }
        complete &= gallery.add(task, drive)?;
    }
    let Gallery {
        table,
        mut charts,
        summary,
        ..
    } = gallery;
    if let (&[left, right, low, high], Some(last)) = (&task.options.zoom[..], charts.last()) {
        let part = last.clone().limits([left, right], [low, high]);
        charts.push(part.title("enlargement of the last"));
    }
    let columns = if charts.len() > 1 { 2 } else { 1 };
    let page = charts.into_iter().fold(Page::new(columns), Page::chart);
    Ok(table.with(page.to_svg(), summary, complete)?)
}

/// The portraits so far.
struct Gallery {
    table: Table,
    charts: Vec<Chart>,
    summary: String,
    /// The orbit that is marked in all of them.
    marked: Option<Attractor>,
}

impl Gallery {
    /// Adds the portrait at an amplitude; false if it is not complete.
    fn add(&mut self, task: &Task<'_>, drive: Option<f64>) -> Result<bool, Failure> {
        let facts = task.system.facts();
        let value = task.amplitude(drive)?;
        let (basins, start) = settled(task, drive)?;
        let mut complete = basins.complete;
        let mut portrait = Portrait {
            chart: Chart::new(task.title(drive, "")?)
                .x(facts.coordinates[0].to_string())
                .y(format!("rate of {}", facts.coordinates[0])),
            map: task.map(drive)?,
        };
        // Writing to a string does not fail.
        let _ = writeln!(self.summary, "{}", task.title(drive, "")?);
        for (index, attractor) in basins.attractors.iter().enumerate() {
            let label = name(&basins.attractors, index);
            let first = attractor.points[0][0];
            let _ = writeln!(self.summary, "{label:<10} from x = {first:.9}");
            let head = [value, index as f64, attractor.period as f64];
            self.rows(head, &attractor.points);
            portrait = portrait.periodic(attractor, label)?;
        }
        if let Some((fate, state)) = start {
            let label = other_label(fate);
            let _ = writeln!(self.summary, "{label}");
            // Beside periodic orbits a long period is no portrait of its own.
            if fate == Fate::Chaotic || basins.attractors.is_empty() {
                let (more, points) = portrait.other(task, state, label)?;
                portrait = more;
                complete &= points.len() > POINTS;
                self.rows([value, f64::from(fate.label()), 0.0], &points);
            }
        }
        self.mark(task, value, &basins, &mut portrait);
        self.charts.push(portrait.chart);
        Ok(complete)
    }

    /// A row for each point, behind what is the same for all.
    fn rows(&mut self, [value, label, period]: [f64; 3], points: &[Vec<f64>]) {
        for (point, state) in points.iter().enumerate() {
            let head = [value, label, period, point as f64];
            self.table.row(&[&head, &state[..]].concat());
        }
    }

    /// Marks the orbit that is to be, unless one of its period is there.
    fn mark(&self, task: &Task<'_>, value: f64, basins: &Basins, portrait: &mut Portrait) {
        let Some(marked) = &self.marked else {
            return;
        };
        let mut periods = basins.attractors.iter().map(|attractor| attractor.period);
        if periods.any(|period| period == marked.period) {
            return;
        }
        let drive = task.options.mark.unwrap_or(value);
        portrait.chart = portrait.chart.clone().markers(Series {
            label: format!("period {} at A = {drive}", marked.period),
            points: marked.points.iter().map(|state| place(state)).collect(),
        });
    }
}

/// A motion that is on no periodic orbit: what is known of it, and a state that it has settled to.
type Other = (Fate, Vec<f64>);

/// What the motions from the grid, or from the start, settle to, and one that is on no periodic orbit.
fn settled(task: &Task<'_>, drive: Option<f64>) -> Result<(Basins, Option<Other>), Failure> {
    let mut grid = grid(task, task.options.starts.max(1))?;
    if task.options.starts == 0 {
        // One cell, with the start in its middle.
        for axis in [&mut grid.columns, &mut grid.rows] {
            let middle = grid.start[axis.entry];
            (axis.from, axis.to) = (middle, middle);
        }
    }
    let mut request = request(task).grid(grid.clone());
    if let Some(drive) = drive {
        request = request.parameter("drive", drive);
    }
    let mut basins = request.run_with(|progress| {
        said(task, progress);
        ControlFlow::Continue(())
    })?;
    let other = |fate: &Fate| matches!(fate, Fate::Chaotic | Fate::Long);
    let cell = basins.fates.iter().position(other);
    let start = cell.map(|cell| {
        let mut state = grid.start.clone();
        grid.state(cell, &mut state);
        (basins.fates[cell], state)
    });
    let Some((fate, mut state)) = start else {
        return Ok((basins, None));
    };
    let mut map = task.map(drive)?;
    if !task.settle(&mut map, &mut state, task.options.patience)? {
        basins.complete = false;
        return Ok((basins, None));
    }
    Ok((basins, Some((fate, state))))
}

/// The periodic attractor at the amplitude of `--mark`.
fn marked(task: &Task<'_>) -> Result<Option<Attractor>, Failure> {
    let Some(drive) = task.options.mark else {
        return Ok(None);
    };
    let (mut basins, _) = settled(task, Some(drive))?;
    basins.attractors.truncate(1);
    Ok(basins.attractors.pop())
}

fn other_label(fate: Fate) -> &'static str {
    if fate == Fate::Chaotic {
        "chaotic"
    } else {
        "no period found"
    }
}

/// The first coordinate and its rate.
fn place(state: &[f64]) -> [f64; 2] {
    [state[0], state[state.len() / 2]]
}

/// A chart that grows.
struct Portrait {
    chart: Chart,
    map: Stroboscope,
}

impl Portrait {
    /// The curve and the points of a periodic orbit.
    fn periodic(mut self, attractor: &Attractor, label: String) -> Result<Self, Failure> {
        let curve = self.curve(&attractor.points[0], attractor.period)?;
        self.chart = self
            .chart
            .trace(Series {
                label: String::new(),
                points: curve,
            })
            .markers(Series {
                label,
                points: attractor.points.iter().map(|state| place(state)).collect(),
            });
        Ok(self)
    }

    /// A part of the curve of another motion, and many of its points.
    fn other(
        mut self,
        task: &Task<'_>,
        start: Vec<f64>,
        label: &str,
    ) -> Result<(Self, Vec<Vec<f64>>), Failure> {
        let mut points = vec![start];
        for i in 0..POINTS {
            if !task.goes_on() {
                break;
            }
            let mut next = points[i].clone();
            self.map.map(&mut next)?;
            points.push(next);
        }
        // The part of the motion that goes farthest.
        let size = |i: &usize| points[*i][0].abs();
        let farthest = (0..points.len()).max_by(|a, b| size(a).total_cmp(&size(b)));
        let before = farthest.unwrap_or(0).saturating_sub(CURVE / 2);
        let curve = self.curve(&points[before], CURVE)?;
        self.chart = self
            .chart
            .trace(Series {
                label: format!("{label}, {CURVE} periods"),
                points: curve,
            })
            .cloud(Series {
                label: "beginning of each period".to_owned(),
                points: points.iter().map(|state| place(state)).collect(),
            });
        Ok((self, points))
    }

    fn curve(&mut self, start: &[f64], periods: usize) -> Result<Vec<[f64; 2]>, Failure> {
        let mut curve = Vec::new();
        let mut state = start.to_vec();
        history::record(
            &mut self.map,
            &mut state,
            periods,
            SAMPLES,
            &mut |_, state| {
                curve.push(place(state));
            },
        )?;
        Ok(curve)
    }
}
