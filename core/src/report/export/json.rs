//! Branches as JSON, with feature `serde`.
//!
//! A file is one object with a `version` and a list `branches`; what else it holds is of whoever wrote it.

use std::path::Path;

use serde::de::Error as _;
use serde::{Deserialize, Serialize};

use crate::branches::branch::Branch;
use crate::branches::point::{Event, Point};
use crate::error::Error;
use crate::report::error::FileError;

/// The version of what is written: files of another one are not read.
pub const JSON_VERSION: u32 = 1;

#[derive(Deserialize)]
struct Head {
    version: u32,
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

impl Branch {
    /// Writes it as JSON: an object with a `version` and a list `branches`, of this one. Fields have the names that they have here.
    /// Numbers read back to the same bits; of those that JSON does not have, `"inf"`, `"-inf"` and `"NaN"` are written, and `null`
    /// where one is not known.
    ///
    /// # Errors
    /// If the file cannot be written.
    pub fn write_json(&self, path: impl AsRef<Path>) -> Result<(), Error> {
        let path = path.as_ref();
        let failed = |source: std::io::Error| FileError::Write {
            path: path.to_path_buf(),
            kind: source.kind(),
        };
        let written = Written {
            version: JSON_VERSION,
            branches: [self],
        };
        let mut text = serde_json::to_vec(&written).map_err(|source| failed(source.into()))?;
        text.push(b'\n');
        Ok(hertzian_file::write(path, text).map_err(failed)?)
    }

    /// The first branch of a file that [`write_json`](Self::write_json) or `hertzian response --json` has written. It is equal to what was
    /// written and has no model: [`attach`](Self::attach) gives it one.
    ///
    /// # Errors
    /// If the file cannot be read, is none of these, ends early, is of another version, or holds numbers that do not belong together.
    pub fn read_json(path: impl AsRef<Path>) -> Result<Self, Error> {
        let path = path.as_ref();
        let text = std::fs::read(path).map_err(|source| FileError::Read {
            path: path.to_path_buf(),
            kind: source.kind(),
        })?;
        // Where it ends within a number, the number is at fault.
        let begins = text.trim_ascii_start().starts_with(b"{");
        let ends = text.trim_ascii_end().ends_with(b"}");
        let refused = |source: serde_json::Error| {
            let path = path.to_path_buf();
            if source.is_eof() || (begins && !ends) {
                return FileError::Truncated { path };
            }
            let reason = source.to_string();
            FileError::Format { path, reason }
        };
        let Head { version } = serde_json::from_slice(&text).map_err(refused)?;
        if version != JSON_VERSION {
            let (path, expected) = (path.to_path_buf(), JSON_VERSION);
            return Err(FileError::Version {
                path,
                version,
                expected,
            }
            .into());
        }
        let Read { branches } = serde_json::from_slice(&text).map_err(refused)?;
        let Some(branch) = branches.into_iter().next() else {
            return Err(refused(serde_json::Error::custom("there is no branch in it")).into());
        };
        if let Some(at) = branch.disagrees() {
            let reason = format!("the numbers of the orbit at {at} disagree");
            return Err(refused(serde_json::Error::custom(reason)).into());
        }
        Ok(branch)
    }

    /// Where an orbit, one of events too, has not as many numbers as those of the model.
    fn disagrees(&self) -> Option<f64> {
        if let Some(value) = self.changes_form() {
            return Some(value);
        }
        let events = self.events.iter().filter(|event| !self.holds_event(event));
        let points = self.points.iter().filter(|point| !self.holds(point));
        let mut points = points.chain(events.map(|event| &event.point));
        points.next().map(|point| point.value)
    }

    /// The value of an orbit that is not of the period and the form of the first one.
    fn changes_form(&self) -> Option<f64> {
        let form = |point: &Point| (point.orbit.period, point.orbit.states.len());
        let first = form(self.points.first()?);
        let events = self.events.iter().map(|event| &event.point);
        let mut others = self.points.iter().chain(events);
        let other = others.find(|point| form(point) != first);
        other.map(|point| point.value)
    }

    fn holds_event(&self, event: &Event) -> bool {
        let tangent = event.tangent.split_last();
        let tangent = tangent.filter(|_| event.point.orbit.states.is_empty());
        self.holds(&event.point) && tangent.is_none_or(|(_, series)| self.has_series(series))
    }

    fn holds(&self, point: &Point) -> bool {
        let (model, orbit, observed) = (&self.model, &point.orbit, &point.observed);
        let coordinates = model.coordinates.len();
        let contacts = observed.contacts.len();
        coordinates > 0
            && orbit.coordinates == coordinates
            && orbit.period > 0
            && (orbit.series.is_empty() || self.has_series(&orbit.series))
            && orbit.states.len().is_multiple_of(2 * coordinates)
            && !(orbit.series.is_empty() && orbit.states.is_empty())
            && observed.motions.len() == coordinates
            && point.parameters.len() == model.parameters.len()
            && [0, model.pieces.len()].contains(&contacts)
            && observed.on_pieces.len() == contacts
    }

    /// Whether these are a mean and pairs of cosine and sine for each coordinate.
    fn has_series(&self, series: &[f64]) -> bool {
        let coordinates = self.model.coordinates.len();
        series.len().is_multiple_of(coordinates) && (series.len() / coordinates) % 2 == 1
    }
}
