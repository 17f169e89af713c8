//! `--bifurcations`, `--follow` and `--track`: what begins on the branch, by shooting where that finds orbits.

use std::fmt::{self, Write};

use hertzian::bifurcation::{Bifurcations, Diagram, DiagramBranch, Origin, Reason};
use hertzian::chart::{Chart, Scale, Series, View};
use hertzian::error::{ErrorKind, chain};
use hertzian::export;
use hertzian::shooting::BifurcationCurve;
use hertzian::{
    Branch, Cancel, Error, Event, EventKind, FrequencyResponse, HarmonicBalance, ModelError, Point,
    RequestError, Shooting, System,
};

use super::covered;
use super::options::{Options, Tracked};
use super::progress::Seen;
use super::run::{Failure, in_range};
use super::search::basin;
use super::summary;
use super::value::{self, of_varied};

/// Sizes of orbits in a larger ratio than this are drawn over decades.
const DECADES: f64 = 50.0;

/// What was found.
#[derive(Debug)]
pub struct Found {
    /// The branches; the first is the one that was asked for.
    pub diagram: Diagram,
    /// Curves of bifurcations in two parameters.
    pub tracks: Vec<BifurcationCurve>,
    /// What could not be done.
    pub warnings: Vec<String>,
}

/// Everything beyond the branch itself that was asked for; nothing if nothing was, or if it was cancelled before there was anything. `seen` is shown
/// every orbit.
///
/// # Errors
/// If an option cannot be used, or there is no first orbit.
pub fn find(
    options: &Options,
    model: &dyn System,
    cancel: &Cancel,
    seen: &mut Seen<'_>,
) -> Result<Option<Found>, Error> {
    if !options.bifurcations && options.track.is_none() {
        return Ok(None);
    }
    let mut request = Bifurcations::of(model)
        .from(options.range.from)
        .to(options.range.to)
        .period(options.period)
        .depth(options.follow.unwrap_or(0));
    if let Some(points) = options.max_points {
        request = request.max_points(points);
    }
    if options.bifurcations
        && let Some(settling) = covered::settling(options, &in_range(options, model))?
    {
        request = request.cover(settling);
    }
    if !options.over_frequency() {
        request = request
            .vary(options.varied())
            .omega(options.model.frequency());
    }
    for &value in &options.search {
        request = request.search(value, basin(options, model, value));
    }
    let request = request.cancel(cancel);
    let diagram = match request.run_with(|progress| seen.see(progress)) {
        // Nothing holds the system somewhere, which shooting has no equation for.
        Err(error) if matches!(error.downcast_ref(), Some(ModelError::Free { .. })) => request
            .by(HarmonicBalance::new())
            .run_with(|progress| seen.see(progress)),
        diagram => diagram,
    };
    let diagram = match diagram {
        Err(error) if error.kind() == ErrorKind::Cancelled => return Ok(None),
        diagram => diagram?,
    };
    let mut found = Found {
        diagram,
        tracks: Vec::new(),
        warnings: Vec::new(),
    };
    if let Some(kind) = options.track {
        found.track(options, model, kind, cancel, seen)?;
    }
    Ok(Some(found))
}

/// Whether curves in two parameters can be followed.
///
/// # Errors
/// If a name is not known or not the one that varies, or the second parameter cannot have the values of its range.
pub fn check(options: &Options, model: &dyn System) -> Result<(), Failure> {
    if options.track.is_none() {
        return Ok(());
    }
    let second = second(options, model)?;
    let value = value_of(options, model, second);
    let [low, high] = within(options, value);
    if !options.within.is_empty() && !(low..=high).contains(&value) {
        let message = format!("--within must hold {second} = {value}, where the curves begin");
        return Err(Failure::Option(message));
    }
    let mut parameters = model.facts().parameters.iter();
    let facts = parameters.find(|parameter| parameter.name == second);
    let admits = |value: f64| {
        facts.map_or(value > 0.0 && value.is_finite(), |facts| {
            facts.admits(value)
        })
    };
    // NaN is no range either.
    if low < high && admits(low) && admits(high) {
        return Ok(());
    }
    let given = if options.within.is_empty() {
        ", from half to twice its value: give another by --within"
    } else {
        ""
    };
    Err(Failure::Option(format!(
        "--track: {second} cannot vary from {low} to {high}{given}"
    )))
}

/// The range of the second parameter, which has this value.
fn within(options: &Options, value: f64) -> [f64; 2] {
    match options.within[..] {
        [low, high] => [low, high],
        _ if value < 0.0 => [2.0 * value, 0.5 * value],
        _ => [0.5 * value, 2.0 * value],
    }
}

impl Found {
    /// Tracks every event of a kind, but those that are on a curve already.
    fn track(
        &mut self,
        options: &Options,
        model: &dyn System,
        tracked: Tracked,
        cancel: &Cancel,
        seen: &mut Seen<'_>,
    ) -> Result<(), Error> {
        let is_wanted = |kind: EventKind| match tracked {
            Tracked::Fold => kind == EventKind::Fold,
            Tracked::PeriodDoubling => kind == EventKind::PeriodDoubling,
            Tracked::BranchPoint => kind == EventKind::SymmetryBreaking,
            Tracked::Grazing => matches!(kind, EventKind::Grazing { .. }),
        };
        let shooting = shooting(options, model).cancel(cancel);
        let second = second(options, model)?;
        let value = value_of(options, model, second);
        let range = within(options, value);
        let events: Vec<Event> = self
            .diagram
            .branches
            .iter()
            .filter(|branch| !branch.mirrored)
            .flat_map(|branch| &branch.branch.events)
            .filter(|event| is_wanted(event.kind))
            .cloned()
            .collect();
        for event in events {
            if cancel.is_cancelled() {
                break;
            }
            seen.at(event.point.value);
            let on_it = |track: &&BifurcationCurve| passes(track, &event, value);
            if self.tracks.iter().any(|track| on_it(&track)) {
                continue;
            }
            let tracked = shooting.track_with(&event, second, range, |progress| seen.see(progress));
            match tracked {
                Ok(track) => self.tracks.push(track),
                Err(error) => self
                    .warnings
                    .push(format!("{event} is not tracked: {}", chain(&error))),
            }
        }
        Ok(())
    }

    /// The branches.
    pub fn branches(&self) -> impl Iterator<Item = &Branch> {
        self.diagram.branches.iter().map(|found| &found.branch)
    }

    /// The picture: of the curves in two parameters if there are any, of the branches otherwise.
    ///
    /// # Errors
    /// If what was asked for is not there.
    pub fn chart(
        &self,
        options: &Options,
        model: &dyn System,
        view: &View,
    ) -> Result<Chart, Error> {
        let Some(track) = self.tracks.first() else {
            let chart = self.diagram.chart_of(view)?;
            let free = options.plot.is_empty() && options.look.stack == 0;
            let chart = if free && options.look.scale.is_none() {
                chart.scales(Scale::Linear, self.scale())
            } else {
                chart
            };
            return Ok(summary::titled(chart, options, model));
        };
        let [x, y] = &track.names;
        let title = summary::title(options, model, &track.names);
        let axis = |name: &str| match self.unit(name) {
            "" => name.to_owned(),
            unit => format!("{name} [{unit}]"),
        };
        let mut chart = Chart::new(title).x(axis(x)).y(axis(y));
        let mut special = Vec::new();
        for track in &self.tracks {
            chart = chart.trace(Series {
                label: format!("{}, period {}", track.kind, track.period),
                points: track.values.clone(),
            });
            special.extend(&track.special);
        }
        for kind in ["cusp", "grazing", "fold-flip", "double", "degenerate"] {
            let of_kind = special.iter().filter(|s| s.kind.to_string() == kind);
            let points: Vec<_> = of_kind.map(|special| special.values).collect();
            if !points.is_empty() {
                let label = kind.to_owned();
                chart = chart.marks(Series { label, points });
            }
        }
        Ok(chart)
    }

    /// The unit of a parameter, or of the frequency.
    fn unit(&self, name: &str) -> &str {
        let first = self.diagram.branches.first();
        first.map_or("", |first| first.branch.model.unit_of_varied(name))
    }

    /// Orbits of very different sizes are drawn over decades.
    fn scale(&self) -> Scale {
        let points = self
            .diagram
            .branches
            .iter()
            .flat_map(|branch| &branch.branch.points);
        let sizes = points.map(Point::peak_to_peak);
        let (low, high) = sizes.fold((f64::INFINITY, 0.0_f64), |(low, high), size| {
            (low.min(size), high.max(size))
        });
        if low > 0.0 && high > DECADES * low {
            Scale::Logarithmic
        } else {
            Scale::Linear
        }
    }

    /// For people.
    pub fn summary(&self, varied: &str) -> String {
        let mut text = String::new();
        // Writing to a string does not fail.
        let _ = self.write(&mut text, varied);
        text
    }

    fn write(&self, text: &mut String, varied: &str) -> fmt::Result {
        for (number, branch) in self.diagram.branches.iter().enumerate() {
            describe(text, number + 1, branch)?;
        }
        let deep = |reason: &Reason| matches!(reason, Reason::Depth);
        let left = self.diagram.omitted.iter();
        let deep = left.filter(|omitted| deep(&omitted.reason)).count();
        if deep > 0 {
            let begin = if deep == 1 {
                "branch begins"
            } else {
                "branches begin"
            };
            writeln!(text, "deeper     {deep} {begin} beyond the depth asked for")?;
        }
        for omitted in &self.diagram.omitted {
            let reason = &omitted.reason;
            let worth_saying = matches!(
                reason,
                Reason::Failed(_) | Reason::Budget | Reason::Interrupted
            );
            if worth_saying {
                writeln!(
                    text,
                    "omitted    on branch {}: {reason}",
                    omitted.branch + 1
                )?;
            }
        }
        covered::write_search(text, &self.diagram, varied)?;
        for track in &self.tracks {
            let count = track.points.len();
            let [x, y] = &track.names;
            let (kind, period) = (track.kind, track.period);
            let [begin, end] = &track.ends;
            writeln!(
                text,
                "curve      {kind}, period {period}: {count} points in {x}, {y}; {begin} and {end}"
            )?;
            for special in &track.special {
                let place = |number: usize| {
                    let value = export::rounded(special.values[number], 9);
                    value::with(self.unit(&track.names[number]), value)
                };
                let [a, b] = [place(0), place(1)];
                let error = special.error;
                writeln!(
                    text,
                    "  {:<8} {x} {a}, {y} {b} (error {error:.0e})",
                    special.kind
                )?;
            }
        }
        let milliseconds = 1e3 * self.diagram.elapsed.as_secs_f64();
        writeln!(text, "shooting   {milliseconds:.0} ms for all branches")
    }
}

/// A branch, and what is on it.
///
/// # Errors
/// None: writing to a string does not fail.
pub fn describe(text: &mut String, number: usize, branch: &DiagramBranch) -> fmt::Result {
    let from = match branch.origin {
        Origin::Event { branch, .. } => format!(", from branch {}", branch + 1),
        Origin::Attractor { value } | Origin::Solved { value } => {
            format!(", found at {}", of_varied(&branch.branch, value))
        }
        Origin::OtherEnd => ", from the other end".to_owned(),
        _ => String::new(),
    };
    let (period, count) = (branch.period(), branch.branch.points.len());
    writeln!(
        text,
        "branch {number:<3} period {period}{from}: {count} orbits, {}",
        branch.branch.stopped
    )?;
    for event in &branch.branch.events {
        writeln!(text, "  {}", branch.branch.describe(event))?;
    }
    for turn in &branch.branch.turns {
        let why = if turn.test.is_nan() {
            "orbits beside it tell, and it was not found"
        } else {
            "a test function changes its sign, and was not driven to zero"
        };
        let value = of_varied(&branch.branch, format_args!("{:.6}", turn.value));
        writeln!(text, "  unlocated at {value}: {why}")?;
    }
    Ok(())
}

/// Shooting over the range of the branch, and a part of it beyond.
fn shooting(options: &Options, model: &dyn System) -> FrequencyResponse<Shooting> {
    let margin = 0.1 * (options.range.to - options.range.from);
    let mut parameters = model.facts().parameters.iter();
    let parameter = parameters.find(|parameter| parameter.name == options.varied());
    let admitted = |value: f64| parameter.map_or(value > 0.0, |p| p.admits(value));
    let widened = |end: f64, by: f64| if admitted(end + by) { end + by } else { end };
    in_range(options, model)
        .by(Shooting::new())
        .from(widened(options.range.from, -margin))
        .to(widened(options.range.to, margin))
}

/// The parameter of `--in` that is not what varies along the branch.
fn second<'o>(options: &'o Options, model: &dyn System) -> Result<&'o str, Error> {
    let first = options.varied();
    let names = &options.plane;
    let second = names.iter().find(|name| *name != first);
    let has_first = names.iter().any(|name| name == first);
    let parameters = model.facts().parameters.iter();
    let known: Vec<String> = parameters
        .map(|parameter| parameter.name.to_string())
        .chain(["omega".to_owned()])
        .collect();
    let is_known = |name: &&String| has_first && known.contains(name);
    if let Some(name) = second.filter(is_known) {
        return Ok(name);
    }
    let unknown = names.iter().find(|name| !known.contains(name));
    let name = unknown.cloned().unwrap_or_else(|| names.join(","));
    Err(RequestError::UnknownParameter { name, known }.into())
}

fn value_of(options: &Options, model: &dyn System, name: &str) -> f64 {
    let facts = model.facts();
    let mut values = vec![0.0; facts.parameters.len()];
    model.values(&mut values);
    let index = facts.parameters.iter().position(|p| p.name == name);
    index.map_or(options.model.frequency(), |index| values[index])
}

/// Whether a curve passes an event, which has this value of the second parameter.
fn passes(track: &BifurcationCurve, event: &Event, value: f64) -> bool {
    let values = track.values.iter();
    let size = values.fold(0.0, |m: f64, [first, _]| m.max(first.abs()));
    track.period == event.point.orbit.period
        && track.values.windows(2).any(|pair| {
            let [a, b] = [pair[0], pair[1]];
            let part = (value - a[1]) / (b[1] - a[1]);
            let at = a[0] + part * (b[0] - a[0]);
            (0.0..=1.0).contains(&part) && (at - event.point.value).abs() < 1e-3 * size
        })
}
