//! Extremes of gaps as the engine of branches asks for them, to locate where one touches a level.
//!
//! An extreme `g_e` short of its level is a multiple of the unknown `H` of the pair that watches it, by (3) of
//! [`skeleton`](super::skeleton),
//!
//! ```text
//! g_e - level = -(g''/2) H                                                                                     (1)
//! ```
//!
//! and a gap that passes a level with the slope `r`, while its second derivative `a` slows it down, would turn beyond it at the height
//!
//! ```text
//! r^2 / (2 |a|)                                                                                                (2)
//! ```
//!
//! Source: di Bernardo, Budd, Champneys and Kowalczyk (2008), Piecewise-smooth Dynamical Systems, section 6.2 (grazing).

use std::f64::consts::TAU;

use super::motion::{GapExtreme, Motion};
use super::placement::{Switch, Told};
use super::run::{Run, SAME};
use crate::branches::extreme::{Bend, Extreme};
use crate::branches::recurrence::Recurrence;

/// What `H` of a pair may be where its gap touches the level.
const TOUCHES: f64 = 1e-9;
/// The root of `H` where the force jumps: up to the first it is how far beyond the level an extreme is, below the other one that is rounding.
const BEYOND: f64 = 0.5;
const ROUNDED: f64 = 1e-6;
/// Levels that differ by this part are one.
const SAME_LEVEL: f64 = 1e-9;
/// A pair whose `H`, or the root of it, is less is near its touch.
const WIDE: f64 = 0.03;
/// How fast a slope changes is seen over this, in radians.
const SHORT: f64 = 1e-4;
/// Where gaps are compared, in parts of the time after which the orbit comes back: nowhere in particular.
const LOOKED_AT: f64 = 0.377;

/// A contact with the gap that another one has had, or with the opposite.
#[derive(Debug, Clone, Copy)]
pub(super) struct Image {
    contact: usize,
    sign: f64,
}

/// The image of a contact after so many parts.
fn later(images: &[Image], contact: usize, parts: usize) -> Image {
    let own = Image { contact, sign: 1.0 };
    (0..parts).fold(own, |Image { contact, sign }, _| {
        let next = images[contact];
        Image {
            contact: next.contact,
            sign: sign * next.sign,
        }
    })
}

/// Whether levels are those of another contact, or the opposite ones.
fn are_alike(levels: &[f64], others: &[f64], sign: f64) -> bool {
    let same = |(level, other): (&f64, &f64)| {
        (level - sign * other).abs() <= SAME_LEVEL * level.abs().max(other.abs())
    };
    levels.len() == others.len()
        && if sign > 0.0 {
            levels.iter().zip(others).all(same)
        } else {
            levels.iter().zip(others.iter().rev()).all(same)
        }
}

impl Run<'_> {
    /// All extremes of gaps as the engine sees them.
    pub(super) fn extremes(&mut self, u: &[f64], extremes: &mut Vec<Extreme>) -> bool {
        extremes.clear();
        self.equations.compute(u, false);
        if self.equations.failed || !self.equations.is_in_order() {
            return false;
        }
        let whole = TAU * self.equations.skeleton.recurrence().period as f64;
        let mut found = self.of_period();
        let place = |extreme: &GapExtreme| extreme.phase.rem_euclid(whole);
        found.sort_by(|a, b| {
            let contacts = a.contact.cmp(&b.contact);
            contacts.then(place(a).total_cmp(&place(b)))
        });
        for of_contact in found.chunk_by(|a, b| a.contact == b.contact) {
            let contact = of_contact[0].contact;
            let size = (0.5 * self.range(of_contact, contact)).max(f64::MIN_POSITIVE);
            let of = &self.equations.values.contacts[contact];
            let facts = self.equations.setting.system.law(of.law).facts();
            for (level, value) in of.levels.iter().enumerate() {
                extremes.extend(of_contact.iter().map(|extreme| Extreme {
                    contact,
                    level,
                    tau: TAU * place(extreme) / whole,
                    maximum: extreme.maximum,
                    above: (extreme.gap - value) / size,
                    size,
                    jumps: facts.levels[level].force_jumps,
                    bend: Bend::at(facts, level, &of.arguments),
                    begins: false,
                    plain: false,
                    of_states: false,
                }));
            }
        }
        true
    }

    /// How slowly a gap passes a level where the force jumps while it is slowed down: the height (2) at which it would turn, in units
    /// of half of the gap's range, with its slope `r` by the phase and how fast that changes, `a`, before the level.
    pub(super) fn slowest(&mut self, u: &[f64]) -> f64 {
        self.equations.compute(u, false);
        if self.equations.failed || !self.equations.is_in_order() {
            return f64::INFINITY;
        }
        let motion = Motion::of(&self.equations);
        let found = motion.extremes().gaps.concat();
        let skeleton = &self.equations.skeleton;
        let heights = skeleton.switches.iter().enumerate().map(|(index, switch)| {
            let contact = switch.contact;
            let size = 0.5 * self.range(&found, contact);
            let Some(interval) = skeleton.before(index) else {
                return f64::INFINITY;
            };
            let [from, to] = motion.phases(interval);
            let width = (to - from).min(SHORT);
            let slope = |phase: f64| motion.gap(contact, interval, phase)[1];
            let (before, rate) = (slope(to - width), slope(to));
            let change = (rate - before) / width;
            let slowed = rate * change < 0.0 && self.has_leap(contact, switch.level);
            // A pair passes as slowly as its gap has gone beyond the level.
            let other = match switch.told {
                Told::First { other, .. } => Some(other),
                Told::Second { .. } => Some(index),
                Told::Alone => None,
            };
            let wide = other.is_none_or(|other| u[skeleton.slot(other)] > WIDE);
            if slowed && wide && width > 0.0 {
                0.5 * rate * rate / change.abs() / size
            } else {
                f64::INFINITY
            }
        });
        heights.fold(f64::INFINITY, f64::min)
    }

    /// Extremes over the whole period of the orbit of the last pass: where it comes back earlier, with their images.
    fn of_period(&self) -> Vec<GapExtreme> {
        let motion = Motion::of(&self.equations);
        let skeleton = &self.equations.skeleton;
        let found = motion.extremes().gaps.concat();
        let images = self.images();
        let parts = skeleton.recurrence().parts;
        let image = |extreme: &GapExtreme, part: usize| {
            let Image { contact, sign } = later(images, extreme.contact, part);
            GapExtreme {
                contact,
                phase: extreme.phase + skeleton.length * part as f64,
                gap: sign * extreme.gap,
                maximum: extreme.maximum == (sign > 0.0),
                ..*extreme
            }
        };
        let all = (0..parts).flat_map(|part| found.iter().map(move |extreme| (extreme, part)));
        all.map(|(extreme, part)| image(extreme, part)).collect()
    }

    /// The range of a gap over the period, from these extremes of what is followed.
    pub(super) fn range(&self, extremes: &[GapExtreme], contact: usize) -> f64 {
        let images = self.images();
        let parts = self.equations.skeleton.recurrence().parts;
        let all = extremes.iter().flat_map(|extreme| {
            let later = move |part| (later(images, extreme.contact, part), extreme.gap);
            (0..parts).map(later)
        });
        let own = all.filter(|(image, _)| image.contact == contact);
        let (low, high) = own.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), own| {
            let gap = own.0.sign * own.1;
            (low.min(gap), high.max(gap))
        });
        high - low
    }

    /// For every contact the one that has its gap, or the opposite, when the orbit has come back: found from the motion of the last pass.
    fn images(&self) -> &[Image] {
        self.equations.images.get_or_init(|| self.seen_images())
    }

    /// A switch where the orbit has come back, as one of the contact whose gap does so there.
    pub(super) fn later(&self, switch: &Switch) -> Switch {
        let Image { contact, sign } = self.images()[switch.contact];
        if sign > 0.0 {
            return Switch { contact, ..*switch };
        }
        let levels = self.equations.values.contacts[contact].levels.len();
        Switch {
            contact,
            level: levels - 1 - switch.level,
            rises: !switch.rises,
            ..*switch
        }
    }

    fn seen_images(&self) -> Vec<Image> {
        let skeleton = &self.equations.skeleton;
        let contacts = &self.equations.values.contacts;
        if skeleton.recurrence().parts == 1 {
            let own = |contact| Image { contact, sign: 1.0 };
            return (0..contacts.len()).map(own).collect();
        }
        let motion = Motion::of(&self.equations);
        let at = |phase: f64, state: &mut [f64]| motion.at(phase, state);
        let gaps = self.gaps(&at);
        let seen = |phase: f64| -> Vec<[f64; 2]> {
            let all = 0..contacts.len();
            all.map(|contact| gaps.gap(contact, phase)).collect()
        };
        let phase = skeleton.begin + LOOKED_AT * skeleton.length;
        let [now, then] = [phase, phase + skeleton.length].map(seen);
        let base = self.equations.values.base;
        let mut taken = vec![false; contacts.len()];
        let mut images = Vec::with_capacity(contacts.len());
        for (contact, of) in contacts.iter().enumerate() {
            let apart = |other: usize, sign: f64| {
                let [gap, rate] = [0, 1].map(|i| (then[other][i] - sign * now[contact][i]).abs());
                gap + rate / base
            };
            let pairs = (0..contacts.len())
                .flat_map(|contact| [1.0, -1.0].map(|sign| Image { contact, sign }));
            let mut possible = pairs.filter(
                |Image {
                     contact: other,
                     sign,
                 }| {
                    !taken[*other] && are_alike(&of.levels, &contacts[*other].levels, *sign)
                },
            );
            let first = possible.next();
            let image = possible.fold(first, |best, next| {
                let distance = |image: &Image| apart(image.contact, image.sign);
                best.filter(|best| distance(best) <= distance(&next))
                    .or(Some(next))
            });
            let image = image.unwrap_or(Image { contact, sign: 1.0 });
            taken[image.contact] = true;
            images.push(image);
        }
        images
    }

    /// Writes the linear form of unknowns that gap less level is at an extreme that is short of it, in units of the extreme: by (1)
    /// a multiple of `H`; beyond a level where the force jumps, to leading order, of its square root's square. Says
    /// whether the extreme is watched.
    pub(super) fn extreme_form(&self, u: &[f64], extreme: &Extreme, form: &mut [f64]) -> bool {
        let watched = self.watched(u, extreme);
        if let Some((square, bend)) = watched {
            let beyond = extreme.jumps && u[square] > ROUNDED;
            form.fill(0.0);
            form[square] = if beyond {
                2.0 * extreme.above / u[square]
            } else {
                -bend / extreme.size
            };
        }
        watched.is_some()
    }

    /// Unknowns beside some, in which an extreme has about a height, in its units: where the force jumps at its level, the pair of switches that
    /// watches it is that far apart.
    pub(super) fn lifted(&self, u: &[f64], extreme: &Extreme, height: f64) -> Option<Vec<f64>> {
        let (place, bend) = self.watched(u, extreme).filter(|_| extreme.jumps)?;
        let is_clear = (height < 0.0) == extreme.maximum;
        let beyond = u[place];
        // Half of `g''` beyond the level.
        let inside = if beyond > ROUNDED {
            (extreme.above / (beyond * beyond)).abs()
        } else {
            (bend / extreme.size).abs()
        };
        let mut lifted = u.to_vec();
        lifted[place] = if is_clear {
            -height * extreme.size / bend
        } else {
            (height.abs() / inside).sqrt()
        };
        Some(lifted)
    }

    /// The unknown `H` of the pair that watches an extreme which is short of its level, or its root beyond one where the force jumps, and half of
    /// `g''`.
    pub(super) fn watched(&self, u: &[f64], extreme: &Extreme) -> Option<(usize, f64)> {
        let skeleton = &self.equations.skeleton;
        let images = self.images();
        let Recurrence { period, parts, .. } = *skeleton.recurrence();
        let whole = TAU * period as f64;
        // How far it is, and the sign with which it is watched: a later part of the period may be the first one mirrored.
        let place_of = |index: usize, part: usize| {
            let switch = &skeleton.switches[index];
            let phase = skeleton.phase(u, index) + skeleton.length * part as f64;
            let apart = (TAU * phase / whole - extreme.tau).rem_euclid(TAU);
            let Image { contact, sign } = later(images, switch.contact, part);
            let levels = self.equations.values.contacts[contact].levels.len();
            let (level, rises) = if sign > 0.0 {
                (switch.level, switch.rises)
            } else {
                (levels - 1 - switch.level, !switch.rises)
            };
            let same = (contact, level, rises) == (extreme.contact, extreme.level, extreme.maximum);
            let apart = parts as f64 * apart.min(TAU - apart);
            (same && apart < SAME).then_some((apart, sign))
        };
        let watching = (0..skeleton.switches.len()).filter_map(|index| {
            let Told::First { other, bend } = skeleton.switches[index].told else {
                return None;
            };
            let square = skeleton.slot(other);
            let most = if extreme.jumps { BEYOND } else { TOUCHES };
            let (apart, sign) = (0..parts).find_map(|part| place_of(index, part))?;
            (u[square] <= most).then_some((apart, square, sign * bend))
        });
        let nearest = watching.min_by(|a, b| a.0.total_cmp(&b.0));
        nearest.map(|(_, square, bend)| (square, bend))
    }
}
