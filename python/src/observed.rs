//! What is read off an orbit.

use hertzian::Point;
use hertzian::observe::{ContactMotion, Motion};
use pyo3::prelude::*;
use pyo3::types::PyDict;

use hertzian::Model;
use numpy::PyArray1;

/// What is read off an orbit over its period. Of an orbit by shooting the extremes of the coordinates, and the rest after
/// `Branch.complete`.
#[pyclass(frozen, get_all, name = "Observed", module = "hertzian")]
pub struct PyObserved {
    /// The coordinates by their names: dict of `Motion`.
    motions: Py<PyDict>,
    /// The outputs by their names; empty where only the extremes of the coordinates were read off: dict of `Motion`.
    outputs: Py<PyDict>,
    /// The contacts by their names; empty where only the extremes were read off: dict of `ContactMotion`.
    contacts: Py<PyDict>,
    /// For each contact, by its name, the part of the period on each piece of its law, from the piece of the lowest gaps to that of
    /// the highest; they add up to one: dict of arrays.
    on_pieces: Py<PyDict>,
    /// Mean power of the load, in force times length per time: float or None.
    input_power: Option<f64>,
    /// Mean power that damping, stiffness and contacts take up: float or None.
    dissipated_power: Option<f64>,
    /// How often a gap crosses a level in the period, where shooting has counted that: int or None.
    switches: Option<usize>,
    /// Whether `motions` has the first coordinate alone, since accuracy is of an output, until the orbit is completed: bool.
    sampled: bool,
}

impl PyObserved {
    pub fn of(py: Python<'_>, model: &Model, point: &Point) -> PyResult<Self> {
        let observed = &point.observed;
        let by_name = PyDict::new(py);
        let motions = |dict: &Bound<'_, PyDict>, names: &[&str], motions: &[Motion]| {
            let mut pairs = names.iter().zip(motions);
            pairs.try_for_each(|(name, motion)| dict.set_item(*name, PyMotion(*motion)))
        };
        let coordinates: Vec<&str> = model.coordinates.iter().map(String::as_str).collect();
        motions(&by_name, &coordinates, observed.read())?;
        let outputs = PyDict::new(py);
        let names: Vec<&str> = model.outputs.iter().map(|o| o.name.as_str()).collect();
        motions(&outputs, &names, &observed.outputs)?;
        let (contacts, on_pieces) = (PyDict::new(py), PyDict::new(py));
        for (name, contact) in model.contacts.iter().zip(&observed.contacts) {
            contacts.set_item(name, PyContactMotion(*contact))?;
        }
        for (name, pieces) in model.contacts.iter().zip(&observed.on_pieces) {
            on_pieces.set_item(name, PyArray1::from_slice(py, pieces))?;
        }
        Ok(Self {
            motions: by_name.unbind(),
            outputs: outputs.unbind(),
            contacts: contacts.unbind(),
            on_pieces: on_pieces.unbind(),
            input_power: observed.input_power,
            dissipated_power: observed.dissipated_power,
            switches: observed.switches,
            sampled: observed.sampled,
        })
    }
}

/// What is read off the motion of a coordinate or an output over a period, in its unit.
#[pyclass(frozen, name = "Motion", module = "hertzian", eq)]
#[derive(PartialEq)]
pub struct PyMotion(pub Motion);

#[pymethods]
impl PyMotion {
    /// Largest value: float.
    #[getter]
    fn maximum(&self) -> f64 {
        self.0.maximum
    }

    /// Smallest value: float.
    #[getter]
    fn minimum(&self) -> f64 {
        self.0.minimum
    }

    /// Mean; None where only the extremes were read off: float or None.
    #[getter]
    fn mean(&self) -> Option<f64> {
        self.0.mean
    }

    /// Root of the mean square, mean included; None where only the extremes were read off: float or None.
    #[getter]
    fn rms(&self) -> Option<f64> {
        self.0.rms
    }

    /// Largest less smallest value: float.
    #[getter]
    fn peak_to_peak(&self) -> f64 {
        self.0.peak_to_peak()
    }

    /// Largest value by size over the root of the mean square; None at rest in zero: float or None.
    #[getter]
    fn crest_factor(&self) -> Option<f64> {
        self.0.crest_factor()
    }

    fn __repr__(&self) -> String {
        let Motion {
            minimum, maximum, ..
        } = self.0;
        format!(
            "<Motion from {minimum:.6} to {maximum:.6}, rms {}>",
            self.0
                .rms
                .map_or("unknown".to_owned(), |rms| format!("{rms:.6}"))
        )
    }
}

/// What is read off a contact over a period of the orbit.
#[pyclass(frozen, name = "ContactMotion", module = "hertzian", eq)]
#[derive(PartialEq)]
pub struct PyContactMotion(pub ContactMotion);

#[pymethods]
impl PyContactMotion {
    /// Largest value of the law by size, without a factor that stands outside of it: float.
    #[getter]
    fn peak_force(&self) -> f64 {
        self.0.peak_force
    }

    /// Smallest value of the law, with its sign: float.
    #[getter]
    fn minimum_force(&self) -> f64 {
        self.0.minimum_force
    }

    /// Largest value of the law, with its sign: float.
    #[getter]
    fn maximum_force(&self) -> f64 {
        self.0.maximum_force
    }

    /// Part of the period on pieces whose force is not identically zero: float.
    #[getter]
    fn fraction(&self) -> f64 {
        self.0.fraction
    }

    /// Number of separate intervals of contact; one for contact that is never lost: int.
    #[getter]
    fn count(&self) -> usize {
        self.0.count
    }

    /// Integral of the law over the period of the orbit, in force times time: float or None.
    #[getter]
    fn impulse(&self) -> Option<f64> {
        self.0.impulse
    }

    /// How often contact begins in the period of the orbit; zero where it is never lost: int.
    #[getter]
    fn impacts(&self) -> usize {
        self.0.impacts()
    }

    fn __repr__(&self) -> String {
        let ContactMotion {
            minimum_force,
            maximum_force,
            fraction,
            ..
        } = self.0;
        format!(
            "<ContactMotion: force from {minimum_force:.6} to {maximum_force:.6}, in contact {fraction:.4} of the period>"
        )
    }
}
