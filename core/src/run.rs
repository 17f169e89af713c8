//! What a run does with the curve it follows: orbits with their stability, folds, and another number of harmonics where the
//! tolerance asks for it.

use std::ops::ControlFlow;

use crate::balance::{Balance, Resolution};
use crate::branch::{Event, EventKind, Point, Turn};
use crate::continuation::follow::{
    Continue, CurvePoint, FollowOptions, Halt, Halted, Outcome, Start, Stop, Visit, follow,
};
use crate::continuation::locate::locate;
use crate::error::Error;
use crate::follower::Follower;
use crate::fourier::series;
use crate::harmonics::{Chooser, resize};
use crate::newton::{Newton, NewtonError};
use crate::reader::Reader;
use crate::statistics::Statistics;
use crate::symmetry::EvenBlock;
use crate::truncation::BEYOND;

/// The test function of a fold is driven below this.
const FOLD_TOLERANCE: f64 = 1e-10;
/// The core grows when updates shrink by less than this at so many points in succession.
const SLOW: f64 = 0.5;
const SLOW_POINTS: usize = 2;

/// What a run has gathered.
pub(crate) struct Run<'f, 'a> {
    follower: &'f Follower<'a>,
    options: FollowOptions,
    resolution: Resolution,
    /// The size of the core, where it pays to have one.
    core: usize,
    reader: Reader<'a>,
    /// The even harmonics, where the orbits have none.
    even: Option<EvenBlock<'a>>,
    chooser: Option<Chooser>,
    /// The resolution asked for when the walk was halted.
    wanted: Resolution,
    /// The last point was refused and is to be read again.
    refused: bool,
    slow: usize,
    pub(crate) points: Vec<Point>,
    pub(crate) events: Vec<Event>,
    pub(crate) turns: Vec<Turn>,
    pub(crate) statistics: Statistics,
}

impl<'f, 'a> Run<'f, 'a> {
    pub(crate) fn new(follower: &'f Follower<'a>, options: FollowOptions, first: &[f64]) -> Self {
        let core = follower.core_for(first);
        let resolution = follower.with_harmonics(follower.resolution.harmonics, core);
        Self {
            follower,
            options,
            resolution,
            core,
            reader: follower.reader(resolution),
            even: follower.even_block(resolution),
            chooser: follower.chooser.clone(),
            wanted: resolution,
            refused: false,
            slow: 0,
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
        first: Vec<f64>,
        visit: &mut impl FnMut(&Point) -> ControlFlow<()>,
    ) -> Result<Stop, Error> {
        let mut start = Start::Near(first);
        // Where the walk was halted last, in case that another resolution fails there.
        let mut last: Option<(Box<Halted>, Resolution)> = None;
        loop {
            let mut balance = self.follower.balance(self.resolution);
            let mut newton = Newton::new(&balance);
            let options = self.options;
            let outcome = follow(
                &mut balance,
                &mut newton,
                start,
                options,
                &mut |b, n, seen| self.visit(b, n, &seen, visit),
            );
            self.statistics += newton.statistics;
            self.statistics.monodromies += self.judged();
            match outcome {
                Ok(Outcome::Stopped(stop)) => return Ok(stop),
                Ok(Outcome::Halted(halted)) => {
                    start = Start::At(Box::new(self.resized(&halted, &balance)));
                    last = Some((halted, self.resolution));
                    self.resolution = self.wanted;
                }
                Err(reason) => {
                    let Some((halted, resolution)) = last.take() else {
                        return self.lost(reason);
                    };
                    // What was found with the former resolution stands, and is read with its error.
                    self.settle(resolution);
                    start = Start::At(halted);
                }
            }
            self.reader = self.follower.reader(self.resolution);
            self.even = self.follower.even_block(self.resolution);
        }
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
            None => Err(Error::NoStart {
                parameter: self.options.from,
                reason,
            }),
            Some(point) => Ok(Stop::StepTooShort {
                step: 0.0,
                parameter: point.value,
                reason,
            }),
        }
    }

    /// Returns to a resolution and keeps it.
    fn settle(&mut self, resolution: Resolution) {
        self.resolution = resolution;
        self.wanted = resolution;
        if let Some(chooser) = &mut self.chooser {
            chooser.most = resolution.harmonics;
            chooser.least = resolution.harmonics;
        }
    }

    fn judged(&self) -> usize {
        self.reader.judge.as_ref().map_or(0, |judge| judge.computed)
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
            Visit::Between(before, behind) => {
                if (behind.parameter_slope() < 0.0) != (before.parameter_slope() < 0.0) {
                    self.turn(balance, newton, (before, behind));
                }
                self.watch(balance, newton, (before, behind));
                Continue::Continue(())
            }
        }
    }

    /// Decides on the resolution of the next point, or of this one again.
    fn choose(&mut self, point: &Point, contraction: f64) {
        let harmonics = self.resolution.harmonics;
        self.slow = if contraction > SLOW { self.slow + 1 } else { 0 };
        if self.slow >= SLOW_POINTS {
            self.slow = 0;
            self.core += self.core.div_ceil(2);
        }
        let chosen = self.chooser.as_mut().and_then(|chooser| {
            let error = point.error.unwrap_or(f64::INFINITY);
            chooser.decide(harmonics, error)
        });
        self.wanted = self
            .follower
            .with_harmonics(chosen.unwrap_or(harmonics), self.core);
    }

    /// Locates where the even harmonics become singular between two symmetric orbits.
    fn watch(
        &mut self,
        balance: &mut Balance<'_>,
        newton: &mut Newton,
        (before, behind): (&CurvePoint, &CurvePoint),
    ) {
        let Some(even) = &mut self.even else {
            return;
        };
        let (a, b) = (even.determinant(&before.u), even.determinant(&behind.u));
        if a.0 * b.0 >= 0.0 {
            return;
        }
        let largest = a.1.max(b.1);
        let relative = |(sign, size): (f64, f64)| sign * (size - largest).exp();
        let even = std::cell::RefCell::new(even);
        let test = |point: &CurvePoint| relative(even.borrow_mut().determinant(&point.u));
        let between = (before, behind);
        let options = self.options.newton;
        let located = locate(balance, newton, between, options, FOLD_TOLERANCE, test);
        let Some(located) = located.filter(|located| located.vanishes) else {
            return;
        };
        let u = &located.point.u;
        let error = if self.reader.finer.correct(u, newton) {
            let range = behind.parameter() - before.parameter();
            self.symmetry_error(&located.point, 1e-4 * range)
        } else {
            f64::INFINITY
        };
        let point = self.reader.read(balance, newton, u);
        self.events.push(Event {
            kind: EventKind::SymmetryBreaking,
            point,
            error,
            test: located.test,
            after: self.points.len() - 1,
        });
    }

    /// Estimated error of a symmetry-breaking point: where twice the harmonics, at the corrected orbit that `finer` holds, would
    /// put it.
    fn symmetry_error(&self, point: &CurvePoint, step: f64) -> f64 {
        let finer = self.reader.finer.extended();
        let fine = Resolution {
            harmonics: 2 * self.resolution.harmonics,
            ..self.resolution
        };
        let Some(mut even) = self.follower.even_block(fine) else {
            return f64::INFINITY;
        };
        let coordinates = self.follower.system.facts().coordinates.len();
        let length = series::length(fine.harmonics);
        let mut at = |u: &[f64]| even.determinant(&resize(u, coordinates, length));
        // The determinant along the tangent, by a central difference in the parameter.
        let value = point.parameter();
        let along = step / point.tangent[point.tangent.len() - 1];
        let moved = |by: f64| -> Vec<f64> {
            let pairs = finer
                .iter()
                .zip(resize(&point.tangent, coordinates, length));
            pairs.map(|(x, t)| x + by * t).collect()
        };
        let (a, b, here) = (at(&moved(-along)), at(&moved(along)), at(finer));
        let largest = a.1.max(b.1);
        let relative = |(sign, size): (f64, f64)| sign * (size - largest).exp();
        let slope = (relative(b) - relative(a)) / (2.0 * step);
        let change = finer[finer.len() - 1] - value - relative(here) / slope;
        let error = BEYOND * change.abs() + 1e-12 * value.abs();
        if error.is_finite() {
            error
        } else {
            f64::INFINITY
        }
    }

    /// Locates the fold between two points, or the jump that is there instead.
    fn turn(
        &mut self,
        balance: &mut Balance<'_>,
        newton: &mut Newton,
        between: (&CurvePoint, &CurvePoint),
    ) {
        let options = self.options.newton;
        // The point behind the turn has been stored already.
        let after = self.points.len() - 1;
        let slope = CurvePoint::parameter_slope;
        match locate(balance, newton, between, options, FOLD_TOLERANCE, slope) {
            Some(located) if located.vanishes => {
                let u = &located.point.u;
                let error = self.reader.finer.fold_error(u, newton);
                let point = self.reader.read(balance, newton, u);
                let kind = EventKind::Fold;
                self.events.push(Event {
                    kind,
                    point,
                    error,
                    test: located.test,
                    after,
                });
            }
            Some(located) => {
                let value = located.point.parameter();
                self.turns.push(Turn {
                    value,
                    test: located.test,
                    after,
                });
            }
            None => {
                let value = 0.5 * (between.0.parameter() + between.1.parameter());
                self.turns.push(Turn {
                    value,
                    test: between.0.parameter_slope(),
                    after,
                });
            }
        }
    }
}
