//! Structures given as matrices, with few contacts: finite-element models, modal models, test rigs.

use std::collections::HashMap;
use std::fmt;
use std::sync::Arc;

pub use nalgebra::DMatrix;

use crate::law::Law;
use crate::system::{
    Bound, ContactFacts, ParameterFacts, Part, Place, System, SystemFacts, Variable, Wave,
};

/// A pivot of the mass matrix that is smaller than this share of the largest is taken for zero.
const PIVOT: f64 = 1e-13;

/// A linear structure with contacts, built at run time: equation (1) with constant `M`, `C`, `K` and directions.
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
pub struct Structure {
    facts: SystemFacts,
    values: Vec<f64>,
    coefficients: Vec<Coefficient>,
    laws: Vec<Arc<dyn Law>>,
}

/// A structure being described; nothing is checked before [`Builder::build`].
pub struct Builder {
    name: String,
    matrices: [DMatrix<f64>; 3],
    loads: Vec<(usize, Wave, Value)>,
    contacts: Vec<Contact>,
}

/// A law at work in a structure.
///
/// The gap is `direction . q - offset`, and the force acts along the same direction unless another is given.
pub struct Contact {
    law: Arc<dyn Law>,
    arguments: Vec<Value>,
    gap: Vec<f64>,
    force: Option<Vec<f64>>,
    offset: Value,
}

/// A number, or a named parameter that a continuation may vary.
#[derive(Debug, Clone, PartialEq)]
pub struct Value {
    factor: f64,
    parameter: Option<(String, f64)>,
}

/// A named parameter and its present value. One name stands for one parameter wherever it is used.
pub fn parameter(name: &str, value: f64) -> Value {
    Value {
        factor: 1.0,
        parameter: Some((name.to_owned(), value)),
    }
}

impl From<f64> for Value {
    fn from(number: f64) -> Self {
        Self {
            factor: number,
            parameter: None,
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
}

/// A coefficient of (1) or (2): a number, or a number times a parameter.
#[derive(Clone, Copy)]
struct Coefficient {
    factor: f64,
    parameter: Option<usize>,
}

/// What is wrong with a structure.
#[derive(Debug, Clone, PartialEq)]
pub enum StructureError {
    /// A matrix is not as many rows and columns as the structure has coordinates.
    MatrixSize {
        /// Which one.
        matrix: &'static str,
        /// Its rows.
        rows: usize,
        /// Its columns.
        columns: usize,
        /// Rows of the mass matrix.
        coordinates: usize,
    },
    /// A direction of a contact has not as many entries as there are coordinates.
    DirectionSize {
        /// Which contact.
        contact: usize,
        /// How many entries.
        entries: usize,
        /// How many there must be.
        coordinates: usize,
    },
    /// A number is infinite or not a number.
    NotFinite {
        /// Where it stands.
        place: String,
        /// The number.
        value: f64,
    },
    /// The mass matrix has no inverse.
    SingularMass {
        /// Smallest pivot, as a share of the largest.
        pivot: f64,
    },
    /// A load acts on a coordinate that is not there.
    NoCoordinate {
        /// The coordinate asked for, from zero.
        coordinate: usize,
        /// How many there are.
        coordinates: usize,
    },
    /// A law has another number of arguments.
    Arguments {
        /// Its name.
        law: String,
        /// How many it has.
        expected: usize,
        /// How many were given.
        given: usize,
    },
    /// One name was used with two values.
    TwoValues {
        /// The name.
        parameter: String,
        /// Its first value.
        first: f64,
        /// Another.
        second: f64,
    },
    /// A parameter was to be set that the structure does not have.
    UnknownParameter {
        /// The name asked for.
        name: String,
    },
}

impl Contact {
    /// A contact that follows a law.
    pub fn new(law: impl Law + 'static) -> Self {
        Self {
            law: Arc::new(law),
            arguments: Vec::new(),
            gap: Vec::new(),
            force: None,
            offset: 0.0.into(),
        }
    }

    /// The arguments of the law, in its order.
    #[must_use]
    pub fn arguments(mut self, arguments: impl IntoIterator<Item = impl Into<Value>>) -> Self {
        self.arguments = arguments.into_iter().map(Into::into).collect();
        self
    }

    /// The direction of gap and force, one entry per coordinate.
    #[must_use]
    pub fn direction(mut self, direction: impl Into<Vec<f64>>) -> Self {
        self.gap = direction.into();
        self
    }

    /// A direction of the force that differs from that of the gap.
    #[must_use]
    pub fn force_direction(mut self, direction: impl Into<Vec<f64>>) -> Self {
        self.force = Some(direction.into());
        self
    }

    /// What is subtracted from `direction . q`.
    #[must_use]
    pub fn offset(mut self, offset: impl Into<Value>) -> Self {
        self.offset = offset.into();
        self
    }
}

impl Structure {
    /// Begins a structure of given mass, damping and stiffness.
    pub fn of(mass: &DMatrix<f64>, damping: &DMatrix<f64>, stiffness: &DMatrix<f64>) -> Builder {
        Builder {
            name: "structure".to_owned(),
            matrices: [mass.clone(), damping.clone(), stiffness.clone()],
            loads: Vec::new(),
            contacts: Vec::new(),
        }
    }

    /// Sets a parameter.
    ///
    /// # Errors
    /// If there is no parameter of that name.
    pub fn set(&mut self, name: &str, value: f64) -> Result<(), StructureError> {
        let mut parameters = self.facts.parameters.iter();
        let position = parameters.position(|parameter| parameter.name == name);
        let index = position.ok_or_else(|| StructureError::UnknownParameter {
            name: name.to_owned(),
        })?;
        self.values[index] = value;
        Ok(())
    }
}

impl Builder {
    /// A name, for reports and pictures.
    #[must_use]
    pub fn name(mut self, name: &str) -> Self {
        name.clone_into(&mut self.name);
        self
    }

    /// A load that does not change with time, on one coordinate.
    #[must_use]
    pub fn constant(self, coordinate: usize, load: impl Into<Value>) -> Self {
        self.load(coordinate, Wave::CONSTANT, load)
    }

    /// A load `amplitude * cos(harmonic * omega * t)` on one coordinate.
    #[must_use]
    pub fn cosine(self, coordinate: usize, harmonic: u32, amplitude: impl Into<Value>) -> Self {
        let part = Part::Cosine;
        self.load(coordinate, Wave { harmonic, part }, amplitude)
    }

    /// A load `amplitude * sin(harmonic * omega * t)` on one coordinate; `harmonic` zero is no load.
    #[must_use]
    pub fn sine(self, coordinate: usize, harmonic: u32, amplitude: impl Into<Value>) -> Self {
        let part = Part::Sine;
        if harmonic == 0 {
            return self;
        }
        self.load(coordinate, Wave { harmonic, part }, amplitude)
    }

    fn load(mut self, coordinate: usize, wave: Wave, value: impl Into<Value>) -> Self {
        self.loads.push((coordinate, wave, value.into()));
        self
    }

    /// A contact.
    #[must_use]
    pub fn contact(mut self, contact: Contact) -> Self {
        self.contacts.push(contact);
        self
    }

    /// Checks the description and makes a system of it.
    ///
    /// # Errors
    /// The first thing that is wrong, with its numbers.
    pub fn build(self) -> Result<Structure, StructureError> {
        let coordinates = self.matrices[0].nrows();
        let mut assembly = Assembly::default();
        self.assemble_matrices(&mut assembly)?;
        regular(&self.matrices[0])?;
        for &(row, wave, ref value) in &self.loads {
            if row >= coordinates {
                return Err(StructureError::NoCoordinate {
                    coordinate: row,
                    coordinates,
                });
            }
            assembly.add(Place::Load { row, wave }, value)?;
        }
        for (index, contact) in self.contacts.iter().enumerate() {
            assembly.contact(index, contact, coordinates)?;
        }
        let contacts = (0..self.contacts.len()).map(|law| ContactFacts { law });
        let names = (1..=coordinates).map(|number| format!("q{number}").into());
        Ok(Structure {
            facts: SystemFacts {
                name: self.name.into(),
                equation: "M ddot(q) + C dot(q) + K q + contacts = loads".into(),
                coordinates: names.collect(),
                parameters: assembly.parameters.into(),
                divisor: 1,
                laws: self.contacts.len(),
                contacts: contacts.collect(),
                places: assembly.places.into(),
            },
            values: assembly.values,
            coefficients: assembly.coefficients,
            laws: self
                .contacts
                .into_iter()
                .map(|contact| contact.law)
                .collect(),
        })
    }

    fn assemble_matrices(&self, assembly: &mut Assembly) -> Result<(), StructureError> {
        let coordinates = self.matrices[0].nrows();
        for (matrix, name) in self.matrices.iter().zip(["mass", "damping", "stiffness"]) {
            let (rows, columns) = matrix.shape();
            if rows != coordinates || columns != coordinates || coordinates == 0 {
                return Err(StructureError::MatrixSize {
                    matrix: name,
                    rows,
                    columns,
                    coordinates,
                });
            }
            for row in 0..rows {
                for column in 0..columns {
                    let place = match name {
                        "mass" => Place::Mass { row, column },
                        "damping" => Place::Damping { row, column },
                        _ => Place::Stiffness {
                            row,
                            column,
                            wave: Wave::CONSTANT,
                        },
                    };
                    assembly.add(place, &matrix[(row, column)].into())?;
                }
            }
        }
        Ok(())
    }
}

/// A mass matrix determines the accelerations.
fn regular(mass: &DMatrix<f64>) -> Result<(), StructureError> {
    let upper = mass.clone().lu().u();
    let pivots = upper.diagonal().abs();
    let pivot = pivots.min() / pivots.max();
    // A matrix of zeros has the share 0/0.
    if pivot > PIVOT {
        Ok(())
    } else {
        let pivot = if pivot.is_nan() { 0.0 } else { pivot };
        Err(StructureError::SingularMass { pivot })
    }
}

/// Coefficients and parameters as they are gathered.
#[derive(Default)]
struct Assembly {
    places: Vec<Place>,
    coefficients: Vec<Coefficient>,
    parameters: Vec<ParameterFacts>,
    values: Vec<f64>,
    known: HashMap<String, usize>,
}

impl Assembly {
    /// Adds a coefficient, unless it is zero.
    fn add(&mut self, place: Place, value: &Value) -> Result<(), StructureError> {
        let not_finite = |value: f64| StructureError::NotFinite {
            place: format!("{place:?}"),
            value,
        };
        if !value.factor.is_finite() {
            return Err(not_finite(value.factor));
        }
        let parameter = match &value.parameter {
            None if value.factor == 0.0 => return Ok(()),
            None => None,
            Some((_, present)) if !present.is_finite() => return Err(not_finite(*present)),
            Some((name, present)) => Some(self.parameter(name, *present)?),
        };
        self.places.push(place);
        self.coefficients.push(Coefficient {
            factor: value.factor,
            parameter,
        });
        Ok(())
    }

    /// The position of a parameter, which is new or has the same value as before.
    fn parameter(&mut self, name: &str, value: f64) -> Result<usize, StructureError> {
        if let Some(&index) = self.known.get(name) {
            let first = self.values[index];
            if first == value {
                return Ok(index);
            }
            return Err(StructureError::TwoValues {
                parameter: name.to_owned(),
                first,
                second: value,
            });
        }
        let index = self.values.len();
        self.known.insert(name.to_owned(), index);
        self.values.push(value);
        self.parameters.push(ParameterFacts {
            name: name.to_owned().into(),
            documentation: "".into(),
            minimum: Bound::Unbounded,
            maximum: Bound::Unbounded,
        });
        Ok(index)
    }

    fn contact(
        &mut self,
        index: usize,
        contact: &Contact,
        coordinates: usize,
    ) -> Result<(), StructureError> {
        let law = contact.law.facts();
        if law.arguments.len() != contact.arguments.len() {
            return Err(StructureError::Arguments {
                law: law.name.to_string(),
                expected: law.arguments.len(),
                given: contact.arguments.len(),
            });
        }
        let force = contact.force.as_ref().unwrap_or(&contact.gap);
        for direction in [&contact.gap, force] {
            if direction.len() != coordinates {
                return Err(StructureError::DirectionSize {
                    contact: index,
                    entries: direction.len(),
                    coordinates,
                });
            }
        }
        let wave = Wave::CONSTANT;
        for (row, (&force, &gap)) in force.iter().zip(&contact.gap).enumerate() {
            let along = Place::ForceDirection {
                contact: index,
                row,
                wave,
            };
            self.add(along, &force.into())?;
            let across = Place::GapDirection {
                contact: index,
                column: row,
                wave,
            };
            self.add(across, &gap.into())?;
        }
        let offset = Place::Offset {
            contact: index,
            wave,
        };
        self.add(offset, &contact.offset)?;
        for (argument, value) in contact.arguments.iter().enumerate() {
            let place = Place::Argument {
                contact: index,
                index: argument,
            };
            self.add(place, value)?;
        }
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

    fn coefficients(&self, parameters: &[f64], _omega: f64, coefficients: &mut [f64]) {
        for (out, coefficient) in coefficients.iter_mut().zip(&self.coefficients) {
            let parameter = coefficient.parameter.map_or(1.0, |index| parameters[index]);
            *out = coefficient.factor * parameter;
        }
    }

    fn coefficients_by(
        &self,
        variable: Variable,
        _parameters: &[f64],
        _omega: f64,
        derivatives: &mut [f64],
    ) {
        for (out, coefficient) in derivatives.iter_mut().zip(&self.coefficients) {
            let depends = match (variable, coefficient.parameter) {
                (Variable::Parameter(by), Some(parameter)) => by == parameter,
                _ => false,
            };
            *out = if depends { coefficient.factor } else { 0.0 };
        }
    }

    fn law(&self, index: usize) -> &dyn Law {
        self.laws[index].as_ref()
    }
}

impl fmt::Display for StructureError {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::MatrixSize {
                matrix,
                rows,
                columns,
                coordinates,
            } => write!(
                formatter,
                "the {matrix} matrix is {rows} by {columns}; the mass matrix has {coordinates} rows, and all must be square, of one size, and not empty"
            ),
            Self::DirectionSize {
                contact,
                entries,
                coordinates,
            } => write!(
                formatter,
                "a direction of contact {contact} has {entries} entries; there are {coordinates} coordinates"
            ),
            Self::NotFinite { place, value } => write!(formatter, "{value} in {place}"),
            Self::SingularMass { pivot } => write!(
                formatter,
                "the mass matrix has no inverse: its smallest pivot is {pivot:e} of the largest"
            ),
            Self::NoCoordinate {
                coordinate,
                coordinates,
            } => write!(
                formatter,
                "a load on coordinate {coordinate}, counted from zero; there are {coordinates}"
            ),
            Self::Arguments {
                law,
                expected,
                given,
            } => write!(
                formatter,
                "law `{law}` has {expected} arguments, and {given} were given"
            ),
            Self::TwoValues {
                parameter,
                first,
                second,
            } => write!(
                formatter,
                "parameter `{parameter}` is {first} in one place and {second} in another"
            ),
            Self::UnknownParameter { name } => {
                write!(formatter, "the structure has no parameter `{name}`")
            }
        }
    }
}

impl std::error::Error for StructureError {}
