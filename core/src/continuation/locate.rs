//! Locating where a test function vanishes between two points of a curve.
//!
//! The curve between them is parametrised by the arc length `s` of the chord's first tangent; every value of the test
//! function is taken at a corrected solution. Where to look next is what [`Bracket`] says.

use super::follow::{CurvePoint, Step};
use super::problem::{AsProblem, Problem, Scale};
use crate::continuation::newton::{Border, Newton, NewtonOptions};
use crate::numeric::linear::dot;
use crate::numeric::roots::{Bracket, Place, STEPS};

/// A point where the test function vanishes.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Located {
    pub(crate) point: CurvePoint,
    /// Value of the test function there.
    pub(crate) test: f64,
    /// Whether it was driven to zero; otherwise it jumps here.
    pub(crate) vanishes: bool,
    /// By how much, as two points tell that are as near to each other as can be; infinite where the search ended before, or where they are on
    /// different branches.
    pub(crate) jump: f64,
}

/// Parts of a bracket that are tried where corrections fail in the middle of it.
const ASIDE: [f64; 4] = [0.1, 0.9, 0.02, 0.98];
/// So often at most.
const MOST_ASIDE: usize = 60;
/// Points on both sides of a jump of the test function are on one branch if this part of the step at most is between them.
const CLOSE: f64 = 1e-3;
/// Where the search along the first tangent is lost, and that has less than this part of the step along itself, the chord is followed.
const SLANTED: f64 = 0.5;
/// Points closer together than this part of the arc length are the same.
const CLOSEST: f64 = 1e-14;

/// Where a test function changes sign between two points: its zero, or the place where it jumps.
///
/// `None` if corrections fail on the way, or a tangent is not that of the whole system.
pub(crate) fn locate<P: AsProblem + ?Sized>(
    problem: &mut P,
    newton: &mut Newton,
    step: Step<'_>,
    options: NewtonOptions,
    tolerance: f64,
    test: impl FnMut(&mut P, &CurvePoint) -> f64,
) -> Option<Located> {
    search(problem, newton, step, options, tolerance, &[], test)
}

/// The same where corrections may fail in the middle of a step, as where unknowns move as a root: other places near its ends are tried then.
pub(crate) fn locate_beside<P: AsProblem + ?Sized>(
    problem: &mut P,
    newton: &mut Newton,
    step: Step<'_>,
    options: NewtonOptions,
    tolerance: f64,
    test: impl FnMut(&mut P, &CurvePoint) -> f64,
) -> Option<Located> {
    search(problem, newton, step, options, tolerance, &ASIDE, test)
}

/// The same, where the curve is told by a linear form that grows along it, as where it bends so sharply that no arc length does.
pub(crate) fn locate_along<P: AsProblem + ?Sized>(
    problem: &mut P,
    newton: &mut Newton,
    step: Step<'_>,
    form: Vec<f64>,
    options: NewtonOptions,
    tolerance: f64,
    mut test: impl FnMut(&mut P, &CurvePoint) -> f64,
) -> Option<Located> {
    let arc = ArcLength::along_form(form, step);
    // Tangents of the ends go with the form, too.
    let mut end = |at: &CurvePoint| {
        let s = arc.at(&at.u);
        let point = arc.corrected(problem.problem(), newton, at.u.clone(), s, options)?;
        let value = test(problem, &point);
        Some((point, value))
    };
    let (before, next) = (end(step.before)?, end(step.next)?);
    if (before.1 > 0.0) == (next.1 > 0.0) {
        return None;
    }
    let step = Step {
        before: &before.0,
        next: &next.0,
    };
    let way = Way {
        arc: &arc,
        length: arc.at(&next.0.u),
        step,
    };
    search_along(problem, newton, way, options, tolerance, &[], test)
}

fn search<P: AsProblem + ?Sized>(
    problem: &mut P,
    newton: &mut Newton,
    step: Step<'_>,
    options: NewtonOptions,
    tolerance: f64,
    others: &[f64],
    mut test: impl FnMut(&mut P, &CurvePoint) -> f64,
) -> Option<Located> {
    let arc = ArcLength::from(newton, step.before);
    let way = Way {
        arc: &arc,
        length: arc.length(newton, step.before, step.next),
        step,
    };
    let found = search_along(problem, newton, way, options, tolerance, others, &mut test);
    let is_lost = |found: &Located| !found.vanishes && found.jump.is_infinite();
    let (before, chord) = (step.before, step.difference());
    if !found.as_ref().is_none_or(is_lost)
        || way.length > SLANTED * newton.norm().length(before.scale, &chord)
    {
        return found;
    }
    // Beside a touch from which the branch goes as a root its tangent tells nothing of where it goes; the chord does.
    let mut form = vec![0.0; chord.len()];
    newton.norm().linear_form(before.scale, &chord, &mut form);
    let along = locate_along(problem, newton, step, form, options, tolerance, test);
    // A form may have its value on another part of the branch, too.
    let whole = arc.apart(newton, &step.before.u, &step.next.u);
    let is_inside = |along: &Located| arc.apart(newton, &step.before.u, &along.point.u) <= whole;
    along
        .filter(|along| !is_lost(along) && is_inside(along))
        .or(found)
}

/// A step, and what tells a place in it.
#[derive(Clone, Copy)]
struct Way<'w> {
    arc: &'w ArcLength,
    /// Where the step ends.
    length: f64,
    step: Step<'w>,
}

fn search_along<P: AsProblem + ?Sized>(
    problem: &mut P,
    newton: &mut Newton,
    Way { arc, length, step }: Way<'_>,
    options: NewtonOptions,
    tolerance: f64,
    others: &[f64],
    mut test: impl FnMut(&mut P, &CurvePoint) -> f64,
) -> Option<Located> {
    let Step { before: a, next: b } = step;
    let mut side = |x, point: &CurvePoint| Side {
        place: Place {
            x,
            value: test(problem, point),
        },
        point: point.clone(),
    };
    let (mut far, mut near) = (side(0.0, a), side(length, b));
    let mut bracket = Bracket::new(far.place, near.place, CLOSEST * length.abs());
    let mut aside = 0;
    for _ in 0..STEPS {
        let mut at = |part: f64, near_by: bool| {
            let s = bracket.at(part);
            let trial = between([&near, &far], s, arc);
            let known = near_by.then(|| trial.clone());
            let point = arc.corrected(problem.problem(), newton, trial, s, options)?;
            let moved = known.map_or(0.0, |known| arc.apart(newton, &point.u, &known));
            (moved <= length.abs()).then_some((s, point))
        };
        let part = bracket.part();
        // Where a correction fails, another place may do, as long as it leads to an orbit beside those that are known.
        let found = at(part, false).or_else(|| at(0.5 * part + 0.2, false));
        aside += usize::from(found.is_none());
        let found = found.or_else(|| others.iter().find_map(|part| at(*part, true)));
        let (x, point) = found.filter(|_| aside <= MOST_ASIDE)?;
        let value = test(problem, &point);
        if value.abs() <= tolerance {
            return Some(Located {
                point,
                test: value,
                vanishes: true,
                jump: 0.0,
            });
        }
        let place = Place { x, value };
        let last = std::mem::replace(&mut near, Side { place, point });
        if bracket.take(place) {
            far = last;
        }
        if bracket.is_closed() {
            break;
        }
    }
    if aside > 0 && !bracket.is_closed() {
        return None;
    }
    let between = arc.apart(newton, &near.point.u, &far.point.u);
    let jump = if bracket.is_closed() && between < CLOSE * arc.apart(newton, &a.u, &b.u) {
        near.place.value.abs() + far.place.value.abs()
    } else {
        f64::INFINITY
    };
    let last = if bracket.near_is_best() { near } else { far };
    Some(Located {
        vanishes: false,
        jump,
        test: last.place.value,
        point: last.point,
    })
}

/// The point of the curve at a part of a step, as the arc length along the first tangent tells.
///
/// `None` if the correction fails.
pub(crate) fn inside(
    problem: &mut dyn Problem,
    newton: &mut Newton,
    step: Step<'_>,
    part: f64,
    options: NewtonOptions,
) -> Option<CurvePoint> {
    let arc = ArcLength::from(newton, step.before);
    let length = arc.length(newton, step.before, step.next);
    inside_by(problem, newton, step, &arc, length, part, options)
}

/// The same, as the arc length [over](ArcLength::over) the step tells.
pub(crate) fn inside_over(
    problem: &mut dyn Problem,
    newton: &mut Newton,
    step: Step<'_>,
    part: f64,
    options: NewtonOptions,
) -> Option<CurvePoint> {
    let arc = ArcLength::over(newton, step);
    let length = arc.at(&step.next.u);
    inside_by(problem, newton, step, &arc, length, part, options)
}

fn inside_by(
    problem: &mut dyn Problem,
    newton: &mut Newton,
    Step { before: a, next: b }: Step<'_>,
    arc: &ArcLength,
    length: f64,
    part: f64,
    options: NewtonOptions,
) -> Option<CurvePoint> {
    let value = f64::NAN;
    let [from, to] = [(0.0, a), (length, b)].map(|(x, point)| Side {
        place: Place { x, value },
        point: point.clone(),
    });
    let trial = between([&from, &to], part * length, arc);
    arc.corrected(problem, newton, trial, part * length, options)
}

/// The parameter of the curve behind a point: the arc length along the tangent there.
pub(crate) struct ArcLength {
    border: Vec<f64>,
    /// The linear form at the point.
    origin: f64,
    scale: Scale,
}

impl ArcLength {
    pub(crate) fn from(newton: &Newton, a: &CurvePoint) -> Self {
        let mut border = vec![0.0; a.u.len()];
        newton.norm().linear_form(a.scale, &a.tangent, &mut border);
        Self {
            origin: dot(&border, &a.u),
            border,
            scale: a.scale,
        }
    }

    /// Along the tangent before a step, or along its chord where that tangent hardly leads to its end, as at a touch from which unknowns go as a root. It
    /// grows the way that the tangents do. Where one goes along the chord and the other one against it, the chord is not the way: the point before may be in
    /// unknowns that it was not solved in.
    pub(crate) fn over(newton: &Newton, step: Step<'_>) -> Self {
        let Step { before, next } = step;
        let (norm, scale, chord) = (newton.norm(), before.scale, step.difference());
        let [first, last] = [before, next].map(|at| norm.product(scale, &at.tangent, &chord));
        let whole = norm.length(scale, &chord);
        let leads = first.abs() > SLANTED * whole || last.abs() < first.abs();
        let is_way = whole > 0.0 && first * last >= 0.0;
        if leads || !is_way {
            return Self::from(newton, before);
        }
        let mut border = vec![0.0; chord.len()];
        norm.linear_form(scale, &chord, &mut border);
        for x in &mut border {
            *x *= last.signum() / whole;
        }
        Self {
            origin: dot(&border, &before.u),
            border,
            scale,
        }
    }

    /// From so far before its first point on.
    pub(crate) fn behind(self, way: f64) -> Self {
        Self {
            origin: self.origin - way,
            ..self
        }
    }

    /// Along a form, which grows over the step.
    fn along_form(mut border: Vec<f64>, Step { before, next }: Step<'_>) -> Self {
        let rise = dot(&border, &next.u) - dot(&border, &before.u);
        for x in &mut border {
            *x *= rise.signum();
        }
        Self {
            origin: dot(&border, &before.u),
            border,
            scale: before.scale,
        }
    }

    /// Where another point is.
    fn length(&self, newton: &Newton, a: &CurvePoint, b: &CurvePoint) -> f64 {
        let difference: Vec<f64> = b.u.iter().zip(&a.u).map(|(x, y)| x - y).collect();
        newton.norm().product(self.scale, &a.tangent, &difference)
    }

    /// The same, from the linear form.
    pub(crate) fn at(&self, u: &[f64]) -> f64 {
        dot(&self.border, u) - self.origin
    }

    /// How far two points are apart.
    fn apart(&self, newton: &Newton, u: &[f64], v: &[f64]) -> f64 {
        let difference: Vec<f64> = u.iter().zip(v).map(|(x, y)| x - y).collect();
        newton.norm().length(self.scale, &difference)
    }

    /// How fast it grows in a direction.
    pub(super) fn along(&self, direction: &[f64]) -> f64 {
        dot(&self.border, direction)
    }

    /// What holds a solution where it is.
    pub(super) fn border_at(&self, u: &[f64]) -> Border<'_> {
        Border {
            row: &self.border,
            value: dot(&self.border, u),
        }
    }

    /// What holds a solution at a place.
    pub(super) fn border(&self, s: f64) -> Border<'_> {
        Border {
            row: &self.border,
            value: self.origin + s,
        }
    }

    /// The solution near `u` at a place, with the tangent of the whole system.
    fn corrected(
        &self,
        problem: &mut dyn Problem,
        newton: &mut Newton,
        mut u: Vec<f64>,
        s: f64,
        options: NewtonOptions,
    ) -> Option<CurvePoint> {
        let scale = self.scale;
        newton
            .correct(problem, &mut u, self.border(s), scale, options)
            .ok()?;
        let mut tangent = vec![0.0; u.len()];
        if !newton.tangent(problem, &u, &mut tangent, true) {
            return None;
        }
        let norm = newton.norm().length(scale, &tangent);
        for t in &mut tangent {
            *t /= norm;
        }
        Some(CurvePoint { u, tangent, scale })
    }
}

/// A point at one side of the zero.
struct Side {
    /// Arc length and test function.
    place: Place,
    point: CurvePoint,
}

/// The cubic through two points with their tangents; a straight line where a tangent hardly follows the arc length.
fn between([a, b]: [&Side; 2], s: f64, arc: &ArcLength) -> Vec<f64> {
    let width = b.place.x - a.place.x;
    let x = (s - a.place.x) / width;
    let ahead = |side: &Side| arc.along(&side.point.tangent);
    let (first, last) = (ahead(a), ahead(b));
    let (share, start, end) = if first.min(last) > 0.5 * first.max(last) {
        let y = 1.0 - x;
        (
            x * x * (3.0 - 2.0 * x),
            x * y * y * width / first,
            -x * x * y * width / last,
        )
    } else {
        (x, 0.0, 0.0)
    };
    let points = a.point.u.iter().zip(&b.point.u);
    let tangents = a.point.tangent.iter().zip(&b.point.tangent);
    points
        .zip(tangents)
        .map(|((p, q), (t, r))| p + share * (q - p) + start * t + end * r)
        .collect()
}
