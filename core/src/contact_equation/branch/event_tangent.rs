//! The tangent of a branch at an event, in the states that its orbit has at the beginnings of periods: what is switched to there is looked for in
//! states, and unknowns of the contact equation are those of its own switches only.
//!
//! With states `x(u)` and a tangent `t`, it is a central difference,
//!
//! ```text
//! (x(u + e t) - x(u - e t)) / (2 e)                                                                            (1)
//! ```
//!
//! Source: Abramowitz and Stegun (1964), Handbook of Mathematical Functions, section 25.3 (numerical differentiation).

use crate::contact_equation::equations::Equations;
use crate::contact_equation::orbit::motion::Motion;
use crate::contact_equation::run::DIFFERENCE;
use crate::continuation::follow::CurvePoint;

/// (1), and the component along what is varied; empty where the motion beside the point is not known.
pub(super) fn of_states(equations: &mut Equations, at: &CurvePoint, periods: usize) -> Vec<f64> {
    let step = DIFFERENCE / at.tangent.iter().fold(1e-3, |m: f64, t| m.max(t.abs()));
    let mut beside = |step: f64| {
        let pairs = at.u.iter().zip(&at.tangent);
        let u: Vec<f64> = pairs.map(|(x, t)| x + step * t).collect();
        equations.compute(&u, false);
        (!equations.failed).then(|| Motion::of(equations).states_of_parts(periods))
    };
    let ends = beside(step).zip(beside(-step));
    let Some((ahead, behind)) = ends else {
        return Vec::new();
    };
    let pairs = ahead.iter().zip(&behind);
    let mut tangent: Vec<f64> = pairs.map(|(a, b)| (a - b) / (2.0 * step)).collect();
    tangent.push(at.tangent[at.tangent.len() - 1]);
    tangent
}
