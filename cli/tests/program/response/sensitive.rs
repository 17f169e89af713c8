//! Derivatives by parameters: the table, the pictures, and what is refused.

use std::fs;

use hertzian_cli::command::{Program, Task};

use super::{COARSE, all, coarse, read, run_with};
use crate::folder::Folder;

/// Rows of a table as texts, by the names of their columns.
fn rows(path: &str) -> Vec<std::collections::HashMap<String, String>> {
    let mut reader = csv::Reader::from_path(path).expect("a table");
    reader
        .deserialize()
        .collect::<Result<_, _>>()
        .expect("rows")
}

/// `x'' + 2 zeta x' + x = A cos(omega t) + W` has the peak-to-peak `2 A / sqrt((1 - omega^2)^2 + (2 zeta omega)^2)`.
#[test]
fn of_a_linear_oscillator_are_those_of_the_formula() {
    let folder = Folder::new("slopes");
    let (table, json) = (folder.file("slopes.csv"), folder.file("a.json"));
    let linear = [
        "--continuous",
        "--alpha",
        "1",
        "--zeta",
        "0.1",
        "--to",
        "1.2",
    ];
    let asked = [
        "--plot",
        "x:p2p",
        "--sensitivities",
        &table,
        "--json",
        &json,
    ];
    coarse(&folder, &[&linear[..], &asked].concat()).expect("a branch");
    let rows = rows(&table);
    let mut compared = 0;
    for row in rows.iter().filter(|row| row["by"] == "zeta") {
        let omega: f64 = row["value"].parse().expect("a number");
        let zeta = 0.1;
        let below = (1.0 - omega * omega).powi(2) + (2.0 * zeta * omega).powi(2);
        let expected = -0.2 * 4.0 * zeta * omega * omega / below.powf(1.5);
        let [found, error] = ["derivative", "error"].map(|of| row[of].parse::<f64>().unwrap());
        assert!((found - expected).abs() < 1e-8, "{row:?} {expected}");
        assert!(error < 1e-8 && row["what"] == "x:p2p" && row["held"] == "omega");
        compared += 1;
    }
    let all = all(&json);
    let points = all["branches"][0]["points"]
        .as_array()
        .expect("points")
        .len();
    assert_eq!(compared, points);
    let kept = all["sensitivities"].as_array().expect("derivatives");
    assert_eq!(kept.len(), points);
    assert_eq!(kept[0]["point"], 0);
    assert_eq!(kept[0]["derivatives"]["measured"][0]["name"], "x:p2p");
    assert!(hertzian::Branch::read(&json).is_ok());
}

/// The impulse of a contact that carries a load is `2 pi W / omega`. A number of impacts has no derivative, and takes nothing else away.
#[test]
fn what_has_no_derivative_takes_nothing_else_away() {
    let folder = Folder::new("impulses");
    let table = folder.file("slopes.csv");
    let asked = [
        "--plot",
        "contact:impulse,contact:impacts",
        "--sensitivities",
        &table,
    ];
    coarse(&folder, &asked).expect("a branch");
    let rows = rows(&table);
    let mut compared = 0;
    for row in rows
        .iter()
        .filter(|row| row["at"] == "orbit" && row["by"] == "load")
    {
        let numbers = ["value", "derivative", "error"];
        let [omega, found, error] = numbers.map(|of| row[of].parse::<f64>().unwrap());
        let expected = std::f64::consts::TAU / omega;
        // Next to a fold it is what the equations leave of it, and stated.
        let apart = (found - expected).abs();
        assert!(
            apart <= error.max(1e-8) && error < 1e-3,
            "{row:?} {expected}"
        );
        compared += 1;
    }
    assert!(compared > 10);
    let said = rows.iter().filter(|row| row["what"] == "contact:impacts");
    assert!(said.clone().count() >= compared);
    for row in said {
        assert!(row["note"].contains("whole"), "{row:?}");
    }
}

#[test]
fn of_folds_are_in_the_table_the_summary_and_a_picture() {
    let folder = Folder::new("tornado");
    let names = ["slopes.csv", "tornado.svg", "a.json"];
    let [table, tornado, json] = names.map(|name| folder.file(name));
    let asked = [
        "--sensitivities",
        &table,
        "--tornado",
        &tornado,
        "--uncertain",
        "zeta=5%,load=0.02",
        "--plot",
        "x:p2p",
        "--json",
        &json,
    ];
    let outcome = coarse(&folder, &asked).expect("a branch");
    assert!(
        outcome.summary.contains("domega/dzeta = "),
        "{}",
        outcome.summary
    );
    let rows = rows(&table);
    let of_fold = |what: &str, held: &str| {
        let mut own = rows.iter().filter(|row| row["at"] == "fold");
        own.any(|row| row["what"] == what && row["held"] == held && row["by"] == "zeta")
    };
    assert!(of_fold("omega", "event") && of_fold("x:p2p", "event"));
    let said = rows.iter().filter(|row| row["note"].contains("unbounded"));
    assert_eq!(said.count(), 2);
    let tornado = fs::read_to_string(tornado).expect("a picture");
    for part in [
        "zeta = 0.032 ± 5 %",
        "load = 1 ± 0.02",
        "parameter larger",
        "first order",
    ] {
        assert!(tornado.contains(part), "{part}");
    }
    // What was written is read back.
    let show = |words: &[&str]| {
        let words = [&["hertzian", "show", &json], words].concat();
        let program = Program::read(words.into_iter().map(Into::into)).expect("options");
        let Task::Show(options) = program.task else {
            panic!("another task");
        };
        hertzian_cli::show::show(&options)
            .expect("a summary")
            .summary
    };
    let line = outcome
        .summary
        .lines()
        .find(|line| line.contains("domega/dzeta"));
    let line = line.expect("a line of an event");
    assert!(show(&[]).contains(line) && show(&["--branch", "1"]).contains(line));
    let picture = fs::read_to_string(folder.file("response.svg")).expect("a picture");
    assert!(picture.contains("± zeta=5%, load=0.02"));
}

#[test]
fn what_cannot_be_uncertain_is_refused() {
    let error = read(&["--uncertain", "zeta=much"]).expect_err("no number");
    assert!(
        error.to_string().contains("zeta=much is no uncertainty"),
        "{error}"
    );
    let refused = |uncertain: &str| {
        let arguments = [&COARSE[..], &["--uncertain", uncertain]].concat();
        run_with(&arguments).expect_err(uncertain).to_string()
    };
    let unknown = refused("mass=1%");
    assert!(
        unknown.starts_with("--uncertain mass: there is no parameter mass; there are "),
        "{unknown}"
    );
    let twice = refused("zeta=1%,zeta=2%");
    assert!(twice.contains("zeta"), "{twice}");
    let error = read(&["--svg", "a.svg", "--uncertain", "zeta=1%", "--stack", "3"])
        .expect_err("several curves");
    assert!(error.to_string().contains("leave one out"), "{error}");
}
