//! A structure being described.

use super::assembly::Assembly;
use super::contact::common;
use super::{Contact, DMatrix, Structure, StructureError, Value};
use crate::error::Error;
use crate::model::validate;
use crate::system::{
    ContactFacts, OutputFacts, ParameterFacts, Part, Place, Signal, SystemFacts, Wave,
};

/// Directions have a common period of so many of the excitation at most.
const MOST_TURNS: u32 = 1000;

/// A structure being described; nothing is checked before [`Builder::build`].
#[derive(Debug)]
pub struct Builder {
    pub(super) name: String,
    pub(super) matrices: [DMatrix<f64>; 3],
    /// Damping matrices, each with what it is multiplied by.
    pub(super) further: Vec<(DMatrix<f64>, Value)>,
    pub(super) coordinates: Vec<String>,
    pub(super) parameters: Vec<ParameterFacts>,
    pub(super) loads: Vec<(usize, Wave, Value)>,
    pub(super) contacts: Vec<Contact>,
    pub(super) outputs: Vec<(OutputFacts, Reading)>,
}

/// What an output of a structure is equal to.
#[derive(Debug, Clone)]
pub(super) enum Reading {
    /// A sum of coordinates, rates or accelerations, one factor for each coordinate.
    Along(fn(usize) -> Signal, Vec<f64>),
    /// The force of a contact.
    Force(usize),
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

    /// An output: the sum of the coordinates, each with its factor.
    #[must_use]
    pub fn output(self, name: &str, factors: impl Into<Vec<f64>>) -> Self {
        self.read(name, Reading::Along(Signal::Coordinate, factors.into()))
    }

    /// An output: the sum of the rates of the coordinates, each with its factor.
    ///
    /// ```
    /// use hertzian::FrequencyResponse;
    /// use hertzian::structure::{DMatrix, Structure};
    ///
    /// // x'' + 0.2 x' + x = 0.3 cos(t): at its resonance the rate has the amplitude 0.3/0.2.
    /// let one = DMatrix::identity(1, 1);
    /// let mass = Structure::of(&one, &(0.2 * &one), &one)
    ///     .cosine(0, 1, 0.3)
    ///     .rate_output("speed", [1.0])
    ///     .unit("m/s")
    ///     .about("speed of the mass")
    ///     .build()?;
    /// let request = FrequencyResponse::of(&mass);
    /// let orbit = request.orbit(1.0)?;
    /// let speed = request.measured(&"speed:h1".parse()?, &orbit)?;
    /// assert!((speed.unwrap() - 1.5).abs() < 1e-9);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    #[must_use]
    pub fn rate_output(self, name: &str, factors: impl Into<Vec<f64>>) -> Self {
        self.read(name, Reading::Along(Signal::Rate, factors.into()))
    }

    /// An output: the sum of the accelerations of the coordinates, each with its factor. They are what the equations of motion give, and
    /// jump where the force of a contact does.
    #[must_use]
    pub fn acceleration_output(self, name: &str, factors: impl Into<Vec<f64>>) -> Self {
        self.read(name, Reading::Along(Signal::Acceleration, factors.into()))
    }

    fn read(mut self, name: &str, reading: Reading) -> Self {
        self.outputs
            .push((OutputFacts::new(name.to_owned()), reading));
        self
    }

    /// The unit of the output that was added last, for reports and pictures.
    #[must_use]
    pub fn unit(mut self, unit: &str) -> Self {
        if let Some((facts, _)) = self.outputs.last_mut() {
            facts.unit = unit.to_owned().into();
        }
        self
    }

    /// What the output that was added last is; the first line is what charts say of it.
    #[must_use]
    pub fn about(mut self, documentation: &str) -> Self {
        if let Some((facts, _)) = self.outputs.last_mut() {
            facts.documentation = documentation.to_owned().into();
        }
        self
    }

    /// Names of the coordinates, which are `q1`, `q2`, .. otherwise. One that is left out keeps that name.
    #[must_use]
    pub fn coordinates(mut self, names: impl IntoIterator<Item = impl Into<String>>) -> Self {
        self.coordinates = names.into_iter().map(Into::into).collect();
        self
    }

    /// What is known of a parameter: its documentation, its unit, and a range that its values must be in besides those of the
    /// arguments that it is passed for.
    #[must_use]
    pub fn parameter(mut self, facts: ParameterFacts) -> Self {
        self.parameters.push(facts);
        self
    }

    /// A further damping matrix, multiplied by a parameter or by a power of the frequency, as a gyroscopic matrix by the speed of
    /// rotation.
    ///
    /// ```
    /// use hertzian::structure::{Builder, DMatrix, Structure, Value};
    ///
    /// // A disc that turns with the frequency of the excitation: its tilts about two axes are coupled.
    /// let (one, none) = (DMatrix::identity(2, 2), DMatrix::zeros(2, 2));
    /// let gyroscopic = DMatrix::from_row_slice(2, 2, &[0.0, 0.5, -0.5, 0.0]);
    /// let disc: Builder = Structure::of(&one, &none, &one);
    /// let disc = disc.damping(&gyroscopic, Value::from(1.0).times_omega(1)).build()?;
    /// # Ok::<(), hertzian::Error>(())
    /// ```
    #[must_use]
    pub fn damping(mut self, matrix: &DMatrix<f64>, times: impl Into<Value>) -> Self {
        self.further.push((matrix.clone(), times.into()));
        self
    }

    /// An output: the force of a contact, counted from zero in the order in which they were added.
    #[must_use]
    pub fn force_output(self, name: &str, contact: usize) -> Self {
        self.read(name, Reading::Force(contact))
    }

    /// Checks the description and makes a system of it.
    ///
    /// # Errors
    /// The first thing that is wrong, with its numbers.
    pub fn build(self) -> Result<Structure, Error> {
        let coordinates = self.matrices[0].nrows();
        let mut assembly = Assembly::default();
        self.assemble_matrices(&mut assembly)?;
        validate::regular(&self.matrices[0])
            .map_err(|pivot| StructureError::SingularMass { pivot })?;
        let divisor = self.divisor()?;
        for &(row, wave, ref value) in &self.loads {
            if row >= coordinates {
                return Err(StructureError::NoCoordinate {
                    coordinate: row,
                    coordinates,
                }
                .into());
            }
            let harmonic = wave.harmonic.saturating_mul(divisor);
            let wave = Wave { harmonic, ..wave };
            assembly.add(Place::Load { row, wave }, value)?;
        }
        for (index, contact) in self.contacts.iter().enumerate() {
            assembly.contact(index, contact, coordinates, divisor)?;
        }
        self.assemble_outputs(&mut assembly)?;
        for known in &self.parameters {
            assembly.know(known);
        }
        let contacts = self.contacts.iter().enumerate();
        let contacts = contacts
            .map(|(index, contact)| ContactFacts::new(index).unit(contact.unit.clone()))
            .collect::<Vec<_>>();
        let outputs = self.outputs.iter().map(|(facts, _)| facts.clone());
        let names: Vec<String> = self.coordinate_names().collect();
        let facts = SystemFacts::new(self.name)
            .equation("M ddot(q) + C dot(q) + K q + contacts = loads")
            .coordinates(names)
            .parameters(assembly.parameters)
            .divisor(divisor)
            .contacts(self.contacts.len(), contacts)
            .places(assembly.places)
            .outputs(outputs);
        Ok(Structure {
            facts,
            values: assembly.values,
            coefficients: assembly.coefficients,
            laws: self
                .contacts
                .into_iter()
                .map(|contact| contact.law)
                .collect(),
        })
    }

    /// By what the frequency of the excitation is divided, so that all that turns has whole harmonics.
    fn divisor(&self) -> Result<u32, StructureError> {
        let mut divisor = 1_u32;
        for (contact, of) in self.contacts.iter().enumerate() {
            let Some((_, turn)) = &of.turning else {
                continue;
            };
            let [numerator, denominator] = turn.fraction();
            let least = turn.lowest();
            let next = u64::from(divisor / common(divisor, least)) * u64::from(least);
            let fits = denominator > 0 && turn.angle().is_finite() && numerator <= MOST_TURNS;
            divisor = u32::try_from(next)
                .ok()
                .filter(|next| fits && *next <= MOST_TURNS)
                .ok_or(StructureError::Turn {
                    contact,
                    numerator,
                    denominator,
                    most: MOST_TURNS,
                })?;
        }
        Ok(divisor)
    }

    fn assemble_outputs(&self, assembly: &mut Assembly) -> Result<(), StructureError> {
        let coordinates = self.matrices[0].nrows();
        for (output, (facts, reading)) in self.outputs.iter().enumerate() {
            let name = &facts.name;
            self.output_has_a_name(output, name, assembly)?;
            let wave = Wave::CONSTANT;
            match reading {
                Reading::Along(signal, factors) if factors.len() == coordinates => {
                    for (index, &factor) in factors.iter().enumerate() {
                        let of = signal(index);
                        assembly.add(Place::Output { output, of, wave }, &factor.into())?;
                    }
                }
                Reading::Along(_, factors) => {
                    return Err(StructureError::OutputSize {
                        output: name.to_string(),
                        entries: factors.len(),
                        coordinates,
                    });
                }
                Reading::Force(contact) if *contact < self.contacts.len() => {
                    let of = Signal::Force(*contact);
                    assembly.add(Place::Output { output, of, wave }, &1.0.into())?;
                }
                Reading::Force(contact) => {
                    return Err(StructureError::NoContact {
                        output: name.to_string(),
                        contact: *contact,
                        contacts: self.contacts.len(),
                    });
                }
            }
        }
        Ok(())
    }

    /// An output has a name that nothing else has.
    fn output_has_a_name(
        &self,
        output: usize,
        name: &str,
        assembly: &Assembly,
    ) -> Result<(), StructureError> {
        let is_taken = self.outputs[..output]
            .iter()
            .any(|(known, _)| known.name == name)
            || self.coordinate_names().any(|known| known == name)
            || assembly.parameters.iter().any(|known| known.name == name);
        if name.is_empty() || name == "omega" || is_taken {
            return Err(StructureError::OutputName {
                output: name.to_owned(),
            });
        }
        Ok(())
    }

    fn coordinate_names(&self) -> impl Iterator<Item = String> {
        let name = |index: usize| {
            let given = self.coordinates.get(index).cloned();
            given.unwrap_or_else(|| format!("q{}", index + 1))
        };
        (0..self.matrices[0].nrows()).map(name)
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
        for (matrix, times) in &self.further {
            let (rows, columns) = matrix.shape();
            if rows != coordinates || columns != coordinates {
                return Err(StructureError::MatrixSize {
                    matrix: "further damping",
                    rows,
                    columns,
                    coordinates,
                });
            }
            for column in 0..columns {
                for row in (0..rows).filter(|row| matrix[(*row, column)] != 0.0) {
                    let value = times.clone().times(matrix[(row, column)]);
                    assembly.add(Place::Damping { row, column }, &value)?;
                }
            }
        }
        Ok(())
    }
}
