//! Motion in time: from a state at one phase to the state at a later one, through every switch.
//!
//! Time is measured by the phase `tau = omega t / divisor` of the system's own waves, so that `2 pi` is its period whatever
//! the frequency. A state is `(q, dq/dt)`: coordinates, then their derivatives by *time*.

#[doc(hidden)]
pub mod affine;
pub mod history;
pub mod poincare;
pub mod stroboscope;

pub(crate) mod centred;
pub(crate) mod divergence;
mod error;
mod field;
pub(crate) mod gap;
mod integrated;
pub(crate) mod signals;
#[cfg(test)]
mod tests;

pub use error::FlowError;
pub(crate) use error::MotionError;
#[doc(hidden)]
pub use integrated::Integrated;

use crate::cancel::Cancel;
use crate::error::Error;
use crate::model;
use crate::system::{System, Variable};

/// What is shown every smooth stretch of a motion.
pub(crate) type See<'s> = &'s mut (dyn FnMut(&dyn Stretch) + 's);

/// What is shown the number of a phase, and the state and the columns of the tangent there.
pub(crate) type Show<'s> = &'s mut (dyn FnMut(usize, &[f64], &[f64]) + 's);

/// The flow of one system, at values of its parameters and of `omega` that can be changed.
///
/// Nothing is remembered between calls but room: the same call gives the same bits.
pub trait Flow: Send {
    /// Number of coordinates `n`; a state has `2 n` entries.
    fn coordinates(&self) -> usize;

    /// Whether a variable may have a value: a parameter in its declared range, a positive and finite frequency.
    fn admits(&self, variable: Variable, value: f64) -> bool;

    /// Changes the frequency or a parameter. The declared range is not asked for, so that a search may look beyond its end:
    /// see [`admits`](Self::admits).
    ///
    /// # Errors
    /// If there is no such parameter, the value is not finite, a frequency is not positive, levels would be out of order, or the
    /// mass matrix would be singular. The flow is then as before.
    fn set(&mut self, variable: Variable, value: f64) -> Result<(), FlowError>;

    /// Ends motions when this token is cancelled, with [`FlowError::Cancelled`]: every step and every switch looks at it.
    fn until(&mut self, cancel: &Cancel);

    /// Moves a state from a phase to another one, and the tangent with it; back in time if that is an earlier one. Every smooth
    /// stretch of the motion is shown to `see` once it is complete, in order and without gaps.
    ///
    /// # Errors
    /// If the motion cannot be continued, or was cancelled: state and tangent are then those of the phase that the error tells. If the state or the
    /// tangent has the wrong number of entries: nothing has moved then.
    fn advance(
        &mut self,
        from: f64,
        to: f64,
        state: &mut [f64],
        tangent: Option<&mut Tangent>,
        see: Option<See<'_>>,
    ) -> Result<(), FlowError>;

    /// As [`advance`](Self::advance) with a tangent, which is shown with the state at phases between, in the order of the motion: with the
    /// number of the phase. A flow that knows both between its own steps makes none shorter for them.
    ///
    /// Stops are finite and in the order in which the motion passes them; one that is not between the ends is taken for the nearest place that is
    /// left. The tangent is that by the state at `from`. A stop that is on a switch, but for rounding, is before or behind it: who needs one side
    /// of a jump stops beside it. Each stop is shown once, unless the motion ends before it.
    ///
    /// # Errors
    /// As there.
    fn advance_by(
        &mut self,
        ends: [f64; 2],
        stops: &[f64],
        state: &mut [f64],
        tangent: &mut Tangent,
        show: Show<'_>,
    ) -> Result<(), FlowError> {
        from_stop_to_stop(self, ends, stops, state, tangent, show)
    }

    /// Whether it is a closed form, which is exact to rounding whatever tolerance was asked for.
    fn is_closed_form(&self) -> bool {
        false
    }

    /// The work done since the flow was made.
    fn work(&self) -> Work;
}

/// Moves from one stop to the next: [`Flow::advance_by`] of a flow that knows nothing between its ends.
pub(crate) fn from_stop_to_stop<F: Flow + ?Sized>(
    flow: &mut F,
    [from, to]: [f64; 2],
    stops: &[f64],
    state: &mut [f64],
    tangent: &mut Tangent,
    show: Show<'_>,
) -> Result<(), FlowError> {
    let mut here = from;
    for (number, &stop) in stops.iter().enumerate() {
        let next = stop.max(here.min(to)).min(here.max(to));
        if next != here {
            flow.advance(here, next, state, Some(tangent), None)?;
        }
        show(number, state, &tangent.columns);
        here = next;
    }
    flow.advance(here, to, state, Some(tangent), None)
}

/// The flow of a system at a frequency, at the values that its parameters have: in closed form if every force is affine on
/// each of its pieces and nothing else varies in time, otherwise by numerical integration.
///
/// The tolerance is the error allowed in a state, relative to the largest states of the motion; from `1e-14` to `1e-2`. A closed form is
/// always exact to rounding.
///
/// ```
/// use std::f64::consts::TAU;
/// use hertzian::time;
/// use hertzian::time::Tangent;
///
/// hertzian::oscillator! {
///     Contact(x) {
///         param zeta in 0.0..;
///         param drive;
///         law contact(gap) { gap > 0 => 2*zeta*dot(gap) + gap^1.5, else => 0 }
///         ddot(x) + contact(x) = 1 + drive*cos(omega*t);
///     }
/// }
///
/// let model = Contact { zeta: 0.05, drive: 0.5 };
/// let mut flow = time::of(&model, 0.8, 1e-10)?;
/// let mut state = [1.0, 0.0];
/// for _ in 0..200 {
///     flow.advance(0.0, TAU, &mut state, None, None)?;
/// }
/// // The motion has settled: it comes back after a period, and its derivatives by where it began are those of a contraction.
/// let before = state;
/// let mut tangent = Tangent::of_state(1, None);
/// flow.advance(0.0, TAU, &mut state, Some(&mut tangent), None)?;
/// assert!((state[0] - before[0]).abs() < 1e-8);
/// let [a, b, c, d] = tangent.columns[..] else { unreachable!() };
/// assert!(a * d - b * c < 1.0);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # Errors
/// If a parameter, the frequency or the tolerance is outside its range, the levels of a law are out of order, the mass matrix is
/// singular, or the system has no coordinates.
pub fn of(system: &dyn System, omega: f64, tolerance: f64) -> Result<Box<dyn Flow>, Error> {
    at(system, &model::values(system), omega, tolerance)
}

/// As [`of`], at given values of the parameters.
///
/// # Errors
/// As [`of`], and if there are not as many values as parameters.
pub fn at(
    system: &dyn System,
    values: &[f64],
    omega: f64,
    tolerance: f64,
) -> Result<Box<dyn Flow>, Error> {
    let system = system.shared();
    let integrated = Integrated::new(&system, values, omega, tolerance)?;
    Ok(match affine::Affine::new(&system, values, omega) {
        Ok(affine) => Box::new(affine),
        Err(_) => Box::new(integrated),
    })
}

/// Derivatives of a state, moved along with it.
#[derive(Debug, Clone, PartialEq)]
pub struct Tangent {
    /// Derivatives by the initial state or along chosen directions: columns of `2 n` entries, one after the other.
    pub columns: Vec<f64>,
    /// The variables that the last columns are the derivatives by, at fixed phase, in their order; without any all columns are homogeneous.
    pub by: Vec<Variable>,
}

impl Tangent {
    /// The derivatives by the initial state at the phase where it is given: the unit matrix. For every variable, a column of
    /// zeros more: `None`, `Some(variable)`, or several.
    pub fn of_state(coordinates: usize, by: impl IntoIterator<Item = Variable>) -> Self {
        let order = 2 * coordinates;
        let by: Vec<Variable> = by.into_iter().collect();
        let mut columns = vec![0.0; order * (order + by.len())];
        for i in 0..order {
            columns[i * order + i] = 1.0;
        }
        Self { columns, by }
    }

    /// Columns that are not derivatives by a variable, of so many entries.
    pub(crate) fn homogeneous(&self, order: usize) -> usize {
        self.columns.len() / order - self.by.len()
    }
}

/// A stretch of motion without switches.
pub trait Stretch {
    /// Its first and its last phase, in the order in which the motion passed them.
    fn phases(&self) -> (f64, f64);

    /// Writes the state at a phase between them, as accurate as the motion itself.
    fn state(&self, phase: f64, state: &mut [f64]);
}

/// What a flow has done.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[non_exhaustive]
pub struct Work {
    /// Steps, or stretches where a closed form needs none.
    pub steps: usize,
    /// Steps tried again with a smaller length.
    pub rejected: usize,
    /// Evaluations of forces at one instant.
    pub forces: usize,
    /// Crossings of levels.
    pub switches: usize,
}

// Counts of a continuation (`Statistics`) and of multipliers (`Cost`) are summed alike: other counts, of rooms that know no other.
impl std::ops::AddAssign for Work {
    fn add_assign(&mut self, other: Self) {
        self.steps += other.steps;
        self.rejected += other.rejected;
        self.forces += other.forces;
        self.switches += other.switches;
    }
}
