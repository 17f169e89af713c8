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

/// Where something is on a branch: behind so many of its points, at a value of what is varied.
#[derive(Debug, Clone, Copy)]
struct Mark {
    after: usize,
    value: f64,
    /// Whether the branch may turn there.
    turns: bool,
}

/// The order along a branch, with these values at its points, of what is at these places, beside others. What is behind the same point is in the order of values where all of it is between that point
/// and the next one, and the branch turns at none of it; else it stays as it was found.
fn order_along(points: &[f64], marks: &[Mark], others: &[Mark]) -> Vec<usize> {
    let way = |mark: &Mark| {
        let (from, to) = (
            points.get(mark.after.checked_sub(1)?)?,
            points.get(mark.after)?,
        );
        let inside = |other: &&Mark| (other.value - from) * (other.value - to) <= 0.0;
        let here = |other: &&Mark| other.after == mark.after;
        let mut all = marks.iter().chain(others).filter(here);
        let turns = all.any(|other| other.turns);
        let mut same = marks.iter().filter(here);
        (!turns && same.all(|other| inside(&other))).then(|| (mark.value - from).abs())
    };
    let ways: Vec<f64> = marks.iter().map(|mark| way(mark).unwrap_or(0.0)).collect();
    let mut order: Vec<usize> = (0..marks.len()).collect();
    order.sort_by(|&a, &b| {
        let after = marks[a].after.cmp(&marks[b].after);
        after.then(ways[a].total_cmp(&ways[b]))
    });
    order
}

/// What is in a list, in another order.
fn arranged<T>(list: Vec<T>, order: &[usize]) -> Vec<T> {
    let mut list: Vec<Option<T>> = list.into_iter().map(Some).collect();
    order
        .iter()
        .filter_map(|&place| list[place].take())
        .collect()
}

/// How events and turns were rearranged: where each one was before.
pub(crate) struct Rearranged {
    pub(crate) events: Vec<usize>,
    pub(crate) turns: Vec<usize>,
}

/// Whether the branch may turn at an event: two folds between two points may have values between both.
fn may_turn(kind: EventKind) -> bool {
    matches!(
        kind,
        EventKind::Fold | EventKind::BranchPoint | EventKind::Grazing { turns: true }
    )
}

/// Brings what happened in the order of the branch: what a step hid is found one step later, and what a step shows is found kind by kind.
pub(crate) fn sort(points: &[Point], events: &mut Vec<Event>, turns: &mut Vec<Turn>) -> Rearranged {
    let values: Vec<f64> = points.iter().map(|point| point.value).collect();
    let of_events = events.iter().map(|event| Mark {
        after: event.after,
        value: event.point.value,
        turns: may_turn(event.kind),
    });
    let of_turns = turns.iter().map(|turn| Mark {
        after: turn.after,
        value: turn.value,
        turns: may_turn(turn.kind),
    });
    let (of_events, of_turns): (Vec<Mark>, Vec<Mark>) = (of_events.collect(), of_turns.collect());
    let order = Rearranged {
        events: order_along(&values, &of_events, &of_turns),
        turns: order_along(&values, &of_turns, &of_events),
    };
    *events = arranged(std::mem::take(events), &order.events);
    *turns = arranged(std::mem::take(turns), &order.turns);
    order
}

impl Record {
    /// Brings what happened in the order of the branch, with places in it.
    pub(crate) fn sort(&mut self, places: Option<&mut Places>) {
        let order = sort(&self.points, &mut self.events, &mut self.turns);
        if let Some(places) = places {
            Places::sorted(&mut places.events, &order.events);
            Places::sorted(&mut places.turns, &order.turns);
        }
    }

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

    /// Drops events and turns, each from one on, that are there already: of the same kind and step, and so near in value or not told apart by their
    /// errors.
    pub(crate) fn drop_again(&mut self, [first, turn]: [usize; 2], near: f64) {
        let mut place = first;
        while place < self.events.len() {
            let event = &self.events[place];
            let again = self.events[..place].iter().any(|other| {
                let apart = (other.point.value - event.point.value).abs();
                let known = other.error + event.error;
                (other.kind, other.after) == (event.kind, event.after)
                    && (apart <= near || known.is_finite() && apart <= known)
            });
            if again {
                self.events.remove(place);
            } else {
                place += 1;
            }
        }
        let mut place = turn;
        while place < self.turns.len() {
            let here = &self.turns[place];
            let again = self.turns[..place].iter().any(|other| {
                (other.kind, other.after) == (here.kind, here.after)
                    && (other.value - here.value).abs() <= near
            });
            if again {
                self.turns.remove(place);
            } else {
                place += 1;
            }
        }
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

#[cfg(test)]
mod tests {
    use super::{Mark, order_along};

    fn mark(after: usize, value: f64) -> Mark {
        Mark {
            after,
            value,
            turns: false,
        }
    }

    #[test]
    fn what_is_behind_one_point_is_in_the_order_of_the_branch() {
        let found = [mark(2, 1.7), mark(1, 0.5), mark(2, 1.2)];
        assert_eq!(order_along(&[0.0, 1.0, 2.0], &found, &[]), [1, 2, 0]);
        let found = [mark(1, 1.2), mark(1, 1.7)];
        assert_eq!(order_along(&[2.0, 1.0], &found, &[]), [1, 0]);
    }

    /// An S between two points has the values of its folds between theirs, the later one first.
    #[test]
    fn what_is_beside_a_fold_or_the_end_stays_as_it_was_found() {
        let fold = |value| Mark {
            turns: true,
            ..mark(1, value)
        };
        assert_eq!(
            order_along(&[0.0, 1.0], &[fold(0.7), fold(0.3)], &[]),
            [0, 1]
        );
        let beside = [mark(1, 0.7), mark(1, 0.3)];
        assert_eq!(order_along(&[0.0, 1.0], &beside, &[fold(0.5)]), [0, 1]);
        let beyond = [mark(1, 2.1), mark(1, 1.5)];
        assert_eq!(order_along(&[1.0, 2.0], &beyond, &[]), [0, 1]);
        let behind = [mark(2, 2.0), mark(2, 1.5), mark(0, 1.0)];
        assert_eq!(order_along(&[1.0, 2.0], &behind, &[]), [2, 0, 1]);
        assert_eq!(order_along(&[], &[], &[]), [0; 0]);
    }
}
