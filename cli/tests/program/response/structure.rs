//! `--structure`: a structure from files, as the book has it, and what is kept of its reduction.

use std::process::Command;

use serde_json::Value;

use super::{all, run_with};
use crate::folder::Folder;

/// A plate of 96 coordinates by the script of the book. Returns the path of its description.
fn plate(folder: &Folder) -> String {
    let script = concat!(
        env!("CARGO_MANIFEST_DIR"),
        "/../examples/structures/plate.py"
    );
    let status = Command::new("python3")
        .args([script, "12", "3"])
        .arg(&folder.0)
        .status();
    assert!(status.expect("python3 is there").success());
    folder.file("plate.toml")
}

const RANGE: [&str; 4] = ["--from", "1250", "--to", "1300"];

/// What the program says of a structure, which ends.
fn refused(arguments: &[&str]) -> String {
    let failure = run_with(arguments).expect_err("a refusal");
    assert_eq!(failure.exit_code(), 2);
    let text = failure.to_string();
    assert!(!text.contains('\n'), "{text}");
    text
}

#[test]
fn a_plate_gives_a_picture_a_reduction_and_its_error() {
    let folder = Folder::new("plate");
    let (plate, svg, json) = (plate(&folder), folder.file("a.svg"), folder.file("a.json"));
    let files = ["--structure", &plate, "--svg", &svg, "--json", &json];
    let plot = ["--plot", "tip,tip:rms"];
    let outcome = run_with(&[&files[..], &RANGE, &plot].concat()).expect("a branch");
    assert!(outcome.complete, "{}", outcome.summary);
    for line in [
        "reduction  ",
        " static vectors of 96 coordinates",
        "error      of tip by the reduction",
        "error      of tip:rms by the reduction: at most ",
        "stability  of the whole structure: decided at ",
    ] {
        assert!(outcome.summary.contains(line), "{}", outcome.summary);
    }
    assert!(std::fs::read_to_string(&svg).unwrap().contains("tip"));
    let all = all(&json);
    let reduction = &all["reduction"];
    assert_eq!(reduction["coordinates"], 96);
    let count = |name: &str| reduction[name].as_u64().expect(name);
    let frequencies = reduction["frequencies"].as_array().expect("frequencies");
    assert_eq!(
        frequencies.len() as u64,
        count("modes") + count("static_vectors")
    );
    // As `scipy.linalg.eigh` has them of the same files.
    for (found, known) in frequencies.iter().zip([1_181.524_037_48, 7_160.515_039_15]) {
        let found = found.as_f64().expect("a number");
        assert!((found / known - 1.0).abs() < 1e-8, "{found} {known}");
    }
    let error = reduction["outputs"][0][1].as_f64().expect("a number");
    assert_eq!(reduction["outputs"][0][0], "tip");
    // That the sixteenfold of 1300 is covered to a millionth does not cover all of the force of a stop.
    assert!((1e-8..1e-4).contains(&error), "{error:e}");
    let verdicts = &reduction["verdicts"];
    assert!(verdicts["looked_at"].as_u64() > Some(0));
    assert_eq!(verdicts["decided"], verdicts["looked_at"]);
    let branch = &all["branches"][0];
    assert_eq!(branch["stopped"], "reached-end");
    let last = branch["points"].as_array().and_then(|all| all.last());
    let contact = &last.expect("an orbit")["observed"]["contacts"][0];
    assert_eq!(contact["count"], 1);
}

/// Parts of a curve between places where it was not followed, as numbers of its orbits.
fn parts(curve: &Value) -> Vec<std::ops::Range<usize>> {
    let leaps = curve["leaps"].as_array().expect("leaps").iter();
    let after = leaps.map(|leap| leap["after"].as_u64().expect("a count") as usize);
    let all = curve["points"].as_array().expect("orbits").len();
    let ends: Vec<usize> = std::iter::once(0).chain(after).chain([all]).collect();
    ends.windows(2).map(|pair| pair[0]..pair[1]).collect()
}

/// The frequency of an orbit, and how far its first mode moves.
fn place(point: &Value) -> [f64; 2] {
    let number = |of: &Value| of.as_f64().expect("a number");
    let motion = &point["observed"]["motions"][0];
    let size = number(&motion["maximum"]) - number(&motion["minimum"]);
    [number(&point["orbit"]["omega"]), size]
}

/// How far frequencies of phase resonance below a limit are from those of free oscillation of the same size, as a part of them: where two orbits
/// of one part have it between them.
fn apart(free: &Value, resonance: &Value, below: f64) -> Vec<f64> {
    let orbits = free["points"].as_array().expect("orbits");
    let of_part = |part: std::ops::Range<usize>| -> Vec<[f64; 2]> {
        orbits[part].iter().map(place).collect()
    };
    let parts: Vec<Vec<[f64; 2]>> = parts(free).into_iter().map(of_part).collect();
    let pairs = || parts.iter().flat_map(|part| part.windows(2));
    let all = resonance["points"].as_array().expect("orbits").iter();
    let low = all.map(place).filter(|[omega, _]| *omega < below);
    let nearest = low.filter_map(|[omega, size]| {
        let around = pairs().filter(|pair| (pair[0][1] - size) * (pair[1][1] - size) <= 0.0);
        let apart = around.map(|pair| {
            let part = (size - pair[0][1]) / (pair[1][1] - pair[0][1]);
            let free = pair[0][0] + part * (pair[1][0] - pair[0][0]);
            (omega / free - 1.0).abs()
        });
        apart.reduce(f64::min)
    });
    nearest.collect()
}

/// The resonance of the plate before its stop: free oscillation begins at the frequency of its first mode, and stiffens where the stop is met. Where
/// harmonics meet other modes it turns back and is taken up again, which is said; energies ascend on the way to each turn.
#[test]
fn a_plate_has_a_backbone() {
    let folder = Folder::new("plate-backbone");
    let (plate, svg, json) = (plate(&folder), folder.file("a.svg"), folder.file("a.json"));
    let files = ["--structure", &plate, "--svg", &svg, "--json", &json];
    let range = ["--from", "1100", "--to", "1700", "--backbone"];
    let outcome = run_with(&[&files[..], &range].concat()).expect("a branch");
    assert!(outcome.warnings.is_empty(), "{:?}", outcome.warnings);
    for line in [
        "error      of the frequency of free oscillation by the reduction: ",
        "error      of tip in phase resonance by the reduction: at most ",
        "backbone   free oscillation: ",
        "           not followed from omega = 1283.1",
        "backbone   phase resonance: ",
    ] {
        assert!(outcome.summary.contains(line), "{}", outcome.summary);
    }
    let drawn = std::fs::read_to_string(&svg).unwrap();
    assert!(drawn.contains("free oscillation") && drawn.contains("phase resonance"));
    let all = all(&json);
    let numbers = |of: &Value| -> Vec<f64> {
        let numbers = of.as_array().expect("numbers").iter();
        numbers.map(|x| x.as_f64().expect("a number")).collect()
    };
    let points = all["backbone"]["free"]["points"]
        .as_array()
        .expect("orbits");
    let omega = |point: &Value| point["orbit"]["omega"].as_f64().expect("a frequency");
    // As `scipy.linalg.eigh` has it of the same files.
    assert!((omega(&points[0]) / 1_181.524_037_48 - 1.0).abs() < 1e-8);
    assert!(omega(points.last().unwrap()) > 1.1 * omega(&points[0]));
    let energies = numbers(&all["backbone"]["energies"]);
    assert_eq!(energies.len(), points.len());
    let parts = parts(&all["backbone"]["free"]);
    assert!(parts.len() > 1);
    for part in parts {
        assert!(energies[part].is_sorted_by(|a, b| 0.0 < *a && a < b));
    }
    let errors = numbers(&all["reduction"]["backbone"]["frequencies"]);
    assert_eq!(errors.len(), points.len());
    assert!(errors.iter().all(|error| *error < 1e-5), "{errors:?}");
    // A tenth of the damping ratio.
    let apart = apart(
        &all["backbone"]["free"],
        &all["backbone"]["resonance"],
        1420.0,
    );
    assert!(apart.len() > 3, "{apart:?}");
    assert!(apart.iter().all(|apart| *apart < 1e-3), "{apart:?}");
}

#[test]
fn a_reduced_structure_is_kept_and_read_again() {
    let folder = Folder::new("kept");
    let (plate, kept) = (plate(&folder), folder.file("reduced.json"));
    let curve = |json: &str, options: &[&str]| -> Value {
        let svg = folder.file("a.svg");
        let files = ["--structure", &plate, "--svg", &svg, "--json", json];
        let keep = ["--reduced", &kept];
        run_with(&[&files[..], &keep, &RANGE, options].concat()).expect("a branch");
        let all = all(json);
        let mut points = all["branches"][0]["points"].clone();
        points.as_array_mut().expect("points").truncate(20);
        points
    };
    let first = curve(&folder.file("a.json"), &[]);
    let written = std::fs::read(&kept).expect("it is kept");
    let again = curve(&folder.file("b.json"), &[]);
    assert_eq!(first, again);
    assert_eq!(std::fs::read(&kept).unwrap(), written);
    let svg = folder.file("a.svg");
    let with = |options: &[&str]| {
        let files = ["--structure", &plate, "--svg", &svg, "--reduced", &kept];
        refused(&[&files[..], options].concat())
    };
    let modes = with(&[&RANGE[..], &["--modes", "3"]].concat());
    assert!(
        modes.ends_with(
            "reduced.json: it was made with all modes that its frequency asks for, and 3 modes are asked for: remove it"
        ),
        "{modes}"
    );
    let steps = with(&[&RANGE[..], &["--steps", "0"]].concat());
    assert!(steps.contains("and 0 steps of static vectors"), "{steps}");
    let beyond = with(&["--from", "800", "--to", "2000"]);
    assert!(beyond.contains("up to 1300, and 2000 are"), "{beyond}");
    let text = std::fs::read_to_string(&plate).unwrap();
    std::fs::write(&plate, text.replace("ratio = 0.01", "ratio = 0.02")).unwrap();
    let other = with(&RANGE);
    assert!(other.contains("of another structure"), "{other}");
}

/// Two arms on a mass with a stop: how far they are apart is nothing but rounding, by the contact equation and by shooting.
#[test]
fn an_output_that_vanishes_ends() {
    let folder = Folder::new("vanishes");
    let header = "%%MatrixMarket matrix coordinate real symmetric\n";
    for (name, entries) in [
        ("mass.mtx", "3 3 3\n1 1 1\n2 2 1\n3 3 1\n"),
        (
            "stiffness.mtx",
            "3 3 5\n1 1 2\n2 1 -1\n3 1 -1\n2 2 3\n3 3 3\n",
        ),
    ] {
        std::fs::write(folder.file(name), format!("{header}{entries}")).unwrap();
    }
    for (law, range) in [("gap^1.5", ["0.5", "1.2"]), ("gap", ["0.5", "0.7"])] {
        let description = format!(
            r#"[matrices]
mass = "mass.mtx"
stiffness = "stiffness.mtx"
[damping]
ratio = 0.02
[[load]]
direction = {{ coordinates = [0] }}
amplitude = 0.1
[[contact]]
name = "stop"
law = "Stop(gap, k) {{ gap > 0 => k*{law}, else => 0 }}"
arguments = {{ k = 10 }}
direction = {{ coordinates = [0] }}
offset = 0.2
[[output]]
name = "apart"
direction = {{ coordinates = [1, 2], weights = [1, -1] }}
"#
        );
        let (file, svg) = (folder.file("arms.toml"), folder.file("a.svg"));
        std::fs::write(&file, description).unwrap();
        let words = ["--structure", &file, "--svg", &svg];
        let range = ["--from", range[0], "--to", range[1]];
        let outcome = run_with(&[&words[..], &range].concat()).expect("a branch");
        assert!(outcome.complete, "{law}: {}", outcome.summary);
    }
}
