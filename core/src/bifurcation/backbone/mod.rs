//! Backbone (skeleton) curves: the frequency of free oscillation over its amplitude, and where the damped and driven system is in
//! phase resonance.

mod free;
mod oscillation;
mod resonance;

use std::time::Duration;

use crate::continuation::follow::Stop;
use crate::continuation::statistics::Statistics;
use crate::time::Work;

pub use free::{FreeOscillation, FreePoint};
pub use resonance::{PhaseResonance, ResonancePoint};

/// A backbone curve, of [`FreePoint`] or of [`ResonancePoint`].
#[derive(Debug, Clone, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[non_exhaustive]
pub struct Backbone<P> {
    /// Its points, in the order in which it was followed.
    pub points: Vec<P>,
    /// Why it ended.
    pub stopped: Stop,
    /// What the continuation cost.
    pub statistics: Statistics,
    /// What the motions cost; nothing in phase resonance, which computes none.
    pub work: Work,
    /// Time of the computation.
    #[cfg_attr(feature = "serde", serde(with = "crate::serialise"))]
    pub elapsed: Duration,
}
