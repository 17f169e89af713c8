//! One orbit of a branch with what is known of it.

use hertzian::observe::Wanted;
use hertzian::{Complex, RequestError};
use numpy::PyArray1;
use pyo3::prelude::*;

use crate::errors::exception;
use crate::held::{Owner, PointRef};
use crate::observed::PyObserved;
use crate::orbit::PyOrbit;
use crate::reading::PyReading;
use crate::request::by_any;

/// One orbit with what is known of it.
#[pyclass(frozen, name = "Point", module = "hertzian")]
pub struct PyPoint(pub PointRef);

/// What is asked of a signal, as ``"tip:rms"``.
pub fn wanted(text: &str) -> PyResult<Wanted> {
    text.parse().map_err(|error: RequestError| exception(error))
}

#[pymethods]
impl PyPoint {
    /// Value of what the branch varies, the excitation frequency or a parameter: float.
    #[getter]
    fn value(&self) -> f64 {
        self.0.value
    }

    /// Excitation frequency, in radians per unit of time: float.
    #[getter]
    fn omega(&self) -> f64 {
        self.0.omega()
    }

    /// The parameters by their names: dict of float.
    #[getter]
    fn parameters<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, pyo3::types::PyDict>> {
        let model = self.0.owner().model();
        let names = model.parameters.iter().map(|parameter| &parameter.name);
        let dict = pyo3::types::PyDict::new(py);
        for (name, value) in names.zip(&self.0.parameters) {
            dict.set_item(name, value)?;
        }
        Ok(dict)
    }

    /// The orbit: `Orbit`.
    #[getter]
    fn orbit(&self) -> PyOrbit {
        PyOrbit {
            orbit: self.0.orbit.clone(),
            names: self.0.owner().model().coordinates,
        }
    }

    /// Its stability: `Stability`.
    #[getter]
    fn stability(&self) -> PyStability {
        PyStability(self.0.clone())
    }

    /// What is read off it: `Observed`.
    #[getter]
    fn observed(&self, py: Python<'_>) -> PyResult<PyObserved> {
        PyObserved::of(py, &self.0.owner().model(), &self.0)
    }

    /// Estimated error of peak-to-peak, relative; infinite where it could not be estimated: float or None.
    #[getter]
    fn error(&self) -> Option<f64> {
        self.0.error
    }

    /// Peak-to-peak of the first coordinate, in its unit: float.
    #[getter]
    fn peak_to_peak(&self) -> f64 {
        self.0.peak_to_peak()
    }

    /// An output, a coordinate or the force of a contact over the period, by its name: `Reading`. Of an orbit by shooting its
    /// motion is computed once more.
    fn reading(&self, py: Python<'_>, name: &str) -> PyResult<PyReading> {
        let point = &self.0;
        let reading = py.detach(|| match point.owner() {
            Owner::Branch(branch) => branch.reading(name, point),
            Owner::Request(asked) => by_any!(&asked.request, r => r.reading(name, point)),
        });
        reading.map(PyReading).map_err(exception)
    }

    /// What is asked of a signal by its name, as ``"tip:rms"``: float, or None where it is not known, as a harmonic of an orbit that
    /// has fewer.
    ///
    /// Measures are p2p, max, min, mean, rms, crest, h1, phase1 (radians), and of contacts impulse, impacts and piece1. A name alone
    /// asks for its p2p.
    #[pyo3(name = "measured")]
    fn measure(&self, py: Python<'_>, wanted: &str) -> PyResult<Option<f64>> {
        let (point, wanted) = (&self.0, self::wanted(wanted)?);
        let measured = py.detach(|| match point.owner() {
            Owner::Branch(branch) => branch.measured(&wanted, point),
            Owner::Request(asked) => by_any!(&asked.request, r => r.measured(&wanted, point)),
        });
        measured.map_err(exception)
    }

    fn __eq__(&self, other: &Bound<'_, PyAny>) -> bool {
        other
            .cast::<Self>()
            .is_ok_and(|other| *self.0 == *other.get().0)
    }

    fn __repr__(&self) -> String {
        format!(
            "<Point at {}: peak-to-peak {:.6}, {}>",
            self.0.value,
            self.0.peak_to_peak(),
            self.0.stability.verdict
        )
    }
}

/// What is known of the stability of an orbit.
#[pyclass(frozen, name = "Stability", module = "hertzian")]
pub struct PyStability(PointRef);

#[pymethods]
impl PyStability {
    /// ``"stable"``, ``"unstable"`` or ``"undecided"``, where the error of the multipliers allows neither: str.
    #[getter]
    fn verdict(&self) -> String {
        self.0.stability.verdict.to_string()
    }

    /// Floquet multipliers over the orbit's own period, largest modulus first: complex array of shape (multipliers,).
    #[getter]
    fn multipliers<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<Complex<f64>>> {
        PyArray1::from_slice(py, &self.0.stability.multipliers)
    }

    /// Estimated error of the multipliers: float.
    #[getter]
    fn error(&self) -> f64 {
        self.0.stability.error
    }

    /// So many multipliers more are exactly one, since nothing holds the system along some directions: int.
    #[getter]
    fn rigid(&self) -> usize {
        self.0.stability.rigid
    }

    fn __repr__(&self) -> String {
        let stability = &self.0.stability;
        let largest = stability.multipliers.first().map_or(f64::NAN, |m| m.norm());
        format!(
            "<Stability: {}, largest multiplier {largest:.6} (error {:.0e})>",
            stability.verdict, stability.error
        )
    }
}
