//! Where another branch crosses, which no zero of a test function can be driven to: see [`continuation::crossing`](crate::continuation::crossing).

use super::Run;
use super::event_monitor::{ROUNDING, Test, or_infinite, three_quarters, unless_contradicted};
use crate::balance::Balance;
use crate::balance::truncation::BEYOND;
use crate::branches::point::Event;
use crate::branches::problem::Zero;
use crate::continuation::follow::{CurvePoint, Step};
use crate::continuation::newton::{Border, Newton};
use crate::event::EventKind;

/// Derivatives along the branch are differences over this part of the step: close by, the matrix of a step is singular.
const BESIDE: f64 = 0.1;
/// What interpolation leaves of a determinant at a branch point, as a part of what it is at the ends of the step.
pub(super) const CROSSED: f64 = 1e-6;

impl<'a> Run<'a> {
    /// Reads the orbit where another branch crosses.
    pub(super) fn branch_point(
        &mut self,
        balance: &mut Balance<'_>,
        newton: &mut Newton,
        step: Step<'_>,
        zero: &Zero,
        test: &mut Test<'_, 'a>,
    ) {
        let at = &zero.root.located.point;
        let shift = self.crossing_shift(balance, newton, step, at, test);
        let error = BEYOND * shift + zero.root.error + ROUNDING * at.parameter().abs();
        let point = self.evaluator.read(balance, newton, &at.u, None);
        let kind = if self.breaks_symmetry(at, test) {
            EventKind::SymmetryBreaking
        } else {
            zero.change.kind
        };
        self.record.events.push(Event {
            kind,
            error: unless_contradicted(or_infinite(error), kind, &point),
            point,
            test: zero.root.located.test,
            after: zero.after,
            contacts: 0,
            tangent: at.tangent.clone(),
        });
    }

    /// Whether the branch that crosses is one of orbits without a symmetry that the last orbit has.
    fn breaks_symmetry(&self, at: &CurvePoint, test: &mut Test<'_, 'a>) -> bool {
        let permutations = &self.context.permutations;
        let (Test::Block(block, _), Some(last)) = (test, self.record.points.last()) else {
            return false;
        };
        if permutations.is_empty() {
            return false;
        }
        let (_, v) = block.null_vector(&at.u, &at.tangent);
        permutations.are_broken(&last.orbit, &v[..v.len() - 1])
    }

    /// How far corrected orbits put a branch point from where it is: the zeros of straight lines through the test function
    /// on both sides of it, before and after the correction. As with other events, both halves of the harmonics that were left
    /// out are taken by their sizes.
    fn crossing_shift(
        &mut self,
        balance: &mut Balance<'_>,
        newton: &mut Newton,
        step: Step<'_>,
        at: &CurvePoint,
        test: &mut Test<'_, 'a>,
    ) -> f64 {
        let scale = step.before.scale;
        let mut row = vec![0.0; at.u.len()];
        newton.norm().linear_form(scale, &at.tangent, &mut row);
        let width = BESIDE * newton.norm().length(scale, &step.difference());
        let fine = self.evaluator.finer.balance().resolution();
        let resolutions = [fine, three_quarters(fine)];
        let mut monitors = resolutions.map(|of| self.monitor_like(test, of));
        let mut coarse = [[0.0; 2]; 2];
        let mut finer = [[[0.0; 2]; 2]; 2];
        for (side, sign) in [-1.0, 1.0].into_iter().enumerate() {
            let pairs = at.u.iter().zip(&at.tangent);
            let mut u: Vec<f64> = pairs.map(|(x, t)| x + sign * width * t).collect();
            let border = Border {
                row: &row,
                value: crate::numeric::linear::dot(&row, &u),
            };
            let options = self.options.newton;
            let corrected = newton.correct(balance, &mut u, border, scale, options);
            if corrected.is_err() || !self.evaluator.finer.correct(&u, newton) {
                return f64::INFINITY;
            }
            coarse[side] = [u[u.len() - 1], test.at(&u, &at.tangent)];
            for ((monitor, of), finer) in monitors.iter_mut().zip(resolutions).zip(&mut finer) {
                let u = self.with_harmonics_of(self.evaluator.finer.extended(), of);
                let tangent = self.with_harmonics_of(&at.tangent, of);
                let Some(mut test) = monitor.test(test) else {
                    return f64::INFINITY;
                };
                finer[side] = [u[u.len() - 1], test.at(&u, &tangent)];
            }
        }
        for monitor in &monitors {
            self.count(monitor);
        }
        let zero = |[[p, a], [q, b]]: [[f64; 2]; 2]| p + (q - p) * a / (a - b);
        let [all, half] = finer.map(|sides| zero(sides) - zero(coarse));
        half.abs() + (all - half).abs()
    }
}
