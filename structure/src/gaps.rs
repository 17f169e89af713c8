//! Gaps of contacts along an orbit, and what the laws of contacts are to motions beside it.
//!
//! To motions beside an orbit a contact is a spring and a damper that change with time. At equal times their stiffness `k` and damping `r` are
//! the slopes of the law. Over a time in which the gap crosses a level they are those means for which
//!
//! ```text
//! change of the force = k * (change of the gap) + r * (change of its rate)                                    (1)
//! ```
//!
//! so that a spring which acts for a part of the time counts for that part, and a force that jumps by `J` where the gap has the rate `v` as
//! a stiffness with the integral `J / |v|`.
//!
//! Source of that integral: Aizerman and Gantmakher (1958), Quart. J. Mech. Appl. Math. 11, 225.

use std::f64::consts::TAU;

use hertzian::Orbit;
use hertzian::law::{Derivatives, Law, On};

use crate::arms::Arm;
use crate::reduced::Reduced;

/// Times of the period.
pub(crate) const TIMES: usize = 128;
/// Parts of each of the times between, by which (1) is taken.
const FINE: usize = 8;
const POINTS: usize = TIMES * FINE;
/// Where a gap turns it changes by less than this part of what its rate makes of the time, and slopes are taken instead of (1).
const TURNING: f64 = 0.1;
/// Means by (1) that differ from slopes by less than this part are slopes.
const ROUNDING: f64 = 1e-6;

/// Slopes of the law of a contact at all times, or means around them.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Slopes {
    pub(crate) by_gap: Vec<f64>,
    pub(crate) by_rate: Vec<f64>,
}

/// The gap of a contact along an orbit.
#[derive(Debug)]
pub(crate) struct Gap<'s> {
    law: &'s dyn Law,
    arguments: Vec<f64>,
    /// Gap and rate at all points.
    motion: [Vec<f64>; 2],
    /// How long it takes from one point to the next.
    step: f64,
}

/// Adds a multiple of a series to one that may be shorter.
pub(crate) fn add(sum: &mut Vec<f64>, factor: f64, series: &[f64]) {
    sum.resize(sum.len().max(series.len()), 0.0);
    for (sum, x) in sum.iter_mut().zip(series) {
        *sum += factor * x;
    }
}

/// A law at points.
struct Evaluated {
    force: Vec<f64>,
    slopes: Slopes,
}

fn evaluated(law: &dyn Law, arguments: &[f64], [gaps, rates]: [&[f64]; 2]) -> Evaluated {
    let none = vec![0.0; gaps.len()];
    let mut found = Evaluated {
        force: none.clone(),
        slopes: Slopes {
            by_gap: none.clone(),
            by_rate: none,
        },
    };
    let out = Derivatives {
        force: &mut found.force,
        by_gap: &mut found.slopes.by_gap,
        by_rate: &mut found.slopes.by_rate,
    };
    law.derivatives(On::AllPieces, arguments, gaps, rates, out);
    found
}

impl<'s> Gap<'s> {
    /// Of a law with its arguments, along the arms of a contact by the vectors that coordinates of an orbit with a series are of, less an offset.
    pub(crate) fn of(
        law: &'s dyn Law,
        arguments: Vec<f64>,
        reduced: &Reduced,
        arms: &[Arm],
        offset: f64,
        orbit: &Orbit,
    ) -> Self {
        let mut series: Vec<f64> = Vec::new();
        for arm in arms {
            let mut along: Vec<f64> = Vec::new();
            for (coordinate, factor) in reduced.rows[arm.read].iter().enumerate() {
                add(
                    &mut along,
                    *factor,
                    orbit.series(coordinate).unwrap_or_default(),
                );
            }
            add(&mut series, 1.0, &arm.times(&along));
        }
        let mean = series.first().map_or(-offset, |mean| mean - offset);
        let mut motion = [vec![mean; POINTS], vec![0.0; POINTS]];
        let circle = (0..POINTS).map(|i| (TAU * i as f64 / POINTS as f64).sin_cos());
        let circle: Vec<(f64, f64)> = circle.collect();
        let harmonics = series.get(1..).unwrap_or_default().chunks_exact(2);
        for (pair, k) in harmonics.zip(1..) {
            let frequency = k as f64 * orbit.base;
            for i in 0..POINTS {
                let (sine, cosine) = circle[(k * i) % POINTS];
                motion[0][i] += pair[0] * cosine + pair[1] * sine;
                motion[1][i] += frequency * (pair[1] * cosine - pair[0] * sine);
            }
        }
        Self {
            law,
            arguments,
            motion,
            step: TAU / orbit.base / POINTS as f64,
        }
    }

    /// From the least to the largest gap, and rate.
    pub(crate) fn spans(&self) -> [f64; 2] {
        [0, 1].map(|i| {
            let ends = |[least, most]: [f64; 2], x: &f64| [x.min(least), x.max(most)];
            let none = [f64::INFINITY, f64::NEG_INFINITY];
            let [least, most] = self.motion[i].iter().fold(none, ends);
            most - least
        })
    }

    /// Slopes at all times.
    pub(crate) fn slopes(&self) -> Slopes {
        let at = |i: usize| -> Vec<f64> { self.motion[i].iter().step_by(FINE).copied().collect() };
        evaluated(self.law, &self.arguments, [&at(0), &at(1)]).slopes
    }

    /// Means (1) around all times, where gap and rate are moved by so much.
    pub(crate) fn means(&self, moved: [f64; 2]) -> Slopes {
        let by = |i: usize| -> Vec<f64> { self.motion[i].iter().map(|x| x + moved[i]).collect() };
        let (gaps, rates) = (by(0), by(1));
        let Evaluated { force, slopes } = evaluated(self.law, &self.arguments, [&gaps, &rates]);
        let between = |a: usize| {
            let b = (a + 1) % POINTS;
            let middle = |of: &[f64]| 0.5 * (of[a] + of[b]);
            let (stiffness, damping) = (middle(&slopes.by_gap), middle(&slopes.by_rate));
            let [gap, rate, force] = [&gaps, &rates, &force].map(|of| of[b] - of[a]);
            let reach = self.step * rates[a].abs().max(rates[b].abs());
            if gap.abs() <= TURNING * reach {
                return [stiffness, damping];
            }
            let mean = (force - damping * rate) / gap;
            let ends = [a, b].map(|i| (mean - slopes.by_gap[i]).abs());
            let is_slope = ends.iter().all(|by| *by <= ROUNDING * mean.abs());
            [if is_slope { stiffness } else { mean }, damping]
        };
        let around = |time: usize| {
            let first = FINE * time + POINTS - FINE / 2;
            let parts = (first..first + FINE).map(|a| between(a % POINTS));
            let sum = parts.fold([0.0; 2], |[k, r], part| [k + part[0], r + part[1]]);
            sum.map(|x| x / FINE as f64)
        };
        let all: Vec<[f64; 2]> = (0..TIMES).map(around).collect();
        Slopes {
            by_gap: all.iter().map(|[k, _]| *k).collect(),
            by_rate: all.iter().map(|[_, r]| *r).collect(),
        }
    }
}
