//! The error of peak-to-peak of an output, as a part of itself, from two orbits.
//!
//! What differs in the other orbit, which is not the one that is reported; what moves states by as much as their errors; and what rounding of
//! states does. An output that does not move is measured by its largest value.

use super::equations::Equations;
use super::problem::ShootingProblem;
use super::signals::Rounded;
use crate::branches::observed::{Motion, Observed, part_of};
use crate::time::{FlowError, Stretch};

/// An orbit of some equations.
pub(super) struct At<'e> {
    pub(super) equations: &'e mut Equations,
    pub(super) u: &'e [f64],
}

impl At<'_> {
    /// Extremes of an output, with more rounding of states if that is wanted.
    fn output(
        &mut self,
        problem: &ShootingProblem,
        output: usize,
        rounded: bool,
    ) -> Result<Motion, FlowError> {
        let u = self.u;
        let recurrence = self.equations.span.recurrence.clone();
        let Some(mut outputs) = problem.output_reader(u[u.len() - 1], &recurrence) else {
            return Ok(Motion::NONE);
        };
        let see = &mut |stretch: &dyn Stretch| {
            if rounded {
                outputs.include(&Rounded(stretch));
            } else {
                outputs.include(stretch);
            }
        };
        self.equations.trace(u, see)?;
        let motion = outputs.motions().into_iter().nth(output);
        Ok(motion.unwrap_or(Motion::NONE))
    }
}

/// What the error is this part of, of what differs between the orbits; and errors that the flow leaves in the states, as parts of the size of
/// their oscillation.
#[derive(Debug, Clone, Copy)]
pub(super) struct Errors {
    pub(super) part: f64,
    pub(super) states: f64,
    pub(super) size: f64,
}

/// The error of an output of the best orbit, of which this was observed.
pub(super) fn output_error(
    problem: &ShootingProblem,
    output: usize,
    observed: &Observed,
    mut best: At<'_>,
    mut other: At<'_>,
    Errors { part, states, size }: Errors,
) -> Result<f64, FlowError> {
    let Some(motion) = observed.outputs.get(output) else {
        return Ok(f64::INFINITY);
    };
    let apart = best.equations.apart(other.u, best.u);
    let there = other.output(problem, output, false)?;
    if motion.peak_to_peak() == 0.0 && there.peak_to_peak() == 0.0 {
        return Ok(0.0);
    }
    let change = motion.apart(&there);
    let noise = motion.apart(&best.output(problem, output, true)?);
    // Of two orbits that are one nothing tells how an output follows the states.
    let seen = if apart > 0.0 { change / apart } else { 0.0 };
    let times = seen.max(motion.peak_to_peak() / (2.0 * size));
    let error = part * change + times * states * size + noise;
    Ok(part_of(error, motion.measure(noise)))
}
