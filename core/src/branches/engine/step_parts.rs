//! Orbits within a step: the steps between them, their places among the parts, and whether a tangent there leads along the step.

use super::seen::Seen;
use crate::continuation::follow::{CurvePoint, Step};
use crate::continuation::locate::ArcLength;
use crate::continuation::newton::Newton;

/// The step from one orbit to another.
pub(super) fn step_between([a, b]: [&Seen; 2]) -> Step<'_> {
    Step {
        before: &a.point,
        next: &b.point,
    }
}

/// Whether the tangent of an orbit within a step leads along its chord as those of both ends do. Where a branch bends by more than that, which way it
/// goes at an orbit is not known, and with it the signs of determinants.
pub(super) fn is_on_way(newton: &Newton, step: Step<'_>, found: &CurvePoint) -> bool {
    let (chord, scale) = (step.difference(), step.before.scale);
    let along = |at: &CurvePoint| newton.norm().product(scale, &at.tangent, &chord);
    let [a, b, here] = [step.before, step.next, found].map(along);
    here * a > 0.0 && here * b > 0.0
}

/// Puts an orbit to its place among the parts of a step: where the way by it is hardly longer. No arc length tells that where the branch bends.
pub(super) fn insert(newton: &Newton, parts: &mut Vec<Seen>, found: Seen) {
    let scale = parts[0].point.scale;
    let apart = |a: &Seen, b: &Seen| {
        let pairs = a.point.u.iter().zip(&b.point.u);
        let difference: Vec<f64> = pairs.map(|(x, y)| x - y).collect();
        newton.norm().length(scale, &difference)
    };
    let detours = parts
        .windows(2)
        .map(|pair| apart(&pair[0], &found) + apart(&found, &pair[1]) - apart(&pair[0], &pair[1]));
    let least = detours.enumerate().min_by(|a, b| a.1.total_cmp(&b.1));
    parts.insert(least.map_or(1, |(place, _)| place + 1), found);
}

/// How far a point is behind another one.
pub(super) fn distance(newton: &Newton, a: &CurvePoint, b: &CurvePoint) -> f64 {
    ArcLength::from(newton, a).at(&b.u)
}
