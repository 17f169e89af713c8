//! Why there is no fit.

use std::fmt;

/// Why there is no fit.
#[derive(thiserror::Error)]
#[non_exhaustive]
pub enum FitError {
    /// A data set cannot be used.
    #[error("data set {set}: {message}")]
    Data {
        /// Its name.
        set: String,
        /// What is wrong.
        message: String,
    },
    /// A table cannot be used.
    #[error("line {line}: {message}")]
    Table {
        /// The line, from one on.
        line: u64,
        /// What is wrong.
        message: String,
    },
    /// Nothing can be fitted.
    #[error("{message}")]
    Nothing {
        /// Why not.
        message: &'static str,
    },
    /// A parameter cannot be free as it was asked for.
    #[error("free parameter {name}: {message}")]
    Free {
        /// Its name.
        name: String,
        /// What is wrong.
        message: String,
    },
    /// More is unknown than is measured.
    #[error("{parameters} parameters are free, and there are only {measured} measured values")]
    TooFew {
        /// Measured values.
        measured: usize,
        /// Free parameters.
        parameters: usize,
    },
    /// From no start the curves could be followed.
    #[error("no curve could be followed from {tried} starts; from the first: {reason}")]
    NoStart {
        /// How many were tried.
        tried: usize,
        /// Why the first one failed.
        reason: String,
    },
    /// Nothing was found before it was cancelled.
    #[error("cancelled before anything was found")]
    Cancelled,
    /// What is asked of the model is refused.
    #[error(transparent)]
    Request(#[from] hertzian::Error),
}

impl FitError {
    pub(crate) fn data(set: &str, message: impl Into<String>) -> Self {
        let (set, message) = (set.to_owned(), message.into());
        Self::Data { set, message }
    }

    pub(crate) fn free(name: &str, message: impl Into<String>) -> Self {
        let (name, message) = (name.to_owned(), message.into());
        Self::Free { name, message }
    }
}

/// The sentence with its sources, as of every error.
impl fmt::Debug for FitError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        fmt::Display::fmt(&hertzian::error::chain(self), f)
    }
}
