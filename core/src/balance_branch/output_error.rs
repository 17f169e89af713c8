//! The error of peak-to-peak of an output, as a part of itself.
//!
//! An output may be a small difference of coordinates, and with rates, accelerations and forces it is no linear function of the harmonics at
//! fixed phases. So it is read off the orbit and off the corrected one, contribution by contribution
//! ([`change_of`](RefinedBalance::change_of)). What is known of the coordinates alone is scaled by how much more of the output changes.

use super::point_evaluator::{EXTREMES, PointEvaluator, ROUNDING};
use crate::balance::Balance;
use crate::balance::truncation::BEYOND;
use crate::orbit::observe::Motion;

#[cfg(doc)]
use crate::balance::truncation::RefinedBalance;

/// The change by the harmonics from `K` to `2 K` times this is that by all above `K`, where it falls as `K^-1` or faster: a rate falls by a
/// power less than a displacement.
const BEYOND_OF_OUTPUT: f64 = 2.0;

/// Errors of the coordinates, as parts of the largest one.
#[derive(Debug, Clone, Copy)]
pub(super) struct OfCoordinates {
    /// By the harmonics that were left out, with all steps of their correction.
    pub(super) truncation: f64,
    /// By what Newton's method left, and by rounding of the equations.
    pub(super) left: f64,
    pub(super) rounding: f64,
    /// How far along the tangent the corrected orbit is from the value of the orbit.
    pub(super) shift: f64,
}

impl PointEvaluator<'_> {
    /// The error of an output with this motion.
    pub(super) fn error_of_output(
        &mut self,
        output: usize,
        motion: &Motion,
        balance: &mut Balance<'_>,
        u: &[f64],
        of: OfCoordinates,
    ) -> f64 {
        let own = motion.peak_to_peak();
        // What does not move has no error as a part of itself.
        if own <= 0.0 || !of.truncation.is_finite() {
            self.across = f64::INFINITY;
            return self.across;
        }
        let Self {
            finer, observer, ..
        } = self;
        let change = finer.change_of(u, &mut |balance, orbit| {
            observer.output(balance, orbit, output).peak_to_peak()
        });
        let first = BEYOND * finer.largest_change(u, observer.phases(), &self.units);
        // Where that is a first step only of what the coordinates are corrected by, it is one here.
        let steps = if first > 0.0 {
            of.truncation / first
        } else {
            1.0
        };
        let truncation = BEYOND_OF_OUTPUT * change * steps.max(1.0) / own;
        let times = if of.truncation > 0.0 {
            (truncation / of.truncation).max(1.0)
        } else {
            1.0
        };
        let farthest = motion.maximum.abs().max(motion.minimum.abs());
        let extremes = EXTREMES * f64::EPSILON * farthest / own;
        self.rounding = times * of.rounding;
        self.across = truncation + times * of.left + extremes + ROUNDING;
        self.across + self.output_along(output, own, balance, u, of.shift)
    }

    /// What the output at the value of the orbit differs from that at the value of the corrected one, by the slope of the branch.
    fn output_along(
        &mut self,
        output: usize,
        own: f64,
        balance: &mut Balance<'_>,
        u: &[f64],
        shift: f64,
    ) -> f64 {
        if shift == 0.0 {
            return 0.0;
        }
        let moved = u.iter().zip(&self.tangent);
        let moved: Vec<f64> = moved.map(|(x, t)| x + shift * t).collect();
        let n = u.len() - 1;
        balance.set(moved[n]);
        let there = self.observer.output(balance, &moved[..n], output);
        balance.set(u[n]);
        (there.peak_to_peak() - own).abs() / own
    }
}
