//! What lies between two points that the signs of test functions at both do not show.
//!
//! A function that has one sign at both ends of a step may have passed zero twice: two folds, or two bifurcations of a kind. With a second
//! difference `c` that is at most so large between two points, `l` apart with heights `p` and `q` above zero, it stays above
//!
//! ```text
//! p + (q - p) s / l - c s (l - s)                                                                            (1)
//! ```
//!
//! The second difference of three successive points is trusted to a factor. Where a level is touched between two points the function may have a
//! kink, to which no second difference is a bound. If it is convex all the same it stays above the chords of the parts beside. It need not be, and
//! falls the faster the nearer to the kink then: with slopes `m < 0` before and `n > 0` behind, or that of the part where that is steeper, both times `t = 2`,
//! it is looked at if
//!
//! ```text
//! p + t m s,     q - t n (l - s),                                                                              (2)
//! ```
//!
//! which meet where `s = (q - p - t n l) / (t (m - n))`, come down to zero. Where (1) or (2) comes down to zero, the orbit there is computed, and both parts are looked at
//! with the differences that are known then, until one has the other sign or all stay above. It may be in the step before the last one, since a
//! point beside the second zero says nothing until the next one is known.
//!
//! Where a branch turns and the bordered determinant changes its sign as well, that is one place, where it ends on another branch, or
//! two, a fold and a crossing: orbits on both sides of the turn tell.
//!
//! Source: (1) is the error bound of linear interpolation, as Piyavskii (1972), An algorithm for finding the absolute extremum of a
//! function, uses it with a bound on the first derivative. (2), with `t = 1`, are the two lines below a convex function of Rote (1992), The convergence rate of
//! the sandwich algorithm for approximating convex functions.

use super::Engine;
use super::meeting::Meeting;
use super::seen::{Former, Seen, changes, signs};
use crate::branches::problem::{BranchProblem, Change, Test, TestValue};
use crate::continuation::follow::{CurvePoint, Step};
use crate::continuation::locate::{ArcLength, inside, locate};
use crate::continuation::newton::{Newton, NewtonOptions};
use crate::event::EventKind;

/// A second difference may be so many times as large between the points that it was taken of.
const TRUSTED: f64 = 3.0;
/// `t` of (2)
const STEEPER: f64 = 2.0;
/// So many orbits, and until they come this near to each other, as a part of the step.
pub(super) const LOOKS: usize = 6;
pub(super) const CLOSE: f64 = 1e-3;
/// The nearest that an orbit is looked for to another one, as a part of what lies between two.
const ASIDE: f64 = 0.15;
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
        self.divide_parts(problem, newton, &mut parts);
        if let Some(earlier) = earlier {
            for sought in sought_from(problem, &parts[0]) {
                if sought.is_seen(problem, &parts, earlier) {
                    continue;
                }
                let points = [earlier, &parts[0], &parts[parts.len() - 1]];
                match self.dip(problem, newton, points, None, sought) {
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
        if let Some(former) = self.former.take() {
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

    /// Divides the first step behind a point that has other unknowns, as far as multipliers tell: what else there is to compare is of the
    /// equations.
    fn divide_behind(
        &self,
        problem: &mut dyn BranchProblem,
        newton: &mut Newton,
        former: Former,
        parts: &mut Vec<Seen>,
    ) {
        let way = former.way;
        let earlier = former.before(&parts[0]);
        for sought in of_multipliers(problem, &parts[0]) {
            if sought.is_seen(problem, parts, &earlier) {
                continue;
            }
            let points = [&earlier, &parts[0], &parts[parts.len() - 1]];
            if let Some(Dip::Last(found)) = self.dip(problem, newton, points, Some(way), sought) {
                insert(newton, parts, found);
            }
        }
    }

    /// Divides parts of one step where a function passes zero twice in one of them, as far as three of their ends tell.
    fn divide_parts(
        &self,
        problem: &mut dyn BranchProblem,
        newton: &mut Newton,
        parts: &mut Vec<Seen>,
    ) {
        let mut middle = 1;
        while middle + 1 < parts.len() {
            for sought in sought_from(problem, &parts[middle]) {
                let points = [middle - 1, middle, middle + 1].map(|place| &parts[place]);
                let (found, place) = match self.dip(problem, newton, points, None, sought) {
                    Some(Dip::Last(found)) => (found, middle + 1),
                    Some(Dip::Before(found)) => (found, middle),
                    None => continue,
                };
                parts.insert(place, found);
                middle += 1;
                break;
            }
            middle += 1;
        }
    }

    /// Notes for which test functions the parts of a step show what its ends do not.
    fn note_divided(&mut self, problem: &dyn BranchProblem, parts: &[Seen], after: usize) {
        for test in tests(problem) {
            if is_hidden(problem, parts, test) && !self.divided.contains(&(after, test)) {
                self.divided.push((after, test));
            }
        }
    }

    /// Records what an orbit shows inside of a step and its ends do not.
    fn record_pair(
        &mut self,
        problem: &mut dyn BranchProblem,
        newton: &mut Newton,
        parts: &[Seen],
        after: usize,
    ) {
        let known = self.divided.clone();
        let hidden: Vec<Test> = tests(problem)
            .filter(|test| is_hidden(problem, parts, *test) && !known.contains(&(after, *test)))
            .collect();
        let wanted = |change: &Change| hidden.contains(&change.test);
        for pair in parts.windows(2) {
            self.record_all(problem, newton, [&pair[0], &pair[1]], after, wanted);
            if self.ended.is_some() {
                return;
            }
        }
        self.note_divided(problem, parts, after);
    }

    /// Records what orbits within a step show, and others between these, and its ends do not.
    pub(super) fn record_between(
        &mut self,
        problem: &mut dyn BranchProblem,
        newton: &mut Newton,
        [a, b]: [Seen; 2],
        inner: Vec<Seen>,
        after: usize,
    ) {
        let mut parts = vec![a, b];
        for seen in inner {
            insert(newton, &mut parts, seen);
        }
        if !tests(problem).any(|test| is_hidden(problem, &parts, test)) {
            return;
        }
        self.divide_parts(problem, newton, &mut parts);
        self.record_pair(problem, newton, &parts, after);
    }

    /// An orbit inside one of two steps where a test function has the other sign than at all their ends. Where the first point has other
    /// unknowns, the length of the `former` step is known and no orbit of it.
    fn dip(
        &self,
        problem: &mut dyn BranchProblem,
        newton: &mut Newton,
        points: [&Seen; 3],
        former: Option<f64>,
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
        let lengths = [former.unwrap_or_else(|| length(0)), length(1)];
        let places = [0.0, lengths[0], lengths[0] + lengths[1]];
        let known = [0, 1, 2].map(|i| Height {
            place: places[i],
            height: heights[i],
        });
        let noise = match sought {
            Sought::Test(test) => noise_of(problem, test, points[1]),
            Sought::Meeting(_) => 0.0,
        };
        let steps = if former.is_some() { &[1][..] } else { &[1, 0] };
        for &first in steps {
            let descent = Descent {
                between: [points[first], points[first + 1]],
                from: places[first],
                whole: lengths[first],
                sought,
                sign,
                reference,
            };
            if heights[first].min(heights[first + 1]) <= noise {
                continue;
            }
            if let Some(found) = self.lowest(problem, newton, &descent, &known) {
                return Some(if first == 1 {
                    Dip::Last(found)
                } else {
                    Dip::Before(found)
                });
            }
        }
        None
    }

    /// An orbit of the other sign in a step, if (1) does not exclude it.
    fn lowest(
        &self,
        problem: &mut dyn BranchProblem,
        newton: &mut Newton,
        descent: &Descent<'_>,
        known: &[Height; 3],
    ) -> Option<Seen> {
        let Descent {
            between,
            from,
            whole,
            ..
        } = *descent;
        let ends = step_between(between);
        let mut known = known.to_vec();
        // What falls steeply and is not of multipliers alone is that of a branch which bends, or which another one crosses: tangents tell little of
        // which way it goes there.
        let kinks = match descent.sought {
            Sought::Test(Test::Slope) => false,
            Sought::Test(Test::Watched(index)) => problem.is_of_multipliers(index),
            Sought::Meeting(_) => true,
        };
        for _ in 0..LOOKS {
            let place = in_doubt(&known, [from, from + whole], CLOSE * whole, kinks)?;
            let options = self.options.newton;
            let part = (place - from) / whole;
            // What is only looked at leaves the walk as it is.
            let contraction = newton.contraction();
            let point = inside(problem.equations(), newton, ends, part, options);
            newton.remember_contraction(contraction);
            let point = point?;
            if kinks && !is_on_way(newton, ends, &point) {
                return None;
            }
            let seen = Seen::at(problem, &point, between[0].falls);
            let mut pairs = seen.values.iter().zip(&between[0].values);
            if pairs.any(|(here, there)| there.is_known() && !here.is_known()) {
                // A part without a value would hide what changes its sign there.
                return None;
            }
            let height = descent.sign * descent.sought.value(&seen).relative_to(descent.reference);
            if height.is_nan() {
                return None;
            }
            if height < 0.0 {
                return Some(seen);
            }
            let next = known.iter().position(|other| other.place > place)?;
            known.insert(next, Height { place, height });
        }
        None
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
fn tests(problem: &dyn BranchProblem) -> impl Iterator<Item = Test> + use<> {
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

    /// Whether the parts of a step show already what it would tell.
    fn is_seen(self, problem: &dyn BranchProblem, parts: &[Seen], earlier: &Seen) -> bool {
        match self {
            Self::Test(test) => {
                is_hidden(problem, parts, test) || is_conjugate(problem, [earlier, &parts[0]], test)
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

/// Where an orbit of the other sign was found.
enum Dip {
    /// In the last step.
    Last(Seen),
    /// In the one before.
    Before(Seen),
}

/// How far a test function is above zero at a place along the branch.
#[derive(Debug, Clone, Copy)]
pub(super) struct Height {
    pub(super) place: f64,
    pub(super) height: f64,
}

/// A step in which a test function may come down to zero.
struct Descent<'s> {
    between: [&'s Seen; 2],
    /// Where it begins, and its length.
    from: f64,
    whole: f64,
    sought: Sought,
    sign: f64,
    reference: f64,
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
fn insert(newton: &Newton, parts: &mut Vec<Seen>, found: Seen) {
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

/// Where (1), or (2) if there may be kinks, comes down lowest in an interval, below zero, between known heights that are not too close.
pub(super) fn in_doubt(
    known: &[Height],
    [from, to]: [f64; 2],
    close: f64,
    kinks: bool,
) -> Option<f64> {
    let differences: Vec<f64> = known.windows(3).map(second_difference).collect();
    let mut deepest: Option<Height> = None;
    for (i, pair) in known.windows(2).enumerate() {
        let (a, b) = (pair[0], pair[1]);
        if a.place < from || b.place > to || b.place - a.place < 2.0 * close {
            continue;
        }
        let beside = [i.checked_sub(1), Some(i)];
        let beside = beside.into_iter().flatten();
        let differences = beside.filter_map(|index| differences.get(index));
        let largest = differences.fold(0.0, |largest: f64, c| largest.max(c.abs()));
        let lowest = [
            Some(lowest_between(a, b, TRUSTED * largest)),
            below_chords(known, i).filter(|_| kinks),
        ];
        for lowest in lowest.into_iter().flatten() {
            let lower = |other: &Height| lowest.height < other.height;
            if lowest.height < 0.0 && deepest.as_ref().is_none_or(lower) {
                let aside = ASIDE * (b.place - a.place);
                let place = lowest.place.clamp(a.place + aside, b.place - aside);
                deepest = Some(Height { place, ..lowest });
            }
        }
    }
    deepest.map(|deepest| deepest.place)
}

/// Slope from one height to the next.
fn chord(pair: &[Height]) -> f64 {
    (pair[1].height - pair[0].height) / (pair[1].place - pair[0].place)
}

/// Second divided difference of three heights.
fn second_difference(known: &[Height]) -> f64 {
    (chord(&known[1..]) - chord(&known[..2])) / (known[2].place - known[0].place)
}

/// The lowest place of (2) between a height and the next one. Where one chord alone is known, that is half of the way that it is below zero.
fn below_chords(known: &[Height], i: usize) -> Option<Height> {
    let (a, b) = (known[i], known[i + 1]);
    let l = b.place - a.place;
    let before = i.checked_sub(1).map(|first| chord(&known[first..=i]));
    let behind = known.get(i + 1..i + 3).map(chord);
    let (s, height) = match (before, behind) {
        (Some(m), Some(n)) => {
            let own = (b.height - a.height) / l;
            let steep = [m.min(own), n.max(own)];
            let falls = steep[0] < 0.0 && steep[1] > 0.0;
            let [m, n] = if falls {
                steep.map(|slope| STEEPER * slope)
            } else {
                [m, n]
            };
            let s = (b.height - a.height - n * l) / (m - n);
            (s, a.height + m * s)
        }
        (Some(m), None) => (0.5 * (l - a.height / m), 0.5 * (a.height + m * l)),
        (None, Some(n)) => (0.5 * (l - b.height / n), 0.5 * (b.height - n * l)),
        (None, None) => return None,
    };
    (s > 0.0 && s < l).then_some(Height {
        place: a.place + s,
        height,
    })
}

/// The lowest place of (1) inside an interval; one of its ends if it falls or rises all along.
fn lowest_between(a: Height, b: Height, c: f64) -> Height {
    let l = b.place - a.place;
    let (p, q) = (a.height, b.height);
    let s = 0.5 * l - 0.5 * (q - p) / (c * l);
    if s > 0.0 && s < l {
        Height {
            place: a.place + s,
            height: p + (q - p) * s / l - c * s * (l - s),
        }
    } else if p < q {
        a
    } else {
        b
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Where a function is found below zero between the last two of three points, or else the number of orbits that were looked at.
    fn below(f: impl Fn(f64) -> f64, places: [f64; 3]) -> Result<f64, usize> {
        below_between(f, places, [places[1], places[2]])
    }

    /// The same between any two of them.
    fn below_between(
        f: impl Fn(f64) -> f64,
        places: [f64; 3],
        step: [f64; 2],
    ) -> Result<f64, usize> {
        let at = |place: f64| Height {
            place,
            height: f(place),
        };
        let mut known: Vec<Height> = places.map(at).into();
        for looks in 0..LOOKS {
            let Some(place) = in_doubt(&known, step, CLOSE * (step[1] - step[0]), true) else {
                return Err(looks);
            };
            if f(place) < 0.0 {
                return Ok(place);
            }
            let next = known.iter().position(|other| other.place > place).unwrap();
            known.insert(next, at(place));
        }
        Err(LOOKS)
    }

    /// Twice the period of a gear: the function falls steeply to a touch just before the last point, and rises from there. A second difference
    /// of three points is less than a third of what there is at the touch.
    #[test]
    fn a_kink_hides_no_pair_of_zeros() {
        let kink =
            |s: f64| (1.15 - 1.6 * s).max(0.17 + 1.1 * (s - 1.0)) + 0.4 * (s * s - s).max(0.0);
        let points = [-1.2, 0.0, 1.0];
        let found = below(kink, points).unwrap();
        assert!((0.7..0.9).contains(&found), "{found}");
        assert!(below(|s| kink(s) + 0.4, points).is_err());
    }

    /// A pair of multipliers of four masses, whose modulus falls the faster the nearer it comes to a kink, where it is below one for a tenth of the step.
    #[test]
    fn a_kink_that_is_come_to_steeply_hides_no_pair_of_zeros() {
        let kink = |s: f64| {
            if s < 0.77 {
                0.365 - 0.5 * (0.77_f64.sqrt() - (0.77 - s).sqrt())
            } else {
                -0.074 + 1.2 * (s - 0.77)
            }
        };
        let points = [0.0, 1.0, 1.3];
        let found = below_between(kink, points, [0.0, 1.0]).unwrap();
        assert!((0.7..0.84).contains(&found), "{found}");
    }

    /// What halves from point to point leads to zero at the next one, and no further.
    #[test]
    fn what_decays_is_not_looked_at() {
        assert_eq!(below(|s| (-0.6 * s).exp(), [0.0, 1.0, 2.0]), Err(0));
    }
}
