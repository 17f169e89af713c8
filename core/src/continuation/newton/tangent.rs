//! The direction of the solution curve, with what the Jacobian leaves out.

use super::{Border, Newton, subtract};
use crate::continuation::problem::Problem;
use crate::numeric::linear::dot;

/// A tangent whose component along the parameter is smaller than this is computed exactly: it may be near a fold.
const NEAR_FOLD: f64 = 0.1;
/// The same in units of what an exact matrix has changed by since its factors were made: beside a branch point it is nearly singular, and what it
/// changes by on the way from the predictor turns its tangent.
const CHANGES: f64 = 3.0;
/// Corrections of an exact tangent, at most.
const REFINEMENTS: usize = 60;
/// Relative size of the last of them, where it decides on an event.
const REFINED: f64 = 1e-13;
/// The same where only the side of a fold matters.
const ROUGHLY: f64 = 1e-4;
/// Where rounding keeps corrections from shrinking, this many times that is good enough.
const ROUNDING: f64 = 100.0;
/// Drift that does not change a tangent noticeably.
const SMALL_DRIFT: f64 = 1e-8;
/// Drift that is made up for along with what the Jacobian leaves out.
const DRIFT_TO_REFINE: f64 = 1e-2;

impl Newton {
    /// The direction of the solution curve at a solution that was corrected last, not yet normalised: it solves (1) with a
    /// right-hand side that is one in the border and zero elsewhere. Near a fold, or where `exact` is set, nothing is left out
    /// of the Jacobian. Returns whether that could be made up for; if not, the direction is the one of what the Jacobian has,
    /// and [`Newton::contraction`] says that there is none.
    pub fn tangent(
        &mut self,
        problem: &mut dyn Problem,
        u: &[f64],
        tangent: &mut [f64],
        exact: bool,
    ) -> bool {
        self.unit_of_border(tangent);
        let n = self.norm.unknowns();
        let slope = tangent[n] / self.scale.parameter;
        let doubtful = if self.jacobian.is_exact() {
            CHANGES * self.changed
        } else {
            0.0
        };
        let steep = slope.abs() >= (NEAR_FOLD + doubtful) * self.norm.length(self.scale, tangent);
        if steep && !exact {
            return true;
        }
        let allowed = match (self.jacobian.is_exact(), exact) {
            (true, true) => REFINED,
            (true, false) => SMALL_DRIFT,
            // It is refined anyway.
            (false, _) => DRIFT_TO_REFINE,
        };
        if self.drift > allowed {
            self.trial.copy_from_slice(&self.border);
            let border = std::mem::take(&mut self.trial);
            let row = Border {
                row: &border,
                value: dot(&border, u),
            };
            let renewed = self.linearise(problem, u, row);
            self.trial = border;
            if renewed.is_err() {
                return false;
            }
            self.unit_of_border(tangent);
        }
        if self.jacobian.is_exact() {
            return true;
        }
        let wanted = if exact { REFINED } else { ROUGHLY };
        let refined = self.refine(problem, u, tangent, wanted);
        if !refined {
            self.contraction = self.contraction.max(1.0);
            self.unit_of_border(tangent);
        }
        refined
    }

    /// The same with what the Jacobian has, and how steeply the curve runs along the parameter there: from zero at a fold to one.
    pub fn direction(&mut self, tangent: &mut [f64]) -> f64 {
        self.unit_of_border(tangent);
        let slope = tangent[self.norm.unknowns()] / self.scale.parameter;
        slope.abs() / self.norm.length(self.scale, tangent)
    }

    /// Writes the solution of (1) for a right-hand side that is one in the border and zero elsewhere.
    fn unit_of_border(&mut self, tangent: &mut [f64]) {
        let n = self.norm.unknowns();
        tangent.fill(0.0);
        tangent[n] = 1.0;
        self.solve(tangent);
    }

    /// Makes up for what the Jacobian leaves out: `t += B^-1 ([0; 1] - J t)`, repeated. Returns whether the last correction
    /// was as small as wanted, or as rounding allows.
    fn refine(
        &mut self,
        problem: &mut dyn Problem,
        u: &[f64],
        tangent: &mut [f64],
        wanted: f64,
    ) -> bool {
        let n = self.norm.unknowns();
        self.memory.clear();
        let wanted = wanted * self.norm.length(self.scale, tangent);
        let (mut before, mut previous) = (f64::INFINITY, f64::INFINITY);
        for _ in 0..REFINEMENTS {
            problem.apply(u, tangent, &mut self.residual[..n]);
            self.statistics.derivatives += 1;
            self.residual[n] = dot(&self.border, tangent) - 1.0;
            self.next_update(false);
            let change = self.norm.length(self.scale, &self.update);
            // They need not shrink in every norm at once.
            let largest = before.max(previous);
            if change.is_nan() || change >= 4.0 * largest {
                break;
            }
            subtract(tangent, &self.update, 1.0);
            self.memory.remember(&self.norm, self.scale, &self.update);
            let rounding = change <= ROUNDING * wanted && change > 0.5 * largest;
            if change <= wanted || rounding {
                return true;
            }
            (before, previous) = (previous, change);
        }
        false
    }
}
