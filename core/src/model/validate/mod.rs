//! Checks of what a user asks for, before any work.

#[cfg(test)]
mod tests;

use std::ops::RangeInclusive;

use nalgebra::DMatrix;

use crate::error::Error;
use crate::model::error::ModelError;
use crate::model::layout::Layout;
use crate::model::request::RequestError;
use crate::numeric::decimal::Decimal;
use crate::system::{Bound, ParameterFacts, System, SystemFacts, Variable};

/// The variable of this name; the excitation frequency without a name.
pub(crate) fn variable(facts: &SystemFacts, name: Option<&str>) -> Result<Variable, Error> {
    let Some(name) = name.filter(|name| *name != "omega") else {
        return Ok(Variable::Omega);
    };
    let found = facts
        .parameters
        .iter()
        .position(|parameter| parameter.name == name);
    found
        .map(Variable::Parameter)
        .ok_or_else(|| unknown(facts, name))
}

/// There is no parameter of this name.
pub(crate) fn unknown(facts: &SystemFacts, name: &str) -> Error {
    let parameters = facts.parameters.iter();
    RequestError::UnknownParameter {
        name: name.to_owned(),
        known: parameters
            .map(|parameter| parameter.name.to_string())
            .collect(),
    }
    .into()
}

/// Both ends of a range are usable and differ.
pub(crate) fn range(
    facts: &SystemFacts,
    variable: Variable,
    from: f64,
    to: f64,
) -> Result<(), Error> {
    for end in [from, to] {
        value(facts, variable, end)?;
    }
    if from == to {
        return Err(RequestError::EmptyRange { value: from }.into());
    }
    Ok(())
}

/// What is varied may have a value.
pub(crate) fn value(facts: &SystemFacts, variable: Variable, value: f64) -> Result<(), Error> {
    match variable {
        Variable::Omega => omega(value).map(|_| ()),
        Variable::Parameter(index) => parameter(&facts.parameters[index], value),
    }
}

/// A frequency is positive and finite.
pub(crate) fn omega(value: f64) -> Result<f64, Error> {
    if value > 0.0 && value.is_finite() {
        Ok(value)
    } else {
        Err(RequestError::Option {
            name: "omega",
            value,
            must: "must be positive and finite",
        }
        .into())
    }
}

/// Everything that a system needs before it can be evaluated: parameters, frequency, levels and masses.
pub(crate) fn values(system: &dyn System, values: &[f64], frequency: f64) -> Result<(), Error> {
    omega(frequency)?;
    parameters(system.facts(), values)?;
    levels(system, values, frequency)?;
    mass(system, values, frequency)
}

/// There is a value for every parameter, finite and within its declared range.
pub(crate) fn parameters(facts: &SystemFacts, values: &[f64]) -> Result<(), Error> {
    if values.len() != facts.parameters.len() {
        return Err(RequestError::Values {
            values: values.len(),
            expected: facts.parameters.len(),
        }
        .into());
    }
    facts
        .parameters
        .iter()
        .zip(values)
        .try_for_each(|(facts, &value)| parameter(facts, value))
}

fn parameter(facts: &ParameterFacts, value: f64) -> Result<(), Error> {
    if facts.admits(value) {
        return Ok(());
    }
    Err(RequestError::Parameter {
        name: facts.name.to_string(),
        value,
        range: described(facts.minimum, facts.maximum),
    }
    .into())
}

/// A range as text.
pub(crate) fn described(minimum: Bound, maximum: Bound) -> String {
    let lower = match minimum {
        Bound::Unbounded => "(-inf".to_owned(),
        Bound::Included(bound) => format!("[{}", Decimal::plain(bound)),
        Bound::Excluded(bound) => format!("({}", Decimal::plain(bound)),
    };
    let upper = match maximum {
        Bound::Unbounded => "inf)".to_owned(),
        Bound::Included(bound) => format!("{}]", Decimal::plain(bound)),
        Bound::Excluded(bound) => format!("{})", Decimal::plain(bound)),
    };
    format!("{lower}, {upper}")
}

/// Values for a difference over a step to both sides, but where the variable may not have them.
pub(crate) fn around(facts: &SystemFacts, variable: Variable, value: f64, step: f64) -> [f64; 2] {
    let admitted = |other: f64| match variable {
        Variable::Omega => other > 0.0,
        Variable::Parameter(index) => facts.parameters[index].admits(other),
    };
    [value - step, value + step].map(|other| if admitted(other) { other } else { value })
}

/// An option is a number in its range.
pub(crate) fn option(
    name: &'static str,
    value: f64,
    range: RangeInclusive<f64>,
    must: &'static str,
) -> Result<(), Error> {
    if range.contains(&value) {
        Ok(())
    } else {
        Err(RequestError::Option { name, value, must }.into())
    }
}

/// A number is neither infinite nor NaN.
pub(crate) fn finite(name: &'static str, value: f64) -> Result<(), Error> {
    option(name, value, f64::MIN..=f64::MAX, "must be finite")
}

/// A number is more than zero.
pub(crate) fn positive(name: &'static str, value: f64) -> Result<(), Error> {
    let range = f64::MIN_POSITIVE..=f64::INFINITY;
    option(name, value, range, "must be positive")
}

/// Levels are finite and none is below the one before it.
pub(crate) fn in_order(levels: &[f64]) -> bool {
    let finite = levels.iter().all(|level| level.is_finite());
    finite && levels.windows(2).all(|pair| pair[0] <= pair[1])
}

/// The levels of every contact's law are in increasing order.
pub(crate) fn levels(system: &dyn System, parameters: &[f64], omega: f64) -> Result<(), Error> {
    let layout = Layout::of(system);
    let mut coefficients = vec![0.0; layout.coefficients];
    system.coefficients(parameters, omega, &mut coefficients);
    for contact in &layout.contacts {
        let law = system.law(contact.law);
        let mut arguments = vec![0.0; contact.argument_count];
        contact.arguments(&coefficients, &mut arguments);
        let mut levels = vec![0.0; law.facts().levels.len()];
        law.levels(&arguments, &mut levels);
        if !in_order(&levels) {
            return Err(ModelError::Levels {
                law: law.facts().name.to_string(),
                levels,
            }
            .into());
        }
    }
    Ok(())
}

/// The mass matrix can be inverted, and gives no motion a negative energy.
pub(crate) fn mass(system: &dyn System, parameters: &[f64], omega: f64) -> Result<(), Error> {
    let layout = Layout::of(system);
    let mut coefficients = vec![0.0; layout.coefficients];
    system.coefficients(parameters, omega, &mut coefficients);
    let mass = layout.mass(&coefficients);
    let determinant: f64 = mass.determinant();
    regular(&mass).map_err(|_| ModelError::SingularMass { determinant })?;
    energy_is_positive(system.facts(), &mass)
}

/// A mass that stands alone in its equation is positive, and a symmetric matrix is positive definite. Of others nothing is known: the
/// equations may be combined or in any order, as a zero on the diagonal says.
fn energy_is_positive(facts: &SystemFacts, mass: &DMatrix<f64>) -> Result<(), Error> {
    for row in mass.row_iter() {
        let mut entries = row.iter().enumerate().filter(|(_, entry)| **entry != 0.0);
        if let (Some((column, &own)), None) = (entries.next(), entries.next())
            && own < 0.0
        {
            let coordinate = facts.coordinates[column].to_string();
            return Err(ModelError::NegativeMass {
                coordinate,
                mass: own,
            }
            .into());
        }
    }
    let largest = mass.amax();
    let is_symmetric = (mass - mass.transpose()).amax() <= 1e-12 * largest;
    if is_symmetric && mass.diagonal().min() > 0.0 {
        let eigenvalue = mass.symmetric_eigenvalues().min();
        if eigenvalue < 0.0 {
            return Err(ModelError::IndefiniteMass { eigenvalue }.into());
        }
    }
    Ok(())
}

/// A pivot of a mass matrix that is smaller than this share of the largest is taken for zero.
const PIVOT: f64 = 1e-13;

/// Whether a mass matrix determines the accelerations; otherwise its smallest pivot as a share of the largest. Rows and columns are
/// taken in units of their own, since coordinates may be lengths and angles.
pub(crate) fn regular(mass: &DMatrix<f64>) -> Result<(), f64> {
    let mut scaled = mass.clone();
    for mut row in scaled.row_iter_mut() {
        let largest = row.amax();
        row /= largest;
    }
    for mut column in scaled.column_iter_mut() {
        let largest = column.amax();
        column /= largest;
    }
    let pivots = scaled.lu().u().diagonal().abs();
    let share = pivots.min() / pivots.max();
    if share > PIVOT {
        Ok(())
    } else {
        // A row of zeros has the largest entry zero.
        Err(if share.is_nan() { 0.0 } else { share })
    }
}
