//! Branches and how they are connected.

use std::path::PathBuf;
use std::sync::Arc;

use hertzian::bifurcation::{Diagram, Omitted, Origin, Searched, SettledTo};
use hertzian::{Branch, Error};
use numpy::{PyArray1, PyArray2};
use pyo3::prelude::*;

use crate::arrays::matrix;
use crate::branch::PyBranch;
use crate::errors::exception;
use crate::event::{PyEvent, kind};
use crate::held::{BranchRef, DiagramRef, EventRef};
use crate::look::view;
use crate::model::PyModel;
use crate::solutions::PySolutionsAt;
use crate::stop::{object, variant};

/// Branches of periodic orbits and how they are connected. A notebook shows its chart.
#[pyclass(frozen, name = "Diagram", module = "hertzian")]
pub struct PyDiagram(pub DiagramRef);

impl PyDiagram {
    pub fn new(diagram: Diagram) -> Self {
        Self(DiagramRef::Own(Arc::new(diagram)))
    }

    fn branch(&self, number: usize) -> BranchRef {
        BranchRef::In(self.0.clone(), number)
    }
}

#[pymethods]
impl PyDiagram {
    /// The diagram of a file that `write` or the library has written, or the branches of one by ``hertzian response --json``, which does not
    /// say what connects them. With a model they can compute further orbits.
    #[staticmethod]
    #[pyo3(signature = (path, model=None))]
    fn read(py: Python<'_>, path: PathBuf, model: Option<&PyModel>) -> PyResult<Self> {
        let system = model.map(PyModel::system);
        let read = py.detach(|| -> Result<Diagram, Error> {
            let mut diagram = Diagram::read(path)?;
            if let Some(system) = &system {
                let mut all = diagram.branches.iter_mut();
                all.try_for_each(|found| found.branch.attach(system))?;
            }
            Ok(diagram)
        });
        read.map(Self::new).map_err(exception)
    }

    /// Writes it as JSON; `read` and the library read it back to the same bits.
    fn write(&self, py: Python<'_>, path: PathBuf) -> PyResult<()> {
        py.detach(|| self.0.write(path)).map_err(exception)
    }

    /// The branches, in the order in which they were found: list of `DiagramBranch`.
    #[getter]
    fn branches(&self) -> Vec<PyDiagramBranch> {
        let numbers = 0..self.0.branches.len();
        let branch = |number| PyDiagramBranch(self.0.clone(), number);
        numbers.map(branch).collect()
    }

    /// Bifurcations whose further branch was not followed, and why: list of `Omitted`.
    #[getter]
    fn omitted(&self) -> Vec<PyOmitted> {
        self.0.omitted.iter().cloned().map(PyOmitted).collect()
    }

    /// Attractors whose branch was not followed, and searches that failed: list of (value, why).
    #[getter]
    fn missed(&self) -> Vec<(f64, String)> {
        let missed = self.0.missed.iter();
        missed
            .map(|(value, why)| (*value, why.to_string()))
            .collect()
    }

    /// Where motions were followed until they settled, and what they settled to: list of `Searched`.
    #[getter]
    fn searched(&self) -> Vec<PySearched> {
        self.0.searched.iter().cloned().map(PySearched).collect()
    }

    /// Parts of the range in which no branch has an orbit, in increasing order: array of shape (parts, 2).
    #[getter]
    fn uncovered<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray2<f64>>> {
        matrix(py, self.0.uncovered.as_flattened().to_vec(), 2)
    }

    /// Time of the computation, in seconds: float.
    #[getter]
    fn elapsed(&self) -> f64 {
        self.0.elapsed.as_secs_f64()
    }

    /// All events of one kind, each with the number of its branch: list of (number, `Event`).
    #[pyo3(signature = (kind))]
    fn events(&self, kind: &str) -> PyResult<Vec<(usize, PyEvent)>> {
        let kind = self::kind(kind)?;
        let alike = |branch: &Branch, index: usize| {
            std::mem::discriminant(&branch.events[index].kind) == std::mem::discriminant(&kind)
        };
        let mut found = Vec::new();
        for number in 0..self.0.branches.len() {
            let branch = self.branch(number);
            let events = (0..branch.events.len()).filter(|&index| alike(&branch, index));
            found.extend(events.map(|index| {
                let branch = branch.clone();
                (number, PyEvent(EventRef { branch, index }))
            }));
        }
        Ok(found)
    }

    /// What its branches have at a value: `SolutionsAt`.
    fn solutions_at(&self, py: Python<'_>, value: f64) -> PyResult<PySolutionsAt> {
        let diagram = &self.0;
        let at = py.detach(|| diagram.solutions_at(value));
        Ok(PySolutionsAt::new(at.map_err(exception)?, diagram.clone()))
    }

    /// Draws what is asked of a signal over what is varied as an SVG file, one curve for each period; as `Branch.plot`.
    #[pyo3(signature = (path, of=None, frequency="omega"))]
    fn plot(
        &self,
        py: Python<'_>,
        path: PathBuf,
        of: Option<&str>,
        frequency: &str,
    ) -> PyResult<()> {
        let (diagram, view) = (&self.0, view(of, frequency)?);
        let written =
            py.detach(|| -> Result<(), Error> { Ok(diagram.chart_of(&view)?.write(path)?) });
        written.map_err(exception)
    }

    /// The same as text: str.
    #[pyo3(signature = (of=None, frequency="omega"))]
    fn to_svg(&self, of: Option<&str>, frequency: &str) -> PyResult<String> {
        let chart = self.0.chart_of(&view(of, frequency)?);
        Ok(chart.map_err(exception)?.to_svg())
    }

    fn _repr_svg_(&self) -> String {
        self.0.chart().to_svg()
    }

    fn __len__(&self) -> usize {
        self.0.branches.len()
    }

    fn __eq__(&self, other: &Bound<'_, PyAny>) -> bool {
        let other = other.cast::<Self>();
        other.is_ok_and(|other| *self.0 == *other.get().0)
    }

    fn __repr__(&self) -> String {
        let orbits: usize = self.0.branches.iter().map(|b| b.branch.points.len()).sum();
        format!(
            "<Diagram of {} branches, {orbits} orbits; {} not followed>",
            self.0.branches.len(),
            self.0.omitted.len() + self.0.missed.len()
        )
    }
}

/// One branch of a diagram.
#[pyclass(frozen, name = "DiagramBranch", module = "hertzian")]
pub struct PyDiagramBranch(DiagramRef, usize);

#[pymethods]
impl PyDiagramBranch {
    /// Where it comes from: `Origin`.
    #[getter]
    fn origin(&self) -> PyOrigin {
        PyOrigin(self.0.branches[self.1].origin)
    }

    /// Number of bifurcations between it and the first branch: int.
    #[getter]
    fn depth(&self) -> usize {
        self.0.branches[self.1].depth
    }

    /// Its orbits and events: `Branch`.
    #[getter]
    fn branch(&self) -> PyBranch {
        PyBranch::of(BranchRef::In(self.0.clone(), self.1))
    }

    /// Whether it is the mirror image of another branch: bool.
    #[getter]
    fn mirrored(&self) -> bool {
        self.0.branches[self.1].mirrored
    }

    /// Period of its orbits in periods of the declaration: int.
    #[getter]
    fn period(&self) -> usize {
        self.0.branches[self.1].period()
    }

    fn __repr__(&self) -> PyResult<String> {
        let branch = &self.0.branches[self.1];
        Ok(format!(
            "<DiagramBranch {}: period {}, {} orbits, {}>",
            self.1,
            branch.period(),
            branch.branch.points.len(),
            self.origin().__repr__()?
        ))
    }
}

/// Where a branch comes from.
#[pyclass(frozen, name = "Origin", module = "hertzian", eq)]
#[derive(PartialEq)]
pub struct PyOrigin(Origin);

#[pymethods]
impl PyOrigin {
    /// ``"first"``, ``"event"``, ``"other-end"``, ``"attractor"`` or ``"solved"``: str.
    #[getter]
    fn kind(&self) -> PyResult<String> {
        Ok(variant(&self.0)?.0)
    }

    /// Of an event ``branch``, ``event`` and ``side``, of an attractor or a solved orbit the ``value``: dict.
    #[getter]
    fn values<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        object(py, &variant(&self.0)?.1)
    }

    fn __repr__(&self) -> PyResult<String> {
        let kind = self.kind()?;
        Ok(match self.0 {
            Origin::Event { branch, event, .. } => {
                format!("<Origin: event {event} of branch {branch}>")
            }
            Origin::Attractor { value } | Origin::Solved { value } => {
                format!("<Origin: {kind} at {value}>")
            }
            _ => format!("<Origin: {kind}>"),
        })
    }
}

/// A bifurcation of which a further branch was not followed; ``str()`` of it is a sentence.
#[pyclass(frozen, name = "Omitted", module = "hertzian", eq)]
#[derive(PartialEq)]
pub struct PyOmitted(Omitted);

#[pymethods]
impl PyOmitted {
    /// Number of the branch in the diagram: int.
    #[getter]
    fn branch(&self) -> usize {
        self.0.branch
    }

    /// Number of the event on it: int.
    #[getter]
    fn event(&self) -> usize {
        self.0.event
    }

    /// Why: str.
    #[getter]
    fn reason(&self) -> String {
        self.0.reason.to_string()
    }

    fn __str__(&self) -> String {
        self.0.to_string()
    }

    fn __repr__(&self) -> String {
        format!("<Omitted: {}>", self.0)
    }
}

/// What was searched at one value, and what was found.
#[pyclass(frozen, name = "Searched", module = "hertzian", eq)]
#[derive(PartialEq)]
pub struct PySearched(Searched);

#[pymethods]
impl PySearched {
    /// The value of what is varied: float.
    #[getter]
    fn value(&self) -> f64 {
        self.0.value
    }

    /// The longest period that was looked for: int.
    #[getter]
    fn longest(&self) -> usize {
        self.0.longest
    }

    /// Periods for which motions were followed at most: int.
    #[getter]
    fn patience(&self) -> usize {
        self.0.patience
    }

    /// What became of the motion from each initial state: the number among `orbits`, or a `Fate`: array of int of shape (motions,).
    #[getter]
    fn fates<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<i16>> {
        PyArray1::from_iter(py, self.0.fates.iter().map(|fate| fate.label()))
    }

    /// The orbits that motions settled to: list of `SettledTo`.
    #[getter]
    fn orbits(&self) -> Vec<PySettledTo> {
        self.0.orbits.iter().copied().map(PySettledTo).collect()
    }

    fn __repr__(&self) -> String {
        format!(
            "<Searched at {}: {} motions settled to {} orbits>",
            self.0.value,
            self.0.fates.len(),
            self.0.orbits.len()
        )
    }
}

/// An orbit that motions settled to.
#[pyclass(frozen, name = "SettledTo", module = "hertzian", eq)]
#[derive(PartialEq)]
pub struct PySettledTo(SettledTo);

#[pymethods]
impl PySettledTo {
    /// Its shortest period, in periods of the declaration: int.
    #[getter]
    fn period(&self) -> usize {
        self.0.period
    }

    /// Number in the diagram of the branch that it lies on; None where that was not followed: int or None.
    #[getter]
    fn branch(&self) -> Option<usize> {
        self.0.branch
    }

    fn __repr__(&self) -> String {
        let branch = self.0.branch;
        let branch = branch.map_or("no branch".to_owned(), |number| format!("branch {number}"));
        format!("<SettledTo: period {}, {branch}>", self.0.period)
    }
}
