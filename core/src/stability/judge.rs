//! The verdict on one orbit: multipliers, and how far they can be trusted.
//!
//! Two errors are estimated. That of the integration is the change of the multipliers when the steps are halved. That of
//! the orbit is their change when the orbit is corrected for what its harmonics and samples leave out
//! ([`truncation`](crate::truncation)); the multipliers given are those of the corrected orbit.

use nalgebra::Complex;

use super::monodromy::{Orbit, Panels};
use super::{Stability, distance, eigenvalues};
use crate::balance::Balance;
use crate::layout::Layout;
use crate::truncation::Finer;

/// Steps per period at first.
const FIRST_DENSITY: f64 = 16.0;
/// Steps per period at most.
const LARGEST_DENSITY: f64 = 1024.0;
/// Error of the integration that is aimed at.
const INTEGRATION_TOLERANCE: f64 = 1e-7;

/// Judges the orbits of one branch, one after the other.
#[derive(Debug)]
pub(crate) struct Judge {
    /// Steps per period that sufficed for the last orbit.
    density: f64,
    /// Orbits judged.
    pub(crate) computed: usize,
}

impl Judge {
    pub(crate) fn new() -> Self {
        Self {
            density: FIRST_DENSITY,
            computed: 0,
        }
    }

    /// Stability of the orbit `u` of a balance that was set to its variable; `finer` holds it corrected, unless that failed.
    pub(crate) fn stability(
        &mut self,
        balance: &Balance<'_>,
        finer: Option<&Finer<'_>>,
        u: &[f64],
    ) -> Stability {
        self.computed += 1;
        let series = &u[..u.len() - 1];
        let plain = Panels::new(orbit_of(balance, balance.layout(), series))
            .map(|panels| eigenvalues(&panels.monodromy(self.density)))
            .filter(|multipliers| !multipliers.is_empty());
        let Some(plain) = plain else {
            return Stability::unknown();
        };
        let Some(finer) = finer else {
            return Stability {
                multipliers: plain,
                ..Stability::unknown()
            };
        };
        let balance = finer.balance();
        let corrected = orbit_of(balance, balance.layout(), finer.series());
        let Some(panels) = Panels::new(corrected) else {
            return Stability {
                multipliers: plain,
                ..Stability::unknown()
            };
        };
        let first = eigenvalues(&panels.monodromy(self.density));
        let by_truncation = distance(&plain, &first);
        let density = self.density;
        let refined = integrate(&panels, first, density, by_truncation);
        self.density = refined.next_density;
        Stability::of(refined.multipliers, refined.change + by_truncation)
    }
}

/// Multipliers that were refined until they hardly changed.
struct Refined {
    multipliers: Vec<Complex<f64>>,
    /// Their last change.
    change: f64,
    /// Steps per period to begin the next orbit with.
    next_density: f64,
}

/// Refines multipliers until halving the steps changes them little, or little compared with the error of the orbit.
fn integrate(
    panels: &Panels<'_>,
    mut fine: Vec<Complex<f64>>,
    mut density: f64,
    by_truncation: f64,
) -> Refined {
    let mut coarse = eigenvalues(&panels.monodromy(0.5 * density));
    let wanted = INTEGRATION_TOLERANCE.max(0.05 * by_truncation.min(1.0));
    loop {
        let change = distance(&coarse, &fine);
        if change <= wanted || density >= LARGEST_DENSITY {
            // Steps that are far shorter than needed are lengthened for the next orbit.
            let shorter = change < 1e-3 * wanted && density > FIRST_DENSITY;
            let next_density = if shorter { 0.5 * density } else { density };
            return Refined {
                multipliers: fine,
                change,
                next_density,
            };
        }
        density *= 2.0;
        coarse = std::mem::replace(&mut fine, eigenvalues(&panels.monodromy(density)));
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
