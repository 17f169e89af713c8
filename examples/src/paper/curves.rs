//! Figures of frequency-response curves: 2 to 7 and 9a.

use std::ops::ControlFlow;
use std::sync::atomic::Ordering;

use hertzian::chart::{Chart, Curve, Markers, Reference, Scale};
use hertzian::{Branch, Event, EventKind, FrequencyResponse, Stop};

use super::exact;
use super::figure::{Drawing, Table, Task, Value};
use crate::model::ModelOptions;
use crate::response::boundary::loss_of_contact;
use crate::response::files;
use crate::response::models::declared;
use crate::response::records::PointRecord;

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
                omega: 1.0,
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
    marks: [Vec<[f64; 2]>; 2],
    drawing: Drawing,
    notes: Vec<String>,
}

impl<'t> Curves<'t> {
    /// Without any.
    pub fn new(task: &'t Task<'t>) -> Self {
        let names = std::iter::once("curve").chain(files::COLUMNS);
        Self {
            task,
            chart: Chart::new(format!("{}: {}", task.figure.name, task.figure.parameters))
                .x("excitation frequency ω")
                .y("peak-to-peak displacement"),
            marks: Default::default(),
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
        let [from, to] = case.range;
        // A picture alone needs no more than the eye can see.
        let tolerance = if case.exact.is_empty() { 1e-4 } else { 1e-6 };
        let branch = FrequencyResponse::of(&*system)
            .from(from)
            .to(to)
            .tolerance(tolerance)
            .run_with(|_| {
                if self.task.interrupted.load(Ordering::Relaxed) {
                    ControlFlow::Break(())
                } else {
                    ControlFlow::Continue(())
                }
            })
            .map_err(|error| error.to_string())?;
        self.add(&case.label, &branch);
        self.compare(case, &branch);
        Ok(self)
    }

    /// Adds a branch: its curve, its data and its special orbits.
    pub fn add(&mut self, label: &str, branch: &Branch<'_>) {
        let facts = branch.system().facts();
        self.chart = std::mem::take(&mut self.chart).curve(Curve {
            label: label.to_owned(),
            runs: branch.runs(),
        });
        for event in &branch.events {
            let place = [event.point.value, event.point.peak_to_peak()];
            match event.kind {
                EventKind::Fold => self.marks[0].push(place),
                _ => self.marks[1].push(place),
            }
        }
        for point in &branch.points {
            let mut row = vec![label.to_owned()];
            row.extend(files::row(&PointRecord::of(point, facts)));
            self.drawing.data.rows.push(row);
        }
        if branch.stopped != Stop::ReachedEnd {
            let why = &branch.stopped;
            self.notes
                .push(format!("The curve {label} ended early: {why}."));
        }
    }

    /// Puts the special orbits of a branch beside the exact ones: each to the nearest of its kind.
    fn compare(&mut self, case: &Case, branch: &Branch<'_>) {
        let known = exact::frequencies(case.exact);
        let mut unclaimed: Vec<&Event> = branch.events.iter().collect();
        for &(kind, omega) in known {
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
        for event in unclaimed {
            let what = described(case, event.kind);
            self.drawing.values.push(value(what, event));
        }
    }

    /// Adds a line to compare with.
    #[must_use]
    pub fn reference(mut self, label: impl Into<String>, points: Vec<[f64; 2]>) -> Self {
        self.chart = self.chart.reference(Reference {
            label: label.into(),
            points,
        });
        self
    }

    /// Adds the boundary beyond which contact is lost.
    #[must_use]
    pub fn boundary(self, case: &Case) -> Self {
        let [from, to] = case.range;
        let stop = || self.task.interrupted.load(Ordering::Relaxed);
        let points = loss_of_contact(&case.model, from..=to, stop);
        self.reference("loss of contact", points)
    }

    /// What came of it.
    pub fn drawn(self) -> Drawing {
        let Self {
            chart,
            marks: [folds, others],
            mut drawing,
            notes,
            ..
        } = self;
        drawing.svg = chart
            .markers(Markers {
                label: "fold".to_owned(),
                points: folds,
            })
            .markers(Markers {
                label: "symmetry-breaking".to_owned(),
                points: others,
            })
            .to_svg();
        drawing.note = notes.join(" ");
        drawing
    }
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
