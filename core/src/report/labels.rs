//! What charts say of a branch: the system with its parameters, and what is at the axes.

use crate::branches::branch::{Branch, Model};
use crate::report::prefix::with_unit;
use crate::report::unit::in_unit;
use crate::report::view::{Frequency, Seen};

/// Title and axes.
#[derive(Debug, Clone, PartialEq, Default)]
pub(crate) struct Labels {
    /// The system, and everything that is the same all along the branch.
    pub title: String,
    /// What is varied: a parameter by its name and the first line of its documentation.
    pub varied: String,
    /// What is measured of an orbit.
    pub size: String,
}

impl Labels {
    /// Of a branch.
    pub(crate) fn of(seen: &Seen<'_>) -> Self {
        let branch = seen.branch;
        let (model, varied) = (&branch.model, &branch.varied);
        let labels = Self {
            title: model.name.clone(),
            varied: name_of(model, varied, seen.frequency),
            size: seen.label(),
        };
        held(branch)
            .iter()
            .fold(labels, |labels, held| labels.with(&held.text()))
    }

    /// The same axes, and a title of a name and of values.
    pub(crate) fn titled(
        seen: &Seen<'_>,
        name: String,
        values: impl Iterator<Item = String>,
    ) -> Self {
        let labels = Self {
            title: name,
            varied: name_of(&seen.branch.model, &seen.branch.varied, seen.frequency),
            size: seen.label(),
        };
        values.fold(labels, |labels, value| labels.with(&value))
    }

    /// With one more value in the title.
    pub(crate) fn with(mut self, value: &str) -> Self {
        let first = !self.title.contains(": ");
        self.title += if first { ": " } else { ", " };
        self.title += value;
        self
    }

    /// Of orbits of this period.
    pub(crate) fn with_period(self, period: usize) -> Self {
        if period > 1 {
            self.with(&format!("period {period}"))
        } else {
            self
        }
    }
}

/// What is the same all along a branch.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Held {
    pub(crate) name: String,
    /// As titles have it.
    symbol: String,
    pub(crate) value: f64,
    unit: String,
}

impl Held {
    /// With its unit, and a prefix where that reads better.
    pub(crate) fn text(&self) -> String {
        format!("{} = {}", self.symbol, with_unit(self.value, &self.unit))
    }
}

/// Parameters of a branch that it does not vary, and the frequency where it is another one than a parameter; nothing without orbits.
pub(crate) fn held(branch: &Branch) -> Vec<Held> {
    let (model, varied) = (&branch.model, &branch.varied);
    let Some(point) = branch.points.first() else {
        return Vec::new();
    };
    let known = model.parameters.iter().zip(&point.parameters);
    let others = known.filter(|(parameter, _)| parameter.name != *varied);
    let mut held: Vec<Held> = others
        .map(|(parameter, value)| Held {
            name: parameter.name.clone(),
            symbol: parameter.name.clone(),
            value: *value,
            unit: parameter.unit.clone(),
        })
        .collect();
    if varied != "omega" && !model.parameters.is_empty() {
        let unit = if model.units.is_empty() { "" } else { "rad/s" };
        held.push(Held {
            name: "omega".to_owned(),
            symbol: "ω".to_owned(),
            value: point.omega(),
            unit: unit.to_owned(),
        });
    }
    held
}

/// A parameter by its name and the first line of its documentation.
pub(crate) fn name_of(model: &Model, varied: &str, frequency: Frequency) -> String {
    if varied == "omega" {
        return frequency.label(!model.units.is_empty());
    }
    let parameter = model.parameters.iter().find(|p| p.name == varied);
    let documentation = parameter.and_then(|p| p.documentation.lines().next());
    let name = match documentation.map(str::trim).filter(|line| !line.is_empty()) {
        Some(line) => format!("{varied} ({line})"),
        None => varied.to_owned(),
    };
    in_unit(&name, parameter.map_or("", |parameter| &parameter.unit))
}
