//! Everything that is read off an orbit.

use crate::balance::Balance;
use crate::branch::{Orbit, Point};
use crate::continuation::problem::Problem;
use crate::newton::Newton;
use crate::observe::{Motion, Observed, Observer};
use crate::stability::judge::Judge;
use crate::stability::{Method, Stability};
use crate::truncation::{BEYOND, Finer};

/// Relative error of peak-to-peak that rounding leaves.
const ROUNDING: f64 = 1e-14;
/// A first coordinate that moves by less than this part of the largest motion is at rest beside it.
const STILL: f64 = 1e-6;
/// Roundings of the two extremes.
const EXTREMES: f64 = 4.0;

/// Reads orbits of one resolution.
#[derive(Debug)]
pub(crate) struct Reader<'a> {
    pub(crate) finer: Finer<'a>,
    pub(crate) judge: Option<Judge>,
    observer: Observer,
    /// What errors of the coordinates are measured by.
    units: Vec<f64>,
    /// The error is wanted, whether or not the stability is.
    estimate: bool,
    /// What rounding of the equations makes of the last orbit, relative to its peak-to-peak, where that exceeds the tolerance of Newton's
    /// method; zero otherwise.
    pub(crate) rounding: f64,
}

impl<'a> Reader<'a> {
    pub(crate) fn new(finer: Finer<'a>, stability: Option<Method>, estimate: bool) -> Self {
        Self {
            finer,
            judge: stability.map(Judge::new),
            observer: Observer::default(),
            units: Vec::new(),
            estimate,
            rounding: 0.0,
        }
    }

    /// Everything that is read off a solution, whose factors Newton's method holds.
    pub(crate) fn read(
        &mut self,
        balance: &mut Balance<'_>,
        newton: &mut Newton,
        u: &[f64],
    ) -> Point {
        let n = balance.unknowns();
        balance.set(u[n]);
        let wanted = self.estimate || self.judge.is_some();
        let corrected = wanted && self.finer.correct(u, newton);
        let stability = self
            .judge
            .as_mut()
            .map_or_else(Stability::unknown, |judge| {
                judge.stability(balance, corrected.then_some(&self.finer), u)
            });
        let orbit = Orbit {
            series: u[..n].to_vec(),
            coordinates: balance.layout().coordinates,
            omega: balance.omega(),
            base: balance.base(),
            period: balance.resolution().period,
        };
        let observed = self.observer.observe(balance, u);
        let error = wanted.then(|| {
            if corrected {
                self.error(&observed, balance, u, newton)
            } else {
                f64::INFINITY
            }
        });
        Point {
            value: u[n],
            parameters: balance.parameters().to_vec(),
            orbit,
            stability,
            observed,
            error,
        }
    }

    /// Largest change of a coordinate's peak-to-peak by the correction, by what Newton's method left, and by rounding of its extremes:
    /// of the first coordinate relative to its own, of the others to the largest.
    fn error(
        &mut self,
        observed: &Observed,
        balance: &Balance<'_>,
        u: &[f64],
        newton: &mut Newton,
    ) -> f64 {
        // Of the orbit itself, before the correction is computed.
        let (left, rounding) = (newton.left_in_oscillation(), newton.rounding_size());
        let largest = |of: fn(&Motion) -> f64| observed.motions.iter().map(of).fold(0.0, f64::max);
        let size = largest(Motion::peak_to_peak);
        self.units.clear();
        if size == 0.0 {
            self.units.resize(observed.motions.len(), 1.0);
            return self.truncation(balance, u, newton) + left;
        }
        self.units.resize(observed.motions.len(), size);
        self.units[0] = observed.motions[0].peak_to_peak().max(STILL * size);
        let truncation = self.truncation(balance, u, newton);
        // From a mean square over coordinates to the peak-to-peak of one of them.
        let peak = 2.0 * (2.0 * observed.motions.len() as f64).sqrt();
        self.rounding = peak * rounding / self.units[0];
        let farthest = largest(|motion| motion.maximum.abs().max(motion.minimum.abs()));
        let extremes = EXTREMES * f64::EPSILON * farthest;
        truncation + (peak * left + extremes) / self.units[0] + ROUNDING
    }

    /// The part of the harmonics that were left out, each coordinate in its unit.
    ///
    /// Where a law is too sharp for the series, and for the correction with it, an orbit closed by integration tells.
    fn truncation(&mut self, balance: &Balance<'_>, u: &[f64], newton: &mut Newton) -> f64 {
        let units = &self.units;
        let phases = self.observer.phases();
        let correction = BEYOND * self.finer.peak_to_peak_error(u, phases, units, newton);
        let judge = self.judge.as_ref();
        let refined = judge.and_then(|judge| judge.refined.as_ref());
        let series = &u[..balance.unknowns()];
        refined
            .and_then(|refined| refined.peak_to_peak_error(balance, series, phases, units))
            .unwrap_or(correction)
    }
}
