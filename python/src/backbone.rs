//! Backbone curves: free oscillation, and phase resonance.

use std::sync::Arc;

use hertzian::System;
use hertzian::backbone::{FreeOscillation, PhaseResonance};
use numpy::PyArray1;
use pyo3::IntoPyObjectExt;
use pyo3::prelude::*;

use crate::arrays::numbers;
use crate::branch::PyBranch;
use crate::compute::{Watch, compute};
use crate::given::Given;

/// Free oscillation of a system, or of what is left of it without what gives or takes energy.
fn free(system: &Arc<dyn System>, conservative: Option<bool>) -> FreeOscillation {
    let request = FreeOscillation::of(system);
    if conservative.unwrap_or(false) {
        request.conservative()
    } else {
        request
    }
}

/// The frequency of free oscillation over its amplitude.
pub fn free_oscillation<'py>(
    py: Python<'py>,
    [from, to]: [Option<f64>; 2],
    system: &Arc<dyn System>,
    watch: Watch,
    given: Given<'py>,
) -> PyResult<Bound<'py, PyAny>> {
    let mut request = free(system, given.take("conservative")?);
    if let Some(position) = from {
        request = request.from(position);
    }
    if let Some(position) = to {
        request = request.to(position);
    }
    if let Some(branch) = given.take::<PyRef<'py, PyBranch>>("up_to")? {
        request = request.up_to(&branch.held());
    }
    if let Some(coordinate) = given.take::<String>("along")? {
        request = request.along(coordinate);
    }
    if let Some((positions, omega)) = given.take::<(Bound<'py, PyAny>, f64)>("near_rest")? {
        request = request.near_rest(&numbers(&positions)?, omega);
    }
    if let Some(number) = given.take("mode")? {
        request = request.mode(number);
    }
    if let Some(tolerance) = given.take("tolerance")? {
        request = request.tolerance(tolerance);
    }
    if let Some(step) = given.take("largest_step")? {
        request = request.largest_step(step);
    }
    if let Some(points) = given.take("max_points")? {
        request = request.max_points(points);
    }
    given.end()?;
    compute(
        py,
        watch,
        |cancel, see| request.cancel(cancel).run_with(see),
        PyBranch::new,
    )
}

/// Where a system is in phase resonance with its load.
pub fn phase_resonance<'py>(
    py: Python<'py>,
    vary: String,
    to: f64,
    system: &Arc<dyn System>,
    watch: Watch,
    given: Given<'py>,
) -> PyResult<Bound<'py, PyAny>> {
    let mut request = PhaseResonance::of(system).vary(vary).to(to);
    if let Some((low, high)) = given.take("between")? {
        request = request.between(low, high);
    }
    if let Some(branch) = given.take::<PyRef<'py, PyBranch>>("on")? {
        request = request.on(&branch.held());
    }
    if let Some(harmonics) = given.take("harmonics")? {
        request = request.harmonics(harmonics);
    }
    if let Some(step) = given.take("largest_step")? {
        request = request.largest_step(step);
    }
    if let Some(points) = given.take("max_points")? {
        request = request.max_points(points);
    }
    given.end()?;
    compute(
        py,
        watch,
        |cancel, see| request.cancel(cancel).run_with(see),
        PyBranch::new,
    )
}

/// Frequencies of small free oscillations.
pub fn modes<'py>(
    py: Python<'py>,
    system: &Arc<dyn System>,
    watch: Watch,
    conservative: bool,
) -> PyResult<Bound<'py, PyAny>> {
    let request = free(system, Some(conservative));
    compute(
        py,
        watch,
        |cancel, _| request.cancel(cancel).modes(),
        Numbers,
    )
}

/// Energies of free oscillations.
pub fn energies<'py>(
    py: Python<'py>,
    curve: &PyBranch,
    system: &Arc<dyn System>,
    watch: Watch,
    conservative: bool,
) -> PyResult<Bound<'py, PyAny>> {
    let request = free(system, Some(conservative));
    let curve = curve.held();
    compute(
        py,
        watch,
        |cancel, _| request.cancel(cancel).energies(&curve),
        Numbers,
    )
}

/// Numbers that become an array.
struct Numbers(Vec<f64>);

impl<'py> IntoPyObject<'py> for Numbers {
    type Target = PyAny;
    type Output = Bound<'py, PyAny>;
    type Error = PyErr;

    fn into_pyobject(self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        PyArray1::from_vec(py, self.0).into_bound_py_any(py)
    }
}
