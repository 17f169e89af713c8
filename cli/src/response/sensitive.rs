//! `--sensitivities`, `--tornado` and `--uncertain`: how orbits and events change with the parameters.

use std::fmt::Write;
use std::io;
use std::path::Path;

use hertzian::bifurcation::Diagram;
use hertzian::chart::{Chart, Page, View};
use hertzian::error::{ErrorKind, chain};
use hertzian::export;
use hertzian::observe::Wanted;
use hertzian::sensitivity::{Measured, Sensitivities, Uncertain};
use hertzian::{Branch, Cancel, Error, Event, Model, Point, System};
use serde::{Deserialize, Serialize};
use serde_json::Value;

use super::files::write_csv;
use super::options::Options;
use super::progress::Seen;
use super::run::Failure;
use super::value::of_varied;

/// Derivatives at one place of a branch.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub struct At {
    /// The number of the branch.
    pub branch: usize,
    /// Which of its points, or of its events.
    #[serde(flatten)]
    pub place: Place,
    /// What varies, there.
    pub value: f64,
    /// The derivatives; nothing where there are none.
    pub derivatives: Option<Sensitivities>,
    /// Why there are none.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub why: Option<String>,
}

/// A point or an event, by its number.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Place {
    /// A point.
    Point(usize),
    /// An event.
    Event(usize),
}

/// Whether all that is uncertain is a parameter, or the frequency, and given once.
///
/// # Errors
/// If something is not.
pub fn check(options: &Options, model: &dyn System) -> Result<(), Failure> {
    let known = Model::of(model);
    let names = || options.uncertain.iter().map(Uncertain::name);
    crate::values::once("--uncertain", names()).map_err(Failure::Option)?;
    let is_known = |name: &str| {
        name == "omega"
            || known
                .parameters
                .iter()
                .any(|parameter| parameter.name == name)
    };
    if let Some(name) = names().find(|name| !is_known(name)) {
        let parameters = known
            .parameters
            .iter()
            .map(|parameter| parameter.name.as_str());
        let parameters: Vec<&str> = parameters.collect();
        return Err(Failure::Option(format!(
            "--uncertain {name}: there is no parameter {name}; there are {}",
            parameters.join(", ")
        )));
    }
    Ok(())
}

/// Derivatives of everything that is asked for: at every orbit for a table, at every event for that and for a tornado chart. Nothing
/// if nothing was; what was found where it is cancelled.
///
/// # Errors
/// If what is asked for has no derivatives at all.
fn find(
    options: &Options,
    branches: &[Branch],
    cancel: &Cancel,
    seen: &mut Seen<'_>,
) -> Result<Vec<At>, Error> {
    let mut all = Vec::new();
    let everywhere = options.sensitivities.is_some();
    if !everywhere && options.tornado.is_none() {
        return Ok(all);
    }
    for (branch, own) in branches.iter().enumerate() {
        let points = own.points.iter().enumerate().filter(|_| everywhere);
        for (index, point) in points {
            if cancel.is_cancelled() {
                return Ok(all);
            }
            seen.at(point.value);
            let found = of_point(own, point, &options.plot);
            all.push(at(branch, Place::Point(index), point.value, found)?);
        }
        for (index, event) in own.events.iter().enumerate() {
            if cancel.is_cancelled() {
                return Ok(all);
            }
            let found = of_event(own, event, &options.plot);
            all.push(at(branch, Place::Event(index), event.point.value, found)?);
        }
    }
    Ok(all)
}

/// The same, or why there is none of it: what was computed is not lost for that.
pub fn found(
    options: &Options,
    branches: &[Branch],
    cancel: &Cancel,
    seen: &mut Seen<'_>,
) -> (Vec<At>, Option<String>) {
    match find(options, branches, cancel, seen) {
        Ok(found) => (found, None),
        Err(error) => (
            Vec::new(),
            Some(format!("no sensitivities: {}", chain(&error))),
        ),
    }
}

fn of_point(branch: &Branch, point: &Point, wanted: &[Wanted]) -> Result<Sensitivities, Error> {
    if wanted.is_empty() {
        branch.sensitivities(point)
    } else {
        branch.sensitivities_of(point, wanted)
    }
}

fn of_event(branch: &Branch, event: &Event, wanted: &[Wanted]) -> Result<Sensitivities, Error> {
    if wanted.is_empty() {
        branch.event_sensitivities(event)
    } else {
        branch.event_sensitivities_of(event, wanted)
    }
}

/// What was found at a place, or why nothing was.
///
/// # Errors
/// If what is asked for has no derivatives anywhere.
fn at(
    branch: usize,
    place: Place,
    value: f64,
    found: Result<Sensitivities, Error>,
) -> Result<At, Error> {
    let (derivatives, why) = match found {
        Ok(found) => (Some(found), None),
        Err(error) if matches!(place, Place::Point(_)) && error.kind() == ErrorKind::Request => {
            return Err(error);
        }
        Err(error) => (None, Some(chain(&error).to_string())),
    };
    Ok(At {
        branch,
        place,
        value,
        derivatives,
        why,
    })
}

/// Writes the files that were asked for.
///
/// # Errors
/// If one cannot be written, or something uncertain is no parameter.
pub fn write(options: &Options, branches: &[Branch], all: &[At]) -> Result<(), Failure> {
    let failed = |path: &Path, error: io::Error| Failure::File(path.to_path_buf(), error);
    if let Some(path) = &options.sensitivities {
        write_csv(path, |out| table(out, branches, all)).map_err(|error| failed(path, error))?;
    }
    if let Some(path) = &options.tornado {
        let page = tornado(branches, all, &options.uncertain)?;
        export::write(path, page.to_svg()).map_err(|error| failed(path, error))?;
    }
    Ok(())
}

/// The columns of the table.
const COLUMNS: [&str; 11] = [
    "branch",
    "at",
    "value",
    "what",
    "unit",
    "size",
    "held",
    "by",
    "derivative",
    "error",
    "note",
];

fn table(out: &mut csv::Writer<Vec<u8>>, branches: &[Branch], all: &[At]) -> csv::Result<()> {
    out.write_record(COLUMNS)?;
    for at in all {
        let branch = &branches[at.branch];
        let kind = match at.place {
            Place::Point(_) => "orbit".to_owned(),
            Place::Event(index) => branch.events[index].kind.to_string(),
        };
        let begin = [at.branch.to_string(), kind, at.value.to_string()];
        let mut row = |cells: [&str; 8]| {
            let begin = begin.iter().map(String::as_str);
            out.write_record(begin.chain(cells))
        };
        let Some(found) = &at.derivatives else {
            let why = at.why.as_deref().unwrap_or_default();
            row(["", "", "", "", "", "", "", why])?;
            continue;
        };
        let unit = branch.model.unit_of_varied(&branch.varied);
        for (by, derivative) in found.variables.iter().zip(&found.place) {
            let Some(derivative) = derivative else {
                continue;
            };
            let [size, value, error] = [at.value, derivative.value, derivative.error].map(cell);
            row([&branch.varied, unit, &size, "event", by, &value, &error, ""])?;
        }
        let fixed = found
            .measured
            .iter()
            .map(|row| (row, branch.varied.as_str()));
        let moving = found.moving.iter().map(|row| (row, "event"));
        for (
            Measured {
                name,
                unit,
                value,
                by,
                ..
            },
            held,
        ) in fixed.chain(moving)
        {
            let known = found.variables.iter().zip(by);
            for (variable, by) in known.filter(|(_, by)| !by.value.is_nan()) {
                let [size, derivative, error] = [*value, by.value, by.error].map(cell);
                row([name, unit, &size, held, variable, &derivative, &error, ""])?;
            }
        }
        for missing in &found.missing {
            row([&missing.what, "", "", "", "", "", "", &missing.why])?;
        }
    }
    Ok(())
}

/// A number as short as it reads back to the same bits.
fn cell(number: f64) -> String {
    export::plain(number).to_string()
}

/// A chart for every event, two in a row.
fn tornado(branches: &[Branch], all: &[At], uncertain: &[Uncertain]) -> Result<Page, Error> {
    let mut page = Page::new(2);
    let mut events = 0;
    for at in all {
        let Place::Event(index) = at.place else {
            continue;
        };
        let branch = &branches[at.branch];
        let event = &branch.events[index];
        events += 1;
        page = page.chart(match &at.derivatives {
            Some(moves) => branch.tornado(event, moves, uncertain)?,
            None => Chart::new(format!(
                "{} at {} = {}",
                event.kind, branch.varied, at.value
            ))
            .remark(at.why.clone().unwrap_or_default()),
        });
    }
    if events == 0 {
        page = page.chart(Chart::new("No event on the branch: nothing to move"));
    }
    Ok(page)
}

/// Bands of what is uncertain around the curves of a chart.
///
/// # Errors
/// If something uncertain is no parameter, or what is drawn has no derivative.
pub fn banded(
    options: &Options,
    diagram: &Diagram,
    view: &View,
    mut chart: Chart,
) -> Result<Chart, Error> {
    if options.uncertain.is_empty() {
        return Ok(chart);
    }
    let uncertain = options.uncertain.iter().map(ToString::to_string);
    let label = format!("± {}", uncertain.collect::<Vec<_>>().join(", "));
    for found in &diagram.branches {
        chart = found
            .branch
            .band(view, &options.uncertain)?
            .on(chart, &label);
    }
    Ok(chart)
}

/// The key of derivatives in what `--json` writes.
const KEY: &str = "sensitivities";

/// The derivatives in a file of branches; none where it has none.
///
/// # Errors
/// If the file cannot be read, or they are not what `--json` writes.
pub fn read(path: &Path) -> io::Result<Vec<At>> {
    let bytes = std::fs::read(path)?;
    let key = format!("\"{KEY}\"");
    if !bytes.windows(key.len()).any(|part| part == key.as_bytes()) {
        return Ok(Vec::new());
    }
    // A branch that is kept while it is followed is another form, which has none.
    let Ok(Value::Object(mut all)) = serde_json::from_slice(&bytes) else {
        return Ok(Vec::new());
    };
    let all = all.remove(KEY).map(serde_json::from_value);
    Ok(all.transpose()?.unwrap_or_default())
}

/// How events move, for people.
pub fn summary(branches: &[Branch], all: &[At]) -> String {
    let mut text = String::new();
    for at in all {
        let Place::Event(index) = at.place else {
            continue;
        };
        let branch = branches.get(at.branch);
        let event = branch.and_then(|branch| branch.events.get(index));
        // What was read from a file may be of other branches.
        let (Some(branch), Some(event)) = (branch, event) else {
            continue;
        };
        let kind = event.kind;
        let value = of_varied(branch, export::rounded(at.value, 6));
        let moves = match (&at.derivatives, &at.why) {
            (Some(found), _) => by_all(found),
            (None, why) => why.clone().unwrap_or_default(),
        };
        // Writing to a string does not fail.
        let _ = writeln!(text, "{kind} at {value}: {moves}");
    }
    text
}

/// The derivatives of a place, by all parameters.
fn by_all(found: &Sensitivities) -> String {
    let known = found.variables.iter().zip(&found.place);
    let known = known.filter_map(|(name, by)| Some((name, (*by)?)));
    let told = known.map(|(name, by)| {
        // As many digits as a reader can use, fewer where the error leaves fewer.
        let error = by.error.max(1e-6 * by.value.abs());
        format!(
            "d{}/d{name} = {}",
            found.varied,
            export::to_error(by.value, error)
        )
    });
    told.collect::<Vec<_>>().join(", ")
}
