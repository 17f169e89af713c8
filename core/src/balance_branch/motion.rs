//! How a start moves states of the system in time.

use std::f64::consts::TAU;

use crate::balance::start::{Moved, Moving};
use crate::balance_branch::context::BranchContext;
use crate::system::{System, Variable};
use crate::time;
use crate::time::{Flow, FlowError, Stretch};

/// Tolerance of motions that only lead to a guess.
const TOLERANCE: f64 = 1e-7;
/// Multiplications for the force of a contact at one instant.
const PER_CONTACT: u64 = 64;

/// Moves a state of the system of a branch.
pub(crate) fn moved(context: &BranchContext, moving: Moving<'_>) -> Moved {
    let mut parameters = context.parameters.clone();
    let mut omega = moving.omega;
    match moving.variable {
        Variable::Omega => omega = moving.value,
        Variable::Parameter(index) => parameters[index] = moving.value,
    }
    let Ok(mut flow) = time::at(&context.system, &parameters, omega, TOLERANCE) else {
        return Moved {
            positions: None,
            operations: 0,
        };
    };
    flow.until(&context.cancel);
    let most =
        usize::try_from(moving.most / per_force(context.system.as_ref())).unwrap_or(usize::MAX);
    let positions = recorded(flow.as_mut(), moving, most).ok().flatten();
    Moved {
        positions,
        operations: flow.work().forces as u64 * per_force(context.system.as_ref()),
    }
}

/// Positions over the last periods, unless that takes more than so many evaluations of the force.
///
/// # Errors
/// If the motion cannot be continued.
fn recorded(
    flow: &mut dyn Flow,
    moving: Moving<'_>,
    most: usize,
) -> Result<Option<Vec<f64>>, FlowError> {
    let Moving {
        state,
        skipped,
        recorded,
        samples,
        ..
    } = moving;
    for _ in 0..skipped {
        flow.advance(0.0, TAU, state, None, None)?;
        if flow.work().forces > most {
            return Ok(None);
        }
    }
    let coordinates = flow.coordinates();
    let count = recorded * samples;
    let mut positions = vec![0.0; coordinates * count];
    let mut between = state.to_vec();
    for period in 0..recorded {
        let mut next = 0;
        let mut see = |stretch: &dyn Stretch| {
            let end = stretch.phases().1;
            while next < samples {
                let phase = TAU * next as f64 / samples as f64;
                if phase > end {
                    break;
                }
                stretch.state(phase, &mut between);
                for (i, x) in between[..coordinates].iter().enumerate() {
                    positions[i * count + period * samples + next] = *x;
                }
                next += 1;
            }
        };
        flow.advance(0.0, TAU, state, None, Some(&mut see))?;
    }
    Ok(positions.iter().all(|x| x.is_finite()).then_some(positions))
}

/// Multiplications for all forces at one instant, about.
fn per_force(system: &dyn System) -> u64 {
    let facts = system.facts();
    let order = facts.coordinates.len() as u64;
    PER_CONTACT * facts.contacts.len() as u64 + 4 * order * order
}
