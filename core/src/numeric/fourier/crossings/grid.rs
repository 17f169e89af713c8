//! A series and its derivative at equally spaced phases, and an enclosure of its range between each two.
//!
//! Both come from a fast Fourier transform. Products with tables of cosines, folded by symmetry to a quarter of the
//! phases, were measured as well: they took a little less time at 5 harmonics and more from 10 on, three times as much
//! at 100.

use std::f64::consts::TAU;

use super::pieces::{Cubic, Point};
use super::waves::Waves;
use crate::numeric::fourier::sampled::SampledTransform;
use crate::numeric::fourier::series;

/// Intervals per shortest wave: the cubic through a lone highest harmonic is then off by 1/60 of it at most.
const PER_WAVE: usize = 4;
/// Intervals of a period, at least.
const FEWEST: usize = 16;

#[derive(Debug)]
pub(super) struct Grid {
    harmonics: usize,
    step: f64,
    transform: SampledTransform,
    /// The series that is transformed.
    series: Vec<f64>,
    /// Values, and a third of a step times the slopes; the first again at the end.
    x: Vec<f64>,
    lift: Vec<f64>,
    low: Vec<f64>,
    high: Vec<f64>,
}

impl Grid {
    pub fn new(harmonics: usize) -> Self {
        let intervals = quick_size((PER_WAVE * harmonics).max(FEWEST));
        Self {
            harmonics,
            step: TAU / intervals as f64,
            transform: SampledTransform::new(intervals),
            series: Vec::with_capacity(series::length(harmonics)),
            x: vec![0.0; intervals + 1],
            lift: vec![0.0; intervals + 1],
            low: vec![0.0; intervals],
            high: vec![0.0; intervals],
        }
    }

    pub fn harmonics(&self) -> usize {
        self.harmonics
    }

    pub fn intervals(&self) -> usize {
        self.low.len()
    }

    pub fn values(&self) -> &[f64] {
        &self.x[..self.intervals()]
    }

    /// Lower and upper bounds of the waves on the intervals.
    pub fn ranges(&self) -> (&[f64], &[f64]) {
        (&self.low, &self.high)
    }

    /// Both ends of the interval after phase `index`, which goes on beyond one period from `intervals()` onwards.
    pub fn interval(&self, index: usize) -> (Point, Point) {
        let at = index % self.intervals();
        let point = |more: usize| Point {
            tau: (index + more) as f64 * self.step,
            x: self.x[at + more],
            slope: self.lift[at + more] * (3.0 / self.step),
        };
        (point(0), point(1))
    }

    pub fn sample(&mut self, waves: &Waves) {
        let intervals = self.intervals();
        self.series.clear();
        self.series.push(0.0);
        self.series.extend(waves.pairs().iter().flatten());
        self.transform
            .sample(&self.series, &mut self.x[..intervals]);
        let mut factor = 0.0;
        for pair in self.series[1..].chunks_exact_mut(2) {
            factor += self.step / 3.0;
            (pair[0], pair[1]) = (factor * pair[1], -factor * pair[0]);
        }
        self.transform
            .sample(&self.series, &mut self.lift[..intervals]);
        (self.x[intervals], self.lift[intervals]) = (self.x[0], self.lift[0]);
        self.enclose(waves);
    }

    fn enclose(&mut self, waves: &Waves) {
        let margin = Cubic::error(self.step, waves.bounds());
        let ends = self.x.windows(2).zip(self.lift.windows(2));
        for ((x, lift), (low, high)) in ends.zip(self.low.iter_mut().zip(&mut self.high)) {
            let cubic = Cubic([x[0], x[0] + lift[0], x[1] - lift[1], x[1]]);
            let (least, largest) = cubic.range();
            (*low, *high) = (least - margin, largest + margin);
        }
    }
}

/// The next even number without prime factors but 2 and 3: for these the transform is quickest.
fn quick_size(least: usize) -> usize {
    let only_2_and_3 = |mut n: usize| {
        while n.is_multiple_of(2) {
            n /= 2;
        }
        while n.is_multiple_of(3) {
            n /= 3;
        }
        n == 1
    };
    (least.next_multiple_of(2)..)
        .step_by(2)
        .find(|&n| only_2_and_3(n))
        .unwrap_or(least)
}
