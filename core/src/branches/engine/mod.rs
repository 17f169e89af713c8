//! Follows a branch of periodic orbits, by whatever method they are computed.
//!
//! Along the curve of solutions ([`follow`](crate::continuation::follow)) every point is read, and between two points test functions tell
//! what happened:
//!
//! | event | test function that changes its sign |
//! |---|---|
//! | fold | the slope of the parameter, and the bordered determinant does not |
//! | branch point | the determinant of the equations with the tangent as their border; where the slope changes its sign too, a branch ends on another one |
//! | others | what the method gives: [`BranchProblem::watched`] |
//!
//! 1. A step is [divided](inside) where a function passes zero twice in it, as far as three points tell.
//! 2. What changes its sign in a part is [located](zero) and read.
//! 3. Touches of levels are the method's ([`BranchProblem::graze`]): what is smooth there depends on the unknowns.
//!
//! Source: Govaerts (2000), Numerical Methods for Bifurcations of Dynamical Equilibria, chapters 3 and 4 (test functions); Keller
//! (1977), Numerical solution of bifurcation and nonlinear eigenvalue problems (the bordered determinant).

mod inside;
#[cfg(test)]
mod tests;
mod zero;

pub(crate) use zero::{Aim, Search, is_crossing, root};

use super::problem::{BranchProblem, Change, Read, Test, TestValue};
use crate::continuation::follow::{
    Continue, CurvePoint, FollowOptions, Halt, Halted, Outcome, Start, Step, Stop, Visit, Walked,
    follow_until_stuck,
};
use crate::continuation::newton::{Newton, NewtonError};
use crate::event::{EventKind, Turn};

/// Points that are remembered: a parabola goes through them.
const POINTS: usize = 3;

/// A point of the branch with its test functions.
#[derive(Debug, Clone)]
struct Seen {
    point: CurvePoint,
    values: Vec<TestValue>,
}

impl Seen {
    fn at(problem: &mut dyn BranchProblem, point: &CurvePoint, needed: bool) -> Self {
        let values = (0..problem.watched().len()).map(|index| problem.test(index, point, needed));
        Self {
            values: values.collect(),
            point: point.clone(),
        }
    }

    fn value(&self, test: Test) -> TestValue {
        match test {
            Test::Slope => TestValue::plain(self.point.parameter_slope()),
            Test::Watched(index) => self.values[index],
        }
    }
}

/// The state of a walk along a branch.
struct Engine {
    options: FollowOptions,
    /// The last three points, the newest last, in their present unknowns.
    seen: Vec<Seen>,
    /// Number of points before a step that was divided when it was the last, and for what.
    divided: Vec<(usize, Test)>,
    /// The last point was refused.
    refused: bool,
    /// The last point is beyond the end.
    beyond: bool,
    /// Why it ended from here.
    ended: Option<Stop>,
}

/// Follows the branch from its start to its end.
///
/// # Errors
/// If there is no first point.
pub(crate) fn run(
    problem: &mut dyn BranchProblem,
    mut start: Start,
    options: FollowOptions,
) -> Result<Stop, NewtonError> {
    let mut engine = Engine::new(options);
    // Where the walk was halted last, in case that other unknowns fail there.
    let mut last: Option<Box<Halted>> = None;
    loop {
        let begun = start.clone();
        let mut newton = Newton::new(problem.equations());
        let length = newton.norm().unknowns() + 1;
        engine.seen.retain(|seen| seen.point.u.len() == length);
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
                    return Ok(engine.ended.unwrap_or(stop));
                };
                Start::At(halted)
            }
            Ok(Walked {
                outcome: Outcome::Halted(halted),
                ..
            }) => {
                let mut resized = halted.clone();
                problem.remap(&mut resized);
                last = Some(halted);
                Start::At(resized)
            }
            Err(NewtonError::Cancelled { .. }) if problem.points() > 0 => {
                return Ok(Stop::Interrupted);
            }
            Err(_) if problem.couple_fully() => begun,
            Err(reason) => {
                let Some(halted) = last.take() else {
                    return Err(reason);
                };
                // What was found with the former unknowns stands.
                problem.revert();
                Start::At(halted)
            }
        };
    }
}

impl Engine {
    fn new(options: FollowOptions) -> Self {
        Self {
            options,
            seen: Vec::new(),
            divided: Vec::new(),
            refused: false,
            beyond: false,
            ended: None,
        }
    }

    fn visit(
        &mut self,
        problem: &mut dyn BranchProblem,
        newton: &mut Newton,
        seen: &Visit<'_>,
    ) -> Continue {
        match seen {
            Visit::Again(_) if !self.refused => Continue::Continue(()),
            Visit::Point(at) | Visit::Again(at) => {
                self.beyond = matches!(seen, Visit::Point(_)) && problem.is_beyond(at);
                if self.beyond {
                    // The step to it is looked at next, and is the last one.
                    return Continue::Continue(());
                }
                let read = problem.read(newton, at);
                self.kept(problem, at, read)
            }
            Visit::Between(before, next) => self.step(problem, newton, Step { before, next }),
        }
    }

    /// What follows from how a point was read.
    fn kept(&mut self, problem: &mut dyn BranchProblem, at: &CurvePoint, read: Read) -> Continue {
        self.refused = read == Read::Refused;
        match read {
            Read::Refused | Read::Resize => return Continue::Break(Halt::Resize),
            Read::Stop => return Continue::Break(Halt::Stop),
            Read::Kept => {}
        }
        self.see(Seen::at(problem, at, false));
        Continue::Continue(())
    }

    /// Remembers a point.
    fn see(&mut self, seen: Seen) {
        if self.seen.len() == POINTS {
            self.seen.remove(0);
        }
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
            let Some(read) = problem.end(newton, step, self.options.newton) else {
                return Continue::Break(Halt::Stop);
            };
            let kept = self.kept(problem, step.next, read);
            if kept.is_break() {
                return Continue::Break(Halt::Stop);
            }
        }
        let turned = self.events(problem, newton, step);
        if self.ended.is_none() {
            problem.graze(newton, step, turned);
        }
        if self.ended.is_some() {
            Continue::Break(Halt::Stop)
        } else {
            Continue::Continue(())
        }
    }

    /// Locates what happened in a step, and in the one before where that shows only now. Says where the branch turned without a fold.
    fn events(
        &mut self,
        problem: &mut dyn BranchProblem,
        newton: &mut Newton,
        step: Step<'_>,
    ) -> Option<Turn> {
        let after = problem.points() - 1;
        let earlier = self.complete(problem, step);
        let ends = [self.seen.len() - 2, self.seen.len() - 1];
        let ends = ends.map(|place| self.seen[place].clone());
        let parts = self.parts(problem, newton, earlier.as_ref(), ends, after);
        if self.ended.is_some() {
            return None;
        }
        let mut turned = None;
        for pair in parts.windows(2) {
            for change in changes(problem, &pair[0], &pair[1]) {
                let turn = self.record(problem, newton, [&pair[0], &pair[1]], change, after);
                turned = turned.or(turn.filter(|_| change.test == Test::Slope));
                if self.ended.is_some() {
                    return turned;
                }
            }
        }
        turned
    }

    /// Sees to it that the last two points are the ends of a step, and that what is known at one end is known at the other. Returns the
    /// point before them.
    fn complete(
        &mut self,
        problem: &mut dyn BranchProblem,
        Step { before, next }: Step<'_>,
    ) -> Option<Seen> {
        let find = |seen: &[Seen], at: &CurvePoint| seen.iter().rposition(|seen| seen.point == *at);
        let place = find(&self.seen, before);
        let earlier = place.and_then(|place| place.checked_sub(1));
        let earlier = earlier.map(|place| self.seen[place].clone());
        let mut ends = [before, next].map(|at| {
            let known = find(&self.seen, at).map(|place| self.seen[place].clone());
            known.unwrap_or_else(|| Seen::at(problem, at, false))
        });
        let [a, b] = &mut ends;
        for index in 0..a.values.len() {
            match [a.values[index].is_known(), b.values[index].is_known()] {
                [true, false] => b.values[index] = problem.test(index, next, true),
                [false, true] => a.values[index] = problem.test(index, before, true),
                _ => {}
            }
        }
        self.seen.clear();
        self.seen.extend(earlier.clone().into_iter().chain(ends));
        earlier
    }
}

/// What changes its sign from one point to the next, and what that means. Without the bordered determinant every turn counts as a
/// fold.
fn changes(problem: &dyn BranchProblem, a: &Seen, b: &Seen) -> Vec<Change> {
    let differs = |test: Test| {
        let [x, y] = [a, b].map(|seen| seen.value(test));
        x.is_known() && y.is_known() && x.is_negative() != y.is_negative()
    };
    let turned = differs(Test::Slope);
    let watched = problem.watched();
    let bordered = watched.iter().position(|watched| watched.bordered);
    let crossed = bordered.filter(|index| differs(Test::Watched(*index)));
    let mut changes = Vec::new();
    match (turned, crossed) {
        (true, crossed) => changes.push(Change {
            test: Test::Slope,
            kind: crossed.map_or(EventKind::Fold, |_| EventKind::BranchPoint),
        }),
        (false, Some(index)) => changes.push(Change {
            test: Test::Watched(index),
            kind: EventKind::BranchPoint,
        }),
        (false, None) => {}
    }
    for (index, watched) in watched.iter().enumerate() {
        let test = Test::Watched(index);
        let largest = [a, b].map(|seen| seen.value(test).mantissa.abs());
        let noise = problem.noise(index);
        if !watched.bordered && differs(test) && largest[0].max(largest[1]) > noise {
            let kind = watched.kind;
            changes.push(Change { test, kind });
        }
    }
    changes
}
