//! A computed branch of periodic orbits.

use std::fmt;
use std::mem::discriminant;
use std::time::Duration;

use crate::continuation::follow::Stop;
use crate::continuation::statistics::Statistics;
use crate::error::Error;
use crate::event::{EventKind, Turn};
use crate::numeric::decimal::Decimal;
use crate::numeric::fourier::series;
use crate::orbit::observe::{Motion, Observed};
use crate::orbit::stability::Stability;
use crate::response::follower::Follower;
use crate::system::System;

/// A periodic orbit as Fourier series of its coordinates.
#[derive(Debug, Clone, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct Orbit {
    /// Coordinate by coordinate, each laid out as in [`series`].
    pub(crate) series: Vec<f64>,
    pub(crate) coordinates: usize,
    /// Excitation frequency.
    pub omega: f64,
    /// Base frequency: the orbit repeats after `2 pi / base`.
    pub base: f64,
    /// Number of periods of the declaration (`2 pi divisor / omega`) in its period.
    pub period: usize,
}

impl Orbit {
    /// Fourier series of one coordinate, `[mean, cos 1, sin 1, ...]` in harmonics of the base frequency.
    ///
    /// # Panics
    /// If there is no such coordinate.
    pub fn series(&self, coordinate: usize) -> &[f64] {
        assert!(
            coordinate < self.coordinates,
            "the orbit has {} coordinates",
            self.coordinates
        );
        let length = self.series.len() / self.coordinates;
        &self.series[coordinate * length..][..length]
    }

    /// Number of coordinates.
    pub fn coordinates(&self) -> usize {
        self.coordinates
    }

    /// Number of harmonics.
    pub fn harmonics(&self) -> usize {
        series::harmonics(self.series(0))
    }

    /// Position and velocity of one coordinate at a time.
    ///
    /// # Panics
    /// If there is no such coordinate.
    pub fn state(&self, coordinate: usize, time: f64) -> (f64, f64) {
        let (x, slope, _) =
            series::value_and_derivatives(self.series(coordinate), self.base * time);
        (x, self.base * slope)
    }
}

/// One orbit of a branch.
#[derive(Debug, Clone, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
#[non_exhaustive]
pub struct Point {
    /// Value of what the branch varies: omega or a parameter.
    pub value: f64,
    /// Parameters of the system, in the order of its declaration.
    pub parameters: Vec<f64>,
    /// The orbit.
    pub orbit: Orbit,
    /// Its stability.
    pub stability: Stability,
    /// What is read off it.
    pub observed: Observed,
    /// Estimated error of peak-to-peak from the harmonics that were left out: of the first coordinate relative to its own, of the others
    /// relative to the largest of all, at this very value of what is varied. A first coordinate that moves less than a millionth of that is measured by a millionth. `None` where neither the tolerance nor
    /// the stability asked for it. Infinite where it could not be estimated: nothing is known of the error then.
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
}

/// A special orbit of a branch, located until its test function vanished.
#[derive(Debug, Clone, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
#[non_exhaustive]
pub struct Event {
    /// What happens there.
    pub kind: EventKind,
    /// The orbit.
    pub point: Point,
    /// Estimated error of [`Point::value`], from the harmonics and samples that were left out. Infinite where it could not be
    /// estimated: the event is one of the truncated balance then, and nothing is known of the true one.
    pub error: f64,
    /// Value of the test function that was reached.
    pub test: f64,
    /// Number of points of the branch before it.
    pub after: usize,
    /// Where an orbit grazes, the number of contacts that touch a level there; several at once where they are copies of each other,
    /// as the balls of a bearing. Zero otherwise.
    pub contacts: usize,
    /// At a crossing with another branch of the same harmonics the tangent of the branch, in extended unknowns; otherwise nothing.
    #[cfg_attr(feature = "serde", serde(skip))]
    pub(crate) tangent: Vec<f64>,
}

impl fmt::Display for Event {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self {
            kind,
            point,
            error,
            contacts,
            ..
        } = self;
        let value = Decimal::rounded(point.value, 9);
        let size = Decimal::rounded(point.peak_to_peak(), 6);
        write!(
            f,
            "{kind} at {value} (error {error:.0e}), peak-to-peak {size}"
        )?;
        if *contacts > 1 {
            write!(f, ", {contacts} contacts at once")?;
        }
        Ok(())
    }
}

/// A branch of orbits in the order in which it was followed.
#[derive(Debug, Clone)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct Branch<'a> {
    /// Name of what it varies.
    pub varied: String,
    /// The orbits.
    pub points: Vec<Point>,
    /// Special orbits.
    pub events: Vec<Event>,
    /// Turns that are not folds, and other events that could not be located.
    pub turns: Vec<Turn>,
    /// Why it ended.
    pub stopped: Stop,
    /// What it cost.
    pub statistics: Statistics,
    /// Time of the computation.
    #[cfg_attr(
        feature = "serde",
        serde(serialize_with = "crate::numeric::serialise::seconds")
    )]
    pub elapsed: Duration,
    #[cfg_attr(feature = "serde", serde(skip))]
    pub(crate) follower: Follower<'a>,
}

impl<'a> Branch<'a> {
    /// The system that it belongs to.
    pub fn system(&self) -> &'a dyn System {
        self.follower.system
    }

    /// The events of one kind. Whether the branch turns back is not asked: `Grazing` of either kind gives all.
    pub fn events(&self, kind: EventKind) -> impl Iterator<Item = &Event> {
        let alike = move |event: &&Event| discriminant(&event.kind) == discriminant(&kind);
        self.events.iter().filter(alike)
    }

    /// The folds.
    pub fn folds(&self) -> impl Iterator<Item = &Event> {
        self.events(EventKind::Fold)
    }

    /// Every orbit of the branch at a value of what it varies, in branch order; empty where the branch does not pass. Harmonics
    /// follow the tolerance as along the branch.
    ///
    /// # Errors
    /// If the value is not finite, or an orbit between two points cannot be computed.
    pub fn at(&self, value: f64) -> Result<Vec<Point>, Error> {
        crate::model::validate::finite("at", value)?;
        self.follower.at(&self.points, &self.events, value)
    }
}
