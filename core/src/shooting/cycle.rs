//! Orbits found by shooting, and branches of them.

use std::fmt;
use std::time::Duration;

use super::extremes::Extremes;
use crate::continuation::follow::Stop;
use crate::continuation::statistics::Statistics;
use crate::event::{EventKind, Turn};
use crate::model::labels::Labels;
use crate::numeric::decimal::Decimal;
use crate::orbit::stability::Stability;
use crate::time::{FlowError, Work};

/// A periodic orbit, as a state that returns to itself.
#[derive(Debug, Clone, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
#[non_exhaustive]
pub struct Cycle {
    /// Value of what is varied: omega or a parameter.
    pub value: f64,
    /// Parameters of the system, in the order of its declaration.
    pub parameters: Vec<f64>,
    /// Excitation frequency.
    pub omega: f64,
    /// Number of periods of the declaration (`2 pi divisor / omega`) in its period.
    pub period: usize,
    /// Whether it has odd symmetry: half a period later every coordinate has the opposite sign.
    pub symmetric: bool,
    /// States at the beginnings of the segments; see [`Cycle::state`].
    pub(super) states: Vec<f64>,
    /// Its stability, with the multipliers over the whole period.
    pub stability: Stability,
    /// Extremes of every coordinate.
    pub extremes: Vec<Extremes>,
    /// How often a gap crosses a level in the period.
    pub switches: usize,
    /// Estimated error of the state, of velocities in units of omega: from the tolerance of the flow and from rounding.
    /// `None` where no stability was asked for, since it comes with that.
    pub error: Option<f64>,
    /// Updates of Newton's method that it took from the guess; zero on a branch.
    pub iterations: usize,
}

impl Cycle {
    /// The state `(q, dq/dt)` at phase zero.
    pub fn state(&self) -> &[f64] {
        &self.states[..2 * self.extremes.len()]
    }

    /// The states at the beginnings of the segments, of equal length, that the orbit, or half of it if it is symmetric, is divided
    /// into: by default one for each period of the declaration.
    pub fn states(&self) -> impl Iterator<Item = &[f64]> {
        self.states.chunks_exact(2 * self.extremes.len())
    }

    /// Half of the largest peak-to-peak of a coordinate; one at rest.
    pub(super) fn size(&self) -> f64 {
        let largest = |m: f64, extremes: &Extremes| m.max(0.5 * extremes.peak_to_peak());
        let size = self.extremes.iter().fold(0.0, largest);
        if size > 0.0 { size } else { 1.0 }
    }

    /// Largest less smallest value of the first coordinate.
    pub fn peak_to_peak(&self) -> f64 {
        self.extremes[0].peak_to_peak()
    }
}

/// A special orbit of a branch, located until its test function vanished.
#[derive(Debug, Clone, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
#[non_exhaustive]
pub struct CycleEvent {
    /// What happens there.
    pub kind: EventKind,
    /// The orbit.
    pub cycle: Cycle,
    /// Estimated error of [`Cycle::value`], from the tolerance of the flow and from rounding.
    pub error: f64,
    /// Value of the test function that was reached.
    pub test: f64,
    /// Number of orbits of the branch before it.
    pub after: usize,
    /// Direction of the branch there, in states at the beginnings of the segments and the parameter.
    pub(super) direction: Vec<f64>,
}

impl fmt::Display for CycleEvent {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self {
            kind, cycle, error, ..
        } = self;
        write!(
            f,
            "{kind} at {} (error {error:.0e}), peak-to-peak {}",
            Decimal::rounded(cycle.value, 12),
            Decimal::rounded(cycle.peak_to_peak(), 9)
        )
    }
}

/// Why a branch ended.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub enum End {
    /// Following it ended.
    Stopped(Stop),
    /// It met a branch of more regular orbits, at the branch point that is its last event.
    Joined {
        /// Shortest period of these, in periods of the declaration.
        period: usize,
        /// Whether they have odd symmetry.
        symmetric: bool,
    },
    /// The motion near the last orbit, or the one that would be next, cannot be computed.
    Motion {
        /// Value at the last orbit.
        value: f64,
        /// Why.
        reason: FlowError,
    },
}

impl fmt::Display for End {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Stopped(stop) => stop.fmt(f),
            Self::Joined {
                period,
                symmetric: false,
            } => write!(f, "met a branch of orbits of period {period}"),
            Self::Joined {
                period,
                symmetric: true,
            } => write!(f, "met a branch of symmetric orbits of period {period}"),
            Self::Motion { value, reason } => {
                let value = Decimal::plain(*value);
                write!(f, "no further motion computed at {value}: {reason}")
            }
        }
    }
}

/// A branch of orbits in the order in which it was followed.
#[derive(Debug, Clone, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
#[non_exhaustive]
pub struct CycleBranch {
    /// Name of what it varies.
    pub varied: String,
    /// What a chart says of it.
    #[cfg_attr(feature = "serde", serde(skip))]
    pub(crate) labels: Labels,
    /// The orbits.
    pub cycles: Vec<Cycle>,
    /// Special orbits.
    pub events: Vec<CycleEvent>,
    /// Places where a test function changes its sign, but jumps instead of vanishing, as where an orbit grazes a level.
    pub turns: Vec<Turn>,
    /// Why it ended at its beginning, where it was followed both ways from an orbit.
    pub begin: Option<End>,
    /// Why it ended.
    pub end: End,
    /// What the continuation cost.
    pub statistics: Statistics,
    /// What the motions cost.
    pub work: Work,
    /// Time of the computation.
    #[cfg_attr(
        feature = "serde",
        serde(serialize_with = "crate::numeric::serialise::seconds")
    )]
    pub elapsed: Duration,
}

impl CycleBranch {
    /// Two parts of one branch from the same orbit on as one branch, the first backwards.
    pub(crate) fn joined(back: Self, forth: Self) -> Self {
        let count = back.cycles.len();
        let mut branch = forth;
        let mut cycles = back.cycles;
        cycles.reverse();
        // The first orbit of both is the same.
        cycles.extend(branch.cycles.drain(..).skip(1));
        let turned = |after: usize| count - after.min(count);
        let mut events: Vec<CycleEvent> = back.events;
        events.reverse();
        for event in &mut events {
            event.after = turned(event.after);
        }
        let mut turns: Vec<Turn> = back.turns;
        turns.reverse();
        for turn in &mut turns {
            turn.after = turned(turn.after);
        }
        let shift = count.saturating_sub(1);
        events.extend(branch.events.drain(..).map(|event| CycleEvent {
            after: event.after + shift,
            ..event
        }));
        turns.extend(branch.turns.drain(..).map(|turn| Turn {
            after: turn.after + shift,
            ..turn
        }));
        branch.statistics += back.statistics;
        branch.elapsed += back.elapsed;
        super::run::add(&mut branch.work, back.work);
        Self {
            cycles,
            events,
            turns,
            begin: Some(back.end),
            ..branch
        }
    }

    /// The events of one kind.
    pub fn events(&self, kind: EventKind) -> impl Iterator<Item = &CycleEvent> {
        self.events.iter().filter(move |event| event.kind == kind)
    }

    /// The folds.
    pub fn folds(&self) -> impl Iterator<Item = &CycleEvent> {
        self.events(EventKind::Fold)
    }
}
