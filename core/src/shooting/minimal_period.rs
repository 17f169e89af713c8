//! Whether an orbit is more regular than asked for: it returns before its period is over, or comes back after a part of it with
//! coordinates or contacts in each other's place.
//!
//! A branch of orbits that are not ends where it meets one of orbits that are, at a period doubling or where a symmetry breaks.
//! Steps along it pass over that point and onto the other branch. There the point is located, by the test function of branch
//! points.

use super::equations::Equations;
use crate::branches::recurrence::{CyclicSymmetry, Recurrence, are_near, least};
use crate::numeric::linear::dot;
use crate::time::FlowError;

/// The same at a branch point: along a branch that turns there, states are known to the root of what the value is known to.
const SAME_AT_POINT: f64 = 1e-4;
/// Directions are opposite if the cosine of the angle between them is below minus this.
const OPPOSITE: f64 = 0.5;

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
    let (order, omega) = (equations.order(), equations.frame.omega);
    let first = equations.states_of(u)[..order].to_vec();
    let given = equations.span.recurrence.clone();
    let (mut state, mut passed) = (first.clone(), [0, 0]);
    least(&given, symmetries, |symmetry, steps, recurrence| {
        if passed[0] != symmetry {
            (state, passed) = (first.clone(), [symmetry, 0]);
        }
        let parts = symmetries[symmetry].parts;
        equations.pass(&mut state, value, [passed[1], steps], parts)?;
        passed[1] = steps;
        let image = recurrence.image.of_states(&first, order / 2);
        Ok(are_near(&state, &image, most, omega))
    })
}

/// Whether what two orbits `u` and `other` of a branch have in addition to those that come back earlier, in this way, has opposite
/// directions: the branch passes one that has nothing in addition between them.
///
/// # Errors
/// If their motion cannot be computed.
pub(super) fn passes_between(
    equations: &mut Equations,
    orbits: [&[f64]; 2],
    earlier: &Recurrence,
    symmetries: &[CyclicSymmetry],
) -> Result<bool, FlowError> {
    let given = equations.span.recurrence.clone();
    let (order, omega) = (equations.order(), equations.frame.omega);
    let way = symmetries.iter().find_map(|symmetry| {
        let mut within = symmetry.within(&given);
        let (steps, _) = within.find(|(_, recurrence)| recurrence == earlier)?;
        Some((steps, symmetry.parts))
    });
    let Some((steps, parts)) = way else {
        return Ok(false);
    };
    let mut additions = Vec::new();
    for u in orbits {
        let first = equations.states_of(u)[..order].to_vec();
        let mut state = first.clone();
        equations.pass(&mut state, u[u.len() - 1], [0, steps], parts)?;
        let image = earlier.image.of_states(&first, order / 2);
        for (i, (x, y)) in state.iter_mut().zip(&image).enumerate() {
            *x = (*x - y) / if i < order / 2 { 1.0 } else { omega };
        }
        additions.push(state);
    }
    let [a, b] = [&additions[0], &additions[1]];
    Ok(dot(a, b) < -OPPOSITE * (dot(a, a) * dot(b, b)).sqrt())
}
