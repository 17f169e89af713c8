//! The models to begin with.

use std::path::Path;

use serde::Serialize;

use super::fault::Fault;
use super::options::Options;
use crate::built_in::{BuiltIn, MODELS};
use crate::response::model_file;

/// The range over which examples show a model, by its name.
const RANGES: &[(&str, [f64; 2])] = &[
    ("one-sided", [0.6, 1.6]),
    ("continuous", [0.6, 1.6]),
    ("cubic-with-stop", [0.4, 2.2]),
    ("gear-pair", [0.4, 1.6]),
    ("gear-mesh", [8e3, 4e4]),
    ("two-masses", [0.8, 1.7]),
    ("preloaded-stop", [0.7, 1.4]),
    ("ball-bearing", [0.3, 0.65]),
    ("tip", [0.994, 1.006]),
    ("bolted-joint", [1500.0, 4500.0]),
    ("cantilever", [300.0, 900.0]),
];

/// Where nothing else is known, as of `hertzian response`.
const RANGE: [f64; 2] = [0.6, 1.6];

/// A model that the page offers.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Offered {
    /// Its name, or that of its file.
    pub name: String,
    /// What it is, in a line.
    pub described: String,
    /// Its declaration.
    pub text: String,
    /// The range of the frequency to begin with.
    pub range: [f64; 2],
    /// Values of parameters to begin with.
    pub values: Vec<(String, f64)>,
}

/// All models with a name; the one of the command line first.
///
/// # Errors
/// If that cannot be read.
pub fn offered(options: &Options) -> Result<Vec<Offered>, Fault> {
    let named = BuiltIn::named(&options.model);
    let text = model_file::text(&options.model);
    let text = text.map_err(|error| {
        let error = model_file::ModelError::Unreadable(error);
        Fault::request(error.describe(&options.model))
    })?;
    let known = range_of(&options.model);
    let first = Offered {
        name: options.model.display().to_string(),
        described: named.map_or_else(String::new, |model| model.described().to_owned()),
        text,
        range: [
            options.from.unwrap_or(known[0]),
            options.to.unwrap_or(known[1]),
        ],
        values: options.set.clone(),
    };
    let others = MODELS.iter().filter(|model| Some(*model) != named);
    let others = others.map(|model| Offered {
        name: model.name.to_owned(),
        described: model.described().to_owned(),
        text: model.text.to_owned(),
        range: range_of(Path::new(model.name)),
        values: Vec::new(),
    });
    Ok(std::iter::once(first).chain(others).collect())
}

fn range_of(name: &Path) -> [f64; 2] {
    let mut ranges = RANGES.iter();
    let known = ranges.find(|(known, _)| Path::new(known) == name);
    known.map_or(RANGE, |(_, range)| *range)
}
