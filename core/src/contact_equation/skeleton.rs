//! Which pieces the gaps of an orbit are on, one after the other, and where the unknowns that tell it stand.
//!
//! The period is cut where a gap switches from one piece of its law to the next. What lies between two successive cuts is an *interval*: on
//! each the forces of contacts whose piece has one are unknown at [nodes](super::nodes), and those of the others are zero. Where they are
//! affine, they are in a [configuration](super::configuration) of the linear part, and none is unknown.
//!
//! ```text
//! u = [ states at the beginning | places of switches | forces at nodes, interval by interval | parameter ]     (1)
//! ```
//!
//! A switch has its phase as unknown. Two that may meet, since the stretch between them is short, have their middle `c` and `H`, the square
//! of half of the way between them:
//!
//! ```text
//! tau = c -+ sqrt(H),    (g_1 + g_2)/2 = level,    (g_2 - g_1)/(2 sqrt H) = 0,    H > 0                       (2)
//! g(c) - level + (g''/2) H = 0,    g'(c) = 0,                                     H <= 0                      (3)
//! ```
//!
//! So `H` passes zero smoothly where the gap touches its level: beyond, (3) goes on with the extreme of a gap that does not reach it. Where
//! the force jumps at the level, the orbit goes as the root of `H > 0`, which is the unknown there then.
//!
//! Of an orbit that comes back after a part of its period with an image `S` of its coordinates that part is cut, and its end is `S` of its
//! beginning.
//!
//! Source: di Bernardo, Budd, Champneys and Kowalczyk (2008), Piecewise-smooth Dynamical Systems, section 6.2 (grazing: the time in
//! contact grows as the root of the penetration).

use std::f64::consts::TAU;

use super::configuration::Configuration;
use super::grading::STEEPEST;
use super::nodes::{COUNTS, Nodes};
use super::place::{Opening, Place};
use super::placement::{Placement, Switch, Told};
use super::values::{Contact, Values};
use crate::branches::recurrence::Recurrence;
use crate::law::{Law, Quantity, Variation};
use crate::numeric::fourier::grading;
use crate::system::System;

/// A stretch is short where `H` is less.
const OPEN: f64 = 0.05;

/// Where an interval begins or ends.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Cut {
    /// Where the period begins.
    Begin,
    /// Where it ends.
    End,
    /// At a switch.
    Switch(usize),
}

/// A part of the way from one cut to another.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Mark {
    pub(super) from: Cut,
    pub(super) to: Cut,
    pub(super) part: f64,
}

impl Mark {
    fn at(cut: Cut) -> Self {
        Self {
            from: cut,
            to: cut,
            part: 0.0,
        }
    }
}

/// A contact whose force is unknown on an interval.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Active {
    pub(super) contact: usize,
    pub(super) piece: usize,
    /// Place of the first of its forces among the unknowns.
    pub(super) first: usize,
}

/// What lies between two cuts, or a part of it.
#[derive(Debug, Clone)]
pub(super) struct Interval {
    pub(super) from: Mark,
    pub(super) to: Mark,
    /// Per contact.
    pub(super) pieces: Vec<usize>,
    pub(super) active: Vec<Active>,
    /// The configuration that has the forces, where none is unknown although there are some.
    pub(super) configuration: Option<usize>,
    pub(super) nodes: &'static Nodes,
    /// The switch where it ends.
    pub(super) ends: Option<usize>,
}

impl Interval {
    /// Number of its forces.
    pub(super) fn forces(&self) -> usize {
        self.active.len() * self.nodes.count()
    }

    /// Place of the first of them among the unknowns.
    pub(super) fn first(&self) -> usize {
        self.active.first().map_or(0, |active| active.first)
    }

    /// Half of the way from its beginning to its end.
    fn middle(&self) -> Mark {
        // Panels of one way have the same ends; a whole one has its own.
        if (self.from.from, self.from.to) == (self.to.from, self.to.to)
            && self.from.part != self.to.part
        {
            return Mark {
                part: 0.5 * (self.from.part + self.to.part),
                ..self.from
            };
        }
        let whole = |mark: Mark| mark.from == mark.to;
        let [from, to] = match [whole(self.from), whole(self.to)] {
            [true, true] => [self.from.from, self.to.from],
            [true, false] => [self.to.from, self.to.to],
            _ => [self.from.from, self.from.to],
        };
        let part = |mark: Mark, end: f64| if whole(mark) { end } else { mark.part };
        Mark {
            from,
            to,
            part: 0.5 * (part(self.from, 0.0) + part(self.to, 1.0)),
        }
    }
}

/// All of it.
#[derive(Debug, Clone)]
pub(super) struct Skeleton {
    /// Phase where the period begins, or the part of it after which the orbit comes back, and its length.
    pub(super) begin: f64,
    pub(super) length: f64,
    /// Number of states.
    pub(super) order: usize,
    /// In the order of time.
    pub(super) switches: Vec<Switch>,
    /// How the way between two of them is told.
    openings: Vec<Opening>,
    pub(super) intervals: Vec<Interval>,
    /// Pieces of the contacts in every configuration.
    pub(super) configurations: Vec<Vec<usize>>,
    /// Number of forces.
    pub(super) forces: usize,
    pub(super) placement: Placement,
}

impl Skeleton {
    /// From the switches of an orbit, in the order of time from its beginning on.
    pub(super) fn new(system: &dyn System, values: &Values, placement: Placement) -> Self {
        let contacts = &values.contacts;
        let Placement {
            beginning, placed, ..
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
            let way = Way {
                cuts: [from, to],
                length: next - phase,
                pieces: &pieces,
                ends,
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

    /// The same with more nodes, and with more panels where those are as many as can be.
    pub(super) fn finer(&self) -> Self {
        let most = COUNTS[COUNTS.len() - 1];
        let mut finer = self.clone();
        finer.forces = 0;
        finer.intervals.clear();
        let first = self.order + self.switches.len();
        for interval in &self.intervals {
            let count = interval.nodes.count();
            let next = COUNTS.iter().copied().find(|more| *more > count);
            let parts = if next.is_none() && !interval.active.is_empty() {
                2
            } else {
                1
            };
            for part in 0..parts {
                let grading = interval.nodes.grading;
                let grading = [
                    if part == 0 { grading[0] } else { 1 },
                    if part + 1 == parts { grading[1] } else { 1 },
                ];
                let nodes = Nodes::of(next.unwrap_or(most), grading);
                let mut panel = Interval {
                    nodes,
                    ends: interval.ends.filter(|_| part + 1 == parts),
                    ..interval.clone()
                };
                if parts == 2 {
                    let middle = interval.middle();
                    if part == 0 {
                        panel.to = middle;
                    } else {
                        panel.from = middle;
                    }
                }
                for active in &mut panel.active {
                    active.first = first + finer.forces;
                    finer.forces += nodes.count();
                }
                finer.intervals.push(panel);
            }
        }
        finer
    }

    /// Extended unknowns as those of a finer skeleton: forces are interpolated.
    pub(super) fn interpolated(&self, finer: &Self, u: &[f64]) -> Vec<f64> {
        let mut to = u[..self.told()].to_vec();
        to.resize(finer.unknowns(), 0.0);
        to.push(u[u.len() - 1]);
        let parts = |interval: &Interval| {
            let most = COUNTS[COUNTS.len() - 1];
            if interval.nodes.count() == most && !interval.active.is_empty() {
                2
            } else {
                1
            }
        };
        let mut panels = finer.intervals.iter();
        for interval in &self.intervals {
            let parts = parts(interval);
            let n = interval.nodes.count();
            for (part, panel) in panels.by_ref().take(parts).enumerate() {
                let of_panel = |part: usize| {
                    let mut matrix = vec![0.0; panel.nodes.count() * n];
                    let rows = matrix.chunks_exact_mut(n);
                    for (row, target) in rows.zip(&panel.nodes.targets) {
                        let psi = (part as f64 + target) / parts as f64;
                        interval.nodes.polynomials(psi, row);
                    }
                    matrix
                };
                let made;
                let matrix = if interval.active.is_empty() {
                    continue;
                } else if parts == 1 {
                    interval.nodes.at_next(panel.nodes)
                } else {
                    made = of_panel(part);
                    &made
                };
                for (of, at) in interval.active.iter().zip(&panel.active) {
                    let forces = &u[of.first..][..n];
                    let to = to[at.first..].iter_mut();
                    for (to, row) in to.zip(matrix.chunks_exact(n)) {
                        *to = row.iter().zip(forces).map(|(l, f)| l * f).sum();
                    }
                }
            }
        }
        to
    }

    /// Adds what lies between two cuts, in as many panels as its length asks for.
    fn add(&mut self, system: &dyn System, values: &Values, way: &Way<'_>) {
        let contacts = &values.contacts;
        let (active, configuration) = self.forced(system, values, way.pieces);
        let panels = if active.is_empty() {
            1
        } else {
            let whole = self.length.min(TAU);
            let asked = self.placement.resolution.panels as f64 * way.length / whole;
            let asked = asked.ceil().max(1.0) as usize;
            // Half of a period then has the nodes of the other half: what is its image stays that, and where this symmetry breaks branches cross.
            if way.cuts == [Cut::Begin, Cut::End] {
                asked.next_multiple_of(2)
            } else {
                asked
            }
        };
        let [first, last] = way.cuts.map(|cut| self.steepness(system, contacts, cut));
        let [from, to] = way.cuts;
        for panel in 0..panels {
            let mark = |index: usize| match index {
                0 => Mark::at(from),
                index if index == panels => Mark::at(to),
                index => Mark {
                    from,
                    to,
                    part: index as f64 / panels as f64,
                },
            };
            let grading = [
                if panel == 0 { first } else { 1 },
                if panel + 1 == panels { last } else { 1 },
            ];
            let nodes = Nodes::of(self.placement.resolution.nodes, grading);
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
                nodes,
                ends: way.ends.filter(|_| panel + 1 == panels),
            });
        }
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
        let power = grading::power_for(&exponents.iter().copied());
        (power as usize).clamp(1, STEEPEST)
    }

    /// How the orbit comes back at its end.
    pub(super) fn recurrence(&self) -> &Recurrence {
        &self.placement.beginning.recurrence
    }

    /// Number of unknowns, without the parameter.
    pub(super) fn unknowns(&self) -> usize {
        self.told() + self.forces
    }

    /// Number of those that are no forces.
    pub(super) fn told(&self) -> usize {
        self.order + self.switches.len()
    }

    /// The place of a switch's unknown.
    pub(super) fn slot(&self, switch: usize) -> usize {
        self.order + switch
    }

    /// Phase of a cut, and its derivatives by unknowns.
    fn cut(&self, u: &[f64], cut: Cut) -> Place {
        match cut {
            Cut::Begin => Place::fixed(self.begin),
            Cut::End => Place::fixed(self.begin + self.length),
            Cut::Switch(index) => {
                let own = self.slot(index);
                let (middle, square, sign) = match self.switches[index].told {
                    Told::Alone => {
                        let mut place = Place::fixed(self.begin + u[own]);
                        place.add(own, 1.0);
                        return place;
                    }
                    Told::First { other, .. } => (own, self.slot(other), -1.0),
                    Told::Second { other } => (self.slot(other), own, 1.0),
                };
                let [half, slope] = self.openings[index].half(u[square]);
                let mut place = Place::fixed(self.begin + u[middle] + sign * half);
                place.add(middle, 1.0);
                if half > 0.0 {
                    place.add(square, sign * slope);
                }
                place
            }
        }
    }

    /// Phase of a mark, and its derivatives by unknowns.
    pub(super) fn place(&self, u: &[f64], mark: Mark) -> Place {
        let mut place = self.cut(u, mark.from);
        if mark.part > 0.0 {
            let to = self.cut(u, mark.to);
            place.scale(1.0 - mark.part);
            place.phase += mark.part * to.phase;
            for (unknown, slope) in to.slopes() {
                place.add(unknown, mark.part * slope);
            }
        }
        place
    }

    /// Takes forces from another orbit beside a short stretch. Its ends move as the root of `H`, and nodes on both sides with them; as functions
    /// of the phase from its middle `c` forces hardly change there. Says whether there were any.
    pub(super) fn carry_forces(&self, known: &[f64], u: &mut [f64]) -> bool {
        let mut polynomials = Vec::new();
        let mut carried = false;
        for interval in &self.intervals {
            let marks = [interval.from, interval.to];
            let is_beside = marks.iter().any(|mark| {
                let mut cuts = [mark.from, mark.to].into_iter();
                cuts.any(|cut| self.opens(cut, u, known))
            });
            if interval.active.is_empty() || self.is_within_pair(interval) || !is_beside {
                continue;
            }
            let ends = |u: &[f64]| marks.map(|mark| self.place(u, mark).phase);
            let ([from, to], [a, b]) = (ends(u), ends(known));
            if b <= a {
                continue;
            }
            carried = true;
            let [first, last] = marks.map(|mark| self.moved(mark, u, known));
            polynomials.resize(interval.nodes.count(), 0.0);
            for node in 0..polynomials.len() {
                let target = interval.nodes.targets[node];
                let moved = first + target * (last - first);
                let psi = (from + target * (to - from) - moved - a) / (b - a);
                interval
                    .nodes
                    .polynomials(psi.clamp(0.0, 1.0), &mut polynomials);
                for active in &interval.active {
                    let forces = &known[active.first..][..polynomials.len()];
                    let force = polynomials.iter().zip(forces).map(|(l, f)| l * f).sum();
                    u[active.first + node] = force;
                }
            }
        }
        carried
    }

    /// How far a mark has moved between two orbits, of a short pair its middle: that moves by little where `H` passes zero.
    fn moved(&self, mark: Mark, u: &[f64], known: &[f64]) -> f64 {
        let cut = |cut: Cut| match cut {
            Cut::Switch(index) if self.opens(cut, u, known) => {
                let middle = match self.switches[index].told {
                    Told::Second { other } => self.slot(other),
                    Told::First { .. } | Told::Alone => self.slot(index),
                };
                u[middle] - known[middle]
            }
            _ => self.cut(u, cut).phase - self.cut(known, cut).phase,
        };
        (1.0 - mark.part) * cut(mark.from) + mark.part * cut(mark.to)
    }

    /// Whether a cut is at one of a pair of switches with a short way between them in one of two orbits at least, which has not gone in both.
    fn opens(&self, cut: Cut, u: &[f64], known: &[f64]) -> bool {
        let Cut::Switch(index) = cut else {
            return false;
        };
        let second = match self.switches[index].told {
            Told::Alone => return false,
            Told::First { other, .. } => other,
            Told::Second { .. } => index,
        };
        let told = self.openings[index];
        let squares = [u, known].map(|u| told.square(u[self.slot(second)]));
        squares[0].max(squares[1]) > 0.0 && squares[0].min(squares[1]) <= OPEN
    }

    /// Whether an interval lies between the two switches of a pair, and nothing else does.
    pub(super) fn is_within_pair(&self, interval: &Interval) -> bool {
        let Cut::Switch(first) = interval.from.from else {
            return false;
        };
        let Told::First { other, .. } = self.switches[first].told else {
            return false;
        };
        let marks = [interval.from, interval.to].into_iter();
        let mut cuts = marks.flat_map(|mark| [mark.from, mark.to]);
        cuts.all(|cut| cut == Cut::Switch(first) || cut == Cut::Switch(other))
    }

    /// The interval that ends at a switch.
    pub(super) fn before(&self, switch: usize) -> Option<usize> {
        let mut intervals = self.intervals.iter();
        intervals.position(|interval| interval.ends == Some(switch))
    }

    /// How the way between a switch and the other one of its pair is told.
    pub(super) fn opened(&self, switch: usize) -> Opening {
        self.openings[switch]
    }

    /// Phase of a switch.
    pub(super) fn phase(&self, u: &[f64], switch: usize) -> f64 {
        self.cut(u, Cut::Switch(switch)).phase
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
