//! Branches as JSON, with feature `serde`.
//!
//! A file is one object with a `version` and a list `branches`; what else it holds is of whoever wrote it: the program adds a summary.

use std::path::Path;

use serde::de::DeserializeOwned;
use serde::{Deserialize, Serialize};

use crate::branches::branch::Branch;
use crate::error::Error;
use crate::report::checkpoint;
use crate::report::error::FileError;

/// The version of what is written: files of another one are not read.
pub const JSON_VERSION: u32 = 2;

#[derive(Deserialize)]
struct Head {
    /// The first version wrote none.
    version: Option<u32>,
}

#[derive(Serialize)]
struct Written<'b> {
    version: u32,
    branches: [&'b Branch; 1],
}

#[derive(Deserialize)]
struct Read {
    branches: Vec<Branch>,
}

/// What is in a file.
///
/// # Errors
/// If it cannot be read.
pub(crate) fn contents(path: &Path) -> Result<Vec<u8>, FileError> {
    std::fs::read(path).map_err(|source| FileError::Read {
        path: path.to_path_buf(),
        kind: source.kind(),
    })
}

/// Why a text is none of what is read.
fn refused(path: &Path, text: &[u8], source: &serde_json::Error) -> FileError {
    let path = path.to_path_buf();
    // Where it ends within a number, the number is at fault.
    let begins = text.trim_ascii_start().starts_with(b"{");
    let ends = text.trim_ascii_end().ends_with(b"}");
    if source.is_eof() || (begins && !ends) {
        return FileError::Truncated { path };
    }
    let reason = source.to_string();
    FileError::Format { path, reason }
}

/// A text is of the version that is read.
///
/// # Errors
/// If it is of another one, or none at all.
fn check_version(path: &Path, text: &[u8]) -> Result<(), FileError> {
    let head = serde_json::from_slice(text).map_err(|source| refused(path, text, &source));
    let Head { version } = head?;
    is_read(path, version.unwrap_or(1))
}

/// Files of this version alone are read.
fn is_read(path: &Path, version: u32) -> Result<(), FileError> {
    if version == JSON_VERSION {
        return Ok(());
    }
    Err(FileError::Version {
        path: path.to_path_buf(),
        version,
        expected: JSON_VERSION,
    })
}

/// What a file of one object has, if it is of the version that is read.
///
/// # Errors
/// If it cannot be read, is of another version, or has something else.
pub(crate) fn read<T: DeserializeOwned>(path: &Path) -> Result<T, FileError> {
    let text = contents(path)?;
    check_version(path, &text)?;
    serde_json::from_slice(&text).map_err(|source| refused(path, &text, &source))
}

/// Writes what a file has as JSON.
///
/// # Errors
/// If the file cannot be written.
pub(crate) fn write(path: &Path, written: &impl Serialize) -> Result<(), FileError> {
    let failed = |source: std::io::Error| FileError::not_written(path, &source);
    let mut text = serde_json::to_vec(written).map_err(|source| failed(source.into()))?;
    text.push(b'\n');
    hertzian_file::write(path, text).map_err(failed)
}

impl Branch {
    /// Writes it as JSON: an object with a `version` and a list `branches`, of this one. Fields have the names that they have here.
    /// Numbers read back to the same bits; of those that JSON does not have, `"inf"`, `"-inf"` and `"NaN"` are written, and `null`
    /// where one is not known.
    ///
    /// # Errors
    /// If the file cannot be written.
    pub fn write(&self, path: impl AsRef<Path>) -> Result<(), Error> {
        let written = Written {
            version: JSON_VERSION,
            branches: [self],
        };
        Ok(write(path.as_ref(), &written)?)
    }

    /// The first branch of a file that [`write`](Self::write) or `hertzian response --json` has written, or in which one
    /// was [kept](crate::FrequencyResponse::keep). It is equal to what was written and has no model: [`attach`](Self::attach) gives it one.
    ///
    /// # Errors
    /// If the file cannot be read, is none of these, ends early, is of another version, or holds numbers that do not belong together.
    pub fn read(path: impl AsRef<Path>) -> Result<Self, Error> {
        let path = path.as_ref();
        let none = || FileError::Format {
            path: path.to_path_buf(),
            reason: "there is no branch in it".to_owned(),
        };
        let first = Self::read_all(path)?.into_iter().next();
        Ok(first.ok_or_else(none)?)
    }

    /// All branches of such a file, in their order there.
    ///
    /// # Errors
    /// As [`read`](Self::read).
    pub fn read_all(path: impl AsRef<Path>) -> Result<Vec<Self>, Error> {
        let path = path.as_ref();
        let text = contents(path)?;
        let refused = |source: serde_json::Error| refused(path, &text, &source);
        if let Some(kept) = checkpoint::read(&text) {
            is_read(path, kept.version)?;
            let branch = kept.branch().and_then(Self::checked).map_err(refused)?;
            return Ok(vec![branch]);
        }
        check_version(path, &text)?;
        let Read { branches } = serde_json::from_slice(&text).map_err(refused)?;
        let branches = branches.into_iter().map(Self::checked);
        let branches: serde_json::Result<Vec<Self>> = branches.collect();
        Ok(branches.map_err(refused)?)
    }
}
