//! Shooting as the engine of branches sees it.

use nalgebra::Complex;

use super::equations::Equations;
use super::events;
use super::gap_extremes::GapExtremes;
use super::minimal_period::earlier;
use super::run::Run;
use super::test_functions::{self, Tests};
use crate::branches::branch_start::step_on_other_branch;
use crate::branches::checkpoint::keep;
use crate::branches::engine::{Search, Walk};
use crate::branches::extreme::{self, Extreme};
use crate::branches::moduli;
use crate::branches::problem::{
    BranchProblem, Change, Read, TestValue, Touch, Watched, Zero, ZeroOutcome,
};
use crate::branches::progress::{Progress, See};
use crate::branches::record::Record;
use crate::branches::recurrence::{Recurrence, may_be_earlier};
use crate::continuation::follow::{Continue, CurvePoint, Step};
use crate::continuation::locate::Located;
use crate::continuation::newton::{Newton, NewtonOptions};
use crate::continuation::problem::Problem;
use crate::event::EventKind;
use crate::laws::generic::narrow::Narrow;
use crate::time::FlowError;

/// Brackets of an event are narrowed until rounding stops it, or this is reached.
pub(super) const VANISHED: f64 = 1e-14;
/// Multipliers that may be wrong by more are not compared with one.
const COARSE: f64 = 1e-3;

/// A branch by shooting.
pub(super) struct ShootingBranch<'b, 'r> {
    pub(super) run: &'b mut Run<'r>,
    pub(super) equations: Equations,
    /// The same equations for test functions, if they were needed.
    other: Option<Equations>,
    /// Made when it is asked for.
    gaps: Option<GapExtremes<'r>>,
    watched: Vec<Watched>,
    /// The test functions computed last, and where.
    tested: Option<(Vec<f64>, Tests)>,
    visit: See<'b>,
}

impl<'b, 'r> ShootingBranch<'b, 'r> {
    pub(super) fn new(run: &'b mut Run<'r>, equations: Equations, visit: See<'b>) -> Self {
        let watched = if run.problem.stability {
            test_functions::watched(equations.span.recurrence.doubling(), equations.order())
        } else {
            Vec::new()
        };
        Self {
            run,
            equations,
            other: None,
            gaps: None,
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
        if let Some(gaps) = &self.gaps {
            self.run.work += gaps.equations.flow.work();
        }
    }

    fn gaps(&mut self) -> Option<&mut GapExtremes<'r>> {
        if self.gaps.is_none() {
            let problem = self.run.problem;
            let equations = self.equations.again(problem).ok()?;
            self.gaps = Some(GapExtremes::new(problem, equations));
        }
        self.gaps.as_mut()
    }

    /// Test functions at a point.
    fn tests(&mut self, at: &CurvePoint) -> &Tests {
        let known = self.tested.take().filter(|(u, _)| *u == at.u);
        let found = known.unwrap_or_else(|| (at.u.clone(), self.tests_of(at)));
        &self.tested.insert(found).1
    }

    fn tests_of(&mut self, at: &CurvePoint) -> Tests {
        if self.other.is_none() {
            self.other = self.equations.again(self.run.problem).ok();
        }
        let map = self
            .other
            .as_mut()
            .map(|other| other.map(&at.u, &mut |_| {}));
        let map = map.and_then(Result::ok);
        Tests::of(map.as_ref(), self.divisor(at))
    }

    /// What the bordered determinant is divided by. Where the slope is rounding, nothing is known of the quotient.
    fn divisor(&self, at: &CurvePoint) -> f64 {
        at.known_slope(self.vanishing()).unwrap_or(f64::NAN)
    }

    /// How well multipliers are known along the last step.
    fn error_of_multipliers(&self) -> f64 {
        self.last_error().min(COARSE)
    }

    /// The same, however coarse.
    fn last_error(&self) -> f64 {
        self.run.record.last_error(self.vanishing())
    }

    /// What happens at a zero, if anything does.
    fn kind(&mut self, zero: &Zero) -> Option<EventKind> {
        let test_functions::Test::Modulus(place) = test_functions::Test::of(zero.change.test)
        else {
            return Some(zero.change.kind);
        };
        let tells = zero.told || zero.least <= self.last_error();
        let doubling = self.watched[test_functions::DOUBLING].kind;
        let tests = self.tests(&zero.root.located.point);
        tests.seen_by_modulus(place, tells, doubling)
    }

    fn recurrence(&mut self, at: &CurvePoint) -> Result<Option<Recurrence>, FlowError> {
        let symmetries = &self.run.problem.symmetries;
        if self.run.record.points.is_empty() {
            return Ok(None);
        }
        let same = self.run.same_state(&self.equations);
        if may_be_earlier(&self.equations.span.recurrence, symmetries)
            && let Some(found) = earlier(&mut self.equations, &at.u, same, symmetries)?
        {
            return Ok(Some(found));
        }
        let states = self.equations.states_of(&at.u);
        let state = &states[..self.equations.order()];
        let gains = self.run.gains_symmetry(&self.equations, state, same);
        Ok(gains.then(|| self.equations.span.recurrence.clone()))
    }
}

impl BranchProblem for ShootingBranch<'_, '_> {
    fn equations(&mut self) -> &mut dyn Problem {
        &mut self.equations
    }

    fn watched(&self) -> &[Watched] {
        &self.watched
    }

    fn test(&mut self, index: usize, at: &CurvePoint) -> TestValue {
        TestValue::plain(self.tests(at).value(test_functions::Test::watched(index)))
    }

    fn pairs(&mut self, at: &CurvePoint) -> Option<Vec<Complex<f64>>> {
        let watches = !self.watched.is_empty();
        watches.then(|| moduli::pairs(&self.tests(at).multipliers))
    }

    fn is_of_multipliers(&self, index: usize) -> bool {
        !self.watched[index].bordered
    }

    fn vanishing(&self) -> f64 {
        self.run.problem.vanishing(self.equations.frame.ratio)
    }

    /// Without damping all moduli are one, but for what is not known of them.
    fn noise(&self, index: usize) -> f64 {
        match test_functions::Test::watched(index) {
            test_functions::Test::Modulus(_) => self.error_of_multipliers(),
            _ => 0.0,
        }
    }

    fn aim(&self) -> f64 {
        VANISHED
    }

    fn vanishes(&mut self, change: Change, located: &Located) -> bool {
        let (point, equations) = (&located.point, &mut self.equations);
        let unit = match test_functions::Test::of(change.test) {
            test_functions::Test::Slope => point.narrowness(),
            test_functions::Test::Bordered => {
                events::others(equations, &point.u, 1.0) / point.parameter_slope().abs()
            }
            test_functions::Test::Plus => events::others(equations, &point.u, -1.0),
            test_functions::Test::Modulus(_) => {
                return located.test.abs() <= self.error_of_multipliers();
            }
        };
        located.test.abs() <= self.vanishing() * unit
    }

    fn record(&self) -> &Record {
        &self.run.record
    }

    fn record_mut(&mut self) -> &mut Record {
        &mut self.run.record
    }

    fn is_beyond(&mut self, at: &CurvePoint) -> bool {
        match self.recurrence(at) {
            Ok(found) => {
                self.run.joined = found;
                self.run.joined.is_some()
            }
            Err(failure) => {
                self.run.failure = Some(failure);
                false
            }
        }
    }

    fn joint(
        &mut self,
        newton: &mut Newton,
        step: Step<'_>,
        options: NewtonOptions,
    ) -> Option<CurvePoint> {
        if self.watched.is_empty() {
            return None;
        }
        let other = step_on_other_branch(&mut self.equations, newton, step, options)?;
        Search::of_joint(self, step, &other, options).place(self, newton)
    }

    fn goes_on(&mut self) {
        self.run.joined = None;
    }

    fn end(&mut self, newton: &mut Newton, step: Step<'_>, options: NewtonOptions) -> Option<Read> {
        let equations = &mut self.equations;
        let other = step_on_other_branch(equations, newton, step, options)?;
        if !self.watched.is_empty() {
            Search::of_joint(self, step, &other, options).record(self, newton);
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
        let tests = Tests::of(map.as_ref(), self.divisor(at));
        self.tested = Some((at.u.clone(), tests));
        let done = self.run.record.points.len() + 1;
        let answer = (self.visit)(Progress::orbit(done, &point));
        self.run.record.points.push(point);
        if answer.is_break() {
            Read::Stop
        } else {
            Read::Kept
        }
    }

    fn keep(&mut self, _: &mut Newton, step: Step<'_>, zero: &Zero) -> ZeroOutcome {
        let of_modulus = zero.change.kind == EventKind::NeimarkSacker;
        let Some(kind) = self.kind(zero) else {
            return ZeroOutcome::Nothing;
        };
        let found = self.run.event_at(&mut self.equations, step, zero, kind);
        let Some(mut event) = found else {
            return ZeroOutcome::Unread;
        };
        let at = &zero.root.located.point.u;
        if event.kind == EventKind::BranchPoint && self.run.breaks_symmetry(&mut self.equations, at)
        {
            event.kind = EventKind::SymmetryBreaking;
        }
        if of_modulus {
            if zero.least <= self.last_error() {
                // It is as good as zero from that end on.
                event.error += self.error_of_multipliers() / zero.steepness;
            }
            if moduli::is_recorded(&self.run.record.events, &event) {
                return ZeroOutcome::Nothing;
            }
        }
        let ends = matches!(event.kind, EventKind::BranchPoint | EventKind::Fold);
        let meets = ends && self.run.joined.is_none();
        self.run.record.events.push(event);
        let end = meets.then(|| self.run.meets(&mut self.equations)).flatten();
        end.map_or(ZeroOutcome::Event, ZeroOutcome::Ends)
    }

    fn seeks_touches(&self) -> bool {
        self.run.problem.stability
    }

    fn force_jumps(&self) -> bool {
        extreme::force_jumps(self.run.problem.system.as_ref())
    }

    fn corners(&self) -> bool {
        extreme::corners(self.run.problem.system.as_ref())
    }

    fn extremes(&mut self, u: &[f64], extremes: &mut Vec<Extreme>) -> bool {
        let gaps = self.gaps();
        gaps.is_some_and(|gaps| gaps.read(u, extremes).is_some())
    }

    fn plain_extremes(&mut self, u: &[f64], extremes: &mut Vec<Extreme>) -> bool {
        let gaps = self.gaps();
        gaps.is_some_and(|gaps| gaps.read_plain(u, extremes) == Some(true))
    }

    fn narrow_places(&mut self, u: &[f64], contact: usize, range: [f64; 2], to: &mut Vec<Narrow>) {
        if let Some(gaps) = self.gaps() {
            gaps.narrow(u, contact, range, to);
        }
    }

    fn extreme_form(&mut self, u: &[f64], extreme: &Extreme, range: f64, form: &mut [f64]) -> bool {
        let gaps = self.gaps();
        gaps.is_some_and(|gaps| gaps.form(u, extreme, range, form).is_some())
    }

    fn add_beginnings(&mut self, u: &[f64], extremes: &mut Vec<Extreme>) {
        if let Some(gaps) = self.gaps() {
            gaps.add_beginnings(u, extremes);
        }
    }

    fn slowest(&mut self, u: &[f64]) -> f64 {
        let slowest = self.gaps().and_then(|gaps| gaps.slowest(u));
        slowest.unwrap_or(f64::INFINITY)
    }

    fn keep_touch(&mut self, _: &mut Newton, step: Step<'_>, touch: &Touch) {
        self.run.touch(&mut self.equations, step, touch);
    }

    fn onward(&mut self, walk: Walk) -> Continue {
        let rest = self.rest(walk);
        let answer = keep(self.run.problem.keep.as_ref(), self.kept(), &rest);
        self.run.rest = Some(Box::new(rest));
        answer
    }

    fn count(&mut self, newton: &Newton) {
        self.run.statistics += newton.statistics;
    }
}
