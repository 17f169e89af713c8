//! What happens along a branch, whichever method follows it.

use std::fmt;
use std::mem::discriminant;

/// What happens at an [`Event`](crate::Event).
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(rename_all = "kebab-case"))]
#[non_exhaustive]
pub enum EventKind {
    /// The branch turns back in what it varies; a multiplier is one.
    Fold,
    /// Orbits with a symmetry of the system cease to have it: a branch of orbits without it crosses, which the symmetry takes into each
    /// other. It is the odd one, or one of coordinates in each other's place, at every time or a part of the period later.
    SymmetryBreaking,
    /// A branch of orbits begins that come back after twice the time: a multiplier over the shortest time in which these come back is minus
    /// one. That is a period of the declaration or several, or a part of one where contacts take each other's place, as the passage of a
    /// ball in a bearing: see [`Orbit::parts`](crate::Orbit::parts).
    PeriodDoubling,
    /// Another branch of orbits crosses or is met; a multiplier is one.
    BranchPoint,
    /// Quasi-periodic motions begin: a pair of complex multipliers crosses the unit circle.
    NeimarkSacker,
    /// A gap touches a level, without speed. Multipliers lose their smoothness there, or jump.
    Grazing {
        /// Whether the branch turns back in what it varies there.
        turns: bool,
    },
}

impl EventKind {
    /// Every kind, of grazing the one at which the branch does not turn.
    pub const ALL: [Self; 6] = [
        Self::Fold,
        Self::PeriodDoubling,
        Self::SymmetryBreaking,
        Self::BranchPoint,
        Self::NeimarkSacker,
        Self::Grazing { turns: false },
    ];

    /// Whether both are of one kind; whether the branch turns back is not asked.
    pub fn is_like(self, other: Self) -> bool {
        discriminant(&self) == discriminant(&other)
    }

    /// Whether the branch turns back in what it varies at an event of this kind.
    pub fn turns(self) -> bool {
        matches!(self, Self::Fold | Self::Grazing { turns: true })
    }
}

impl fmt::Display for EventKind {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Fold => "fold",
            Self::SymmetryBreaking => "symmetry-breaking",
            Self::PeriodDoubling => "period-doubling",
            Self::BranchPoint => "branch-point",
            Self::NeimarkSacker => "neimark-sacker",
            Self::Grazing { .. } => "grazing",
        })
    }
}

/// A place where a test function changed its sign without an event that could be located: it jumped there, or corrections failed. Where all
/// events are looked for, also a place where the verdict changes and nothing was found: its kind is what the multiplier nearest to the
/// unit circle suggests.
///
/// Of kind [`EventKind::Fold`] it is a place where the branch turned back, but not through a fold. A sampled balance of a force
/// that jumps does this, and so does an orbit that grazes a level. Where its test function is not a number, the step could not be looked at: its first
/// orbit has no place in the unknowns of its last one.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[non_exhaustive]
pub struct Turn {
    /// What would have happened where the test function vanishes.
    pub kind: EventKind,
    /// What the branch varies, where the jump is. Where it was not found: at the touch of a level in the step, if there is one at which
    /// multipliers jump or nearly do, or else in the middle between two points.
    #[cfg_attr(feature = "serde", serde(with = "crate::serialise"))]
    pub value: f64,
    /// Value of the test function beside the jump, or before the step where that was not found; not a number where it is unknown.
    #[cfg_attr(feature = "serde", serde(with = "crate::serialise"))]
    pub test: f64,
    /// Number of points of the branch before it.
    pub after: usize,
}

/// The side of an event on which a branch is followed.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(rename_all = "kebab-case"))]
pub enum Side {
    /// One of the two.
    One,
    /// The other one.
    Other,
}

impl Side {
    /// One or minus one.
    pub(crate) fn sign(self) -> f64 {
        match self {
            Self::One => 1.0,
            Self::Other => -1.0,
        }
    }
}
