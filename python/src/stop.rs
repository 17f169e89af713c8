//! Why branches end, and why parts of them are missing; variants with numbers: their name, their numbers by names, and their sentence.

use hertzian::{Leap, Stop};
use pyo3::IntoPyObjectExt;
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyList};
use serde::Serialize;
use serde_json::Value;

/// Why following a branch or a curve ended; ``str()`` of it is a sentence.
#[pyclass(frozen, name = "Stop", module = "hertzian", eq)]
#[derive(PartialEq)]
pub struct PyStop(pub Stop);

#[pymethods]
impl PyStop {
    /// What it is: ``"reached-end"``, ``"left-at-start"``, ``"closed"``, ``"joined"``, ``"joined-doublings"``, ``"point-limit"``,
    /// ``"step-too-short"``, ``"turned-back"``, ``"missed"``, ``"pulled-on"``, ``"motion"``, ``"unbounded"`` or ``"interrupted"``.
    #[getter]
    fn kind(&self) -> PyResult<String> {
        Ok(variant(&self.0)?.0)
    }

    /// Its numbers by their names, as ``{"value": 1.2, "growth": 1e6}``: dict.
    #[getter]
    fn values<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        object(py, &variant(&self.0)?.1)
    }

    fn __str__(&self) -> String {
        self.0.to_string()
    }

    fn __repr__(&self) -> String {
        format!("<Stop: {}>", self.0)
    }
}

/// A part of a branch that is missing.
#[pyclass(frozen, name = "Leap", module = "hertzian", eq)]
#[derive(PartialEq)]
pub struct PyLeap(pub Leap);

#[pymethods]
impl PyLeap {
    /// Number of points of the branch before it: int.
    #[getter]
    fn after(&self) -> usize {
        self.0.after
    }

    /// Why it was not followed on from there: `Stop`.
    #[getter]
    fn reason(&self) -> PyStop {
        PyStop(self.0.reason)
    }

    fn __str__(&self) -> String {
        self.0.to_string()
    }

    fn __repr__(&self) -> String {
        format!("<Leap: {}>", self.0)
    }
}

/// The name of a variant, and what it carries.
pub fn variant(of: &impl Serialize) -> PyResult<(String, Value)> {
    Ok(match value(of)? {
        Value::String(name) => (name, Value::Object(serde_json::Map::new())),
        Value::Object(map) => map.into_iter().next().unwrap_or_default(),
        _ => Default::default(),
    })
}

/// What serde makes of it.
pub fn value(of: &impl Serialize) -> PyResult<Value> {
    serde_json::to_value(of).map_err(|error| PyValueError::new_err(error.to_string()))
}

/// The same as an object of Python; of texts those that stand for numbers which JSON does not have are these numbers.
pub fn object<'py>(py: Python<'py>, value: &Value) -> PyResult<Bound<'py, PyAny>> {
    match value {
        Value::Null => Ok(py.None().into_bound(py)),
        Value::Bool(truth) => truth.into_bound_py_any(py),
        Value::Number(number) => match number.as_i64() {
            Some(whole) => whole.into_bound_py_any(py),
            None => number.as_f64().into_bound_py_any(py),
        },
        Value::String(text) => match text.as_str() {
            "inf" => f64::INFINITY.into_bound_py_any(py),
            "-inf" => f64::NEG_INFINITY.into_bound_py_any(py),
            "NaN" => f64::NAN.into_bound_py_any(py),
            text => text.into_bound_py_any(py),
        },
        Value::Array(list) => {
            let items = list.iter().map(|item| object(py, item));
            let items: PyResult<Vec<_>> = items.collect();
            PyList::new(py, items?)?.into_bound_py_any(py)
        }
        Value::Object(map) => {
            let dict = PyDict::new(py);
            for (name, item) in map {
                dict.set_item(name, object(py, item)?)?;
            }
            dict.into_bound_py_any(py)
        }
    }
}
