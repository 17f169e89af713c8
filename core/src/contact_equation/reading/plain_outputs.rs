//! Outputs that are sums of coordinates: their extremes are found as those of coordinates, and their means from what the motion is made of. With many modes
//! that takes a small part of what reading all coordinates takes, instant by instant.
//!
//! Source: Meirovitch (2001), Fundamentals of Vibrations, section 7.15.

use std::f64::consts::TAU;

use crate::branches::observed::Motion as Extent;
use crate::branches::recurrence::{Recurrence, SignedPermutation};
use crate::contact_equation::orbit::extremes::read;
use crate::contact_equation::orbit::motion::Motion;
use crate::contact_equation::orbit::signal::Term;
use crate::system::{Place, Signal, System, Wave};

/// A sum of coordinates and a constant.
struct Plain {
    terms: Vec<Term>,
    constant: f64,
}

/// All outputs, if each is such a sum.
fn plain(system: &dyn System, parameters: &[f64], omega: f64) -> Option<Vec<Plain>> {
    let facts = system.facts();
    let nothing = || Plain {
        terms: Vec::new(),
        constant: 0.0,
    };
    let is_output = |place: &Place| matches!(place, Place::Output { .. });
    let is_plain = |place: &Place| {
        !matches!(place, Place::Output { of, wave, .. }
            if *wave != Wave::CONSTANT || !matches!(of, Signal::Coordinate(_) | Signal::Constant))
    };
    if !facts.places.iter().all(is_plain) {
        return None;
    }
    let mut found: Vec<Plain> = facts.outputs.iter().map(|_| nothing()).collect();
    let mut coefficients = vec![0.0; facts.places.len()];
    system.coefficients(parameters, omega, &mut coefficients);
    let pairs = facts.places.iter().zip(&coefficients);
    for (place, &factor) in pairs.filter(|(place, _)| is_output(place)) {
        let Place::Output { output, of, .. } = *place else {
            continue;
        };
        match of {
            Signal::Coordinate(coordinate) => {
                found[output].terms.push(Term { coordinate, factor });
            }
            _ => found[output].constant += factor,
        }
    }
    Some(found)
}

/// What all outputs do over the period; nothing if one of them is more than a sum of coordinates.
pub(super) fn motions(
    motion: &Motion<'_>,
    system: &dyn System,
    parameters: &[f64],
    omega: f64,
) -> Option<Vec<Extent>> {
    let outputs = plain(system, parameters, omega)?;
    let sampled = motion.sampled();
    let recurrence = motion.equations.skeleton.recurrence();
    let found = outputs.iter().map(|output| {
        let mut whole = Extent {
            mean: Some(0.0),
            rms: Some(0.0),
            ..Extent::NONE
        };
        let mut sums = [0.0; 2];
        for part in 0..recurrence.parts {
            let terms = image(&output.terms, &recurrence.image.power(part));
            let found = read(motion, sampled, &terms, output.constant);
            whole.include(found.least);
            whole.include(found.most);
            for (sum, own) in sums.iter_mut().zip(found.integrals) {
                *sum += own;
            }
        }
        finish(whole, sums, recurrence)
    });
    Some(found.collect())
}

/// The terms of an output as they are where coordinates are in each other's place.
fn image(terms: &[Term], image: &SignedPermutation) -> Vec<Term> {
    let terms = terms.iter().map(|term| {
        let (coordinate, sign) = image.entry(term.coordinate);
        Term {
            coordinate,
            factor: sign * term.factor,
        }
    });
    terms.collect()
}

fn finish(whole: Extent, sums: [f64; 2], recurrence: &Recurrence) -> Extent {
    let length = TAU * recurrence.period as f64;
    Extent {
        mean: Some(sums[0] / length),
        rms: Some((sums[1] / length).max(0.0).sqrt()),
        ..whole
    }
}
