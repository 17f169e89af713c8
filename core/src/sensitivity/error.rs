//! Why there are no derivatives.

use crate::error::{Error, ErrorKind, room_error};
use crate::event::EventKind;
use crate::time::FlowError;

/// Why there are no derivatives of an orbit or of an event.
#[derive(Clone, PartialEq, thiserror::Error)]
pub(crate) enum SensitivityError {
    /// The place of such an event is that of another one, or none at other values of the parameters.
    #[error(
        "the place of a {kind} has no derivative here: it is that of a doubling or a broken symmetry of the branch that is met, which has, or a change of a parameter parts the branches"
    )]
    Kind {
        /// The kind of the event.
        kind: EventKind,
    },
    /// The equations of the orbit are singular: it is at a fold, or another branch crosses.
    #[error("the equations of the orbit are singular: it is at a fold, or another branch crosses")]
    Singular,
    /// The orbit was not found again.
    #[error("the orbit was not found again: the last correction was {left:.0e} of it")]
    Diverged {
        /// The last update of Newton's method relative to the orbit.
        left: f64,
    },
    /// The branch has no fold near the one that was given.
    #[error("there is no fold nearby: the search ended {moved:.0e} of the orbit's size away")]
    NoFold {
        /// How far the search went along the branch.
        moved: f64,
    },
    /// No multiplier crosses the unit circle near the event that was given.
    #[error("no multiplier crosses the unit circle nearby as it does at such an event")]
    NoCrossing,
    /// The multiplier that decides is a repeated one.
    #[error(
        "the multiplier that crosses the unit circle is a repeated one, which has no derivatives"
    )]
    Repeated,
    /// Orbits beside this one cross other levels.
    #[error(
        "multipliers have no derivatives here: motions beside the orbit, however near, cross other levels, as where a gap touches one"
    )]
    Beside,
    /// No gap comes near a level.
    #[error("no gap of the orbit has an extreme on a level")]
    NoTouch,
    /// What should be an uncertainty is none.
    #[error("{text} is no uncertainty: write zeta=0.002, or load=5% of its value")]
    Uncertainty {
        /// What was given.
        text: String,
    },
    /// The motion cannot be continued.
    #[error(transparent)]
    Motion(#[from] FlowError),
}

impl SensitivityError {
    /// Whether it was cancelled.
    pub(super) fn is_cancelled(&self) -> bool {
        matches!(self, Self::Motion(FlowError::Cancelled { .. }))
    }

    fn kind(&self) -> ErrorKind {
        match self {
            Self::Kind { .. } | Self::Uncertainty { .. } => ErrorKind::Request,
            _ if self.is_cancelled() => ErrorKind::Cancelled,
            Self::Motion(_) => ErrorKind::Motion,
            _ => ErrorKind::NoOrbit,
        }
    }
}

room_error! {
    SensitivityError;
    Kind { kind }
    Singular {}
    Diverged { left }
    NoFold { moved }
    NoCrossing {}
    Repeated {}
    Beside {}
    NoTouch {}
    Uncertainty { text }
    ;
    Motion
}

impl From<SensitivityError> for Error {
    fn from(error: SensitivityError) -> Self {
        match error {
            // The motion's own error says more.
            SensitivityError::Motion(flow) => flow.into(),
            other => Self::new(other.kind(), other),
        }
    }
}
