//! Extremes of gaps that go through their level and back within a step.
//!
//! Both ends show such an extreme on one side of its level. How near it may come in between is told by its distance at three successive
//! points, as of a test function that may pass zero twice: see (1) of [`heights`](super::heights).

use super::dip::{CLOSE, LOOKS};
use super::grazing::Gaps;
use super::heights::{Height, in_doubt};
use super::step_parts::distance;
use crate::branches::extreme::Extreme;
use crate::branches::problem::BranchProblem;
use crate::continuation::follow::Step;
use crate::continuation::locate::{ArcLength, inside};
use crate::continuation::newton::{Newton, NewtonOptions};

/// An extreme that is nearer to its level, in units of the gap, stays there: which side of it is rounding.
const STAYS: f64 = 1e-8;

/// Two successive steps, the parts of which are looked at.
pub(super) struct Steps {
    /// An orbit before the first one, and the ends of both.
    ends: [Gaps; 3],
    /// Where they are along the branch.
    places: [f64; 3],
    /// The ends of the parts of either.
    pub(super) parts: [Vec<Gaps>; 2],
    /// The least way behind the beginning of one of them at which an extreme may still be on the other side of its level: no orbit was
    /// found there, or too many would have to be looked at.
    pub(super) doubt: Option<f64>,
}

/// What is known of an extreme between both ends of a step.
enum Told {
    /// It is on the other side of its level at this orbit.
    Across(Gaps),
    /// It stays.
    Stays,
    /// It may be there at this place.
    Doubt(f64),
}

impl Steps {
    /// Undivided; `None` where their unknowns differ.
    pub(super) fn new(newton: &Newton, ends: [Gaps; 3]) -> Option<Self> {
        if ends[0].point.u.len() != ends[1].point.u.len() {
            return None;
        }
        let length = |i: usize| distance(newton, &ends[i].point, &ends[i + 1].point);
        let places = [0.0, length(0), length(0) + length(1)];
        let parts = [0, 1].map(|i| ends[i..i + 2].to_vec());
        Some(Self {
            ends,
            places,
            parts,
            doubt: None,
        })
    }

    /// Divides them where an extreme is on the other side of its level than at all their ends.
    pub(super) fn divide(
        &mut self,
        problem: &mut dyn BranchProblem,
        newton: &mut Newton,
        options: NewtonOptions,
    ) {
        self.divide_some(problem, newton, options, &[1, 0]);
    }

    /// The same of the last one alone.
    pub(super) fn divide_last(
        &mut self,
        problem: &mut dyn BranchProblem,
        newton: &mut Newton,
        options: NewtonOptions,
    ) {
        self.divide_some(problem, newton, options, &[1]);
    }

    fn divide_some(
        &mut self,
        problem: &mut dyn BranchProblem,
        newton: &mut Newton,
        options: NewtonOptions,
        which: &[usize],
    ) {
        let middle = self.ends[1].extremes.clone();
        for extreme in &middle {
            let Some(heights) = self.heights(extreme) else {
                continue;
            };
            for &step in which {
                let inner = &self.parts[step][1..self.parts[step].len() - 1];
                let is_hidden = |gaps: &Gaps| is_across(extreme, &gaps.extremes);
                if inner.iter().any(is_hidden) {
                    continue;
                }
                let search = Search {
                    extreme,
                    whole: Step {
                        before: &self.ends[step].point,
                        next: &self.ends[step + 1].point,
                    },
                    range: [self.places[step], self.places[step + 1]],
                    options,
                };
                let found = match search.across(problem, newton, &heights) {
                    Told::Across(found) => found,
                    Told::Stays => continue,
                    Told::Doubt(place) => {
                        let way = place - self.places[step];
                        self.doubt = Some(self.doubt.map_or(way, |doubt| doubt.min(way)));
                        continue;
                    }
                };
                let along = ArcLength::from(newton, search.whole.before);
                let place = |gaps: &Gaps| along.at(&gaps.point.u);
                let parts = &self.parts[step];
                let next = parts.iter().position(|part| place(part) > place(&found));
                let next = next.unwrap_or(parts.len() - 1).max(1);
                self.parts[step].insert(next, found);
            }
        }
    }

    /// How far an extreme of the orbit in the middle is from its level at all three, if it is on one side.
    fn heights(&self, extreme: &Extreme) -> Option<[Height; 3]> {
        let mut heights = [Height {
            place: 0.0,
            height: 0.0,
        }; 3];
        for (i, to) in heights.iter_mut().enumerate() {
            let there = extreme.nearest(&self.ends[i].extremes)?;
            // Each must be the nearest of the other.
            if there.nearest(&self.ends[1].extremes) != Some(extreme) {
                return None;
            }
            *to = Height {
                place: self.places[i],
                height: extreme.above.signum() * there.above,
            };
        }
        let clear = heights.iter().all(|known| known.height > STAYS);
        clear.then_some(heights)
    }
}

/// Whether the same extreme of another orbit is on the other side of its level.
fn is_across(extreme: &Extreme, others: &[Extreme]) -> bool {
    let there = extreme.nearest(others);
    there.is_some_and(|there| there.above * extreme.above < 0.0)
}

/// A step in which an extreme may come to its level.
struct Search<'s> {
    extreme: &'s Extreme,
    whole: Step<'s>,
    /// Where it begins and ends along the branch.
    range: [f64; 2],
    options: NewtonOptions,
}

impl Search<'_> {
    /// An orbit in the step where the extreme is on the other side of its level.
    fn across(
        &self,
        problem: &mut dyn BranchProblem,
        newton: &mut Newton,
        heights: &[Height; 3],
    ) -> Told {
        let [from, to] = self.range;
        let mut known = heights.to_vec();
        let close = CLOSE * (to - from);
        for _ in 0..LOOKS {
            let Some(place) = in_doubt(&known, self.range, close, false) else {
                return Told::Stays;
            };
            let part = (place - from) / (to - from);
            let Some((gaps, height)) = self.look(problem, newton, part) else {
                return Told::Doubt(place);
            };
            if height < 0.0 {
                return Told::Across(gaps);
            }
            let next = known.partition_point(|other| other.place <= place);
            known.insert(next, Height { place, height });
        }
        in_doubt(&known, self.range, close, false).map_or(Told::Stays, Told::Doubt)
    }

    /// The orbit at a part of the step, and how far the extreme is from its level there, on the side of both ends.
    fn look(
        &self,
        problem: &mut dyn BranchProblem,
        newton: &mut Newton,
        part: f64,
    ) -> Option<(Gaps, f64)> {
        let point = inside(problem.equations(), newton, self.whole, part, self.options)?;
        let gaps = Gaps::at(problem, &point)?;
        let there = self.extreme.nearest(&gaps.extremes)?;
        let height = self.extreme.above.signum() * there.above;
        Some((gaps, height))
    }
}
