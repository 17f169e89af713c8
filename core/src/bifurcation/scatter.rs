//! Orbits that no motion was seen to settle to.
//!
//! Few motions settle to an orbit whose basin is small, and none to one that is stable over a narrow part of the range only, between the values at
//! which motions were followed. But branches go on where their orbits are unstable, mostly over much more of the range, and Newton's method leads
//! to those orbits as well: from states as those of `starts.rs`, some of them moved along, with values that fill the surroundings of those that
//! were asked for. What is found and lies on no known branch begins another one.
//!
//! Of `N` states that led to an orbit, `n` of them to one of a branch that no other state led to, the next state leads to a new branch with a probability of
//! about
//!
//! ```text
//! p = n / N                                                                                                     (1)
//! ```
//!
//! (Good 1953, Biometrika 40, 237). Rounds follow each other until that is small.

use std::ops::ControlFlow;

use super::cover::Settling;
use super::diagram::{Origin, Reason, Search};
use super::matching::beside;
use super::nearest::{Nearest, NearestOrbit};
use super::starts::{Start, Starts};
use crate::branches::progress::{Progress, Stage};
use crate::response::OrbitMethod;
use crate::time::stroboscope::Stroboscope;

/// Rounds, at least and at most.
const ROUNDS: [usize; 2] = [2, 8];
/// There are no more where one state of so many leads to something new.
const RARE: usize = 200;
/// Values that were asked for one by one have surroundings of this part of the range, or less where there are many.
const SURROUNDINGS: f64 = 0.05;
/// Periods for which states are moved along, in turn.
const MOVED: [usize; 3] = [0, 8, 30];
/// What derivatives by one entry of a state take, where one is what the state itself takes.
const DERIVATIVE: f64 = 0.3;
/// Orbits around a value whose branch could not be followed before no more are looked for there.
const REFUSED: usize = 2;

/// Part of the range around a value.
#[derive(Debug, Clone, Copy)]
struct Place {
    value: f64,
    width: f64,
    /// Orbits whose branch could not be followed.
    refused: usize,
}

/// How many states led to each branch.
#[derive(Debug, Default)]
struct Met(Vec<usize>);

impl Met {
    /// By one state more, of each branch among these.
    fn add(&mut self, mut branches: Vec<usize>) {
        branches.sort_unstable();
        branches.dedup();
        for branch in branches {
            let count = self.0.len().max(branch + 1);
            self.0.resize(count, 0);
            self.0[branch] += 1;
        }
    }

    /// Whether nothing new is likely, by (1).
    fn is_all(&self) -> bool {
        let once = self.0.iter().filter(|states| **states == 1).count();
        once * RARE <= self.0.iter().sum()
    }
}

impl<M: OrbitMethod> Search<'_, M> {
    /// Looks for orbits around the values that were asked for.
    pub(super) fn scatter(&mut self, settling: &Settling, at: &[f64]) {
        let mut places = self.places(settling, at);
        let mut met = Met::default();
        let [least, most] = ROUNDS;
        for round in 1..=most {
            for place in &mut places {
                if let ControlFlow::Break(reason) = self.scatter_at(place, settling, &mut met) {
                    self.diagram.missed.push((place.value, reason));
                    return;
                }
            }
            if round >= least && met.is_all() {
                return;
            }
        }
    }

    fn places(&self, settling: &Settling, at: &[f64]) -> Vec<Place> {
        let [from, to] = self.asked;
        let length = (to - from).abs();
        let place = |value, part: f64| Place {
            value,
            width: part * length,
            refused: 0,
        };
        let part = (settling.values as f64).recip();
        let cells = (0..settling.values).map(|index| {
            let middle = (index as f64 + 0.5) * part;
            place((1.0 - middle) * from + middle * to, part)
        });
        let around = SURROUNDINGS.min((at.len() as f64).recip());
        let asked = at.iter().map(|&value| place(value, around));
        cells.chain(asked).collect()
    }

    /// Looks for orbits around a value, for no longer than motions may take there. Breaks where no more branches may be followed.
    fn scatter_at(
        &mut self,
        place: &mut Place,
        settling: &Settling,
        met: &mut Met,
    ) -> ControlFlow<Reason> {
        if self.observer.interrupted || self.response.request.cancel.is_cancelled() {
            self.observer.interrupted = true;
            return ControlFlow::Break(Reason::Interrupted);
        }
        let Ok(variable) = self.response.request.variable() else {
            return ControlFlow::Continue(());
        };
        // What cannot be computed there was said when motions were followed.
        let Ok((starts, mut map)) = self.starts(place.value, settling.wide) else {
            return ControlFlow::Continue(());
        };
        if self.drifts(place.value) || place.width == 0.0 {
            return ControlFlow::Continue(());
        }
        let allowed = self.allowed(&mut map, place.value, settling);
        let mut units = starts.units.clone();
        units.push(place.width);
        let mut nearest = Nearest::new(map, variable, units, self.asked);
        for done in 0..settling.starts {
            let mut branches = Vec::new();
            let start = self.next_start(&starts, &mut nearest, place);
            for period in 1..=settling.longest {
                if nearest.periods() > allowed || place.refused > REFUSED {
                    met.add(branches);
                    return ControlFlow::Continue(());
                }
                let orbit = start
                    .as_ref()
                    .and_then(|(start, value)| nearest.orbit(&start.state, *value, period));
                if let Some(orbit) = orbit {
                    branches.extend(self.take(&mut nearest, &orbit, place)?);
                }
            }
            met.add(branches);
            let progress = Progress {
                total: Some(settling.starts),
                ..Progress::at(Stage::Solving, done + 1, place.value)
            };
            if self.observer.see(progress).is_break() {
                return ControlFlow::Break(Reason::Interrupted);
            }
        }
        ControlFlow::Continue(())
    }

    /// The next state, moved along, and its value. `None` if its motion cannot be computed.
    fn next_start(
        &mut self,
        starts: &Starts,
        nearest: &mut Nearest,
        place: &Place,
    ) -> Option<(Start, f64)> {
        let mut start = starts.draw(self.drawn);
        self.drawn += 1;
        nearest.measure_by(&start.units);
        let [low, high] = [
            self.asked[0].min(self.asked[1]),
            self.asked[0].max(self.asked[1]),
        ];
        let value = (place.value + (start.part - 0.5) * place.width).clamp(low, high);
        let moved = MOVED[start.turn % MOVED.len()];
        nearest.pass(&mut start.state, value, moved).ok()?;
        Some((start, value))
    }

    /// Periods at a value: what motions may take there, derivatives counted as more.
    fn allowed(&self, map: &mut Stroboscope, value: f64, settling: &Settling) -> u64 {
        let begun = map.work().forces;
        let mut moved = 0;
        for mut state in self.first_states(value) {
            moved += usize::from(map.map(&mut state).is_ok());
        }
        let period = (map.work().forces - begun) / moved.max(1);
        let patience = settling.patience.min(self.most_forces() / period.max(1));
        let periods = patience.saturating_mul(settling.starts) as f64;
        map.periods() + (periods / (1.0 + DERIVATIVE * map.order() as f64)) as u64
    }

    /// The number of the branch of an orbit, which is taken in unless it is known.
    fn take(
        &mut self,
        nearest: &mut Nearest,
        orbit: &NearestOrbit,
        place: &mut Place,
    ) -> ControlFlow<Reason, Option<usize>> {
        let known = self.passing(nearest, orbit);
        if known.is_some() {
            return ControlFlow::Continue(known);
        }
        let value = orbit.value;
        let added = self.add_orbit(Origin::Solved { value }, value, &orbit.states);
        self.exhaust();
        match added {
            Ok(number) => ControlFlow::Continue(Some(number)),
            Err(reason @ (Reason::Budget | Reason::Interrupted)) => ControlFlow::Break(reason),
            Err(reason) => {
                // The next states may lead to the same orbit.
                if place.refused == 0 {
                    self.diagram.missed.push((value, reason));
                }
                place.refused += 1;
                ControlFlow::Continue(None)
            }
        }
    }

    /// The number of the branch on which Newton's method leads to an orbit from between two neighbours: at less cost than by the method of
    /// the branch, which tells what this does not.
    fn passing(&self, nearest: &mut Nearest, orbit: &NearestOrbit) -> Option<usize> {
        self.diagram.branches.iter().position(|branch| {
            let begin = self.diagram.begin(branch);
            let mut pairs = beside(&branch.branch, begin, orbit.value);
            branch.period() == orbit.states.len()
                && pairs.any(|pair| {
                    let [a, b] = pair.map(|point| point.orbit.state());
                    let ends = [(pair[0].value, &a[..]), (pair[1].value, &b[..])];
                    nearest.is_between(ends, orbit)
                })
        })
    }
}
