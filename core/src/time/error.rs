//! Why a motion cannot be continued, or a flow not be changed.

use super::Tangent;
use crate::numeric::decimal::Decimal;
use crate::system::{System, Variable};

/// Why a motion cannot be continued.
#[derive(Clone, Copy, PartialEq)]
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
    /// The function of a section is not a number.
    Section {
        /// Where.
        phase: f64,
    },
    /// A mean was to be taken over no period at all.
    NoPeriods,
    /// More switches in one period than anything that moves has: chatter.
    TooManySwitches {
        /// Where.
        phase: f64,
        /// How many.
        switches: usize,
    },
    /// More steps in one period than the motion is worth: a force that changes on a scale which they do not reach.
    TooManySteps {
        /// Where.
        phase: f64,
        /// How many.
        steps: usize,
    },
    /// The motion rests on a level at which the force jumps, held by the jump: it sticks.
    Rests {
        /// Where.
        phase: f64,
    },
    /// A gap touches a level at which the force jumps, without speed: the motion has no derivative there.
    Grazes {
        /// Where.
        phase: f64,
    },
    /// The mass matrix is singular.
    SingularMass {
        /// Its determinant.
        determinant: f64,
    },
    /// There is no such variable, or it cannot have this value.
    Value {
        /// What was to be set.
        variable: Variable,
        /// To what.
        value: f64,
    },
    /// The levels of a law are not in increasing order, or not finite.
    Levels {
        /// Position of the first contact with this law.
        contact: usize,
    },
    /// A state has another number of entries than the system, or a tangent does not have whole columns of that many.
    Entries {
        /// Entries given.
        entries: usize,
        /// Twice the number of coordinates.
        expected: usize,
    },
}

crate::error::sentence_as_debug! {
    FlowError:
    StepTooShort { phase, step }
    NotFinite { phase }
    Section { phase }
    NoPeriods {}
    TooManySwitches { phase, switches }
    TooManySteps { phase, steps }
    Rests { phase }
    Grazes { phase }
    SingularMass { determinant }
    Value { variable, value }
    Levels { contact }
    Entries { entries, expected }
    ;
}

impl FlowError {
    /// As numbers: which one it is, and what it carries.
    pub(crate) fn numbers(self) -> [f64; 3] {
        match self {
            Self::StepTooShort { phase, step } => [1.0, phase, step],
            Self::NotFinite { phase } => [2.0, phase, 0.0],
            Self::TooManySwitches { phase, switches } => [3.0, phase, switches as f64],
            Self::Rests { phase } => [4.0, phase, 0.0],
            Self::Grazes { phase } => [5.0, phase, 0.0],
            Self::SingularMass { determinant } => [6.0, determinant, 0.0],
            Self::Value { variable, value } => match variable {
                Variable::Omega => [7.0, value, 0.0],
                Variable::Parameter(index) => [8.0, value, index as f64],
            },
            Self::Levels { contact } => [9.0, contact as f64, 0.0],
            Self::Entries { entries, expected } => [10.0, entries as f64, expected as f64],
            Self::Section { phase } => [11.0, phase, 0.0],
            Self::NoPeriods => [12.0, 0.0, 0.0],
            Self::TooManySteps { phase, steps } => [13.0, phase, steps as f64],
        }
    }

    /// From [`numbers`](Self::numbers).
    pub(crate) fn of_numbers([kind, a, b]: [f64; 3]) -> Option<Self> {
        Some(match kind as usize {
            1 => Self::StepTooShort { phase: a, step: b },
            2 => Self::NotFinite { phase: a },
            3 => Self::TooManySwitches {
                phase: a,
                switches: b as usize,
            },
            4 => Self::Rests { phase: a },
            5 => Self::Grazes { phase: a },
            6 => Self::SingularMass { determinant: a },
            7 => Self::Value {
                variable: Variable::Omega,
                value: a,
            },
            8 => Self::Value {
                variable: Variable::Parameter(b as usize),
                value: a,
            },
            9 => Self::Levels {
                contact: a as usize,
            },
            10 => Self::Entries {
                entries: a as usize,
                expected: b as usize,
            },
            11 => Self::Section { phase: a },
            12 => Self::NoPeriods,
            13 => Self::TooManySteps {
                phase: a,
                steps: b as usize,
            },
            _ => return None,
        })
    }

    /// The same at another phase.
    pub(crate) fn moved(mut self, to: impl Fn(f64) -> f64) -> Self {
        match &mut self {
            Self::StepTooShort { phase, .. }
            | Self::NotFinite { phase }
            | Self::Section { phase }
            | Self::TooManySwitches { phase, .. }
            | Self::TooManySteps { phase, .. }
            | Self::Rests { phase }
            | Self::Grazes { phase } => *phase = to(*phase),
            Self::SingularMass { .. }
            | Self::NoPeriods
            | Self::Value { .. }
            | Self::Levels { .. }
            | Self::Entries { .. } => {}
        }
        self
    }
}

/// Whether a variable of a system may have a value.
pub(crate) fn admits(system: &dyn System, variable: Variable, value: f64) -> bool {
    match variable {
        Variable::Omega => value > 0.0 && value.is_finite(),
        Variable::Parameter(index) => {
            let parameter = system.facts().parameters.get(index);
            parameter.is_some_and(|parameter| parameter.admits(value))
        }
    }
}

/// A variable that there is gets a finite value, and a frequency a positive one.
pub(crate) fn check_value(
    system: &dyn System,
    variable: Variable,
    value: f64,
) -> Result<(), FlowError> {
    let usable = match variable {
        Variable::Omega => value > 0.0,
        Variable::Parameter(index) => index < system.facts().parameters.len(),
    };
    if usable && value.is_finite() {
        Ok(())
    } else {
        Err(FlowError::Value { variable, value })
    }
}

/// A state has the entries of so many coordinates, and a tangent has whole columns of as many.
pub(crate) fn check_entries(
    coordinates: usize,
    state: &[f64],
    tangent: Option<&Tangent>,
) -> Result<(), FlowError> {
    let expected = 2 * coordinates;
    if state.len() != expected {
        let entries = state.len();
        return Err(FlowError::Entries { entries, expected });
    }
    let Some(Tangent { columns, by }) = tangent else {
        return Ok(());
    };
    let entries = columns.len();
    if entries % expected == 0 && (by.is_none() || entries > 0) {
        Ok(())
    } else {
        Err(FlowError::Entries { entries, expected })
    }
}

impl std::fmt::Display for FlowError {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::StepTooShort { phase, step } => {
                write!(f, "the step fell to {step:.1e} at the phase {phase}")
            }
            Self::NotFinite { phase } => write!(f, "the motion is not finite at the phase {phase}"),
            Self::Section { phase } => write!(
                f,
                "the function of the section is not a number at the phase {phase}"
            ),
            Self::NoPeriods => write!(f, "there is no mean over no periods: take one or more"),
            Self::TooManySwitches { phase, switches } => {
                write!(
                    f,
                    "{switches} switches within one period at the phase {phase}"
                )
            }
            Self::TooManySteps { phase, steps } => write!(
                f,
                "{steps} steps within one period at the phase {phase}: the force changes on a scale that they do not reach"
            ),
            Self::Rests { phase } => write!(
                f,
                "the motion rests on a level at which the force jumps, at the phase {phase}"
            ),
            Self::Grazes { phase } => write!(
                f,
                "a gap touches a level at which the force jumps, at the phase {phase}: the motion has no derivative there"
            ),
            Self::SingularMass { determinant } => {
                write!(
                    f,
                    "the mass matrix is singular: its determinant is {determinant:e}"
                )
            }
            Self::Value {
                variable: Variable::Omega,
                value,
            } => write!(
                f,
                "omega = {}: must be positive and finite",
                Decimal::plain(*value)
            ),
            Self::Value {
                variable: Variable::Parameter(index),
                value,
            } => write!(
                f,
                "parameter {} cannot be {}: it is outside its range, or there is no such parameter",
                index + 1,
                Decimal::plain(*value)
            ),
            Self::Levels { contact } => write!(
                f,
                "the levels of the law of contact {} are not in increasing order",
                contact + 1
            ),
            Self::Entries { entries, expected } => write!(
                f,
                "{entries} entries instead of {expected}, or whole columns of as many"
            ),
        }
    }
}

impl std::error::Error for FlowError {}
