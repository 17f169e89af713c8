//! Pseudo-arclength continuation: parabolic predictor, bordered corrector.
//!
//! Here are the data, points of the curve and where a walk stands, and the loop that goes from point to point. Predictor and corrector are in
//! [`stepper`](super::stepper), how long steps are in [`step_control`](super::step_control), where a walk is between two steps and whether it
//! ends in [`position`](super::position).
//!
//! From a solution `u_0` with unit tangent `t_0`, a step of length `s` solves
//!
//! ```text
//! R(u) = 0,    <t_0, u - u_0> = s                                                                             (1)
//! ```
//!
//! with Newton's method from `u_0 + s t_0 + s^2 b`, where the parabola goes through the point before as well. The tangent at the solution follows from the last matrix of that iteration,
//! `[R_u; t_0^T] t = [0; 1]`, which keeps its direction through folds. The product is the one of
//! [`Scale`]: mean squares relative to the size of the orbit, and the parameter relative to its range.
//!
//! Source: Keller (1977), Numerical solution of bifurcation and nonlinear eigenvalue problems.

use super::position::Position;
use super::problem::{AsProblem, Scale};
use super::step_control::StepControl;
pub use super::stop::Stop;
use crate::continuation::newton::{Newton, NewtonError, NewtonOptions};

/// What to follow, and how far.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct FollowOptions {
    pub(crate) from: f64,
    pub(crate) to: f64,
    pub(crate) points: usize,
    pub(crate) steps: StepControl,
    pub(crate) newton: NewtonOptions,
}

/// A solution and the direction of the curve there.
#[derive(Debug, Clone, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub(crate) struct CurvePoint {
    /// Extended unknowns.
    #[cfg_attr(feature = "serde", serde(with = "crate::serialise"))]
    pub(crate) u: Vec<f64>,
    /// Unit tangent in the scale of this point.
    #[cfg_attr(feature = "serde", serde(with = "crate::serialise"))]
    pub(crate) tangent: Vec<f64>,
    /// The scale.
    pub(crate) scale: Scale,
}

impl CurvePoint {
    /// The parameter.
    pub(crate) fn parameter(&self) -> f64 {
        self.u[self.u.len() - 1]
    }

    /// Component of the unit tangent along the parameter, in units of its scale: zero at a fold.
    pub(crate) fn parameter_slope(&self) -> f64 {
        self.tangent[self.tangent.len() - 1] / self.scale.parameter
    }

    /// The same, unless it is rounding, which is as large as `vanishing` where the parameter is as large as its scale.
    pub(crate) fn known_slope(&self, vanishing: f64) -> Option<f64> {
        self.unless_rounding(self.parameter_slope(), vanishing)
    }

    /// A slope there, unless it is rounding.
    pub(crate) fn unless_rounding(&self, slope: f64, vanishing: f64) -> Option<f64> {
        let rounding = (vanishing * self.narrowness()).min(ROUNDED);
        (slope.abs() > rounding).then_some(slope)
    }

    /// How many times its scale the parameter is, if that is more than one: rounding of it is that much larger.
    pub(crate) fn narrowness(&self) -> f64 {
        (self.parameter().abs() / self.scale.parameter).max(1.0)
    }
}

/// A slope that is larger is none that rounding makes, whatever the unit of the parameter is.
const ROUNDED: f64 = 1e-3;

/// The way between two successive points of a curve, or a part of it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Step<'p> {
    pub(crate) before: &'p CurvePoint,
    pub(crate) next: &'p CurvePoint,
}

impl Step<'_> {
    /// What the extended unknowns change by.
    pub(crate) fn difference(&self) -> Vec<f64> {
        let pairs = self.next.u.iter().zip(&self.before.u);
        pairs.map(|(x, y)| x - y).collect()
    }

    /// The parameter at both ends.
    pub(crate) fn parameters(&self) -> [f64; 2] {
        [self.before, self.next].map(CurvePoint::parameter)
    }
}

/// No walk has had so many points.
const MOST_POINTS: usize = 1 << 32;

/// Why a visitor ends a walk.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Halt {
    /// For good.
    Stop,
    /// To go on from here with another number of unknowns.
    Resize,
    /// To make the last step again.
    Back,
}

/// What the visitor of a curve answers.
pub(crate) type Continue = std::ops::ControlFlow<Halt>;

/// Where a walk begins.
#[derive(Clone)]
pub(crate) enum Start {
    /// Near a solution, given as extended unknowns.
    Near(Vec<f64>),
    /// Where another walk was halted to be resized.
    At(Box<Halted>),
    /// At a solution, in the direction of its tangent.
    Along(Box<CurvePoint>),
    /// Where another walk was about to make its next step, which is made at once.
    Onward(Box<Halted>),
}

impl Start {
    /// Where a walk that goes on was.
    pub(crate) fn halted(&self) -> Option<&Halted> {
        match self {
            Self::At(halted) | Self::Onward(halted) => Some(halted),
            Self::Near(_) | Self::Along(_) => None,
        }
    }
}

/// A halted walk, whose vectors may be given another length.
#[derive(Debug, Clone, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub(crate) struct Halted {
    pub(crate) point: CurvePoint,
    /// The point before, for a turn between the two that has not been seen yet.
    pub(crate) previous: Option<CurvePoint>,
    /// The point before, where what happened in the step from it has been looked at.
    #[cfg_attr(feature = "serde", serde(skip))]
    pub(crate) earlier: Option<CurvePoint>,
    #[cfg_attr(feature = "serde", serde(with = "crate::serialise"))]
    pub(crate) before: Option<Vec<f64>>,
    pub(crate) first: CurvePoint,
    /// It has gone against its first direction.
    pub(super) turned: bool,
    /// It is at its first point, which was solved for, and leads to the end of the range.
    #[cfg_attr(feature = "serde", serde(default))]
    pub(super) ahead: bool,
    #[cfg_attr(feature = "serde", serde(with = "crate::serialise"))]
    pub(super) step: f64,
    #[cfg_attr(feature = "serde", serde(with = "crate::serialise"))]
    pub(super) largest: [f64; 2],
    pub(super) count: usize,
    /// The walk ends at the point.
    pub(super) ended: Option<Stop>,
}

impl Halted {
    /// To go on from another point instead, which was found beyond the last one, with a step of this length.
    #[must_use]
    pub(crate) fn moved_to(self, point: CurvePoint, step: f64) -> Self {
        Self {
            point,
            step,
            previous: None,
            before: None,
            ahead: false,
            ended: None,
            ..self
        }
    }

    /// To go on from the point before the last one again, which is none of the curve.
    #[must_use]
    pub(crate) fn back_to(self, point: CurvePoint, step: f64) -> Self {
        Self {
            count: self.count.saturating_sub(1),
            ..self.moved_to(point, step)
        }
    }

    /// The direction of its first point is not known in its present unknowns, and so whether it has gone against it: it may have.
    pub(crate) fn loses_first_direction(&mut self) {
        self.turned = true;
    }

    /// The last step has passed the first point, which ends the walk if it has gone against its first direction before.
    pub(crate) fn passes_first(&mut self) {
        if self.turned && self.ended.is_none() {
            self.ended = Some(Stop::Closed);
        }
    }

    /// Whether its step and its scales are numbers that a walk can have: they may have been read from a file.
    pub(crate) fn is_possible(&self) -> bool {
        let positive = |x: f64| x.is_finite() && x > 0.0;
        let scaled = |point: &CurvePoint| {
            let scale = point.scale;
            positive(scale.oscillation) && positive(scale.mean) && positive(scale.parameter)
        };
        let mut points = [&self.point, &self.first].into_iter().chain(&self.previous);
        self.count <= MOST_POINTS
            && positive(self.step)
            && self.largest.iter().all(|x| x.is_finite())
            && points.all(scaled)
    }

    /// The step that it was about to make.
    pub(crate) fn length(&self) -> f64 {
        self.step
    }

    /// The extended vectors of the walk.
    pub(crate) fn vectors(&mut self) -> impl Iterator<Item = &mut Vec<f64>> {
        let Self {
            point,
            previous,
            earlier,
            before,
            first,
            ..
        } = self;
        let points = [point, first].into_iter().chain(previous).chain(earlier);
        points
            .flat_map(|point| [&mut point.u, &mut point.tangent])
            .chain(before)
    }
}

/// How a walk ended.
pub(crate) enum Outcome {
    Stopped(Stop),
    Halted(Box<Halted>),
}

/// Follows the curve until the parameter reaches `to`, calling `visit` at every point in order. The factors that Newton's
/// method holds then are those of the point. Then it is called with the step that led there. A walk that was resized visits its
/// point again.
pub(crate) fn follow<P: AsProblem + ?Sized>(
    problem: &mut P,
    newton: &mut Newton,
    start: Start,
    options: FollowOptions,
    visit: &mut dyn FnMut(&mut P, &mut Newton, Visit<'_>) -> Continue,
) -> Result<Outcome, NewtonError> {
    follow_until_stuck(problem, newton, start, options, visit).map(|walked| walked.outcome)
}

/// How a walk ended, and how it is to be resumed with another matrix where no step led on.
pub(crate) struct Walked {
    pub(crate) outcome: Outcome,
    pub(crate) stuck: Option<Box<Halted>>,
}

impl From<Outcome> for Walked {
    fn from(outcome: Outcome) -> Self {
        let stuck = None;
        Self { outcome, stuck }
    }
}

/// The same, with what it takes to go on where no step led on.
pub(crate) fn follow_until_stuck<P: AsProblem + ?Sized>(
    problem: &mut P,
    newton: &mut Newton,
    start: Start,
    options: FollowOptions,
    visit: &mut dyn FnMut(&mut P, &mut Newton, Visit<'_>) -> Continue,
) -> Result<Walked, NewtonError> {
    let mut again = matches!(start, Start::At(_));
    // What there was to see of its point has been seen.
    let mut onward = matches!(start, Start::Onward(_));
    let mut position = Position::begin(problem.problem(), newton, start, options)?;
    loop {
        if !std::mem::take(&mut onward) {
            let point = &position.point;
            let seen = if again {
                Visit::Again(point)
            } else {
                Visit::Point(point)
            };
            again = false;
            if let Continue::Break(halt) = visit(problem, newton, seen) {
                return Ok(position.halted(halt).into());
            }
            if let Some(from) = &position.previous
                && let Continue::Break(halt) = visit(problem, newton, Visit::Between(from, point))
            {
                if halt != Halt::Stop {
                    if halt == Halt::Resize && position.has_closed(newton) {
                        return Ok(Outcome::Stopped(Stop::Closed).into());
                    }
                    // The step has been looked at.
                    position.previous = None;
                    return Ok(position.halted(halt).into());
                }
                return Ok(Outcome::Stopped(Stop::Interrupted).into());
            }
            if let Some(stop) = position.ends(problem.problem(), newton) {
                return Ok(Outcome::Stopped(stop).into());
            }
        }
        if visit(problem, newton, Visit::Onward(&position)).is_break() {
            return Ok(Outcome::Stopped(Stop::Interrupted).into());
        }
        loop {
            let tried = position.length();
            let stop = match position.step(problem.problem(), newton) {
                Ok(true) => break,
                Ok(false) => None,
                Err(stop) => Some(stop),
            };
            let failed = Visit::Failed(&position.point, tried);
            if stop != Some(Stop::Interrupted)
                && let Continue::Break(halt) = visit(problem, newton, failed)
            {
                return Ok(position.halted(halt).into());
            }
            if let Some(stop) = stop {
                return Ok(Walked {
                    outcome: Outcome::Stopped(stop),
                    stuck: Some(position.stuck()),
                });
            }
        }
    }
}

/// What a visitor sees.
pub(crate) enum Visit<'a> {
    /// The next point.
    Point(&'a CurvePoint),
    /// The last point again, with another number of unknowns.
    Again(&'a CurvePoint),
    /// The step between these two points.
    Between(&'a CurvePoint, &'a CurvePoint),
    /// The last point again, from where a step of this length failed.
    Failed(&'a CurvePoint, f64),
    /// Where the walk is before its next step.
    Onward(&'a Position),
}
