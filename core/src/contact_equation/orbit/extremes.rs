//! Extremes of the coordinates and of the gaps of an orbit, from one walk along its period.
//!
//! Signals are sampled: eight times in the shortest period of the load, the directions that move and those modes whose ringing makes up the rates but for a tenth, six
//! times on an interval at least, or twice in a layer of it. Where the motion is in closed form each has as many samples as it asks for itself, of a [grid](super::grid) that all of them share. Where
//! what rings decays in a part of an interval, coordinates have as many in each of its [layers](super::layers) as what is left of the ringing asks for. Where
//! forces are unknown at nodes all have the same: those of the pass where its nodes are dense enough, else those that gaps ask for. What rings faster is bounded,
//! and followed where an extreme may depend on it: see [`search`](super::search).
//!
//! Where a slope changes its sign between two samples, its zero is located to `1e-9` of their distance: of a gap every one, of a coordinate
//! those that may be its smallest or its largest value. Where a gap has slopes of one sign at both ends, and that of the cubic through both samples
//! is less than a tenth of the larger of them or has the other sign in between, the motion itself is looked at there, and both parts in the same way, to
//! four halvings.
//!
//! Nothing proves that the cubic is near the motion where forces are known at nodes. A maximum and a minimum of a gap between two samples of which it does
//! not tell are not seen, and neither is a contact that begins and ends between them.
//!
//! Source: de Boor (2001), A Practical Guide to Splines, chapter IV (cubic Hermite interpolation).

use std::cell::RefCell;
use std::collections::HashMap;
use std::ops::Range;

use super::content::Content;
use super::grid::Grid;
use super::layers::{Grids, Layer};
use super::motion::Motion;
use super::pieces::Part;
use super::search::{Cubic, Largest, extreme};
use super::signal::{Look, Of, Signal};
use super::sums::integrals_of;
use crate::contact_equation::equations::pass_results::GapExtreme;
use crate::contact_equation::linear_part::block::Block;
use crate::contact_equation::linear_part::contact::Contact;
use crate::contact_equation::skeleton::placement::Told;
use crate::numeric::roots::Place;

/// Samples of a rate in the shortest period of what is followed by samples alone.
pub(super) const SAMPLES: f64 = 8.0;
/// The same at least on an interval.
const FEWEST: f64 = 6.0;
/// More are not taken, however fast the motion is.
const MOST: f64 = 1e6;
/// What makes up less than this part of the rates of a signal is not followed by samples alone.
pub(super) const PART: f64 = 0.1;
/// Of so many modes all are followed by samples.
const FEW: usize = 1;
/// Two extremes of a gap as near as this are one.
const SEEN_TWICE: f64 = 1e-6;
/// Phases that are nearer to each other are not told apart by what lies between them, as a part of them.
const CLOSEST: f64 = 1e-14;
/// The rate of a gap is looked at between samples where it may come as near to zero, in parts of the larger one of both, so often at most.
const DIPS: f64 = 0.1;
const HALVINGS: usize = 4;
/// As far from an extreme that is known, in parts of the distance of two samples, its rate has a sign.
const ASIDE: f64 = 1e-3;

/// An interval that takes time: what rings there, and phases of it with the states there.
#[derive(Debug)]
pub(in crate::contact_equation) struct Sampled {
    pub(super) interval: usize,
    pub(super) content: Content,
    /// Where nothing is unknown at nodes, grids of all of it, and of its layers.
    grids: Option<Grids>,
    pub(super) layers: Vec<Layer>,
    phases: Vec<f64>,
    states: Vec<f64>,
    /// States at other phases, by the bits of these.
    others: RefCell<HashMap<u64, Vec<f64>>>,
}

/// Samples of a signal on an interval.
pub(super) struct Samples<'s> {
    pub(super) phases: &'s [f64],
    pub(super) values: Vec<f64>,
    pub(super) rates: Vec<f64>,
}

impl<'s> Samples<'s> {
    /// Values with rates, one pair for each phase.
    pub(super) fn of(phases: &'s [f64], looks: impl Iterator<Item = [f64; 2]>) -> Self {
        let (values, rates) = looks.map(|[value, rate]| (value, rate)).unzip();
        Self {
            phases,
            values,
            rates,
        }
    }

    pub(super) fn look(&self, index: usize) -> Look {
        Look {
            x: self.phases[index],
            value: self.values[index],
            rate: self.rates[index],
        }
    }
}

/// Extremes of all gaps.
pub(super) fn extremes_of_gaps(motion: &Motion<'_>) -> Vec<Vec<GapExtreme>> {
    let sampled = motion.sampled();
    let contacts = motion.equations.values.contacts.iter().enumerate();
    let of = |(contact, of): (usize, &Contact)| {
        let mut found = Vec::new();
        // Of others nothing is asked.
        let values = &motion.equations.values;
        if !of.levels.is_empty() || motion.equations.setting.is_narrow(values, contact) {
            let mut end = None;
            for sampled in sampled {
                let signal = Signal::new(motion, sampled, Of::Gap(contact));
                let samples = signal.samples();
                let scan = Scan {
                    motion,
                    signal,
                    interval: sampled.interval,
                    contact,
                    found: &mut found,
                };
                scan.go(&samples, &mut end);
            }
            add_short(motion, contact, &mut found);
        }
        found
    };
    contacts.map(of).collect()
}

/// Those of all coordinates, over the period.
pub(super) fn extremes_of_coordinates(motion: &Motion<'_>) -> Vec<[Place; 2]> {
    let sampled = motion.sampled();
    let coordinates = 0..motion.equations.values.linear.rows.len();
    let found = coordinates.map(|coordinate| coordinate_ends(motion, sampled, coordinate));
    let found: Vec<[Place; 2]> = found.collect();
    of_period(motion, &found)
}

/// What a sum of coordinates does on some intervals.
pub(in crate::contact_equation) struct Outputs {
    pub(in crate::contact_equation) least: f64,
    pub(in crate::contact_equation) most: f64,
    /// Over the phase, of it and of its square.
    pub(in crate::contact_equation) integrals: [f64; 2],
}

/// Reads what is given interval by interval.
pub(in crate::contact_equation) fn read<'m>(
    motion: &'m Motion<'_>,
    signals: impl Iterator<Item = (&'m Sampled, Of<'m>)>,
) -> Outputs {
    let mut parts = parts(motion, signals);
    let [least, most] = farthest(motion, &mut parts);
    let mut integrals = [0.0; 2];
    for part in &mut parts {
        for (integral, own) in integrals.iter_mut().zip(integrals_of(&mut part.signal)) {
            *integral += own;
        }
    }
    Outputs {
        least: least.value,
        most: most.value,
        integrals,
    }
}

/// Where coordinates are smallest and largest, over the whole period. Where an orbit comes back with coordinates in each other's place, the extremes
/// of all are looked for.
pub(in crate::contact_equation) fn extremes_of(
    motion: &Motion<'_>,
    asked: Range<usize>,
) -> Vec<[Place; 2]> {
    let sampled = motion.sampled();
    let of = |coordinate| coordinate_ends(motion, sampled, coordinate);
    if motion.equations.skeleton.recurrence().image.is_identity() {
        return asked.map(of).collect();
    }
    let coordinates = 0..motion.equations.values.linear.rows.len();
    let all: Vec<[Place; 2]> = coordinates.map(of).collect();
    of_period(motion, &all).drain(asked).collect()
}

/// The smallest and the largest value of a coordinate.
fn coordinate_ends(motion: &Motion<'_>, sampled: &[Sampled], coordinate: usize) -> [Place; 2] {
    let signals = sampled.iter().map(|of| (of, Of::Coordinate(coordinate)));
    farthest(motion, &mut parts(motion, signals))
}

/// Signals with their samples.
fn parts<'m, 'e, 'r>(
    motion: &'m Motion<'e>,
    signals: impl Iterator<Item = (&'m Sampled, Of<'r>)>,
) -> Vec<Part<'m, 'e>> {
    let parts = signals.map(|(sampled, of)| {
        let signal = Signal::new(motion, sampled, of);
        let pieces = signal.pieces();
        Part { signal, pieces }
    });
    parts.collect()
}

/// The smallest and the largest value of a signal that is given part by part.
fn farthest(motion: &Motion<'_>, parts: &mut [Part<'_, '_>]) -> [Place; 2] {
    let none = |value: f64| Place { x: 0.0, value };
    let mut ends = [none(f64::INFINITY), none(f64::NEG_INFINITY)];
    for piece in parts.iter().flat_map(|part| &part.pieces) {
        let [low, high] = piece.ends();
        if low.value < ends[0].value {
            ends[0] = low;
        }
        if high.value > ends[1].value {
            ends[1] = high;
        }
    }
    let range = ends[1].value - ends[0].value;
    for (end, sign) in ends.iter_mut().zip([-1.0, 1.0]) {
        let mut largest = Largest {
            parts,
            base: motion.equations.values.base,
            sign,
            range,
            best: *end,
        };
        *end = largest.search();
    }
    ends
}

/// Smallest and largest values over the period, from those until the orbit comes back: then coordinates have the motions of their images.
fn of_period(motion: &Motion<'_>, found: &[[Place; 2]]) -> Vec<[Place; 2]> {
    let skeleton = &motion.equations.skeleton;
    let image = &skeleton.recurrence().image;
    let mut most = found.to_vec();
    for turns in 1..image.order() {
        let image = image.power(turns);
        let later = skeleton.length * turns as f64;
        for (coordinate, most) in most.iter_mut().enumerate() {
            let (place, sign) = image.entry(coordinate);
            let mut ends = found[place].map(|end| Place {
                x: end.x + later,
                value: sign * end.value,
            });
            if sign < 0.0 {
                ends.reverse();
            }
            if ends[0].value < most[0].value {
                most[0] = ends[0];
            }
            if ends[1].value > most[1].value {
                most[1] = ends[1];
            }
        }
    }
    most
}

impl Sampled {
    /// All intervals that take time.
    pub(in crate::contact_equation) fn of(motion: &Motion<'_>) -> Vec<Self> {
        let intervals = 0..motion.intervals();
        let takes = |interval: &usize| {
            let [from, to] = motion.phases(*interval);
            to > from
        };
        let intervals = intervals.filter(takes);
        intervals
            .map(|interval| {
                let mut sampled = Self {
                    interval,
                    content: Content::of(motion, interval),
                    grids: None,
                    layers: Vec::new(),
                    phases: Vec::new(),
                    states: Vec::new(),
                    others: RefCell::default(),
                };
                sampled.take(motion);
                sampled
            })
            .collect()
    }

    pub(in crate::contact_equation) fn interval(&self) -> usize {
        self.interval
    }

    fn take(&mut self, motion: &Motion<'_>) {
        let passed = &motion.equations.passed[self.interval];
        let [from, to] = passed.phases;
        let of = &motion.equations.skeleton.intervals[self.interval];
        if motion.is_closed(self.interval) {
            let parts = (SAMPLES * motion.moves(self.interval) * (to - from)).max(FEWEST);
            let parts = parts.ceil().min(MOST) as usize;
            self.grids = Some(Grids::new([from, to], parts));
            if motion.values(self.interval).linear.blocks.len() > FEW {
                self.layers = Layer::of(motion, self.interval, &self.content);
            }
            return;
        }
        let fastest = motion.moves(self.interval).max(self.rings(motion));
        let parts = (SAMPLES * fastest * (to - from)).max(FEWEST);
        let order = motion.equations.skeleton.order;
        if !of.active.is_empty() && parts * of.nodes.widest() <= 1.0 {
            self.phases.push(from);
            let targets = of.nodes.targets.iter();
            self.phases
                .extend(targets.map(|psi| from + psi * (to - from)));
            self.states.extend_from_slice(&passed.states);
            return;
        }
        let parts = parts.ceil().min(MOST) as usize;
        self.states.resize((parts + 1) * order, 0.0);
        for (part, states) in self.states.chunks_exact_mut(order).enumerate() {
            let phase = from + (to - from) * (part as f64 / parts as f64);
            self.phases.push(phase);
            motion.states(self.interval, phase, states);
        }
    }

    /// Periods in a unit of phase of what rings in gaps.
    fn rings(&self, motion: &Motion<'_>) -> f64 {
        let values = &motion.equations.values;
        let blocks = &motion.values(self.interval).linear.blocks;
        if blocks.len() <= FEW {
            let turning = blocks
                .iter()
                .filter(|block| block.real_exponents().is_none());
            let turns = turning.map(Block::rate).fold(0.0, f64::max);
            return turns / values.base / std::f64::consts::TAU;
        }
        let contacts = values.contacts.iter().enumerate();
        let contacts = contacts.filter(|(_, contact)| !contact.levels.is_empty());
        let turns = contacts.map(|(contact, _)| {
            let of = Of::Gap(contact);
            Signal::new(motion, self, of).most(PART)
        });
        turns.fold(0.0, f64::max) / values.base / std::f64::consts::TAU
    }

    /// Samples near enough to each other for what turns so fast, by the phase; nothing where forces are unknown at nodes.
    pub(super) fn grid(&self, motion: &Motion<'_>, turns: f64) -> Option<&Grid> {
        let grids = self.grids.as_ref()?;
        Some(grids.at(motion, self.interval, turns))
    }

    /// What is followed by samples of a signal turns so fast, in a unit of phase.
    pub(super) fn turns(&self, motion: &Motion<'_>, signal: &Signal<'_, '_>) -> f64 {
        let base = motion.equations.values.base;
        let blocks = &motion.values(self.interval).linear.blocks;
        if blocks.len() > FEW {
            return signal.most(PART) / base;
        }
        let turning = blocks
            .iter()
            .filter(|block| block.real_exponents().is_none());
        turning.map(Block::rate).fold(0.0, f64::max) / base
    }

    /// Looks at the states at a phase, which are kept.
    pub(super) fn at<T>(&self, motion: &Motion<'_>, x: f64, look: impl FnOnce(&[f64]) -> T) -> T {
        let mut others = self.others.borrow_mut();
        let states = others.entry(x.to_bits()).or_insert_with(|| {
            let mut states = vec![0.0; motion.equations.skeleton.order];
            motion.states(self.interval, x, &mut states);
            states
        });
        look(states)
    }

    /// At how many phases states are known.
    #[cfg(test)]
    pub(in crate::contact_equation) fn count(&self) -> usize {
        let grids = self.grids.iter();
        let grids = grids.chain(self.layers.iter().map(|layer| &layer.grids));
        let on_grids: usize = grids.map(Grids::count).sum();
        on_grids + self.phases.len() + self.others.borrow().len()
    }

    /// Phases with states, where there is no grid.
    pub(super) fn known(&self) -> (&[f64], impl Iterator<Item = &[f64]>) {
        let order = self.states.len() / self.phases.len().max(1);
        (&self.phases, self.states.chunks_exact(order.max(1)))
    }
}

/// The search for the extremes of a gap on an interval.
struct Scan<'s, 'm, 'e> {
    motion: &'m Motion<'e>,
    signal: Signal<'m, 'e>,
    interval: usize,
    contact: usize,
    found: &'s mut Vec<GapExtreme>,
}

impl Scan<'_, '_, '_> {
    /// Which sign a rate has where two intervals meet, as at an extreme of another gap that is opposite to it, is rounding: it is one for both of them.
    fn go(mut self, samples: &Samples<'_>, end: &mut Option<Look>) {
        let last = samples.phases.len() - 1;
        let mut before = samples.look(0);
        if let Some(end) = end.filter(|end| (end.x - before.x).abs() <= SEEN_TWICE) {
            before.rate = end.rate;
        }
        for index in 1..=last {
            let mut next = samples.look(index);
            let here = next;
            if index == 1 {
                self.move_inside(&mut before, next.x, true);
            }
            if index == last {
                self.move_inside(&mut next, before.x, false);
            }
            self.between(before, next, HALVINGS);
            before = here;
        }
        *end = Some(before);
    }

    /// Where an interval begins or ends at an extreme that is short of a level, which is added afterwards, the sign of the rate is that beside it.
    fn move_inside(&mut self, end: &mut Look, other: f64, begins: bool) {
        let skeleton = &self.motion.equations.skeleton;
        let beside = if begins {
            self.interval.checked_sub(1)
        } else {
            Some(self.interval + 1).filter(|next| *next < self.motion.intervals())
        };
        let Some(beside) = beside.filter(|beside| self.is_nowhere(*beside)) else {
            return;
        };
        let ends = skeleton.intervals[beside.min(self.interval)].ends;
        let Some(switch) = ends.map(|switch| skeleton.switches[switch]) else {
            return;
        };
        let told = match switch.told {
            Told::First { .. } => !begins,
            Told::Second { .. } => begins,
            Told::Alone => false,
        };
        if told && switch.contact == self.contact {
            *end = self.signal.at(end.x + ASIDE * (other - end.x));
        }
    }

    fn is_nowhere(&self, interval: usize) -> bool {
        let [from, to] = self.motion.phases(interval);
        to <= from
    }

    /// Adds the extremes between two phases. What rings too fast for them is followed where it may make one; of the rest the cubic tells, where the
    /// rate has one sign at both ends, whether it has another one between them.
    fn between(&mut self, before: Look, next: Look, halvings: usize) {
        let base = self.motion.equations.values.base;
        let cubic = Cubic::of(&before, &next, base);
        let fast = self.signal.fast_from(cubic.h, before.x);
        let changes = (before.rate > 0.0) != (next.rate > 0.0);
        let sure = if changes {
            cubic.turns_once(fast)
        } else {
            cubic.goes_on(fast)
        };
        // Of motions that grow beyond all bounds nothing is sure, however near phases are.
        let divides = next.x - before.x > CLOSEST * next.x.abs().max(1.0);
        let known = before.rate.is_finite() && next.rate.is_finite();
        if !fast.is_none() && !sure && divides && known {
            self.halve(before, next, 0.5, halvings);
            return;
        }
        if changes {
            let found = extreme(&mut self.signal, [before, next], base);
            self.found.push(GapExtreme {
                contact: self.contact,
                interval: self.interval,
                phase: found.x,
                gap: found.value,
                maximum: before.rate > 0.0,
            });
            return;
        }
        let s = cubic.inflection();
        let least = before.rate.signum() * cubic.rate_there();
        let turns = least < DIPS * before.rate.abs().max(next.rate.abs());
        if halvings > 0 && turns && s > 0.0 && s < 1.0 {
            self.halve(before, next, s, halvings - 1);
        }
    }

    fn halve(&mut self, before: Look, next: Look, part: f64, halvings: usize) {
        let middle = self.signal.at_shared(before.x + part * (next.x - before.x));
        self.between(before, middle, halvings);
        self.between(middle, next, halvings);
    }
}

/// Extremes that are short of a level stand where two intervals meet: rounding says whether they are seen within one. They are those of
/// pairs of switches in one place.
fn add_short(motion: &Motion<'_>, contact: usize, found: &mut Vec<GapExtreme>) {
    let skeleton = &motion.equations.skeleton;
    for (first, switch) in skeleton.switches.iter().enumerate() {
        let Told::First { other, .. } = switch.told else {
            continue;
        };
        let intervals = [first, other].map(|switch| skeleton.before(switch));
        let [Some(before), Some(between)] = intervals else {
            continue;
        };
        let phase = motion.phases(before)[1];
        if switch.contact != contact || phase < motion.phases(between)[1] {
            continue;
        }
        found.retain(|extreme| (extreme.phase - phase).abs() > SEEN_TWICE);
        found.push(GapExtreme {
            contact,
            interval: before,
            phase,
            gap: motion.gap(contact, before, phase)[0],
            maximum: switch.rises,
        });
    }
}
