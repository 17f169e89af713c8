//! Damping: a matrix, multiples of mass and stiffness, or ratios of modes; and gyroscopic matrices beside it.

use hertzian::structure::Value;

use crate::matrix::SparseMatrix;

/// Damping ratios, parts of the critical one.
#[derive(Debug, Clone, PartialEq)]
pub enum Ratios {
    /// One for all modes.
    One(f64),
    /// Of each mode, the lowest first; those beyond the list have its last one. Rigid modes count.
    PerMode(Vec<f64>),
    /// Angular frequencies in ascending order with their ratios; linear between, constant beyond.
    Table(Vec<[f64; 2]>),
}

impl Ratios {
    /// Of a mode.
    pub(crate) fn of(&self, mode: usize, frequency: f64) -> f64 {
        match self {
            Self::One(ratio) => *ratio,
            Self::PerMode(ratios) => ratios.get(mode).or(ratios.last()).copied().unwrap_or(0.0),
            Self::Table(table) => between(table, frequency),
        }
    }

    /// By which part those from a mode or a frequency on differ at most.
    pub(crate) fn spread(&self, mode: usize, frequency: f64) -> f64 {
        let beyond: Vec<f64> = match self {
            Self::One(_) => Vec::new(),
            Self::PerMode(ratios) => {
                let beyond = ratios.iter().skip(mode).chain(ratios.last());
                beyond.copied().collect()
            }
            Self::Table(table) => {
                let beyond = table.iter().filter(|[at, _]| *at > frequency);
                let here = between(table, frequency);
                beyond.map(|[_, ratio]| *ratio).chain([here]).collect()
            }
        };
        let [least, most] = beyond
            .iter()
            .fold([f64::INFINITY, 0.0], |[least, most], x| {
                [x.min(least), x.max(most)]
            });
        if most > 0.0 {
            (most - least) / most
        } else {
            0.0
        }
    }

    /// All of them, and the frequencies of a table.
    pub(super) fn numbers(&self) -> Vec<f64> {
        match self {
            Self::One(ratio) => vec![*ratio],
            Self::PerMode(ratios) => ratios.clone(),
            Self::Table(table) => table.concat(),
        }
    }
}

fn between(table: &[[f64; 2]], frequency: f64) -> f64 {
    let after = table.partition_point(|[at, _]| *at < frequency);
    match (
        after.checked_sub(1).map(|i| table[i]),
        table.get(after).copied(),
    ) {
        (Some([a, low]), Some([b, high])) => low + (high - low) * (frequency - a) / (b - a),
        (Some([_, ratio]), None) | (None, Some([_, ratio])) => ratio,
        (None, None) => 0.0,
    }
}

/// Viscous damping.
#[derive(Debug, Clone, PartialEq, Default)]
#[non_exhaustive]
pub enum Damping {
    /// None.
    #[default]
    None,
    /// A symmetric matrix.
    Matrix(SparseMatrix),
    /// A sum of multiples of mass and stiffness.
    Rayleigh {
        /// Times the mass matrix, in 1/time.
        mass: f64,
        /// Times the stiffness matrix, in time.
        stiffness: f64,
    },
    /// By modes. The vectors that a reduction keeps besides modes have the ratio of a mode of their frequency and place.
    Modal(Ratios),
}

impl Damping {
    /// One ratio for all modes.
    pub fn ratio(ratio: f64) -> Self {
        Self::Modal(Ratios::One(ratio))
    }
}

/// A skew-symmetric matrix beside the damping, times a value: `G` in `M q'' + (C + value G) q' + K q`.
#[derive(Debug, Clone, PartialEq)]
pub struct Gyroscopic {
    /// `G`
    pub matrix: SparseMatrix,
    /// The speed of rotation: a number, a parameter, or the frequency of the excitation.
    pub speed: Value,
}
