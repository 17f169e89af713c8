//! What is known of a model without computing.

use hertzian::Model;
use pyo3::prelude::*;

/// What a model consists of, by names.
#[pyclass(frozen, get_all, name = "ModelFacts", module = "hertzian")]
pub struct Facts {
    /// Name of the declaration: str.
    name: String,
    /// The equations of motion, as written, and the constants and laws that are in them, one in each line: str.
    equation: String,
    /// Names of the coordinates: list of str.
    coordinates: Vec<String>,
    /// Units of the coordinates, empty for plain numbers; no entry at all where the model has no units: list of str.
    units: Vec<String>,
    /// The parameters, in the order of `Point.parameters`: list of `Named`.
    parameters: Vec<Py<Named>>,
    /// The outputs: list of `Named`.
    outputs: Vec<Py<Named>>,
    /// Names of the contacts: those of their laws, with a number from one on where a law acts in several: list of str.
    contacts: Vec<String>,
    /// Units of their forces, empty for plain numbers; no entry at all where the model has no units: list of str.
    force_units: Vec<String>,
    /// Number of pieces of the law of each contact: list of int.
    pieces: Vec<usize>,
}

/// A parameter or an output of a model.
#[pyclass(frozen, get_all, module = "hertzian")]
pub struct Named {
    /// Its name: str.
    name: String,
    /// What the declaration says of it: str.
    documentation: String,
    /// Its unit, empty where there is none: str.
    unit: String,
}

impl Facts {
    pub fn of(py: Python<'_>, model: Model) -> PyResult<Self> {
        let parameters = model.parameters.into_iter().map(|parameter| {
            let (documentation, unit) = (parameter.documentation, parameter.unit);
            Named::new(py, parameter.name, documentation, unit)
        });
        let outputs = model.outputs.into_iter();
        let outputs =
            outputs.map(|output| Named::new(py, output.name, output.documentation, output.unit));
        Ok(Self {
            name: model.name,
            equation: model.equation,
            coordinates: model.coordinates,
            units: model.units,
            parameters: parameters.collect::<PyResult<_>>()?,
            outputs: outputs.collect::<PyResult<_>>()?,
            contacts: model.contacts,
            force_units: model.force_units,
            pieces: model.pieces,
        })
    }
}

impl Named {
    fn new(
        py: Python<'_>,
        name: String,
        documentation: String,
        unit: String,
    ) -> PyResult<Py<Self>> {
        let named = Self {
            name,
            documentation,
            unit,
        };
        Py::new(py, named)
    }
}

#[pymethods]
impl Facts {
    fn __repr__(&self) -> String {
        format!("<ModelFacts {}>", self.name)
    }
}

#[pymethods]
impl Named {
    fn __repr__(&self) -> String {
        let Self {
            name,
            documentation,
            unit,
        } = self;
        let unit = if unit.is_empty() {
            String::new()
        } else {
            format!(" [{unit}]")
        };
        format!("<{name}{unit}: {documentation}>")
    }
}
