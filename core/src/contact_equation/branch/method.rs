//! The contact equation as the engine of branches sees it.

use nalgebra::Complex;

use super::change_equations::Before;
use super::events;
use super::first_orbit::FirstOrbit;
use super::prepare_equations::{HELD, Next};
use super::resume_state::Rest;
use super::test_values::{Last, VANISHING};
use crate::branches::branch_start::step_on_other_branch;
use crate::branches::checkpoint::keep;
use crate::branches::engine::{Search, Walk};
use crate::branches::extreme::{self, Extreme};
use crate::branches::moduli;
use crate::branches::problem::{
    BranchProblem, Change, Read, TestValue, Touch, Watched, Zero, ZeroOutcome,
};
use crate::branches::progress::See;
use crate::branches::record::Record;
use crate::contact_equation::problem::FIRST;
use crate::contact_equation::run::Run;
use crate::contact_equation::switches::fits::Fits;
use crate::continuation::follow::{Continue, CurvePoint, Halted, Step};
use crate::continuation::locate::Located;
use crate::continuation::newton::{Newton, NewtonOptions};
use crate::continuation::problem::Problem;
use crate::event::EventKind;
use crate::laws::generic::narrow::Narrow;
use crate::shooting::test_functions::{self, Tests};

/// Brackets of an event are narrowed until rounding stops it, or this is reached.
pub(super) const VANISHED: f64 = 1e-14;
/// Multipliers that may be wrong by more are not compared with one.
const COARSE: f64 = 1e-3;

/// A branch by the contact equation.
pub(in crate::contact_equation) struct ContactBranch<'b, 'r> {
    pub(in crate::contact_equation) run: &'b mut Run<'r>,
    pub(super) watched: Vec<Watched>,
    /// The test functions computed last, and where.
    pub(super) tested: Option<(Vec<f64>, Tests)>,
    /// The last orbit that was kept.
    pub(in crate::contact_equation) last: Option<Last>,
    /// The equations that the walk goes on with, and its last point in them.
    pub(super) next: Option<Next>,
    /// Where it was before the last step.
    pub(in crate::contact_equation) rest: Option<Box<Rest>>,
    /// The equations before, while others are tried.
    pub(super) before: Option<Before>,
    /// The first orbit, where equations have changed since.
    pub(super) first: Option<FirstOrbit>,
    /// The same as a point of the present equations, in which the walk does not have it yet.
    pub(super) first_here: Option<CurvePoint>,
    /// Where it was in them before it was found there, while the walk goes over to that.
    pub(super) moved: Option<Vec<f64>>,
    /// The last step has passed it, as states tell.
    pub(super) passes_first: bool,
    /// Other equations lead nowhere from the last point.
    pub(super) stuck: bool,
    /// How often the last point was refused.
    pub(in crate::contact_equation) refused: usize,
    /// How often the step to it was made again, shorter.
    pub(super) shortened: usize,
    /// The same, since the last orbit that was kept had no place in its equations.
    pub(super) displaced: usize,
    /// The last orbit that was kept, in the present unknowns; empty where it is not known in them.
    pub(in crate::contact_equation) kept: Vec<f64>,
    /// Points that are followed before fewer nodes are tried.
    pub(in crate::contact_equation) held: usize,
    pub(super) visit: See<'b>,
}

impl<'b, 'r> ContactBranch<'b, 'r> {
    pub(in crate::contact_equation) fn new(run: &'b mut Run<'r>, visit: See<'b>) -> Self {
        let watched = if run.problem.asked.stability {
            let skeleton = &run.equations.skeleton;
            test_functions::watched(skeleton.recurrence().doubling(), skeleton.order)
        } else {
            Vec::new()
        };
        Self {
            held: if run.resolution > FIRST { HELD } else { 0 },
            run,
            watched,
            tested: None,
            last: None,
            next: None,
            rest: None,
            before: None,
            first: None,
            first_here: None,
            moved: None,
            passes_first: false,
            stuck: false,
            refused: 0,
            shortened: 0,
            displaced: 0,
            kept: Vec::new(),
            visit,
        }
    }
}

// Test functions are those of a map over the period, as by shooting; where the map comes from is another thing, so what asks for them
// is written for both.
impl BranchProblem for ContactBranch<'_, '_> {
    fn equations(&mut self) -> &mut dyn Problem {
        &mut self.run.equations
    }

    fn watched(&self) -> &[Watched] {
        &self.watched
    }

    fn test(&mut self, index: usize, at: &CurvePoint) -> TestValue {
        TestValue::plain(self.tests(at).value(test_functions::Test::watched(index)))
    }

    fn slope(&mut self, at: &CurvePoint) -> f64 {
        self.run.slope(at)
    }

    fn pairs(&mut self, at: &CurvePoint) -> Option<Vec<Complex<f64>>> {
        let watches = !self.watched.is_empty();
        watches.then(|| moduli::pairs(&self.tests(at).multipliers))
    }

    fn is_of_multipliers(&self, index: usize) -> bool {
        !self.watched[index].bordered
    }

    fn vanishing(&self) -> f64 {
        VANISHING
    }

    fn noise(&self, index: usize) -> f64 {
        match test_functions::Test::watched(index) {
            test_functions::Test::Modulus(_) => self.last_error().min(COARSE),
            _ => 0.0,
        }
    }

    fn aim(&self) -> f64 {
        VANISHED
    }

    fn vanishes(&mut self, change: Change, located: &Located) -> bool {
        let point = &located.point;
        let unit = match test_functions::Test::of(change.test) {
            test_functions::Test::Slope => point.narrowness(),
            test_functions::Test::Bordered => {
                self.run.others(point, 1.0) / point.parameter_slope().abs()
            }
            test_functions::Test::Plus => self.run.others(point, -1.0),
            test_functions::Test::Modulus(_) => return located.test.abs() <= self.last_error(),
        };
        located.test.abs() <= VANISHING * unit
    }

    fn record(&self) -> &Record {
        &self.run.record
    }

    fn record_mut(&mut self) -> &mut Record {
        &mut self.run.record
    }

    fn is_beyond(&mut self, at: &CurvePoint) -> bool {
        self.run.joined = self.run.earlier(at);
        self.run.joined.is_some()
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
        let other = step_on_other_branch(&mut self.run.equations, newton, step, options)?;
        Search::of_joint(self, step, &other, options).place(self, newton)
    }

    fn goes_on(&mut self) {
        self.run.joined = None;
    }

    fn end(&mut self, newton: &mut Newton, step: Step<'_>, options: NewtonOptions) -> Option<Read> {
        let other = step_on_other_branch(&mut self.run.equations, newton, step, options)?;
        if !self.watched.is_empty() {
            Search::of_joint(self, step, &other, options).record(self, newton);
        }
        None
    }

    fn read(&mut self, _: &mut Newton, at: &CurvePoint) -> Read {
        self.read_orbit(at)
    }

    fn keep(&mut self, _: &mut Newton, step: Step<'_>, zero: &Zero) -> ZeroOutcome {
        let of_modulus = zero.change.kind == EventKind::NeimarkSacker;
        let Some(kind) = self.kind(zero) else {
            return ZeroOutcome::Nothing;
        };
        let Some(mut event) = self.run.event(step, zero, kind) else {
            return ZeroOutcome::Unread;
        };
        let at = &zero.root.located.point.u;
        if event.kind == EventKind::BranchPoint && self.run.breaks_symmetry(at) {
            event.kind = EventKind::SymmetryBreaking;
        }
        if of_modulus && moduli::is_recorded(&self.run.record.events, &event)
            || events::crosses_nothing(&event)
        {
            return ZeroOutcome::Nothing;
        }
        let meets = event.kind == EventKind::BranchPoint && self.run.joined.is_none();
        self.run.record.events.push(event);
        let end = meets.then(|| self.run.meets(at)).flatten();
        end.map_or(ZeroOutcome::Event, ZeroOutcome::Ends)
    }

    fn seeks_touches(&self) -> bool {
        self.run.problem.asked.stability
    }

    fn force_jumps(&self) -> bool {
        extreme::force_jumps(self.run.problem.asked.system.as_ref())
    }

    fn corners(&self) -> bool {
        extreme::corners(self.run.problem.asked.system.as_ref())
    }

    fn extremes(&mut self, u: &[f64], extremes: &mut Vec<Extreme>) -> bool {
        self.run.extremes(u, extremes)
    }

    fn plain_extremes(&mut self, u: &[f64], extremes: &mut Vec<Extreme>) -> bool {
        self.run.plain_extremes(u, extremes)
    }

    fn narrow_places(&mut self, _: &[f64], contact: usize, range: [f64; 2], to: &mut Vec<Narrow>) {
        self.run.narrow_places(contact, range, to);
    }

    fn extreme_form(&mut self, u: &[f64], extreme: &Extreme, _: f64, form: &mut [f64]) -> bool {
        // No unknown tells how far an extreme is from a narrow place.
        !extreme.plain && self.run.extreme_form(u, extreme, form)
    }

    fn lifted(&mut self, u: &[f64], extreme: &Extreme, height: f64) -> Option<Vec<f64>> {
        self.run.lifted(u, extreme, height)
    }

    fn slowest(&mut self, u: &[f64]) -> f64 {
        self.run.slowest(u)
    }

    fn describes(&mut self, at: &CurvePoint) -> bool {
        self.run.equations.compute(&at.u, false);
        !self.run.equations.failed && self.run.fits(&at.u) != Fits::No
    }

    fn keep_touch(&mut self, _: &mut Newton, _: Step<'_>, touch: &Touch) {
        events::touch(self.run, touch);
    }

    fn remap(&mut self, halted: &mut Halted) {
        self.change_equations(halted);
    }

    fn revert(&mut self) {
        self.restore_equations();
    }

    fn onward(&mut self, walk: Walk) -> Continue {
        let rest = self.rest(walk);
        let answer = keep(
            self.run.problem.asked.keep.as_ref(),
            self.run.record.kept(),
            &rest,
        );
        self.rest = Some(Box::new(rest));
        answer
    }

    fn count(&mut self, newton: &Newton) {
        self.run.statistics += newton.statistics;
    }
}
