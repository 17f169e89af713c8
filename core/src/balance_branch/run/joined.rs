//! Where a branch of longer or less symmetric orbits joins the more regular one that it began at, and ends.

use super::Run;
use crate::balance::Balance;
use crate::balance::subharmonics::passes_shorter_period;
use crate::balance::symmetry::{broken, broken_share};
use crate::continuation::follow::{CurvePoint, Step, Stop};
use crate::continuation::locate::locate;
use crate::continuation::newton::Newton;
use crate::continuation::problem::Norm;

/// What the orbits of a longer period have in addition vanishes as the square root of the distance in the parameter, so that
/// this part of it is as good as nothing.
const JOINED: f64 = 1e-5;
/// What Newton's method leaves is below so many times its tolerance.
const BEYOND_NEWTON: f64 = 100.0;
/// An orbit that has more than this part of it left is not one of the more regular branch.
const LEFT: f64 = 0.05;

impl Run<'_> {
    /// Whether the branch has passed an orbit of a shorter period, or a symmetric one, since its last point: what its orbits have
    /// in addition has changed its sign.
    pub(super) fn joins(&self, u: &[f64]) -> bool {
        let orbit = self.record.points.last().map(|point| &point.orbit);
        orbit.is_some_and(|orbit| {
            let length = orbit.row(0).len();
            let least = BEYOND_NEWTON * self.options.newton.tolerance;
            let symmetric = self.context.asymmetric
                && broken_share(&orbit.series, length) > least * least
                && broken(orbit, u).vanished();
            symmetric || passes_shorter_period(orbit, u, self.context.stride).is_some()
        })
    }

    /// Locates where a branch of longer orbits joins one of a shorter period, and ends it there: what would follow are the
    /// same orbits again, one excitation period later. Says whether it does; what its orbits have in addition may also turn
    /// without vanishing.
    pub(super) fn join(
        &mut self,
        balance: &mut Balance<'_>,
        newton: &mut Newton,
        step: Step<'_>,
    ) -> bool {
        let Some(last) = self.record.points.last() else {
            return false;
        };
        let joined = passes_shorter_period(&last.orbit, &step.next.u, self.context.stride);
        let addition = |point: &CurvePoint| match joined {
            Some(joined) => joined.addition(&last.orbit, &point.u),
            None => broken(&last.orbit, &point.u),
        };
        let period = joined.map_or(last.orbit.period, |joined| joined.period);
        let options = self.options.newton;
        let along = |_: &mut Balance<'_>, point: &CurvePoint| addition(point).along();
        let value = match locate(balance, newton, step, options, JOINED, along) {
            // It turned, and did not vanish: the branch goes on.
            Some(located) if addition(&located.point).size() > LEFT => return false,
            Some(located) => located.point.parameter(),
            None => vertex(newton.norm(), step),
        };
        self.ended = Some(Stop::Joined {
            period,
            symmetric: joined.is_none(),
            value,
        });
        true
    }
}

/// The parameter where it turns back between two points, on the cubic through both with their slopes (Hermite's); in the middle if
/// that does not turn.
fn vertex(norm: &Norm, step: Step<'_>) -> f64 {
    let Step { before, next } = step;
    let difference = step.difference();
    let length = norm.length(before.scale, &difference);
    let last = difference.len() - 1;
    let change = difference[last];
    let [a, b] = [before, next]
        .map(|point| length * point.tangent[last] / norm.length(before.scale, &point.tangent));
    // The slope is a + 2 c x + 3 d x^2 for x from 0 to 1.
    let (c, d) = (3.0 * change - 2.0 * a - b, a + b - 2.0 * change);
    let root = (c * c - 3.0 * a * d).sqrt();
    let turns = [-a / (c + root), -a / (c - root)];
    let inside = turns.into_iter().find(|x| (0.0..=1.0).contains(x));
    let x = inside.unwrap_or(0.5);
    let turned = before.parameter() + x * (a + x * (c + x * d));
    if inside.is_some() {
        turned
    } else {
        0.5 * (before.parameter() + next.parameter())
    }
}
