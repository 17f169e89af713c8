//! What can be wrong with the file of a structure, and with those that it names.

use std::io;
use std::path::PathBuf;

use crate::error::StructureError;
use crate::market::{MOST_COORDINATES, MarketError};
use crate::matrix::MatrixError;
use crate::npy::NpyError;

/// What is wrong with the files of a structure.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum FileError {
    /// A file cannot be read.
    #[error("cannot read {}: {source}", .path.display())]
    Read {
        /// Its path.
        path: PathBuf,
        /// Why.
        source: io::Error,
    },
    /// The file is too long, or no text.
    #[error("{}: a structure is described by a text in UTF-8 of at most {longest} bytes", .path.display())]
    NoText {
        /// Its path.
        path: PathBuf,
        /// How long it may be.
        longest: u64,
    },
    /// The file is no TOML, or has a key that means nothing here, or one of another kind.
    #[error("{}:{line}: {message}", .path.display())]
    Toml {
        /// Its path.
        path: PathBuf,
        /// The line, from one.
        line: usize,
        /// What is wrong.
        message: String,
    },
    /// Something in the file cannot be used.
    #[error("{}:{line}: {fault}", .path.display())]
    At {
        /// Its path.
        path: PathBuf,
        /// The line, from one.
        line: usize,
        /// What is wrong.
        fault: FileFault,
    },
    /// The parts of the structure do not fit each other.
    #[error("{}: {source}", .path.display())]
    Structure {
        /// Path of the description.
        path: PathBuf,
        /// What is wrong.
        source: StructureError,
    },
    /// A Matrix Market file is at fault.
    #[error("{}: {source}", .path.display())]
    Market {
        /// Its path.
        path: PathBuf,
        /// What is wrong, with its line.
        source: MarketError,
    },
    /// A file of MATLAB.
    #[error("{}: files of MATLAB are not read: what `scipy.io.loadmat`, or `h5py` of version 7.3, reads of it is written as it is taken here by {instead}", .path.display())]
    Matlab {
        /// Its path.
        path: PathBuf,
        /// What writes a file that is read.
        instead: &'static str,
    },
    /// An array of numpy is at fault.
    #[error("{}: {source}", .path.display())]
    Npy {
        /// Its path.
        path: PathBuf,
        /// What is wrong.
        source: NpyError,
    },
    /// An array of numpy makes no matrix.
    #[error("{}: {source}", .path.display())]
    Matrix {
        /// Its path.
        path: PathBuf,
        /// What is wrong.
        source: MatrixError,
    },
    /// An array has another shape than it must have.
    #[error("{}: its shape is {shape:?}; it must have {expected}", .path.display())]
    Shape {
        /// Its path.
        path: PathBuf,
        /// Its shape.
        shape: Vec<usize>,
        /// What it must have.
        expected: &'static str,
    },
}

/// What is wrong in the file of a structure.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum FileFault {
    /// A name that no parameter has.
    #[error("`{name}` is no parameter: those of [parameters] are {known}")]
    NoParameter {
        /// The name.
        name: String,
        /// Those that there are.
        known: String,
    },
    /// A value is infinite or not a number.
    #[error("{value} is no number that can be used here")]
    NotFinite {
        /// The value.
        value: f64,
    },
    /// A law cannot be read.
    #[error("column {column} of the law: {message}")]
    Law {
        /// Column of that line, from one; of the law, where it begins in that line.
        column: usize,
        /// What is wrong.
        message: String,
    },
    /// A law needs an argument that it is not given.
    #[error("law `{law}` needs a value of `{argument}`")]
    NoArgument {
        /// Name of the law.
        law: String,
        /// Name of the argument.
        argument: String,
    },
    /// A law is given an argument that it does not have.
    #[error("law `{law}` has no argument `{argument}`; it has {known}")]
    UnknownArgument {
        /// Name of the law.
        law: String,
        /// Name of the argument.
        argument: String,
        /// Those that it has.
        known: String,
    },
    /// Keys that cannot stand together, or one that must.
    #[error("{what}")]
    Keys {
        /// What to write.
        what: &'static str,
    },
    /// There are not as many weights as coordinates.
    #[error("{weights} weights of {coordinates} coordinates")]
    Weights {
        /// Weights.
        weights: usize,
        /// Coordinates.
        coordinates: usize,
    },
    /// A coordinate that is not there.
    #[error("coordinate {coordinate}, counted from zero; there are {coordinates}")]
    NoCoordinate {
        /// The coordinate.
        coordinate: usize,
        /// How many there are.
        coordinates: usize,
    },
    /// A structure of more coordinates than can be held.
    #[error("{coordinates} coordinates: at most {MOST_COORDINATES}")]
    Large {
        /// How many.
        coordinates: usize,
    },
    /// Two things of one name.
    #[error("the name `{name}` is taken")]
    Taken {
        /// The name.
        name: String,
    },
    /// A parameter has another unit than what it is used for.
    #[error("`{parameter}` is in {unit}; here stands a value in {expected}")]
    Unit {
        /// Name of the parameter.
        parameter: String,
        /// Its unit.
        unit: String,
        /// What it is used for.
        expected: String,
    },
}
