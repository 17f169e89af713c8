//! Where the slope of a force jumps although its gap stays on a piece, as that of `max(0, dot(gap))` does where the rate is zero, and where
//! it turns sharply, as that of `tanh(dot(gap)/w)` does there.
//!
//! Polynomials through nodes on both sides of such a kink converge slowly, and neither the orbit nor its multipliers tell by how much. So
//! panels end there. Since the force is continuous, an orbit depends on the place `p` of such an end as little as
//!
//! ```text
//! x(p) - x(p_0) = O((p - p_0)^2)                                                                               (1)
//! ```
//!
//! so that kinks need not be unknowns: they are located on an orbit that was found, by the sign of what the absolute value is taken of
//! ([`scales`](crate::laws::generic::scales)), and stay in their part of the way between two switches until they have moved far. Finer
//! equations, which tell the error, have them where the orbit has them. Two kinks between the same samples are not seen.
//!
//! A place that is sharp has a width `w` on the way ([`narrow`](crate::laws::generic::narrow)), and the force is analytic, with singularities
//! about as far from the place. Panels that grow with the distance from it,
//!
//! ```text
//! p - 4^j 2 w,    p + 4^j 2 w,    j = 0, 1, ..                                                                 (2)
//! ```
//!
//! are followed by polynomials of one degree equally well: each is no longer than three times its distance from the singularities. A place beside the way,
//! behind a switch or where the period begins, has its singularities as near to the polynomials on it, so that it counts as well: the
//! analytic motion of the way goes on there as the orbit does, but for what a switch changes. Nothing
//! depends on (2) but the error, so that ends stay until the place has moved by a part of them. Where it has moved farther, nodes are apart
//! by a part of that, and so is the place that the orbit by them has from where it should be: ends that are located anew, again and again,
//! close in on it.
//!
//! Source: Gear and Østerby (1984), Solving ordinary differential equations with discontinuities, ACM Transactions on Mathematical Software
//! 10, 23 (steps end where a derivative jumps); Trefethen (2013), Approximation Theory and Approximation Practice, chapter 8 (convergence by
//! the distance of singularities).

use std::f64::consts::TAU;

use super::gaps::Gaps;
use super::motion::Motion;
use crate::contact_equation::equations::Equations;
use crate::contact_equation::equations::setting::Setting;
use crate::contact_equation::linear_part::contact::Contact;
use crate::contact_equation::skeleton::Skeleton;
use crate::contact_equation::skeleton::interval::{Cut, Interval, Mark};
use crate::contact_equation::skeleton::placement::{APART, EDGE, Kink, MOST};
use crate::laws::generic::narrow::{Narrow, Way};
use crate::laws::generic::scales::Scales;
use crate::numeric::roots::{Place, root};

/// Samples in a period of the declaration, and at least in a way between two switches.
const SAMPLES: f64 = 200.0;
const LEAST: f64 = 24.0;
/// Accuracy of its part of the way: by (1) far more than enough.
const CLOSE: f64 = 1e-10;
/// Kinks of a way where slopes jump, at most, and samples from one to the next, at least on the mean.
const KINKS: usize = 32;
const FAR: usize = 6;
/// Operands smaller than this part of their largest value on a way are rounding.
const NOISE: f64 = 1e-9;
/// How wide places are at most where a law turns sharply, in parts of the way, and how many of them.
const NARROW: f64 = 0.02;
const PLACES: usize = 12;
/// Panels end so many widths from such a place, and farther by this factor, up to this part of the way, by (2); it may move by a part of that.
const WIDTHS: f64 = 2.0;
const FARTHER: f64 = 4.0;
const FARTHEST: f64 = 0.25;
const FREE: f64 = 0.25;

impl Equations {
    /// The same with more nodes, at an orbit: panels end at its kinks.
    pub(in crate::contact_equation) fn finer_at(&mut self, u: &[f64]) -> Option<Self> {
        self.compute(u, false);
        if !self.has_kinks() {
            return self.finer_equations(u[u.len() - 1]);
        }
        let kinks = self.kinks()?.to_vec();
        let values = self.setting.values(self.made)?;
        let system = self.setting.system.as_ref();
        let skeleton = self.skeleton.finer_with(system, &values, kinks);
        self.on(skeleton, u[u.len() - 1])
    }

    /// The same with panels that end at the kinks of an orbit.
    pub(in crate::contact_equation) fn at_kinks(&mut self, u: &[f64]) -> Option<Self> {
        self.compute(u, false);
        let kinks = self.kinks()?.to_vec();
        let values = self.setting.values(self.made)?;
        let system = self.setting.system.as_ref();
        self.on(self.skeleton.with(system, &values, kinks), self.made)
    }

    /// Unknowns, or changes of them, as those of [`Equations::finer_at`] or [`Equations::at_kinks`].
    pub(in crate::contact_equation) fn rearranged(&self, other: &Self, u: &[f64]) -> Vec<f64> {
        let same = self.skeleton.placement.kinks == other.skeleton.placement.kinks;
        if same && !self.has_kinks() {
            self.skeleton.interpolated(&other.skeleton, u)
        } else {
            self.skeleton.rearranged(&other.skeleton, u)
        }
    }

    /// Whether panels end at kinks, or would at those of the last pass.
    pub(in crate::contact_equation) fn has_kinks(&self) -> bool {
        let known = !self.skeleton.placement.kinks.is_empty();
        known || self.kinks().is_some_and(|kinks| !kinks.is_empty())
    }

    /// Where slopes of forces jump in the last pass, between switches; `None` where it has failed.
    pub(in crate::contact_equation) fn kinks(&self) -> Option<&[Kink]> {
        if self.failed {
            return None;
        }
        if !self.setting.may_have_ends(&self.values) {
            return Some(&[]);
        }
        let found = self.kinks.get_or_init(|| {
            let motion = Motion::of(self);
            let gaps = Gaps {
                values: &self.values,
                at: &|phase: f64, state: &mut [f64]| motion.at(phase, state),
                coordinates: self.values.linear.positions.nrows(),
            };
            kinks(&self.setting, &gaps, &self.skeleton, &self.last)
        });
        Some(found)
    }

    /// Whether kinks of the last pass are farther from where panels end than this part of a way.
    pub(in crate::contact_equation) fn has_moved_kinks(&self, most: f64) -> bool {
        let ends = &self.skeleton.placement.kinks;
        let same = |(a, b): (&Kink, &Kink)| {
            let most = if b.free > 0.0 { b.free } else { most };
            a.after == b.after && (a.part - b.part).abs() <= most
        };
        let are_there =
            |kinks: &[Kink]| ends.len() == kinks.len() && ends.iter().zip(kinks).all(same);
        self.kinks().is_some_and(|kinks| !are_there(kinks))
    }
}

/// Kinks of a motion, between the switches of a skeleton at these unknowns.
pub(in crate::contact_equation) fn kinks(
    setting: &Setting,
    gaps: &Gaps<'_>,
    skeleton: &Skeleton,
    u: &[f64],
) -> Vec<Kink> {
    let mut found = Vec::new();
    if !setting.may_have_ends(gaps.values) {
        return found;
    }
    for after in 0..=skeleton.switches.len() {
        let from = after.checked_sub(1).map_or(Cut::Begin, Cut::Switch);
        let to = if after < skeleton.switches.len() {
            Cut::Switch(after)
        } else {
            Cut::End
        };
        let [begin, end] = [from, to].map(|cut| skeleton.place(u, Mark::at(cut)).phase);
        let first = |interval: &&Interval| interval.from == Mark::at(from);
        let Some(interval) = skeleton.intervals.iter().find(first) else {
            continue;
        };
        if end <= begin {
            continue;
        }
        let between = Between {
            setting,
            gaps,
            interval,
            phases: [begin, end],
            whole: [from, to] == [Cut::Begin, Cut::End],
        };
        let bends = between.bends();
        let sharp = between.sharp();
        found.extend(between.ends(after, &bends, &sharp));
    }
    found
}

/// The way between two cuts.
struct Between<'b> {
    setting: &'b Setting,
    gaps: &'b Gaps<'b>,
    interval: &'b Interval,
    phases: [f64; 2],
    /// The orbit comes back where it ends.
    whole: bool,
}

impl Between<'_> {
    /// Gap and rate of a contact at a part of the way.
    fn gap(&self, contact: usize, part: f64) -> [f64; 2] {
        let [begin, end] = self.phases;
        self.gaps.gap(contact, begin + part * (end - begin))
    }

    /// Number of samples.
    fn samples(&self) -> usize {
        let [begin, end] = self.phases;
        (SAMPLES * (end - begin) / TAU).max(LEAST) as usize
    }

    /// Parts of the way where slopes jump, in their order.
    fn bends(&self) -> Vec<f64> {
        let mut parts = Vec::new();
        let samples = self.samples();
        for active in &self.interval.active {
            let contact = &self.gaps.values.contacts[active.contact];
            let Some(scales) = self.setting.kinked(contact.law, active.piece) else {
                continue;
            };
            let gap = |part: f64| self.gap(active.contact, part);
            add(scales, contact, active.piece, samples, gap, &mut parts);
        }
        parts.sort_by(f64::total_cmp);
        parts.dedup_by(|next, kept| *next - *kept < EDGE);
        // So many are the rounding of an operand that rests, which changes its sign from one sample to the next.
        if parts.len() > KINKS.min(samples / FAR) {
            parts.clear();
        }
        parts
    }

    /// Where forces turn sharply.
    fn sharp(&self) -> Vec<Narrow> {
        let mut found = Vec::new();
        for active in &self.interval.active {
            let Some(mut scales) = self.setting.sharp(self.gaps.values, active.contact) else {
                continue;
            };
            let contact = &self.gaps.values.contacts[active.contact];
            scales.set(&contact.arguments, &contact.levels);
            let at = |part: f64| {
                let [gap, rate] = self.gap(active.contact, part);
                [contact.held(active.piece, gap), rate]
            };
            // What comes back is beside itself.
            let beside = if self.whole { -EDGE } else { FARTHEST };
            let parts = (1.0 + 2.0 * beside) * self.samples() as f64;
            let way = Way {
                at: &at,
                range: [-beside, 1.0 + beside],
                parts: parts.ceil() as usize,
                widest: NARROW,
            };
            let mut own = Vec::new();
            scales.narrow_along(active.piece, way, &mut own);
            if own.len() > PLACES {
                own.retain(|place| (0.0..=1.0).contains(&place.at));
            }
            // So many of one contact are the rounding of an operand that rests.
            if own.len() <= PLACES {
                found.append(&mut own);
            }
        }
        found
    }

    /// Where panels end then: by (2) as far as no other place is nearer.
    fn ends(&self, after: usize, bends: &[f64], sharp: &[Narrow]) -> Vec<Kink> {
        let kink = |part: f64, free: f64| Kink { after, part, free };
        let mut ends: Vec<Kink> = bends.iter().map(|part| kink(*part, 0.0)).collect();
        let apart = |a: f64, b: f64| {
            let apart = (a - b).abs();
            if self.whole {
                apart.min(1.0 - apart)
            } else {
                apart
            }
        };
        for place in sharp {
            let first = WIDTHS * place.width;
            let reaches = std::iter::successors(Some(first), |reach| Some(FARTHER * reach));
            for reach in reaches.take_while(|reach| *reach < FARTHEST) {
                for part in [place.at - reach, place.at + reach] {
                    let part = if self.whole {
                        part.rem_euclid(1.0)
                    } else {
                        part
                    };
                    let others = sharp.iter().map(|other| other.at);
                    let mut others = others.chain(bends.iter().copied());
                    let nearest = others.all(|other| apart(other, part) >= (1.0 - CLOSE) * reach);
                    if nearest && (EDGE..=1.0 - EDGE).contains(&part) {
                        ends.push(kink(part, FREE * reach));
                    }
                }
            }
        }
        ends.sort_by(|a, b| a.part.total_cmp(&b.part));
        ends.dedup_by(|next, kept| next.part - kept.part < APART);
        if ends.len() > MOST {
            // Kinks come first.
            ends.retain(|end| end.free == 0.0);
        }
        ends
    }
}

/// Adds the parts of a way where an operand of a contact changes its sign.
fn add(
    mut scales: Scales,
    contact: &Contact,
    piece: usize,
    samples: usize,
    gap: impl Fn(f64) -> [f64; 2],
    parts: &mut Vec<f64>,
) {
    scales.set(&contact.arguments, &contact.levels);
    let gap = |part: f64| {
        let [value, rate] = gap(part);
        [contact.held(piece, value), rate]
    };
    let place = |index: usize| EDGE + (1.0 - 2.0 * EDGE) * index as f64 / samples as f64;
    let sampled = (0..=samples).map(|index| gap(place(index)));
    let (gaps, rates): (Vec<f64>, Vec<f64>) = sampled.map(|[gap, rate]| (gap, rate)).unzip();
    let operands: Vec<Vec<f64>> = scales
        .bending(piece, &gaps, &rates)
        .map(<[f64]>::to_vec)
        .collect();
    for (which, values) in operands.iter().enumerate() {
        let largest = values.iter().fold(0.0, |most: f64, x| most.max(x.abs()));
        // What is zero but for rounding has no sign.
        let known = (0..values.len()).filter(|index| values[*index].abs() > NOISE * largest);
        let known: Vec<usize> = known.collect();
        for pair in known.windows(2) {
            let [a, b] = [pair[0], pair[1]].map(|index| Place {
                x: place(index),
                value: values[index],
            });
            if (a.value > 0.0) == (b.value > 0.0) {
                continue;
            }
            let there = root(a, b, CLOSE, |part| {
                let [gap, rate] = gap(part);
                let (gap, rate) = ([gap], [rate]);
                let mut operands = scales.bending(piece, &gap, &rate);
                operands.nth(which).map_or(f64::NAN, |value| value[0])
            });
            parts.extend(there);
        }
    }
}
