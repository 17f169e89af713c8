//! The tangent of a branch at an event, in the states that its orbit has at the beginnings of periods: what is switched to there is looked for in
//! states, and unknowns of the contact equation are those of its own switches only.
//!
//! With states `x(u)` and a tangent `t`, it is a central difference,
//!
//! ```text
//! (x(u + e t) - x(u - e t)) / (2 e)                                                                            (1)
//! ```
//!
//! or one to the side of the event on which no gap touches its level within `e`: across a touch the motion has another derivative.
//!
//! Source: Abramowitz and Stegun (1964), Handbook of Mathematical Functions, section 25.3 (numerical differentiation).

use crate::contact_equation::equations::Equations;
use crate::contact_equation::orbit::motion::Motion;
use crate::contact_equation::run::difference_step;
use crate::contact_equation::skeleton::Skeleton;
use crate::contact_equation::skeleton::placement::Told;
use crate::continuation::follow::CurvePoint;

/// (1), and the component along what is varied; empty where the motion beside the point is not known.
pub(super) fn of_states(equations: &mut Equations, at: &CurvePoint, periods: usize) -> Vec<f64> {
    let step = difference_step(&equations.skeleton, &at.u, &at.tangent);
    let ways = ways(&equations.skeleton, at, step);
    let mut beside = |step: f64| {
        let pairs = at.u.iter().zip(&at.tangent);
        let u: Vec<f64> = pairs.map(|(x, t)| x + step * t).collect();
        equations.compute(&u, false);
        (!equations.failed).then(|| Motion::of(equations).states_of_parts(periods))
    };
    let [forward, backward] = ways.map(|free| if free { step } else { 0.0 });
    let ends = beside(forward).zip(beside(-backward));
    let Some((ahead, behind)) = ends else {
        return Vec::new();
    };
    let whole = forward + backward;
    let pairs = ahead.iter().zip(&behind);
    let mut tangent: Vec<f64> = pairs.map(|(a, b)| (a - b) / whole).collect();
    tangent.push(at.tangent[at.tangent.len() - 1]);
    tangent
}

/// Whether the ways ahead and back are free of touches: no `H` of (2) of [`skeleton`](crate::contact_equation::skeleton) changes its sign there. Both are taken
/// where neither is.
fn ways(skeleton: &Skeleton, at: &CurvePoint, step: f64) -> [bool; 2] {
    let switches = skeleton.switches.iter().enumerate();
    let pairs = switches.filter(|(_, switch)| matches!(switch.told, Told::Second { .. }));
    let places: Vec<usize> = pairs.map(|(index, _)| skeleton.slot(index)).collect();
    let is_free = |step: f64| {
        let touches = |slot: &usize| {
            let (here, moved) = (at.u[*slot], step * at.tangent[*slot]);
            (here > 0.0) != (here + moved > 0.0)
        };
        !places.iter().any(touches)
    };
    match [step, -step].map(is_free) {
        [false, false] => [true, true],
        free => free,
    }
}
