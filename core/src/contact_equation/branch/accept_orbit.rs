//! Whether an orbit that was found is kept, looked for again by other equations, or come to in shorter steps.

use super::closed_states::pass_first;
use super::method::ContactBranch;
use super::test_values::{Last, divisor};
use crate::branches::point::Point;
use crate::branches::problem::Read;
use crate::branches::progress::Progress;
use crate::contact_equation::problem::FIRST;
use crate::contact_equation::reading::ReadOrbit;
use crate::contact_equation::switches::fits::Fits;
use crate::continuation::follow::CurvePoint;
use crate::shooting::test_functions::Tests;

/// A point is refused so often at most.
pub(in crate::contact_equation) const REFUSALS: usize = 8;
/// As many of them may be for panels that do not end at the kinks of the orbit: they move again as it is solved for.
pub(in crate::contact_equation) const RELOCATED: usize = 6;
/// A step is made again shorter so often at most, where it leaps over a touch of a level where the force jumps, over a touch and a change of
/// the order of switches, or to where no equations are found.
pub(super) const SHORTENED: usize = 8;
/// An error of all that is read.
const WHOLE: f64 = 1.0;
/// Parts of the tolerance below which fewer nodes do.
const PLENTY: f64 = 1e-4;

impl ContactBranch<'_, '_> {
    /// Reads an orbit that was found, and keeps it or says what is done instead.
    pub(super) fn read_orbit(&mut self, at: &CurvePoint) -> Read {
        self.first_here = None;
        let stuck = std::mem::take(&mut self.stuck);
        let again = !stuck && self.refused < REFUSALS;
        self.run
            .equations
            .compute(&at.u, self.run.problem.asked.stability);
        let equations = &self.run.equations;
        if equations.failed || equations.is_in_order() {
            let Some(read) = self.run.read_on(at) else {
                return Read::Lost;
            };
            let fits = self.run.fits(&at.u);
            if fits != Fits::No {
                return self.decide(at, read, fits, stuck);
            }
            // Behind a corner there may be nothing near by: it is come to from where it is watched.
            if again && self.shortened < SHORTENED && self.run.has_leapt(&at.u) {
                self.shortened += 1;
                return Read::TooFar;
            }
        }
        // A touch is passed by equations that have the switches around it in their order. Where those of the point behind it lead nowhere, it is
        // come to from where it is watched, too.
        let far = stuck || again && self.run.is_beyond_touch(&at.u);
        if far && self.shortened < SHORTENED {
            self.shortened += 1;
            self.refused = 0;
            return Read::TooFar;
        }
        if !again || !self.prepare(&at.u, self.run.resolution) {
            return Read::Lost;
        }
        if self.is_displaced() {
            return Read::TooFar;
        }
        self.refused += 1;
        Read::Refused
    }

    /// The resolution that the last error asks for.
    fn wanted(&self, point: &Point) -> usize {
        let now = self.run.resolution;
        if self.run.is_coarse(point) {
            now + 1
        } else if self.run.excess(point) < PLENTY && now > FIRST && self.held == 0 {
            now - 1
        } else {
            now
        }
    }

    /// Of nodes that step over a narrow place: where panels end elsewhere no orbit was found, or one that asks for others. The step was too
    /// long for them.
    fn shorter_or_lost(&mut self) -> Read {
        if self.shortened >= SHORTENED {
            return Read::Lost;
        }
        self.shortened += 1;
        self.refused = 0;
        Read::TooFar
    }

    /// Whether this is the first orbit, and known to no digit: that is none to begin with.
    fn begins_with_nothing(&self, point: &Point) -> bool {
        let is_first = self.run.record.points.is_empty();
        is_first
            && point
                .error
                .is_some_and(|error| error.is_finite() && error > WHOLE)
    }

    /// What is done with an orbit that was read, by equations that fit it.
    fn decide(&mut self, at: &CurvePoint, read: ReadOrbit, fits: Fits, stuck: bool) -> Read {
        let wanted = match read.overlooks {
            Some(overlooked) => overlooked.needed.unwrap_or(self.run.resolution),
            None => self.wanted(&read.point),
        };
        let again = !stuck && self.refused < REFUSALS;
        // As many nodes may do where panels end at the kinks of this orbit.
        let fails = self.run.excess(&read.point) > 1.0;
        let moved = fails && again && self.refused < RELOCATED && self.run.has_moved_kinks();
        if moved && self.prepare_at_kinks(&at.u) {
            if self.is_displaced() {
                return Read::TooFar;
            }
            self.refused += 1;
            return Read::Refused;
        }
        if wanted > self.run.resolution && again && self.prepare(&at.u, wanted) {
            if self.is_displaced() {
                return Read::TooFar;
            }
            self.refused += 1;
            return Read::Refused;
        }
        if read.overlooks.is_some() {
            return self.shorter_or_lost();
        }
        if self.begins_with_nothing(&read.point) {
            return Read::Lost;
        }
        self.refused = 0;
        self.shortened = 0;
        self.displaced = 0;
        let before = std::mem::replace(&mut self.kept, at.u.clone());
        self.held = self.held.saturating_sub(1);
        self.run.equations.known[0].clone_from(&at.u);
        if !self.keep_point(at, read) {
            return Read::Stop;
        }
        if self.first.is_some() && pass_first(&self.run.record.points, at.scale.parameter) {
            self.passes_first = true;
            // Where the orbit before has no place in the present unknowns there is no step to be looked at.
            return if before.is_empty() {
                Read::Resize
            } else {
                Read::ResizeBehind
            };
        }
        let other = fits == Fits::Soon || wanted != self.run.resolution;
        if other && !stuck && self.prepare(&at.u, wanted) {
            return Read::ResizeBehind;
        }
        if fits == Fits::Moved && !stuck && self.prepare_at_kinks(&at.u) {
            return Read::ResizeBehind;
        }
        if !other && !stuck && self.prepare_reshaped(at) {
            return Read::ResizeBehind;
        }
        let first = self.first.as_mut();
        self.first_here = first.and_then(|first| first.ahead(self.run, &before, at));
        if self.first_here.is_some() {
            return Read::ResizeBehind;
        }
        Read::Kept
    }

    fn keep_point(&mut self, at: &CurvePoint, read: ReadOrbit) -> bool {
        let ReadOrbit { point, map, .. } = read;
        let values = map.as_ref().map(|map| self.run.last_map.values(map));
        let values = values.map_or_else(Vec::new, <[_]>::to_vec);
        let tests = Tests::with(map.as_ref(), values, divisor(at));
        self.last = Some(Last {
            value: at.parameter(),
            slope: divisor(at),
            map: map.map_or_else(Vec::new, |map| map.as_slice().to_vec()),
        });
        self.tested = Some((at.u.clone(), tests));
        let done = self.run.record.points.len() + 1;
        let answer = (self.visit)(Progress::orbit(done, &point));
        self.run.record.points.push(point);
        answer.is_continue()
    }
}
