//! Options of a call, by their names.

use pyo3::conversion::FromPyObjectOwned;
use pyo3::exceptions::PyTypeError;
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyDictMethods};

/// What a call was given by names, each of which is taken once.
pub struct Given<'py> {
    function: &'static str,
    options: Bound<'py, PyDict>,
}

impl<'py> Given<'py> {
    pub fn new(
        py: Python<'py>,
        function: &'static str,
        options: Option<&Bound<'py, PyDict>>,
    ) -> PyResult<Self> {
        let options = options.map_or_else(|| Ok(PyDict::new(py)), PyDictMethods::copy)?;
        Ok(Self { function, options })
    }

    /// The value of a name; `None` of Python is none.
    pub fn any(&self, name: &str) -> PyResult<Option<Bound<'py, PyAny>>> {
        let Some(value) = self.options.get_item(name)? else {
            return Ok(None);
        };
        self.options.del_item(name)?;
        Ok((!value.is_none()).then_some(value))
    }

    /// The same as what is wanted.
    pub fn take<T: FromPyObjectOwned<'py>>(&self, name: &str) -> PyResult<Option<T>> {
        let Some(value) = self.any(name)? else {
            return Ok(None);
        };
        let taken = value.extract::<T>();
        taken
            .map(Some)
            .map_err(|error| self.refused(name, error.into()))
    }

    /// One that has no default.
    pub fn need<T: FromPyObjectOwned<'py>>(&self, name: &str) -> PyResult<T> {
        self.take(name)?.ok_or_else(|| {
            let function = self.function;
            PyTypeError::new_err(format!("{function}() needs the argument '{name}'"))
        })
    }

    /// Says which argument an error is about.
    fn refused(&self, name: &str, error: PyErr) -> PyErr {
        let function = self.function;
        let value = error.value(self.options.py());
        PyTypeError::new_err(format!("{function}() argument '{name}': {value}"))
    }

    /// A callback for progress.
    pub fn progress(&self) -> PyResult<Option<Py<PyAny>>> {
        let Some(progress) = self.any("progress")? else {
            return Ok(None);
        };
        if progress.is_callable() {
            return Ok(Some(progress.unbind()));
        }
        let function = self.function;
        Err(PyTypeError::new_err(format!(
            "{function}() argument 'progress' must be callable"
        )))
    }

    /// All names have been taken.
    pub fn end(self) -> PyResult<()> {
        let Some(name) = self.options.keys().iter().next() else {
            return Ok(());
        };
        let function = self.function;
        Err(PyTypeError::new_err(format!(
            "{function}() got an unexpected keyword argument '{name}'; help({function}) lists them"
        )))
    }
}
