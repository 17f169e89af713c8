//! A branch of orbits that was computed by the balance.

use std::mem::discriminant;
use std::time::Duration;

use crate::balance_branch::follower::Follower;
use crate::branches::point::{Event, Point};
use crate::continuation::follow::Stop;
use crate::continuation::statistics::Statistics;
use crate::error::Error;
use crate::event::{EventKind, Turn};
use crate::system::System;

/// A branch of orbits in the order in which it was followed.
///
/// It owns a copy of the system, so that it can be returned, kept, and sent to another thread:
///
/// ```
/// use hertzian::{Branch, Error, FrequencyResponse};
///
/// fn resonance(drive: f64) -> Result<Branch, Error> {
///     hertzian::oscillator! {
///         Duffing(x) {
///             param drive;
///             ddot(x) + 0.1*dot(x) + x + x^3 = drive*cos(omega*t);
///         }
///     }
///
///     let model = Duffing { drive };
///     FrequencyResponse::of(&model).from(0.5).to(2.0).harmonics(7).samples(64).run()
/// }
///
/// let branch = resonance(0.2)?;
/// // Further orbits are computed when they are asked for.
/// let at = std::thread::spawn(move || branch.at(1.3)).join().unwrap()?;
/// assert_eq!(at.len(), 3);
/// # Ok::<(), hertzian::Error>(())
/// ```
#[derive(Debug, Clone)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct Branch {
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
    pub(crate) follower: Follower,
}

impl Branch {
    /// The system that it belongs to.
    pub fn system(&self) -> &dyn System {
        self.follower.system.as_ref()
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
