//! Names with units, as axes and the headers of tables have them.

/// A name with its unit in brackets, if it has one.
pub(crate) fn in_unit(name: &str, unit: &str) -> String {
    if unit.is_empty() {
        name.to_owned()
    } else {
        format!("{name} [{unit}]")
    }
}

/// A number with its unit, if it has one.
pub(crate) fn with(number: &str, unit: &str) -> String {
    if unit.is_empty() {
        number.to_owned()
    } else {
        format!("{number} {unit}")
    }
}
