//! Rules on the mass matrix.

use crate::ast::Declaration;
use crate::dag::{Dag, Id, Variable};
use crate::errors::Extent;
use crate::lower::interval::Interval;

/// The mass matrix is regular: for some values of the parameters it can be inverted.
///
/// The determinant is evaluated at a few generic values within the ranges; one that is zero at all of them is zero.
pub(crate) fn mass_is_regular(
    declaration: &Declaration,
    dag: &Dag,
    masses: &[(usize, usize, Id)],
    ranges: &[Interval],
) -> syn::Result<()> {
    let coordinates: Vec<_> = declaration.elements().collect();
    let size = coordinates.len();
    for (column, (coordinate, name)) in coordinates.iter().enumerate() {
        if !masses.iter().any(|&(_, other, _)| other == column) {
            let message = format!(
                "`ddot({coordinate})` stands in no equation: without inertia `{coordinate}` has no equation of motion"
            );
            return Err(Extent::at(name.span()).fault(message));
        }
    }
    let regular = (1..=3).any(|trial| {
        let value = |variable| match variable {
            Variable::Parameter(index) => {
                let fraction = (f64::from(trial) * 0.618 + index as f64 * 0.382).fract();
                ranges
                    .get(index)
                    .map_or(fraction, |range| range.inside(fraction))
            }
            _ => 0.9 + 0.1 * f64::from(trial),
        };
        let mut matrix = vec![vec![0.0; size]; size];
        for &(row, column, mass) in masses {
            matrix[row][column] += dag.evaluate(mass, &value);
        }
        is_regular(matrix)
    });
    if regular {
        return Ok(());
    }
    Err(crate::lower::all_equations(declaration).fault(
        "the mass matrix is singular: the second derivatives in these equations are not independent; combine the equations so that each holds one of its own",
    ))
}

/// Gaussian elimination with row pivoting.
fn is_regular(mut matrix: Vec<Vec<f64>>) -> bool {
    let scale = matrix
        .iter()
        .flatten()
        .fold(0.0_f64, |scale, entry| scale.max(entry.abs()));
    let size = matrix.len();
    for column in 0..size {
        let Some(pivot) = (column..size)
            .max_by(|&a, &b| matrix[a][column].abs().total_cmp(&matrix[b][column].abs()))
        else {
            return false;
        };
        matrix.swap(column, pivot);
        let head = matrix[column][column];
        if head.is_nan() || head.abs() <= 1e-12 * scale {
            return false;
        }
        let above = matrix[column].clone();
        for row in &mut matrix[column + 1..] {
            let factor = row[column] / head;
            if factor == 0.0 {
                continue;
            }
            for (entry, upper) in row.iter_mut().zip(&above) {
                *entry -= factor * upper;
            }
        }
    }
    true
}
