//! What a walk does where it cannot go on as it is: it goes back to a point before, for a shorter step or for other unknowns, or it ends.

use super::Engine;
use super::seen::{Former, Seen};
use super::walk::Asked;
use crate::branches::problem::BranchProblem;
use crate::continuation::follow::{CurvePoint, Halted, Start, Step, Stop};
use crate::continuation::newton::NewtonError;
use crate::continuation::problem::Norm;

/// A step that went too far is made again with this part of its length.
const SHORTER: f64 = 0.3;
/// Of the step that was asked for last from the same point, the next one is this part at most.
const AT_MOST: f64 = 0.5;
/// A gap that would turn at this height beyond its level, in units of half of its range, does not pass it.
pub(crate) const STOPPED: f64 = 1e-12;

impl Engine {
    /// Why no equations are found behind the last point.
    pub(super) fn lost(&self, problem: &mut dyn BranchProblem) -> Stop {
        let last = problem.kept().points.last().map(|point| point.value);
        let stop = Stop::StepTooShort {
            step: self.options.steps.smallest,
            value: last.unwrap_or(self.options.from),
            reason: NewtonError::NoEquations {},
        };
        self.named(problem, stop)
    }

    /// Makes the step to a point again, shorter, if there was one. Not if a gap hardly passes its level any more.
    pub(super) fn go_back(&mut self, problem: &mut dyn BranchProblem, next: &CurvePoint) -> bool {
        let last = self.seen.last().map(|seen| seen.point.clone());
        if let Some(before) = last.filter(|last| last.u.len() == next.u.len()) {
            if problem.slowest(&before.u) < STOPPED {
                return false;
            }
            let step = Step {
                before: &before,
                next,
            };
            let norm = Norm::of(problem.equations());
            let length = norm.length(before.scale, &step.difference());
            if self.shortest_asked(problem) < self.options.steps.smallest {
                return false;
            }
            self.ask_again(problem, before, SHORTER * length);
            self.refused = false;
        }
        true
    }

    /// From where the walk goes on that leads nowhere in these unknowns: from the same point in those that it had, or from the one before.
    pub(super) fn reverted(
        &mut self,
        problem: &mut dyn BranchProblem,
        begun: &Start,
        last: Option<Box<Halted>>,
    ) -> Option<Start> {
        let Some(halted) = last else {
            return self.before_refused(problem, begun);
        };
        // What was found with the former unknowns stands.
        problem.revert();
        self.displaced = None;
        Some(Start::At(halted))
    }

    /// A point that was refused, and is none in other unknowns either, may be none at all: from the one before it, for a shorter step.
    fn before_refused(&mut self, problem: &mut dyn BranchProblem, begun: &Start) -> Option<Start> {
        let halted = begun.halted().filter(|_| self.refused)?;
        let before = halted.previous.as_ref()?;
        if self.shortest_asked(problem) < self.options.steps.smallest {
            return None;
        }
        let step = Step {
            before,
            next: &halted.point,
        };
        let norm = Norm::of(problem.equations());
        let length = norm.length(before.scale, &step.difference());
        self.ask_again(problem, before.clone(), SHORTER * length);
        self.refused = false;
        let (point, step) = self.back.take()?;
        Some(Start::At(Box::new(halted.clone().back_to(point, step))))
    }

    /// Has the walk go back to the point before the last one, for a shorter step from there; one that is shorter than the last that was asked for from there,
    /// too. Beside a corner an orbit far away may be behind a step however short.
    pub(super) fn ask_again(&mut self, problem: &dyn BranchProblem, before: CurvePoint, step: f64) {
        self.ask_at_most(problem, before, step, AT_MOST);
    }

    /// The same, where the step may be this part of the last that was asked for from there.
    pub(super) fn ask_at_most(
        &mut self,
        problem: &dyn BranchProblem,
        before: CurvePoint,
        step: f64,
        part: f64,
    ) {
        let step = step.min(part * self.shortest_asked(problem));
        self.asked = Some(Asked {
            points: problem.points(),
            step,
        });
        self.back = Some((before, step));
    }

    /// The shortest step that was asked for behind as many points; infinite where none was.
    pub(super) fn shortest_asked(&self, problem: &dyn BranchProblem) -> f64 {
        let asked = self.asked.filter(|asked| asked.points == problem.points());
        asked.map_or(f64::INFINITY, |asked| asked.step)
    }

    /// After a change of unknowns, of the points before it only the one to go on from is known in them; of the one before that, its multipliers.
    pub(super) fn forget_others(&mut self, problem: &mut dyn BranchProblem, halted: &Halted) {
        let last = if self.refused {
            halted.previous.as_ref()
        } else {
            Some(&halted.point)
        };
        if self.seen.last().map(|seen| &seen.point) != last {
            let value = last.map(CurvePoint::parameter);
            let is_same = self.seen.last().map(|seen| seen.point.parameter()) == value;
            self.former = match &self.seen[..] {
                [.., former, _] if is_same && self.way > 0.0 => Some(Former {
                    values: former.values.clone(),
                    pairs: former.pairs.clone(),
                    slope: Some(former.point.parameter_slope()),
                    way: self.way,
                }),
                // It was changed before.
                [_] if is_same => self.former.take(),
                _ => None,
            };
            if !is_same {
                self.earlier = None;
            }
            self.seen.clear();
            self.looked = None;
            let crossed = self.crossed.take().filter(|at| is_same && at.way > 0.0);
            self.crossed = crossed.and_then(|at| Some(at.displaced_to(last?)));
            let seen = last.map(|at| Seen::at(problem, at, self.falls));
            self.seen.extend(seen);
        }
    }
}
