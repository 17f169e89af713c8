//! A branch of orbits.

use std::path::PathBuf;
use std::sync::{Arc, Mutex, PoisonError};

use hertzian::chart::Line;
use hertzian::{Branch, Complex, Error, Point};
use numpy::{PyArray1, PyArray2};
use pyo3::IntoPyObjectExt;
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyList};

use crate::arrays::{matrix, ragged};
use crate::compute::{Watch, compute};
use crate::curve::PyBifurcationCurve;
use crate::errors::exception;
use crate::event::{self, PyEvent, PyTurn, PyWinding};
use crate::facts::Facts;
use crate::given::Given;
use crate::held::{BranchRef, EventRef, Owner, PointRef};
use crate::look::{Look, view};
use crate::model::PyModel;
use crate::point::{PyPoint, wanted};
use crate::reading::PyReading;
use crate::stop::{PyLeap, PyStop, object, value};

/// A branch of periodic orbits, in the order in which it was followed. A notebook shows its chart.
///
/// Besides its orbits and events it has arrays with a number for each orbit: `values`, `omega`, `verdicts`, `errors`, `parameters`,
/// `multipliers`, and ``measured("tip:rms")`` for whatever is read off.
#[pyclass(frozen, name = "Branch", module = "hertzian")]
pub struct PyBranch(Mutex<BranchRef>);

impl PyBranch {
    pub fn new(branch: Branch) -> Self {
        Self::of(BranchRef::Own(Arc::new(branch)))
    }

    pub fn of(branch: BranchRef) -> Self {
        Self(Mutex::new(branch))
    }

    /// The branch as it is now: it may be given a model meanwhile.
    pub fn held(&self) -> BranchRef {
        let held = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        held.clone()
    }

    fn events_of<'py>(
        py: Python<'py>,
        branch: &BranchRef,
        wanted: impl Fn(&hertzian::Event) -> bool,
    ) -> PyResult<Bound<'py, PyList>> {
        let wanted = branch
            .events
            .iter()
            .enumerate()
            .filter(|(_, event)| wanted(event));
        let events: PyResult<Vec<_>> = wanted
            .map(|(index, _)| {
                let branch = branch.clone();
                Py::new(py, PyEvent(EventRef { branch, index }))
            })
            .collect();
        PyList::new(py, events?)
    }

    /// The number of each orbit.
    fn each<'py, T: numpy::Element>(
        &self,
        py: Python<'py>,
        number: impl Fn(&Point) -> T,
    ) -> Bound<'py, PyArray1<T>> {
        PyArray1::from_iter(py, self.held().points.iter().map(number))
    }
}

/// Points of the branch that are given one by one, with the branch that they belong to.
fn points<'py>(
    py: Python<'py>,
    branch: &BranchRef,
    points: Vec<Point>,
) -> PyResult<Bound<'py, PyList>> {
    let owner = || Owner::Branch(branch.clone());
    let points = points.into_iter();
    let points = points.map(|point| Py::new(py, PyPoint(PointRef::own(point, owner()))));
    PyList::new(py, points.collect::<PyResult<Vec<_>>>()?)
}

#[pymethods]
impl PyBranch {
    /// The first branch of a file that `write`, the library or ``hertzian response --json`` has written, or in which one was kept. With a
    /// model it can compute further orbits, as by `attach`.
    #[staticmethod]
    #[pyo3(signature = (path, model=None))]
    fn read(py: Python<'_>, path: PathBuf, model: Option<&PyModel>) -> PyResult<Self> {
        let branch = py.detach(|| Branch::read(path)).map_err(exception)?;
        Self::new(branch).with(model)
    }

    /// All branches of such a file, in their order there: list of `Branch`.
    #[staticmethod]
    #[pyo3(signature = (path, model=None))]
    fn read_all(py: Python<'_>, path: PathBuf, model: Option<&PyModel>) -> PyResult<Vec<Self>> {
        let branches = py.detach(|| Branch::read_all(path)).map_err(exception)?;
        let branches = branches.into_iter();
        branches
            .map(|branch| Self::new(branch).with(model))
            .collect()
    }

    /// Writes it as JSON, which `read` and the library read back to the same bits.
    fn write(&self, py: Python<'_>, path: PathBuf) -> PyResult<()> {
        let branch = self.held();
        py.detach(|| branch.write(path)).map_err(exception)
    }

    /// Writes the orbits as a table, one row for each.
    fn write_csv(&self, py: Python<'_>, path: PathBuf) -> PyResult<()> {
        let branch = self.held();
        py.detach(|| branch.write_csv(path)).map_err(exception)
    }

    /// The orbits as a table with names of the columns, one row for each: str.
    fn to_csv(&self) -> String {
        self.held().to_csv()
    }

    /// Gives a branch that was read from a file its model back, so that it can compute further orbits.
    fn attach(&self, model: &PyModel) -> PyResult<()> {
        let system = model.system();
        let mut held = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        let mut branch = Branch::clone(&held);
        branch.attach(&system).map_err(exception)?;
        *held = BranchRef::Own(Arc::new(branch));
        Ok(())
    }

    /// What it says of its model: `ModelFacts`.
    #[getter]
    fn model(&self, py: Python<'_>) -> PyResult<Facts> {
        Facts::of(py, self.held().model.clone())
    }

    /// Name of what it varies: str.
    #[getter]
    fn varied(&self) -> String {
        self.held().varied.clone()
    }

    /// The orbits: list of `Point`.
    #[getter]
    fn points<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyList>> {
        let branch = self.held();
        let points = 0..branch.points.len();
        let points = points.map(|index| Py::new(py, PyPoint(PointRef::Of(branch.clone(), index))));
        PyList::new(py, points.collect::<PyResult<Vec<_>>>()?)
    }

    /// Special orbits: list of `Event`.
    #[getter]
    fn events<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyList>> {
        Self::events_of(py, &self.held(), |_| true)
    }

    /// The folds: list of `Event`.
    #[getter]
    fn folds<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyList>> {
        Self::events_of(py, &self.held(), |event| {
            event.kind == hertzian::EventKind::Fold
        })
    }

    /// Turns that are not folds, and other events that could not be located: list of `Turn`.
    #[getter]
    fn turns(&self) -> Vec<PyTurn> {
        self.held().turns.iter().copied().map(PyTurn).collect()
    }

    /// Where parts of it are missing, as those of free oscillation in resonance with another mode: list of `Leap`.
    #[getter]
    fn leaps(&self) -> Vec<PyLeap> {
        self.held().leaps.iter().copied().map(PyLeap).collect()
    }

    /// Where it winds, if it does: a narrow part of its range with dozens of folds: `Winding` or None.
    #[getter]
    fn winding(&self) -> Option<PyWinding> {
        self.held().winding().map(PyWinding)
    }

    /// Why it ended at its beginning, where it was followed both ways: `Stop` or None.
    #[getter]
    fn begin(&self) -> Option<PyStop> {
        self.held().begin.map(PyStop)
    }

    /// Why it ended: `Stop`.
    #[getter]
    fn stopped(&self) -> PyStop {
        PyStop(self.held().stopped)
    }

    /// What followed it: "harmonic balance", "shooting" or "contact equation"; None of a branch from a file that does not say so.
    #[getter]
    fn method(&self) -> Option<String> {
        self.held().method().map(|method| method.to_string())
    }

    /// Counts of what the continuation cost: dict of int.
    #[getter]
    fn statistics<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        object(py, &value(&self.held().statistics)?)
    }

    /// Counts of what motions in time cost, by shooting: dict of int.
    #[getter]
    fn work<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        object(py, &value(&self.held().work)?)
    }

    /// Time of the computation, in seconds: float.
    #[getter]
    fn elapsed(&self) -> f64 {
        self.held().elapsed.as_secs_f64()
    }

    /// Period of its orbits in periods of the declaration; zero without orbits: int.
    #[getter]
    fn period(&self) -> usize {
        self.held().period()
    }

    /// What charts show unless they are asked for something else, as ``"x:p2p"``: str.
    #[getter]
    fn leading(&self) -> String {
        self.held().leading().to_string()
    }

    /// Value of what it varies, at each orbit: array of shape (orbits,).
    #[getter]
    fn values<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        self.each(py, |point| point.value)
    }

    /// Excitation frequency of each orbit, in radians per unit of time: array of shape (orbits,).
    #[getter]
    fn omega<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        self.each(py, Point::omega)
    }

    /// ``"stable"``, ``"unstable"`` or ``"undecided"`` for each orbit: array of str of shape (orbits,).
    #[getter]
    fn verdicts<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        let branch = self.held();
        let verdicts = branch.points.iter();
        let verdicts: Vec<String> = verdicts.map(|p| p.stability.verdict.to_string()).collect();
        let kind = PyDict::new(py);
        kind.set_item("dtype", "U9")?;
        py.import("numpy")?
            .call_method("array", (verdicts,), Some(&kind))
    }

    /// Name of the output or coordinate that `errors` are of, or None where they are of all coordinates: str or None.
    #[getter]
    fn accuracy_of(&self) -> Option<String> {
        self.held().accuracy_of().map(str::to_owned)
    }

    /// Estimated error of peak-to-peak of each orbit, relative; not a number where it was not asked for: array of shape (orbits,).
    #[getter]
    fn errors<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        self.each(py, |point| point.error.unwrap_or(f64::NAN))
    }

    /// Parameters of each orbit, in the order of ``model.parameters``: array of shape (orbits, parameters).
    #[getter]
    fn parameters<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray2<f64>>> {
        let branch = self.held();
        let columns = branch.model.parameters.len();
        let numbers = branch.points.iter().flat_map(|point| &point.parameters);
        matrix(py, numbers.copied().collect(), columns)
    }

    /// Floquet multipliers of each orbit over its period, largest modulus first: complex array of shape (orbits, multipliers).
    #[getter]
    fn multipliers<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray2<Complex<f64>>>> {
        let branch = self.held();
        let rows = branch.points.iter();
        let rows: Vec<&[Complex<f64>]> = rows.map(|p| p.stability.multipliers.as_slice()).collect();
        ragged(py, &rows)
    }

    /// What is asked of a signal by its name, as ``"tip:rms"``, at every orbit: array of shape (orbits,), not a number where it is not known.
    /// At one ``point``: float or None. By default what charts show, `leading`. Measures are those of `Point.measured`.
    #[pyo3(signature = (wanted=None, point=None))]
    fn measured<'py>(
        &self,
        py: Python<'py>,
        wanted: Option<&str>,
        point: Option<&PyPoint>,
    ) -> PyResult<Bound<'py, PyAny>> {
        let branch = self.held();
        let wanted = match wanted {
            Some(text) => self::wanted(text)?,
            None => branch.leading(),
        };
        let measure = |point: &Point| branch.measured(&wanted, point);
        if let Some(point) = point {
            let measured = py.detach(|| measure(&point.0)).map_err(exception)?;
            return measured.into_bound_py_any(py);
        }
        let numbers = py.detach(|| {
            let numbers = branch.points.iter().map(measure);
            let numbers = numbers.map(|found| found.map(|number| number.unwrap_or(f64::NAN)));
            numbers.collect::<Result<Vec<f64>, _>>()
        });
        Ok(PyArray1::from_vec(py, numbers.map_err(exception)?).into_any())
    }

    /// An output, a coordinate or the force of a contact over the period of an orbit, by its name: `Reading`.
    fn reading(&self, py: Python<'_>, name: &str, point: &PyPoint) -> PyResult<PyReading> {
        let branch = self.held();
        let reading = py.detach(|| branch.reading(name, &point.0));
        reading.map(PyReading).map_err(exception)
    }

    /// Every orbit of the branch at a value of what it varies, in branch order; none where it does not pass: list of `Point`.
    fn at<'py>(&self, py: Python<'py>, value: f64) -> PyResult<Bound<'py, PyList>> {
        let branch = self.held();
        let found = py.detach(|| branch.at(value)).map_err(exception)?;
        points(py, &branch, found)
    }

    /// An orbit of this branch with its Fourier series and everything that is read off: `Point`. By the balance it has that already.
    fn complete(&self, py: Python<'_>, point: &PyPoint) -> PyResult<PyPoint> {
        let branch = self.held();
        let found = py.detach(|| branch.complete(&point.0));
        let found = found.map_err(exception)?;
        Ok(PyPoint(PointRef::own(found, Owner::Branch(branch))))
    }

    /// The same branch with every orbit completed, as `complete` does with one: `Branch`. An orbit whose motion cannot be computed stays as
    /// it is, and so do those that are left when ``progress`` stops it; where none can be, the first reason is raised.
    #[pyo3(signature = (*, progress=None))]
    fn complete_all<'py>(
        &self,
        py: Python<'py>,
        progress: Option<Py<PyAny>>,
    ) -> PyResult<Bound<'py, PyAny>> {
        let branch = self.held();
        compute(
            py,
            watch(&branch, progress),
            |_, see| {
                let mut all = Branch::clone(&branch);
                let found = all.complete_all_with(see);
                let lacks = |point: &Point| point.orbit.harmonics() == 0;
                if all.points.iter().all(lacks) {
                    found?;
                }
                Ok(all)
            },
            Self::new,
        )
    }

    /// The branch that begins at one of its events, by the same method in the same range: `Branch`. ``side`` is ``"one"`` or ``"other"``.
    #[pyo3(signature = (event, side="one", *, progress=None))]
    fn switch<'py>(
        &self,
        py: Python<'py>,
        event: &PyEvent,
        side: &str,
        progress: Option<Py<PyAny>>,
    ) -> PyResult<Bound<'py, PyAny>> {
        let (branch, side) = (self.held(), event::side(side)?);
        compute(
            py,
            watch(&branch, progress),
            |_, see| branch.switch_with(&event.0, side, see),
            Self::new,
        )
    }

    /// The curve of bifurcations through one of its events as a second parameter, or ``"omega"``, varies between two values:
    /// `BifurcationCurve`.
    #[pyo3(signature = (event, second, range, *, progress=None))]
    fn track<'py>(
        &self,
        py: Python<'py>,
        event: &PyEvent,
        second: &str,
        range: [f64; 2],
        progress: Option<Py<PyAny>>,
    ) -> PyResult<Bound<'py, PyAny>> {
        let branch = self.held();
        compute(
            py,
            watch(&branch, progress),
            |_, see| branch.track_with(&event.0, second, range, see),
            PyBifurcationCurve,
        )
    }

    /// Goes on with this branch, by what it was asked for: `Branch`. One that was interrupted, or met its limit of points, gives what an
    /// uninterrupted run gives, to the last bit.
    ///
    /// ``to``: a value beyond the range that was asked for. ``max_points``: of the whole branch. ``tolerance``, ``largest_step``,
    /// ``bifurcations``: follow it once more from its first orbit with these. ``keep``, ``progress``: as of `Model.response`.
    #[pyo3(
        signature = (**options),
        text_signature = "($self, *, to=None, max_points=None, tolerance=None, largest_step=None, bifurcations=None, keep=None, progress=None)"
    )]
    fn resume<'py>(
        &self,
        py: Python<'py>,
        options: Option<&Bound<'py, PyDict>>,
    ) -> PyResult<Bound<'py, PyAny>> {
        let given = Given::new(py, "resume", options)?;
        let branch = self.held();
        let watch = watch(&branch, given.progress()?);
        let mut resume = branch.resume();
        if let Some(to) = given.take("to")? {
            resume = resume.to(to);
        }
        if let Some(points) = given.take("max_points")? {
            resume = resume.max_points(points);
        }
        if let Some(tolerance) = given.take("tolerance")? {
            resume = resume.tolerance(tolerance);
        }
        if let Some(step) = given.take("largest_step")? {
            resume = resume.largest_step(step);
        }
        if let Some(wanted) = given.take("bifurcations")? {
            resume = resume.bifurcations(wanted);
        }
        if let Some(path) = given.take::<PathBuf>("keep")? {
            resume = resume.keep(path);
        }
        given.end()?;
        compute(
            py,
            watch,
            |cancel, see| resume.cancel(cancel).run_with(see),
            Self::new,
        )
    }

    /// The branch as runs of one stability each, of what is asked of a signal over what is varied, for drawing: list of `Run`. Neighbours
    /// share the point where they meet. Between orbits there are interpolated places where the line bends.
    #[pyo3(signature = (wanted=None))]
    fn runs(&self, py: Python<'_>, wanted: Option<&str>) -> PyResult<Vec<PyRun>> {
        let branch = self.held();
        let wanted = wanted.map_or_else(|| branch.leading().to_string(), str::to_owned);
        let curve = py.detach(|| branch.curve(&wanted)).map_err(exception)?;
        let runs = curve.runs.into_iter().map(|run| {
            let numbers: Vec<f64> = run.points.into_iter().flatten().collect();
            Ok(PyRun {
                verdict: match run.line {
                    Line::Stable => "stable",
                    Line::Unstable => "unstable",
                    _ => "undecided",
                },
                points: matrix(py, numbers, 2)?.unbind(),
            })
        });
        runs.collect()
    }

    /// Draws what is asked of a signal, as ``"tip:rms"``, as an SVG file; by default `leading`. ``frequency`` is what is at its axis:
    /// ``"omega"``, ``"hertz"`` or ``"rpm"``. ``scale``: ``"linear"``, ``"log"`` or ``"db"``. ``stack``: the amplitudes of so many harmonics
    /// upon each other instead. ``events``: the kinds that are marked, all by default.
    #[pyo3(signature = (path, of=None, frequency="omega", *, scale="linear", stack=0, events=None))]
    #[expect(clippy::too_many_arguments, reason = "they have names in Python")]
    fn plot(
        &self,
        py: Python<'_>,
        path: PathBuf,
        of: Option<&str>,
        frequency: &str,
        scale: &str,
        stack: usize,
        events: Option<Vec<String>>,
    ) -> PyResult<()> {
        let view = Look::new(scale, stack, events)?.on(view(of, frequency)?);
        let branch = self.held();
        let written =
            py.detach(|| -> Result<(), Error> { Ok(branch.chart_of(&view)?.write(path)?) });
        written.map_err(exception)
    }

    /// The same as text: str.
    #[pyo3(signature = (of=None, frequency="omega", *, scale="linear", stack=0, events=None))]
    fn to_svg(
        &self,
        of: Option<&str>,
        frequency: &str,
        scale: &str,
        stack: usize,
        events: Option<Vec<String>>,
    ) -> PyResult<String> {
        let view = Look::new(scale, stack, events)?.on(view(of, frequency)?);
        let chart = self.held().chart_of(&view);
        Ok(chart.map_err(exception)?.to_svg())
    }

    fn _repr_svg_(&self) -> String {
        self.held().chart().to_svg()
    }

    fn __len__(&self) -> usize {
        self.held().points.len()
    }

    fn __eq__(&self, other: &Bound<'_, PyAny>) -> bool {
        other
            .cast::<Self>()
            .is_ok_and(|other| *self.held() == *other.get().held())
    }

    fn __repr__(&self) -> String {
        let branch = self.held();
        let (name, varied) = (&branch.model.name, &branch.varied);
        let ends = branch.points.first().zip(branch.points.last());
        let range = ends.map_or(String::new(), |(first, last)| {
            format!(", {varied} from {} to {}", first.value, last.value)
        });
        format!(
            "<Branch of {name}: {} orbits{range}, {} events; {}>",
            branch.points.len(),
            branch.events.len(),
            branch.stopped
        )
    }
}

impl PyBranch {
    /// The same with a model, if there is one.
    fn with(self, model: Option<&PyModel>) -> PyResult<Self> {
        if let Some(model) = model {
            self.attach(model)?;
        }
        Ok(self)
    }
}

/// Who is told of progress on a branch.
fn watch(branch: &BranchRef, progress: Option<Py<PyAny>>) -> Watch {
    Watch::new(progress, Owner::Branch(branch.clone()))
}

/// A part of a branch with one stability.
#[pyclass(frozen, get_all, name = "Run", module = "hertzian")]
pub struct PyRun {
    /// ``"stable"``, ``"unstable"`` or ``"undecided"``: str.
    verdict: &'static str,
    /// What is varied, and what was asked for: array of shape (points, 2).
    points: Py<PyArray2<f64>>,
}

#[pymethods]
impl PyRun {
    fn __repr__(&self) -> String {
        format!("<Run: {}>", self.verdict)
    }
}
