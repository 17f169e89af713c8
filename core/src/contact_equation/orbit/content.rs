//! How much each mode rings on an interval, and what of that a signal sees that changes faster than in a given time.
//!
//! The motion of a pair of states is what the load and the forces hold it at, and what rings about that: the free part `y`, and on an interval with
//! forces at nodes what `X` of these is more than at rest,
//!
//! ```text
//! y = e^(A t) y_0,    X + A^-1 B f                                                                             (1)
//! ```
//!
//! With (1) of [`block`](crate::contact_equation::linear_part::block), a state `i` of what rings is at most, while it does not grow,
//!
//! ```text
//! |c y_i + k (D y)_i| <= sqrt(y_i^2 + (D y)_i^2 / |d|)                                                          (2)
//! ```
//!
//! A pair with two real exponents does not turn. It has a part of each, `(y +- D y / sqrt(d)) / 2`, of which the fast one has soon decayed, and follows its
//! forces as slowly as these change. What a wave in resonance does grows from rest, by no more than its input in the same time.
//!
//! The second part of (1) is looked at at the nodes: it holds some of what the mode does as slowly as its force, so that more rings than does,
//! which costs instants and loses nothing.
//!
//! Source: Higham (2008), Functions of Matrices, section 1.2; Moore, Kearfott and Cloud (2009), Introduction to Interval Analysis, section 5.4 (bounds
//! that tell where there is nothing to look for).

use std::f64::consts::FRAC_PI_4;

use super::motion::Motion;
use crate::contact_equation::linear_part::block::{Block, Pair, pair};

/// What turns by less between two samples is followed by them.
const FOLLOWED: f64 = FRAC_PI_4;
/// What changes a signal by less than this part of its largest is rounding.
const ROUNDING: f64 = 1e-14;

/// Parts of what rings of a pair.
pub(super) const RINGS: usize = 3;
/// What turns by so many radians while it decays by a factor of e rings.
const TURNING: f64 = 4.0;

/// What a pair does on an interval beside what it is held at, or a part of that.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Ringing {
    /// How fast it turns or decays.
    pub(super) turns: f64,
    /// The exponent that it decays with; zero where it does not.
    pub(super) decay: f64,
    /// (2) of both states.
    pub(super) most: Pair,
}

/// What rings on an interval.
#[derive(Debug, Clone, Default)]
pub(super) struct Content {
    /// By pairs: what turns, or both parts of what does not, and what is in resonance.
    rings: Vec<[Ringing; RINGS]>,
}

impl Content {
    pub(super) fn of(motion: &Motion<'_>, interval: usize) -> Self {
        let passed = &motion.equations.passed[interval];
        let values = motion.values(interval);
        let [from, to] = passed.phases;
        let whole = (to - from) / values.base;
        let blocks = &values.linear.blocks;
        let free = |(r, block): (usize, &Block)| free(block, pair(&passed.free, r), whole);
        let mut rings: Vec<[Ringing; RINGS]> = blocks.iter().enumerate().map(free).collect();
        let count = motion.equations.skeleton.intervals[interval].nodes.count();
        let forced = passed.forced.chunks_exact(2 * blocks.len());
        let turning = |block: &&Block| block.real_exponents().is_none();
        for (node, forced) in forced.enumerate().take(count) {
            let pairs = blocks.iter().zip(&mut rings).enumerate();
            for (r, (block, rings)) in pairs.filter(|(_, (block, _))| turning(block)) {
                let load = [0, 1].map(|i| passed.load[(2 * r + i) * count + node]);
                let held = block.held(load);
                let here = [0, 1].map(|i| forced[2 * r + i] - held[i]);
                let bound = block.bound(here, whole);
                let most = &mut rings[0].most;
                *most = [0, 1].map(|i| most[i].max(bound[i]));
            }
        }
        if !passed.forced.is_empty() {
            // What is free and what forces have made ring may add up, and the latter is made anew.
            let pairs = blocks.iter().zip(&mut rings);
            for (_, rings) in pairs.filter(|(block, _)| turning(block)) {
                rings[0].most = rings[0].most.map(|x| 2.0 * x);
                rings[0].decay = 0.0;
            }
        }
        for wave in &values.load {
            for &r in &wave.resonant {
                let (block, ringing) = (&blocks[r], &mut rings[r][2]);
                let parts = [wave.input[r].map(|x| x.re), wave.input[r].map(|x| x.im)];
                let turns = wave.harmonic * values.base;
                ringing.turns = ringing.turns.max(block.rate()).max(turns);
                for bound in parts.map(|input| block.bound(input, whole)) {
                    for (most, bound) in ringing.most.iter_mut().zip(bound) {
                        *most += whole * bound;
                    }
                }
            }
        }
        Self { rings }
    }

    /// Of a pair.
    pub(super) fn rings(&self, block: usize) -> &[Ringing; RINGS] {
        &self.rings[block]
    }

    /// What is left of each after a time, pair by pair.
    pub(super) fn left(&self, time: f64) -> Vec<f64> {
        let rings = self.rings.iter().flatten();
        rings.map(|of| (of.decay * time).exp()).collect()
    }

    /// The fastest decay of what turns meanwhile, if it turns faster than this and has more than a pair may have by rounding.
    pub(super) fn decay(&self, turns: f64, rounding: impl Fn(usize) -> f64) -> f64 {
        let rings = self.rings.iter().enumerate();
        let rings = rings.flat_map(|(r, rings)| rings.iter().map(move |of| (r, of)));
        let turning = rings.filter(|(_, of)| of.turns > turns.max(-TURNING * of.decay));
        let ringing = turning.filter(|(r, of)| of.most[0] > rounding(*r));
        ringing.fold(0.0, |most: f64, (_, of)| most.max(-of.decay))
    }
}

/// What a pair does within a time from these states, if nothing acts on it.
fn free(block: &Block, states: Pair, time: f64) -> [Ringing; RINGS] {
    let none = Ringing::default();
    let Some(exponents) = block.real_exponents() else {
        let ringing = Ringing {
            turns: block.rate(),
            decay: block.slowest(),
            most: block.bound(states, time),
        };
        return [ringing, none, none];
    };
    let parts = block.real_parts(states);
    let [slow, fast] = [0, 1].map(|part| {
        let exponent: f64 = exponents[part];
        let growth = (exponent * time).exp().max(1.0);
        Ringing {
            turns: exponent.abs(),
            decay: exponent.min(0.0),
            most: parts[part].map(|x| growth * x.abs()),
        }
    });
    [slow, fast, none]
}

/// What a mode does to a signal.
#[derive(Debug, Clone, Copy)]
struct Ripple {
    /// Its place among all that rings.
    place: usize,
    /// How fast it turns or decays.
    turns: f64,
    /// Bounds of its values and of their rates.
    value: f64,
    rate: f64,
    /// How they decay.
    mean: f64,
}

/// Bounds of what in a signal is too fast to be followed by samples: of its values, their rates and the rates of these.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Fast {
    pub(super) value: f64,
    pub(super) rate: f64,
    pub(super) bend: f64,
    /// All of it decays at least so fast.
    mean: f64,
}

impl Fast {
    /// A time later.
    pub(super) fn after(self, time: f64) -> Self {
        if self.mean == 0.0 || self.value == 0.0 {
            return self;
        }
        let decay = (self.mean * time).exp();
        Self {
            value: decay * self.value,
            rate: decay * self.rate,
            bend: decay * self.bend,
            ..self
        }
    }

    /// There is nothing.
    pub(super) fn is_none(&self) -> bool {
        self.value == 0.0
    }
}

/// What rings in a signal, the fastest first.
#[derive(Debug, Clone, Default)]
pub(super) struct Ripples {
    of: Vec<Ripple>,
    /// Sums up to each.
    sums: Vec<Fast>,
    /// Bound of the fourth derivative of each and all that are slower.
    fourth: Vec<f64>,
    /// The same of what does not ring, and a bound of its rates.
    steady: f64,
    moves: f64,
}

impl Ripples {
    /// Of so many modes at most.
    pub(super) fn with_room(count: usize) -> Self {
        Self {
            of: Vec::with_capacity(count),
            sums: Vec::with_capacity(count),
            fourth: Vec::with_capacity(count + 1),
            ..Self::default()
        }
    }

    /// What rings at a place among all that does.
    pub(super) fn add(&mut self, place: usize, turns: f64, mean: f64, [value, rate]: [f64; 2]) {
        if value > 0.0 || rate > 0.0 {
            self.of.push(Ripple {
                place,
                turns,
                value,
                rate,
                mean,
            });
        }
    }

    /// What does not ring: a wave, and how fast it turns.
    pub(super) fn add_wave(&mut self, turns: f64, value: f64) {
        self.steady += value * turns.powi(4);
        self.moves += value * turns;
    }

    pub(super) fn sort(&mut self) {
        self.of.sort_unstable_by(|a, b| b.turns.total_cmp(&a.turns));
        self.sum();
    }

    /// The same later, when so much is left of each.
    pub(super) fn later(&self, left: &[f64]) -> Self {
        let mut later = Self::with_room(self.of.len());
        (later.steady, later.moves) = (self.steady, self.moves);
        later.of.extend(self.of.iter().map(|of| Ripple {
            value: left[of.place] * of.value,
            rate: left[of.place] * of.rate,
            ..*of
        }));
        later.sum();
        later
    }

    fn sum(&mut self) {
        self.sums.clear();
        let mut sum = Fast {
            mean: f64::NEG_INFINITY,
            ..Fast::default()
        };
        for ripple in &self.of {
            sum.value += ripple.value;
            sum.rate += ripple.rate;
            sum.bend += ripple.rate * ripple.turns;
            sum.mean = sum.mean.max(ripple.mean);
            self.sums.push(sum);
        }
        self.fourth.clear();
        self.fourth.resize(self.of.len() + 1, self.steady);
        for place in (0..self.of.len()).rev() {
            let Ripple { turns, value, .. } = self.of[place];
            self.fourth[place] = self.fourth[place + 1] + value * turns.powi(4);
        }
    }

    fn count(&self, time: f64) -> usize {
        self.of.partition_point(|of| of.turns * time > FOLLOWED)
    }

    /// What turns too fast for samples that are so far apart; nothing where it is rounding of a signal of this size.
    pub(super) fn fast(&self, time: f64, size: f64) -> Fast {
        let count = self.count(time);
        let fast = count.checked_sub(1).map(|last| self.sums[last]);
        fast.map_or(Fast::default(), |fast| unless_rounding(fast, size))
    }

    /// A bound of the fourth derivative of what is followed by samples that are so far apart, forces at nodes left out.
    pub(super) fn fourth(&self, time: f64) -> f64 {
        self.fourth[self.count(time)]
    }

    /// How fast turns what, with all that is faster, may be more than this.
    pub(super) fn turns_above(&self, value: f64) -> f64 {
        let place = self.sums.partition_point(|sum| sum.value <= value);
        self.of.get(place).map_or(0.0, |of| of.turns)
    }

    /// How fast turns what is more than a part of all the rates.
    pub(super) fn most(&self, part: f64) -> f64 {
        let all = self.moves + self.sums.last().map_or(0.0, |sum| sum.rate);
        let counts = |sum: &Fast| sum.rate <= part * all;
        let place = self.sums.partition_point(counts);
        self.of.get(place).map_or(0.0, |of| of.turns)
    }
}

/// Nothing where it is rounding of a signal of this size.
pub(super) fn unless_rounding(fast: Fast, size: f64) -> Fast {
    if fast.value > ROUNDING * size {
        fast
    } else {
        Fast::default()
    }
}
