//! Why a study cannot be made, or why it ended.

use std::fmt;
use std::io;
use std::path::PathBuf;

use hertzian::power::Instructions;

/// Why there is no study, or no result of one.
#[derive(thiserror::Error)]
#[non_exhaustive]
pub enum StudyError {
    /// The study file is not one.
    #[error("{}:{line}:{column}: {message}", .path.display())]
    File {
        /// Its path.
        path: PathBuf,
        /// The line, from one on.
        line: usize,
        /// The column, from one on.
        column: usize,
        /// What is wrong.
        message: String,
    },
    /// A value in it cannot be used.
    #[error("{key}: {message}")]
    Value {
        /// Where it stands, as `variants.over.zeta`.
        key: String,
        /// What is wrong.
        message: String,
    },
    /// The request is refused.
    #[error("request")]
    Request(#[source] hertzian::Error),
    /// The processor does not have the instruction set that the study is pinned to, or another one is in use already.
    #[error(
        "the study is pinned to the instructions `{}`, and this process has `{}`: results would differ in their last digits",
        .pinned.name(),
        .found.name()
    )]
    Instructions {
        /// What the study says.
        pinned: Instructions,
        /// What is in use.
        found: Instructions,
    },
    /// A file cannot be read or written.
    #[error("cannot use {}", .path.display())]
    Io {
        /// Its path.
        path: PathBuf,
        /// What the system said.
        source: io::Error,
    },
    /// The folder holds the results of another study.
    #[error(
        "{} holds results of another study: {difference}; give another folder, or remove that one",
        .folder.display()
    )]
    Other {
        /// The folder.
        folder: PathBuf,
        /// The first line that differs.
        difference: String,
    },
    /// Threads cannot be started.
    #[error("cannot start {threads} threads: {message}")]
    Threads {
        /// How many were asked for.
        threads: usize,
        /// Why not.
        message: String,
    },
    /// There is no such part.
    #[error("no part {number} of {of}: parts are 1/{of} to {of}/{of}")]
    Part {
        /// Its number.
        number: usize,
        /// How many there are.
        of: usize,
    },
}

impl StudyError {
    /// Of a value that stands at a key of the study file.
    pub(crate) fn value(key: impl Into<String>, message: impl Into<String>) -> Self {
        let (key, message) = (key.into(), message.into());
        Self::Value { key, message }
    }

    /// Of a file that the system does not give.
    pub(crate) fn io(path: impl Into<PathBuf>, source: io::Error) -> Self {
        let path = path.into();
        Self::Io { path, source }
    }
}

/// The sentence with its sources, as of every error.
impl fmt::Debug for StudyError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        fmt::Display::fmt(&hertzian::error::chain(self), f)
    }
}
