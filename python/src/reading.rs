//! A signal over the period of an orbit.

use hertzian::fourier::series;
use hertzian::observe::Reading;
use numpy::PyArray1;
use pyo3::prelude::*;

use crate::observed::PyMotion;
use crate::orbit::{shaped, times};

/// A signal over the period of an orbit: an output, a coordinate, or the force of a contact.
#[pyclass(frozen, name = "Reading", module = "hertzian", eq)]
#[derive(PartialEq)]
pub struct PyReading(pub Reading);

#[pymethods]
impl PyReading {
    /// Its extremes, mean and root of the mean square: those of the signal itself, not of its series: `Motion`.
    #[getter]
    fn motion(&self) -> PyMotion {
        PyMotion(self.0.motion)
    }

    /// Its Fourier series in harmonics of the orbit, ``[mean, cos 1, sin 1, cos 2, ..]``: array of shape (2 harmonics + 1,).
    #[getter]
    fn series<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        PyArray1::from_slice(py, &self.0.series)
    }

    /// The base frequency of the orbit, in radians per unit of time: float.
    #[getter]
    fn base(&self) -> f64 {
        self.0.base
    }

    /// The mean and all harmonics: `Spectrum`.
    #[getter]
    fn spectrum(&self, py: Python<'_>) -> PySpectrum {
        let lines = self.0.spectrum();
        let array = |number: fn(&hertzian::observe::SpectrumLine) -> f64| {
            PyArray1::from_iter(py, lines.iter().map(number)).unbind()
        };
        PySpectrum {
            omega: array(|line| line.omega),
            amplitude: array(|line| line.amplitude),
            phase: array(|line| line.phase),
        }
    }

    /// The value of its series at a time, or at an array of times, counted from phase zero of the excitation: float, or an array of
    /// the same shape.
    fn value<'py>(&self, time: &Bound<'py, PyAny>) -> PyResult<Bound<'py, PyAny>> {
        let at = times(time)?;
        let value = |t: f64| series::value(&self.0.series, self.0.base * t);
        shaped(time.py(), at.as_array().mapv(value))
    }

    fn __repr__(&self) -> String {
        let harmonics = series::harmonics(&self.0.series);
        format!("<Reading of {harmonics} harmonics of {}>", self.0.base)
    }
}

/// The harmonics of a signal, the mean first: it is the sum of ``amplitude*cos(omega*t - phase)``.
#[pyclass(frozen, get_all, name = "Spectrum", module = "hertzian")]
pub struct PySpectrum {
    /// Frequencies, in radians per unit of time: array of shape (harmonics + 1,).
    omega: Py<PyArray1<f64>>,
    /// Amplitudes, of the mean with its sign, in the unit of the signal: array of the same shape.
    amplitude: Py<PyArray1<f64>>,
    /// Phase lags in radians: array of the same shape.
    phase: Py<PyArray1<f64>>,
}

#[pymethods]
impl PySpectrum {
    fn __repr__(&self, py: Python<'_>) -> PyResult<String> {
        let lines = self.omega.bind(py).len()?;
        Ok(format!("<Spectrum of {lines} lines, the mean first>"))
    }
}
