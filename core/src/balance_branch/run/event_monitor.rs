//! Events besides folds, and where they are between two points of a branch.
//!
//! | event | test function |
//! |---|---|
//! | symmetry breaking, period doubling | the determinant of the block of harmonics that the orbits do not have ([`critical_block`](crate::balance::critical_block)) |
//! | branch point ([`crossed`](super::crossed)) | the determinant of the Jacobian with the tangent as its border |
//! | Neimark-Sacker | the product over pairs of multipliers ([`pairs`](crate::orbit::stability::pairs)), and a pair is complex |
//! | grazing ([`grazing`](super::grazing)) | an extreme of a gap less the level ([`gap_extremes`](super::gap_extremes)) |
//!
//! All are functions of the discrete orbit, and driven to zero on the branch. The same functions of the orbit that is corrected for
//! the harmonics left out say where the event would be then: with `s` along the unit tangent `t`, and `du` the correction,
//!
//! ```text
//! ds = - T(u + du) / (dT/ds),      d lambda = du_l + ds t_l                                                    (1)
//! ```
//!
//! What changes its sign and leads to no zero is recorded as a [`Turn`] of its kind.

use std::cell::RefCell;

use super::Run;
use super::gap_extremes::{Extreme, GapExtremes};
use crate::balance::critical_block::{CriticalBlock, Part};
use crate::balance::resolution::resize;
use crate::balance::truncation::BEYOND;
use crate::balance::{Balance, Resolution};
use crate::balance_branch::context::{BranchContext, EventSelection};
use crate::branches::point::{Event, Point};
use crate::branches::problem::{TestValue, Watched};
use crate::continuation::follow::{CurvePoint, Step};
use crate::continuation::locate::Located;
use crate::continuation::newton::Newton;
use crate::event::{EventKind, Turn};
use crate::numeric::fourier::series;
use crate::orbit::stability::pairs::Pairs;

/// Derivatives along the branch are differences over this part of the step.
const DIFFERENCE: f64 = 1e-4;
/// Relative error that rounding leaves in the value of an event.
pub(super) const ROUNDING: f64 = 1e-12;
/// Multipliers whose product is farther than this from one are not looked at more closely.
const NEAR_CIRCLE: f64 = 0.5;

/// A function of orbits that vanishes at an event.
pub(super) enum Test<'t, 'a> {
    /// In units of a size, given as its logarithm: that of the first if it is not given.
    Block(&'t mut CriticalBlock<'a>, Option<f64>),
    Pairs(&'t mut Pairs<'a>),
    /// Of one extreme, wherever it moves.
    Extreme(&'t mut GapExtremes<'a>, Extreme),
}

impl Test<'_, '_> {
    pub(super) fn at(&mut self, u: &[f64], tangent: &[f64]) -> f64 {
        match self {
            Self::Block(block, largest) => {
                let (sign, size) = block.determinant_along(u, tangent);
                sign * (size - *largest.get_or_insert(size)).exp()
            }
            Self::Pairs(pairs) => pairs.product(u).0,
            Self::Extreme(gaps, extreme) => {
                let mut extremes = Vec::new();
                gaps.read(u, &mut extremes);
                extreme.nearest(&extremes).map_or(f64::NAN, |found| {
                    // The next one is looked for where this one was.
                    *extreme = *found;
                    found.above
                })
            }
        }
    }
}

/// An event that was located, behind so many points of the branch.
pub(super) struct Found<'f> {
    pub(super) kind: EventKind,
    pub(super) located: &'f Located,
    pub(super) after: usize,
}

/// What is watched along a branch, at one resolution.
#[derive(Debug, Default)]
pub(super) struct EventMonitor<'a> {
    /// Test functions: of the blocks, then of the pairs.
    pub(super) watched: Vec<Watched>,
    pub(super) blocks: Vec<CriticalBlock<'a>>,
    pub(super) pairs: Option<Pairs<'a>>,
    pub(super) gaps: Option<GapExtremes<'a>>,
    /// Extremes at the ends of the step looked at.
    pub(super) extremes: [Vec<Extreme>; 2],
}

impl<'a> EventMonitor<'a> {
    pub(super) fn new(context: &'a BranchContext, resolution: Resolution) -> Self {
        let coordinates = context.system.facts().coordinates.len();
        let all = context.selection == EventSelection::All;
        // Two multipliers on the unit circle, of one coordinate, are there with no damping only.
        let pairs = all && context.stability.is_some() && coordinates > 1;
        let blocks = context.blocks(resolution);
        let mut watched: Vec<Watched> = blocks.iter().map(|block| watched(block.part)).collect();
        watched.extend(pairs.then_some(Watched {
            kind: EventKind::NeimarkSacker,
            bordered: false,
        }));
        Self {
            watched,
            blocks,
            pairs: pairs.then(|| Pairs::new(context.balance(resolution))),
            gaps: all.then(|| GapExtremes::new(context.balance(resolution))),
            extremes: Default::default(),
        }
    }

    /// Value of a test function; pairs are looked at only where some are `near` the unit circle.
    pub(super) fn value(&mut self, index: usize, at: &CurvePoint, near: bool) -> TestValue {
        if let Some(block) = self.blocks.get_mut(index) {
            let (mantissa, exponent) = block.determinant_along(&at.u, &at.tangent);
            return TestValue { mantissa, exponent };
        }
        let pairs = self.pairs.as_mut().filter(|_| near);
        pairs.map_or(TestValue::UNKNOWN, |pairs| {
            TestValue::plain(pairs.product(&at.u).0)
        })
    }

    /// Whether the pair of multipliers whose product is nearest to one is complex.
    pub(super) fn is_complex(&mut self, u: &[f64]) -> bool {
        self.pairs.as_mut().is_some_and(|pairs| pairs.product(u).1)
    }

    /// Determinants, each a Jacobian and a factorisation, and monodromy matrices that were computed.
    pub(super) fn computed(&self) -> (usize, usize) {
        let determinants = self.blocks.iter().map(|block| block.computed).sum();
        (
            determinants,
            self.pairs.as_ref().map_or(0, |pairs| pairs.computed),
        )
    }
}

impl<'a> Run<'a> {
    /// Whether a pair of complex multipliers is near the unit circle at one of the last two points.
    pub(super) fn is_near_circle(&self) -> bool {
        let near = |point: &Point| {
            let multipliers = &point.stability.multipliers;
            let complex = multipliers.iter().filter(|m| m.im > 0.0);
            let mut distances = complex.map(|m| (m.norm_sqr() - 1.0).abs());
            distances.any(|distance| distance < NEAR_CIRCLE)
        };
        self.points[self.points.len().saturating_sub(2)..]
            .iter()
            .any(near)
    }

    /// Records what could not be located.
    pub(super) fn omit(&mut self, kind: EventKind, step: Step<'_>, test: f64) {
        let [a, b] = step.parameters();
        self.turns.push(Turn {
            kind,
            value: 0.5 * (a + b),
            test,
            after: self.points.len() - 1,
        });
    }

    /// Locates the zero of a test function, with core and tail, or else with the whole system.
    pub(super) fn event(
        &mut self,
        balance: &mut Balance<'_>,
        newton: &mut Newton,
        step: Step<'_>,
        kind: EventKind,
        test: &mut Test<'_, 'a>,
    ) {
        let ends = [step.before, step.next].map(|end| test.at(&end.u, &end.tangent));
        let cell = RefCell::new(test);
        let value = |point: &CurvePoint| cell.borrow_mut().at(&point.u, &point.tangent);
        let read = |run: &mut Self, b: &mut Balance<'_>, n: &mut Newton, found: &Located| {
            let test: &mut Test<'_, 'a> = &mut cell.borrow_mut();
            let found = Found {
                kind,
                located: found,
                after: run.points.len() - 1,
            };
            run.located(b, n, step, test, &found);
        };
        if self
            .locate_zero(balance, newton, step, value, read)
            .is_err()
        {
            self.omit(kind, step, ends[0]);
        }
    }

    /// Reads the orbit at an event, whose factors Newton's method holds.
    pub(super) fn located(
        &mut self,
        balance: &mut Balance<'_>,
        newton: &mut Newton,
        step: Step<'_>,
        test: &mut Test<'_, 'a>,
        found: &Found<'_>,
    ) {
        let Found {
            kind,
            located,
            after,
        } = *found;
        let u = &located.point.u;
        let left = newton.left_in_parameter();
        let error = if self.evaluator.finer.correct(u, newton) {
            let scale = step.before.scale;
            let length = newton.norm().length(scale, &step.difference());
            left + self.event_error(&located.point, DIFFERENCE * length, test)
        } else {
            f64::INFINITY
        };
        let point = self.evaluator.read(balance, newton, u);
        self.events.push(Event {
            kind,
            point,
            error,
            test: located.test,
            after,
            contacts: usize::from(matches!(kind, EventKind::Grazing { .. })),
            tangent: Vec::new(),
        });
    }

    /// Estimated error of an event, from the corrected orbit that is held. What the first half of the harmonics that were left out
    /// does and what the second half does may cancel, and are taken by their sizes.
    fn event_error(&mut self, point: &CurvePoint, step: f64, test: &Test<'_, 'a>) -> f64 {
        let fine = self.evaluator.finer.balance().resolution();
        let some = three_quarters(fine);
        let mut by = |of| self.moved(point, step, of, test);
        let (all, half) = (by(fine), by(some));
        let change = half.abs() + (all - half).abs();
        or_infinite(BEYOND * change + ROUNDING * point.parameter().abs())
    }

    /// (1) with the harmonics of a resolution, and the derivative from differences over `step`.
    fn moved(
        &mut self,
        point: &CurvePoint,
        step: f64,
        resolution: Resolution,
        test: &Test<'_, 'a>,
    ) -> f64 {
        let mut monitor = self.monitor_like(test, resolution);
        let Some(mut test) = monitor.test(test) else {
            return f64::INFINITY;
        };
        let finer = self.with_harmonics_of(self.evaluator.finer.extended(), resolution);
        let tangent = self.with_harmonics_of(&point.tangent, resolution);
        let mut at = |by: f64| {
            let pairs = finer.iter().zip(&tangent);
            let u: Vec<f64> = pairs.map(|(x, t)| x + by * t).collect();
            test.at(&u, &tangent)
        };
        let (a, here, b) = (at(-step), at(0.0), at(step));
        let along = -here / ((b - a) / (2.0 * step));
        let last = finer.len() - 1;
        let moved = finer[last] - point.parameter() + along * tangent[last];
        self.count(&monitor);
        moved
    }

    /// Adds the work of a monitor that was made for one event.
    pub(super) fn count(&mut self, monitor: &EventMonitor<'_>) {
        let (determinants, monodromies) = monitor.computed();
        self.statistics.jacobians += determinants;
        self.statistics.factorisations += determinants;
        self.statistics.monodromies += monodromies;
    }

    /// What is watched for a test function, in some resolution.
    pub(super) fn monitor_like(
        &self,
        test: &Test<'_, 'a>,
        resolution: Resolution,
    ) -> EventMonitor<'a> {
        let context = self.context;
        let mut monitor = EventMonitor::default();
        match test {
            Test::Extreme(..) => {
                monitor.gaps = Some(GapExtremes::new(context.balance(resolution)));
            }
            Test::Pairs(_) => {
                monitor.pairs = Some(Pairs::new(context.balance(resolution)));
            }
            Test::Block(block, _) => monitor.blocks.push(context.block(block.part, resolution)),
        }
        monitor
    }

    /// A vector of the branch in another resolution.
    pub(super) fn with_harmonics_of(&self, v: &[f64], resolution: Resolution) -> Vec<f64> {
        let coordinates = self.context.system.facts().coordinates.len();
        resize(v, coordinates, series::length(resolution.harmonics))
    }
}

/// What a block tells. The determinant of all of the Jacobian has the tangent as its border.
fn watched(part: Part) -> Watched {
    Watched {
        kind: part.kind(),
        bordered: part == Part::Own,
    }
}

impl<'a> EventMonitor<'a> {
    /// The same test function of other orbits, in units of its own.
    pub(super) fn test(&mut self, like: &Test<'_, 'a>) -> Option<Test<'_, 'a>> {
        match like {
            Test::Block(..) => self
                .blocks
                .first_mut()
                .map(|block| Test::Block(block, None)),
            Test::Pairs(_) => self.pairs.as_mut().map(Test::Pairs),
            Test::Extreme(_, extreme) => {
                let gaps = self.gaps.as_mut();
                gaps.map(|gaps| Test::Extreme(gaps, *extreme))
            }
        }
    }
}

/// With half of the harmonics that a correction adds.
pub(super) fn three_quarters(fine: Resolution) -> Resolution {
    let harmonics = fine.harmonics * 3 / 4;
    Resolution {
        harmonics,
        core: fine.core.min(harmonics),
        ..fine
    }
}

/// An error, or infinity where nothing is known of it.
pub(super) fn or_infinite(error: f64) -> f64 {
    if error.is_finite() {
        error
    } else {
        f64::INFINITY
    }
}
