//! Beyond a touch of a level at which the force jumps, or its slope is unbounded.
//!
//! An orbit whose extreme is by `h` beyond the level is there for a time that goes as the root of `h`, and the jump of the force gives it
//! an impulse that does so too. With the equations `R(u) = 0` as they are without it, and `v` what the jump does to them,
//!
//! ```text
//! R(u) + sqrt(h) v + O(h) = 0,    h = d . (u - u_0)                                                            (1)
//! ```
//!
//! at the touch `u_0`, so that `h` is quadratic in the arc length and the branch goes on as
//!
//! ```text
//! u = u_0 - sqrt(h) w + O(h),    R_u w = v,    d . w = 0                                                       (2)
//! ```
//!
//! which is a corner of any angle. If it is sharper than a right one, no plane across the tangent before it cuts the branch behind it, and
//! steps of arc length end. But `h` itself goes through zero from one side to the other. At a prescribed `h`, where `sqrt(h)` is
//! constant, the equations are as well conditioned as those of the touch. The orbit is sought from (2) with the matrix of the touch: one
//! side is reached from the other with steps along the tangent, which bring `h` to what is wanted, and steps that solve (1).
//!
//! Where the force goes as `g^p` beyond the level, its impulse goes as `h^(p + 1/2)` in place of the root in (1). With `p` below a half the
//! branch has the same corner. Below one its slope is continuous, but it goes to its limit as `h^(p - 1/2)`, which at `p = 0.6` is still a
//! fortieth of what it is at a height of one when rounding hides `h`: no step of arc length sees that the branch bends. So such a touch is passed in the
//! same way, where steps fail.
//!
//! By shooting the branch has a kink too where a gap passes a level at which the force jumps just where its unknowns begin to tell the orbit. Nothing
//! happens to the orbit there, but Newton's method may fail beside it: it is passed in the same way.
//!
//! If the force on the other side pulls the gap on, motions that pass the level go far away however slowly they pass it: then there is
//! no orbit at a small `h`, and the branch ends.
//!
//! Source: di Bernardo, Budd, Champneys and Kowalczyk (2008), Piecewise-smooth Dynamical Systems, section 6.2 (the square root) and 7.1
//! (corners of branches); Keller (1977), Numerical solution of bifurcation and nonlinear eigenvalue problems (a border that is not the
//! tangent).

use super::corner_search::{Corner, CornerSearch};
use super::grazing::Bent;
use super::grazing::touching;
use super::grazing_search::{Approach, Reached};
use super::seen::Seen;
use super::{Engine, Looked};
use crate::branches::extreme::{Bend, Extreme, passed};
use crate::branches::point::Event;
use crate::branches::problem::{BranchProblem, Change, Touch};
use crate::continuation::follow::{CurvePoint, Step, Stop};
use crate::continuation::newton::Newton;
use crate::continuation::problem::Norm;
use crate::event::{EventKind, Turn};
use crate::numeric::linear::dot;

/// A corner is looked for as far ahead as so many times the step that failed.
const REACH: f64 = 2.0;
/// A step so much shorter is worth another look.
const SHORTER: f64 = 0.1;
/// An orbit farther away than so many times that is another one.
const FARTHEST: f64 = 10.0;
/// Extremes that are farther from their level, in units of the gap, are not those that a step fails at.
const NEAR: f64 = 0.2;
/// An event that so many of its errors do not tell apart from a touch is one with it.
const ERRORS: f64 = 3.0;
/// Kinks where nothing touches are looked for where so short a step fails.
const SHORTEST: f64 = 1e-3;
/// Where the slope is unbounded the branch is smooth at last, and steps lead on unless they fail when they are so short.
const BENDS_WITHIN: f64 = 1e-5;
/// A walk that ends nearer to a touch than this ends there.
const PULLED: f64 = 1e-5;

/// What is tried out on the way.
struct Tried<'p> {
    problem: &'p mut dyn BranchProblem,
    newton: Newton,
    coupled: bool,
}

impl<'p> Tried<'p> {
    /// With all of the equations in the matrix.
    fn begin(problem: &'p mut dyn BranchProblem) -> Self {
        let coupled = problem.couple_fully_once(true);
        Self {
            newton: Newton::new(problem.equations()),
            problem,
            coupled,
        }
    }

    fn end(self) {
        self.problem.count(&self.newton);
        if self.coupled {
            self.problem.couple_fully_once(false);
        }
    }
}

impl Engine {
    /// Looks for a corner of the branch ahead of a point where a step of some length failed.
    pub(super) fn corner_ahead(
        &mut self,
        problem: &mut dyn BranchProblem,
        at: &CurvePoint,
        step: f64,
    ) -> bool {
        let looked = self.looked.take().filter(|looked| looked.at == at.u);
        let enough = |looked: &Looked| step > SHORTER * looked.step;
        if !problem.corners() || looked.as_ref().is_some_and(enough) {
            self.looked = looked;
            return false;
        }
        self.looked = Some(Looked {
            at: at.u.clone(),
            step,
        });
        let ahead = ahead(problem, at, step);
        self.pass(problem, at, &ahead)
    }

    /// Looks for a corner in the step to a point that is not kept yet.
    pub(super) fn corner_before(
        &mut self,
        problem: &mut dyn BranchProblem,
        next: &CurvePoint,
    ) -> bool {
        if !problem.force_jumps() {
            return false;
        }
        let last = self.seen.last().map(|seen| seen.point.clone());
        let Some(before) = last.filter(|last| last.u.len() == next.u.len()) else {
            return false;
        };
        let [Some(here), Some(there)] = [&before, next].map(|at| self.gaps_at(problem, at)) else {
            return false;
        };
        let norm = Norm::of(problem.equations());
        let step = Step {
            before: &before,
            next,
        };
        let length = norm.length(before.scale, &step.difference());
        let through = passed(&here.extremes, &there.extremes).into_iter();
        let through = through.map(|passage| (length, passage.before));
        let through: Vec<_> = through.filter(|(_, extreme)| extreme.jumps).collect();
        !through.is_empty() && self.pass(problem, &before, &through)
    }

    /// Why a walk ended, with the reason if that is a touch behind which there are no orbits near by.
    pub(super) fn named(&self, problem: &mut dyn BranchProblem, stop: Stop) -> Stop {
        let (Stop::StepTooShort { value, .. }, Some(last)) = (stop, self.seen.last()) else {
            return stop;
        };
        if !problem.force_jumps() {
            return stop;
        }
        let u = &last.point.u;
        let mut extremes = Vec::new();
        problem.extremes(u, &mut extremes);
        let touches = |extreme: &Extreme| extreme.jumps && extreme.above.abs() < PULLED;
        if extremes.iter().any(touches) || problem.slowest(u) < PULLED {
            return Stop::PulledOn { value };
        }
        stop
    }

    /// Passes the nearest corner to which one of these extremes leads: records it, and remembers a point behind it to go on from.
    fn pass(
        &mut self,
        problem: &mut dyn BranchProblem,
        at: &CurvePoint,
        extremes: &[(f64, Extreme)],
    ) -> bool {
        if extremes.is_empty() {
            return false;
        }
        let mut tried = Tried::begin(problem);
        let found = extremes.iter().filter_map(|(length, extreme)| {
            let mut search = self.search(&mut tried, at, *extreme, *length);
            let corner = search.corner()?;
            let next = search.behind(&corner)?;
            Some((search.distance(at, &corner.end), corner, next))
        });
        let nearest = found.min_by(|a, b| a.0.total_cmp(&b.0));
        // Where the equations hold no more at a touch, something else comes first, and the way to it is to be gone in shorter steps.
        let nearest = nearest.filter(|(_, corner, next)| {
            let mut both = [&corner.touch.located.point, next].into_iter();
            both.all(|at| tried.problem.describes(at))
        });
        if let Some((_, corner, next)) = &nearest {
            let after = tried.problem.points();
            self.keep_corner(&mut tried, [at, next], corner, after);
            self.seen.clear();
            self.gaps.clear();
            self.touched.clear();
            self.crossed = None;
            self.refused = true;
        }
        tried.end();
        let found = nearest.is_some();
        self.passed = nearest.map(|(_, _, next)| next);
        found
    }

    /// The search for the corner that an extreme leads to, on a way of some length.
    fn search<'s>(
        &self,
        tried: &'s mut Tried<'_>,
        from: &'s CurvePoint,
        extreme: Extreme,
        length: f64,
    ) -> CornerSearch<'s> {
        CornerSearch {
            problem: &mut *tried.problem,
            newton: &mut tried.newton,
            options: self.options.newton,
            range: [self.options.from, self.options.to],
            approach: Approach {
                from,
                extreme,
                farthest: FARTHEST * length,
            },
        }
    }

    /// Records the touch at a corner, what happens between the point before it and the corner, and what between it and the point behind.
    fn keep_corner(
        &mut self,
        tried: &mut Tried<'_>,
        [before, next]: [&CurvePoint; 2],
        corner: &Corner,
        after: usize,
    ) {
        let Tried {
            problem, newton, ..
        } = tried;
        let Corner {
            touch, end, begin, ..
        } = corner;
        let (value, error) = (touch.located.point.parameter(), touch.error);
        let known = problem.record().events.len();
        let places = problem.record().turns.len();
        // On the side that is clear the branch is smooth up to the touch.
        let comes_clear = end.u == touch.located.point.u;
        let mut turns = corner.turns();
        let mut first = known;
        let mut from = before;
        for point in corner.way.iter().chain([end]) {
            self.events_between(*problem, newton, [from, point], after, |_| true);
            from = point;
        }
        if comes_clear {
            first = problem.record().events.len();
        }
        let is_corner = touch.extreme.bend == Bend::Corner;
        if !is_corner {
            turns &= !self.folds_within(*problem, newton, [end, begin], after);
        }
        if !comes_clear {
            first = problem.record().events.len();
        }
        // The branch may have turned there.
        self.falls = None;
        self.events_between(*problem, newton, [begin, next], after, |_| true);
        if self.ended.is_some() {
            return;
        }
        let record = problem.record_mut();
        let mut behind = record.events.split_off(first);
        if is_corner {
            // Multipliers are unbounded at the touch: what a series leaves of that beside it is none of its own.
            drop_beside(&mut record.events, known, value);
            drop_beside(&mut behind, 0, value);
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
                before: if comes_clear { before } else { next },
                next: &touch.located.point,
            };
            self.keep_touch(*problem, newton, step, touch, turns, after);
        }
        problem.record_mut().events.extend(behind);
    }

    /// Keeps the touch at a corner.
    fn keep_touch(
        &mut self,
        problem: &mut dyn BranchProblem,
        newton: &mut Newton,
        step: Step<'_>,
        touch: &Reached,
        turns: bool,
        after: usize,
    ) {
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
        let bent = Bent::kept(problem, newton, step, &touch, &extremes);
        self.bent.extend(bent);
    }

    /// What changes its sign between the two sides of a touch that is no corner: slopes and multipliers may be continuous and change
    /// faster than a way of points shows. Says whether the branch turns there by a fold, and not by its corner.
    fn folds_within(
        &mut self,
        problem: &mut dyn BranchProblem,
        newton: &mut Newton,
        sides: [&CurvePoint; 2],
        after: usize,
    ) -> bool {
        let (events, turns) = {
            let record = problem.record();
            (record.events.len(), record.turns.len())
        };
        let is_zero = |change: &Change| change.kind != EventKind::BranchPoint;
        self.events_between(problem, newton, sides, after, is_zero);
        let record = problem.record_mut();
        let mut place = 0;
        record.turns.retain(|turn| {
            place += 1;
            place <= turns || turn.kind != EventKind::Fold
        });
        let mut found = record.events[events..].iter();
        found.any(|event| event.kind == EventKind::Fold)
    }

    /// What changes its sign between two points that are not kept as a step.
    fn events_between(
        &mut self,
        problem: &mut dyn BranchProblem,
        newton: &mut Newton,
        ends: [&CurvePoint; 2],
        after: usize,
        wanted: impl Fn(&Change) -> bool,
    ) {
        let [a, b] = ends.map(|point| {
            let seen = Seen::at(problem, point, self.falls);
            self.falls = seen.falls;
            seen
        });
        if self.ended.is_none() {
            self.record_all(problem, newton, [&a, &b], after, wanted);
        }
    }
}

/// The extremes that come to levels where the branch may have a corner, the nearest first, with the length of the way to them.
fn ahead(problem: &mut dyn BranchProblem, at: &CurvePoint, step: f64) -> Vec<(f64, Extreme)> {
    let mut extremes = Vec::new();
    let mut ahead: Vec<(f64, Extreme)> = Vec::new();
    let mut form = vec![0.0; at.u.len()];
    problem.extremes(&at.u, &mut extremes);
    if step < SHORTEST {
        problem.add_beginnings(&at.u, &mut extremes);
    }
    for extreme in extremes {
        let bends = match extreme.bend {
            Bend::Corner => true,
            Bend::Steep => step < BENDS_WITHIN,
            Bend::Root | Bend::Smooth => false,
        };
        if !bends || extreme.above.abs() > NEAR {
            continue;
        }
        let range = at.scale.parameter;
        let known = problem.extreme_form(&at.u, &extreme, range, &mut form);
        let distance = -extreme.above / dot(&form, &at.tangent);
        if known && distance > 0.0 && distance < REACH * step {
            ahead.push((distance.max(step), extreme));
        }
    }
    ahead.sort_by(|a, b| a.0.total_cmp(&b.0));
    ahead
}

/// Drops those of the events from one on that their errors, so many times, do not tell apart from a touch at a value.
fn drop_beside(events: &mut Vec<Event>, first: usize, touch: f64) {
    let mut place = 0;
    events.retain(|event| {
        place += 1;
        place <= first || (event.point.value - touch).abs() > ERRORS * event.error
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
