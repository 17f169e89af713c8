//! Why a walk along a branch or a curve ended, and how that is said.
//!
//! Who says so: what a point tells, [`Position::ends`](super::position::Position::ends); the end of the range and steps that fail,
//! [`stepper`](super::stepper); touches and corners, and what a method tells of its orbits, the engine of branches.

use crate::continuation::newton::NewtonError;
use crate::numeric::decimal::Decimal;
use crate::time::FlowError;

/// Why following a branch or a curve ended.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(rename_all = "kebab-case"))]
#[non_exhaustive]
pub enum Stop {
    /// The parameter reached the end of its range; of a curve, one of both parameters.
    ReachedEnd,
    /// The branch turned back and left the range where it had passed.
    LeftAtStart,
    /// A curve that is followed one way, as that of free oscillation in a mode, turned back, and no part of it was found beyond.
    TurnedBack {
        /// Where.
        #[cfg_attr(feature = "serde", serde(with = "crate::serialise"))]
        value: f64,
    },
    /// The motion that would be next on a curve of free oscillations does not come back to its beginning: it parts from its neighbours so fast that
    /// rounding becomes visible.
    Missed {
        /// Value at the last orbit.
        #[cfg_attr(feature = "serde", serde(with = "crate::serialise"))]
        value: f64,
        /// How far it misses its beginning, as a part of its size.
        #[cfg_attr(feature = "serde", serde(with = "crate::serialise"))]
        by: f64,
    },
    /// The branch closed upon itself, be it one or several periods of the declaration later.
    Closed,
    /// A branch of orbits of several periods of the declaration met one of a shorter period, or one of orbits without a symmetry met one of
    /// orbits with it. It would go on through the same orbits, shifted in time or mirrored.
    Joined {
        /// The shorter period, in periods of the declaration.
        period: usize,
        /// Whether the orbits met have an odd symmetry that those of the branch lack.
        symmetric: bool,
        /// Where.
        #[cfg_attr(feature = "serde", serde(with = "crate::serialise"))]
        value: f64,
    },
    /// A curve of folds met the curve of doublings at which its orbits begin, at the degenerate point that is the special one there.
    JoinedDoublings,
    /// As many points as were allowed.
    PointLimit {
        /// The limit.
        points: usize,
    },
    /// No step, however short, led to another solution.
    StepTooShort {
        /// Length of the last step tried, where one is the size of the orbit, or the range of what is varied.
        #[cfg_attr(feature = "serde", serde(with = "crate::serialise"))]
        step: f64,
        /// Where.
        #[cfg_attr(feature = "serde", serde(with = "crate::serialise"))]
        value: f64,
        /// What the last correction said.
        reason: NewtonError,
    },
    /// A gap touches a level at which the force jumps, and on its other side the force pulls it on: motions that pass the level go far
    /// away, however slowly they pass it, so that the branch has no orbits beyond.
    PulledOn {
        /// Where.
        #[cfg_attr(feature = "serde", serde(with = "crate::serialise"))]
        value: f64,
    },
    /// The motion near the last orbit, or the one that would be next, cannot be computed.
    Motion {
        /// Value at the last orbit.
        #[cfg_attr(feature = "serde", serde(with = "crate::serialise"))]
        value: f64,
        /// Why.
        reason: FlowError,
    },
    /// The orbits grow without bound while what is varied hardly moves: a resonance that no damping limits.
    Unbounded {
        /// Where.
        #[cfg_attr(feature = "serde", serde(with = "crate::serialise"))]
        value: f64,
        /// How many times the first orbit's oscillation the last one is.
        #[cfg_attr(feature = "serde", serde(with = "crate::serialise"))]
        growth: f64,
    },
    /// The caller asked to stop, or [cancelled](crate::Cancel) the work.
    Interrupted,
}

impl Stop {
    /// Whether nothing but the caller ended it.
    pub(crate) fn can_be_resumed(self) -> bool {
        matches!(self, Self::Interrupted | Self::PointLimit { .. })
    }
}

impl std::fmt::Display for Stop {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::ReachedEnd => write!(f, "reached the end of the range"),
            Self::LeftAtStart => write!(f, "turned back and left the range at its start"),
            Self::TurnedBack { value } => write!(f, "turned back at {}", Decimal::plain(*value)),
            Self::Missed { value, by } => write!(
                f,
                "the motion beyond {} misses its beginning by {by:.0e} of its size",
                Decimal::plain(*value)
            ),
            Self::Closed => write!(f, "closed upon itself"),
            Self::Joined {
                period,
                symmetric,
                value,
            } => write!(
                f,
                "joined a branch of {}orbits of period {period} at {}; beyond, the same orbits would follow again, shifted or mirrored",
                if *symmetric { "symmetric " } else { "" },
                Decimal::rounded(*value, 9)
            ),
            Self::JoinedDoublings => write!(f, "met the doublings at which its orbits begin"),
            Self::PointLimit { points } => write!(f, "reached the limit of {points} points"),
            Self::StepTooShort {
                step,
                value,
                reason,
            } => {
                write!(
                    f,
                    "no further solution found at {} with a step of {step:.1e}: {reason}",
                    Decimal::plain(*value)
                )
            }
            Self::PulledOn { value } => write!(
                f,
                "ends at {}, where a gap touches a level at which the force jumps: motions that pass it are pulled far away",
                Decimal::rounded(*value, 9)
            ),
            Self::Motion { value, reason } => write!(
                f,
                "no further motion computed at {}: {reason}",
                Decimal::plain(*value)
            ),
            Self::Unbounded { value, growth } => write!(
                f,
                "the oscillation grew {growth:.0e} times towards {}, without an end: a resonance without damping",
                Decimal::rounded(*value, 12)
            ),
            Self::Interrupted => write!(f, "interrupted"),
        }
    }
}
