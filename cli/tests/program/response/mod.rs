//! The subcommand `response`: what it accepts, and what it writes and says.

mod accepted;
mod sensitive;
#[cfg(feature = "sparse")]
mod structure;
mod written;

use hertzian::Cancel;
use hertzian::export::COLUMNS;
use hertzian_cli::command::{Program, Task};
use hertzian_cli::response::options::Options;
use hertzian_cli::response::progress::Progress;
use hertzian_cli::response::run::{Failure, Outcome, run};
use serde_json::Value;

use crate::folder::Folder;

/// What the words of a command line ask for.
fn read(arguments: &[&str]) -> Result<Options, clap::Error> {
    let words = ["hertzian", "response"]
        .into_iter()
        .chain(arguments.iter().copied());
    match Program::read(words.map(Into::into))?.task {
        Task::Response(options) => Ok(*options),
        other => panic!("{other:?}"),
    }
}

fn options(arguments: &[&str]) -> Options {
    read(arguments).expect("arguments that can be parsed")
}

fn run_with(arguments: &[&str]) -> Result<Outcome, Failure> {
    let never = Cancel::new();
    run(&options(arguments), &never, &mut Progress::hidden())
}

/// Enough for a curve, and quick.
const COARSE: [&str; 2] = ["--harmonics", "5"];

fn coarse(folder: &Folder, arguments: &[&str]) -> Result<Outcome, Failure> {
    let svg = folder.file("response.svg");
    let files = ["--svg", &svg];
    run_with(&[&COARSE[..], &files, arguments].concat())
}

fn numbers<'a>(object: &'a Value, names: &'a [&str]) -> impl Iterator<Item = f64> + 'a {
    names.iter().map(move |&name| {
        let number = object[name].as_f64();
        number.unwrap_or_else(|| panic!("{name} in {object}"))
    })
}

fn check_point(point: &Value) {
    let (orbit, observed) = (&point["orbit"], &point["observed"]);
    assert!(numbers(point, &["value", "error"]).all(f64::is_finite));
    let verdict = point["stability"]["verdict"].as_str();
    let verdict = verdict.expect("a verdict");
    assert!(["stable", "unstable", "undecided"].contains(&verdict));
    let length = |list: &Value| list.as_array().map(Vec::len);
    assert_eq!(length(&point["stability"]["multipliers"]), Some(2));
    assert_eq!(length(&orbit["series"]), Some(11));
    let contact = &observed["contacts"][0];
    assert_eq!(
        (&contact["count"], &contact["fraction"]),
        (&1.into(), &1.0.into())
    );
    let names = ["maximum", "minimum", "mean", "rms"];
    assert!(numbers(&observed["motions"][0], &names).all(f64::is_finite));
    let mean = orbit["series"][0].as_f64().expect("a number");
    assert!(numbers(&observed["motions"][0], &["mean"]).all(|observed| near(observed, mean)));
}

/// Whether two numbers are the same but for the rounding of a reader.
fn near(a: f64, b: f64) -> bool {
    (a - b).abs() <= 1e-13 * a.abs().max(b.abs())
}

/// The points of all branches, each with the number of its branch.
fn points(all: &Value) -> Vec<(usize, &Value)> {
    let branches = all["branches"].as_array().expect("branches").iter();
    let points = branches.enumerate().flat_map(|(number, branch)| {
        let points = branch["points"].as_array().expect("points").iter();
        points.map(move |point| (number, point))
    });
    points.collect()
}

/// The rows say the same as the points.
fn check_csv(path: &str, all: &Value) {
    let mut reader = csv::Reader::from_path(path).expect("a file");
    let header = reader.headers().expect("a header").clone();
    assert_eq!(header.iter().take(20).collect::<Vec<_>>(), COLUMNS);
    let rows: Vec<_> = reader.records().collect::<Result<_, _>>().expect("rows");
    let points = points(all);
    assert_eq!(rows.len(), points.len());
    for (row, (number, point)) in rows.iter().zip(points) {
        let cell = |column: &str| {
            let index = COLUMNS.iter().position(|name| *name == column);
            &row[index.expect("a column")]
        };
        assert_eq!(cell("branch"), number.to_string());
        assert_eq!(cell("stability"), point["stability"]["verdict"]);
        let motion = &point["observed"]["motions"][0];
        for (column, value) in [
            ("omega", &point["orbit"]["omega"]),
            ("period", &point["orbit"]["period"]),
            ("value", &point["value"]),
            ("error", &point["error"]),
            ("max", &motion["maximum"]),
            ("min", &motion["minimum"]),
            ("mean", &motion["mean"]),
            ("rms", &motion["rms"]),
            ("multiplier_1_re", &point["stability"]["multipliers"][0][0]),
            ("multiplier_2_im", &point["stability"]["multipliers"][1][1]),
            (
                "peak_force",
                &point["observed"]["contacts"][0]["peak_force"],
            ),
            ("contacts", &point["observed"]["contacts"][0]["count"]),
        ] {
            let value = value.as_f64().expect("a number");
            let cell: f64 = cell(column).parse().expect("a number");
            assert!(near(cell, value), "{column}: {cell} {value}");
        }
    }
}

fn all(json: &str) -> Value {
    let text = std::fs::read_to_string(json).expect("a file");
    serde_json::from_str(&text).expect("JSON")
}
