//! Which solutions exist at each value.

use std::sync::Arc;

use hertzian::Verdict;
use hertzian::bifurcation::{Solutions, SolutionsAt};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;

use crate::diagram::PyDiagram;
use crate::held::{BranchRef, DiagramRef, Owner, PointRef};
use crate::point::PyPoint;

/// The periodic solutions at several values, and what was searched; ``print`` shows a line for each value.
#[pyclass(frozen, name = "Solutions", module = "hertzian")]
pub struct PySolutions(Arc<Solutions>);

impl PySolutions {
    pub fn new(solutions: Solutions) -> Self {
        Self(Arc::new(solutions))
    }

    fn held(&self) -> DiagramRef {
        DiagramRef::OfSolutions(Arc::clone(&self.0))
    }
}

#[pymethods]
impl PySolutions {
    /// Name of what is varied: str.
    #[getter]
    fn varied(&self) -> &str {
        &self.0.varied
    }

    /// The values, as they were asked for, with what exists there: list of `SolutionsAt`.
    #[getter]
    fn at(&self) -> Vec<PySolutionsAt> {
        let at = self.0.at.iter().cloned();
        at.map(|at| PySolutionsAt::new(at, self.held())).collect()
    }

    /// The branches that they lie on, and what was searched: `Diagram`.
    #[getter]
    fn diagram(&self) -> PyDiagram {
        PyDiagram(self.held())
    }

    fn __str__(&self) -> String {
        self.0.to_string()
    }

    fn __repr__(&self) -> String {
        self.0.to_string()
    }
}

/// The periodic solutions at one value.
#[pyclass(frozen, name = "SolutionsAt", module = "hertzian")]
pub struct PySolutionsAt {
    at: SolutionsAt,
    diagram: DiagramRef,
}

impl PySolutionsAt {
    pub fn new(at: SolutionsAt, diagram: DiagramRef) -> Self {
        Self { at, diagram }
    }
}

#[pymethods]
impl PySolutionsAt {
    /// The value: float.
    #[getter]
    fn value(&self) -> f64 {
        self.at.value
    }

    /// The periodic orbits, branch by branch: list of `Solution`.
    #[getter]
    fn orbits(&self) -> Vec<PySolution> {
        let orbits = self.at.orbits.iter();
        let orbits = orbits.map(|solution| {
            let owner = Owner::Branch(BranchRef::In(self.diagram.clone(), solution.branch));
            PySolution {
                branch: solution.branch,
                point: PointRef::own(solution.point.clone(), owner),
            }
        });
        orbits.collect()
    }

    /// Motions that settled to no orbit of any period looked for: chaos, long periods, several frequencies: int.
    #[getter]
    fn restless(&self) -> usize {
        self.at.restless
    }

    /// How many orbits have a verdict, ``"stable"``, ``"unstable"`` or ``"undecided"``: int.
    fn count(&self, verdict: &str) -> PyResult<usize> {
        let verdicts = [Verdict::Stable, Verdict::Unstable, Verdict::Undecided];
        let found = verdicts.into_iter().find(|v| v.to_string() == verdict);
        let found = found.ok_or_else(|| {
            PyValueError::new_err(format!(
                "{verdict} is no verdict: stable, unstable or undecided"
            ))
        })?;
        Ok(self.at.count(found))
    }

    /// The largest peak-to-peak of the first coordinate among the stable ones: float or None.
    #[getter]
    fn largest(&self) -> Option<f64> {
        self.at.largest()
    }

    fn __repr__(&self) -> String {
        format!(
            "<SolutionsAt {}: {} orbits, {} stable>",
            self.at.value,
            self.at.orbits.len(),
            self.at.count(Verdict::Stable)
        )
    }
}

/// A periodic orbit, and where it was found.
#[pyclass(frozen, name = "Solution", module = "hertzian")]
pub struct PySolution {
    /// Number of its branch in the diagram: int.
    #[pyo3(get)]
    branch: usize,
    point: PointRef,
}

#[pymethods]
impl PySolution {
    /// The orbit: `Point`.
    #[getter]
    fn point(&self) -> PyPoint {
        PyPoint(self.point.clone())
    }

    fn __repr__(&self) -> String {
        format!(
            "<Solution on branch {}: peak-to-peak {:.6}, {}>",
            self.branch,
            self.point.peak_to_peak(),
            self.point.stability.verdict
        )
    }
}
