//! What happens on both sides of a [corner](super::corner): events on the way to it and behind it, and the touch itself.
//!
//! On the side that is clear the branch is smooth up to the touch, and is looked at as a step is. On the other one orbits are
//! [looked for](super::beyond_corner) at their heights. What errors do not tell apart from the touch is one with it.

use std::iter;

use super::Engine;
use super::corner::{Passed, Tried};
use super::corner_search::{Beside, Corner};
use super::grazing::{Bent, touching};
use super::grazing_search::{Reached, again};
use super::seen::Seen;
use crate::branches::extreme::{Bend, Extreme};
use crate::branches::point::Event;
use crate::branches::problem::{BranchProblem, Change, Touch};
use crate::continuation::follow::{CurvePoint, Step};
use crate::event::{EventKind, Turn};

/// An event that so many of its errors do not tell apart from a touch is one with it.
const ERRORS: f64 = 3.0;

impl Engine {
    /// Records the touch at a corner, what happens between the point before it and the corner, and what between it and the point behind. Returns the
    /// orbit before that, if it is beyond the level.
    pub(super) fn keep_corner(
        &mut self,
        tried: &mut Tried<'_>,
        before: &CurvePoint,
        passed: &Passed,
        after: usize,
    ) -> Option<Seen> {
        let Passed { corner, next, .. } = passed;
        let Corner {
            touch, end, begin, ..
        } = corner;
        let (value, error) = (touch.located.point.parameter(), touch.error);
        let known = tried.problem.record().events.len();
        let places = tried.problem.record().turns.len();
        // On the side that is clear the branch is smooth up to the touch.
        let comes_clear = passed.extreme.is_clear();
        let mut turns = corner.turns();
        let mut first = known;
        let way = self.way_to_corner(tried, before, passed, after);
        self.events_along(tried, before, &way, after);
        let mut touching = Vec::new();
        tried
            .problem
            .extremes(&touch.located.point.u, &mut touching);
        self.touches_beside_corner(tried, [before, end], &touching, after);
        if comes_clear {
            first = tried.problem.record().events.len();
        }
        let is_corner = touch.extreme.bend == Bend::Corner;
        if !is_corner {
            turns &= !self.folds_within(tried, [end, begin], after);
        }
        if !comes_clear {
            first = tried.problem.record().events.len();
        }
        // The branch may have turned there.
        self.falls = None;
        let way = self.way_from_corner(tried, before, passed);
        self.events_between_all(tried, &way, after);
        self.touches_beside_corner(tried, [begin, &next.point], &touching, after);
        if self.ended.is_some() {
            return None;
        }
        let record = tried.problem.record_mut();
        let mut behind = record.events.split_off(first);
        if is_corner {
            // Multipliers are unbounded at the touch: what a series leaves of that beside it is none of its own.
            drop_beside(&mut record.events, known, [value, error]);
            drop_beside(&mut behind, 0, [value, error]);
            turns ^= drop_places_beside(&mut record.turns, places, [value, error]);
        }
        if turns {
            // A fold and a turn that are not told apart are none.
            let dropped = drop_fold_beside(&mut record.events, known, [value, error])
                || drop_fold_beside(&mut behind, 0, [value, error]);
            turns = !dropped;
        }
        if !touch.extreme.begins {
            let step = Step {
                before: if comes_clear { before } else { &next.point },
                next: &touch.located.point,
            };
            self.keep_touch(tried, step, touch, turns, after);
        }
        tried.problem.record_mut().events.extend(behind);
        // The step before the corner and the one behind it are behind as many points.
        self.divided.retain(|(place, _)| *place != after);
        // Multipliers of an orbit that touches are those of either side.
        let behind = way.into_iter().rev().nth(1);
        behind.filter(|seen| comes_clear && seen.point != corner.begin)
    }

    /// Orbits on the way from the last point to a corner, and that where the branch ends there. What they show in the step to the last point, which may be next
    /// to the corner, is recorded.
    fn way_to_corner(
        &mut self,
        tried: &mut Tried<'_>,
        before: &CurvePoint,
        passed: &Passed,
        after: usize,
    ) -> Vec<Seen> {
        let Passed {
            corner,
            extreme,
            length,
            ..
        } = passed;
        if extreme.is_clear() {
            return vec![Seen::at(tried.problem, &corner.end, self.falls)];
        }
        let outer = Beside {
            point: before.clone(),
            extreme: *extreme,
        };
        let earlier = self.earlier_beyond(tried.problem, before, extreme);
        let outers: Vec<Beside> = iter::once(outer).chain(earlier).collect();
        let search = self.search(tried, before, *extreme, *length);
        let mut way = self.beyond_corner(search, corner, &outers, true);
        let last = way.iter().position(|seen| seen.point == *before);
        let behind = way.split_off(last.map_or(0, |last| last + 1));
        if way.len() > 2 {
            self.record_pair(tried.problem, &mut tried.newton, &way, after - 1);
        }
        behind
    }

    /// The point before the last one, if it is farther beyond the level to which an extreme of that leads.
    fn earlier_beyond(
        &self,
        problem: &mut dyn BranchProblem,
        last: &CurvePoint,
        extreme: &Extreme,
    ) -> Option<Beside> {
        let point = match &self.seen[..] {
            [.., earlier, there] if there.point == *last => &earlier.point,
            // It was followed in other unknowns.
            _ => self.earlier.as_ref()?,
        };
        if point.u.len() != last.u.len() {
            return None;
        }
        let there = again(problem, &point.u, extreme)?;
        (there.above / extreme.above > 1.0).then(|| Beside {
            point: point.clone(),
            extreme: there,
        })
    }

    /// Orbits on the way from where the branch begins behind a corner to the point where the walk goes on.
    fn way_from_corner(
        &mut self,
        tried: &mut Tried<'_>,
        before: &CurvePoint,
        passed: &Passed,
    ) -> Vec<Seen> {
        let Passed {
            corner,
            extreme,
            length,
            next,
            ..
        } = passed;
        if !extreme.is_clear() {
            let begin = Seen::at(tried.problem, &corner.begin, self.falls);
            let next = Seen::at(tried.problem, &next.point, begin.falls);
            return vec![begin, next];
        }
        let search = self.search(tried, before, *extreme, *length);
        self.beyond_corner(search, corner, std::slice::from_ref(next), false)
    }

    /// What happens on the way from the last point along others, none of which is kept as a point.
    fn events_along(
        &mut self,
        tried: &mut Tried<'_>,
        before: &CurvePoint,
        way: &[Seen],
        after: usize,
    ) {
        let [first, ..] = way else {
            return;
        };
        let step = Step {
            before,
            next: &first.point,
        };
        self.events(tried.problem, &mut tried.newton, step, after);
        self.events_between_all(tried, way, after);
    }

    /// What changes its sign from one to the next of orbits that are not kept as points.
    fn events_between_all(&mut self, tried: &mut Tried<'_>, way: &[Seen], after: usize) {
        for pair in way.windows(2) {
            if self.ended.is_some() {
                return;
            }
            let pair = [&pair[0], &pair[1]];
            self.record_part(tried.problem, &mut tried.newton, pair, after);
        }
        if let Some(last) = way.last() {
            self.falls = last.falls;
        }
    }

    /// What else is touched on one side of a corner, at which these extremes touch.
    fn touches_beside_corner(
        &mut self,
        tried: &mut Tried<'_>,
        [before, next]: [&CurvePoint; 2],
        touching: &[Extreme],
        after: usize,
    ) {
        let step = Step { before, next };
        if self.ended.is_none() {
            self.touches_of_others(tried.problem, &mut tried.newton, step, touching, after);
        }
    }

    /// Keeps the touch at a corner.
    fn keep_touch(
        &mut self,
        tried: &mut Tried<'_>,
        step: Step<'_>,
        touch: &Reached,
        turns: bool,
        after: usize,
    ) {
        let Tried {
            problem, newton, ..
        } = tried;
        let mut extremes = Vec::new();
        problem.extremes(&touch.located.point.u, &mut extremes);
        let touch = Touch {
            contacts: touching(&extremes),
            turns,
            located: touch.located.clone(),
            extreme: touch.extreme,
            error: touch.error,
            rate: touch.rate,
            after,
        };
        let bent = Bent::kept(*problem, newton, step, &touch, &extremes);
        self.bent.extend(bent);
    }

    /// What changes its sign between the two sides of a touch that is no corner: slopes and multipliers may be continuous and change
    /// faster than a way of points shows. Says whether the branch turns there by a fold, and not by its corner.
    fn folds_within(
        &mut self,
        tried: &mut Tried<'_>,
        sides: [&CurvePoint; 2],
        after: usize,
    ) -> bool {
        let (events, turns) = {
            let record = tried.problem.record();
            (record.events.len(), record.turns.len())
        };
        let is_zero = |change: &Change| change.kind != EventKind::BranchPoint;
        let [a, b] = sides.map(|point| {
            let seen = Seen::at(tried.problem, point, self.falls);
            self.falls = seen.falls;
            seen
        });
        if self.ended.is_none() {
            self.record_all(tried.problem, &mut tried.newton, [&a, &b], after, is_zero);
        }
        let record = tried.problem.record_mut();
        let mut place = 0;
        record.turns.retain(|turn| {
            place += 1;
            place <= turns || turn.kind != EventKind::Fold
        });
        let mut found = record.events[events..].iter();
        found.any(|event| event.kind == EventKind::Fold)
    }
}

/// Drops those of the events from one on that their errors, so many times, do not tell apart from a touch at a value; where theirs is not known, the error of
/// the touch in its place.
fn drop_beside(events: &mut Vec<Event>, first: usize, [touch, error]: [f64; 2]) {
    let mut place = 0;
    events.retain(|event| {
        place += 1;
        let error = if event.error.is_finite() {
            event.error
        } else {
            error
        };
        place <= first || (event.point.value - touch).abs() > ERRORS * error
    });
}

/// Drops the places from one on where something jumps no farther from a corner than the error of its value: it jumps there. Says whether the
/// slope does so an odd number of times, beside what both sides of the corner tell of it.
fn drop_places_beside(turns: &mut Vec<Turn>, first: usize, [touch, error]: [f64; 2]) -> bool {
    let (mut place, mut turned) = (0, false);
    turns.retain(|turn| {
        place += 1;
        let beside = error.is_finite() && (turn.value - touch).abs() <= ERRORS * error;
        let dropped = place > first && beside;
        turned ^= dropped && turn.kind == EventKind::Fold;
        !dropped
    });
    turned
}

/// Drops a fold among the events from one on that errors do not tell apart from a touch. Says whether there was one.
fn drop_fold_beside(events: &mut Vec<Event>, first: usize, [touch, error]: [f64; 2]) -> bool {
    let beside = |event: &Event| {
        let apart = (event.point.value - touch).abs();
        event.kind == EventKind::Fold && event.error.is_finite() && apart <= error + event.error
    };
    let place = events.iter().skip(first).position(beside);
    if let Some(place) = place {
        events.remove(first + place);
    }
    place.is_some()
}
