//! Angles that are the same after a turn.

use std::f64::consts::TAU;

/// The angle that differs from this one by turns and is nearest to another.
pub(crate) fn near(angle: f64, other: f64) -> f64 {
    angle - TAU * ((angle - other) / TAU).round()
}
