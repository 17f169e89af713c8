//! The states at all targets of an interval at once, and how they change with where it begins and ends and with the frequency.
//!
//! With (1) of [`block`](crate::contact_equation::linear_part::block), `c` and `k` at a target, a pair is
//!
//! ```text
//! y = c z + k D z + y_p + P + D Q + y_r,    z = y_a - y_p(tau_a)                                                (1)
//! ```
//!
//! which is (1) of [`equations`](crate::contact_equation::equations) pair by pair, where `P` and `Q` are the integrals of both factors times what the forces do, and `y_r` is what waves in resonance do. Numbers stand
//! target by target, so that plain loops go over many of them.

use super::integrals::Integrals;
use crate::contact_equation::linear_part::block::{Pair, add, add_both, pair, times};
use crate::contact_equation::linear_part::kernels::Found;
use crate::contact_equation::linear_part::values::Values;
use crate::contact_equation::linear_part::wave::turn;

/// An interval that begins with these states.
#[derive(Debug, Clone, Copy)]
pub(in crate::contact_equation) struct Way<'w> {
    pub(in crate::contact_equation) values: &'w Values,
    /// Phases of its ends, and its length in units of time.
    pub(in crate::contact_equation) phases: [f64; 2],
    pub(in crate::contact_equation) time: f64,
    /// Its targets, as parts of it.
    pub(in crate::contact_equation) psi: &'w [f64],
    /// States less the steady response where it begins, and the derivatives of that by the phase and the base frequency.
    pub(in crate::contact_equation) free: &'w [f64],
    pub(in crate::contact_equation) begun: [&'w [f64]; 2],
    /// What its forces do, if it has some.
    pub(super) integrals: Option<&'w Integrals>,
    /// The frequency that is varied, if derivatives by it are asked for.
    pub(in crate::contact_equation) omega: Option<f64>,
    pub(in crate::contact_equation) derivatives: bool,
}

/// State by state, target by target.
#[derive(Debug, Default)]
pub(super) struct Targets {
    count: usize,
    pub(in crate::contact_equation) phases: Vec<f64>,
    states: Vec<f64>,
    by_from: Vec<f64>,
    by_to: Vec<f64>,
    by_omega: Vec<f64>,
    /// `c` and `k` of every pair.
    kernels: [Vec<f64>; 2],
    found: Found,
    /// The steady response by the phase and by the base frequency.
    steady: [Vec<f64>; 2],
    /// Waves in resonance: states, and by the time, by the phase where the interval begins, and by the base frequency.
    resonant: [Vec<f64>; 4],
    /// Of one wave.
    cosine: Vec<f64>,
    sine: Vec<f64>,
}

impl Targets {
    /// Room for so many states and targets.
    pub(in crate::contact_equation) fn new(order: usize, count: usize) -> Self {
        let all = || vec![0.0; order * count];
        let one = || vec![0.0; count];
        Self {
            count: 0,
            phases: one(),
            states: all(),
            by_from: all(),
            by_to: all(),
            by_omega: all(),
            kernels: std::array::from_fn(|_| vec![0.0; order / 2 * count]),
            found: Found::default(),
            steady: std::array::from_fn(|_| all()),
            resonant: std::array::from_fn(|_| all()),
            cosine: one(),
            sine: one(),
        }
    }

    /// A state at a target.
    pub(in crate::contact_equation) fn state(&self, target: usize, state: usize) -> f64 {
        self.states[state * self.count + target]
    }

    /// Writes all states at a target.
    pub(in crate::contact_equation) fn write(&self, target: usize, to: &mut [f64]) {
        for (state, to) in to.iter_mut().enumerate() {
            *to = self.state(target, state);
        }
    }

    /// How a state at a target changes with where the interval begins and ends, and with the frequency.
    pub(in crate::contact_equation) fn slopes(&self, target: usize, state: usize) -> [f64; 3] {
        let at = state * self.count + target;
        [self.by_from[at], self.by_to[at], self.by_omega[at]]
    }

    /// The same of all states, where there is one target.
    pub(super) fn slopes_at_one(&self, order: usize) -> [&[f64]; 3] {
        [&self.by_from, &self.by_to, &self.by_omega].map(|of| &of[..order])
    }

    /// `c` and `k` of a pair at a target.
    pub(in crate::contact_equation) fn kernel(&self, target: usize, pair: usize) -> [f64; 2] {
        let at = pair * self.count + target;
        [self.kernels[0][at], self.kernels[1][at]]
    }

    /// Everything at all targets of an interval.
    pub(in crate::contact_equation) fn fill(&mut self, way: &Way<'_>) {
        let [from, to] = way.phases;
        self.count = way.psi.len();
        for (phase, psi) in self.phases.iter_mut().zip(way.psi) {
            *phase = if *psi == 1.0 {
                to
            } else {
                from + psi * (to - from)
            };
        }
        self.add_steady(way);
        let resonant = self.add_resonant(way);
        self.find_kernels(way);
        for r in 0..way.values.linear.blocks.len() {
            self.compose(way, r, resonant);
        }
    }

    /// Kernels of all pairs: of each at all targets at once, or of all at the only target.
    fn find_kernels(&mut self, way: &Way<'_>) {
        let (count, linear) = (self.count, &way.values.linear);
        let [c, k] = &mut self.kernels;
        let found = &mut self.found;
        if let [psi] = *way.psi {
            linear.kernels.find(&linear.blocks, psi * way.time, found);
            let pairs = linear.blocks.len();
            c[..pairs].copy_from_slice(&found.c[..pairs]);
            k[..pairs].copy_from_slice(&found.k[..pairs]);
            return;
        }
        for (r, block) in linear.blocks.iter().enumerate() {
            let place = r * count..(r + 1) * count;
            let (c, k) = (&mut c[place.clone()], &mut k[place]);
            if block.is_free() {
                c.fill(1.0);
                for (k, psi) in k.iter_mut().zip(way.psi) {
                    *k = psi * way.time;
                }
            } else {
                found.find(block, way.psi, way.time);
                c.copy_from_slice(&found.c[..count]);
                k.copy_from_slice(&found.k[..count]);
            }
        }
    }

    /// The steady response.
    fn add_steady(&mut self, way: &Way<'_>) {
        let (count, order) = (self.count, way.values.order());
        self.states[..order * count].fill(0.0);
        if way.derivatives {
            for steady in &mut self.steady {
                steady[..order * count].fill(0.0);
            }
        }
        for wave in &way.values.load {
            if wave.is_resonant() {
                continue;
            }
            let phases = self.phases[..count].iter();
            for ((phase, cosine), sine) in phases.zip(&mut self.cosine).zip(&mut self.sine) {
                let turn = turn(wave.harmonic * phase);
                (*cosine, *sine) = (turn.re, turn.im);
            }
            let turns = [&self.cosine[..count], &self.sine[..count]];
            for (state, [response, by]) in wave.steady.iter().enumerate() {
                let place = state * count..(state + 1) * count;
                add_both(
                    turns,
                    [response.re, -response.im],
                    &mut self.states[place.clone()],
                );
                if way.derivatives {
                    let slope = [response.im, response.re].map(|x| -wave.harmonic * x);
                    add_both(turns, slope, &mut self.steady[0][place.clone()]);
                    add_both(turns, [by.re, -by.im], &mut self.steady[1][place]);
                }
            }
        }
    }

    /// Waves in resonance. Says whether there are any.
    fn add_resonant(&mut self, way: &Way<'_>) -> bool {
        let (count, order) = (self.count, way.values.order());
        if !way.values.has_resonance() {
            return false;
        }
        for resonant in &mut self.resonant {
            resonant[..order * count].fill(0.0);
        }
        for wave in &way.values.load {
            for &r in &wave.resonant {
                if wave.is_constant_on(&way.values.linear.blocks[r]) {
                    self.add_parabola(way, wave.input[r].map(|x| x.re), r);
                    continue;
                }
                for (target, psi) in way.psi.iter().enumerate() {
                    let resonance = way
                        .values
                        .resonance(wave, r, [way.phases[0], psi * way.time]);
                    for (to, of) in self.resonant.iter_mut().zip(resonance) {
                        for i in 0..2 {
                            to[(2 * r + i) * count + target] += of[i];
                        }
                    }
                }
            }
        }
        true
    }

    /// A constant load on a pair that nothing holds.
    fn add_parabola(&mut self, way: &Way<'_>, input: Pair, r: usize) {
        let moved = times(way.values.linear.blocks[r].deviation, input);
        for i in 0..2 {
            let place = (2 * r + i) * self.count..(2 * r + i + 1) * self.count;
            let [state, by_time, ..] = &mut self.resonant;
            let places = state[place.clone()].iter_mut().zip(&mut by_time[place]);
            for ((state, by_time), psi) in places.zip(way.psi) {
                let time = psi * way.time;
                *state += time * (input[i] + 0.5 * time * moved[i]);
                *by_time += input[i] + time * moved[i];
            }
        }
    }

    /// (1) of a pair, and its derivatives.
    fn compose(&mut self, way: &Way<'_>, r: usize, resonant: bool) {
        let count = self.count;
        let block = &way.values.linear.blocks[r];
        let free = pair(way.free, r);
        let turned = times(block.deviation, free);
        let moved = times(block.matrix, free);
        let moved = [moved, times(block.deviation, moved)];
        let begun = way.begun.map(|of| pair(of, r));
        let begun = begun.map(|of| [of, times(block.deviation, of)]);
        for i in 0..2 {
            let state = 2 * r + i;
            let place = state * count..(state + 1) * count;
            let kernels = self.kernels.each_ref();
            let kernels = kernels.map(|of| &of[r * count..][..count]);
            let to = &mut self.states[place.clone()];
            add_both(kernels, [free[i], turned[i]], to);
            if let Some(integrals) = way.integrals {
                add(to, 1.0, integrals.forced(0, state));
            }
            if resonant {
                add(to, 1.0, &self.resonant[0][place.clone()]);
            }
            if way.derivatives {
                let of = |of: [Pair; 2]| [of[0][i], of[1][i]];
                self.derive(way, state, of(moved), begun.map(of), resonant);
            }
        }
    }

    /// Derivatives of a state: what is free moves with the time like `moved`, and the steady response began with the derivatives `begun`,
    /// each in parts of `c` and `k`.
    fn derive(
        &mut self,
        way: &Way<'_>,
        state: usize,
        moved: Pair,
        begun: [Pair; 2],
        resonant: bool,
    ) {
        let (count, base) = (self.count, way.values.base);
        let place = state * count..(state + 1) * count;
        let kernels = self.kernels.each_ref();
        let [c, k] = kernels.map(|of| &of[state / 2 * count..][..count]);
        let resonant = resonant.then(|| self.resonant.each_ref().map(|of| &of[place.clone()]));
        let forced = way.integrals.filter(|integrals| integrals.moves());
        let driven = way.integrals.map(|integrals| integrals.driven(state));
        let steady = self.steady.each_ref().map(|of| &of[place.clone()]);
        for (t, psi) in way.psi.iter().enumerate() {
            let of = |pair: Pair| pair[0] * c[t] + pair[1] * k[t];
            let mut by_time = psi * of(moved);
            let mut by_from = (1.0 - psi) * steady[0][t] - of(begun[0]);
            let mut by_to = psi * steady[0][t];
            let mut by_omega = steady[1][t] - of(begun[1]);
            if let Some(driven) = driven {
                by_time += driven[t];
            }
            if let Some(integrals) = forced {
                by_from += integrals.forced(1, state)[t];
                by_to += integrals.forced(2, state)[t];
            }
            if let Some(resonant) = resonant {
                by_time += psi * resonant[1][t];
                by_from += resonant[2][t];
                by_omega += resonant[3][t];
            }
            // The base frequency is a part of the one that is varied, and the time is as long as that is short.
            if let Some(omega) = way.omega {
                by_omega = (by_omega * base - by_time * way.time) / omega;
            }
            let at = state * count + t;
            self.by_from[at] = by_from - by_time / base;
            self.by_to[at] = by_to + by_time / base;
            self.by_omega[at] = by_omega;
        }
    }
}
