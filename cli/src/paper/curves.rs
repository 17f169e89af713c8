//! Figures of frequency-response curves: 2 to 7.

use hertzian::Side;
use hertzian::chart::{Chart, Curve, Scale, Series, event_markers};
use hertzian::error::chain;
use hertzian::export;
use hertzian::{Branch, Event, EventKind, FrequencyResponse, OrbitMethodKind, Stop, System};

use super::exact;
use super::figure::{Drawing, Table, Task, Value};
use crate::model::ModelOptions;
use crate::response::boundary::loss_of_contact;
use crate::response::models::declared;

/// Column of peak-to-peak in the data: the name of the curve comes before those of `hertzian response`.
const PEAK_TO_PEAK: usize = 3;

/// A curve of a figure.
#[derive(Debug, Clone)]
pub struct Case {
    /// What the legend says of it.
    pub label: String,
    /// The oscillator.
    pub model: ModelOptions,
    /// The frequencies at which it begins and ends.
    pub range: [f64; 2],
    /// Name of its exact values, if there are any.
    pub exact: &'static str,
}

impl Case {
    /// A one-sided contact at damping ratio 0.032, load 1 and amplitude 0.1.
    pub fn one_sided(label: impl Into<String>, alpha: f64, range: [f64; 2]) -> Self {
        Self {
            label: label.into(),
            model: ModelOptions {
                alpha,
                one_sided: true,
                continuous: false,
                file: None,
                set: Vec::new(),
                zeta: 0.032,
                load: 1.0,
                drive: 0.1,
                omega: None,
            },
            range,
            exact: "",
        }
    }

    /// A spring in both directions at damping ratio 0.01, without load, at amplitude 0.1.
    pub fn continuous(label: impl Into<String>, alpha: f64, range: [f64; 2]) -> Self {
        let mut case = Self::one_sided(label, alpha, range);
        case.model.one_sided = false;
        case.model.continuous = true;
        case.model.zeta = 0.01;
        case.model.load = 0.0;
        case
    }

    /// With this load.
    #[must_use]
    pub fn load(mut self, load: f64) -> Self {
        self.model.load = load;
        self
    }

    /// With this damping ratio.
    #[must_use]
    pub fn zeta(mut self, zeta: f64) -> Self {
        self.model.zeta = zeta;
        self
    }

    /// With exact values of its special orbits.
    #[must_use]
    pub fn compared(mut self, exact: &'static str) -> Self {
        self.exact = exact;
        self
    }
}

/// A figure that grows by curves.
pub struct Curves<'t> {
    task: &'t Task<'t>,
    chart: Chart,
    lines: Vec<Curve>,
    marks: Vec<(EventKind, [f64; 2])>,
    drawing: Drawing,
    notes: Vec<String>,
}

impl<'t> Curves<'t> {
    /// Without any.
    pub fn new(task: &'t Task<'t>) -> Self {
        let names = std::iter::once("curve").chain(export::COLUMNS);
        Self {
            task,
            chart: Chart::new(task.figure.title())
                .x("excitation frequency ω")
                .y("peak-to-peak displacement"),
            lines: Vec::new(),
            marks: Vec::new(),
            drawing: Drawing {
                data: Table {
                    names: names.map(str::to_owned).collect(),
                    rows: Vec::new(),
                },
                ..Drawing::default()
            },
            notes: Vec::new(),
        }
    }

    /// Shows small orbits beside large ones.
    #[must_use]
    pub fn logarithmic(mut self) -> Self {
        self.chart = self.chart.scales(Scale::Linear, Scale::Logarithmic);
        self
    }

    /// Traces a curve and adds it.
    ///
    /// # Errors
    /// If no orbit is found to start from.
    pub fn trace(mut self, case: &Case) -> Result<Self, String> {
        let system = declared(&case.model);
        let request = request(&*system, case);
        let branch = self.followed(case, &request)?;
        self.compare(case, &branch.events);
        Ok(self)
    }

    /// Traces a curve, and what begins where its orbits lose their symmetry.
    ///
    /// # Errors
    /// If no orbit is found to start from.
    pub fn trace_all(mut self, case: &Case) -> Result<Self, String> {
        let system = declared(&case.model);
        let request = request(&*system, case);
        let branch = self.followed(case, &request)?;
        let mut events = branch.events.clone();
        let breaks = |event: &&Event| event.kind == EventKind::SymmetryBreaking;
        // The other methods look for them anyhow.
        let beyond = match request.choice() {
            OrbitMethodKind::HarmonicBalance => request.clone().doublings(true),
            _ => request.clone(),
        };
        // Such a branch ends where it meets the curve again: it does not begin there once more.
        let mut ends = Vec::new();
        for event in branch.events.iter().filter(breaks) {
            if ends
                .iter()
                .any(|end: &f64| (end - event.point.value).abs() < 1e-5)
            {
                continue;
            }
            match beyond.clone().switch(event, Side::One) {
                Ok(mut broken) => {
                    self.complete("without symmetry", &mut broken);
                    if let Stop::Joined { value, .. } = broken.stopped {
                        ends.push(value);
                    }
                    self.add("without symmetry", &broken);
                    let joint = |event: &&Event| event.kind != EventKind::BranchPoint;
                    events.extend(broken.events.iter().filter(joint).cloned());
                }
                Err(error) => self.notes.push(format!(
                    "What begins at {:.6} was not followed: {}.",
                    event.point.value,
                    chain(&error)
                )),
            }
        }
        let unnamed = Case {
            label: String::new(),
            ..case.clone()
        };
        self.compare(&unnamed, &events);
        Ok(self)
    }

    /// Traces a curve until it ends or is interrupted.
    fn followed(&mut self, case: &Case, request: &FrequencyResponse) -> Result<Branch, String> {
        let followed = request.clone().cancel(self.task.cancel).run();
        let mut branch = followed.map_err(|error| chain(&error).to_string())?;
        self.complete(&case.label, &mut branch);
        self.add(&case.label, &branch);
        Ok(branch)
    }

    /// Has what takes the whole motion read off the orbits of a curve, for the data.
    fn complete(&mut self, label: &str, branch: &mut Branch) {
        if let Err(error) = branch.complete_all() {
            let why = chain(&error);
            self.notes.push(format!(
                "Not all orbits of the curve {label} are complete: {why}."
            ));
        }
    }

    /// Adds a branch: its curve, its data and its special orbits. Branches of one name have one place in the legend.
    pub fn add(&mut self, label: &str, branch: &Branch) {
        match self.lines.iter_mut().find(|curve| curve.label == label) {
            Some(curve) => curve.runs.extend(branch.runs()),
            None => self.lines.push(Curve {
                label: label.to_owned(),
                runs: branch.runs(),
            }),
        }
        for event in &branch.events {
            let place = [event.point.value, event.point.peak_to_peak()];
            self.marks.push((event.kind, place));
        }
        for point in &branch.points {
            let mut row = vec![label.to_owned()];
            row.extend(export::cells(0, point));
            self.drawing.data.rows.push(row);
        }
        let joined = matches!(branch.stopped, Stop::Joined { .. });
        if branch.stopped != Stop::ReachedEnd && !joined {
            let why = &branch.stopped;
            self.notes
                .push(format!("The curve {label} ended early: {why}."));
        }
    }

    /// Puts special orbits beside the exact ones, each to the nearest of its kind, if there is something to compare with.
    fn compare(&mut self, case: &Case, events: &[Event]) {
        if case.exact.is_empty() {
            return;
        }
        let [from, to] = case.range;
        let within = |omega: f64| from.min(to) <= omega && omega <= from.max(to);
        let known = exact::frequencies(case.exact).iter();
        let mut unclaimed: Vec<&Event> = events.iter().collect();
        for &(kind, omega) in known.filter(|(_, omega)| within(*omega)) {
            let distance = |event: &Event| (event.point.value - omega).abs();
            let alike = unclaimed.iter().enumerate().filter(|(_, e)| e.kind == kind);
            let nearest = alike.min_by(|a, b| distance(a.1).total_cmp(&distance(b.1)));
            let what = described(case, kind);
            let found = nearest.filter(|(_, event)| distance(event) < 1e-3);
            self.drawing
                .values
                .push(match found.map(|(index, _)| index) {
                    Some(index) => value(what, unclaimed.remove(index)).exact(Some(omega)),
                    None => Value::missing(what, omega),
                });
        }
        if !unclaimed.is_empty() {
            let more = "Special orbits without a reference are ours alone: those that were computed independently are not all.";
            self.notes.push(more.to_owned());
        }
        for event in unclaimed {
            let what = described(case, event.kind);
            self.drawing.values.push(value(what, event));
        }
    }

    /// Adds a value to compare.
    pub fn value(&mut self, value: Value) {
        self.drawing.values.push(value);
    }

    /// Adds a line to compare with.
    #[must_use]
    pub fn reference(mut self, label: impl Into<String>, points: Vec<[f64; 2]>) -> Self {
        self.chart = self.chart.reference(Series {
            label: label.into(),
            points,
        });
        self
    }

    /// Adds the boundary beyond which contact is lost.
    #[must_use]
    pub fn boundary(self, case: &Case) -> Self {
        let [from, to] = case.range;
        let points = loss_of_contact(&case.model, from..=to, self.task.cancel);
        let drawn = self
            .drawing
            .data
            .rows
            .iter()
            .filter_map(|row| row.get(PEAK_TO_PEAK)?.parse().ok());
        let top = drawn.fold(0.0, f64::max);
        let low = points
            .iter()
            .map(|point| point[1])
            .fold(f64::INFINITY, f64::min);
        let mut figure = self.reference("loss of contact", points);
        // Where no curve reaches it, the chart would not either.
        if top < low && low.is_finite() {
            figure.chart = figure
                .chart
                .limits([from.min(to), from.max(to)], [0.0, 1.2 * low]);
        }
        figure
    }

    /// What came of it.
    pub fn drawn(self) -> Drawing {
        let Self {
            chart,
            lines,
            marks,
            mut drawing,
            notes,
            ..
        } = self;
        let drawn = lines.into_iter().fold(chart, Chart::curve);
        drawing.svg = event_markers(marks).fold(drawn, Chart::marks).to_svg();
        drawing.note = notes.join(" ");
        drawing
    }
}

/// What is asked for. A picture alone needs no more than the eye can see.
fn request(system: &dyn System, case: &Case) -> FrequencyResponse {
    let [from, to] = case.range;
    let tolerance = if case.exact.is_empty() { 1e-4 } else { 1e-6 };
    FrequencyResponse::of(system)
        .from(from)
        .to(to)
        .tolerance(tolerance)
}

fn described(case: &Case, kind: EventKind) -> String {
    if case.label.is_empty() {
        format!("{kind}, ω")
    } else {
        format!("{}: {kind}, ω", case.label)
    }
}

fn value(what: String, event: &Event) -> Value {
    Value::of(what, event.point.value).stated(event.error)
}
