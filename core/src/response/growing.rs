//! Linear parts of which motions grow away within a period, which are followed by shooting by default.
//!
//! Without its contacts a system may fall away from where it is, as a buckled beam between stops does. Then a motion from states at the beginning
//! has grown after a period `T` by
//!
//! ```text
//! exp(T max Re lambda),    det(lambda^2 M + lambda C + K) = 0                                                  (1)
//! ```
//!
//! and rounding of these states with it. The contact equation has the states at the beginning of the period as unknowns, and the forces give
//! back what grows. Shooting begins anew in segments.
//!
//! Source of shooting in segments for motions that grow: Ascher, Mattheij and Russell (1995), Numerical Solution of Boundary Value Problems for
//! Ordinary Differential Equations, section 4.3.

use nalgebra::DMatrix;

use crate::branches::request::Request;
use crate::model::layout::{self, Layout};
use crate::numeric::spectrum::eigenvalues;
use crate::system::System;

/// The logarithm of (1) from which on it matters: five of the digits of a number and a half, or fewer where as many roundings as these come to the tolerance.
const MUCH: f64 = 13.0;
const ROUNDINGS: f64 = 100.0;
/// Of more coordinates a growth is not looked for.
const MOST: usize = 60;

/// Whether motions of the linear part grow that much in the period of a request.
pub(super) fn grows(
    system: &dyn System,
    layout: &Layout,
    coefficients: &[f64],
    omega: f64,
    request: &Request,
) -> bool {
    let divisor = f64::from(system.facts().divisor);
    let time = std::f64::consts::TAU * divisor * request.period() as f64 / omega;
    let seen = (request.tolerance / (ROUNDINGS * f64::EPSILON)).ln();
    let much = seen.clamp(0.0, MUCH);
    fastest(layout, coefficients).is_some_and(|growth| growth * time > much)
}

/// The largest real part in (1); nothing where stiffness and damping show that none is positive, or there is no mass.
fn fastest(layout: &Layout, coefficients: &[f64]) -> Option<f64> {
    let n = layout.coordinates;
    let matrix = |entries| layout::constant(entries, coefficients, n);
    let [damping, stiffness] = [matrix(&layout.damping), matrix(&layout.stiffness)];
    let holds = |matrix: &DMatrix<f64>| {
        matrix.transpose() == *matrix && matrix.clone().cholesky().is_some()
    };
    if n > MOST || (holds(&stiffness) && holds(&damping)) {
        return None;
    }
    let mass = layout.mass(coefficients).lu();
    let by_position = mass.solve(&stiffness)?;
    let by_rate = mass.solve(&damping)?;
    let mut companion = DMatrix::zeros(2 * n, 2 * n);
    companion.view_mut((0, n), (n, n)).fill_with_identity();
    companion.view_mut((n, 0), (n, n)).copy_from(&-by_position);
    companion.view_mut((n, n), (n, n)).copy_from(&-by_rate);
    let exponents = eigenvalues(&companion);
    exponents
        .into_iter()
        .map(|exponent| exponent.re)
        .reduce(f64::max)
}
