//! An orbit cut where a gap crosses a level, and where it nearly does.
//!
//! Between two cuts every contact stays on one piece of its law. A near miss is a cut without a jump.

use std::f64::consts::TAU;

use super::orbit::Orbit;
use crate::balance::rate_series;
use crate::law::{LawFacts, PieceFacts, Quantity};
use crate::model::layout::ContactLayout;
use crate::numeric::fourier::crossings::CrossingFinder;
use crate::numeric::fourier::crossings::levels::Cuts;
use crate::numeric::fourier::grading::power_for;
use crate::numeric::fourier::series;

/// What happens at a cut.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Event {
    /// The gap crosses the level from below to above.
    Rising,
    /// From above to below.
    Falling,
    /// It nearly touches the level.
    Near,
}

/// Phase between cuts up to which they switch together.
const TOGETHER: f64 = 1e-3;

/// Numbers of harmonics that are prepared for at once: those of an orbit, and of the corrected one.
const FINDERS: usize = 4;

/// A phase at which the orbit is cut.
#[derive(Debug, Clone, Copy)]
pub(super) struct Cut {
    pub(super) tau: f64,
    pub(super) contact: usize,
    pub(super) level: usize,
    pub(super) event: Event,
}

/// One contact along the orbit.
#[derive(Debug, Default)]
pub(super) struct Contact {
    pub(super) arguments: Vec<f64>,
    /// The arguments before.
    before: Vec<f64>,
    pub(super) levels: Vec<f64>,
    /// Series of the gap and of its rate.
    pub(super) gap: Vec<f64>,
    pub(super) rate: Vec<f64>,
    /// The piece it is on, as the cuts are passed.
    pub(super) piece: usize,
    /// One for each number of harmonics, so that phases do not depend on the orbits that came before.
    finders: Vec<(usize, CrossingFinder)>,
    /// Powers of the grading at the lower and the upper end of every piece, for the arguments at hand.
    powers: Vec<[u32; 2]>,
}

/// The contacts of an orbit and its cuts, in order of phase. What is needed again is kept from orbit to orbit.
#[derive(Debug, Default)]
pub(super) struct Path {
    pub(super) contacts: Vec<Contact>,
    pub(super) cuts: Vec<Cut>,
    /// Those of one contact.
    found: Cuts,
}

impl Path {
    /// Takes an orbit.
    pub(super) fn load(&mut self, orbit: &Orbit<'_>) {
        let layouts = &orbit.layout.contacts;
        self.contacts.resize_with(layouts.len(), Contact::default);
        self.cuts.clear();
        for (index, layout) in layouts.iter().enumerate() {
            let facts = orbit.system.law(layout.law).facts();
            self.contacts[index].load(orbit, layout);
            if !facts.levels.is_empty() {
                self.cut(index, facts);
            }
        }
        self.cuts.sort_unstable_by(|a, b| {
            a.tau
                .total_cmp(&b.tau)
                .then(a.contact.cmp(&b.contact))
                .then(order(a).cmp(&order(b)))
        });
        self.begin();
    }

    /// Finds the cuts of one contact.
    fn cut(&mut self, index: usize, facts: &LawFacts) {
        let contact = &mut self.contacts[index];
        let finder = finder(&mut contact.finders, series::harmonics(&contact.gap));
        finder.sample(&contact.gap);
        let cut = |tau, level, event| Cut {
            tau,
            contact: index,
            level,
            event,
        };
        self.found.find(Some(finder), &contact.gap, &contact.levels);
        self.cuts.extend(self.found.switches().iter().map(|found| {
            let event = if found.rising {
                Event::Rising
            } else {
                Event::Falling
            };
            cut(found.tau, found.level, event)
        }));
        for (level, &value) in contact.levels.iter().enumerate() {
            let broken =
                |piece: usize| power(&facts.pieces[piece], &contact.arguments, piece == level) > 1;
            if broken(level) || broken(level + 1) {
                let misses = self.found.near_misses(finder, &contact.gap, value);
                self.cuts
                    .extend(misses.map(|tau| cut(tau, level, Event::Near)));
            }
        }
    }

    /// Puts every contact on the piece before its first switch; without any, on that of the mean, for an orbit may touch a level
    /// at a single phase.
    pub(super) fn begin(&mut self) {
        for (index, contact) in self.contacts.iter_mut().enumerate() {
            let mut switches = self.cuts.iter().filter(|cut| cut.contact == index);
            let first = switches.find(|cut| cut.event != Event::Near);
            contact.piece = first.map_or_else(
                || {
                    let mean = contact.gap[0];
                    contact.levels.iter().filter(|&&level| mean > level).count()
                },
                |cut| cut.level + usize::from(cut.event == Event::Falling),
            );
        }
    }

    /// Passes a cut.
    pub(super) fn pass(&mut self, cut: &Cut) {
        let piece = match cut.event {
            Event::Rising => cut.level + 1,
            Event::Falling => cut.level,
            Event::Near => return,
        };
        self.contacts[cut.contact].piece = piece;
    }

    /// The cut that follows after one of them, at most a period later.
    pub(super) fn next(&self, index: usize) -> Cut {
        match self.cuts.get(index + 1) {
            Some(cut) => *cut,
            None => Cut {
                tau: self.cuts[0].tau + TAU,
                ..self.cuts[0]
            },
        }
    }

    /// The cuts at both ends of the panel after a cut: of several contacts that switch together all count, also those that are a
    /// little farther away. The one at the end itself is the last and the first of them.
    pub(super) fn ends(&self, index: usize) -> [&[Cut]; 2] {
        let cuts = &self.cuts;
        let start = cuts[index].tau - TOGETHER;
        let first = cuts[..index].partition_point(|cut| cut.tau < start);
        let next = if index + 1 < cuts.len() { index + 1 } else { 0 };
        let end = cuts[next].tau + TOGETHER;
        let count = cuts[next..].partition_point(|cut| cut.tau <= end);
        [&cuts[first..=index], &cuts[next..next + count]]
    }

    /// The power with which a panel must be graded towards cuts at one of its ends.
    pub(super) fn grading(&self, cuts: &[Cut]) -> u32 {
        let powers = cuts.iter().map(|cut| self.power(cut));
        powers.max().unwrap_or(1)
    }

    fn power(&self, cut: &Cut) -> u32 {
        let contact = &self.contacts[cut.contact];
        let [lower, upper] = contact.powers[contact.piece];
        if contact.piece == cut.level {
            upper
        } else if contact.piece == cut.level + 1 {
            lower
        } else {
            1
        }
    }
}

/// The one that is prepared for so many harmonics.
fn finder(finders: &mut Vec<(usize, CrossingFinder)>, harmonics: usize) -> &mut CrossingFinder {
    let known = finders.iter().position(|(of, _)| *of == harmonics);
    let place = known.unwrap_or_else(|| {
        if finders.len() == FINDERS {
            finders.clear();
        }
        finders.push((harmonics, CrossingFinder::new(harmonics)));
        finders.len() - 1
    });
    &mut finders[place].1
}

/// Levels that coincide are crossed in their order when the gap rises, and in the opposite one when it falls.
fn order(cut: &Cut) -> isize {
    let level = cut.level as isize;
    if cut.event == Event::Falling {
        -level
    } else {
        level
    }
}

/// The power that makes the derivatives on a piece smooth at its upper or lower end.
fn power(facts: &PieceFacts, arguments: &[f64], upper: bool) -> u32 {
    let terms = facts
        .terms
        .iter()
        .filter(|term| matches!(term.of, Quantity::ByGap | Quantity::ByRate));
    power_for(&terms.map(|term| {
        let exponent = if upper { term.upper } else { term.lower };
        (exponent.value(arguments), term.logarithm)
    }))
}

impl Contact {
    fn load(&mut self, orbit: &Orbit<'_>, layout: &ContactLayout) {
        let facts = orbit.system.law(layout.law).facts();
        std::mem::swap(&mut self.arguments, &mut self.before);
        self.arguments.resize(layout.argument_count, 0.0);
        layout.arguments(orbit.coefficients, &mut self.arguments);
        if self.powers.is_empty() || self.arguments != self.before {
            let power = |piece, upper| power(piece, &self.arguments, upper);
            let pieces = facts.pieces.iter();
            self.powers.clear();
            self.powers
                .extend(pieces.map(|piece| [power(piece, false), power(piece, true)]));
        }
        orbit.levels(layout, &self.arguments, &mut self.levels);
        orbit.gap(layout, &mut self.gap);
        self.rate.resize(self.gap.len(), 0.0);
        rate_series(&self.gap, orbit.base, &mut self.rate);
    }
}
