//! A structure being described.

use super::assembly::Assembly;
use super::{Contact, DMatrix, Structure, StructureError, Value};
use crate::model::validate;
use crate::system::{ContactFacts, OutputFacts, Part, Place, Signal, SystemFacts, Wave};

/// A structure being described; nothing is checked before [`Builder::build`].
#[derive(Debug)]
pub struct Builder {
    pub(super) name: String,
    pub(super) matrices: [DMatrix<f64>; 3],
    pub(super) loads: Vec<(usize, Wave, Value)>,
    pub(super) contacts: Vec<Contact>,
    pub(super) outputs: Vec<(String, Reading)>,
}

/// What an output of a structure is equal to.
#[derive(Debug, Clone)]
pub(super) enum Reading {
    /// A sum of coordinates, one factor for each.
    Positions(Vec<f64>),
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
    pub fn output(mut self, name: &str, factors: impl Into<Vec<f64>>) -> Self {
        let reading = Reading::Positions(factors.into());
        self.outputs.push((name.to_owned(), reading));
        self
    }

    /// An output: the force of a contact, counted from zero in the order in which they were added.
    #[must_use]
    pub fn force_output(mut self, name: &str, contact: usize) -> Self {
        self.outputs
            .push((name.to_owned(), Reading::Force(contact)));
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
        validate::regular(&self.matrices[0])
            .map_err(|pivot| StructureError::SingularMass { pivot })?;
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
        self.assemble_outputs(&mut assembly)?;
        let contacts = (0..self.contacts.len()).map(ContactFacts::new);
        let outputs = self.outputs.iter();
        let outputs = outputs.map(|(name, _)| OutputFacts::new(name.clone()));
        let facts = SystemFacts::new(self.name)
            .equation("M ddot(q) + C dot(q) + K q + contacts = loads")
            .coordinates((1..=coordinates).map(|number| format!("q{number}")))
            .parameters(assembly.parameters)
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

    fn assemble_outputs(&self, assembly: &mut Assembly) -> Result<(), StructureError> {
        let coordinates = self.matrices[0].nrows();
        for (output, (name, reading)) in self.outputs.iter().enumerate() {
            self.output_has_a_name(output, name, assembly)?;
            let wave = Wave::CONSTANT;
            match reading {
                Reading::Positions(factors) if factors.len() == coordinates => {
                    for (index, &factor) in factors.iter().enumerate() {
                        let of = Signal::Coordinate(index);
                        assembly.add(Place::Output { output, of, wave }, &factor.into())?;
                    }
                }
                Reading::Positions(factors) => {
                    return Err(StructureError::OutputSize {
                        output: name.clone(),
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
                        output: name.clone(),
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
        let coordinates = 1..=self.matrices[0].nrows();
        let is_taken = self.outputs[..output]
            .iter()
            .any(|(known, _)| known == name)
            || coordinates
                .into_iter()
                .any(|number| name == format!("q{number}"))
            || assembly.parameters.iter().any(|known| known.name == name);
        if name.is_empty() || name == "omega" || is_taken {
            return Err(StructureError::OutputName {
                output: name.to_owned(),
            });
        }
        Ok(())
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
