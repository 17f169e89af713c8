//! Orbits beside the turn of a branch. Where it turns and the bordered determinant changes its sign as well, that is one place, where it ends on
//! another branch, or two, a fold and a crossing: orbits on both sides of the turn tell.

use super::Engine;
use super::seen::{Seen, changes};
use super::step_parts::step_between;
use crate::branches::problem::{BranchProblem, Change, Test};
use crate::continuation::locate::{ArcLength, inside, locate};
use crate::continuation::newton::{Newton, NewtonOptions};
use crate::event::EventKind;

/// Half of the widths about a turn that are looked at, as parts of the step.
const BESIDE: [f64; 3] = [1e-2, 1e-3, 1e-4];
/// Orbits there are known to this part of how far they are from the turn: a step may be hardly longer than what Newton's method leaves.
const KNOWN: f64 = 1e-2;
/// A zero is in the middle of a width if the values at both ends differ by less than this part.
const MIDDLE: f64 = 0.2;

impl Engine {
    /// Orbits before and behind the turn in a step in which the bordered determinant changes its sign too, if it does so beside the turn. `None` too where
    /// orbits are not known well enough to tell.
    pub(super) fn beside_turn(
        &self,
        problem: &mut dyn BranchProblem,
        newton: &mut Newton,
        pair: [&Seen; 2],
    ) -> Option<[Seen; 2]> {
        let found = changes(problem, pair[0], pair[1]);
        let is_turn =
            |change: &Change| change.test == Test::Slope && change.kind == EventKind::BranchPoint;
        if !found.iter().any(is_turn) {
            return None;
        }
        let bordered = problem
            .watched()
            .iter()
            .position(|watched| watched.bordered)?;
        let step = step_between(pair);
        let length = newton.norm().length(step.before.scale, &step.difference());
        let along = ArcLength::from(newton, step.before);
        let wanted = problem.vanishing();
        for width in BESIDE {
            let options = NewtonOptions {
                tolerance: (KNOWN * width * length).min(self.options.newton.tolerance),
                ..self.options.newton
            };
            let turn = locate(problem, newton, step, options, wanted, |problem, at| {
                problem.slope(at)
            })?;
            let place = along.at(&turn.point.u) / along.at(&step.next.u);
            let mut beside = |width: f64| {
                let part = place + width;
                let point = inside(problem.equations(), newton, step, part, options)?;
                Some(Seen::at(problem, &point, pair[0].falls))
            };
            let width = width.min(0.5 * place).min(0.5 * (1.0 - place));
            let found = [beside(-width)?, beside(width)?];
            let slopes = found.each_ref().map(|seen| seen.point.parameter_slope());
            // What Newton's method leaves hides where the branch turns.
            if turn.test.abs() > MIDDLE * slopes[0].abs().min(slopes[1].abs()) {
                return None;
            }
            if slopes[0] * slopes[1] >= 0.0 {
                return None;
            }
            let values = found.each_ref().map(|seen| seen.values[bordered]);
            let reference = values[0].exponent.max(values[1].exponent);
            let [b, c] = values.map(|value| value.relative_to(reference));
            if b * c > 0.0 {
                return Some(found);
            }
            // Where a branch ends on another one, it vanishes in the middle.
            if (b + c).abs() < MIDDLE * (b - c).abs() {
                return None;
            }
        }
        None
    }
}
