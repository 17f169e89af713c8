//! An orbit at a value that a branch may not reach: the branch turns back at a fold before it.
//!
//! Newton's method with the parameter held fails there, and ends near the fold. Near it the equations can be solved with another
//! unknown held instead of the parameter. That unknown is moved, in steps that grow, so that the parameter comes nearer to the value,
//! until it passes it or turns back.

use super::equations::Equations;
use super::problem::ShootingProblem;
use crate::branches::error::OrbitError;
use crate::branches::solve;
use crate::continuation::follow::{CurvePoint, Step};
use crate::continuation::locate::locate;
use crate::continuation::newton::{Newton, NewtonOptions};
use crate::continuation::problem::Scale;
use crate::error::Error;

/// An orbit this far from the value, relative to it, or to one if it is zero, has nothing to do with it.
const FAR: f64 = 0.1;
/// First step, as a part of the size of the orbit, and how the steps grow.
const STEP: f64 = 1e-5;
const GROWTH: f64 = 3.0;
/// No step is longer than this.
const LONGEST: f64 = 0.1;
const STEPS: usize = 60;
/// The test function of the fold is driven below this.
const VANISHED: f64 = 1e-12;

/// What was found on the way to the value.
enum Found {
    Orbit(Vec<f64>),
    Fold(f64),
}

/// The orbit at a value where Newton's method from a guess failed with `reason` at `u`.
///
/// # Errors
/// [`OrbitError::Beyond`] if the branch turns back before, and `reason` if nothing is known.
pub(super) fn search(
    problem: &ShootingProblem,
    equations: &mut Equations,
    u: &[f64],
    value: f64,
    reason: Error,
) -> Result<Vec<f64>, Error> {
    let mut search = Search {
        newton: Newton::new(equations),
        start: problem.newton_at_start(),
        options: problem.newton(problem.source.tolerance, 1.0),
        equations,
        value,
        held: 0,
    };
    let found = search.neighbour(u).and_then(|near| search.towards(near));
    match found {
        Some(Found::Orbit(u)) => Ok(u),
        Some(Found::Fold(fold)) => Err(OrbitError::Beyond { value, fold }.into()),
        None => Err(reason),
    }
}

struct Search<'e> {
    equations: &'e mut Equations,
    newton: Newton,
    start: NewtonOptions,
    options: NewtonOptions,
    value: f64,
    /// The unknown that is held.
    held: usize,
}

impl Search<'_> {
    /// How far an orbit is from the value.
    fn distance(&self, u: &[f64]) -> f64 {
        (u[u.len() - 1] - self.value).abs()
    }

    /// An orbit near the last iterate, of those with one entry of the first state held the nearest to the value.
    fn neighbour(&mut self, u: &[f64]) -> Option<Vec<f64>> {
        if u.iter().any(|x| !x.is_finite()) {
            return None;
        }
        let mut nearest: Option<Vec<f64>> = None;
        for held in 0..self.equations.order() {
            let mut u = u.to_vec();
            let solved = self.solve(&mut u, held);
            let unit = if self.value == 0.0 {
                1.0
            } else {
                self.value.abs()
            };
            let far = FAR * unit;
            let distance = self.distance(&u);
            let nearer = nearest.as_ref().is_none_or(|n| distance < self.distance(n));
            if solved && distance <= far && nearer {
                nearest = Some(u);
                self.held = held;
            }
        }
        nearest
    }

    fn solve(&mut self, u: &mut [f64], held: usize) -> bool {
        solve::with_held(self.equations, &mut self.newton, u, held, self.options).is_ok()
    }

    /// A solution with its tangent, which points to larger values of the unknown that is held.
    fn point(&mut self, u: Vec<f64>, scale: Scale) -> CurvePoint {
        let mut tangent = vec![0.0; u.len()];
        self.newton.tangent(self.equations, &u, &mut tangent, true);
        let length = self.newton.norm().length(scale, &tangent);
        for t in &mut tangent {
            *t /= length;
        }
        CurvePoint { u, tangent, scale }
    }

    /// Moves from an orbit towards the value.
    fn towards(&mut self, near: Vec<f64>) -> Option<Found> {
        let scale = solve::scale_at(&self.newton, &near);
        let unit = self.newton.norm().unit(scale, self.held);
        // Once more, for the matrix.
        let mut u = near;
        if !self.solve(&mut u, self.held) {
            return None;
        }
        let mut before = self.point(u, scale);
        let wanted = self.value - before.parameter();
        let direction = (wanted * before.parameter_slope()).signum();
        let mut step = STEP;
        for _ in 0..STEPS {
            let along = direction * step * unit / before.tangent[self.held];
            let pairs = before.u.iter().zip(&before.tangent);
            let mut u: Vec<f64> = pairs.map(|(x, t)| x + along * t).collect();
            if !self.solve(&mut u, self.held) {
                return None;
            }
            let next = self.point(u, scale);
            let step_to = Step {
                before: &before,
                next: &next,
            };
            if let Some(found) = self.between(step_to) {
                return Some(found);
            }
            before = next;
            step = (GROWTH * step).min(LONGEST);
        }
        None
    }

    /// The orbit at the value, or the fold, if one of them is between two points.
    fn between(&mut self, step: Step<'_>) -> Option<Found> {
        let Step { before, next } = step;
        let mut end = next.clone();
        let turned = (next.parameter_slope() < 0.0) != (before.parameter_slope() < 0.0);
        if turned {
            // From the one with the smaller value of what is held, as the tangents point.
            let held = self.held;
            let forwards = before.u[held] < next.u[held];
            let between = if forwards {
                step
            } else {
                Step {
                    before: next,
                    next: before,
                }
            };
            let slope = CurvePoint::parameter_slope;
            let options = self.options;
            let newton = &mut self.newton;
            end = locate(
                self.equations,
                newton,
                between,
                options,
                VANISHED,
                |_, at| slope(at),
            )?
            .point;
        }
        let (a, b) = (
            before.parameter() - self.value,
            end.parameter() - self.value,
        );
        if a * b <= 0.0 {
            let part = if a == b { 0.0 } else { a / (a - b) };
            let pairs = before.u.iter().zip(&end.u);
            let mut u: Vec<f64> = pairs.map(|(x, y)| x + part * (y - x)).collect();
            let last = u.len() - 1;
            u[last] = self.value;
            let newton = &mut self.newton;
            let solved = solve::at_value(self.equations, newton, &mut u, self.start);
            return solved.is_ok().then_some(Found::Orbit(u));
        }
        turned.then(|| Found::Fold(end.parameter()))
    }
}
