//! The coefficients of a system, sorted by where they stand.
//!
//! A [`System`] lists its coefficients in any order; the runtime walks them term by term. The lists are made once, so
//! that the same walk serves the coefficients and their derivatives.

use nalgebra::DMatrix;

use crate::system::{Place, System, Wave};

/// An entry of a matrix or of the load, times a wave.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Entry {
    pub(crate) row: usize,
    /// Zero for a load.
    pub(crate) column: usize,
    pub(crate) wave: Wave,
    /// Position of its coefficient.
    pub(crate) coefficient: usize,
}

/// Adds what is constant in a matrix of order `n` to `rows`, row by row.
pub(crate) fn add_constant(entries: &[Entry], coefficients: &[f64], n: usize, rows: &mut [f64]) {
    for entry in entries.iter().filter(|entry| entry.wave.harmonic == 0) {
        rows[entry.row * n + entry.column] += coefficients[entry.coefficient];
    }
}

/// What is constant in a matrix of order `n`.
pub(crate) fn constant(entries: &[Entry], coefficients: &[f64], n: usize) -> DMatrix<f64> {
    let mut rows = vec![0.0; n * n];
    add_constant(entries, coefficients, n, &mut rows);
    DMatrix::from_row_slice(n, n, &rows)
}

/// A component of a direction, or a term of an offset, times a wave.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Term {
    /// Coordinate or equation; zero for an offset.
    pub(crate) index: usize,
    pub(crate) wave: Wave,
    /// Position of its coefficient.
    pub(crate) coefficient: usize,
}

/// What belongs to one contact.
#[derive(Debug, Clone, Default)]
pub(crate) struct ContactLayout {
    pub(crate) law: usize,
    pub(crate) force: Vec<Term>,
    pub(crate) gap: Vec<Term>,
    pub(crate) offset: Vec<Term>,
    /// Argument and position of its coefficient.
    pub(crate) arguments: Vec<(usize, usize)>,
    pub(crate) argument_count: usize,
}

impl ContactLayout {
    /// Highest harmonic of the force direction, in multiples of `omega / divisor`.
    pub(crate) fn force_harmonic(&self) -> usize {
        highest(&self.force)
    }

    /// Highest harmonic of the gap direction.
    pub(crate) fn gap_harmonic(&self) -> usize {
        highest(&self.gap)
    }

    /// Highest harmonic of the offset.
    pub(crate) fn offset_harmonic(&self) -> usize {
        highest(&self.offset)
    }

    /// Writes the arguments of the law.
    pub(crate) fn arguments(&self, coefficients: &[f64], arguments: &mut [f64]) {
        arguments.fill(0.0);
        for &(index, coefficient) in &self.arguments {
            arguments[index] += coefficients[coefficient];
        }
    }

    /// Positions of all its coefficients.
    pub(crate) fn coefficients(&self) -> impl Iterator<Item = usize> {
        self.force
            .iter()
            .chain(&self.gap)
            .chain(&self.offset)
            .map(|term| term.coefficient)
            .chain(self.arguments.iter().map(|&(_, coefficient)| coefficient))
    }
}

fn highest(terms: &[Term]) -> usize {
    terms
        .iter()
        .map(|term| term.wave.harmonic as usize)
        .max()
        .unwrap_or(0)
}

/// The coefficients of a system, sorted by where they stand.
#[derive(Debug, Clone)]
pub(crate) struct Layout {
    pub(crate) coordinates: usize,
    pub(crate) coefficients: usize,
    pub(crate) mass: Vec<Entry>,
    pub(crate) damping: Vec<Entry>,
    pub(crate) stiffness: Vec<Entry>,
    pub(crate) load: Vec<Entry>,
    pub(crate) contacts: Vec<ContactLayout>,
}

impl Layout {
    pub(crate) fn of(system: &dyn System) -> Self {
        let facts = system.facts();
        let contacts = facts.contacts.iter().map(|contact| ContactLayout {
            law: contact.law,
            argument_count: system.law(contact.law).facts().arguments.len(),
            ..ContactLayout::default()
        });
        let mut layout = Self {
            coordinates: facts.coordinates.len(),
            coefficients: facts.places.len(),
            mass: Vec::new(),
            damping: Vec::new(),
            stiffness: Vec::new(),
            load: Vec::new(),
            contacts: contacts.collect(),
        };
        for (coefficient, &place) in facts.places.iter().enumerate() {
            layout.add(place, coefficient);
        }
        layout
    }

    fn add(&mut self, place: Place, coefficient: usize) {
        let entry = |row, column, wave| Entry {
            row,
            column,
            wave,
            coefficient,
        };
        let term = |index, wave| Term {
            index,
            wave,
            coefficient,
        };
        match place {
            Place::Mass { row, column } => self.mass.push(entry(row, column, Wave::CONSTANT)),
            Place::Damping { row, column } => self.damping.push(entry(row, column, Wave::CONSTANT)),
            Place::Stiffness { row, column, wave } => {
                self.stiffness.push(entry(row, column, wave));
            }
            Place::Load { row, wave } => self.load.push(entry(row, 0, wave)),
            Place::ForceDirection { contact, row, wave } => {
                self.contacts[contact].force.push(term(row, wave));
            }
            Place::GapDirection {
                contact,
                column,
                wave,
            } => self.contacts[contact].gap.push(term(column, wave)),
            Place::Offset { contact, wave } => self.contacts[contact].offset.push(term(0, wave)),
            Place::Argument { contact, index } => {
                self.contacts[contact].arguments.push((index, coefficient));
            }
            Place::Output { .. } => {}
            // The contract is of this very version: Cargo.toml asks for it.
            other => unreachable!("this version of the contract has no {other:?}"),
        }
    }

    /// The mass matrix.
    pub(crate) fn mass(&self, coefficients: &[f64]) -> DMatrix<f64> {
        constant(&self.mass, coefficients, self.coordinates)
    }

    /// Highest harmonic in the declaration, in multiples of `omega / divisor`.
    pub(crate) fn highest_harmonic(&self) -> usize {
        let stiffness = self
            .stiffness
            .iter()
            .map(|entry| entry.wave.harmonic as usize);
        let contacts = self.contacts.iter().map(|contact| {
            contact
                .force_harmonic()
                .max(contact.gap_harmonic())
                .max(contact.offset_harmonic())
        });
        stiffness
            .chain(contacts)
            .max()
            .unwrap_or(0)
            .max(self.load_harmonic())
    }

    /// Highest harmonic of the load, in multiples of `omega / divisor`.
    pub(crate) fn load_harmonic(&self) -> usize {
        self.load
            .iter()
            .map(|entry| entry.wave.harmonic as usize)
            .max()
            .unwrap_or(0)
    }
}
