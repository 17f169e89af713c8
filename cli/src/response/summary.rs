//! What a person reads: what was traced, how it ended, and what is on the branch.

use std::fmt::{self, Write};
use std::path::Path;

use hertzian::chart::Chart;
use hertzian::export;
use hertzian::{Branch, Event, EventKind, Point, System, Verdict};

use super::options::Options;
use super::run::request;
use super::value::of_varied;
use crate::model::ModelOptions;

/// As many folds, turns and changes of stability are listed one by one; more of them are counted.
const LISTED: usize = 6;

/// Title of the picture: the oscillator, and what is the same everywhere. The axes are what varies besides.
pub fn title(options: &Options, model: &dyn System, axes: &[String]) -> String {
    let period = match options.period {
        1 => String::new(),
        n => format!(", period {n}"),
    };
    let omega = (!options.over_frequency()).then_some(("ω", "omega", options.model.frequency()));
    let fixed = |name: &str| name != options.varied() && axes.iter().all(|axis| axis != name);
    if options.model.file.is_some() {
        let facts = model.facts();
        let mut values = vec![0.0; facts.parameters.len()];
        model.values(&mut values);
        let parameters = facts.parameters.iter().zip(values);
        let shown = parameters.filter(|(parameter, _)| fixed(&parameter.name));
        let shown = shown.map(|(parameter, value)| format!("{} = {value}", parameter.name));
        let omega = omega.filter(|(_, name, _)| fixed(name));
        let omega = omega.map(|(sign, _, value)| format!("{sign} = {value}"));
        let shown: Vec<_> = shown.chain(omega).collect();
        return format!("{}: {}{period}", facts.name, shown.join(", "));
    }
    let kind = if options.model.loses_contact() {
        "One-sided"
    } else {
        "Continuous"
    };
    let values = parameters(&options.model).into_iter().chain(omega);
    let shown = values.filter(|(_, name, _)| fixed(name));
    let shown: Vec<_> = shown
        .map(|(sign, _, value)| format!("{sign} = {value}"))
        .collect();
    format!("{kind}, {}{period}", shown.join(", "))
}

/// A chart with the title of the oscillator that has options of its own; a declared one has its own title.
pub fn titled(chart: Chart, options: &Options, model: &dyn System) -> Chart {
    if options.model.file.is_some() {
        chart
    } else {
        chart.title(title(options, model, &[]))
    }
}

/// Signs, names and values of the parameters of a declared oscillator.
fn parameters(options: &ModelOptions) -> [(&'static str, &'static str, f64); 4] {
    [
        ("α", "alpha", options.alpha),
        ("ζ", "zeta", options.zeta),
        ("W", "load", options.load),
        ("A", "drive", options.drive),
    ]
}

/// The summary of a run.
pub fn of(options: &Options, branch: &Branch, at: &[Point], written: &[&Path]) -> String {
    let mut text = String::new();
    // Writing to a string does not fail.
    let _ = write_all(&mut text, options, branch, at, written);
    text
}

fn write_all(
    text: &mut String,
    options: &Options,
    branch: &Branch,
    at: &[Point],
    written: &[&Path],
) -> fmt::Result {
    match &options.model.file {
        Some(path) => from_file(text, path, options, branch)?,
        None => equation(text, options)?,
    }
    range(text, branch)?;
    method(text, options, branch)?;
    folds(text, branch)?;
    stability(text, branch)?;
    let solutions = at.iter().map(|point| {
        let value = of_varied(branch, export::plain(point.value));
        let asked = options.plot.iter();
        let asked = asked.filter_map(|of| branch.describe_measured(&of.to_string(), point).ok());
        let asked: Vec<String> = asked.collect();
        let size = match asked[..] {
            [] => branch.describe_size(point),
            _ => asked.join(", "),
        };
        let verdict = point.stability.verdict;
        format!("{} {value}: {size}, {verdict}", branch.varied)
    });
    for solution in solutions {
        writeln!(text, "at         {solution}")?;
    }
    caution(text, options)?;
    let milliseconds = 1e3 * branch.elapsed.as_secs_f64();
    writeln!(
        text,
        "time       {milliseconds:.0} ms; {}",
        branch.statistics
    )?;
    let paths = written.iter().map(|path| path.display().to_string());
    writeln!(text, "written    {}", paths.collect::<Vec<_>>().join(", "))
}

/// The equations of a file, and the parameters that do not vary.
fn from_file(text: &mut String, path: &Path, options: &Options, branch: &Branch) -> fmt::Result {
    let model = &branch.model;
    writeln!(
        text,
        "{} from {}: {}",
        model.name,
        path.display(),
        model.equation
    )?;
    let Some(point) = branch.points.first() else {
        return Ok(());
    };
    let parameters = model.parameters.iter().zip(&point.parameters);
    let fixed = parameters
        .filter(|(parameter, _)| parameter.name != branch.varied)
        .map(|(parameter, value)| {
            let said = format!("{} = {value} {}", parameter.name, parameter.unit);
            said.trim_end().to_owned()
        });
    let unit = if model.units.is_empty() { "" } else { " rad/s" };
    let omega =
        (!options.over_frequency()).then(|| format!("omega = {}{unit}", options.model.frequency()));
    writeln!(
        text,
        "{}\n",
        fixed.chain(omega).collect::<Vec<_>>().join(", ")
    )
}

fn equation(text: &mut String, options: &Options) -> fmt::Result {
    let (force, remark) = if options.model.loses_contact() {
        (
            "2 zeta H(x) x' + H(x) x^alpha",
            "  one-sided: H(x) = 1 for x > 0, else 0",
        )
    } else {
        ("2 zeta x' + sgn(x) |x|^alpha", "  continuous")
    };
    writeln!(text, "x'' + {force} = drive cos(omega t) + load{remark}")?;
    let omega = ("ω", "omega", options.model.frequency());
    let values = parameters(&options.model).into_iter().chain([omega]);
    let fixed = values.filter(|(_, name, _)| *name != options.varied());
    let fixed: Vec<_> = fixed
        .map(|(_, name, value)| format!("{name} = {value}"))
        .collect();
    writeln!(text, "{}\n", fixed.join(", "))
}

fn range(text: &mut String, branch: &Branch) -> fmt::Result {
    let ends = branch.points.first().zip(branch.points.last());
    if let Some((first, last)) = ends {
        // An orbit that is known by its states has harmonics only where a file was asked for.
        let series = branch
            .points
            .iter()
            .filter(|point| point.orbit.states().next().is_none());
        let all = || series.clone().map(|point| point.orbit.harmonics());
        let (least, most) = (all().min().unwrap_or(0), all().max().unwrap_or(0));
        let harmonics = if most == 0 {
            String::new()
        } else if least == most {
            format!(", {most} harmonics")
        } else {
            format!(", {least} to {most} harmonics")
        };
        writeln!(
            text,
            "points     {}, {} from {} to {}{harmonics}",
            branch.points.len(),
            branch.varied,
            export::rounded(first.value, 6),
            of_varied(branch, export::rounded(last.value, 6)),
        )?;
    }
    writeln!(text, "ended      {}", branch.stopped)
}

/// The method that was chosen, and why.
fn method(text: &mut String, options: &Options, branch: &Branch) -> fmt::Result {
    let chosen = options.resume.is_none() && options.method().is_none();
    let followed = branch.method().zip(branch.system()).filter(|_| chosen);
    let Some((method, system)) = followed else {
        return Ok(());
    };
    let request = request(options, system);
    let choice = request.choice();
    if choice == method {
        writeln!(text, "method     {choice}, since {}", request.reason())
    } else {
        writeln!(text, "method     {method}, in place of {choice}")
    }
}

fn folds(text: &mut String, branch: &Branch) -> fmt::Result {
    let folds = branch.folds().map(|fold| {
        let point = &fold.point;
        let value = of_varied(branch, export::to_error(point.value, fold.error));
        let size = branch.describe_size(point);
        format!(
            "{} {value} (error {:.0e}), {size}",
            branch.varied, fold.error
        )
    });
    list(text, "fold", folds)?;
    let turns = branch.turns.iter().map(|turn| {
        let varied = &branch.varied;
        let value = of_varied(branch, export::rounded(turn.value, 6));
        match turn.kind {
            EventKind::Fold if turn.test.is_nan() => {
                format!("{varied} {value}, a turn in a step that could not be looked at")
            }
            EventKind::Fold => {
                format!("{varied} {value}, not confirmed as a fold: the slope jumps")
            }
            kind => format!("{varied} {value}, not confirmed as a {kind}"),
        }
    });
    list(text, "turn", turns)?;
    let broken = branch
        .events
        .iter()
        .filter(|event| event.kind == EventKind::SymmetryBreaking)
        .map(|event| {
            format!(
                "{} {} (error {:.0e}), broken: a branch without it crosses",
                branch.varied,
                of_varied(branch, export::to_error(event.point.value, event.error)),
                event.error
            )
        });
    list(text, "symmetry", broken)?;
    if branch.folds().next().is_none() && branch.turns.is_empty() {
        writeln!(text, "folds      none")?;
    }
    Ok(())
}

/// Between which points the verdict changes, and how often there is none.
fn stability(text: &mut String, branch: &Branch) -> fmt::Result {
    let undecided = |point: &&Point| point.stability.verdict == Verdict::Undecided;
    let decided: Vec<&Point> = branch.points.iter().filter(|p| !undecided(p)).collect();
    let changes: Vec<String> = decided
        .windows(2)
        .filter(|pair| pair[0].stability.verdict != pair[1].stability.verdict)
        .map(|pair| {
            let [before, behind] = [pair[0], pair[1]];
            let (from, to) = (before.stability.verdict, behind.stability.verdict);
            match between(branch, before, behind) {
                Some(event) => format!(
                    "{from} before the {} at {} {}, {to} after it",
                    event.kind,
                    branch.varied,
                    of_varied(branch, export::rounded(event.point.value, 6))
                ),
                None => format!(
                    "{from} until {} {}, {to} from {}",
                    branch.varied,
                    of_varied(branch, export::rounded(before.value, 6)),
                    of_varied(branch, export::rounded(behind.value, 6))
                ),
            }
        })
        .collect();
    if let (true, Some(point)) = (changes.is_empty(), decided.first()) {
        writeln!(text, "stability  {} throughout", point.stability.verdict)?;
    }
    list(text, "stability", changes.into_iter())?;
    let count = branch.points.iter().filter(undecided).count();
    if count > 0 {
        writeln!(
            text,
            "undecided  at {count} of the points: a multiplier is nearer to 1 in size than its error, or a quarter of it is not known"
        )?;
    }
    Ok(())
}

/// The event between two points of a branch, if there is one alone but where a gap touches a level, which changes no verdict by itself.
fn between<'b>(branch: &'b Branch, before: &Point, behind: &Point) -> Option<&'b Event> {
    let place = |point: &Point| branch.points.iter().position(|p| std::ptr::eq(p, point));
    let (first, last) = (place(before)?, place(behind)?);
    let mut events = branch.events.iter();
    let mut found = events
        .by_ref()
        .filter(|event| event.kind != EventKind::Grazing { turns: false })
        .filter(|event| first < event.after && event.after <= last);
    let event = found.next()?;
    found.next().is_none().then_some(event)
}

/// A line each, and a count of what would be too much.
fn list(text: &mut String, label: &str, entries: impl Iterator<Item = String>) -> fmt::Result {
    let mut more = 0;
    for (index, entry) in entries.enumerate() {
        if index < LISTED {
            writeln!(text, "{label:<10} {entry}")?;
        } else {
            more += 1;
        }
    }
    if more > 0 {
        writeln!(text, "{label:<10} and {more} more")?;
    }
    Ok(())
}

/// What sampling does to a force that is not smooth.
fn caution(text: &mut String, options: &Options) -> fmt::Result {
    let reason = if !options.is_sampled() {
        return Ok(());
    } else if options.model.loses_contact() {
        "damping switches with contact"
    } else if options.model.file.is_none() && options.model.alpha < 1.0 {
        "the stiffness is unbounded at x = 0"
    } else {
        return Ok(());
    };
    writeln!(
        text,
        "caution    {reason}, and the force is sampled: folds and turns of orbits\n           \
         that pass x = 0 can be displaced or false; compare with other --samples"
    )
}
