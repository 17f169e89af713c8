//! No request makes the program panic, and each has one answer: random bytes, requests with parts that were changed, texts in which pieces are missing.

use std::time::Duration;

use hertzian::Cancel;
use hertzian_cli::built_in::MODELS;
use hertzian_cli::explore::asked::{Asked, Effort, Method};
use hertzian_cli::explore::exported::{Form, Scale};
use hertzian_cli::explore::work::{Ask, Request, Work};
use proptest::prelude::*;

use super::answered;

fn number() -> impl Strategy<Value = f64> {
    prop_oneof![
        3 => 0.1..2.0_f64,
        1 => prop::num::f64::NORMAL | prop::num::f64::ZERO | prop::num::f64::SUBNORMAL,
        1 => prop::sample::select(vec![0.0, -0.0, 1.0, -1.0, 1e308, -1e308, 5e-324, 1e-12, 1e12]),
    ]
}

fn name() -> impl Strategy<Value = String> {
    prop_oneof![
        4 => prop::sample::select(vec!["omega", "zeta", "drive", "load", "alpha", "stop", "distance"])
            .prop_map(str::to_owned),
        1 => ".{0,12}",
    ]
}

/// A declaration from which a piece was taken, and into which another was put.
fn text() -> impl Strategy<Value = String> {
    let models: Vec<&str> = MODELS.iter().map(|model| model.text).collect();
    let whole = prop::sample::select(models);
    let changed = (
        whole.clone(),
        any::<prop::sample::Index>(),
        0_usize..12,
        ".{0,6}",
    )
        .prop_map(|(text, at, length, put)| {
            let letters: Vec<char> = text.chars().collect();
            let at = at.index(letters.len());
            let behind = letters.iter().skip(at + length);
            letters[..at]
                .iter()
                .copied()
                .chain(put.chars())
                .chain(behind.copied())
                .collect()
        });
    prop_oneof![2 => whole.prop_map(str::to_owned), 2 => changed, 1 => ".{0,60}"]
}

fn asked() -> impl Strategy<Value = Asked> {
    let method = prop::sample::select(vec![
        Method::Automatic,
        Method::Balance,
        Method::Shooting,
        Method::ContactEquation,
    ]);
    let values = prop::collection::btree_map(name(), number(), 0..4);
    let depth = prop::option::weighted(0.1, 0_usize..3);
    let period = prop_oneof![8 => Just(1), 1 => 0_usize..5, 1 => any::<usize>()];
    let numbers = (number(), number(), number());
    (text(), values, name(), numbers, period, method, depth).prop_map(
        |(text, values, varied, (from, to, omega), period, by, depth)| Asked {
            text,
            values,
            varied,
            from,
            to,
            omega,
            period,
            by,
            depth,
        },
    )
}

/// A table of measured values, or what is none.
fn table() -> impl Strategy<Value = String> {
    let header = prop::sample::select(vec![
        "omega, x:p2p",
        "frequency [Hz]; x:h1; sd",
        "load, contact:max, sweep",
        "omega",
        "",
    ]);
    let rows = prop::collection::vec((number(), number()), 0..8);
    prop_oneof![
        3 => (header, rows).prop_map(|(header, rows)| {
            let rows = rows.iter().map(|(place, value)| format!("\n{place}, {value}"));
            header.to_owned() + &rows.collect::<String>()
        }),
        1 => ".{0,40}",
    ]
}

fn ask() -> impl Strategy<Value = Ask> {
    let plot = || {
        prop_oneof![
            3 => Just(String::new()),
            2 => prop::sample::select(vec!["x:p2p", "x:h3", "x:phase1", "contact:max", "contact:piece9", "x:crest", ":", "x:h0"])
                .prop_map(str::to_owned),
            1 => ".{0,8}",
        ]
    };
    let effort = prop::sample::select(vec![Effort::Screen, Effort::Full]);
    let form = prop::sample::select(vec![Form::Svg, Form::Csv, Form::Json, Form::Rust]);
    let scale = prop::sample::select(vec![Scale::Linear, Scale::Log, Scale::Db]);
    prop_oneof![
        text().prop_map(|text| Ask::Declaration { text }),
        (asked(), plot(), effort).prop_map(|(of, plot, effort)| Ask::Curve { of, plot, effort }),
        (asked(), table()).prop_map(|(of, table)| Ask::Table { of, table }),
        (asked(), table(), prop::collection::vec(name(), 0..3))
            .prop_map(|(of, table, free)| Ask::Fit { of, table, free }),
        (asked(), plot(), number()).prop_map(|(of, plot, at)| Ask::Orbits { of, plot, at }),
        (asked(), plot(), scale, form).prop_map(|(of, plot, scale, form)| Ask::Export {
            of,
            plot,
            scale,
            form
        }),
    ]
}

/// More with `HERTZIAN_REQUESTS`.
fn cases(usual: u32) -> ProptestConfig {
    let more = std::env::var("HERTZIAN_REQUESTS").ok();
    let more = more.and_then(|count| count.parse().ok());
    ProptestConfig {
        failure_persistence: None,
        ..ProptestConfig::with_cases(more.unwrap_or(usual))
    }
}

proptest! {
    #![proptest_config(cases(60))]

    #[test]
    fn every_request_has_one_answer(ask in ask()) {
        let cancel = Cancel::new();
        let token = cancel.clone();
        let (done, waits) = std::sync::mpsc::channel::<()>();
        // Nobody waits long.
        let timer = std::thread::spawn(move || {
            let _ = waits.recv_timeout(Duration::from_millis(60));
            token.cancel();
        });
        // As the server hands it over: written, read, with a stack that has room.
        let request = Request { client: "fuzz".to_owned(), number: 0, ask };
        let written = serde_json::to_vec(&request).expect("JSON");
        let read = Request::read(&written).expect("a request");
        prop_assert_eq!(&read, &request);
        let thread = std::thread::Builder::new().stack_size(1 << 24);
        let lines = thread.spawn(move || answered(&Work::default(), &read.ask, &cancel));
        let lines = lines.expect("a thread").join().expect("no panic");
        drop(done);
        timer.join().expect("a timer");
        let (last, before) = lines.split_last().expect("a line");
        let is_answer = |line: &serde_json::Value| {
            ["declaration", "curve", "orbits", "export", "table", "fit", "fault"].iter().any(|key| !line[*key].is_null())
        };
        prop_assert!(is_answer(last));
        prop_assert!(before.iter().all(|line| line["fault"].is_null()));
        let said = last["fault"]["message"].as_str().unwrap_or_default();
        prop_assert!(!said.contains("the program has a mistake"), "{}", said);
    }
}

proptest! {
    #![proptest_config(cases(400))]

    #[test]
    fn bytes_that_are_no_request_are_refused(bytes in prop::collection::vec(any::<u8>(), 0..200)) {
        prop_assert!(Request::read(&bytes).is_err());
    }

    #[test]
    fn a_request_with_other_bytes_is_read_or_refused(at in any::<prop::sample::Index>(), byte in any::<u8>()) {
        let ask = Ask::Declaration { text: MODELS[0].text.to_owned() };
        let request = Request { client: "fuzz".to_owned(), number: 0, ask };
        let mut bytes = serde_json::to_vec(&request).expect("JSON");
        let at = at.index(bytes.len());
        bytes[at] = byte;
        let _ = Request::read(&bytes);
    }
}
