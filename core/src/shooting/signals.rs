//! Outputs and forces over an orbit, from its motion in time.
//!
//! Between two switches a signal is smooth but for powers of the distance from where they are: in `s` with
//! `tau = a + (b - a) s^2 (3 - 2 s)` the half-integer ones are analytic. A Gauss rule on a part of `s` is compared with the same rule on its
//! halves, which are taken where both agree, and divided again where they do not. A largest value is looked for beside those of the nodes
//! that may be exceeded.
//!
//! Of an orbit that comes back after a part of its period, with coordinates in each other's place, that part is shown alone, and all of its
//! images are read at once. A signal of an image that is another signal of the part before, as the force of the ball of a bearing that has come to the place of the one
//! before it, is looked at there alone. Signals of images are called channels.

use std::f64::consts::TAU;

use super::problem::ShootingProblem;
use crate::branches::observed::{ContactMotion, EXTREMES, Motion};
use crate::branches::recurrence::{Recurrence, SignedPermutation};
use crate::numeric::fourier::{gauss, series};
use crate::numeric::roots::Place;
use crate::numeric::{disturb, peak};
use crate::time::Stretch;
use crate::time::signals::{Asked, Chosen, Signals};

/// Nodes of a rule.
const NODES: usize = 8;
/// Two rules agree if they differ by this part of the largest value: the finer one has twice as many digits.
const AGREE: f64 = 1e-9;
/// What differs by less and does not fall when a part is halved is rounding.
const NOISE: f64 = 1e-5;
/// A stretch is divided into at most two to this power.
const DEEPEST: usize = 9;
/// Angle of the highest harmonic over a part, where harmonics are asked for.
const ANGLE: f64 = 2.0;

impl ShootingProblem {
    /// Reads signals, with so many harmonics, off an orbit that comes back like this, where what is varied has a value.
    pub(crate) fn reader(
        &self,
        value: f64,
        asked: Asked,
        recurrence: &Recurrence,
        harmonics: usize,
    ) -> Reader<'_> {
        let system = self.system.as_ref();
        let (parameters, omega) = (self.parameters_at(value), self.omega_at(value));
        let signals = Signals::new(system, &parameters, omega, asked);
        let coordinates = system.facts().coordinates.len();
        Reader::new(signals, recurrence, coordinates, harmonics)
    }

    /// The same of all outputs, without harmonics; nothing where the system has none.
    pub(crate) fn output_reader(&self, value: f64, recurrence: &Recurrence) -> Option<Reader<'_>> {
        let any = !self.system.facts().outputs.is_empty();
        any.then(|| self.reader(value, Asked::Outputs, recurrence, 0))
    }
}

/// What is found of a signal.
#[derive(Debug, Clone)]
pub(crate) struct Found {
    /// Extremes, mean and root of the mean square.
    pub(crate) motion: Motion,
    /// Its Fourier series in harmonics of the orbit, as many as were asked for.
    pub(crate) series: Vec<f64>,
}

/// Reads signals off an orbit, stretch after stretch.
pub(crate) struct Reader<'s> {
    signals: Signals<'s>,
    /// Each signal alone.
    alone: Vec<Chosen>,
    images: Vec<Image>,
    /// Which channel each is, of those that are looked at.
    same: Vec<usize>,
    /// The signals that each channel is looked at for.
    sharers: Vec<Vec<usize>>,
    /// Periods of the declaration.
    period: usize,
    found: Vec<Found>,
    harmonics: usize,
    /// Where the present stretch begins, in the phase of the orbit from zero on; nothing before the first one.
    passed: Option<f64>,
    /// Phase on each piece of each contact.
    on_pieces: Vec<Vec<f64>>,
    state: Vec<f64>,
    image: Vec<f64>,
}

/// The same stretch with roundings in its states, which are those of sums that cancel in an output.
pub(crate) struct Rounded<'s>(pub(crate) &'s dyn Stretch);

impl Stretch for Rounded<'_> {
    fn phases(&self) -> (f64, f64) {
        self.0.phases()
    }

    fn state(&self, phase: f64, state: &mut [f64]) {
        self.0.state(phase, state);
        disturb(state, EXTREMES * f64::EPSILON);
    }
}

/// One part of the orbit.
struct Image {
    of: SignedPermutation,
    /// The signals that are looked at in it.
    chosen: Chosen,
    /// Its phase after the first part.
    phase: f64,
    /// The piece of every contact on the present stretch.
    pieces: Vec<usize>,
    /// For every contact, whether it touched on each stretch, where that changed.
    touched: Vec<Vec<bool>>,
}

/// The nodes of a rule with all signals of all images.
struct Nodes {
    phases: [f64; NODES],
    weights: [f64; NODES],
    /// Node after node.
    values: Vec<f64>,
}

impl Nodes {
    /// A signal of an image at a node.
    fn at(&self, index: usize, channel: usize) -> f64 {
        self.values[index * (self.values.len() / NODES) + channel]
    }

    /// Its integral, and that of its square.
    fn sums(&self, channel: usize) -> [f64; 2] {
        let weights = self.weights.iter().enumerate();
        weights.fold([0.0; 2], |sums, (index, weight)| {
            let x = self.at(index, channel);
            [sums[0] + weight * x, sums[1] + weight * x * x]
        })
    }
}

impl<'s> Reader<'s> {
    /// Reads these signals, with so many harmonics, off an orbit of so many coordinates that comes back like this.
    pub(crate) fn new(
        signals: Signals<'s>,
        recurrence: &Recurrence,
        coordinates: usize,
        harmonics: usize,
    ) -> Self {
        let pieces: Vec<usize> = signals.pieces().collect();
        let Recurrence {
            period,
            parts,
            image,
        } = recurrence;
        let later = TAU * *period as f64 / *parts as f64;
        let count = signals.count();
        let same = same(&signals, recurrence, later);
        let sharers = sharers(&same, signals.count());
        let images = (0..*parts).map(|part| Image {
            of: image.power(part),
            chosen: signals.choose((0..count).filter(|of| {
                let channel = part * count + of;
                same[channel] == channel
            })),
            phase: TAU * (period * part) as f64 / *parts as f64,
            pieces: vec![0; pieces.len()],
            touched: vec![Vec::new(); pieces.len()],
        });
        let found = Found {
            motion: Motion {
                mean: Some(0.0),
                rms: Some(0.0),
                ..Motion::NONE
            },
            series: vec![0.0; series::length(harmonics)],
        };
        Self {
            images: images.collect(),
            alone: (0..count).map(|of| signals.choose([of])).collect(),
            sharers,
            same,
            period: *period,
            found: vec![found; count],
            harmonics,
            signals,
            passed: None,
            on_pieces: pieces.iter().map(|&count| vec![0.0; count]).collect(),
            state: vec![0.0; 2 * coordinates],
            image: vec![0.0; 2 * coordinates],
        }
    }

    /// Includes a stretch.
    pub(crate) fn include(&mut self, stretch: &dyn Stretch) {
        let (from, to) = stretch.phases();
        let passed = self.passed.unwrap_or(from);
        self.passed = Some(passed);
        if from >= to {
            return;
        }
        self.place(stretch, [from, to]);
        let angle = self.harmonics as f64 * (to - from) / self.period as f64;
        let parts = (angle / ANGLE).ceil().max(1.0) as usize;
        for part in 0..parts {
            let ends = [part, part + 1].map(|part| part as f64 / parts as f64);
            let whole = self.nodes(stretch, ends);
            self.part(stretch, ends, &whole, f64::INFINITY, DEEPEST);
        }
        self.passed = Some(passed + (to - from));
    }

    /// What was found of every signal.
    pub(crate) fn found(self) -> Vec<Found> {
        let whole = TAU * self.period as f64;
        let mut found = self.found;
        for Found { motion, series } in &mut found {
            motion.mean = motion.mean.map(|sum| sum / whole);
            motion.rms = motion.rms.map(|sum| (sum / whole).max(0.0).sqrt());
            for (index, x) in series.iter_mut().enumerate() {
                *x *= if index == 0 { 1.0 } else { 2.0 } / whole;
            }
        }
        found
    }

    /// The same without the series.
    pub(crate) fn motions(self) -> Vec<Motion> {
        let found = self.found().into_iter();
        found.map(|found| found.motion).collect()
    }

    /// What was found of the contacts, where their forces were asked for, over a period of this length; and the part of it on each piece.
    pub(crate) fn contacts(self, time: f64) -> (Vec<ContactMotion>, Vec<Vec<f64>>) {
        let whole = TAU * self.period as f64;
        let mut on_pieces = self.on_pieces.clone();
        for part in on_pieces.iter_mut().flatten() {
            *part = (*part / whole).min(1.0);
        }
        let count = self.on_pieces.len();
        let touches: Vec<Vec<usize>> = (0..count)
            .map(|contact| {
                let pieces = 0..on_pieces[contact].len();
                pieces
                    .filter(|&piece| self.signals.touches(contact, piece))
                    .collect()
            })
            .collect();
        let intervals: Vec<usize> = (0..count).map(|contact| self.intervals(contact)).collect();
        let found = self.found().into_iter().enumerate();
        let contacts = found.map(|(contact, Found { motion, .. })| {
            let on = touches[contact]
                .iter()
                .map(|&piece| on_pieces[contact][piece]);
            ContactMotion {
                peak_force: motion.maximum.abs().max(motion.minimum.abs()),
                minimum_force: motion.minimum,
                maximum_force: motion.maximum,
                fraction: on.sum::<f64>().min(1.0),
                count: intervals[contact],
                impulse: motion.mean.map(|mean| mean * time),
            }
        });
        (contacts.collect(), on_pieces)
    }

    /// Separate intervals of contact in the period: one where it is never lost.
    fn intervals(&self, contact: usize) -> usize {
        let all = self.images.iter().flat_map(|image| &image.touched[contact]);
        let all: Vec<bool> = all.copied().collect();
        if all.iter().all(|&touches| touches) {
            return usize::from(!all.is_empty());
        }
        let next = all.iter().skip(1).chain(all.first());
        all.iter()
            .zip(next)
            .filter(|&(before, next)| !before && *next)
            .count()
    }

    /// Takes the pieces that gaps are on along a stretch.
    fn place(&mut self, stretch: &dyn Stretch, [from, to]: [f64; 2]) {
        let middle = 0.5 * (from + to);
        stretch.state(middle, &mut self.state);
        for image in &mut self.images {
            image.of.write(&self.state, &mut self.image);
            let phase = middle + image.phase;
            self.signals.place(phase, &self.image, &mut image.pieces);
            for (contact, &piece) in image.pieces.iter().enumerate() {
                self.on_pieces[contact][piece] += to - from;
                let touches = self.signals.touches(contact, piece);
                let touched = &mut image.touched[contact];
                if touched.last() != Some(&touches) {
                    touched.push(touches);
                }
            }
        }
    }

    /// Writes all channels at a phase.
    fn write(&mut self, stretch: &dyn Stretch, phase: f64, out: &mut [f64]) {
        let count = self.found.len().max(1);
        stretch.state(phase, &mut self.state);
        for (image, out) in self.images.iter().zip(out.chunks_exact_mut(count)) {
            if !image.chosen.signals().is_empty() {
                let state = image.state(&self.state, &mut self.image);
                let (chosen, phase) = (&image.chosen, phase + image.phase);
                self.signals
                    .write_some(chosen, phase, state, &image.pieces, out);
            }
        }
        for channel in 0..out.len() {
            out[channel] = out[self.same[channel]];
        }
    }

    /// Writes one channel at a phase in its place among the signals, and returns it.
    fn value(&mut self, stretch: &dyn Stretch, phase: f64, channel: usize, out: &mut [f64]) -> f64 {
        let count = self.found.len();
        stretch.state(phase, &mut self.state);
        let (image, alone) = (&self.images[channel / count], &self.alone[channel % count]);
        let state = image.state(&self.state, &mut self.image);
        let phase = phase + image.phase;
        self.signals
            .write_some(alone, phase, state, &image.pieces, out);
        out[channel % count]
    }

    fn is_looked_at(&self, channel: usize) -> bool {
        self.same[channel] == channel
    }

    fn nodes(&mut self, stretch: &dyn Stretch, [from, to]: [f64; 2]) -> Nodes {
        let (begin, end) = stretch.phases();
        let count = self.found.len() * self.images.len();
        let mut nodes = Nodes {
            phases: [0.0; NODES],
            weights: [0.0; NODES],
            values: vec![0.0; NODES * count],
        };
        let rule = gauss::rule(NODES);
        for (index, row) in nodes.values.chunks_exact_mut(count.max(1)).enumerate() {
            let s = from + (to - from) * rule.nodes[index];
            let phase = place(s, [begin, end]);
            nodes.phases[index] = phase;
            nodes.weights[index] =
                (end - begin) * 6.0 * s * (1.0 - s) * (to - from) * rule.weights[index];
            self.write(stretch, phase, row);
        }
        nodes
    }

    /// Includes a part of a stretch, of which one rule is known: what halves changed before says whether that still means something.
    fn part(
        &mut self,
        stretch: &dyn Stretch,
        [from, to]: [f64; 2],
        whole: &Nodes,
        before: f64,
        depth: usize,
    ) {
        let middle = 0.5 * (from + to);
        let halves = [[from, middle], [middle, to]];
        let parts = halves.map(|ends| self.nodes(stretch, ends));
        let apart = self.apart(whole, &parts);
        let noise = apart <= NOISE && apart >= 0.25 * before;
        if apart <= AGREE || noise || depth == 0 {
            self.take(stretch, [from, to], &parts);
            return;
        }
        for (ends, nodes) in halves.into_iter().zip(&parts) {
            self.part(stretch, ends, nodes, apart, depth - 1);
        }
    }

    /// Takes the nodes of two halves of a part.
    fn take(&mut self, stretch: &dyn Stretch, [from, to]: [f64; 2], halves: &[Nodes; 2]) {
        let (begin, end) = stretch.phases();
        let count = self.found.len();
        let passed = self.passed.unwrap_or(begin);
        for channel in 0..count * self.images.len() {
            let shift = self.images[channel / count].phase;
            let Found { motion, series } = &mut self.found[channel % count];
            for nodes in halves {
                let [sum, square] = nodes.sums(channel);
                motion.mean = motion.mean.map(|mean| mean + sum);
                motion.rms = motion.rms.map(|rms| rms + square);
                for (index, (phase, weight)) in nodes.phases.iter().zip(nodes.weights).enumerate() {
                    let angle = (passed + phase - begin + shift) / self.period as f64;
                    add_waves(series, angle, weight * nodes.at(index, channel));
                }
            }
        }
        let ends = [from, to].map(|s| place(s, [begin, end]));
        self.take_extremes(stretch, ends, halves);
    }

    /// The largest difference of integrals by a rule and by the rule on halves, in parts of the largest value.
    fn apart(&self, whole: &Nodes, halves: &[Nodes; 2]) -> f64 {
        let length: f64 = whole.weights.iter().sum();
        let mut apart: f64 = 0.0;
        let channels = 0..self.same.len();
        for channel in channels.filter(|channel| self.is_looked_at(*channel)) {
            let [a, b, c] = [whole, &halves[0], &halves[1]].map(|nodes| nodes.sums(channel));
            let size = |nodes: &Nodes| {
                let values = (0..NODES).map(|index| nodes.at(index, channel).abs());
                values.fold(0.0, f64::max)
            };
            let size = size(&halves[0]).max(size(&halves[1]));
            if size > 0.0 {
                apart = apart.max((a[0] - b[0] - c[0]).abs() / (size * length));
                apart = apart.max((a[1] - b[1] - c[1]).abs() / (size * size * length));
            }
        }
        apart
    }

    fn take_extremes(&mut self, stretch: &dyn Stretch, ends: [f64; 2], halves: &[Nodes; 2]) {
        let count = self.found.len();
        let channels = count * self.images.len();
        let mut at_ends = [vec![0.0; channels], vec![0.0; channels]];
        for (phase, values) in ends.into_iter().zip(&mut at_ends) {
            self.write(stretch, phase, values);
        }
        let mut row = vec![0.0; count];
        let sharers = std::mem::take(&mut self.sharers);
        for (channel, sharers) in sharers.iter().enumerate() {
            if sharers.is_empty() {
                continue;
            }
            let mut samples = [[0.0; 2]; 2 * NODES + 2];
            samples[0] = [ends[0], at_ends[0][channel]];
            samples[2 * NODES + 1] = [ends[1], at_ends[1][channel]];
            for (half, nodes) in halves.iter().enumerate() {
                for index in 0..NODES {
                    samples[1 + half * NODES + index] =
                        [nodes.phases[index], nodes.at(index, channel)];
                }
            }
            self.include_in(sharers, samples.iter().map(|[_, value]| *value));
            for sign in [1.0, -1.0] {
                let known = sharers.iter().map(|signal| {
                    let motion = &self.found[*signal].motion;
                    if sign > 0.0 {
                        motion.maximum
                    } else {
                        -motion.minimum
                    }
                });
                // What one of them has seen elsewhere, others may not have.
                let known = known.fold(f64::INFINITY, f64::min);
                let mut at = |phase: f64| sign * self.value(stretch, phase, channel, &mut row);
                let largest = largest(&samples, sign, known, &mut at);
                if largest > known {
                    self.include_in(sharers, [sign * largest]);
                }
            }
        }
        self.sharers = sharers;
    }

    /// Includes values in the extremes of signals.
    fn include_in(&mut self, signals: &[usize], values: impl IntoIterator<Item = f64>) {
        for value in values {
            for signal in signals {
                self.found[*signal].motion.include(value);
            }
        }
    }
}

impl Image {
    /// The state in it of the one in the first part.
    fn state<'r>(&self, state: &'r [f64], room: &'r mut [f64]) -> &'r [f64] {
        if self.of.is_identity() {
            return state;
        }
        self.of.write(state, room);
        room
    }
}

/// A phase between two others, graded at both.
fn place(s: f64, [begin, end]: [f64; 2]) -> f64 {
    begin + (end - begin) * s * s * (3.0 - 2.0 * s)
}

/// For every channel the one that is looked at in its place: a signal that is another one after a part of the period is that in the image before.
fn same(signals: &Signals<'_>, recurrence: &Recurrence, later: f64) -> Vec<usize> {
    let count = signals.count();
    let mut same: Vec<usize> = (0..count).collect();
    if recurrence.parts > 1 {
        let images = signals.images(later, &|index| recurrence.image.entry(index));
        for channel in count..count * recurrence.parts {
            let before = images[channel % count].map(|of| channel / count * count - count + of);
            same.push(before.map_or(channel, |before| same[before]));
        }
    }
    same
}

/// For every channel the signals that it is looked at for, of so many.
fn sharers(same: &[usize], count: usize) -> Vec<Vec<usize>> {
    let mut sharers = vec![Vec::new(); same.len()];
    for (channel, root) in same.iter().enumerate() {
        let signal = channel % count;
        if !sharers[*root].contains(&signal) {
            sharers[*root].push(signal);
        }
    }
    sharers
}

/// The largest value near samples, or the one that is known.
fn largest(samples: &[[f64; 2]], sign: f64, known: f64, at: &mut dyn FnMut(f64) -> f64) -> f64 {
    let mut largest = known;
    let last = samples.len() - 1;
    let value = |index: usize| sign * samples[index][1];
    for index in 0..=last {
        let (before, next) = (index.saturating_sub(1), (index + 1).min(last));
        let here = value(index);
        if here < value(before) || here < value(next) {
            continue;
        }
        let middle = index.clamp(1, last - 1);
        let three = [middle - 1, middle, middle + 1].map(|index| samples[index]);
        let (slope, rise) = parabola(three, samples[index][0]);
        // Beyond an end it may grow, but that is not asked.
        let outwards = index == 0 && sign * slope <= 0.0 || index == last && sign * slope >= 0.0;
        if !outwards && here + 2.0 * rise > largest {
            let place = |index: usize| Place {
                x: samples[index][0],
                value: value(index),
            };
            let ends = [before, next].map(place);
            let inside = (before < index && index < next).then(|| place(index));
            let found = peak::largest(&mut *at, ends, inside);
            largest = largest.max(found);
        }
    }
    largest
}

/// The slope of the parabola through three samples at a place, and how far its value there is from that at its vertex.
fn parabola([a, b, c]: [[f64; 2]; 3], place: f64) -> (f64, f64) {
    let divided = |a: [f64; 2], b: [f64; 2]| (b[1] - a[1]) / (b[0] - a[0]);
    let first = divided(a, b);
    let bend = (divided(b, c) - first) / (c[0] - a[0]);
    let slope = first + bend * (2.0 * place - a[0] - b[0]);
    let rise = slope * slope / (4.0 * bend.abs());
    (slope, if rise.is_finite() { rise } else { 0.0 })
}

/// Adds a number times the cosine and the sine of every harmonic of an angle.
fn add_waves(series: &mut [f64], angle: f64, number: f64) {
    let (sine, cosine) = angle.sin_cos();
    let (mut c, mut s) = (1.0, 0.0);
    series[0] += number;
    for pair in series[1..].chunks_exact_mut(2) {
        (c, s) = (c * cosine - s * sine, s * cosine + c * sine);
        pair[0] += number * c;
        pair[1] += number * s;
    }
}
