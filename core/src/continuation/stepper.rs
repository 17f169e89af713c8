//! One step after the other along a curve, for [`follow`](super::follow::follow).
//!
//! Numbers of equations are those of [`follow`](super::follow).

use super::follow::{CurvePoint, FollowOptions, Halted, Stop};
use super::problem::{Norm, Problem, Scale};
use crate::continuation::newton::{Border, Newton, NewtonError};

/// Least scale of what oscillates, in sizes of what rounding makes of an update.
const ROUNDINGS: f64 = 1e3;

/// A slope that falls below this part of those at both ends within a step may have changed its sign there.
const NEARLY: f64 = 0.5;

/// Which way a curve is followed from a point that is corrected.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Direction {
    /// As the tangent that it has.
    Along,
    /// To the end of the range: where the orbit is resolved better its tangent may be another one.
    Ahead,
}

/// What makes the steps; its buffers are reused.
pub(super) struct Stepper {
    pub(super) options: FollowOptions,
    /// Length of the next step.
    pub(super) step: f64,
    border: Vec<f64>,
    trial: Vec<f64>,
    /// The predictor, then how far the solution is from it, and the length of that.
    apart: Vec<f64>,
    gone: f64,
    scale: Scale,
    /// Largest oscillation and mean so far.
    pub(super) largest: [f64; 2],
    /// The point before the one from which the next step goes, where the curve between them was smooth.
    pub(super) before: Option<Vec<f64>>,
    /// Half the second derivative by arc length of the curve there.
    curvature: Vec<f64>,
}

impl Stepper {
    pub(super) fn new(problem: &dyn Problem, options: FollowOptions, u: Vec<f64>) -> Self {
        let parameter = (options.to - options.from).abs();
        Self {
            options,
            step: options.steps.initial,
            border: vec![0.0; problem.unknowns() + 1],
            apart: u.clone(),
            gone: 0.0,
            trial: u,
            scale: Scale {
                parameter,
                ..Scale::UNIT
            },
            largest: [0.0; 2],
            before: None,
            curvature: vec![0.0; problem.unknowns() + 1],
        }
    }

    /// Of a halted walk.
    pub(super) fn of(problem: &dyn Problem, options: FollowOptions, halted: &mut Halted) -> Self {
        Self {
            step: halted.step,
            largest: halted.largest,
            before: halted.before.take(),
            ..Self::new(problem, options, halted.point.u.clone())
        }
    }

    /// Corrects a point of another number of unknowns, in the plane across its tangent; at an end of the range, there. Without a
    /// tangent the branch goes towards the end of the range.
    pub(super) fn again(
        &mut self,
        problem: &mut dyn Problem,
        newton: &mut Newton,
        point: &CurvePoint,
        at_end: bool,
        direction: Direction,
    ) -> Result<CurvePoint, NewtonError> {
        self.scale = point.scale;
        if at_end || point.parameter() == self.options.from {
            self.solve_at(problem, newton, point.parameter())?;
        } else {
            newton
                .norm()
                .linear_form(point.scale, &point.tangent, &mut self.border);
            let border = Border {
                row: &self.border,
                value: crate::numeric::linear::dot(&self.border, &point.u),
            };
            let options = self.options.newton;
            newton.correct(problem, &mut self.trial, border, self.scale, options)?;
        }
        let mut again = self.point(problem, newton);
        let along = newton
            .norm()
            .product(point.scale, &again.tangent, &point.tangent);
        let ahead = if along == 0.0 || direction == Direction::Ahead {
            again.parameter_slope() * (self.options.to - self.options.from)
        } else {
            along
        };
        if ahead < 0.0 {
            for t in &mut again.tangent {
                *t = -*t;
            }
        }
        Ok(again)
    }

    /// Solves at the first parameter and points the tangent towards the end of the range.
    pub(super) fn first(
        &mut self,
        problem: &mut dyn Problem,
        newton: &mut Newton,
    ) -> Result<CurvePoint, NewtonError> {
        self.scale = self.scale_at_trial(newton);
        self.solve_at(problem, newton, self.options.from)?;
        let mut point = self.point(problem, newton);
        if point.parameter_slope() * (self.options.to - self.options.from) < 0.0 {
            for t in &mut point.tangent {
                *t = -*t;
            }
        }
        Ok(point)
    }

    /// Solves from `trial` with the parameter held at a value.
    fn solve_at(
        &mut self,
        problem: &mut dyn Problem,
        newton: &mut Newton,
        value: f64,
    ) -> Result<(), NewtonError> {
        let last = self.trial.len() - 1;
        self.trial[last] = value;
        self.border.fill(0.0);
        self.border[last] = 1.0 / self.scale.parameter;
        let border = Border {
            row: &self.border,
            value: value / self.scale.parameter,
        };
        newton.correct(
            problem,
            &mut self.trial,
            border,
            self.scale,
            self.options.newton,
        )?;
        self.trial[last] = value;
        Ok(())
    }

    /// The point at `trial`, with the tangent from the last matrix of the corrector.
    fn point(&mut self, problem: &mut dyn Problem, newton: &mut Newton) -> CurvePoint {
        let mut tangent = vec![0.0; self.trial.len()];
        newton.tangent(problem, &self.trial, &mut tangent, false);
        let mut scale = self.scale_at_trial(newton);
        if self.largest == [0.0; 2] {
            // What rests at zero has no size: that of the way it goes over the range of the parameter is one.
            let way = scale.parameter / tangent[tangent.len() - 1].abs();
            let moved: Vec<f64> = tangent.iter().map(|t| way * t).collect();
            let floor = ROUNDINGS * newton.rounding_size();
            let of_way = newton.norm().size_at(&moved, scale.parameter);
            scale = of_way.filter(|of| of.oscillation > floor).unwrap_or(scale);
        }
        let norm = newton.norm().length(scale, &tangent);
        for t in &mut tangent {
            *t /= norm;
        }
        CurvePoint {
            u: self.trial.clone(),
            tangent,
            scale,
        }
    }

    /// Rounding must not look like a turn of the curve.
    fn scale_at_trial(&mut self, newton: &Newton) -> Scale {
        let norm = newton.norm();
        let scale = norm.scale_at(&self.trial, self.scale.parameter, &mut self.largest);
        let oscillation = scale.oscillation.max(ROUNDINGS * newton.rounding_size());
        Scale {
            oscillation,
            mean: scale.mean.max(oscillation),
            ..scale
        }
    }

    /// One step; `None` where it failed, and the next one is shorter.
    pub(super) fn next(
        &mut self,
        problem: &mut dyn Problem,
        newton: &mut Newton,
        from: &CurvePoint,
    ) -> Result<Option<CurvePoint>, Stop> {
        self.set_curvature(newton, from);
        let steps = self.options.steps;
        let shorter = match self.corrected(problem, newton, from, self.step) {
            Ok((mut point, distance)) => {
                let mut angle = angle_between(newton.norm(), from, &point);
                let doubtful = steps.turns_too_far(angle) && steps.after_doubt(self.step).is_none();
                // Beside a branch point the matrix is nearly singular, and what it changes by on the way from the predictor turns its tangent.
                if doubtful || steps.turns(angle) && newton.has_changed() {
                    retake_tangent(problem, newton, &mut point);
                    angle = angle_between(newton.norm(), from, &point);
                }
                let norm = newton.norm();
                // Where the equations themselves jump, as with samples, no short step leads on.
                let nearly = if self.step > steps.initial {
                    NEARLY
                } else {
                    0.0
                };
                // The plane of (1) has other parts of the curve in it, to which Newton's method may go by updates of which the first is small.
                let looks_wrong = steps.turns_too_far(angle)
                    || steps.is_too_far(distance.max(self.gone))
                    || passes_folds(norm, [from, &point], self.options.newton.tolerance, nearly);
                let shorter = steps.after_doubt(self.step).filter(|_| looks_wrong);
                let Some(shorter) = shorter else {
                    newton.statistics.accepted_steps += 1;
                    self.remember(from, angle);
                    let slope = point.parameter_slope();
                    self.step = steps.after_success(self.step, angle, distance, slope);
                    return Ok(Some(point));
                };
                newton.statistics.rejected_steps += 1;
                shorter
            }
            Err(NewtonError::Cancelled { .. }) => return Err(Stop::Interrupted),
            Err(reason) => {
                newton.statistics.rejected_steps += 1;
                self.shorten(from, self.step, reason)?;
                return Ok(None);
            }
        };
        self.tried_again(shorter);
        Ok(None)
    }

    /// After a step of a length has failed.
    ///
    /// # Errors
    /// If it cannot be shorter.
    pub(super) fn shorten(
        &mut self,
        from: &CurvePoint,
        step: f64,
        reason: NewtonError,
    ) -> Result<(), Stop> {
        let shorter = self.options.steps.after_failure(step);
        let shorter = shorter.ok_or(Stop::StepTooShort {
            step,
            value: from.parameter(),
            reason,
        })?;
        self.tried_again(shorter);
        Ok(())
    }

    /// The next step has this length. The parabola may have led astray.
    fn tried_again(&mut self, step: f64) {
        self.before = None;
        self.step = step;
    }

    /// The parabola through the point before, and this one with its tangent: at arc length `-h` before,
    /// `u_0 - h t_0 + h^2 b = u_(-1)`. Zero where there is none.
    fn set_curvature(&mut self, newton: &Newton, from: &CurvePoint) {
        let Some(before) = self.before.take() else {
            self.curvature.fill(0.0);
            return;
        };
        for (to, (x, y)) in self.curvature.iter_mut().zip(before.iter().zip(&from.u)) {
            *to = x - y;
        }
        let h = -newton
            .norm()
            .product(from.scale, &from.tangent, &self.curvature);
        for (to, t) in self.curvature.iter_mut().zip(&from.tangent) {
            *to = (*to + h * t) / (h * h);
        }
        if !(h > 0.0 && self.curvature.iter().all(|x| x.is_finite())) {
            self.curvature.fill(0.0);
        }
        self.before = Some(before);
    }

    /// Keeps a point for the next parabola, unless the curve turned sharply behind it.
    fn remember(&mut self, from: &CurvePoint, angle: f64) {
        if angle > self.options.steps.angle {
            self.before = None;
            return;
        }
        match &mut self.before {
            Some(before) => before.copy_from_slice(&from.u),
            None => self.before = Some(from.u.clone()),
        }
    }

    /// The solution of (1) at arc length `step` from a point, and how far off the predictor was.
    fn corrected(
        &mut self,
        problem: &mut dyn Problem,
        newton: &mut Newton,
        from: &CurvePoint,
        step: f64,
    ) -> Result<(CurvePoint, f64), NewtonError> {
        self.scale = from.scale;
        for (i, x) in self.trial.iter_mut().enumerate() {
            *x = from.u[i] + step * (from.tangent[i] + step * self.curvature[i]);
        }
        self.apart.copy_from_slice(&self.trial);
        newton
            .norm()
            .linear_form(from.scale, &from.tangent, &mut self.border);
        let value = crate::numeric::linear::dot(&self.border, &self.trial);
        let border = Border {
            row: &self.border,
            value,
        };
        let converged = newton.correct(
            problem,
            &mut self.trial,
            border,
            self.scale,
            self.options.newton,
        )?;
        for (apart, x) in self.apart.iter_mut().zip(&self.trial) {
            *apart = x - *apart;
        }
        self.gone = newton.norm().length(from.scale, &self.apart);
        Ok((self.point(problem, newton), converged.first))
    }

    /// If the step went beyond an end of the range, replaces its point by the one at the end.
    ///
    /// # Errors
    /// If there is none near by: the step was too long.
    pub(super) fn cut_at_range(
        &mut self,
        problem: &mut dyn Problem,
        newton: &mut Newton,
        from: &CurvePoint,
        next: CurvePoint,
    ) -> Result<(CurvePoint, Option<Stop>), NewtonError> {
        let FollowOptions {
            from: start,
            to: end,
            ..
        } = self.options;
        let forwards = (end - start).signum();
        let (limit, stop) = if (next.parameter() - end) * forwards >= 0.0 {
            (end, Stop::ReachedEnd)
        } else if (next.parameter() - start) * forwards < 0.0 {
            (start, Stop::LeftAtStart)
        } else {
            return Ok((next, None));
        };
        let ahead = limit - from.parameter();
        if ahead * from.parameter_slope() > 0.0 {
            let part = ahead / (next.parameter() - from.parameter());
            for (i, x) in self.trial.iter_mut().enumerate() {
                *x = from.u[i] + part * (next.u[i] - from.u[i]);
            }
        } else {
            // There is a fold in between, and the end of the range is on the side of the next point.
            let last = next.u.len() - 1;
            let part = (limit - next.parameter()) / next.tangent[last];
            for (i, x) in self.trial.iter_mut().enumerate() {
                *x = next.u[i] + part * next.tangent[i];
            }
        }
        self.scale = from.scale;
        // A point beyond the range is never kept: the equations need not make sense there.
        self.solve_at(problem, newton, limit)?;
        let mut point = self.point(problem, newton);
        if newton
            .norm()
            .product(point.scale, &point.tangent, &next.tangent)
            < 0.0
        {
            for t in &mut point.tangent {
                *t = -*t;
            }
        }
        Ok((point, Some(stop)))
    }
}

/// A tangent that turns however short the step is may be one of the last matrix alone, which was taken of unknowns before the solution: those
/// at which another gap is closed, if a level is touched in between. It is taken of the solution.
fn retake_tangent(problem: &mut dyn Problem, newton: &mut Newton, point: &mut CurvePoint) {
    let mut tangent = vec![0.0; point.u.len()];
    if !newton.tangent(problem, &point.u, &mut tangent, true) {
        return;
    }
    let norm = newton.norm().length(point.scale, &tangent);
    if norm.is_finite() && norm > 0.0 {
        let taken = tangent.iter().map(|t| t / norm);
        point
            .tangent
            .iter_mut()
            .zip(taken)
            .for_each(|(t, taken)| *t = taken);
    }
}

/// The angle between the tangents of two points.
fn angle_between(norm: &Norm, from: &CurvePoint, to: &CurvePoint) -> f64 {
    let along = norm.product(from.scale, &from.tangent, &to.tangent);
    let cosine = along / norm.length(from.scale, &to.tangent);
    cosine.clamp(-1.0, 1.0).acos()
}

/// Whether a step seems to have passed a pair of folds, or nearly: the parameter has the same direction at both ends, but the
/// cubic through both ends and slopes turns back in between, or comes near to it: to a part of the smaller slope. A parameter that changes by no more than the
/// tolerance of Newton's method does not tell: the curve is vertical.
///
/// Source: Fritsch and Carlson (1980), Monotone piecewise cubic interpolation.
fn passes_folds(norm: &Norm, [from, to]: [&CurvePoint; 2], tolerance: f64, nearly: f64) -> bool {
    let last = from.u.len() - 1;
    let difference: Vec<f64> = to.u.iter().zip(&from.u).map(|(x, y)| x - y).collect();
    let length = norm.length(from.scale, &difference);
    let change = difference[last];
    let a = length * from.tangent[last];
    let b = length * to.tangent[last] / norm.length(from.scale, &to.tangent);
    let largest = change.abs().max(a.abs()).max(b.abs());
    if a * b <= 0.0 || largest <= tolerance * from.scale.parameter {
        return false;
    }
    // The slope is a + 2 c x + 3 d x^2 for x from 0 to 1; both ends have the sign of a. In the vertex it is a - c^2 / (3 d).
    let (c, d) = (3.0 * change - 2.0 * a - b, a + b - 2.0 * change);
    let vertex = -c / (3.0 * d);
    let least = (1.0 - c * c / (3.0 * a * d)) * a.abs();
    vertex > 0.0 && vertex < 1.0 && d * a > 0.0 && least < nearly * a.abs().min(b.abs())
}
