//! The subcommand `fit`: what it prints and writes, as the book says it, and what is refused.

use std::fmt::Write;
use std::fs;
use std::path::Path;

use clap::Parser;
use hertzian::Cancel;
use hertzian_cli::fit::{options::Options, run::run};
use hertzian_cli::program::Ended;
use hertzian_cli::response::progress::Progress;

use crate::folder::Folder;

const MODEL: &str = "Linear(x) {
    param k > 0;
    param c = 0.1 in 0.0..;
    param drive;
    ddot(x) + c*dot(x) + k*x = drive*cos(omega*t);
}";

fn fit(words: &[&str]) -> Result<Ended, String> {
    let words = [&["fit"], words].concat();
    let options = Options::try_parse_from(words).map_err(|error| error.to_string())?;
    run(&options, &Cancel::new(), &mut Progress::hidden()).map_err(|failure| failure.to_string())
}

/// Peak-to-peak of that model with other values, at two levels of the drive.
fn table() -> String {
    let mut table = "omega,x:p2p,drive\n".to_owned();
    for i in 0..10 {
        let omega = 1.0 + 0.2 * f64::from(i);
        for drive in [0.5, 1.0] {
            let size = 2.0 * drive / (4.4 - omega * omega).hypot(0.2 * omega);
            let _ = writeln!(table, "{omega},{size},{drive}");
        }
    }
    table
}

#[test]
fn what_the_book_prints_is_printed() {
    let folder = Folder::new("fit-book");
    let measured =
        Path::new(env!("CARGO_MANIFEST_DIR")).join("../fit/tests/fit/measured/noisy.csv");
    let measured = measured.to_str().expect("a path");
    let svg = folder.file("fit.svg");
    let words = [
        measured,
        "--zeta",
        "0.05",
        "--load",
        "0.8",
        "--alpha",
        "1.3",
        "--free",
        "zeta,load,alpha",
        "--jump",
        "x:p2p falling=0.686:0.002",
        "--svg",
        &svg,
    ];
    let ended = fit(&words).expect("a fit");
    assert!(ended.complete && ended.complaints.is_empty(), "{ended:?}");
    let book = include_str!("../../../docs/book/src/fitting.md");
    let lines = ended
        .summary
        .lines()
        .filter(|line| !line.starts_with("written"));
    for line in lines {
        assert!(book.contains(line), "{line}");
    }
    assert!(
        fs::read_to_string(svg)
            .expect("a picture")
            .contains("x:p2p falling")
    );
}

/// The frequency and the levels of the drive are in the table, the start of the stiffness in its range.
#[test]
fn a_model_of_ones_own_is_fitted_and_everything_is_written() {
    let folder = Folder::new("fit-own");
    let [model, data, svg, csv, json] =
        ["mine.txt", "data.csv", "a.svg", "a.csv", "a.json"].map(|name| folder.file(name));
    fs::write(&model, MODEL).expect("written");
    fs::write(&data, table()).expect("written");
    let words = [
        &model,
        &data,
        "--free",
        "k=2..6,c",
        "--svg",
        &svg,
        "--csv",
        &csv,
        "--json",
        &json,
        "--against",
        "c=0.2",
    ];
    let ended = fit(&words.map(|word: &str| word)).expect("a fit");
    assert!(ended.complete, "{ended:?}");
    assert!(ended.summary.contains("c = 0.2"), "{}", ended.summary);
    let json: serde_json::Value =
        serde_json::from_str(&fs::read_to_string(json).expect("a file")).expect("JSON");
    for (index, value) in [4.4, 0.2].into_iter().enumerate() {
        let found = json["estimates"][index]["value"]
            .as_f64()
            .expect("a number");
        assert!((found / value - 1.0).abs() < 1e-6, "{found}");
    }
    assert_eq!(json["sets"][1]["name"], "x:p2p drive=1");
    assert_eq!(fs::read_to_string(csv).expect("a file").lines().count(), 21);
    assert!(fs::read_to_string(svg).expect("a file").starts_with("<svg"));
}

#[test]
fn what_is_wrong_is_one_clear_sentence() {
    let folder = Folder::new("fit-faults");
    let [model, data, svg] = ["mine.txt", "data.csv", "a.svg"].map(|name| folder.file(name));
    fs::write(&model, MODEL).expect("written");
    let refused = |table: &str, words: &[&str]| {
        fs::write(&data, table).expect("written");
        let words = [
            &[model.as_str(), data.as_str(), "--svg", svg.as_str()],
            words,
        ]
        .concat();
        fit(&words).expect_err(table)
    };
    let table = table();
    let cases: [(&str, &[&str], String); 9] = [
        ("", &["--free", "c"], format!("{data}:1: the table is empty")),
        ("omega,x:p2p\n1,2\n1,two\n", &["--free", "c"], format!("{data}:3: `two` in column 2 is not a number")),
        ("omega,x:p2p [mm]\n1,2\n", &["--free", "c"], format!("{data}:1: column 2, `x:p2p [mm]`: the model has no units: leave [mm] out, or declare units in the model")),
        (&table, &[], "no parameter is free: name at least one".to_owned()),
        (&table, &["--free", "c"], "data set x:p2p drive=0.5: parameter k has no value".to_owned()),
        (&table, &["--free", "k"], "free parameter k: it has no value to start from, and no range: give one of both".to_owned()),
        (&table, &["--free", "c,k=2..6", "--set", "mass=1"], format!("{model}: there is no parameter mass; there are k, c, drive")),
        (&table, &["--free", "k=2..6", "--jump", "up=1:0.1"], "--jump: there is no data set `up`; there are `x:p2p drive=0.5`, `x:p2p drive=1`".to_owned()),
        (&table, &["--free", "k=2..6,drive"], "free parameter drive: data set x:p2p drive=0.5 says what it is: leave that out, or do not free it".to_owned()),
    ];
    for (table, words, said) in cases {
        assert_eq!(refused(table, words), said, "{words:?}");
    }
    let error = fit(&[&model, "nowhere.csv", "--free", "c"]).expect_err("no file");
    assert!(error.starts_with("cannot read nowhere.csv: "), "{error}");
    for word in ["k=6", "k=1..x", "k=1..inf"] {
        assert!(fit(&[&model, &data, "--free", word]).is_err(), "{word}");
    }
}

#[test]
fn ctrl_c_keeps_the_best() {
    let folder = Folder::new("fit-cancelled");
    let [model, data, svg] = ["mine.txt", "data.csv", "a.svg"].map(|name| folder.file(name));
    fs::write(&model, MODEL).expect("written");
    fs::write(&data, table()).expect("written");
    let words = ["fit", &model, &data, "--free", "k=2..6,c", "--svg", &svg];
    let options = Options::try_parse_from(words).expect("options");
    let cancel = Cancel::new();
    cancel.cancel();
    let error = run(&options, &cancel, &mut Progress::hidden()).expect_err("nothing was found");
    assert_eq!(error.to_string(), "cancelled before anything was found");
}
