//! The numbers on the page are those of `hertzian response`, digit by digit.

use std::process::Command;

use hertzian_cli::explore::asked::{Asked, Effort, Method};
use hertzian_cli::explore::exported::{Form, Scale};
use hertzian_cli::explore::work::Ask;
use serde_json::Value;

use super::{last, of};
use crate::folder::Folder;

/// What `hertzian response` writes: table, picture, everything, and what it prints.
fn written(command: &str, folder: &Folder, more: &str) -> [String; 4] {
    let file = |name: &str| folder.file(name);
    let words = format!(
        "{command} --csv {} --svg {} --json {} {more}",
        file("a.csv"),
        file("a.svg"),
        file("a.json")
    );
    let mut program = Command::new(env!("CARGO_BIN_EXE_hertzian"));
    let output = program.args(words.split_whitespace().skip(1)).output();
    let output = output.expect("the program");
    let said = String::from_utf8_lossy(&output.stderr);
    assert_ne!(output.status.code(), Some(2), "{words}: {said}");
    let read = |name: &str| std::fs::read_to_string(file(name)).expect("a file");
    let printed = String::from_utf8(output.stdout).expect("text");
    [read("a.csv"), read("a.svg"), read("a.json"), printed]
}

fn exported(of: &Asked, form: Form) -> String {
    let answer = last(&Ask::Export {
        of: of.clone(),
        plot: String::new(),
        scale: Scale::Linear,
        form,
    });
    let contents = answer["export"]["contents"].as_str();
    contents.unwrap_or_else(|| panic!("{answer}")).to_owned()
}

fn curve(of: &Asked) -> Value {
    let answer = last(&Ask::Curve {
        of: of.clone(),
        plot: String::new(),
        effort: Effort::Full,
    });
    assert!(answer["fault"].is_null(), "{answer}");
    answer["curve"].clone()
}

/// Without how long it took.
fn timeless(text: &str) -> Value {
    fn strip(value: &mut Value) {
        match value {
            Value::Object(entries) => {
                entries.remove("elapsed");
                entries.values_mut().for_each(strip);
            }
            Value::Array(entries) => entries.iter_mut().for_each(strip),
            _ => {}
        }
    }
    let mut value = serde_json::from_str(text).expect("JSON");
    strip(&mut value);
    value
}

fn cases() -> Vec<(&'static str, Asked)> {
    let balance = Asked {
        by: Method::Balance,
        ..of("one-sided", 0.6, 1.6)
    };
    let drive = Asked {
        varied: "drive".to_owned(),
        values: [("alpha".to_owned(), 1.0)].into(),
        omega: 0.9,
        ..of("one-sided", 0.01, 0.3)
    };
    let period = Asked {
        values: [("drive".to_owned(), 0.2)].into(),
        by: Method::Shooting,
        ..of("two-masses", 0.8, 1.2)
    };
    let followed = Asked {
        values: [("alpha".to_owned(), 1.0)].into(),
        depth: Some(1),
        varied: "drive".to_owned(),
        ..of("one-sided", 1.0, 1.6)
    };
    vec![
        ("figure 5b", of("one-sided", 0.6, 1.6)),
        ("by the balance", balance),
        ("over the drive", drive),
        ("two masses", period),
        ("what begins at bifurcations", followed),
        ("units", of("bolted-joint", 1500.0, 4500.0)),
    ]
}

#[test]
fn files_are_those_of_the_command_that_is_shown() {
    for (name, asked) in cases() {
        let folder = Folder::new("explored");
        let curve = curve(&asked);
        let command = curve["command"].as_str().expect("a command");
        let [csv, svg, json, _] = written(command, &folder, "");
        assert!(exported(&asked, Form::Csv) == csv, "{name}: {command}");
        assert!(exported(&asked, Form::Svg) == svg, "{name}: {command}");
        let ours = timeless(&exported(&asked, Form::Json));
        assert!(ours == timeless(&json), "{name}: {command}");
        // What is drawn is what is in the file.
        let branches = curve["branches"].as_array().expect("branches").iter();
        let drawn = branches.flat_map(|branch| branch["orbits"].as_array().expect("orbits"));
        let orbits: Vec<f64> = drawn
            .map(|orbit| orbit[0].as_f64().expect("a value"))
            .collect();
        let points = ours["branches"].as_array().expect("branches").iter();
        let points = points.flat_map(|branch| branch["points"].as_array().expect("points"));
        let points: Vec<f64> = points
            .map(|p| p["value"].as_f64().expect("a value"))
            .collect();
        // What begins at bifurcations is drawn alone; the file has the branch by the method that was asked for before it.
        assert!(points.ends_with(&orbits), "{name}");
        let alone = asked.depth.is_some() || points.len() == orbits.len();
        assert!(alone && !orbits.is_empty(), "{name}");
    }
}

#[test]
fn events_and_orbits_are_said_as_the_command_says_them() {
    for (name, asked) in cases() {
        let folder = Folder::new("explored");
        let curve = curve(&asked);
        let command = curve["command"].as_str().expect("a command");
        let at = asked.from + 0.37 * (asked.to - asked.from);
        let [.., printed] = written(command, &folder, &format!("--at {at}"));
        let folds = printed
            .lines()
            .filter_map(|line| line.strip_prefix("fold "));
        let events = curve["events"].as_array().expect("events").iter();
        let events = events.filter(|event| event["kind"] == "fold");
        let ours: Vec<&str> = events
            .map(|e| e["written"].as_str().expect("text"))
            .collect();
        let folds: Vec<&str> = folds.collect();
        // Of the branch that was asked for six are listed.
        for (fold, ours) in folds.iter().zip(&ours).take(6) {
            assert!(fold.contains(ours), "{name}: {fold} {ours}");
        }
        let orbits = last(&Ask::Orbits {
            of: asked.clone(),
            plot: String::new(),
            at,
        });
        let orbits = orbits["orbits"]["orbits"]
            .as_array()
            .expect("orbits")
            .iter();
        let text = |value: &Value| value.as_str().expect("text").to_owned();
        let said =
            orbits.map(|orbit| format!("{}, {}", text(&orbit["said"]), text(&orbit["verdict"])));
        let said: Vec<String> = said.collect();
        let lines = printed.lines().filter(|line| line.starts_with("at  "));
        let lines: Vec<&str> = lines
            .map(|line| line.split_once(": ").expect("an orbit").1)
            .collect();
        assert_eq!(said, lines, "{name}");
        assert!(!said.is_empty(), "{name}");
    }
}
