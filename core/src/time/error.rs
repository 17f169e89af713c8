//! Why a motion cannot be continued, or a flow not be changed.

use super::Tangent;
use crate::error::{Error, ErrorKind, Room};
use crate::numeric::decimal::Decimal;
use crate::system::{System, Variable};

/// Why a motion cannot be continued.
#[derive(Clone, Copy, PartialEq, thiserror::Error)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(rename_all = "kebab-case"))]
#[non_exhaustive]
pub enum FlowError {
    /// The tolerance asks for steps that vanish beside the phase.
    #[error("the step fell to {step:.1e} at the phase {phase}")]
    StepTooShort {
        /// Where.
        #[cfg_attr(feature = "serde", serde(with = "crate::serialise"))]
        phase: f64,
        /// The last step tried.
        #[cfg_attr(feature = "serde", serde(with = "crate::serialise"))]
        step: f64,
    },
    /// A state, a force or a derivative is not a number.
    #[error("the motion is not finite at the phase {phase}")]
    NotFinite {
        /// Where.
        #[cfg_attr(feature = "serde", serde(with = "crate::serialise"))]
        phase: f64,
    },
    /// The function of a section is not a number.
    #[error("the function of the section is not a number at the phase {phase}")]
    Section {
        /// Where.
        #[cfg_attr(feature = "serde", serde(with = "crate::serialise"))]
        phase: f64,
    },
    /// The motion grew beyond the bound that was set for it.
    #[error("the motion grew beyond the bound")]
    Escaped,
    /// A mean was to be taken over no period at all.
    #[error("there is no mean over no periods: take one or more")]
    NoPeriods,
    /// More switches in one period than anything that moves has: chatter.
    #[error("{switches} switches within one period at the phase {phase}")]
    TooManySwitches {
        /// Where.
        #[cfg_attr(feature = "serde", serde(with = "crate::serialise"))]
        phase: f64,
        /// How many.
        switches: usize,
    },
    /// More steps in one period than the motion is worth: a force that changes on a scale which they do not reach.
    #[error(
        "{steps} steps within one period at the phase {phase}: the force changes on a scale that they do not reach"
    )]
    TooManySteps {
        /// Where.
        #[cfg_attr(feature = "serde", serde(with = "crate::serialise"))]
        phase: f64,
        /// How many.
        steps: usize,
    },
    /// The motion rests on a level at which the force jumps, held by the jump: it sticks.
    #[error("the motion rests on a level at which the force jumps, at the phase {phase}")]
    Rests {
        /// Where.
        #[cfg_attr(feature = "serde", serde(with = "crate::serialise"))]
        phase: f64,
    },
    /// A gap touches a level at which the force jumps, without speed: the motion has no derivative there.
    #[error(
        "a gap touches a level at which the force jumps, at the phase {phase}: the motion has no derivative there"
    )]
    Grazes {
        /// Where.
        #[cfg_attr(feature = "serde", serde(with = "crate::serialise"))]
        phase: f64,
    },
    /// The motion was [cancelled](crate::Cancel).
    #[error("cancelled at the phase {phase}")]
    Cancelled {
        /// Where.
        #[cfg_attr(feature = "serde", serde(with = "crate::serialise"))]
        phase: f64,
    },
    /// The mass matrix is singular.
    #[error("the mass matrix is singular: its determinant is {determinant:e}")]
    SingularMass {
        /// Its determinant.
        #[cfg_attr(feature = "serde", serde(with = "crate::serialise"))]
        determinant: f64,
    },
    /// There is no such variable, or it cannot have this value.
    #[error("{}", refused(*.variable, *.value))]
    Value {
        /// What was to be set.
        #[cfg_attr(feature = "serde", serde(with = "crate::serialise"))]
        variable: Variable,
        /// To what.
        #[cfg_attr(feature = "serde", serde(with = "crate::serialise"))]
        value: f64,
    },
    /// The levels of a law are not in increasing order, or not finite.
    #[error("the levels of the law of contact {} are not in increasing order", .contact + 1)]
    Levels {
        /// Position of the first contact with this law.
        contact: usize,
    },
    /// A state has another number of entries than the system, or a tangent does not have whole columns of that many.
    #[error("{entries} entries instead of {expected}, or whole columns of as many")]
    Entries {
        /// Entries given.
        entries: usize,
        /// Twice the number of coordinates.
        expected: usize,
    },
}

crate::error::room_error! {
    FlowError, FlowError::kind;
    StepTooShort { phase, step }
    NotFinite { phase }
    Section { phase }
    Escaped {}
    NoPeriods {}
    TooManySwitches { phase, switches }
    TooManySteps { phase, steps }
    Rests { phase }
    Grazes { phase }
    Cancelled { phase }
    SingularMass { determinant }
    Value { variable, value }
    Levels { contact }
    Entries { entries, expected }
    ;
}

/// No orbit was found where motions were to lead to one.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
#[error("no periodic orbit found at {}", Decimal::plain(*.value))]
pub(crate) struct MotionError {
    /// Value of what is varied.
    pub(crate) value: f64,
    /// Why the motion cannot be computed.
    #[source]
    pub(crate) reason: FlowError,
}

impl FlowError {
    fn kind(&self) -> ErrorKind {
        match self {
            Self::Value { .. } | Self::Entries { .. } | Self::NoPeriods => ErrorKind::Request,
            Self::SingularMass { .. } | Self::Levels { .. } => ErrorKind::Model,
            Self::Cancelled { .. } => ErrorKind::Cancelled,
            _ => ErrorKind::Motion,
        }
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
            | Self::Grazes { phase }
            | Self::Cancelled { phase } => *phase = to(*phase),
            Self::SingularMass { .. }
            | Self::Escaped
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
    if entries % expected == 0 && entries >= by.len() * expected {
        Ok(())
    } else {
        Err(FlowError::Entries { entries, expected })
    }
}

fn refused(variable: Variable, value: f64) -> String {
    let value = Decimal::plain(value);
    match variable {
        Variable::Omega => format!("omega = {value}: must be positive and finite"),
        Variable::Parameter(index) => format!(
            "parameter {} cannot be {value}: it is outside its range, or there is no such parameter",
            index + 1
        ),
    }
}

impl From<MotionError> for Error {
    fn from(error: MotionError) -> Self {
        Self::new(error.reason.kind(), error)
    }
}

/// It is what its reason is, at a value of what is varied.
impl Room for MotionError {
    fn variant(&self) -> &str {
        self.reason.variant()
    }

    fn append_values<'s>(&'s self, values: &mut Vec<(&'s str, f64)>) {
        values.push(("value", self.value));
        self.reason.append_values(values);
    }
}
