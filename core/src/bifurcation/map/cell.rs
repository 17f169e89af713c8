//! What there is at values of two parameters.

use std::fmt;

use crate::attractors::basin::Fate;
use crate::bifurcation::diagram::{Diagram, Reason};
use crate::bifurcation::solutions::Solution;
use crate::branches::stability::Verdict;
use crate::error::Error;

/// The solutions at values of two parameters.
#[derive(Debug, Clone, PartialEq, Default)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[non_exhaustive]
pub struct Cell {
    /// Stable periodic orbits, of any period.
    pub stable: usize,
    /// Unstable ones.
    pub unstable: usize,
    /// Those whose stability is not certain.
    pub undecided: usize,
    /// Orbits that motions settled to and whose branch could not be followed: they are not among the others.
    pub missed: usize,
    /// Motions that were followed here, from as many states.
    pub motions: usize,
    /// Of these, how many settled to no orbit of any period looked for: chaos, long periods, several frequencies.
    pub restless: usize,
    /// Largest peak-to-peak of [what leads](super::Map::signal) among the stable orbits. Not known where there is none, or where it is not known of
    /// one of them.
    #[cfg_attr(feature = "serde", serde(with = "crate::serialise"))]
    pub largest: Option<f64>,
    /// Periods of the stable orbits, in periods of the declaration, in increasing order.
    pub periods: Vec<usize>,
    /// Why nothing is known here; `None` where something is.
    pub reason: Option<Reason>,
}

/// What can be said of all orbits that were found in a cell together; what motions do, where they settle to none, is part of it.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[non_exhaustive]
pub enum CellVerdict {
    /// All are stable.
    AllStable,
    /// Some are stable, and some are not.
    SomeStable,
    /// None is stable, and all motions settle to orbits whose branches are known, or escape.
    NoneStable,
    /// Some are stable, and some motions settle to no orbit.
    StableAndRestless,
    /// None is stable, and motions settle to no orbit.
    Restless,
    /// The stability of one is not certain, or the branch of one was missed.
    Uncertain,
    /// No orbit was found.
    Empty,
    /// Nothing could be computed.
    Failed,
    /// The computation ended before.
    NotLookedAt,
}

#[cfg(feature = "plot")]
impl CellVerdict {
    /// In the order of the legend.
    pub(crate) const ALL: [Self; 9] = [
        Self::AllStable,
        Self::SomeStable,
        Self::NoneStable,
        Self::StableAndRestless,
        Self::Restless,
        Self::Uncertain,
        Self::Empty,
        Self::Failed,
        Self::NotLookedAt,
    ];
}

impl fmt::Display for CellVerdict {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::AllStable => "all stable",
            Self::SomeStable => "stable and unstable",
            Self::NoneStable => "none stable",
            Self::StableAndRestless => "stable, and not settling",
            Self::Restless => "none stable, not settling",
            Self::Uncertain => "undecided or missed",
            Self::Empty => "no orbit",
            Self::Failed => "not computable",
            Self::NotLookedAt => "not looked at",
        })
    }
}

impl Cell {
    /// Names of [`counts`](Self::counts), as columns of tables have them.
    pub const COUNTED: [&'static str; 6] = [
        "stable",
        "unstable",
        "undecided",
        "missed",
        "motions",
        "restless",
    ];

    /// The orbits and motions that are counted, in the order of [`COUNTED`](Self::COUNTED).
    pub fn counts(&self) -> [usize; 6] {
        [
            self.stable,
            self.unstable,
            self.undecided,
            self.missed,
            self.motions,
            self.restless,
        ]
    }

    /// One of which nothing is known.
    pub(super) fn without(reason: Reason) -> Self {
        Self {
            reason: Some(reason),
            ..Self::default()
        }
    }

    /// What can be said of all orbits together.
    pub fn verdict(&self) -> CellVerdict {
        match &self.reason {
            Some(Reason::Interrupted) => return CellVerdict::NotLookedAt,
            Some(_) => return CellVerdict::Failed,
            None => {}
        }
        if self.undecided > 0 || self.missed > 0 {
            return CellVerdict::Uncertain;
        }
        match (self.stable, self.unstable, self.restless) {
            (0, _, 1..) => CellVerdict::Restless,
            (0, 0, 0) => CellVerdict::Empty,
            (0, _, 0) => CellVerdict::NoneStable,
            (_, _, 1..) => CellVerdict::StableAndRestless,
            (_, 0, 0) => CellVerdict::AllStable,
            (_, _, 0) => CellVerdict::SomeStable,
        }
    }
}

impl Diagram {
    /// What there is at a value, where orbits have sizes.
    ///
    /// # Errors
    /// As [`solutions_at`](Self::solutions_at).
    pub(super) fn cell(
        &self,
        value: f64,
        size: impl Fn(&Solution) -> Option<f64>,
    ) -> Result<Cell, Error> {
        let at = self.solutions_at(value)?;
        let here = || self.searched.iter().filter(|at| at.value == value);
        let fates = here().flat_map(|searched| &searched.fates);
        let followed = fates.filter(|fate| !matches!(fate, Fate::Unknown | Fate::Failed));
        let settled = here().flat_map(|searched| &searched.orbits);
        let is_stable = |found: &&Solution| found.point.stability.verdict == Verdict::Stable;
        let stable = || at.orbits.iter().filter(is_stable);
        let mut periods: Vec<usize> = stable().map(|found| found.point.orbit.period).collect();
        periods.sort_unstable();
        let sizes: Option<Vec<f64>> = stable().map(size).collect();
        Ok(Cell {
            stable: periods.len(),
            unstable: at.count(Verdict::Unstable),
            undecided: at.count(Verdict::Undecided),
            missed: settled.filter(|orbit| orbit.branch.is_none()).count(),
            motions: followed.count(),
            restless: at.restless,
            largest: sizes.and_then(|sizes| sizes.into_iter().max_by(f64::total_cmp)),
            periods,
            reason: None,
        })
    }
}
