//! What a run does with the curve it follows: orbits with their stability, events, and another number of harmonics where the
//! tolerance asks for it.

mod corrected_moduli;
mod crossing_branch;
mod event_monitor;
mod folds;
mod gap_extremes;
mod joined;
mod method;
mod resume_state;

use crate::balance::resolution::{Chooser, resize};
use crate::balance::{Balance, Resolution};
use crate::balance_branch::context::BranchContext;
use crate::balance_branch::point_evaluator::PointEvaluator;
use crate::branches::engine;
use crate::branches::error::OrbitError;
use crate::branches::point::Point;
use crate::branches::problem::Read;
use crate::branches::progress::{Progress, See};
use crate::branches::record::Record;
use crate::continuation::follow::{CurvePoint, FollowOptions, Halted, Start, Stop};
use crate::continuation::newton::{Border, Newton, NewtonError};
use crate::continuation::statistics::Statistics;
use crate::error::Error;
use crate::numeric::fourier::series;
use event_monitor::EventMonitor;
use method::BalanceBranch;
pub(crate) use resume_state::Rest;

/// The core grows when updates shrink by less than this at so many points in succession.
const SLOW: f64 = 0.5;
const SLOW_POINTS: usize = 2;
/// A core that no number of harmonics exceeds.
const ALL: usize = 1 << 24;

/// A branch as it was followed.
pub(crate) struct Followed {
    pub(crate) stopped: Stop,
    pub(crate) record: Record,
    pub(crate) statistics: Statistics,
    /// What it goes on from, where it was interrupted.
    pub(crate) rest: Option<Box<Rest>>,
}

/// What a run has gathered.
pub(crate) struct Run<'a> {
    pub(crate) context: &'a BranchContext,
    options: FollowOptions,
    resolution: Resolution,
    /// The size of the core, where it pays to have one, and before it grew last.
    core: usize,
    core_before: usize,
    evaluator: PointEvaluator<'a>,
    /// What is looked for besides folds.
    monitor: EventMonitor<'a>,
    chooser: Option<Chooser>,
    /// The resolution asked for when the walk was halted.
    wanted: Resolution,
    /// The resolution before it was changed last, and the core then.
    former: Option<(Resolution, usize)>,
    slow: usize,
    /// What the branch ended on.
    ended: Option<Stop>,
    /// Where it was before the last step.
    rest: Option<Box<Rest>>,
    pub(crate) record: Record,
    pub(crate) statistics: Statistics,
}

impl<'a> Run<'a> {
    pub(crate) fn new(context: &'a BranchContext, options: FollowOptions, first: &[f64]) -> Self {
        let core = context.core_for(first);
        let resolution = context.with_harmonics(context.resolution.harmonics, core);
        Self {
            context,
            options,
            resolution,
            core,
            core_before: core,
            evaluator: context.evaluator(resolution),
            monitor: EventMonitor::new(context, resolution),
            chooser: context.chooser.clone(),
            wanted: resolution,
            former: None,
            slow: 0,
            ended: None,
            rest: None,
            record: Record::default(),
            statistics: Statistics::default(),
        }
    }

    /// Follows the branch to its end, with as many numbers of harmonics as it takes.
    ///
    /// # Errors
    /// If there is no first point.
    pub(crate) fn follow(mut self, start: Start, visit: See<'_>) -> Result<Followed, Error> {
        if matches!(start, Start::Along(_)) {
            // Where another branch is near, what the tail leaves out decides between the two.
            self.couple_all();
            self.renew();
        }
        let options = self.options;
        let mut branch = BalanceBranch::new(self, visit);
        let stopped = engine::run(&mut branch, start, options);
        branch.run.followed(stopped)
    }

    /// Goes on from where it was interrupted.
    ///
    /// # Errors
    /// None, but for a rest of another run.
    pub(crate) fn resume(self, rest: &Rest, visit: See<'_>) -> Result<Followed, Error> {
        let options = self.options;
        let mut branch = BalanceBranch::new(self, visit);
        let stopped = engine::resume(&mut branch, rest.walk.clone(), options);
        branch.run.followed(stopped)
    }

    /// The branch that was followed, as the engine has ended.
    fn followed(self, stopped: Result<Stop, NewtonError>) -> Result<Followed, Error> {
        let mut run = self;
        run.count_others();
        let stopped = match stopped {
            Ok(stop) => run.ended.unwrap_or(stop),
            Err(reason) => run.lost(reason)?,
        };
        Ok(Followed {
            stopped,
            record: run.record,
            statistics: run.statistics,
            rest: run.rest.filter(|_| stopped.can_be_resumed()),
        })
    }

    /// Reads and monitors orbits of the resolution from here on.
    fn renew(&mut self) {
        self.count_others();
        self.evaluator = self.context.evaluator(self.resolution);
        self.monitor = EventMonitor::new(self.context, self.resolution);
    }

    /// Whether harmonics are coupled to the core alone.
    fn has_tail(&self) -> bool {
        self.resolution.core < self.resolution.harmonics
    }

    /// Couples all harmonics from here on: what core and tail cannot solve, the whole system may.
    fn couple_all(&mut self) {
        self.core = ALL;
        self.core_before = ALL;
        self.resolution.core = self.resolution.harmonics;
        self.wanted = self.resolution;
    }

    /// Puts a halted walk into the resolution wanted.
    fn remap(&mut self, halted: &mut Halted) {
        let length = series::length(self.wanted.harmonics);
        let coordinates = self.context.system.facts().coordinates.len();
        for vector in halted.vectors() {
            *vector = resize(vector, coordinates, length);
        }
        self.former = Some((self.resolution, self.core_before));
        self.resolution = self.wanted;
        self.renew();
    }

    /// No orbit where the walk begins: no branch at all, or the end of the one that there is.
    fn lost(&self, reason: NewtonError) -> Result<Stop, Error> {
        match self.record.points.last() {
            None => Err(OrbitError::NoStart {
                value: self.options.from,
                reason,
            }
            .into()),
            Some(point) => Ok(Stop::StepTooShort {
                step: 0.0,
                value: point.value,
                reason,
            }),
        }
    }

    /// Returns to the former resolution and keeps it for some points.
    fn revert(&mut self) {
        let Some((resolution, core)) = self.former.take() else {
            return;
        };
        self.resolution = resolution;
        self.wanted = resolution;
        self.core = core;
        if let Some(chooser) = &mut self.chooser {
            chooser.keep();
        }
        self.renew();
    }

    /// Adds the work that Newton's method does not count.
    fn count_others(&mut self) {
        let judged = self
            .evaluator
            .judge
            .as_ref()
            .map_or(0, |judge| judge.computed);
        let (determinants, monodromies) = self.monitor.computed();
        self.statistics.monodromies += judged + monodromies;
        self.statistics.jacobians += determinants;
        self.statistics.factorisations += determinants;
    }

    /// Reads a point, and decides on the resolution of the next one.
    fn read(
        &mut self,
        balance: &mut Balance<'_>,
        newton: &mut Newton,
        at: &CurvePoint,
        visit: See<'_>,
    ) -> Read {
        let point = self.evaluator.read(balance, newton, &at.u, Some(at));
        self.choose(&point, newton.contraction());
        let change = self.wanted != self.resolution;
        if self.wanted.harmonics > self.resolution.harmonics {
            return Read::Refused;
        }
        let answer = visit(Progress::orbit(self.record.points.len() + 1, &point));
        self.record.points.push(point);
        if answer.is_break() {
            Read::Stop
        } else if change {
            Read::Resize
        } else {
            Read::Kept
        }
    }

    /// Reads a point whose factors Newton's method no longer holds.
    fn read_again(
        &mut self,
        balance: &mut Balance<'_>,
        newton: &mut Newton,
        point: &CurvePoint,
    ) -> Point {
        let mut u = point.u.clone();
        let mut row = vec![0.0; u.len()];
        newton
            .norm()
            .linear_form(point.scale, &point.tangent, &mut row);
        let value = crate::numeric::linear::dot(&row, &u);
        let border = Border { row: &row, value };
        let options = self.options.newton;
        let corrected = newton.correct(balance, &mut u, border, point.scale, options);
        let u = if corrected.is_ok() { &u } else { &point.u };
        self.evaluator.read(balance, newton, u, Some(point))
    }

    /// Decides on the resolution of the next point, or of this one again.
    fn choose(&mut self, point: &Point, contraction: f64) {
        let harmonics = self.resolution.harmonics;
        self.core_before = self.core;
        self.slow = if contraction > SLOW { self.slow + 1 } else { 0 };
        if self.slow >= SLOW_POINTS {
            self.slow = 0;
            self.core += self.core.div_ceil(2);
        }
        let chosen = self.chooser.as_mut().and_then(|chooser| {
            let error = point.error.map_or(f64::INFINITY, |_| self.evaluator.across);
            chooser.decide(harmonics, self.evaluator.by_harmonics(error))
        });
        self.wanted = self
            .context
            .with_harmonics(chosen.unwrap_or(harmonics), self.core);
    }
}
