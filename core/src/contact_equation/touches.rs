//! Extremes of gaps as the engine of branches asks for them, to locate where one touches a level.

use std::f64::consts::TAU;

use super::motion::{GapExtreme, Motion};
use super::placement::Told;
use super::run::{Run, SAME};
use crate::branches::extreme::Extreme;

/// What `H` of a pair may be where its gap touches the level.
const TOUCHES: f64 = 1e-9;

impl Run<'_> {
    /// All extremes of gaps as the engine sees them.
    pub(super) fn extremes(&mut self, u: &[f64], extremes: &mut Vec<Extreme>) -> bool {
        extremes.clear();
        self.equations.compute(u, false);
        if self.equations.failed {
            return false;
        }
        let motion = Motion::of(&self.equations);
        let length = self.equations.skeleton.length;
        for (contact, found) in motion.extremes().gaps.iter().enumerate() {
            let mut found = found.clone();
            found.sort_by(|a, b| {
                let place = |extreme: &GapExtreme| extreme.phase.rem_euclid(length);
                place(a).total_cmp(&place(b))
            });
            let gaps = found.iter().map(|extreme| extreme.gap);
            let (low, high) = gaps.fold((f64::INFINITY, f64::NEG_INFINITY), |(a, b), x| {
                (a.min(x), b.max(x))
            });
            let size = 0.5 * (high - low);
            let levels = &self.equations.values.contacts[contact].levels;
            for (level, value) in levels.iter().enumerate() {
                extremes.extend(found.iter().map(|extreme| Extreme {
                    contact,
                    level,
                    tau: TAU * extreme.phase.rem_euclid(length) / length,
                    maximum: extreme.maximum,
                    above: (extreme.gap - value) / size,
                    size,
                    jumps: false,
                    begins: false,
                }));
            }
        }
        true
    }

    /// Writes the linear form of unknowns that gap less level is at an extreme that is short of it, in units of the extreme: by (3) of
    /// [`skeleton`](super::skeleton) a multiple of `H`. Says whether the extreme is watched.
    pub(super) fn extreme_form(&self, u: &[f64], extreme: &Extreme, form: &mut [f64]) -> bool {
        let watched = self.watched(u, extreme);
        if let Some((square, bend)) = watched {
            form.fill(0.0);
            form[square] = -bend / extreme.size;
        }
        watched.is_some()
    }

    /// The unknown `H` of the pair that watches an extreme which is short of its level, and half of `g''`.
    pub(super) fn watched(&self, u: &[f64], extreme: &Extreme) -> Option<(usize, f64)> {
        let skeleton = &self.equations.skeleton;
        let mut switches = skeleton.switches.iter().enumerate();
        switches.find_map(|(index, switch)| {
            let Told::First { other, bend } = switch.told else {
                return None;
            };
            let phase = TAU * skeleton.phase(u, index) / skeleton.length;
            let apart = (phase - extreme.tau).rem_euclid(TAU);
            let same = (switch.contact, switch.level, switch.rises)
                == (extreme.contact, extreme.level, extreme.maximum);
            let square = skeleton.slot(other);
            let short = same && apart.min(TAU - apart) < SAME && u[square] <= TOUCHES;
            short.then_some((square, bend))
        })
    }
}
