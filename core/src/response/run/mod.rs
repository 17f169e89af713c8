//! What a run does with the curve it follows: orbits with their stability, events, and another number of harmonics where the
//! tolerance asks for it.

mod crossed;
mod events;
mod grazing;
mod hidden;
mod touch;
mod watch;

use std::ops::ControlFlow;

use crate::balance::resolution::{Chooser, resize};
use crate::balance::{Balance, Resolution};
use crate::branches::error::OrbitError;
use crate::branches::point::{Event, Point};
use crate::continuation::follow::{
    Continue, CurvePoint, FollowOptions, Halt, Halted, Outcome, Start, Stop, Visit,
    follow_until_stuck,
};
use crate::continuation::newton::{Border, Newton, NewtonError};
use crate::continuation::statistics::Statistics;
use crate::error::Error;
use crate::event::Turn;
use crate::numeric::fourier::series;
use crate::response::follower::Follower;
use crate::response::reader::Reader;
use watch::Watch;

/// The core grows when updates shrink by less than this at so many points in succession.
const SLOW: f64 = 0.5;
const SLOW_POINTS: usize = 2;
/// An error of so many times what rounding makes of an update is due to it.
const ROUNDINGS: f64 = 100.0;
/// A core that no number of harmonics exceeds.
const ALL: usize = 1 << 24;

/// What a run has gathered.
pub(crate) struct Run<'a> {
    pub(crate) follower: &'a Follower,
    options: FollowOptions,
    resolution: Resolution,
    /// The size of the core, where it pays to have one, and before it grew last.
    core: usize,
    core_before: usize,
    reader: Reader<'a>,
    /// What is looked for besides folds.
    watch: Watch<'a>,
    chooser: Option<Chooser>,
    /// The resolution asked for when the walk was halted.
    wanted: Resolution,
    /// The point before the last step.
    earlier: Option<CurvePoint>,
    /// Number of points before the last step in which two folds were hidden.
    split: Option<usize>,
    /// The last point was refused and is to be read again.
    refused: bool,
    slow: usize,
    /// Why the walk was ended from here.
    ended: Option<Stop>,
    pub(crate) points: Vec<Point>,
    pub(crate) events: Vec<Event>,
    pub(crate) turns: Vec<Turn>,
    pub(crate) statistics: Statistics,
}

impl<'a> Run<'a> {
    pub(crate) fn new(follower: &'a Follower, options: FollowOptions, first: &[f64]) -> Self {
        let core = follower.core_for(first);
        let resolution = follower.with_harmonics(follower.resolution.harmonics, core);
        Self {
            follower,
            options,
            resolution,
            core,
            core_before: core,
            reader: follower.reader(resolution),
            watch: Watch::new(follower, resolution),
            chooser: follower.chooser.clone(),
            wanted: resolution,
            earlier: None,
            split: None,
            refused: false,
            slow: 0,
            ended: None,
            points: Vec::new(),
            events: Vec::new(),
            turns: Vec::new(),
            statistics: Statistics::default(),
        }
    }

    /// Follows the branch to its end, with as many numbers of harmonics as it takes.
    ///
    /// # Errors
    /// If there is no first point.
    pub(crate) fn follow(
        &mut self,
        mut start: Start,
        visit: &mut impl FnMut(&Point) -> ControlFlow<()>,
    ) -> Result<Stop, Error> {
        // Where the walk was halted last, in case that another resolution fails there.
        let mut last: Option<(Box<Halted>, Resolution, usize)> = None;
        if matches!(start, Start::Along(_)) {
            // Where another branch is near, what the tail leaves out decides between the two.
            self.couple_all();
            self.reader = self.follower.reader(self.resolution);
            self.watch = Watch::new(self.follower, self.resolution);
        }
        loop {
            let begun = start.clone();
            let mut balance = self.follower.balance(self.resolution);
            let mut newton = Newton::new(&balance);
            let options = self.options;
            let mut stuck = None;
            let outcome = follow_until_stuck(
                &mut balance,
                &mut newton,
                start,
                options,
                &mut |b, n, seen| self.visit(b, n, &seen, visit),
                &mut stuck,
            );
            self.statistics += newton.statistics;
            self.count_others();
            match outcome {
                Ok(Outcome::Stopped(stop)) => {
                    let Some(halted) = stuck.filter(|_| self.has_tail()) else {
                        return Ok(self.ended.unwrap_or(stop));
                    };
                    self.couple_all();
                    start = Start::At(halted);
                }
                Ok(Outcome::Halted(halted)) => {
                    start = Start::At(Box::new(self.resized(&halted, &balance)));
                    last = Some((halted, self.resolution, self.core_before));
                    self.resolution = self.wanted;
                }
                Err(_) if self.has_tail() => {
                    self.couple_all();
                    start = begun;
                }
                Err(reason) => {
                    let Some((halted, resolution, core)) = last.take() else {
                        return self.lost(reason);
                    };
                    // What was found with the former resolution stands, and is read with its error.
                    self.settle(resolution, core);
                    start = Start::At(halted);
                }
            }
            self.reader = self.follower.reader(self.resolution);
            self.watch = Watch::new(self.follower, self.resolution);
        }
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

    /// The state of a halted walk in the resolution wanted.
    fn resized(&self, halted: &Halted, balance: &Balance<'_>) -> Halted {
        let length = series::length(self.wanted.harmonics);
        let coordinates = balance.layout().coordinates;
        let mut resized = halted.clone();
        for vector in resized.vectors() {
            *vector = resize(vector, coordinates, length);
        }
        resized
    }

    /// No orbit where the walk begins: no branch at all, or the end of the one that there is.
    fn lost(&self, reason: NewtonError) -> Result<Stop, Error> {
        match self.points.last() {
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

    /// Returns to a resolution and keeps it for some points.
    fn settle(&mut self, resolution: Resolution, core: usize) {
        self.resolution = resolution;
        self.wanted = resolution;
        self.core = core;
        if let Some(chooser) = &mut self.chooser {
            chooser.keep();
        }
    }

    /// Adds the work that Newton's method does not count.
    fn count_others(&mut self) {
        let judged = self.reader.judge.as_ref().map_or(0, |judge| judge.computed);
        let (determinants, monodromies) = self.watch.computed();
        self.statistics.monodromies += judged + monodromies;
        self.statistics.jacobians += determinants;
        self.statistics.factorisations += determinants;
    }

    fn visit(
        &mut self,
        balance: &mut Balance<'_>,
        newton: &mut Newton,
        seen: &Visit<'_>,
        visit: &mut impl FnMut(&Point) -> ControlFlow<()>,
    ) -> Continue {
        match seen {
            Visit::Again(_) if !self.refused => Continue::Continue(()),
            // It belongs to what comes after the end, which is located between this point and the one before.
            Visit::Point(at) if self.joins(&at.u) => Continue::Continue(()),
            Visit::Point(at) | Visit::Again(at) => {
                let point = self.reader.read(balance, newton, &at.u);
                self.choose(&point, newton.contraction());
                let change = self.wanted != self.resolution;
                self.refused = self.wanted.harmonics > self.resolution.harmonics;
                if self.refused {
                    return Continue::Break(Halt::Resize);
                }
                let answer = visit(&point);
                self.points.push(point);
                if answer.is_break() {
                    Continue::Break(Halt::Stop)
                } else if change {
                    Continue::Break(Halt::Resize)
                } else {
                    Continue::Continue(())
                }
            }
            Visit::Between(before, behind) => self.step(balance, newton, (before, behind), visit),
        }
    }

    /// Looks at the step between two points.
    fn step(
        &mut self,
        balance: &mut Balance<'_>,
        newton: &mut Newton,
        (before, behind): (&CurvePoint, &CurvePoint),
        visit: &mut impl FnMut(&Point) -> ControlFlow<()>,
    ) -> Continue {
        if self.joins(&behind.u) {
            if self.join(balance, newton, (before, behind)) {
                return Continue::Break(Halt::Stop);
            }
            // It only seemed to belong to what comes after the end. The walk cannot be halted here for more harmonics, so
            // that the point stands with the error it has.
            let point = self.read_again(balance, newton, behind);
            let answer = visit(&point);
            self.points.push(point);
            if answer.is_break() {
                return Continue::Break(Halt::Stop);
            }
        }
        let known = self.turns.len();
        if (behind.parameter_slope() < 0.0) != (before.parameter_slope() < 0.0) {
            self.turn(balance, newton, (before, behind), self.points.len() - 1);
        }
        let turned = self.turns.get(known).copied();
        self.hidden(balance, newton, (before, behind));
        self.look_between(balance, newton, (before, behind), turned);
        if self.ended.is_some() {
            Continue::Break(Halt::Stop)
        } else {
            Continue::Continue(())
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
        self.reader.read(balance, newton, u)
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
            let error = point.error.map_or(f64::INFINITY, |_| self.reader.across);
            // What rounding leaves, no harmonics take away.
            let error = if error <= ROUNDINGS * self.reader.rounding {
                0.0
            } else {
                error
            };
            chooser.decide(harmonics, error)
        });
        self.wanted = self
            .follower
            .with_harmonics(chosen.unwrap_or(harmonics), self.core);
    }
}
