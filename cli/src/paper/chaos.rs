//! Figures 8b, 9b, 10 and 11: what motions settle to. They are what `hertzian attractors` draws for them; here they are compared.

use clap::Parser;

use super::exact;
use super::figure::{Drawing, Table, Task, Value};
use crate::attractors::options::Options;
use crate::attractors::output::Results;
use crate::attractors::{figures, run};
use crate::response::progress::Progress;

/// What a command of `hertzian attractors` gives.
fn attractors(task: &Task<'_>, arguments: &str) -> Result<Results, String> {
    let words = arguments.split_whitespace().map(Into::into);
    let command = figures::expanded(std::iter::once("attractors".into()).chain(words));
    let options = Options::try_parse_from(command).map_err(|error| error.to_string())?;
    let found = run::compute(&options, task.cancel, &mut Progress::hidden());
    found.map_err(|error| error.to_string())
}

fn drawing(results: Results, values: Vec<Value>) -> Drawing {
    let note = if results.complete {
        String::new()
    } else {
        "The computation was ended early.".to_owned()
    };
    Drawing {
        svg: results.svg,
        data: Table {
            names: results.names,
            rows: results.rows,
        },
        values,
        note,
    }
}

/// Bifurcation diagram of the stroboscopic map.
///
/// # Errors
/// If a motion cannot be computed.
pub fn figure_8b(task: &Task<'_>) -> Result<Drawing, String> {
    Ok(drawing(attractors(task, "--figure 8b")?, Vec::new()))
}

/// Coexisting orbits.
///
/// # Errors
/// If a motion cannot be computed.
pub fn figure_9b(task: &Task<'_>) -> Result<Drawing, String> {
    let results = attractors(task, "--figure 9b")?;
    let mut values = Vec::new();
    for (period, exact, _) in exact::COEXISTING {
        let of_period = |row: &&Vec<String>| number(row, 2) == Some(period as f64);
        let points = results.rows.iter().filter(of_period);
        let places = points.filter_map(|row| number(row, 4));
        let nearest = places.min_by(|a, b| (a - exact).abs().total_cmp(&(b - exact).abs()));
        let what = format!("period {period}: x at phase zero");
        values.push(match nearest {
            Some(x) => Value::of(what, x).exact(Some(exact)),
            None => Value::missing(what, exact),
        });
    }
    Ok(drawing(results, values))
}

/// Intermittency of type I.
///
/// # Errors
/// If a motion cannot be computed.
pub fn figure_10a(task: &Task<'_>) -> Result<Drawing, String> {
    history(task, "10a", exact::LYAPUNOV[0])
}

/// Intermittency that a crisis brings.
///
/// # Errors
/// If a motion cannot be computed.
pub fn figure_10b(task: &Task<'_>) -> Result<Drawing, String> {
    history(task, "10b", exact::LYAPUNOV[1])
}

/// A time history, and the Lyapunov exponent of the same motion.
fn history(task: &Task<'_>, name: &str, known: exact::Exponent) -> Result<Drawing, String> {
    let exact::Exponent {
        drive,
        value: exact,
        error: uncertain,
    } = known;
    let results = attractors(task, &format!("--figure {name}"))?;
    let long = format!("--lyapunov --alpha 1 --drive {drive} --start -0.35 0.335");
    let exponents = attractors(task, &long)?;
    let row = exponents.rows.first().ok_or("no exponent was computed")?;
    let (Some(value), Some(error)) = (number(row, 2), number(row, 3)) else {
        return Err("no exponent was computed".to_owned());
    };
    let what = "largest Lyapunov exponent per period, with its standard error";
    let value = Value::of(what, value).stated(error).exact(Some(exact));
    let value = value.uncertain(uncertain);
    let mut drawing = drawing(results, vec![value]);
    drawing.note = format!(
        "{} The exponent to compare with is itself a mean over a long motion, with a standard error of {uncertain}.",
        drawing.note
    );
    Ok(drawing)
}

/// Phase portraits before, at and after both changes.
///
/// # Errors
/// If a motion cannot be computed.
pub fn figure_11(task: &Task<'_>) -> Result<Drawing, String> {
    Ok(drawing(attractors(task, "--figure 11")?, Vec::new()))
}

fn number(row: &[String], column: usize) -> Option<f64> {
    row.get(column)?.parse().ok()
}
