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
mod error;
mod grid;
mod orbit;
mod recognise;
mod record;
#[cfg(test)]
mod tests;
mod threads;

pub use attractor::{Attractor, Fate};
pub(crate) use error::BasinError;
pub use grid::{Axis, Grid};
pub(crate) use orbit::Finder;

use std::ops::ControlFlow;
use std::path::Path;

use super::log::Log;
use super::request::Request;
use crate::branches::branch::Model;
use crate::branches::progress::Progress;
use crate::cancel::Cancel;
use crate::error::Error;
use crate::model::request::RequestError;
use crate::model::{self, validate};
use crate::system::{System, Variable};
use crate::time::Flow;

/// Which basins to compute: set up step by step, then [run](Basin::run).
///
/// By default motions start at phase zero, orbits of up to 64 periods are looked for, motions are followed for 20000 periods, and one has
/// escaped beyond a million.
///
/// ```
/// use hertzian::attractors::basin::{Axis, Basin, Grid};
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
/// let basins = Basin::of(&model).omega(1.0).grid(grid).longest(2).run()?;
/// // One motion in each well.
/// assert_eq!(basins.attractors.len(), 2);
/// # Ok::<(), hertzian::Error>(())
/// ```
#[derive(Clone)]
pub struct Basin {
    request: Request,
    /// Values of parameters that are not the system's.
    parameters: Vec<(String, f64)>,
    grid: Option<Grid>,
    phase: f64,
    longest: usize,
    patience: usize,
    threads: usize,
}

/// Everything that the basins depend on.
impl std::fmt::Debug for Basin {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Basin")
            .field("request", &self.request)
            .field("parameters", &self.parameters)
            .field("grid", &self.grid)
            .field("phase", &self.phase)
            .field("longest", &self.longest)
            .field("patience", &self.patience)
            .finish_non_exhaustive()
    }
}

/// Basins of attraction.
#[derive(Debug, Clone, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[non_exhaustive]
pub struct Basins {
    /// What the basins are of.
    pub model: Model,
    /// Values of all parameters, in the order of the model.
    #[cfg_attr(feature = "serde", serde(with = "crate::serialise"))]
    pub parameters: Vec<f64>,
    /// The excitation frequency, in radians per unit of time.
    #[cfg_attr(feature = "serde", serde(with = "crate::serialise"))]
    pub omega: f64,
    /// The phase at which motions start and are looked at.
    #[cfg_attr(feature = "serde", serde(with = "crate::serialise"))]
    pub phase: f64,
    /// The states from which motions start.
    pub grid: Grid,
    /// What becomes of the motion of every cell, row by row; see [`Grid::state`].
    pub fates: Vec<Fate>,
    /// The periodic attractors that the motions settle to, by period, then by the first point.
    pub attractors: Vec<Attractor>,
    /// Periods that were computed, with all that served to recognise attractors.
    pub periods: u64,
    /// Whether all cells were looked at.
    pub complete: bool,
}

impl Basin {
    /// Of this system, at the values that its parameters have now.
    pub fn of(system: &dyn System) -> Self {
        Self {
            request: Request::of(system),
            parameters: Vec::new(),
            grid: None,
            phase: 0.0,
            longest: 64,
            patience: 20_000,
            threads: 1,
        }
    }

    hertzian_contract::setters! { self:
        /// The excitation frequency, in radians per unit of time.
        omega(omega: f64) { self.request.omega = Some(omega) }

        /// A parameter has this value, whatever the system has.
        parameter(name: impl Into<String>, value: f64) { self.parameters.push((name.into(), value)) }

        /// The initial states.
        grid(grid: Grid) { self.grid = Some(grid) }

        /// The phase at which motions start and are looked at. Default: 0.
        phase(phase: f64) { self.phase = phase }

        /// The longest period that is looked for, in periods of the declaration. Default: 64.
        longest(period: usize) { self.longest = period }

        /// Periods after which a motion that was not recognised is judged by its Lyapunov exponent. Default: 20000.
        patience(periods: usize) { self.patience = periods }

        /// A state with an entry beyond this has escaped. Default: a million.
        escape(bound: f64) { self.request.escape = bound }

        /// Tolerance of the flow, where it is not in closed form. Default: 1e-10.
        tolerance(tolerance: f64) { self.request.tolerance = tolerance }

        /// So many threads, which do not change the result. Default: 1, and without the feature `parallel` there is no more.
        threads(count: usize) { self.threads = count }

        /// The computation ends when this token is cancelled; cells that are missing then are [`Fate::Unknown`].
        cancel(cancel: &Cancel) { self.request.cancel = cancel.clone() }
    }

    /// Computes the basins.
    ///
    /// # Errors
    /// If a parameter or an option is not usable, threads cannot be started, or no motion of the grid can be computed.
    pub fn run(&self) -> Result<Basins, Error> {
        self.run_with(|_| ControlFlow::Continue(()))
    }

    /// As [`run`](Self::run), and calls `visit` after every part of the grid: to show progress, or to stop. Cells that are missing then are
    /// [`Fate::Unknown`].
    ///
    /// # Errors
    /// As [`run`](Self::run).
    pub fn run_with(
        &self,
        mut visit: impl FnMut(Progress<'_>) -> ControlFlow<()> + Send,
    ) -> Result<Basins, Error> {
        Ok(self.compute(self.moving()?, None, &mut visit)?)
    }

    /// As [`run_with`](Self::run_with), and goes on from what a file holds of these basins; what is computed is added to it. A
    /// file that is not there is begun. `model` is one line that says which system it is, with everything that its motions depend on: a
    /// file of another one, or of another request, is refused.
    ///
    /// # Errors
    /// As [`run`](Self::run), and if the file cannot be used.
    pub fn resume(
        &self,
        path: impl AsRef<Path>,
        model: &str,
        mut visit: impl FnMut(Progress<'_>) -> ControlFlow<()> + Send,
    ) -> Result<Basins, Error> {
        let moving = self.moving()?;
        let mut log = Log::open(path.as_ref(), &format!("{model}, {self:?}"))?;
        Ok(self.compute(moving, Some(&mut log), &mut visit)?)
    }

    /// A flow for each thread, and at which values.
    fn moving(&self) -> Result<Moving, Error> {
        let omega = self.request.omega.ok_or(RequestError::no_omega())?;
        self.check()?;
        let mut values = model::values(&self.request.system);
        for (name, value) in &self.parameters {
            if let Variable::Parameter(index) =
                validate::variable(self.request.system.facts(), Some(name))?
            {
                values[index] = *value;
            }
        }
        let flows = (0..self.threads).map(|_| self.request.flow(&values, omega));
        Ok(Moving {
            flows: flows.collect::<Result<_, Error>>()?,
            parameters: values,
            omega,
        })
    }

    /// Whether the request is of a system with the same declaration, whatever its parameters are.
    pub(crate) fn is_of(&self, system: &dyn System) -> Result<(), BasinError> {
        if self.request.system.facts() == system.facts() {
            return Ok(());
        }
        let (name, must) = ("basin", "must be of the system that is followed");
        Err(BasinError::Request { name, must })
    }

    /// Number of threads.
    pub(crate) fn threads_wanted(&self) -> usize {
        self.threads
    }

    /// Computes the basins with one thread for each flow; all flows must be the same.
    pub(crate) fn compute(
        &self,
        moving: Moving,
        log: Option<&mut Log>,
        visit: Visit<'_>,
    ) -> Result<Basins, BasinError> {
        compute::compute(self, self.check()?, moving, log, visit)
    }

    /// The grid of a request that can be used.
    pub(crate) fn check(&self) -> Result<&Grid, BasinError> {
        let fault = |name, must| Err(BasinError::Request { name, must });
        let Some(grid) = &self.grid else {
            return fault("grid", "is missing");
        };
        let Grid {
            start,
            columns,
            rows,
            states,
        } = grid;
        let ranges = [columns, rows].map(|axis| [axis.from, axis.to]);
        let entries = [columns.entry, rows.entry];
        if !(1..=MOST_THREADS).contains(&self.threads) {
            return fault("threads", "must be from 1 to 1024");
        }
        let order = 2 * self.request.system.facts().coordinates.len();
        if grid.cells() > 0 && !grid.is_of(order) {
            return fault("grid", "must have the entries of a state");
        }
        if entries[0] == entries[1] {
            return fault("grid", "must vary two different entries");
        }
        if !ranges
            .as_flattened()
            .iter()
            .chain(start)
            .chain(states.iter().flatten())
            .all(|x| x.is_finite())
            || !self.phase.is_finite()
        {
            return fault("grid", "must be finite");
        }
        if grid.cells() == 0 || grid.cells() > MOST_CELLS {
            return fault("grid", "must have at least one cell and at most 2^28");
        }
        if self.longest == 0 || self.patience == 0 {
            return fault("longest and patience", "must be at least one");
        }
        if self.request.escape.is_nan() || self.request.escape <= 0.0 {
            return fault("escape", "must be positive");
        }
        Ok(grid)
    }
}

/// Flows that are the same, one for each thread, and at which values of the parameters and of the frequency they are.
pub(crate) struct Moving {
    pub(crate) flows: Vec<Box<dyn Flow>>,
    pub(crate) parameters: Vec<f64>,
    pub(crate) omega: f64,
}

/// What is told of progress, from any thread.
pub(crate) type Visit<'v> = &'v mut (dyn FnMut(Progress<'_>) -> ControlFlow<()> + Send);

/// More threads gain nothing, and take longer to start than the work.
const MOST_THREADS: usize = 1024;
/// More would not fit into memory well.
const MOST_CELLS: usize = 1 << 28;

impl Basins {
    /// How many cells have a fate.
    pub fn count(&self, fate: Fate) -> usize {
        self.fates.iter().filter(|&&other| other == fate).count()
    }
}
