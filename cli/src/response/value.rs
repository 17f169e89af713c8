//! Values of what varies, with its unit.

use std::fmt::Display;

use hertzian::{Branch, bifurcation::Diagram};

/// As `618.149 rad/s`, of what a branch varies.
pub fn of_varied(branch: &Branch, value: impl Display) -> String {
    with(branch.model.unit_of_varied(&branch.varied), value)
}

/// The same of a diagram, by a branch of it: one without has no unit.
pub fn in_diagram(diagram: &Diagram, value: impl Display) -> String {
    let first = diagram.branches.first();
    first.map_or_else(
        || value.to_string(),
        |first| of_varied(&first.branch, &value),
    )
}

/// A value with a unit, if there is one.
pub fn with(unit: &str, value: impl Display) -> String {
    if unit.is_empty() {
        value.to_string()
    } else {
        format!("{value} {unit}")
    }
}
