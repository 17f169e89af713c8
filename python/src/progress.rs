//! How far a computation is.

use hertzian::Progress;
use pyo3::prelude::*;

use crate::held::{Owner, PointRef};
use crate::point::PyPoint;

/// How far a computation is: what the callback ``progress`` is called with. Where that returns ``False`` the computation ends, and what
/// there is by then is returned.
#[pyclass(frozen, name = "Progress", module = "hertzian")]
pub struct PyProgress {
    /// What is computed: ``"first orbit"``, ``"branch"``, ``"curve"``, ``"sweep"``, ``"basin"`` or ``"settling"``: str.
    #[pyo3(get)]
    stage: String,
    /// How much of it is done, in what the stage counts: int.
    #[pyo3(get)]
    done: usize,
    /// How much there is of it, where that is known: int or None.
    #[pyo3(get)]
    total: Option<usize>,
    /// Value of what is varied: float or None.
    #[pyo3(get)]
    value: Option<f64>,
    point: Option<PointRef>,
}

impl PyProgress {
    pub fn of(progress: Progress<'_>, owner: &Owner) -> Self {
        Self {
            stage: progress.stage.to_string(),
            done: progress.done,
            total: progress.total,
            value: progress.value,
            point: progress
                .point
                .map(|p| PointRef::own(p.clone(), owner.clone())),
        }
    }
}

#[pymethods]
impl PyProgress {
    /// The orbit that was found last: `Point` or None.
    #[getter]
    fn point(&self) -> Option<PyPoint> {
        self.point.clone().map(PyPoint)
    }

    fn __repr__(&self) -> String {
        let of = self
            .total
            .map_or(String::new(), |total| format!(" of {total}"));
        format!("<Progress: {}, {}{of}>", self.stage, self.done)
    }
}
