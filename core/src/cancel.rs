//! Stopping a computation from elsewhere: a token that every iteration of Newton's method and every step of a motion looks at.

use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

/// A token by which computations are stopped: from another thread, from a callback, or where Ctrl-C is caught.
///
/// Clones are the same token. Everything that it was given to ends soon after [`cancel`](Self::cancel), a search for a first orbit too:
/// what is computed by then comes back with the reason, and where there is nothing yet, an error of the kind
/// [`ErrorKind::Cancelled`](crate::error::ErrorKind::Cancelled). A token is not taken back: a further computation takes a new one.
///
/// ```
/// use hertzian::Cancel;
///
/// let cancel = Cancel::new();
/// let elsewhere = cancel.clone();
/// std::thread::spawn(move || elsewhere.cancel()).join().unwrap();
/// assert!(cancel.is_cancelled());
/// ```
#[derive(Debug, Clone, Default)]
pub struct Cancel(Arc<Token>);

#[derive(Debug, Default)]
struct Token {
    cancelled: AtomicBool,
    parent: Option<Cancel>,
}

impl Cancel {
    /// A token that is not cancelled.
    pub fn new() -> Self {
        Self::default()
    }

    /// A token that is cancelled with this one, and can be without it: for a part of the work that may have to be stopped alone.
    ///
    /// ```
    /// let whole = hertzian::Cancel::new();
    /// let part = whole.child();
    /// part.cancel();
    /// assert!(part.is_cancelled() && !whole.is_cancelled());
    /// ```
    #[must_use]
    pub fn child(&self) -> Self {
        Self(Arc::new(Token {
            cancelled: AtomicBool::new(false),
            parent: Some(self.clone()),
        }))
    }

    /// Stops all that this token was given to.
    pub fn cancel(&self) {
        self.0.cancelled.store(true, Ordering::Relaxed);
    }

    /// Whether that has happened.
    #[inline]
    pub fn is_cancelled(&self) -> bool {
        // Nothing else is read because of it, so that no order with other memory is needed.
        let mut token = &self.0;
        loop {
            if token.cancelled.load(Ordering::Relaxed) {
                return true;
            }
            match &token.parent {
                Some(parent) => token = &parent.0,
                None => return false,
            }
        }
    }
}
