//! Orbits of a branch with what is known of them, and special ones.

use std::fmt;

use super::observed::{Motion, Observed};
use super::orbit::Orbit;
use super::stability::Stability;
use crate::event::EventKind;
use crate::numeric::decimal::Decimal;

/// One orbit of a branch.
#[derive(Debug, Clone, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[non_exhaustive]
pub struct Point {
    /// Value of what the branch varies: omega or a parameter.
    #[cfg_attr(feature = "serde", serde(with = "crate::serialise"))]
    pub value: f64,
    /// Parameters of the system, in the order of its declaration.
    #[cfg_attr(feature = "serde", serde(with = "crate::serialise"))]
    pub parameters: Vec<f64>,
    /// The orbit.
    pub orbit: Orbit,
    /// Its stability.
    pub stability: Stability,
    /// What is read off it.
    pub observed: Observed,
    /// Estimated error of peak-to-peak, from the harmonics or nodes that were left out or from the tolerance of the flow, and from rounding:
    /// of the first coordinate relative to its own, of the others relative to the largest of all, at this very value of what is varied. A
    /// first coordinate whose motion is not told from what is left of the equations is at rest, and measured by the largest. Where
    /// accuracy was asked of one output or coordinate, of that, as a part of itself ([`Branch::accuracy_of`](crate::Branch::accuracy_of)).
    /// Of a [free oscillation](crate::backbone::FreeOscillation), whose size is not a function of its frequency, how far the motion misses its
    /// beginning after a period, as a part of its size.
    /// `None` where neither the tolerance nor the stability asked for it. Infinite where it could not be estimated: nothing is known of
    /// the error then.
    #[cfg_attr(feature = "serde", serde(with = "crate::serialise"))]
    pub error: Option<f64>,
}

impl Point {
    /// Excitation frequency.
    pub fn omega(&self) -> f64 {
        self.orbit.omega
    }

    /// Motion of the first coordinate.
    pub fn motion(&self) -> Motion {
        self.observed.motions[0]
    }

    /// Peak-to-peak of the first coordinate.
    pub fn peak_to_peak(&self) -> f64 {
        self.motion().peak_to_peak()
    }

    /// Half of the largest peak-to-peak of a coordinate; one at rest.
    pub(crate) fn size(&self) -> f64 {
        let motions = self.observed.motions.iter();
        let size = motions.fold(0.0, |m: f64, motion| m.max(0.5 * motion.peak_to_peak()));
        if size > 0.0 { size } else { 1.0 }
    }
}

/// A special orbit of a branch, located until its test function vanished.
#[derive(Debug, Clone, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[non_exhaustive]
pub struct Event {
    /// What happens there.
    pub kind: EventKind,
    /// The orbit.
    pub point: Point,
    /// Estimated error of [`Point::value`], from the harmonics and samples that were left out or from the tolerance of the flow, and from
    /// rounding. Infinite where it could not be estimated: the event is one of the discrete equations then, and nothing is known of
    /// the true one.
    #[cfg_attr(feature = "serde", serde(with = "crate::serialise"))]
    pub error: f64,
    /// Value of the test function that was reached.
    #[cfg_attr(feature = "serde", serde(with = "crate::serialise"))]
    pub test: f64,
    /// Number of points of the branch before it.
    pub after: usize,
    /// Where an orbit grazes, the number of contacts that touch a level there; several at once where they are copies of each other,
    /// as the balls of a bearing. Zero otherwise.
    pub contacts: usize,
    /// The tangent of the branch, in extended unknowns. By the balance at a crossing with another branch of the same harmonics only.
    #[cfg_attr(feature = "serde", serde(with = "crate::serialise"))]
    pub(crate) tangent: Vec<f64>,
}

impl Event {
    /// Period of the orbits of the branch that begins here, in periods of the declaration.
    pub(crate) fn period_of_branch(&self) -> usize {
        let orbit = &self.point.orbit;
        match self.kind {
            EventKind::PeriodDoubling => orbit.recurrence().doubled().period,
            _ => orbit.period,
        }
    }
}

/// Decimals of the size of an orbit whose error was not asked for.
pub(crate) const DECIMALS: usize = 6;

impl fmt::Display for Event {
    /// With the size of the first coordinate: [`Branch::describe`](crate::Branch::describe) names what leads, with units.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self {
            kind,
            point,
            error,
            contacts,
            ..
        } = self;
        let value = Decimal::to_error(point.value, *error);
        let size = point.peak_to_peak();
        let size = match point.error {
            Some(error) => Decimal::to_error(size, error * size),
            None => Decimal::rounded(size, DECIMALS),
        };
        let of = if point.orbit.coordinates > 1 {
            " of the first coordinate"
        } else {
            ""
        };
        write!(
            f,
            "{kind} at {value} (error {error:.0e}), peak-to-peak{of} {size}"
        )?;
        if *contacts > 1 {
            write!(f, ", {contacts} contacts at once")?;
        }
        Ok(())
    }
}
