//! Why there are no derivatives.

use crate::error::ErrorKind;
use crate::event::EventKind;
use crate::time::FlowError;

/// Why there are no derivatives of an orbit or of an event.
#[derive(Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum SensitivityError {
    /// The derivative of the place of such an event takes second derivatives of the motion.
    #[error(
        "the place of a {kind} has no derivative here: it takes second derivatives of the motion, which are not computed; folds and grazing have one"
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
    /// No gap comes near a level.
    #[error("no gap of the orbit has an extreme on a level")]
    NoTouch,
    /// The motion cannot be continued.
    #[error(transparent)]
    Motion(#[from] FlowError),
}

impl SensitivityError {
    fn kind(&self) -> ErrorKind {
        match self {
            Self::Kind { .. } => ErrorKind::Request,
            Self::Motion(FlowError::Cancelled { .. }) => ErrorKind::Cancelled,
            Self::Motion(_) => ErrorKind::Motion,
            _ => ErrorKind::NoOrbit,
        }
    }
}

crate::error::room_error! {
    SensitivityError, SensitivityError::kind;
    Kind { kind }
    Singular {}
    Diverged { left }
    NoFold { moved }
    NoTouch {}
    ;
    Motion
}
