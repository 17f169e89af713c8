//! Whether an orbit is more regular than asked for: it returns before its period is over, or turns its sign after half of it.
//!
//! A branch of orbits that are not ends where it meets one of orbits that are, at a period doubling or where a symmetry breaks.
//! Steps along it pass over that point and onto the other branch. There the point is located, by the test function of branch
//! points.

use super::equations::Equations;
use crate::branches::solve;
use crate::continuation::follow::{CurvePoint, Step};
use crate::continuation::newton::{Newton, NewtonOptions};
use crate::time::FlowError;

/// The same at a branch point: along a branch that turns there, states are known to the root of what the value is known to.
const SAME_AT_POINT: f64 = 1e-4;
/// The other branch is followed beyond the point before by this part of the step.
const MARGIN: f64 = 0.5;

/// By what part of the `size` of orbits two states differ at most that are one.
#[derive(Debug, Clone, Copy)]
pub(super) struct SameState {
    pub(super) size: f64,
    pub(super) part: f64,
}

/// How an orbit repeats itself.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct MinimalPeriod {
    /// Its shortest period, in periods of the system.
    pub(super) period: usize,
    /// Half of the period asked for turns the sign of every coordinate.
    pub(super) odd: bool,
}

impl MinimalPeriod {
    /// The same at a branch point.
    pub(super) fn at_point(
        equations: &mut Equations,
        u: &[f64],
        same: SameState,
        odd: bool,
    ) -> Result<Self, FlowError> {
        let part = same.part.max(SAME_AT_POINT);
        Self::of(equations, u, SameState { part, ..same }, odd)
    }

    /// Of the orbit `u`; whether it has odd symmetry only where that is possible.
    pub(super) fn of(
        equations: &mut Equations,
        u: &[f64],
        same: SameState,
        odd: bool,
    ) -> Result<Self, FlowError> {
        let most = same.part * same.size;
        let span = equations.span;
        let value = u[u.len() - 1];
        let first = equations.states_of(u)[..equations.order()].to_vec();
        let mut recurrence = Self {
            period: span.period,
            odd: span.half,
        };
        if span.half {
            return Ok(recurrence);
        }
        let mut state = first.clone();
        for passed in 1..=span.period / 2 {
            equations.pass(&mut state, value, 2)?;
            if span.period.is_multiple_of(passed) && returns(equations, &state, &first, most) {
                recurrence.period = passed;
                break;
            }
        }
        if odd && span.period % 2 == 1 {
            let mut state = first.clone();
            equations.pass(&mut state, value, span.period)?;
            for x in &mut state {
                *x = -*x;
            }
            recurrence.odd = returns(equations, &state, &first, most);
        }
        Ok(recurrence)
    }
}

/// Whether a state is that at the beginning, but for this.
fn returns(equations: &Equations, state: &[f64], first: &[f64], most: f64) -> bool {
    let n = state.len() / 2;
    let mut pairs = state.iter().zip(first).enumerate();
    pairs.all(|(i, (x, y))| {
        let unit = if i < n { 1.0 } else { equations.frame.omega };
        (x - y).abs() <= most * unit
    })
}

/// The step along the more regular branch that passes over the point where a step came onto it: from beyond the
/// parameter where the step begins.
pub(super) fn step_on_other_branch(
    equations: &mut Equations,
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
    solve::at_value(equations, newton, &mut u, options).ok()?;
    let mut tangent = vec![0.0; u.len()];
    newton.tangent(equations, &u, &mut tangent, true);
    let scale = next.scale;
    let length = newton.norm().length(scale, &tangent) * slope.signum();
    for t in &mut tangent {
        *t /= length;
    }
    Some(CurvePoint { u, tangent, scale })
}
