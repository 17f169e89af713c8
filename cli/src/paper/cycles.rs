//! Figures 8a and 9a, and Table 1: orbits of several periods of the one-sided contact of exponent one; figure 8a by the method that fits, which is the
//! contact equation, the others by shooting.
//!
//! Every piece of its force is affine, so that motions are known in closed form and nothing is truncated.

use hertzian::bifurcation::Bifurcations;
use hertzian::chart::{Chart, Curve, Scale, Series, event_markers};
use hertzian::error::chain;
use hertzian::{Branch, Error, Event, EventKind, FrequencyResponse, OrbitError, Point, Shooting};

use super::exact;
use super::figure::{Drawing, Table, Task, Value};
use crate::response::models::OneSidedLinear;

/// States on orbits to three digits or so, to begin with; the attractors at amplitude and frequency one were found by simulation.
const PERIOD_8: [f64; 2] = [-0.330, 0.333];
const COEXISTING: [(usize, [f64; 2]); 5] = [
    (2, [-5.63, 3.53]),
    (3, [-31.3, 0.605]),
    (3, [-6.36, -0.0231]),
    (4, [-58.4, -2.28]),
    (5, [-99.53, 1.207]),
];

fn model(drive: f64) -> OneSidedLinear {
    OneSidedLinear {
        zeta: 0.032,
        load: 1.0,
        drive,
    }
}

/// A figure that grows by branches.
struct Cycles<'t> {
    task: &'t Task<'t>,
    curves: Vec<Curve>,
    marks: Vec<(EventKind, [f64; 2])>,
    events: Vec<Event>,
    scale: Scale,
    drawing: Drawing,
}

impl<'t> Cycles<'t> {
    fn new(task: &'t Task<'t>, varied: &'static str) -> Self {
        let names = ["period", varied, "peak_to_peak", "stability", "multiplier"];
        Self {
            task,
            curves: Vec::new(),
            marks: Vec::new(),
            events: Vec::new(),
            scale: Scale::Linear,
            drawing: Drawing {
                data: Table {
                    names: names.map(str::to_owned).to_vec(),
                    rows: Vec::new(),
                },
                ..Drawing::default()
            },
        }
    }

    /// Follows a branch and adds it.
    fn follow(&mut self, shooting: &FrequencyResponse<Shooting>) -> Result<Branch, String> {
        let branch = shooting
            .clone()
            .cancel(self.task.cancel)
            .run()
            .map_err(|error| chain(&error).to_string())?;
        self.add(&branch);
        Ok(branch)
    }

    /// Goes on where a branch has come back to through a fold.
    fn continue_from(
        &mut self,
        branch: &Branch,
        orbits: &FrequencyResponse<Shooting>,
        [from, to]: [f64; 2],
    ) -> Result<(), String> {
        let last = branch.points.last().filter(|last| last.value == from);
        let last =
            last.ok_or_else(|| format!("the branch did not come back: {}", branch.stopped))?;
        self.follow(&orbits.clone().near_orbit(&last.orbit).from(from).to(to))?;
        Ok(())
    }

    /// Adds a branch: its curve, its data and its special orbits. Branches of one period have one place in the legend.
    fn add(&mut self, branch: &Branch) {
        let Some(first) = branch.points.first() else {
            return;
        };
        let label = format!("period {}", first.orbit.period);
        let runs = branch.runs();
        match self.curves.iter_mut().find(|curve| curve.label == label) {
            Some(curve) => curve.runs.extend(runs),
            None => self.curves.push(Curve { label, runs }),
        }
        for event in &branch.events {
            let place = place(&event.point);
            self.marks.push((event.kind, place));
        }
        self.events.extend(branch.events.iter().cloned());
        let rows = branch.points.iter().map(row);
        self.drawing.data.rows.extend(rows);
    }

    fn drawn(mut self, x: &str, y: [f64; 2]) -> Drawing {
        let mut chart = Chart::new(self.task.figure.title())
            .x(x)
            .y("peak-to-peak displacement");
        chart = chart.scales(Scale::Linear, self.scale);
        let ends = self.curves.iter().flat_map(|curve| &curve.runs);
        let values = ends.flat_map(|run| &run.points).map(|point| point[0]);
        let (low, high) = values.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), x| {
            (low.min(x), high.max(x))
        });
        if low < high {
            chart = chart.limits([low, high], y);
        }
        for curve in self.curves {
            chart = chart.curve(curve);
        }
        self.drawing.svg = event_markers(self.marks).fold(chart, Chart::marks).to_svg();
        self.drawing
    }
}

fn place(point: &Point) -> [f64; 2] {
    [point.value, point.peak_to_peak()]
}

fn row(point: &Point) -> Vec<String> {
    let largest = point.stability.multipliers.iter().map(|m| m.norm());
    let largest = largest.fold(0.0, f64::max);
    vec![
        point.orbit.period.to_string(),
        format!("{:?}", point.value),
        format!("{:?}", point.peak_to_peak()),
        point.stability.verdict.to_string(),
        format!("{largest:?}"),
    ]
}

/// Everything that is connected with period one by bifurcations, as the amplitude changes.
///
/// # Errors
/// If the first branch does not begin.
pub fn figure_8a(task: &Task<'_>) -> Result<Drawing, String> {
    let model = model(0.1);
    let request = Bifurcations::of(&model).vary("drive").omega(1.0);
    let request = request.from(0.1).to(2.1).depth(3);
    let diagram = request.run().map_err(|error| chain(&error).to_string())?;
    let mut figure = Cycles::new(task, "drive");
    for branch in &diagram.branches {
        figure.add(&branch.branch);
    }
    figure.drawing.note = format!(
        "{} branches, found from the first one by themselves.",
        diagram.branches.len()
    );
    let events = std::mem::take(&mut figure.events);
    for (period, kind, drive, what) in exact::AMPLITUDES {
        let alike = events
            .iter()
            .filter(|e| e.kind == kind && e.point.orbit.period == period);
        let distance = |event: &Event| (event.point.value - drive).abs();
        let nearest = alike.min_by(|a, b| distance(a).total_cmp(&distance(b)));
        let found = nearest.filter(|event| distance(event) < 1e-3);
        let value = match found {
            Some(event) => Value::of(format!("{what}, A"), event.point.value)
                .stated(event.error)
                .exact(Some(drive)),
            None => Value::missing(format!("{what}, A"), drive),
        };
        figure.drawing.values.push(value);
    }
    Ok(figure.drawn("excitation amplitude A", [0.0, 28.0]))
}

/// Orbits of period one to five as the frequency changes.
///
/// # Errors
/// If a branch does not begin.
pub fn figure_9a(task: &Task<'_>) -> Result<Drawing, String> {
    let model = model(1.0);
    let mut figure = Cycles::new(task, "omega");
    let shooting = FrequencyResponse::of(&model).by(Shooting::new());
    figure.follow(&shooting.clone().from(2.2).to(0.4))?;
    for (period, state) in COEXISTING {
        let orbits = shooting.clone().period(period);
        let near = orbits.clone().near_state(&state);
        figure.follow(&near.clone().from(1.0).to(0.4))?;
        let fold = figure.follow(&near.from(1.0).to(2.2))?;
        figure.continue_from(&fold, &orbits, [1.0, 0.4])?;
    }
    for (period, _, exact) in exact::COEXISTING {
        let state = COEXISTING.iter().find(|known| known.0 == period);
        let orbits = shooting.clone().period(period);
        let near = state.map_or(orbits.clone(), |known| orbits.near_state(&known.1));
        let point = near.orbit(1.0).map_err(|error| chain(&error).to_string())?;
        let what = format!("period {period} at ω = 1: peak-to-peak");
        let value = Value::of(what, point.peak_to_peak()).exact(Some(exact));
        figure.drawing.values.push(value);
    }
    figure.scale = Scale::Logarithmic;
    Ok(figure.drawn("excitation frequency ω", [0.4, 150.0]))
}

/// Table 1: multipliers of period eight beside its fold.
///
/// # Errors
/// If an orbit is not found where there is one.
pub fn table_1(task: &Task<'_>) -> Result<Drawing, String> {
    let model = model(1.7798);
    let shooting = FrequencyResponse::of(&model)
        .by(Shooting::new())
        .vary("drive")
        .omega(1.0)
        .period(8);
    let mut figure = Cycles::new(task, "drive");
    let branch = shooting
        .clone()
        .near_state(&PERIOD_8)
        .from(1.7798)
        .to(1.7799);
    let branch = figure.follow(&branch)?;
    let mut values = Vec::new();
    let mut near = PERIOD_8.to_vec();
    for column in &exact::TABLE_1 {
        match shooting.clone().near_state(&near).orbit(column.drive) {
            Ok(point) => {
                near = point.orbit.state();
                values.extend(beside(column, &point));
            }
            Err(error) => values.push(fold_before(column, &error)?),
        }
    }
    let mut drawing = figure.drawing;
    drawing.svg = Chart::new(task.figure.title())
        .x("excitation amplitude A")
        .y("leading multiplier of period 8")
        .curve(Curve {
            label: String::new(),
            runs: branch.runs_of(leading),
        })
        .markers(Series {
            label: "printed in the paper".to_owned(),
            points: exact::TABLE_1
                .iter()
                .filter_map(|column| Some([column.drive, column.printed[0].parse().ok()?]))
                .collect(),
        })
        .to_svg();
    drawing.values = values;
    Ok(drawing)
}

/// The multipliers of an orbit beside those of the table.
fn beside(column: &exact::Column, point: &Point) -> [Value; 2] {
    let found = &point.stability.multipliers;
    [0, 1].map(|index| {
        let name = format!("λ{} at A = {}", ["₁", "₂"][index], column.drive);
        let found = found.get(index).map_or(f64::NAN, |m| m.re);
        let value = Value::of(name, found).stated(point.stability.error);
        let exact = column.multipliers.map(|exact| exact[index]);
        value.exact(exact).printed(column.printed[index])
    })
}

/// The fold before a column of the table at which there is no orbit.
fn fold_before(column: &exact::Column, error: &Error) -> Result<Value, String> {
    let beyond = match error.downcast_ref() {
        Some(&OrbitError::Beyond { fold, .. }) if column.multipliers.is_none() => Some(fold),
        _ => None,
    };
    let fold = beyond.ok_or_else(|| chain(error).to_string())?;
    let value = Value::of(format!("fold before A = {}", column.drive), fold);
    let exact = exact::AMPLITUDES.iter().find(|known| known.0 == 8);
    let value = value.exact(exact.map(|known| known.2));
    Ok(value.printed("1.0020 and 0.1833: there is no orbit"))
}

/// Amplitude and leading multiplier.
fn leading(point: &Point) -> [f64; 2] {
    let multipliers = point.stability.multipliers.iter().map(|m| m.re);
    [point.value, multipliers.fold(f64::NEG_INFINITY, f64::max)]
}
