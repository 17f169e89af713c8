//! Extremes of gaps over a period, seen from the levels of their laws.
//!
//! An extreme is a smooth function of the orbit, `d g(tau*) = dg(tau*)` as `g'(tau*) = 0`. So where the orbit itself varies
//! smoothly along its branch, an extreme that reaches a level is a simple zero, whatever the force does there.
//!
//! Source: di Bernardo, Budd, Champneys and Kowalczyk (2008), Piecewise-smooth Dynamical Systems, section 6.2 (grazing).

use std::f64::consts::{PI, TAU};

use crate::continuation::follow::{CurvePoint, Step};
use crate::law::{LawFacts, unbounded_by};
use crate::system::System;

/// An extreme of a gap is followed from one orbit to the next as long as it moves by less than this phase.
const FAR: f64 = 1.0;
/// Distances of copies differ by less than this, in units of the gap.
const COPIES: f64 = 1e-8;

/// Whether the force of a contact jumps at one of its levels.
pub(crate) fn force_jumps(system: &dyn System) -> bool {
    let contacts = system.facts().contacts.iter();
    contacts
        .flat_map(|contact| system.law(contact.law).facts().levels.iter())
        .any(|level| level.force_jumps)
}

/// Whether a branch may have a corner of any angle where a level of some contact is touched.
pub(crate) fn corners(system: &dyn System) -> bool {
    let contacts = system.facts().contacts.iter();
    contacts
        .flat_map(|contact| system.law(contact.law).facts().levels.iter())
        .any(|level| level.force_jumps || level.unbounded_by_gap)
}

/// What a branch and the multipliers along it do where a level is touched. With a force that goes as `g^p` beyond it, both go to their limits as
/// `h^(p - 1/2)` of the height `h` of the extreme.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(rename_all = "kebab-case"))]
pub(crate) enum Bend {
    /// They go on: the stiffness does.
    Smooth,
    /// Multipliers go as the root of the height: the stiffness, or what the force is of the rate, jumps.
    Root,
    /// They are continuous, and steeper than can be resolved: `p` is between a half and one.
    Steep,
    /// The branch may have a corner of any angle, and multipliers jump or are unbounded: the force jumps, or `p` is a half at most.
    Corner,
}

impl Bend {
    /// At one level of a law, at values of its arguments, of which an exponent may be one.
    pub(crate) fn at(facts: &LawFacts, level: usize, arguments: &[f64]) -> Self {
        // The exponent of the slope is that of the force less one.
        match unbounded_by(facts, level, arguments) {
            _ if facts.levels[level].force_jumps => Self::Corner,
            Some(exponent) if exponent <= -0.5 => Self::Corner,
            Some(_) => Self::Steep,
            None if facts.levels[level].by_gap_jumps => Self::Root,
            None if facts.levels[level].by_rate_jumps => Self::Root,
            None => Self::Smooth,
        }
    }
}

/// One extreme of a gap, seen from one level.
#[derive(Debug, Clone, Copy, PartialEq)]
#[expect(
    clippy::struct_excessive_bools,
    reason = "independent facts, not states"
)]
pub(crate) struct Extreme {
    pub(crate) contact: usize,
    pub(crate) level: usize,
    /// Where in the period, which is `2 pi`.
    pub(crate) tau: f64,
    pub(crate) maximum: bool,
    /// Gap less level, in units of half of the gap's range.
    pub(crate) above: f64,
    /// Half of the gap's range.
    pub(crate) size: f64,
    /// The force jumps at the level.
    pub(crate) jumps: bool,
    /// What the branch does where the level is touched.
    pub(crate) bend: Bend,
    /// It is none, but the gap where the unknowns begin to tell the orbit.
    pub(crate) begins: bool,
    /// It is seen from no level, but from the gap zero.
    pub(crate) plain: bool,
    /// Its form has no part of what the parameter does to a motion from given states: where a motion forgets its beginning, that tells all
    /// orbits of one value alike.
    pub(crate) of_states: bool,
}

impl Extreme {
    /// One of a contact from a level, of which the rest is not known yet.
    pub(crate) fn of(contact: usize, level: usize, size: f64, jumps: bool) -> Self {
        Self {
            contact,
            level,
            tau: 0.0,
            maximum: false,
            above: 0.0,
            size,
            jumps,
            bend: if jumps { Bend::Corner } else { Bend::Smooth },
            begins: false,
            plain: false,
            of_states: false,
        }
    }

    /// The gap that it is seen from, one of these levels or zero.
    pub(crate) fn origin(&self, levels: &[f64]) -> f64 {
        if self.plain { 0.0 } else { levels[self.level] }
    }

    /// The gap itself of one that is seen from zero.
    pub(crate) fn gap(&self) -> f64 {
        self.above * self.size
    }

    /// Whether the level is not crossed beside it: a maximum below, or a minimum above.
    pub(crate) fn is_clear(&self) -> bool {
        (self.above < 0.0) == self.maximum
    }

    fn is_alike(&self, other: &Self) -> bool {
        let place = |extreme: &Self| (extreme.contact, extreme.level);
        let kind = |extreme: &Self| (extreme.maximum, extreme.begins);
        place(self) == place(other) && kind(self) == kind(other)
    }

    /// How far apart in phase.
    fn apart(&self, other: &Self) -> f64 {
        let apart = (self.tau - other.tau).abs().rem_euclid(TAU);
        PI - (PI - apart).abs()
    }

    /// The nearest extreme of the same kind of another orbit.
    pub(crate) fn nearest<'e>(&self, among: &'e [Self]) -> Option<&'e Self> {
        among
            .iter()
            .filter(|other| self.is_alike(other))
            .min_by(|a, b| self.apart(a).total_cmp(&self.apart(b)))
            .filter(|other| self.apart(other) < FAR)
    }
}

/// Each extreme with the same one of another orbit.
pub(crate) fn pairs<'e>(
    here: &'e [Extreme],
    next: &'e [Extreme],
) -> impl Iterator<Item = [&'e Extreme; 2]> {
    here.iter().filter_map(move |extreme| {
        let there = extreme.nearest(next)?;
        // Each must be the nearest of the other.
        (there.nearest(here) == Some(extreme)).then_some([extreme, there])
    })
}

/// An extreme that has gone through its level from one orbit to the next: where it was, and where it is.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Passage {
    pub(crate) before: Extreme,
    pub(crate) next: Extreme,
}

impl Passage {
    /// The end of a step at which it is clear of its level, and the extreme there.
    pub(crate) fn clear_end<'s>(&self, step: Step<'s>) -> (&'s CurvePoint, Extreme) {
        if self.before.is_clear() {
            (step.before, self.before)
        } else {
            (step.next, self.next)
        }
    }
}

/// The extremes that have gone through their levels from one orbit to the next.
pub(crate) fn passed(before: &[Extreme], next: &[Extreme]) -> Vec<Passage> {
    let through = pairs(before, next).filter(|[a, b]| (a.above < 0.0) != (b.above < 0.0));
    let passages = through.map(|[before, next]| Passage {
        before: *before,
        next: *next,
    });
    passages.collect()
}

/// Whether an extreme near its level is there at one of two orbits and not at the other one: two of them have become one between both, or
/// one two. What they passed there shows at neither end.
pub(crate) fn appears(before: &[Extreme], next: &[Extreme], near: f64) -> bool {
    let alone = |extreme: &Extreme, there: &[Extreme], here: &[Extreme]| {
        let other = extreme.nearest(there);
        extreme.above.abs() <= near && other.and_then(|other| other.nearest(here)) != Some(extreme)
    };
    before.iter().any(|extreme| alone(extreme, next, before))
        || next.iter().any(|extreme| alone(extreme, before, next))
}

/// Whether two extremes that have gone through their levels are as far from them before and after: those of contacts that are copies
/// of each other, shifted in phase or with the opposite sign.
pub(crate) fn is_copy(one: &Passage, other: &Passage) -> bool {
    let alike = |a: &Extreme, b: &Extreme| (a.above.abs() - b.above.abs()).abs() <= COPIES;
    alike(&one.before, &other.before) && alike(&one.next, &other.next)
}

/// The number of contacts that extremes belong to.
pub(crate) fn distinct(found: &[Passage]) -> usize {
    // They are in order of contacts.
    found
        .chunk_by(|a, b| a.before.contact == b.before.contact)
        .count()
}

/// How often levels are crossed in a period: between two successive extremes on different sides, once.
pub(crate) fn crossings(extremes: &[Extreme]) -> usize {
    let same = |a: &Extreme, b: &Extreme| (a.contact, a.level) == (b.contact, b.level);
    extremes
        .chunk_by(same)
        .map(|of| {
            let next = of.iter().cycle().skip(1);
            let pairs = of.iter().zip(next);
            pairs
                .filter(|(a, b)| (a.above < 0.0) != (b.above < 0.0))
                .count()
        })
        .sum()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn at(tau: f64, maximum: bool, above: f64) -> Extreme {
        Extreme {
            contact: 0,
            level: 0,
            tau,
            maximum,
            above,
            size: 1.0,
            jumps: false,
            bend: Bend::Smooth,
            begins: false,
            plain: false,
            of_states: false,
        }
    }

    #[test]
    fn an_extreme_that_goes_through_its_level_is_seen() {
        let before = [at(0.1, false, 0.05), at(3.0, true, 1.0)];
        // The phase goes round, and the minimum below.
        let next = [at(3.1, true, 1.0), at(6.2, false, -0.01)];
        let found = passed(&before, &next);
        let passage = Passage {
            before: before[0],
            next: next[1],
        };
        assert_eq!(found, [passage]);
        assert_eq!((crossings(&before), crossings(&next)), (0, 2));
        assert!(passed(&before, &before).is_empty());
        // A new pair of extremes is nothing that went through.
        let born = [
            at(0.1, false, 0.04),
            at(1.0, true, 0.5),
            at(1.1, false, 0.45),
            at(3.0, true, 1.0),
        ];
        assert!(passed(&before, &born).is_empty());
        // Far from the level it stays there.
        assert!(!appears(&before, &born, 0.1));
        assert!(appears(&before, &born, 0.5) && appears(&born, &before, 0.5));
        assert!(!appears(&before, &next, 1.0));
    }

    #[test]
    fn copies_are_as_far_from_their_levels() {
        let pair = |contact: usize, tau: f64, above: f64, there: f64| {
            let of = |above: f64| Extreme {
                contact,
                ..at(tau, true, above)
            };
            Passage {
                before: of(above),
                next: of(there),
            }
        };
        let found = [
            pair(0, 0.1, -0.05, 0.02),
            pair(0, 3.2, -0.05, 0.02),
            pair(1, 0.9, -0.05, 0.02 + 1e-12),
            pair(2, 1.7, -0.05, 0.021),
        ];
        assert_eq!(
            found.map(|other| is_copy(&found[0], &other)),
            [true, true, true, false]
        );
        // The opposite sign is the other side.
        assert!(is_copy(&found[0], &pair(0, 2.0, 0.05, -0.02)));
        assert_eq!(distinct(&found), 3);
        assert_eq!(distinct(&found[..2]), 1);
    }
}
