//! A model from text, and what is computed of it.

use std::path::PathBuf;
use std::sync::{Arc, Mutex, PoisonError};

use hertzian::generic::Declaration;
use hertzian::{Bifurcations, FrequencyResponse, Model, Shooting, System};
use pyo3::exceptions::PyTypeError;
use pyo3::prelude::*;
use pyo3::types::PyDict;

use crate::branch::PyBranch;
use crate::compute::{Watch, compute};
use crate::diagram::PyDiagram;
use crate::errors::exception;
use crate::facts::Facts;
use crate::given::Given;
use crate::held::{Owner, PointRef};
use crate::map::PyMap;
use crate::methods::PySettling;
use crate::point::PyPoint;
use crate::request::{Method, Request, by_any};
use crate::solutions::PySolutions;
use crate::{attractors, backbone, sweep};

/// A model declared by text, in the language of the macro ``oscillator!``, with values of its parameters by name.
///
/// >>> model = Model("Duffing(x) { param drive; ddot(x) + 0.1*dot(x) + x + x^3 = drive*cos(omega*t); }", drive=0.2)
/// >>> model.parameters
/// {'drive': 0.2}
///
/// Computations take the values that the parameters have when they are called. They run without the interpreter's lock; Ctrl-C ends them,
/// and what was computed by then is the ``result`` of the exception that is raised.
#[pyclass(frozen, name = "Model", module = "hertzian")]
pub struct PyModel {
    text: String,
    declaration: Mutex<Declaration>,
}

impl PyModel {
    /// The system at the values that its parameters have now.
    pub fn system(&self) -> Arc<dyn System> {
        self.declared(|declaration| declaration.shared())
    }

    fn declared<T>(&self, does: impl FnOnce(&mut Declaration) -> T) -> T {
        let mut declaration = self
            .declaration
            .lock()
            .unwrap_or_else(PoisonError::into_inner);
        does(&mut declaration)
    }

    fn of(text: String, values: Option<&Bound<'_, PyDict>>) -> PyResult<Self> {
        let declaration = Declaration::parse(&text).map_err(exception)?;
        let declaration = Mutex::new(declaration);
        let model = Self { text, declaration };
        model.set(values)?;
        Ok(model)
    }

    /// What was asked for of orbits, by the method that fits unless one is named, in a range if there is one: with all of its options.
    fn asked(
        &self,
        py: Python<'_>,
        function: &'static str,
        options: Option<&Bound<'_, PyDict>>,
        range: Option<[f64; 2]>,
    ) -> PyResult<Asked> {
        let given = Given::new(py, function, options)?;
        let asked = self.asked_of(&given, Method::Chosen, range)?;
        given.end()?;
        Ok(asked)
    }

    /// The same with the options that every method takes, and of others.
    fn asked_of(
        &self,
        given: &Given<'_>,
        default: Method,
        range: Option<[f64; 2]>,
    ) -> PyResult<Asked> {
        let system = self.system();
        let request = Request::of(&system, given, default)?;
        let owner = Owner::request(&system, &request);
        let request = match range {
            Some([from, to]) => request.between(from, to),
            None => request,
        };
        Ok(Asked {
            request,
            watch: Watch::new(given.progress()?, owner.clone()),
            owner,
        })
    }

    /// What was asked for of motions: its options, the system, and who is told of progress, where there are no orbits to show.
    fn asked_of_motions<'py>(
        &self,
        py: Python<'py>,
        function: &'static str,
        options: Option<&Bound<'py, PyDict>>,
    ) -> PyResult<(Given<'py>, Arc<dyn System>, Watch)> {
        let given = Given::new(py, function, options)?;
        let system = self.system();
        let request = Request::Chosen(FrequencyResponse::of(&system));
        let owner = Owner::request(&system, &request);
        let watch = Watch::new(given.progress()?, owner);
        Ok((given, system, watch))
    }
}

/// What was asked for of orbits, who is told of progress, and what orbits belong to that are on no branch.
struct Asked {
    request: Request,
    watch: Watch,
    owner: Owner,
}

#[pymethods]
impl PyModel {
    #[new]
    #[pyo3(signature = (text, /, **values))]
    fn new(text: String, values: Option<&Bound<'_, PyDict>>) -> PyResult<Self> {
        Self::of(text, values)
    }

    /// The model that a file declares, with values of its parameters by name.
    #[staticmethod]
    #[pyo3(signature = (path, /, **values))]
    fn read(path: PathBuf, values: Option<&Bound<'_, PyDict>>) -> PyResult<Self> {
        Self::of(std::fs::read_to_string(path)?, values)
    }

    /// Sets parameters by name: ``model.set(drive=0.2)``. What has been computed before stays as it is.
    #[pyo3(signature = (**values))]
    fn set(&self, values: Option<&Bound<'_, PyDict>>) -> PyResult<()> {
        let Some(values) = values else {
            return Ok(());
        };
        let mut numbers: Vec<(String, f64)> = Vec::new();
        for (name, value) in values {
            let name: String = name.extract()?;
            let value: f64 = value.extract().map_err(|_| {
                PyTypeError::new_err(format!("the value of parameter {name} must be a number"))
            })?;
            numbers.push((name, value));
        }
        // All of them, or none.
        self.declared(|declaration| {
            let mut changed = declaration.clone();
            for (name, value) in &numbers {
                changed.set(name, *value)?;
            }
            *declaration = changed;
            Ok::<(), hertzian::Error>(())
        })
        .map_err(exception)
    }

    /// The parameters by their names; not a number where one has no value: dict of float.
    #[getter]
    fn parameters<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let dict = PyDict::new(py);
        self.declared(|declaration| {
            let mut parameters = declaration.parameters().into_iter();
            parameters.try_for_each(|(name, value)| dict.set_item(name, value))
        })?;
        Ok(dict)
    }

    /// The declaration: str.
    #[getter]
    fn text(&self) -> &str {
        &self.text
    }

    /// What it consists of: `ModelFacts`.
    #[getter]
    fn facts(&self, py: Python<'_>) -> PyResult<Facts> {
        Facts::of(py, Model::of(&self.system()))
    }

    /// Follows the branch of periodic orbits from one end of a range to the other: `Branch`.
    ///
    /// ``from_``, ``to``: the range, of the excitation frequency in radians per unit of time, or of the parameter ``vary`` at the
    /// frequency ``omega``. ``period``: of the orbits, in periods of the declaration. ``tolerance``: relative accuracy of peak-to-peak.
    /// ``accuracy_of``: the output or coordinate that the tolerance and the errors of orbits are of, all coordinates by default.
    /// ``stability``: whether Floquet multipliers are computed. ``near_orbit``, ``near_state``: the first orbit is near this one, or near
    /// the motion from this state. ``by``: a method, `HarmonicBalance`, `Shooting` or `ContactEquation`, by default the contact
    /// equation where a law opens or has a corner (at a tolerance of 1e-8 or below: is another function beyond a level), shooting where a
    /// stiffness is unbounded on both sides of a level, and the balance elsewhere. ``harmonics``, ``doublings``, ``bifurcations``, ``symmetric``: options of
    /// the balance, which is the method where one of them is given. ``keep``: a file in which the branch is kept while it is followed.
    /// ``progress``: called with a `Progress` at every orbit; ends the computation by returning ``False``.
    ///
    /// A branch that ends early is not an error: `Branch.stopped` says why it ended. Raises an exception if no first orbit is found.
    #[pyo3(
        signature = (from_, to, **options),
        text_signature = "($self, from_, to, *, vary=None, omega=None, period=1, tolerance=1e-6, accuracy_of=None, stability=True, largest_step=0.1, max_points=20000, near_orbit=None, near_state=None, by=None, harmonics=None, doublings=False, bifurcations=False, symmetric=True, keep=None, progress=None)"
    )]
    fn response<'py>(
        &self,
        py: Python<'py>,
        from_: f64,
        to: f64,
        options: Option<&Bound<'py, PyDict>>,
    ) -> PyResult<Bound<'py, PyAny>> {
        let Asked { request, watch, .. } =
            self.asked(py, "response", options, Some([from_, to]))?;
        compute(
            py,
            watch,
            |cancel, see| by_any!(request, r => r.cancel(cancel).run_with(see)),
            PyBranch::new,
        )
    }

    /// The one orbit at a value of what is varied: `Point`. Options are those of `response`.
    #[pyo3(
        signature = (value, **options),
        text_signature = "($self, value, *, vary=None, omega=None, period=1, tolerance=1e-6, accuracy_of=None, stability=True, near_orbit=None, near_state=None, by=None, harmonics=None, symmetric=True)"
    )]
    fn orbit<'py>(
        &self,
        py: Python<'py>,
        value: f64,
        options: Option<&Bound<'py, PyDict>>,
    ) -> PyResult<Bound<'py, PyAny>> {
        let Asked {
            request,
            watch,
            owner,
        } = self.asked(py, "orbit", options, None)?;
        compute(
            py,
            watch,
            |cancel, _| by_any!(request, r => r.cancel(cancel).orbit(value)),
            |point| PyPoint(PointRef::own(point, owner)),
        )
    }

    /// The branch through the orbit at a value inside a range, both ways as far as it goes: `Branch`. Options are those of `response`.
    #[pyo3(
        signature = (value, from_, to, **options),
        text_signature = "($self, value, from_, to, *, vary=None, omega=None, period=1, tolerance=1e-6, accuracy_of=None, stability=True, largest_step=0.1, max_points=20000, near_orbit=None, near_state=None, by=None, harmonics=None, doublings=False, bifurcations=False, symmetric=True, progress=None)"
    )]
    fn through<'py>(
        &self,
        py: Python<'py>,
        value: f64,
        from_: f64,
        to: f64,
        options: Option<&Bound<'py, PyDict>>,
    ) -> PyResult<Bound<'py, PyAny>> {
        let Asked { request, watch, .. } = self.asked(py, "through", options, Some([from_, to]))?;
        compute(
            py,
            watch,
            |cancel, see| by_any!(request, r => r.cancel(cancel).through_with(value, see)),
            PyBranch::new,
        )
    }

    /// All that exists in a range, as far as it is found at little cost: `Diagram`. The branch of `response`; where that turns back or
    /// ends before the other end, the branch from there; and where there is no stable orbit yet, the branches of what motions settle to.
    /// `Diagram.searched` says what was searched, `Diagram.uncovered` where there is no orbit. Options are those of `response`.
    #[pyo3(
        signature = (from_, to, **options),
        text_signature = "($self, from_, to, *, vary=None, omega=None, period=1, tolerance=1e-6, accuracy_of=None, stability=True, largest_step=0.1, max_points=20000, near_orbit=None, near_state=None, by=None, harmonics=None, doublings=False, bifurcations=False, symmetric=True, keep=None, progress=None)"
    )]
    fn cover<'py>(
        &self,
        py: Python<'py>,
        from_: f64,
        to: f64,
        options: Option<&Bound<'py, PyDict>>,
    ) -> PyResult<Bound<'py, PyAny>> {
        let Asked { request, watch, .. } = self.asked(py, "cover", options, Some([from_, to]))?;
        compute(
            py,
            watch,
            |cancel, see| by_any!(request, r => r.cancel(cancel).cover_with(see)),
            PyDiagram::new,
        )
    }

    /// All periodic solutions at some values in a range, as far as they are found: `Solutions`; ``print`` shows a line for each value and
    /// what was searched. Options are those of `response`.
    #[pyo3(
        signature = (values, from_, to, **options),
        text_signature = "($self, values, from_, to, *, vary=None, omega=None, period=1, tolerance=1e-6, accuracy_of=None, stability=True, largest_step=0.1, max_points=20000, near_orbit=None, near_state=None, by=None, harmonics=None, doublings=False, bifurcations=False, symmetric=True)"
    )]
    fn solutions<'py>(
        &self,
        values: &Bound<'py, PyAny>,
        from_: f64,
        to: f64,
        options: Option<&Bound<'py, PyDict>>,
    ) -> PyResult<Bound<'py, PyAny>> {
        let py = values.py();
        let Asked { request, watch, .. } =
            self.asked(py, "solutions", options, Some([from_, to]))?;
        let values = crate::arrays::numbers(values)?;
        compute(
            py,
            watch,
            |cancel, _| by_any!(request, r => r.cancel(cancel).solutions(&values)),
            PySolutions::new,
        )
    }

    /// All periodic solutions over two parameters, as far as they are found: `Map`. ``values``: of what is varied, in the range; ``second``:
    /// the other parameter, or ``"omega"``, and ``others``: its values, each of which is a row. Options are those of `response`; by
    /// `Shooting` a map with many bifurcations takes a small part of the time.
    #[pyo3(
        signature = (values, from_, to, second, others, **options),
        text_signature = "($self, values, from_, to, second, others, *, vary=None, omega=None, period=1, tolerance=1e-6, accuracy_of=None, stability=True, largest_step=0.1, max_points=20000, near_orbit=None, near_state=None, by=None, harmonics=None, doublings=False, bifurcations=False, symmetric=True, progress=None)"
    )]
    fn map<'py>(
        &self,
        values: &Bound<'py, PyAny>,
        from_: f64,
        to: f64,
        second: &str,
        others: &Bound<'py, PyAny>,
        options: Option<&Bound<'py, PyDict>>,
    ) -> PyResult<Bound<'py, PyAny>> {
        let py = values.py();
        let Asked { request, watch, .. } = self.asked(py, "map", options, Some([from_, to]))?;
        let [values, others] = [values, others].map(crate::arrays::numbers);
        let (values, others) = (values?, others?);
        compute(
            py,
            watch,
            |cancel, see| by_any!(request, r => r.cancel(cancel).map_with(&values, second, &others, see)),
            PyMap,
        )
    }

    /// Follows a branch and all that are connected with it by bifurcations, to a depth: `Diagram`.
    ///
    /// ``from_``, ``to``, ``vary``, ``omega``, ``period``, ``tolerance``, ``largest_step``, ``by``: as of `response`; the method is
    /// `Shooting` unless another one is asked for. ``depth``: bifurcations that may lie between a branch and the first one.
    /// ``max_period``: the longest period of what is followed at doublings. ``max_branches``, ``max_points``: limits of all together.
    /// ``margin``: part of the range by which further branches may go beyond its ends. ``cover``: a `Settling`, by which the range is
    /// searched for what motions settle to; ``settled_at``: values at which motions are followed then too. ``progress``: as of `response`.
    #[pyo3(
        signature = (from_, to, **options),
        text_signature = "($self, from_, to, *, vary=None, omega=None, period=1, tolerance=1e-6, accuracy_of=None, largest_step=0.1, by=None, depth=3, max_period=None, max_branches=64, max_points=50000, margin=0.1, cover=None, settled_at=None, near_orbit=None, near_state=None, keep=None, progress=None)"
    )]
    fn bifurcations<'py>(
        &self,
        py: Python<'py>,
        from_: f64,
        to: f64,
        options: Option<&Bound<'py, PyDict>>,
    ) -> PyResult<Bound<'py, PyAny>> {
        let given = Given::new(py, "bifurcations", options)?;
        let points = given.take("max_points")?.unwrap_or(50_000);
        let default = Method::Shooting(Shooting::new());
        let Asked { request, watch, .. } = self.asked_of(&given, default, Some([from_, to]))?;
        let search = DiagramOptions::of(&given)?;
        given.end()?;
        compute(
            py,
            watch,
            |cancel, see| match request {
                Request::Chosen(request) => {
                    let request = Bifurcations::starting_with(request.cancel(cancel));
                    search.on(request, points).run_with(see)
                }
                Request::Balance(request) => {
                    let request = request.bifurcations(true).cancel(cancel);
                    search
                        .on(Bifurcations::starting_with(request), points)
                        .run_with(see)
                }
                Request::Shooting(request) => {
                    let request = Bifurcations::starting_with(request.cancel(cancel));
                    search.on(request, points).run_with(see)
                }
                Request::ContactEquation(request) => {
                    let request = Bifurcations::starting_with(request.cancel(cancel));
                    search.on(request, points).run_with(see)
                }
            },
            PyDiagram::new,
        )
    }

    /// What the motions from some states settle to: `Basins`, of which ``fates`` has a number for each state.
    ///
    /// ``starts``: states at the phase, all positions, then all velocities: array of shape (states, 2 coordinates). ``omega``: the
    /// excitation frequency, in radians per unit of time. ``phase``: of the excitation, in radians, at which motions start and are looked
    /// at. ``longest``: the longest period that is looked for. ``patience``: periods after which a motion is judged by its Lyapunov
    /// exponent. ``escape``: a state with an entry beyond this has escaped. ``tolerance``: of the flow, where it is not in closed form.
    /// ``threads``: so many, which do not change the result. ``progress``: as of `response`.
    #[pyo3(
        signature = (starts, **options),
        text_signature = "($self, starts, *, omega, phase=0.0, longest=64, patience=20000, escape=1e6, tolerance=1e-10, threads=1, progress=None)"
    )]
    fn settle<'py>(
        &self,
        starts: &Bound<'py, PyAny>,
        options: Option<&Bound<'py, PyDict>>,
    ) -> PyResult<Bound<'py, PyAny>> {
        let (given, system, watch) = self.asked_of_motions(starts.py(), "settle", options)?;
        attractors::settle(starts, &system, watch, given)
    }

    /// What the motions from a grid of states settle to: `Basins`, of which ``fates`` has a row for each cell of ``rows``.
    ///
    /// ``columns``, ``rows``: two `Axis`, along which entries of the state vary. ``start``: the state whose other entries they have, by
    /// default zeros. Other options are those of `settle`.
    #[pyo3(
        signature = (columns, rows, **options),
        text_signature = "($self, columns, rows, *, omega, start=None, phase=0.0, longest=64, patience=20000, escape=1e6, tolerance=1e-10, threads=1, progress=None)"
    )]
    fn basin<'py>(
        &self,
        py: Python<'py>,
        columns: PyRef<'py, attractors::PyAxis>,
        rows: PyRef<'py, attractors::PyAxis>,
        options: Option<&Bound<'py, PyDict>>,
    ) -> PyResult<Bound<'py, PyAny>> {
        let (given, system, watch) = self.asked_of_motions(py, "basin", options)?;
        attractors::basin(py, [&columns, &rows], &system, watch, given)
    }

    /// What a motion settles to as the frequency or a parameter changes in steps, each going on from the one before: `Swept`.
    ///
    /// ``values``: so many at equal distances, both ends included. ``back``: whether they follow again in reverse, which shows hysteresis.
    /// ``start``: the first state, by default at rest. ``transient``: periods that are dropped at every value. ``periods``: periods that
    /// are looked at then. ``vary``, ``omega``: as of `response`; ``escape``, ``tolerance``: as of `settle`.
    #[pyo3(
        signature = (from_, to, **options),
        text_signature = "($self, from_, to, *, vary=None, omega=None, values=101, back=False, start=None, transient=400, periods=100, escape=1e6, tolerance=1e-10, progress=None)"
    )]
    fn sweep<'py>(
        &self,
        py: Python<'py>,
        from_: f64,
        to: f64,
        options: Option<&Bound<'py, PyDict>>,
    ) -> PyResult<Bound<'py, PyAny>> {
        let (given, system, watch) = self.asked_of_motions(py, "sweep", options)?;
        sweep::sweep(py, [from_, to], &system, watch, given)
    }

    /// The frequency of free oscillation over its amplitude: `Branch` over the frequency, of orbits that begin at rest.
    ///
    /// ``from_``, ``to``: positions at rest of the coordinate that is varied, where the curve begins and ends. ``mode``: the mode that it
    /// begins with, counted from one in the order of `modes`; then ``from_`` is by default a fiftieth of the displacement at the end, and
    /// ``up_to``, a `Branch` of the same coordinates, may say in place of ``to`` how far it moves. ``along``: the coordinate that is varied,
    /// by default the first one, of a mode that which moves most. ``near_rest``: positions at rest and the frequency of an oscillation that
    /// the first one is near, as ``([1.0, 0.5], 1.2)``. ``conservative``: whether damping, loads that change with time and what forces do by
    /// rates are left out; else there must be none. ``tolerance``: of the flow, where it is not in closed form. ``progress``: as of `response`.
    ///
    /// `Branch.leaps` says where parts of the curve are missing. Nothing is known of stability.
    #[pyo3(
        signature = (from_=None, to=None, **options),
        text_signature = "($self, from_=None, to=None, *, mode=None, up_to=None, along=None, near_rest=None, conservative=False, tolerance=1e-12, largest_step=0.1, max_points=5000, progress=None)"
    )]
    fn free_oscillation<'py>(
        &self,
        py: Python<'py>,
        from_: Option<f64>,
        to: Option<f64>,
        options: Option<&Bound<'py, PyDict>>,
    ) -> PyResult<Bound<'py, PyAny>> {
        let (given, system, watch) = self.asked_of_motions(py, "free_oscillation", options)?;
        backbone::free_oscillation(py, [from_, to], &system, watch, given)
    }

    /// Angular frequencies of small free oscillations about the state at rest, the lowest first; zero of what nothing holds: array of shape
    /// (coordinates,). ``conservative``: as of `free_oscillation`.
    #[pyo3(signature = (*, conservative=false))]
    fn modes<'py>(&self, py: Python<'py>, conservative: bool) -> PyResult<Bound<'py, PyAny>> {
        let (_, system, watch) = self.asked_of_motions(py, "modes", None)?;
        backbone::modes(py, &system, watch, conservative)
    }

    /// Energies of the orbits of a curve of `free_oscillation` above that of the state at rest: array of shape (points,).
    /// ``conservative``: as there.
    #[pyo3(signature = (curve, *, conservative=false))]
    fn energies<'py>(
        &self,
        py: Python<'py>,
        curve: PyRef<'py, PyBranch>,
        conservative: bool,
    ) -> PyResult<Bound<'py, PyAny>> {
        let (_, system, watch) = self.asked_of_motions(py, "energies", None)?;
        backbone::energies(py, &curve, &system, watch, conservative)
    }

    /// Where the model is in phase resonance with its load, from the value that the parameter ``vary`` has to the value ``to``: `Branch`
    /// over that parameter, along which the frequency follows the resonance.
    ///
    /// ``between``: two frequencies, between which the response is searched for the first orbit; or ``on``: a `Branch` of the response, on
    /// which it is. ``harmonics``: so many. ``progress``: as of `response`. Nothing is known of stability.
    #[pyo3(
        signature = (vary, to, **options),
        text_signature = "($self, vary, to, *, between=None, on=None, harmonics=20, largest_step=0.1, max_points=5000, progress=None)"
    )]
    fn phase_resonance<'py>(
        &self,
        py: Python<'py>,
        vary: String,
        to: f64,
        options: Option<&Bound<'py, PyDict>>,
    ) -> PyResult<Bound<'py, PyAny>> {
        let (given, system, watch) = self.asked_of_motions(py, "phase_resonance", options)?;
        backbone::phase_resonance(py, vary, to, &system, watch, given)
    }

    /// The motion from a state, at equal distances of time: two arrays, the times of shape (periods*samples + 1,), and the states, all
    /// positions, then all velocities, of shape (periods*samples + 1, 2 coordinates).
    ///
    /// ``state``: at time zero, by default zeros. ``omega``: the excitation frequency. ``periods``: of the declaration, each with so many
    /// ``samples``. ``tolerance``: of the flow, where it is not in closed form.
    #[pyo3(signature = (state=None, *, omega, periods=1, samples=200, tolerance=1e-10))]
    fn history<'py>(
        &self,
        py: Python<'py>,
        state: Option<&Bound<'py, PyAny>>,
        omega: f64,
        periods: usize,
        samples: usize,
        tolerance: f64,
    ) -> PyResult<Bound<'py, PyAny>> {
        let state = state.map(crate::arrays::numbers).transpose()?;
        let asked = sweep::Asked {
            omega,
            periods,
            samples,
            tolerance,
        };
        let (_, system, watch) = self.asked_of_motions(py, "history", None)?;
        sweep::history(py, state, &system, watch, asked)
    }

    fn __reduce__<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        let module = py.import("hertzian._pickled")?;
        let rebuilt = (module.getattr("model")?, (&self.text, self.parameters(py)?));
        Ok(rebuilt.into_pyobject(py)?.into_any())
    }

    fn __repr__(&self) -> String {
        let system = self.system();
        let facts = system.facts();
        let values = self.declared(|declaration| {
            let values = declaration.parameters().into_iter();
            let values: Vec<String> = values.map(|(name, x)| format!("{name}={x}")).collect();
            values.join(", ")
        });
        format!("<Model {}({values})>", facts.name)
    }
}

/// Options of a diagram beside those of its first branch.
struct DiagramOptions {
    depth: Option<usize>,
    max_period: Option<usize>,
    max_branches: Option<usize>,
    margin: Option<f64>,
    cover: Option<PySettling>,
    settled_at: Option<Vec<f64>>,
}

impl DiagramOptions {
    fn of(given: &Given<'_>) -> PyResult<Self> {
        let settled_at = given.any("settled_at")?;
        Ok(Self {
            depth: given.take("depth")?,
            max_period: given.take("max_period")?,
            max_branches: given.take("max_branches")?,
            margin: given.take("margin")?,
            cover: given.take("cover")?,
            settled_at: settled_at
                .as_ref()
                .map(crate::arrays::numbers)
                .transpose()?,
        })
    }

    fn on<M: hertzian::OrbitMethod>(
        self,
        request: Bifurcations<M>,
        points: usize,
    ) -> Bifurcations<M> {
        let mut request = request.max_points(points);
        if let Some(depth) = self.depth {
            request = request.depth(depth);
        }
        if let Some(period) = self.max_period {
            request = request.max_period(period);
        }
        if let Some(branches) = self.max_branches {
            request = request.max_branches(branches);
        }
        if let Some(margin) = self.margin {
            request = request.margin(margin);
        }
        if let Some(settling) = self.cover {
            request = request.cover(settling.0);
        }
        if let Some(values) = &self.settled_at {
            request = request.settled_at(values);
        }
        request
    }
}
