//! What the reduction changes of Floquet multipliers at an orbit, and what verdict that leaves of the whole structure.
//!
//! A multiplier `mu = exp(s T)` is off by `|mu| (exp(|ds| T) - 1)` where the exponent changes by `ds` ([`crate::exponent`]), to first order. What
//! is left out by that is of the second order, `|ds|` times the part of what a mode keeps its forces up by that the error of the
//! compliance makes: it is added. A verdict needs less than `ds`: compliances turn multipliers, and leave their size alone unless they are in
//! resonance. So it is the real part of `ds` that counts there, with all of what is of the second order, of damping and of other orbits.
//!
//! Modes that are mostly of vectors besides modes stand for modes that are left out, which have other frequencies: no multiplier of the whole
//! structure need be where theirs are. They count in the verdict, to first order: where such a mode grows by a resonance of its own, the
//! compliance that it makes is all error, and `ds` at least what it grows and is damped by.

use std::f64::consts::TAU;

use hertzian::{Branch, Cancel, Complex, Point, Stability, Verdict};

use crate::at_orbit::AtOrbit;
use crate::description::damping::Damping;
use crate::description::structure::SparseStructure;
use crate::doubt;
use crate::exponent::{self, Change, Contacts};
use crate::floquet::{Mode, Propagation};
use crate::gaps::TIMES;
use crate::reduced::{Reduced, ReducedError};

/// Multipliers below this are not looked at, except the largest.
const LEAST: f64 = 0.1;
/// The mode of another multiplier, by this part of it or of the distance to the next one, is not the mode that was asked for.
const APART: [f64; 2] = [0.1, 0.5];
/// A mode that has more of it in vectors besides modes is none of the whole structure.
const MOSTLY: f64 = 0.5;
/// So many harmonics of those that there are tell of a vector.
const RESOLVED: f64 = 0.75;
/// Multipliers of a pair differ by rounding.
const SAME: f64 = 1e-9;
/// An orbit over more periods of the excitation than this is not resolved.
const MOST_PERIODS: f64 = 2.5;
/// A first order says nothing of exponents that change by more than this in a period.
const FIRST_ORDER: f64 = 1.0;

/// What the reduction changes of the stability of an orbit.
///
/// Source: the change of a characteristic exponent to first order is that of Yakubovich and Starzhinskii (1975), Linear Differential Equations
/// with Periodic Coefficients, chapter IV.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct ReducedStability {
    /// Whether small perturbations of the orbit of the whole structure die out: undecided where multipliers, to what is known of them as
    /// those of the whole structure, may lie on either side of the unit circle. Modes that are left out altogether are taken to be damped:
    /// without damping nothing is stable. Above 300 coordinates compliances are interpolated between frequencies, and a verdict is as good
    /// as that.
    pub verdict: Verdict,
    /// How far from each of the orbit's [multipliers](hertzian::Stability::multipliers), in their order, one of the whole structure is at
    /// most: to first order, without unit, beside their own error. Those below 0.1 are not looked at, unless they are the largest. Infinite
    /// where there is no bound: that is so of modes that are made of vectors besides modes, where the first order says nothing, where
    /// multipliers lie next to each other, where the mode is not resolved by 128 times of the period, of orbits over more than two periods, and
    /// of all with more than 60 vectors. Multipliers beyond the end of this list are those below 0.1, and of 130 states or more those that the orbit does not list.
    pub errors: Vec<f64>,
}

impl Reduced {
    /// What the reduction changes of Floquet multipliers at an orbit of a branch of it, and the verdict on the whole structure.
    ///
    /// ```
    /// use hertzian::{FrequencyResponse, Verdict};
    /// use hertzian_structure::{
    ///     Damping, Direction, Load, Reduction, SparseContact, SparseMatrix, SparseStructure,
    /// };
    ///
    /// // Two masses on three springs; the first one meets another spring.
    /// let of = |own: f64, beside: f64| {
    ///     let entries = [(0, 0, own), (0, 1, beside), (1, 0, beside), (1, 1, own)];
    ///     SparseMatrix::from_triplets(2, 2, entries)
    /// };
    /// let law = hertzian::generic::law_from_text("Stop(gap, k) { gap > 0 => k*gap, else => 0 }")?;
    /// let stop = SparseContact::new("stop", law, Direction::at(0));
    /// let structure = SparseStructure::new(of(1.0, 0.0)?, of(2.0, -1.0)?)
    ///     .damping(Damping::ratio(0.05))
    ///     .load(Load::force(Direction::at(1), 0.1))
    ///     .contact(stop.arguments([0.2]).offset(0.1))
    ///     .output("first", Direction::at(0));
    /// // One mode of the two.
    /// let reduced = Reduction::to(1.2).modes(1).steps(0).run(&structure)?;
    /// let model = reduced.structure(&structure)?;
    /// let branch = FrequencyResponse::of(&model).from(0.8).to(1.2).run()?;
    /// let stability = reduced.stability_at(&structure, &branch, &branch.points[0])?;
    /// assert_eq!(stability.verdict, Verdict::Stable);
    /// assert!(stability.errors[0] < 0.1);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Errors
    /// If it is a reduction of [another structure](Self::is_of), or the orbit cannot be read.
    pub fn stability_at(
        &self,
        structure: &SparseStructure,
        branch: &Branch,
        point: &Point,
    ) -> Result<ReducedStability, ReducedError> {
        self.effects(structure, branch).stability(point)
    }

    /// The same, unless it is cancelled.
    pub(crate) fn stability_until(
        &self,
        structure: &SparseStructure,
        at: &AtOrbit<'_>,
        point: &Point,
        cancel: &Cancel,
    ) -> Result<ReducedStability, ReducedError> {
        let multipliers = &point.stability.multipliers;
        let modes = self.floquet_modes(at, point, cancel);
        let near = modes.iter().flatten();
        let near = near.flat_map(|mode| exponent::frequencies(mode, at.base));
        let measured = at.measured.measured(structure, near, cancel)?;
        let contacts = Contacts::of(self, at);
        let period = TAU / at.base;
        // Where nothing is left out vectors besides modes are modes too.
        let kept = if self.vectors() == self.coordinates {
            self.vectors()
        } else {
            self.modes()
        };
        let mut whole: Vec<Known> = Vec::with_capacity(modes.len());
        for (index, mode) in modes.iter().enumerate() {
            if cancel.is_cancelled() {
                return Err(ReducedError::Cancelled);
            }
            whole.push(match mode {
                Some(mode) => {
                    let change = contacts.change(self, at, &measured, mode);
                    let stands = mode.share(|vector| vector >= kept) > MOSTLY;
                    let mu = multipliers[index];
                    let apart = others(point, index).map(|other| (mu / other).ln().norm());
                    let apart = apart.fold(f64::INFINITY, f64::min);
                    Known::of(&change, mu.norm(), [period, apart], stands)
                }
                None if is_second(multipliers, index) => whole[index - 1],
                None => Known::NOTHING,
            });
        }
        let left_out = self.vectors() < self.coordinates;
        let verdict = match verdict(point, &whole) {
            Verdict::Stable if left_out && is_undamped(&structure.damping) => Verdict::Undecided,
            other => other,
        };
        Ok(ReducedStability {
            verdict,
            errors: whole.iter().map(|known| known.error).collect(),
        })
    }

    /// Modes of the multipliers that matter, of a pair that of the first one; none where it is not resolved, or when it is cancelled.
    fn floquet_modes(&self, at: &AtOrbit<'_>, point: &Point, cancel: &Cancel) -> Vec<Option<Mode>> {
        let multipliers = &point.stability.multipliers;
        let many = multipliers.iter().take_while(|mu| mu.norm() >= LEAST);
        let count = many.count().max(1).min(multipliers.len());
        let damping = doubt::damping(self, &at.speeds);
        let means: Vec<_> = at.gaps.iter().map(|gap| gap.means([0.0; 2])).collect();
        // A period of many periods of the excitation has too few times in each.
        let is_resolved = point.omega() <= MOST_PERIODS * at.base;
        let propagation = is_resolved
            .then(|| Propagation::of(self, &damping, &means, &at.arms, at.base, cancel))
            .flatten();
        let of = |index: usize| {
            if is_second(multipliers, index) || cancel.is_cancelled() {
                return None;
            }
            let mode = propagation.as_ref()?.mode(multipliers[index])?;
            let fastest = RESOLVED * 0.5 * TIMES as f64 * at.base;
            let fast = mode.share(|vector| self.squares[vector] > fastest * fastest);
            (is_of(&mode, point, index) && fast <= MOSTLY).then_some(mode)
        };
        (0..count).map(of).collect()
    }
}

/// Whether a multiplier is the second one of a pair.
fn is_second(multipliers: &[Complex<f64>], index: usize) -> bool {
    let first = index.checked_sub(1).map(|first| multipliers[first]);
    let mu = multipliers[index];
    mu.im != 0.0
        && first.is_some_and(|first| (first - mu.conj()).norm() <= SAME * mu.norm())
        && (index < 2 || !is_second(multipliers, index - 1))
}

/// All multipliers but one, with those of motions that nothing holds, which are not among the others.
fn others(point: &Point, index: usize) -> impl Iterator<Item = Complex<f64>> {
    let Stability {
        multipliers, rigid, ..
    } = &point.stability;
    let all = multipliers.iter().enumerate();
    let all = all.filter(move |(i, _)| *i != index).map(|(_, mu)| *mu);
    all.chain(std::iter::repeat_n(Complex::new(1.0, 0.0), *rigid))
}

/// Whether a mode is that of a multiplier.
fn is_of(mode: &Mode, point: &Point, index: usize) -> bool {
    let known = point.stability.multipliers[index];
    let next = others(point, index).map(|other| (other - known).norm());
    let next = next.fold(f64::INFINITY, f64::min);
    let apart = (mode.multiplier - known).norm();
    apart <= APART[0] * known.norm() && apart <= APART[1] * next
}

/// What is known of a multiplier as one of the whole structure.
#[derive(Debug, Clone, Copy)]
struct Known {
    /// How far it may be from where it is.
    error: f64,
    /// The least and the largest size that it may have.
    sizes: [f64; 2],
}

impl Known {
    const NOTHING: Self = Self {
        error: f64::INFINITY,
        sizes: [0.0, f64::INFINITY],
    };

    /// Of this size, where the exponent changes, and where the mode may stand for others. Exponents times the period that are `apart` by no more
    /// than twice what they change by may meet, and part as a root.
    fn of(change: &Change, size: f64, [period, apart]: [f64; 2], stands: bool) -> Self {
        let (mut by, mut growth) = if stands {
            (f64::INFINITY, change.first_growth() * period)
        } else {
            (change.most() * period, change.growth() * period)
        };
        if growth.is_nan() || by.is_nan() || !stands && by > FIRST_ORDER.min(0.5 * apart) {
            return Self::NOTHING;
        }
        if !stands && by > 0.0 {
            // Of the second order, by the mode that is the nearest.
            let second = by * by / (apart - by);
            by += second;
            growth += second;
        }
        let least = if stands { 0.0 } else { size * (-growth).exp() };
        Self {
            error: size * by.exp_m1(),
            sizes: [least, size * growth.exp()],
        }
    }
}

/// Whether modes that are left out have no damping.
fn is_undamped(damping: &Damping) -> bool {
    match damping {
        Damping::None => true,
        Damping::Rayleigh { mass, stiffness } => *mass <= 0.0 && *stiffness <= 0.0,
        _ => false,
    }
}

/// What all multipliers allow.
fn verdict(point: &Point, whole: &[Known]) -> Verdict {
    let own = point.stability.error;
    if whole.is_empty() || point.stability.verdict == Verdict::Undecided {
        Verdict::Undecided
    } else if whole.iter().any(|known| known.sizes[0] - own > 1.0) {
        Verdict::Unstable
    } else if whole.iter().all(|known| known.sizes[1] + own < 1.0) {
        Verdict::Stable
    } else {
        Verdict::Undecided
    }
}
