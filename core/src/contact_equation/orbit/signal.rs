//! One number of the motion on an interval, a coordinate, a gap or an output, at any phase of it: rows over the states are put on what the motion is
//! made of once, so that an instant costs what the signal sees, and not what all coordinates are.
//!
//! With a row `p` over the states it is, by (1) of [`equations`](crate::contact_equation::equations) and (1) of [`block`](crate::contact_equation::linear_part::block),
//!
//! ```text
//! x(t) = sum_w Re(p . Y_w e^(i w tau)) + sum_r (c_r (p . y_r) + k_r (p . D_r y_r)) + sum_j l_j(psi) (p . X_j)  (1)
//! ```
//!
//! with the steady response, free parts and what forces have done at the targets `j`. What does not fit in, a direction that moves, a wave in resonance, and pairs
//! that forces make ring between their nodes, is followed as the [motion](super::motion) is.
//!
//! Source: Meirovitch (2001), Fundamentals of Vibrations, section 7.15.

use std::borrow::Cow;

use nalgebra::Complex;

use super::content::{Content, Fast, RINGS, Ripples, unless_rounding};
use super::extremes::{PART, Sampled, Samples};
use super::grid::Grid;
use super::layers::Layer;
use super::motion::Motion;
use super::pieces::Piece;
use super::sums::Exponential;
use crate::contact_equation::collocation::nodes::Nodes;
use crate::contact_equation::linear_part::block::{Pair, pair, row_times, times};
use crate::contact_equation::linear_part::kernels::Found;
use crate::contact_equation::linear_part::linear::{Seen, of_states, seen};
use crate::contact_equation::linear_part::wave::turn;

/// Exponentials that are smaller in parts of a signal are none.
const NOTHING: f64 = 1e-19;
/// So many of all blocks are worth the exponentials of all.
const MANY: usize = 8;

/// Few blocks are all followed where one of them takes as long as all.
const SHARED: usize = 64;

/// What is looked at.
#[derive(Debug, Clone, Copy)]
pub(in crate::contact_equation) enum Of<'r> {
    Coordinate(usize),
    Gap(usize),
    /// A sum of coordinates and rates, and what is added. Rates are asked for where the motion is in closed form alone.
    Sum(&'r [Term], f64),
}

/// A multiple of a coordinate, or of its rate.
#[derive(Debug, Clone, Copy)]
pub(in crate::contact_equation) struct Term {
    pub(in crate::contact_equation) coordinate: usize,
    pub(in crate::contact_equation) of_rate: bool,
    pub(in crate::contact_equation) factor: f64,
}

/// A number of the motion, and its rate, at a phase.
#[derive(Debug, Clone, Copy)]
pub(super) struct Look {
    pub(super) x: f64,
    pub(super) value: f64,
    pub(super) rate: f64,
}

/// What a signal sees of the free part of a block: factors of `c` and `k`.
#[derive(Debug, Clone, Copy)]
struct Ring {
    block: usize,
    value: Pair,
    rate: Pair,
}

/// (1)
pub(in crate::contact_equation) struct Signal<'m, 'e> {
    motion: &'m Motion<'e>,
    sampled: &'m Sampled,
    interval: usize,
    /// What it sees of the states of the linear part, where that stands, and of those on its interval.
    row: Cow<'m, [Seen]>,
    own: Cow<'m, [Seen]>,
    /// It is followed as the motion is: this gap, or its row.
    whole: Option<Whole>,
    offset: f64,
    waves: Vec<(f64, Complex<f64>)>,
    rings: Vec<Ring>,
    forced: Vec<[f64; 2]>,
    ripples: Ripples,
    /// About the largest value.
    pub(super) size: f64,
    found: Found,
    weights: Vec<f64>,
}

#[derive(Debug, Clone, Copy)]
enum Whole {
    Gap(usize),
    Row,
}

impl<'m, 'e> Signal<'m, 'e> {
    /// On an interval whose content is known.
    pub(super) fn new(motion: &'m Motion<'e>, sampled: &'m Sampled, of: Of<'_>) -> Self {
        let mut signal = Self {
            motion,
            sampled,
            interval: sampled.interval,
            row: Cow::Borrowed(&[]),
            own: Cow::Borrowed(&[]),
            whole: None,
            offset: 0.0,
            waves: Vec::new(),
            rings: Vec::new(),
            forced: Vec::new(),
            ripples: Ripples::default(),
            size: 0.0,
            found: Found::default(),
            weights: Vec::new(),
        };
        signal.set(&sampled.content, of);
        signal
    }

    fn set(&mut self, content: &'m Content, of: Of<'_>) {
        let motion = self.motion;
        let own = &motion.equations.values;
        if let Of::Gap(contact) = of
            && !own.contacts[contact].stands()
        {
            self.set_moving(content, contact);
            return;
        }
        let row = match of {
            Of::Coordinate(index) => Cow::Borrowed(&own.linear.rows[index][..]),
            Of::Gap(contact) => {
                self.offset = -own.contacts[contact].constant_offset();
                Cow::Owned(own.contacts[contact].row())
            }
            Of::Sum(terms, constant) => {
                self.offset = constant;
                Cow::Owned(sum(&own.linear.rows, terms))
            }
        };
        let values = motion.values(self.interval);
        if motion.is_rung(self.interval) || values.has_resonance() {
            self.whole = Some(Whole::Row);
        }
        self.row = row;
        let mut row = match (of, motion.configuration(self.interval)) {
            (Of::Coordinate(index), Some(of)) => Cow::Borrowed(&of.values.linear.rows[index][..]),
            (_, Some(of)) => Cow::Owned(of.row(&self.row)),
            _ => self.row.clone(),
        };
        if matches!(of, Of::Sum(terms, _) if terms.iter().any(|term| term.of_rate)) {
            // What a rate itself moves with is known of its free part alone, as `p A`.
            for seen in row.to_mut() {
                seen.rate = row_times(seen.position, values.linear.blocks[seen.block].matrix);
            }
        }
        self.put(content, &row);
        self.own = row;
    }

    /// Puts a row on what the motion is made of.
    fn put(&mut self, content: &Content, row: &[Seen]) {
        self.ripples = Ripples::with_room(2 * row.len());
        self.rings.reserve(row.len());
        let (motion, interval) = (self.motion, self.interval);
        let values = motion.values(interval);
        let passed = &motion.equations.passed[interval];
        self.size = self.offset.abs();
        for wave in values.load.iter().filter(|wave| !wave.is_resonant()) {
            let mut amplitude = Complex::new(0.0, 0.0);
            for seen in row {
                for i in 0..2 {
                    amplitude += wave.steady[2 * seen.block + i][0] * seen.position[i];
                }
            }
            let turns = wave.harmonic * values.base;
            self.ripples.add_wave(turns, amplitude.norm());
            self.size += amplitude.norm();
            self.waves.push((wave.harmonic, amplitude));
        }
        for seen in row {
            let block = &values.linear.blocks[seen.block];
            let free = pair(&passed.free, seen.block);
            let turned = times(block.deviation, free);
            let along = |row: Pair| [dot(row, free), dot(row, turned)];
            let ring = Ring {
                block: seen.block,
                value: along(seen.position),
                rate: along(seen.rate),
            };
            if ring.value != [0.0; 2] || ring.rate != [0.0; 2] {
                self.rings.push(ring);
            }
            self.add_rings(content, seen, 0.0);
        }
        self.ripples.sort();
        let order = 2 * values.linear.blocks.len();
        if self.whole.is_none() {
            let targets = passed.forced.chunks_exact(order);
            self.forced
                .extend(targets.map(|forced| of_states(row, forced)));
        }
    }

    /// What a pair does to it, in a row that turns.
    fn add_rings(&mut self, content: &Content, seen: &Seen, turning: f64) {
        for (part, ringing) in content.rings(seen.block).iter().enumerate() {
            let of = |row: Pair| row[0].abs() * ringing.most[0] + row[1].abs() * ringing.most[1];
            let most = [of(seen.position), of(seen.rate)];
            self.size += most[0];
            let (place, turns) = (RINGS * seen.block + part, ringing.turns + turning);
            self.ripples.add(place, turns, ringing.decay, most);
        }
    }

    /// A gap that moves: bounds are those of the largest row that it may have.
    fn set_moving(&mut self, content: &Content, contact: usize) {
        let own = &self.motion.equations.values;
        self.whole = Some(Whole::Gap(contact));
        let row = own.contacts[contact].largest(own.base);
        let row = match self.motion.configuration(self.interval) {
            Some(of) => of.largest_row(&row),
            None => row,
        };
        let turning = own.contacts[contact].harmonic() * own.base;
        for seen in &row {
            self.add_rings(content, seen, turning);
        }
        self.ripples.sort();
    }

    /// It at phases that are near enough to each other for what it sees most of.
    pub(super) fn samples(&self) -> Samples<'m> {
        let (motion, sampled) = (self.motion, self.sampled);
        if let Some(grid) = sampled.grid(motion, sampled.turns(motion, self)) {
            return match self.whole {
                None => self.on(grid),
                // A gap that moves has no row.
                Some(whole) => {
                    let looks = grid.phases.iter().map(|x| self.followed(whole, *x));
                    Samples::of(&grid.phases, looks)
                }
            };
        }
        let (phases, states) = sampled.known();
        let looks = phases.iter().zip(states);
        let looks = looks.map(|(phase, states)| self.of_states(*phase, states));
        Samples::of(phases, looks.map(|look| [look.value, look.rate]))
    }

    /// The same piece by piece.
    pub(super) fn pieces(&self) -> Vec<Piece<'m>> {
        let (motion, sampled) = (self.motion, self.sampled);
        if sampled.layers.is_empty() || self.whole.is_some() {
            return vec![Piece::new(self.samples(), None, self.phases()[0])];
        }
        let layers = sampled.layers.iter();
        let piece = |layer: &'m Layer| {
            let ripples = self.ripples.later(&layer.left);
            let turns = ripples.most(PART) / self.base();
            let samples = self.on(layer.grids.at(motion, self.interval, turns));
            Piece::new(samples, Some(ripples), layer.begin())
        };
        layers.map(piece).collect()
    }

    /// Value and rate at a phase of what is followed as the motion is.
    fn followed(&self, whole: Whole, x: f64) -> [f64; 2] {
        match whole {
            Whole::Gap(contact) => {
                let base = self.motion.equations.values.base;
                let [gap, rate] = self.motion.gap(contact, self.interval, x);
                [gap, rate * base]
            }
            Whole::Row => {
                let [value, rate] = self.motion.seen(&self.row, self.interval, x);
                [value + self.offset, rate]
            }
        }
    }

    /// On a grid.
    pub(super) fn on(&self, grid: &'m Grid) -> Samples<'m> {
        let mut values = vec![self.offset; grid.phases.len()];
        let mut rates = vec![0.0; grid.phases.len()];
        for (index, (harmonic, amplitude)) in self.waves.iter().enumerate() {
            let turns = harmonic * self.base();
            let both = [&mut values[..], &mut rates[..]];
            grid.add_wave(index, [amplitude.re, amplitude.im], turns, both);
        }
        let both = [&mut values[..], &mut rates[..]];
        grid.add_row(self.motion, self.interval, &self.own, both);
        Samples {
            phases: &grid.phases,
            values,
            rates,
        }
    }

    /// Value and rate at a phase.
    pub(super) fn at(&mut self, x: f64) -> Look {
        let [value, rate] = match self.whole {
            Some(whole) => self.followed(whole, x),
            None => self.sum(x),
        };
        Look { x, value, rate }
    }

    fn sum(&mut self, x: f64) -> [f64; 2] {
        let (motion, interval) = (self.motion, self.interval);
        let values = motion.values(interval);
        let [from, to] = motion.phases(interval);
        let mut sum = [self.offset, 0.0];
        for (harmonic, amplitude) in &self.waves {
            let wave = turn(harmonic * x) * amplitude;
            sum[0] += wave.re;
            sum[1] -= harmonic * values.base * wave.im;
        }
        let time = (x - from) / values.base;
        let linear = &values.linear;
        let many = MANY * self.rings.len() > linear.blocks.len() + MANY;
        if many {
            linear.kernels.find(&linear.blocks, time, &mut self.found);
        }
        for ring in &self.rings {
            let kernel = if many {
                self.found.kernel(ring.block)
            } else {
                linear.blocks[ring.block].kernel(time)
            };
            sum[0] += kernel.c * ring.value[0] + kernel.k * ring.value[1];
            sum[1] += kernel.c * ring.rate[0] + kernel.k * ring.rate[1];
        }
        if !self.forced.is_empty() {
            let nodes = motion.equations.skeleton.intervals[interval].nodes;
            nodes.through_ends((x - from) / (to - from), &mut self.weights);
            for (weight, forced) in self.weights.iter().zip(&self.forced) {
                sum[0] += weight * forced[0];
                sum[1] += weight * forced[1];
            }
        }
        sum
    }

    /// The same, where other signals may be looked at, too: of one that sees much the states are kept for these.
    pub(super) fn at_shared(&mut self, x: f64) -> Look {
        let blocks = self.motion.equations.values.linear.blocks.len();
        let many = match self.whole {
            Some(Whole::Gap(_)) => true,
            Some(Whole::Row) => MANY * self.row.len() > blocks || blocks <= SHARED,
            None => self.is_forced() && MANY * self.rings.len() > blocks + MANY,
        };
        if many {
            let sampled = self.sampled;
            sampled.at(self.motion, x, |states| self.of_states(x, states))
        } else {
            self.at(x)
        }
    }

    /// The same in states at a phase.
    pub(super) fn of_states(&self, x: f64, states: &[f64]) -> Look {
        let [value, rate] = if let Some(Whole::Gap(contact)) = &self.whole {
            let base = self.motion.equations.values.base;
            let [gap, rate] = self.motion.gap_of(*contact, x, states);
            [gap, rate * base]
        } else {
            let [value, rate] = of_states(&self.row, states);
            [value + self.offset, rate]
        };
        Look { x, value, rate }
    }

    /// It as exponentials from the beginning of its interval on, if it is nothing else.
    pub(super) fn exponentials(&self) -> Option<Vec<Exponential>> {
        if self.whole.is_some() || self.is_forced() {
            return None;
        }
        let values = self.motion.values(self.interval);
        let [from, to] = self.phases();
        let time = (to - from) / values.base;
        let zero = Complex::new(0.0, 0.0);
        let mut found = vec![Exponential {
            z: self.offset.into(),
            m: zero,
        }];
        for (harmonic, amplitude) in &self.waves {
            found.push(Exponential {
                z: amplitude * turn(harmonic * from),
                m: Complex::new(0.0, harmonic * values.base),
            });
        }
        for ring in &self.rings {
            let block = &values.linear.blocks[ring.block];
            for [z, m] in block.exponentials(ring.value, time)? {
                found.push(Exponential { z, m });
            }
        }
        let least = NOTHING * self.size;
        found.retain(|of| of.z.norm() > least);
        Some(found)
    }

    /// How fast the phase moves.
    pub(super) fn base(&self) -> f64 {
        self.motion.equations.values.base
    }

    /// Where its interval begins and ends.
    pub(super) fn phases(&self) -> [f64; 2] {
        self.motion.phases(self.interval)
    }

    /// How fast turns, by the phase, what is more than a part of it; and its waves.
    pub(super) fn turns_above(&self, part: f64) -> f64 {
        let rings = self.ripples.turns_above(part * self.size) / self.base();
        rings.max(std::f64::consts::TAU * self.motion.moves(self.interval))
    }

    /// Forces at nodes are in it.
    pub(super) fn is_forced(&self) -> bool {
        !self.motion.equations.passed[self.interval]
            .forced
            .is_empty()
    }

    /// The nodes of these.
    pub(super) fn nodes(&self) -> Option<&'static Nodes> {
        let of = &self.motion.equations.skeleton.intervals[self.interval];
        self.is_forced().then_some(of.nodes)
    }

    /// Value and rate at one of these, where the pass has left the states.
    pub(super) fn at_node(&self, node: usize) -> Look {
        let (phase, states) = self.motion.at_node(self.interval, node);
        self.of_states(phase, states)
    }

    /// What rings too fast for samples that are so far apart, while the interval lasts.
    pub(super) fn fast(&self, time: f64) -> Fast {
        self.ripples.fast(time, self.size)
    }

    /// The same from a phase on.
    pub(super) fn fast_from(&self, time: f64, x: f64) -> Fast {
        let [from, _] = self.phases();
        let fast = self.fast(time).after((x - from) / self.base());
        unless_rounding(fast, self.size)
    }

    /// What rings in it.
    pub(super) fn ripples(&self) -> &Ripples {
        &self.ripples
    }

    /// See [`Ripples::most`].
    pub(super) fn most(&self, part: f64) -> f64 {
        self.ripples.most(part)
    }
}

fn dot(a: Pair, b: Pair) -> f64 {
    a[0] * b[0] + a[1] * b[1]
}

/// The row of a sum of coordinates and rates.
pub(super) fn sum(rows: &[Vec<Seen>], terms: &[Term]) -> Vec<Seen> {
    let states = 2 * rows.len();
    let mut both = [vec![0.0; states], vec![0.0; states]];
    for term in terms {
        for seen in &rows[term.coordinate] {
            let of = if term.of_rate {
                [seen.rate, [0.0; 2]]
            } else {
                [seen.position, seen.rate]
            };
            for (both, of) in both.iter_mut().zip(of) {
                for i in 0..2 {
                    both[2 * seen.block + i] += term.factor * of[i];
                }
            }
        }
    }
    let [position, rate] = both;
    seen(position.into_iter(), rate.into_iter())
}
