//! Motions in time: sweeps and histories.

use std::f64::consts::TAU;
use std::sync::Arc;

use hertzian::attractors::sweep::{Row, Sweep, Swept};
use hertzian::time;
use hertzian::time::history::record;
use hertzian::time::stroboscope::Stroboscope;
use hertzian::{RequestError, System};
use numpy::{PyArray1, PyArray2};
use pyo3::exceptions::PyMemoryError;
use pyo3::prelude::*;

use crate::arrays::{matrix, numbers};
use crate::compute::{Watch, compute};
use crate::errors::exception;
use crate::given::Given;

/// What a motion settles to as something changes in steps.
pub fn sweep<'py>(
    py: Python<'py>,
    [from, to]: [f64; 2],
    system: &Arc<dyn System>,
    watch: Watch,
    given: Given<'py>,
) -> PyResult<Bound<'py, PyAny>> {
    let mut sweep = Sweep::of(system).from(from).to(to);
    if let Some(name) = given.take::<String>("vary")? {
        sweep = sweep.vary(name);
    }
    if let Some(omega) = given.take("omega")? {
        sweep = sweep.omega(omega);
    }
    if let Some(count) = given.take("values")? {
        sweep = sweep.values(count);
    }
    if let Some(wanted) = given.take("back")? {
        sweep = sweep.back(wanted);
    }
    if let Some(start) = given.any("start")? {
        sweep = sweep.start(&numbers(&start)?);
    }
    if let Some(periods) = given.take("transient")? {
        sweep = sweep.transient(periods);
    }
    if let Some(periods) = given.take("periods")? {
        sweep = sweep.periods(periods);
    }
    if let Some(bound) = given.take("escape")? {
        sweep = sweep.escape(bound);
    }
    if let Some(tolerance) = given.take("tolerance")? {
        sweep = sweep.tolerance(tolerance);
    }
    given.end()?;
    let columns = 2 * system.facts().coordinates.len();
    compute(
        py,
        watch,
        |cancel, see| sweep.cancel(cancel).run_with(see),
        |swept| PySwept { swept, columns },
    )
}

/// What a sweep has seen.
#[pyclass(frozen, name = "Swept", module = "hertzian", eq)]
#[derive(PartialEq)]
pub struct PySwept {
    swept: Swept,
    columns: usize,
}

#[pymethods]
impl PySwept {
    /// Value by value, in order: list of `Row`.
    #[getter]
    fn rows(&self) -> Vec<PyRow> {
        let columns = self.columns;
        let rows = self.swept.rows.iter().cloned();
        rows.map(|row| PyRow { row, columns }).collect()
    }

    /// The values: array of shape (rows,).
    #[getter]
    fn values<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        PyArray1::from_iter(py, self.swept.rows.iter().map(|row| row.value))
    }

    /// Whether these are all values; otherwise it was interrupted: bool.
    #[getter]
    fn complete(&self) -> bool {
        self.swept.complete
    }

    fn __repr__(&self) -> String {
        format!("<Swept: {} values>", self.swept.rows.len())
    }
}

/// What a sweep has seen at one value.
#[pyclass(frozen, name = "Row", module = "hertzian", eq)]
#[derive(PartialEq)]
pub struct PyRow {
    row: Row,
    columns: usize,
}

#[pymethods]
impl PyRow {
    /// The value: float.
    #[getter]
    fn value(&self) -> f64 {
        self.row.value
    }

    /// States at the beginnings of periods, all positions, then all velocities: array of shape (periods, 2 coordinates).
    #[getter]
    fn points<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray2<f64>>> {
        matrix(py, self.row.points.clone(), self.columns)
    }

    /// Why it has no points: str or None.
    #[getter]
    fn ended(&self) -> Option<String> {
        self.row.ended.map(|ended| ended.to_string())
    }

    fn __repr__(&self) -> String {
        format!("<Row at {}>", self.row.value)
    }
}

/// How long a motion is recorded, and how densely.
#[derive(Clone, Copy)]
pub struct Asked {
    pub omega: f64,
    pub periods: usize,
    pub samples: usize,
    pub tolerance: f64,
}

/// More would not fit into memory well.
const MOST_STATES: usize = 1 << 27;

/// The motion from a state: times and states.
pub fn history<'py>(
    py: Python<'py>,
    state: Option<Vec<f64>>,
    system: &Arc<dyn System>,
    watch: Watch,
    asked: Asked,
) -> PyResult<Bound<'py, PyAny>> {
    let order = 2 * system.facts().coordinates.len();
    let mut state = state.unwrap_or_else(|| vec![0.0; order]);
    let entries = state.len();
    if entries != order {
        let expected = order;
        return Err(exception(RequestError::State { entries, expected }));
    }
    let Asked {
        omega,
        periods,
        samples,
        tolerance,
    } = asked;
    let states = periods.saturating_mul(samples.max(1)).saturating_mul(order);
    if states > MOST_STATES {
        return Err(PyMemoryError::new_err(format!(
            "{periods} periods of {samples} samples are too many to be kept"
        )));
    }
    let period = TAU * f64::from(system.facts().divisor) / omega;
    let (mut times, mut states) = (Vec::new(), Vec::new());
    let seen = (&mut times, &mut states);
    let ended = compute(
        py,
        watch,
        |cancel, _| {
            let mut flow = time::of(system, omega, tolerance)?;
            flow.until(cancel);
            let mut map = Stroboscope::new(flow);
            let moved = record(
                &mut map,
                &mut state,
                periods,
                samples,
                &mut |part, state| {
                    seen.0.push(part * period);
                    seen.1.extend_from_slice(state);
                },
            );
            Ok(moved?)
        },
        |()| true,
    );
    let recorded = (PyArray1::from_vec(py, times), matrix(py, states, order)?);
    let recorded = recorded.into_pyobject(py)?.into_any();
    match ended {
        Ok(_) => Ok(recorded),
        Err(error) => {
            // What came before.
            error.value(py).setattr("result", &recorded)?;
            Err(error)
        }
    }
}
