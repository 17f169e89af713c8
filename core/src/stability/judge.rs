//! The verdict on one orbit: multipliers, and how far they can be trusted.
//!
//! Two errors are estimated. That of the integration is the change of the multipliers when the steps are halved. That of
//! the orbit is their change when the orbit is corrected for what its harmonics and samples leave out
//! ([`truncation`](crate::truncation)).

use nalgebra::Complex;

use super::monodromy::{Orbit, Panels};
use super::{Stability, distance, eigenvalues};
use crate::balance::Balance;
use crate::continuation::problem::Scale;
use crate::layout::Layout;
use crate::newton::Newton;
use crate::truncation::Finer;

/// Steps per period at first.
const FIRST_DENSITY: f64 = 16.0;
/// Steps per period at most.
const LARGEST_DENSITY: f64 = 1024.0;
/// Error of the integration that is aimed at.
const INTEGRATION_TOLERANCE: f64 = 1e-7;

/// Judges the orbits of one branch, one after the other.
#[derive(Debug)]
pub(crate) struct Judge<'a> {
    finer: Finer<'a>,
    /// Steps per period that sufficed for the last orbit.
    density: f64,
    /// Orbits judged.
    pub(crate) computed: usize,
}

impl<'a> Judge<'a> {
    pub(crate) fn new(finer: Finer<'a>) -> Self {
        Self {
            finer,
            density: FIRST_DENSITY,
            computed: 0,
        }
    }

    /// Stability of the orbit `u` of a balance that was set to its variable; Newton's method holds its factors.
    pub(crate) fn stability(
        &mut self,
        balance: &Balance<'_>,
        newton: &mut Newton,
        u: &[f64],
        scale: Scale,
    ) -> Stability {
        self.computed += 1;
        let series = &u[..u.len() - 1];
        let Some(panels) = Panels::new(orbit_of(balance, balance.layout(), series)) else {
            return Stability::unknown();
        };
        let first = eigenvalues(&panels.monodromy(self.density));
        if first.is_empty() {
            return Stability::unknown();
        }
        let by_truncation = self.truncation(newton, u, scale, &first);
        let (multipliers, by_steps) = self.integrate(&panels, first, by_truncation);
        Stability::of(multipliers, by_steps + by_truncation)
    }

    /// Multipliers, and their change when the steps are halved; these are refined until that is small, or small compared
    /// with the error of the orbit.
    fn integrate(
        &mut self,
        panels: &Panels<'_>,
        mut fine: Vec<Complex<f64>>,
        by_truncation: f64,
    ) -> (Vec<Complex<f64>>, f64) {
        let mut coarse = eigenvalues(&panels.monodromy(0.5 * self.density));
        let wanted = INTEGRATION_TOLERANCE.max(0.05 * by_truncation.min(1.0));
        loop {
            let change = distance(&coarse, &fine);
            if change <= wanted || self.density >= LARGEST_DENSITY {
                // Steps that are far shorter than needed are lengthened for the next orbit.
                if change < 1e-3 * wanted && self.density > FIRST_DENSITY {
                    self.density *= 0.5;
                }
                return (fine, change);
            }
            self.density *= 2.0;
            coarse = std::mem::replace(&mut fine, eigenvalues(&panels.monodromy(self.density)));
        }
    }

    /// Change of the multipliers when the orbit is corrected.
    fn truncation(
        &mut self,
        newton: &mut Newton,
        u: &[f64],
        scale: Scale,
        multipliers: &[Complex<f64>],
    ) -> f64 {
        if !self.finer.correct(u, newton, scale) {
            return f64::INFINITY;
        }
        let balance = self.finer.balance();
        let corrected = orbit_of(balance, balance.layout(), self.finer.series());
        Panels::new(corrected).map_or(f64::INFINITY, |panels| {
            distance(&eigenvalues(&panels.monodromy(self.density)), multipliers)
        })
    }
}

fn orbit_of<'b>(balance: &'b Balance<'_>, layout: &'b Layout, series: &'b [f64]) -> Orbit<'b> {
    Orbit {
        system: balance.system(),
        layout,
        coefficients: balance.coefficients(),
        base: balance.base(),
        period: balance.resolution().period,
        series,
    }
}
