//! Methods of computing orbits, and how a range is searched, with their options.

use hertzian::bifurcation::Settling;
use hertzian::{ContactEquation, HarmonicBalance, Shooting};
use pyo3::prelude::*;

/// Orbits as Fourier series whose residual vanishes in as many harmonics: the method where no law opens or has a corner, unless another one is
/// asked for.
///
/// ``harmonics``: the same number at every point, in place of as many as the tolerance asks for. ``doublings``: whether period doublings
/// are located too. ``bifurcations``: whether all bifurcations are, and not folds alone. ``symmetric``: whether orbits have the symmetry
/// that the system has.
#[pyclass(frozen, name = "HarmonicBalance", module = "hertzian", from_py_object)]
#[derive(Clone, Copy)]
pub struct PyHarmonicBalance(pub HarmonicBalance);

#[pymethods]
impl PyHarmonicBalance {
    #[new]
    #[pyo3(signature = (*, harmonics=None, doublings=false, bifurcations=false, symmetric=true))]
    fn new(harmonics: Option<usize>, doublings: bool, bifurcations: bool, symmetric: bool) -> Self {
        let balance = HarmonicBalance::new().doublings(doublings);
        let balance = balance.bifurcations(bifurcations).symmetric(symmetric);
        Self(match harmonics {
            Some(harmonics) => balance.harmonics(harmonics),
            None => balance,
        })
    }

    fn __repr__(&self) -> String {
        format!("{:?}", self.0)
    }
}

/// Orbits as states that return to themselves: multiple shooting, without truncation.
///
/// ``segments``: segments that the orbit is divided into, by default one for each period of the declaration. ``tolerance``: of the flow,
/// relative to the size of the motion, by default 1e-4 times that of the output.
#[pyclass(frozen, name = "Shooting", module = "hertzian", from_py_object)]
#[derive(Clone, Copy)]
pub struct PyShooting(pub Shooting);

#[pymethods]
impl PyShooting {
    #[new]
    #[pyo3(signature = (*, segments=None, tolerance=None))]
    fn new(segments: Option<usize>, tolerance: Option<f64>) -> Self {
        let mut shooting = Shooting::new();
        if let Some(segments) = segments {
            shooting = shooting.segments(segments);
        }
        if let Some(tolerance) = tolerance {
            shooting = shooting.tolerance(tolerance);
        }
        Self(shooting)
    }

    fn __repr__(&self) -> String {
        format!("{:?}", self.0)
    }
}

/// Orbits from the forces at a few nodes of each stretch in contact; between contacts the motion is known in closed form.
#[pyclass(frozen, name = "ContactEquation", module = "hertzian", from_py_object)]
#[derive(Clone, Copy)]
pub struct PyContactEquation(pub ContactEquation);

#[pymethods]
impl PyContactEquation {
    #[new]
    fn new() -> Self {
        Self(ContactEquation::new())
    }

    fn __repr__(&self) -> String {
        format!("{:?}", self.0)
    }
}

/// How a range is searched for what motions settle to, for ``cover`` of `Model.bifurcations`.
///
/// ``values``: so many values in the middles of as many parts of the range, besides those where there is no stable orbit. ``starts``: motions
/// from so many initial states at each. ``longest``: the longest period that is looked for, and ``patience``: for how long a motion is
/// followed, both in periods of the declaration.
#[pyclass(frozen, name = "Settling", module = "hertzian", from_py_object)]
#[derive(Clone, Copy)]
pub struct PySettling(pub Settling);

#[pymethods]
impl PySettling {
    #[new]
    #[pyo3(signature = (*, values=0, starts=4, longest=4, patience=500))]
    fn new(values: usize, starts: usize, longest: usize, patience: usize) -> Self {
        let settling = Settling::new().values(values).starts(starts);
        Self(settling.longest(longest).patience(patience))
    }

    fn __repr__(&self) -> String {
        format!("{:?}", self.0)
    }
}
