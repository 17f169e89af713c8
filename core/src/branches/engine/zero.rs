//! Locates where a test function vanishes between two points, and has the orbit there read.

use super::Engine;
use super::seen::Seen;
use super::step_parts::step_between;
use crate::branches::extreme::{Bend, crossings, passed};
use crate::branches::problem::{BranchProblem, Change, Root, Test, TestValue, Zero, ZeroOutcome};
use crate::continuation::crossing::locate_crossing;
use crate::continuation::follow::{CurvePoint, Step, Stop};
use crate::continuation::locate::{Located, locate, locate_along, locate_beside};
use crate::continuation::newton::{Newton, NewtonOptions};
use crate::continuation::problem::AsProblem;
use crate::event::{EventKind, Turn};

/// Of a test function that is steep, and does not jump, at most this part is left beside its zero.
const STEEP: f64 = 1e-3;
/// Where a test function is left at its zero, orbits are known to this part of the scale: it may be what Newton's method leaves.
const EXACT: f64 = 1e-12;
/// Where branches cross, at most this part of a test function is left.
const CROSSED: f64 = 1e-3;

/// Turns as near to a joint of two branches, as a part of the step, are that.
const AT_JOINT: f64 = 1e-3;

/// What came of a change of sign.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum Recorded {
    /// An event.
    Found,
    /// What changed its sign is nothing special.
    Nothing,
    /// The branch ends there.
    Ends(Stop),
    /// A place that is none.
    Turn(Turn),
}

/// A step in which a test function changes its sign, behind so many points of the branch.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Search<'s> {
    pub(crate) step: Step<'s>,
    pub(crate) change: Change,
    /// Values of the test function at both ends.
    pub(crate) ends: [TestValue; 2],
    pub(crate) after: usize,
    /// Another test function, which is no modulus, changes its sign in the step too.
    pub(crate) told: bool,
    pub(crate) options: NewtonOptions,
}

impl Engine {
    /// Locates an event and keeps it, or the place where the test function jumps.
    pub(super) fn record(
        &mut self,
        problem: &mut dyn BranchProblem,
        newton: &mut Newton,
        [a, b]: [&Seen; 2],
        change: Change,
        told: bool,
        after: usize,
    ) -> Recorded {
        let search = Search {
            told,
            ..self.search_between([a, b], change, after)
        };
        let (recorded, at) = search.recorded(problem, newton);
        match recorded {
            Recorded::Ends(stop) => {
                self.ended = Some(stop);
                if let Some(at) = &at {
                    search.explain_turns(problem, at.parameter());
                }
                self.end = at.map(|at| (at, after));
            }
            Recorded::Turn(turn) if turn.value == search.middle() => self.unlocated.push(turn),
            _ => {}
        }
        recorded
    }

    /// A change of sign between two points.
    fn search_between<'s>(
        &self,
        [a, b]: [&'s Seen; 2],
        change: Change,
        after: usize,
    ) -> Search<'s> {
        Search {
            step: step_between([a, b]),
            change,
            ends: [a, b].map(|seen| seen.value(change.test)),
            after,
            told: true,
            options: self.options.newton,
        }
    }

    /// Whether a test function jumps where it changes its sign between two points, or no place is found.
    pub(super) fn jumps_at(
        &self,
        problem: &mut dyn BranchProblem,
        newton: &mut Newton,
        pair: [&Seen; 2],
        change: Change,
    ) -> bool {
        let search = self.search_between(pair, change, problem.points());
        let Some((root, vanishes)) = search.found(problem, newton) else {
            return true;
        };
        !(vanishes
            || search.is_smooth_crossing(problem, &root.located)
            || search.is_steep(problem, &root.located, true))
    }
}

impl<'s> Search<'s> {
    /// For the branch point that a step passed over onto a branch of more regular orbits, along which `other` is behind it.
    pub(crate) fn of_joint(
        problem: &mut dyn BranchProblem,
        step: Step<'s>,
        other: &'s CurvePoint,
        options: NewtonOptions,
    ) -> Self {
        let beyond = Step {
            before: step.next,
            next: other,
        };
        Self {
            step: beyond,
            change: Change {
                test: Test::Watched(0),
                kind: EventKind::BranchPoint,
            },
            ends: [beyond.before, beyond.next].map(|at| problem.test(0, at)),
            after: problem.points(),
            told: true,
            options,
        }
    }

    /// Where it vanishes.
    pub(crate) fn place(
        &self,
        problem: &mut dyn BranchProblem,
        newton: &mut Newton,
    ) -> Option<CurvePoint> {
        self.root(problem, newton).map(|root| root.located.point)
    }

    /// Locates an event, with what the matrix has now or else with more of the equations in it, and keeps it; or the place where the test
    /// function jumps.
    pub(crate) fn record(&self, problem: &mut dyn BranchProblem, newton: &mut Newton) -> Recorded {
        self.recorded(problem, newton).0
    }

    /// The same, with the place where the branch ends.
    fn recorded(
        &self,
        problem: &mut dyn BranchProblem,
        newton: &mut Newton,
    ) -> (Recorded, Option<CurvePoint>) {
        let (mut kept, jump) = self.search(problem, newton, false);
        if kept == ZeroOutcome::Unread && !is_crossing(problem, self.change) {
            if problem.couple_fully_once(true) {
                let mut newton = Newton::new(problem.equations());
                kept = self.search(problem, &mut newton, false).0;
                problem.count(&newton);
                problem.couple_fully_once(false);
            } else if !self.may_jump(problem) {
                kept = self.search(problem, newton, true).0;
            }
        }
        match kept {
            ZeroOutcome::Event => return (Recorded::Found, None),
            ZeroOutcome::Nothing => return (Recorded::Nothing, None),
            ZeroOutcome::Ends(stop) => {
                return (Recorded::Ends(stop), jump.map(|located| located.point));
            }
            // It may well be an event.
            ZeroOutcome::Unread if problem.equations().is_cancelled() => {
                return (Recorded::Ends(Stop::Interrupted), None);
            }
            ZeroOutcome::Unread => {}
        }
        let (value, test) = jump.map_or_else(
            || (self.middle(), self.ends[0].relative_to(self.reference())),
            |jump| (jump.point.parameter(), jump.test),
        );
        let turn = Turn {
            kind: self.change.kind,
            value,
            test,
            after: self.after,
        };
        problem.record_mut().turns.push(turn);
        (Recorded::Turn(turn), None)
    }

    fn middle(&self) -> f64 {
        let [a, b] = self.step.parameters();
        0.5 * (a + b)
    }

    /// Determinants are in units of the larger one of those at both ends.
    fn reference(&self) -> f64 {
        self.ends[0].exponent.max(self.ends[1].exponent)
    }

    /// Of the test function at both ends.
    fn sizes(&self) -> [f64; 2] {
        let reference = self.reference();
        self.ends.map(|end| end.relative_to(reference).abs())
    }

    /// How steep the chords from a zero to both ends are, at least.
    fn steepness(&self, zero: f64) -> f64 {
        let places = self.step.parameters().into_iter().zip(self.sizes());
        let slopes = places.map(|(end, size)| size / (end - zero).abs());
        slopes.fold(f64::INFINITY, f64::min)
    }

    /// Where the test function changes its sign, and whether it vanishes there, with orbits that are known better where little is left of it.
    fn found(&self, problem: &mut dyn BranchProblem, newton: &mut Newton) -> Option<(Root, bool)> {
        let root = self.root(problem, newton)?;
        if problem.vanishes(self.change, &root.located) {
            return Some((root, true));
        }
        let [a, b] = self.sizes();
        let is_little = root.located.test.abs() <= STEEP * a.min(b);
        if self.options.tolerance <= EXACT || !is_little || is_crossing(problem, self.change) {
            return Some((root, false));
        }
        let options = NewtonOptions {
            tolerance: EXACT,
            ..self.options
        };
        let exact = Self { options, ..*self }.root(problem, newton);
        Some(exact.map_or((root, false), |exact| {
            let vanishes = problem.vanishes(self.change, &exact.located);
            (exact, vanishes)
        }))
    }

    /// What became of the zero, and where the function jumps instead. It may be `steep` where no level is a corner.
    fn search(
        &self,
        problem: &mut dyn BranchProblem,
        newton: &mut Newton,
        steep: bool,
    ) -> (ZeroOutcome, Option<Located>) {
        let Some((mut root, mut vanishes)) = self.found(problem, newton) else {
            return (ZeroOutcome::Unread, None);
        };
        if !vanishes && self.is_smooth_crossing(problem, &root.located) {
            root.error += self.left_of_crossing(&root.located);
            vanishes = true;
        }
        if !vanishes && !self.is_steep(problem, &root.located, steep) {
            return (ZeroOutcome::Unread, Some(root.located));
        }
        let value = root.located.point.parameter();
        let zero = Zero {
            change: self.change,
            root,
            reference: self.reference(),
            steepness: self.steepness(value),
            least: self.sizes().into_iter().fold(f64::INFINITY, f64::min),
            told: self.told,
            after: self.after,
        };
        let kept = problem.keep(newton, self.step, &zero);
        (kept, Some(zero.root.located))
    }

    /// Whether a test function that is not driven to zero is continuous there all the same, and steep, as close to a touch, from which multipliers
    /// move away as a root: on both sides little is left of it, as near as points can be to each other. Where a level may be a corner it may be a
    /// short jump.
    fn is_steep(&self, problem: &mut dyn BranchProblem, located: &Located, steep: bool) -> bool {
        let [a, b] = self.sizes();
        if !(located.jump > 0.0 && located.jump <= STEEP * a.min(b)) {
            return false;
        }
        if steep || !problem.corners() {
            return steep;
        }
        let mut extremes = Vec::new();
        let known = problem.extremes(&located.point.u, &mut extremes);
        let sharpest = extremes.iter().map(|extreme| extreme.bend).max();
        known && sharpest == Some(Bend::Steep)
    }

    /// Whether test functions may jump between both ends: an extreme goes through a level at which the branch may have a corner, or it is not
    /// known whether one does.
    fn may_jump(&self, problem: &mut dyn BranchProblem) -> bool {
        if !problem.corners() {
            return false;
        }
        let Step { before, next } = self.step;
        let (mut here, mut there) = (Vec::new(), Vec::new());
        if !(problem.extremes(&before.u, &mut here) && problem.extremes(&next.u, &mut there)) {
            return true;
        }
        for extremes in [&mut here, &mut there] {
            extremes.retain(|extreme| extreme.bend == Bend::Corner);
        }
        !passed(&here, &there).is_empty() || crossings(&here) != crossings(&there)
    }

    /// Whether branches cross there, and next to nothing is left of the test function: it is interpolated, from orbits that are known the less the
    /// nearer to each other they are. Of a jump about half would be left.
    fn is_smooth_crossing(&self, problem: &dyn BranchProblem, located: &Located) -> bool {
        let [a, b] = self.sizes();
        is_crossing(problem, self.change) && located.test.abs() <= CROSSED * a.min(b)
    }

    /// What that is in the parameter, which has an extreme where its slope is the test function.
    fn left_of_crossing(&self, located: &Located) -> f64 {
        let [a, b] = self.sizes();
        let part = located.test.abs() / a.min(b);
        let value = located.point.parameter();
        let ways = self.step.parameters().map(|end| (end - value).abs());
        let power = if self.change.test == Test::Slope {
            2
        } else {
            1
        };
        part.powi(power) * ways[0].max(ways[1])
    }

    /// Takes back turns of the step where branches meet: the parameter of one of them has an extreme there, and the determinant is zero.
    fn explain_turns(&self, problem: &mut dyn BranchProblem, joint: f64) {
        let [a, b] = self.step.parameters();
        let most = AT_JOINT * (b - a).abs().max((a - joint).abs());
        let after = self.after;
        problem.record_mut().turns.retain(|turn| {
            let of_joint = matches!(turn.kind, EventKind::Fold | EventKind::BranchPoint);
            !(of_joint && turn.after == after && (turn.value - joint).abs() <= most)
        });
    }

    /// The test function, in the units of both ends.
    fn value(&self, problem: &mut dyn BranchProblem, at: &CurvePoint) -> f64 {
        match self.change.test {
            Test::Slope => problem.slope(at),
            Test::Watched(index) => problem.test(index, at).relative_to(self.reference()),
        }
    }

    /// Where the test function changes its sign.
    fn root(&self, problem: &mut dyn BranchProblem, newton: &mut Newton) -> Option<Root> {
        let aim = if is_crossing(problem, self.change) {
            Aim::Crossing
        } else if self.may_jump(problem) {
            Aim::Below(problem.aim())
        } else {
            Aim::Beside(problem.aim())
        };
        let value =
            |problem: &mut (dyn BranchProblem + '_), at: &CurvePoint| self.value(problem, at);
        let found = root(problem, newton, self.step, self.options, aim, value);
        let left = |root: &Root| root.located.test.abs();
        let jumps = |root: &Root| !root.located.vanishes;
        let jump = found.as_ref().filter(|root| jumps(root)).map(left);
        let is_fold = matches!(
            (self.change.test, self.change.kind),
            (Test::Slope, EventKind::Fold)
        );
        let Some(jump) = jump.filter(|_| is_fold) else {
            return found;
        };
        let along = self.along_heights(problem, newton).into_iter();
        let least = along.min_by(|a, b| left(a).total_cmp(&left(b)));
        // What still jumps is where it was.
        least.filter(|least| left(least) <= STEEP * jump).or(found)
    }

    /// The same of a fold, where an extreme goes through its level and the branch bends sharply beside that: what is a jump to the arc length is none to
    /// the height of the extreme, which grows through the touch.
    fn along_heights(&self, problem: &mut dyn BranchProblem, newton: &mut Newton) -> Vec<Root> {
        let Step { before, next } = self.step;
        let (mut here, mut there) = (Vec::new(), Vec::new());
        if !(problem.extremes(&before.u, &mut here) && problem.extremes(&next.u, &mut there)) {
            return Vec::new();
        }
        let mut form = vec![0.0; before.u.len()];
        let farthest = newton.norm().length(before.scale, &self.step.difference());
        let found = passed(&here, &there).into_iter().filter_map(|passage| {
            let range = before.scale.parameter;
            let ends = [(before, passage.before), (next, passage.next)];
            let known = ends
                .iter()
                .any(|(at, extreme)| problem.extreme_form(&at.u, extreme, range, &mut form));
            if !known {
                return None;
            }
            let (aim, options) = (problem.aim(), self.options);
            let form = form.clone();
            let value =
                |problem: &mut (dyn BranchProblem + '_), at: &CurvePoint| self.value(problem, at);
            let located = locate_along(problem, newton, self.step, form, options, aim, value)?;
            // A form may have its value on another part of the branch, too.
            let way = Step {
                before,
                next: &located.point,
            };
            let distance = newton.norm().length(before.scale, &way.difference());
            let error = 0.0;
            (distance <= farthest).then_some(Root { located, error })
        });
        found.collect()
    }
}

/// What a zero is located by.
#[derive(Debug, Clone, Copy)]
pub(crate) enum Aim {
    /// The test function is driven below this.
    Below(f64),
    /// The same, also where corrections fail in the middle of the step: where it has no corner, orbits are found beside.
    Beside(f64),
    /// The matrix of Newton's method is singular there: interpolation.
    Crossing,
}

/// Where a test function changes its sign in a step.
pub(crate) fn root<P: AsProblem + ?Sized>(
    problem: &mut P,
    newton: &mut Newton,
    step: Step<'_>,
    options: NewtonOptions,
    aim: Aim,
    value: impl FnMut(&mut P, &CurvePoint) -> f64,
) -> Option<Root> {
    match aim {
        Aim::Crossing => {
            let found = locate_crossing(problem, newton, step, options, value)?;
            let located = Located {
                point: found.point,
                test: found.test,
                vanishes: true,
                jump: 0.0,
            };
            let error = found.error;
            Some(Root { located, error })
        }
        Aim::Below(tolerance) => {
            let located = locate(problem, newton, step, options, tolerance, value)?;
            let error = 0.0;
            Some(Root { located, error })
        }
        Aim::Beside(tolerance) => {
            let located = locate_beside(problem, newton, step, options, tolerance, value)?;
            let error = 0.0;
            Some(Root { located, error })
        }
    }
}

/// Whether the matrix of Newton's method is singular at the zero.
pub(crate) fn is_crossing(problem: &dyn BranchProblem, change: Change) -> bool {
    match change.test {
        Test::Slope => change.kind == EventKind::BranchPoint,
        Test::Watched(index) => problem.watched()[index].bordered,
    }
}
