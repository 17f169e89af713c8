//! Why a result is not in its file.

use std::io;
use std::path::PathBuf;

use crate::error::{Error, ErrorKind};

/// Why a result is not in its file.
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
}

crate::error::sentence_as_debug! {
    FileError:
    Write { path, kind }
    ;
}

impl From<FileError> for Error {
    fn from(error: FileError) -> Self {
        Self::new(ErrorKind::File, error)
    }
}
