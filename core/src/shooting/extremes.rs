//! Smallest and largest value of every coordinate along a motion.
//!
//! A smooth stretch is halved until the cubic through positions and velocities at the ends of a part (Hermite's) foretells its
//! middle; then the velocity vanishes at most once in a half.

use crate::branches::observed::Motion;
use crate::branches::recurrence::SignedPermutation;
use crate::numeric::roots::{self, Place};
use crate::time::Stretch;

/// Relative accuracy of the foretold middle.
const FORETOLD: f64 = 1e-3;
/// A stretch is divided into at most two to this power.
const DEEPEST: usize = 12;
/// Part of its bracket to which a zero of the velocity is located: the position is then exact to its square.
const LOCATED: f64 = 1e-8;

/// State at a phase.
#[derive(Debug, Clone)]
struct Sample {
    phase: f64,
    state: Vec<f64>,
}

fn sample(stretch: &dyn Stretch, phase: f64, order: usize) -> Sample {
    let mut state = vec![0.0; order];
    stretch.state(phase, &mut state);
    Sample { phase, state }
}

/// Includes a stretch of a motion whose phase moves by `rate` per unit of time.
pub(crate) fn include(stretch: &dyn Stretch, rate: f64, extremes: &mut [Motion]) {
    let order = 2 * extremes.len();
    let (from, to) = stretch.phases();
    let ends = [from, to].map(|phase| sample(stretch, phase, order));
    part(stretch, rate, &ends, DEEPEST, extremes);
}

/// Of all of an orbit, from those of a part of it after which it comes back with this image of its coordinates.
pub(crate) fn over_images(extremes: &mut [Motion], image: &SignedPermutation) {
    // Where p_i is i the sign alone tells; else as many times as there are powers.
    for _ in 1..image.order() {
        let known = extremes.to_vec();
        for (i, own) in extremes.iter_mut().enumerate() {
            let (place, sign) = image.entry(i);
            let other = known[place];
            let ends = [sign * other.minimum, sign * other.maximum];
            own.minimum = own.minimum.min(ends[0]).min(ends[1]);
            own.maximum = own.maximum.max(ends[0]).max(ends[1]);
        }
    }
}

fn part(
    stretch: &dyn Stretch,
    rate: f64,
    [a, b]: &[Sample; 2],
    depth: usize,
    extremes: &mut [Motion],
) {
    let n = extremes.len();
    let middle = sample(stretch, 0.5 * (a.phase + b.phase), 2 * n);
    let time = (b.phase - a.phase) / rate;
    let foretold = (0..n).all(|i| {
        let cubic =
            0.5 * (a.state[i] + b.state[i]) + time / 8.0 * (a.state[n + i] - b.state[n + i]);
        let travelled = [a, b, &middle].map(|s| time * s.state[n + i].abs());
        let size = travelled.into_iter().fold(0.0, f64::max);
        (cubic - middle.state[i]).abs() <= FORETOLD * size
    });
    if !foretold && depth > 0 {
        let (left, right) = ([a.clone(), middle.clone()], [middle, b.clone()]);
        part(stretch, rate, &left, depth - 1, extremes);
        part(stretch, rate, &right, depth - 1, extremes);
        return;
    }
    for (i, extremes) in extremes.iter_mut().enumerate() {
        for (from, to) in [(a, &middle), (&middle, b)] {
            extremes.include(from.state[i]);
            extremes.include(to.state[i]);
            if from.state[n + i] * to.state[n + i] < 0.0 {
                extremes.include(turning(stretch, [from, to], i));
            }
        }
    }
}

/// The position where the velocity of a coordinate vanishes.
fn turning(stretch: &dyn Stretch, [a, b]: [&Sample; 2], coordinate: usize) -> f64 {
    let velocity = a.state.len() / 2 + coordinate;
    let [from, to] = [a, b].map(|sample| Place {
        x: sample.phase,
        value: sample.state[velocity],
    });
    let mut state = a.state.clone();
    roots::root(from, to, LOCATED * (to.x - from.x), |phase| {
        stretch.state(phase, &mut state);
        state[velocity]
    });
    state[coordinate]
}

#[cfg(test)]
mod tests {
    use super::*;

    /// `x = cos(5 phase) + 2`, `y = phase (2 - phase)`, at `rate` one.
    struct Known;

    impl Stretch for Known {
        fn phases(&self) -> (f64, f64) {
            (0.1, 3.0)
        }

        fn state(&self, phase: f64, state: &mut [f64]) {
            state[0] = (5.0 * phase).cos() + 2.0;
            state[1] = phase * (2.0 - phase);
            state[2] = -5.0 * (5.0 * phase).sin();
            state[3] = 2.0 - 2.0 * phase;
        }
    }

    #[test]
    fn extremes_of_a_known_motion() {
        let mut extremes = [Motion::NONE; 2];
        include(&Known, 1.0, &mut extremes);
        let expected = [1.0, 3.0, -3.0, 1.0];
        let found = extremes.map(|e| [e.minimum, e.maximum]);
        for (found, expected) in found.as_flattened().iter().zip(expected) {
            assert!((found - expected).abs() < 1e-14, "{found} {expected}");
        }
    }
}
