//! The program `response`: what it accepts, what it writes, and what it says.

use std::path::{Path, PathBuf};
use std::sync::atomic::AtomicBool;

use clap::Parser;
use hertzian_examples::response::boundary::loss_of_contact;
use hertzian_examples::response::files::COLUMNS;
use hertzian_examples::response::options::{Multipliers, Options};
use hertzian_examples::response::progress::Progress;
use hertzian_examples::response::run::{Failure, Outcome, run};
use serde_json::Value;

/// A folder of its own, removed with everything in it.
struct Folder(PathBuf);

impl Folder {
    fn new(name: &str) -> Self {
        let path = Path::new(env!("CARGO_TARGET_TMPDIR")).join(format!("response-{name}"));
        let _ = std::fs::remove_dir_all(&path);
        std::fs::create_dir_all(&path).expect("a folder");
        Self(path)
    }

    fn file(&self, name: &str) -> String {
        self.0.join(name).display().to_string()
    }
}

impl Drop for Folder {
    fn drop(&mut self) {
        let _ = std::fs::remove_dir_all(&self.0);
    }
}

fn options(arguments: &[&str]) -> Options {
    let arguments = std::iter::once("response").chain(arguments.iter().copied());
    Options::try_parse_from(arguments).expect("arguments that can be parsed")
}

fn run_with(arguments: &[&str]) -> Result<Outcome, Failure> {
    let never = AtomicBool::new(false);
    run(&options(arguments), &never, &mut Progress::new(false))
}

/// Enough for a curve, and quick.
const COARSE: [&str; 4] = ["--harmonics", "5", "--samples", "128"];

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

#[test]
fn without_arguments_it_is_figure_5b() {
    let options = options(&[]);
    assert!(options.model.loses_contact());
    let values = [
        options.model.alpha,
        options.model.zeta,
        options.model.load,
        options.model.drive,
        options.from,
        options.to,
    ];
    assert_eq!(values, [1.5, 0.032, 1.0, 0.1, 0.6, 1.6]);
    assert!(options.over_frequency());
    assert_eq!(options.svg, Path::new("response.svg"));
    assert_eq!((options.csv, options.json), (None, None));
}

#[test]
fn every_option_is_understood() {
    let all = "--alpha 0.6 --continuous --zeta 0.01 --load -5e-1 --drive 0.2 --omega 2 --sweep drive --from 1 --to 2.2 \
               --period 2 --harmonics 7 --samples 99 --aft sampled --tolerance 1e-5 --max-points 10 --at 1.5 -0.2 \
               --svg a.svg --csv b.csv --json c.json --multipliers koopman-hill-subharmonic --quiet";
    let options = options(&all.split_whitespace().collect::<Vec<_>>());
    assert!(!options.model.loses_contact() && options.quiet);
    assert_eq!((options.model.load, options.model.frequency()), (-0.5, 2.0));
    assert_eq!(
        (options.harmonics, options.samples, options.period),
        (Some(7), Some(99), 2)
    );
    assert_eq!(options.at, [1.5, -0.2]);
    assert_eq!(options.multipliers, Multipliers::KoopmanHillSubharmonic);
    assert_eq!(options.varied(), "drive");
}

#[test]
fn bad_usage_is_refused_by_the_parser() {
    for arguments in [
        &["--alpha"][..],
        &["--alpha", "soft"],
        &["--harmonics", "-3"],
        &["--aft", "exact"],
        &["--multipliers", "guess"],
        &["--one-sided", "--continuous"],
        &["--amplitude", "1"],
        &["stray"],
    ] {
        let arguments = std::iter::once("response").chain(arguments.iter().copied());
        let error = Options::try_parse_from(arguments).expect_err("a refusal");
        assert_eq!(error.exit_code(), 2, "{error}");
    }
}

#[test]
fn bad_input_gives_one_message_and_exit_code_2() {
    let folder = Folder::new("bad");
    let nowhere = folder.file("missing/file");
    let itself = folder.0.display().to_string();
    for (arguments, message) in [
        (&["--alpha", "0"][..], "alpha"),
        (&["--alpha", "NaN"], "alpha"),
        (&["--alpha", "-1.5", "--continuous"], "alpha"),
        (&["--zeta", "-0.1"], "zeta"),
        (&["--zeta", "inf"], "zeta"),
        (&["--load", "NaN"], "load"),
        (&["--drive", "inf"], "drive"),
        (&["--from", "NaN"], "omega"),
        (&["--from", "0"], "omega"),
        (&["--from", "-1"], "omega"),
        (&["--to", "inf"], "omega"),
        (&["--from", "1", "--to", "1"], "range is empty"),
        (&["--sweep", "drive", "--omega", "0"], "omega"),
        (&["--sweep", "drive", "--from", "NaN"], "drive"),
        (&["--period", "0"], "period"),
        (&["--max-points", "0"], "max_points"),
        (&["--tolerance", "0"], "tolerance"),
        (&["--tolerance", "NaN"], "tolerance"),
        (&["--at", "1", "NaN"], "at"),
        (&["--csv", &nowhere], "cannot write"),
        (&["--json", &itself], "cannot write"),
    ] {
        let failure = coarse(&folder, arguments).expect_err("a refusal");
        let text = failure.to_string();
        assert_eq!(failure.exit_code(), 2, "{text}");
        assert!(text.contains(message), "{arguments:?}: {text}");
        assert!(text.lines().count() == 1 && text.len() < 200, "{text}");
    }
    for arguments in [["--harmonics", "0"], ["--samples", "3"]] {
        let failure = run_with(&arguments).expect_err("a refusal");
        assert_eq!(failure.exit_code(), 2, "{failure}");
    }
    assert!(!Path::new("response.svg").exists());
}

#[test]
fn json_has_the_documented_names() {
    let folder = Folder::new("json");
    let (json, csv) = (folder.file("a.json"), folder.file("a.csv"));
    let outcome = coarse(
        &folder,
        &[
            "--continuous",
            "--from",
            "1",
            "--json",
            &json,
            "--csv",
            &csv,
            "--at",
            "1.3",
        ],
    )
    .expect("a branch");
    assert!(outcome.complete && outcome.warnings.is_empty());

    let text = std::fs::read_to_string(&json).expect("a file");
    let all: Value = serde_json::from_str(&text).expect("JSON");
    let points = all["points"].as_array().expect("points");
    let at = all["at"].as_array().expect("solutions at 1.3");
    assert!(points.len() > 20 && !at.is_empty());
    for point in points.iter().chain(at) {
        check_point(point);
    }
    assert_eq!(points[0]["omega"], 1.0);
    assert_eq!(points[points.len() - 1]["omega"], 1.6);
    assert!(at.iter().all(|point| point["omega"] == 1.3));
    let events = all["events"].as_array().expect("events");
    for event in events {
        assert_eq!(event["kind"], "fold");
        let names = ["omega", "drive", "peak_to_peak", "error"];
        assert!(numbers(event, &names).all(f64::is_finite));
    }
    assert!(all["stopped"].is_string() && all["turns"].is_array());
    assert!(all["statistics"]["jacobians"].as_u64() > Some(20));
    assert!(all["elapsed_seconds"].as_f64() > Some(0.0));

    check_csv(&csv, points);
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
    assert_eq!(header.iter().collect::<Vec<_>>(), COLUMNS);
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

#[test]
fn every_model_runs_both_ways() {
    let folder = Folder::new("models");
    for alpha in ["1", "1.5", "2.2"] {
        for kind in ["--one-sided", "--continuous"] {
            for sweep in [
                &["--sweep", "omega", "--from", "1.9", "--to", "1.8"][..],
                &[
                    "--sweep", "drive", "--from", "0.01", "--to", "0.1", "--omega", "1.9",
                ],
            ] {
                let arguments = [&["--alpha", alpha, kind][..], sweep].concat();
                let outcome = coarse(&folder, &arguments).expect("a branch");
                assert!(outcome.complete, "{arguments:?}: {}", outcome.summary);
            }
        }
    }
}

#[test]
fn a_branch_that_ends_early_is_written_all_the_same() {
    let folder = Folder::new("early");
    let json = folder.file("a.json");
    let arguments = ["--max-points", "7", "--json", &json, "--at", "1.5"];
    let outcome = coarse(&folder, &arguments).expect("a branch");
    assert!(!outcome.complete);
    assert!(outcome.summary.contains("limit of 7 points"));
    assert!(outcome.warnings[0].contains("does not pass omega = 1.5"));
    assert!(outcome.warnings[1].contains("ended early: reached the limit"));
    let text = std::fs::read_to_string(&json).expect("a file");
    let all: Value = serde_json::from_str(&text).expect("JSON");
    assert_eq!(all["points"].as_array().map(Vec::len), Some(7));
}

#[test]
fn an_interrupt_ends_the_branch() {
    let folder = Folder::new("interrupt");
    let svg = folder.file("a.svg");
    let now = AtomicBool::new(true);
    let outcome = run(&options(&["--svg", &svg]), &now, &mut Progress::new(false));
    let outcome = outcome.expect("a branch");
    assert!(!outcome.complete && outcome.summary.contains("interrupted"));
    assert!(Path::new(&svg).exists());
}

#[test]
fn a_summary_says_what_matters() {
    let folder = Folder::new("summary");
    let outcome = coarse(&folder, &["--continuous", "--zeta", "0.01", "--to", "1.7"]);
    let summary = outcome.expect("a branch").summary;
    for part in [
        "sgn(x) |x|^alpha",
        "alpha = 1.5, zeta = 0.01, load = 1, drive = 0.1",
        "omega from 0.600000 to 1.700000",
        "reached the end of the range",
        "fold       omega 1.",
        "stable before the fold at omega",
        "response.svg",
    ] {
        assert!(summary.contains(part), "{part} in\n{summary}");
    }
    assert!(summary.lines().count() < 25);
    let picture = std::fs::read_to_string(folder.file("response.svg")).expect("a picture");
    assert!(picture.contains("Continuous, α = 1.5") && picture.contains("fold"));
}

#[test]
fn contact_with_a_linear_spring_is_lost_at_twice_the_load() {
    for load in ["0.5", "1"] {
        let options = options(&["--alpha", "1", "--load", load]);
        let boundary = loss_of_contact(&options.model, 0.6..=1.6, || false);
        assert!(boundary.len() > 20);
        for [omega, size] in boundary {
            let error = size - 2.0 * options.model.load;
            assert!(error.abs() < 1e-4, "{size} at {omega} for load {load}");
        }
    }
}

#[test]
fn contact_that_cannot_be_lost_has_no_boundary() {
    for arguments in [&["--continuous"][..], &["--load", "0"], &["--load", "-1"]] {
        let boundary = loss_of_contact(&options(arguments).model, 0.6..=1.6, || false);
        assert_eq!(boundary, Vec::<[f64; 2]>::new());
    }
}

/// A Duffing oscillator read from a file is the one that is declared: its response to a small force is the linear one.
#[test]
fn an_oscillator_is_read_from_a_file() {
    let folder = Folder::new("model");
    let model = folder.file("duffing.txt");
    let text = "Duffing(x) {\n    param zeta = 0.05 in 0.0..;\n    param drive;\n    \
                ddot(x) + 2*zeta*dot(x) + x + x^3 = drive*cos(omega*t);\n}\n";
    std::fs::write(&model, text).expect("written");
    let arguments = [
        "--model",
        &model,
        "--set",
        "drive=1e-5",
        "--to",
        "0.7",
        "--at",
        "0.6",
    ];
    let outcome = coarse(&folder, &arguments).expect("a branch");
    assert!(outcome.complete);
    let peak_to_peak = 2e-5 / (1.0 - 0.36_f64).hypot(0.06);
    let found = format!("at         omega 0.6: peak-to-peak {peak_to_peak:.6}, stable");
    assert!(
        outcome.summary.contains(&found),
        "{found} in\n{}",
        outcome.summary
    );
    assert!(outcome.summary.contains("zeta = 0.05, drive = 0.00001"));
}

#[test]
fn what_is_wrong_with_a_file_is_said_with_its_place() {
    let folder = Folder::new("faulty");
    let model = folder.file("model.txt");
    let refused = |text: &str, more: &[&str]| {
        std::fs::write(&model, text).expect("written");
        let arguments = [&["--model", &model][..], more].concat();
        let failure = coarse(&folder, &arguments).expect_err("a failure");
        assert_eq!(failure.exit_code(), 2);
        failure.to_string()
    };
    let good = "A(x) { param k; ddot(x) + k*x = cos(omega*t); }";
    assert!(
        refused("A(x) { param k; ddot(x) + kk*x = 0; }", &[])
            .contains("model.txt:1:27: unknown name `kk`")
    );
    assert!(refused(good, &[]).ends_with("parameters without a value: --set k=VALUE"));
    assert!(refused(good, &["--set", "c=1"]).contains('c'));
    assert!(refused(good, &["--set", "k=1", "--sweep", "drive"]).contains("no parameter drive"));
    std::fs::remove_file(&model).expect("removed");
    let failure = coarse(&folder, &["--model", &model]).expect_err("a failure");
    assert!(failure.to_string().starts_with("cannot read"));
}

#[test]
fn any_parameter_varies_and_the_record_says_of_what() {
    let folder = Folder::new("parameter");
    let (model, json, svg) = (
        folder.file("a.txt"),
        folder.file("a.json"),
        folder.file("response.svg"),
    );
    let text = "Stop(x) { param k >= 0; param zeta >= 0; law stop(g) { g > 0 => k*g, else => 0 }
                ddot(x) + zeta*dot(x) + x + stop(x - 1) = 0.2*cos(omega*t); }";
    std::fs::write(&model, text).expect("written");
    let command = format!(
        "--model {model} --set zeta=0.1 --sweep k --omega 1.2 --from 0.5 --to 1 --json {json} --bifurcations"
    );
    let arguments: Vec<_> = command.split_whitespace().collect();
    let outcome = coarse(&folder, &arguments);
    assert!(outcome.expect("a branch").complete);
    let all = all(&json);
    assert_eq!(
        (&all["model"], &all["varied"]),
        (&"Stop".into(), &"k".into())
    );
    assert_eq!(all["parameters"]["zeta"], 0.1);
    let points = all["points"].as_array().expect("points");
    assert_eq!(points[0]["value"], 0.5);
    assert_eq!(points.last().expect("points")["value"], 1.0);
    let picture = std::fs::read_to_string(&svg).expect("a picture");
    assert!(picture.contains("Stop: zeta = 0.1, ω = 1.2"), "{picture}");
    let alone = coarse(
        &folder,
        &["--sweep", "alpha", "--from", "1.4", "--to", "1.6"],
    );
    assert!(alone.expect("a branch").complete);
    let failure = coarse(
        &folder,
        &["--model", &model, "--set", "zeta=0.1", "--backbone"],
    );
    assert_eq!(failure.expect_err("a failure").exit_code(), 2);
}

fn all(json: &str) -> Value {
    let text = std::fs::read_to_string(json).expect("a file");
    serde_json::from_str(&text).expect("JSON")
}

/// Figure 8a of Wang et al. (2021) by one command. Exact values: `amplitude_sweep` of reference values computed independently of this
/// project, with 60 digits.
#[test]
fn the_cascade_of_figure_8a() {
    let folder = Folder::new("cascade");
    let [svg, json, csv] = ["a.svg", "a.json", "a.csv"].map(|name| folder.file(name));
    let command = "--alpha 1 --one-sided --zeta 0.032 --load 1 --sweep drive --omega 1 --from 0.1 --to 2.0 \
                   --bifurcations --follow 3";
    let files = ["--svg", &svg, "--json", &json, "--csv", &csv];
    let arguments: Vec<&str> = command.split_whitespace().chain(files).collect();
    let outcome = run_with(&arguments).expect("a branch");
    assert!(outcome.complete, "{}", outcome.summary);
    let all = all(&json);
    let events = all["events"].as_array().expect("events");
    for (kind, period, drive) in [
        ("period-doubling", 1, 1.282_584_167_663_767),
        ("period-doubling", 2, 1.531_044_135_499_983),
        ("period-doubling", 2, 1.880_077_405_264_828),
        ("fold", 2, 2.009_554_757_004_067),
        ("fold", 2, 0.294_528_806_187_216),
        ("fold", 8, 1.779_836_025_884_334),
    ] {
        let is_it = |event: &&Value| {
            let place = event["drive"].as_f64().expect("a number");
            event["kind"] == kind && event["period"] == period && (place - drive).abs() < 1e-9
        };
        let event = events.iter().find(is_it);
        let event = event.unwrap_or_else(|| panic!("{kind} {period} {drive}"));
        assert!(event["branch"].is_u64());
    }
    let points = all["points"].as_array().expect("points");
    for period in [1, 2, 4, 8] {
        assert!(points.iter().any(|point| point["period"] == period));
    }
    for branch in 0..5 {
        assert!(points.iter().any(|point| point["branch"] == branch));
    }
    check_csv(&csv, points);
    for part in ["period 8", "period-doubling", "grazing"] {
        let picture = std::fs::read_to_string(&svg).expect("a picture");
        assert!(picture.contains(part), "{part}");
    }
}

#[test]
fn folds_are_tracked_in_two_parameters() {
    let folder = Folder::new("track");
    let [svg, json] = ["a.svg", "a.json"].map(|name| folder.file(name));
    let command = "--alpha 1 --from 0.6 --to 1.6 --bifurcations --track fold --in omega,drive --within 0.03,0.5";
    let files = ["--svg", &svg, "--json", &json];
    let arguments: Vec<&str> = command.split_whitespace().chain(files).collect();
    run_with(&arguments).expect("a branch");
    let all = all(&json);
    let tracks = all["tracks"].as_array().expect("tracks");
    assert_eq!(tracks.len(), 1);
    assert_eq!(tracks[0]["kind"], "fold");
    assert_eq!(tracks[0]["names"][1], "drive");
    assert!(tracks[0]["points"].as_array().map(Vec::len) > Some(20));
    assert_eq!(tracks[0]["special"][0]["kind"], "cusp");
}

/// Where a Hertzian contact is lost: both events of the branch are on one curve, and it has a least drive between them.
#[test]
fn grazing_is_tracked_in_two_parameters() {
    let folder = Folder::new("touch");
    let [svg, json] = ["a.svg", "a.json"].map(|name| folder.file(name));
    let command = "--from 0.6 --to 1.6 --track grazing --in omega,drive --within 0.03,0.5";
    let files = ["--svg", &svg, "--json", &json];
    let arguments: Vec<&str> = command.split_whitespace().chain(files).collect();
    let outcome = run_with(&arguments).expect("a branch");
    assert!(outcome.complete, "{}", outcome.summary);
    let all = all(&json);
    let tracks = all["tracks"].as_array().expect("tracks");
    assert_eq!(tracks.len(), 1);
    assert_eq!(tracks[0]["kind"], "grazing");
    let points = tracks[0]["points"].as_array().expect("points");
    let drives = points
        .iter()
        .map(|point| point[1].as_f64().expect("a number"));
    let drives: Vec<f64> = drives.collect();
    assert!(drives.len() > 20);
    for end in [drives[0], drives[drives.len() - 1]] {
        assert!((end - 0.5).abs() < 1e-12, "{end}");
    }
    assert!(drives.iter().copied().fold(f64::INFINITY, f64::min) < 0.1);
}

/// What `--in` names must be what varies and something else.
#[test]
fn a_plane_has_two_parameters() {
    let folder = Folder::new("plane");
    for plane in ["omega", "drive,load", "omega,nothing"] {
        let arguments = ["--bifurcations", "--track", "fold", "--in", plane];
        let failure = coarse(&folder, &arguments).expect_err("a refusal");
        assert_eq!(failure.exit_code(), 2, "{failure}");
    }
}

#[test]
fn a_backbone_is_drawn_through_the_resonance() {
    let folder = Folder::new("backbone");
    let [svg, json] = ["a.svg", "a.json"].map(|name| folder.file(name));
    let command = "--continuous --load 0 --zeta 0.01 --from 0.6 --to 1.7 --backbone";
    let files = ["--svg", &svg, "--json", &json];
    let arguments: Vec<&str> = command.split_whitespace().chain(files).collect();
    run_with(&arguments).expect("a branch");
    let all = all(&json);
    for curve in ["free", "resonance"] {
        let points = all["backbone"][curve].as_array().expect("a curve");
        assert!(points.len() > 5, "{curve}");
        for point in points {
            let [omega, size]: [f64; 2] = numbers(point, &["omega", "peak_to_peak"])
                .collect::<Vec<_>>()
                .try_into()
                .expect("two numbers");
            let free = 0.954_693_569_728_51 * (0.5 * size).powf(0.25);
            let tolerance = if curve == "free" { 1e-9 } else { 0.01 };
            assert!(
                (omega / free - 1.0).abs() < tolerance,
                "{curve} {omega} {free}"
            );
        }
    }
    let picture = std::fs::read_to_string(&svg).expect("a picture");
    assert!(picture.contains("free oscillation") && picture.contains("phase resonance"));
}
