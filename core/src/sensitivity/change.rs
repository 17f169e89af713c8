//! How the matrix over the period changes along a direction.
//!
//! ```text
//! M' = d/dh M(s + h s'; p + h p')   at h = 0                                                                   (1)
//! D(h) = ( M(h) - M(-h) ) / 2h,     T_jk = T_j,k-1 + ( T_j,k-1 - T_j-1,k-1 ) / (4^k - 1),   T_j0 = D(h / 2^j)  (2)
//! ```
//!
//! `M` is the exact derivative of the discrete motion, and the direction is the exact tangent, so that (1) takes one derivative of what is
//! known, along a straight line. It is differenced (2): second derivatives of laws at fixed times are not integrable for exponents below
//! one, while `M` is smooth as long as the same levels are crossed in the same order; looked at is how many are. The error is what the last step of
//! (2) changed, as Ridders has it; where steps become so short that it is noise, it grows again, and the best is taken.
//!
//! Source: Ridders (1982), Accurate computation of F'(x) and F'(x) F''(x), Adv. Eng. Softw. 4.

use nalgebra::DMatrix;

use super::cycle::Cycle;
use super::error::SensitivityError;
use super::moments::Along;
use crate::system::Variable;
use crate::time::FlowError;

/// The first step: no part of the orbit, and no value, changes by more than this part.
const FIRST: f64 = 1e-3;
/// Halvings of the step.
const LEVELS: usize = 7;
/// The first step is so often made shorter by this, where other levels are crossed at it.
const SHORTER: f64 = 0.2;
const SHORTENED: usize = 6;
/// Errors below this part of a matrix are small enough.
const ENOUGH: f64 = 1e-8;
/// An error that has grown by this from the best is noise.
const WORSE: f64 = 4.0;

/// The derivative of the matrix over the period.
#[derive(Debug, Clone)]
pub(super) struct Change {
    pub(super) matrix: DMatrix<f64>,
    /// Of its norm.
    pub(super) error: f64,
}

/// (1) along a direction, of an orbit at the present values.
///
/// # Errors
/// If motions beside it cannot be continued, or cross other levels however near they are.
pub(super) fn along(
    cycle: &mut Cycle,
    states: &[f64],
    variables: &[Variable],
    along: &Along,
) -> Result<Change, SensitivityError> {
    let values: Vec<f64> = variables.iter().map(|&v| cycle.value(v)).collect();
    let mut line = Line {
        states,
        variables,
        values: &values,
        along,
    };
    let change = line.change(cycle);
    // Whatever came of it, the values are as before.
    line.set(cycle, 0.0)?;
    change
}

/// A straight line through an orbit.
struct Line<'l> {
    states: &'l [f64],
    variables: &'l [Variable],
    values: &'l [f64],
    along: &'l Along,
}

impl Line<'_> {
    fn set(&self, cycle: &mut Cycle, h: f64) -> Result<(), FlowError> {
        let values = self.variables.iter().zip(self.values);
        for ((&variable, &value), &weight) in values.zip(&self.along.weights) {
            cycle.set(variable, value + h * weight)?;
        }
        Ok(())
    }

    /// The matrix at a place, and how often levels are crossed.
    fn at(&self, cycle: &mut Cycle, h: f64) -> Result<(DMatrix<f64>, usize), FlowError> {
        self.set(cycle, h)?;
        let moved = self.states.iter().zip(&self.along.states);
        let states: Vec<f64> = moved.map(|(s, d)| s + h * d).collect();
        let before = cycle.switches();
        let evaluated = cycle.evaluate(&states, &[], &[])?;
        Ok((cycle.monodromy(&evaluated), cycle.switches() - before))
    }

    /// The largest part of the orbit, or of a value, that changes with `h = 1`.
    fn length(&self, cycle: &Cycle) -> f64 {
        let size = cycle.size(self.states).max(f64::MIN_POSITIVE);
        let of_states = cycle.size(self.along.states.as_slice()) / size;
        let values = self.values.iter().zip(&self.along.weights);
        let known = values.filter(|(value, _)| **value != 0.0);
        known.fold(of_states, |m, (value, weight)| {
            m.max((weight / value).abs())
        })
    }

    fn change(&mut self, cycle: &mut Cycle) -> Result<Change, SensitivityError> {
        let (_, crossed) = self.at(cycle, 0.0)?;
        let length = self.length(cycle);
        let mut step = if length > 0.0 { FIRST / length } else { FIRST };
        for _ in 0..SHORTENED {
            match self.extrapolated(cycle, step, crossed) {
                Ok(Some(change)) => return Ok(change),
                Err(error @ FlowError::Cancelled { .. }) => return Err(error.into()),
                Ok(None) | Err(_) => step *= SHORTER,
            }
        }
        Err(SensitivityError::Beside)
    }

    /// (2); nothing if levels are crossed otherwise at the first step.
    fn extrapolated(
        &self,
        cycle: &mut Cycle,
        first: f64,
        crossed: usize,
    ) -> Result<Option<Change>, FlowError> {
        let mut before: Vec<DMatrix<f64>> = Vec::new();
        let mut best: Option<Change> = None;
        for level in 0..LEVELS {
            let step = first * 0.5_f64.powi(level as i32);
            let (ahead, a) = self.at(cycle, step)?;
            let (behind, b) = self.at(cycle, -step)?;
            if a != crossed || b != crossed {
                return Ok(best);
            }
            let mut row = vec![(ahead - behind) / (2.0 * step)];
            let mut error = f64::INFINITY;
            for (k, shorter) in before.iter().enumerate() {
                let factor = 4.0_f64.powi(k as i32 + 1) - 1.0;
                let next = &row[k] + (&row[k] - shorter) / factor;
                error = (&next - &row[k]).norm().max((&next - shorter).norm());
                if best.as_ref().is_none_or(|best| error < best.error) {
                    let matrix = next.clone();
                    best = Some(Change { matrix, error });
                }
                row.push(next);
            }
            if let Some(best) = &best
                && (best.error <= ENOUGH * best.matrix.norm() || error > WORSE * best.error)
            {
                break;
            }
            before = row;
        }
        Ok(best)
    }
}
