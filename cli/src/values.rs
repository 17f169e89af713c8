//! What the numbers of a command line must be, in one place for all programs, so that none of them is found wrong after the work.

use std::ops::RangeInclusive;

/// More threads than this gain nothing, and starting them takes longer than the work.
pub const MOST_THREADS: usize = 1024;
/// More rows of a table would not fit into memory well.
pub const MOST_ROWS: usize = 10_000_000;

/// A number is neither infinite nor NaN.
///
/// # Errors
/// Which option is at fault, and what it must be; so of all that follows.
pub fn finite(option: &str, value: f64) -> Result<(), String> {
    require(value.is_finite(), option, value, "finite")
}

/// A number is more than zero, and finite.
///
/// # Errors
/// If it is not.
pub fn positive(option: &str, value: f64) -> Result<(), String> {
    let is_positive = value > 0.0 && value.is_finite();
    require(is_positive, option, value, "positive and finite")
}

/// The ends of a range are finite, and the lower one comes first.
///
/// # Errors
/// If they are not.
pub fn interval(option: &str, ends: &[f64]) -> Result<(), String> {
    let &[low, high] = ends else {
        return Err(format!("{option} needs two values, the lower one first"));
    };
    finite(option, low)?;
    finite(option, high)?;
    if low < high {
        return Ok(());
    }
    Err(format!(
        "{option}: the range from {low} to {high} is empty; the lower end comes first"
    ))
}

/// A number of things is in its range.
///
/// # Errors
/// If it is not.
pub fn counted(option: &str, count: usize, range: RangeInclusive<usize>) -> Result<(), String> {
    if range.contains(&count) {
        return Ok(());
    }
    let (least, most) = range.into_inner();
    Err(format!("{option} {count}: must be from {least} to {most}"))
}

/// No name is given twice: one of the values would be ignored.
///
/// # Errors
/// If one is.
pub fn once<'n>(option: &str, names: impl Iterator<Item = &'n str>) -> Result<(), String> {
    let mut seen = Vec::new();
    for name in names {
        if seen.contains(&name) {
            return Err(format!("{option} names {name} more than once"));
        }
        seen.push(name);
    }
    Ok(())
}

fn require(holds: bool, option: &str, value: f64, must: &str) -> Result<(), String> {
    if holds {
        Ok(())
    } else {
        Err(format!("{option} {value}: must be {must}"))
    }
}
