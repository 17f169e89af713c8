//! The subcommand `response`: what it accepts, and what it writes and says.

mod accepted;
#[path = "../cancels/mod.rs"]
mod cancels;
#[path = "../folder/mod.rs"]
mod folder;
mod written;

use hertzian::Cancel;
use hertzian::export::COLUMNS;
use hertzian_cli::command::{Program, Task};
use hertzian_cli::response::options::Options;
use hertzian_cli::response::progress::Progress;
use hertzian_cli::response::run::{Failure, Outcome, run};
use serde_json::Value;

use folder::Folder;

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
    run(&options(arguments), &never, &mut Progress::new(false))
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
    let names = [
        "omega",
        "drive",
        "peak_to_peak",
        "max",
        "min",
        "mean",
        "rms",
        "contact_fraction",
        "peak_force",
        "dissipated_power",
        "harmonics",
        "error",
    ];
    assert!(numbers(point, &names).all(f64::is_finite));
    let stability = point["stability"].as_str().expect("a verdict");
    assert!(["stable", "unstable", "undecided"].contains(&stability));
    assert_eq!(point["harmonics"], 5);
    assert_eq!(point["contacts"], 1);
    assert_eq!(point["contact_fraction"], 1.0);
    for (list, length) in [("multipliers", 2), ("amplitudes", 6), ("phases", 6)] {
        assert_eq!(point[list].as_array().map(Vec::len), Some(length), "{list}");
    }
    let names = ["max", "min", "peak_to_peak", "mean"];
    let [max, min, size, mean]: [f64; 4] = numbers(point, &names)
        .collect::<Vec<_>>()
        .try_into()
        .expect("four numbers");
    assert!(near(max - min, size));
    assert!(near(point["amplitudes"][0].as_f64().unwrap_or(0.0), mean));
}

/// Whether two numbers are the same but for the rounding of a reader.
fn near(a: f64, b: f64) -> bool {
    (a - b).abs() <= 1e-13 * a.abs().max(b.abs())
}

/// The rows say the same as the points.
fn check_csv(path: &str, points: &[Value]) {
    let mut reader = csv::Reader::from_path(path).expect("a file");
    let header = reader.headers().expect("a header").clone();
    assert_eq!(header.iter().take(20).collect::<Vec<_>>(), COLUMNS);
    let rows: Vec<_> = reader.records().collect::<Result<_, _>>().expect("rows");
    assert_eq!(rows.len(), points.len());
    for (row, point) in rows.iter().zip(points) {
        for (cell, column) in row.iter().zip(COLUMNS) {
            let expected = match column.strip_prefix("multiplier_") {
                Some("1_re") => &point["multipliers"][0][0],
                Some("1_im") => &point["multipliers"][0][1],
                Some("2_re") => &point["multipliers"][1][0],
                Some("2_im") => &point["multipliers"][1][1],
                _ => &point[column],
            };
            match expected {
                Value::String(text) => assert_eq!(cell, text),
                number => {
                    let number = number.as_f64().expect("a number");
                    let cell = cell.parse().expect("a number");
                    assert!(near(cell, number), "{column}: {cell} {number}");
                }
            }
        }
    }
}

fn all(json: &str) -> Value {
    let text = std::fs::read_to_string(json).expect("a file");
    serde_json::from_str(&text).expect("JSON")
}
