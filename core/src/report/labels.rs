//! What charts say of a branch: the system with its parameters, and what is at the axes.

use crate::branches::branch::{Branch, Model};
use crate::numeric::decimal::Decimal;

/// Title and axes.
#[derive(Debug, Clone, PartialEq, Default)]
pub(crate) struct Labels {
    /// The system, and everything that is the same all along the branch.
    pub title: String,
    /// What is varied: a parameter by its name and the first line of its documentation.
    pub varied: String,
    /// The size of an orbit, by its first coordinate.
    pub size: String,
}

impl Labels {
    /// Of a branch.
    pub(crate) fn of(branch: &Branch) -> Self {
        let (model, varied) = (&branch.model, &branch.varied);
        let labels = Self {
            title: model.name.clone(),
            varied: name_of(model, varied),
            size: model
                .coordinates
                .first()
                .map_or_else(String::new, |name| format!("peak-to-peak of {name}")),
        };
        let Some(point) = branch.points.first() else {
            return labels;
        };
        let known = model.parameters.iter().zip(&point.parameters);
        let held = known.filter(|(parameter, _)| parameter.name != *varied);
        let values = held
            .map(|(parameter, value)| format!("{} = {}", parameter.name, Decimal::plain(*value)));
        let omega =
            (varied != "omega").then(|| format!("omega = {}", Decimal::plain(point.omega())));
        let omega = omega.filter(|_| !model.parameters.is_empty());
        values
            .chain(omega)
            .fold(labels, |labels, value| labels.with(&value))
    }

    /// With one more value in the title.
    fn with(mut self, value: &str) -> Self {
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

/// A parameter by its name and the first line of its documentation.
fn name_of(model: &Model, varied: &str) -> String {
    if varied == "omega" {
        return "excitation frequency ω".to_owned();
    }
    let parameter = model.parameters.iter().find(|p| p.name == varied);
    let documentation = parameter.and_then(|p| p.documentation.lines().next());
    match documentation.map(str::trim).filter(|line| !line.is_empty()) {
        Some(line) => format!("{varied} ({line})"),
        None => varied.to_owned(),
    }
}
