//! Multipliers of one orbit as exactly as its verdict needs them, and how far they can be trusted. The verdict that follows from both is
//! `Stability::of` in `branches/stability.rs`.
//!
//! Two errors are estimated: that of the method, by the method itself; and that of the orbit, by the change of the multipliers
//! when the orbit is corrected for what its harmonics and samples leave out ([`truncation`](crate::balance::truncation)). The
//! multipliers given are those of the corrected orbit.
//!
//! Of one coordinate the determinant hardly changes, so that the change is one number, that of the trace, which passes zero at
//! single orbits of a branch and says nothing there of the harmonics above `2 K`. The matrix `P` does not stop changing there. So
//! the truncation is taken to leave at least what a part of the change of the matrix could do to the multipliers,
//!
//! ```text
//! max( | lambda(P + dP) - lambda(P) |, max over signs | lambda(P +- b dP) - lambda(P) | ),    b = 1/2         (1)
//! ```
//!
//! where `b` is the part of the change by the harmonics from `K` to `2 K` that all above have, if it falls as `K^-1.6`. A method
//! without a matrix has only the first.

use std::time::Instant;

use nalgebra::{Complex, DMatrix};

use super::method::{Floquet, Found};
use super::orbit::Orbit;
use super::refined::{self, Refined};
use super::resting_gap::Rest;
use super::{Answer, Method, Stability};
use crate::balance::Balance;
use crate::balance::truncation::{BEYOND, NOTHING, RefinedBalance};
use crate::numeric::spectrum::spread;
use crate::numeric::spectrum::{distance, eigenvalues};

/// Error of the multipliers that is aimed at by default.
const TOLERANCE: f64 = 1e-6;
/// The same of a method that is asked for by name.
const TIGHT: f64 = 1e-10;
/// The same, in parts of the error that the orbit makes.
const PART: f64 = 0.3;
/// The part that is accepted.
const ACCEPTED: f64 = 1.0;
/// Error of a first attempt, in units of what is aimed at.
const LENIENCE: f64 = 3.0;
/// Change of an orbit by its correction, in parts of its size, beyond which it is not known well enough for a verdict: the change of the
/// multipliers is proportional to their error for small corrections only.
const FAR: f64 = 0.1;
/// Error that is aimed at, in parts of the distance from a verdict's boundary.
const MARGIN: f64 = 0.1;
/// The same, at least.
const LEAST: f64 = 1e-11;

/// (1), from the multipliers and matrices of both orbits.
fn by_truncation(plain: &Found, found: &Found) -> f64 {
    let change = distance(&plain.multipliers, &found.multipliers);
    let (before, after) = (&plain.matrix, &found.matrix);
    if before.len() != after.len() || after.is_empty() || found.multipliers.is_empty() {
        return change;
    }
    let part = |index: usize| (BEYOND - 1.0) * (after[index] - before[index]);
    let order = found.multipliers.len();
    let beyond = if order == 2 {
        spread(&found.multipliers, after, part)
    } else {
        // Those that the matrix has: it may have lost small ones.
        let multipliers = eigenvalues(&DMatrix::from_column_slice(order, order, after));
        spread(&multipliers, after, part)
    };
    change.max(beyond)
}

/// Judges the orbits of one branch, one after the other.
#[derive(Debug)]
pub(crate) struct Judge {
    method: Method,
    engine: Box<dyn Floquet>,
    /// What looks at orbits for a method without nodes.
    sentinel: Option<Box<dyn Floquet>>,
    /// Error of the method that is aimed at.
    tolerance: f64,
    /// Error of the method that sufficed for the last orbit.
    aim: f64,
    rest: Rest,
    /// The last orbit, where it was closed by integration.
    pub(crate) refined: Option<Refined>,
    /// Orbits whose multipliers were computed.
    pub(crate) computed: usize,
}

/// What a judge takes over from one orbit to the next.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub(crate) struct Memory {
    #[cfg_attr(feature = "serde", serde(with = "crate::serialise"))]
    aim: f64,
    #[cfg_attr(feature = "serde", serde(with = "crate::serialise"))]
    pace: f64,
    #[cfg_attr(feature = "serde", serde(with = "crate::serialise"))]
    sentinel: Option<f64>,
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
            sentinel: None,
            tolerance,
            aim: tolerance,
            rest: Rest::default(),
            refined: None,
            computed: 0,
        }
    }

    /// What it takes over from one orbit to the next.
    pub(crate) fn memory(&self) -> Memory {
        Memory {
            aim: self.aim,
            pace: self.engine.pace(),
            sentinel: self.sentinel.as_ref().map(|sentinel| sentinel.pace()),
        }
    }

    /// As after an orbit that left this.
    pub(crate) fn remember(&mut self, memory: Memory) {
        if memory.aim > 0.0 {
            self.aim = memory.aim;
        }
        self.engine.keep_pace(memory.pace);
        if let Some(pace) = memory.sentinel {
            let mut sentinel = Method::Default.engine();
            sentinel.keep_pace(pace);
            self.sentinel = Some(sentinel);
        }
    }

    /// Stability of the orbit `u` of a balance that was set to its variable; `finer` holds it corrected, unless that failed.
    pub(crate) fn stability(
        &mut self,
        balance: &Balance<'_>,
        finer: Option<&RefinedBalance<'_>>,
        u: &[f64],
    ) -> Stability {
        self.answer(balance, finer, u).stability
    }

    /// The same, with where the error comes from and what it cost.
    pub(crate) fn answer(
        &mut self,
        balance: &Balance<'_>,
        finer: Option<&RefinedBalance<'_>>,
        u: &[f64],
    ) -> Answer {
        let started = Instant::now();
        self.computed += 1;
        let orbit = Orbit::of(balance, &u[..u.len() - 1]);
        self.refined = None;
        let rests = self.rest.on_a_level(&orbit);
        let (plain, corrected) = self.plain_and_corrected(&orbit, finer);
        let known = |found: &Found| !found.multipliers.is_empty();
        let corrected = if self.overlooks(balance, finer, u) {
            let series = finer.map_or(orbit.series, |finer| finer.series());
            let (found, refined) = refined::multipliers(balance, series).unzip();
            self.refined = refined;
            found.map(|found| (found, 0.0))
        } else {
            corrected.filter(|(found, _)| known(found) && known(&plain))
        };
        let corrected = corrected.filter(|_| !rests);
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
        // An orbit closed by integration is at the value itself.
        let moved = finer.filter(|_| self.refined.is_none());
        let moved = moved.and_then(|finer| finer.extended().last());
        Answer {
            method: self.method,
            stability: stability.beside(balance.rigid()),
            value: moved.copied().unwrap_or(u[u.len() - 1]),
            uncorrected: plain.multipliers,
            by_method,
            by_truncation,
            bound,
            cost: self.engine.cost(),
            elapsed: started.elapsed(),
        }
    }

    /// The multipliers of an orbit beside the one that was judged last, if the method can as exactly as this, and their error; none if that
    /// fails.
    pub(crate) fn beside(
        &mut self,
        finer: &RefinedBalance<'_>,
        exactly: f64,
    ) -> (Vec<Complex<f64>>, f64) {
        self.computed += 1;
        let orbit = Orbit::of(finer.balance(), finer.series());
        let tolerance = exactly.clamp(LEAST, LENIENCE * self.tolerance);
        let found = self.engine.multipliers(&orbit, tolerance);
        (found.multipliers, found.error)
    }

    /// Multipliers of an orbit as it is, and of the corrected one with what the truncation may leave in them.
    fn plain_and_corrected(
        &mut self,
        orbit: &Orbit<'_>,
        finer: Option<&RefinedBalance<'_>>,
    ) -> (Found, Option<(Found, f64)>) {
        let Some(finer) = finer else {
            return (self.engine.multipliers(orbit, self.aim), None);
        };
        if self.engine.knows_its_error() && finer.change() <= NOTHING {
            let plain = self.sharp(orbit, |_: &Found| finer.change());
            return (plain.clone(), Some((plain, finer.change())));
        }
        let corrected = Orbit::of(finer.balance(), finer.series());
        let (plain, found, by_truncation) = self.both([orbit, &corrected], finer.change() > FAR);
        (plain, Some((found, by_truncation)))
    }

    /// Whether a law changes between the nodes of the orbit where they do not see it; asked of the monodromy matrix if the method has
    /// no nodes.
    fn overlooks(
        &mut self,
        balance: &Balance<'_>,
        finer: Option<&RefinedBalance<'_>>,
        u: &[f64],
    ) -> bool {
        if self.engine.knows_its_error() {
            return self.engine.overlooks();
        }
        let sentinel = self
            .sentinel
            .get_or_insert_with(|| Method::Default.engine());
        let orbit = match finer {
            Some(finer) => Orbit::of(finer.balance(), finer.series()),
            None => Orbit::of(balance, &u[..u.len() - 1]),
        };
        sentinel.multipliers(&orbit, 1.0);
        sentinel.overlooks()
    }

    /// Multipliers of an orbit and of the corrected one, and what the truncation may leave in the latter; nothing is known of that
    /// if they are `far` from each other.
    fn both(&mut self, [orbit, corrected]: [&Orbit<'_>; 2], far: bool) -> (Found, Found, f64) {
        let error = |plain: &Found, found: &Found| {
            if far {
                f64::INFINITY
            } else {
                by_truncation(plain, found)
            }
        };
        let mut plain = self.engine.multipliers(orbit, LENIENCE * self.aim);
        let found = self.sharp(corrected, |found| error(&plain, found));
        // What sufficed for the orbit before may be too little for this one.
        if self.engine.knows_its_error() && plain.error > LENIENCE * self.aim {
            plain = self.engine.multipliers(orbit, self.aim);
        }
        let error = error(&plain, &found);
        (plain, found, error)
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
