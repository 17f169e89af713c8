//! Rigid motions that nothing damps, as the shaft of two gears: they are known without integration.
//!
//! If no damping sees a rigid direction either, `C r = 0` and `w^T C = 0`, `W^T` times the equations of motion is
//!
//! ```text
//! (P q)'' = R (W^T M R)^-1 W^T f                                                                              (1)
//! ```
//!
//! whatever the rest of the system does. A shift along `R`, and a constant velocity along it, change no force. Of all motions that differ by
//! these alone one is periodic with a mean of zero: with the waves of the load, `f_h` at `h` times the base frequency,
//!
//! ```text
//! P q = - sum over h of R (W^T M R)^-1 W^T f_h(tau) / (h omega)^2                                              (2)
//! ```
//!
//! and the balance has the same one. A state gets it by
//!
//! ```text
//! q -> q - P q + (2),     q' -> q' - P q' + (2)'                                                               (3)
//! ```
//!
//! which leaves an orbit as it is and takes the multipliers of the rigid motions to zero.

use nalgebra::{DMatrix, DVector, DVectorView};

use super::{LOOKED_AT, Place, Rigid, free};
use crate::error::Error;
use crate::model::error::ModelError;
use crate::model::layout::Layout;
use crate::system::{Part, Wave};

/// Products with `R` or `W` that cancel to this part of their sizes are zero.
const ZERO: f64 = 1e-12;

/// The rigid motion of a system at values of its parameters.
#[derive(Debug, Clone)]
pub(crate) struct Centre {
    /// `P`
    projector: DMatrix<f64>,
    /// Waves of the load, each with the acceleration that it gives, (1).
    driven: Vec<(Wave, DVector<f64>)>,
    /// Base frequency, that of a wave of one
    base: f64,
    /// How many multipliers (3) takes to zero.
    multipliers: usize,
}

impl Centre {
    /// The rigid motion where the variable has its value; `None` if there is none, loads carry it away, or it is damped.
    pub(crate) fn at(place: Place<'_>) -> Option<Self> {
        let rigid = Rigid::beside(place)?;
        let Place { layout, omega, .. } = place;
        let coefficients = place.coefficients(place.value());
        let [positions, velocities] = &rigid.complements;
        let is_damped = positions.ncols() != velocities.ncols()
            || !is_blind(&rigid.response, layout, &coefficients);
        if is_damped {
            return None;
        }
        let waves = layout.load.iter().filter(|load| load.wave.harmonic > 0);
        let driven = waves.map(|load| {
            let acceleration = rigid.response.column(load.row) * coefficients[load.coefficient];
            (load.wave, acceleration)
        });
        Some(Self {
            driven: driven.filter(|(_, part)| part.amax() > 0.0).collect(),
            base: omega / f64::from(place.system.facts().divisor),
            multipliers: rigid.multipliers(),
            projector: rigid.projector,
        })
    }

    /// Whether there is a rigid motion that is known throughout a range; it is not where there is none.
    ///
    /// # Errors
    /// [`ModelError::CarriedAway`], or [`ModelError::Free`] where something damps it, so that it is not known.
    pub(crate) fn over(place: Place<'_>, range: [f64; 2]) -> Result<Option<Self>, Error> {
        let Some(direction) = free(place, range)? else {
            return Ok(None);
        };
        let [from, to] = range;
        let mut found = None;
        for part in LOOKED_AT {
            let value = from + part * (to - from);
            let mut parameters = place.parameters.to_vec();
            let there = place.moved(value, &mut parameters);
            let Some(centre) = Self::at(there) else {
                return Err(ModelError::Free { direction }.into());
            };
            found = Some(centre);
        }
        Ok(found)
    }

    /// How many multipliers (3) takes to zero.
    pub(crate) fn multipliers(&self) -> usize {
        self.multipliers
    }

    /// (3) of a state at a phase.
    pub(crate) fn take(&self, phase: f64, state: &mut [f64]) {
        self.take_homogeneous(state);
        let n = self.projector.nrows();
        let (positions, velocities) = state.split_at_mut(n);
        for (wave, acceleration) in &self.driven {
            let rate = f64::from(wave.harmonic) * self.base;
            let (sin, cos) = (f64::from(wave.harmonic) * phase).sin_cos();
            // The wave, and its derivative by its phase.
            let (value, slope) = match wave.part {
                Part::Cosine => (cos, -sin),
                Part::Sine => (sin, cos),
            };
            for (i, part) in acceleration.iter().enumerate() {
                positions[i] -= part * value / (rate * rate);
                velocities[i] -= part * slope / rate;
            }
        }
    }

    /// What (3) does to a difference of two states.
    pub(crate) fn take_homogeneous(&self, state: &mut [f64]) {
        for part in state.chunks_exact_mut(self.projector.nrows()) {
            let rigid = &self.projector * DVectorView::from_slice(part, part.len());
            for (x, rigid) in part.iter_mut().zip(&rigid) {
                *x -= rigid;
            }
        }
    }
}

/// Whether the rigid motions, by what `response` makes of forces, know nothing of damping: `W^T C = 0` for each of its waves.
fn is_blind(response: &DMatrix<f64>, layout: &Layout, coefficients: &[f64]) -> bool {
    let n = layout.coordinates;
    layout.damping.iter().all(|entry| {
        let same = |other: &&crate::model::layout::Entry| {
            other.wave == entry.wave && other.column == entry.column
        };
        let (mut sum, mut size) = (DVector::zeros(n), DVector::zeros(n));
        for other in layout.damping.iter().filter(same) {
            let part = response.column(other.row) * coefficients[other.coefficient];
            size += part.abs();
            sum += part;
        }
        let mut pairs = sum.iter().zip(&size);
        pairs.all(|(sum, size): (&f64, &f64)| sum.abs() <= ZERO * size)
    })
}
