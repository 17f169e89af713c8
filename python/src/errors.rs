//! Errors of the library as exceptions, which are declared in `hertzian/errors.py`.

use hertzian::error::{Error, ErrorKind, chain};
use hertzian::generic::DeclarationError;
use pyo3::prelude::*;
use pyo3::types::PyDict;

/// The exception of an error.
pub fn exception(error: impl Into<Error>) -> PyErr {
    let error = error.into();
    Python::attach(|py| built(py, &error).unwrap_or_else(|failed| failed))
}

fn built(py: Python<'_>, error: &Error) -> PyResult<PyErr> {
    let sentence = chain(error).to_string();
    let details = format!("{error:#?}");
    let module = py.import("hertzian.errors")?;
    let value = if let Some(faulty) = error.downcast_ref::<DeclarationError>() {
        let faults = faulty.faults.iter();
        let faults: Vec<_> = faults
            .map(|fault| (fault.line, fault.column, fault.message.as_str()))
            .collect();
        module
            .getattr("DeclarationError")?
            .call1((sentence, details, faults))?
    } else {
        module
            .getattr(class(error.kind()))?
            .call1((sentence, details))?
    };
    value.setattr("variant", error.variant())?;
    // Of several numbers of one name the first, as in `Error::value`.
    let values = PyDict::new(py);
    for (name, number) in error.values().into_iter().rev() {
        values.set_item(name, number)?;
    }
    value.setattr("values", values)?;
    Ok(PyErr::from_value(value))
}

/// That a request cannot be, for a reason which the library does not know.
pub fn refused(sentence: &str) -> PyErr {
    Python::attach(|py| {
        let class = py.import("hertzian.errors");
        let class = class.and_then(|module| module.getattr("RequestError"));
        let value = class.and_then(|class| class.call1((sentence,)));
        value.map_or_else(|failed| failed, PyErr::from_value)
    })
}

/// The class of what is to be changed for an answer.
fn class(kind: ErrorKind) -> &'static str {
    match kind {
        ErrorKind::Request => "RequestError",
        ErrorKind::Model => "ModelError",
        ErrorKind::NoOrbit => "NoOrbitError",
        ErrorKind::Limit => "LimitError",
        ErrorKind::Motion => "MotionError",
        ErrorKind::Cancelled => "CancelledError",
        ErrorKind::File => "FileError",
        ErrorKind::System => "ResourceError",
        _ => "HertzianError",
    }
}
