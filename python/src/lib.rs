//! The module `hertzian._hertzian`: what Python sees of the library, by the names that it has in Rust.
//!
//! Objects of Python hold results and refer to their parts; numbers become arrays where they are asked for. Every computation runs on a
//! thread of its own without the interpreter's lock, while the calling thread looks for signals (`compute.rs`).

mod arrays;
mod attractors;
mod backbone;
mod branch;
mod compute;
mod curve;
mod diagram;
mod errors;
mod event;
mod facts;
mod given;
mod held;
mod look;
mod map;
mod methods;
mod model;
mod observed;
mod orbit;
mod point;
mod progress;
mod reading;
mod request;
mod solutions;
mod stop;
mod sweep;

use pyo3::prelude::*;

/// What `hertzian` is made of; import that.
#[pymodule]
fn _hertzian(module: &Bound<'_, PyModule>) -> PyResult<()> {
    module.add("__version__", env!("CARGO_PKG_VERSION"))?;
    module.add_class::<model::PyModel>()?;
    module.add_class::<facts::Facts>()?;
    module.add_class::<facts::Named>()?;
    module.add_class::<methods::PyHarmonicBalance>()?;
    module.add_class::<methods::PyShooting>()?;
    module.add_class::<methods::PyContactEquation>()?;
    module.add_class::<methods::PySettling>()?;
    module.add_class::<branch::PyBranch>()?;
    module.add_class::<branch::PyRun>()?;
    module.add_class::<point::PyPoint>()?;
    module.add_class::<point::PyStability>()?;
    module.add_class::<observed::PyObserved>()?;
    module.add_class::<observed::PyMotion>()?;
    module.add_class::<observed::PyContactMotion>()?;
    module.add_class::<orbit::PyOrbit>()?;
    module.add_class::<reading::PyReading>()?;
    module.add_class::<reading::PySpectrum>()?;
    module.add_class::<event::PyEvent>()?;
    module.add_class::<event::PyTurn>()?;
    module.add_class::<event::PyWinding>()?;
    module.add_class::<stop::PyStop>()?;
    module.add_class::<stop::PyLeap>()?;
    module.add_class::<curve::PyBifurcationCurve>()?;
    module.add_class::<curve::PySpecial>()?;
    module.add_class::<diagram::PyDiagram>()?;
    module.add_class::<diagram::PyDiagramBranch>()?;
    module.add_class::<diagram::PyOrigin>()?;
    module.add_class::<diagram::PyOmitted>()?;
    module.add_class::<diagram::PySearched>()?;
    module.add_class::<diagram::PySettledTo>()?;
    module.add_class::<solutions::PySolutions>()?;
    module.add_class::<solutions::PySolutionsAt>()?;
    module.add_class::<solutions::PySolution>()?;
    module.add_class::<map::PyMap>()?;
    module.add_class::<attractors::PyAxis>()?;
    module.add_class::<attractors::PyBasins>()?;
    module.add_class::<attractors::PyAttractor>()?;
    module.add_class::<sweep::PySwept>()?;
    module.add_class::<sweep::PyRow>()?;
    module.add_class::<progress::PyProgress>()?;
    Ok(())
}
