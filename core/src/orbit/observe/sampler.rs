//! One series at a time, sampled and searched.
//!
//! The largest value of a series is among those maxima that no sample exceeds. They are the near misses of a level that
//! the series cannot pass, the mean plus the sum of all amplitudes, down to the largest sample. So few intervals are
//! searched, however many extrema there are, and none is overlooked. The smallest value is found in the same way.

use crate::numeric::fourier::crossings::{CrossingFinder, NearMiss};
use crate::numeric::fourier::sampled::SampledTransform;
use crate::numeric::fourier::series;

/// Samples per shortest wave.
const PER_WAVE: usize = 4;
/// Samples of a period, at least.
const FEWEST: usize = 32;

/// The series loaded last, its samples and the search of it.
#[derive(Debug, Default)]
pub(super) struct Sampler {
    workspace: Option<Workspace>,
    series: Vec<f64>,
    samples: Vec<f64>,
    misses: Vec<NearMiss>,
    phases: [f64; 2],
}

#[derive(Debug)]
struct Workspace {
    harmonics: usize,
    finder: CrossingFinder,
    transform: SampledTransform,
}

impl Workspace {
    fn new(harmonics: usize) -> Self {
        Self {
            harmonics,
            finder: CrossingFinder::new(harmonics),
            transform: SampledTransform::new(quick_size(PER_WAVE * harmonics)),
        }
    }
}

/// Two or three times a power of two: for these the transform is quick.
fn quick_size(least: usize) -> usize {
    let power = least.max(FEWEST).next_power_of_two();
    let between = power / 4 * 3;
    if between >= least { between } else { power }
}

impl Sampler {
    /// Takes a series.
    pub(super) fn load(&mut self, series: &[f64]) {
        if self.series == series {
            return;
        }
        self.series.clear();
        self.series.extend_from_slice(series);
        let harmonics = series::harmonics(series);
        if self
            .workspace
            .as_ref()
            .is_some_and(|r| r.harmonics < harmonics)
        {
            self.workspace = None;
        }
        let workspace = self
            .workspace
            .get_or_insert_with(|| Workspace::new(harmonics));
        workspace.finder.sample(series);
        self.samples.resize(workspace.transform.samples(), 0.0);
        workspace.transform.sample(series, &mut self.samples);
    }

    pub(super) fn series(&self) -> &[f64] {
        &self.series
    }

    /// The series at equally spaced phases, from zero on.
    pub(super) fn samples(&self) -> &[f64] {
        &self.samples
    }

    /// The search, once a series has been loaded.
    pub(super) fn finder(&self) -> Option<&CrossingFinder> {
        self.workspace.as_ref().map(|workspace| &workspace.finder)
    }

    /// Writes the samples of another series with as many harmonics at the same phases.
    pub(super) fn sample(&mut self, other: &[f64], samples: &mut Vec<f64>) {
        samples.resize(self.samples.len(), 0.0);
        if let Some(workspace) = &mut self.workspace {
            workspace.transform.sample(other, samples);
        }
    }

    /// The phases of the smallest and the largest value that were found last.
    pub(super) fn phases(&self) -> [f64; 2] {
        self.phases
    }

    /// Smallest and largest value of a series; its mean if it does not vary.
    pub(super) fn extremes(&mut self, series: &[f64]) -> (f64, f64) {
        let mean = series[0];
        self.phases = [0.0; 2];
        if series[1..].iter().all(|&x| x == 0.0) {
            return (mean, mean);
        }
        // The mean does not matter here, so a gap may stand for its coordinate.
        if self.series.get(1..) != Some(&series[1..]) {
            self.load(series);
        }
        let bound: f64 = series[1..].iter().map(|x| x.abs()).sum();
        let ((low, first), (high, second)) = (self.farthest(-bound), self.farthest(bound));
        self.phases = [first, second];
        if low <= high {
            (mean + low, mean + high)
        } else {
            (mean, mean)
        }
    }

    /// The value nearest to a bound of all values, both without the mean, and its phase.
    fn farthest(&mut self, bound: f64) -> (f64, f64) {
        let mean = self.series[0];
        let sign = bound.signum();
        let samples = self.samples.iter().map(|&x| sign * (x - mean));
        let mut farthest = samples.fold(f64::NEG_INFINITY, largest);
        // As the finder computes it, rounded in the same way.
        let level = mean + bound;
        let target = sign * (level - mean);
        let Some(workspace) = &self.workspace else {
            return (sign * farthest, 0.0);
        };
        self.misses.clear();
        workspace
            .finder
            .near_misses(level, target - farthest, &mut self.misses);
        let mut phase = 0.0;
        for miss in &self.misses {
            let value = target - miss.distance;
            if value >= farthest {
                (farthest, phase) = (value, miss.tau);
            }
        }
        (sign * farthest, phase)
    }
}

// Unlike `f64::max` this is one instruction; a NaN is passed over.
pub(super) fn largest(a: f64, b: f64) -> f64 {
    if b > a { b } else { a }
}
