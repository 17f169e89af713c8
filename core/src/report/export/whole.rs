//! Diagrams and basins as JSON: an object with a `version` and what it is of.

use std::path::Path;

use serde::{Deserialize, Serialize};

use crate::attractors::basin::{Basins, Fate};
use crate::bifurcation::diagram::{Diagram, Origin, Reason};
use crate::error::Error;
use crate::report::error::FileError;
use crate::report::export::json::{JSON_VERSION, read, write};

#[derive(Serialize)]
struct WrittenDiagram<'d> {
    version: u32,
    diagram: &'d Diagram,
}

#[derive(Deserialize)]
struct ReadDiagram {
    diagram: Diagram,
}

#[derive(Serialize)]
struct WrittenBasins<'b> {
    version: u32,
    basins: &'b Basins,
}

#[derive(Deserialize)]
struct ReadBasins {
    basins: Basins,
}

impl Diagram {
    /// Writes it as JSON: an object with a `version` and the `diagram`. Fields have the names that they have here, and numbers are
    /// written as those of [a branch](crate::Branch::write).
    ///
    /// # Errors
    /// If the file cannot be written.
    pub fn write(&self, path: impl AsRef<Path>) -> Result<(), Error> {
        let written = WrittenDiagram {
            version: JSON_VERSION,
            diagram: self,
        };
        Ok(write(path.as_ref(), &written)?)
    }

    /// The diagram of a file that [`write`](Self::write) has written. It is equal to what was written, and its branches have no model:
    /// [`attach`](crate::Branch::attach) gives one to each.
    ///
    /// # Errors
    /// If the file cannot be read, is none of these, ends early, is of another version, or holds numbers that do not belong together.
    pub fn read(path: impl AsRef<Path>) -> Result<Self, Error> {
        let path = path.as_ref();
        let ReadDiagram { diagram } = read(path)?;
        if !diagram.belongs_together() {
            return Err(apart(path, "branches and events that it names are not there").into());
        }
        let Self { branches, .. } = &diagram;
        let unsound = branches.iter().find_map(|found| found.branch.unsound());
        match unsound {
            Some(reason) => Err(apart(path, &reason).into()),
            None => Ok(diagram),
        }
    }

    /// Whether the branches, events and orbits that are named by numbers are there.
    fn belongs_together(&self) -> bool {
        let branches = self.branches.len();
        let event = |branch: usize, event: usize| {
            let named = self.branches.get(branch);
            named.is_some_and(|named| event < named.branch.events.len())
        };
        let reason = |reason: &Reason| match reason {
            Reason::BranchEnds { branch } => *branch < branches,
            _ => true,
        };
        let mut origins = self.branches.iter().map(|found| found.origin);
        let mut omitted = self.omitted.iter();
        origins.all(|origin| match origin {
            Origin::Event {
                branch, event: own, ..
            } => event(branch, own),
            _ => true,
        }) && omitted.all(|one| event(one.branch, one.event) && reason(&one.reason))
            && self.missed.iter().all(|(_, own)| reason(own))
            && self.searched.iter().all(|searched| {
                let mut orbits = searched.orbits.iter();
                orbits.all(|orbit| orbit.branch.is_none_or(|branch| branch < branches))
                    && are_known(&searched.fates, searched.orbits.len())
            })
    }
}

impl Basins {
    /// Writes them as JSON: an object with a `version` and the `basins`. Fields have the names that they have here, and numbers are
    /// written as those of [a branch](crate::Branch::write).
    ///
    /// # Errors
    /// If the file cannot be written.
    pub fn write(&self, path: impl AsRef<Path>) -> Result<(), Error> {
        let written = WrittenBasins {
            version: JSON_VERSION,
            basins: self,
        };
        Ok(write(path.as_ref(), &written)?)
    }

    /// The basins of a file that [`write`](Self::write) has written. They are equal to what was written.
    ///
    /// # Errors
    /// If the file cannot be read, is none of these, ends early, is of another version, or holds numbers that do not belong together.
    pub fn read(path: impl AsRef<Path>) -> Result<Self, Error> {
        let path = path.as_ref();
        let ReadBasins { basins } = read(path)?;
        if basins.belong_together() {
            return Ok(basins);
        }
        let reason = "its cells, states and attractors do not belong together";
        Err(apart(path, reason).into())
    }

    /// Whether there is a fate of each cell, and states have the entries of the model.
    fn belong_together(&self) -> bool {
        let order = 2 * self.model.coordinates.len();
        let mut attractors = self.attractors.iter();
        self.grid.is_of(order)
            && self.fates.len() == self.grid.cells()
            && self.parameters.len() == self.model.parameters.len()
            && are_known(&self.fates, self.attractors.len())
            && attractors.all(|attractor| {
                attractor.points.len() == attractor.period
                    && attractor.points.iter().all(|point| point.len() == order)
            })
    }
}

/// Whether motions settle to orbits that are there.
fn are_known(fates: &[Fate], orbits: usize) -> bool {
    fates.iter().all(|fate| match fate {
        Fate::Periodic(index) => *index < orbits,
        _ => true,
    })
}

fn apart(path: &Path, reason: &str) -> FileError {
    FileError::Format {
        path: path.to_path_buf(),
        reason: reason.to_owned(),
    }
}
