//! What the walk along a branch has gathered, whichever method computes its orbits.

use std::time::Duration;

use super::branch::{Branch, Further, Model};
use super::engine::Places;
use super::point::{Event, Point};
use crate::continuation::follow::Stop;
use crate::continuation::statistics::Statistics;
use crate::event::{EventKind, Turn};
use crate::system::System;
use crate::time::Work;

/// Orbits with what happened between them. Places of events and turns count the points before them.
#[derive(Debug, Default)]
pub(crate) struct Record {
    pub(crate) points: Vec<Point>,
    pub(crate) events: Vec<Event>,
    pub(crate) turns: Vec<Turn>,
}

/// The same, looked at.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Kept<'k> {
    pub(crate) points: &'k [Point],
    pub(crate) events: &'k [Event],
    pub(crate) turns: &'k [Turn],
}

impl Record {
    /// A branch of a system that has ended so. What it cost, and what it goes on from, is for the method to add.
    pub(crate) fn into_branch(self, system: &dyn System, varied: String, stopped: Stop) -> Branch {
        let Self {
            points,
            events,
            turns,
        } = self;
        Branch {
            model: Model::of(system),
            varied,
            points,
            events,
            turns,
            leaps: Vec::new(),
            begin: None,
            stopped,
            statistics: Statistics::default(),
            work: Work::default(),
            elapsed: Duration::default(),
            further: Further::default(),
        }
    }

    pub(crate) fn kept(&self) -> Kept<'_> {
        Kept {
            points: &self.points,
            events: &self.events,
            turns: &self.turns,
        }
    }

    /// Where the branch has joined another one: the branch point behind its last orbit, else that orbit.
    pub(crate) fn joint(&self) -> Option<f64> {
        let here = |event: &&Event| {
            event.kind == EventKind::BranchPoint && event.after == self.points.len()
        };
        let event = self.events.iter().rfind(here);
        let last = || self.points.last().map(|point| point.value);
        event.map(|event| event.point.value).or_else(last)
    }

    /// Puts the branch point where the branch has joined another one behind what else happened on the way to it.
    pub(crate) fn ends_with_joint(&mut self) {
        let last = self.points.len();
        let is_joint = |event: &Event| event.kind == EventKind::BranchPoint && event.after == last;
        if let Some(place) = self.events.iter().rposition(is_joint) {
            self.events[place..].rotate_left(1);
        }
    }

    /// Has the last event, behind so many points, be where the branch ends on another one. It is what any branch point there is, that was not
    /// located.
    pub(crate) fn is_joint(&mut self, after: usize) {
        if let Some(event) = self.events.last_mut() {
            event.kind = EventKind::BranchPoint;
        }
        let same = |turn: &Turn| turn.after == after && turn.kind == EventKind::BranchPoint;
        self.turns.retain(|turn| !same(turn));
    }

    /// Drops a place that turned out to be where a level is touched.
    pub(crate) fn drop_turn(&mut self, turn: &Turn) {
        self.turns.retain(|other| other != turn);
    }

    /// Makes places of branch points and Neimark-Sacker bifurcations, from one event on, whose errors are unknown: they are of unknowns that do
    /// not resolve the orbits there, such as few harmonics in a narrow place of a law, and may be theirs alone.
    pub(crate) fn doubt_unknown(&mut self, first: usize) {
        let of_equations =
            |kind: EventKind| matches!(kind, EventKind::BranchPoint | EventKind::NeimarkSacker);
        let (mut place, turns) = (0, &mut self.turns);
        self.events.retain(|event| {
            place += 1;
            let kept = place <= first || event.error.is_finite() || !of_equations(event.kind);
            if !kept {
                turns.push(Turn {
                    kind: event.kind,
                    value: event.point.value,
                    test: event.test,
                    after: event.after,
                });
            }
            kept
        });
    }

    /// The largest error that the multipliers of the last two points may have, or `least` if that is more.
    pub(crate) fn last_error(&self, least: f64) -> f64 {
        let last = self.points.iter().rev().take(2);
        last.map(|point| point.stability.error)
            .fold(least, f64::max)
    }
}

impl Kept<'_> {
    /// What was there when the walk was at these places; `None` where there is nothing.
    pub(crate) fn at(&self, places: &Places) -> Option<Record> {
        Some(Record {
            points: self.points.get(..places.points)?.to_vec(),
            events: taken(&places.events, self.events)?,
            turns: taken(&places.turns, self.turns)?,
        })
    }
}

/// What is at these places; `None` where there is nothing.
fn taken<T: Clone>(places: &[usize], from: &[T]) -> Option<Vec<T>> {
    places
        .iter()
        .map(|&place| from.get(place).cloned())
        .collect()
}
