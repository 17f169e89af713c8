//! The [extremes](Extreme) of gaps, from the series of an orbit.

use crate::balance::{Balance, gap_series};
use crate::branches::extreme::Extreme;
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
                    jumps: law.facts().levels[level].force_jumps,
                    begins: false,
                }));
            }
        }
    }
}
