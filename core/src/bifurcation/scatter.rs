//! Orbits that no motion was seen to settle to.
//!
//! Few motions settle to an orbit whose basin is small, and none to one that is stable over a narrow part of the range only, between the values at
//! which motions were followed. But branches go on where their orbits are unstable, mostly over much more of the range, and Newton's method leads
//! to those orbits as well: from states as those of `starts.rs`, some of them moved along, with values that fill the surroundings of those that
//! were asked for. What is found and lies on no known branch begins another one.
//!
//! Of `N` orbits that were met, `n` of them on branches that were met once, the next one is on a new branch with a probability of about
//!
//! ```text
//! p = n / N                                                                                                     (1)
//! ```
//!
//! (Good 1953, Biometrika 40, 237, equation 9). Rounds follow each other until one finds nothing new and no branch was met only once.

use std::ops::ControlFlow;

use super::cover::Settling;
use super::diagram::{Origin, Reason, Search};
use super::matching::beside;
use super::nearest::{Nearest, NearestOrbit};
use super::starts::Starts;
use crate::branches::progress::{Progress, Stage};
use crate::response::OrbitMethod;
use crate::time::stroboscope::Stroboscope;

/// Rounds, at most.
const ROUNDS: usize = 8;
/// Values that were asked for one by one have surroundings of this part of the range.
const SURROUNDINGS: f64 = 0.05;
/// Periods for which states are moved along, in turn.
const MOVED: [usize; 3] = [0, 8, 30];
/// What derivatives by one entry of a state take, where one is what the state itself takes.
const DERIVATIVE: f64 = 0.3;

/// Part of the range around a value.
#[derive(Debug, Clone, Copy)]
struct Place {
    value: f64,
    width: f64,
}

impl<M: OrbitMethod> Search<'_, M> {
    /// Looks for orbits around the values that were asked for.
    pub(super) fn scatter(&mut self, settling: &Settling, at: &[f64]) {
        let [from, to] = self.asked;
        let count = settling.values as f64;
        let cells = (0..settling.values).map(|index| {
            let part = (index as f64 + 0.5) / count;
            Place {
                value: (1.0 - part) * from + part * to,
                width: (to - from).abs() / count,
            }
        });
        let asked = at.iter().map(|&value| Place {
            value,
            width: SURROUNDINGS * (to - from).abs(),
        });
        let places: Vec<Place> = cells.chain(asked).collect();
        let mut met = Vec::new();
        for _ in 0..ROUNDS {
            for &place in &places {
                if self.scatter_at(place, settling, &mut met).is_break() {
                    return;
                }
            }
            // What is new was met once.
            if !met.contains(&1) {
                return;
            }
        }
    }

    /// Looks for orbits around a value, for as long as motions may take there; breaks where no more branches may be followed.
    fn scatter_at(
        &mut self,
        place: Place,
        settling: &Settling,
        met: &mut Vec<usize>,
    ) -> ControlFlow<()> {
        if self.observer.interrupted || self.drifts(place.value) {
            return ControlFlow::Continue(());
        }
        // What cannot be computed there was said when motions were followed.
        let Ok(variable) = self.response.request.variable() else {
            return ControlFlow::Break(());
        };
        let Ok((starts, mut map)) = self.starts(place.value, settling.wide) else {
            return ControlFlow::Continue(());
        };
        let Some(allowed) = allowed(&mut map, settling) else {
            return ControlFlow::Continue(());
        };
        let mut units = starts.units.clone();
        units.push(place.width);
        let mut nearest = Nearest::new(map, variable, units, self.asked);
        let begun = nearest.forces();
        for _ in 0..settling.starts {
            if nearest.forces() - begun > allowed {
                break;
            }
            let drawn = self.drawn;
            self.drawn += 1;
            let cancelled = self.response.request.cancel.is_cancelled();
            let progress = Progress::at(Stage::Settling, drawn, place.value);
            if cancelled || self.observer.see(progress).is_break() {
                self.observer.interrupted = true;
                return ControlFlow::Break(());
            }
            for orbit in from(&mut nearest, &starts, place, drawn, settling.longest) {
                if let Some(number) = self.take(&mut nearest, &orbit)? {
                    met.resize(self.diagram.branches.len().max(number + 1), 0);
                    met[number] += 1;
                }
            }
        }
        ControlFlow::Continue(())
    }

    /// The number of the branch of an orbit, which is taken in unless it is known.
    fn take(
        &mut self,
        nearest: &mut Nearest,
        orbit: &NearestOrbit,
    ) -> ControlFlow<(), Option<usize>> {
        let known = self.passing(nearest, orbit);
        if known.is_some() {
            return ControlFlow::Continue(known);
        }
        let value = orbit.value;
        let added = self.add_orbit(Origin::Solved { value }, value, &orbit.states);
        self.exhaust();
        match added {
            Ok(number) => ControlFlow::Continue(Some(number)),
            Err(reason) => {
                let last = matches!(reason, Reason::Budget | Reason::Interrupted);
                self.diagram.missed.push((value, reason));
                if last {
                    ControlFlow::Break(())
                } else {
                    ControlFlow::Continue(None)
                }
            }
        }
    }

    /// The number of the branch on which Newton's method leads to an orbit from between two neighbours: at less cost than by the method of
    /// the branch, which tells what this does not.
    fn passing(&self, nearest: &mut Nearest, orbit: &NearestOrbit) -> Option<usize> {
        self.diagram.branches.iter().position(|branch| {
            let mut pairs = beside(branch, orbit.value);
            branch.period() == orbit.states.len()
                && pairs.any(|pair| {
                    let [a, b] = pair.map(|point| point.orbit.state());
                    let ends = [(pair[0].value, &a[..]), (pair[1].value, &b[..])];
                    nearest.is_between(ends, orbit)
                })
        })
    }
}

/// Evaluations of forces at a place: what motions may take there, derivatives counted as more. `None` if motions cannot be computed.
fn allowed(map: &mut Stroboscope, settling: &Settling) -> Option<usize> {
    let begun = map.work().forces;
    let mut state = vec![0.0; map.order()];
    map.map(&mut state).ok()?;
    let period = (map.work().forces - begun).max(1) as f64;
    let periods = settling.patience.saturating_mul(settling.starts) as f64;
    Some((periods * period / (1.0 + DERIVATIVE * map.order() as f64)) as usize)
}

/// Orbits of all periods that are looked for, from one state.
fn from(
    nearest: &mut Nearest,
    starts: &Starts,
    place: Place,
    drawn: usize,
    longest: usize,
) -> Vec<NearestOrbit> {
    let (mut state, part) = starts.draw(drawn);
    let value = place.value + (part - 0.5) * place.width;
    let moved = MOVED[drawn % MOVED.len()];
    if nearest.pass(&mut state, value, moved).is_err() {
        return Vec::new();
    }
    let orbits = (1..=longest).filter_map(|period| nearest.orbit(&state, value, period));
    orbits.collect()
}
