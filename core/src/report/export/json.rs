//! Results through serde, with feature `serde`: how what is no plain number or list is written.
//!
//! Complex numbers are pairs of real and imaginary part, times are seconds, and what has a name is that name, as it is printed.

use std::fmt::Display;
use std::time::Duration;

use nalgebra::Complex;
use serde::{Serialize, Serializer};

use crate::attractors::sweep::Ended;
use crate::branches::branch::EventKind;
use crate::continuation::follow::Stop;
use crate::orbit::stability::{Method, Verdict};
use crate::shooting::{End, SpecialKind, TrackEnd};

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

macro_rules! as_text {
    ($($name:ty),*) => {$(
        impl Serialize for $name {
            fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
                text(self, serializer)
            }
        }
    )*};
}

as_text!(
    EventKind,
    Stop,
    End,
    SpecialKind,
    TrackEnd,
    Ended,
    Method,
    Verdict
);
