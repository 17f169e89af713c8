//! The numbers in the README are those of the present code, and true.

use std::path::Path;

use clap::Parser;
use hertzian::FrequencyResponse;
use hertzian::{Cancel, EventKind};
use hertzian_cli::paper::exact;
use hertzian_cli::response::models::OneSidedHertz;
use hertzian_cli::response::options::Options;
use hertzian_cli::response::progress::Progress;
use hertzian_cli::response::run::run;
use serde_json::Value;

const README: &str = include_str!("../../../README.md");

/// The lines between the line after this one and the end of its block.
fn block(before: &str) -> Vec<&'static str> {
    let lines = README.lines().skip_while(|line| !line.contains(before));
    let lines = lines.skip_while(|line| *line != "```text");
    lines.skip(1).take_while(|line| *line != "```").collect()
}

/// The twenty lines, with the same declaration.
#[test]
fn the_twenty_lines_print_what_is_said() {
    let model = OneSidedHertz {
        zeta: 0.032,
        load: 1.0,
        drive: 0.1,
    };
    let branch = FrequencyResponse::of(&model).from(0.6).to(1.6).run();
    let branch = branch.expect("a branch");
    let mut printed: Vec<String> = branch.folds().map(ToString::to_string).collect();
    for point in branch.at(1.1).expect("orbits") {
        let (verdict, size) = (point.stability.verdict, point.peak_to_peak());
        printed.push(format!("{verdict}, {size:.3}"));
    }
    assert_eq!(printed, block("They print"));
}

/// Options of a command line, what they print, and the folds that they write, by frequency, with their errors.
fn response(name: &str, command: &str) -> (String, Vec<[f64; 2]>) {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join(format!("readme-{name}"));
    std::fs::create_dir_all(&folder).expect("a folder");
    let words = std::iter::once("response").chain(command.split_whitespace());
    let mut options = Options::try_parse_from(words).expect("a command");
    let json = folder.join("a.json");
    options.svg = folder.join("response.svg");
    options.json = Some(json.clone());
    let never = Cancel::new();
    let outcome = run(&options, &never, &mut Progress::hidden()).expect("a branch");
    assert!(outcome.complete);
    let text = std::fs::read_to_string(&json).expect("a file");
    let all: Value = serde_json::from_str(&text).expect("JSON");
    let folds = all["branches"][0]["events"]
        .as_array()
        .expect("events")
        .iter();
    let folds = folds.filter(|event| event["kind"] == "fold");
    let number = |value: &Value| value.as_f64().expect("a number");
    let folds = folds.map(|fold| [number(&fold["point"]["value"]), number(&fold["error"])]);
    let mut folds: Vec<_> = folds.collect();
    folds.sort_by(|a, b| a[0].total_cmp(&b[0]));
    let _ = std::fs::remove_dir_all(&folder);
    (outcome.summary, folds)
}

/// Lines without how long it took and where the files are.
fn lasting<'l>(lines: impl Iterator<Item = &'l str>) -> Vec<&'l str> {
    let lasting = lines.filter(|line| !line.starts_with("written "));
    let timeless = lasting.map(|line| {
        let time = line.strip_prefix("time ");
        let counts = time.and_then(|rest| rest.split_once(" ms; "));
        counts.map_or(line, |(_, counts)| counts)
    });
    timeless.collect()
}

#[test]
fn the_command_prints_what_is_said() {
    let line = README.lines().find(|line| line.ends_with("` prints"));
    let command = line.and_then(|line| line.split('`').rev().nth(1));
    let command = command
        .expect("a command")
        .strip_prefix("hertzian response ");
    let (summary, _) = response("command", command.expect("options"));
    let said = block("` prints").into_iter();
    let (printed, said) = (lasting(summary.lines()), lasting(said));
    assert_eq!(printed.len(), said.len());
    for (printed, said) in printed.into_iter().zip(said) {
        assert!(is_alike(printed, said), "{printed:?} {said:?}");
    }
}

/// Whether lines say the same: the last digits of numbers, and errors that are rounding, are those of the processor's lanes, and counts with them.
fn is_alike(printed: &str, said: &str) -> bool {
    let number = |word: &str| {
        word.trim_matches(|c| "(),;".contains(c))
            .parse::<f64>()
            .ok()
    };
    let [a, b] = [printed, said].map(|line| line.split_whitespace().collect::<Vec<_>>());
    let alike = |(a, b): (&&str, &&str)| match (number(a), number(b)) {
        (Some(x), Some(y)) if a.contains("e-") => x < 30.0 * y && y < 30.0 * x,
        (Some(x), Some(y)) if a.contains('.') => (x - y).abs() <= 1e-12 * y.abs(),
        (Some(x), Some(y)) => (x - y).abs() <= 0.1 * y.abs(),
        _ => a == b,
    };
    a.len() == b.len() && a.iter().zip(&b).all(alike)
}

/// The frequencies of the folds in a summary and their errors, as they are printed, by frequency.
fn printed_folds(summary: &str) -> Vec<[&str; 2]> {
    let folds = summary.lines().filter_map(|line| {
        let (value, rest) = line
            .strip_prefix("fold       omega ")?
            .split_once(" (error ")?;
        Some([value, rest.split_once(')')?.0])
    });
    let mut folds: Vec<[&str; 2]> = folds.collect();
    let value = |fold: &[&str; 2]| fold[0].parse::<f64>().expect("a number");
    folds.sort_by(|a, b| value(a).total_cmp(&value(b)));
    folds
}

/// `| figure | command | found (error stated), ... | exact, ... |`: what the command prints, as many as there are, no further off
/// than the error that it states; what is exact to nine digits after the point, or as many as are found.
#[test]
fn the_table_is_true() {
    let table = README
        .lines()
        .skip_while(|line| !line.starts_with("| figure |"));
    let rows: Vec<&str> = table
        .skip(2)
        .take_while(|line| line.starts_with('|'))
        .collect();
    assert_eq!(rows.len(), 5);
    for (index, row) in rows.into_iter().enumerate() {
        let cells: Vec<&str> = row.split('|').map(str::trim).collect();
        let [_, figure, command, found, known, _] = cells[..] else {
            panic!("{row}");
        };
        let command = command.trim_matches('`');
        let (summary, folds) = response(&format!("{index}"), command);
        let words = std::iter::once("response").chain(command.split_whitespace());
        let options = Options::try_parse_from(words).expect("a command");
        let (from, to) = (options.range.from, options.range.to);
        let exact = exact::frequencies(figure).iter();
        let exact = exact
            .filter(|(kind, omega)| *kind == EventKind::Fold && from <= *omega && *omega <= to);
        let mut exact: Vec<f64> = exact.map(|(_, omega)| *omega).collect();
        exact.sort_by(f64::total_cmp);
        let printed = printed_folds(&summary);
        let said = printed
            .iter()
            .map(|[value, error]| format!("{value} ({error})"));
        let said = said.collect::<Vec<_>>().join(", ");
        assert!(is_alike(&said, found), "{said} {row}");
        assert_eq!([folds.len(), printed.len()], [exact.len(); 2], "{row}");
        let digits = |text: &str| text.split_once('.').map_or(0, |(_, behind)| behind.len());
        let known_as = exact.iter().zip(&printed);
        let known_as =
            known_as.map(|(value, [text, _])| format!("{value:.*}", digits(text).max(9)));
        assert_eq!(known_as.collect::<Vec<_>>().join(", "), known, "{row}");
        for ([value, error], exact) in folds.iter().zip(exact) {
            assert!(
                (value - exact).abs() <= *error,
                "{row}: {value} {error:e} {exact}"
            );
        }
    }
}

/// A law of one's own, from the file with the same declaration.
#[test]
fn the_folds_of_ones_own_law_are_those_that_are_said() {
    let line = README
        .lines()
        .find(|line| line.contains("branch.folds().count(), 2); // "));
    let (_, said) = line
        .expect("a comment")
        .split_once("// ")
        .expect("a comment");
    let model = concat!(
        env!("CARGO_MANIFEST_DIR"),
        "/../examples/models/cubic_with_stop.txt"
    );
    let (summary, folds) = response("own", &format!("--model {model} --from 0.4 --to 2.2"));
    assert!(
        summary.contains("zeta = 0.02, stop = 5, distance = 0.8, drive = 0.1"),
        "{summary}"
    );
    // In the order in which the branch passes them.
    let found: Vec<String> = folds
        .iter()
        .rev()
        .map(|[value, _]| format!("{value:.9}"))
        .collect();
    assert_eq!(found.join(" and "), said);
}
