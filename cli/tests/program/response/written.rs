//! Results: files, summaries and pictures.

use hertzian::Cancel;
use std::path::Path;

use hertzian_cli::response::progress::Progress;
use hertzian_cli::response::run::run;
use serde_json::Value;

use super::{all, check_csv, check_point, coarse, numbers, options, points, run_with};
use crate::cancels::{CancelsAt, CancelsWhereWritten};
use crate::folder::Folder;

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

    let all = all(&json);
    assert_eq!(all["version"], hertzian::export::JSON_VERSION);
    let branch = &all["branches"][0];
    let points = branch["points"].as_array().expect("points");
    let at = all["at"].as_array().expect("solutions at 1.3");
    assert!(points.len() > 20 && !at.is_empty());
    for point in points.iter().chain(at) {
        check_point(point);
    }
    assert_eq!(points[0]["value"], 1.0);
    assert_eq!(points[points.len() - 1]["orbit"]["omega"], 1.6);
    assert!(at.iter().all(|point| point["orbit"]["omega"] == 1.3));
    for event in branch["events"].as_array().expect("events") {
        assert_eq!(event["kind"], "fold");
        assert!(numbers(event, &["error", "test"]).all(f64::is_finite));
    }
    assert_eq!(branch["stopped"], "reached-end");
    assert!(branch["statistics"]["jacobians"].as_u64() > Some(20));
    assert!(branch["elapsed"].as_f64() > Some(0.0));
    let read = hertzian::Branch::read(&json).expect("the library reads it");
    assert_eq!(read.points.len(), points.len());

    check_csv(&csv, &all);
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

/// Figure 5a, away from its folds: the peak-to-peak at 0.8 is the same by every method.
#[test]
fn a_curve_is_followed_by_every_method() {
    let folder = Folder::new("by");
    let (svg, json) = (folder.file("a.svg"), folder.file("a.json"));
    let sizes = ["balance", "shooting", "contact-equation"].map(|by| {
        let outcome = run_with(&[
            "--alpha", "1", "--to", "0.85", "--at", "0.8", "--by", by, "--svg", &svg, "--json",
            &json,
        ])
        .expect("a branch");
        assert!(outcome.complete, "{by}: {}", outcome.summary);
        let all = all(&json);
        let motions = &all["at"][0]["observed"]["motions"];
        motions[0]["maximum"].as_f64().expect("a maximum")
            - motions[0]["minimum"].as_f64().expect("a minimum")
    });
    for size in sizes {
        assert!((size / sizes[0] - 1.0).abs() < 1e-6, "{sizes:?}");
    }
}

/// What takes the whole motion is in tables by every method, whether that was chosen or asked for.
#[test]
fn tables_have_every_column_by_every_method() {
    let folder = Folder::new("columns");
    let (svg, csv) = (folder.file("a.svg"), folder.file("a.csv"));
    let command = ["--alpha", "1", "--from", "0.8", "--to", "0.85"];
    let files = ["--one-branch", "--svg", &svg, "--csv", &csv];
    let methods = ["", "balance", "shooting", "contact-equation"];
    let firsts = methods.map(|by| {
        let by = if by.is_empty() {
            vec![]
        } else {
            vec!["--by", by]
        };
        run_with(&[&command[..], &files, &by].concat()).expect("a branch");
        let mut table = csv::Reader::from_path(&csv).expect("a table");
        let names = table.headers().expect("names").clone();
        let rows: Vec<csv::StringRecord> = table.records().map(|row| row.expect("a row")).collect();
        let columns = ["mean", "rms", "contact_fraction", "peak_force", "harmonics"];
        let of = |name: &str| names.iter().position(|own| own == name).expect("a column");
        for (row, name) in rows.iter().flat_map(|row| columns.map(|name| (row, name))) {
            assert!(!row[of(name)].is_empty(), "{by:?}: {name} in {row:?}");
        }
        ["mean", "rms", "peak_force"]
            .map(|name| rows[0][of(name)].parse::<f64>().expect("a number"))
    });
    for (first, by) in firsts.iter().zip(methods) {
        for (number, balanced) in first.iter().zip(firsts[1]) {
            assert!((number / balanced - 1.0).abs() < 1e-4, "{by}: {first:?}");
        }
    }
}

/// Ctrl-C while orbits are read off for files ends that, and what is there is written.
#[test]
fn an_interrupt_ends_what_files_need() {
    let folder = Folder::new("read-off");
    let [svg, json] = ["a.svg", "a.json"].map(|name| folder.file(name));
    let command = ["--alpha", "1", "--to", "0.7", "--one-branch"];
    let arguments = options(&[&command[..], &["--svg", &svg, "--json", &json]].concat());
    let now = Cancel::new();
    let mut progress = Progress::to(CancelsAt(now.clone(), "3 of "));
    let outcome = run(&arguments, &now, &mut progress).expect("a branch");
    let read = hertzian::Branch::read(&json).expect("a branch");
    assert_eq!(read.stopped, hertzian::Stop::ReachedEnd);
    let series = read.points.iter().map(|point| point.orbit.harmonics() > 0);
    let left = read.points.len() - 3;
    let expected = [true; 3]
        .into_iter()
        .chain(std::iter::repeat_n(false, left));
    assert!(series.eq(expected) && !outcome.complete);
    let said = format!("of {left} orbits of branch 0 files lack");
    assert!(
        outcome
            .warnings
            .iter()
            .any(|warning| warning.contains(&said))
    );
}

#[test]
fn an_orbit_is_drawn_in_the_plane_of_two_signals() {
    let folder = Folder::new("path");
    let [model, svg, page] = ["stop.txt", "a.svg", "page.svg"].map(|name| folder.file(name));
    let text = "Stop(x) { law stop(g) { g > 0 => g, else => 0 }
                ddot(x) + dot(x)/10 + x + stop(x - 1) = cos(omega*t)/5; output speed = dot(x); }";
    std::fs::write(&model, text).expect("written");
    let command = format!(
        "--model {model} --from 0.8 --to 0.9 --at 0.85 --svg {svg} --panels {page} --path speed,x"
    );
    let words: Vec<&str> = command.split_whitespace().collect();
    let outcome = run_with(&words).expect("a branch");
    assert!(outcome.complete, "{:?}", outcome.warnings);
    let drawn = std::fs::read_to_string(&page).expect("a page");
    assert!(drawn.contains("speed over x at ω = 0.85"));
    // One name is no plane, and what is not there is said.
    let alone = command.replace("speed,x", "speed");
    let words: Vec<&str> = alone.split_whitespace().collect();
    let refused = run_with(&words).expect_err("one name");
    assert!(refused.to_string().contains("--path takes two names"));
    let unknown = command.replace("speed,x", "speed,z");
    let words: Vec<&str> = unknown.split_whitespace().collect();
    let refused = run_with(&words).expect_err("no such signal");
    assert!(refused.to_string().contains("speed"), "{refused}");
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
    let read = hertzian::Branch::read(&json).expect("a branch");
    assert_eq!(read.points.len(), 7);
}

#[test]
fn an_interrupt_ends_the_branch() {
    let folder = Folder::new("interrupt");
    let svg = folder.file("a.svg");
    let arguments = options(&["--svg", &svg]);
    let now = Cancel::new();
    // At the first point.
    let mut progress = Progress::to(CancelsWhereWritten(now.clone()));
    let outcome = run(&arguments, &now, &mut progress).expect("a branch");
    assert!(!outcome.complete && outcome.summary.contains("interrupted"));
    assert!(Path::new(&svg).exists());
    // Before there is anything to write.
    let failure = run(&arguments, &now, &mut Progress::hidden()).expect_err("nothing");
    assert_eq!(failure.exit_code(), 3);
    assert!(failure.to_string().starts_with("cancelled"), "{failure}");
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
    let branch = hertzian::Branch::read(&json).expect("a branch");
    assert_eq!((&branch.model.name[..], &branch.varied[..]), ("Stop", "k"));
    assert_eq!(branch.model.parameters[1].name, "zeta");
    assert_eq!(branch.points[0].parameters, [0.5, 0.1]);
    assert_eq!(branch.points.last().expect("points").value, 1.0);
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
    let branches = all["branches"].as_array().expect("branches").iter();
    let events = branches.flat_map(|branch| branch["events"].as_array().expect("events"));
    let events: Vec<&Value> = events.collect();
    for (kind, period, drive) in [
        ("period-doubling", 1, 1.282_584_167_663_767),
        ("period-doubling", 2, 1.531_044_135_499_983),
        ("period-doubling", 2, 1.880_077_405_264_828),
        ("fold", 2, 2.009_554_757_004_067),
        ("fold", 2, 0.294_528_806_187_216),
        ("fold", 8, 1.779_836_025_884_334),
    ] {
        let is_it = |event: &&Value| {
            let (point, orbit) = (&event["point"], &event["point"]["orbit"]);
            let place = point["value"].as_f64().expect("a number");
            event["kind"] == kind && orbit["period"] == period && (place - drive).abs() < 1e-9
        };
        assert!(
            events.iter().copied().any(|event| is_it(&event)),
            "{kind} {period} {drive}"
        );
    }
    let points = points(&all);
    for period in [1, 2, 4, 8] {
        let mut points = points.iter();
        assert!(points.any(|(_, point)| point["orbit"]["period"] == period));
    }
    assert!(all["branches"].as_array().map(Vec::len) > Some(5));
    check_csv(&csv, &all);
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

#[test]
fn a_backbone_is_drawn_through_the_resonance() {
    let folder = Folder::new("backbone");
    let [svg, json] = ["a.svg", "a.json"].map(|name| folder.file(name));
    let command = "--continuous --load 0 --zeta 0.01 --from 0.6 --to 1.7 --backbone";
    let files = ["--svg", &svg, "--json", &json];
    let arguments: Vec<&str> = command.split_whitespace().chain(files).collect();
    run_with(&arguments).expect("a branch");
    let all = all(&json);
    let number = |value: &Value| value.as_f64().expect("a number");
    for (curve, tolerance) in [("free", 1e-9), ("resonance", 0.01)] {
        let points = all["backbone"][curve]["points"].as_array();
        let points = points.expect("a curve");
        assert!(points.len() > 5, "{curve}");
        for point in points {
            let motion = &point["observed"]["motions"][0];
            let [high, low] = ["maximum", "minimum"].map(|end| number(&motion[end]));
            let (omega, size) = (number(&point["orbit"]["omega"]), high - low);
            let free = 0.954_693_569_728_51 * (0.5 * size.abs()).powf(0.25);
            let off = (omega / free - 1.0).abs();
            assert!(off < tolerance, "{curve} {omega} {free}");
        }
    }
    let picture = std::fs::read_to_string(&svg).expect("a picture");
    assert!(picture.contains("free oscillation") && picture.contains("phase resonance"));
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
    assert!(tracks[0]["kind"]["grazing"].is_object());
    let values = tracks[0]["values"].as_array().expect("values");
    let drives = values
        .iter()
        .map(|pair| pair[1].as_f64().expect("a number"));
    let drives: Vec<f64> = drives.collect();
    assert!(drives.len() > 20);
    for end in [drives[0], drives[drives.len() - 1]] {
        assert!((end - 0.5).abs() < 1e-12, "{end}");
    }
    assert!(drives.iter().copied().fold(f64::INFINITY, f64::min) < 0.1);
}

/// The branch at 1.0 turns back at 1.1445: that from the other end is joined, and one branch alone does not cover the range.
#[test]
fn a_branch_that_turns_back_is_joined_from_the_other_end() {
    let folder = Folder::new("joined");
    let json = folder.file("a.json");
    let csv = folder.file("a.csv");
    let range = ["--from", "1", "--to", "1.6", "--json", &json, "--csv", &csv];
    let svg = folder.file("a.svg");
    let outcome = run_with(&[&range[..], &["--svg", &svg, "--at", "1.1"]].concat());
    let outcome = outcome.expect("branches");
    assert!(outcome.complete && outcome.warnings.is_empty());
    for part in [
        "ended      turned back and left the range at its start",
        "branch 2   period 1, from the other end: ",
    ] {
        assert!(outcome.summary.contains(part), "{}", outcome.summary);
    }
    let solutions = outcome
        .summary
        .lines()
        .filter(|line| line.starts_with("at "));
    assert_eq!(solutions.count(), 3, "{}", outcome.summary);
    let record = all(&json);
    assert_eq!(record["branches"].as_array().map(Vec::len), Some(2));
    assert_eq!(record["searched"].as_array().map(Vec::len), Some(0));
    assert_eq!(record["uncovered"].as_array().map(Vec::len), Some(0));
    assert!(points(&record).iter().any(|(number, _)| *number == 1));
    let alone = run_with(&[&range[..], &["--svg", &svg, "--one-branch"]].concat());
    let alone = alone.expect("a branch");
    assert!(!alone.complete);
    assert!(alone.warnings[0].contains("ended early: turned back"));
    let record = all(&json);
    assert_eq!(record["branches"].as_array().map(Vec::len), Some(1));
}

/// Where all orbits of the branch are unstable, what motions settle to is said and drawn.
#[test]
fn what_motions_settle_to_is_joined() {
    let folder = Folder::new("settled");
    let [svg, json] = ["a.svg", "a.json"].map(|name| folder.file(name));
    let command = "--alpha 1 --sweep drive --omega 1 --from 1.2 --to 1.5";
    let files = ["--svg", &svg, "--json", &json];
    let arguments: Vec<&str> = command.split_whitespace().chain(files).collect();
    let outcome = run_with(&arguments).expect("branches");
    assert!(outcome.complete);
    assert!(
        outcome.summary.contains("settle to period 2 on branch 2"),
        "{}",
        outcome.summary
    );
    let record = all(&json);
    assert_eq!(record["searched"][0]["orbits"][0]["period"], 2);
    let picture = std::fs::read_to_string(&svg).expect("a picture");
    assert!(picture.contains("period 2"));
}

/// Two masses in units, with outputs.
const MACHINE: &str = "Machine(base: mm, head: mm) {
    param m: t = 1e-3 > 0;
    param k: N/mm = 40 in 0.0..;
    param c: N*s/mm = 0.02 in 0.0..;
    param stiff: N/mm^1.5 = 4e3 in 0.0..;
    param play: mm = 0.02;
    param drive: N = 1;
    law stop(gap) { gap > 0 => stiff*gap^1.5, else => 0 }
    m*ddot(base) + c*dot(base) + 2*k*base - k*head = drive*cos(omega*t);
    m*ddot(head) + c*dot(head) + k*(head - base) + stop(head - play) = 0;
    /// stretch of the spring between them
    output stretch: um = head - base;
    output impact = force(stop);
}";

#[test]
fn signals_are_drawn_and_written_by_their_names() {
    let folder = Folder::new("signals");
    let (model, csv) = (folder.file("machine.txt"), folder.file("a.csv"));
    std::fs::write(&model, MACHINE).expect("a file");
    let range = [
        "--model",
        &model,
        "--from",
        "110",
        "--to",
        "112",
        "--one-branch",
    ];
    let plot = ["--plot", "stretch:rms,impact:max,head", "--axis", "hz"];
    let outcome = coarse(&folder, &[&range[..], &plot, &["--csv", &csv]].concat());
    assert!(outcome.expect("a branch").complete);
    let picture = std::fs::read_to_string(folder.file("response.svg")).expect("a picture");
    for part in [
        "rms of stretch (stretch of the spring between them) [um]",
        "largest of impact [N]",
        "peak-to-peak of head [mm]",
        "excitation frequency [Hz]",
        "stiff = 4000 N/mm^1.5",
    ] {
        assert!(picture.contains(part), "{part}");
    }
    let table = std::fs::read_to_string(&csv).expect("a table");
    assert!(table.starts_with("omega [rad/s],peak_to_peak [mm],"));
    assert!(table.contains(",stretch_rms [um],") && table.contains(",head_p2p [mm],"));
    for (wrong, said) in [
        (
            "strtch:rms",
            "no output, coordinate or contact is called strtch",
        ),
        (
            "head:impacts",
            "impacts per period is one of contacts, and head is none",
        ),
    ] {
        let failure = coarse(&folder, &[&range[..], &["--plot", wrong]].concat());
        let message = failure.expect_err("no such signal").to_string();
        assert!(message.contains(said), "{message}");
    }
    assert!(super::read(&["--plot", "head:power"]).is_err());
}
