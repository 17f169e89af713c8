//! Curves of bifurcations in two parameters.

use hertzian::shooting::{BifurcationCurve, Special};
use hertzian::{Complex, Point};
use numpy::{PyArray1, PyArray2};
use pyo3::prelude::*;

use crate::arrays::{matrix, ragged};
use crate::stop::PyStop;

/// A curve of bifurcations in the plane of two parameters.
#[pyclass(frozen, name = "BifurcationCurve", module = "hertzian", eq)]
#[derive(PartialEq)]
pub struct PyBifurcationCurve(pub BifurcationCurve);

#[pymethods]
impl PyBifurcationCurve {
    /// What bifurcates, as of events: str.
    #[getter]
    fn kind(&self) -> String {
        self.0.kind.to_string()
    }

    /// Names of the two parameters: two str.
    #[getter]
    fn names(&self) -> (String, String) {
        let [first, second] = &self.0.names;
        (first.clone(), second.clone())
    }

    /// Period of the orbits in periods of the declaration: int.
    #[getter]
    fn period(&self) -> usize {
        self.0.period
    }

    /// Values of the two parameters, in the order of the curve: array of shape (points, 2).
    #[getter]
    fn values<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray2<f64>>> {
        matrix(py, self.0.values.as_flattened().to_vec(), 2)
    }

    /// States at phase zero, all positions, then all velocities: array of shape (points, 2 coordinates).
    #[getter]
    fn states<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray2<f64>>> {
        let points = self.0.points.iter();
        let states: Vec<Vec<f64>> = points.map(|point| point.orbit.state()).collect();
        let columns = states.first().map_or(0, Vec::len);
        matrix(py, states.concat(), columns)
    }

    /// Floquet multipliers over the period, largest modulus first: complex array of shape (points, multipliers).
    #[getter]
    fn multipliers<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray2<Complex<f64>>>> {
        let rows = self.0.points.iter();
        let rows: Vec<&[Complex<f64>]> = rows.map(|p| p.stability.multipliers.as_slice()).collect();
        ragged(py, &rows)
    }

    /// How often a gap crosses a level in a period: array of int of shape (points,).
    #[getter]
    fn switches<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<u64>> {
        let points = self.0.points.iter();
        let switches = points.map(|point| point.observed.switches.unwrap_or_default() as u64);
        PyArray1::from_iter(py, switches)
    }

    /// Peak-to-peak of the first coordinate: array of shape (points,).
    #[getter]
    fn peak_to_peak<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        PyArray1::from_iter(py, self.0.points.iter().map(Point::peak_to_peak))
    }

    /// Its special points, in the order of the curve: list of `Special`.
    #[getter]
    fn special(&self) -> Vec<PySpecial> {
        self.0.special.iter().cloned().map(PySpecial).collect()
    }

    /// Why it ended on both sides: two `Stop`.
    #[getter]
    fn ends(&self) -> (PyStop, PyStop) {
        let [first, last] = self.0.ends;
        (PyStop(first), PyStop(last))
    }

    fn __len__(&self) -> usize {
        self.0.points.len()
    }

    fn __repr__(&self) -> String {
        let [first, second] = &self.0.names;
        format!(
            "<BifurcationCurve of {} over {first} and {second}: {} points>",
            self.0.kind,
            self.0.points.len()
        )
    }
}

/// A special point of a curve of bifurcations; ``str()`` of it is a sentence.
#[pyclass(frozen, name = "Special", module = "hertzian", eq)]
#[derive(PartialEq)]
pub struct PySpecial(Special);

#[pymethods]
impl PySpecial {
    /// What is special: str.
    #[getter]
    fn kind(&self) -> String {
        self.0.kind.to_string()
    }

    /// Values of the two parameters: two floats.
    #[getter]
    fn values(&self) -> (f64, f64) {
        self.0.values.into()
    }

    /// Estimated error of them: float.
    #[getter]
    fn error(&self) -> f64 {
        self.0.error
    }

    /// Number of points of the curve before it: int.
    #[getter]
    fn after(&self) -> usize {
        self.0.after
    }

    fn __str__(&self) -> String {
        self.0.to_string()
    }

    fn __repr__(&self) -> String {
        format!("<Special: {}>", self.0)
    }
}
