//! Motion in time: from a state at one phase to the state at a later one, through every switch.
//!
//! Time is measured by the phase `tau = omega t / divisor` of the system's own waves, so that `2 pi` is its period whatever
//! the frequency. A state is `(q, dq/dt)`: coordinates, then their derivatives by *time*.

pub mod affine;
#[cfg(test)]
pub mod shooting;

use crate::system::Variable;

/// What is shown every smooth stretch of a motion.
pub type See<'s> = &'s mut (dyn FnMut(&dyn Stretch) + 's);

/// The flow of one system, at values of its parameters and of `omega` that can be changed.
///
/// Nothing is remembered between calls but room: the same call gives the same bits.
pub trait Flow: Send {
    /// Number of coordinates `n`; a state has `2 n` entries.
    fn coordinates(&self) -> usize;

    /// Changes the frequency or a parameter.
    fn set(&mut self, variable: Variable, value: f64);

    /// Moves a state from a phase to a later one, and the tangent with it. Every smooth stretch of the motion is shown to
    /// `see` once it is complete, in order and without gaps.
    ///
    /// # Errors
    /// If the motion cannot be continued. State and tangent are then those of the phase that the error tells.
    fn advance(
        &mut self,
        from: f64,
        to: f64,
        state: &mut [f64],
        tangent: Option<&mut Tangent>,
        see: Option<See<'_>>,
    ) -> Result<(), FlowError>;

    /// The work done since the flow was made.
    fn work(&self) -> Work;
}

/// Derivatives of a state, moved along with it.
#[derive(Debug, Clone, PartialEq)]
pub struct Tangent {
    /// Derivatives by the initial state or along chosen directions: columns of `2 n` entries, one after the other.
    pub columns: Vec<f64>,
    /// The variable that the last column is the derivative by, at fixed phase; without one all columns are homogeneous.
    pub by: Option<Variable>,
}

impl Tangent {
    /// The derivatives by the initial state at the phase where it is given: the unit matrix. With a variable, a column of
    /// zeros more.
    pub fn of_state(coordinates: usize, by: Option<Variable>) -> Self {
        let order = 2 * coordinates;
        let mut columns = vec![0.0; order * (order + usize::from(by.is_some()))];
        for i in 0..order {
            columns[i * order + i] = 1.0;
        }
        Self { columns, by }
    }
}

/// A stretch of motion without switches.
pub trait Stretch {
    /// Its first and its last phase.
    fn phases(&self) -> (f64, f64);

    /// Writes the state at a phase between them, as accurate as the motion itself.
    fn state(&self, phase: f64, state: &mut [f64]);
}

/// What a flow has done.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
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

/// Why a motion cannot be continued.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub enum FlowError {
    /// The tolerance asks for steps that vanish beside the phase.
    StepTooShort {
        /// Where.
        phase: f64,
        /// The last step tried.
        step: f64,
    },
    /// A state, a force or a derivative is not a number.
    NotFinite {
        /// Where.
        phase: f64,
    },
    /// More switches in one period than anything that moves has: chatter.
    TooManySwitches {
        /// Where.
        phase: f64,
        /// How many.
        switches: usize,
    },
    /// The mass matrix is singular.
    SingularMass {
        /// Its determinant.
        determinant: f64,
    },
}

impl std::fmt::Display for FlowError {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::StepTooShort { phase, step } => {
                write!(f, "the step fell to {step:.1e} at the phase {phase}")
            }
            Self::NotFinite { phase } => write!(f, "the motion is not finite at the phase {phase}"),
            Self::TooManySwitches { phase, switches } => {
                write!(
                    f,
                    "{switches} switches within one period at the phase {phase}"
                )
            }
            Self::SingularMass { determinant } => {
                write!(
                    f,
                    "the mass matrix is singular: its determinant is {determinant}"
                )
            }
        }
    }
}

impl std::error::Error for FlowError {}
