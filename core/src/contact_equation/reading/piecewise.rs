//! Outputs that are sums of coordinates, rates and forces of contacts. On an interval where a contact is on a piece without force or with an affine one,
//! its force is such a sum itself,
//!
//! ```text
//! phi = phi_0 + k (d . q - delta - g_0) + c d . q'                                                             (1)
//! ```
//!
//! so that an output is one there, is nothing but a number where no contact of it acts, and is read as sums of coordinates are. On other intervals outputs are read
//! instant by instant, by rules of quadrature.
//!
//! Source: Shaw and Holmes (1983), A periodically forced piecewise linear oscillator, Journal of Sound and Vibration 90(1) (the force of an elastic stop from the motion,
//! in closed form on each side of it).

use std::f64::consts::TAU;

use super::plain_outputs::{self, Plain, Sum, finish};
use super::stretch::Read;
use crate::branches::observed::Motion as Extent;
use crate::branches::recurrence::Recurrence;
use crate::contact_equation::linear_part::configuration::Affine;
use crate::contact_equation::orbit::extremes::{Outputs, Sampled, read};
use crate::contact_equation::orbit::motion::{Motion, Within};
use crate::contact_equation::orbit::signal::{Of, Term};
use crate::law::Variation;
use crate::shooting::signals::Reader;
use crate::system::System;
use crate::time::signals::{Asked, Signals};

/// Of what is no force.
const UNBOUNDED: [f64; 2] = [f64::NEG_INFINITY, f64::INFINITY];

/// Outputs over an orbit.
pub(super) struct Piecewise<'o, 'e> {
    pub(super) system: &'o dyn System,
    pub(super) parameters: &'o [f64],
    pub(super) omega: f64,
    pub(super) motion: &'o Motion<'e>,
}

/// What an output is on an interval in one part of the period.
struct Form {
    sum: Plain,
    /// A force is no more, and no less, than at the ends of its piece: rounding must not take it beyond these.
    within: [f64; 2],
}

/// An interval in one part of the period, and the pieces of all contacts there.
struct Stretch<'s> {
    sampled: &'s Sampled,
    part: usize,
    pieces: Vec<usize>,
}

/// What is known of an output: its extremes, and integrals of it and of its square by the phase.
struct Found {
    extent: Extent,
    integrals: [f64; 2],
}

impl Piecewise<'_, '_> {
    /// What all outputs do over the period.
    pub(super) fn read(&self) -> Vec<Extent> {
        let sums = plain_outputs::all(self.system, self.parameters, self.omega);
        if sums.is_empty() {
            return Vec::new();
        }
        let has_forces = |sum: &Option<Sum>| sum.as_ref().is_some_and(|sum| !sum.forces.is_empty());
        let signals = sums.iter().any(has_forces).then(|| self.signals());
        let stretches = self.stretches(signals.as_ref());
        let forms = sums.iter().map(|sum| {
            let of = |stretch: &Stretch<'_>| self.form(sum.as_ref()?, stretch);
            stretches.iter().map(of).collect()
        });
        let forms: Vec<Vec<Option<Form>>> = forms.collect();
        let outputs = 0..forms.len();
        let open: Vec<usize> = outputs
            .filter(|output| forms[*output].iter().any(Option::is_none))
            .collect();
        // Where one of these is read by rules, all of them are, in all parts.
        let mut by_rules: Vec<usize> = Vec::new();
        for (at, stretch) in stretches.iter().enumerate() {
            if open.iter().any(|output| forms[*output][at].is_none()) {
                by_rules.push(stretch.sampled.interval());
            }
        }
        let mut others = self.by_rules(&open, &by_rules).into_iter();
        let outputs = forms.iter().enumerate().map(|(output, forms)| {
            let is_open = open.contains(&output);
            let passes =
                |stretch: &Stretch<'_>| is_open && by_rules.contains(&stretch.sampled.interval());
            let pairs = forms.iter().zip(&stretches);
            let pairs = pairs.filter(|(_, stretch)| !passes(stretch));
            let mut found =
                self.of_forms(pairs.filter_map(|(form, of)| Some((form.as_ref()?, of))));
            if let Some(other) = is_open.then(|| others.next()).flatten() {
                found.add(&other, self.length());
            }
            finish(found.extent, found.integrals, self.recurrence())
        });
        outputs.collect()
    }

    fn recurrence(&self) -> &Recurrence {
        self.motion.equations.skeleton.recurrence()
    }

    /// Phase of the whole period.
    fn length(&self) -> f64 {
        TAU * self.recurrence().period as f64
    }

    fn signals(&self) -> Signals<'_> {
        Signals::new(self.system, self.parameters, self.omega, Asked::Outputs)
    }

    /// All intervals that take time in all parts of the period, with the pieces that gaps are on in their middles, if they are asked for.
    fn stretches(&self, signals: Option<&Signals<'_>>) -> Vec<Stretch<'_>> {
        let recurrence = self.recurrence();
        let contacts = self.motion.equations.values.contacts.len();
        let states = || vec![0.0; self.motion.equations.skeleton.order];
        let (mut state, mut moved) = (states(), states());
        let mut found = Vec::new();
        for part in 0..recurrence.parts {
            let image = recurrence.image.power(part);
            let later = self.length() * part as f64 / recurrence.parts as f64;
            for sampled in self.motion.sampled() {
                let mut pieces = Vec::new();
                if let Some(signals) = signals {
                    let [from, to] = self.motion.phases(sampled.interval());
                    let middle = 0.5 * (from + to);
                    self.motion.state(sampled.interval(), middle, &mut state);
                    image.write(&state, &mut moved);
                    pieces.resize(contacts, 0);
                    signals.place(middle + later, &moved, &mut pieces);
                }
                found.push(Stretch {
                    sampled,
                    part,
                    pieces,
                });
            }
        }
        found
    }

    /// What a sum is on a stretch; nothing where a force is not affine or its gap moves by itself, or where rates are not in closed form.
    fn form(&self, sum: &Sum, stretch: &Stretch<'_>) -> Option<Form> {
        let Plain {
            mut terms,
            mut constant,
        } = sum.linear.clone();
        let mut within = if terms.is_empty() {
            [constant; 2]
        } else {
            UNBOUNDED
        };
        for &(contact, factor) in &sum.forces {
            let of = &self.motion.equations.values.contacts[contact];
            let piece = stretch.pieces[contact];
            let facts = &self.system.law(of.law).facts().pieces[piece];
            if factor == 0.0 || facts.force == Variation::Zero {
                continue;
            }
            if !facts.affine || !of.stands() {
                return None;
            }
            let affine = Affine::of(self.system, of, piece);
            constant +=
                factor * (affine.force - affine.by_gap * (affine.at + of.constant_offset()));
            for (coordinate, along) in of.constant_direction().iter().enumerate() {
                for (of_rate, by) in [(false, affine.by_gap), (true, affine.by_rate)] {
                    if by * along != 0.0 {
                        terms.push(Term {
                            coordinate,
                            of_rate,
                            factor: factor * by * along,
                        });
                    }
                }
            }
            let own = of.force_at_ends(&affine, piece).map(|force| factor * force);
            within[0] += own[0].min(own[1]);
            within[1] += own[0].max(own[1]);
        }
        let closed = self.motion.is_closed(stretch.sampled.interval());
        let has_rates = terms.iter().any(|term| term.of_rate);
        let image = self.recurrence().image.power(stretch.part);
        (closed || !has_rates).then(|| Form {
            sum: Plain {
                terms: plain_outputs::image(&terms, &image),
                constant,
            },
            within,
        })
    }

    /// Reads what is a sum on some stretches.
    fn of_forms<'f>(&self, forms: impl Iterator<Item = (&'f Form, &'f Stretch<'f>)>) -> Found {
        let mut found = Found {
            extent: Extent::NONE,
            integrals: [0.0; 2],
        };
        let mut within = [f64::INFINITY, f64::NEG_INFINITY];
        let mut moving = Vec::new();
        for (form, stretch) in forms {
            let Form { sum, within: own } = form;
            within = [within[0].min(own[0]), within[1].max(own[1])];
            if sum.terms.is_empty() {
                let [from, to] = self.motion.phases(stretch.sampled.interval());
                found.extent.include(sum.constant);
                found.integrals[0] += (to - from) * sum.constant;
                found.integrals[1] += (to - from) * sum.constant * sum.constant;
            } else {
                moving.push((stretch.sampled, Of::Sum(&sum.terms, sum.constant)));
            }
        }
        if !moving.is_empty() {
            let Outputs {
                least,
                most,
                integrals,
            } = read(self.motion, moving.into_iter());
            found.extent.include(least.max(within[0]));
            found.extent.include(most.min(within[1]));
            for (sum, own) in found.integrals.iter_mut().zip(integrals) {
                *sum += own;
            }
        }
        found
    }

    /// Reads some outputs by rules, on some intervals.
    fn by_rules(&self, outputs: &[usize], intervals: &[usize]) -> Vec<Extent> {
        if outputs.is_empty() {
            return Vec::new();
        }
        let coordinates = self.motion.equations.skeleton.order / 2;
        let signals = self.signals().only(outputs);
        let mut reader = Reader::new(signals, self.recurrence(), coordinates, 0);
        let all = self.motion.sampled().iter().map(Sampled::interval);
        for interval in all.filter(|interval| intervals.contains(interval)) {
            reader.include(&Read::new(Within {
                motion: self.motion,
                interval,
            }));
        }
        reader.motions()
    }
}

impl Found {
    /// Adds what was found elsewhere, as if that were over all of a period that is so long.
    fn add(&mut self, other: &Extent, length: f64) {
        self.extent.include(other.minimum);
        self.extent.include(other.maximum);
        let [mean, rms] = [other.mean, other.rms].map(|x| x.unwrap_or(f64::NAN));
        self.integrals[0] += length * mean;
        self.integrals[1] += length * rms * rms;
    }
}
