//! A curve as files, the same that `hertzian response` writes, and as lines of Rust.

use hertzian::export;
use hertzian::{Branch, Cancel, Point, System};
use serde::{Deserialize, Serialize};

use super::curve::wanted;
use super::declared::Texts;
use super::fault::{Fault, Kind};
use super::lines;
use super::traced::Traced;
use crate::look::ScaleName;
use crate::response::backbone::Backbone;
use crate::response::files::{self, Record};
use crate::response::run;

/// A form.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Form {
    /// The library's picture.
    Svg,
    /// One row per orbit.
    Csv,
    /// Everything.
    Json,
    /// The lines that make this curve.
    Rust,
}

/// The scale of the vertical axis.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Scale {
    /// Evenly.
    #[default]
    Linear,
    /// By the logarithm.
    Log,
    /// The same in decibels.
    Db,
}

/// A file.
#[derive(Debug, Clone, PartialEq, Eq, Serialize)]
pub struct File {
    /// Its name.
    pub name: &'static str,
    /// What is in it.
    pub contents: String,
}

/// The branches in a form.
///
/// # Errors
/// If it cannot be drawn or written.
pub fn of(
    traced: &Traced,
    form: Form,
    plot: &str,
    scale: Scale,
    texts: &Texts,
    cancel: &Cancel,
) -> Result<File, Fault> {
    let (name, contents) = match form {
        Form::Svg => ("response.svg", picture(traced, plot, scale, cancel)?),
        Form::Csv => (
            "response.csv",
            files::table(&*traced.model, &traced.written(cancel)?).to_csv(),
        ),
        Form::Json => ("response.json", json(traced, &traced.written(cancel)?)?),
        Form::Rust => ("main.rs", rust(traced, texts)?),
    };
    Ok(File { name, contents })
}

fn picture(traced: &Traced, plot: &str, scale: Scale, cancel: &Cancel) -> Result<String, Fault> {
    let mut options = traced.options.clone();
    let first = traced.branches().next();
    let leads = first.is_some_and(|branch| branch.leading().to_string() == plot);
    if let Some(branch) = first.filter(|_| !leads && !plot.is_empty()) {
        options.plot = vec![wanted(plot, branch)?];
    }
    options.look.scale = match scale {
        // Of what was followed sizes may be very different, and the usual scale depends on that.
        Scale::Linear if traced.followed.is_some() => Some(ScaleName::Linear),
        Scale::Linear => None,
        Scale::Log => Some(ScaleName::Log),
        Scale::Db => Some(ScaleName::Db),
    };
    let views = options.views();
    let charts = views
        .iter()
        .map(|view| match &traced.followed {
            Some((_, found)) => found.chart(&options, &*traced.model, view),
            None => run::picture(&options, &traced.diagram, &*traced.model, view, cancel),
        })
        .collect::<Result<Vec<_>, _>>()?;
    Ok(files::page(charts))
}

fn json(traced: &Traced, branches: &[Branch]) -> Result<String, Fault> {
    let none: [Point; 0] = [];
    let record = Record {
        version: export::JSON_VERSION,
        branches,
        searched: &traced.diagram.searched,
        uncovered: &traced.diagram.uncovered,
        at: &none,
        tracks: &[],
        backbone: &Backbone::default(),
        reduction: None,
    };
    let unwritten =
        |error: &dyn std::fmt::Display| Fault::new(Kind::Computation, error.to_string());
    let bytes = files::json(&record).map_err(|error| unwritten(&error))?;
    String::from_utf8(bytes).map_err(|error| unwritten(&error))
}

/// The lines, with the declaration as it was written: a compiled model may have its exponent in the force.
fn rust(traced: &Traced, texts: &Texts) -> Result<String, Fault> {
    let asked = &traced.asked;
    let mut declaration = texts.parse(&asked.text)?;
    for (name, value) in &asked.values {
        declaration.set(name, *value)?;
    }
    if asked.varied != "omega" {
        declaration.set(&asked.varied, asked.from)?;
    }
    let mut values = vec![0.0; declaration.facts().parameters.len()];
    declaration.values(&mut values);
    let by = traced.by();
    let several = traced.diagram.branches.len() > 1;
    Ok(lines::of(asked, &declaration, &values, by, several))
}
