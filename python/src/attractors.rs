//! What motions settle to.

use std::collections::BTreeMap;
use std::path::PathBuf;
use std::sync::Arc;

use hertzian::attractors::basin::{Attractor, Axis, Basin, Basins, Grid};
use hertzian::{Complex, System};
use numpy::{PyArray1, PyArray2, PyArrayMethods};
use pyo3::exceptions::{PyTypeError, PyValueError};
use pyo3::prelude::*;

use crate::arrays::{matrix, numbers, rows};
use crate::compute::{Watch, compute};
use crate::errors::exception;
use crate::given::Given;

/// One direction of a grid of initial states: an entry of the state, in so many cells from one value to another. Motions start from the
/// middles of cells.
///
/// ``entry``: a coordinate by its name, as ``"x"``, its velocity as ``"dot(x)"``, or the number of the entry.
#[pyclass(frozen, name = "Axis", module = "hertzian")]
pub struct PyAxis {
    entry: Entry,
    axis: Axis,
}

/// An entry of the state.
enum Entry {
    Number(usize),
    Name(String),
}

#[pymethods]
impl PyAxis {
    #[new]
    #[pyo3(signature = (entry, from_, to, cells=256))]
    fn new(entry: &Bound<'_, PyAny>, from_: f64, to: f64, cells: usize) -> PyResult<Self> {
        let entry = if let Ok(name) = entry.extract::<String>() {
            Entry::Name(name)
        } else {
            let number = entry.extract::<usize>().map_err(|_| {
                PyTypeError::new_err(
                    "the entry of an axis is a coordinate by its name, as \"x\" or \"dot(x)\", or a number",
                )
            })?;
            Entry::Number(number)
        };
        let axis = Axis::of(0).from(from_).to(to).cells(cells);
        Ok(Self { entry, axis })
    }

    /// The values that motions start from: array of shape (cells,).
    #[getter]
    fn middles<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        PyArray1::from_iter(py, (0..self.axis.count).map(|cell| self.axis.middle(cell)))
    }

    fn __repr__(&self) -> String {
        let Axis {
            from, to, count, ..
        } = self.axis;
        let entry = match &self.entry {
            Entry::Number(number) => number.to_string(),
            Entry::Name(name) => format!("\"{name}\""),
        };
        format!("Axis({entry}, {from}, {to}, cells={count})")
    }
}

impl PyAxis {
    /// The same of a system.
    fn of(&self, system: &dyn System) -> PyResult<Axis> {
        let Axis {
            from, to, count, ..
        } = self.axis;
        let entry = match &self.entry {
            Entry::Number(number) => *number,
            Entry::Name(name) => place(system, name)?,
        };
        Ok(Axis::of(entry).from(from).to(to).cells(count))
    }
}

/// The number of an entry of the state.
fn place(system: &dyn System, name: &str) -> PyResult<usize> {
    let coordinates = &system.facts().coordinates;
    let rate = name.strip_prefix("dot(").and_then(|n| n.strip_suffix(')'));
    let wanted = rate.unwrap_or(name);
    let found = coordinates.iter().position(|known| *known == wanted);
    let number = found.ok_or_else(|| {
        let known: Vec<&str> = coordinates.iter().map(AsRef::as_ref).collect();
        PyValueError::new_err(format!(
            "{name} is no entry of a state: coordinates are {}, their velocities dot(..)",
            known.join(", ")
        ))
    })?;
    Ok(number + if rate.is_some() { coordinates.len() } else { 0 })
}

/// What the motions from states settle to.
pub fn settle<'py>(
    starts: &Bound<'py, PyAny>,
    system: &Arc<dyn System>,
    watch: Watch,
    given: Given<'py>,
) -> PyResult<Bound<'py, PyAny>> {
    let basin = asked(system, &given)?.grid(Grid::of_states(rows(starts)?));
    given.end()?;
    compute(
        starts.py(),
        watch,
        |cancel, see| basin.cancel(cancel).run_with(see),
        |basins| PyBasins::new(basins, None),
    )
}

/// What the motions from a grid of states settle to.
pub fn basin<'py>(
    py: Python<'py>,
    [columns, rows]: [&PyAxis; 2],
    system: &Arc<dyn System>,
    watch: Watch,
    given: Given<'py>,
) -> PyResult<Bound<'py, PyAny>> {
    let (columns, rows) = (columns.of(system)?, rows.of(system)?);
    let start = match given.any("start")? {
        Some(start) => numbers(&start)?,
        None => vec![0.0; 2 * system.facts().coordinates.len()],
    };
    let shape = [rows.count, columns.count];
    let basin = asked(system, &given)?.grid(Grid::new(start, columns, rows));
    given.end()?;
    compute(
        py,
        watch,
        |cancel, see| basin.cancel(cancel).run_with(see),
        |basins| PyBasins::new(basins, Some(shape)),
    )
}

/// A request with what all of them take.
fn asked(system: &Arc<dyn System>, given: &Given<'_>) -> PyResult<Basin> {
    let mut basin = Basin::of(system).omega(given.need("omega")?);
    if let Some(phase) = given.take("phase")? {
        basin = basin.phase(phase);
    }
    if let Some(period) = given.take("longest")? {
        basin = basin.longest(period);
    }
    if let Some(periods) = given.take("patience")? {
        basin = basin.patience(periods);
    }
    if let Some(bound) = given.take("escape")? {
        basin = basin.escape(bound);
    }
    if let Some(tolerance) = given.take("tolerance")? {
        basin = basin.tolerance(tolerance);
    }
    if let Some(count) = given.take("threads")? {
        basin = basin.threads(count);
    }
    Ok(basin)
}

/// What motions settle to.
#[pyclass(frozen, name = "Basins", module = "hertzian", eq)]
#[derive(PartialEq)]
pub struct PyBasins {
    basins: Basins,
    /// Rows and columns of a grid.
    shape: Option<[usize; 2]>,
}

impl PyBasins {
    fn new(basins: Basins, shape: Option<[usize; 2]>) -> Self {
        Self { basins, shape }
    }
}

#[pymethods]
impl PyBasins {
    /// The basins of a file that `write` or the library has written.
    #[staticmethod]
    fn read(py: Python<'_>, path: PathBuf) -> PyResult<Self> {
        let basins = py.detach(|| Basins::read(path)).map_err(exception)?;
        let grid = &basins.grid;
        let is_image = grid.given().is_empty();
        let shape = is_image.then_some([grid.rows.count, grid.columns.count]);
        Ok(Self::new(basins, shape))
    }

    /// Writes them as JSON.
    fn write(&self, py: Python<'_>, path: PathBuf) -> PyResult<()> {
        py.detach(|| self.basins.write(path)).map_err(exception)
    }

    /// Values of all parameters: dict of str and float.
    #[getter]
    fn parameters(&self) -> BTreeMap<&str, f64> {
        let names = self.basins.model.parameters.iter();
        let names = names.map(|parameter| parameter.name.as_str());
        names.zip(self.basins.parameters.iter().copied()).collect()
    }

    /// The excitation frequency: float, in radians per unit of time.
    #[getter]
    fn omega(&self) -> f64 {
        self.basins.omega
    }

    /// What becomes of each motion: the number of its attractor, or a `Fate`: array of int of shape (states,), or (rows, columns) of a
    /// grid.
    #[getter]
    fn fates<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        let fates = self.basins.fates.iter().map(|fate| fate.label());
        let fates = PyArray1::from_iter(py, fates);
        Ok(match self.shape {
            Some(shape) => fates.reshape(shape)?.into_any(),
            None => fates.into_any(),
        })
    }

    /// The periodic attractors, by period, then by their first point: list of `Attractor`.
    #[getter]
    fn attractors(&self) -> Vec<PyAttractor> {
        let attractors = self.basins.attractors.iter();
        attractors.cloned().map(PyAttractor).collect()
    }

    /// Periods that were computed: int.
    #[getter]
    fn periods(&self) -> u64 {
        self.basins.periods
    }

    /// Whether all motions were looked at: bool.
    #[getter]
    fn complete(&self) -> bool {
        self.basins.complete
    }

    /// How many motions settle to an attractor, by its number, or have a `Fate`: int.
    fn count(&self, fate: i16) -> usize {
        let fates = self.basins.fates.iter();
        fates.filter(|other| other.label() == fate).count()
    }

    fn __repr__(&self) -> String {
        let settled = self.basins.fates.iter();
        let settled = settled.filter(|fate| fate.label() >= 0).count();
        format!(
            "<Basins: {settled} of {} motions settle to {} attractors>",
            self.basins.fates.len(),
            self.basins.attractors.len()
        )
    }
}

/// A stable periodic orbit.
#[pyclass(frozen, name = "Attractor", module = "hertzian", eq)]
#[derive(PartialEq)]
pub struct PyAttractor(Attractor);

#[pymethods]
impl PyAttractor {
    /// Its shortest period, in periods of the declaration: int.
    #[getter]
    fn period(&self) -> usize {
        self.0.period
    }

    /// Its states at the phase, in the order in which it visits them, all positions, then all velocities: array of shape (period,
    /// 2 coordinates).
    #[getter]
    fn points<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray2<f64>>> {
        let columns = self.0.points.first().map_or(0, Vec::len);
        matrix(py, self.0.points.concat(), columns)
    }

    /// Floquet multipliers over its period, largest modulus first: complex array of shape (multipliers,).
    #[getter]
    fn multipliers<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<Complex<f64>>> {
        PyArray1::from_slice(py, &self.0.multipliers)
    }

    fn __repr__(&self) -> String {
        let largest = self.0.multipliers.first().map_or(f64::NAN, |m| m.norm());
        format!(
            "<Attractor of period {}, largest multiplier {largest:.6}>",
            self.0.period
        )
    }
}
