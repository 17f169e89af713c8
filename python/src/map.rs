//! Which solutions exist over two parameters.

use std::path::PathBuf;

use hertzian::Error;
use hertzian::bifurcation::{Cell, Map};
use hertzian::chart::Chart;
use numpy::{PyArray1, PyArray2};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;

use crate::arrays::matrix;
use crate::errors::exception;

/// The periodic solutions over two parameters, as far as they were found; ``print`` shows how many cells have what. Arrays have a row for
/// each value of the second parameter and a column for each of the first.
#[pyclass(frozen, name = "Map", module = "hertzian", eq)]
#[derive(PartialEq)]
pub struct PyMap(pub Map);

impl PyMap {
    /// A number of each cell.
    fn cells<'py, T: numpy::Element>(
        &self,
        py: Python<'py>,
        of: impl Fn(&Cell) -> T,
    ) -> PyResult<Bound<'py, PyArray2<T>>> {
        let numbers = self.0.cells.iter().map(of).collect();
        matrix(py, numbers, self.0.values[0].len())
    }

    fn chart(&self, of: &str) -> PyResult<Chart> {
        Ok(match of {
            "stable" => self.0.chart_of_stable(),
            "largest" => self.0.chart_of_largest(),
            "verdict" => self.0.chart_of_verdicts(),
            _ => {
                let text = format!("{of} is no chart of a map: stable, largest or verdict");
                return Err(PyValueError::new_err(text));
            }
        })
    }
}

#[pymethods]
impl PyMap {
    /// The map of a file that ``write`` or the program has written: `Map`.
    #[staticmethod]
    fn read(py: Python<'_>, path: PathBuf) -> PyResult<Self> {
        py.detach(|| Map::read(path)).map(Self).map_err(exception)
    }

    /// Writes it as JSON.
    fn write(&self, py: Python<'_>, path: PathBuf) -> PyResult<()> {
        py.detach(|| self.0.write(path)).map_err(exception)
    }

    /// What varies along a row, and from row to row: tuple of str.
    #[getter]
    fn names(&self) -> (&str, &str) {
        let [along, across] = &self.0.names;
        (along, across)
    }

    /// Values along a row: array of shape (columns,).
    #[getter]
    fn columns<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        PyArray1::from_slice(py, &self.0.values[0])
    }

    /// Values from row to row: array of shape (rows,).
    #[getter]
    fn rows<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        PyArray1::from_slice(py, &self.0.values[1])
    }

    /// Number of stable orbits, of any period: array of int.
    #[getter]
    fn stable<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray2<usize>>> {
        self.cells(py, |cell| cell.stable)
    }

    /// Number of unstable orbits: array of int.
    #[getter]
    fn unstable<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray2<usize>>> {
        self.cells(py, |cell| cell.unstable)
    }

    /// Number of orbits whose stability is not certain: array of int.
    #[getter]
    fn undecided<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray2<usize>>> {
        self.cells(py, |cell| cell.undecided)
    }

    /// Number of orbits that motions settled to and whose branch could not be followed: array of int.
    #[getter]
    fn missed<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray2<usize>>> {
        self.cells(py, |cell| cell.missed)
    }

    /// Number of motions that were followed: array of int.
    #[getter]
    fn motions<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray2<usize>>> {
        self.cells(py, |cell| cell.motions)
    }

    /// How many of these settled to no orbit: array of int.
    #[getter]
    fn restless<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray2<usize>>> {
        self.cells(py, |cell| cell.restless)
    }

    /// Largest peak-to-peak of `signal` among the stable orbits; not a number where it is not known: array of float.
    #[getter]
    fn largest<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray2<f64>>> {
        self.cells(py, |cell| cell.largest.unwrap_or(f64::NAN))
    }

    /// What `largest` is of: str.
    #[getter]
    fn signal(&self) -> &str {
        &self.0.signal
    }

    /// What can be said of all orbits of a cell together, row by row: list of lists of str.
    #[getter]
    fn verdicts(&self) -> Vec<Vec<String>> {
        let row = |row: &[Cell]| row.iter().map(|cell| cell.verdict().to_string()).collect();
        self.0.rows().map(row).collect()
    }

    /// How many branches were followed for each row: list of int.
    #[getter]
    fn branches(&self) -> Vec<usize> {
        self.0.branches.clone()
    }

    /// Draws the cells as an SVG file: ``"stable"``, the number of stable orbits, ``"largest"`` or ``"verdict"``.
    #[pyo3(signature = (path, of="stable"))]
    fn plot(&self, py: Python<'_>, path: PathBuf, of: &str) -> PyResult<()> {
        let chart = self.chart(of)?;
        let written = py.detach(|| -> Result<(), Error> { Ok(chart.write(path)?) });
        written.map_err(exception)
    }

    fn _repr_svg_(&self) -> String {
        self.0.chart_of_stable().to_svg()
    }

    fn __str__(&self) -> String {
        self.0.to_string()
    }

    fn __repr__(&self) -> String {
        let ([columns, rows], [along, across]) = (&self.0.values, &self.0.names);
        let [columns, rows] = [columns.len(), rows.len()];
        format!("<Map: {columns} values of {along}, {rows} of {across}>")
    }
}
