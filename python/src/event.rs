//! What happens along a branch.

use hertzian::{EventKind, Side, Turn, Winding};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;

use crate::held::{EventRef, PointRef};
use crate::point::PyPoint;

/// A special orbit of a branch, located until its test function vanished; ``str()`` of it is a sentence.
#[pyclass(frozen, name = "Event", module = "hertzian")]
pub struct PyEvent(pub EventRef);

#[pymethods]
impl PyEvent {
    /// What happens there: ``"fold"``, ``"symmetry-breaking"``, ``"period-doubling"``, ``"branch-point"``, ``"neimark-sacker"`` or
    /// ``"grazing"``: str.
    #[getter]
    fn kind(&self) -> String {
        self.0.kind.to_string()
    }

    /// Whether the branch turns back in what it varies there: bool.
    #[getter]
    fn turns(&self) -> bool {
        self.0.kind.turns()
    }

    /// The orbit: `Point`.
    #[getter]
    fn point(&self) -> PyPoint {
        PyPoint(PointRef::AtEvent(self.0.branch.clone(), self.0.index))
    }

    /// Value of what the branch varies there, as ``point.value``: float.
    #[getter]
    fn value(&self) -> f64 {
        self.0.point.value
    }

    /// Estimated error of the value; infinite where it could not be estimated: float.
    #[getter]
    fn error(&self) -> f64 {
        self.0.error
    }

    /// Value of the test function that was reached: float.
    #[getter]
    fn test(&self) -> f64 {
        self.0.test
    }

    /// Number of points of the branch before it: int.
    #[getter]
    fn after(&self) -> usize {
        self.0.after
    }

    /// Where an orbit grazes, the number of contacts that touch a level there: int.
    #[getter]
    fn contacts(&self) -> usize {
        self.0.contacts
    }

    fn __eq__(&self, other: &Bound<'_, PyAny>) -> bool {
        other
            .cast::<Self>()
            .is_ok_and(|other| *self.0 == *other.get().0)
    }

    fn __str__(&self) -> String {
        self.0.branch.describe(&self.0)
    }

    fn __repr__(&self) -> String {
        format!("<Event: {}>", self.__str__())
    }
}

/// A place where a test function changed its sign without an event that could be located.
#[pyclass(frozen, name = "Turn", module = "hertzian", eq)]
#[derive(PartialEq)]
pub struct PyTurn(pub Turn);

#[pymethods]
impl PyTurn {
    /// What would have happened there, as of events: str.
    #[getter]
    fn kind(&self) -> String {
        self.0.kind.to_string()
    }

    /// What the branch varies, there: float.
    #[getter]
    fn value(&self) -> f64 {
        self.0.value
    }

    /// Value of the test function beside it; not a number where it is unknown: float.
    #[getter]
    fn test(&self) -> f64 {
        self.0.test
    }

    /// Number of points of the branch before it: int.
    #[getter]
    fn after(&self) -> usize {
        self.0.after
    }

    fn __repr__(&self) -> String {
        format!("<Turn: {} not located at {}>", self.0.kind, self.0.value)
    }
}

/// A part of a branch in which it turns back again and again; ``str()`` of it says what to do about it.
#[pyclass(frozen, name = "Winding", module = "hertzian", eq)]
#[derive(PartialEq)]
pub struct PyWinding(pub Winding);

#[pymethods]
impl PyWinding {
    /// The folds in it, and other turns that were not located: int.
    #[getter]
    fn folds(&self) -> usize {
        self.0.folds
    }

    /// The smallest and the largest value of them: two floats.
    #[getter]
    fn within(&self) -> (f64, f64) {
        self.0.within.into()
    }

    fn __str__(&self) -> String {
        self.0.to_string()
    }

    fn __repr__(&self) -> String {
        format!("<Winding: {}>", self.0)
    }
}

/// A kind of events by its name.
pub fn kind(name: &str) -> PyResult<EventKind> {
    let kinds = [
        EventKind::Fold,
        EventKind::SymmetryBreaking,
        EventKind::PeriodDoubling,
        EventKind::BranchPoint,
        EventKind::NeimarkSacker,
        EventKind::Grazing { turns: false },
    ];
    let found = kinds.iter().find(|kind| kind.to_string() == name);
    found.copied().ok_or_else(|| {
        let names: Vec<String> = kinds.iter().map(ToString::to_string).collect();
        PyValueError::new_err(format!("{name} is no kind of events: {}", names.join(", ")))
    })
}

/// A side of an event by its name.
pub fn side(name: &str) -> PyResult<Side> {
    match name {
        "one" => Ok(Side::One),
        "other" => Ok(Side::Other),
        _ => Err(PyValueError::new_err(format!(
            "{name} is no side of an event: one or other"
        ))),
    }
}
