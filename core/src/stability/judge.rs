//! The verdict on one orbit: multipliers, and how far they can be trusted.
//!
//! Two errors are estimated: that of the method, by the method itself; and that of the orbit, by the change of the multipliers
//! when the orbit is corrected for what its harmonics and samples leave out ([`truncation`](crate::truncation)). The
//! multipliers given are those of the corrected orbit.

use std::time::Instant;

use super::method::{Floquet, Found};
use super::orbit::Orbit;
use super::{Answer, Method, Stability, distance};
use crate::balance::Balance;
use crate::truncation::{Finer, NOTHING};

/// Error of the method that is aimed at by default, and when it is asked for by name.
const TOLERANCE: f64 = 1e-6;
const TIGHT: f64 = 1e-10;
/// The same, as a part of the error of the orbit; and the part that is accepted.
const PART: f64 = 0.3;
const ACCEPTED: f64 = 1.0;
/// A first attempt may miss the error aimed at by this factor.
const LENIENCE: f64 = 3.0;
/// An orbit that its correction changes by more than this part of its size is not known well enough for a verdict: the change of
/// the multipliers is proportional to their error for small corrections only.
const FAR: f64 = 0.1;
/// The same, as a part of the distance from a verdict's boundary, and at least.
const MARGIN: f64 = 0.1;
const LEAST: f64 = 1e-11;

/// Judges the orbits of one branch, one after the other.
#[derive(Debug)]
pub(crate) struct Judge {
    method: Method,
    engine: Box<dyn Floquet>,
    /// Error of the method that is aimed at.
    tolerance: f64,
    /// Error of the method that sufficed for the last orbit.
    aim: f64,
    /// Orbits judged.
    pub(crate) computed: usize,
}

impl Judge {
    pub(crate) fn new(method: Method) -> Self {
        let tolerance = if method == Method::Default {
            TOLERANCE
        } else {
            TIGHT
        };
        Self {
            method,
            engine: method.engine(),
            tolerance,
            aim: tolerance,
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
        let started = Instant::now();
        self.computed += 1;
        let orbit = Orbit::of(balance, &u[..u.len() - 1]);
        let plain;
        let corrected = match finer {
            None => {
                plain = self.engine.multipliers(&orbit, self.aim);
                None
            }
            Some(finer) if self.engine.knows_its_error() && finer.change() <= NOTHING => {
                let by_truncation = |_: &Found| finer.change();
                plain = self.sharp(&orbit, by_truncation);
                Some((plain.clone(), finer.change()))
            }
            Some(finer) => {
                plain = self.engine.multipliers(&orbit, LENIENCE * self.aim);
                let orbit = Orbit::of(finer.balance(), finer.series());
                let by_truncation = |found: &Found| {
                    if finer.change() > FAR {
                        return f64::INFINITY;
                    }
                    distance(&plain.multipliers, &found.multipliers)
                };
                let corrected = self.sharp(&orbit, by_truncation);
                let by_truncation = by_truncation(&corrected);
                Some((corrected, by_truncation))
            }
        };
        let known = |found: &Found| !found.multipliers.is_empty();
        let corrected = corrected.filter(|(found, _)| known(found) && known(&plain));
        let bound = corrected
            .as_ref()
            .map_or(plain.bound, |(found, _)| found.bound);
        let (by_method, by_truncation, stability) = if let Some((found, by_truncation)) = corrected
        {
            let stability = Stability::of(found.multipliers, found.error + by_truncation);
            (found.error, by_truncation, stability)
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
            bound,
            cost: self.engine.cost(),
            elapsed: started.elapsed(),
        }
    }

    /// Multipliers so exact that the method adds little to the error of the orbit, and does not stand between the largest of
    /// them and a verdict.
    fn sharp(&mut self, orbit: &Orbit<'_>, by_truncation: impl Fn(&Found) -> f64) -> Found {
        let found = self.engine.multipliers(orbit, LENIENCE * self.aim);
        let Some(largest) = found.multipliers.first() else {
            return found;
        };
        let by_truncation = by_truncation(&found);
        let margin = (largest.norm() - 1.0).abs();
        let part = |part: f64| self.tolerance.max(part * by_truncation.min(1.0));
        let (aim, accepted) = (part(PART), part(ACCEPTED));
        self.aim = aim;
        let wanted = if margin > found.error + by_truncation {
            accepted
        } else {
            aim.min(MARGIN * margin).max(LEAST)
        };
        if found.error <= wanted || !self.engine.knows_its_error() {
            return found;
        }
        self.engine.multipliers(orbit, wanted)
    }
}
