//! The largest force on a segment: by samples, both ends included, and then where the slope vanishes next to the best of them and to
//! every other that might be exceeded by more.
//!
//! The slope by phase is `phi_g dg/dtau + phi_r dr/dtau`. The first step goes to the vertex of the parabola through the best
//! sample and its neighbours, the further ones are secants of the slope, [guarded](Guarded) by the bracket.

use std::f64::consts::TAU;
use std::ops::Range;

use super::sampler::largest;
use crate::balance::rate_series;
use crate::law::{Law, On};
use crate::laws::single::Single;
use crate::numeric::fourier::crossings::levels::Segment;
use crate::numeric::fourier::kernels::{LANES, evaluate};
use crate::numeric::fourier::series;
use crate::numeric::roots::{Guarded, Place, STEPS};

/// Samples below which a segment is sampled by itself.
const FEWEST: usize = 8;
/// Samples of such a segment: two groups of lanes.
const OWN: usize = 2 * LANES;
/// Where the slope at an end is taken, in parts of the distance to the next sample: inside, where no power is on its level.
const INSIDE: f64 = 1e-6;
/// What the next step would gain, in parts of the force, when a search ends.
const GAIN: f64 = 1e-14;

/// The samples of one segment.
#[derive(Debug, Default)]
pub(super) struct Batch {
    phases: Vec<f64>,
    gap: Vec<f64>,
    rate: Vec<f64>,
    force: Vec<f64>,
    /// Series of the rate of a segment that is sampled by itself.
    series: Vec<f64>,
    /// The first and the last sample are not ends, but repeat those at the other end of the period.
    whole: bool,
}

/// The force at a phase, or its negative, and its derivative by the phase.
#[derive(Debug, Clone, Copy)]
struct Slope {
    size: f64,
    slope: f64,
}

/// An orbit under a law, on one piece.
#[derive(Clone, Copy)]
struct Motion<'a> {
    law: &'a dyn Law,
    piece: usize,
    arguments: &'a [f64],
    gap: &'a [f64],
    base: f64,
    /// One to look for the largest force, minus one for the smallest.
    sign: f64,
}

impl Motion<'_> {
    fn at(&self, tau: f64) -> Slope {
        let (gap, by_phase, curvature) = series::value_and_derivatives(self.gap, tau);
        let (on, rate) = (On::Piece(self.piece), self.base * by_phase);
        let at = Single::of(self.law, on, self.arguments, [gap, rate]);
        let slope = at.by_gap * by_phase + at.by_rate * self.base * curvature;
        Slope {
            size: self.sign * at.force,
            slope: self.sign * slope,
        }
    }
}

impl Batch {
    /// Gathers the samples of a segment from those of the period.
    pub(super) fn take(
        &mut self,
        segment: &Segment,
        levels: &[f64],
        [gaps, rates]: [&[f64]; 2],
        gap: &[f64],
        base: f64,
    ) {
        let ends = segment.levels.map(|ends| ends.map(|level| levels[level]));
        let count = gaps.len() as isize;
        let step = TAU / count as f64;
        self.whole = ends.is_none();
        let (first, last) = if self.whole {
            (-1, count)
        } else {
            let first = (segment.start / step).floor() as isize + 1;
            (first, (segment.end / step).ceil() as isize - 1)
        };
        for buffer in [&mut self.phases, &mut self.gap, &mut self.rate] {
            buffer.clear();
        }
        if last - first + 1 < FEWEST as isize {
            self.sample(segment, ends, gap, base);
            return;
        }
        if let Some([level, _]) = ends {
            self.push(segment.start, level, gap, base);
        }
        self.phases
            .extend((first..=last).map(|index| index as f64 * step));
        for index in first..=last {
            let index = index.rem_euclid(count) as usize;
            self.gap.push(gaps[index]);
            self.rate.push(rates[index]);
        }
        if let Some([_, level]) = ends {
            self.push(segment.end, level, gap, base);
        }
    }

    /// Adds an end, where the gap is on a level.
    fn push(&mut self, tau: f64, level: f64, gap: &[f64], base: f64) {
        let (_, by_phase, _) = series::value_and_derivatives(gap, tau);
        self.phases.push(tau);
        self.gap.push(level);
        self.rate.push(base * by_phase);
    }

    /// Samples a segment that is short, from end to end.
    fn sample(&mut self, segment: &Segment, levels: Option<[f64; 2]>, gap: &[f64], base: f64) {
        let step = (segment.end - segment.start) / (OWN - 1) as f64;
        self.phases
            .extend((0..OWN - 1).map(|index| segment.start + step * index as f64));
        self.phases.push(segment.end);
        let (mut sines, mut cosines) = ([0.0; OWN], [0.0; OWN]);
        for (index, tau) in self.phases.iter().enumerate() {
            (sines[index], cosines[index]) = tau.sin_cos();
        }
        self.series.resize(gap.len(), 0.0);
        rate_series(gap, base, &mut self.series);
        self.gap.resize(OWN, 0.0);
        self.rate.resize(OWN, 0.0);
        let both = [gap, &self.series];
        evaluate(both, &cosines, &sines, &mut self.gap, &mut self.rate);
        if let Some(levels) = levels {
            [self.gap[0], self.gap[OWN - 1]] = levels;
        }
    }

    /// Smallest and largest force on the segment that was taken.
    pub(super) fn extremes(
        &mut self,
        law: &dyn Law,
        piece: usize,
        arguments: &[f64],
        gap: &[f64],
        base: f64,
    ) -> [f64; 2] {
        self.force.resize(self.gap.len(), 0.0);
        let on = On::Piece(piece);
        law.force(on, arguments, &self.gap, &self.rate, &mut self.force);
        let motion = Motion {
            law,
            piece,
            arguments,
            gap,
            base,
            sign: 1.0,
        };
        let most = self.largest(motion);
        for force in &mut self.force {
            *force = -*force;
        }
        let least = -self.largest(Motion {
            sign: -1.0,
            ..motion
        });
        [least, most]
    }

    /// The largest value of what has been sampled.
    fn largest(&self, motion: Motion<'_>) -> f64 {
        // The best first: few others can then be larger.
        let best = self.best();
        let mut peak = largest(self.force[best], self.refined(best, motion));
        for index in self.inside() {
            if index != best && self.promise(index) > peak {
                peak = largest(peak, self.refined(index, motion));
            }
        }
        peak
    }

    /// The samples that are in the segment.
    fn inside(&self) -> Range<usize> {
        let skip = usize::from(self.whole);
        skip..self.force.len() - skip
    }

    fn best(&self) -> usize {
        let Range { start, end } = self.inside();
        let larger = |best, index| {
            if self.force[index] > self.force[best] {
                index
            } else {
                best
            }
        };
        (start..end).fold(start, larger)
    }

    /// About the largest value near a sample if it is larger than its neighbours; else nothing. Between samples the parabola
    /// through three of them rises by an eighth of their second difference at most; the double of that is allowed for.
    fn promise(&self, index: usize) -> f64 {
        let at = |index: usize| self.force.get(index).copied().unwrap_or(0.0);
        let (before, here, after) = match index {
            0 => (at(1), at(0), at(1)),
            _ if index + 1 == self.force.len() => (at(index - 1), at(index), at(index - 1)),
            _ => (at(index - 1), at(index), at(index + 1)),
        };
        if here < before || here < after {
            return f64::NEG_INFINITY;
        }
        here + 0.25 * ((here - before) + (here - after))
    }

    /// The largest value next to a sample.
    fn refined(&self, index: usize, motion: Motion<'_>) -> f64 {
        let last = self.force.len() - 1;
        match index {
            0 => self.beside_end(motion, 0, 1),
            _ if index == last => self.beside_end(motion, last, last - 1),
            _ => {
                let bracket = [self.phases[index - 1], self.phases[index + 1]];
                search(motion, bracket, self.parabola(index))
            }
        }
    }

    /// An end is the largest of its samples: there is a larger force inside only if it grows from there.
    fn beside_end(&self, motion: Motion<'_>, end: usize, next: usize) -> f64 {
        let (end, next) = (self.phases[end], self.phases[next]);
        let near = end + INSIDE * (next - end);
        let Slope { size, slope } = motion.at(near);
        if slope * (next - end) > 0.0 {
            let bracket = [near.min(next), near.max(next)];
            let from = Guess {
                tau: 0.5 * (near + next),
                curvature: f64::NAN,
            };
            search(motion, bracket, from)
        } else {
            size
        }
    }

    /// Where the parabola through three samples has its peak, and its second derivative.
    fn parabola(&self, best: usize) -> Guess {
        let at = |index: usize| (self.phases[index], self.force[index]);
        let ((a, fa), (b, fb), (c, fc)) = (at(best - 1), at(best), at(best + 1));
        let (left, right) = ((fb - fa) / (b - a), (fc - fb) / (c - b));
        // Both are slopes at the middle of an interval.
        let curvature = (right - left) / (0.5 * (c - a));
        let vertex = 0.5 * (a + b) - left / curvature;
        let inside = vertex > a && vertex < c;
        let tau = if inside { vertex } else { b };
        Guess { tau, curvature }
    }
}

/// Where a search begins, and a guess of the second derivative there.
#[derive(Debug, Clone, Copy)]
struct Guess {
    tau: f64,
    curvature: f64,
}

/// Largest value where the slope falls through zero between two phases.
fn search(motion: Motion<'_>, [a, b]: [f64; 2], from: Guess) -> f64 {
    let Guess {
        mut tau,
        mut curvature,
    } = from;
    let mut bracket = Guarded::new(a, b);
    let mut before: Option<Place> = None;
    let mut peak = f64::NEG_INFINITY;
    for _ in 0..STEPS {
        let Slope { size, slope } = motion.at(tau);
        peak = largest(peak, size);
        bracket.cut(tau, slope > 0.0);
        if let Some(before) = before {
            curvature = (slope - before.value) / (tau - before.x);
        }
        before = Some(Place {
            x: tau,
            value: slope,
        });
        let step = -slope / curvature;
        // A parabola of this slope and curvature gains so much on the way to its peak.
        let gain = 0.5 * (slope * step).abs();
        if gain <= GAIN * size.abs() || bracket.is_closed() {
            break;
        }
        let falls = curvature < 0.0;
        (tau, _) = bracket.next(tau, if falls { step } else { f64::NAN });
    }
    peak
}
