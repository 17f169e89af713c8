//! Results through serde, with feature `serde`: how what is no plain number or list is written.
//!
//! Complex numbers are pairs of real and imaginary part, times are seconds, and what has a name is that name, as it is printed.

use std::fmt::Display;
use std::time::Duration;

use nalgebra::Complex;
use serde::Serializer;

/// Complex numbers as pairs.
pub(crate) fn pairs<S: Serializer>(
    numbers: &[Complex<f64>],
    serializer: S,
) -> Result<S::Ok, S::Error> {
    serializer.collect_seq(numbers.iter().map(|number| [number.re, number.im]))
}

/// A time in seconds.
pub(crate) fn seconds<S: Serializer>(time: &Duration, serializer: S) -> Result<S::Ok, S::Error> {
    serializer.serialize_f64(time.as_secs_f64())
}

/// What is printed.
pub(crate) fn text<S: Serializer>(value: &impl Display, serializer: S) -> Result<S::Ok, S::Error> {
    serializer.collect_str(value)
}
