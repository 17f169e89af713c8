//! Whether an orbit is more regular than asked for: it returns before its period is over, or comes back after a part of it with
//! coordinates or contacts in each other's place.
//!
//! A branch of orbits that are not ends where it meets one of orbits that are, at a period doubling or where a symmetry breaks.
//! Steps along it pass over that point and onto the other branch. There the point is located, by the test function of branch
//! points.

use super::equations::Equations;
use crate::branches::recurrence::{CyclicSymmetry, Recurrence};
use crate::time::FlowError;

/// The same at a branch point: along a branch that turns there, states are known to the root of what the value is known to.
const SAME_AT_POINT: f64 = 1e-4;

/// By what part of the `size` of orbits two states differ at most that are one.
#[derive(Debug, Clone, Copy)]
pub(super) struct SameState {
    pub(super) size: f64,
    pub(super) part: f64,
}

impl SameState {
    /// At a branch point.
    pub(super) fn at_point(self) -> Self {
        Self {
            part: self.part.max(SAME_AT_POINT),
            ..self
        }
    }
}

/// How the orbit `u` comes back in less time than it is followed for, the least that there is; `None` if it does not.
///
/// # Errors
/// If its motion cannot be computed.
pub(super) fn earlier(
    equations: &mut Equations,
    u: &[f64],
    same: SameState,
    symmetries: &[CyclicSymmetry],
) -> Result<Option<Recurrence>, FlowError> {
    let most = same.part * same.size;
    let value = u[u.len() - 1];
    let coordinates = equations.order() / 2;
    let first = equations.states_of(u)[..equations.order()].to_vec();
    let mut least: Option<Recurrence> = None;
    for symmetry in symmetries {
        let mut state = first.clone();
        let mut passed = 0;
        for (steps, recurrence) in symmetry.within(&equations.span.recurrence) {
            let shorter = |least: &Recurrence| {
                recurrence.period * least.parts < least.period * recurrence.parts
            };
            if !least.as_ref().is_none_or(shorter) {
                break;
            }
            equations.pass(&mut state, value, [passed, steps], symmetry.parts)?;
            passed = steps;
            let image = recurrence.image.of_states(&first, coordinates);
            if are_near(equations, &state, &image, most) {
                least = Some(recurrence);
                break;
            }
        }
    }
    Ok(least)
}

/// Whether there may be orbits that come back in less time than is followed.
pub(super) fn may_be_earlier(equations: &Equations, symmetries: &[CyclicSymmetry]) -> bool {
    let given = &equations.span.recurrence;
    let mut symmetries = symmetries.iter();
    symmetries.any(|symmetry| symmetry.within(given).next().is_some())
}

/// Whether a state is another one, but for this.
pub(super) fn are_near(equations: &Equations, state: &[f64], other: &[f64], most: f64) -> bool {
    let n = state.len() / 2;
    let mut pairs = state.iter().zip(other).enumerate();
    pairs.all(|(i, (x, y))| {
        let unit = if i < n { 1.0 } else { equations.frame.omega };
        (x - y).abs() <= most * unit
    })
}
