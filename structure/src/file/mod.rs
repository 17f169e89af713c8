//! A structure from one file, in TOML, that names its matrices and says what acts on them.
//!
//! ```toml
//! name = "cantilever"
//!
//! [matrices]
//! mass = "mass.mtx"
//! stiffness = "stiffness.mtx"
//!
//! [units]
//! length = "m"
//! force = "N"
//!
//! [damping]
//! ratio = 0.01
//!
//! [parameters]
//! drive = { value = 20.0, unit = "N" }
//! clearance = 1e-4
//!
//! [[load]]
//! direction = { coordinates = [200, 202] }
//! amplitude = "drive"
//!
//! [[contact]]
//! name = "stop"
//! law = "Stop(gap, k) { gap > 0 => k*gap, else => 0 }"
//! arguments = { k = 1e6 }
//! direction = { coordinates = [201, 203, 205], weights = [0.25, 0.5, 0.25] }
//! offset = "clearance"
//!
//! [[output]]
//! name = "tip"
//! direction = { coordinates = [203] }
//!
//! [[output]]
//! name = "shaking"
//! kind = "acceleration"
//! direction = { coordinates = [203] }
//! about = "what an accelerometer at the tip shows"
//! ```
//!
//! The direction of a contact may turn with time, as that of a ball of a bearing whose cage turns two fifths as fast as the excitation:
//!
//! ```toml
//! [[contact]]
//! name = "ball3"
//! law = "Ball(gap, k) { gap > 0 => k*gap^1.5, else => 0 }"
//! arguments = { k = 1e9 }
//! direction = { coordinates = [12] }
//! turning = { towards = { coordinates = [13] }, by = [2, 5], from = 2.356 }
//! ```
//!
//! Coordinates are counted from zero, as in numpy. A direction of several coordinates without weights is their mean. Numbers can be names
//! of parameters, which a request may vary, and a minus may stand before a name.

mod error;
mod parse;
mod text;

use std::fs::File;
use std::io::{BufRead, BufReader, Read};
use std::path::{Path, PathBuf};

pub use error::{FileError, FileFault};

use crate::description::structure::SparseStructure;
use crate::matrix::SparseMatrix;
use crate::{market, npy};

/// A description is a few pages; a file that is longer than this many bytes is something else.
const LONGEST: u64 = 16_000_000;

/// Reads a structure, with the files that it names, whose paths are relative to its own.
///
/// # Errors
/// What is wrong, with the file and the line.
pub fn read(path: impl AsRef<Path>) -> Result<SparseStructure, FileError> {
    let path = path.as_ref();
    let mut bytes = Vec::new();
    let unreadable = |source| FileError::Read {
        path: path.to_owned(),
        source,
    };
    let file = File::open(path).map_err(unreadable)?;
    file.take(LONGEST + 1)
        .read_to_end(&mut bytes)
        .map_err(unreadable)?;
    let text = if bytes.len() as u64 > LONGEST {
        None
    } else {
        String::from_utf8(bytes).ok()
    };
    let text = text.ok_or_else(|| FileError::NoText {
        path: path.to_owned(),
        longest: LONGEST,
    })?;
    parse::parsed(&text, &Files::of(path))
}

/// The file of a description, and those that it names.
struct Files {
    path: PathBuf,
    folder: PathBuf,
}

impl Files {
    fn of(path: &Path) -> Self {
        Self {
            path: path.to_owned(),
            folder: path.parent().unwrap_or(Path::new("")).to_owned(),
        }
    }

    /// A matrix: an array of numpy by the end of its name, else a Matrix Market file.
    fn matrix(&self, name: &str) -> Result<SparseMatrix, FileError> {
        let path = self.folder.join(name);
        if path.extension().is_some_and(|end| end == "npy") {
            let array = self.array(name)?;
            let shape = (array.shape[0], *array.shape.get(1).unwrap_or(&0));
            if array.shape.len() != 2 {
                return Err(FileError::Shape {
                    path,
                    shape: array.shape,
                    expected: "two dimensions",
                });
            }
            // An array without numbers may claim any number of rows.
            if array.values.is_empty() {
                return Err(FileError::Shape {
                    path,
                    shape: array.shape,
                    expected: "a row and a column at least",
                });
            }
            let entries = array.values.iter().enumerate();
            let entries = entries.filter(|(_, value)| **value != 0.0);
            let entries = entries.map(|(k, &value)| (k / shape.1, k % shape.1, value));
            return SparseMatrix::from_triplets(shape.0, shape.1, entries)
                .map_err(|source| FileError::Matrix { path, source });
        }
        let reader = begun(&path, b'%', "`scipy.io.mmwrite`")?;
        market::read(reader).map_err(|source| FileError::Market { path, source })
    }

    fn array(&self, name: &str) -> Result<npy::Array, FileError> {
        let path = self.folder.join(name);
        let reader = begun(&path, 0x93, "`numpy.save`")?;
        npy::read(reader).map_err(|source| FileError::Npy { path, source })
    }
}

/// A file that begins with a byte, unless it is one of MATLAB: then what else writes what is in it.
fn begun(path: &Path, with: u8, instead: &'static str) -> Result<BufReader<File>, FileError> {
    let unreadable = |source| FileError::Read {
        path: path.to_owned(),
        source,
    };
    let mut reader = BufReader::new(File::open(path).map_err(unreadable)?);
    let begin = reader.fill_buf().map_err(unreadable)?;
    // Files of version 4 do not say so.
    let end = path.extension();
    let is_named = end.is_some_and(|end| end.eq_ignore_ascii_case("mat"));
    if begin.starts_with(b"MATLAB ") || is_named && begin.first() != Some(&with) {
        return Err(FileError::Matlab {
            path: path.to_owned(),
            instead,
        });
    }
    Ok(reader)
}
