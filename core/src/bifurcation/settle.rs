//! What motions settle to at one value of what is varied.
//!
//! A motion is looked at once a period. Where it nearly returns after one of the periods looked for, Newton's method leads to the
//! orbit; it has settled once it stays near a stable one that is known. What has not settled after all is judged by its largest Lyapunov
//! exponent.

use std::ops::ControlFlow;

use crate::attractors::basin::{Fate, Finder};
use crate::attractors::lyapunov::Lyapunov;
use crate::branches::recurrence::CyclicSymmetry;
use crate::numeric::estimate::Estimate;
use crate::time::FlowError;
use crate::time::stroboscope::Stroboscope;

/// The first return that is tried, relative to the size of motions, and the nearest.
const RETURNS: [f64; 2] = [3e-2, 1e-10];
/// Each further one is by so much nearer.
const NEARER: f64 = 0.2;
/// An orbit is known to this, relative to its size.
const RETURNED: f64 = 1e-6;
/// How much farther than it returns a motion may be from an orbit that it is taken to approach.
const FARTHER: f64 = 10.0;
/// A motion that has been so near an orbit, relative to its size, for so many periods has settled to it.
const NEAR: f64 = 1e-3;
const STAYS: usize = 8;
/// A state with an entry of so many times its size has escaped.
const ESCAPED: f64 = 1e4;
/// States of one orbit that were found in two ways differ by less.
const SAME: f64 = 1e-5;
/// Batches of periods that tell chaos, and the periods of one.
const BATCHES: usize = 10;
const BATCH: usize = 10;

/// A stable orbit that motions settle to.
#[derive(Debug, Clone)]
pub(super) struct SettledOrbit {
    /// Its states at phase zero, one for each period.
    pub(super) states: Vec<Vec<f64>>,
    /// How many motions have settled to it.
    pub(super) motions: usize,
}

/// How long a motion is followed.
#[derive(Debug, Clone, Copy)]
pub(super) struct Patience {
    /// The longest period that is looked for.
    pub(super) longest: usize,
    pub(super) periods: usize,
    /// Evaluations of forces.
    pub(super) forces: usize,
}

/// Which images of orbits were looked at.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Images {
    orbit: usize,
    symmetry: usize,
}

/// Motions at one value, one after the other.
pub(super) struct Motions {
    map: Stroboscope,
    finder: Finder,
    /// Sizes of the entries of a state.
    units: Vec<f64>,
    patience: Patience,
    /// The states of the last periods, in turn.
    past: Vec<Vec<f64>>,
    pub(super) orbits: Vec<SettledOrbit>,
}

impl Motions {
    pub(super) fn new(map: Stroboscope, units: Vec<f64>, patience: Patience) -> Self {
        Self {
            finder: Finder::new(units.len()).near(RETURNED),
            past: vec![vec![0.0; units.len()]; patience.longest],
            map,
            units,
            patience,
            orbits: Vec::new(),
        }
    }

    /// What becomes of the motion from a state. Of an orbit it is the number among [`orbits`](Self::orbits).
    pub(super) fn follow(&mut self, start: &[f64]) -> Fate {
        let mut state = start.to_vec();
        let begun = self.map.work().forces;
        let mut tolerance = RETURNS[0];
        let mut stays = (usize::MAX, 0);
        for period in 0..self.patience.periods {
            let passed = period.min(self.past.len());
            let near = self.near(&state, NEAR);
            stays = match near {
                Some(orbit) if orbit == stays.0 => (orbit, stays.1 + 1),
                Some(orbit) => (orbit, 1),
                None => (usize::MAX, 0),
            };
            if stays.1 >= STAYS {
                self.orbits[stays.0].motions += 1;
                return Fate::Periodic(stays.0);
            }
            if near.is_none()
                && let Some(returned) = self.returned(&state, period, passed, tolerance)
            {
                // It may be on the way to an orbit that is known.
                if self.near(&state, FARTHER * tolerance).is_none()
                    && let Some(first) = self.finder.stable(&mut self.map, &state, returned)
                {
                    self.take(&first, returned);
                }
                tolerance = (NEARER * tolerance).max(RETURNS[1]);
            }
            let length = self.past.len();
            self.past[period % length].copy_from_slice(&state);
            if let ControlFlow::Break(fate) = self.advance(&mut state) {
                return fate;
            }
            if self.map.work().forces - begun > self.patience.forces {
                return Fate::Long;
            }
        }
        self.judge(&state)
    }

    /// The next image of an orbit that is none of those that are known: with `q(t)` also `S^-1 q(t + T/m)` is a motion, an orbit is as stable as
    /// its image, and few motions may settle to either.
    pub(super) fn image(
        &mut self,
        symmetries: &[CyclicSymmetry],
        images: &mut Images,
    ) -> Option<Vec<f64>> {
        while let Some(orbit) = self.orbits.get(images.orbit) {
            let Some(CyclicSymmetry { parts, image }) = symmetries.get(images.symmetry) else {
                *images = Images {
                    orbit: images.orbit + 1,
                    symmetry: 0,
                };
                continue;
            };
            images.symmetry += 1;
            let mut later = orbit.states.first()?.clone();
            if *parts > 1 && self.map.pass_part(*parts, &mut later).is_err() {
                continue;
            }
            // S^-1 is the power before the identity.
            let inverse = image.power(image.order() - 1);
            let start = inverse.of_states(&later, later.len() / 2);
            if self.near(&start, SAME).is_none() {
                return Some(start);
            }
        }
        None
    }

    /// Over one period.
    fn advance(&mut self, state: &mut [f64]) -> ControlFlow<Fate> {
        match self.map.map(state) {
            Ok(()) => {}
            Err(FlowError::NotFinite { .. }) => return ControlFlow::Break(Fate::Escaped),
            Err(FlowError::Cancelled { .. }) => return ControlFlow::Break(Fate::Unknown),
            Err(_) => return ControlFlow::Break(Fate::Failed),
        }
        let mut entries = state.iter().zip(&self.units);
        if entries.all(|(x, unit)| x.abs() <= ESCAPED * unit) {
            ControlFlow::Continue(())
        } else {
            ControlFlow::Break(Fate::Escaped)
        }
    }

    /// How far two states are apart, relative to their sizes.
    fn apart(&self, a: &[f64], b: &[f64]) -> f64 {
        let entries = a.iter().zip(b).zip(&self.units);
        entries.fold(0.0, |most: f64, ((x, y), unit)| {
            most.max((x - y).abs() / unit)
        })
    }

    /// The orbit that a state is near to.
    fn near(&self, state: &[f64], within: f64) -> Option<usize> {
        let is_near = |orbit: &SettledOrbit| {
            let mut states = orbit.states.iter();
            states.any(|other| self.apart(state, other) <= within)
        };
        self.orbits.iter().position(is_near)
    }

    /// After how many periods a state has nearly returned, of those that have passed.
    fn returned(
        &self,
        state: &[f64],
        period: usize,
        passed: usize,
        tolerance: f64,
    ) -> Option<usize> {
        let length = self.past.len();
        let before = |count: usize| &self.past[(period - count) % length];
        (1..=passed).find(|&count| self.apart(state, before(count)) <= tolerance)
    }

    /// Takes in an orbit, unless it is known.
    fn take(&mut self, first: &[f64], period: usize) {
        if self.near(first, SAME).is_some() {
            return;
        }
        let mut states = vec![first.to_vec()];
        for index in 1..period {
            let mut next = states[index - 1].clone();
            if self.advance(&mut next).is_break() {
                return;
            }
            states.push(next);
        }
        // One of a shorter period, met in another order.
        if states[1..]
            .iter()
            .any(|state| self.apart(state, first) <= SAME)
        {
            return;
        }
        self.orbits.push(SettledOrbit { states, motions: 0 });
    }

    /// Tells chaos from what is long by the largest exponent.
    fn judge(&mut self, state: &[f64]) -> Fate {
        let mut lyapunov = Lyapunov::new(&mut self.map, state);
        for _ in 0..BATCHES {
            match lyapunov.batch(BATCH) {
                Ok(_) => {}
                Err(FlowError::Cancelled { .. }) => return Fate::Unknown,
                Err(_) => return Fate::Failed,
            }
        }
        let means = lyapunov.batches().iter().map(|batch| batch[0]);
        let largest = Estimate::of_batches(means);
        let parts = largest.value * (BATCHES * BATCH) as f64 > 1.0;
        if parts && largest.value > 3.0 * largest.error {
            Fate::Chaotic
        } else {
            Fate::Long
        }
    }
}
