//! Structures given as matrices, with few contacts: finite-element models, modal models, test rigs.

mod assembly;
mod builder;
mod contact;
mod error;

use std::sync::Arc;

#[doc(no_inline)]
pub use nalgebra::DMatrix;

pub use self::builder::Builder;
pub use self::contact::{Contact, Turn};
pub(crate) use self::error::StructureError;

use crate::error::Error;
use crate::law::Law;
use crate::model::validate;
use crate::system::{System, SystemFacts, Variable};

/// A linear structure with contacts, built at run time: equation (1) with constant `M`, `C`, `K`, and directions that are
/// constant or turn.
///
/// Two masses, of which the first meets an elastic stop:
///
/// ```
/// use hertzian::FrequencyResponse;
/// use hertzian::structure::{Contact, DMatrix, Structure, parameter};
///
/// hertzian::law! {
///     /// Force of a spring that is touched at gap zero.
///     Spring(gap, k) { gap > 0 => k*gap, else => 0 }
/// }
///
/// let stiffness = DMatrix::from_row_slice(2, 2, &[1.0, -1.0, -1.0, 2.0]);
/// let structure = Structure::of(&DMatrix::identity(2, 2), &(0.03 * &stiffness), &stiffness)
///     .cosine(1, 1, parameter("drive", 0.1))
///     .contact(Contact::new(Spring).arguments([100.0]).direction([1.0, 0.0]).offset(1.0))
///     .build()?;
/// let branch = FrequencyResponse::of(&structure).from(0.8).to(0.9).harmonics(7).samples(64).run()?;
/// assert!(branch.points.len() > 2);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Debug, Clone)]
pub struct Structure {
    facts: SystemFacts,
    values: Vec<f64>,
    coefficients: Vec<Coefficient>,
    laws: Vec<Arc<dyn Law>>,
}

/// A number, or a named parameter that a continuation may vary.
#[derive(Debug, Clone, PartialEq)]
pub struct Value {
    factor: f64,
    parameter: Option<(String, f64)>,
    /// By which power of the frequency it is multiplied.
    power: u8,
}

/// The matrix of a structure with so many coordinates, from the square matrices of its elements, each of which stands at the coordinates
/// from one on. What would stand beyond the last coordinate is left out, as the node of an element that is clamped.
///
/// ```
/// use hertzian::structure::{DMatrix, assemble};
///
/// // Three springs in a row between three masses and a wall.
/// let spring = DMatrix::from_row_slice(2, 2, &[1.0, -1.0, -1.0, 1.0]);
/// let stiffness = assemble(3, (0..3).map(|first| (first, &spring)));
/// let expected = [1.0, -1.0, 0.0, -1.0, 2.0, -1.0, 0.0, -1.0, 2.0];
/// assert_eq!(stiffness, DMatrix::from_row_slice(3, 3, &expected));
/// ```
pub fn assemble<'m>(
    coordinates: usize,
    elements: impl IntoIterator<Item = (usize, &'m DMatrix<f64>)>,
) -> DMatrix<f64> {
    let mut whole = DMatrix::zeros(coordinates, coordinates);
    for (first, element) in elements {
        let size = element.nrows().min(element.ncols());
        let held = size.min(coordinates.saturating_sub(first));
        for row in 0..held {
            for column in 0..held {
                whole[(first + row, first + column)] += element[(row, column)];
            }
        }
    }
    whole
}

/// A named parameter and its present value. One name stands for one parameter wherever it is used.
pub fn parameter(name: &str, value: f64) -> Value {
    Value {
        factor: 1.0,
        parameter: Some((name.to_owned(), value)),
        power: 0,
    }
}

impl From<f64> for Value {
    fn from(number: f64) -> Self {
        Self {
            factor: number,
            parameter: None,
            power: 0,
        }
    }
}

impl Value {
    /// The same multiplied by a number.
    #[must_use]
    pub fn times(mut self, factor: f64) -> Self {
        self.factor *= factor;
        self
    }

    /// The same multiplied by a power of the frequency `omega` of the excitation: 2 for the force of an unbalance, whose parameter is mass
    /// times eccentricity.
    #[must_use]
    pub fn times_omega(mut self, power: u8) -> Self {
        self.power = self.power.saturating_add(power);
        self
    }

    /// The parameter that it is proportional to, if there is one.
    pub fn name(&self) -> Option<&str> {
        self.parameter.as_ref().map(|(name, _)| name.as_str())
    }

    /// Its number at a frequency, where parameters that are known have their values and others the one that was given.
    pub fn at(&self, known: impl Fn(&str) -> Option<f64>, omega: f64) -> f64 {
        let given = self.parameter.as_ref();
        let parameter = given.map_or(1.0, |(name, value)| known(name).unwrap_or(*value));
        self.factor * parameter * omega.powi(i32::from(self.power))
    }
}

/// A coefficient of (1) or (2): a number, times a parameter, times a power of the frequency.
#[derive(Debug, Clone, Copy)]
struct Coefficient {
    factor: f64,
    parameter: Option<usize>,
    power: u8,
}

impl Structure {
    /// Begins a structure of given mass, damping and stiffness.
    pub fn of(mass: &DMatrix<f64>, damping: &DMatrix<f64>, stiffness: &DMatrix<f64>) -> Builder {
        Builder {
            name: "structure".to_owned(),
            matrices: [mass.clone(), damping.clone(), stiffness.clone()],
            further: Vec::new(),
            coordinates: Vec::new(),
            parameters: Vec::new(),
            loads: Vec::new(),
            contacts: Vec::new(),
            outputs: Vec::new(),
        }
    }

    /// Sets a parameter. Whether the value is in the range of the arguments it is passed for is checked when a run
    /// starts, as for any system.
    ///
    /// # Errors
    /// If there is no parameter of that name.
    pub fn set(&mut self, name: &str, value: f64) -> Result<(), Error> {
        let mut parameters = self.facts.parameters.iter();
        let position = parameters.position(|parameter| parameter.name == name);
        let index = position.ok_or_else(|| validate::unknown(&self.facts, name))?;
        self.values[index] = value;
        Ok(())
    }
}

impl System for Structure {
    fn facts(&self) -> &SystemFacts {
        &self.facts
    }

    fn values(&self, values: &mut [f64]) {
        values.copy_from_slice(&self.values);
    }

    fn coefficients(&self, parameters: &[f64], omega: f64, coefficients: &mut [f64]) {
        for (out, coefficient) in coefficients.iter_mut().zip(&self.coefficients) {
            let parameter = coefficient.parameter.map_or(1.0, |index| parameters[index]);
            *out = coefficient.factor * parameter * omega.powi(i32::from(coefficient.power));
        }
    }

    fn coefficients_by(
        &self,
        variable: Variable,
        parameters: &[f64],
        omega: f64,
        derivatives: &mut [f64],
    ) {
        for (out, coefficient) in derivatives.iter_mut().zip(&self.coefficients) {
            let power = i32::from(coefficient.power);
            *out = match (variable, coefficient.parameter) {
                (Variable::Parameter(by), Some(parameter)) if by == parameter => {
                    coefficient.factor * omega.powi(power)
                }
                (Variable::Omega, parameter) if power > 0 => {
                    let parameter = parameter.map_or(1.0, |index| parameters[index]);
                    let slope = f64::from(coefficient.power) * omega.powi(power - 1);
                    coefficient.factor * parameter * slope
                }
                _ => 0.0,
            };
        }
    }

    fn law(&self, index: usize) -> &dyn Law {
        self.laws[index].as_ref()
    }

    fn shared(&self) -> Arc<dyn System> {
        Arc::new(self.clone())
    }
}
