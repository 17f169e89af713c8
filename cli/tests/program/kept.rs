//! Branches that are kept while they are followed, resumed when the program was killed, shown, and begun near.

use std::process::{Command, Output, Stdio};
use std::time::{Duration, Instant};

use hertzian::{Branch, Stop};

use crate::folder::Folder;

fn hertzian(arguments: &[&str]) -> Output {
    let mut program = Command::new(env!("CARGO_BIN_EXE_hertzian"));
    program.args(arguments).output().expect("the program")
}

fn printed(arguments: &[&str]) -> String {
    let Output {
        status,
        stdout,
        stderr,
    } = hertzian(arguments);
    let said = String::from_utf8_lossy(&stderr);
    assert_eq!(status.code(), Some(0), "{arguments:?}: {said}");
    String::from_utf8(stdout).expect("text")
}

fn refused(arguments: &[&str]) -> String {
    let Output { status, stderr, .. } = hertzian(arguments);
    let said = String::from_utf8(stderr).expect("text");
    assert_eq!(status.code(), Some(2), "{arguments:?}: {said}");
    said
}

/// A curve that takes long enough to be killed on the way.
const SLOW: [&str; 3] = ["response", "--harmonics", "150"];

/// Kills it when there are a few lines. Says if it did: where a line takes long to write, as on a busy machine, there are fewer until it ends.
fn was_killed(kept: &str, svg: &str) -> bool {
    let mut program = Command::new(env!("CARGO_BIN_EXE_hertzian"));
    program.args(SLOW).args(["--keep", kept, "--svg", svg]);
    program.stdout(Stdio::null()).stderr(Stdio::null());
    let _ = std::fs::remove_file(kept);
    let mut running = program.spawn().expect("the program");
    let begun = Instant::now();
    let lines = || std::fs::read(kept).map_or(0, |text| text.split(|b| *b == b'\n').count());
    while lines() < 5 {
        if let Some(status) = running.try_wait().expect("a state") {
            assert!(status.success(), "{status}");
            return false;
        }
        let waited = begun.elapsed();
        assert!(waited < Duration::from_secs(120), "nothing is kept");
        std::thread::sleep(Duration::from_millis(2));
    }
    running.kill().expect("killed");
    running.wait().expect("it has ended");
    true
}

#[test]
fn a_branch_goes_on_after_the_program_was_killed() {
    let folder = Folder::new("killed");
    let [kept, svg, whole, resumed] =
        ["kept.json", "a.svg", "whole.json", "resumed.json"].map(|name| folder.file(name));
    assert!((0..20).any(|_| was_killed(&kept, &svg)), "it is too fast");
    if Branch::read(&kept).expect("a branch").stopped == Stop::ReachedEnd {
        // It was faster. Killed it would have left a part of what it wrote, and of a line.
        let text = std::fs::read(&kept).expect("what it kept");
        std::fs::write(&kept, &text[..text.len() / 2]).expect("half of it");
    }
    let part = Branch::read(&kept).expect("a branch");
    assert_eq!(part.stopped, Stop::Interrupted);

    let said = printed(&["show", &kept]);
    assert!(said.contains("interrupted"), "{said}");
    let goes_on = ["response", "--resume", &kept];
    printed(&[&goes_on[..], &["--svg", &svg, "--json", &resumed]].concat());
    let alone = ["--one-branch", "--svg", &svg, "--json", &whole];
    printed(&[&SLOW[..], &alone].concat());
    let [whole, resumed, kept] =
        [whole, resumed, kept].map(|path| Branch::read(path).expect("a branch"));
    assert!(part.points.len() < whole.points.len());
    assert_eq!(resumed.points, whole.points);
    assert_eq!(resumed.events, whole.events);
    assert_eq!(kept.points, whole.points);
    assert_eq!(kept.stopped, Stop::ReachedEnd);
}

#[test]
fn a_file_is_shown_without_computing() {
    let folder = Folder::new("shown");
    let [json, svg, csv] = ["a.json", "b.svg", "c.csv"].map(|name| folder.file(name));
    let one = [
        "response",
        "--alpha",
        "1",
        "--harmonics",
        "5",
        "--one-branch",
    ];
    printed(&[&one[..], &["--svg", &svg, "--json", &json]].concat());
    let said = printed(&[
        "show", &json, "--at", "0.9", "3", "--svg", &svg, "--csv", &csv,
    ]);
    let branch = Branch::read(&json).expect("a branch");
    for event in &branch.events {
        assert!(said.contains(&event.to_string()), "{said}");
    }
    let count = branch.points.len();
    assert!(
        said.contains(&format!("{count} orbits of period 1")),
        "{said}"
    );
    // As the folds say: three orbits there, of which the middle one is not stable.
    let folds: Vec<f64> = branch.folds().map(|fold| fold.point.value).collect();
    assert!(
        folds.iter().any(|at| *at < 0.9) && folds.iter().any(|at| *at > 0.9),
        "{folds:?}"
    );
    assert!(
        said.contains("at omega = 0.9: 3 orbits, 2 of them stable"),
        "{said}"
    );
    assert!(said.contains("at omega = 3: 0 orbits"), "{said}");
    assert_eq!(
        std::fs::read_to_string(&csv).expect("a table"),
        branch.to_csv()
    );
    assert!(
        std::fs::read_to_string(&svg)
            .expect("a picture")
            .contains("<svg")
    );
    assert!(refused(&["show", &json, "--branch", "2"]).contains("there is one branch in"));
    std::fs::write(&csv, "{\"version\": 1, \"branches\": []}").expect("written");
    assert!(refused(&["show", &csv]).contains("is of version 1, and files of version 2 are read"));
}

#[test]
fn a_branch_begins_near_what_is_known() {
    let folder = Folder::new("near");
    let [json, near, svg] = ["a.json", "b.json", "c.svg"].map(|name| folder.file(name));
    let one = [
        "response",
        "--alpha",
        "1",
        "--harmonics",
        "5",
        "--one-branch",
        "--svg",
        &svg,
    ];
    printed(&[&one[..], &["--json", &json]].concat());
    let branch = Branch::read(&json).expect("a branch");
    // The large orbit of three.
    let from = ["--from", "0.9", "--to", "0.95", "--json", &near];
    printed(&[&one[..], &from, &["--near", &json]].concat());
    let begun = Branch::read(&near).expect("a branch");
    let far = |value: f64| (value - 0.9).abs();
    let nearest = branch
        .points
        .iter()
        .min_by(|a, b| far(a.value).total_cmp(&far(b.value)));
    let nearest = nearest.expect("an orbit").peak_to_peak();
    let size = begun.points[0].peak_to_peak();
    assert!((size - nearest).abs() < 0.05 * nearest, "{size} {nearest}");
    printed(&[&one[..], &from, &["--at-rest", "x=1"]].concat());
    assert_eq!(Branch::read(&near).expect("a branch").points[0].value, 0.9);
    let said = refused(&[&one[..], &["--at-rest", "y=1"]].concat());
    assert!(said.contains("the coordinates are x"), "{said}");
    let said = refused(&[&one[..5], &["--resume", &json]].concat());
    assert!(
        said.contains("--resume takes range and options from the file"),
        "{said}"
    );
}

#[test]
fn a_branch_goes_on_for_as_many_points_as_asked() {
    let folder = Folder::new("counted");
    let [kept, svg] = ["kept.json", "a.svg"].map(|name| folder.file(name));
    let one = [
        "response",
        "--alpha",
        "1",
        "--harmonics",
        "5",
        "--one-branch",
    ];
    let few = ["--max-points", "10", "--keep", &kept, "--svg", &svg];
    let Output { status, .. } = hertzian(&[&one[..], &few].concat());
    assert_eq!(status.code(), Some(3), "it ends before the range does");
    let count = || Branch::read(&kept).expect("a branch").points.len();
    assert_eq!(count(), 10);
    let on = ["response", "--alpha", "1", "--resume", &kept, "--svg", &svg];
    let Output { status, .. } = hertzian(&[&on[..], &["--max-points", "15"]].concat());
    assert_eq!((status.code(), count()), (Some(3), 15));
    let said = refused(&[&on[..], &["--max-points", "15"]].concat());
    assert!(
        said.contains("must be more than the points that the branch has"),
        "{said}"
    );
    assert_eq!(count(), 15);
    printed(&[&on[..], &["--max-points", "1000"]].concat());
    let said = refused(&on);
    assert!(
        said.contains("has reached the end of its range, and nothing of it is left"),
        "{said}"
    );
}

/// What is said of a file is of the output that leads, and charts are those that one asks for.
#[test]
fn a_file_is_shown_by_its_outputs() {
    let folder = Folder::new("outputs");
    let [model, json, svg, csv] =
        ["m.txt", "a.json", "a.svg", "a.csv"].map(|name| folder.file(name));
    let text = "Pair(base: mm, head: mm) {
        param m: t = 1e-3 > 0;
        param k: N/mm = 40;
        param c: N*s/mm = 0.02;
        param drive: N = 1;
        law stop(gap) { gap > 0 => 100{N/mm}*gap, else => 0 }
        m*ddot(base) + c*dot(base) + 2*k*base - k*head = drive*cos(omega*t);
        m*ddot(head) + c*dot(head) + k*(head - base) + k*head + k/10*stop(head - base)/k = 0;
        output stretch: um = head - base;
    }";
    let text = text
        .replace("100{N/mm}*gap", "gap")
        .replace("k/10*stop(head - base)/k", "k/10*stop(head)");
    std::fs::write(&model, text).expect("written");
    let run = [
        "response", "--model", &model, "--from", "150", "--to", "200",
    ];
    let files = ["--one-branch", "--svg", &svg, "--json", &json];
    printed(&[&run[..], &files].concat());
    let said = printed(&["show", &json, "--at", "170"]);
    assert!(said.contains("largest peak-to-peak of stretch "), "{said}");
    assert!(
        said.contains(" um at omega = ") && said.contains(" rad/s"),
        "{said}"
    );
    assert!(said.contains("about peak-to-peak of stretch "), "{said}");
    assert!(said.contains("k = 40 N/mm"), "{said}");
    printed(&[
        "show",
        &json,
        "--svg",
        &svg,
        "--plot",
        "stretch:rms,stop:max",
        "--axis",
        "hz",
    ]);
    let picture = std::fs::read_to_string(&svg).expect("a picture");
    for part in [
        "rms of stretch [um]",
        "largest of stop",
        "excitation frequency [Hz]",
    ] {
        assert!(picture.contains(part), "{part}");
    }
    assert!(
        refused(&["show", &json, "--plot", "stop:piece9"])
            .contains("stop has no piece 9: its law has 2")
    );
    let said = refused(&["show", &json, "--plot", "tip"]);
    assert!(
        said.contains("there are stretch, base, head, stop"),
        "{said}"
    );
    // A file with branches of two oscillators.
    let other = folder.file("b.json");
    let one = [
        "response",
        "--alpha",
        "1",
        "--harmonics",
        "5",
        "--one-branch",
        "--svg",
        &svg,
    ];
    printed(&[&one[..], &["--json", &other]].concat());
    let [a, b] = [&json, &other].map(|path| {
        let text = std::fs::read_to_string(path).expect("a file");
        let all: serde_json::Value = serde_json::from_str(&text).expect("JSON");
        all["branches"][0].clone()
    });
    let both = serde_json::json!({"version": 2, "branches": [a, b]});
    std::fs::write(&other, both.to_string()).expect("written");
    let said = printed(&["show", &other]);
    assert!(
        said.contains("Pair: ") && said.contains("branch 2: "),
        "{said}"
    );
    let said = refused(&["show", &other, "--csv", &csv]);
    assert!(
        said.contains("branch 1 is of Pair over omega, branch 2 of "),
        "{said}"
    );
    printed(&["show", &other, "--csv", &csv, "--branch", "2"]);
}

/// What the file varies need not be what is asked for: the nearest orbit is that with the nearest values of all, and others are said.
#[test]
fn near_an_orbit_with_other_values_says_so() {
    let folder = Folder::new("near-other");
    let [json, near, svg] = ["a.json", "b.json", "c.svg"].map(|name| folder.file(name));
    let one = [
        "response",
        "--alpha",
        "1",
        "--harmonics",
        "5",
        "--one-branch",
        "--svg",
        &svg,
    ];
    let drives = [
        "--sweep", "drive", "--omega", "1.2", "--from", "0.05", "--to", "0.3",
    ];
    printed(&[&one[..], &drives, &["--json", &json]].concat());
    let from = [
        "--from", "1.2", "--to", "1.25", "--json", &near, "--near", &json,
    ];
    let Output { status, stderr, .. } = hertzian(&[&one[..], &from, &["--drive", "0.1"]].concat());
    let said = String::from_utf8(stderr).expect("text");
    assert_eq!(status.code(), Some(0), "{said}");
    let file = Branch::read(&json).expect("a branch");
    let far = |value: f64| (value - 0.1).abs();
    let nearest = file
        .points
        .iter()
        .min_by(|a, b| far(a.value).total_cmp(&far(b.value)));
    let value = nearest.expect("an orbit").value;
    assert!(
        said.contains(&format!("drive = {value}, and 0.1 is asked for")),
        "{said}"
    );
}
