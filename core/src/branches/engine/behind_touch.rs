//! What test functions do right behind an orbit that touches a level.
//!
//! On the side where the level is crossed the time in contact grows as the root of the distance from the touch, and with it the map over a period,
//! if the slope of the force jumps. So test functions are smooth in
//!
//! ```text
//! r = (s / l)^(1/2)                                                                                            (1)
//! ```
//!
//! of the way `s` along the branch, in units `l` of that to the end of the step, and may pass zero twice in a part of it that is small in `s`. Orbits
//! are computed at two places in `r`, and where between these (1) or (2) of [`heights`](super::heights) come down to zero in `r`. The same is
//! done in the next step, since the first may end next to the touch. Where the force jumps determinants go as `a + b / r` instead, as
//! [behind a corner](super::beyond_corner), where the way itself goes as the root of the height: with `r = s / l` in place of (1) `r` times them is smooth, and is
//! looked at in the first step from where the walk goes on.
//!
//! Source: Nordmark (1991), Non-periodic motion caused by grazing incidence in an impact oscillator, Journal of Sound and Vibration 145 (the root);
//! di Bernardo, Budd, Champneys and Kowalczyk (2008), Piecewise-smooth Dynamical Systems, section 6.2.

use super::Engine;
use super::dip::{CLOSE, LOOKS};
use super::heights::{Height, in_doubt};
use super::seen::{Crossed, Seen};
use super::sought::noise_of;
use super::step_parts::{is_on_way, step_between};
use crate::branches::problem::{BranchProblem, Test};
use crate::continuation::locate::{ArcLength, inside_over};
use crate::continuation::newton::{Newton, NewtonOptions};
use crate::event::EventKind;

/// Where orbits are computed in any case: by (1), and as parts of what is left in `r = s / l` where the force jumps and orbits beside that are known.
const PLACES: [f64; 2] = [0.3, 0.65];
/// Orbits that are looked for to come to a place, at most.
const TRIES: usize = 12;

/// A part of the way from a touch on, and the orbits known on it.
struct Behind<'s> {
    /// Where the part begins, which may be the touch.
    begin: &'s Seen,
    /// `s`, and where (1) is one.
    along: ArcLength,
    whole: f64,
    /// `r` at both ends.
    range: [f64; 2],
    /// From the touch on, with `r`.
    known: Vec<(f64, Seen)>,
    falls: Option<bool>,
    /// The force jumps: determinants go as `1 / r`, and `r` as the way.
    unbounded: bool,
    options: NewtonOptions,
}

impl Engine {
    /// Orbits between a touch and the end of its step at which the level is crossed: some of them, and what they show that both ends do not.
    pub(super) fn behind_touch(
        &self,
        problem: &mut dyn BranchProblem,
        newton: &mut Newton,
        touch: &Seen,
        end: &Seen,
    ) -> Vec<Seen> {
        let along = ArcLength::over(newton, step_between([touch, end]));
        let mut behind = Behind {
            begin: touch,
            whole: along.at(&end.point.u),
            along,
            range: [0.0, 1.0],
            known: vec![(0.0, touch.clone()), (1.0, end.clone())],
            falls: touch.falls,
            unbounded: false,
            options: self.options.newton,
        };
        let contraction = newton.contraction();
        for place in PLACES {
            behind.add(problem, newton, place);
        }
        behind.seek_all(problem, newton);
        // What is only looked at leaves the walk as it is.
        newton.remember_contraction(contraction);
        behind.found()
    }

    /// The same between the end of that step and the other end of the one behind it, as far as both and the touch tell. Where the touch is the last
    /// point in other unknowns, its multipliers and how far it is from there do. Where the force jumps, the orbit before both that is `earlier` than they are
    /// tells, and the touch does not.
    pub(super) fn farther_behind(
        &self,
        problem: &mut dyn BranchProblem,
        newton: &mut Newton,
        crossed: &Crossed,
        earlier: Option<&Seen>,
        ends: [&Seen; 2],
    ) -> Vec<Seen> {
        let touch = &crossed.touch;
        let length = touch.point.u.len();
        if ends.iter().any(|end| end.point.u.len() != length) {
            return Vec::new();
        }
        let along = if crossed.displaced {
            ArcLength::over(newton, step_between(ends)).behind(crossed.way)
        } else {
            ArcLength::over(newton, step_between([touch, ends[1]]))
        };
        let ways = ends.map(|end| along.at(&end.point.u));
        let part = ways[0] / ways[1];
        let goes_on = part > 0.0 && part < 1.0;
        if !goes_on {
            return Vec::new();
        }
        let middle = place_of(part, crossed.jumps);
        let inner = |at: &Seen| {
            let r = place_of(along.at(&at.point.u) / ways[1], crossed.jumps);
            (r > 0.0 && r < middle).then_some(r)
        };
        let earlier = earlier.filter(|at| at.point.u.len() == length);
        let first = if crossed.jumps {
            earlier.and_then(|at| Some((inner(at)?, at)))
        } else {
            Some((0.0, touch))
        };
        let known = first.into_iter().chain([(middle, ends[0]), (1.0, ends[1])]);
        let mut behind = Behind {
            begin: ends[0],
            whole: ways[1],
            along,
            range: [middle, 1.0],
            known: known.map(|(r, seen)| (r, seen.clone())).collect(),
            falls: ends[0].falls,
            unbounded: crossed.jumps,
            options: self.options.newton,
        };
        let contraction = newton.contraction();
        if crossed.jumps && problem.resolves_sharp() {
            for part in PLACES {
                behind.add(problem, newton, middle + part * (1.0 - middle));
            }
        }
        behind.seek_all(problem, newton);
        newton.remember_contraction(contraction);
        behind.found()
    }
}

impl Behind<'_> {
    /// Computes the orbit at a place, by way of others nearer to those that are known where that fails: behind a touch the branch may bend too sharply
    /// for one step, and from the touch itself switches go as a root. Says whether there is a new one.
    fn add(&mut self, problem: &mut dyn BranchProblem, newton: &mut Newton, place: f64) -> bool {
        let count = self.known.len();
        let (mut reach, mut failed) = (place, 0);
        for _ in 0..TRIES {
            if self.add_between(problem, newton, reach) {
                if reach == place {
                    break;
                }
                (reach, failed) = (place, 0);
            } else {
                let [from, to] = self.beside(place).map(|at| self.known[at].0);
                let other = if failed % 2 == 0 { to } else { from };
                reach = other + 0.5_f64.powi(failed / 2 + 1) * (place - other);
                failed += 1;
            }
        }
        self.known.len() > count
    }

    /// The known places beside another one.
    fn beside(&self, place: f64) -> [usize; 2] {
        let next = self.known.iter().position(|(other, _)| *other > place);
        let next = next.unwrap_or(self.known.len() - 1).max(1);
        [next - 1, next]
    }

    /// Computes the orbit at a place from those beside it, if it is on the way from one to the other.
    fn add_between(
        &mut self,
        problem: &mut dyn BranchProblem,
        newton: &mut Newton,
        place: f64,
    ) -> bool {
        let [(from, a), (to, b)] = self.beside(place).map(|at| &self.known[at]);
        let step = step_between([a, b]);
        let way = |r: f64| if self.unbounded { r } else { r * r };
        let part = (way(place) - way(*from)) / (way(*to) - way(*from));
        let Some(point) = inside_over(problem.equations(), newton, step, part, self.options) else {
            return false;
        };
        if !is_on_way(newton, step, &point) {
            return false;
        }
        // Arc lengths of two orbits differ where the branch bends.
        let here = place_of(self.along.at(&point.u) / self.whole, self.unbounded);
        let place = if here > *from && here < *to {
            here
        } else {
            place
        };
        let seen = Seen::at(problem, &point, self.falls);
        let [_, next] = self.beside(place);
        self.known.insert(next, (place, seen));
        true
    }

    /// Adds orbits where a function of multipliers has another sign than at both ends, if there may be one.
    fn seek_all(&mut self, problem: &mut dyn BranchProblem, newton: &mut Newton) {
        let watched = 0..problem.watched().len();
        let of_map: Vec<usize> = watched
            .filter(|of| problem.is_of_multipliers(*of))
            .collect();
        for of in of_map {
            let noise = noise_of(problem, Test::Watched(of), self.begin);
            let is_modulus = problem.watched()[of].kind == EventKind::NeimarkSacker;
            let unbounded = self.unbounded && !is_modulus;
            // Parts in which no orbit is found, as next to the touch, hide none of the others.
            let mut shut: Vec<f64> = Vec::new();
            for _ in 0..LOOKS {
                let Some(heights) = self.heights(Test::Watched(of), noise, unbounded) else {
                    break;
                };
                let parts = heights
                    .windows(2)
                    .filter(|pair| !shut.contains(&pair[0].place));
                let mut parts = parts.map(|pair| [pair[0].place, pair[1].place]);
                let deepest =
                    in_doubt(&heights, self.range, CLOSE, true).filter(|_| shut.is_empty());
                let Some(place) = deepest.or_else(|| {
                    parts.find_map(|[from, to]| {
                        let range = [from.max(self.range[0]), to.min(self.range[1])];
                        in_doubt(&heights, range, CLOSE, true)
                    })
                }) else {
                    break;
                };
                if !self.add(problem, newton, place) {
                    let [from, _] = self.beside(place);
                    shut.push(self.known[from].0);
                }
            }
        }
    }

    /// How far a test function is above zero at all places, if it is so everywhere between both ends; times `r` if it is unbounded. Of what is known before
    /// them, what leads there with one sign.
    fn heights(&self, test: Test, noise: f64, unbounded: bool) -> Option<Vec<Height>> {
        let values = self.known.iter().map(|(_, seen)| seen.value(test));
        let reference = values.clone().map(|value| value.exponent);
        let reference = reference.fold(f64::NEG_INFINITY, f64::max);
        let sign = self.begin.value(test).mantissa.signum();
        let above = values.map(|value| sign * value.relative_to(reference));
        let above: Vec<f64> = above.collect();
        let is_low = |above: &f64| above.is_nan() || *above <= noise;
        let first = above.iter().rposition(is_low).map_or(0, |place| place + 1);
        let known = self.known[first..].iter().zip(&above[first..]);
        let heights = known.map(|((place, _), above)| {
            let weight = if unbounded { *place } else { 1.0 };
            Height {
                place: *place,
                height: weight * above,
            }
        });
        let heights: Vec<Height> = heights.collect();
        let reaches = heights.first()?.place <= self.range[0];
        reaches.then_some(heights)
    }

    /// What was computed.
    fn found(self) -> Vec<Seen> {
        let [from, to] = self.range;
        let inner = self.known.into_iter().filter(|(r, _)| *r > from && *r < to);
        inner.map(|(_, seen)| seen).collect()
    }
}

/// `r` at a part of the way.
fn place_of(part: f64, unbounded: bool) -> f64 {
    let part = part.max(0.0);
    if unbounded { part } else { part.sqrt() }
}
