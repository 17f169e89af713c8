//! Outputs that are sums of coordinates: their extremes are found as those of coordinates, and their means from what the motion is made of. With many modes
//! that takes a small part of what reading all coordinates takes, instant by instant.
//!
//! Source: Meirovitch (2001), Fundamentals of Vibrations, section 7.15.

use std::f64::consts::TAU;

use crate::branches::observed::Motion as Extent;
use crate::branches::recurrence::{Recurrence, SignedPermutation};
use crate::contact_equation::orbit::extremes::read;
use crate::contact_equation::orbit::motion::Motion;
use crate::contact_equation::orbit::signal::{Of, Term};
use crate::system::{Place, Signal, System, Wave};

/// A sum of coordinates and a constant.
#[derive(Debug, Clone)]
pub(super) struct Plain {
    pub(super) terms: Vec<Term>,
    pub(super) constant: f64,
}

impl Plain {
    /// What it adds up, by size, where all coordinates are as far as they come at once.
    pub(super) fn added(&self, motions: &[Extent]) -> f64 {
        let far = |term: &Term| term.factor.abs() * motions[term.coordinate].farthest();
        self.terms.iter().map(far).sum::<f64>() + self.constant.abs()
    }

    /// How far it is in one state from what it is in another one.
    pub(super) fn apart(&self, [a, b]: [&[f64]; 2]) -> f64 {
        let terms = self.terms.iter();
        let apart = terms.map(|term| term.factor * (a[term.coordinate] - b[term.coordinate]));
        apart.sum::<f64>().abs()
    }
}

/// A sum of coordinates, rates and forces of contacts.
pub(super) struct Sum {
    /// All of it but the forces; rates are among its terms.
    pub(super) linear: Plain,
    /// Contacts, and what their forces are multiplied by.
    pub(super) forces: Vec<(usize, f64)>,
}

impl Sum {
    /// What it is if there are coordinates alone.
    pub(super) fn plain(self) -> Option<Plain> {
        let rates = self.linear.terms.iter().any(|term| term.of_rate);
        (self.forces.is_empty() && !rates).then_some(self.linear)
    }
}

/// One output, if it is a sum of coordinates.
pub(super) fn one(
    system: &dyn System,
    parameters: &[f64],
    omega: f64,
    output: usize,
) -> Option<Plain> {
    let mut outputs = all(system, parameters, omega);
    let of = (output < outputs.len()).then(|| outputs.swap_remove(output))?;
    of?.plain()
}

/// All outputs; nothing of one that is no such sum.
pub(super) fn all(system: &dyn System, parameters: &[f64], omega: f64) -> Vec<Option<Sum>> {
    let facts = system.facts();
    let nothing = || Sum {
        linear: Plain {
            terms: Vec::new(),
            constant: 0.0,
        },
        forces: Vec::new(),
    };
    let mut found: Vec<_> = facts.outputs.iter().map(|_| Some(nothing())).collect();
    let mut coefficients = vec![0.0; facts.places.len()];
    system.coefficients(parameters, omega, &mut coefficients);
    for (place, &factor) in facts.places.iter().zip(&coefficients) {
        let Place::Output { output, of, wave } = *place else {
            continue;
        };
        let Some(sum) = &mut found[output] else {
            continue;
        };
        let mut add = |coordinate, of_rate| {
            sum.linear.terms.push(Term {
                coordinate,
                of_rate,
                factor,
            });
        };
        match of {
            _ if wave != Wave::CONSTANT => found[output] = None,
            Signal::Coordinate(coordinate) => add(coordinate, false),
            Signal::Rate(coordinate) => add(coordinate, true),
            Signal::Force(contact) => sum.forces.push((contact, factor)),
            Signal::Constant => sum.linear.constant += factor,
            _ => found[output] = None,
        }
    }
    found
}

impl Plain {
    /// What it does over the period.
    pub(super) fn motion(&self, motion: &Motion<'_>) -> Extent {
        let sampled = motion.sampled();
        let recurrence = motion.equations.skeleton.recurrence();
        let mut whole = Extent::NONE;
        let mut sums = [0.0; 2];
        for part in 0..recurrence.parts {
            let terms = image(&self.terms, &recurrence.image.power(part));
            let of = |sampled| (sampled, Of::Sum(&terms, self.constant));
            let found = read(motion, sampled.iter().map(of));
            whole.include(found.least);
            whole.include(found.most);
            for (sum, own) in sums.iter_mut().zip(found.integrals) {
                *sum += own;
            }
        }
        finish(whole, sums, recurrence)
    }
}

/// The terms of an output as they are where coordinates are in each other's place.
pub(super) fn image(terms: &[Term], image: &SignedPermutation) -> Vec<Term> {
    let terms = terms.iter().map(|term| {
        let (coordinate, sign) = image.entry(term.coordinate);
        Term {
            coordinate,
            of_rate: term.of_rate,
            factor: sign * term.factor,
        }
    });
    terms.collect()
}

/// Extremes with the integrals over the period of the signal and of its square.
pub(super) fn finish(whole: Extent, sums: [f64; 2], recurrence: &Recurrence) -> Extent {
    let length = TAU * recurrence.period as f64;
    Extent {
        mean: Some(sums[0] / length),
        rms: Some((sums[1] / length).max(0.0).sqrt()),
        ..whole
    }
}
