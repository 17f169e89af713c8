//! Orbits that stay on one piece: equally spaced samples.
//!
//! The trapezoidal rule errs by what lies beyond the Nyquist frequency, and for an analytic integrand that falls
//! exponentially (Trefethen and Weideman (2014), The exponentially convergent trapezoidal rule). The samples are doubled until
//! the upper end of the spectrum has fallen to rounding, or to the largest number.

use super::{Sums, Wanted, overlooks};
use crate::balance::aft::samples::Samples;
use crate::balance::aft::{ContactInput, PER_SAMPLE};
use crate::law::{On, Variation};
use crate::laws::generic::scales::Scales;
use crate::numeric::fourier::sampled::SampledTransform;
use crate::numeric::fourier::series;

/// The upper end of the spectrum, relative to the largest coefficient, at which samples suffice: aliases of the harmonics
/// asked for lie as far above Nyquist as those lie below, and are smaller still. It is the upper eighth, or twice the spacing of the gap's
/// harmonics where that is more: an orbit of a shorter period than the balance's has a spectrum with holes.
const RESOLVED: f64 = 1e-10;
/// Samples of a period, at most.
const MOST: usize = 1 << 15;

/// Transforms of increasing length, made when they are first needed.
#[derive(Debug, Default)]
pub(super) struct Whole {
    grids: Vec<Grid>,
    /// Multiplications so far, about.
    pub(super) operations: u64,
}

#[derive(Debug)]
struct Grid {
    samples: Samples,
    series: Vec<f64>,
    /// Harmonics at the upper end of the spectrum that must be empty.
    window: usize,
}

impl Whole {
    /// Adds a period on one piece.
    pub(super) fn add(
        &mut self,
        input: ContactInput<'_>,
        piece: usize,
        sums: &mut Sums<'_>,
        scales: &mut Option<Scales>,
    ) {
        let slopes = sums.slopes.as_ref().map_or(0, |s| s.by_gap.len() / 2);
        let top = (sums.force.len() / 2).max(slopes);
        let least = (top + series::harmonics(input.gap) + 8).next_power_of_two();
        let spacing = spacing(input.gap);
        let mut samples = least;
        loop {
            let index = self.grid(samples);
            let grid = &mut self.grids[index];
            grid.window = (samples / 16 + 1).max(2 * spacing);
            self.operations += PER_SAMPLE * samples as u64;
            let resolved = grid.evaluate(input, piece, Wanted::of(sums), scales);
            if resolved || samples >= MOST.max(least) {
                grid.add(sums);
                return;
            }
            samples *= 2;
        }
    }

    fn grid(&mut self, samples: usize) -> usize {
        let known = self
            .grids
            .iter()
            .position(|grid| grid.samples.transform.samples() == samples);
        known.unwrap_or_else(|| {
            self.grids.push(Grid::new(samples));
            self.grids.len() - 1
        })
    }
}

impl Grid {
    fn new(samples: usize) -> Self {
        Self {
            samples: Samples::new(samples),
            series: vec![0.0; series::length((samples - 1) / 2)],
            window: samples / 16 + 1,
        }
    }

    /// The law at all samples. Returns whether the samples suffice.
    fn evaluate(
        &mut self,
        input: ContactInput<'_>,
        piece: usize,
        wanted: Wanted<'_>,
        scales: &mut Option<Scales>,
    ) -> bool {
        let Self {
            samples: s, window, ..
        } = self;
        s.take(input);
        let seen = !overlooks(scales, piece, [&s.gap, &s.rate]);
        let on = On::Piece(piece);
        let change = match wanted {
            Wanted::Force => {
                s.evaluate(input, on);
                return seen && s.transform.is_resolved(&s.force, RESOLVED, *window);
            }
            Wanted::Slopes => None,
            Wanted::Changes(changing) => Some(changing.change),
        };
        s.evaluate_slopes(input, on, change);
        let facts = &input.law.facts().pieces[piece];
        let varying = |variation| variation == Variation::Varying;
        let sampled = [
            (true, &s.force),
            (varying(facts.by_gap), &s.by_gap),
            (varying(facts.by_rate), &s.by_rate),
            (change.is_some(), &s.by_parameter),
        ];
        let mut sampled = sampled.into_iter().filter(|(matters, _)| *matters);
        seen && sampled.all(|(_, samples)| s.transform.is_resolved(samples, RESOLVED, *window))
    }

    /// Adds the harmonics of what was evaluated.
    fn add(&mut self, sums: &mut Sums<'_>) {
        let (s, workspace) = (&mut self.samples, &mut self.series);
        add(&mut s.transform, &s.force, workspace, sums.force);
        if let Some(slopes) = &mut sums.slopes {
            add(&mut s.transform, &s.by_gap, workspace, slopes.by_gap);
            add(&mut s.transform, &s.by_rate, workspace, slopes.by_rate);
            if slopes.change.is_some() {
                let to = &mut *slopes.by_parameter;
                add(&mut s.transform, &s.by_parameter, workspace, to);
            }
        }
    }
}

fn add(transform: &mut SampledTransform, samples: &[f64], workspace: &mut [f64], sum: &mut [f64]) {
    transform.analyse(samples, workspace);
    for (to, from) in sum.iter_mut().zip(workspace) {
        *to += *from;
    }
}

/// The greatest common divisor of the harmonics that a series has, but for rounding; one if it has none.
fn spacing(series: &[f64]) -> usize {
    let size = |pair: &[f64]| pair[0].abs().max(pair[1].abs());
    let pairs = || series[1..].chunks_exact(2);
    let nothing = RESOLVED * pairs().map(size).fold(0.0, f64::max);
    let present = pairs().enumerate().filter(|(_, pair)| size(pair) > nothing);
    let common = present.fold(0, |common, (index, _)| divisor(common, index + 1));
    common.max(1)
}

/// The greatest common divisor (Euclid).
fn divisor(a: usize, b: usize) -> usize {
    if b == 0 { a } else { divisor(b, a % b) }
}
