//! Whether what a structure is made of fits together.

use super::damping::{Damping, Ratios};
use super::direction::Direction;
use super::structure::SparseStructure;
use crate::error::StructureError;
use crate::matrix::SparseMatrix;

/// What differs from symmetry by more than this part of the largest entry is no rounding.
const ROUNDING: f64 = 1e-9;

impl SparseStructure {
    /// Whether matrices fit each other, are symmetric as they must be, and directions stand at coordinates that there are.
    ///
    /// # Errors
    /// The first thing that is wrong, with its numbers.
    pub fn check(&self) -> Result<(), StructureError> {
        let coordinates = self.coordinates();
        if coordinates == 0 {
            return Err(StructureError::Empty);
        }
        self.sized("mass", &self.mass)?;
        self.sized("stiffness", &self.stiffness)?;
        symmetric("mass", &self.mass, 1.0)?;
        symmetric("stiffness", &self.stiffness, 1.0)?;
        for coordinate in 0..coordinates {
            let mass = self.mass.get(coordinate, coordinate);
            if mass < 0.0 {
                return Err(StructureError::NegativeMass { coordinate, mass });
            }
        }
        self.check_damping()?;
        for gyroscopic in &self.gyroscopic {
            self.sized("gyroscopic", &gyroscopic.matrix)?;
            symmetric("gyroscopic", &gyroscopic.matrix, -1.0)?;
        }
        for (index, load) in self.loads.iter().enumerate() {
            self.directed(&load.direction, || format!("load {index}"))?;
            if !load.phase.is_finite() {
                return Err(StructureError::NotFinite {
                    what: format!("the phase of load {index}"),
                    value: load.phase,
                });
            }
        }
        for contact in &self.contacts {
            let of = || format!("contact `{}`", contact.name);
            self.directed(&contact.gap, of)?;
            self.directed(contact.second(), of)?;
            if contact.turning.is_some() && contact.force.is_some() {
                return Err(StructureError::TurningForce { what: of() });
            }
        }
        for output in &self.outputs {
            self.directed(&output.direction, || format!("output `{}`", output.name))?;
        }
        Ok(())
    }

    fn sized(&self, name: &'static str, matrix: &SparseMatrix) -> Result<(), StructureError> {
        let (rows, columns) = (matrix.rows(), matrix.columns());
        let coordinates = self.coordinates();
        if rows == coordinates && columns == coordinates {
            return Ok(());
        }
        Err(StructureError::Size {
            matrix: name,
            rows,
            columns,
            coordinates,
        })
    }

    fn check_damping(&self) -> Result<(), StructureError> {
        let numbers = match &self.damping {
            Damping::None => Vec::new(),
            Damping::Matrix(matrix) => {
                self.sized("damping", matrix)?;
                symmetric("damping", matrix, 1.0)?;
                Vec::new()
            }
            Damping::Rayleigh { mass, stiffness } => vec![*mass, *stiffness],
            Damping::Modal(ratios) => {
                if let Ratios::Table(table) = ratios
                    && !table.is_sorted_by(|a, b| a[0] < b[0])
                {
                    return Err(StructureError::Table);
                }
                ratios.numbers()
            }
        };
        let faulty = numbers.into_iter().find(|x| !(x.is_finite() && *x >= 0.0));
        faulty.map_or(Ok(()), |value| Err(StructureError::Damping { value }))
    }

    fn directed(
        &self,
        direction: &Direction,
        of: impl Fn() -> String,
    ) -> Result<(), StructureError> {
        let coordinates = self.coordinates();
        for &(coordinate, factor) in &direction.entries {
            if coordinate >= coordinates {
                return Err(StructureError::NoCoordinate {
                    what: of(),
                    coordinate,
                    coordinates,
                });
            }
            if !factor.is_finite() {
                return Err(StructureError::NotFinite {
                    what: format!("a factor of {}", of()),
                    value: factor,
                });
            }
        }
        if direction.entries.iter().all(|(_, factor)| *factor == 0.0) {
            return Err(StructureError::NoDirection { what: of() });
        }
        Ok(())
    }
}

fn symmetric(name: &'static str, matrix: &SparseMatrix, sign: f64) -> Result<(), StructureError> {
    let (row, column, off) = matrix.asymmetry(sign);
    let largest = matrix.largest();
    if off <= ROUNDING * largest {
        return Ok(());
    }
    Err(StructureError::Symmetry {
        matrix: name,
        kind: if sign > 0.0 {
            "symmetric"
        } else {
            "skew-symmetric"
        },
        row,
        column,
        value: matrix.get(row, column),
        mirrored: matrix.get(column, row),
    })
}
