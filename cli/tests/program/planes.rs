//! The subcommand `response` in planes: curves in two parameters, and where attractors are looked for; and `map`.

use std::ffi::OsString;

use clap::Parser;
use hertzian::Cancel;
use hertzian::attractors::basin::Axis;
use hertzian::bifurcation::Map;
use hertzian_cli::command::{Program, Task};
use hertzian_cli::response::model_file::Varied;
use hertzian_cli::response::models::model;
use hertzian_cli::response::options::Options;
use hertzian_cli::response::progress::Progress;
use hertzian_cli::response::run::{Failure, Outcome, run};
use hertzian_cli::response::search;
use hertzian_cli::{map, show};
use serde_json::Value;

use crate::cancels::CancelsWhereWritten;
use crate::folder::Folder;

impl Folder {
    /// A file with this text.
    fn with(&self, name: &str, text: &str) -> String {
        std::fs::write(self.0.join(name), text).expect("written");
        self.file(name)
    }

    /// Runs a command that writes a picture and JSON, named by a letter.
    fn run(&self, name: &str, command: &str) -> Result<Outcome, Failure> {
        let [svg, json] = ["svg", "json"].map(|kind| self.file(&format!("{name}.{kind}")));
        let command = format!("{command} --svg {svg} --json {json}");
        let never = Cancel::new();
        run(&options(&command), &never, &mut Progress::hidden())
    }

    fn picture(&self, name: &str) -> String {
        std::fs::read_to_string(self.0.join(name).with_extension("svg")).expect("a picture")
    }

    fn json(&self, name: &str) -> Value {
        let text = std::fs::read_to_string(self.0.join(name).with_extension("json"));
        serde_json::from_str(&text.expect("a file")).expect("JSON")
    }
}

fn options(command: &str) -> Options {
    let words = std::iter::once("response").chain(command.split_whitespace());
    Options::try_parse_from(words).expect("arguments that can be parsed")
}

/// What is an axis is not in the title, and everything else is.
#[test]
fn a_title_says_what_is_fixed() {
    let folder = Folder::new("title");
    let text = "Duffing(x) { param zeta = 0.05; param drive = 0.1;
                ddot(x) + 2*zeta*dot(x) + x + x^3 = drive*cos(omega*t); }";
    let duffing = folder.with("duffing.txt", text);
    let duffing = format!("--model {duffing} --from 0.8 --to 1.8 --bifurcations --track fold");
    let declared = "--alpha 1 --from 0.6 --to 1.4 --bifurcations --track fold";
    for (name, command, title) in [
        (
            "a",
            format!("{declared} --in omega,zeta --within 0.02,0.05"),
            ">One-sided, α = 1, W = 1, A = 0.1<",
        ),
        (
            "b",
            format!("{declared} --in drive,omega --within 0.05,0.2"),
            ">One-sided, α = 1, ζ = 0.032, W = 1<",
        ),
        (
            "c",
            format!("{duffing} --in omega,zeta --within 0.04,0.06"),
            ">Duffing: drive = 0.1<",
        ),
    ] {
        folder.run(name, &command).expect("a curve");
        assert!(folder.picture(name).contains(title), "{command}");
        let all = folder.json(name);
        assert!(!all["tracks"].as_array().expect("curves").is_empty());
    }
}

/// With `x` and the load reversed, and half a period later, a spring that acts in both directions is what it was.
#[test]
fn folds_at_negative_loads_mirror_those_at_positive_ones() {
    let folder = Folder::new("mirror");
    let command = "--continuous --zeta 0.01 --sweep load --omega 1.15 --bifurcations --track fold --in load,drive";
    let ends = |name: &str, range: &str| {
        let outcome = folder.run(name, &format!("{command} {range}"));
        let outcome = outcome.expect("a branch");
        assert_eq!(outcome.warnings, Vec::<String>::new());
        let all = folder.json(name);
        let number = |value: &Value| value.as_f64().expect("a number");
        let tracks = all["tracks"].as_array().expect("curves");
        let ends = tracks.iter().flat_map(|track| {
            let values = track["values"].as_array().expect("values");
            let ends = [&values[0], &values[values.len() - 1]];
            ends.map(|end| [number(&end[0]), number(&end[1])])
        });
        ends.collect::<Vec<_>>()
    };
    let (below, above) = (
        ends("n", "--from -2 --to -0.5"),
        ends("p", "--from 2 --to 0.5"),
    );
    assert_eq!((below.len(), above.len()), (4, 4));
    for (below, above) in below.iter().zip(&above) {
        assert!((below[0] + above[0]).abs() < 1e-9, "{below:?} {above:?}");
        assert!((below[1] - above[1]).abs() < 1e-12, "{below:?} {above:?}");
    }
}

/// The same force, however it is written and whatever varies, gives the same grid.
#[test]
fn a_grid_is_as_large_as_flights_under_the_force_there() {
    let folder = Folder::new("grid");
    let text = "Own(y) { param heavy; param shake; law contact(gap) { gap > 0 => gap, else => 0 }
                2*ddot(y) + contact(y) = 2*shake*cos(omega*t) + 2*heavy; }";
    let own = folder.with("own.txt", text);
    let grid = |command: &str, value: f64| {
        let options = options(command);
        let varied = Varied {
            name: &options.range.sweep,
            value: options.range.from,
        };
        let model = model(&options.model, varied).expect("a model");
        let grid = search::grid(&options, &*model, value);
        [grid.columns, grid.rows].map(|Axis { from, to, .. }| [from, to])
    };
    // A flight of five periods of 2 pi under the load 3.
    let time = 10.0 * std::f64::consts::PI;
    let height = 0.15 * 3.0 * time * time;
    let speed = 0.5 * 3.0 * time;
    for (command, value) in [
        ("--load 3", 1.0),
        ("--load -1 --drive 3", 1.0),
        ("--sweep load --omega 1", 3.0),
        ("--sweep drive", 3.0),
        (&format!("--model {own} --set heavy=3 --set shake=1"), 1.0),
        (&format!("--model {own} --set heavy=1 --sweep shake"), 3.0),
    ] {
        let found = grid(command, value);
        let expected = [[-height, 0.2 * height], [-speed, speed]];
        for (found, expected) in found.iter().flatten().zip(expected.iter().flatten()) {
            let error = (found / expected - 1.0).abs();
            assert!(error < 1e-14, "{command}: {found} {expected}");
        }
    }
}

#[test]
fn what_cannot_be_searched_is_refused() {
    let folder = Folder::new("search");
    let two = "Two(x[2]) { for i in 0..2 { ddot(x[i]) + 0.1*dot(x[i]) + x[i]^3 = cos(omega*t); } }";
    let unforced = "Shaken(x) { ddot(x) + 0.1*dot(x) + (1 + 0.3*cos(omega*t))*x + x^3 = 0; }";
    for (text, message) in [(two, "one coordinate"), (unforced, "right-hand side")] {
        let model = folder.with("model.txt", text);
        let command = format!("--model {model} --bifurcations --search 1");
        let failure = folder.run("a", &command).expect_err("a refusal");
        assert_eq!(failure.exit_code(), 2);
        assert!(failure.to_string().contains(message), "{failure}");
    }
}

/// The subcommand `map` with these words, into files of a folder.
fn mapped(folder: &Folder, words: &str, progress: &mut Progress, cancel: &Cancel) -> Mapped {
    let [svg, csv, json] = ["svg", "csv", "json"].map(|kind| folder.file(&format!("map.{kind}")));
    let words = format!("hertzian map {words} --svg {svg} --csv {csv} --json {json}");
    let program = Program::read(words.split_whitespace().map(OsString::from));
    let program = program.map_err(|error| error.to_string())?;
    let Task::Map(options) = program.task else {
        panic!("another task");
    };
    let ended = map::run(&options, cancel, progress).map_err(|failure| {
        assert_eq!(failure.exit_code(), 2);
        failure.to_string()
    })?;
    let read = |path: String| std::fs::read_to_string(path).expect("a file");
    let all = Map::read(&json).expect("a map");
    assert_eq!(all.to_csv(), read(csv));
    Ok((ended, all, read(svg)))
}

type Mapped = Result<(hertzian_cli::program::Ended, Map, String), String>;

/// Figure 5a of Wang et al. (2021) has its folds at 0.7151 and 0.9602, and at a fifth of the drive contact is not lost.
#[test]
fn a_map_has_a_cell_for_every_pair() {
    let folder = Folder::new("map");
    let never = Cancel::new();
    let words =
        "--alpha 1 --from 0.7 --to 1.1 --count 3 --over drive --low 0.02 --high 0.1 --rows 2";
    for (what, label) in [
        ("stable", "\"2 stable orbits\""),
        ("largest", "largest peak-to-peak of x of stable orbits"),
        ("verdict", "\"stable and unstable\""),
    ] {
        let words = format!("{words} --what {what}");
        let found = mapped(&folder, &words, &mut Progress::hidden(), &never);
        let (ended, map, svg) = found.expect("a map");
        assert!(ended.complete && ended.complaints.is_empty());
        let stable: Vec<usize> = map.cells.iter().map(|cell| cell.stable).collect();
        assert_eq!(stable, [1, 1, 1, 1, 2, 1]);
        assert_eq!(map.values, [vec![0.7, 0.9, 1.1], vec![0.02, 0.1]]);
        assert!(ended.summary.contains("2 stable orbits in 1 cell\n"));
        assert!(
            svg.contains("One-sided, α = 1: zeta = 0.032, load = 1; "),
            "{svg}"
        );
        assert!(svg.contains(label), "{svg}");
    }
}

#[test]
fn a_map_is_shown_from_its_file() {
    let folder = Folder::new("map-shown");
    let words =
        "--alpha 1 --from 0.7 --to 1.1 --count 3 --over drive --low 0.02 --high 0.1 --rows 2";
    let never = Cancel::new();
    let (ended, map, _) = mapped(&folder, words, &mut Progress::hidden(), &never).expect("a map");
    let [json, svg, csv] = ["map.json", "again.svg", "again.csv"].map(|name| folder.file(name));
    let shown = |words: &str| {
        let words = format!("hertzian show {json} {words}");
        let program = Program::read(words.split_whitespace().map(OsString::from)).expect("options");
        let Task::Show(options) = program.task else {
            panic!("another task");
        };
        show::show(&options)
    };
    let said = shown(&format!("--svg {svg} --csv {csv}")).expect("shown");
    assert!(ended.summary.starts_with(&said.summary), "{}", said.summary);
    let read = |path: &str| std::fs::read_to_string(path).expect("a file");
    assert_eq!(read(&csv), map.to_csv());
    let panels = ["2 stable orbits", "all stable", "largest peak-to-peak of x"];
    assert!(panels.iter().all(|label| read(&svg).contains(label)));
    let refused = shown("--at 0.9").expect_err("refused");
    assert!(
        refused.message.starts_with("--at is for branches"),
        "{}",
        refused.message
    );
    let over = shown(&format!("--csv {json}")).expect_err("refused");
    assert!(over.message.contains("more than once"), "{}", over.message);
}

#[test]
fn a_map_that_is_interrupted_is_written() {
    let folder = Folder::new("interrupted");
    let cancel = Cancel::new();
    let mut progress = Progress::to(CancelsWhereWritten(cancel.clone()));
    let words = "--alpha 1 --count 2 --over omega --sweep drive --from 0.02 --to 0.1 --low 0.8 --high 1 --rows 2";
    let (ended, map, svg) = mapped(&folder, words, &mut progress, &cancel).expect("a map");
    assert!(!ended.complete && map.omega.is_none());
    assert!(ended.complaints[0].starts_with("interrupted"));
    assert_eq!(map.cells.len(), 4);
    assert!(svg.contains("\"not looked at\""));
}

#[test]
fn what_makes_no_map_is_refused() {
    let folder = Folder::new("no-map");
    let over = "--over drive --low 0.02 --high 0.1";
    for (words, message) in [
        ("", "--over"),
        ("--over drive --low 1", "--high"),
        (
            "--over force --low 1 --high 2",
            "there is no parameter force",
        ),
        (
            "--over omega --low 1 --high 2",
            "two different ones make a map",
        ),
        (&format!("{over} --omega 1"), "the range gives it"),
        (
            &format!("{over} --drive 1"),
            "--over drive takes the place of the value of drive",
        ),
        (
            &format!("{over} --sweep load --load 1"),
            "--sweep load takes the place",
        ),
        (
            "--over drive --low 1 --high 1",
            "the range from 1 to 1 is empty",
        ),
        ("--over zeta --low -1 --high 1", "outside its range"),
        (&format!("{over} --rows 0"), "--rows 0: must be from 1"),
        (
            &format!("{over} --count 20000"),
            "--count 20000: must be from 1",
        ),
        (&format!("{over} --from nan"), "--from NaN: must be finite"),
        (&format!("{over} --from -1"), "omega = -1"),
        (
            &format!("{over} --set load=1"),
            "--set load belongs to --model",
        ),
        (&format!("{over} --model gear-pair"), "no parameter"),
    ] {
        let never = Cancel::new();
        let said = mapped(&folder, words, &mut Progress::hidden(), &never);
        let said = said.err().unwrap_or_default();
        assert!(said.contains(message), "{words}: {said}");
    }
    let left = std::fs::read_dir(&folder.0).expect("a folder").count();
    assert_eq!(left, 0, "nothing is written");
}
