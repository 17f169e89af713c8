//! The program `attractors`: what it accepts, what it writes, and what it says.

use std::path::{Path, PathBuf};
use std::sync::atomic::AtomicBool;

use clap::{CommandFactory, Parser};
use hertzian::{Shooting, Verdict};
use hertzian_examples::attractors::figures::{FIGURES, expanded};
use hertzian_examples::attractors::options::Options;
use hertzian_examples::attractors::run::{Failure, Outcome, run};
use hertzian_examples::response::models::model;
use hertzian_examples::response::progress::Progress;

/// A folder of its own, removed with everything in it.
struct Folder(PathBuf);

impl Folder {
    fn new(name: &str) -> Self {
        let path = Path::new(env!("CARGO_TARGET_TMPDIR")).join(format!("attractors-{name}"));
        let _ = std::fs::remove_dir_all(&path);
        std::fs::create_dir_all(&path).expect("a folder");
        Self(path)
    }

    fn file(&self, name: &str) -> String {
        self.0.join(name).display().to_string()
    }

    fn read(&self, name: &str) -> Vec<u8> {
        std::fs::read(self.0.join(name)).expect(name)
    }

    fn text(&self, name: &str) -> String {
        String::from_utf8(self.read(name)).expect("text")
    }

    /// The bytes of all three results.
    fn results(&self, prefix: &str) -> [Vec<u8>; 3] {
        ["csv", "npy", "svg"].map(|extension| self.read(&format!("{prefix}.{extension}")))
    }
}

impl Drop for Folder {
    fn drop(&mut self) {
        let _ = std::fs::remove_dir_all(&self.0);
    }
}

fn options(arguments: &[&str]) -> Options {
    let arguments = std::iter::once("attractors").chain(arguments.iter().copied());
    Options::try_parse_from(expanded(arguments.map(Into::into)))
        .expect("arguments that can be parsed")
}

fn run_in(folder: &Folder, prefix: &str, arguments: &[&str]) -> Result<Outcome, Failure> {
    let out = folder.file(prefix);
    let arguments = [arguments, &["--out", &out]].concat();
    let never = AtomicBool::new(false);
    run(&options(&arguments), &never, &mut Progress::new(false))
}

/// Rows of a table of numbers, without its head.
fn rows(text: &str) -> Vec<Vec<f64>> {
    let lines = text.lines().skip(1);
    lines
        .map(|line| {
            line.split(',')
                .map(|x| x.parse().expect("a number"))
                .collect()
        })
        .collect()
}

/// Numbers of an array in NPY format, and its shape as text.
fn array(bytes: &[u8]) -> (String, Vec<f64>) {
    assert_eq!(&bytes[..8], b"\x93NUMPY\x01\x00");
    let length = usize::from(u16::from_le_bytes([bytes[8], bytes[9]])) + 10;
    assert_eq!(length % 64, 0);
    let header = String::from_utf8(bytes[10..length].to_vec()).expect("a header");
    let data = &bytes[length..];
    let numbers = if header.contains("'<f8'") {
        let numbers = data.chunks_exact(8);
        numbers
            .map(|x| f64::from_le_bytes(x.try_into().expect("eight")))
            .collect()
    } else {
        assert!(header.contains("'<i2'"), "{header}");
        let numbers = data.chunks_exact(2);
        numbers
            .map(|x| f64::from(i16::from_le_bytes([x[0], x[1]])))
            .collect()
    };
    (header, numbers)
}

/// Each figure from its command, shortened by options given after it.
#[test]
fn every_figure_has_a_command() {
    let folder = Folder::new("figures");
    let shorter: [(&str, &[&str], &[&str]); 5] = [
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
    for ((name, less, parts), (figure, _)) in shorter.into_iter().zip(FIGURES) {
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

/// States of periods 1, 2 and 3 computed independently from the closed-form flow, in 80-bit arithmetic confirmed with 60 digits.
#[test]
fn a_basin_lists_the_orbits_and_labels_the_cells() {
    let folder = Folder::new("basin");
    let outcome = run_in(
        &folder,
        "basin",
        &["--basin", "--alpha", "1", "--drive", "1", "--grid", "40"],
    );
    let summary = outcome.expect("basins").summary;
    assert!(
        summary.contains("period 3a") && summary.contains("period 28"),
        "{summary}"
    );
    let text = folder.text("basin.csv");
    let mut lines = text.lines();
    let names = "attractor,period,cells,point,x,dx,multiplier_1_re,multiplier_1_im,multiplier_2_re,multiplier_2_im";
    assert_eq!(lines.next(), Some(names));
    let table = rows(&text);
    let exact = [
        [-1.999_776_122_757_642_7, 0.178_235_874_603_685_45],
        [-8.051_070_357_195_234, -2.756_595_228_529_427],
        [-31.334_287_816_436_888, 0.605_360_285_158_400_4],
    ];
    for (attractor, state) in exact.iter().enumerate() {
        let row = table.iter().find(|row| row[0] == attractor as f64);
        let row = row.expect("an orbit");
        assert_eq!(row[1], attractor as f64 + 1.0);
        assert!(
            (row[4] - state[0]).hypot(row[5] - state[1]) < 1e-11,
            "{row:?}"
        );
    }
    let (header, labels) = array(&folder.read("basin.npy"));
    assert!(header.contains("'shape': (40, 40)"), "{header}");
    let first = labels.iter().filter(|&&label| label == 0.0).count();
    assert_eq!(table[0][2], first as f64);
    let svg = folder.text("basin.svg");
    for part in [
        "initial x",
        "initial rate of x",
        "points of period 1",
        "data:image/png",
    ] {
        assert!(svg.contains(part), "{part}");
    }
}

/// Ended by Ctrl-C and started again, with another number of threads: the same bytes as without.
#[test]
fn a_basin_that_was_interrupted_goes_on_to_the_same_bytes() {
    let folder = Folder::new("resumed");
    let (checkpoint, out) = (folder.file("checkpoint"), folder.file("part"));
    let task = ["--basin", "--alpha", "1", "--drive", "1", "--grid", "40"];
    run_in(&folder, "whole", &task).expect("basins");
    let kept = ["--checkpoint", &checkpoint, "--out", &out];
    let part = options(&[&task[..], &kept, &["--threads", "1"]].concat());
    let now = AtomicBool::new(true);
    let outcome = run(&part, &now, &mut Progress::new(false)).expect("part of it");
    assert!(!outcome.complete);
    assert!(
        outcome.summary.contains("not looked at"),
        "{}",
        outcome.summary
    );
    let outcome = run_in(
        &folder,
        "part",
        &[&task[..], &kept[..2], &["--threads", "2"]].concat(),
    );
    assert!(outcome.expect("the rest").complete);
    assert_eq!(folder.results("part"), folder.results("whole"));
    // The checkpoint belongs to this request, and to this law.
    for change in [["--grid", "41"], ["--alpha", "1.5"]] {
        let other = [&task[..], &change, &kept[..2]].concat();
        let failure = run_in(&folder, "other", &other).expect_err("a refusal");
        assert!(
            failure.to_string().contains("another computation"),
            "{failure}"
        );
    }
}

/// What the run that is killed computes, and where it keeps it.
const TO_BE_KILLED: [&str; 7] = ["--basin", "--alpha", "1", "--drive", "1", "--grid", "128"];
const CHECKPOINT: &str = "HERTZIAN_TEST_CHECKPOINT";

/// The other process of the next test; alone it does nothing.
#[test]
fn a_run_that_is_killed() {
    if let Ok(checkpoint) = std::env::var(CHECKPOINT) {
        let out = format!("{checkpoint}-unwanted");
        let kept = ["--checkpoint", &checkpoint, "--out", &out];
        let task = [&TO_BE_KILLED[..], &kept].concat();
        let never = AtomicBool::new(false);
        run(&options(&task), &never, &mut Progress::new(false)).expect("basins");
    }
}

/// Killed at half of its work, without a word, and started again: the same bytes as without.
#[test]
fn a_basin_that_was_killed_goes_on_to_the_same_bytes() {
    let folder = Folder::new("killed");
    let file = |name: &str| folder.0.join(name);
    let size = |name: &str| std::fs::metadata(file(name)).map_or(0, |data| data.len());
    let logs = ["whole.log", "part.log"].map(|name| folder.file(name));
    let whole = [&TO_BE_KILLED[..], &["--checkpoint", &logs[0]]].concat();
    run_in(&folder, "whole", &whole).expect("basins");
    let test = std::env::current_exe().expect("this program");
    let mut child = std::process::Command::new(test)
        .args(["--exact", "a_run_that_is_killed"])
        .env(CHECKPOINT, file("part.log"))
        .stdout(std::process::Stdio::null())
        .spawn()
        .expect("another process");
    while size("part.log") < size("whole.log") / 2 {
        assert!(
            child.try_wait().expect("a child").is_none(),
            "it ended by itself"
        );
        std::thread::sleep(std::time::Duration::from_millis(1));
    }
    child.kill().expect("it is killed");
    child.wait().expect("it ends");
    let kept = size("part.log");
    assert!(kept < size("whole.log"), "it was killed too late");
    let part = [&TO_BE_KILLED[..], &["--checkpoint", &logs[1]]].concat();
    run_in(&folder, "part", &part).expect("the rest");
    assert_eq!(folder.results("part"), folder.results("whole"));
    assert_eq!(size("part.log"), size("whole.log"));
}

/// Without damping nothing settles: a table of classes only.
#[test]
fn a_basin_without_periodic_attractors_is_written() {
    let folder = Folder::new("none");
    let task = [
        "--basin",
        "--alpha",
        "1",
        "--zeta",
        "0",
        "--grid",
        "4",
        "--patience",
        "50",
    ];
    run_in(&folder, "none", &task).expect("basins");
    let text = folder.text("none.csv");
    let columns = |line: &str| line.split(',').count();
    let mut lines = text.lines().map(columns);
    let head = lines.next();
    assert!(lines.all(|count| Some(count) == head), "{text}");
}

#[test]
fn a_sweep_that_was_interrupted_goes_on_to_the_same_bytes() {
    let folder = Folder::new("sweep");
    let checkpoint = folder.file("checkpoint");
    let task = [
        "--sweep",
        "omega",
        "--alpha",
        "1",
        "--drive",
        "0.5",
        "--from",
        "0.9",
        "--to",
        "1.1",
        "--values",
        "5",
        "--up",
        "--down",
        "--transient",
        "50",
        "--periods",
        "5",
    ];
    run_in(&folder, "whole", &task).expect("rows");
    let kept = [&task[..], &["--checkpoint", &checkpoint]].concat();
    let out = folder.file("part");
    let now = AtomicBool::new(true);
    let part = options(&[&kept[..], &["--out", &out]].concat());
    for _ in 0..3 {
        let outcome = run(&part, &now, &mut Progress::new(false)).expect("a row more");
        assert!(!outcome.complete);
    }
    assert_eq!(rows(&folder.text("part.csv")).len(), 3 * 5);
    assert!(run_in(&folder, "part", &kept).expect("the rest").complete);
    assert_eq!(folder.results("part"), folder.results("whole"));
}

/// Period one at A = 1: the exponents are half the logarithm of the determinant of its multipliers, which are exact values.
#[test]
fn exponents_of_a_periodic_orbit_are_those_of_its_multipliers() {
    let folder = Folder::new("lyapunov");
    let task = [
        "--lyapunov",
        "--alpha",
        "1",
        "--drives",
        "1",
        "0.5",
        "--transient",
        "1000",
        "--periods",
        "2000",
        "--batches",
        "4",
    ];
    let outcome = run_in(&folder, "lyapunov", &task).expect("exponents");
    assert!(
        outcome
            .summary
            .contains("the divergence over the same motion")
    );
    let table = rows(&folder.text("lyapunov.csv"));
    assert_eq!(table.len(), 2);
    let [re, im] = [-0.655_596_449_627_929_2_f64, 0.615_582_920_279_132_8];
    let expected = re.hypot(im).ln();
    let row = &table[0];
    assert!(
        (row[2] - expected).abs() < 1e-3 && (row[4] - expected).abs() < 1e-3,
        "{row:?}"
    );
    // The sum of both, by determinants and by the divergence.
    assert!((row[6] - 2.0 * expected).abs() < 1e-11, "{row:?}");
    assert!((row[7] - row[6]).abs() < 1e-11, "{row:?}");
}

/// A contact of exponent 3/2, whose motions are integrated numerically, at frequencies between its folds: two attractors of period
/// one. Exact peaks to peaks of the upper and the lower one, from event-located DOP853 in 80-bit arithmetic, independent of this
/// project; to nine decimals, as the frequencies.
#[test]
fn other_exponents_are_integrated() {
    let folder = Folder::new("hertz");
    for (omega, exact, upper) in [
        ("1.093995426", 2.589_037_875, true),
        ("1.11032312", 0.773_510_966, false),
    ] {
        let task = [
            "--phase",
            "--drive",
            "0.1",
            "--omega",
            omega,
            "--x-range",
            "-1",
            "3",
            "--v-range",
            "-2",
            "2",
            "--starts",
            "4",
        ];
        run_in(&folder, "hertz", &task).expect("a portrait");
        let table = rows(&folder.text("hertz.csv"));
        let model = model(&options(&task).model, ("omega", 1.0)).expect("a model");
        let omega = omega.parse().expect("a number");
        let mut found: Vec<f64> = Vec::new();
        for row in &table {
            assert_eq!(row[2], 1.0, "{row:?}");
            let cycle = Shooting::of(&*model)
                .near(&row[4..])
                .orbit(omega)
                .expect("an orbit");
            assert_eq!(cycle.stability.verdict, Verdict::Stable);
            for (x, y) in row[4..].iter().zip(cycle.state()) {
                assert!((x - y).abs() < 1e-8, "{row:?} {:?}", cycle.state());
            }
            found.push(cycle.peak_to_peak());
        }
        found.sort_by(f64::total_cmp);
        assert_eq!(found.len(), 2, "{found:?}");
        let error = found[usize::from(upper)] - exact;
        assert!(error.abs() < 2e-8, "{found:?} {error:e}");
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
        let arguments = std::iter::once("attractors").chain(arguments.iter().copied());
        let error = Options::try_parse_from(expanded(arguments.map(Into::into)));
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
        (&["--basin", "--model", &nowhere], "cannot read"),
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
        &AtomicBool::new(false),
        &mut Progress::new(false),
    );
    assert!(
        failure
            .expect_err("a refusal")
            .to_string()
            .contains("cannot write")
    );
}
