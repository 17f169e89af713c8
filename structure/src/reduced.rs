//! A structure by few vectors, and what that changes.

use std::io;
use std::path::Path;

use hertzian::Error;
use hertzian::structure::{Contact, DMatrix, Structure, Value};
use serde::{Deserialize, Serialize};

use crate::description::damping::Damping;
use crate::description::load::LoadKind;
use crate::description::output::OutputKind;
use crate::description::structure::SparseStructure;
use crate::doubt::Doubt;
use crate::gaps::TIMES;

/// The last harmonics of a force that say how large those beyond are, and how many of these there are at most.
const LAST: usize = 4;
const MOST: usize = 10_000;
/// Frequencies that differ by this part are one.
const SAME: f64 = 1e-9;

/// A structure by few vectors: modes, and static responses besides them.
///
/// Its directions are in the order: of each contact that of its gap and that of its force, or both between which they turn, then loads, then
/// outputs.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Reduced {
    pub(crate) version: u32,
    /// Of the structure that it is of.
    pub(crate) fingerprint: u64,
    pub(crate) coordinates: usize,
    pub(crate) to: f64,
    pub(crate) asked: Asked,
    pub(crate) modes: usize,
    /// Squares of frequencies.
    pub(crate) squares: Vec<f64>,
    pub(crate) damping: Vec<f64>,
    pub(crate) gyroscopic: Vec<Vec<f64>>,
    /// By pairs of damping matrix, where that was given by its entries, and gyroscopic ones: how what is left out couples vectors.
    pub(crate) coupling: Vec<Vec<f64>>,
    /// Of each direction the components of the vectors along it.
    pub(crate) rows: Vec<Vec<f64>>,
    pub(crate) checked: Vec<Checked>,
}

/// The number of the version of a file, which is read before all else: what other versions hold may be named otherwise.
#[derive(Debug, Deserialize)]
struct Numbered {
    version: u32,
}

/// What was asked of a reduction besides the frequency.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct Asked {
    pub(crate) modes: Option<usize>,
    pub(crate) steps: Option<usize>,
    pub(crate) tolerance: f64,
}

impl Asked {
    /// Modes, steps and tolerance in words.
    pub(crate) fn said(self) -> [String; 3] {
        let modes = self.modes.map_or_else(
            || "all modes that its frequency asks for".to_owned(),
            |modes| format!("{modes} modes"),
        );
        let steps = self.steps.map_or_else(
            || "as many steps of static vectors as the compliance asks for".to_owned(),
            |steps| format!("{steps} steps of static vectors"),
        );
        let tolerance = format!("a compliance to {:e}", self.tolerance);
        [modes, steps, tolerance]
    }
}

/// The error of the compliance at a frequency.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub(crate) struct Checked {
    pub(crate) frequency: f64,
    /// Of each direction along which something is read, those along which something is driven.
    pub(crate) errors: Vec<f64>,
    /// The largest compliance.
    pub(crate) largest: f64,
}

impl Checked {
    /// The largest error, relative to the largest compliance.
    pub(crate) fn relative(&self) -> f64 {
        let worst = self.errors.iter().fold(0.0, |m: f64, x| m.max(x.abs()));
        if worst == 0.0 {
            0.0
        } else {
            worst / self.largest
        }
    }
}

/// Why a reduced structure cannot be used.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum ReducedError {
    /// Its file cannot be read or written.
    #[error("{0}")]
    File(#[from] io::Error),
    /// Its file holds something else.
    #[error("it holds no reduced structure: {0}")]
    Content(#[from] serde_json::Error),
    /// It is of another version of this package.
    #[error("it is of version {found}, and this reads version {known}")]
    Version {
        /// Of the file.
        found: u32,
        /// What is read.
        known: u32,
    },
    /// It does not hold together.
    #[error("its numbers do not fit each other")]
    Sizes,
    /// It is of a structure with other matrices or directions.
    #[error(
        "it is of another structure, or of this one before its matrices or directions were changed"
    )]
    Other,
    /// It was made for lower frequencies.
    #[error("it was made for frequencies up to {made}, and {asked} are asked for: remove it")]
    Frequency {
        /// Up to which one it was made.
        made: f64,
        /// Which one is asked for.
        asked: f64,
    },
    /// It was made with another number of modes or steps, or to another tolerance.
    #[error("it was made with {made}, and {asked} are asked for: remove it")]
    Asked {
        /// With what it was made.
        made: String,
        /// What is asked for.
        asked: String,
    },
    /// An orbit cannot be read.
    #[error("{0}")]
    Orbit(#[from] Error),
    /// It was stopped.
    #[error("what the reduction changes was not computed: it was cancelled")]
    Cancelled,
}

impl Reduced {
    pub(crate) const VERSION: u32 = 5;

    /// How many of its vectors are modes of the structure.
    pub fn modes(&self) -> usize {
        self.modes
    }

    /// How many vectors are kept.
    pub fn vectors(&self) -> usize {
        self.squares.len()
    }

    /// Coordinates of the structure that it is of.
    pub fn coordinates(&self) -> usize {
        self.coordinates
    }

    /// Up to which frequency of the excitation it was made for, in radians per unit of time.
    pub fn to(&self) -> f64 {
        self.to
    }

    /// Angular frequencies of the vectors; the first are those of modes.
    pub fn frequencies(&self) -> Vec<f64> {
        let squares = self.squares.iter();
        squares.map(|square| square.max(0.0).sqrt()).collect()
    }

    /// An entry of the damping matrix of its vectors, whose mass matrix is the identity.
    pub fn damping(&self, row: usize, column: usize) -> f64 {
        self.damping[row * self.vectors() + column]
    }

    /// The largest error of a compliance between two directions relative to the largest compliance, at frequencies that ascend.
    pub fn compliance_errors(&self) -> Vec<[f64; 2]> {
        let checked = self.checked.iter();
        checked.map(|c| [c.frequency, c.relative()]).collect()
    }

    /// Compliance without damping between two directions by their places, at an angular frequency.
    pub fn compliance(&self, read: usize, driven: usize, frequency: f64) -> f64 {
        let pairs = self.rows[read].iter().zip(&self.rows[driven]);
        let terms = pairs.zip(&self.squares);
        terms
            .map(|((d, b), square)| d * b / (square - frequency * frequency))
            .sum()
    }

    /// The first row that is equal to one: several contacts may be along one direction.
    pub(crate) fn first_like(&self, row: usize) -> usize {
        let own = &self.rows[row];
        let first = self.rows.iter().position(|other| other == own);
        first.unwrap_or(row)
    }

    /// How many directions are driven: those of contacts and of loads.
    fn driven(structure: &SparseStructure) -> usize {
        2 * structure.contacts.len() + structure.loads.len()
    }

    /// Error of the compliance between two directions at a frequency, interpolated between those where it was measured. Beyond them it
    /// is the compliance that was left out at the last one.
    pub fn compliance_error(&self, read: usize, driven: usize, frequency: f64) -> f64 {
        let columns = self
            .checked
            .first()
            .map_or(0, |c| c.errors.len() / self.rows.len().max(1));
        let error = |c: &Checked| c.errors[read * columns + driven].abs();
        let after = self.checked.partition_point(|c| c.frequency < frequency);
        match (
            after.checked_sub(1).map(|i| &self.checked[i]),
            self.checked.get(after),
        ) {
            (Some(a), Some(b)) => {
                let (low, high) = (
                    error(a).max(f64::MIN_POSITIVE),
                    error(b).max(f64::MIN_POSITIVE),
                );
                let part = (frequency - a.frequency) / (b.frequency - a.frequency);
                // Errors grow with a power of the frequency.
                (low.ln() + part * (high.ln() - low.ln())).exp()
            }
            (Some(c), None) | (None, Some(c)) => error(c),
            (None, None) => 0.0,
        }
    }

    /// The same with its sign where it was measured at this very frequency.
    pub(crate) fn measured_error(&self, read: usize, driven: usize, frequency: f64) -> Option<f64> {
        let columns = self.checked.first()?.errors.len() / self.rows.len().max(1);
        let near = |c: &&Checked| (c.frequency - frequency).abs() <= SAME * frequency;
        let after = self
            .checked
            .partition_point(|c| c.frequency < frequency * (1.0 - SAME));
        let found = self.checked.get(after).filter(near)?;
        Some(found.errors[read * columns + driven])
    }

    /// The error that the reduction makes of the harmonics of what is read along a direction, to first order: the error of the compliance
    /// times the forces of contacts and loads, whose amplitudes by harmonic are given for each driven direction, and times the frequency
    /// for each derivative. Beyond the harmonics that are given, those of a force with more than three are taken to fall with the square of
    /// their number. Beyond the last frequency that was looked at masses alone answer, and the error of an acceleration stays what it is.
    pub fn response_error(
        &self,
        read: usize,
        kind: OutputKind,
        omega: f64,
        forces: &[(usize, Vec<f64>)],
    ) -> f64 {
        self.response_off(read, kind, omega, forces, &Doubt::default())
    }

    /// The same with what is not known of damping.
    pub(crate) fn response_off(
        &self,
        read: usize,
        kind: OutputKind,
        omega: f64,
        forces: &[(usize, Vec<f64>)],
        doubt: &Doubt,
    ) -> f64 {
        let looked_at = self.checked.last().map_or(0.0, |c| c.frequency);
        let derivatives = kind.derivatives();
        let of = |(driven, amplitudes): &(usize, Vec<f64>)| -> f64 {
            let error = |harmonic: usize| {
                let frequency = harmonic as f64 * omega;
                let compliance = self.compliance_error(read, *driven, frequency)
                    + doubt.of(self, [read, *driven], harmonic, omega);
                compliance * frequency.min(looked_at).powi(derivatives)
            };
            let known = amplitudes.len();
            let end = match kind {
                OutputKind::Displacement => ((looked_at / omega) as usize).max(4 * known).min(MOST),
                OutputKind::Rate | OutputKind::Acceleration => MOST,
            };
            let terms = (0..=end).map(|k| error(k) * amplitude_of(amplitudes, k));
            terms.sum::<f64>()
        };
        forces.iter().map(of).sum()
    }

    /// The same harmonic by harmonic, which are as many as [`TIMES`] tell.
    pub(crate) fn harmonics_off(
        &self,
        read: usize,
        kind: OutputKind,
        omega: f64,
        forces: &[(usize, Vec<f64>)],
        doubt: &Doubt,
    ) -> Vec<f64> {
        let looked_at = self.checked.last().map_or(0.0, |c| c.frequency);
        let at = |harmonic: usize| {
            let frequency = harmonic as f64 * omega;
            let of = |(driven, amplitudes): &(usize, Vec<f64>)| {
                let compliance = self.compliance_error(read, *driven, frequency)
                    + doubt.of(self, [read, *driven], harmonic, omega);
                let times = frequency.min(looked_at).powi(kind.derivatives());
                compliance * times * amplitude_of(amplitudes, harmonic)
            };
            forces.iter().map(of).sum()
        };
        (0..TIMES / 2).map(at).collect()
    }

    /// The structure by these vectors, with the loads, contacts and outputs of the whole one.
    ///
    /// # Errors
    /// If names or arguments of laws cannot be used.
    pub fn structure(&self, of: &SparseStructure) -> Result<Structure, Error> {
        let m = self.vectors();
        let stiffness = DMatrix::from_fn(m, m, |i, j| if i == j { self.squares[i] } else { 0.0 });
        let damping = DMatrix::from_row_slice(m, m, &self.damping);
        let names = (0..m).map(|i| match i.checked_sub(self.modes) {
            None => format!("mode{}", i + 1),
            Some(i) => format!("static{}", i + 1),
        });
        let mut builder = Structure::of(&DMatrix::identity(m, m), &damping, &stiffness)
            .name(&of.name)
            .coordinates(names);
        for (matrix, gyroscopic) in self.gyroscopic.iter().zip(&of.gyroscopic) {
            let matrix = DMatrix::from_row_slice(m, m, matrix);
            builder = builder.damping(&matrix, gyroscopic.speed.clone());
        }
        let mut rows = self.rows.iter();
        let mut next = || rows.next().cloned().unwrap_or_default();
        for contact in &of.contacts {
            let (gap, second) = (next(), next());
            let own = Contact::of(contact.law.clone())
                .arguments(contact.arguments.iter().cloned())
                .direction(gap)
                .offset(contact.offset.clone())
                .unit(of.force_unit.clone());
            builder = builder.contact(match contact.turning {
                Some((_, turn)) => own.turning(second, turn),
                None => own.force_direction(second),
            });
        }
        for load in &of.loads {
            let row = next();
            let amplitude = match load.kind {
                LoadKind::Force | LoadKind::Acceleration => load.amplitude.clone(),
                LoadKind::Unbalance => load.amplitude.clone().times_omega(2),
                LoadKind::Base => {
                    let squared = f64::from(load.harmonic).powi(2);
                    load.amplitude.clone().times_omega(2).times(squared)
                }
            };
            let (sine, cosine) = load.phase.sin_cos();
            for (index, factor) in row.into_iter().enumerate() {
                let part = |by: f64| -> Value { amplitude.clone().times(by * factor) };
                builder = builder.cosine(index, load.harmonic, part(cosine)).sine(
                    index,
                    load.harmonic,
                    part(-sine),
                );
            }
        }
        for output in &of.outputs {
            let (name, row) = (&output.name, next());
            let read = match output.kind {
                OutputKind::Displacement => builder.output(name, row),
                OutputKind::Rate => builder.rate_output(name, row),
                OutputKind::Acceleration => builder.acceleration_output(name, row),
            };
            builder = read.unit(&output.unit).about(&output.documentation);
        }
        for (index, contact) in of.contacts.iter().enumerate() {
            builder = builder
                .force_output(&contact.name, index)
                .unit(&of.force_unit);
        }
        for parameter in &of.parameters {
            builder = builder.parameter(parameter.clone());
        }
        builder.build()
    }

    /// Writes it to a file, whole or not at all.
    ///
    /// # Errors
    /// If the file cannot be written.
    pub fn write(&self, path: impl AsRef<Path>) -> Result<(), ReducedError> {
        let text = serde_json::to_vec(self)?;
        Ok(hertzian_file::write(path.as_ref(), &text)?)
    }

    /// Reads it from a file.
    ///
    /// # Errors
    /// If the file cannot be read, is of another version or holds something else.
    pub fn read(path: impl AsRef<Path>) -> Result<Self, ReducedError> {
        let text = std::fs::read(path)?;
        let Numbered { version: found } = serde_json::from_slice(&text)?;
        let known = Self::VERSION;
        if found != known {
            return Err(ReducedError::Version { found, known });
        }
        let reduced: Self = serde_json::from_slice(&text)?;
        if !reduced.fits() {
            return Err(ReducedError::Sizes);
        }
        Ok(reduced)
    }

    /// Whether its numbers fit each other. JSON has none that are not finite.
    fn fits(&self) -> bool {
        let m = self.vectors();
        let rows = self.rows.iter().all(|row| row.len() == m);
        let columns = self.checked.first().map_or(0, |c| c.errors.len());
        let sound = |c: &Checked| c.errors.len() == columns && (c.largest > 0.0 || columns == 0);
        let ascending = self.checked.is_sorted_by(|a, b| a.frequency < b.frequency);
        (1..=m).contains(&self.modes)
            && self.to > 0.0
            && self.asked.modes != Some(0)
            && self.asked.tolerance > 0.0
            && mirrored(&self.damping, m, 1.0)
            && self.gyroscopic.iter().all(|g| mirrored(g, m, -1.0))
            && self.coupling.iter().all(|c| c.len() == m * m)
            && [false, true]
                .map(|given| self.couplings(given))
                .contains(&self.coupling.len())
            && rows
            && !self.checked.is_empty()
            && self.checked.iter().all(sound)
            && ascending
            && columns.is_multiple_of(self.rows.len().max(1))
    }

    /// How many pairs of matrices couple the vectors with what is left out, where the damping matrix is given by its entries or not.
    fn couplings(&self, given: bool) -> usize {
        if self.vectors() == self.coordinates {
            // Nothing is left out.
            return 0;
        }
        (usize::from(given) + self.gyroscopic.len()).pow(2)
    }

    /// Whether it is of this structure.
    ///
    /// # Errors
    /// If its numbers do not fit each other, or matrices or directions are others.
    pub fn is_of(&self, structure: &SparseStructure) -> Result<(), ReducedError> {
        // It need not come of a file that was looked at.
        if !self.fits() {
            return Err(ReducedError::Sizes);
        }
        let given = matches!(structure.damping, Damping::Matrix(_));
        let driven = Self::driven(structure);
        let rows = driven + structure.outputs.len();
        let is_of = self.fingerprint == Self::fingerprint_of(structure)
            && self.coordinates == structure.coordinates()
            && self.rows.len() == rows
            && self.gyroscopic.len() == structure.gyroscopic.len()
            && self.coupling.len() == self.couplings(given)
            && self.checked.iter().all(|c| c.errors.len() == rows * driven);
        if is_of {
            Ok(())
        } else {
            Err(ReducedError::Other)
        }
    }

    /// A number that other matrices, damping or directions do not have (Fowler, Noll and Vo, FNV-1a of 64 bits).
    pub(crate) fn fingerprint_of(structure: &SparseStructure) -> u64 {
        let mut hash = 0xcbf2_9ce4_8422_2325_u64;
        let mut take = |word: u64| {
            hash = (hash ^ word).wrapping_mul(0x0100_0000_01b3);
        };
        let matrices = [&structure.mass, &structure.stiffness].into_iter();
        for matrix in matrices.chain(structure.gyroscopic.iter().map(|g| &g.matrix)) {
            take(matrix.rows() as u64);
            for (row, column, value) in matrix.triplets() {
                take(row as u64);
                take(column as u64);
                take(value.to_bits());
            }
        }
        for byte in format!("{:?}", structure.damping).bytes() {
            take(u64::from(byte));
        }
        // Directions one after the other do not say what each is of; a base moves the masses, where a force moves its direction.
        take(structure.contacts.len() as u64);
        take(structure.loads.len() as u64);
        for load in &structure.loads {
            let by_masses = matches!(load.kind, LoadKind::Base | LoadKind::Acceleration);
            take(u64::from(by_masses));
        }
        for contact in &structure.contacts {
            take(u64::from(contact.turning.is_some()));
        }
        let contacts = structure.contacts.iter();
        let contacts = contacts.flat_map(|c| {
            let across = c.turning.as_ref().map(|(across, _)| across);
            [Some(&c.gap), across.or(c.force.as_ref())]
        });
        let loads = structure.loads.iter().map(|load| Some(&load.direction));
        let outputs = structure.outputs.iter().map(|o| Some(&o.direction));
        for direction in contacts.chain(loads).chain(outputs) {
            take(direction.map_or(0, |d| d.entries.len() as u64 + 1));
            for (coordinate, factor) in direction.iter().flat_map(|d| &d.entries) {
                take(*coordinate as u64);
                take(factor.to_bits());
            }
        }
        hash
    }
}

/// The amplitude of a harmonic of a force. Beyond those that are known a force with more than three, whose slope jumps where a contact opens,
/// falls with the square of the harmonic.
fn amplitude_of(amplitudes: &[f64], harmonic: usize) -> f64 {
    let known = amplitudes.len();
    if let Some(amplitude) = amplitudes.get(harmonic) {
        return amplitude.abs();
    }
    if known < 3 {
        return 0.0;
    }
    let last = amplitudes[known - known.min(LAST)..].iter();
    let last = last.fold(0.0, |m: f64, x| m.max(x.abs()));
    last * (known as f64 / harmonic as f64).powi(2)
}

/// Whether a matrix of so many rows, row by row, is its transpose times a sign.
fn mirrored(matrix: &[f64], m: usize, sign: f64) -> bool {
    let pairs = (0..m).flat_map(|i| (0..=i).map(move |j| (i * m + j, j * m + i)));
    matrix.len() == m * m
        && pairs
            .into_iter()
            .all(|(a, b)| matrix[a] == sign * matrix[b])
}
