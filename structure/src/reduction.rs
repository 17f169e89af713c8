//! Few vectors instead of all coordinates: modes, and what static responses have besides them.
//!
//! With the modes `Phi` below a frequency, and the directions `b` of contacts and loads,
//!
//! ```text
//! X_0 = A^-1 (b - M Phi Phi^T b),    X_j+1 = A^-1 M X_j,    A = K + s M                                       (1)
//! ```
//!
//! made orthonormal in the product of the mass matrix, and diagonal by the modes of their own (Ritz): `Psi`, with `Psi^T M Psi = I` and
//! `Psi^T K Psi = diag(w^2)`. The shift `s` is zero where nothing is free to move. `j + 1` steps make the compliance exact in `2 j + 2`
//! more terms of its series in the square of the frequency.
//!
//! What is left out is measured, without damping, at frequencies up to many times that of the excitation:
//!
//! ```text
//! E(s) = d^T (K - s^2 M)^-1 b - d^T Psi (diag(w^2) - s^2)^-1 Psi^T b                                          (2)
//! ```
//!
//! That no mode below a frequency is missed is known from the number of negative pivots of `K - s^2 M` ([`crate::factor`]).
//!
//! Source: `MacNeal` (1971), Comput. Struct. 1, 581 (residual flexibility); Wilson, Yuan and Dickens (1982), Earthq. Eng. Struct. Dyn. 10,
//! 813 (load-dependent vectors, Ritz); Craig and Ni (1989), J. Guid. Control Dyn. 12, 577.

use hertzian::Cancel;
use nalgebra::DMatrix;
use sparse_ldlt::LdltError;

use crate::description::{Damping, Direction, LoadKind, SparseStructure};
use crate::error::StructureError;
use crate::factor::{Factor, Ordering};
use crate::lanczos::{self, Basis, Missing};
use crate::matrix::SparseMatrix;
use crate::reduced::{Checked, Reduced};

/// Modes are kept up to so many times the highest frequency of the excitation.
const COVERED: f64 = 16.0;
/// More modes than this are asked for by their number.
const MOST_MODES: usize = 200;
/// Steps (1) at most.
const MOST_STEPS: usize = 6;
/// Multiples of the highest frequency of the excitation where (2) is measured; the vectors are enough where it is small at the first
/// ones.
const MULTIPLES: [f64; 8] = [0.0, 1.0, 2.0, 4.0, 8.0, 16.0, 32.0, 64.0];
const ASKED: usize = 6;
/// A new vector must have this part of it besides the others.
const DEPENDENT: f64 = 1e-7;
/// A frequency that is this part of the excitation's, squared, is that of a rigid mode.
const RIGID: f64 = 1e-8;
/// A stiffness matrix has rigid modes where a pivot is this part of the largest entry.
const SOFT: f64 = 1e-9;
/// A frequency in resonance is moved by this part.
const ASIDE: f64 = 3e-3;

/// Why a structure was not reduced.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum ReductionError {
    /// The structure itself is at fault.
    #[error(transparent)]
    Structure(#[from] StructureError),
    /// An option cannot be used.
    #[error("{name} = {value}: must be {must}")]
    Option {
        /// Which one.
        name: &'static str,
        /// Its value.
        value: f64,
        /// What it must be.
        must: &'static str,
    },
    /// The stiffness matrix has negative eigenvalues: the structure buckles.
    #[error(
        "the stiffness matrix has {count} negative eigenvalue{}: the structure is not at a stable equilibrium", if *.count == 1 { "" } else { "s" }
    )]
    Unstable {
        /// How many.
        count: usize,
    },
    /// The mass matrix has a negative eigenvalue, or none that is not zero.
    #[error("the mass matrix is not positive: a motion has no or negative kinetic energy")]
    Mass,
    /// A matrix of equations has no inverse.
    #[error("stiffness and mass at {frequency} rad per unit of time have no inverse: {reason}")]
    Singular {
        /// The frequency.
        frequency: f64,
        /// What the elimination met.
        reason: String,
    },
    /// There are more modes than a dense model is made for.
    #[error(
        "there are {count} modes below {frequency} rad per unit of time: ask for a number of modes, or for a lower frequency"
    )]
    ManyModes {
        /// How many.
        count: usize,
        /// Below which frequency.
        frequency: f64,
    },
    /// Not all modes that there are were found.
    #[error("{found} of {expected} modes were found")]
    Modes {
        /// As many as converged.
        found: usize,
        /// As many as there are.
        expected: usize,
    },
    /// It was stopped.
    #[error("the reduction was cancelled")]
    Cancelled,
}

/// How a structure is reduced.
#[derive(Debug, Clone)]
pub struct Reduction {
    to: f64,
    modes: Option<usize>,
    steps: Option<usize>,
    tolerance: f64,
    cancel: Cancel,
}

impl Reduction {
    /// For excitations up to this angular frequency.
    pub fn to(omega: f64) -> Self {
        Self {
            to: omega,
            modes: None,
            steps: None,
            tolerance: 1e-6,
            cancel: Cancel::new(),
        }
    }

    /// So many modes, instead of all up to sixteen times the frequency of the excitation.
    #[must_use]
    pub fn modes(mut self, modes: usize) -> Self {
        self.modes = Some(modes);
        self
    }

    /// So many steps of static vectors, instead of as many as the tolerance asks for; none are modes alone.
    #[must_use]
    pub fn steps(mut self, steps: usize) -> Self {
        self.steps = Some(steps);
        self
    }

    /// Error of the compliance between contacts, loads and outputs, relative to the largest of them, up to sixteen times the frequency of the
    /// excitation.
    #[must_use]
    pub fn tolerance(mut self, tolerance: f64) -> Self {
        self.tolerance = tolerance;
        self
    }

    /// Stops where the token is cancelled.
    #[must_use]
    pub fn cancel(mut self, cancel: &Cancel) -> Self {
        self.cancel = cancel.clone();
        self
    }

    /// Reduces a structure.
    ///
    /// # Errors
    /// What is wrong with the structure, and if its modes were not found.
    pub fn run(&self, structure: &SparseStructure) -> Result<Reduced, ReductionError> {
        self.check()?;
        structure.check()?;
        if structure.mass.largest() == 0.0 {
            return Err(ReductionError::Mass);
        }
        let work = Work::new(self, structure)?;
        let (squares, modes) = work.modes()?;
        let kept = squares.len();
        let mut basis = Basis::new(&structure.mass, modes);
        let mut last = work.directions.attached.clone();
        for step in 0..self.steps.unwrap_or(MOST_STEPS) {
            last = work.attach(&mut basis, kept, last, step == 0)?;
            if self.steps.is_none() && !last.is_empty() {
                let reduced = work.reduced(&squares, &basis, Vec::new());
                let error = work.checked(&reduced, MULTIPLES[ASKED - 1])?;
                if error.relative() <= self.tolerance {
                    break;
                }
            }
            if last.is_empty() {
                break;
            }
        }
        let reduced = work.reduced(&squares, &basis, Vec::new());
        let checked = MULTIPLES
            .iter()
            .map(|&multiple| work.checked(&reduced, multiple));
        let checked = checked.collect::<Result<_, _>>()?;
        Ok(work.reduced(&squares, &basis, checked))
    }

    fn check(&self) -> Result<(), ReductionError> {
        for (name, value) in [("omega", self.to), ("tolerance", self.tolerance)] {
            if !(value > 0.0 && value.is_finite()) {
                let must = "positive and finite";
                return Err(ReductionError::Option { name, value, must });
            }
        }
        match self.modes {
            Some(0) => Err(ReductionError::Option {
                name: "modes",
                value: 0.0,
                must: "at least one",
            }),
            _ => Ok(()),
        }
    }
}

/// Where a structure is pushed and read.
struct Directions {
    /// Of all rows of a [`Reduced`], in its order.
    rows: Vec<Vec<f64>>,
    /// Those of contacts and loads, whose static responses are kept in every step, then of outputs.
    attached: Vec<Vec<f64>>,
    /// How many of them are contacts and loads.
    driven: usize,
}

impl Directions {
    fn of(structure: &SparseStructure) -> Self {
        let n = structure.coordinates();
        let full = |direction: &Direction| direction.full(n);
        let contacts = structure.contacts.iter().flat_map(|contact| {
            let force = contact.force.as_ref().unwrap_or(&contact.gap);
            [full(&contact.gap), full(force)]
        });
        let loads = structure.loads.iter().map(|load| match load.kind {
            LoadKind::Force | LoadKind::Unbalance => full(&load.direction),
            LoadKind::Base | LoadKind::Acceleration => structure.mass.times(&full(&load.direction)),
        });
        let driven: Vec<Vec<f64>> = contacts.chain(loads).collect();
        let count = driven.len();
        let outputs = structure
            .outputs
            .iter()
            .map(|output| full(&output.direction));
        let rows: Vec<Vec<f64>> = driven.into_iter().chain(outputs).collect();
        Self {
            attached: rows.clone(),
            rows,
            driven: count,
        }
    }
}

/// What a reduction works with.
struct Work<'r> {
    options: &'r Reduction,
    structure: &'r SparseStructure,
    order: Ordering,
    factor: Factor,
    shift: f64,
    directions: Directions,
}

impl<'r> Work<'r> {
    fn new(options: &'r Reduction, structure: &'r SparseStructure) -> Result<Self, ReductionError> {
        let (mass, stiffness) = (&structure.mass, &structure.stiffness);
        let pattern = SparseMatrix::sum(&[(1.0, stiffness), (1.0, mass)]);
        let order = Ordering::of(&pattern);
        let (factor, shift) = factored(options.to, mass, stiffness, &order)?;
        Ok(Self {
            options,
            structure,
            order,
            factor,
            shift,
            directions: Directions::of(structure),
        })
    }

    /// `K - s^2 M`, its factors, and the frequency, which is moved where it is in resonance.
    fn dynamic(&self, frequency: f64) -> Result<(Factor, f64), ReductionError> {
        let mut frequency = frequency;
        let mut tries = 0;
        loop {
            if self.options.cancel.is_cancelled() {
                return Err(ReductionError::Cancelled);
            }
            let terms = [
                (1.0, &self.structure.stiffness),
                (-frequency * frequency, &self.structure.mass),
            ];
            match Factor::of(&SparseMatrix::sum(&terms), &self.order) {
                Ok(factor) => return Ok((factor, frequency)),
                Err(error) if tries == 5 => return Err(singular(frequency, &error)),
                Err(_) => {
                    let unit = frequency.max(ASIDE * self.options.to);
                    frequency += ASIDE * unit;
                    tries += 1;
                }
            }
        }
    }

    /// How many modes are kept: all below a frequency, unless their number was asked for.
    fn count(&self) -> Result<usize, ReductionError> {
        if let Some(modes) = self.options.modes {
            return Ok(modes.min(self.structure.coordinates()));
        }
        let (factor, frequency) = self.dynamic(COVERED * self.options.to)?;
        let count = factor.negative();
        if count > MOST_MODES {
            return Err(ReductionError::ManyModes { count, frequency });
        }
        Ok(count.max(1))
    }

    /// The modes that are kept.
    fn modes(&self) -> Result<(Vec<f64>, Vec<Vec<f64>>), ReductionError> {
        let count = self.count()?;
        let stop = || self.options.cancel.is_cancelled();
        let mass = &self.structure.mass;
        let found = lanczos::lowest(&self.factor, mass, self.shift, count, &stop);
        let (mut squares, modes) = found.map_err(|missing| match missing {
            Missing::Indefinite => ReductionError::Mass,
            Missing::Cancelled => ReductionError::Cancelled,
            Missing::Found(found) => ReductionError::Modes {
                found,
                expected: count,
            },
        })?;
        let least = RIGID * self.options.to * self.options.to;
        for square in &mut squares {
            if square.abs() < least {
                *square = 0.0;
            }
        }
        if let Some(highest) = squares.last().filter(|x| **x > 0.0) {
            // As many as there are below the last one, which may have others of its frequency.
            let (factor, frequency) = self.dynamic(highest.sqrt() * (1.0 - ASIDE))?;
            let expected = factor.negative();
            let below = squares.iter().filter(|x| x.sqrt() < frequency);
            let found = below.count();
            if found != expected {
                return Err(ReductionError::Modes { found, expected });
            }
        }
        Ok((squares, modes))
    }

    /// (1): adds a step of vectors. Returns those that are new among the ones that go on.
    fn attach(
        &self,
        basis: &mut Basis<'_>,
        kept: usize,
        last: Vec<Vec<f64>>,
        first: bool,
    ) -> Result<Vec<Vec<f64>>, ReductionError> {
        let mass = &self.structure.mass;
        let mut next = Vec::new();
        for (index, vector) in last.into_iter().enumerate() {
            if self.options.cancel.is_cancelled() {
                return Err(ReductionError::Cancelled);
            }
            let image = if first {
                let mut rest = vector;
                for mode in &basis.vectors[..kept] {
                    let part = lanczos::dot(mode, &rest);
                    lanczos::add(&mut rest, -part, &mass.times(mode));
                }
                self.factor.solve(&rest)
            } else {
                self.factor.solve(&mass.times(&vector))
            };
            let before = basis.vectors.len();
            basis.push(image, DEPENDENT).ok_or(ReductionError::Mass)?;
            let goes_on = !first || index < self.directions.driven;
            if basis.vectors.len() > before && goes_on {
                next.push(basis.vectors[before].clone());
            }
        }
        Ok(next)
    }

    /// The model of the vectors that are kept.
    fn reduced(&self, squares: &[f64], basis: &Basis<'_>, checked: Vec<Checked>) -> Reduced {
        let (kept, m) = (squares.len(), basis.vectors.len());
        let mut stiffness = DMatrix::zeros(m, m);
        for (mode, square) in squares.iter().enumerate() {
            stiffness[(mode, mode)] = *square;
        }
        for j in kept..m {
            let image = self.structure.stiffness.times(&basis.vectors[j]);
            // Modes are orthogonal in the product of the stiffness matrix too.
            for i in kept..m {
                stiffness[(i, j)] = lanczos::dot(&basis.vectors[i], &image);
            }
        }
        let stiffness = 0.5 * (&stiffness + stiffness.transpose());
        let (own, vectors) = diagonal(&stiffness, kept);
        let mut order: Vec<usize> = (0..m - kept).collect();
        order.sort_by(|&a, &b| own[a].total_cmp(&own[b]));
        let mut turn = DMatrix::zeros(m, m);
        turn.view_mut((0, 0), (kept, kept)).fill_with_identity();
        let mut all = squares.to_vec();
        for (place, &of) in order.iter().enumerate() {
            all.push(own[of]);
            turn.view_mut((kept, kept + place), (m - kept, 1))
                .copy_from(&vectors.column(of));
        }
        // Symmetric, or skew-symmetric by a sign of -1, to the last bit, as the matrix itself is up to rounding.
        let project = |matrix: &SparseMatrix, sign: f64| {
            let images: Vec<Vec<f64>> = basis.vectors.iter().map(|v| matrix.times(v)).collect();
            let inner = DMatrix::from_fn(m, m, |i, j| lanczos::dot(&basis.vectors[i], &images[j]));
            let turned = turn.transpose() * inner * &turn;
            0.5 * (&turned + sign * turned.transpose())
        };
        let row = |direction: &Vec<f64>| -> Vec<f64> {
            let inner = DMatrix::from_fn(1, m, |_, j| lanczos::dot(direction, &basis.vectors[j]));
            (inner * &turn).iter().copied().collect()
        };
        let structure = self.structure;
        Reduced {
            version: Reduced::VERSION,
            fingerprint: Reduced::fingerprint_of(structure),
            coordinates: structure.coordinates(),
            to: self.options.to,
            modes: kept,
            damping: damping(&structure.damping, &all, &|matrix| project(matrix, 1.0)),
            gyroscopic: structure
                .gyroscopic
                .iter()
                .map(|g| entries(&project(&g.matrix, -1.0)))
                .collect(),
            squares: all,
            rows: self.directions.rows.iter().map(row).collect(),
            checked,
        }
    }

    /// (2) at a multiple of the frequency of the excitation.
    fn checked(&self, reduced: &Reduced, multiple: f64) -> Result<Checked, ReductionError> {
        let asked = multiple * self.options.to;
        let (factor, frequency) = if multiple == 0.0 && self.shift == 0.0 {
            (None, 0.0)
        } else {
            let (factor, frequency) = self.dynamic(asked.max(ASIDE * self.options.to))?;
            (Some(factor), frequency)
        };
        let factor = factor.as_ref().unwrap_or(&self.factor);
        let rows = &self.directions.rows;
        let driven = self.directions.driven;
        let mut errors = vec![0.0; rows.len() * driven];
        let mut largest: f64 = 0.0;
        for b in 0..driven {
            let response = factor.solve(&rows[b]);
            for d in 0..rows.len() {
                let full = lanczos::dot(&rows[d], &response);
                errors[d * driven + b] = full - reduced.compliance(d, b, frequency);
                largest = largest.max(full.abs());
            }
        }
        Ok(Checked {
            frequency,
            errors,
            largest,
        })
    }
}

/// The factors of `K`, or of `K + s M` where something is free to move.
fn factored(
    to: f64,
    mass: &SparseMatrix,
    stiffness: &SparseMatrix,
    order: &Ordering,
) -> Result<(Factor, f64), ReductionError> {
    if let Ok(factor) = Factor::of(stiffness, order) {
        let count = factor.negative();
        if count == 0 && factor.least_pivot() > SOFT * stiffness.largest() {
            return Ok((factor, 0.0));
        }
    }
    let shift = to * to;
    let shifted = SparseMatrix::sum(&[(1.0, stiffness), (shift, mass)]);
    let factor = Factor::of(&shifted, order).map_err(|error| singular(to, &error))?;
    match factor.negative() {
        0 => {
            // Below zero by more than rounding.
            let slight = SparseMatrix::sum(&[(1.0, stiffness), (RIGID * shift, mass)]);
            match Factor::of(&slight, order).map(|factor| factor.negative()) {
                Ok(count) if count > 0 => Err(ReductionError::Unstable { count }),
                _ => Ok((factor, shift)),
            }
        }
        count => Err(ReductionError::Unstable { count }),
    }
}

fn singular(frequency: f64, error: &LdltError) -> ReductionError {
    ReductionError::Singular {
        frequency,
        reason: match error {
            LdltError::ZeroPivot(column) => format!("a pivot of zero at coordinate {column}"),
            LdltError::NearZeroPivot { column, pivot, .. } => {
                format!("a pivot of {pivot:e} at coordinate {column}")
            }
            other => format!("{other:?}"),
        },
    }
}

/// Eigenvalues and eigenvectors of what stands behind the modes.
fn diagonal(stiffness: &DMatrix<f64>, kept: usize) -> (Vec<f64>, DMatrix<f64>) {
    let count = stiffness.nrows() - kept;
    if count == 0 {
        return (Vec::new(), DMatrix::zeros(0, 0));
    }
    let part = stiffness.view((kept, kept), (count, count)).into_owned();
    let eigen = part.symmetric_eigen();
    (eigen.eigenvalues.as_slice().to_vec(), eigen.eigenvectors)
}

fn entries(matrix: &DMatrix<f64>) -> Vec<f64> {
    matrix.transpose().as_slice().to_vec()
}

/// The damping of the vectors that are kept, row by row.
fn damping(
    damping: &Damping,
    squares: &[f64],
    project: &dyn Fn(&SparseMatrix) -> DMatrix<f64>,
) -> Vec<f64> {
    let m = squares.len();
    let diagonal = |of: &dyn Fn(usize) -> f64| {
        entries(&DMatrix::from_fn(
            m,
            m,
            |i, j| if i == j { of(i) } else { 0.0 },
        ))
    };
    match damping {
        Damping::None => vec![0.0; m * m],
        Damping::Matrix(matrix) => entries(&project(matrix)),
        Damping::Rayleigh { mass, stiffness } => diagonal(&|i| mass + stiffness * squares[i]),
        Damping::Modal(ratios) => diagonal(&|i| {
            let frequency = squares[i].max(0.0).sqrt();
            2.0 * ratios.of(i, frequency) * frequency
        }),
    }
}
