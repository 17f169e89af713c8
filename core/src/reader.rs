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

/// Reads orbits of one resolution.
#[derive(Debug)]
pub(crate) struct Reader<'a> {
    pub(crate) finer: Finer<'a>,
    pub(crate) judge: Option<Judge>,
    observer: Observer,
    /// The error is wanted, whether or not the stability is.
    estimate: bool,
}

impl<'a> Reader<'a> {
    pub(crate) fn new(finer: Finer<'a>, stability: Option<Method>, estimate: bool) -> Self {
        Self {
            finer,
            judge: stability.map(Judge::new),
            observer: Observer::default(),
            estimate,
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
                self.error(&observed, u, newton) + newton.left()
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

    /// Largest change of a coordinate's peak-to-peak by the correction, relative to the largest peak-to-peak.
    fn error(&mut self, observed: &Observed, u: &[f64], newton: &mut Newton) -> f64 {
        let phases = self.observer.phases();
        let change = self.finer.peak_to_peak_error(u, phases, newton);
        let sizes = observed.motions.iter().map(Motion::peak_to_peak);
        let size = sizes.fold(0.0, f64::max);
        if size > 0.0 {
            BEYOND * change / size + ROUNDING
        } else {
            BEYOND * change
        }
    }
}
