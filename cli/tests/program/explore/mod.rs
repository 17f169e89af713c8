//! The subcommand `explore`: what its page is told, and what its server refuses. The page itself is driven by `cli/tests/explore/drive.mjs`.

mod answers;
mod fuzzed;
#[allow(
    dead_code,
    reason = "it is compared with what is exported, and compiled"
)]
mod lines {
    mod followed;
    mod one;
    mod several;
}
mod numbers;
mod server;

use std::sync::{Arc, Mutex};

use hertzian::Cancel;
use hertzian_cli::built_in::MODELS;
use hertzian_cli::explore::asked::{Asked, Method};
use hertzian_cli::explore::work::{Ask, Emit, Work};
use serde_json::Value;

/// A curve of a model with a name, over the frequency.
fn of(name: &str, from: f64, to: f64) -> Asked {
    let model = MODELS.iter().find(|model| model.name == name);
    Asked {
        text: model.expect("a model").text.to_owned(),
        values: std::collections::BTreeMap::new(),
        varied: "omega".to_owned(),
        from,
        to,
        omega: 1.0,
        period: 1,
        by: Method::Automatic,
        depth: None,
    }
}

/// The lines of an answer.
fn answered(work: &Work, ask: &Ask, cancel: &Cancel) -> Vec<Value> {
    let lines = Arc::new(Mutex::new(Vec::new()));
    let emit: Emit = {
        let lines = Arc::clone(&lines);
        Arc::new(move |line| lines.lock().expect("lines").push(line))
    };
    work.answer(ask, cancel, &emit);
    drop(emit);
    std::mem::take(&mut *lines.lock().expect("lines"))
}

/// The last line of an answer, which nothing cancels.
fn last(ask: &Ask) -> Value {
    let mut lines = answered(&Work::default(), ask, &Cancel::new());
    lines.pop().expect("a line")
}
