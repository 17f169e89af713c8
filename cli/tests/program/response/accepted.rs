//! Options and files of oscillators: what is understood, and what is refused in which words.

use hertzian::Cancel;
use std::path::Path;

use hertzian_cli::response::boundary::loss_of_contact;
use hertzian_cli::response::options::Multipliers;

use serde_json::Value;

use super::{all, coarse, options, read, run_with};
use crate::folder::Folder;

#[test]
fn without_arguments_it_is_figure_5b() {
    let options = options(&[]);
    assert!(options.model.loses_contact());
    let values = [
        options.model.alpha,
        options.model.zeta,
        options.model.load,
        options.model.drive,
        options.range.from,
        options.range.to,
    ];
    assert_eq!(values, [1.5, 0.032, 1.0, 0.1, 0.6, 1.6]);
    assert!(options.over_frequency());
    assert_eq!(options.svg, Path::new("response.svg"));
    assert_eq!((options.csv, options.json), (None, None));
}

#[test]
fn every_option_is_understood() {
    let all = "--alpha 0.6 --continuous --zeta 0.01 --load -5e-1 --omega 2 --sweep drive --from 1 --to 2.2 \
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
    assert_eq!(
        options.multipliers,
        Some(Multipliers::KoopmanHillSubharmonic)
    );
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
        let error = read(arguments).expect_err("a refusal");
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
        (
            &["--accuracy-of", "tip"],
            "accuracy is that of an output or a coordinate",
        ),
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
    for arguments in [
        &["--harmonics", "0"][..],
        &["--aft", "sampled", "--samples", "3"],
    ] {
        let failure = run_with(arguments).expect_err("a refusal");
        assert_eq!(failure.exit_code(), 2, "{failure}");
    }
    assert!(!Path::new("response.svg").exists());
}

#[test]
fn contact_with_a_linear_spring_is_lost_at_twice_the_load() {
    for load in ["0.5", "1"] {
        let options = options(&["--alpha", "1", "--load", load]);
        let boundary = loss_of_contact(&options.model, 0.6..=1.6, &Cancel::new());
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
        let boundary = loss_of_contact(&options(arguments).model, 0.6..=1.6, &Cancel::new());
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
    let summary = &outcome.summary;
    let found = summary.split_once("at         omega 0.6: peak-to-peak ");
    let found = found.and_then(|(_, rest)| rest.split_once(", stable"));
    let (found, _) = found.expect(summary);
    let found: f64 = found.parse().expect("a number");
    // The cubic force is smaller by the square of the amplitude.
    assert!((found / peak_to_peak - 1.0).abs() < 1e-8, "{summary}");
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

/// What would have no effect is not taken silently, and numbers of things are not negative.
#[test]
fn options_that_would_do_nothing_are_refused() {
    for (arguments, message) in [
        (
            &["--sweep", "drive", "--drive", "1"][..],
            "--sweep drive takes the place of the value of drive: --from and --to say where it begins and ends",
        ),
        (&["--omega", "2"], "--sweep omega takes the place"),
        (
            &["--track", "fold", "--in", "omega,drive", "--values", "3"],
            "--values, --starts and --patience do nothing beside --track",
        ),
        (
            &["--by", "shooting", "--harmonics", "9"],
            "--harmonics belongs to --by balance",
        ),
        (
            &["--samples", "512"],
            "--samples belongs to --aft sampled or --aft primitive",
        ),
        (
            &["--bifurcations", "--follow", "-1"],
            "must be a whole number, zero or more",
        ),
        (
            &["--model", "a.txt", "--set", "k=1", "--sweep", "k"],
            "--sweep k takes the place of the value of k",
        ),
    ] {
        let error = read(arguments).expect_err("a refusal");
        let text = error.to_string();
        assert!(text.contains(message), "{text}");
        assert_eq!(error.exit_code(), 2);
    }
}

/// A function that there is not, and an end of a range that is on the wrong side: one message each, with what to write.
#[test]
fn faults_of_a_file_are_said_once_with_what_to_write_instead() {
    let folder = Folder::new("instead");
    let model = folder.file("model.txt");
    for (text, expected) in [
        (
            "A(x) { ddot(x) + sinh(x) = cos(omega*t); }",
            "model.txt:1:18: unknown function `sinh`: write `(exp(x) - exp(-x))/2`",
        ),
        (
            "A(x) { param k = 1 in 5..0; ddot(x) + k*x = cos(omega*t); }",
            "model.txt:1:20: no value of `k` lies in this range: write the smaller end first, as in `0..=5`",
        ),
        (
            "A(x) { x'' + x = cos(omega*t); }",
            "model.txt:1:8: a second derivative by time is written `ddot(x)`, not `x''`",
        ),
    ] {
        std::fs::write(&model, text).expect("written");
        let failure = coarse(&folder, &["--model", &model]).expect_err("a failure");
        let said = failure.to_string();
        assert!(said.ends_with(expected), "{said}");
        assert_eq!(said.lines().count(), 1, "{said}");
    }
}

/// Gears that turn freely. As long as the teeth press, the mesh is linear, `r'' = -3/2 (k (1 + cos(omega t)/5) r + c r')`, and has motions of twice the
/// period where Hill's determinant of odd multiples of half the frequency vanishes, here of 24 of them in 40 digits.
#[test]
fn doublings_of_what_nothing_holds_are_found() {
    let folder = Folder::new("free");
    let json = folder.file("a.json");
    let command = "--model gear-mesh --from 3.3e4 --to 3.6e4 --bifurcations --one-branch --json";
    let arguments: Vec<&str> = command.split(' ').chain([json.as_str()]).collect();
    let outcome = run_with(&[&arguments[..], &["--svg", &folder.file("a.svg")]].concat());
    assert!(outcome.expect("a branch").complete);
    let all = all(&json);
    // The branch as it was asked for, and the same again as the first of the diagram.
    let branches = all["branches"].as_array().expect("branches");
    assert_eq!(branches.len(), 2);
    for (branch, most) in branches.iter().zip([1e-7, 1e-9]) {
        let events = branch["events"].as_array().expect("events").iter();
        let doublings: Vec<_> = events
            .filter(|event| event["kind"] == "period-doubling")
            .collect();
        assert_eq!(doublings.len(), 2);
        for (event, exact) in doublings
            .iter()
            .zip([33_721.404_775_409_11, 35_452.857_836_518_27])
        {
            let [value, error] = [&event["point"]["value"], &event["error"]].map(Value::as_f64);
            let apart = (value.expect("a number") - exact).abs();
            let error = error.expect("a number");
            assert!(apart <= error && error < most, "{apart:e} {event}");
        }
    }
}
