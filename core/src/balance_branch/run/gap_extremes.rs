//! The [extremes](Extreme) of gaps, from the series of an orbit. Why it is not one with that of a motion: `shooting/gap_extremes.rs`.

use crate::balance::{Balance, gap_series};
use crate::branches::extreme::{Bend, Extreme};
use crate::laws::generic::narrow::Narrow;
use crate::laws::generic::scales::Scales;
use crate::model::validate;
use crate::numeric::fourier::crossings::{Crossing, CrossingFinder};
use crate::numeric::fourier::series;
use crate::system::Part;

/// Derivatives by the parameter are differences over this part of its range.
const DIFFERENCE: f64 = 1e-6;

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
    /// One entry per contact.
    scales: Vec<Option<Scales>>,
}

impl<'a> GapExtremes<'a> {
    pub(super) fn new(balance: Balance<'a>) -> Self {
        let harmonics = balance.gap_harmonics();
        let length = series::length(harmonics);
        let contacts = balance.layout().contacts.iter();
        let scales = contacts.map(|of| Scales::of(balance.system().law(of.law)));
        Self {
            scales: scales.collect(),
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
        self.set(extreme.contact);
        let (length, period) = (self.balance.length(), self.balance.resolution().period);
        let of = &self.balance.layout().contacts[extreme.contact];
        let coefficients = self.balance.coefficients();
        gap_series(of, coefficients, period, u, length, &mut self.gap);
        series::value(&self.gap, extreme.tau) - extreme.origin(&self.levels)
    }

    /// Takes the arguments and levels of a contact.
    fn set(&mut self, contact: usize) {
        let of = &self.balance.layout().contacts[contact];
        let law = self.balance.system().law(of.law);
        self.levels.resize(law.facts().levels.len(), 0.0);
        self.arguments.resize(of.argument_count, 0.0);
        of.arguments(self.balance.coefficients(), &mut self.arguments);
        law.levels(&self.arguments, &mut self.levels);
    }

    /// Finds where a gap turns. Returns its lowest and its highest value.
    fn find_turns(&mut self, u: &[f64], contact: usize) -> [f64; 2] {
        let (length, period) = (self.balance.length(), self.balance.resolution().period);
        let of = &self.balance.layout().contacts[contact];
        let coefficients = self.balance.coefficients();
        gap_series(of, coefficients, period, u, length, &mut self.gap);
        series::differentiate(&self.gap, &mut self.slope);
        self.turns.clear();
        self.finder.sample(&self.slope);
        self.finder.crossings(0.0, &mut self.turns);
        let values = self.turns.iter().map(|at| series::value(&self.gap, at.tau));
        values.fold([f64::INFINITY, f64::NEG_INFINITY], |[a, b], x| {
            [a.min(x), b.max(x)]
        })
    }

    /// The extremes that were found, from a level.
    fn seen_from(&self, level: f64, alike: Extreme) -> impl Iterator<Item = Extreme> + '_ {
        self.turns.iter().map(move |at| Extreme {
            tau: at.tau,
            maximum: !at.rising,
            above: (series::value(&self.gap, at.tau) - level) / alike.size,
            ..alike
        })
    }

    /// Writes the extremes of all gaps, from every level, in order of phase.
    pub(super) fn read(&mut self, u: &[f64], extremes: &mut Vec<Extreme>) {
        extremes.clear();
        self.balance.set(u[u.len() - 1]);
        for contact in 0..self.balance.layout().contacts.len() {
            self.set(contact);
            if self.levels.is_empty() {
                continue;
            }
            let [low, high] = self.find_turns(u, contact);
            let of = &self.balance.layout().contacts[contact];
            let facts = self.balance.system().law(of.law).facts();
            for (level, value) in self.levels.iter().enumerate() {
                let jumps = facts.levels[level].force_jumps;
                let alike = Extreme {
                    bend: Bend::at(facts, level, &self.arguments),
                    ..Extreme::of(contact, level, 0.5 * (high - low), jumps)
                };
                extremes.extend(self.seen_from(*value, alike));
            }
        }
    }

    /// The same from zero, of the gaps alone whose laws may have narrow places. Says whether there are any.
    pub(super) fn read_plain(&mut self, u: &[f64], extremes: &mut Vec<Extreme>) -> bool {
        extremes.clear();
        if self.scales.iter().all(Option::is_none) {
            return false;
        }
        self.balance.set(u[u.len() - 1]);
        let mut known = false;
        for contact in 0..self.scales.len() {
            if self.may_be_narrow(contact) {
                known = true;
                let [low, high] = self.find_turns(u, contact);
                let alike = Extreme {
                    plain: true,
                    ..Extreme::of(contact, 0, 0.5 * (high - low), false)
                };
                extremes.extend(self.seen_from(0.0, alike));
            }
        }
        known
    }

    /// Takes what belongs to a contact, and says whether its law may have narrow places.
    fn may_be_narrow(&mut self, contact: usize) -> bool {
        if self.scales[contact].is_none() {
            return false;
        }
        self.set(contact);
        let scales = self.scales[contact].as_mut();
        scales.is_some_and(|scales| {
            scales.set(&self.arguments, &self.levels);
            scales.may_be_narrow()
        })
    }

    /// Adds the narrow places of the law of a contact in a range of its gap.
    pub(super) fn narrow(
        &mut self,
        u: &[f64],
        contact: usize,
        range: [f64; 2],
        to: &mut Vec<Narrow>,
    ) {
        self.balance.set(u[u.len() - 1]);
        self.set(contact);
        if let Some(scales) = &mut self.scales[contact] {
            scales.set(&self.arguments, &self.levels);
            scales.narrow(range, to);
        }
    }
}
