//! Shooting as the engine of branches sees it.

use super::equations::Equations;
use super::events;
use super::minimal_period::{MinimalPeriod, step_on_other_branch};
use super::run::Run;
use super::tested::{self, Tests};
use crate::branches::engine::Search;
use crate::branches::problem::{
    BranchProblem, Change, Read, Test, TestValue, Watched, Zero, ZeroOutcome,
};
use crate::branches::progress::{Progress, See};
use crate::continuation::follow::{CurvePoint, Step, Stop};
use crate::continuation::locate::Located;
use crate::continuation::newton::{Newton, NewtonOptions};
use crate::continuation::problem::Problem;
use crate::event::{EventKind, Turn};
use crate::time::FlowError;

/// Brackets of an event are narrowed until rounding stops it, or this is reached.
pub(super) const VANISHED: f64 = 1e-14;
/// Test functions are noise below so many times of what must vanish.
const NOISE: f64 = 10.0;

/// A branch by shooting.
pub(super) struct ShootingBranch<'b, 'r> {
    pub(super) run: &'b mut Run<'r>,
    pub(super) equations: Equations,
    /// The same equations for test functions, if they were needed.
    other: Option<Equations>,
    watched: Vec<Watched>,
    /// The test functions computed last, and where.
    tested: Option<(Vec<f64>, Tests)>,
    visit: See<'b>,
}

impl<'b, 'r> ShootingBranch<'b, 'r> {
    pub(super) fn new(run: &'b mut Run<'r>, equations: Equations, visit: See<'b>) -> Self {
        let watched = if run.problem.stability {
            tested::watched(equations.span.half).to_vec()
        } else {
            Vec::new()
        };
        Self {
            run,
            equations,
            other: None,
            watched,
            tested: None,
            visit,
        }
    }

    /// Adds up the work of its flows.
    pub(super) fn count_flows(&mut self) {
        self.run.work += self.equations.flow.work();
        if let Some(other) = &self.other {
            self.run.work += other.flow.work();
        }
    }

    /// Test functions at a point.
    fn tests(&mut self, at: &CurvePoint) -> Tests {
        if let Some((u, tests)) = &self.tested
            && *u == at.u
        {
            return *tests;
        }
        if self.other.is_none() {
            self.other = self.equations.again(self.run.problem).ok();
        }
        let map = self
            .other
            .as_mut()
            .map(|other| other.map(&at.u, &mut |_| {}));
        let map = map.and_then(Result::ok);
        let tests = Tests::of(map.as_ref(), at.parameter_slope());
        self.tested = Some((at.u.clone(), tests));
        tests
    }

    fn recurrence(&mut self, at: &CurvePoint) -> Result<Option<MinimalPeriod>, FlowError> {
        let (span, odd) = (self.equations.span, self.run.problem.odd);
        if self.run.points.is_empty() || (span.period == 1 && !odd) {
            return Ok(None);
        }
        let same = self.run.same_state(&self.equations);
        let found = MinimalPeriod::of(&mut self.equations, &at.u, same, odd)?;
        let is_regular = found.period < span.period || found.odd != span.half;
        Ok(is_regular.then_some(found))
    }
}

impl BranchProblem for ShootingBranch<'_, '_> {
    fn equations(&mut self) -> &mut dyn Problem {
        &mut self.equations
    }

    fn watched(&self) -> &[Watched] {
        &self.watched
    }

    fn test(&mut self, index: usize, at: &CurvePoint, _: bool) -> TestValue {
        TestValue::plain(self.tests(at).value(tested::Test::watched(index)))
    }

    fn vanishing(&self) -> f64 {
        self.run.problem.vanishing(self.equations.frame.ratio)
    }

    /// Without damping the product of pairs is rounding all along.
    fn noise(&self, index: usize) -> f64 {
        match tested::Test::watched(index) {
            tested::Test::Pairs => NOISE * self.vanishing(),
            _ => 0.0,
        }
    }

    fn aim(&self) -> f64 {
        VANISHED
    }

    fn vanishes(&mut self, change: Change, located: &Located) -> bool {
        let (point, equations) = (&located.point, &mut self.equations);
        // A slope is relative to the range, and rounding to the value.
        let unit = match tested::Test::of(change.test) {
            tested::Test::Slope => (point.parameter().abs() / point.scale.parameter).max(1.0),
            tested::Test::Bordered => {
                events::others(equations, &point.u, 1.0) / point.parameter_slope().abs()
            }
            tested::Test::Plus => events::others(equations, &point.u, -1.0),
            // What is nothing special need not vanish to be passed over.
            tested::Test::Pairs if !self.tests(point).complex => return true,
            tested::Test::Pairs => 1.0,
        };
        located.test.abs() <= self.vanishing() * unit
    }

    fn points(&self) -> usize {
        self.run.points.len()
    }

    fn is_beyond(&mut self, at: &CurvePoint) -> bool {
        match self.recurrence(at) {
            Ok(found) => {
                self.run.joined = found;
                found.is_some()
            }
            Err(failure) => {
                self.run.failure = Some(failure);
                false
            }
        }
    }

    fn end(&mut self, newton: &mut Newton, step: Step<'_>, options: NewtonOptions) -> Option<Read> {
        let equations = &mut self.equations;
        let other = step_on_other_branch(equations, newton, step, options)?;
        let change = Change {
            test: Test::Watched(0),
            kind: EventKind::BranchPoint,
        };
        if !self.watched.is_empty() {
            let beyond = Step {
                before: step.next,
                next: &other,
            };
            let ends = [beyond.before, beyond.next].map(|at| self.test(0, at, true));
            let search = Search {
                step: beyond,
                change,
                ends,
                after: self.run.points.len(),
                options,
            };
            search.record(self, newton);
        }
        None
    }

    fn read(&mut self, _: &mut Newton, at: &CurvePoint) -> Read {
        if self.run.failure.is_some() {
            return Read::Stop;
        }
        let (point, map) = match self.run.read(&mut self.equations, &at.u) {
            Ok(read) => read,
            Err(failure) => {
                self.run.failure = Some(failure);
                return Read::Stop;
            }
        };
        let tests = Tests::of(map.as_ref(), at.parameter_slope());
        self.tested = Some((at.u.clone(), tests));
        let done = self.run.points.len() + 1;
        let answer = (self.visit)(Progress::orbit(done, &point));
        self.run.points.push(point);
        if answer.is_break() {
            Read::Stop
        } else {
            Read::Kept
        }
    }

    fn keep(&mut self, _: &mut Newton, step: Step<'_>, zero: &Zero) -> ZeroOutcome {
        let test = tested::Test::of(zero.change.test);
        if test == tested::Test::Pairs && !self.tests(&zero.root.located.point).complex {
            return ZeroOutcome::Nothing;
        }
        let Some(event) = self.run.event_at(&mut self.equations, step, zero) else {
            return ZeroOutcome::Unread;
        };
        let meets = event.kind == EventKind::BranchPoint && self.run.joined.is_none();
        self.run.events.push(event);
        if meets && self.run.meets(&mut self.equations) {
            return ZeroOutcome::Ends(Stop::Interrupted);
        }
        ZeroOutcome::Event
    }

    fn keep_turn(&mut self, turn: Turn) {
        self.run.turns.push(turn);
    }

    fn graze(&mut self, newton: &mut Newton, step: Step<'_>, _: Option<Turn>) {
        if self.run.problem.stability
            && let [.., a, b] = &self.run.points[..]
            && a.observed.switches != b.observed.switches
        {
            self.run.grazings(&mut self.equations, newton, step);
        }
    }

    fn count(&mut self, newton: &Newton) {
        self.run.statistics += newton.statistics;
    }
}
