//! Everything that is read off an orbit.

use crate::balance::Balance;
use crate::branch::{Orbit, Point};
use crate::continuation::problem::Problem;
use crate::newton::Newton;
use crate::observe::{Observed, Observer};
use crate::stability::judge::Judge;
use crate::stability::{Method, Stability};
use crate::truncation::{BEYOND, Finer, NOTHING};

/// Reads orbits of one resolution.
#[derive(Debug)]
pub(crate) struct Reader<'a> {
    pub(crate) finer: Finer<'a>,
    pub(crate) judge: Option<Judge>,
    observer: Observer,
    /// Reads corrected orbits, which have more harmonics.
    fine: Observer,
    /// The error is wanted, whether or not the stability is.
    estimate: bool,
}

impl<'a> Reader<'a> {
    pub(crate) fn new(finer: Finer<'a>, stability: Option<Method>, estimate: bool) -> Self {
        Self {
            finer,
            judge: stability.map(Judge::new),
            observer: Observer::default(),
            fine: Observer::default(),
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
                self.error(&observed)
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
    fn error(&mut self, observed: &Observed) -> f64 {
        if self.finer.change() <= NOTHING {
            return self.finer.change();
        }
        let series = self.finer.series();
        let length = series.len() / observed.motions.len();
        let mut change = 0.0_f64;
        let mut size = 0.0_f64;
        for (motion, corrected) in observed.motions.iter().zip(series.chunks_exact(length)) {
            let corrected = self.fine.motion(corrected).peak_to_peak();
            change = change.max((corrected - motion.peak_to_peak()).abs());
            size = size.max(motion.peak_to_peak());
        }
        BEYOND * if size > 0.0 { change / size } else { change }
    }
}
