//! What lies between two points that the signs of test functions at both do not show.
//!
//! A function that has one sign at both ends of a step may have passed zero twice: two folds, or two bifurcations of a kind. Where its
//! [heights](super::heights) above zero at three successive points leave that open, the orbit there is computed, and both parts are looked at
//! with what is known then, until one has the other sign or all stay above. It may be in the step before the last one, since a
//! point beside the second zero says nothing until the next one is known. Orbits that were looked at for one function are known to all others.
//!
//! Where a branch turns and the bordered determinant changes its sign as well, that is one place, where it ends on another branch, or
//! two, a fold and a crossing: orbits on both sides of the turn tell.

use std::iter;

use super::Engine;
use super::heights::{Height, in_doubt};
use super::meeting::Meeting;
use super::seen::{Former, Seen, changes, signs};
use crate::branches::problem::{BranchProblem, Change, Test, TestValue};
use crate::continuation::follow::{CurvePoint, Step};
use crate::continuation::locate::{ArcLength, inside, locate};
use crate::continuation::newton::{Newton, NewtonOptions};
use crate::event::EventKind;

/// So many orbits, and until they come this near to each other, as a part of the step.
pub(super) const LOOKS: usize = 6;
pub(super) const CLOSE: f64 = 1e-3;
/// Half of the widths about a turn that are looked at, as parts of the step.
const BESIDE: [f64; 3] = [1e-2, 1e-3, 1e-4];
/// Orbits there are known to this part of how far they are from the turn: a step may be hardly longer than what Newton's method leaves.
const KNOWN: f64 = 1e-2;
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
        let mut parts = self.through_narrow(problem, newton, [a, b]);
        self.doubted = parts.len() > 2;
        self.divide_parts(problem, newton, &mut parts, 0);
        let displaced = self.earlier.take().filter(|_| earlier.is_none());
        let displaced = displaced.filter(|at| at.u.len() == parts[0].point.u.len());
        let displaced = displaced.map(|at| Seen::at(problem, &at, parts[0].falls));
        let former = self.former.take().filter(|_| displaced.is_none());
        if let Some(earlier) = earlier.or(displaced.as_ref()) {
            let mut looks = Vec::new();
            for sought in sought_from(problem, &parts[0]) {
                if sought.is_seen(problem, &parts, earlier) {
                    continue;
                }
                let points = [earlier, &parts[0], &parts[parts.len() - 1]];
                match self.dip(problem, newton, points, &mut looks, sought) {
                    Some(Dip::Last(found)) => insert(newton, &mut parts, found),
                    // Found as the last step, when it was that.
                    Some(Dip::Before(_)) if sought.is_among(&self.divided, after - 1) => {}
                    Some(Dip::Before(found)) => {
                        let parts = [earlier.clone(), found, parts[0].clone()];
                        self.record_pair(problem, newton, &parts, after - 1);
                    }
                    None => {}
                }
                if self.ended.is_some() {
                    return parts;
                }
            }
        }
        if let Some(former) = former {
            self.divide_behind(problem, newton, former, &mut parts);
        }
        self.note_divided(problem, &parts, after);
        self.divided.retain(|(place, _)| *place + 1 >= after);
        let mut index = 0;
        while index + 1 < parts.len() {
            let pair = [&parts[index], &parts[index + 1]];
            // What is only looked at leaves the walk as it is.
            let contraction = newton.contraction();
            let beside = self.beside_turn(problem, newton, pair);
            newton.remember_contraction(contraction);
            if let Some(beside) = beside {
                parts.splice(index + 1..=index, beside);
                index += 2;
            }
            index += 1;
        }
        parts
    }

    /// Records what the first of these points show in the step between the first two that both of its ends do not: that step is behind so many points, and it
    /// was looked at before the third one was known.
    pub(super) fn record_before(
        &mut self,
        problem: &mut dyn BranchProblem,
        newton: &mut Newton,
        points: [&Seen; 3],
        after: usize,
    ) {
        let mut looks = Vec::new();
        for sought in sought_from(problem, points[1]) {
            if sought.is_copy(problem, [points[0], points[1]]) {
                continue;
            }
            let within = Within::First;
            let found = self.dip_within(problem, newton, points, within, &mut looks, sought);
            let Some(Dip::Before(found)) = found else {
                continue;
            };
            if !sought.is_among(&self.divided, after) {
                let parts = [points[0].clone(), found, points[1].clone()];
                self.record_pair(problem, newton, &parts, after);
            }
            if self.ended.is_some() {
                return;
            }
        }
    }

    /// Divides the first step behind a point that has other unknowns, as far as slopes and multipliers tell: what else there is to compare is of
    /// the equations.
    fn divide_behind(
        &self,
        problem: &mut dyn BranchProblem,
        newton: &mut Newton,
        former: Former,
        parts: &mut Vec<Seen>,
    ) {
        let mut looks = Vec::new();
        let within = Within::Last(former.way);
        let earlier = former.before(&parts[0]);
        let slope = Sought::Test(Test::Slope);
        let sought = of_multipliers(problem, &parts[0]).into_iter();
        for sought in iter::once(slope).chain(sought) {
            if sought.is_seen(problem, parts, &earlier) {
                continue;
            }
            let points = [&earlier, &parts[0], &parts[parts.len() - 1]];
            let found = self.dip_within(problem, newton, points, within, &mut looks, sought);
            if let Some(Dip::Last(found)) = found {
                insert(newton, parts, found);
            }
        }
    }

    /// Divides parts of one step where a function passes zero twice in one of them, as far as three of their ends tell. So many of the first are no
    /// parts of it, and stay as they are.
    pub(super) fn divide_parts(
        &self,
        problem: &mut dyn BranchProblem,
        newton: &mut Newton,
        parts: &mut Vec<Seen>,
        before: usize,
    ) {
        let mut middle = 1;
        while middle + 1 < parts.len() {
            let mut looks = Vec::new();
            for sought in sought_from(problem, &parts[middle]) {
                let points = [middle - 1, middle, middle + 1].map(|place| &parts[place]);
                let (found, place) = match self.dip(problem, newton, points, &mut looks, sought) {
                    Some(Dip::Last(found)) => (found, middle + 1),
                    Some(Dip::Before(found)) if middle > before => (found, middle),
                    Some(Dip::Before(_)) | None => continue,
                };
                parts.insert(place, found);
                middle += 1;
                break;
            }
            middle += 1;
        }
    }

    /// Notes for which test functions the parts of a step show what its ends do not.
    pub(super) fn note_divided(
        &mut self,
        problem: &dyn BranchProblem,
        parts: &[Seen],
        after: usize,
    ) {
        for test in tests(problem) {
            if is_hidden(problem, parts, test) && !self.divided.contains(&(after, test)) {
                self.divided.push((after, test));
            }
        }
    }

    /// An orbit inside one of two steps where a test function has the other sign than at all their ends.
    fn dip(
        &self,
        problem: &mut dyn BranchProblem,
        newton: &mut Newton,
        points: [&Seen; 3],
        looks: &mut Vec<Look>,
        sought: Sought,
    ) -> Option<Dip> {
        self.dip_within(problem, newton, points, Within::Both, looks, sought)
    }

    /// The same in one of them, or both.
    fn dip_within(
        &self,
        problem: &mut dyn BranchProblem,
        newton: &mut Newton,
        points: [&Seen; 3],
        within: Within,
        looks: &mut Vec<Look>,
        sought: Sought,
    ) -> Option<Dip> {
        let values = points.map(|seen| sought.value(seen));
        let sign = values[1].mantissa.signum();
        let alike = |value: &TestValue| sign * value.mantissa > 0.0;
        if points[0].point.u.len() != points[1].point.u.len() || !values.iter().all(alike) {
            return None;
        }
        let reference = values.iter().map(|value| value.exponent);
        let reference = reference.fold(f64::NEG_INFINITY, f64::max);
        let heights = values.map(|value| sign * value.relative_to(reference));
        let length = |i: usize| distance(newton, &points[i].point, &points[i + 1].point);
        let (steps, first) = match within {
            Within::Both => (&[1, 0][..], length(0)),
            Within::First => (&[0][..], length(0)),
            Within::Last(way) => (&[1][..], way),
        };
        let lengths = [first, length(1)];
        let places = [0.0, lengths[0], lengths[0] + lengths[1]];
        let known = [0, 1, 2].map(|i| Height {
            place: places[i],
            height: heights[i],
        });
        let noise = match sought {
            Sought::Test(test) => noise_of(problem, test, points[1]),
            Sought::Meeting(_) => 0.0,
        };
        for &first in steps {
            let descent = Descent {
                between: [points[first], points[first + 1]],
                from: places[first],
                whole: lengths[first],
                sought,
                kinks: sought.may_have_kinks(problem),
                sign,
                reference,
            };
            if heights[first].min(heights[first + 1]) <= noise {
                continue;
            }
            if let Some(found) = self.lowest(problem, newton, &descent, &known, looks) {
                return Some(if first == 1 {
                    Dip::Last(found)
                } else {
                    Dip::Before(found)
                });
            }
        }
        None
    }

    /// An orbit of the other sign in a step, if its heights do not exclude it. What is looked at is known to what is looked for next.
    fn lowest(
        &self,
        problem: &mut dyn BranchProblem,
        newton: &mut Newton,
        descent: &Descent<'_>,
        known: &[Height; 3],
        looks: &mut Vec<Look>,
    ) -> Option<Seen> {
        let Descent { from, whole, .. } = *descent;
        let close = CLOSE * whole;
        let is_open = in_doubt(known, [from, from + whole], close, descent.kinks).is_some();
        let mut known = known.to_vec();
        let mut found = None;
        for look in looks.iter().filter(|look| look.on_way) {
            let Some(height) = descent.height(look) else {
                continue;
            };
            if height < 0.0 {
                if descent.is_within(look.place) {
                    found = found.or(Some(look));
                }
                continue;
            }
            let place = look.place;
            let near = |other: &Height| (other.place - place).abs() < CLOSE * whole;
            if known.iter().any(near) {
                continue;
            }
            let next = known.iter().position(|other| other.place > place);
            known.insert(next.unwrap_or(known.len()), Height { place, height });
        }
        if let Some(found) = found {
            // What its own heights leave no doubt of may have another sign for its unknowns alone.
            return is_open.then(|| found.seen.clone());
        }
        for _ in 0..LOOKS {
            let place = in_doubt(&known, [from, from + whole], close, descent.kinks)?;
            let look = self.look(problem, newton, descent, place)?;
            let height = descent.height(&look);
            looks.push(look.clone());
            let height = height?;
            if height < 0.0 {
                return Some(look.seen);
            }
            let next = known.iter().position(|other| other.place > place)?;
            known.insert(next, Height { place, height });
        }
        None
    }

    /// The orbit at a place of a step, with its test functions.
    fn look(
        &self,
        problem: &mut dyn BranchProblem,
        newton: &mut Newton,
        descent: &Descent<'_>,
        place: f64,
    ) -> Option<Look> {
        let ends = step_between(descent.between);
        let part = (place - descent.from) / descent.whole;
        // What is only looked at leaves the walk as it is.
        let contraction = newton.contraction();
        let point = inside(problem.equations(), newton, ends, part, self.options.newton);
        newton.remember_contraction(contraction);
        let point = point?;
        let begin = descent.between[0];
        let on_way = is_on_way(newton, ends, &point);
        let seen = Seen::at(problem, &point, begin.falls);
        let mut pairs = seen.values.iter().zip(&begin.values);
        // A part without a value would hide what changes its sign there.
        let is_whole = pairs.all(|(here, there)| here.is_known() || !there.is_known());
        Some(Look {
            place,
            seen,
            on_way,
            is_whole,
        })
    }

    /// Orbits before and behind the turn in a step in which the bordered determinant changes its sign too, if it does so beside the turn. `None` too where
    /// orbits are not known well enough to tell.
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
        let length = newton.norm().length(step.before.scale, &step.difference());
        let along = ArcLength::from(newton, step.before);
        let wanted = problem.vanishing();
        for width in BESIDE {
            let options = NewtonOptions {
                tolerance: (KNOWN * width * length).min(self.options.newton.tolerance),
                ..self.options.newton
            };
            let turn = locate(problem, newton, step, options, wanted, |problem, at| {
                problem.slope(at)
            })?;
            let place = along.at(&turn.point.u) / along.at(&step.next.u);
            let mut beside = |width: f64| {
                let part = place + width;
                let point = inside(problem.equations(), newton, step, part, options)?;
                Some(Seen::at(problem, &point, pair[0].falls))
            };
            let width = width.min(0.5 * place).min(0.5 * (1.0 - place));
            let found = [beside(-width)?, beside(width)?];
            let slopes = found.each_ref().map(|seen| seen.point.parameter_slope());
            // What Newton's method leaves hides where the branch turns.
            if turn.test.abs() > MIDDLE * slopes[0].abs().min(slopes[1].abs()) {
                return None;
            }
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

/// Below this a test function is rounding.
pub(super) fn noise_of(problem: &dyn BranchProblem, test: Test, at: &Seen) -> f64 {
    match test {
        Test::Slope => at.point.narrowness() * problem.vanishing(),
        Test::Watched(index) => problem.noise(index).max(problem.vanishing()),
    }
}

/// All test functions.
pub(super) fn tests(problem: &dyn BranchProblem) -> impl Iterator<Item = Test> + use<> {
    let watched = (0..problem.watched().len()).map(Test::Watched);
    [Test::Slope].into_iter().chain(watched)
}

/// A function that may pass zero twice within a step.
#[derive(Debug, Clone, Copy)]
enum Sought {
    Test(Test),
    /// That of two pairs of multipliers, whose moduli tell it afterwards.
    Meeting(Meeting),
}

/// All that are looked at from an orbit on.
fn sought_from(problem: &dyn BranchProblem, seen: &Seen) -> Vec<Sought> {
    let meetings = meetings(problem, seen);
    tests(problem).map(Sought::Test).chain(meetings).collect()
}

/// Those of them that are of multipliers.
fn of_multipliers(problem: &dyn BranchProblem, seen: &Seen) -> Vec<Sought> {
    let watched = 0..problem.watched().len();
    let of_map = watched.filter(|index| problem.is_of_multipliers(*index));
    let of_map = of_map.map(|index| Sought::Test(Test::Watched(index)));
    of_map.chain(meetings(problem, seen)).collect()
}

/// All pairs of multipliers beside each other.
fn meetings(problem: &dyn BranchProblem, seen: &Seen) -> impl Iterator<Item = Sought> + use<> {
    let moduli = moduli(problem).next();
    let meetings = moduli.map(|index| Meeting::all(seen, problem.noise(index)));
    meetings.into_iter().flatten().map(Sought::Meeting)
}

/// The moduli of multipliers among what is watched.
fn moduli(problem: &dyn BranchProblem) -> impl Iterator<Item = usize> + use<'_> {
    let watched = problem.watched().iter().enumerate();
    let moduli = watched.filter(|(_, watched)| watched.kind == EventKind::NeimarkSacker);
    moduli.map(|(index, _)| index)
}

impl Sought {
    fn value(self, seen: &Seen) -> TestValue {
        match self {
            Self::Test(test) => seen.value(test),
            Self::Meeting(meeting) => meeting.value(seen),
        }
    }

    /// What falls steeply and is not of multipliers alone is that of a branch which bends, or which another one crosses: tangents tell little of
    /// which way it goes there.
    fn may_have_kinks(self, problem: &dyn BranchProblem) -> bool {
        match self {
            Self::Test(Test::Slope) => false,
            Self::Test(Test::Watched(index)) => problem.is_of_multipliers(index),
            Self::Meeting(_) => true,
        }
    }

    /// Whether another one tells the same between these points.
    fn is_copy(self, problem: &dyn BranchProblem, points: [&Seen; 2]) -> bool {
        matches!(self, Self::Test(test) if is_conjugate(problem, points, test))
    }

    /// Whether the parts of a step show already what it would tell.
    fn is_seen(self, problem: &dyn BranchProblem, parts: &[Seen], earlier: &Seen) -> bool {
        match self {
            Self::Test(test) => {
                is_hidden(problem, parts, test) || self.is_copy(problem, [earlier, &parts[0]])
            }
            Self::Meeting(_) => {
                let mut moduli = moduli(problem);
                moduli.any(|index| is_hidden(problem, parts, Test::Watched(index)))
            }
        }
    }

    /// Whether a step behind so many points was divided for it.
    fn is_among(self, divided: &[(usize, Test)], after: usize) -> bool {
        matches!(self, Self::Test(test) if divided.contains(&(after, test)))
    }
}

/// Whether a test function has one sign at both ends of a step and the other one inside.
fn is_hidden(problem: &dyn BranchProblem, parts: &[Seen], test: Test) -> bool {
    let [first, inner @ .., last] = parts else {
        return false;
    };
    let differ = |ends: [&Seen; 2]| signs(problem, ends, test).map(|[x, y]| x != y);
    differ([first, last]) == Some(false)
        && inner.iter().any(|seen| differ([first, seen]) == Some(true))
}

/// Whether it is the modulus of the second of a pair, which tells what that of the first does.
fn is_conjugate(problem: &dyn BranchProblem, points: [&Seen; 2], test: Test) -> bool {
    let Test::Watched(index) = test else {
        return false;
    };
    let watched = problem.watched();
    let of_modulus = |index: usize| watched[index].kind == EventKind::NeimarkSacker;
    index > 0
        && of_modulus(index)
        && of_modulus(index - 1)
        && points
            .iter()
            .all(|seen| seen.values[index] == seen.values[index - 1])
}

/// In which of two steps an orbit is looked for.
#[derive(Debug, Clone, Copy)]
enum Within {
    Both,
    First,
    /// Of the first, whose first point has other unknowns, the length is known and no orbit.
    Last(f64),
}

/// Where an orbit of the other sign was found.
enum Dip {
    /// In the last step.
    Last(Seen),
    /// In the one before.
    Before(Seen),
}

/// An orbit that was looked at within two steps.
#[derive(Clone)]
struct Look {
    /// How far it is behind the first point.
    place: f64,
    seen: Seen,
    /// Its tangent leads along the step.
    on_way: bool,
    /// All that is known where the step begins is known of it.
    is_whole: bool,
}

/// A step in which a test function may come down to zero.
struct Descent<'s> {
    between: [&'s Seen; 2],
    /// Where it begins, and its length.
    from: f64,
    whole: f64,
    sought: Sought,
    kinks: bool,
    sign: f64,
    reference: f64,
}

impl Descent<'_> {
    /// How far the function is above zero at an orbit; `None` where that tells nothing.
    fn height(&self, look: &Look) -> Option<f64> {
        let tells = look.is_whole && (look.on_way || !self.kinks);
        let value = tells.then(|| self.sought.value(&look.seen))?;
        let height = self.sign * value.relative_to(self.reference);
        (!height.is_nan()).then_some(height)
    }

    fn is_within(&self, place: f64) -> bool {
        place > self.from && place < self.from + self.whole
    }
}

/// The step from one orbit to another.
pub(super) fn step_between([a, b]: [&Seen; 2]) -> Step<'_> {
    Step {
        before: &a.point,
        next: &b.point,
    }
}

/// Whether the tangent of an orbit within a step leads along its chord as those of both ends do. Where a branch bends by more than that, which way it
/// goes at an orbit is not known, and with it the signs of determinants.
pub(super) fn is_on_way(newton: &Newton, step: Step<'_>, found: &CurvePoint) -> bool {
    let (chord, scale) = (step.difference(), step.before.scale);
    let along = |at: &CurvePoint| newton.norm().product(scale, &at.tangent, &chord);
    let [a, b, here] = [step.before, step.next, found].map(along);
    here * a > 0.0 && here * b > 0.0
}

/// Puts an orbit to its place among the parts of a step: where the way by it is hardly longer. No arc length tells that where the branch bends.
pub(super) fn insert(newton: &Newton, parts: &mut Vec<Seen>, found: Seen) {
    let scale = parts[0].point.scale;
    let apart = |a: &Seen, b: &Seen| {
        let pairs = a.point.u.iter().zip(&b.point.u);
        let difference: Vec<f64> = pairs.map(|(x, y)| x - y).collect();
        newton.norm().length(scale, &difference)
    };
    let detours = parts
        .windows(2)
        .map(|pair| apart(&pair[0], &found) + apart(&found, &pair[1]) - apart(&pair[0], &pair[1]));
    let least = detours.enumerate().min_by(|a, b| a.1.total_cmp(&b.1));
    parts.insert(least.map_or(1, |(place, _)| place + 1), found);
}

/// How far a point is behind another one.
pub(super) fn distance(newton: &Newton, a: &CurvePoint, b: &CurvePoint) -> f64 {
    ArcLength::from(newton, a).at(&b.u)
}
