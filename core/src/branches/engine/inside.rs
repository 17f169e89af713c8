//! What lies between two points that the signs of test functions at both do not show.
//!
//! A function that has one sign at both ends of a step may have passed zero twice: two folds, or two bifurcations of a kind. The parabola
//! through its values at three successive points tells where it comes nearest to zero. If that is much nearer than at the ends of a step,
//! the orbit there is computed, and the parabola taken again through the lowest of them, until one has the other sign or none comes
//! lower. It may be in the step before the last one, since a point beside the second zero says nothing until the next one is known.
//!
//! Where a branch turns and the bordered determinant changes its sign as well, that is one place, where it ends on another branch, or
//! two, a fold and a crossing: orbits on both sides of the turn tell.
//!
//! Source: successive parabolic interpolation, as in Brent (1973), Algorithms for Minimization without Derivatives, chapter 5.

use super::{Engine, Seen, changes};
use crate::branches::problem::{BranchProblem, Change, Test, TestValue};
use crate::continuation::follow::{CurvePoint, Step};
use crate::continuation::locate::{inside, locate};
use crate::continuation::newton::Newton;
use crate::event::EventKind;

/// A function that comes nearer to zero than this part of what it is at both ends is looked at.
const NEAR: f64 = 0.5;
/// So many orbits, and until they come this near to each other, as a part of the step.
const LOOKS: usize = 6;
const CLOSE: f64 = 1e-3;
/// Half of the widths about a turn that are looked at, as parts of the step.
const BESIDE: [f64; 3] = [1e-2, 1e-3, 1e-4];
/// A zero is in the middle of a width if the values at both ends differ by less than this part.
const MIDDLE: f64 = 0.2;

impl Engine {
    /// A step divided so that no test function changes its sign twice in a part, as far as can be seen. What shows in the step
    /// before it, from the `earlier` point on, is recorded.
    pub(super) fn parts(
        &mut self,
        problem: &mut dyn BranchProblem,
        newton: &mut Newton,
        earlier: Option<&Seen>,
        [a, b]: [Seen; 2],
        after: usize,
    ) -> Vec<Seen> {
        let mut parts = vec![a, b];
        if let Some(earlier) = earlier {
            let watched = (0..problem.watched().len()).map(Test::Watched);
            for test in [Test::Slope].into_iter().chain(watched) {
                let ends = [parts[0].clone(), parts[parts.len() - 1].clone()];
                match self.dip(problem, newton, [earlier, &ends[0], &ends[1]], test) {
                    Some(Dip::Last(found)) => insert(newton, &mut parts, found),
                    // Found as the last step, when it was that.
                    Some(Dip::Before(_)) if self.divided.contains(&(after - 1, test)) => {}
                    Some(Dip::Before(found)) => {
                        self.record_pair(
                            problem,
                            newton,
                            [earlier, &found, &ends[0]],
                            test,
                            after - 1,
                        );
                    }
                    None => {}
                }
                if self.ended.is_some() {
                    return parts;
                }
            }
            self.note_divided(problem, &parts, after);
        }
        self.divided.retain(|(place, _)| *place + 1 >= after);
        let mut index = 0;
        while index + 1 < parts.len() {
            let pair = [&parts[index], &parts[index + 1]];
            if let Some(beside) = self.beside_turn(problem, newton, pair) {
                parts.splice(index + 1..=index, beside);
                index += 2;
            }
            index += 1;
        }
        parts
    }

    /// Notes for which test functions the parts of a step show what its ends do not.
    fn note_divided(&mut self, problem: &dyn BranchProblem, parts: &[Seen], after: usize) {
        let watched = (0..problem.watched().len()).map(Test::Watched);
        for test in [Test::Slope].into_iter().chain(watched) {
            let negative = |seen: &Seen| seen.value(test).is_negative();
            let [first, inner @ .., last] = parts else {
                return;
            };
            let hidden = negative(first) == negative(last)
                && inner.iter().any(|seen| negative(seen) != negative(first));
            if hidden && !self.divided.contains(&(after, test)) {
                self.divided.push((after, test));
            }
        }
    }

    /// Records the two zeros of one test function on both sides of an orbit.
    fn record_pair(
        &mut self,
        problem: &mut dyn BranchProblem,
        newton: &mut Newton,
        [a, inner, b]: [&Seen; 3],
        test: Test,
        after: usize,
    ) {
        for pair in [[a, inner], [inner, b]] {
            let found = changes(problem, pair[0], pair[1]);
            for change in found.into_iter().filter(|change| change.test == test) {
                self.record(problem, newton, pair, change, after);
                if self.ended.is_some() {
                    return;
                }
            }
        }
    }

    /// An orbit inside one of two steps where a test function has the other sign than at all their ends.
    fn dip(
        &self,
        problem: &mut dyn BranchProblem,
        newton: &mut Newton,
        points: [&Seen; 3],
        test: Test,
    ) -> Option<Dip> {
        let values = points.map(|seen| seen.value(test));
        let sign = values[1].mantissa.signum();
        let alike = |value: &TestValue| sign * value.mantissa > 0.0;
        if points[0].point.u.len() != points[1].point.u.len() || !values.iter().all(alike) {
            return None;
        }
        let reference = values.iter().map(|value| value.exponent);
        let reference = reference.fold(f64::NEG_INFINITY, f64::max);
        let heights = values.map(|value| sign * value.relative_to(reference));
        let lengths = [0, 1].map(|i| distance(newton, &points[i].point, &points[i + 1].point));
        let known = [
            (-lengths[0], heights[0]),
            (0.0, heights[1]),
            (lengths[1], heights[2]),
        ];
        let (place, _) = vertex(known)?;
        let last = place > 0.0;
        let (between, known, whole) = if last {
            ([points[1], points[2]], known, lengths[1])
        } else {
            let shifted = known.map(|(s, height)| (s + lengths[0], height));
            ([points[0], points[1]], shifted, lengths[0])
        };
        let least = between.map(|seen| sign * seen.value(test).relative_to(reference));
        let least = least[0].min(least[1]);
        let noise = match test {
            Test::Slope => 0.0,
            Test::Watched(index) => problem.noise(index),
        };
        if least <= problem.vanishing().max(noise) {
            return None;
        }
        let descent = Descent {
            between,
            whole,
            least,
            test,
            sign,
            reference,
        };
        let found = self.lowest(problem, newton, &descent, known)?;
        Some(if last {
            Dip::Last(found)
        } else {
            Dip::Before(found)
        })
    }

    fn lowest(
        &self,
        problem: &mut dyn BranchProblem,
        newton: &mut Newton,
        descent: &Descent<'_>,
        mut known: [(f64, f64); 3],
    ) -> Option<Seen> {
        let Descent { between, whole, .. } = *descent;
        let ends = step_between(between);
        let close = CLOSE * whole;
        let mut lowest = f64::NAN;
        for _ in 0..LOOKS {
            let (place, foretold) = vertex(known)?;
            let is_within = place > close && place < whole - close;
            if !is_within || foretold > NEAR * descent.least || (place - lowest).abs() < close {
                return None;
            }
            let options = self.options.newton;
            let point = inside(problem.equations(), newton, ends, place / whole, options)?;
            let seen = Seen::at(problem, &point, true);
            let mut pairs = seen.values.iter().zip(&between[0].values);
            if pairs.any(|(here, there)| there.is_known() && !here.is_known()) {
                // A part without a value would hide what changes its sign there.
                return None;
            }
            let height = descent.sign * seen.value(descent.test).relative_to(descent.reference);
            if height < 0.0 {
                return Some(seen);
            }
            let mut all = [&known[..], &[(place, height)]].concat();
            all.sort_by(|x, y| x.0.total_cmp(&y.0));
            let at = (1..all.len() - 1).min_by(|i, j| all[*i].1.total_cmp(&all[*j].1))?;
            known = [all[at - 1], all[at], all[at + 1]];
            lowest = place;
        }
        None
    }

    /// Orbits before and behind the turn in a step in which the bordered determinant changes its sign too, if it does so beside the turn.
    fn beside_turn(
        &self,
        problem: &mut dyn BranchProblem,
        newton: &mut Newton,
        pair: [&Seen; 2],
    ) -> Option<[Seen; 2]> {
        let found = changes(problem, pair[0], pair[1]);
        let is_turn =
            |change: &Change| change.test == Test::Slope && change.kind == EventKind::BranchPoint;
        if !found.iter().any(is_turn) {
            return None;
        }
        let bordered = problem
            .watched()
            .iter()
            .position(|watched| watched.bordered)?;
        let step = step_between(pair);
        let options = self.options.newton;
        let wanted = problem.vanishing().max(problem.aim());
        let turn = locate(problem, newton, step, options, wanted, |_, at| {
            at.parameter_slope()
        })?;
        let length = distance(newton, step.before, step.next);
        let place = distance(newton, step.before, &turn.point) / length;
        let mut beside = |part: f64| {
            let point = inside(problem.equations(), newton, step, part, options)?;
            Some(Seen::at(problem, &point, true))
        };
        for width in BESIDE {
            let width = width.min(0.5 * place).min(0.5 * (1.0 - place));
            let found = [beside(place - width)?, beside(place + width)?];
            let slopes = found.each_ref().map(|seen| seen.point.parameter_slope());
            if slopes[0] * slopes[1] >= 0.0 {
                return None;
            }
            let values = found.each_ref().map(|seen| seen.values[bordered]);
            let reference = values[0].exponent.max(values[1].exponent);
            let [b, c] = values.map(|value| value.relative_to(reference));
            if b * c > 0.0 {
                return Some(found);
            }
            // Where a branch ends on another one, it vanishes in the middle.
            if (b + c).abs() < MIDDLE * (b - c).abs() {
                return None;
            }
        }
        None
    }
}

/// Where an orbit of the other sign was found.
enum Dip {
    /// In the last step.
    Last(Seen),
    /// In the one before.
    Before(Seen),
}

/// A step in which a test function may come down to zero.
struct Descent<'s> {
    between: [&'s Seen; 2],
    /// Its length.
    whole: f64,
    /// The lower one of the values at its ends.
    least: f64,
    test: Test,
    sign: f64,
    reference: f64,
}

/// The step from one orbit to another.
fn step_between([a, b]: [&Seen; 2]) -> Step<'_> {
    Step {
        before: &a.point,
        next: &b.point,
    }
}

/// Puts an orbit to its place among the parts of a step.
fn insert(newton: &Newton, parts: &mut Vec<Seen>, found: Seen) {
    let along = |seen: &Seen| distance(newton, &parts[0].point, &seen.point);
    let place = along(&found);
    let next = parts.iter().position(|part| along(part) > place);
    parts.insert(next.unwrap_or(parts.len() - 1), found);
}

/// How far a point is behind another one, along the tangent there.
fn distance(newton: &Newton, a: &CurvePoint, b: &CurvePoint) -> f64 {
    let step = Step { before: a, next: b };
    newton
        .norm()
        .product(a.scale, &a.tangent, &step.difference())
}

/// Place and value of the lowest point of the parabola through three points; `None` if it has none.
fn vertex([(x, p), (y, q), (z, r)]: [(f64, f64); 3]) -> Option<(f64, f64)> {
    let (left, right) = ((q - p) / (y - x), (r - q) / (z - y));
    let bend = (right - left) / (z - x);
    // q + s (u - y) + bend (u - y)^2
    let s = left + bend * (y - x);
    let lowest = y - 0.5 * s / bend;
    (bend > 0.0 && lowest.is_finite()).then_some((lowest, q - 0.25 * s * s / bend))
}
