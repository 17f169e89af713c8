//! The subcommand `show`: what is in a file of branches, or of a map, without computing anything.

use std::fmt::{self, Write};
use std::path::{Path, PathBuf};
use std::process::ExitCode;

use clap::Args;
use hertzian::bifurcation::{Diagram, Map};
use hertzian::chart::{Chart, View};
use hertzian::error::chain;
use hertzian::export::{self, Table};
use hertzian::observe::Wanted;
use hertzian::{Branch, Point, Verdict};

use crate::look::{Axis, Look};
use crate::map;
use crate::program::{self, Ended, Failed};
use crate::response::files::page;
use crate::response::places;
use crate::response::sensitive;

/// Says what is in a file that `response --json`, `response --keep` or `map --json` has written, and draws it. Nothing is computed.
#[derive(Debug, Clone, PartialEq, Args)]
#[command(
    allow_negative_numbers = true,
    after_help = "Examples:\n  \
        hertzian show branch.json\n  \
        hertzian show branch.json --at 1.1                  which orbits there are at omega = 1.1\n  \
        hertzian show branch.json --branch 2 --csv two.csv --svg two.svg\n  \
        hertzian show branch.json --svg tip.svg --plot tip:rms,stop:max --axis hz\n  \
        hertzian show branch.json --svg tip.svg --plot tip --stack 5 --scale db\n  \
        hertzian show a.json b.json c.json --svg all.svg    of several parameters or models: what differs names the curves\n  \
        hertzian show a.json b.json c.json --svg all.svg --waterfall drive\n  \
        hertzian show map.json --svg map.svg                how many are stable, how large these are, and the verdict of all\n\n\
        Between two orbits of a branch, sizes are those of a straight line from one to the other. Exit codes: 0 done; 2 bad input."
)]
pub struct Options {
    /// The file, or several: their branches are numbered on
    #[arg(value_name = "FILE", required = true)]
    pub files: Vec<PathBuf>,

    /// Which orbits there are at these values of what varies
    #[arg(long, value_name = "VALUE", value_delimiter = ',', num_args = 1..)]
    pub at: Vec<f64>,

    /// This branch alone, counted from one
    #[arg(long, value_name = "NUMBER")]
    pub branch: Option<usize>,

    /// Draw the branches, or all charts of the map, into this file
    #[arg(long, value_name = "FILE")]
    pub svg: Option<PathBuf>,

    /// What is drawn and said of each orbit, as for `hertzian response`: a chart for each [default: p2p of the first output, or of the
    /// coordinate that moves most]
    #[arg(long, value_name = "NAME:MEASURE", value_delimiter = ',')]
    pub plot: Vec<Wanted>,

    /// What is at the axis of the frequency in the picture
    #[arg(long, value_enum, value_name = "UNIT", default_value_t = Axis::Omega, requires = "svg")]
    pub axis: Axis,

    /// How charts look
    #[command(flatten)]
    pub look: Look,

    /// Draw a curve for each value of this parameter, each above the last, with the value at its end
    #[arg(long, value_name = "NAME", requires = "svg")]
    pub waterfall: Option<String>,

    /// Write one row per orbit, or per cell of the map, to this file
    #[arg(long, value_name = "FILE")]
    pub csv: Option<PathBuf>,
}

/// Does what is asked for, and says by the exit code how it went.
pub fn start(options: &Options) -> ExitCode {
    program::run("hertzian show", false, |_, _| show(options))
}

/// What is said of the file; pictures and tables are written.
///
/// # Errors
/// If the file is none of branches, there is no such branch in it, or a file cannot be written.
pub fn show(options: &Options) -> Result<Ended, Failed> {
    let mut all = Vec::new();
    let mut summary = String::new();
    let mut moves = String::new();
    for path in &options.files {
        let read = match (Branch::read_all(path), &options.files[..]) {
            (Ok(read), _) => read,
            // It may be one of a map.
            (Err(error), [_]) => {
                let map = Map::read(path);
                let map = map.map_err(|_| Failed::new(chain(&error).to_string()))?;
                return shown(&map, options).map_err(Failed::new);
            }
            (Err(error), _) => return Err(Failed::new(chain(&error).to_string())),
        };
        if options.files.len() > 1 {
            // Writing to a string does not fail.
            let _ = match read.len() {
                0 => writeln!(summary, "{}: no branch", path.display()),
                1 => writeln!(summary, "{}: branch {}", path.display(), all.len() + 1),
                count => writeln!(
                    summary,
                    "{}: branches {} to {}",
                    path.display(),
                    all.len() + 1,
                    all.len() + count
                ),
            };
        }
        moves += &moved(path, options, &read, all.len()).map_err(Failed::new)?;
        all.extend(read);
    }
    let count = all.len();
    let numbers = match options.branch {
        None => 1..=count,
        Some(number) if (1..=count).contains(&number) => number..=number,
        Some(number) => {
            let files = listed(&options.files);
            let there = match count {
                1 => format!("there is one branch in {files}"),
                _ => format!("there are {count} branches in {files}"),
            };
            return Err(Failed::new(format!("--branch {number}: {there}")));
        }
    };
    let numbered: Vec<(usize, &Branch)> =
        numbers.map(|number| (number, &all[number - 1])).collect();
    describe(&mut summary, &numbered, options).map_err(Failed::new)?;
    write(options, &numbered).map_err(Failed::new)?;
    Ok(Ended {
        summary: summary + &moves,
        complaints: Vec::new(),
        complete: true,
    })
}

/// How the events of a file move, if that was written: of the branch that is asked for, where others were counted before.
///
/// # Errors
/// If it cannot be read.
fn moved(
    path: &Path,
    options: &Options,
    branches: &[Branch],
    before: usize,
) -> Result<String, String> {
    let mut all = sensitive::read(path)
        .map_err(|error| format!("cannot read derivatives in {}: {error}", path.display()))?;
    if let Some(number) = options.branch {
        all.retain(|at| before + at.branch + 1 == number);
    }
    Ok(sensitive::summary(branches, &all))
}

/// Files by their names.
fn listed(files: &[PathBuf]) -> String {
    let names = files.iter().map(|path| path.display().to_string());
    names.collect::<Vec<_>>().join(", ")
}

/// What is said of a map; it is drawn and written again.
///
/// # Errors
/// If something is asked for that it has not, or a file cannot be written.
fn shown(map: &Map, options: &Options) -> Result<Ended, String> {
    let asked = [
        ("--at", !options.at.is_empty()),
        ("--branch", options.branch.is_some()),
        ("--plot", !options.plot.is_empty()),
        ("--axis", options.axis != Axis::Omega),
        ("--waterfall", options.waterfall.is_some()),
        ("--scale", options.look.scale.is_some()),
        ("--events", !options.look.events.is_empty()),
        ("--stack", options.look.stack > 0),
    ];
    if let Some((name, _)) = asked.iter().find(|(_, asked)| *asked) {
        let file = listed(&options.files);
        return Err(format!("{name} is for branches, and {file} has a map"));
    }
    unshared(options)?;
    map::write_again(map, options.svg.as_deref(), options.csv.as_deref())?;
    Ok(Ended {
        summary: map.to_string(),
        complaints: Vec::new(),
        complete: true,
    })
}

/// No file is written twice, or over the one that is shown.
fn unshared(options: &Options) -> Result<(), String> {
    let source = options.files.iter().map(PathBuf::as_path);
    let written = [&options.svg, &options.csv].into_iter().flatten();
    let paths = source.chain(written.map(PathBuf::as_path));
    match places::shared(paths) {
        Some(path) => Err(format!("{} is asked for more than once", path.display())),
        None => Ok(()),
    }
}

/// Writes what was asked for.
///
/// # Errors
/// Why a file cannot be written.
fn write(options: &Options, branches: &[(usize, &Branch)]) -> Result<(), String> {
    unshared(options)?;
    let failed = |path: &PathBuf, error| format!("cannot write {}: {error}", path.display());
    if let Some(path) = &options.svg {
        let picture = picture(options, branches)?;
        export::write(path, picture).map_err(|error| failed(path, error))?;
    }
    if let (Some(path), Some((_, first))) = (&options.csv, branches.first()) {
        alike(
            "--csv: one table has the columns of one oscillator",
            branches,
        )?;
        let mut table = Table::of_model(&first.model).with_errors_of(first.accuracy_of());
        for (number, branch) in branches {
            for point in &branch.points {
                table.add(number - 1, point);
            }
        }
        export::write(path, table.to_csv()).map_err(|error| failed(path, error))?;
    }
    Ok(())
}

/// The charts that were asked for.
///
/// # Errors
/// If the branches do not belong into one chart, or there is nothing of that name.
fn picture(options: &Options, branches: &[(usize, &Branch)]) -> Result<String, String> {
    let all: Vec<&Branch> = branches.iter().map(|(_, branch)| *branch).collect();
    let one = all.windows(2).all(|pair| {
        let [a, b] = [pair[0], pair[1]];
        a.model == b.model && a.varied == b.varied && held(a).eq(held(b))
    });
    let diagram = || {
        Diagram::from(
            all.iter()
                .map(|branch| (*branch).clone())
                .collect::<Vec<_>>(),
        )
    };
    let chart = |view: &View| match (&options.waterfall, &all[..]) {
        (Some(parameter), _) => view.waterfall(parameter, all.iter().copied()),
        (None, [alone]) => alone.chart_of(view),
        (None, _) if one => diagram().chart_of(view),
        (None, _) => view.together(all.iter().copied()),
    };
    let views = options.look.views(options.axis, &options.plot);
    let charts = views.iter().map(chart).collect::<Result<Vec<Chart>, _>>();
    let charts = charts.map_err(|error| chain(&error).to_string())?;
    Ok(page(charts))
}

/// Branches of one file may be of several oscillators, or vary something else each.
fn alike(what: &str, branches: &[(usize, &Branch)]) -> Result<(), String> {
    let Some((first, one)) = branches.first() else {
        return Ok(());
    };
    let same = |branch: &Branch| branch.model == one.model && branch.varied == one.varied;
    match branches.iter().find(|(_, branch)| !same(branch)) {
        None => Ok(()),
        Some((other, branch)) => Err(format!(
            "{what}, and branch {first} is of {} over {}, branch {other} of {} over {}: --branch says which",
            one.model.name, one.varied, branch.model.name, branch.varied
        )),
    }
}

/// Says what there is.
fn describe(
    text: &mut String,
    branches: &[(usize, &Branch)],
    options: &Options,
) -> Result<(), String> {
    // Writing to a string does not fail.
    if branches.is_empty() {
        let _ = writeln!(text, "there is no branch in it");
    }
    let mut before: Option<&Branch> = None;
    for (number, branch) in branches {
        let told = before
            .is_some_and(|before| before.model == branch.model && held(before).eq(held(branch)));
        if !told {
            let _ = describe_model(text, branch);
        }
        before = Some(branch);
        let wanted = match &options.plot[..] {
            [] => vec![branch.leading()],
            wanted => wanted.to_vec(),
        };
        for wanted in &wanted {
            branch
                .model
                .check(wanted)
                .map_err(|error| chain(&error).to_string())?;
        }
        let _ = describe_branch(text, *number, branch, &wanted);
    }
    let mut varied: Vec<&str> = Vec::new();
    for (_, branch) in branches {
        if !varied.contains(&branch.varied.as_str()) {
            varied.push(&branch.varied);
        }
    }
    for value in &options.at {
        for varied in &varied {
            let own = branches
                .iter()
                .filter(|(_, branch)| branch.varied == **varied);
            let own: Vec<(usize, &Branch)> = own.copied().collect();
            let _ = describe_value(text, &own, varied, *value, options);
        }
    }
    Ok(())
}

/// Name, value and unit of the parameters that are the same all along a branch.
fn held(branch: &Branch) -> impl Iterator<Item = (&str, f64, &str)> {
    let values = branch.points.first().map(|point| &point.parameters[..]);
    let all = branch.model.parameters.iter();
    let all = all.zip(values.unwrap_or_default().iter().copied());
    all.filter(|(parameter, _)| parameter.name != branch.varied)
        .map(|(parameter, value)| (&parameter.name[..], value, &parameter.unit[..]))
}

fn describe_model(text: &mut String, branch: &Branch) -> fmt::Result {
    writeln!(text, "{}: {}", branch.model.name, branch.model.equation)?;
    for (name, value, unit) in held(branch) {
        writeln!(text, "{name} = {}", with_unit(export::plain(value), unit))?;
    }
    Ok(())
}

/// A number with its unit, if it has one.
fn with_unit(number: impl std::fmt::Display, unit: &str) -> String {
    if unit.is_empty() {
        number.to_string()
    } else {
        format!("{number} {unit}")
    }
}

fn describe_branch(
    text: &mut String,
    number: usize,
    branch: &Branch,
    wanted: &[Wanted],
) -> fmt::Result {
    let count = branch.points.len();
    let varied = &branch.varied;
    let (Some(from), Some(to)) = (branch.points.first(), branch.points.last()) else {
        return writeln!(text, "branch {number}: no orbits, {}", branch.stopped);
    };
    let [from, to] = [from, to].map(|point| export::rounded(point.value, 9));
    writeln!(
        text,
        "branch {number}: {count} orbits of period {}, {varied} from {from} to {to}; {}",
        branch.period(),
        branch.stopped
    )?;
    for verdict in [Verdict::Stable, Verdict::Unstable, Verdict::Undecided] {
        let alike = branch
            .points
            .iter()
            .filter(|point| point.stability.verdict == verdict);
        match alike.count() {
            0 => {}
            alike => writeln!(text, "  {alike} of them {verdict}")?,
        }
    }
    for wanted in wanted {
        describe_largest(text, branch, wanted)?;
    }
    for event in &branch.events {
        writeln!(text, "  {}", branch.describe(event))?;
    }
    for turn in &branch.turns {
        let value = export::rounded(turn.value, 9);
        writeln!(text, "  {} near {value}, not located", turn.kind)?;
    }
    if let Some(winding) = branch.winding() {
        writeln!(text, "  {winding}")?;
    }
    Ok(())
}

/// The largest value of what is asked of the orbits of a branch.
fn describe_largest(text: &mut String, branch: &Branch, wanted: &Wanted) -> fmt::Result {
    let known = branch.points.iter().filter_map(|point| {
        let size = branch.measured(wanted, point).ok().flatten()?;
        Some((size, point))
    });
    let Some((size, point)) = known.max_by(|(a, _), (b, _)| a.total_cmp(b)) else {
        return writeln!(text, "  {wanted} is not in the file");
    };
    let value = export::rounded(point.value, 6);
    let unit = branch.model.unit_of_varied(&branch.varied);
    // What leads has as many digits as its error bears.
    let what = if *wanted == branch.leading() {
        branch.describe_size(point)
    } else {
        in_words(branch, wanted, size)
    };
    let varied = &branch.varied;
    writeln!(
        text,
        "  largest {what} at {varied} = {}",
        with_unit(value, unit)
    )
}

/// What is asked for, with its value and its unit: `peak-to-peak of tip 1.25 um`.
fn in_words(branch: &Branch, wanted: &Wanted, value: f64) -> String {
    let model = &branch.model;
    let name = match (model.outputs.len(), model.coordinates.len()) {
        (0, 1) if *wanted == branch.leading() => String::new(),
        _ => format!(" of {}", wanted.name),
    };
    let unit = wanted.measure.unit(model.unit_of(&wanted.name));
    let value = with_unit(export::rounded(value, 6), &unit);
    format!("{}{name} {value}", wanted.measure.in_words())
}

/// Which orbits there are at a value.
fn describe_value(
    text: &mut String,
    branches: &[(usize, &Branch)],
    varied: &str,
    value: f64,
    options: &Options,
) -> fmt::Result {
    let found: Vec<(usize, &Branch, Passing<'_>)> = branches
        .iter()
        .flat_map(|(number, branch)| {
            passings(branch, value).map(move |passing| (*number, *branch, passing))
        })
        .collect();
    let stable = found
        .iter()
        .filter(|(.., passing)| passing.verdict() == Some(Verdict::Stable));
    let (all, stable) = (found.len(), stable.count());
    writeln!(
        text,
        "at {varied} = {}: {all} orbits, {stable} of them stable",
        export::plain(value)
    )?;
    for (number, branch, passing) in found {
        let leading = [branch.leading()];
        let wanted = if options.plot.is_empty() {
            &leading[..]
        } else {
            &options.plot[..]
        };
        let sizes = wanted
            .iter()
            .map(|wanted| match passing.size(branch, wanted, value) {
                Some(size) => in_words(branch, wanted, size),
                None => format!("{wanted} is not in the file"),
            });
        let sizes = sizes.collect::<Vec<String>>().join(", ");
        let verdict = passing.verdict().map_or_else(
            || "stability changes beside it".to_owned(),
            |verdict| verdict.to_string(),
        );
        let [a, b] = passing.ends.map(|point| export::rounded(point.value, 6));
        writeln!(
            text,
            "  branch {number}: about {sizes}, {verdict} (between orbits at {a} and {b})"
        )?;
    }
    Ok(())
}

/// Two neighbours on a branch with a value between them.
#[derive(Debug, Clone, Copy)]
struct Passing<'p> {
    ends: [&'p Point; 2],
    /// What is known of the stability on the way.
    verdicts: [Verdict; 2],
}

impl Passing<'_> {
    /// What is asked for, on a straight line; `None` where it is not known.
    fn size(&self, branch: &Branch, wanted: &Wanted, value: f64) -> Option<f64> {
        let [a, b] = self.ends;
        let part = (value - a.value) / (b.value - a.value);
        let part = if part.is_finite() { part } else { 0.0 };
        let size = |point: &Point| branch.measured(wanted, point).ok().flatten();
        let [first, second] = [size(a)?, size(b)?];
        Some(first + part * (second - first))
    }

    fn verdict(&self) -> Option<Verdict> {
        let [a, b] = self.verdicts;
        (a == b).then_some(a)
    }
}

/// Where a branch passes a value: between its orbits, and the events at which it turns back.
fn passings(branch: &Branch, value: f64) -> impl Iterator<Item = Passing<'_>> {
    let orbits = branch.points.iter().enumerate();
    let chain = orbits.flat_map(move |(index, point)| {
        let turns = branch.events.iter();
        let turns = turns.filter(move |event| event.after == index && event.kind.turns());
        let turns = turns.map(|event| (&event.point, None));
        turns.chain([(point, Some(point.stability.verdict))])
    });
    let chain: Vec<(&Point, Option<Verdict>)> = chain.collect();
    let mut found = Vec::new();
    for pair in chain.windows(2) {
        let [(a, first), (b, second)] = [pair[0], pair[1]];
        if (a.value <= value) != (b.value <= value) {
            // An event has no verdict of its own: it is where that changes.
            let verdicts = [first.or(second), second.or(first)];
            found.push(Passing {
                ends: [a, b],
                verdicts: verdicts.map(|verdict| verdict.unwrap_or(Verdict::Undecided)),
            });
        }
    }
    // A pair counts the end that is not above; at the ends of a branch the other one is left.
    let beside = |place: Option<&(&Point, Option<Verdict>)>| place.map(|(point, _)| point.value);
    let ends = [
        (branch.points.first(), beside(chain.get(1))),
        (branch.points.last(), beside(chain.iter().rev().nth(1))),
    ];
    let left = ends.into_iter().filter_map(|(end, beside)| {
        let end = end.filter(|point| point.value == value)?;
        beside
            .is_some_and(|beside| beside < end.value)
            .then_some(end)
    });
    let left: Vec<&Point> = left.collect();
    found.extend(left.into_iter().map(|point| Passing {
        ends: [point, point],
        verdicts: [point.stability.verdict; 2],
    }));
    found.into_iter()
}
