//! Where a walk along a curve is, how it begins, and when it ends.

use super::closing::closes;
use super::follow::{CurvePoint, FollowOptions, Halt, Halted, Outcome, Start, Stop};
use super::problem::Problem;
use super::stepper::{Direction, Stepper};
use crate::continuation::newton::{Newton, NewtonError};

/// An end of the range that is not reached by a step as short as this is not reached by shorter ones.
const NEAREST: f64 = 1e-5;

/// An oscillation that has grown so many times, while the branch goes on upwards, has no bound: beside a resonance with less damping
/// than `1 / GROWTH` rounding of the frequency is all that is left.
const GROWTH: f64 = 1e10;

/// Where a walk is.
pub(crate) struct Position {
    stepper: Stepper,
    /// The last point, and the one before it.
    pub(super) point: CurvePoint,
    pub(super) previous: Option<CurvePoint>,
    first: CurvePoint,
    /// It has gone against its first direction, as every closed curve does somewhere: its tangents are zero in sum.
    turned: bool,
    /// Nothing is known of its direction but that it leads to the end of the range: it is at its first point, which was solved for.
    ahead: bool,
    /// Number of points before the last one.
    count: usize,
    /// The last point is the end.
    ended: Option<Stop>,
}

impl Position {
    /// Finds the first point, or corrects the one where a walk was halted.
    pub(super) fn begin(
        problem: &mut dyn Problem,
        newton: &mut Newton,
        start: Start,
        options: FollowOptions,
    ) -> Result<Self, NewtonError> {
        match start {
            Start::Near(u) => {
                let mut stepper = Stepper::new(problem, options, u);
                let point = stepper.first(problem, newton)?;
                Ok(Self {
                    ahead: true,
                    ..Self::at(stepper, point)
                })
            }
            Start::Along(along) => {
                let mut stepper = Stepper::new(problem, options, along.u.clone());
                let direction = Direction::Along;
                let point = stepper.again(problem, newton, &along, false, direction)?;
                Ok(Self::at(stepper, point))
            }
            Start::At(mut halted) => {
                let mut stepper = Stepper::of(problem, options, &mut halted);
                let at_end = halted.ended.is_some_and(|stop| stop != Stop::Closed);
                let direction = if halted.ahead {
                    Direction::Ahead
                } else {
                    Direction::Along
                };
                let point = stepper.again(problem, newton, &halted.point, at_end, direction)?;
                Ok(Self::of(stepper, Halted { point, ..*halted }))
            }
            Start::Onward(mut halted) => {
                let stepper = Stepper::of(problem, options, &mut halted);
                Ok(Self::of(stepper, *halted))
            }
        }
    }

    /// Where a walk was halted.
    fn of(stepper: Stepper, halted: Halted) -> Self {
        Self {
            stepper,
            point: halted.point,
            previous: halted.previous,
            first: halted.first,
            turned: halted.turned,
            ahead: halted.ahead,
            count: halted.count,
            ended: halted.ended,
        }
    }

    /// At the first point.
    fn at(stepper: Stepper, point: CurvePoint) -> Self {
        Self {
            stepper,
            first: point.clone(),
            point,
            previous: None,
            turned: false,
            ahead: false,
            count: 0,
            ended: None,
        }
    }

    /// Why the walk ends at the last point, if it does; otherwise it is counted.
    pub(super) fn ends(&mut self, problem: &dyn Problem, newton: &Newton) -> Option<Stop> {
        if problem.is_cancelled() {
            // What is between the last two points may not have been looked at to its end.
            return Some(Stop::Interrupted);
        }
        if self.ended.is_some() {
            return self.ended;
        }
        if self.has_closed(newton) {
            return Some(Stop::Closed);
        }
        if self.count == 0 {
            self.first = self.point.clone();
        }
        let Self { first, point, .. } = &self;
        let norm = newton.norm();
        self.turned |= norm.product(first.scale, &point.tangent, &first.tangent) < 0.0;
        if let Some(stop) = self.unbounded() {
            return Some(stop);
        }
        self.count += 1;
        self.ahead = false;
        let points = self.stepper.options.points;
        (self.count >= points).then_some(Stop::PointLimit { points })
    }

    /// Whether the last step passed the first point again.
    pub(super) fn has_closed(&self, newton: &Newton) -> bool {
        let passes = |from| closes(newton, &self.first, from, &self.point);
        self.turned && self.previous.as_ref().is_some_and(passes)
    }

    fn unbounded(&self) -> Option<Stop> {
        let Self { first, point, .. } = self;
        let growth = point.scale.oscillation / first.scale.oscillation;
        let upwards = point.parameter_slope().abs() * GROWTH < point.scale.parameter.recip();
        (growth > GROWTH && upwards).then(|| Stop::Unbounded {
            value: point.parameter(),
            growth,
        })
    }

    /// Goes on to the next point. `false` if the step failed, and is to be tried again, shorter.
    ///
    /// # Errors
    /// If no step leads on.
    pub(super) fn step(
        &mut self,
        problem: &mut dyn Problem,
        newton: &mut Newton,
    ) -> Result<bool, Stop> {
        let tried = self.stepper.step;
        let Some(next) = self.stepper.next(problem, newton, &self.point)? else {
            return Ok(false);
        };
        let cut = self
            .stepper
            .cut_at_range(problem, newton, &self.point, next);
        let (next, ended) = match cut {
            Ok(cut) => cut,
            Err(NewtonError::Cancelled { .. }) => return Err(Stop::Interrupted),
            // A shorter step ends within the range, where its point is looked at before the end is tried again.
            Err(reason) => {
                if tried < NEAREST {
                    let (step, value) = (tried, self.point.parameter());
                    return Err(Stop::StepTooShort {
                        step,
                        value,
                        reason,
                    });
                }
                newton.statistics.accepted_steps -= 1;
                newton.statistics.rejected_steps += 1;
                self.stepper.shorten(&self.point, tried, reason)?;
                return Ok(false);
            }
        };
        self.previous = Some(std::mem::replace(&mut self.point, next));
        self.ended = ended;
        Ok(true)
    }

    /// The length of the step that is tried next.
    pub(super) fn length(&self) -> f64 {
        self.stepper.step
    }

    /// As a visitor has asked for it.
    pub(super) fn halted(self, halt: Halt) -> Outcome {
        if halt == Halt::Stop {
            // The visitor knows why, and says so where it is known better.
            return Outcome::Stopped(Stop::Interrupted);
        }
        Outcome::Halted(Box::new(self.here()))
    }

    /// What it takes to go on from here.
    pub(crate) fn here(&self) -> Halted {
        Halted {
            point: self.point.clone(),
            previous: self.previous.clone(),
            earlier: None,
            before: self.stepper.before.clone(),
            first: self.first.clone(),
            turned: self.turned,
            ahead: self.ahead,
            step: self.stepper.step,
            largest: self.stepper.largest,
            count: self.count,
            ended: self.ended,
        }
    }

    /// Where no step led on: to go on with the first step again. What was between this point and the one before has been seen. The
    /// direction at the start of the range is that of the matrix that led nowhere, and forgotten.
    pub(super) fn stuck(mut self) -> Box<Halted> {
        let FollowOptions { from, steps, .. } = self.stepper.options;
        let count = self.count - 1;
        if count == 0 && self.point.parameter() == from {
            self.point.tangent.fill(0.0);
        }
        Box::new(Halted {
            point: self.point,
            previous: None,
            earlier: None,
            before: None,
            first: self.first,
            turned: self.turned,
            ahead: self.ahead,
            step: steps.initial,
            largest: self.stepper.largest,
            count,
            ended: None,
        })
    }
}
