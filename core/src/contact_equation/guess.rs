//! Motions that a first orbit is looked for at: the series of an orbit, or its states along the motion itself, by [steps](super::march) as exact as a search
//! needs, or by integration.
//!
//! Between samples that are `d` apart, with positions `a`, `b` and velocities `v`, `w`, positions are at the part `s` of the way
//!
//! ```text
//! x = a + s (d v + s (3 r - 2 d v - d w + s (d v + d w - 2 r))),    r = b - a                                  (1)
//! ```
//!
//! Between two orbits of a branch, at the part `p` of the way, an orbit is looked for near the motion that lies on their chord, at each phase
//!
//! ```text
//! x + p (x' - x),    v + p (v' w / w' - v)                                                                     (2)
//! ```
//!
//! with the velocities of both in units of how fast their phases move, `w` and `w'`.
//!
//! Source: de Boor (2001), A Practical Guide to Splines, chapter IV (cubic Hermite interpolation).

use std::f64::consts::TAU;

use crate::branches::orbit::Orbit;
use crate::branches::point::Point;
use crate::contact_equation::linear_part::block::Block;
use crate::contact_equation::march::March;
use crate::contact_equation::problem::ContactProblem;
use crate::error::Error;
use crate::time::stroboscope::Stroboscope;
use crate::time::{MotionError, history};

/// Samples in a period of the declaration.
const SAMPLES: usize = 4096;
/// Where no pair of states of the linear part turns by a larger angle in a period, an integration is quicker: its steps are as long as that allows.
const STIFF: f64 = 1000.0;
/// Where it turns by more, exact steps take longer than an integration too.
const STIFFEST: f64 = 4e7;
/// Steps between two looks at whether the search is to end.
const LOOKED: usize = 256;

/// An orbit with its motion.
pub(in crate::contact_equation) struct Guess<'g> {
    pub(in crate::contact_equation) point: &'g Point,
    /// States at equal distances, each with all positions and then all velocities; none where the series of the orbit tells them.
    samples: Vec<f64>,
    /// Another one with as many coordinates, and the part of the way to it.
    toward: Option<(Box<Self>, f64)>,
}

impl<'g> Guess<'g> {
    /// By the series of an orbit.
    pub(in crate::contact_equation) fn by_series(point: &'g Point) -> Self {
        Self {
            point,
            samples: Vec::new(),
            toward: None,
        }
    }

    /// On the chord to another one, at a part of the way.
    pub(in crate::contact_equation) fn toward(self, other: Self, part: f64) -> Self {
        Self {
            toward: Some((Box::new(other), part)),
            ..self
        }
    }

    /// By the series of an orbit, or by its motion where that is all that is known.
    ///
    /// # Errors
    /// If the motion cannot be computed.
    pub(in crate::contact_equation) fn of(
        problem: &ContactProblem,
        point: &'g Point,
    ) -> Result<Self, Error> {
        if point.orbit.has_series() {
            return Ok(Self::by_series(point));
        }
        match Self::by_steps(problem, point) {
            Some(guess) => Ok(guess),
            None => Self::by_motion(problem, point),
        }
    }

    /// By equal steps from the states of an orbit. `None` where these are no way to go, or an integration takes less time.
    pub(in crate::contact_equation) fn by_steps(
        problem: &ContactProblem,
        point: &'g Point,
    ) -> Option<Self> {
        let values = problem.setting.values(point.value)?;
        let rates = values.linear.blocks.iter().map(Block::rate);
        let angle = rates.fold(0.0, f64::max) * TAU / values.base;
        if !(STIFF..=STIFFEST).contains(&angle) {
            return None;
        }
        let mut march = March::new(&problem.setting, &values, TAU / SAMPLES as f64)?;
        let state = point.orbit.state();
        let (order, periods) = (state.len(), point.orbit.period);
        let known = known_beginnings(point);
        let mut samples = vec![0.0; order * (SAMPLES * periods + 1)];
        samples[..order].copy_from_slice(&state);
        march.begin(0.0, &state);
        for (index, sample) in samples.chunks_exact_mut(order).enumerate().skip(1) {
            let cancelled = index % LOOKED == 0 && problem.asked.cancel.is_cancelled();
            if cancelled || !march.step() {
                return None;
            }
            march.write(sample);
            let begins = index % SAMPLES == 0;
            if let Some(state) = known.get(index / SAMPLES).filter(|_| begins) {
                sample.copy_from_slice(state);
                march.begin(march.phase(), state);
            }
        }
        Some(Self {
            point,
            samples,
            toward: None,
        })
    }

    /// By the motion from the states of an orbit, which has few harmonics where contacts are stiff.
    ///
    /// # Errors
    /// If the motion cannot be computed.
    pub(in crate::contact_equation) fn by_motion(
        problem: &ContactProblem,
        point: &'g Point,
    ) -> Result<Self, Error> {
        let asked = &problem.asked;
        let failed = |reason| MotionError {
            value: point.value,
            reason,
        };
        let mut flow = asked.flow(asked.source.tolerance)?;
        flow.set(asked.variable, point.value).map_err(failed)?;
        let mut samples = Vec::new();
        let mut state = point.orbit.state();
        let periods = point.orbit.period;
        let mut map = Stroboscope::new(flow);
        let known = known_beginnings(point);
        let order = state.len();
        for period in 0..periods {
            if let Some(known) = known.get(period) {
                state.copy_from_slice(known);
            }
            // The last state of a period is the first one of the next.
            samples.truncate(period * SAMPLES * order);
            let mut keep = |_: f64, state: &[f64]| samples.extend_from_slice(state);
            history::record(&mut map, &mut state, 1, SAMPLES, &mut keep).map_err(failed)?;
        }
        Ok(Self {
            point,
            samples,
            toward: None,
        })
    }

    /// How fast its phase moves.
    pub(in crate::contact_equation) fn rate(&self) -> f64 {
        self.point.orbit.base * self.point.orbit.period as f64
    }

    /// Writes positions and velocities at a phase.
    pub(in crate::contact_equation) fn write(&self, phase: f64, state: &mut [f64]) {
        self.write_own(phase, state);
        let Some((other, part)) = &self.toward else {
            return;
        };
        let mut there = vec![0.0; state.len()];
        other.write(phase, &mut there);
        let pace = self.rate() / other.rate();
        let (positions, velocities) = there.split_at_mut(state.len() / 2);
        for v in &mut *velocities {
            *v *= pace;
        }
        // (2)
        for (x, there) in state.iter_mut().zip(positions.iter().chain(&*velocities)) {
            *x += part * (there - *x);
        }
    }

    fn write_own(&self, phase: f64, state: &mut [f64]) {
        let orbit = &self.point.orbit;
        if self.samples.is_empty() {
            return write_series(orbit, phase / self.rate(), state);
        }
        let order = state.len();
        let n = order / 2;
        let last = self.samples.len() / order - 1;
        let place = (phase / TAU * SAMPLES as f64).rem_euclid(last as f64);
        let index = (place as usize).min(last - 1);
        let [s, step] = [place - index as f64, TAU / SAMPLES as f64 / self.rate()];
        let [a, b] = [index, index + 1].map(|index| &self.samples[index * order..][..order]);
        for i in 0..n {
            let rise = b[i] - a[i];
            let ends = [step * a[n + i], step * b[n + i]];
            // (1)
            let square = 3.0 * rise - 2.0 * ends[0] - ends[1];
            let cube = ends[0] + ends[1] - 2.0 * rise;
            state[i] = a[i] + s * (ends[0] + s * (square + s * cube));
            state[n + i] = (ends[0] + s * (2.0 * square + 3.0 * s * cube)) / step;
        }
    }
}

/// States at the beginnings of periods, where all are known: motions part from an unstable orbit, so that each period begins with that.
fn known_beginnings(point: &Point) -> Vec<&[f64]> {
    let known: Vec<&[f64]> = point.orbit.states().collect();
    if point.orbit.parts == 1 && known.len() == point.orbit.period {
        known
    } else {
        Vec::new()
    }
}

fn write_series(orbit: &Orbit, time: f64, state: &mut [f64]) {
    let coordinates = orbit.coordinates();
    for i in 0..coordinates {
        if let Some((x, v)) = orbit.state_at(i, time) {
            (state[i], state[coordinates + i]) = (x, v);
        }
    }
}
