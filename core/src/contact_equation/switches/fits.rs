//! Whether equations fit the orbit of their last pass: switches are where its gaps have them, and what may meet is told in pairs.
//!
//! `H` is that of (2) and (3) of [`skeleton`](crate::contact_equation::skeleton). A gap that is beyond a level without a switch is told by its
//! [extremes](crate::contact_equation::orbit::extremes), as far as these are seen.

use super::plan;
use crate::contact_equation::equations::pass_results::GapExtreme;
use crate::contact_equation::equations::{BACK, Equations};
use crate::contact_equation::linear_part::configuration::Configuration;
use crate::contact_equation::orbit::gaps::{Gaps, room};
use crate::contact_equation::orbit::motion::Motion;
use crate::contact_equation::run::Run;
use crate::contact_equation::skeleton::placement::{Switch, Told};

/// An extreme belongs to a pair of switches whose middle is as near, in parts of the phase to the next extreme if that is less than one.
pub(in crate::contact_equation) const SAME: f64 = 0.3;
/// A gap that is beyond its level by this part of its size is elsewhere.
const BEYOND: f64 = 1e-9;
/// Panels end elsewhere once a kink has moved by this part of the way.
const MOVED: f64 = 1e-3;
/// Switches are told in other pairs where the way between two of them is this part of those that they are told by.
const NEARER: f64 = 0.5;

/// What the gaps of an orbit say of its equations.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(in crate::contact_equation) enum Fits {
    /// They are right.
    Yes,
    /// They are right, and panels are better that end elsewhere, at the kinks of the orbit.
    Moved,
    /// They are right, and others are better from here on.
    Soon,
    /// The orbit is none: a gap is on another piece.
    No,
}

impl Equations {
    /// Whether the configurations of the last pass have eigenvectors that are far enough from dependent ones.
    fn is_sound(&self) -> bool {
        self.configurations.iter().all(Configuration::is_sound)
    }

    /// Whether the step from the last orbit to these unknowns has led over the end of a stretch whose switches are told each by itself, or over
    /// a touch and a change of order. A shorter one ends between them, where the pair, or the order, can be told anew.
    pub(in crate::contact_equation) fn is_beyond_touch(&self, u: &[f64]) -> bool {
        let [before, _] = &self.known;
        let same = before.len() == u.len();
        self.has_overtaken(u) || same && self.has_touched_out_of_order(u, before)
    }

    /// Whether two switches of one gap have passed each other at these unknowns, which makes them those of no motion: a stretch has ended
    /// in the step to them.
    fn has_overtaken(&self, u: &[f64]) -> bool {
        let skeleton = &self.skeleton;
        (0..skeleton.switches.len()).any(|first| {
            let switches = skeleton.switches.iter().copied();
            let second = plan::next_of_gap(switches, first);
            second.is_some_and(|second| skeleton.phase(u, second) < skeleton.phase(u, first) - BACK)
        })
    }

    /// Whether a gap has touched its level since an orbit in these unknowns, while switches of different gaps have changed their order. Those
    /// between the two of a pair leave it before they meet; a touch is located by equations that have all of them in their order.
    fn has_touched_out_of_order(&self, u: &[f64], before: &[f64]) -> bool {
        let skeleton = &self.skeleton;
        let touched = |switch: &Switch| {
            let Told::First { other, .. } = switch.told else {
                return false;
            };
            let [now, then] = [u, before].map(|u| u[skeleton.slot(other)]);
            (now > 0.0) != (then > 0.0)
        };
        !self.is_in_order() && skeleton.switches.iter().any(touched)
    }
}

impl Run<'_> {
    /// Whether the equations still fit the orbit of their last pass.
    pub(in crate::contact_equation) fn fits(&self, u: &[f64]) -> Fits {
        let motion = Motion::of(&self.equations);
        if !self.equations.is_in_order() {
            return Fits::No;
        }
        let found = motion.gap_extremes().concat();
        let mut fits = self.pairs_fit(u);
        if self.is_watched_in_vain(u, &found) || !self.equations.is_sound() {
            fits = Fits::Soon;
        }
        for extreme in &found {
            match self.extreme_fits(u, extreme, &found) {
                Fits::No => return Fits::No,
                Fits::Soon => fits = Fits::Soon,
                Fits::Moved | Fits::Yes => {}
            }
        }
        if fits == Fits::Yes && self.has_moved_kinks() {
            return Fits::Moved;
        }
        fits
    }

    /// Whether kinks of the last pass are farther from where panels end than the tolerance asks for: what is left out goes as the square of that.
    pub(in crate::contact_equation) fn has_moved_kinks(&self) -> bool {
        let most = MOVED.min(0.1 * self.problem.tolerance.sqrt());
        self.equations.has_moved_kinks(most)
    }

    /// Whether switches are told as they should be, and the beginning is away from them.
    fn pairs_fit(&self, u: &[f64]) -> Fits {
        let skeleton = &self.equations.skeleton;
        let phases: Vec<f64> = (0..skeleton.switches.len())
            .map(|switch| skeleton.phase(u, switch))
            .collect();
        for (first, a) in skeleton.switches.iter().enumerate() {
            let switches = skeleton.switches.iter().copied();
            let Some(second) = plan::next_of_gap(switches, first) else {
                continue;
            };
            let (b, way) = (&skeleton.switches[second], phases[second] - phases[first]);
            let same = a.can_meet(b);
            // Where they are told in pairs with others, those may have longer ways by now.
            let pair = matches!(a.told, Told::First { other, .. } if other == second);
            let others = [first, second].map(|index| match skeleton.switches[index].told {
                Told::Alone => f64::INFINITY,
                Told::First { other, .. } | Told::Second { other } => {
                    (phases[other] - phases[index]).abs()
                }
            });
            let nearer = way < plan::SHORTER.min(NEARER * others[0].min(others[1]));
            if same && !pair && nearer {
                return Fits::Soon;
            }
        }
        for (first, switch) in skeleton.switches.iter().enumerate() {
            if let Told::First { other, .. } = switch.told
                && phases[other] - phases[first] > plan::LONG
            {
                return Fits::Soon;
            }
        }
        let (Some(first), Some(last)) = (phases.first(), phases.last()) else {
            return Fits::Yes;
        };
        let [before, after] = [
            skeleton.begin + skeleton.length - last,
            first - skeleton.begin,
        ];
        let around = before + after;
        // The beginning is better elsewhere, if there is a longer way.
        let ways = phases.windows(2).map(|pair| pair[1] - pair[0]);
        let longest = ways.fold(0.0, f64::max);
        let meets = |way: f64| way < plan::SHORTER.min(NEARER * longest);
        if before.min(after) < 0.2 * around && around > plan::CLOSE
            || self.way_around(u).is_some_and(meets)
        {
            return Fits::Soon;
        }
        Fits::Yes
    }

    /// The shortest way from a switch to the next one of its gap that it may meet, across the beginning: what follows comes back there, maybe with
    /// the gaps of other contacts.
    fn way_around(&self, u: &[f64]) -> Option<f64> {
        if self.equations.failed {
            return None;
        }
        let skeleton = &self.equations.skeleton;
        let ways = skeleton
            .switches
            .iter()
            .enumerate()
            .filter_map(|(first, next)| {
                let switches = &skeleton.switches[..];
                let earlier = |switch: &Switch| switch.contact == next.contact;
                if switches[..first].iter().any(earlier) {
                    return None;
                }
                let next = self.later(next);
                let last = switches
                    .iter()
                    .rposition(|switch| switch.contact == next.contact)?;
                let way = skeleton.phase(u, first) + skeleton.length - skeleton.phase(u, last);
                switches[last].can_meet(&next).then_some(way)
            });
        ways.min_by(f64::total_cmp)
    }

    /// Whether the step to these unknowns has led over the end of a stretch, or over a touch and a change of order. A shorter one ends between
    /// them.
    pub(in crate::contact_equation) fn is_beyond_touch(&self, u: &[f64]) -> bool {
        let overtaken = |way: f64| way < -BACK;
        self.equations.is_beyond_touch(u) || self.way_around(u).is_some_and(overtaken)
    }

    /// Whether an extreme that is watched is far from its level, or comes near another one, with which it may end.
    fn is_watched_in_vain(&self, u: &[f64], found: &[GapExtreme]) -> bool {
        let skeleton = &self.equations.skeleton;
        let motion = Motion::of(&self.equations);
        let at = |phase: f64, state: &mut [f64]| motion.at(phase, state);
        let gaps = self.gaps(&at);
        skeleton.switches.iter().enumerate().any(|(index, switch)| {
            let Told::First { other, .. } = switch.told else {
                return false;
            };
            let square = u[skeleton.slot(other)];
            if square > 0.0 {
                return false;
            }
            let extreme = GapExtreme {
                contact: switch.contact,
                interval: 0,
                phase: skeleton.phase(u, index),
                gap: 0.0,
                maximum: switch.rises,
            };
            let room = plan::Room::of(&gaps, &extreme, found, skeleton.length);
            let jumps = self.has_leap(switch.contact, switch.level);
            plan::is_far(square, room, jumps)
        })
    }

    /// Whether an extreme of the last pass is beyond a level where the force jumps, without switches around it.
    pub(in crate::contact_equation) fn has_leapt(&self, u: &[f64]) -> bool {
        let motion = Motion::of(&self.equations);
        let found = motion.gap_extremes().concat();
        let skeleton = &self.equations.skeleton;
        found.iter().any(|extreme| {
            let contact = extreme.contact;
            let piece = skeleton.intervals[extreme.interval].pieces[contact];
            let levels = self.equations.values.contacts[contact].levels.iter();
            levels.enumerate().any(|(level, value)| {
                let above = extreme.gap - value;
                let beyond = if level < piece { -above } else { above };
                let at_once = || self.has_leap(contact, level);
                beyond > 0.0 && at_once() && !self.is_watched(u, extreme, level)
            })
        })
    }

    /// Whether the force of a contact jumps at a level.
    pub(in crate::contact_equation) fn has_leap(&self, contact: usize, level: usize) -> bool {
        self.equations.values.contacts[contact].jumps[level]
    }

    fn extreme_fits(&self, u: &[f64], extreme: &GapExtreme, all: &[GapExtreme]) -> Fits {
        let GapExtreme {
            contact,
            interval,
            gap,
            maximum,
            ..
        } = *extreme;
        let levels = &self.equations.values.contacts[contact].levels;
        let size = self.range(all, contact).max(f64::MIN_POSITIVE);
        let skeleton = &self.equations.skeleton;
        let piece = skeleton.intervals[interval].pieces[contact];
        let mut fits = Fits::Yes;
        for (level, value) in levels.iter().enumerate() {
            let above = gap - value;
            let beyond = if level < piece { -above } else { above };
            // A leap of the force changes the orbit at once.
            let at_once = self.has_leap(contact, level) && !self.is_watched(u, extreme, level);
            if beyond > if at_once { 0.0 } else { BEYOND * size } {
                return Fits::No;
            }
            let room = |gaps: &Gaps<'_>| plan::Room::of(gaps, extreme, all, skeleton.length);
            if (above < 0.0) == maximum && self.is_near(u, extreme, level, room) {
                fits = Fits::Soon;
            }
        }
        fits
    }

    /// Whether an extreme that is short of a level is to be watched and is not yet.
    fn is_near(
        &self,
        u: &[f64],
        extreme: &GapExtreme,
        level: usize,
        room: impl FnOnce(&Gaps<'_>) -> plan::Room,
    ) -> bool {
        let (contact, phase) = (extreme.contact, extreme.phase);
        let above = extreme.gap - self.equations.values.contacts[contact].levels[level];
        if self.is_watched(u, extreme, level) {
            return false;
        }
        let motion = Motion::of(&self.equations);
        let at = |phase: f64, state: &mut [f64]| motion.at(phase, state);
        let gaps = self.gaps(&at);
        let square = -above / gaps.bend(contact, phase);
        let near = (-plan::NEAR..=0.0).contains(&square);
        near && plan::is_near(square, room(&gaps), self.has_leap(contact, level))
    }

    /// Whether a pair of switches stands at an extreme: both at it, where it is short of the level, or else around it.
    fn is_watched(&self, u: &[f64], extreme: &GapExtreme, level: usize) -> bool {
        let skeleton = &self.equations.skeleton;
        let place = (extreme.contact, level, extreme.maximum);
        skeleton.switches.iter().enumerate().any(|(index, switch)| {
            let Told::First { other, .. } = switch.told else {
                return false;
            };
            let [first, second] = [index, other].map(|index| skeleton.phase(u, index));
            let apart = (first - extreme.phase).rem_euclid(skeleton.length);
            let around = (extreme.phase - first).rem_euclid(skeleton.length) <= second - first;
            let short = u[skeleton.slot(other)] <= 0.0;
            let near = || {
                let others = &Motion::of(&self.equations).gap_extremes()[extreme.contact];
                let same = SAME * room(extreme, others, skeleton.length).min(1.0);
                apart.min(skeleton.length - apart) < same
            };
            let own = (switch.contact, switch.level, switch.rises);
            own == place && if short { near() } else { around }
        })
    }
}
