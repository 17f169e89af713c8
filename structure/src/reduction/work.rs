//! What a reduction works with: factors of the matrices, modes, vectors of (1), and the error (2). Numbers of equations are those of
//! [`super`].

use super::Reduction;
use super::directions::Directions;
use super::error::{ReductionError, singular};
use crate::description::structure::SparseStructure;
use crate::factor::{Factor, Ordering};
use crate::lanczos::{self, Basis, Missing};
use crate::matrix::SparseMatrix;
use crate::reduced::{Checked, Reduced};

/// Modes are kept up to so many times the highest frequency of the excitation.
const COVERED: f64 = 16.0;
/// More modes than this are asked for by their number.
const MOST_MODES: usize = 200;
/// A new vector must have this part of it besides the others.
const DEPENDENT: f64 = 1e-7;
/// A frequency that is this part of the excitation's, squared, is that of a rigid mode.
const RIGID: f64 = 1e-8;
/// A stiffness matrix has rigid modes where a pivot is this part of the largest entry.
const SOFT: f64 = 1e-9;
/// A frequency in resonance is moved by this part.
const ASIDE: f64 = 3e-3;

/// What a reduction works with.
pub(super) struct Work<'r> {
    pub(super) options: &'r Reduction,
    pub(super) structure: &'r SparseStructure,
    order: Ordering,
    pub(super) factor: Factor,
    pub(super) shift: f64,
    pub(super) directions: Directions,
}

impl<'r> Work<'r> {
    pub(super) fn new(
        options: &'r Reduction,
        structure: &'r SparseStructure,
    ) -> Result<Self, ReductionError> {
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
        if let Some(modes) = self.options.asked.modes {
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
    pub(super) fn modes(&self) -> Result<(Vec<f64>, Vec<Vec<f64>>), ReductionError> {
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
    pub(super) fn attach(
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

    /// (2) at a multiple of the frequency of the excitation.
    pub(super) fn checked(
        &self,
        reduced: &Reduced,
        multiple: f64,
    ) -> Result<Checked, ReductionError> {
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
