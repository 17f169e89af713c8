//! The first point of a branch that begins at another one.
//!
//! A branch leaves another one along a direction that is not the tangent of the latter. At a pitchfork and at a period doubling the
//! parameter changes with the square of a step along it, so that no solution can be held there by its parameter. The point is solved
//! for with its component along the direction held instead.
//!
//! Source: Govaerts (2000), Numerical Methods for Bifurcations of Dynamical Equilibria, chapter 8 (branch switching); Seydel (2010),
//! Practical Bifurcation and Stability Analysis, section 5.6.

use super::solve;
use crate::continuation::follow::{CurvePoint, Step};
use crate::continuation::newton::{Border, Newton, NewtonOptions};
use crate::continuation::problem::{Problem, Scale};
use crate::numeric::linear::dot;

/// A solution farther away than so many times its step is one of another branch.
const FARTHEST: f64 = 10.0;
/// A more regular branch is followed beyond the point before by this part of the step onto it.
const MARGIN: f64 = 0.5;

/// Where a branch begins, and where to.
#[derive(Debug, Clone, Copy)]
pub(crate) struct BranchSwitch<'d> {
    /// The solution where it begins, as extended unknowns.
    pub(crate) from: &'d [f64],
    /// The direction of the branch.
    pub(crate) along: &'d [f64],
    /// The linear form that is held.
    pub(crate) held: &'d [f64],
    pub(crate) scale: Scale,
}

impl BranchSwitch<'_> {
    /// The solution at a step along the direction, with its tangent away from where the branch begins.
    pub(crate) fn first_point(
        &self,
        problem: &mut dyn Problem,
        newton: &mut Newton,
        step: f64,
        options: NewtonOptions,
    ) -> Option<CurvePoint> {
        let Self {
            from,
            along,
            held,
            scale,
        } = *self;
        let mut u: Vec<f64> = from.iter().zip(along).map(|(x, d)| x + step * d).collect();
        let border = Border {
            row: held,
            value: dot(held, &u),
        };
        newton
            .correct(problem, &mut u, border, scale, options)
            .ok()?;
        let moved: Vec<f64> = u.iter().zip(from).map(|(x, y)| x - y).collect();
        let length = newton.norm().length(scale, along);
        if newton.norm().length(scale, &moved) > FARTHEST * step.abs() * length {
            return None;
        }
        let mut tangent = vec![0.0; u.len()];
        newton.tangent(problem, &u, &mut tangent, true);
        let outwards = step * dot(held, &tangent);
        let length = newton.norm().length(scale, &tangent) * outwards.signum();
        for t in &mut tangent {
            *t /= length;
        }
        Some(CurvePoint { u, tangent, scale })
    }
}

/// The step along the more regular branch that passes over the point where a step came onto it: from beyond the
/// parameter where the step begins.
pub(crate) fn step_on_other_branch(
    problem: &mut dyn Problem,
    newton: &mut Newton,
    Step { before, next }: Step<'_>,
    options: NewtonOptions,
) -> Option<CurvePoint> {
    let last = next.u.len() - 1;
    let slope = next.tangent[last];
    let distance = (1.0 + MARGIN) * (before.parameter() - next.parameter());
    let along = distance / slope;
    let pairs = next.u.iter().zip(&next.tangent);
    let mut u: Vec<f64> = pairs.map(|(x, t)| x + along * t).collect();
    solve::at_value(problem, newton, &mut u, options).ok()?;
    let mut tangent = vec![0.0; u.len()];
    newton.tangent(problem, &u, &mut tangent, true);
    let scale = next.scale;
    let length = newton.norm().length(scale, &tangent) * slope.signum();
    for t in &mut tangent {
        *t /= length;
    }
    Some(CurvePoint { u, tangent, scale })
}
