//! Touches of levels between two points of a branch.
//!
//! An extreme that is on the other side of its level at the other end of a step has touched it in between. Extremes that went there and
//! back are looked for [inside](super::grazing_within_step), and where extremes appear or disappear near a level, or level crossings do that no
//! extreme explains, or a touch is not located, the step is halved. Each touch is located by [approaching](super::grazing_search) it, and kept
//! ([`Bent::kept`]): the method reads the orbit there ([`BranchProblem::keep_touch`]).

use super::Engine;
use super::counted::PLACES;
use super::grazing_search::{Approach, Reached, on_the_way};
use super::grazing_within_step::Steps;
use super::seen::{Crossed, Seen};
use super::step_parts::step_between;
use crate::branches::extreme::{
    Bend, Extreme, Passage, appears, crossings, distinct, is_copy, passed,
};
use crate::branches::problem::{BranchProblem, Touch};
use crate::continuation::follow::{CurvePoint, Step};
use crate::continuation::locate::{ArcLength, inside};
use crate::continuation::newton::{Newton, NewtonOptions};
use crate::event::{EventKind, Turn};

/// Values that differ by this part of the range are one.
const SAME: f64 = 1e-9;
/// Extremes that are so near to their levels, in units of the gap, at an orbit that touches one, touch as well: Newton's method leaves
/// less between copies.
pub(super) const AT_ONCE: f64 = 1e-8;
/// A slope that is smaller where the branch turns does not jump there.
const STEEP: f64 = 1e-6;
/// An orbit farther from where it was sought than so many steps is another one.
const FARTHEST: f64 = 3.0;
/// A touch as near to an end of its step, as a part of it, shows nothing else than the end.
const AT_END: f64 = 1e-6;
/// Points whose gaps are remembered: those of the last two steps, and the next one.
const READ: usize = 4;
/// Extremes that appear, or disappear, farther from their level, in units of the gap, do not come to it in the same step.
const NEAR: f64 = 0.05;
/// A step is halved so often where extremes appear or disappear, or a touch is not located.
const HALVINGS: usize = 5;
/// And so often where the extremes at its ends do not tell why levels are crossed more or less often: two touches may be that near to each
/// other. Only the halves that do not tell it are halved again.
const UNEXPLAINED: usize = 12;
/// Orbits that part a step, at most.
const PARTED: usize = 64;

/// A step in which levels are touched.
struct TouchSearch<'s> {
    whole: Step<'s>,
    options: NewtonOptions,
    range: f64,
    after: usize,
    /// Contacts and levels that are not looked at.
    without: Vec<[usize; 2]>,
    /// Orbits that parted it so far.
    parted: usize,
    /// Where the branch turned back without a fold, until a touch explains that.
    turned: Option<Turn>,
    /// Where touches were found.
    found: Vec<f64>,
    /// The orbits there, of those that are no corners.
    orbits: Vec<Touching>,
    /// Those at which the branch or its multipliers bend.
    bent: Vec<Bent>,
}

/// An orbit that touches a level.
struct Touching {
    point: CurvePoint,
    /// The end of the part of the step where the level is crossed, if multipliers bend at the touch.
    crossed: Option<CurvePoint>,
}

impl Touching {
    /// Found in a part of a step, between whose ends an extreme passes the level.
    fn of(point: &CurvePoint, bend: Bend, step: Step<'_>, passage: &Passage) -> Self {
        let crossed = if passage.before.is_clear() {
            step.next
        } else {
            step.before
        };
        Self {
            point: point.clone(),
            crossed: (bend != Bend::Smooth).then(|| crossed.clone()),
        }
    }
}

/// A point with the extremes of its gaps.
#[derive(Debug, Clone)]
pub(super) struct Gaps {
    pub(super) point: CurvePoint,
    pub(super) extremes: Vec<Extreme>,
}

impl Gaps {
    pub(super) fn at(problem: &mut dyn BranchProblem, point: &CurvePoint) -> Option<Self> {
        let mut extremes = Vec::new();
        let known = problem.extremes(&point.u, &mut extremes);
        let point = point.clone();
        known.then_some(Self { point, extremes })
    }
}

impl Engine {
    /// Where extremes of gaps reach levels in a step behind so many points, and whether that is where the branch `turned` back without a fold.
    pub(super) fn touches(
        &mut self,
        problem: &mut dyn BranchProblem,
        newton: &mut Newton,
        step: Step<'_>,
        turned: Option<Turn>,
        after: usize,
    ) {
        if !problem.seeks_touches() {
            return;
        }
        let touched = std::mem::take(&mut self.touched);
        let behind = self.crossed.take();
        let earlier = self.seen.len().checked_sub(3);
        let earlier = earlier.map(|place| self.seen[place].point.clone());
        let earlier = earlier.and_then(|point| self.gaps_at(problem, &point));
        let ends = [step.before, step.next].map(|point| self.gaps_at(problem, point));
        let [Some(before), Some(next)] = ends else {
            return;
        };
        let mut parts = vec![before.clone(), next.clone()];
        let steps = earlier.and_then(|earlier| Steps::new(newton, [earlier, before, next]));
        if let Some(mut steps) = steps {
            steps.divide(problem, newton, self.options.newton);
            let [earlier, last] = steps.parts;
            if earlier.len() > 2 {
                let whole = Step {
                    before: &earlier[0].point,
                    next: step.before,
                };
                let mut search = self.touch_search(whole, after - 1);
                search.found = touched;
                search.between_all(problem, newton, &earlier);
                self.bent.append(&mut search.bent);
                let orbits = std::mem::take(&mut search.orbits);
                self.beside_touches(problem, newton, orbits, 2, after - 1);
                if self.ended.is_some() {
                    return;
                }
            }
            parts = last;
        }
        let mut search = self.touch_search(step, after);
        search.turned = turned;
        search.between_all(problem, newton, &parts);
        self.touched = search.found;
        self.bent.append(&mut search.bent);
        let orbits = search.orbits;
        if let (Some(crossed), [earlier @ .., a, b]) = (behind, &self.seen[..]) {
            let ends = [a.clone(), b.clone()];
            let inner = self.farther_behind(problem, newton, &crossed, earlier.last(), [a, b]);
            self.record_between(problem, newton, ends, inner, after);
            if self.ended.is_some() {
                return;
            }
        }
        self.beside_touches(problem, newton, orbits, 1, after);
    }

    /// The same in the step to where the branch ends, which stands already.
    pub(super) fn touches_before_end(
        &mut self,
        problem: &mut dyn BranchProblem,
        newton: &mut Newton,
        before: &CurvePoint,
        end: &CurvePoint,
        after: usize,
    ) {
        let stop = self.ended.take();
        // What was found beyond the end is none of it.
        self.seen.pop();
        let falls = self.seen.last().and_then(|seen| seen.falls);
        self.seen.push(Seen::at(problem, end, falls));
        let step = Step { before, next: end };
        self.touches(problem, newton, step, None, after);
        self.ended = stop;
        problem.record_mut().ends_with_joint();
    }

    /// Where extremes reach other levels than those that an orbit with these extremes touches, between two orbits that are not kept as points.
    pub(super) fn touches_of_others(
        &mut self,
        problem: &mut dyn BranchProblem,
        newton: &mut Newton,
        step: Step<'_>,
        touching: &[Extreme],
        after: usize,
    ) {
        if !problem.seeks_touches() {
            return;
        }
        let mut search = self.touch_search(step, after);
        let touching = touching
            .iter()
            .filter(|extreme| extreme.above.abs() <= AT_ONCE);
        search.without = touching
            .map(|extreme| [extreme.contact, extreme.level])
            .collect();
        let ends = [step.before, step.next].map(|point| search.gaps_at(problem, point));
        let [Some(before), Some(next)] = ends else {
            return;
        };
        search.between_all(problem, newton, &[before, next]);
        self.bent.append(&mut search.bent);
    }

    /// Records what test functions show at touches and behind them, and at no end of the step between the points of these places from the last one
    /// on. Behind a touch they change as a root or along another line: no parabola through three points tells that.
    fn beside_touches(
        &mut self,
        problem: &mut dyn BranchProblem,
        newton: &mut Newton,
        orbits: Vec<Touching>,
        place: usize,
        after: usize,
    ) {
        let Some(before) = self.seen.len().checked_sub(place + 1) else {
            return;
        };
        if orbits.is_empty() || problem.watched().is_empty() {
            return;
        }
        let ends = [before, before + 1].map(|place| self.seen[place].clone());
        let begin = &ends[0].point;
        let along = ArcLength::from(newton, &ends[0].point);
        let whole = along.at(&ends[1].point.u);
        let within = |orbit: &Touching| {
            let part = along.at(&orbit.point.u) / whole;
            part > AT_END && part < 1.0 - AT_END
        };
        let (mut inner, mut earlier) = (Vec::new(), Vec::new());
        let mut farthest = f64::NEG_INFINITY;
        for touching in orbits {
            let inside = within(&touching);
            let Touching { mut point, crossed } = touching;
            // It was come to from either side.
            let norm = newton.norm();
            if norm.product(begin.scale, &point.tangent, &begin.tangent) < 0.0 {
                point.tangent.iter_mut().for_each(|t| *t = -*t);
            }
            let touch = Seen::at(problem, &point, ends[0].falls);
            let crosses = |end: usize| crossed.as_ref().is_some_and(|at| at.u == ends[end].point.u);
            let other = before.checked_sub(1).map(|place| &self.seen[place]);
            if let Some(other) = other.filter(|_| crosses(0)) {
                let touch = touch.clone();
                let crossed = Crossed::at(touch, 0.0);
                earlier.extend(self.farther_behind(
                    problem,
                    newton,
                    &crossed,
                    None,
                    [&ends[0], other],
                ));
            }
            // Behind another step it is not known how far the last point is from it.
            if place == 1 && crosses(1) && along.at(&touch.point.u) / whole > farthest {
                farthest = along.at(&touch.point.u) / whole;
                let way = ArcLength::over(newton, step_between([&touch, &ends[1]]));
                self.crossed = Some(Crossed::at(touch.clone(), way.at(&ends[1].point.u)));
            }
            if let Some(end) = crossed.filter(|_| inside) {
                let end = Seen::at(problem, &end, ends[0].falls);
                inner.extend(self.behind_touch(problem, newton, &touch, &end));
            }
            if inside {
                inner.push(touch);
            }
        }
        if let Some(other) = before.checked_sub(1).filter(|_| !earlier.is_empty()) {
            let step = [self.seen[other].clone(), ends[0].clone()];
            self.record_between(problem, newton, step, earlier, after - 1);
            if self.ended.is_some() {
                return;
            }
        }
        self.record_between(problem, newton, ends, inner, after);
    }

    /// A search for the touches in a step behind so many points.
    fn touch_search<'s>(&self, whole: Step<'s>, after: usize) -> TouchSearch<'s> {
        TouchSearch {
            whole,
            options: self.options.newton,
            range: (self.options.to - self.options.from).abs(),
            after,
            without: Vec::new(),
            parted: 0,
            turned: None,
            found: Vec::new(),
            orbits: Vec::new(),
            bent: Vec::new(),
        }
    }

    /// Remembers extremes of an orbit as those of the same one in other unknowns, in which it was not solved for.
    pub(super) fn keep_gaps(&mut self, gaps: Option<Gaps>, there: Option<&CurvePoint>) {
        if let (Some(gaps), Some(point)) = (gaps, there.cloned()) {
            self.remember_gaps(Gaps { point, ..gaps });
        }
    }

    fn remember_gaps(&mut self, gaps: Gaps) {
        if self.gaps.len() == READ {
            self.gaps.remove(0);
        }
        self.gaps.push(gaps);
    }

    /// The extremes at a point, which are read once.
    pub(super) fn gaps_at(
        &mut self,
        problem: &mut dyn BranchProblem,
        point: &CurvePoint,
    ) -> Option<Gaps> {
        let mut known = self.gaps.iter();
        if let Some(known) = known.find(|gaps| gaps.point.u == point.u) {
            let (point, extremes) = (point.clone(), known.extremes.clone());
            return Some(Gaps { point, extremes });
        }
        let gaps = Gaps::at(problem, point)?;
        self.remember_gaps(gaps.clone());
        Some(gaps)
    }
}

/// A touch at which the branch or its multipliers bend more than a root does.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub(super) struct Bent {
    /// Number of points of the branch before it.
    pub(super) after: usize,
    /// Of the event.
    #[cfg_attr(feature = "serde", serde(with = "crate::serialise"))]
    pub(super) value: f64,
    /// The sharpest of all levels that are touched there.
    pub(super) bend: Bend,
}

impl Bent {
    /// Whether it is what a file may say.
    pub(super) fn is_possible(&self) -> bool {
        self.value.is_finite()
    }

    /// Has a touch kept, of an orbit with these extremes. Says what bends there, if anything does so and it is an event.
    pub(super) fn kept(
        problem: &mut dyn BranchProblem,
        newton: &mut Newton,
        step: Step<'_>,
        touch: &Touch,
        extremes: &[Extreme],
    ) -> Option<Self> {
        let known = problem.record().events.len();
        problem.keep_touch(newton, step, touch);
        let event = problem.record().events.get(known)?;
        let touching = extremes.iter();
        let touching = touching.filter(|extreme| extreme.above.abs() <= AT_ONCE);
        let bend = touching.fold(touch.extreme.bend, |bend, extreme| bend.max(extreme.bend));
        (bend > Bend::Root).then_some(Self {
            after: touch.after,
            value: event.point.value,
            bend,
        })
    }
}

impl TouchSearch<'_> {
    /// A point with the extremes that are looked at.
    fn gaps_at(&self, problem: &mut dyn BranchProblem, point: &CurvePoint) -> Option<Gaps> {
        let mut gaps = Gaps::at(problem, point)?;
        let left_out = |extreme: &Extreme| self.without.contains(&[extreme.contact, extreme.level]);
        gaps.extremes.retain(|extreme| !left_out(extreme));
        Some(gaps)
    }

    /// Looks at all parts of the step.
    fn between_all(
        &mut self,
        problem: &mut dyn BranchProblem,
        newton: &mut Newton,
        parts: &[Gaps],
    ) {
        for pair in parts.windows(2) {
            self.between(problem, newton, [&pair[0], &pair[1]], 0);
        }
    }

    /// Looks at a part of the step, which is `halved` so often already, or at both halves of it.
    fn between(
        &mut self,
        problem: &mut dyn BranchProblem,
        newton: &mut Newton,
        [before, next]: [&Gaps; 2],
        halved: usize,
    ) {
        let mut found = passed(&before.extremes, &next.extremes);
        let begun = found.iter().filter(|passage| passage.before.is_clear());
        let more = 2 * begun.count() + crossings(&before.extremes);
        let fewer = found.iter().filter(|passage| passage.next.is_clear());
        let explained = more == 2 * fewer.count() + crossings(&next.extremes);
        let appeared = appears(&before.extremes, &next.extremes, NEAR);
        let part = Step {
            before: &before.point,
            next: &next.point,
        };
        let divided = if explained {
            appeared && halved < HALVINGS
        } else {
            halved < UNEXPLAINED
        };
        if divided && self.between_halves(problem, newton, [before, next], halved) {
            return;
        }
        if !explained && found.is_empty() {
            self.omit(problem, part);
        }
        while let Some(&passage) = found.first() {
            let mut at_once = vec![passage];
            if self.touch(problem, newton, part, &found, &mut at_once) {
                found.retain(|other| !at_once.contains(other));
            } else if halved < HALVINGS
                && self.between_halves(problem, newton, [before, next], halved)
            {
                // What was located already is known there.
                return;
            } else {
                self.omit(problem, part);
                found.retain(|other| !is_copy(&passage, other));
            }
        }
    }

    /// Looks at both halves of a part, if an orbit between them is found. Says whether.
    fn between_halves(
        &mut self,
        problem: &mut dyn BranchProblem,
        newton: &mut Newton,
        [before, next]: [&Gaps; 2],
        halved: usize,
    ) -> bool {
        if self.parted == PARTED {
            return false;
        }
        self.parted += 1;
        let part = Step {
            before: &before.point,
            next: &next.point,
        };
        let middle = PLACES.into_iter().find_map(|place| {
            let middle = inside(problem.equations(), newton, part, place, self.options)?;
            self.gaps_at(problem, &middle)
        });
        let Some(middle) = middle else {
            return false;
        };
        self.between(problem, newton, [before, &middle], halved + 1);
        self.between(problem, newton, [&middle, next], halved + 1);
        true
    }

    /// Records what could not be located.
    fn omit(&self, problem: &mut dyn BranchProblem, step: Step<'_>) {
        let [a, b] = step.parameters();
        problem.record_mut().turns.push(Turn {
            kind: EventKind::Grazing {
                // What was located nowhere may be where the branch turned.
                turns: self.turned.is_some(),
            },
            value: 0.5 * (a + b),
            test: f64::NAN,
            after: self.after,
        });
    }

    /// Locates where the first of the extremes that were `found` reaches its level, with what the matrix has or else with more of the
    /// equations in it, and keeps it. Writes which of them do so `at_once`.
    fn touch(
        &mut self,
        problem: &mut dyn BranchProblem,
        newton: &mut Newton,
        step: Step<'_>,
        found: &[Passage],
        at_once: &mut Vec<Passage>,
    ) -> bool {
        if self.locate(problem, newton, step, found, at_once) {
            return true;
        }
        if !problem.couple_fully_once(true) {
            return false;
        }
        let mut newton = Newton::new(problem.equations());
        let kept = self.locate(problem, &mut newton, step, found, at_once);
        problem.count(&newton);
        problem.couple_fully_once(false);
        kept
    }

    /// From the end of the step where the level is not crossed, or anywhere between both ends.
    fn locate(
        &mut self,
        problem: &mut dyn BranchProblem,
        newton: &mut Newton,
        step: Step<'_>,
        found: &[Passage],
        at_once: &mut Vec<Passage>,
    ) -> bool {
        let (from, extreme) = found[0].clear_end(step);
        let farthest = FARTHEST * newton.norm().length(from.scale, &step.difference());
        let approach = Approach {
            from,
            extreme,
            farthest,
        };
        let options = self.options;
        let same = SAME * self.range;
        let is_known = |value: f64| self.found.iter().any(|other| (other - value).abs() <= same);
        let near = approach.close_in(problem, newton, options);
        let located = match near {
            Some(near) if !is_known(near.value()) => Some(near),
            // Of an extreme that goes through its level twice, what leads to one of both places leads back to the other.
            Some(near) => {
                let other = (extreme.bend != Bend::Corner)
                    .then(|| on_the_way(problem, newton, step, found[0], options))
                    .flatten();
                let other = other.filter(|other| other.is_apart(&near, same));
                other.or(Some(near))
            }
            None => on_the_way(problem, newton, step, found[0], options),
        };
        let Some(Reached {
            located,
            extreme,
            error,
            rate,
        }) = located
        else {
            return false;
        };
        // Contacts that are copies of each other, and orbits with a symmetry, touch in several places at once: one event.
        let mut extremes = Vec::new();
        problem.extremes(&located.point.u, &mut extremes);
        let touches = |other: &&Passage| {
            let there = other.before.nearest(&extremes);
            let there = there.or(other.next.nearest(&extremes));
            there.is_some_and(|there| there.above.abs() <= AT_ONCE)
        };
        at_once.extend(found[1..].iter().filter(touches));
        let value = located.point.parameter();
        if is_known(value) {
            return true;
        }
        self.found.push(value);
        if extreme.bend != Bend::Corner {
            self.orbits
                .push(Touching::of(&located.point, extreme.bend, step, &found[0]));
        }
        let touch = Touch {
            located,
            extreme,
            error,
            rate,
            contacts: distinct(at_once),
            turns: self.turns_at(problem, value),
            after: self.after,
        };
        self.bent
            .extend(Bent::kept(problem, newton, self.whole, &touch, &extremes));
        true
    }

    /// Whether a touch is where the branch turned: at a corner the slope jumps, and the value there is beyond those of both ends of the
    /// step.
    fn turns_at(&mut self, problem: &mut dyn BranchProblem, value: f64) -> bool {
        let [a, b] = self.whole.parameters();
        let turned = self.turned.take_if(|turned| {
            let jumps = turned.test.abs() > STEEP;
            (jumps && (value <= a.min(b) || value >= a.max(b)))
                || (value - turned.value).abs() <= SAME * self.range
        });
        // That is where the branch turned, and why.
        turned.is_some_and(|turned| {
            problem.record_mut().drop_turn(&turned);
            true
        })
    }
}

/// The number of contacts of which an extreme touches a level.
pub(super) fn touching(extremes: &[Extreme]) -> usize {
    // They are in order of contacts.
    extremes
        .chunk_by(|a, b| a.contact == b.contact)
        .filter(|of| of.iter().any(|extreme| extreme.above.abs() <= AT_ONCE))
        .count()
}
