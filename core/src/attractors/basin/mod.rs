//! Basins of attraction: to which attractor the motions from a grid of initial states settle.
//!
//! Every motion is followed until it is recognised, see `recognise.rs`; what is recognised is a stable periodic orbit with its
//! shortest period, its points and its multipliers. A neighbourhood of some of its points is verified to belong to its basin, see
//! `ball.rs`, so that most motions are recognised long before they have settled.
//!
//! The cells are worked on in rounds, from a coarse grid to the full one, and each round in blocks. A block knows the
//! attractors of the rounds before and those that it finds itself. So what it gives depends on nothing but the request,
//! neither on the number of threads nor on the order of blocks, and a finished block can be kept in a log.
//! At the end attractors are numbered by period, then by their first point.

mod attractor;
mod ball;
mod catalogue;
mod compute;
mod grid;
mod orbit;
mod recognise;
mod record;
#[cfg(test)]
mod tests;
mod threads;

pub use attractor::{Attractor, Fate};
pub use grid::{Axis, Grid};

use super::log::{Log, LogError};
use crate::error::{Error, ErrorKind};
use crate::time::{Flow, FlowError};

/// Which basins to compute.
///
/// ```
/// use hertzian::attractors::basin::{Axis, Basin, Grid};
/// use hertzian::time;
/// use hertzian::time::Options;
///
/// hertzian::oscillator! {
///     TwoWells(x) {
///         param drive;
///         ddot(x) + 0.5*dot(x) - x + x^3 = drive*cos(omega*t);
///     }
/// }
///
/// let axis = |entry| Axis::of(entry).from(-1.6).to(1.6).cells(8);
/// let grid = Grid::new(vec![0.0, 0.0], axis(0), axis(1));
/// let model = TwoWells { drive: 0.05 };
/// let flow = time::of(&model, 1.0, Options::default())?;
/// let basins = Basin { longest: 2, ..Basin::new(grid) }.compute(vec![flow], None, &|_| true)?;
/// // One motion in each well.
/// assert_eq!(basins.attractors.len(), 2);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct Basin {
    /// The initial states.
    pub grid: Grid,
    /// The phase at which motions start and are looked at.
    pub phase: f64,
    /// The longest period that is looked for, in periods of the declaration.
    pub longest: usize,
    /// Periods after which a motion that was not recognised is judged by its Lyapunov exponent.
    pub patience: usize,
    /// A state with an entry beyond this has escaped.
    pub escape: f64,
}

/// Basins of attraction.
#[derive(Debug, Clone, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
#[non_exhaustive]
pub struct Basins {
    /// What becomes of the motion of every cell, row by row; see [`Grid::state`].
    pub fates: Vec<Fate>,
    /// The periodic attractors that the motions settle to, by period, then by the first point.
    pub attractors: Vec<Attractor>,
    /// Periods that were computed, with all that served to recognise attractors.
    pub periods: u64,
    /// Whether all cells were looked at.
    pub complete: bool,
}

/// How far a computation is.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[non_exhaustive]
pub struct Progress {
    /// Cells that are done.
    pub done: usize,
    /// All cells.
    pub cells: usize,
}

/// Why there are no basins.
#[derive(Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum BasinError {
    /// The request is at fault.
    #[error("{name} {must}")]
    Request {
        /// What.
        name: &'static str,
        /// What it must be.
        must: &'static str,
    },
    /// The log cannot be used.
    #[error(transparent)]
    Log(#[from] LogError),
    /// The threads could not be started.
    #[error("the system does not give {count} threads")]
    Threads {
        /// How many were asked for.
        count: usize,
    },
    /// No motion of the grid can be computed.
    #[error("no motion of the grid can be computed")]
    Motion {
        /// Why the first one cannot.
        #[source]
        reason: FlowError,
    },
}

crate::error::sentence_as_debug! {
    BasinError:
    Request { name, must }
    Threads { count }
    Motion { reason }
    ;
    Log
}

impl Basin {
    /// A request with what is usual: phase zero, periods up to 64, 20000 periods of patience, and a bound of a million.
    pub fn new(grid: Grid) -> Self {
        Self {
            grid,
            phase: 0.0,
            longest: 64,
            patience: 20_000,
            escape: 1e6,
        }
    }

    /// Computes the basins with one thread for each flow; all flows must be the same. What the log holds of this request is not
    /// computed again; what is computed is added to it. `watch` is told of progress, and ends the computation by
    /// answering false; the cells that are missing then are [`Fate::Unknown`].
    ///
    /// Without the feature `parallel` only the first flow is used.
    ///
    /// # Errors
    /// If the request cannot be used, the log cannot be written, threads cannot be started, or no motion of the grid can be computed.
    pub fn compute(
        &self,
        flows: Vec<Box<dyn Flow>>,
        log: Option<Log>,
        watch: &(dyn Fn(Progress) -> bool + Sync),
    ) -> Result<Basins, BasinError> {
        let order = flows.first().map(|flow| 2 * flow.coordinates());
        self.check(order)?;
        if flows.len() > MOST_FLOWS {
            let (name, must) = ("flows", "must be at most 1024, a thread for each");
            return Err(BasinError::Request { name, must });
        }
        compute::compute(self, flows, log, watch)
    }

    /// Whether the request can be used with flows of so many entries, if there are any.
    pub(crate) fn check(&self, order: Option<usize>) -> Result<(), BasinError> {
        let Grid {
            start,
            columns,
            rows,
        } = &self.grid;
        let ranges = [columns, rows].map(|axis| [axis.from, axis.to]);
        let entries = [columns.entry, rows.entry];
        let fault = |name, must| Err(BasinError::Request { name, must });
        if order.is_none() {
            return fault("flows", "must be at least one");
        }
        if order != Some(start.len()) || entries.iter().any(|&entry| entry >= start.len()) {
            return fault("grid", "must have the entries of a state");
        }
        if entries[0] == entries[1] {
            return fault("grid", "must vary two different entries");
        }
        if !ranges
            .as_flattened()
            .iter()
            .chain(start)
            .all(|x| x.is_finite())
            || !self.phase.is_finite()
        {
            return fault("grid", "must be finite");
        }
        if self.grid.cells() == 0 || self.grid.cells() > MOST_CELLS {
            return fault("grid", "must have at least one cell and at most 2^28");
        }
        if self.longest == 0 || self.patience == 0 {
            return fault("longest and patience", "must be at least one");
        }
        if self.escape.is_nan() || self.escape <= 0.0 {
            return fault("escape", "must be positive");
        }
        Ok(())
    }
}

/// More threads gain nothing, and take longer to start than the work.
const MOST_FLOWS: usize = 1024;
/// More would not fit into memory well.
const MOST_CELLS: usize = 1 << 28;

impl Basins {
    /// How many cells have a fate.
    pub fn count(&self, fate: Fate) -> usize {
        self.fates.iter().filter(|&&other| other == fate).count()
    }
}

impl BasinError {
    pub(crate) fn kind(&self) -> ErrorKind {
        match self {
            Self::Request { .. } => ErrorKind::Request,
            Self::Log(_) => ErrorKind::File,
            Self::Threads { .. } => ErrorKind::System,
            Self::Motion { .. } => ErrorKind::Motion,
        }
    }
}

impl From<BasinError> for Error {
    fn from(error: BasinError) -> Self {
        Self::new(error.kind(), error)
    }
}
