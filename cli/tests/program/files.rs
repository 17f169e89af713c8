//! What `response` writes, against what the book says of it: docs/book/src/files.md.

use hertzian::Cancel;
use std::collections::BTreeSet;
use std::path::Path;

use clap::Parser;
use hertzian::export::COLUMNS;
use hertzian_cli::response::options::Options;
use hertzian_cli::response::progress::Progress;
use hertzian_cli::response::run::run;
use serde_json::Value;

const CHAPTER: &str = include_str!("../../../docs/book/src/files.md");

/// The first and the last cell of every row of the table under a heading.
fn table(heading: &str) -> Vec<(&'static str, &'static str)> {
    let lines = CHAPTER.lines().skip_while(|line| !line.contains(heading));
    let rows = lines.skip_while(|line| !line.starts_with("|--"));
    let rows = rows.skip(1).take_while(|line| line.starts_with('|'));
    let cells = |row: &'static str| {
        let cells: Vec<&str> = row.trim_matches('|').split('|').collect();
        (cells[0], cells[cells.len() - 1])
    };
    rows.map(cells).collect()
}

/// What stands between backticks.
fn quoted(text: &str) -> Vec<String> {
    let parts = text.split('`').skip(1).step_by(2);
    parts.map(str::to_owned).collect()
}

/// The fields that a table of the chapter has.
fn fields(heading: &str) -> BTreeSet<String> {
    let rows = table(heading);
    rows.iter().flat_map(|(names, _)| quoted(names)).collect()
}

/// What is quoted of a field of the JSON, of the part before its kinds are listed.
fn described(heading: &str, field: &str) -> BTreeSet<String> {
    let rows = table(heading);
    let row = rows.iter().find(|(names, _)| quoted(names) == [field]);
    let (_, text) = row.unwrap_or_else(|| panic!("a row for {field}"));
    let fields = text.split(" Kinds: ").next().unwrap_or_default();
    quoted(fields).into_iter().collect()
}

fn names(object: &Value) -> BTreeSet<String> {
    object
        .as_object()
        .expect("an object")
        .keys()
        .cloned()
        .collect()
}

/// Every field of every object, which `list` must have at least one of.
fn assert_fields(list: &Value, expected: &BTreeSet<String>) {
    let objects = list.as_array().expect("a list");
    assert!(!objects.is_empty());
    for object in objects {
        assert_eq!(&names(object), expected);
    }
}

fn folder(name: &str) -> std::path::PathBuf {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join(format!("files-{name}"));
    let _ = std::fs::remove_dir_all(&folder);
    std::fs::create_dir_all(&folder).expect("a folder");
    folder
}

/// The JSON and the CSV of a command.
fn written(name: &str, command: &str) -> (Value, String) {
    let folder = folder(name);
    let [svg, json, csv] = ["svg", "json", "csv"].map(|kind| folder.join("a").with_extension(kind));
    let words = std::iter::once("response").chain(command.split_whitespace());
    let mut options = Options::try_parse_from(words).expect("arguments that can be parsed");
    (options.svg, options.json, options.csv) = (svg, Some(json.clone()), Some(csv.clone()));
    let never = Cancel::new();
    run(&options, &never, &mut Progress::hidden()).expect("a branch");
    let [json, csv] = [json, csv].map(|path| std::fs::read_to_string(path).expect("a file"));
    let _ = std::fs::remove_dir_all(&folder);
    (serde_json::from_str(&json).expect("JSON"), csv)
}

/// The columns of the CSV as the chapter has them, multipliers without their numbers.
fn columns() -> BTreeSet<String> {
    let rows = table("response --csv");
    let cells = rows.iter().flat_map(|(names, _)| quoted(names));
    let plain = cells.filter(|name| !name.starts_with("multiplier_"));
    plain.collect()
}

#[test]
fn columns_are_those_of_the_chapter() {
    let written = COLUMNS
        .iter()
        .filter(|name| !name.starts_with("multiplier_"));
    let written: BTreeSet<String> = written.map(|&name| name.to_owned()).collect();
    assert_eq!(written, columns());
    let mut multipliers = COLUMNS
        .iter()
        .filter(|name| name.starts_with("multiplier_"));
    let (first, last) = (multipliers.next(), multipliers.next_back());
    let ends = format!(
        "`{}` to `{}`",
        first.expect("a name"),
        last.expect("a name")
    );
    assert!(
        table("response --csv")
            .iter()
            .any(|(names, _)| names.trim() == ends)
    );
}

/// Sampled at jumps of the damping, a branch turns where there is no fold: the one way to have turns in a file.
#[test]
fn fields_are_those_of_the_chapter() {
    let command = "--alpha 1 --from 1.4 --to 0.705 --harmonics 10 --samples 256 --aft sampled --max-points 3000 --at 1.2";
    let (all, _) = written("sampled", command);
    let (branch_in, orbit_in) = ("### A branch in JSON", "### An orbit in JSON");
    assert_eq!(names(&all), fields("response --json"));
    assert_fields(&all["branches"], &fields(branch_in));
    let branch = &all["branches"][0];
    assert_fields(&branch["points"], &fields(orbit_in));
    assert_fields(&all["at"], &fields(orbit_in));
    assert_fields(&branch["turns"], &described(branch_in, "turns"));
    for field in ["statistics", "work"] {
        assert_eq!(names(&branch[field]), described(branch_in, field));
    }
    let point = &branch["points"][0];
    for (object, heading, field) in [
        (&branch["model"], branch_in, "model"),
        (&point["orbit"], orbit_in, "orbit"),
        (&point["stability"], orbit_in, "stability"),
        (&point["observed"], orbit_in, "observed"),
        (&point["observed"]["motions"][0], orbit_in, "observed"),
        (&point["observed"]["contacts"][0], orbit_in, "observed"),
    ] {
        assert!(
            names(object).is_subset(&described(heading, field)),
            "{field}: {object}"
        );
    }

    let command =
        "--alpha 1 --to 1.4 --bifurcations --track fold --in omega,drive --within 0.03,0.5";
    let (all, _) = written("track", command);
    assert!(
        all["branches"]
            .as_array()
            .is_some_and(|list| list.len() > 1)
    );
    for branch in all["branches"].as_array().expect("branches") {
        assert_fields(&branch["events"], &described(branch_in, "events"));
        assert_fields(&branch["points"], &fields(orbit_in));
    }
    let said = described("response --json", "tracks");
    let track = &all["tracks"][0];
    for object in [track, &track["special"][0]] {
        assert!(names(object).is_subset(&said), "{object}");
    }
    assert_fields(&track["points"], &fields(orbit_in));
}

#[test]
fn fields_of_a_backbone_are_those_of_the_chapter() {
    let (all, _) = written("backbone", "--continuous --load 0 --backbone --harmonics 5");
    let said = described("response --json", "backbone");
    assert!(names(&all["backbone"]).is_subset(&said));
    for curve in ["free", "resonance"] {
        let curve = &all["backbone"][curve];
        assert!(names(curve).is_subset(&fields("### A branch in JSON")));
        assert_fields(&curve["points"], &fields("### An orbit in JSON"));
        assert_eq!(curve["request"]["backbone"], true);
    }
}

/// A linear spring in both directions is no contact.
#[test]
fn without_a_contact_nothing_is_said_of_one() {
    let (all, csv) = written("linear", "--alpha 1 --continuous --from 0.9 --to 1.1");
    let contact = ["contact_fraction", "contacts", "peak_force"];
    for point in all["branches"][0]["points"].as_array().expect("points") {
        assert_eq!(point["observed"]["contacts"], serde_json::json!([]));
    }
    let mut reader = csv::Reader::from_reader(csv.as_bytes());
    let head = reader.headers().expect("a head").clone();
    for row in reader.records() {
        let row = row.expect("a row");
        for (name, cell) in head.iter().zip(&row) {
            assert_eq!(contact.contains(&name), cell.is_empty(), "{name}: {cell}");
        }
    }
}
