//! Newton's method on the equations of shooting at one value of the parameter, or with another unknown held.

use crate::continuation::newton::{Border, Converged, Newton, NewtonError, NewtonOptions};
use crate::continuation::problem::{Problem, Scale};

/// The scale at extended unknowns, where the parameter counts by its own size.
pub(super) fn scale_at(newton: &Newton, u: &[f64]) -> Scale {
    let parameter = u[u.len() - 1].abs();
    let unit = if parameter > 0.0 { parameter } else { 1.0 };
    newton.norm().scale_at(u, unit, &mut [0.0; 2])
}

/// Solves with the parameter held at the last entry of `u`.
pub(super) fn at_value(
    problem: &mut dyn Problem,
    newton: &mut Newton,
    u: &mut [f64],
    options: NewtonOptions,
) -> Result<Converged, NewtonError> {
    let last = u.len() - 1;
    with_held(problem, newton, u, last, options)
}

/// Solves with one of the extended unknowns held.
pub(super) fn with_held(
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
