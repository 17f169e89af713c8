//! A map over two parameters: what the rows say, as the runtime draws it.

use std::io;

use hertzian::System;
use hertzian::bifurcation::{Cell, Map, Reason};
use hertzian::chart::Chart;
use serde_json::{Value as Json, json};

use super::{is, number, place};
use crate::merge::Source;
use crate::plan::Picture;
use crate::study::Prepared;
use crate::table::Value;

/// Where the columns are that cells are read from.
struct Columns {
    counted: [usize; 6],
    row: usize,
    value: usize,
    largest: usize,
    periods: usize,
    signal: usize,
    ended: usize,
}

impl Columns {
    fn of(study: &Prepared) -> Self {
        let place = |name: &str| place(study, name);
        Self {
            counted: Cell::COUNTED.map(place),
            row: place("row"),
            value: place("value"),
            largest: place("largest"),
            periods: place("periods"),
            signal: place("signal"),
            ended: place("ended"),
        }
    }

    /// The cell of a row, in the form that it is read from.
    fn cell(&self, row: &[Value]) -> Json {
        if is(row, self.row, "failed") {
            let says = row.get(self.ended).map(Value::written).unwrap_or_default();
            return without(&json!({
                "failed": { "kind": "no-orbit", "says": says, "shows": says }
            }));
        }
        let mut cell = without(&Json::Null);
        for (name, place) in Cell::COUNTED.into_iter().zip(self.counted) {
            cell[name] = json!(number(row, place).unwrap_or_default() as u64);
        }
        cell["largest"] = json!(number(row, self.largest));
        if let Some(Value::Text(text)) = row.get(self.periods) {
            let periods = text
                .split(' ')
                .filter_map(|period| period.parse::<usize>().ok());
            cell["periods"] = json!(periods.collect::<Vec<_>>());
        }
        cell
    }
}

/// A cell of which nothing is known, for a reason, in the form that it is read from.
fn without(reason: &Json) -> Json {
    json!({
        "stable": 0, "unstable": 0, "undecided": 0, "missed": 0, "motions": 0, "restless": 0,
        "largest": null, "periods": [], "reason": reason
    })
}

/// The map of a study of solutions over a grid of one parameter.
///
/// # Errors
/// If the rows cannot be read.
pub(super) fn map(source: &Source<'_>) -> io::Result<Map> {
    let study = source.study;
    let (name, side) = study.designed.side().unwrap_or_default();
    let columns = study.at.len();
    let of = Columns::of(study);
    let mut cells = vec![without(&json!(Reason::Interrupted)); columns * side.len()];
    let mut signal = String::new();
    source.each(|row| {
        let variant = number(&row, 0).unwrap_or_default() as usize;
        if let (Some(Value::Text(found)), true) = (row.get(of.signal), signal.is_empty()) {
            signal.clone_from(found);
        }
        // Without a value, the whole variant failed.
        let value = number(&row, of.value);
        let here = cells
            .iter_mut()
            .skip(variant * columns)
            .take(columns)
            .zip(&study.at);
        for (cell, _) in here.filter(|(_, at)| value.is_none_or(|value| value == **at)) {
            *cell = of.cell(&row);
        }
        Ok(())
    })?;
    let (system, omega) = study.variant(0);
    let mut parameters = vec![0.0; system.facts().parameters.len()];
    system.values(&mut parameters);
    let map = json!({
        "model": hertzian::Model::of(&system),
        "names": [study.plan.request.vary, name],
        "values": [study.at, side],
        "parameters": parameters,
        "omega": omega.filter(|_| name != "omega"),
        "signal": signal,
        "cells": cells,
        "branches": vec![0; side.len()],
        "lost": vec![0; side.len()],
        "elapsed": 0.0,
    });
    serde_json::from_value(map).map_err(io::Error::other)
}

/// What is asked for of it.
pub(super) fn chart(map: &Map, picture: &Picture) -> Chart {
    match picture.of.as_deref() {
        Some("largest") => map.chart_of_largest(),
        Some("verdict") => map.chart_of_verdicts(),
        _ => map.chart_of_stable(),
    }
}
