//! What test functions do between a [corner](super::corner) and a point on the side of it where the level is crossed.
//!
//! With a jump of the force, the stiffness of an orbit beyond its touch by a height `h` has an impulse at each of both switches that goes as
//! the inverse of the rate there, and the rate goes as the root of the height. So the map over a period is
//!
//! ```text
//! M = M_0 + B / r + O(r),    r = h^(1/2)                                                                       (1)
//! ```
//!
//! with a matrix `B` of rank one, and determinants of it go as `a + b / r`: they come from infinity, and may pass zero twice within what is a
//! small part of a step of arc length, or between the touch and the nearest orbit that is computed beside it. The slope of the
//! parameter and `r` times such a determinant are smooth in `r`, which is what (1) and (2) of [`heights`](super::heights) ask for. Orbits at heights
//! that fall by a factor are known, and others are computed where two of a sign leave open what is between them, or where the straight line
//! through the first two passes zero before the touch.
//!
//! Source: Nordmark (1991), Non-periodic motion caused by grazing incidence in an impact oscillator, Journal of Sound and Vibration 145 (the inverse
//! of the rate); di Bernardo, Budd, Champneys and Kowalczyk (2008), Piecewise-smooth Dynamical Systems, section 2.5 (saltation) and 6.2.

use super::Engine;
use super::corner_search::{Beside, Corner, CornerSearch, FIRST};
use super::heights::{Height, in_doubt};
use super::seen::Seen;
use super::sought::noise_of;
use crate::branches::problem::{BranchProblem, Test};
use crate::event::EventKind;

/// Heights of orbits behind a corner that are computed in any case, each as a part of the one before.
const PART: f64 = 0.1;
/// None is nearer to the touch than this, as a part of the height of the orbit where the branch begins behind it.
const CLOSEST: f64 = 1e-3;
/// No part of the way, in the root of the height, is longer than this part of all, if so many more orbits do.
const WIDEST: f64 = 0.3;
const FILLED: usize = 8;
/// Orbits that are looked for of one test function, at most, and until they come so near to each other, as a part of the way.
const LOOKS: usize = 8;
const CLOSE: f64 = 1e-4;
/// Where the straight line through two orbits passes zero before the touch, one is computed at so much of the way to that, and so often.
const NEARER: f64 = 0.5;
const BEFORE_FIRST: usize = 4;

/// An orbit with its test functions, at a place along the way: `r` of (1), or less than nothing where the way leads to the touch.
struct Known {
    place: f64,
    beside: Beside,
    seen: Seen,
}

/// Orbits on one side of a corner, in the order of the way.
pub(super) struct Beyond<'s, 'c> {
    search: CornerSearch<'s>,
    corner: &'c Corner,
    /// One on the way from the touch, or minus one.
    onward: f64,
    known: Vec<Known>,
}

impl Engine {
    /// Orbits between a corner and others on the side of it where the level is crossed, the nearest first, from which the branch `comes` or to which it
    /// goes: all ends and as many between them as it takes to tell which test functions change their sign.
    pub(super) fn beyond_corner(
        &self,
        search: CornerSearch<'_>,
        corner: &Corner,
        outer: &[Beside],
        comes: bool,
    ) -> Vec<Seen> {
        let mut beyond = Beyond {
            search,
            corner,
            onward: if comes { -1.0 } else { 1.0 },
            known: Vec::new(),
        };
        let first = Beside {
            point: if comes { &corner.end } else { &corner.begin }.clone(),
            extreme: corner.crossed,
        };
        let highest = outer.first().map_or(0.0, |nearest| nearest.extreme.above);
        let lowest = first.extreme.above.abs();
        beyond.keep(first);
        let is_beside = highest.abs() <= lowest;
        let count = if is_beside { 1 } else { outer.len() };
        for outer in &outer[..count] {
            beyond.keep(outer.clone());
        }
        if is_beside {
            return beyond.in_order(comes, self.falls);
        }
        if comes {
            for beside in corner.way.iter().rev() {
                beyond.add(beside.clone());
            }
        } else {
            let mut height = PART * highest;
            while PART * height.abs() > lowest {
                beyond.add_at(height);
                height *= PART;
            }
        }
        if beyond.problem().resolves_sharp() {
            beyond.fill();
        }
        beyond.seek_all();
        beyond.seen(self.falls)
    }
}

impl Beyond<'_, '_> {
    fn problem(&mut self) -> &mut dyn BranchProblem {
        &mut *self.search.problem
    }

    /// Keeps an orbit at its place.
    fn keep(&mut self, beside: Beside) {
        let seen = Seen::at(self.problem(), &beside.point, None);
        let place = self.onward * beside.extreme.above.abs().sqrt();
        let next = self.next_to(place);
        let known = Known {
            place,
            beside,
            seen,
        };
        self.known.insert(next, known);
    }

    /// Where the first orbit behind a place is among those known.
    fn next_to(&self, place: f64) -> usize {
        self.known.partition_point(|known| known.place < place)
    }

    /// Computes the orbit of a height, if it is on the way from one to the next of those known. Says whether there is a new one.
    fn add_at(&mut self, height: f64) -> bool {
        let found = self.search.at_height(self.corner, height);
        found.is_some_and(|found| self.add(found))
    }

    /// The same at a place: between those known beside it, or else by its height.
    fn add_near(&mut self, place: f64) -> bool {
        let next = self.next_to(place);
        if next > 0 && next < self.known.len() {
            let [a, b] = [next - 1, next].map(|at| &self.known[at]);
            let part = (place - a.place) / (b.place - a.place);
            let found = self.search.between([&a.beside, &b.beside], part);
            if found.is_some_and(|found| self.add(found)) {
                return true;
            }
        }
        let sign = self.corner.crossed.above.signum();
        self.add_at(sign * place * place)
    }

    /// Keeps an orbit that is on the way: beyond the level, and in the direction of the one before it on the way from the touch.
    fn add(&mut self, beside: Beside) -> bool {
        let place = self.onward * beside.extreme.above.abs().sqrt();
        let next = self.next_to(place);
        let [inner, outer] = if self.onward > 0.0 {
            [next.checked_sub(1), Some(next)]
        } else {
            [Some(next), next.checked_sub(1)]
        };
        let known = |place: Option<usize>| place.and_then(|place| self.known.get(place));
        let along = match (known(inner), known(outer)) {
            // Nearer to the touch than the first of them.
            (inner, Some(outer)) => {
                let beside_it = &inner.unwrap_or(outer).beside.point;
                self.search.bend(beside_it, &beside.point) > 0.0
            }
            (_, None) => false,
        };
        let crosses = beside.extreme.above * self.corner.crossed.above > 0.0;
        if crosses && along {
            self.keep(beside);
        }
        crosses && along
    }

    /// Adds orbits in the middle of long parts of the way: a function that passes zero three times in one of them shows one change of its sign.
    fn fill(&mut self) {
        let ends = [0, self.known.len() - 1].map(|end| self.known[end].place);
        let longest = WIDEST * (ends[1] - ends[0]);
        let mut shut: Vec<f64> = Vec::new();
        for _ in 0..FILLED {
            let mut parts = self
                .known
                .windows(2)
                .map(|pair| [pair[0].place, pair[1].place]);
            let long = parts.find(|[from, to]| to - from > longest && !shut.contains(from));
            let Some([from, to]) = long else {
                break;
            };
            let is_added = self.add_near(0.5 * (from + to));
            // What is found by its height may lie elsewhere.
            let inside = |known: &Known| known.place > from && known.place < to;
            if !is_added || !self.known.iter().any(inside) {
                shut.push(from);
            }
        }
    }

    /// Adds orbits where a test function has another sign than both beside them, if there may be one.
    fn seek_all(&mut self) {
        let watched = 0..self.problem().watched().len();
        let problem = self.problem();
        let of_map = watched.filter(|of| problem.is_of_multipliers(*of));
        let of_map: Vec<Test> = of_map.map(Test::Watched).collect();
        for test in [Test::Slope].into_iter().chain(of_map) {
            for _ in 0..BEFORE_FIRST {
                if !self.seek_before_first(test) {
                    break;
                }
            }
            let mut asked = f64::NAN;
            for _ in 0..LOOKS {
                let Some(place) = self.doubtful(test) else {
                    break;
                };
                // What was found by its height may lie elsewhere, and the same place be asked for.
                if place == asked || !self.add_near(place) {
                    break;
                }
                asked = place;
            }
        }
    }

    /// A place between two orbits of one sign where the function may have the other one.
    fn doubtful(&mut self, test: Test) -> Option<f64> {
        let heights = self.heights(test);
        let noise = noise_of(&*self.search.problem, test, &self.known[0].seen);
        let whole = self.known[self.known.len() - 1].place - self.known[0].place;
        let alike = |a: &Height, b: &Height| a.height * b.height > 0.0;
        let known = heights.iter().filter(|known| known.height.is_finite());
        let known: Vec<Height> = known.copied().collect();
        known.chunk_by(alike).find_map(|run| {
            let sign = run[0].height.signum();
            let above = run.iter().map(|known| Height {
                height: sign * known.height,
                ..*known
            });
            let above: Vec<Height> = above.collect();
            if above.len() < 2 || above.iter().any(|known| known.height <= noise) {
                return None;
            }
            let range = [above[0].place, above[above.len() - 1].place];
            in_doubt(&above, range, CLOSE * whole, true)
        })
    }

    /// Adds an orbit nearer to the touch, if the straight line through the two that are nearest passes zero before it. Says whether.
    fn seek_before_first(&mut self, test: Test) -> bool {
        let heights = self.heights(test);
        let [first, next] = if self.onward > 0.0 {
            [0, 1]
        } else {
            [heights.len() - 1, heights.len() - 2]
        };
        let (a, b) = (heights[first], heights[next]);
        let zero = a.place - a.height * (b.place - a.place) / (b.height - a.height);
        let lowest = (CLOSEST * FIRST).sqrt();
        // On its other side the function has the sign that it comes from infinity with.
        let place = (NEARER * zero).abs().max(lowest);
        let is_before = self.onward * zero > 0.0 && place < a.place.abs();
        is_before
            && a.height * b.height > 0.0
            && self.add_at(self.corner.crossed.above.signum() * place * place)
    }

    /// A test function at all places; of (1) times `r` what is not bounded.
    fn heights(&mut self, test: Test) -> Vec<Height> {
        let unbounded = match test {
            Test::Slope => false,
            Test::Watched(of) => self.problem().watched()[of].kind != EventKind::NeimarkSacker,
        };
        let values = self.known.iter().map(|known| known.seen.value(test));
        let reference = values.clone().map(|value| value.exponent);
        let reference = reference.fold(f64::NEG_INFINITY, f64::max);
        let pairs = self.known.iter().zip(values);
        let heights = pairs.map(|(known, value)| {
            let weight = if unbounded { known.place.abs() } else { 1.0 };
            Height {
                place: known.place,
                height: weight * value.relative_to(reference),
            }
        });
        heights.collect()
    }

    /// The two ends alone, in the order of the way: what lies between is at the touch.
    fn in_order(mut self, comes: bool, falls: Option<bool>) -> Vec<Seen> {
        let is_end = |known: &Known| known.seen.point == self.corner.end;
        let is_begin = |known: &Known| known.seen.point == self.corner.begin;
        if comes {
            self.known.sort_by_key(is_end);
        } else {
            self.known.sort_by_key(|known| !is_begin(known));
        }
        self.seen(falls)
    }

    /// All of them, behind a point where the parameter falls or not.
    fn seen(self, mut falls: Option<bool>) -> Vec<Seen> {
        let all = self.known.into_iter().map(|known| {
            falls = known.seen.falls.or(falls);
            Seen {
                falls,
                ..known.seen
            }
        });
        all.collect()
    }
}
