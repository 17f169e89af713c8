//! Events besides folds, and where they are between two points of a branch.
//!
//! | event | test function |
//! |---|---|
//! | symmetry breaking, period doubling | the determinant of the block of harmonics that the orbits do not have ([`critical_block`](crate::balance::critical_block)) |
//! | branch point ([`crossing_branch`](super::crossing_branch)) | the determinant of the Jacobian with the tangent as its border |
//! | Neimark-Sacker | the moduli of multipliers ([`moduli`](crate::branches::moduli)), where a complex pair passes one |
//! | grazing ([`grazing`](crate::branches::engine)) | an extreme of a gap less the level ([`gap_extremes`](super::gap_extremes)) |
//!
//! All are functions of the discrete orbit, and driven to zero on the branch. The same functions of the orbit that is corrected for
//! the harmonics left out say where the event would be then: with `s` along the unit tangent `t`, and `du` the correction,
//!
//! ```text
//! ds = - T(u + du) / (dT/ds),      d lambda = du_l + ds t_l                                                    (1)
//! ```
//!
//! Where that is farther along the branch than the step is long in which the event was located, (1) says nothing, and the error is infinite.
//!
//! What changes its sign and leads to no zero is recorded as a [`Turn`] of its kind.

use super::Run;
use super::corrected_moduli::Corrections;
use super::gap_extremes::GapExtremes;
use crate::balance::critical_block::{CriticalBlock, Part};
use crate::balance::resolution::resize;
use crate::balance::truncation::BEYOND;
use crate::balance::{Balance, Resolution};
use crate::balance_branch::context::{BranchContext, EventSelection};
use crate::branches::extreme::Extreme;
use crate::branches::moduli;
use crate::branches::point::{Event, Point};
use crate::branches::problem::{TestValue, Watched};
use crate::continuation::follow::{CurvePoint, Step};
use crate::continuation::locate::Located;
use crate::continuation::newton::Newton;
use crate::event::EventKind;
use crate::numeric::fourier::series;
use crate::orbit::stability::uncorrected::Uncorrected;

/// Derivatives along the branch are differences over this part of the step.
const DIFFERENCE: f64 = 1e-4;
/// A multiplier that is farther from its critical value than this, and its error, is not the one that an event is due to.
const FAR: f64 = 0.1;
/// Relative error that rounding leaves in the value of an event.
pub(super) const ROUNDING: f64 = 1e-12;

/// A function of orbits that vanishes at an event.
pub(super) enum Test<'t, 'a> {
    /// In units of a size, given as its logarithm: that of the first if it is not given.
    Block(&'t mut CriticalBlock<'a>, Option<f64>),
    /// Of the multiplier at a place in the order of moduli.
    Modulus(&'t mut Uncorrected<'a>, usize),
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
            Self::Modulus(multipliers, place) => moduli::logarithm(multipliers.at(u), *place),
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
    /// Test functions: of the blocks, then of the moduli.
    pub(super) watched: Vec<Watched>,
    pub(super) blocks: Vec<CriticalBlock<'a>>,
    pub(super) multipliers: Option<Uncorrected<'a>>,
    /// What the correction makes of moduli at the last points.
    pub(super) corrections: Corrections,
    gaps: Option<GapExtremes<'a>>,
}

impl<'a> EventMonitor<'a> {
    pub(super) fn new(context: &'a BranchContext, resolution: Resolution) -> Self {
        let all = context.selection == EventSelection::All;
        let multipliers = all && context.stability.is_some();
        let blocks = context.blocks(resolution);
        let mut watched: Vec<Watched> = blocks.iter().map(|block| watched(block.part)).collect();
        if multipliers {
            let of_modulus = Watched {
                kind: EventKind::NeimarkSacker,
                bordered: false,
            };
            let states = 2 * context.system.facts().coordinates.len();
            watched.extend(std::iter::repeat_n(of_modulus, states));
        }
        Self {
            watched,
            blocks,
            multipliers: multipliers.then(|| Uncorrected::new(context.balance(resolution))),
            corrections: Corrections::default(),
            gaps: None,
        }
    }

    /// Value of the test function of a block.
    pub(super) fn value(&mut self, index: usize, at: &CurvePoint) -> TestValue {
        if let Some(block) = self.blocks.get_mut(index) {
            let (mantissa, exponent) = block.determinant_along(&at.u, &at.tangent);
            return TestValue { mantissa, exponent };
        }
        TestValue::UNKNOWN
    }

    /// Determinants, each a Jacobian and a factorisation, and monodromy matrices that were computed.
    pub(super) fn computed(&self) -> (usize, usize) {
        let determinants = self.blocks.iter().map(|block| block.computed).sum();
        (
            determinants,
            self.multipliers
                .as_ref()
                .map_or(0, |multipliers| multipliers.computed),
        )
    }
}

impl<'a> Run<'a> {
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
        let point = self
            .evaluator
            .read(balance, newton, u, Some(&located.point));
        self.record.events.push(Event {
            kind,
            error: unless_contradicted(error, kind, &point),
            point,
            test: located.test,
            after,
            contacts: 0,
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
        if along.abs() > step / DIFFERENCE {
            return f64::INFINITY;
        }
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
            Test::Modulus(..) => {
                monitor.multipliers = Some(Uncorrected::new(context.balance(resolution)));
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
            Test::Modulus(_, place) => {
                let multipliers = self.multipliers.as_mut();
                multipliers.map(|multipliers| Test::Modulus(multipliers, *place))
            }
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

/// The error of an event, or infinity where the multipliers of its orbit say that nothing happens there: a series of which a sharp law
/// leaves little, and its determinants, may have bifurcations that the orbit, closed by integration, has not.
pub(super) fn unless_contradicted(error: f64, kind: EventKind, point: &Point) -> f64 {
    let stability = &point.stability;
    let distance = moduli::from_critical(&stability.multipliers, kind);
    if distance > FAR + stability.error {
        f64::INFINITY
    } else {
        error
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
