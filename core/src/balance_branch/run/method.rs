//! Harmonic balance as the engine of branches sees it.

use nalgebra::Complex;

use super::Run;
use super::crossing_branch::CROSSED;
use super::event_monitor::{EventMonitor, Found, Test as OfOrbit};
use super::folds::FOLD_TOLERANCE;
use super::gap_extremes::GapExtremes;
use crate::balance::{Balance, Resolution};
use crate::balance_branch::context::EventSelection;
use crate::branches::checkpoint::keep;
use crate::branches::engine::{self, Walk};
use crate::branches::extreme::{self, Extreme};
use crate::branches::moduli;
use crate::branches::problem::{
    BranchProblem, Change, Read, Test, TestValue, Touch, Watched, Zero, ZeroOutcome,
};
use crate::branches::progress::{Progress, See};
use crate::branches::record::Record;
use crate::continuation::follow::{Continue, CurvePoint, Halted, Step};
use crate::continuation::locate::Located;
use crate::continuation::newton::{Newton, NewtonOptions};
use crate::continuation::problem::Problem;
use crate::event::EventKind;
use crate::laws::generic::narrow::Narrow;

/// A branch by the balance at its present resolution.
pub(super) struct BalanceBranch<'r, 'v> {
    pub(super) run: Run<'r>,
    balance: Balance<'r>,
    /// Made when it is asked for.
    gaps: Option<GapExtremes<'r>>,
    visit: See<'v>,
}

impl<'r, 'v> BalanceBranch<'r, 'v> {
    pub(super) fn new(run: Run<'r>, visit: See<'v>) -> Self {
        Self {
            balance: run.context.balance(run.resolution),
            run,
            gaps: None,
            visit,
        }
    }

    fn gaps(&mut self) -> &mut GapExtremes<'r> {
        let run = &self.run;
        let new = || GapExtremes::new(run.context.balance(run.resolution));
        self.gaps.get_or_insert_with(new)
    }

    fn renew(&mut self) {
        self.gaps = None;
        self.balance = self.run.context.balance(self.run.resolution);
    }
}

impl BranchProblem for BalanceBranch<'_, '_> {
    fn equations(&mut self) -> &mut dyn Problem {
        &mut self.balance
    }

    fn watched(&self) -> &[Watched] {
        &self.run.monitor.watched
    }

    fn test(&mut self, index: usize, at: &CurvePoint) -> TestValue {
        let run = &mut self.run;
        let Some(place) = index.checked_sub(run.monitor.blocks.len()) else {
            return run.monitor.value(index, at);
        };
        let mut monitor = std::mem::take(&mut run.monitor);
        let modulus = run.modulus(&mut monitor, &at.u, place);
        run.monitor = monitor;
        TestValue::plain(modulus)
    }

    fn pairs(&mut self, at: &CurvePoint) -> Option<Vec<Complex<f64>>> {
        let mut monitor = std::mem::take(&mut self.run.monitor);
        let found = self.run.pairs(&mut monitor, &at.u);
        self.run.monitor = monitor;
        found
    }

    fn aim(&self) -> f64 {
        FOLD_TOLERANCE
    }

    /// Without damping all moduli are one, but for what is not known of them.
    fn noise(&self, index: usize) -> f64 {
        match self.run.monitor.watched[index].kind {
            EventKind::NeimarkSacker => self.run.error_of_multipliers(),
            _ => 0.0,
        }
    }

    fn vanishes(&mut self, change: Change, located: &Located) -> bool {
        if change.kind == EventKind::NeimarkSacker {
            return located.vanishes || located.test.abs() <= self.run.error_of_multipliers();
        }
        if engine::is_crossing(self, change) {
            located.test.abs() <= CROSSED
        } else {
            located.vanishes
        }
    }

    fn record(&self) -> &Record {
        &self.run.record
    }

    fn record_mut(&mut self) -> &mut Record {
        &mut self.run.record
    }

    fn is_beyond(&mut self, at: &CurvePoint) -> bool {
        self.run.joins(&at.u)
    }

    fn end(&mut self, newton: &mut Newton, step: Step<'_>, _: NewtonOptions) -> Option<Read> {
        if self.run.join(&mut self.balance, newton, step) {
            return None;
        }
        // It only seemed to belong to what comes after the end. The walk cannot be halted here for more harmonics, so that the point
        // stands with the error it has.
        let point = self.run.read_again(&mut self.balance, newton, step.next);
        let done = self.run.record.points.len() + 1;
        let answer = (self.visit)(Progress::orbit(done, &point));
        self.run.record.points.push(point);
        Some(if answer.is_break() {
            Read::Stop
        } else {
            Read::Kept
        })
    }

    fn read(&mut self, newton: &mut Newton, at: &CurvePoint) -> Read {
        self.run.read(&mut self.balance, newton, at, self.visit)
    }

    fn keep(&mut self, newton: &mut Newton, step: Step<'_>, zero: &Zero) -> ZeroOutcome {
        let (run, balance) = (&mut self.run, &mut self.balance);
        let index = match zero.change.test {
            Test::Watched(index) => Some(index),
            // A branch that turns where it ends on another one.
            Test::Slope if zero.change.kind == EventKind::BranchPoint => run
                .monitor
                .watched
                .iter()
                .position(|watched| watched.bordered),
            Test::Slope => None,
        };
        let Some(index) = index else {
            return run.fold(balance, newton, zero);
        };
        let mut monitor = std::mem::take(&mut run.monitor);
        let kept = run.keep(balance, newton, step, zero, &mut monitor, index);
        run.monitor = monitor;
        kept
    }

    fn seeks_touches(&self) -> bool {
        self.run.context.selection == EventSelection::All
    }

    fn force_jumps(&self) -> bool {
        extreme::force_jumps(self.run.context.system.as_ref())
    }

    fn corners(&self) -> bool {
        extreme::corners(self.run.context.system.as_ref())
    }

    fn resolves_sharp(&self) -> bool {
        false
    }

    fn extremes(&mut self, u: &[f64], extremes: &mut Vec<Extreme>) -> bool {
        self.gaps().read(u, extremes);
        true
    }

    fn plain_extremes(&mut self, u: &[f64], extremes: &mut Vec<Extreme>) -> bool {
        self.gaps().read_plain(u, extremes)
    }

    fn narrow_places(&mut self, u: &[f64], contact: usize, range: [f64; 2], to: &mut Vec<Narrow>) {
        self.gaps().narrow(u, contact, range, to);
    }

    fn extreme_form(&mut self, u: &[f64], extreme: &Extreme, range: f64, form: &mut [f64]) -> bool {
        self.gaps().form(u, extreme, range, form);
        true
    }

    fn keep_touch(&mut self, newton: &mut Newton, step: Step<'_>, touch: &Touch) {
        self.gaps();
        let Self {
            run, balance, gaps, ..
        } = self;
        let Some(gaps) = gaps else { return };
        let mut test = OfOrbit::Extreme(gaps, touch.extreme);
        let found = Found {
            kind: EventKind::Grazing { turns: touch.turns },
            located: &touch.located,
            after: touch.after,
        };
        run.located(balance, newton, step, &mut test, &found);
        if let Some(event) = run.record.events.last_mut() {
            event.contacts = touch.contacts;
        }
    }

    fn couple_fully(&mut self) -> bool {
        if !self.run.has_tail() {
            return false;
        }
        self.run.couple_all();
        self.run.renew();
        self.renew();
        true
    }

    fn couple_fully_once(&mut self, on: bool) -> bool {
        let resolution = self.run.resolution;
        let coupled = self.balance.resolution().core == resolution.harmonics;
        if !self.run.has_tail() || (on && coupled) {
            return false;
        }
        let core = if on {
            resolution.harmonics
        } else {
            resolution.core
        };
        self.balance = self.run.context.balance(Resolution { core, ..resolution });
        true
    }

    fn remap(&mut self, halted: &mut Halted) {
        self.run.remap(halted);
        self.renew();
    }

    fn revert(&mut self) {
        self.run.revert();
        self.renew();
    }

    fn onward(&mut self, walk: Walk) -> Continue {
        let rest = self.run.rest(walk);
        let kept = self.kept();
        let answer = keep(self.run.context.keep.as_ref(), kept, &rest);
        self.run.rest = Some(Box::new(rest));
        answer
    }

    fn count(&mut self, newton: &Newton) {
        self.run.statistics += newton.statistics;
    }
}

impl<'r> Run<'r> {
    /// Keeps an event of a test function that is watched.
    fn keep(
        &mut self,
        balance: &mut Balance<'_>,
        newton: &mut Newton,
        step: Step<'_>,
        zero: &Zero,
        monitor: &mut EventMonitor<'r>,
        index: usize,
    ) -> ZeroOutcome {
        let bordered = monitor.watched[index].bordered;
        let at = &zero.root.located.point.u;
        let mut kind = zero.change.kind;
        let mut test = if let Some(block) = monitor.blocks.get_mut(index) {
            let slope = zero.change.test == Test::Slope;
            OfOrbit::Block(block, (!slope).then_some(zero.reference))
        } else if let Some(multipliers) = &mut monitor.multipliers {
            let place = index - monitor.blocks.len();
            // What is within the error of multipliers at an end is left to the determinants.
            let tells = zero.told || zero.least <= self.last_error();
            let Some(seen) = moduli::seen_by_moduli(multipliers.at(at), place, tells) else {
                return ZeroOutcome::Nothing;
            };
            kind = seen;
            OfOrbit::Modulus(multipliers, place)
        } else {
            return ZeroOutcome::Nothing;
        };
        if bordered {
            self.branch_point(balance, newton, step, zero, &mut test);
        } else {
            let found = Found {
                kind,
                located: &zero.root.located,
                after: zero.after,
            };
            let of_modulus = matches!(test, OfOrbit::Modulus(..));
            self.located(balance, newton, step, &mut test, &found);
            if of_modulus {
                self.widen(zero);
            }
        }
        ZeroOutcome::Event
    }

    /// Adds what errors of multipliers make of the last event, unless it is another one once more.
    fn widen(&mut self, zero: &Zero) {
        let spread = self.error_of_multipliers() / zero.steepness;
        let Some(mut event) = self.record.events.pop() else {
            return;
        };
        event.error += spread;
        if !moduli::is_recorded(&self.record.events, &event) {
            self.record.events.push(event);
        }
    }
}
