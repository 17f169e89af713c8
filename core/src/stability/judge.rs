//! The verdict on one orbit: multipliers, and how far they can be trusted.
//!
//! Two errors are estimated: that of the method, by the method itself; and that of the orbit, by the change of the multipliers
//! when the orbit is corrected for what its harmonics and samples leave out ([`truncation`](crate::truncation)). The
//! multipliers given are those of the corrected orbit.

use super::method::{Floquet, Found};
use super::orbit::Orbit;
use super::{Answer, Method, Stability, distance};
use crate::balance::Balance;
use crate::truncation::Finer;

/// Error of the method that is aimed at.
const TOLERANCE: f64 = 1e-7;

/// Judges the orbits of one branch, one after the other.
#[derive(Debug)]
pub(crate) struct Judge {
    method: Method,
    engine: Box<dyn Floquet>,
    /// Orbits judged.
    pub(crate) computed: usize,
}

impl Judge {
    pub(crate) fn new(method: Method) -> Self {
        Self {
            method,
            engine: method.engine(),
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
        self.answer(balance, finer, u).stability
    }

    /// The same, with where the error comes from and what it cost.
    pub(crate) fn answer(
        &mut self,
        balance: &Balance<'_>,
        finer: Option<&Finer<'_>>,
        u: &[f64],
    ) -> Answer {
        self.computed += 1;
        let plain = Orbit::of(balance, &u[..u.len() - 1]);
        let plain = self.engine.multipliers(&plain, TOLERANCE);
        let corrected = finer.map_or(Found::NOTHING, |finer| {
            let orbit = Orbit::of(finer.balance(), finer.series());
            self.engine.multipliers(&orbit, TOLERANCE)
        });
        let known = !plain.multipliers.is_empty() && !corrected.multipliers.is_empty();
        let (by_method, by_truncation, stability) = if known {
            let by_truncation = distance(&plain.multipliers, &corrected.multipliers);
            let stability = Stability::of(corrected.multipliers, corrected.error + by_truncation);
            (corrected.error, by_truncation, stability)
        } else {
            let multipliers = plain.multipliers.clone();
            let stability = Stability {
                multipliers,
                ..Stability::unknown()
            };
            (plain.error, f64::INFINITY, stability)
        };
        Answer {
            method: self.method,
            stability,
            uncorrected: plain.multipliers,
            by_method,
            by_truncation,
            cost: self.engine.cost(),
        }
    }
}
