//! What the page is told.

use std::sync::Arc;
use std::time::{Duration, Instant};

use hertzian::Cancel;
use hertzian_cli::built_in::MODELS;
use hertzian_cli::explore::asked::{Asked, Effort, Method};
use hertzian_cli::explore::exported::{Form, Scale};
use hertzian_cli::explore::models::offered;
use hertzian_cli::explore::options::Options;
use hertzian_cli::explore::work::{Ask, Request, Work};
use serde_json::Value;

use super::{answered, last, of};

fn full(of: Asked) -> Ask {
    Ask::Curve {
        of,
        plot: String::new(),
        effort: Effort::Full,
    }
}

#[test]
fn a_declaration_has_its_parameters_with_ranges() {
    let text = of("bolted-joint", 1.0, 2.0).text;
    let answer = last(&Ask::Declaration { text });
    let declared = &answer["declaration"];
    assert_eq!(declared["name"], "BoltedJoint");
    let mass = &declared["parameters"][0];
    assert_eq!(mass["name"], "mass");
    assert_eq!(mass["documentation"], "mass of the part");
    assert_eq!(
        (mass["unit"].as_str(), mass["default"].as_f64()),
        (Some("kg"), Some(2.0))
    );
    assert_eq!(mass["minimum"]["value"], 0.0);
    assert_eq!(mass["minimum"]["included"], false);
    assert!(mass["maximum"].is_null());
    let kinds: Vec<&str> = declared["signals"]
        .as_array()
        .expect("signals")
        .iter()
        .map(|signal| signal["kind"].as_str().expect("a kind"))
        .collect();
    assert_eq!(kinds, ["output", "output", "coordinate", "contact"]);
}

/// Every model is there, with a range in which it has something to show.
#[test]
fn every_model_begins_with_a_curve() {
    let options = Options {
        model: "one-sided".into(),
        set: Vec::new(),
        from: None,
        to: None,
        port: 0,
        open: false,
    };
    let models = offered(&options).expect("models");
    assert_eq!(models.len(), MODELS.len());
    for model in models {
        let answer = last(&Ask::Curve {
            of: of(&model.name, model.range[0], model.range[1]),
            plot: String::new(),
            effort: Effort::Screen,
        });
        let orbits = answer["curve"]["points"].as_u64();
        assert!(
            orbits.is_some_and(|orbits| orbits > 20),
            "{}: {answer}",
            model.name
        );
    }
}

#[test]
fn a_fault_of_a_declaration_has_its_place() {
    let text =
        "Spring(x) {\n    param k = 1 > 0;\n    ddot(x) + k*x = cos(omega*t) + q;\n}".to_owned();
    for ask in [
        Ask::Declaration { text: text.clone() },
        full(Asked {
            text,
            ..of("tip", 0.5, 1.5)
        }),
    ] {
        let fault = &last(&ask)["fault"];
        assert_eq!(fault["kind"], "declaration");
        let place = &fault["places"][0];
        assert_eq!(
            (place["line"].as_u64(), place["column"].as_u64()),
            (Some(3), Some(36))
        );
        assert!(
            place["message"]
                .as_str()
                .expect("a sentence")
                .contains("`q`")
        );
    }
}

#[test]
fn a_fault_of_a_value_names_its_field() {
    let base = of("one-sided", 0.6, 1.6);
    let zeta = Asked {
        values: [("zeta".to_owned(), -1.0)].into(),
        ..base.clone()
    };
    let empty = Asked {
        to: base.from,
        ..base.clone()
    };
    let period = Asked {
        period: 0,
        ..base.clone()
    };
    let without = Asked {
        text: "Free(x) { param mass > 0; mass*ddot(x) + 0.1*dot(x) + x = cos(omega*t); }"
            .to_owned(),
        ..base.clone()
    };
    let varied = Asked {
        varied: "mass".to_owned(),
        ..base
    };
    for (asked, field) in [
        (without, "mass"),
        (zeta, "zeta"),
        (empty, "to"),
        (period, "period"),
        (varied, "mass"),
    ] {
        let fault = last(&full(asked));
        let fault = &fault["fault"];
        let named = fault["field"] == field;
        let said = fault["message"]
            .as_str()
            .is_some_and(|text| text.contains(field));
        assert!(named || said, "{field}: {fault}");
    }
}

#[test]
fn contacts_that_open_or_have_a_corner_are_computed_by_the_contact_equation() {
    for (name, range, method) in [
        ("one-sided", [0.6, 1.6], "contact-equation"),
        ("tip", [0.994, 1.006], "contact-equation"),
        ("continuous", [0.6, 1.6], "balance"),
    ] {
        let answer = last(&full(of(name, range[0], range[1])));
        assert_eq!(answer["curve"]["method"], method, "{name}");
    }
}

/// At the frequency at which contact is lost the gap just touches: where the linear spring has it in closed form, peak-to-peak is twice the load.
#[test]
fn forces_and_gaps_are_those_of_the_law() {
    let asked = Asked {
        values: [("alpha".to_owned(), 1.0), ("zeta".to_owned(), 0.0)].into(),
        by: Method::Balance,
        ..of("one-sided", 0.2, 0.5)
    };
    let answer = last(&Ask::Orbits {
        of: asked,
        plot: String::new(),
        at: 0.4,
    });
    let orbit = &answer["orbits"]["orbits"][0];
    // Without a loss of contact x = W + A cos(omega t) / (1 - omega^2).
    let amplitude = 0.1 / (1.0 - 0.16);
    assert!((orbit["size"].as_f64().expect("a size") - 2.0 * amplitude).abs() < 1e-9);
    let contact = &orbit["contacts"][0];
    let numbers = |value: &Value| -> Vec<f64> {
        let all = value.as_array().expect("numbers").iter();
        all.map(|v| v.as_f64().expect("a number")).collect()
    };
    let (times, gaps, forces) = (
        numbers(&contact["times"]),
        numbers(&contact["gaps"]),
        numbers(&contact["forces"]),
    );
    for ((time, gap), force) in times.iter().zip(&gaps).zip(&forces) {
        assert!((gap - 1.0 - amplitude * (0.4 * time).cos()).abs() < 1e-9);
        assert!((gap - force).abs() < 1e-9);
    }
    assert_eq!(contact["closed"].as_array().expect("stretches").len(), 1);
    assert_eq!(numbers(&contact["surface"]), [0.0, 1.0, 0.0]);
}

/// One branch, several that cover a range, and what begins at bifurcations.
#[test]
fn the_exported_lines_are_a_program() {
    let one = Asked {
        varied: "drive".to_owned(),
        omega: 0.9,
        by: Method::Balance,
        ..of("cubic-with-stop", 0.01, 0.3)
    };
    let several = Asked {
        values: [("drive".to_owned(), 0.2)].into(),
        by: Method::ContactEquation,
        ..of("two-masses", 0.8, 1.2)
    };
    let followed = Asked {
        values: [("alpha".to_owned(), 1.0)].into(),
        depth: Some(1),
        varied: "drive".to_owned(),
        ..of("one-sided", 1.0, 1.6)
    };
    for (asked, lines) in [
        (one, include_str!("lines/one.rs")),
        (several, include_str!("lines/several.rs")),
        (followed, include_str!("lines/followed.rs")),
    ] {
        let answer = last(&Ask::Export {
            of: asked,
            plot: String::new(),
            scale: Scale::Linear,
            form: Form::Rust,
        });
        let ours = answer["export"]["contents"].as_str().expect("lines");
        assert_eq!(ours, lines);
    }
}

#[test]
fn the_macro_may_stand_around_the_declaration() {
    let bare = "Linear(x) { ddot(x) + 0.1*dot(x) + x = cos(omega*t); }";
    for text in [
        bare.to_owned(),
        format!("hertzian::oscillator! {{ {bare} }}"),
        format!("oscillator! {{ {bare} }}"),
        format!("// as oscillator! has it\n{bare}"),
    ] {
        let answer = last(&Ask::Export {
            of: Asked {
                text,
                depth: Some(1),
                ..of("tip", 0.5, 1.5)
            },
            plot: String::new(),
            scale: Scale::Linear,
            form: Form::Rust,
        });
        let lines = answer["export"]["contents"].as_str().expect("lines");
        let begins = lines
            .lines()
            .filter(|line| line.starts_with("hertzian::oscillator! {"));
        assert_eq!(begins.count(), 1, "{lines}");
        assert!(lines.contains("\n        .from(0.5)\n        .to(1.5)\n"));
        assert!(lines.contains("\n        .depth(1)\n"));
    }
}

#[test]
fn what_is_not_shown_is_said() {
    let text =
        "Chain(x[9]) { for j in 0..9 { ddot(x[j]) + 0.1*dot(x[j]) + x[j] = cos(omega*t); } }";
    let answer = last(&Ask::Orbits {
        of: Asked {
            text: text.to_owned(),
            ..of("tip", 0.5, 1.5)
        },
        plot: String::new(),
        at: 0.7,
    });
    let orbits = &answer["orbits"];
    assert_eq!(
        orbits["notes"][0], "the first 8 of 9 coordinates are shown",
        "{answer}"
    );
    assert_eq!(
        orbits["orbits"][0]["motions"].as_array().map(Vec::len),
        Some(8)
    );
}

/// Peak-to-peak of a linear oscillator in closed form, of a damping and a drive that the fit does not begin with.
#[test]
fn parameters_are_fitted_to_a_table() {
    let text = "Linear(x) { param zeta = 0.1 in 0.0..; param drive = 1; ddot(x) + 2*zeta*dot(x) + x = drive*cos(omega*t); }";
    let asked = Asked {
        text: text.to_owned(),
        ..of("tip", 0.5, 1.5)
    };
    let rows = (0..21).map(|step| {
        let omega = 0.5 + 0.05 * f64::from(step);
        let size = 2.0 * 0.7 / (1.0 - omega * omega).hypot(2.0 * 0.03 * omega);
        format!("{omega}, {size}\n")
    });
    let table = "omega, x:p2p\n".to_owned() + &rows.collect::<String>();
    let read = last(&Ask::Table {
        of: asked.clone(),
        table: table.clone(),
    });
    let set = &read["table"][0];
    assert_eq!(
        (set["plot"].as_str(), set["varied"].as_str()),
        (Some("x:p2p"), Some("omega"))
    );
    assert_eq!(set["places"].as_array().map(Vec::len), Some(21));
    let free = |names: &[&str]| {
        last(&Ask::Fit {
            of: asked.clone(),
            table: table.clone(),
            free: names.iter().map(ToString::to_string).collect(),
        })
    };
    let fitted = free(&["zeta", "drive"]);
    assert_eq!(fitted["fit"]["converged"], true, "{fitted}");
    for (estimate, (name, value)) in fitted["fit"]["values"]
        .as_array()
        .expect("values")
        .iter()
        .zip([("zeta", 0.03), ("drive", 0.7)])
    {
        assert_eq!(estimate[0], name);
        assert!(
            (estimate[1].as_f64().expect("a value") - value).abs() < 1e-5,
            "{fitted}"
        );
    }
    for (names, said) in [(&[][..], "no parameter is free"), (&["mass"], "mass")] {
        let fault = &free(names)["fault"];
        assert!(
            fault["message"]
                .as_str()
                .expect("a sentence")
                .contains(said),
            "{fault}"
        );
    }
    let fault = last(&Ask::Table {
        of: asked.clone(),
        table: "omega, y:p2p\n1, 2\n".to_owned(),
    });
    assert!(
        fault["fault"]["message"]
            .as_str()
            .expect("a sentence")
            .contains("line 1"),
        "{fault}"
    );
}

#[test]
fn a_newer_request_takes_the_place_of_an_older_one_of_the_same_page() {
    let work = Arc::new(Work::default());
    let all = Cancel::new();
    let request = |client: &str, at: f64| Request {
        client: client.to_owned(),
        number: 0,
        ask: full(of("one-sided", at, 1.6)),
    };
    let first = work.begin(&request("a", 0.6), &all);
    let other = work.begin(&request("b", 0.6), &all);
    let text = Request {
        client: "a".to_owned(),
        number: 0,
        ask: Ask::Declaration {
            text: String::new(),
        },
    };
    let text = work.begin(&text, &all);
    assert!(!first.cancel.is_cancelled());
    let second = work.begin(&request("a", 0.7), &all);
    assert!(first.cancel.is_cancelled());
    assert!(!second.cancel.is_cancelled() && !other.cancel.is_cancelled());
    assert!(!text.cancel.is_cancelled());
    // Where nobody waits any more, nothing goes on, and nothing is kept; the older one does not take the newer one along.
    let token = second.cancel.clone();
    drop(first);
    assert!(!token.is_cancelled());
    drop(second);
    assert!(token.is_cancelled());
    drop((other, text));
    assert_eq!(work.running(), 0);
}

#[test]
fn a_request_that_arrives_late_does_not_take_the_place_of_a_newer_one() {
    let work = Arc::new(Work::default());
    let request = |number| Request {
        client: "a".to_owned(),
        number,
        ask: full(of("one-sided", 0.6, 1.6)),
    };
    let newer = work.begin(&request(2), &Cancel::new());
    let late = work.begin(&request(1), &Cancel::new());
    assert!(late.cancel.is_cancelled() && !newer.cancel.is_cancelled());
    drop(late);
    let newest = work.begin(&request(3), &Cancel::new());
    assert!(newer.cancel.is_cancelled() && !newest.cancel.is_cancelled());
}

/// Shaft on eight balls: seconds of work, of which little is done once nobody wants it.
#[test]
fn cancelled_work_ends() {
    let cancel = Cancel::new();
    let token = cancel.clone();
    let begun = Instant::now();
    let thread = std::thread::spawn(move || {
        let ask = full(of("ball-bearing", 0.3, 0.65));
        answered(&Work::default(), &ask, &token)
    });
    std::thread::sleep(Duration::from_millis(100));
    cancel.cancel();
    let lines = thread.join().expect("an answer");
    assert_eq!(lines.last().expect("a line")["fault"]["kind"], "cancelled");
    assert!(begun.elapsed() < Duration::from_secs(3));
}

#[test]
fn what_takes_long_says_how_far_it_is() {
    let lines = answered(
        &Work::default(),
        &full(Asked {
            by: Method::Balance,
            ..of("ball-bearing", 0.3, 0.31)
        }),
        &Cancel::new(),
    );
    let (last, before) = lines.split_last().expect("lines");
    assert!(last["curve"].is_object(), "{last}");
    let said = before.iter().filter_map(|line| line["progress"].as_str());
    let said: Vec<&str> = said.collect();
    assert!(
        said.iter().all(|text| text.contains("omega = 0.3")),
        "{said:?}"
    );
    assert!(!said.is_empty());
}

/// On the screen a pixel is not seen to be wrong: folds are where they are to a pixel of some five hundred.
#[test]
fn what_moves_is_as_exact_as_the_screen() {
    for (name, range) in [("one-sided", [0.6, 1.6]), ("cubic-with-stop", [0.4, 2.2])] {
        let folds = |effort| -> Vec<[f64; 2]> {
            let answer = last(&Ask::Curve {
                of: of(name, range[0], range[1]),
                plot: String::new(),
                effort,
            });
            let events = answer["curve"]["events"]
                .as_array()
                .expect("events")
                .clone();
            let folds = events.iter().filter(|event| event["kind"] == "fold");
            folds
                .map(|fold| ["value", "size"].map(|key| fold[key].as_f64().expect("a number")))
                .collect()
        };
        let (coarse, exact) = (folds(Effort::Screen), folds(Effort::Full));
        assert_eq!(coarse.len(), exact.len(), "{name}");
        let highest = exact.iter().fold(0.0_f64, |m, fold| m.max(fold[1]));
        for (a, b) in coarse.iter().zip(&exact) {
            assert!(
                (a[0] - b[0]).abs() < 2e-3 * (range[1] - range[0]),
                "{name}: {a:?} {b:?}"
            );
            assert!((a[1] - b[1]).abs() < 4e-3 * highest, "{name}: {a:?} {b:?}");
        }
    }
}
