//! A skeleton from the switches of an orbit: intervals from cut to cut, panels of long ones and from kink to kink, and the grading of nodes
//! by the exponents that the force has at a switch.

use std::f64::consts::TAU;

use super::Skeleton;
use super::interval::{Active, Cut, Interval, Mark};
use super::phases::Opening;
use super::placement::{Placement, Switch};
use crate::contact_equation::collocation::nodes::Nodes;
use crate::contact_equation::linear_part::configuration::Configuration;
use crate::contact_equation::linear_part::contact::Contact;
use crate::contact_equation::linear_part::values::Values;
use crate::law::{Law, Quantity, Variation};
use crate::numeric::fourier::grading;
use crate::system::System;

/// Parts of a way, and of panels, that are nearer to each other than this are one.
const CLOSE: f64 = 1e-6;

impl Skeleton {
    /// From the switches of an orbit, in the order of time from its beginning on.
    pub(in crate::contact_equation) fn new(
        system: &dyn System,
        values: &Values,
        placement: Placement,
    ) -> Self {
        let contacts = &values.contacts;
        let Placement {
            beginning,
            placed,
            kinks,
            ..
        } = placement.clone();
        let mut skeleton = Self {
            begin: beginning.phase,
            length: beginning.length(),
            order: values.order(),
            switches: placed.iter().map(|placed| placed.switch).collect(),
            openings: placed
                .iter()
                .map(|placed| opening(system, contacts, &placed.switch))
                .collect(),
            intervals: Vec::new(),
            configurations: Vec::new(),
            forces: 0,
            placement,
            refined: 0,
        };
        let end = beginning.phase + beginning.length();
        let mut pieces = beginning.pieces;
        let (mut from, mut phase) = (Cut::Begin, beginning.phase);
        let ends = placed
            .iter()
            .enumerate()
            .map(|(index, placed)| (Some(index), placed.phase));
        for (ends, next) in ends.chain([(None, end)]) {
            let to = ends.map_or(Cut::End, Cut::Switch);
            let after = ends.unwrap_or(placed.len());
            let own = kinks.iter().filter(|kink| kink.after == after);
            let way = Way {
                cuts: [from, to],
                length: next - phase,
                pieces: &pieces,
                ends,
                kinks: own.map(|kink| kink.part).collect(),
            };
            skeleton.add(system, values, &way);
            if let Some(index) = ends {
                let Switch {
                    contact,
                    level,
                    rises,
                    ..
                } = skeleton.switches[index];
                pieces[contact] = level + usize::from(rises);
            }
            (from, phase) = (to, next);
        }
        skeleton
    }

    /// Adds what lies between two cuts, in as many panels as its length asks for.
    fn add(&mut self, system: &dyn System, values: &Values, way: &Way<'_>) {
        let contacts = &values.contacts;
        let (active, configuration) = self.forced(system, values, way.pieces);
        let borders = if active.is_empty() {
            vec![0.0, 1.0]
        } else {
            self.borders(way)
        };
        let panels = borders.len() - 1;
        let [first, last] = way.cuts.map(|cut| self.steepness(system, contacts, cut));
        let [from, to] = way.cuts;
        for panel in 0..panels {
            let mark = |index: usize| match index {
                0 => Mark::at(from),
                index if index == panels => Mark::at(to),
                index => Mark {
                    from,
                    to,
                    part: borders[index],
                },
            };
            let steepness = [
                if panel == 0 { first } else { 1 },
                if panel + 1 == panels { last } else { 1 },
            ];
            let nodes = Nodes::graded(self.placement.resolution.nodes, steepness);
            let unknown = self.order + self.switches.len() + self.forces;
            let of = |(place, contact): (usize, &usize)| Active {
                contact: *contact,
                piece: way.pieces[*contact],
                first: unknown + place * nodes.count(),
            };
            let active: Vec<Active> = active.iter().enumerate().map(of).collect();
            self.forces += active.len() * nodes.count();
            self.intervals.push(Interval {
                from: mark(panel),
                to: mark(panel + 1),
                pieces: way.pieces.to_vec(),
                active,
                configuration,
                steepness,
                nodes,
                ends: way.ends.filter(|_| panel + 1 == panels),
            });
        }
    }

    /// Where panels of a way begin and end, in parts of it.
    fn borders(&self, way: &Way<'_>) -> Vec<f64> {
        let whole = self.length.min(TAU);
        let asked = self.placement.resolution.panels as f64 * way.length / whole;
        // Half of a period then has the nodes of the other half: what is its image stays that, and where this symmetry breaks branches cross.
        let is_whole = way.cuts == [Cut::Begin, Cut::End];
        if way.kinks.is_empty() {
            let panels = asked.ceil().max(1.0) as usize;
            let panels = if is_whole {
                panels.next_multiple_of(2)
            } else {
                panels
            };
            return (0..=panels)
                .map(|index| index as f64 / panels as f64)
                .collect();
        }
        let mut ends = way.kinks.clone();
        let has_half = ends.iter().any(|end| (end - 0.5).abs() < CLOSE);
        ends.extend((is_whole && !has_half).then_some(0.5));
        ends.push(1.0);
        ends.sort_by(f64::total_cmp);
        let (mut borders, mut from) = (vec![0.0], 0.0);
        for to in ends {
            // As many where rounding has made the part a little longer.
            let panels = (asked * (to - from) - CLOSE).ceil().max(1.0) as usize;
            let border = |index: usize| from + (to - from) * index as f64 / panels as f64;
            borders.extend((1..panels).map(border));
            borders.push(to);
            from = to;
        }
        borders
    }

    /// Contacts whose forces are unknown where they are on these pieces, and the configuration that has the forces, if there is one.
    fn forced(
        &mut self,
        system: &dyn System,
        values: &Values,
        pieces: &[usize],
    ) -> (Vec<usize>, Option<usize>) {
        let has_force = |contact: &usize| {
            let law = system.law(values.contacts[*contact].law);
            law.facts().pieces[pieces[*contact]].force != Variation::Zero
        };
        let active: Vec<usize> = (0..pieces.len()).filter(has_force).collect();
        if active.is_empty() {
            return (active, None);
        }
        match self.configuration(system, values, pieces) {
            None => (active, None),
            known => (Vec::new(), known),
        }
    }

    /// The configuration with contacts on these pieces, if their forces are affine.
    fn configuration(
        &mut self,
        system: &dyn System,
        values: &Values,
        pieces: &[usize],
    ) -> Option<usize> {
        let known = self.configurations.iter().position(|of| of == pieces);
        let new = || {
            let pays = Configuration::pays(self.order, values.changes);
            let of = pays.then(|| Configuration::new(system, values, pieces))?;
            of.filter(Configuration::is_sound)?;
            self.configurations.push(pieces.to_vec());
            Some(self.configurations.len() - 1)
        };
        known.or_else(new)
    }

    /// The power of the grading at a cut, which makes the force's exponents there whole.
    fn steepness(&self, system: &dyn System, contacts: &[Contact], cut: Cut) -> usize {
        let Cut::Switch(index) = cut else { return 1 };
        let Switch { contact, level, .. } = self.switches[index];
        let of = &contacts[contact];
        let exponents = exponents_at(system.law(of.law), &of.arguments, level);
        grading::power_for(&exponents.iter().copied()) as usize
    }
}

/// How the way between this switch and another one at its level is told.
fn opening(system: &dyn System, contacts: &[Contact], switch: &Switch) -> Opening {
    let facts = system.law(contacts[switch.contact].law).facts();
    if facts.levels[switch.level].force_jumps {
        Opening::Root
    } else {
        Opening::Square
    }
}

/// What is added between two cuts.
struct Way<'w> {
    cuts: [Cut; 2],
    length: f64,
    pieces: &'w [usize],
    ends: Option<usize>,
    /// Parts of it where the slope of a force jumps.
    kinks: Vec<f64>,
}

/// Exponents of a force at one of its levels, from both sides, and whether each comes with a logarithm.
fn exponents_at(law: &dyn Law, arguments: &[f64], level: usize) -> Vec<(f64, bool)> {
    let facts = law.facts();
    let below = facts.pieces[level]
        .terms
        .iter()
        .map(|term| (term, term.upper));
    let above = facts.pieces[level + 1]
        .terms
        .iter()
        .map(|term| (term, term.lower));
    below
        .chain(above)
        .filter(|(term, _)| term.of == Quantity::Force)
        .map(|(term, exponent)| (exponent.value(arguments), term.logarithm))
        .collect()
}
