//! Where a gap touches a level: the extremes of gaps over a period, less the levels.
//!
//! An extreme is a smooth function of the orbit, `d g(tau*) = dg(tau*)` as `g'(tau*) = 0`. So where the orbit itself varies
//! smoothly along its branch, an extreme that reaches a level is a simple zero, whatever the force does there.
//!
//! Source: di Bernardo, Budd, Champneys and Kowalczyk (2008), Piecewise-smooth Dynamical Systems, section 6.2 (grazing).

use std::f64::consts::{PI, TAU};

use crate::balance::{Balance, gap_series};
use crate::model::validate;
use crate::numeric::fourier::crossings::{Crossing, CrossingFinder};
use crate::numeric::fourier::series;
use crate::system::Part;

/// An extreme of a gap is followed from one orbit to the next as long as it moves by less than this phase.
const FAR: f64 = 1.0;
/// Distances of copies differ by less than this, in units of the gap.
const COPIES: f64 = 1e-8;
/// Derivatives by the parameter are differences over this part of its range.
const DIFFERENCE: f64 = 1e-6;

/// One extreme of a gap, seen from one level.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Extreme {
    contact: usize,
    level: usize,
    tau: f64,
    maximum: bool,
    /// Gap less level, in units of half of the gap's range.
    pub(super) above: f64,
    /// Half of the gap's range.
    size: f64,
}

/// Reads extremes of gaps off the orbits of one balance.
#[derive(Debug)]
pub(super) struct GapExtremes<'a> {
    balance: Balance<'a>,
    finder: CrossingFinder,
    gap: Vec<f64>,
    slope: Vec<f64>,
    arguments: Vec<f64>,
    levels: Vec<f64>,
    turns: Vec<Crossing>,
}

impl<'a> GapExtremes<'a> {
    pub(super) fn new(balance: Balance<'a>) -> Self {
        let harmonics = balance.gap_harmonics();
        let length = series::length(harmonics);
        Self {
            finder: CrossingFinder::new(harmonics),
            gap: vec![0.0; length],
            slope: vec![0.0; length],
            arguments: Vec::new(),
            levels: Vec::new(),
            turns: Vec::new(),
            balance,
        }
    }

    /// Writes the linear form of extended unknowns that gap less level is where the extreme lies, in its units. By the parameter,
    /// whose range has this length, it is a difference.
    pub(super) fn form(&mut self, u: &[f64], extreme: &Extreme, range: f64, row: &mut [f64]) {
        let last = u.len() - 1;
        let step = DIFFERENCE * range;
        row.fill(0.0);
        let (facts, varied) = (self.balance.system().facts(), self.balance.variable());
        let [below, above] = validate::around(facts, varied, u[last], step);
        row[last] = (self.height(u, above, extreme) - self.height(u, below, extreme))
            / ((above - below) * extreme.size);
        self.balance.set(u[last]);
        let (length, period) = (self.balance.length(), self.balance.resolution().period);
        let coefficients = self.balance.coefficients();
        for term in &self.balance.layout().contacts[extreme.contact].gap {
            let (sine, cosine) =
                (f64::from(term.wave.harmonic) * period as f64 * extreme.tau).sin_cos();
            let wave = match term.wave.part {
                Part::Cosine => cosine,
                Part::Sine => sine,
            };
            let factor = coefficients[term.coefficient] * wave / extreme.size;
            let row = &mut row[term.index * length..][..length];
            row[0] += factor;
            for (k, pair) in row[1..].chunks_exact_mut(2).enumerate() {
                let (sine, cosine) = ((k + 1) as f64 * extreme.tau).sin_cos();
                pair[0] += factor * cosine;
                pair[1] += factor * sine;
            }
        }
    }

    /// Gap less level at the phase of an extreme, with another value of the parameter.
    fn height(&mut self, u: &[f64], parameter: f64, extreme: &Extreme) -> f64 {
        self.balance.set(parameter);
        let (length, period) = (self.balance.length(), self.balance.resolution().period);
        let of = &self.balance.layout().contacts[extreme.contact];
        let law = self.balance.system().law(of.law);
        let coefficients = self.balance.coefficients();
        self.levels.resize(law.facts().levels.len(), 0.0);
        self.arguments.resize(of.argument_count, 0.0);
        of.arguments(coefficients, &mut self.arguments);
        law.levels(&self.arguments, &mut self.levels);
        gap_series(of, coefficients, period, u, length, &mut self.gap);
        series::value(&self.gap, extreme.tau) - self.levels[extreme.level]
    }

    /// Writes the extremes of all gaps, from every level, in order of phase.
    pub(super) fn read(&mut self, u: &[f64], extremes: &mut Vec<Extreme>) {
        extremes.clear();
        self.balance.set(u[u.len() - 1]);
        let (length, period) = (self.balance.length(), self.balance.resolution().period);
        for (contact, of) in self.balance.layout().contacts.iter().enumerate() {
            let law = self.balance.system().law(of.law);
            self.levels.resize(law.facts().levels.len(), 0.0);
            if self.levels.is_empty() {
                continue;
            }
            let coefficients = self.balance.coefficients();
            self.arguments.resize(of.argument_count, 0.0);
            of.arguments(coefficients, &mut self.arguments);
            law.levels(&self.arguments, &mut self.levels);
            gap_series(of, coefficients, period, u, length, &mut self.gap);
            series::differentiate(&self.gap, &mut self.slope);
            self.turns.clear();
            self.finder.sample(&self.slope);
            self.finder.crossings(0.0, &mut self.turns);
            let values = self.turns.iter().map(|at| series::value(&self.gap, at.tau));
            let (low, high) = values.fold((f64::INFINITY, f64::NEG_INFINITY), |(a, b), x| {
                (a.min(x), b.max(x))
            });
            let size = 0.5 * (high - low);
            for (level, value) in self.levels.iter().enumerate() {
                extremes.extend(self.turns.iter().map(|at| Extreme {
                    contact,
                    level,
                    tau: at.tau,
                    maximum: !at.rising,
                    above: (series::value(&self.gap, at.tau) - value) / size,
                    size,
                }));
            }
        }
    }
}

impl Extreme {
    /// Whether the level is not crossed beside it: a maximum below, or a minimum above.
    pub(super) fn is_clear(&self) -> bool {
        (self.above < 0.0) == self.maximum
    }

    fn is_alike(&self, other: &Self) -> bool {
        (self.contact, self.level, self.maximum) == (other.contact, other.level, other.maximum)
    }

    /// How far apart in phase.
    fn apart(&self, other: &Self) -> f64 {
        let apart = (self.tau - other.tau).abs().rem_euclid(TAU);
        PI - (PI - apart).abs()
    }

    /// The nearest extreme of the same kind of another orbit.
    pub(super) fn nearest<'e>(&self, among: &'e [Self]) -> Option<&'e Self> {
        among
            .iter()
            .filter(|other| self.is_alike(other))
            .min_by(|a, b| self.apart(a).total_cmp(&self.apart(b)))
            .filter(|other| self.apart(other) < FAR)
    }
}

/// An extreme that has gone through its level from one orbit to the next: where it was, and where it is.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Passage {
    pub(super) before: Extreme,
    pub(super) next: Extreme,
}

/// The extremes that have gone through their levels from one orbit to the next.
pub(super) fn passed(before: &[Extreme], next: &[Extreme]) -> Vec<Passage> {
    let through = |extreme: &Extreme| {
        let there = extreme.nearest(next)?;
        // Each must be the nearest of the other.
        let same = there.nearest(before) == Some(extreme);
        (same && (there.above < 0.0) != (extreme.above < 0.0)).then_some(Passage {
            before: *extreme,
            next: *there,
        })
    };
    before.iter().filter_map(through).collect()
}

/// Whether two extremes that have gone through their levels are as far from them before and after: those of contacts that are copies
/// of each other, shifted in phase or with the opposite sign.
pub(super) fn is_copy(one: &Passage, other: &Passage) -> bool {
    let alike = |a: &Extreme, b: &Extreme| (a.above.abs() - b.above.abs()).abs() <= COPIES;
    alike(&one.before, &other.before) && alike(&one.next, &other.next)
}

/// The number of contacts that extremes belong to.
pub(super) fn distinct(found: &[Passage]) -> usize {
    // They are in order of contacts.
    found
        .chunk_by(|a, b| a.before.contact == b.before.contact)
        .count()
}

/// How often levels are crossed in a period: between two successive extremes on different sides, once.
pub(super) fn crossings(extremes: &[Extreme]) -> usize {
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
