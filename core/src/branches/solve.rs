//! Newton's method on the equations of a branch at one value of the parameter, or with another unknown held.

use crate::continuation::follow::CurvePoint;
use crate::continuation::newton::{Border, Converged, Newton, NewtonError, NewtonOptions};
use crate::continuation::problem::{Problem, Scale};

/// The scale at extended unknowns, where the parameter counts by its own size.
pub(crate) fn scale_at(newton: &Newton, u: &[f64]) -> Scale {
    let parameter = u[u.len() - 1].abs();
    let unit = if parameter > 0.0 { parameter } else { 1.0 };
    newton.norm().scale_at(u, unit, &mut [0.0; 2])
}

/// Solves with the parameter held at the last entry of `u`.
pub(crate) fn at_value(
    problem: &mut dyn Problem,
    newton: &mut Newton,
    u: &mut [f64],
    options: NewtonOptions,
) -> Result<Converged, NewtonError> {
    let last = u.len() - 1;
    with_held(problem, newton, u, last, options)
}

/// Solves with one of the extended unknowns held.
pub(crate) fn with_held(
    problem: &mut dyn Problem,
    newton: &mut Newton,
    u: &mut [f64],
    held: usize,
    options: NewtonOptions,
) -> Result<Converged, NewtonError> {
    let scale = scale_at(newton, u);
    let unit = newton.norm().unit(scale, held);
    let mut row = vec![0.0; u.len()];
    row[held] = 1.0 / unit;
    let value = u[held];
    let border = Border {
        row: &row,
        value: value / unit,
    };
    let converged = newton.correct(problem, u, border, scale, options)?;
    u[held] = value;
    Ok(converged)
}

/// The solution at the value that a guess ends with, and the direction of its branch there: to larger values for a positive `side`.
/// `range` is the length that counts as one for the value.
pub(crate) fn along(
    problem: &mut dyn Problem,
    newton: &mut Newton,
    mut u: Vec<f64>,
    toward: Toward,
    options: NewtonOptions,
) -> Result<CurvePoint, NewtonError> {
    at_value(problem, newton, &mut u, options)?;
    let scale = newton.norm().scale_at(&u, toward.range, &mut [0.0; 2]);
    let mut tangent = vec![0.0; u.len()];
    newton.tangent(problem, &u, &mut tangent, true);
    let sign = toward.side * tangent[tangent.len() - 1];
    let length = newton.norm().length(scale, &tangent) * sign.signum();
    for t in &mut tangent {
        *t /= length;
    }
    Ok(CurvePoint { u, tangent, scale })
}

/// A direction along a branch.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Toward {
    /// Positive to larger values, negative to smaller ones.
    pub(crate) side: f64,
    /// What counts as one for the value.
    pub(crate) range: f64,
}
