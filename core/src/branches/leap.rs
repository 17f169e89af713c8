//! Places between orbits of a branch where it was not followed.

use std::fmt;

use crate::continuation::follow::Stop;

/// A place where a branch ended and was taken up again beyond, so that two of its orbits which are next to each other are not next to each other on
/// any curve: of free oscillation in a [mode](crate::backbone::FreeOscillation::mode), where it is in resonance with another mode.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[non_exhaustive]
pub struct Leap {
    /// Number of points of the branch before it.
    pub after: usize,
    /// Why it was not followed on from there. Values are those of what was varied, of free oscillation a position at rest.
    pub reason: Stop,
}

impl Leap {
    pub(crate) fn new(after: usize, reason: Stop) -> Self {
        Self { after, reason }
    }
}

impl fmt::Display for Leap {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { after, reason } = self;
        write!(f, "taken up anew after {after} orbits: {reason}")
    }
}
