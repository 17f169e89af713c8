//! Why a result is not in its file, or cannot be had from it.

use std::io;
use std::path::{Path, PathBuf};

use crate::error::{ErrorKind, room_error};
#[cfg(feature = "plot")]
use crate::numeric::decimal::Decimal;

/// Why there is no chart of what was asked for.
#[cfg(feature = "plot")]
#[derive(Clone, PartialEq, thiserror::Error)]
pub(crate) enum ViewError {
    /// A value has no place on a logarithmic axis.
    #[error(
        "{name} is {} at {varied} = {}, which has no place on a logarithmic axis or one of decibels: take a linear one",
        Decimal::plain(*.value), Decimal::plain(*.at)
    )]
    NotPositive {
        /// What was asked for.
        name: String,
        /// Its value: negative, or zero where nothing is positive.
        value: f64,
        /// What is varied.
        varied: String,
        /// Its value there.
        at: f64,
    },
    /// A phase is an angle.
    #[error("the phase of harmonic {harmonic} of {name} is an angle: take a linear axis")]
    Angle {
        /// The signal.
        name: String,
        /// The number of the harmonic.
        harmonic: usize,
    },
    /// Harmonics are shown by their amplitudes.
    #[error(
        "harmonics 1 to {count} of {name} are shown by their amplitudes: ask for {name} alone, not for its {measure}"
    )]
    NoAmplitude {
        /// The signal.
        name: String,
        /// How many harmonics were asked for.
        count: usize,
        /// What was asked of it.
        measure: String,
    },
    /// Branches do not belong into one chart.
    #[error("an axis of the chart is {expected}, and branch {branch} has {found}")]
    OtherAxis {
        /// The number of the branch, from one on.
        branch: usize,
        /// What is at the axis.
        expected: String,
        /// What the branch has.
        found: String,
    },
    /// A waterfall of several harmonics.
    #[error("a waterfall is of one measure, and {harmonics} harmonics were asked for")]
    Waterfall {
        /// How many harmonics were asked for.
        harmonics: usize,
    },
    /// There is nothing to draw.
    #[error("none of the {branches} branches has an orbit")]
    Empty {
        /// How many branches were given.
        branches: usize,
    },
}

#[cfg(feature = "plot")]
room_error! {
    ViewError, |_| ErrorKind::Request;
    NotPositive { name, value, varied, at }
    Angle { name, harmonic }
    NoAmplitude { name, count, measure }
    OtherAxis { branch, expected, found }
    Waterfall { harmonics }
    Empty { branches }
    ;
}

/// Why a result is not in its file, or cannot be had from it.
#[derive(Clone, PartialEq, Eq, thiserror::Error)]
pub(crate) enum FileError {
    /// A file could not be written.
    #[error("cannot write {}: {kind}", .path.display())]
    Write {
        /// Its path.
        path: PathBuf,
        /// What the system said.
        kind: io::ErrorKind,
    },
    /// A file could not be read.
    #[cfg(feature = "serde")]
    #[error("cannot read {}: {kind}", .path.display())]
    Read {
        /// Its path.
        path: PathBuf,
        /// What the system said.
        kind: io::ErrorKind,
    },
    /// A file ends before what was written does.
    #[cfg(feature = "serde")]
    #[error("{} ends early: it is a part of a file", .path.display())]
    Truncated {
        /// Its path.
        path: PathBuf,
    },
    /// A file is none of what is read from it.
    #[cfg(feature = "serde")]
    #[error("{} is no file of this kind: {reason}", .path.display())]
    Format {
        /// Its path.
        path: PathBuf,
        /// What is not as it must be, and where.
        reason: String,
    },
    /// A file was written by another version.
    #[cfg(feature = "serde")]
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

impl FileError {
    /// A file could not be written, as the system says.
    pub(crate) fn not_written(path: &Path, source: &io::Error) -> Self {
        Self::Write {
            path: path.to_path_buf(),
            kind: source.kind(),
        }
    }
}

room_error! {
    FileError, |_| ErrorKind::File;
    Write { path, kind }
    #[cfg(feature = "serde")]
    Read { path, kind }
    #[cfg(feature = "serde")]
    Truncated { path }
    #[cfg(feature = "serde")]
    Format { path, reason }
    #[cfg(feature = "serde")]
    Version { path, version, expected }
    ;
}
