//! Everything that is read off an orbit.

use super::output_error::OfCoordinates;
use crate::balance::Balance;
use crate::balance::truncation::{BEYOND, RefinedBalance};
use crate::branches::observed::EXTREMES;
use crate::branches::orbit::Orbit;
use crate::branches::point::Point;
use crate::continuation::follow::CurvePoint;
use crate::continuation::newton::Newton;
use crate::continuation::problem::Problem;
use crate::numeric::fourier::series;
use crate::numeric::spectrum::distance;
use crate::orbit::observe::{Accuracy, Motion, Observed, Observer};
use crate::orbit::stability::judge::Judge;
use crate::orbit::stability::{Method, Stability};

/// Relative error of peak-to-peak that rounding leaves.
pub(super) const ROUNDING: f64 = 1e-14;
/// A first coordinate that moves by less than so many times what is left of the equations, and rounding, is at rest.
const STILL: f64 = 10.0;
/// An error of so many times what rounding makes of an update is due to it.
const ROUNDINGS: f64 = 100.0;
/// A branch less steep than this is at a fold that was located.
const FOLD: f64 = 1e-6;
/// Beside a fold it is less steep than this.
const BESIDE: f64 = 0.1;
/// Multipliers change by at most so much along a unit of the branch, as far as their stated error is asked to tell.
const STEEPEST: f64 = 30.0;

/// Reads orbits of one resolution.
#[derive(Debug)]
pub(crate) struct PointEvaluator<'a> {
    pub(crate) finer: RefinedBalance<'a>,
    pub(crate) judge: Option<Judge>,
    pub(super) observer: Observer,
    /// What errors of the coordinates are measured by.
    pub(super) units: Vec<f64>,
    pub(super) tangent: Vec<f64>,
    beside_fold: bool,
    /// The last error, without what lies along the branch: near a fold no harmonics take that away soon.
    pub(crate) across: f64,
    /// The error is wanted, whether or not the stability is.
    estimate: bool,
    /// What it is of.
    accuracy: Accuracy,
    /// What rounding of the equations makes of the last orbit, relative to its peak-to-peak, where that exceeds the tolerance of Newton's
    /// method; zero otherwise.
    pub(crate) rounding: f64,
}

impl<'a> PointEvaluator<'a> {
    pub(crate) fn new(
        finer: RefinedBalance<'a>,
        stability: Option<Method>,
        estimate: bool,
        accuracy: Accuracy,
    ) -> Self {
        Self {
            finer,
            judge: stability.map(Judge::new),
            observer: Observer::default(),
            units: Vec::new(),
            tangent: Vec::new(),
            beside_fold: false,
            across: f64::INFINITY,
            estimate,
            accuracy,
            rounding: 0.0,
        }
    }

    /// The part of an error of the last orbit that harmonics take away: none of what rounding leaves.
    pub(crate) fn by_harmonics(&self, error: f64) -> f64 {
        if error <= ROUNDINGS * self.rounding {
            0.0
        } else {
            error
        }
    }

    /// Everything that is read off a solution, whose factors Newton's method holds; given as a point of its branch where that is known.
    pub(crate) fn read(
        &mut self,
        balance: &mut Balance<'_>,
        newton: &mut Newton,
        u: &[f64],
        at: Option<&CurvePoint>,
    ) -> Point {
        let n = balance.unknowns();
        balance.set(u[n]);
        let wanted = self.estimate || self.judge.is_some();
        let corrected = wanted && self.finer.correct(u, newton);
        let shift = if corrected {
            self.shift(u, newton, at)
        } else {
            0.0
        };
        let stability = self.stability(balance, corrected, u, shift);
        let recurrence = balance
            .resolution()
            .recurrence(balance.layout().coordinates);
        let orbit = Orbit {
            series: u[..n].to_vec(),
            coordinates: balance.layout().coordinates,
            omega: balance.omega(),
            base: balance.base(),
            period: balance.resolution().period,
            states: Vec::new(),
            parts: recurrence.parts,
            symmetric: recurrence.image.is_minus(),
            image: recurrence.image,
        };
        let observed = self.observer.observe(balance, u);
        self.across = f64::INFINITY;
        let error = wanted.then(|| {
            if corrected {
                self.error(&observed, balance, u, newton, shift)
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
    /// of the first coordinate relative to its own, of the others to the largest. The same of one signal alone, where accuracy is asked
    /// of that.
    fn error(
        &mut self,
        observed: &Observed,
        balance: &mut Balance<'_>,
        u: &[f64],
        newton: &mut Newton,
        shift: f64,
    ) -> f64 {
        // Of the orbit itself, before the correction is computed.
        let (left, rounding) = (newton.left_in_oscillation(), newton.rounding_size());
        let largest = |of: fn(&Motion) -> f64| observed.motions.iter().map(of).fold(0.0, f64::max);
        let size = largest(Motion::peak_to_peak);
        self.units.clear();
        if size == 0.0 {
            self.units.resize(observed.motions.len(), 1.0);
            self.across = self.truncation(balance, u, newton) + left;
            return self.across;
        }
        self.units.resize(observed.motions.len(), size);
        // From a mean square over coordinates to the peak-to-peak of one of them.
        let peak = 2.0 * (2.0 * observed.motions.len() as f64).sqrt();
        let farthest = largest(|motion| motion.maximum.abs().max(motion.minimum.abs()));
        let extremes = EXTREMES * f64::EPSILON * farthest;
        let unit = self.take_units(observed, size, STILL * (peak * left + extremes));
        // An orbit closed by integration is at this very value.
        let refined = self.judge.as_ref().and_then(|judge| judge.refined.as_ref());
        let shift = if refined.is_some() { 0.0 } else { shift };
        let truncation = self.truncation(balance, u, newton);
        if let Accuracy::Output(output) = self.accuracy {
            let of_coordinates = OfCoordinates {
                truncation,
                left: peak * left / unit,
                rounding: peak * rounding / unit,
                shift,
            };
            let motion = &observed.outputs[output];
            return self.error_of_output(output, motion, balance, u, of_coordinates);
        }
        self.rounding = peak * rounding / unit;
        self.across = truncation + (peak * left + extremes) / unit + ROUNDING;
        self.across + self.along(shift, u.len() - 1)
    }

    /// Takes the units of the coordinates, of which the largest has this size, and returns that of what the error is of. What moves by no
    /// more than `still` is at rest, and measured by the largest.
    fn take_units(&mut self, observed: &Observed, size: f64, still: f64) -> f64 {
        let (named, alone) = match self.accuracy {
            Accuracy::Coordinates => (0, false),
            Accuracy::Coordinate(index) => (index, true),
            Accuracy::Output(_) => return size,
        };
        let own = observed.motions[named].peak_to_peak();
        let unit = if own > still { own } else { size };
        if alone {
            // The others do not count.
            self.units.fill(f64::INFINITY);
        }
        self.units[named] = unit;
        unit
    }

    /// The stability of a solution. The multipliers of the corrected orbit, which lies across the branch, are those of another value, and
    /// beside a fold they change with it as its root does: they are taken where the tangent leads back to this very value.
    fn stability(
        &mut self,
        balance: &Balance<'_>,
        corrected: bool,
        u: &[f64],
        shift: f64,
    ) -> Stability {
        let Self {
            judge,
            finer,
            tangent,
            beside_fold,
            ..
        } = self;
        let Some(judge) = judge else {
            return Stability::unknown();
        };
        if shift != 0.0 {
            finer.move_along(u, tangent, -shift);
        }
        let mut stability = judge.stability(balance, corrected.then_some(finer), u);
        if shift != 0.0 {
            finer.move_along(u, tangent, shift);
            let counts = STEEPEST * shift.abs() > stability.error;
            if *beside_fold && counts && judge.refined.is_none() {
                // What lies across the branch and what lies along it may cancel, and are taken by their sizes.
                let (across, error) = judge.beside(finer, stability.error);
                let along = distance(&across, &stability.multipliers) + error;
                stability = Stability::of(stability.multipliers, stability.error + along);
            }
        }
        stability.beside(balance.rigid())
    }

    /// How far along the tangent of the branch the corrected orbit, which lies across the branch, is from this very value. Not at a fold,
    /// where there is no such way; its own error says where it lies.
    /// Factors of the solution before the last update tell the tangent only where it hardly changes.
    fn shift(&mut self, u: &[f64], newton: &mut Newton, at: Option<&CurvePoint>) -> f64 {
        let n = u.len() - 1;
        self.tangent.resize(u.len(), 0.0);
        let slope = if let Some(at) = at {
            self.tangent.copy_from_slice(&at.tangent);
            at.parameter_slope().abs()
        } else {
            newton.direction(&mut self.tangent)
        };
        self.beside_fold = slope < BESIDE;
        if slope < FOLD {
            return 0.0;
        }
        let corrected = self.finer.extended().last();
        corrected.map_or(0.0, |value| value - u[n]) / self.tangent[n]
    }

    /// What the peak-to-peak of the orbit at this very value differs from that of the corrected one: to first order, by the slope of the
    /// branch with so many unknowns.
    fn along(&self, shift: f64, unknowns: usize) -> f64 {
        if shift == 0.0 {
            return 0.0;
        }
        let length = unknowns / self.units.len();
        let moved = |coordinate: usize, phase: f64| {
            let series = &self.tangent[coordinate * length..][..length];
            series::value_and_derivatives(series, phase).0
        };
        let coordinates = self.observer.phases().iter().zip(&self.units).enumerate();
        let changes = coordinates.map(|(coordinate, (&[low, high], unit))| {
            (moved(coordinate, high) - moved(coordinate, low)).abs() / unit
        });
        shift.abs() * changes.fold(0.0, f64::max)
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
        let orbit = &u[..balance.unknowns()];
        refined
            .and_then(|refined| refined.peak_to_peak_error(balance, orbit, phases, units))
            .unwrap_or(correction)
    }
}
