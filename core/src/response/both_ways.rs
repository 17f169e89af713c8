//! Branches that are followed both ways from an orbit: first to the end of the range, then from the same orbit to its beginning.
//!
//! Such a branch is in the order of the range: its part to the beginning backwards, then the other one. What was interrupted goes on part by
//! part, so that what comes of it is what an uninterrupted run gives.

use crate::branches::branch::{Branch, Further};
use crate::branches::point::{Event, Point};
use crate::branches::request::Request;
use crate::cancel::Cancel;
use crate::continuation::follow::Stop;
use crate::continuation::statistics::Statistics;
use crate::error::Error;
use crate::event::Turn;
use crate::model::request::RequestError;
use crate::model::validate;
use crate::time::Work;

/// Rounding of the value of an orbit that was found again, as a part of values along the branch.
const ROUNDING: f64 = 1e-9;

/// A branch that was followed both ways, as it was interrupted or has ended.
#[derive(Debug, Clone, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub(super) struct BothWays<R> {
    /// Value of the orbit from which it was followed.
    #[cfg_attr(feature = "serde", serde(with = "crate::serialise"))]
    pub(super) value: f64,
    /// What is left of the part to the end of the range.
    forth: Option<Box<R>>,
    /// The part to the beginning; none where it has not begun.
    back: Option<Back<R>>,
}

/// The part of a branch to the beginning of the range.
#[derive(Debug, Clone, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
struct Back<R> {
    /// So much of the branch belongs to it.
    points: usize,
    events: usize,
    turns: usize,
    /// What is left of it.
    rest: Option<Box<R>>,
}

/// A part of a branch, in the order in which it was followed.
pub(super) struct Part<R> {
    pub(super) branch: Branch,
    pub(super) rest: Option<Box<R>>,
}

impl<R> Part<R> {
    /// Whether nothing is left of it.
    fn is_whole(&self) -> bool {
        !self.branch.stopped.can_be_resumed()
    }
}

/// One part by itself, without what it cost.
fn alone<R>(branch: Branch, rest: Option<Box<R>>) -> Part<R> {
    Part {
        branch: Branch {
            begin: None,
            statistics: Statistics::default(),
            work: Work::default(),
            elapsed: std::time::Duration::default(),
            further: Further::default(),
            ..branch
        },
        rest,
    }
}

/// Whether something is left of a branch that was followed both ways.
pub(super) fn is_left(branch: &Branch) -> bool {
    let back = branch.begin.is_none_or(Stop::can_be_resumed);
    branch.stopped.can_be_resumed() || branch.stopped != Stop::Closed && back
}

/// Whether the orbit at a place is the one at this value from which a branch was followed: both may have been read from a file. With other
/// harmonics it was found again, at that value to rounding.
pub(super) fn begins_at(value: f64, place: usize, points: &[Point]) -> bool {
    let from = |point: &Point| (point.value - value).abs();
    let extent = points.iter().map(from).fold(0.0, f64::max) + value.abs();
    let at = points.get(place).map(from);
    extent.is_finite() && at.is_some_and(|apart| apart <= ROUNDING * extent)
}

/// Which part of a branch.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Way {
    /// To the end of the range.
    Forth,
    /// To its beginning.
    Back,
}

impl Way {
    /// Where the part comes from and where it ends, in a range.
    pub(super) fn of(self, [from, to]: [f64; 2]) -> [f64; 2] {
        match self {
            Self::Forth => [from, to],
            Self::Back => [to, from],
        }
    }
}

impl<R: Clone> BothWays<R> {
    /// Of a branch from the orbit at a value, of which nothing was followed yet.
    ///
    /// # Errors
    /// If the value is not in the range that is asked for.
    pub(super) fn through(request: &Request, value: f64) -> Result<Self, Error> {
        let [from, to] = request.range()?;
        let between = from.min(to)..=from.max(to);
        validate::option("through", value, between, "must be between from and to")?;
        Ok(Self {
            value,
            forth: None,
            back: None,
        })
    }

    /// Place of the orbit from which a branch was followed.
    pub(super) fn middle(&self) -> usize {
        self.back.as_ref().map_or(0, |back| back.points.max(1) - 1)
    }

    /// Follows what is left of a branch, or all of it if there is none yet. A part goes on from where it was, or begins.
    ///
    /// # Errors
    /// If what it goes on from does not belong to the branch; those of a part.
    pub(super) fn follow(
        &self,
        known: Option<&Branch>,
        cancel: &Cancel,
        mut part: impl FnMut(Way, Option<(&Branch, &R)>) -> Result<Part<R>, Error>,
    ) -> Result<(Branch, Self), Error> {
        let [forth, back] = match known {
            Some(branch) => self.parts(branch).ok_or(RequestError::Rest)?,
            None => [None, None],
        };
        let mut go_on = |way: Way, known: Option<Part<R>>| match known {
            Some(known) if known.is_whole() => Ok(known),
            Some(Part {
                branch,
                rest: Some(rest),
            }) => part(way, Some((&branch, &rest))),
            _ => part(way, None),
        };
        let forth = go_on(Way::Forth, forth)?;
        // Once around, there is no other side.
        let back = match (forth.branch.stopped, back) {
            (Stop::Closed, _) => None,
            // What there is of it stays.
            (Stop::Interrupted, known) => known.map(Ok),
            (_, known) => Some(go_on(Way::Back, known)),
        };
        let left = Self {
            value: self.value,
            forth: forth.rest,
            back: match &back {
                Some(Ok(Part { branch, rest })) => Some(Back {
                    points: branch.points.len(),
                    events: branch.events.len(),
                    turns: branch.turns.len(),
                    rest: rest.clone(),
                }),
                _ => None,
            },
        };
        let back = back.map(|back| back.map(|part| part.branch));
        Ok((Branch::with_back(forth.branch, back, cancel)?, left))
    }

    /// Both parts of a branch, without what they cost; `None` if it is another one.
    fn parts(&self, branch: &Branch) -> Option<[Option<Part<R>>; 2]> {
        let Some(Back {
            points,
            events,
            turns,
            rest,
        }) = &self.back
        else {
            let begun = branch.points.is_empty() || begins_at(self.value, 0, &branch.points);
            let forth = alone(branch.clone(), self.forth.clone());
            return begun.then_some([Some(forth), None]);
        };
        // The first orbit of both is the same.
        let shared = points.checked_sub(1)?;
        if !begins_at(self.value, shared, &branch.points) {
            return None;
        }
        let (before, behind) = (branch.points.get(..*points)?, branch.points.get(shared..)?);
        let (events_before, events_behind) = branch.events.split_at_checked(*events)?;
        let (turns_before, turns_behind) = branch.turns.split_at_checked(*turns)?;
        let turned = |after: usize| points - after.min(*points);
        let back = Branch {
            points: before.iter().rev().cloned().collect(),
            events: (events_before.iter().rev())
                .map(|event| Event {
                    after: turned(event.after),
                    ..event.clone()
                })
                .collect(),
            turns: (turns_before.iter().rev())
                .map(|turn| Turn {
                    after: turned(turn.after),
                    ..*turn
                })
                .collect(),
            stopped: branch.begin?,
            ..branch.clone()
        };
        let moved = |after: usize| after.saturating_sub(shared);
        let forth = Branch {
            points: behind.to_vec(),
            events: (events_behind.iter())
                .map(|event| Event {
                    after: moved(event.after),
                    ..event.clone()
                })
                .collect(),
            turns: (turns_behind.iter())
                .map(|turn| Turn {
                    after: moved(turn.after),
                    ..*turn
                })
                .collect(),
            ..branch.clone()
        };
        Some([
            Some(alone(forth, self.forth.clone())),
            Some(alone(back, rest.clone())),
        ])
    }
}
