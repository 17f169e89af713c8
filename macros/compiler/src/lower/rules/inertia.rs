//! Rules on the mass matrix.
//!
//! Whether it is singular is decided by its value at a few generic values of the parameters within their ranges: a
//! determinant that is zero at all of them is zero.

use crate::ast::{Declaration, Limit, Parameter};
use crate::dag::{Dag, Id, Node, Variable};
use crate::errors::{Diagnostics, Extent};
use crate::lower::interval::{Interval, Ranges, Stretch};

/// The mass matrix is regular: for some values of the parameters it can be inverted.
pub fn mass_is_regular(
    declaration: &Declaration,
    dag: &Dag,
    masses: &[(usize, usize, Id)],
    ranges: &[Interval],
) -> syn::Result<()> {
    let coordinates: Vec<_> = declaration.elements().collect();
    for (column, (coordinate, name)) in coordinates.iter().enumerate() {
        if !masses.iter().any(|&(_, other, _)| other == column) {
            let message = format!(
                "`ddot({coordinate})` stands in no equation: without inertia `{coordinate}` has no equation of motion"
            );
            return Err(Extent::at(name.span()).fault(message));
        }
    }
    let matrix = Matrix {
        dag,
        masses,
        ranges,
        size: coordinates.len(),
    };
    if !matrix.is_singular_at(&[]) {
        return Ok(());
    }
    Err(crate::lower::all_equations(declaration).fault(
        "the mass matrix is singular: the second derivatives in these equations are not independent; combine the equations so that each holds one of its own",
    ))
}

/// An equation that holds one second derivative alone does not hold it with a negative mass, by number, by default or by range.
pub fn masses_are_positive(
    declaration: &Declaration,
    dag: &mut Dag,
    masses: &[(usize, usize, Id)],
    ranges: &Ranges,
    diagnostics: &mut Diagnostics,
) {
    let coordinates: Vec<_> = declaration.elements().collect();
    for &(row, column, mass) in masses {
        if masses.iter().filter(|(other, ..)| *other == row).count() > 1 {
            continue;
        }
        let (coordinate, name) = &coordinates[column];
        let bounds = ranges.bounds(dag, mass, Stretch::ALL);
        if bounds.is_not_positive() {
            let message = format!(
                "the mass of `{coordinate}` is negative: change the signs of the whole equation, so that it holds `m*ddot({coordinate})` with a positive `m`"
            );
            diagnostics.report(Extent::at(name.span()), message);
            continue;
        }
        let default = |variable| match variable {
            Variable::Parameter(index) => declaration
                .parameters
                .get(index)
                .and_then(|parameter| parameter.default)
                .map_or(f64::NAN, |(value, _)| value),
            _ => f64::NAN,
        };
        let value = dag.evaluate(mass, &default);
        if value < 0.0 {
            let message = format!(
                "with the defaults of the parameters the mass of `{coordinate}` is {value}: a mass is positive; change a default, and declare ranges that keep it so"
            );
            diagnostics.report(Extent::at(name.span()), message);
        }
    }
}

/// No range admits a value at which a mass vanishes; a parameter without a range is left to the runtime.
pub fn ranges_admit_no_singular_mass(
    declaration: &Declaration,
    dag: &Dag,
    masses: &[(usize, usize, Id)],
    ranges: &[Interval],
    diagnostics: &mut Diagnostics,
) {
    let matrix = Matrix {
        dag,
        masses,
        ranges,
        size: declaration.elements().count(),
    };
    let roots: Vec<Id> = masses.iter().map(|&(_, _, mass)| mass).collect();
    let parts = dag.reachable(&roots);
    let is_used = |index| {
        let variable = Node::Variable(Variable::Parameter(index));
        parts.iter().any(|&part| *dag.node(part) == variable)
    };
    let mut zeros = Vec::new();
    let faults = diagnostics.count();
    for (index, parameter) in declaration.parameters.iter().enumerate() {
        let values = if is_used(index) {
            special_values(parameter)
        } else {
            Vec::new()
        };
        zeros.extend(values.contains(&0.0).then_some((index, 0.0)));
        let singular = values
            .into_iter()
            .find(|&value| matrix.is_singular_at(&[(index, value)]));
        if let Some(value) = singular {
            let (name, advice) = (&parameter.name, without(parameter, value));
            diagnostics.report(
                parameter.range,
                format!("the mass matrix is singular at `{name} = {value}`, which this range admits: {advice}"),
            );
        }
    }
    // Masses that are sums vanish only with all of their terms.
    if diagnostics.count() == faults && zeros.len() > 1 && matrix.is_singular_at(&zeros) {
        let first = &declaration.parameters[zeros[0].0];
        let names = zeros
            .iter()
            .map(|&(index, _)| declaration.parameters[index].name.to_string());
        let names = names.collect::<Vec<_>>().join("` and `");
        diagnostics.report(
            first.range,
            format!("the mass matrix is singular where `{names}` are all zero, which their ranges admit: {}", without(first, 0.0)),
        );
    }
}

/// The ends that belong to a declared range, and zero inside.
fn special_values(parameter: &Parameter) -> Vec<f64> {
    let ends = [parameter.minimum, parameter.maximum];
    let included = ends.into_iter().flatten().filter(|end| end.included);
    let mut values: Vec<f64> = included.map(|end| end.value).collect();
    let is_declared = ends.iter().any(Option::is_some);
    let is_above = |end: Option<Limit>| end.is_none_or(|end| end.value < 0.0);
    let is_below = |end: Option<Limit>| end.is_none_or(|end| end.value > 0.0);
    if is_declared && is_above(parameter.minimum) && is_below(parameter.maximum) {
        values.push(0.0);
    }
    values
}

/// How to declare a range without one of its special values.
fn without(parameter: &Parameter, value: f64) -> String {
    let name = &parameter.name;
    let name = match &parameter.unit {
        Some((unit, _)) => format!("{name}: {}", unit.text),
        None => name.to_string(),
    };
    let is_at = |end: Option<Limit>| end.is_some_and(|end| end.value == value);
    match (parameter.minimum, parameter.maximum) {
        (Some(_), Some(_)) if is_at(parameter.minimum) => format!("let it begin above {value}"),
        (Some(low), _) if is_at(parameter.maximum) => {
            format!("write `param {name} in {:?}..{value:?};`", low.value)
        }
        _ if is_at(parameter.maximum) => format!("write `param {name} < {value};`"),
        _ => format!("write `param {name} > {value};`"),
    }
}

/// The mass matrix as a function of the parameters.
struct Matrix<'a> {
    dag: &'a Dag,
    masses: &'a [(usize, usize, Id)],
    ranges: &'a [Interval],
    size: usize,
}

impl Matrix<'_> {
    /// Whether it is singular whatever the parameters are, but for some that are given by index and value.
    fn is_singular_at(&self, given: &[(usize, f64)]) -> bool {
        (1..=3).all(|trial| {
            let generic = |index: usize| {
                let fraction = (f64::from(trial) * 0.618 + index as f64 * 0.382).fract();
                self.ranges
                    .get(index)
                    .map_or(fraction, |range| range.inside(fraction))
            };
            let value = |variable| match variable {
                Variable::Parameter(index) => given
                    .iter()
                    .find(|&&(other, _)| other == index)
                    .map_or_else(|| generic(index), |&(_, value)| value),
                _ => 0.9 + 0.1 * f64::from(trial),
            };
            let mut matrix = vec![vec![0.0; self.size]; self.size];
            for &(row, column, mass) in self.masses {
                matrix[row][column] += self.dag.evaluate(mass, &value);
            }
            !is_regular(matrix)
        })
    }
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
