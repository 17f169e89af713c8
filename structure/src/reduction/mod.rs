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

mod directions;
mod error;
mod projected;
mod work;

use hertzian::Cancel;

pub use error::ReductionError;

use crate::description::damping::Damping;
use crate::description::structure::SparseStructure;
use crate::factor;
use crate::lanczos::Basis;
use crate::reduced::{Asked, Checked, Reduced, ReducedError};
use work::Work;

/// Steps (1) at most.
const MOST_STEPS: usize = 6;
/// Multiples of the highest frequency of the excitation where (2) is measured; the vectors are enough where it is small at the first
/// ones.
const MULTIPLES: [f64; 8] = [0.0, 1.0, 2.0, 4.0, 8.0, 16.0, 32.0, 64.0];
const ASKED: usize = 6;
/// Of structures with more coordinates (2) is not measured at the harmonics of each orbit.
const SMALL: usize = 300;

/// How a structure is reduced.
#[derive(Debug, Clone)]
pub struct Reduction {
    to: f64,
    asked: Asked,
    cancel: Cancel,
}

impl Reduction {
    /// For excitations up to this angular frequency.
    pub fn to(omega: f64) -> Self {
        Self {
            to: omega,
            asked: Asked {
                modes: None,
                steps: None,
                tolerance: 1e-6,
            },
            cancel: Cancel::new(),
        }
    }

    /// So many modes, instead of all up to sixteen times the frequency of the excitation.
    #[must_use]
    pub fn modes(mut self, modes: usize) -> Self {
        self.asked.modes = Some(modes);
        self
    }

    /// So many steps of static vectors, instead of as many as the tolerance asks for; none are modes alone.
    #[must_use]
    pub fn steps(mut self, steps: usize) -> Self {
        self.asked.steps = Some(steps);
        self
    }

    /// Error of the compliance between contacts, loads and outputs, relative to the largest of them, up to sixteen times the frequency of the
    /// excitation.
    #[must_use]
    pub fn tolerance(mut self, tolerance: f64) -> Self {
        self.asked.tolerance = tolerance;
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
        if structure.mass.largest() == 0.0 || factor::negative(&structure.mass) > 0 {
            return Err(ReductionError::Mass);
        }
        if let Damping::Matrix(matrix) = &structure.damping {
            let count = factor::negative(matrix);
            if count > 0 {
                return Err(ReductionError::Damping { count });
            }
        }
        let work = Work::new(self, structure)?;
        let (squares, modes) = work.modes()?;
        let kept = squares.len();
        let mut basis = Basis::new(&structure.mass, modes);
        let mut last = work.directions.attached.clone();
        for step in 0..self.asked.steps.unwrap_or(MOST_STEPS) {
            last = work.attach(&mut basis, kept, last, step == 0)?;
            if self.asked.steps.is_none() && !last.is_empty() {
                let reduced = work.reduced(&squares, &basis, Vec::new());
                let error = work.checked(&reduced, MULTIPLES[ASKED - 1])?;
                if error.relative() <= self.asked.tolerance {
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

    /// Whether what was kept of a reduction is what this one would make, or what it would make for higher frequencies.
    ///
    /// # Errors
    /// If it was made for lower frequencies, or with other options.
    pub fn accepts(&self, kept: &Reduced) -> Result<(), ReducedError> {
        let (made, asked) = (kept.to(), self.to);
        if made < asked {
            return Err(ReducedError::Frequency { made, asked });
        }
        let pairs = kept.asked.said().into_iter().zip(self.asked.said());
        let mut others = pairs.filter(|(made, asked)| made != asked);
        others.next().map_or(Ok(()), |(made, asked)| {
            Err(ReducedError::Asked { made, asked })
        })
    }

    fn check(&self) -> Result<(), ReductionError> {
        for (name, value) in [("omega", self.to), ("tolerance", self.asked.tolerance)] {
            if !(value > 0.0 && value.is_finite()) {
                let must = "positive and finite";
                return Err(ReductionError::Option { name, value, must });
            }
        }
        match self.asked.modes {
            Some(0) => Err(ReductionError::Option {
                name: "modes",
                value: 0.0,
                must: "at least one",
            }),
            _ => Ok(()),
        }
    }
}

impl Reduced {
    /// The same with (2) measured at these frequencies too: between modes that are not among the vectors it changes by orders of magnitude. Of
    /// a large structure it stays interpolated.
    pub(crate) fn measured(
        &self,
        structure: &SparseStructure,
        frequencies: impl IntoIterator<Item = f64>,
        cancel: &Cancel,
    ) -> Result<Self, ReducedError> {
        if cancel.is_cancelled() {
            return Err(ReducedError::Cancelled);
        }
        let mut measured = self.clone();
        if self.coordinates > SMALL || self.vectors() == self.coordinates {
            return Ok(measured);
        }
        let options = Reduction {
            to: self.to(),
            asked: self.asked,
            cancel: cancel.clone(),
        };
        let Ok(work) = Work::new(&options, structure) else {
            return Ok(measured);
        };
        let multiples = frequencies.into_iter().map(|s| s / self.to());
        let checked = multiples.filter_map(|multiple| work.checked(self, multiple).ok());
        measured.checked.extend(checked);
        if cancel.is_cancelled() {
            return Err(ReducedError::Cancelled);
        }
        let of = |c: &Checked| c.frequency;
        measured.checked.sort_by(|a, b| of(a).total_cmp(&of(b)));
        measured.checked.dedup_by(|a, b| of(a) == of(b));
        Ok(measured)
    }
}
