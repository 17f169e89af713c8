//! Diagrams and basins as JSON: an object with a `version` and what it is of. A diagram has its branches in a list as other files have,
//! and what connects them beside it, so that who reads branches reads those of a diagram too.

use std::path::Path;
use std::time::Duration;

use serde::{Deserialize, Serialize};

use crate::attractors::basin::{Basins, Fate};
use crate::bifurcation::{Diagram, DiagramBranch, Omitted, Origin, Reason, Searched};
use crate::branches::branch::Branch;
use crate::error::Error;
use crate::report::checkpoint;
use crate::report::error::FileError;
use crate::report::export::json::{JSON_VERSION, contents, read, write};

#[derive(Serialize)]
struct WrittenDiagram<'d> {
    version: u32,
    branches: Vec<&'d Branch>,
    diagram: Connected,
}

#[derive(Deserialize)]
struct ReadDiagram {
    diagram: Option<Connected>,
}

/// A diagram but for its branches.
#[derive(Serialize, Deserialize)]
struct Connected {
    found: Vec<Found>,
    omitted: Vec<Omitted>,
    #[serde(with = "crate::serialise")]
    missed: Vec<(f64, Reason)>,
    searched: Vec<Searched>,
    #[serde(with = "crate::serialise")]
    uncovered: Vec<[f64; 2]>,
    #[serde(with = "crate::serialise")]
    elapsed: Duration,
}

/// What a diagram says of a branch.
#[derive(Serialize, Deserialize)]
struct Found {
    origin: Origin,
    depth: usize,
    mirrored: bool,
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

impl Connected {
    fn of(diagram: &Diagram) -> Self {
        let found = diagram.branches.iter().map(|found| Found {
            origin: found.origin,
            depth: found.depth,
            mirrored: found.mirrored,
        });
        Self {
            found: found.collect(),
            omitted: diagram.omitted.clone(),
            missed: diagram.missed.clone(),
            searched: diagram.searched.clone(),
            uncovered: diagram.uncovered.clone(),
            elapsed: diagram.elapsed,
        }
    }

    /// The diagram of these branches; `None` if there are more, or fewer.
    fn with(self, branches: Vec<Branch>) -> Option<Diagram> {
        let fits = branches.len() == self.found.len();
        let both = self.found.into_iter().zip(branches);
        let branches = both.map(|(found, branch)| DiagramBranch {
            origin: found.origin,
            depth: found.depth,
            branch,
            mirrored: found.mirrored,
        });
        fits.then(|| Diagram {
            branches: branches.collect(),
            omitted: self.omitted,
            missed: self.missed,
            searched: self.searched,
            uncovered: self.uncovered,
            elapsed: self.elapsed,
        })
    }
}

impl Diagram {
    /// Writes it as JSON: an object with a `version`, its `branches`, and as `diagram` what connects them. Fields have the names that they have
    /// here, and numbers are written as those of [a branch](crate::Branch::write).
    ///
    /// # Errors
    /// If the file cannot be written.
    pub fn write(&self, path: impl AsRef<Path>) -> Result<(), Error> {
        let written = WrittenDiagram {
            version: JSON_VERSION,
            branches: self.branches.iter().map(|found| &found.branch).collect(),
            diagram: Connected::of(self),
        };
        Ok(write(path.as_ref(), &written)?)
    }

    /// The diagram of a file that [`write`](Self::write) has written. It is equal to what was written, and its branches have no model:
    /// [`attach`](crate::Branch::attach) gives one to each. Of a file of [branches alone](crate::Branch::read_all) nothing is known of what
    /// connects them.
    ///
    /// # Errors
    /// If the file cannot be read, is none of these, ends early, is of another version, or holds numbers that do not belong together.
    pub fn read(path: impl AsRef<Path>) -> Result<Self, Error> {
        let path = path.as_ref();
        let branches = Branch::read_all(path)?;
        if checkpoint::read(&contents(path)?).is_some() {
            return Ok(branches.into());
        }
        let ReadDiagram { diagram } = read(path)?;
        let Some(connected) = diagram else {
            return Ok(branches.into());
        };
        let diagram = connected.with(branches);
        let diagram = diagram.filter(Self::belongs_together);
        let reason = "branches and events that it names are not there";
        Ok(diagram.ok_or_else(|| apart(path, reason))?)
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
