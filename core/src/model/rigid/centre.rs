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
//!
//! The rigid directions are the same for all values of a variable, and so are `R` and `W`. With `A = R (W^T M R)^-1 W^T`, the response, (3)
//! changes with the variable, whose derivative a dot is, by
//!
//! ```text
//! A. = - A M. A,     P. = A M. (1 - P),     (A f)_. = A (f. - M. A f)                                         (4)
//! ```

use nalgebra::{DMatrix, DVector, DVectorView};

use super::{LOOKED_AT, Place, Rigid, free};
use crate::error::Error;
use crate::model::error::ModelError;
use crate::model::layout::Layout;
use crate::system::{Part, Variable, Wave};

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
    slope: Slope,
}

/// How (3) changes with the variable of the place where it was taken, (4).
#[derive(Debug, Clone)]
struct Slope {
    variable: Variable,
    /// `P.`
    projector: DMatrix<f64>,
    /// Of each wave the derivative of its acceleration.
    driven: Vec<DVector<f64>>,
    /// Derivative of the base frequency over itself.
    stretch: f64,
}

/// Room for a product with a vector of coordinates.
pub(crate) type Room = DVector<f64>;

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
        let mut slopes = vec![0.0; coefficients.len()];
        place
            .system
            .coefficients_by(place.variable, place.parameters, omega, &mut slopes);
        let mass_slope: DMatrix<f64> = layout.mass(&slopes);
        let along_mass = &rigid.response * mass_slope;
        let waves = layout.load.iter().filter(|load| load.wave.harmonic > 0);
        let driven = waves.map(|load| {
            let response = rigid.response.column(load.row);
            let acceleration = response * coefficients[load.coefficient];
            let slope = response * slopes[load.coefficient] - &along_mass * &acceleration;
            (load.wave, acceleration, slope)
        });
        let driven = driven.filter(|(_, part, slope)| part.amax() > 0.0 || slope.amax() > 0.0);
        let (driven, driven_slopes) = driven
            .map(|(wave, part, slope)| ((wave, part), slope))
            .unzip();
        let slope = Slope {
            variable: place.variable,
            projector: &along_mass - &along_mass * &rigid.projector,
            driven: driven_slopes,
            stretch: match place.variable {
                Variable::Omega => 1.0 / omega,
                Variable::Parameter(_) => 0.0,
            },
        };
        Some(Self {
            driven,
            base: omega / f64::from(place.system.facts().divisor),
            multipliers: rigid.multipliers(),
            projector: rigid.projector,
            slope,
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

    /// The variable that [`add_slope`](Self::add_slope) is the derivative by.
    pub(crate) fn variable(&self) -> Variable {
        self.slope.variable
    }

    /// Room for its products.
    pub(crate) fn room(&self) -> Room {
        Room::zeros(self.projector.nrows())
    }

    /// (3) of a state at a phase.
    pub(crate) fn take(&self, phase: f64, state: &mut [f64], room: &mut Room) {
        self.take_homogeneous(state, room);
        let (positions, velocities) = state.split_at_mut(room.len());
        for (wave, acceleration) in &self.driven {
            let ([value, slope], rate) = (both(*wave, phase), self.rate(*wave));
            for (i, part) in acceleration.iter().enumerate() {
                positions[i] -= part * value / (rate * rate);
                velocities[i] -= part * slope / rate;
            }
        }
    }

    /// What (3) does to a difference of two states.
    pub(crate) fn take_homogeneous(&self, state: &mut [f64], room: &mut Room) {
        for part in state.chunks_exact_mut(room.len()) {
            let view = DVectorView::from_slice(part, part.len());
            room.gemv(1.0, &self.projector, &view, 0.0);
            part.iter_mut().zip(room.iter()).for_each(|(x, y)| *x -= y);
        }
    }

    /// Adds the derivative of (3) by the variable, at a phase and a state to which (3) was not applied, by (4).
    pub(crate) fn add_slope(
        &self,
        phase: f64,
        state: &[f64],
        derivative: &mut [f64],
        room: &mut Room,
    ) {
        let slope = &self.slope;
        let n = room.len();
        for (state, to) in state.chunks_exact(n).zip(derivative.chunks_exact_mut(n)) {
            let state = DVectorView::from_slice(state, n);
            room.gemv(1.0, &slope.projector, &state, 0.0);
            to.iter_mut().zip(room.iter()).for_each(|(x, y)| *x -= y);
        }
        let (positions, velocities) = derivative.split_at_mut(n);
        for ((wave, part), by) in self.driven.iter().zip(&slope.driven) {
            let ([value, forward], rate) = (both(*wave, phase), self.rate(*wave));
            for i in 0..n {
                // The frequency divides twice, and once.
                let twice = by[i] - 2.0 * slope.stretch * part[i];
                let once = by[i] - slope.stretch * part[i];
                positions[i] -= twice * value / (rate * rate);
                velocities[i] -= once * forward / rate;
            }
        }
    }

    /// The angular frequency of a wave.
    fn rate(&self, wave: Wave) -> f64 {
        f64::from(wave.harmonic) * self.base
    }
}

/// A wave, and its derivative by its own phase.
fn both(wave: Wave, phase: f64) -> [f64; 2] {
    let (sin, cos) = (f64::from(wave.harmonic) * phase).sin_cos();
    match wave.part {
        Part::Cosine => [cos, -sin],
        Part::Sine => [sin, cos],
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::system::System;

    crate::oscillator! {
        /// Two masses of which the first is pushed.
        Pushed(x, y) {
            param one = 2;
            param two = 3;
            param drive = 0.7;
            one*ddot(x) + x - y + 0.1*(dot(x) - dot(y)) = drive*cos(omega*t) + one*sin(2*omega*t);
            two*ddot(y) - x + y - 0.1*(dot(x) - dot(y)) = 0;
        }
    }

    /// `P` has the rows `[m1, m2]/m` with the sum `m` of the masses, and each load `f_h` gives `f_h/m`: derivatives by hand.
    #[test]
    fn slopes_of_two_masses_are_those_of_their_formula() {
        let model = Pushed::default();
        let layout = Layout::of(&model);
        let (omega, phase, state): (f64, f64, [f64; 4]) = (1.3, 0.9, [0.4, -0.2, 0.7, 1.1]);
        let (one, two, drive) = (model.one, model.two, model.drive);
        let sum = one + two;
        let apart = [0, 2].map(|i| state[i] - state[i + 1]);
        // The waves of both loads over squares of their frequencies, and their derivatives by time.
        let [first, second] = [1.0, 2.0].map(|h| 1.0 / (h * omega));
        let waves = [
            [phase.cos() * first * first, -phase.sin() * first],
            [
                (2.0 * phase).sin() * second * second,
                (2.0 * phase).cos() * second,
            ],
        ];
        let of = |projector: f64, by: [f64; 2]| {
            [0, 1].map(|k| -projector * apart[k] - by[0] * waves[0][k] - by[1] * waves[1][k])
        };
        let by_mass = two / (sum * sum);
        let [twice, once] = of(0.0, [drive / sum, one / sum].map(|part| -part / omega));
        for (variable, exact) in [
            (
                Variable::Parameter(0),
                of(by_mass, [-drive / (sum * sum), by_mass]),
            ),
            (Variable::Parameter(2), of(0.0, [1.0 / sum, 0.0])),
            (Variable::Omega, [2.0 * twice, once]),
        ] {
            let mut parameters = vec![0.0; 3];
            model.values(&mut parameters);
            let centre = Centre::at(Place {
                system: &model,
                layout: &layout,
                parameters: &parameters,
                omega,
                variable,
            });
            let centre = centre.expect("it turns freely");
            let (mut found, mut room) = ([0.0; 4], centre.room());
            centre.add_slope(phase, &state, &mut found, &mut room);
            for (i, found) in found.iter().enumerate() {
                let exact = exact[i / 2];
                assert!(
                    (found - exact).abs() < 1e-15,
                    "{variable:?} {found} {exact}"
                );
            }
        }
    }
}
