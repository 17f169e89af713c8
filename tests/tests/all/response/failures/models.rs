//! The oscillators of the gallery, and how their orbits are found and compared.

use std::ops::ControlFlow;

use hertzian::stability::{Answer, Method};
use hertzian::{Branch, Error, FrequencyResponse, OrbitMethod};
pub use hertzian_tests::{Continuous, OneSided, OneSidedLinear, distance};

/// The linear one at the damping and load of the paper.
pub const fn linear(drive: f64) -> OneSidedLinear {
    OneSidedLinear {
        zeta: 0.032,
        load: 1.0,
        drive,
    }
}

/// A branch of one point: the first orbit of a request, if one is found.
pub fn start<M: OrbitMethod>(request: &FrequencyResponse<M>) -> Result<Branch, Error> {
    request.run_with(|_| ControlFlow::Break(()))
}

/// The same of a request that has one.
pub fn first<M: OrbitMethod>(request: &FrequencyResponse<M>) -> Branch {
    start(request).unwrap()
}

/// What a method says of the first orbit of a branch.
pub fn answer(branch: &Branch, method: Method) -> Answer {
    branch.multipliers(&branch.points[0], method).unwrap()
}

/// A number in a row of a table, if there is one.
pub fn shown(number: Option<f64>) -> String {
    number.map_or_else(|| "no orbit found".to_owned(), |x| format!("{x:.1e}"))
}
