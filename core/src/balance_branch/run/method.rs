//! Harmonic balance as the engine of branches sees it.

use super::Run;
use super::crossed::CROSSED;
use super::event_monitor::{EventMonitor, Found, Test as OfOrbit};
use super::events::FOLD_TOLERANCE;
use crate::balance::{Balance, Resolution};
use crate::branches::engine;
use crate::branches::problem::{
    BranchProblem, Change, Read, Test, TestValue, Watched, Zero, ZeroOutcome,
};
use crate::branches::progress::{Progress, See};
use crate::continuation::follow::{CurvePoint, Halted, Step};
use crate::continuation::locate::Located;
use crate::continuation::newton::{Newton, NewtonOptions};
use crate::continuation::problem::Problem;
use crate::event::{EventKind, Turn};

/// Products of pairs of multipliers that are rounding.
const NOISE: f64 = 1e-20;

/// A branch by the balance at its present resolution.
pub(super) struct BalanceBranch<'r, 'v> {
    pub(super) run: Run<'r>,
    balance: Balance<'r>,
    visit: See<'v>,
}

impl<'r, 'v> BalanceBranch<'r, 'v> {
    pub(super) fn new(run: Run<'r>, visit: See<'v>) -> Self {
        Self {
            balance: run.context.balance(run.resolution),
            run,
            visit,
        }
    }

    fn renew(&mut self) {
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

    fn test(&mut self, index: usize, at: &CurvePoint, needed: bool) -> TestValue {
        let near = needed || self.run.is_near_circle();
        self.run.monitor.value(index, at, near)
    }

    fn aim(&self) -> f64 {
        FOLD_TOLERANCE
    }

    /// Without damping the product of two pairs or more is rounding all along, each factor being so to about 1e-12.
    fn noise(&self, index: usize) -> f64 {
        match self.run.monitor.watched[index].kind {
            EventKind::NeimarkSacker => NOISE,
            _ => 0.0,
        }
    }

    fn vanishes(&mut self, change: Change, located: &Located) -> bool {
        if change.kind == EventKind::NeimarkSacker {
            // What is nothing special need not vanish to be passed over.
            return located.vanishes || !self.run.monitor.is_complex(&located.point.u);
        }
        if engine::is_crossing(self, change) {
            located.test.abs() <= CROSSED
        } else {
            located.vanishes
        }
    }

    fn points(&self) -> usize {
        self.run.points.len()
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
        let done = self.run.points.len() + 1;
        let answer = (self.visit)(Progress::orbit(done, &point));
        self.run.points.push(point);
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

    fn keep_turn(&mut self, turn: Turn) {
        self.run.turns.push(turn);
    }

    fn graze(&mut self, newton: &mut Newton, step: Step<'_>, turned: Option<Turn>) {
        let (run, balance) = (&mut self.run, &mut self.balance);
        let mut monitor = std::mem::take(&mut run.monitor);
        if let Some(gaps) = &mut monitor.gaps {
            run.grazing(balance, newton, step, gaps, &mut monitor.extremes, turned);
        }
        run.monitor = monitor;
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
        if !self.run.has_tail() {
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
        let mut test = if let Some(block) = monitor.blocks.get_mut(index) {
            let slope = zero.change.test == Test::Slope;
            OfOrbit::Block(block, (!slope).then_some(zero.reference))
        } else if let Some(pairs) = &mut monitor.pairs {
            if !pairs.product(at).1 {
                // A pair of real multipliers whose product is one is nothing special.
                return ZeroOutcome::Nothing;
            }
            OfOrbit::Pairs(pairs)
        } else {
            return ZeroOutcome::Nothing;
        };
        if bordered {
            self.branch_point(balance, newton, step, zero, &mut test);
        } else {
            let found = Found {
                kind: zero.change.kind,
                located: &zero.root.located,
                after: zero.after,
            };
            self.located(balance, newton, step, &mut test, &found);
        }
        ZeroOutcome::Event
    }
}
