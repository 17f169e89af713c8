//! An output over the period: smooth between the phases at which one of its contacts switches.
//!
//! Extremes: samples of each stretch, its ends included, and parabolas through those samples that might be exceeded.
//! Means: Gauss rules on parts of each stretch. At a switch a force goes as a power of the distance, so nodes are graded there by
//! `3 s^2 - 2 s^3`, under which half-integer powers are analytic.

use std::f64::consts::TAU;

use super::Motion;
use super::sampler::Sampler;
use super::sum::{Motions, Sum};
use crate::balance::gap_series;
use crate::law::{On, Variation};
use crate::laws::single;
use crate::numeric::fourier::crossings::levels::{Cuts, Segment};
use crate::numeric::fourier::gauss;
use crate::numeric::fourier::series;
use crate::numeric::peak;
use crate::numeric::roots::Place;
use crate::system::System;

/// Samples of the shortest wave.
const PER_WAVE: f64 = 8.0;
/// Samples of a stretch, at least.
const FEWEST: usize = 16;
/// Waves of the square of an output in one part of a stretch, and nodes of its rule.
const WAVES: f64 = 12.0;
const NODES: usize = 64;

/// A signal over the period of an orbit.
#[derive(Debug)]
pub(super) struct Waveform<'o> {
    smooth: Vec<f64>,
    forces: Vec<Force<'o>>,
    /// The phases at which something switches, in increasing order.
    switches: Vec<f64>,
    base: f64,
    /// Of everything in it.
    harmonics: usize,
}

/// The force of a contact, and what multiplies it.
#[derive(Debug)]
struct Force<'o> {
    system: &'o dyn System,
    law: usize,
    arguments: Vec<f64>,
    weight: Vec<f64>,
    gap: Vec<f64>,
    segments: Vec<Segment>,
}

/// From one switch to the next.
#[derive(Debug, Clone)]
struct Stretch {
    start: f64,
    end: f64,
    /// The piece of each force.
    pieces: Vec<usize>,
}

impl<'o> Waveform<'o> {
    pub(super) fn new(motions: &Motions<'o>, sum: Sum) -> Self {
        let mut forces = Vec::new();
        let mut switches: Vec<f64> = Vec::new();
        for (contact, weight) in sum.weights {
            if let Some(force) = Force::of(motions, contact, weight) {
                let cut = force.segments.iter().filter(|own| own.levels.is_some());
                switches.extend(cut.map(|segment| segment.start.rem_euclid(TAU)));
                forces.push(force);
            }
        }
        switches.sort_unstable_by(f64::total_cmp);
        switches.dedup();
        let lengths = forces.iter().map(|force| force.gap.len());
        let longest = lengths.chain([sum.smooth.len()]).max().unwrap_or(1);
        Self {
            smooth: sum.smooth,
            forces,
            switches,
            base: motions.base,
            harmonics: (longest / 2).max(1),
        }
    }

    /// The series itself, where no force is in it.
    fn is_smooth(&self) -> bool {
        self.forces.is_empty()
    }

    /// Its extremes, mean and root of the mean square.
    pub(super) fn motion(&self, sampler: &mut Sampler) -> Motion {
        if self.is_smooth() {
            return Motion::read(sampler, &self.smooth);
        }
        let mut motion = Motion::NONE;
        let (mut mean, mut square) = (0.0, 0.0);
        for stretch in self.stretches() {
            for sign in [1.0, -1.0] {
                motion.include(sign * self.largest(&stretch, sign));
            }
            self.integrate(&stretch, &mut |_, weight, value| {
                mean += weight * value;
                square += weight * value * value;
            });
        }
        motion.mean = Some(mean / TAU);
        motion.rms = Some((square / TAU).max(0.0).sqrt());
        motion
    }

    /// Its Fourier series, of so many harmonics where a force is in it.
    pub(super) fn series(&self, harmonics: usize) -> Vec<f64> {
        if self.is_smooth() {
            return self.smooth.clone();
        }
        let mut sum = vec![0.0; series::length(harmonics)];
        for stretch in self.stretches() {
            self.integrate(&stretch, &mut |tau, weight, value| {
                let (sine, cosine) = tau.sin_cos();
                let (mut c, mut s) = (1.0, 0.0);
                let part = weight * value / TAU;
                sum[0] += part;
                for pair in sum[1..].chunks_exact_mut(2) {
                    (c, s) = (c * cosine - s * sine, s * cosine + c * sine);
                    pair[0] += 2.0 * part * c;
                    pair[1] += 2.0 * part * s;
                }
            });
        }
        sum
    }

    /// Phases and values at so many equal steps of the period and at both ends of each stretch, in increasing order from zero to a period.
    pub(super) fn sampled(&self, count: usize) -> Vec<[f64; 2]> {
        let mut samples = Vec::new();
        for stretch in self.stretches() {
            let Stretch { start, end, .. } = stretch;
            let steps = ((end - start) / TAU * count as f64).ceil().max(1.0);
            let count = steps as usize;
            // The end itself to the bit, so that the next stretch is seen to begin there.
            let at = |i: usize| match i {
                _ if i == count => end,
                _ => start + (end - start) * i as f64 / steps,
            };
            samples.extend((0..=count).map(|i| [at(i), self.value(at(i), &stretch)]));
        }
        let first = samples.first().map_or(0.0, |[tau, _]| *tau);
        // The last stretch goes on from the beginning of the period: what is beyond its end stands there.
        let beyond = samples.partition_point(|[tau, _]| *tau <= TAU);
        let Some(([before, at], [after, behind])) = beyond
            .checked_sub(1)
            .and_then(|last| Some((samples[last], *samples.get(beyond)?)))
        else {
            return samples;
        };
        let across = at + (behind - at) * (TAU - before) / (after - before);
        let moved = samples[beyond..]
            .iter()
            .map(|[tau, value]| [(tau - TAU).min(first), *value]);
        let begin = std::iter::once([0.0, across]).chain(moved);
        let rest = samples[..beyond].iter().copied();
        begin.chain(rest).chain([[TAU, across]]).collect()
    }

    fn stretches(&self) -> Vec<Stretch> {
        let pieces = |start: f64, end: f64| Stretch {
            start,
            end,
            pieces: (self.forces.iter())
                .map(|force| force.piece_at(0.5 * (start + end)))
                .collect(),
        };
        let Some(&first) = self.switches.first() else {
            return vec![pieces(0.0, TAU)];
        };
        let ends = self.switches.iter().skip(1).copied().chain([first + TAU]);
        let both = self.switches.iter().zip(ends);
        both.map(|(&start, end)| pieces(start, end)).collect()
    }

    fn value(&self, tau: f64, stretch: &Stretch) -> f64 {
        let mut value = series::value(&self.smooth, tau);
        for (force, &piece) in self.forces.iter().zip(&stretch.pieces) {
            value += force.value(tau, piece, self.base);
        }
        value
    }

    /// The largest value on a stretch, of the signal times a sign.
    fn largest(&self, stretch: &Stretch, sign: f64) -> f64 {
        let Stretch { start, end, .. } = *stretch;
        let whole = self.switches.is_empty();
        let waves = (end - start) / TAU * self.harmonics as f64;
        let count = FEWEST.max((PER_WAVE * waves).ceil() as usize);
        let step = (end - start) / count as f64;
        let at = |tau: f64| sign * self.value(tau, stretch);
        let place = |index: usize| {
            if index == count {
                end
            } else {
                start + step * index as f64
            }
        };
        let values: Vec<f64> = (0..=count).map(|index| at(place(index))).collect();
        let mut largest = values.iter().copied().fold(f64::NEG_INFINITY, f64::max);
        for index in 0..=count {
            let here = values[index];
            let before = if index > 0 { values[index - 1] } else { here };
            let after = values.get(index + 1).copied().unwrap_or(here);
            // The parabola through three samples rises by an eighth of their second difference at most; the double is allowed for.
            let promise = here + 0.25 * ((here - before) + (here - after)).abs();
            let inside = index > 0 && index < count;
            if here < before || here < after || (inside && promise < largest) {
                continue;
            }
            let known = |x: f64, index: usize| Place {
                x,
                value: values[index],
            };
            let x = place(index);
            // A signal without switches goes on behind its ends.
            let ends = if whole {
                let [before, after] = [(index + count - 1) % count, (index + 1) % count];
                [known(x - step, before), known(x + step, after)]
            } else {
                let around = [index.saturating_sub(1), (index + 1).min(count)];
                around.map(|index| known(place(index), index))
            };
            let between = (ends[0].x < x && x < ends[1].x).then(|| known(x, index));
            largest = largest.max(peak::largest(at, ends, between));
        }
        largest
    }

    /// Adds phase, weight and value of the nodes on a stretch.
    fn integrate(&self, stretch: &Stretch, add: &mut dyn FnMut(f64, f64, f64)) {
        let Stretch { start, end, .. } = *stretch;
        let waves = (end - start) / TAU * 2.0 * self.harmonics as f64;
        let parts = (waves / WAVES).ceil().max(1.0) as usize;
        let rule = gauss::rule(NODES);
        for part in 0..parts {
            let [low, high] = [part, part + 1].map(|part| part as f64 / parts as f64);
            for (&node, &weight) in rule.nodes.iter().zip(&rule.weights) {
                let s = low + (high - low) * node;
                let tau = start + (end - start) * s * s * (3.0 - 2.0 * s);
                let by = (end - start) * 6.0 * s * (1.0 - s) * (high - low);
                add(tau, weight * by, self.value(tau, stretch));
            }
        }
    }
}

impl<'o> Force<'o> {
    /// Nothing where the law has no force.
    fn of(motions: &Motions<'o>, contact: usize, weight: Vec<f64>) -> Option<Self> {
        let layout = &motions.layout.contacts[contact];
        let law = motions.system.law(layout.law);
        let mut pieces = law.facts().pieces.iter();
        if pieces.all(|piece| piece.force == Variation::Zero) {
            return None;
        }
        let mut arguments = vec![0.0; layout.argument_count];
        layout.arguments(&motions.coefficients, &mut arguments);
        let declared = layout.gap_harmonic().max(layout.offset_harmonic());
        let harmonics = (motions.length / 2) + motions.period * declared;
        let mut gap = vec![0.0; series::length(harmonics)];
        let coefficients = &motions.coefficients;
        gap_series(
            layout,
            coefficients,
            motions.period,
            motions.rows,
            motions.length,
            &mut gap,
        );
        let mut levels = vec![0.0; law.facts().levels.len()];
        law.levels(&arguments, &mut levels);
        let (mut sampler, mut cuts) = (Sampler::default(), Cuts::default());
        sampler.load(&gap);
        cuts.apply(sampler.finder(), &gap, &levels);
        Some(Self {
            system: motions.system,
            law: layout.law,
            arguments,
            weight,
            gap,
            segments: cuts.segments().to_vec(),
        })
    }

    fn piece_at(&self, tau: f64) -> usize {
        let holds = |segment: &&Segment| {
            (tau - segment.start).rem_euclid(TAU) < segment.end - segment.start
        };
        let mut segments = self.segments.iter();
        let found = segments.find(holds).or(self.segments.first());
        found.map_or(0, |segment| segment.piece)
    }

    fn value(&self, tau: f64, piece: usize, base: f64) -> f64 {
        let law = self.system.law(self.law);
        if law.facts().pieces[piece].force == Variation::Zero {
            return 0.0;
        }
        let (gap, slope, _) = series::value_and_derivatives(&self.gap, tau);
        let state = [gap, base * slope];
        let force = single::force(law, On::Piece(piece), &self.arguments, state);
        series::value(&self.weight, tau) * force
    }
}
