//! Further steps of the correction, where the first is not small.
//!
//! With the residual `R` of the finer balance at the orbit corrected last, tail and core are corrected in turn by (1) of
//! [`truncation`](super), with the same matrices. The steps fall as a power of a ratio `r`, so that all those that are not made are about
//!
//! ```text
//! r / (1 - r)                                                                                                  (1)
//! ```
//!
//! of the last. `r` is that of what the contacts couple of the tail to its inertia, and that of the change of the Jacobian to itself.
//!
//! Source: Kelley (1995), Iterative Methods for Linear and Nonlinear Equations, section 5.4.1 (the chord method).

use super::{NOTHING, RefinedBalance};
use crate::continuation::newton::Newton;
use crate::continuation::problem::Problem;
use crate::numeric::fourier::series;

/// Size of a correction, in parts of the oscillation, below which the Jacobian does not change with it.
const SMALL: f64 = 1e-5;
/// What contacts couple of the tail to its inertia, beyond which further steps are made however small the first is: they fall slowly, or
/// grow. Up to it their sum is that of a geometric series.
const STRONG: f64 = 0.5;
const STRONGEST: f64 = 1.0 / (1.0 - STRONG);
/// Harmonics up to which such steps are made in any case, and cost least: a contact that is always closed needs no more, however stiff
/// it is beside the inertia of the tail.
const FEW: usize = 12;
/// Size of the last step, in parts of all of them.
const ENOUGH: f64 = 0.01;
/// Further steps, at most.
const STEPS: usize = 6;
/// Ratio of successive steps, at most, by which the sum of those that follow is extrapolated: steps that hardly fall tell no more.
const SLOWEST: f64 = 0.9;

impl RefinedBalance<'_> {
    /// How much the peak-to-peak of a coordinate is changed in its unit, at most, given the phases of the smallest and largest values, by
    /// the last correction of an orbit and by further steps of it, where it is not small.
    pub(crate) fn peak_to_peak_error(
        &mut self,
        u: &[f64],
        phases: &[[f64; 2]],
        units: &[f64],
        newton: &mut Newton,
    ) -> f64 {
        let first = self.largest_change(u, phases, units);
        let most = if self.coarse.harmonics <= FEW * self.coarse.period * self.coarse.stride {
            NOTHING
        } else {
            SMALL
        };
        let steps = 1.0 / (1.0 - self.coupled);
        if self.change() <= NOTHING || (self.change() <= most && self.coupled <= STRONG) {
            return first * steps.clamp(1.0, STRONGEST);
        }
        self.further.clone_from(&self.orbit);
        let error = match self.step_on(u, units, newton) {
            Some(remaining) => first.max(self.largest_change(u, phases, units)) + remaining,
            None => f64::INFINITY,
        };
        // What else is read off the orbit is to first order.
        std::mem::swap(&mut self.orbit, &mut self.further);
        let last = self.orbit.len() - 1;
        self.balance.set(self.orbit[last]);
        error
    }

    /// The same by the last correction alone.
    pub(crate) fn largest_change(&self, u: &[f64], phases: &[[f64; 2]], units: &[f64]) -> f64 {
        let coordinates = phases.iter().zip(units).enumerate();
        coordinates
            .map(|(coordinate, (&phases, unit))| {
                self.peak_to_peak_change(u, coordinate, phases) / unit
            })
            .fold(0.0, f64::max)
    }

    /// Corrects the orbit further, and returns a bound on what is left of the peak-to-peak, (1), each coordinate in its unit; `None` if
    /// that is not finite, or if steps grow.
    fn step_on(&mut self, u: &[f64], units: &[f64], newton: &mut Newton) -> Option<f64> {
        let all = self.distance(units, |finer, index| {
            finer.orbit[index] - finer.start(u, index)
        });
        if all == 0.0 {
            return Some(0.0);
        }
        let (mut before, mut ratio, mut last) = (all, 0.0, 0.0);
        self.before.clone_from(&self.orbit);
        for _ in 0..STEPS {
            self.step(newton)?;
            last = self.distance(units, |finer, index| {
                finer.orbit[index] - finer.before[index]
            });
            self.before.copy_from_slice(&self.orbit);
            ratio = last / before;
            before = last;
            if ratio.is_nan() || ratio > 1.0 {
                return None;
            }
            if last <= ENOUGH * all {
                break;
            }
        }
        let ratio = f64::min(ratio, SLOWEST);
        Some(2.0 * last * ratio / (1.0 - ratio))
    }

    /// Tail and core in turn, from residuals with all terms.
    fn step(&mut self, newton: &mut Newton) -> Option<()> {
        let value = self.orbit[self.orbit.len() - 1];
        self.balance.set(value);
        self.balance.evaluate(&self.orbit, &mut self.residual, None);
        self.move_tail()?;
        self.balance.evaluate(&self.orbit, &mut self.residual, None);
        self.core.fill(0.0);
        self.add_core(1.0);
        newton.statistics.residuals += 2;
        self.move_core(newton);
        self.orbit.iter().all(|x| x.is_finite()).then_some(())
    }

    /// An entry of the orbit before it was corrected; those of the tail are none.
    fn start(&self, u: &[f64], index: usize) -> f64 {
        let (fine, coarse) = (self.balance.length(), series::length(self.coarse.harmonics));
        let (coordinate, entry) = (index / fine, index % fine);
        if entry < coarse {
            u[coordinate * coarse + entry]
        } else {
            0.0
        }
    }

    /// The largest of the coordinates of the root mean square of a difference, without the mean, in its unit; in the order of a change of
    /// an extreme.
    fn distance(&self, units: &[f64], difference: impl Fn(&Self, usize) -> f64) -> f64 {
        let fine = self.balance.length();
        let sizes = units.iter().enumerate().map(|(coordinate, unit)| {
            let entries = coordinate * fine + 1..(coordinate + 1) * fine;
            let square: f64 = entries.map(|index| difference(self, index).powi(2)).sum();
            square.sqrt() / unit
        });
        sizes.fold(0.0, f64::max)
    }
}
