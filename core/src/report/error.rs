//! Why a result is not in its file, or cannot be had from it.

use std::io;
use std::path::PathBuf;

use crate::error::{Error, ErrorKind};

/// Why a result is not in its file, or cannot be had from it.
#[derive(Clone, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum FileError {
    /// A file could not be written.
    #[error("cannot write {}: {kind}", .path.display())]
    Write {
        /// Its path.
        path: PathBuf,
        /// What the system said.
        kind: io::ErrorKind,
    },
    /// A file could not be read.
    #[error("cannot read {}: {kind}", .path.display())]
    Read {
        /// Its path.
        path: PathBuf,
        /// What the system said.
        kind: io::ErrorKind,
    },
    /// A file ends before what was written does.
    #[error("{} ends early: it is a part of a file", .path.display())]
    Truncated {
        /// Its path.
        path: PathBuf,
    },
    /// A file is none of branches.
    #[error("{} is no file of branches: {reason}", .path.display())]
    Format {
        /// Its path.
        path: PathBuf,
        /// What is not as it must be, and where.
        reason: String,
    },
    /// A file was written by another version.
    #[error("{} is of version {version}, and files of version {expected} are read", .path.display())]
    Version {
        /// Its path.
        path: PathBuf,
        /// Its version.
        version: u32,
        /// That of the files that are read.
        expected: u32,
    },
}

crate::error::sentence_as_debug! {
    FileError:
    Write { path, kind }
    Read { path, kind }
    Truncated { path }
    Format { path, reason }
    Version { path, version, expected }
    ;
}

impl From<FileError> for Error {
    fn from(error: FileError) -> Self {
        Self::new(ErrorKind::File, error)
    }
}
