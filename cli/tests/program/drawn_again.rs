//! Pictures of errors in the documentation are what the program draws of the tables beside them: nothing is measured again.
//!
//! `UPDATE_PICTURES=1` writes them.

use std::fs;
use std::path::PathBuf;

use hertzian::chart::Page;
use hertzian_cli::multipliers::{charts, study};
use hertzian_cli::work_precision::measure::Measured;
use hertzian_cli::work_precision::method::{Family, Reference, Setting};
use hertzian_cli::work_precision::multipliers::{Answer, names};
use hertzian_cli::work_precision::peer::Peer;
use hertzian_cli::work_precision::{Section, picture, problem};

fn stored(name: &str) -> PathBuf {
    let folder = concat!(env!("CARGO_MANIFEST_DIR"), "/../docs/pictures");
    PathBuf::from(folder).join(name)
}

/// The rows of a table below its header.
fn rows(name: &str) -> Vec<Vec<String>> {
    let text = fs::read_to_string(stored(name)).expect("a table");
    let mut reader = csv::Reader::from_reader(text.as_bytes());
    let rows = reader.records().map(|row| row.expect("a row"));
    rows.map(|row| row.iter().map(str::to_owned).collect())
        .collect()
}

fn is_drawn(name: &str, page: &Page) {
    let (path, drawn) = (stored(name), page.to_svg());
    if std::env::var_os("UPDATE_PICTURES").is_some() {
        fs::write(&path, drawn).expect("it is written");
        return;
    }
    let stored = fs::read_to_string(&path).expect("a picture");
    assert!(
        stored == drawn,
        "docs/pictures/{name} is to be drawn again: UPDATE_PICTURES=1"
    );
}

/// `K = 5, N = 512`, `K = 5` or `tolerance 1e-4`.
fn setting(text: &str) -> Setting {
    let numbers: Vec<&str> = text
        .split([' ', ','])
        .filter(|word| word.starts_with(char::is_numeric))
        .collect();
    let count = |text: &str| text.parse().expect("a count");
    match numbers[..] {
        [harmonics, samples] => Setting::Samples {
            harmonics: count(harmonics),
            samples: count(samples),
        },
        [number] if text.starts_with('K') => Setting::Harmonics(count(number)),
        [number] => Setting::Tolerance(number.parse().expect("a number")),
        _ => panic!("{text}"),
    }
}

fn number(text: &str) -> Option<f64> {
    (!text.is_empty()).then(|| text.parse().expect("a number"))
}

fn measured(row: &[String], family: Family) -> Measured {
    Measured {
        family,
        setting: setting(&row[2]),
        seconds: number(&row[3]).into_iter().collect(),
        fold: number(&row[6]),
        peak_to_peak: number(&row[7]),
        failure: (!row[8].is_empty()).then(|| row[8].clone()),
    }
}

fn peer(row: &[String]) -> Peer {
    Peer {
        name: row[1].clone(),
        setting: row[2].clone(),
        measured: String::new(),
        points: 0,
        seconds: [3, 4, 5].map(|column| number(&row[column]).expect("a time")),
        fold: number(&row[6]),
        peak_to_peak: number(&row[7]),
        failure: (!row[8].is_empty()).then(|| row[8].clone()),
        note: String::new(),
    }
}

#[test]
fn error_against_time_is_that_of_the_table() {
    let curves = rows("work-precision.csv");
    let answers = rows("work-precision-multipliers.csv");
    let methods: Vec<&str> = names().collect();
    for problem in problem::all() {
        let own = |rows: &[Vec<String>]| -> Vec<Vec<String>> {
            let rows = rows.iter().filter(|row| row[0] == problem.id);
            rows.cloned().collect()
        };
        let family = |row: &[String]| {
            let mut all = Family::ALL.into_iter();
            all.find(|family| family.name() == row[1])
        };
        let curves = own(&curves);
        let of_family = curves.iter().filter_map(|row| Some((row, family(row)?)));
        let of_others = curves.iter().filter(|row| family(row).is_none());
        let answers = own(&answers);
        let answer = |row: &Vec<String>| Answer {
            method: methods
                .iter()
                .position(|name| *name == row[1])
                .expect("a method"),
            setting: row[2].clone(),
            seconds: number(&row[3]).expect("a time"),
            error: number(&row[4]).expect("an error"),
            failure: (!row[5].is_empty()).then(|| row[5].clone()),
        };
        // Whether there are folds is all that is asked of it.
        let reference = Reference {
            folds: vec![f64::NAN],
            peak_to_peak: f64::NAN,
            state: Vec::new(),
            multipliers: Vec::new(),
        };
        let name = problem.id.strip_suffix("-1").unwrap_or(problem.id);
        let name = format!(
            "work-precision-{}.svg",
            name.replace("continuous-1.5", "continuous")
        );
        let section = Section {
            measured: of_family
                .map(|(row, family)| measured(row, family))
                .collect(),
            answers: answers.iter().map(answer).collect(),
            peers: of_others.map(|row| peer(row)).collect(),
            problem,
            reference,
        };
        assert!(section.measured.len() > 40 && section.answers.len() > 20);
        is_drawn(&name, &picture(&section));
    }
}

#[test]
fn errors_of_multipliers_are_those_of_the_table() {
    let rows = rows("multipliers.csv");
    let method = |name: &str| {
        let mut all = study::METHODS.into_iter().map(|(method, _)| method);
        all.find(|method| method.to_string() == name)
    };
    let all: Vec<(&str, Vec<study::Measured>)> = study::oscillators()
        .iter()
        .map(|oscillator| {
            let own = rows.iter().filter(|row| row[0] == oscillator.name);
            let measured = own.map(|row| {
                let [error, corrected, estimate, microseconds] =
                    [3, 4, 5, 6].map(|column| number(&row[column]).expect("a number"));
                study::Measured {
                    method: method(&row[1]).expect("a method"),
                    harmonics: row[2].parse().expect("a count"),
                    error,
                    corrected,
                    estimate,
                    microseconds,
                }
            });
            (oscillator.name, measured.collect())
        })
        .collect();
    assert_eq!(
        all.iter().map(|(_, own)| own.len()).sum::<usize>(),
        rows.len()
    );
    is_drawn("multipliers-harmonics.svg", &charts::by_harmonics(&all));
    is_drawn("multipliers-time.svg", &charts::by_time(&all));
}
