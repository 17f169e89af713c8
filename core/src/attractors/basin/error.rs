//! Why there are no basins.

use crate::attractors::log::LogError;
use crate::error::{ErrorKind, room_error};
use crate::time::FlowError;

/// Why there are no basins.
#[derive(Clone, PartialEq, thiserror::Error)]
pub(crate) enum BasinError {
    /// The request is at fault.
    #[error("{name} {must}")]
    Request {
        /// What.
        name: &'static str,
        /// What it must be.
        must: &'static str,
    },
    /// The log cannot be used.
    #[error(transparent)]
    Log(#[from] LogError),
    /// The threads could not be started.
    #[cfg(feature = "parallel")]
    #[error("the system does not give {count} threads")]
    Threads {
        /// How many were asked for.
        count: usize,
    },
    /// No motion of the grid can be computed.
    #[error("no motion of the grid can be computed")]
    Motion {
        /// Why the first one cannot.
        #[source]
        reason: FlowError,
    },
}

room_error! {
    BasinError, BasinError::kind;
    Request { name, must }
    #[cfg(feature = "parallel")]
    Threads { count }
    Motion { reason }
    ;
    Log
}

impl BasinError {
    pub(crate) fn kind(&self) -> ErrorKind {
        match self {
            Self::Request { .. } => ErrorKind::Request,
            Self::Log(_) => ErrorKind::File,
            #[cfg(feature = "parallel")]
            Self::Threads { .. } => ErrorKind::System,
            Self::Motion { .. } => ErrorKind::Motion,
        }
    }
}
