//! What keeps a branch as it is followed.

use std::fmt::Debug;
use std::sync::Arc;

use super::branch::{Branch, Further, Model};
use super::record::Kept;
use crate::continuation::follow::{Continue, Halt};
use crate::error::Error;

/// Keeps a branch outside of the program, point by point.
pub(crate) trait Keep: Debug + Send + Sync {
    /// Begins with a branch of this model, that varies what has this name and was asked for in this way.
    ///
    /// # Errors
    /// If it cannot be kept.
    fn begin(&self, model: &Model, varied: &str, further: &Further) -> Result<(), Error>;

    /// Keeps what the branch has now. What it goes on from is written where it is wanted. Says whether that could be done; what could not
    /// be kept is told by [`failure`](Self::failure).
    fn keep(&self, kept: Kept<'_>, rest: &dyn Rest) -> bool;

    /// Keeps the branch as it has ended.
    fn end(&self, branch: &Branch) -> bool;

    /// Why it could not be kept.
    fn failure(&self) -> Option<Error>;
}

/// What a branch goes on from.
pub(crate) trait Rest {
    /// As JSON.
    #[cfg(feature = "serde")]
    fn written(&self) -> serde_json::Result<serde_json::Value>;
}

#[cfg(feature = "serde")]
impl<T: serde::Serialize> Rest for T {
    fn written(&self) -> serde_json::Result<serde_json::Value> {
        serde_json::to_value(self)
    }
}

#[cfg(not(feature = "serde"))]
impl<T> Rest for T {}

/// Keeps what a branch has now, if that is wanted; the walk ends where it cannot be done.
pub(crate) fn keep(by: Option<&Arc<dyn Keep>>, kept: Kept<'_>, rest: &dyn Rest) -> Continue {
    if by.is_none_or(|by| by.keep(kept, rest)) {
        Continue::Continue(())
    } else {
        Continue::Break(Halt::Stop)
    }
}
