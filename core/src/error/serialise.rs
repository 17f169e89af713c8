//! Errors in results, through serde with feature `serde`: their kind, and what they say and show.

use std::fmt;

use serde::{Deserialize, Deserializer, Serialize, Serializer};

use super::{Error, ErrorKind, chain};

/// The error of a room, as it is written. Read back it has the sentences and not the type.
#[derive(Serialize, Deserialize)]
struct Written {
    kind: ErrorKind,
    /// The sentence with its sources.
    says: String,
    /// The variant with its numbers.
    shows: String,
}

impl fmt::Display for Written {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.says)
    }
}

impl fmt::Debug for Written {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.shows)
    }
}

impl std::error::Error for Written {}

impl Serialize for Error {
    fn serialize<S: Serializer>(&self, to: S) -> Result<S::Ok, S::Error> {
        let written = Written {
            kind: self.kind,
            says: chain(self).to_string(),
            shows: format!("{self:#?}"),
        };
        written.serialize(to)
    }
}

impl<'de> Deserialize<'de> for Error {
    fn deserialize<D: Deserializer<'de>>(from: D) -> Result<Self, D::Error> {
        let written = Written::deserialize(from)?;
        Ok(Self::new(written.kind, written))
    }
}
