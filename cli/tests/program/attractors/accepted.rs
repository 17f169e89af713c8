//! Options: figures by their names, and what is refused in which words.

use clap::CommandFactory;
use hertzian::Cancel;
use hertzian_cli::attractors::figures::FIGURES;
use hertzian_cli::attractors::options::Options;
use hertzian_cli::attractors::run::run;
use hertzian_cli::response::progress::Progress;

use super::{array, options, read, rows, run_in};
use crate::folder::Folder;

/// A figure, options that shorten it, and what its picture says.
const SHORTER: [(&str, &[&str], &[&str]); 5] = [
    (
        "8b",
        &["--values", "40", "--transient", "50", "--periods", "8"],
        &[
            "excitation amplitude A",
            "A rises",
            "A falls",
            "x at the beginning of each period",
        ],
    ),
    (
        "9b",
        &["--starts", "12"],
        &[
            "period 1",
            "period 2",
            "period 3a",
            "period 3b",
            "period 4",
            "period 5",
            "rate of x",
        ],
    ),
    (
        "10a",
        &["--transient", "100", "--periods", "400"],
        &["enlargement", "every 8th period"],
    ),
    (
        "10b",
        &["--transient", "100", "--periods", "400"],
        &["enlargement", "excitation periods"],
    ),
    (
        "11",
        &["--patience", "6000"],
        &[
            "period 8 at A = 1.77983",
            "\"period 8\"",
            "enlargement",
            "A = 1.785",
        ],
    ),
];

/// Each figure from its command, shortened by options given after it.
#[test]
fn every_figure_has_a_command() {
    let folder = Folder::new("figures");
    for ((name, less, parts), (figure, _)) in SHORTER.into_iter().zip(FIGURES) {
        assert_eq!(name, figure);
        let outcome = run_in(&folder, name, &[&["--figure", name], less].concat());
        let outcome = outcome.unwrap_or_else(|failure| panic!("{name}: {failure}"));
        assert!(outcome.complete, "{name}");
        let svg = folder.text(&format!("{name}.svg"));
        for part in parts.iter().chain(&["α = 1", "ζ = 0.032", "W = 1"]) {
            assert!(svg.contains(part), "{part} in {name}");
        }
        assert!(!svg.contains("NaN") && !svg.contains("inf"), "{name}");
        let table = rows(&folder.text(&format!("{name}.csv")));
        let (_, numbers) = array(&folder.read(&format!("{name}.npy")));
        assert_eq!(table.concat(), numbers, "{name}");
        assert!(!table.is_empty());
        let help = Options::command().render_help().to_string();
        assert!(help.contains(&format!("--figure {name}")), "{help}");
    }
}

#[test]
fn bad_usage_is_refused_by_the_parser() {
    for arguments in [
        &[][..],
        &["--basin", "--phase"],
        &["--sweep", "zeta"],
        &["--figure", "12"],
        &["--basin", "--threads", "0"],
        &["--basin", "--grid", "-3"],
        &["--basin", "--x-range", "1"],
        &["--history", "--every", "0"],
        &["stray"],
    ] {
        let error = read(arguments);
        assert_eq!(error.expect_err("a refusal").exit_code(), 2);
    }
}

#[test]
fn bad_input_gives_one_message() {
    let folder = Folder::new("bad");
    let nowhere = folder.file("missing/file");
    for (arguments, message) in [
        (&["--basin", "--zeta", "-1"][..], "zeta"),
        (&["--basin", "--alpha", "NaN"], "alpha"),
        (&["--history", "--omega", "0"], "omega"),
        (&["--history", "--tolerance", "1"], "tolerance"),
        (&["--history", "--start", "1", "2", "3"], "--start needs 2"),
        (&["--history", "--start", "1", "NaN"], "finite"),
        (&["--basin", "--x-range", "1", "1"], "empty"),
        (&["--basin", "--grid", "0"], "cell"),
        (&["--basin", "--longest", "0"], "longest"),
        (&["--basin", "--escape", "0"], "escape"),
        (
            &["--sweep", "omega", "--from", "0", "--to", "1"],
            "outside its range",
        ),
        (&["--sweep", "drive", "--from", "2", "--to", "1"], "below"),
        (&["--sweep", "drive", "--values", "1"], "two values"),
        (
            &["--basin", "--checkpoint", &nowhere],
            "cannot use the checkpoint",
        ),
        (&["--history", "--model", &nowhere], "cannot read"),
    ] {
        let failure = run_in(&folder, "bad", arguments).expect_err("a refusal");
        let text = failure.to_string();
        assert!(
            text.contains(message) && text.lines().count() == 1,
            "{arguments:?}: {text}"
        );
    }
    let failure = run(
        &options(&["--basin", "--out", &nowhere]),
        &Cancel::new(),
        &mut Progress::hidden(),
    );
    assert!(
        failure
            .expect_err("a refusal")
            .to_string()
            .contains("cannot write")
    );
}

/// What a task does not look at is not taken silently.
#[test]
fn options_that_would_do_nothing_are_refused() {
    for (arguments, message) in [
        (
            &["--basin", "--batches", "7"][..],
            "--batches belongs to --lyapunov and would do nothing here",
        ),
        (
            &["--history", "--x-range", "0", "1"],
            "--x-range belongs to --basin or --phase",
        ),
        (&["--basin", "--up"], "--up belongs to --sweep"),
        (
            &["--sweep", "omega", "--omega", "2"],
            "--sweep omega takes the place of --omega",
        ),
        (
            &["--lyapunov", "--drive", "1", "--drives", "1.2", "1.3"],
            "--drives takes the place of --drive: give all amplitudes by it",
        ),
        (
            &[
                "--phase", "--starts", "0", "--model", "some.txt", "--set", "drive=1", "--drives",
                "1.2",
            ],
            "--drives takes the place of --set drive",
        ),
        (
            &["--basin", "--longest", "-1"],
            "must be a whole number, zero or more",
        ),
        (
            &["--basin", "--model", "some.txt", "--x-range", "-2", "2"],
            "--model needs --x-range and --v-range",
        ),
    ] {
        let error = read(arguments).expect_err("a refusal");
        let text = error.to_string();
        assert!(text.contains(message), "{text}");
        assert_eq!(error.exit_code(), 2);
    }
}
