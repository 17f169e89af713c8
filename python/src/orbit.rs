//! A periodic orbit.

use hertzian::Orbit;
use numpy::ndarray::ArrayD;
use numpy::{AllowTypeChange, PyArray1, PyArray2, PyArrayDyn, PyArrayLikeDyn, PyReadonlyArrayDyn};
use pyo3::IntoPyObjectExt;
use pyo3::exceptions::{PyKeyError, PyTypeError};
use pyo3::prelude::*;

use crate::arrays::{matrix, rows};
use crate::errors::{exception, refused};
use crate::model::PyModel;

/// A periodic orbit: the Fourier series of its coordinates, as the balance finds them, or states along it, as shooting does.
#[pyclass(frozen, name = "Orbit", module = "hertzian", eq)]
#[derive(PartialEq)]
pub struct PyOrbit {
    pub orbit: Orbit,
    /// Of the coordinates.
    pub names: Vec<String>,
}

impl PyOrbit {
    /// The number of a coordinate.
    fn place(&self, coordinate: &Bound<'_, PyAny>) -> PyResult<usize> {
        let known = || self.names.join(", ");
        if let Ok(name) = coordinate.extract::<String>() {
            let place = self.names.iter().position(|known| *known == name);
            return place.ok_or_else(|| {
                PyKeyError::new_err(format!(
                    "no coordinate is called {name}: there are {}",
                    known()
                ))
            });
        }
        let number: usize = coordinate.extract().map_err(|_| {
            PyTypeError::new_err("a coordinate is given by its name, or by its number from zero on")
        })?;
        if number < self.names.len() {
            return Ok(number);
        }
        Err(PyKeyError::new_err(format!(
            "there is no coordinate {number}: there are {}",
            known()
        )))
    }
}

#[pymethods]
impl PyOrbit {
    /// A guess from Fourier series of the coordinates, for ``near_orbit``.
    ///
    /// ``series`` has for each coordinate ``[mean, cos 1, sin 1, ..]`` in harmonics of the base frequency: array of shape
    /// (coordinates, 2 harmonics + 1). ``period`` is in periods of the declaration.
    #[staticmethod]
    fn from_series(
        model: &PyModel,
        omega: f64,
        period: usize,
        series: &Bound<'_, PyAny>,
    ) -> PyResult<Self> {
        let system = model.system();
        let orbit = Orbit::from_series(&system, omega, period, &rows(series)?);
        Ok(Self {
            orbit: orbit.map_err(exception)?,
            names: hertzian::Model::of(&system).coordinates,
        })
    }

    /// A guess from samples of the coordinates at equal distances over the period from time zero on, its end left out, for
    /// ``near_orbit``: array of shape (coordinates, samples).
    #[staticmethod]
    fn from_samples(
        model: &PyModel,
        omega: f64,
        period: usize,
        samples: &Bound<'_, PyAny>,
    ) -> PyResult<Self> {
        let system = model.system();
        let orbit = Orbit::from_samples(&system, omega, period, &rows(samples)?);
        Ok(Self {
            orbit: orbit.map_err(exception)?,
            names: hertzian::Model::of(&system).coordinates,
        })
    }

    /// Excitation frequency, in radians per unit of time: float.
    #[getter]
    fn omega(&self) -> f64 {
        self.orbit.omega
    }

    /// Base frequency: the orbit repeats after ``2*pi/base``: float.
    #[getter]
    fn base(&self) -> f64 {
        self.orbit.base
    }

    /// Its period, in periods of the declaration: int.
    #[getter]
    fn period(&self) -> usize {
        self.orbit.period
    }

    /// Number of equal parts of its period after each of which it is the same again but for a symmetry: int.
    #[getter]
    fn parts(&self) -> usize {
        self.orbit.parts
    }

    /// Whether it was followed as one of odd symmetry: bool.
    #[getter]
    fn symmetric(&self) -> bool {
        self.orbit.symmetric
    }

    /// Number of coordinates: int.
    #[getter]
    fn coordinates(&self) -> usize {
        self.orbit.coordinates()
    }

    /// Number of harmonics; zero where the series are not known: int.
    #[getter]
    fn harmonics(&self) -> usize {
        self.orbit.harmonics()
    }

    /// The state at phase zero, all positions, then all velocities: array of shape (2 coordinates,).
    #[getter]
    fn state<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        PyArray1::from_vec(py, self.orbit.state())
    }

    /// The states at the beginnings of the segments of shooting: array of shape (segments, 2 coordinates), without rows by the balance.
    #[getter]
    fn states<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray2<f64>>> {
        let states: Vec<f64> = self.orbit.states().flatten().copied().collect();
        matrix(py, states, 2 * self.orbit.coordinates())
    }

    /// Fourier series of a coordinate, by its name or number, ``[mean, cos 1, sin 1, ..]``: array of shape (2 harmonics + 1,).
    fn series<'py>(
        &self,
        py: Python<'py>,
        coordinate: &Bound<'py, PyAny>,
    ) -> PyResult<Bound<'py, PyArray1<f64>>> {
        let series = self.orbit.series(self.place(coordinate)?);
        let series = series.ok_or_else(no_series)?;
        Ok(PyArray1::from_slice(py, series))
    }

    /// Position and velocity of a coordinate, by its name or number, at a time or an array of times counted from phase zero of the
    /// excitation: two floats, or two arrays of the same shape.
    fn state_at<'py>(
        &self,
        coordinate: &Bound<'py, PyAny>,
        time: &Bound<'py, PyAny>,
    ) -> PyResult<(Bound<'py, PyAny>, Bound<'py, PyAny>)> {
        let (py, place) = (time.py(), self.place(coordinate)?);
        if self.orbit.series(place).is_none() {
            return Err(no_series());
        }
        let at = times(time)?;
        let states = at.as_array().mapv(|t| self.orbit.state_at(place, t));
        let part = |part: fn((f64, f64)) -> f64| {
            let numbers = states.mapv(|state| state.map_or(f64::NAN, part));
            shaped(py, numbers)
        };
        Ok((part(|state| state.0)?, part(|state| state.1)?))
    }

    fn __repr__(&self) -> String {
        let orbit = &self.orbit;
        let form = match orbit.harmonics() {
            0 => format!("{} states", orbit.states().count()),
            harmonics => format!("{harmonics} harmonics"),
        };
        format!(
            "<Orbit at omega {}, period {}, {form}>",
            orbit.omega, orbit.period
        )
    }
}

/// What only an orbit with series has was asked of another.
fn no_series() -> PyErr {
    refused("the series of this orbit are not known: `Branch.complete` computes them")
}

/// Times, of any shape.
pub fn times<'py>(time: &Bound<'py, PyAny>) -> PyResult<PyReadonlyArrayDyn<'py, f64>> {
    let times: PyArrayLikeDyn<'py, f64, AllowTypeChange> = time.extract()?;
    Ok((*times).clone())
}

/// Numbers in the shape of the times that they are at; one alone as it is.
pub fn shaped(py: Python<'_>, numbers: ArrayD<f64>) -> PyResult<Bound<'_, PyAny>> {
    match numbers.first() {
        Some(number) if numbers.ndim() == 0 => number.into_bound_py_any(py),
        _ => Ok(PyArrayDyn::from_owned_array(py, numbers).into_any()),
    }
}
