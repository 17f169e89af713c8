//! The length of the next step.
//!
//! Source: Allgower and Georg (1990), Introduction to Numerical Continuation Methods, chapter 6: the angle between
//! tangents and the distance of the predictor from the curve are held near wanted values.

use crate::error::Error;
use crate::model::validate::option;

/// Bounds and wishes of the step control, in units of arc length.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct StepControl {
    pub(crate) initial: f64,
    pub(crate) smallest: f64,
    pub(crate) largest: f64,
    /// Part of the range that the parameter may change by.
    pub(crate) range: f64,
    /// Angle between successive tangents that is aimed at.
    pub(crate) angle: f64,
    /// Distance of the predictor from the curve that is aimed at.
    pub(crate) distance: f64,
}

impl Default for StepControl {
    fn default() -> Self {
        Self {
            initial: 0.01,
            smallest: 1e-9,
            largest: 0.1,
            range: 0.015,
            angle: 0.2,
            distance: 0.003,
        }
    }
}

impl StepControl {
    /// The default with another largest step, and what follows from it.
    pub(crate) fn with_largest(largest: f64) -> Self {
        let default = Self::default();
        let range = default.range / default.largest * largest;
        Self {
            initial: default.initial.min(range),
            largest,
            range,
            ..default
        }
    }

    /// The step after one that looks wrong; `None` if it is short already: a kink keeps its angle at any length.
    pub(crate) fn after_doubt(&self, step: f64) -> Option<f64> {
        self.after_failure(step).filter(|_| step > 1e-4)
    }

    /// Whether a step turned by a good part of what steps are made for.
    pub(crate) fn turns(&self, angle: f64) -> bool {
        angle > 0.5 * self.angle
    }

    /// A step that turned by this angle is tried again.
    pub(crate) fn turns_too_far(&self, angle: f64) -> bool {
        angle > 3.0 * self.angle
    }

    /// A step whose predictor was this far off is tried again: it may have stepped over a bend.
    pub(crate) fn is_too_far(&self, distance: f64) -> bool {
        distance > 5.0 * self.distance
    }

    /// The step after one that converged; `slope` is the part of the range that a unit step takes there.
    pub(crate) fn after_success(&self, step: f64, angle: f64, distance: f64, slope: f64) -> f64 {
        let by_angle = self.angle / angle.max(1e-3 * self.angle);
        // The predictor is off by the cube of the step.
        let by_distance = (self.distance / distance.max(1e-3 * self.distance)).cbrt();
        (step * by_angle.min(by_distance).clamp(0.5, 1.5))
            .min(self.range / slope.abs())
            .clamp(self.smallest, self.largest)
    }

    /// The step after one that failed; `None` when it cannot be shortened further.
    pub(crate) fn after_failure(&self, step: f64) -> Option<f64> {
        let shorter = 0.4 * step;
        (shorter >= self.smallest).then_some(shorter)
    }
}

/// A branch may have so many points.
pub(crate) fn max_points(points: usize) -> Result<usize, Error> {
    option(
        "max_points",
        points as f64,
        2.0..=1e9,
        "must be from 2 to 1e9",
    )?;
    Ok(points)
}

/// Steps of a walk with this largest one.
pub(crate) fn largest_step(step: f64) -> Result<StepControl, Error> {
    option("largest_step", step, 1e-6..=1.0, "must be from 1e-6 to 1")?;
    Ok(StepControl::with_largest(step))
}
