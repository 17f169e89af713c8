//! Extremes of gaps as the engine of branches asks for them, to locate where one touches a level.
//!
//! An extreme `g_e` short of its level is a multiple of the unknown `H` of the pair that watches it, by (3) of
//! [`skeleton`](crate::contact_equation::skeleton),
//!
//! ```text
//! g_e - level = -(g''/2) H                                                                                     (1)
//! ```
//!
//! Source: di Bernardo, Budd, Champneys and Kowalczyk (2008), Piecewise-smooth Dynamical Systems, section 6.2 (grazing).

use std::f64::consts::TAU;

use crate::branches::extreme::{Bend, Extreme};
use crate::branches::recurrence::Recurrence;
use crate::contact_equation::equations::pass_results::{GapExtreme, Image};
use crate::contact_equation::orbit::motion::Motion;
use crate::contact_equation::run::Run;
use crate::contact_equation::run::images::later;
use crate::contact_equation::skeleton::placement::Told;
use crate::contact_equation::switches::fits::SAME;

/// What `H` of a pair may be where its gap touches the level.
const TOUCHES: f64 = 1e-9;
/// The root of `H` where the force jumps: up to the first it is how far beyond the level an extreme is, below the other one that is rounding.
const BEYOND: f64 = 0.5;
const ROUNDED: f64 = 1e-6;

impl Run<'_> {
    /// All extremes of gaps as the engine sees them.
    pub(in crate::contact_equation) fn extremes(
        &mut self,
        u: &[f64],
        extremes: &mut Vec<Extreme>,
    ) -> bool {
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

    /// Extremes over the whole period of the orbit of the last pass: where it comes back earlier, with their images.
    pub(super) fn of_period(&self) -> Vec<GapExtreme> {
        let motion = Motion::of(&self.equations);
        let skeleton = &self.equations.skeleton;
        let found = motion.gap_extremes().concat();
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
    pub(in crate::contact_equation) fn watched(
        &self,
        u: &[f64],
        extreme: &Extreme,
    ) -> Option<(usize, f64)> {
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
            let Told::First { other, bend, .. } = skeleton.switches[index].told else {
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
