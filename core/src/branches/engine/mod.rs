//! Follows a branch of periodic orbits, by whatever method they are computed.
//!
//! Along the curve of solutions ([`follow`](crate::continuation::follow)) every point is read, and between two points test functions tell
//! what happened:
//!
//! | event | test function that changes its sign |
//! |---|---|
//! | fold | the slope of the parameter, and the bordered determinant does not |
//! | branch point | the determinant of the equations with the tangent as their border; where the slope changes its sign too, a branch ends on another one |
//! | Neimark-Sacker | the [moduli](crate::branches::moduli) of multipliers, where more of them pass one than the others explain |
//! | others | what the method gives: [`BranchProblem::watched`] |
//!
//! 1. A step is [divided](inside) where a [function](sought) passes zero [twice](dip) in it, as far as three points tell, two pairs of
//!    multipliers [meet](meeting), a fold and a crossing are [beside](beside_turn) each other, or an extreme of a gap passes a [narrow] place
//!    of its law.
//! 2. What changes its sign in a part is [located](zero) and read.
//! 3. A step that [leaps](leap) over two folds, or to another limb, is made again, shorter.
//! 4. Where a step fails before the [corner] that a branch has at a touch, the walk goes on behind it.
//! 5. What events that were located [hide](counted) is looked for beside them.
//! 6. A step onto a branch of more regular orbits is made again up to shortly before the [joint] of both.
//! 7. Where an extreme of a gap goes through a level, the orbit that [touches](grazing) it is located, and what test functions show there, or right
//!    [behind](behind_touch) it, and at no end of the step is recorded.
//!
//! Source: Govaerts (2000), Numerical Methods for Bifurcations of Dynamical Equilibria, chapters 3 and 4 (test functions); Keller
//! (1977), Numerical solution of bifurcation and nonlinear eigenvalue problems (the bordered determinant).

mod back;
mod behind_touch;
mod beside_turn;
mod beyond_corner;
mod corner;
mod corner_events;
mod corner_search;
mod counted;
mod dip;
mod explained;
mod grazing;
mod grazing_search;
mod grazing_within_step;
mod heights;
mod inside;
mod joint;
mod leap;
mod meeting;
mod narrow;
mod seen;
mod shown_between;
mod sought;
mod step_parts;
#[cfg(test)]
mod tests;
mod walk;
mod zero;

pub(crate) use back::STOPPED;
use explained::Displaced;
use grazing::Bent;
use grazing::Gaps;
use joint::Joint;
use seen::{Crossed, Former, Seen, changes, is_modulus};
use step_parts::distance;
use walk::{Asked, Looked};
pub(crate) use walk::{Places, Walk};
use zero::Recorded;
pub(crate) use zero::{Aim, Search, is_crossing, root};

use super::problem::{BranchProblem, Change, Read, Test};
use crate::continuation::follow::{
    Continue, CurvePoint, FollowOptions, Halt, Halted, Outcome, Start, Step, Stop, Visit, Walked,
    follow_until_stuck,
};
use crate::continuation::newton::{Newton, NewtonError};
use crate::event::Turn;

/// Points that are remembered: a parabola goes through them.
const POINTS: usize = 3;

/// The state of a walk along a branch.
#[expect(
    clippy::struct_excessive_bools,
    reason = "independent facts, not states"
)]
struct Engine {
    options: FollowOptions,
    /// The last three points, the newest last, in their present unknowns.
    seen: Vec<Seen>,
    /// The one before these, where it has other unknowns.
    former: Option<Former>,
    /// Where that is in the present unknowns, about.
    earlier: Option<CurvePoint>,
    /// How long the last step was.
    way: f64,
    /// Whether the parameter falls, as far as the walk has come.
    falls: Option<bool>,
    /// Number of points before a step that was divided when it was the last, and for what.
    divided: Vec<(usize, Test)>,
    /// The last point was refused.
    refused: bool,
    /// The unknowns are to change once the step to the last point has been looked at.
    resizes: bool,
    /// The last point is beyond the end.
    beyond: bool,
    /// Why it ended from here.
    ended: Option<Stop>,
    /// Number of points up to the last one with a verdict.
    decided: Option<usize>,
    /// Where a corner was looked for last, and how far ahead.
    looked: Option<Looked>,
    /// A point behind a corner, to go on from, and the longest step from there.
    passed: Option<(CurvePoint, f64)>,
    /// An orbit between that corner and this point, if the branch goes on there: the point has none before it.
    behind: Option<Seen>,
    /// The point before the last one, to go on from in a step of this length, since the last one is not the next on the branch.
    back: Option<(CurvePoint, f64)>,
    /// The step that was made again last.
    asked: Option<Asked>,
    /// The branch point that the last step passed, which is made again.
    joint: Option<Joint>,
    /// Where the branch ends within a step, and the number of points before that.
    end: Option<(CurvePoint, usize)>,
    /// The last points with the extremes of their gaps.
    gaps: Vec<Gaps>,
    /// The last points with the extremes of the gaps whose laws may have narrow places.
    plain: Vec<Gaps>,
    /// How often the step to the next point was made again, shorter, since an extreme had passed a narrow place of its law.
    narrowed: usize,
    /// Where levels are touched in the last step.
    touched: Vec<f64>,
    /// The last of them, if its level is crossed at the end of that step.
    crossed: Option<Crossed>,
    /// Touches at which the branch or its multipliers bend, so far.
    bent: Vec<Bent>,
    /// The last step was divided in a narrow place of a law.
    doubted: bool,
    /// What changed its sign in the last step at no place that was found.
    unlocated: Vec<Turn>,
    /// The point before the last step, where that cannot be looked at: the point has no place in the unknowns of the step's end.
    displaced: Option<Displaced>,
}

/// Follows the branch from its start to its end.
///
/// # Errors
/// If there is no first point.
pub(crate) fn run(
    problem: &mut dyn BranchProblem,
    start: Start,
    options: FollowOptions,
) -> Result<Stop, NewtonError> {
    go_on(problem, Engine::new(options), start, 0.0)
}

/// Goes on with a walk from where it was about to make a step, as if it had not been interrupted. The problem has the unknowns that it had.
///
/// # Errors
/// As [`run`]; there is none but by the caller's fault.
pub(crate) fn resume(
    problem: &mut dyn BranchProblem,
    walk: Walk,
    options: FollowOptions,
) -> Result<Stop, NewtonError> {
    let (engine, halted, contraction) = Engine::resumed(walk, options);
    go_on(
        problem,
        engine,
        Start::Onward(Box::new(halted)),
        contraction,
    )
}

/// The same for an engine, with what the last correction left behind.
fn go_on(
    problem: &mut dyn BranchProblem,
    mut engine: Engine,
    mut start: Start,
    mut contraction: f64,
) -> Result<Stop, NewtonError> {
    let options = engine.options;
    // Where the walk was halted last, in the unknowns that it had, in case that the present ones fail there.
    let mut last: Option<Box<Halted>> = None;
    loop {
        let begun = start.clone();
        let mut newton = Newton::new(problem.equations());
        newton.remember_contraction(std::mem::take(&mut contraction));
        if let Start::At(halted) = &start {
            engine.forget_others(problem, halted);
        }
        let outcome = follow_until_stuck(
            problem,
            &mut newton,
            start,
            options,
            &mut |problem, newton, seen| engine.visit(problem, newton, &seen),
        );
        problem.count(&newton);
        start = match outcome {
            Ok(Walked {
                outcome: Outcome::Stopped(stop),
                stuck,
            }) => {
                let Some(halted) = stuck.filter(|_| problem.couple_fully()) else {
                    return Ok(engine.ended.unwrap_or_else(|| engine.named(problem, stop)));
                };
                last = None;
                Start::At(halted)
            }
            Ok(Walked {
                outcome: Outcome::Halted(halted),
                ..
            }) => {
                if let Some(stop) = engine.ended {
                    return Ok(stop);
                }
                if let Some(from) = engine.moved(&halted) {
                    // The present unknowns have led on: the former ones are gone.
                    last = None;
                    start = from;
                    continue;
                }
                let resized = engine.remapped(problem, &halted);
                last = Some(halted);
                Start::At(resized)
            }
            Err(NewtonError::Cancelled { .. }) if problem.points() > 0 => {
                return Ok(Stop::Interrupted);
            }
            Err(_) if problem.couple_fully() => begun,
            Err(reason) => match engine.reverted(problem, &begun, last.take()) {
                Some(from) => from,
                None => return engine.stranded(problem, &begun, reason),
            },
        };
    }
}

impl Engine {
    /// The walk cannot go on from where it was halted. What was followed until there stands.
    fn stranded(
        &self,
        problem: &mut dyn BranchProblem,
        begun: &Start,
        reason: NewtonError,
    ) -> Result<Stop, NewtonError> {
        let Some(halted) = begun.halted().filter(|_| problem.points() > 0) else {
            return Err(reason);
        };
        let stop = Stop::StepTooShort {
            step: halted.length(),
            value: halted.point.parameter(),
            reason,
        };
        Ok(self.named(problem, stop))
    }

    fn new(options: FollowOptions) -> Self {
        Self {
            options,
            seen: Vec::new(),
            former: None,
            earlier: None,
            way: 0.0,
            falls: None,
            divided: Vec::new(),
            refused: false,
            resizes: false,
            beyond: false,
            ended: None,
            decided: None,
            looked: None,
            passed: None,
            behind: None,
            back: None,
            asked: None,
            joint: None,
            end: None,
            gaps: Vec::new(),
            plain: Vec::new(),
            narrowed: 0,
            touched: Vec::new(),
            crossed: None,
            bent: Vec::new(),
            doubted: false,
            unlocated: Vec::new(),
            displaced: None,
        }
    }

    fn visit(
        &mut self,
        problem: &mut dyn BranchProblem,
        newton: &mut Newton,
        seen: &Visit<'_>,
    ) -> Continue {
        match seen {
            Visit::Again(at) if !self.refused => {
                // It was corrected, in its new unknowns or in those that it had.
                if let Some(seen) = self.seen.last_mut()
                    && seen.point.u.len() == at.u.len()
                {
                    *seen = Seen::at(problem, at, seen.falls);
                }
                Continue::Continue(())
            }
            Visit::Point(at)
                if self.corner_before(problem, at)
                    || self.leaps(problem, at)
                    || self.leaps_over_narrow(problem, at) =>
            {
                Continue::Break(Halt::Resize)
            }
            Visit::Point(at) | Visit::Again(at) => {
                self.beyond = matches!(seen, Visit::Point(_)) && problem.is_beyond(at);
                if self.beyond {
                    // The step to it is looked at next, and is the last one.
                    return Continue::Continue(());
                }
                let read = problem.read(newton, at);
                let flow = self.kept(problem, at, read);
                if flow.is_continue() {
                    self.say_unseen(problem, at);
                }
                flow
            }
            Visit::Between(before, next) => self.step(problem, newton, Step { before, next }),
            Visit::Failed(at, step) => {
                if self.corner_ahead(problem, at, *step) {
                    return Continue::Break(Halt::Resize);
                }
                Continue::Continue(())
            }
            Visit::Onward(position) => {
                let walk = self.here(position.here(), newton.contraction(), problem.kept());
                problem.onward(walk)
            }
        }
    }

    /// The walk where it was halted, in other unknowns. What happened in the last step cannot be looked at where its first point has no place in them.
    fn remapped(&mut self, problem: &mut dyn BranchProblem, halted: &Halted) -> Box<Halted> {
        let mut resized = Box::new(halted.clone());
        // It has no place in other unknowns, and from the touch before it nothing is known of the way then.
        if self.behind.take().is_some() {
            self.crossed = None;
        }
        let before = halted.previous.as_ref().filter(|_| problem.seeks_touches());
        let gaps = before.and_then(|before| self.gaps_at(problem, before));
        resized.earlier = self.earlier_than(halted);
        problem.remap(&mut resized);
        let is_known = |earlier: &CurvePoint| earlier.u.len() == resized.point.u.len();
        self.earlier = resized.earlier.take().filter(is_known);
        match (&halted.previous, &resized.previous) {
            (_, Some(there)) => {
                self.keep_gaps(gaps, Some(there));
                self.displaced = None;
            }
            (Some(point), None) => {
                self.displaced = Some(Displaced {
                    point: point.clone(),
                    gaps,
                });
            }
            (None, None) => {}
        }
        resized
    }

    /// The point before that where the walk was halted, if the step between them has been looked at.
    fn earlier_than(&self, halted: &Halted) -> Option<CurvePoint> {
        let [.., earlier, last] = &self.seen[..] else {
            return None;
        };
        let looked_at = halted.previous.is_none() && last.point == halted.point;
        looked_at.then(|| earlier.point.clone())
    }

    /// Where the walk goes on, if not from where it was halted: behind a corner, or from the point before the last one.
    fn moved(&mut self, halted: &Halted) -> Option<Start> {
        self.displaced = None;
        let moved = if let Some((passed, longest)) = self.passed.take() {
            let step = longest.min(self.options.steps.initial);
            halted.clone().moved_to(passed, step)
        } else {
            let (point, step) = self.back.take()?;
            halted.clone().back_to(point, step)
        };
        Some(Start::At(Box::new(moved)))
    }

    /// What follows from how a point was read.
    fn kept(&mut self, problem: &mut dyn BranchProblem, at: &CurvePoint, read: Read) -> Continue {
        self.refused = matches!(read, Read::Refused | Read::TooFar);
        match read {
            Read::TooFar => {
                return Continue::Break(if self.go_back(problem, at) {
                    Halt::Resize
                } else {
                    self.ended = Some(self.lost(problem));
                    Halt::Stop
                });
            }
            Read::Refused | Read::Resize => return Continue::Break(Halt::Resize),
            Read::Lost => {
                self.ended = Some(self.lost(problem));
                self.explain_verdict(problem);
                return Continue::Break(Halt::Stop);
            }
            Read::Stop => {
                // What happened in the step to it is not looked for any more, but it is said that something did.
                self.explain_verdict(problem);
                return Continue::Break(Halt::Stop);
            }
            Read::ResizeBehind => self.resizes = true,
            Read::Kept => {}
        }
        let behind = self.behind.take();
        if let Some(behind) = behind.filter(|behind| behind.point.u.len() == at.u.len()) {
            self.see(behind);
        }
        self.see(Seen::at(problem, at, self.falls));
        Continue::Continue(())
    }

    /// Remembers a point.
    fn see(&mut self, seen: Seen) {
        if self.seen.len() == POINTS {
            self.seen.remove(0);
        }
        self.falls = seen.falls;
        self.narrowed = 0;
        self.seen.push(seen);
    }

    /// Looks at the step between two points.
    fn step(
        &mut self,
        problem: &mut dyn BranchProblem,
        newton: &mut Newton,
        step: Step<'_>,
    ) -> Continue {
        if self.beyond {
            if self.comes_nearer(problem, newton, step) {
                self.beyond = false;
                return Continue::Break(Halt::Back);
            }
            let Some(read) = problem.end(newton, step, self.options.newton) else {
                return Continue::Break(Halt::Stop);
            };
            let kept = self.kept(problem, step.next, read);
            if kept.is_break() {
                return Continue::Break(Halt::Stop);
            }
        }
        let after = problem.points() - 1;
        let turned = self.events(problem, newton, step, after);
        if self.ended.is_none() {
            self.touches(problem, newton, step, turned, after);
            self.place_turns(problem);
            self.explain_verdict(problem);
        } else if let Some((end, _)) = self.end.take().filter(|end| end.1 == after) {
            self.touches_before_end(problem, newton, step.before, &end, after);
        }
        if self.ended.is_some() {
            Continue::Break(Halt::Stop)
        } else if std::mem::take(&mut self.resizes) {
            Continue::Break(Halt::Resize)
        } else {
            Continue::Continue(())
        }
    }

    /// Locates what happened in a step behind so many points, and in the one before where that shows only now. Says where the branch turned without
    /// a fold.
    fn events(
        &mut self,
        problem: &mut dyn BranchProblem,
        newton: &mut Newton,
        step: Step<'_>,
        after: usize,
    ) -> Option<Turn> {
        let earlier = self.complete(problem, step);
        let ends = [self.seen.len() - 2, self.seen.len() - 1];
        let ends = ends.map(|place| self.seen[place].clone());
        self.way = distance(newton, step.before, step.next);
        let parts = self.parts(problem, newton, earlier.as_ref(), ends, after);
        if self.ended.is_some() {
            return None;
        }
        // What was found in the step before is none of this one.
        let known = problem.record().events.len();
        let mut turned = None;
        for pair in parts.windows(2) {
            let turn = self.record_part(problem, newton, [&pair[0], &pair[1]], after);
            turned = turned.or(turn);
            if self.ended.is_some() {
                return turned;
            }
        }
        if self.doubted {
            problem.record_mut().doubt_unknown(known);
        }
        turned
    }

    /// Records what changes its sign between two points, and what events hide that were located there. Says where the branch turned without a fold.
    fn record_part(
        &mut self,
        problem: &mut dyn BranchProblem,
        newton: &mut Newton,
        pair: [&Seen; 2],
        after: usize,
    ) -> Option<Turn> {
        let known = problem.record();
        let (located, turns) = (known.events.len(), known.turns.len());
        let turned = self.record_all(problem, newton, pair, after, |_| true);
        if self.ended.is_none() {
            self.record_hidden(problem, newton, pair, [located, turns, after]);
        }
        turned
    }

    /// Records what changes its sign between two points and is wanted. Says where the branch turned without a fold.
    fn record_all(
        &mut self,
        problem: &mut dyn BranchProblem,
        newton: &mut Newton,
        pair: [&Seen; 2],
        after: usize,
        wanted: impl Fn(&Change) -> bool,
    ) -> Option<Turn> {
        let mut turned = None;
        // The other modulus of a pair that was found.
        let mut other = None;
        let changes = changes(problem, pair[0], pair[1]);
        let told = changes.iter().any(|change| !is_modulus(change));
        for change in changes {
            if !wanted(&change) || other == Some(change.test) {
                continue;
            }
            let recorded = self.record(problem, newton, pair, change, told, after);
            match recorded {
                Recorded::Turn(turn) if change.test == Test::Slope => turned = Some(turn),
                Recorded::Ends(_) => break,
                _ => {}
            }
            other = match change.test {
                Test::Watched(index) if is_modulus(&change) && recorded != Recorded::Nothing => {
                    Some(Test::Watched(index + 1))
                }
                _ => None,
            };
        }
        turned
    }

    /// Sees to it that the last two points are the ends of a step. Returns the point before them.
    fn complete(
        &mut self,
        problem: &mut dyn BranchProblem,
        Step { before, next }: Step<'_>,
    ) -> Option<Seen> {
        if let [.., a, b] = &self.seen[..]
            && (&a.point, &b.point) == (before, next)
        {
            return self.seen.iter().rev().nth(2).cloned();
        }
        let find = |seen: &[Seen], at: &CurvePoint| seen.iter().rposition(|seen| seen.point == *at);
        let place = find(&self.seen, before);
        let earlier = place.and_then(|place| place.checked_sub(1));
        let earlier = earlier.map(|place| self.seen[place].clone());
        let ends = [before, next].map(|at| {
            let known = find(&self.seen, at).map(|place| self.seen[place].clone());
            let seen = known.unwrap_or_else(|| Seen::at(problem, at, self.falls));
            self.falls = seen.falls;
            seen
        });
        if place.is_none() {
            self.former = None;
        }
        self.seen.clear();
        self.seen.extend(earlier.clone().into_iter().chain(ends));
        earlier
    }
}
