//! Errors in results, through serde with feature `serde`: their kind, what they say and show, and their numbers.

use std::fmt;

use serde::{Deserialize, Deserializer, Serialize, Serializer};

use super::{Error, ErrorKind, Room, chain};

/// The error of a room, as it is written. Read back it has the sentences and not the type.
#[derive(Serialize, Deserialize)]
struct Written {
    kind: ErrorKind,
    /// The sentence with its sources.
    says: String,
    /// The variant with its numbers.
    shows: String,
    /// Its name; empty in a file of an earlier version.
    #[serde(default)]
    variant: String,
    /// Names of its numbers.
    #[serde(default)]
    names: Vec<String>,
    /// The numbers.
    #[serde(default, with = "crate::serialise")]
    numbers: Vec<f64>,
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

impl Room for Written {
    fn variant(&self) -> &str {
        &self.variant
    }

    fn append_values<'s>(&'s self, values: &mut Vec<(&'s str, f64)>) {
        let names = self.names.iter().map(String::as_str);
        values.extend(names.zip(self.numbers.iter().copied()));
    }
}

impl Serialize for Error {
    fn serialize<S: Serializer>(&self, to: S) -> Result<S::Ok, S::Error> {
        let values = self.values().into_iter();
        let (names, numbers) = values.map(|(name, value)| (name.to_owned(), value)).unzip();
        let written = Written {
            kind: self.kind,
            says: chain(self).to_string(),
            shows: format!("{self:#?}"),
            variant: self.variant().to_owned(),
            names,
            numbers,
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::time::FlowError;

    #[test]
    fn numbers_are_read_back() {
        let error = Error::from(FlowError::StepTooShort {
            phase: 1.5,
            step: f64::INFINITY,
        });
        let text = serde_json::to_string(&error).expect("text");
        let read: Error = serde_json::from_str(&text).expect("an error");
        assert_eq!(read, error);
        assert_eq!(read.variant(), "StepTooShort");
        let expected = [("phase", 1.5), ("step", f64::INFINITY)];
        assert_eq!(read.values(), expected);
        assert_eq!(serde_json::to_string(&read).expect("text"), text);
    }

    /// A file of 0.2.0 before errors had them.
    #[test]
    fn what_has_no_numbers_is_read() {
        let text = r#"{"kind":"motion","says":"it rests","shows":"Rests"}"#;
        let read: Error = serde_json::from_str(text).expect("an error");
        assert_eq!(
            (read.to_string().as_str(), read.variant()),
            ("it rests", "")
        );
        assert_eq!(read.values(), []);
    }
}
