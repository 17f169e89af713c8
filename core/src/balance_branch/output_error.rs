//! The error of peak-to-peak of an output, as a part of itself.
//!
//! An output may be a small difference of coordinates, and with rates, accelerations and forces it is no linear function of the harmonics at
//! fixed phases. So it is read off the orbit and off the corrected one, contribution by contribution
//! ([`change_of`](RefinedBalance::change_of)). What is known of the coordinates alone is scaled by how much more of the output changes.

use super::point_evaluator::{PointEvaluator, ROUNDING};
use crate::balance::Balance;
use crate::balance::truncation::BEYOND;
use crate::branches::observed::{EXTREMES, part_of};
use crate::numeric::disturb;
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
        if !of.truncation.is_finite() {
            self.across = f64::INFINITY;
            return self.across;
        }
        let own = motion.peak_to_peak();
        let noise = self.noise(output, own, balance, u, of.left);
        let (measure, is_at_rest) = (motion.measure(noise), motion.is_at_rest(noise));
        let Self {
            finer, observer, ..
        } = self;
        let change = finer.change_of(u, &mut |balance, orbit| {
            let motion = observer.output(balance, orbit, output);
            [motion.minimum, motion.maximum]
        });
        if own + change == 0.0 {
            // It does not move, and neither does that of the corrected orbit.
            (self.across, self.rounding) = (0.0, 0.0);
            return self.output_along(output, motion, measure, balance, u, of.shift);
        }
        let first = BEYOND * finer.largest_change(u, observer.phases(), &self.units);
        // Where that is a first step only of what the coordinates are corrected by, it is one here.
        let steps = if first > 0.0 {
            of.truncation / first
        } else {
            1.0
        };
        let truncation = part_of(BEYOND_OF_OUTPUT * change * steps.max(1.0), measure);
        let times = if of.truncation > 0.0 {
            (truncation / of.truncation).max(1.0)
        } else {
            1.0
        };
        let extremes = EXTREMES * f64::EPSILON * motion.farthest();
        let noise = part_of(noise.max(extremes), measure);
        // Of what is at rest, all that is known is noise.
        let at_rest = if is_at_rest { noise } else { 0.0 };
        self.rounding = times * of.rounding + at_rest;
        self.across = truncation + times * of.left + noise + ROUNDING;
        self.across + self.output_along(output, motion, measure, balance, u, of.shift)
    }

    /// How much of peak-to-peak of an output is noise: what changes with an orbit whose harmonics are disturbed by rounding and by what
    /// Newton's method left.
    fn noise(
        &mut self,
        output: usize,
        own: f64,
        balance: &Balance<'_>,
        u: &[f64],
        left: f64,
    ) -> f64 {
        let by = EXTREMES * f64::EPSILON + left;
        let mut moved = u[..u.len() - 1].to_vec();
        disturb(&mut moved, by);
        let there = self.observer.output(balance, &moved, output);
        (there.peak_to_peak() - own).abs()
    }

    /// What the output at the value of the orbit differs from that at the value of the corrected one, by the slope of the branch.
    fn output_along(
        &mut self,
        output: usize,
        motion: &Motion,
        measure: f64,
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
        part_of(
            (there.peak_to_peak() - motion.peak_to_peak()).abs(),
            measure,
        )
    }
}
