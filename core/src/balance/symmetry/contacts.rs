//! Which contacts the odd symmetry takes into one another.
//!
//! A contact `e phi(g, g')` with `g = d . q - delta` goes over, at `-q` and half a period later, into one that must be there with
//! the opposite sign: with `s` and `t` one or minus one, and `p` minus one for odd waves and one for even ones,
//!
//! ```text
//! d* = -s p d,    delta* = s p delta,    e* = -t p e,    phi*(g, r) = t phi(s g, s r)                              (1)
//! ```
//!
//! A contact may be its own image: one with an odd law, even waves of its directions and odd ones of its offset (`s = t = -1`), or
//! one with odd waves of its directions and even ones of its offset (`s = t = 1`). Two stops on both sides are images of each other.
//!
//! Whether two laws are related so is known where they are one law, with equal arguments. Others are compared by their values:
//! a piece is analytic, so that two that agree to rounding at many gaps and rates, near their ends, far away, and where either
//! changes within a small distance, are one.

use std::collections::BTreeSet;
use std::f64::consts::TAU;

use super::ROUNDING;
use crate::branches::recurrence::SignedPermutation;
use crate::law::{Derivatives, On};
use crate::laws::generic::narrow::Narrow;
use crate::laws::generic::scales::Scales;
use crate::model::layout::{ContactLayout, Layout, Term};
use crate::system::{Part, System};

/// Difference up to which values of laws are equal, in parts of the size of their terms.
const EQUAL: f64 = 1e-12;
/// Distances from a level at which laws are compared, in units of the levels.
const DISTANCES: [f64; 11] = [
    1e-12, 1e-9, 1e-6, 1e-3, 0.02, 0.1, 0.37, 1.3, 4.7, 31.0, 1e3,
];
/// Where a piece with two ends is looked at, in parts of it.
const PARTS: [f64; 7] = [1e-6, 1e-3, 0.04, 0.23, 0.5, 0.81, 0.999];
/// Where a narrow place is looked at, in widths from it.
const WIDTHS: [f64; 5] = [-1.0, -0.5, 0.0, 0.5, 1.0];
/// Rates at which laws are compared.
const RATES: [f64; 6] = [0.0, 0.013, -0.37, 1.7, -7.1, 230.0];
/// The signs `s` and `t`.
const SIGNS: [[f64; 2]; 4] = [[-1.0, -1.0], [1.0, 1.0], [1.0, -1.0], [-1.0, 1.0]];

/// Place of a wave in a direction, an offset or another list, and its value.
pub(super) type Wave<P = usize> = ((P, u32, Part), f64);

/// A contact at one value of the variable.
struct Contact {
    law: usize,
    arguments: Vec<f64>,
    gap: Vec<Wave>,
    offset: Vec<Wave>,
    force: Vec<Wave>,
}

/// Whether every contact has an image among them.
pub(super) fn are_symmetric(system: &dyn System, layout: &Layout, values: &[f64]) -> bool {
    let contacts = layout.contacts.iter();
    let mut unpaired: Vec<Contact> = contacts
        .map(|contact| Contact::of(contact, values))
        .filter(|contact| !contact.force.is_empty())
        .collect();
    // Images of one contact are all alike, so that it does not matter which of them is taken.
    while let Some(contact) = unpaired.pop() {
        if contact.has_image(system, &contact) {
            continue;
        }
        let image = unpaired
            .iter()
            .position(|other| contact.has_image(system, other));
        let Some(image) = image else {
            return false;
        };
        unpaired.swap_remove(image);
    }
    true
}

/// Whether a shift by a part of the period, one of so many, takes the contacts into each other; and if it does, whether it moves
/// any, that is, takes it into one that it is not itself.
pub(super) fn shifted(
    system: &dyn System,
    layout: &Layout,
    values: &[f64],
    parts: usize,
) -> Option<bool> {
    let contacts = layout.contacts.iter();
    let all: Vec<Contact> = contacts
        .map(|contact| Contact::of(contact, values))
        .filter(|contact| !contact.force.is_empty())
        .collect();
    let mut unpaired: Vec<&Contact> = all.iter().collect();
    let mut moved = false;
    for contact in &all {
        let turned = contact.turned(parts);
        let is_image = |other: &Contact| {
            let mut signs = SIGNS.into_iter();
            signs.any(|signs| turned.is_like(system, other, signs))
        };
        let image = unpaired.iter().position(|other| is_image(other))?;
        moved |= !is_image(contact);
        unpaired.swap_remove(image);
    }
    Some(moved)
}

/// The contacts that take each other's place a part of the period later, one of so many, one after the other, where they do so at all of
/// some values of the coefficients.
pub(crate) fn cycles(
    system: &dyn System,
    layout: &Layout,
    values: &[Vec<f64>],
    parts: usize,
) -> Option<Vec<Vec<usize>>> {
    let count = layout.contacts.len();
    let at = |contact: usize| -> Vec<Contact> {
        let of = &layout.contacts[contact];
        values
            .iter()
            .map(|values| Contact::of(of, values))
            .collect()
    };
    let all: Vec<Vec<Contact>> = (0..count).map(at).collect();
    let mut images: Vec<usize> = Vec::with_capacity(count);
    for contact in &all {
        let turned: Vec<Contact> = contact.iter().map(|of| of.turned(parts)).collect();
        let is_image = |other: &usize| {
            let pairs = || turned.iter().zip(&all[*other]);
            let mut signs = SIGNS.into_iter();
            !images.contains(other)
                && signs.any(|signs| pairs().all(|(of, other)| of.is_like(system, other, signs)))
        };
        let image = (0..count).find(is_image)?;
        images.push(image);
    }
    let mut cycles: Vec<Vec<usize>> = Vec::new();
    for first in 0..count {
        if cycles.iter().any(|cycle| cycle.contains(&first)) {
            continue;
        }
        let others = std::iter::successors(Some(images[first]), |of| Some(images[*of]));
        let others = others.take_while(|of| *of != first);
        cycles.push(std::iter::once(first).chain(others).collect());
    }
    Some(cycles)
}

/// Whether all contacts are taken into each other where coordinates take each other's place, a part of the period later, one of so many.
pub(super) fn are_permuted(
    system: &dyn System,
    layout: &Layout,
    values: &[f64],
    image: &SignedPermutation,
    parts: usize,
) -> bool {
    let contacts = layout.contacts.iter();
    let all: Vec<Contact> = contacts
        .map(|contact| Contact::of(contact, values))
        .filter(|contact| !contact.force.is_empty())
        .collect();
    let mut unpaired: Vec<&Contact> = all.iter().collect();
    all.iter().all(|contact| {
        let moved = contact.moved(image).turned(parts);
        let is_image = |other: &&Contact| {
            let mut signs = SIGNS.into_iter();
            signs.any(|signs| moved.is_like(system, other, signs))
        };
        let found = unpaired.iter().position(is_image);
        found.is_some_and(|found| {
            unpaired.swap_remove(found);
            true
        })
    })
}

/// Harmonics of the waves of all contacts, each once.
pub(super) fn harmonics(layout: &Layout) -> BTreeSet<usize> {
    let contacts = layout.contacts.iter();
    let terms = contacts.flat_map(|contact| [&contact.gap, &contact.offset, &contact.force]);
    let terms = terms.flatten();
    terms.map(|term| term.wave.harmonic as usize).collect()
}

impl Contact {
    /// A part of the period later.
    fn turned(&self, parts: usize) -> Self {
        let turned = |waves: &Vec<Wave>| turned(waves, parts);
        Self {
            law: self.law,
            arguments: self.arguments.clone(),
            gap: turned(&self.gap),
            offset: turned(&self.offset),
            force: turned(&self.force),
        }
    }

    /// With coordinates, and their equations, in each other's place.
    fn moved(&self, image: &SignedPermutation) -> Self {
        let moved = |waves: &Vec<Wave>| {
            let waves = waves.iter().map(|((index, harmonic, part), value)| {
                let (place, sign) = image.entry(*index);
                ((place, *harmonic, *part), sign * value)
            });
            waves.collect()
        };
        Self {
            law: self.law,
            arguments: self.arguments.clone(),
            gap: moved(&self.gap),
            offset: self.offset.clone(),
            force: moved(&self.force),
        }
    }

    /// Whether `d* = s d`, `delta* = s delta`, `e* = t e` and `phi*(g, r) = t phi(s g, s r)` for the other contact.
    fn is_like(&self, system: &dyn System, other: &Self, [s, t]: [f64; 2]) -> bool {
        are_equal(&self.gap, s, &other.gap)
            && are_equal(&self.offset, s, &other.offset)
            && are_equal(&self.force, t, &other.force)
            && self.law_becomes(system, other, [s, t])
    }

    fn of(layout: &ContactLayout, values: &[f64]) -> Self {
        let mut arguments = vec![0.0; layout.argument_count];
        layout.arguments(values, &mut arguments);
        Self {
            law: layout.law,
            arguments,
            gap: gathered(&layout.gap, values),
            offset: gathered(&layout.offset, values),
            force: gathered(&layout.force, values),
        }
    }

    /// Whether (1) takes this contact into the other one.
    fn has_image(&self, system: &dyn System, other: &Self) -> bool {
        SIGNS.into_iter().any(|[s, t]| {
            are_times(&self.gap, -s, &other.gap)
                && are_times(&self.offset, s, &other.offset)
                && are_times(&self.force, -t, &other.force)
                && self.law_becomes(system, other, [s, t])
        })
    }

    /// Whether `phi*(g, r) = t phi(s g, s r)` for the law of the other contact.
    fn law_becomes(&self, system: &dyn System, other: &Self, [s, t]: [f64; 2]) -> bool {
        if self.law == other.law && self.arguments == other.arguments {
            let odd = system.law(self.law).facts().odd;
            if (s, t) == (1.0, 1.0) || (odd && (s, t) == (-1.0, -1.0)) {
                return true;
            }
        }
        let [of, to] = [self, other].map(|contact| {
            let mut levels = vec![0.0; system.law(contact.law).facts().levels.len()];
            let law = system.law(contact.law);
            law.levels(&contact.arguments, &mut levels);
            levels
        });
        let count = to.len();
        let turned = |index: usize, last: usize| if s < 0.0 { last - index } else { index };
        let unit = to.iter().fold(0.0, |m: f64, level| m.max(level.abs()));
        let near = |(index, level): (usize, &f64)| {
            (level - s * of[turned(index, count - 1)]).abs() <= EQUAL * unit
        };
        if of.len() != count || !to.iter().enumerate().all(near) {
            return false;
        }
        let unit = if unit > 0.0 { unit } else { 1.0 };
        let own = self.narrow(system, &of, unit).map(|gap| s * gap);
        let narrow: Vec<f64> = own.chain(other.narrow(system, &to, unit)).collect();
        (0..=count).all(|piece| {
            let mut gaps = gaps(&to, piece, unit);
            let below = |gap: &f64| to.iter().filter(|level| *gap > **level).count();
            gaps.extend(narrow.iter().filter(|gap| below(gap) == piece));
            let [there, here] = [(other, 1.0, piece), (self, s, turned(piece, count))]
                .map(|(contact, sign, piece)| contact.sampled(system, piece, &gaps, sign));
            let equal = |((x, size), (y, other)): (&(f64, f64), &(f64, f64))| {
                let beyond = !x.is_finite() && !y.is_finite();
                beyond || (x - t * y).abs() <= EQUAL * size.max(*other)
            };
            there.iter().zip(&here).all(equal)
        })
    }

    /// Gaps in and beside narrow places of the law.
    fn narrow(
        &self,
        system: &dyn System,
        levels: &[f64],
        unit: f64,
    ) -> impl Iterator<Item = f64> + use<> {
        let mut found = Vec::new();
        if let Some(mut scales) = Scales::of(system.law(self.law)) {
            scales.set(&self.arguments, levels);
            if scales.may_be_narrow() {
                for distance in DISTANCES {
                    scales.narrow([-distance * unit, distance * unit], &mut found);
                }
            }
        }
        let beside = |place: Narrow| WIDTHS.map(|widths| place.at + widths * place.width);
        found.into_iter().flat_map(beside)
    }

    /// Forces on one piece at the gaps, times a sign, and all rates, each with the size of its terms.
    fn sampled(
        &self,
        system: &dyn System,
        piece: usize,
        gaps: &[f64],
        sign: f64,
    ) -> Vec<(f64, f64)> {
        let pairs = gaps
            .iter()
            .flat_map(|gap| RATES.map(|rate| (sign * gap, sign * rate)));
        let (gap, rate): (Vec<f64>, Vec<f64>) = pairs.unzip();
        let mut force = vec![0.0; gap.len()];
        let (mut by_gap, mut by_rate) = (force.clone(), force.clone());
        let out = Derivatives {
            force: &mut force,
            by_gap: &mut by_gap,
            by_rate: &mut by_rate,
        };
        let law = system.law(self.law);
        law.derivatives(On::Piece(piece), &self.arguments, &gap, &rate, out);
        let size =
            |i: usize| force[i].abs() + (gap[i] * by_gap[i]).abs() + (rate[i] * by_rate[i]).abs();
        (0..force.len()).map(|i| (force[i], size(i))).collect()
    }
}

/// Gaps on a piece, near its ends and far away.
fn gaps(levels: &[f64], piece: usize, unit: f64) -> Vec<f64> {
    let below = piece.checked_sub(1).map(|level| levels[level]);
    match (below, levels.get(piece)) {
        (None, None) => DISTANCES
            .iter()
            .flat_map(|x| [x * unit, -x * unit])
            .collect(),
        (Some(from), None) => DISTANCES.map(|x| from + x * unit).to_vec(),
        (None, Some(to)) => DISTANCES.map(|x| to - x * unit).to_vec(),
        (Some(from), Some(to)) => PARTS.map(|x| from + x * (to - from)).to_vec(),
    }
}

/// The terms of a direction or an offset, those at one place added; without those that are zero.
pub(super) fn gathered(terms: &[Term], values: &[f64]) -> Vec<Wave> {
    let mut gathered: Vec<Wave> = Vec::new();
    for term in terms {
        let place = (term.index, term.wave.harmonic, term.wave.part);
        let value = values[term.coefficient];
        match gathered.iter_mut().find(|(other, _)| *other == place) {
            Some((_, sum)) => *sum += value,
            None => gathered.push((place, value)),
        }
    }
    let size = largest(&gathered);
    gathered.retain(|(_, value)| value.abs() > ROUNDING * size);
    gathered
}

fn largest(waves: &[Wave]) -> f64 {
    waves
        .iter()
        .fold(0.0, |m: f64, (_, value)| m.max(value.abs()))
}

/// Whether the even waves times a factor, and the odd ones times its negative, are those of another list.
fn are_times(waves: &[Wave], factor: f64, others: &[Wave]) -> bool {
    let size = largest(waves).max(largest(others));
    let equal = |(place, value): &Wave| {
        let factor = if place.1 % 2 == 1 { -factor } else { factor };
        let other = others.iter().find(|(other, _)| other == place);
        other.is_some_and(|(_, other)| (factor * value - other).abs() <= ROUNDING * size)
    };
    waves.len() == others.len() && waves.iter().all(equal)
}

/// The waves a part of the period later, one of so many.
pub(super) fn turned<P: Copy + PartialEq>(waves: &[Wave<P>], parts: usize) -> Vec<Wave<P>> {
    let mut turned: Vec<Wave<P>> = Vec::new();
    let mut add = |place: (P, u32, Part), value: f64| match turned
        .iter_mut()
        .find(|(other, _)| *other == place)
    {
        Some((_, sum)) => *sum += value,
        None => turned.push((place, value)),
    };
    for &((index, harmonic, part), value) in waves {
        let angle = TAU * (harmonic as usize % parts) as f64 / parts as f64;
        let (sine, cosine) = angle.sin_cos();
        let (other, sign) = match part {
            Part::Cosine => (Part::Sine, -1.0),
            Part::Sine => (Part::Cosine, 1.0),
        };
        add((index, harmonic, part), value * cosine);
        if harmonic > 0 {
            add((index, harmonic, other), sign * value * sine);
        }
    }
    turned
}

/// Whether the waves times a factor are those of another list, where one that is missing is zero.
fn are_equal(waves: &[Wave], factor: f64, others: &[Wave]) -> bool {
    let size = largest(waves).max(largest(others));
    let at = |waves: &[Wave], place: &(usize, u32, Part)| {
        let found = waves.iter().find(|(other, _)| other == place);
        found.map_or(0.0, |(_, value)| *value)
    };
    let mut places = waves.iter().chain(others).map(|(place, _)| place);
    places.all(|place| (factor * at(waves, place) - at(others, place)).abs() <= ROUNDING * size)
}
