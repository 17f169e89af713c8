//! Events of a branch, located again with more nodes until their value does not change.
//!
//! With test function `T` along the curve of the finer equations, at the arc length `s` from the orbit that the coarser ones gave, the secant
//! method finds where `T` vanishes,
//!
//! ```text
//! s_(n+1) = s_n - T(s_n) (s_n - s_(n-1)) / (T(s_n) - T(s_(n-1)))                                               (1)
//! ```
//!
//! and where branches cross, so that the equations are singular, the cubic through four points around does. At a touch `H = 0` is an
//! equation besides, (2) and (3) of [`skeleton`](crate::contact_equation::skeleton). Twice the last change of the value is the error that is stated; nodes are
//! added four times at most. A node beside a kink of its law may change sides at every update of Newton's method, which then goes back and forth and is damped.
//!
//! Source: Press et al. (2007), Numerical Recipes, section 9.2 (secant method) and 9.7 (damping); Berrut and Trefethen (2004), Barycentric Lagrange
//! interpolation, section 2 (the polynomial through points).

use nalgebra::DMatrix;

use super::event_tangent;
use super::method::VANISHED;
use crate::branches::moduli::{self, multipliers};
use crate::branches::point::{Event, Point};
use crate::branches::problem::{Touch, Zero};
use crate::branches::solve;
use crate::branches::stability::Stability;
use crate::contact_equation::equations::Equations;
use crate::contact_equation::linear_part::block::add;
use crate::contact_equation::run::Run;
use crate::contact_equation::run::error_estimate::Screened;
use crate::contact_equation::switches::fits::Fits;
use crate::continuation::follow::{CurvePoint, Step};
use crate::continuation::newton::{Border, Converged, Newton, NewtonError, NewtonOptions};
use crate::continuation::problem::Scale;
use crate::event::EventKind;
use crate::numeric::linear::dot;
use crate::numeric::roots::{self, Place};
use crate::shooting::test_functions::{Test, Tests};

/// An event is known well enough when more nodes change its value by this part of it.
const KNOWN: f64 = 2e-10;
/// It is located so often with more nodes at most.
const FINER: usize = 4;
/// Iterations of the secant method at most.
const SECANTS: usize = 12;
/// The first of them, in units of the orbit.
const APART: f64 = 1e-6;
/// Where a curve is solved for around a point at which branches cross, in this part of the tangent, which is the step at first: the cubic through
/// four points is as exact as the fourth power of that. They begin as far apart in units of the orbit, at least: what rounding leaves grows as
/// its inverse.
const AROUND: [f64; 4] = [-2.0, -1.0, 1.0, 2.0];
const BESIDE: f64 = 5e-3;
const ASIDE: f64 = 5e-4;
/// They come half as near so often at most.
const NEARER: usize = 6;
/// What the last change is multiplied by.
const SAFETY: f64 = 2.0;
/// What rounding leaves in a value, for each period that a motion is carried over.
const ROUNDING: f64 = 8.0 * f64::EPSILON;
/// More nodes move an event by so many times its error before at most; farther away there is another one.
const SAME: f64 = 100.0;
/// What rounding leaves in the value of a touch.
const TOUCHED: f64 = 4e-12;
/// Where branches cross a multiplier is one; none is where all are farther from it than this and ten times their error.
const FAR: f64 = 0.1;
/// Of Newton's method with more nodes.
const OPTIONS: NewtonOptions = NewtonOptions {
    tolerance: 1e-11,
    iterations: 12,
    damped: false,
};
/// Where a node lies beside a kink of its law that no switch is at, updates go back and forth across it. Damped ones may be half as large many times.
const DAMPED: NewtonOptions = NewtonOptions {
    iterations: 40,
    damped: true,
    ..OPTIONS
};
/// An orbit that moves farther, in units of the orbit, is another one.
const FARTHEST: f64 = 0.1;

/// The event at a zero of a test function in a step, with the error that more nodes show.
pub(in crate::contact_equation) fn event(
    run: &mut Run<'_>,
    step: Step<'_>,
    zero: &Zero,
    kind: EventKind,
) -> Option<Event> {
    let at = &zero.root.located.point;
    let test = Test::of(zero.change.test);
    let periods = run.problem.asked.period;
    let read = run.read_event(at)?;
    let mut event = Event {
        kind,
        point: read.point,
        error: SAFETY * read.shift.abs() + zero.root.error,
        test: zero.root.located.test,
        after: zero.after,
        contacts: 0,
        tangent: Vec::new(),
    };
    let crosses = zero.change.kind == EventKind::BranchPoint;
    let again = if crosses {
        located_again(run, &along(at, step), test, crossing)
    } else {
        located_again(run, at, test, again)
    };
    let ways = step.parameters().map(|end| (end - at.parameter()).abs());
    let way = ways[0].max(ways[1]);
    // Farther away than the step it is another one.
    let is_same = |again: &Again| {
        let moved = (again.point.parameter() - at.parameter()).abs();
        let known = KNOWN * at.parameter().abs();
        let error = if event.error.is_finite() {
            event.error
        } else {
            0.0
        };
        moved <= way + known + SAME * error
    };
    let Some(mut again) = again.filter(is_same) else {
        let finer = read.finer.as_ref().map(|map| {
            let there = Tests::of(Some(map), at.parameter_slope()).value(test);
            there.abs() / zero.steepness
        });
        // Equations with more nodes lead to none between both ends: it is said where that is, and is no event.
        if !crosses && finer.is_some_and(|moved| moved > way) {
            return None;
        }
        event.error = match finer {
            Some(moved) if crosses => event.error + SAFETY * moved,
            _ => f64::INFINITY,
        };
        event.tangent = event_tangent::of_states(&mut run.equations, at, periods);
        return Some(event);
    };
    let map = again.equations.map(&again.point.u);
    let point = at_event(run, &mut again, map.as_ref(), read.map.as_ref(), kind);
    event.point = Point {
        error: Some(run.error_at_event(at, &again.equations, point.value)),
        ..point
    };
    (event.error, event.test) = (again.error, again.test);
    event.tangent = event_tangent::of_states(&mut again.equations, &again.point, periods);
    Some(event)
}

/// Whether an orbit at which branches seem to cross has multipliers, of which none is near one: the determinant of the equations changes its sign where
/// switches beside a touch change their order, too.
pub(super) fn crosses_nothing(event: &Event) -> bool {
    let stability = &event.point.stability;
    let crosses = matches!(
        event.kind,
        EventKind::BranchPoint | EventKind::SymmetryBreaking
    );
    let apart = stability.multipliers.iter().map(|m| (m - 1.0).norm());
    let nearest = apart.fold(f64::INFINITY, f64::min);
    // What is stated has how far the nearest is, which ought to be nothing, in it.
    let own = if stability.error < nearest {
        stability.error
    } else {
        stability.error - nearest
    };
    // A rigid motion has its own, which are not among them.
    crosses
        && stability.rigid == 0
        && !stability.multipliers.is_empty()
        && nearest > FAR.max(10.0 * own)
}

/// An event of equations with more nodes.
struct Again {
    equations: Equations,
    point: CurvePoint,
    test: f64,
    error: f64,
}

/// A point in the direction of a step: where branches cross, each of them has a tangent.
fn along(at: &CurvePoint, step: Step<'_>) -> CurvePoint {
    CurvePoint {
        tangent: step.difference(),
        ..at.clone()
    }
}

/// Where a test function vanishes along the curve of equations near a point, with what is left of it there and what the place of it may be wrong
/// by, in what is varied.
type Locate = fn(&mut Equations, &CurvePoint, Test) -> Option<(CurvePoint, f64, f64)>;

/// Where a test function vanishes with more nodes, and more again until that does not change.
fn located_again(run: &mut Run<'_>, at: &CurvePoint, test: Test, locate: Locate) -> Option<Again> {
    let mut found: Option<Again> = None;
    let rounding = ROUNDING * run.problem.asked.period as f64;
    for _ in 0..FINER {
        let (from, point) = match &mut found {
            Some(again) => (&mut again.equations, &again.point),
            None => (&mut run.equations, at),
        };
        let value = point.parameter();
        let Some(mut next) = from.finer_at(&point.u) else {
            break;
        };
        let there = |u: &[f64]| from.rearranged(&next, u);
        let start = CurvePoint {
            u: there(&point.u),
            tangent: there(&point.tangent),
            scale: point.scale,
        };
        let Some((point, test, apart)) = locate(&mut next, &start, test) else {
            break;
        };
        let moved = (point.parameter() - value).abs();
        let error = SAFETY * (moved + apart) + rounding * value.abs();
        let known = error <= KNOWN * value.abs();
        found = Some(Again {
            equations: next,
            point,
            test,
            error,
        });
        if known {
            break;
        }
    }
    found
}

/// The orbit at an event. Where one multiplier is known, its difference counts among the errors.
fn at_event(
    run: &Run<'_>,
    again: &mut Again,
    map: Option<&DMatrix<f64>>,
    coarse: Option<&DMatrix<f64>>,
    kind: EventKind,
) -> Point {
    again.equations.compute(&again.point.u, false);
    let mut point = run.observed(&again.equations, again.point.parameter());
    if let (Some(map), Some(coarse)) = (map, coarse) {
        let parts = again.equations.skeleton.recurrence().parts;
        let found = multipliers(map, parts);
        // Over an even number of parts minus one is one.
        let critical = match kind {
            EventKind::PeriodDoubling if !parts.is_multiple_of(2) => -1.0,
            _ => 1.0,
        };
        let nearest = found.iter().map(|m| match kind {
            EventKind::NeimarkSacker => (m.norm() - 1.0).abs(),
            _ => (m - critical).norm(),
        });
        let nearest = nearest.fold(f64::INFINITY, f64::min);
        let spread = moduli::distance(&found, &multipliers(coarse, parts), map.nrows()) + nearest;
        point.stability = Stability::of(found, spread);
    }
    point
}

/// The curve of equations near a point, by the arc length along a direction.
struct Curve<'c> {
    equations: &'c mut Equations,
    newton: Newton,
    start: &'c CurvePoint,
    form: Vec<f64>,
}

impl<'c> Curve<'c> {
    fn new(equations: &'c mut Equations, start: &'c CurvePoint) -> Self {
        let newton = Newton::new(equations);
        let mut form = vec![0.0; start.u.len()];
        newton
            .norm()
            .linear_form(start.scale, &start.tangent, &mut form);
        Self {
            equations,
            newton,
            start,
            form,
        }
    }

    /// The point at an arc length, and the test function there.
    fn at(&mut self, s: f64, test: Test) -> Option<(CurvePoint, f64)> {
        let Self {
            equations,
            newton,
            start,
            form,
        } = self;
        let mut u = start.u.clone();
        let length = dot(form, &start.tangent);
        for (x, t) in u.iter_mut().zip(&start.tangent) {
            *x += s / length * t;
        }
        let border = Border {
            row: form,
            value: dot(form, &start.u) + s,
        };
        let begun = u.clone();
        damped_if_need_be(&mut u, |u, options| {
            newton.correct(*equations, u, border, start.scale, options)
        })?;
        if !is_near(newton, start.scale, [&begun, &u]) {
            return None;
        }
        let mut tangent = vec![0.0; u.len()];
        newton.tangent(*equations, &u, &mut tangent, true);
        let size = newton.norm().length(start.scale, &tangent);
        for t in &mut tangent {
            *t /= size;
        }
        let point = CurvePoint {
            u,
            tangent,
            scale: start.scale,
        };
        let slope = point.parameter_slope();
        let value = if test == Test::Slope {
            slope
        } else {
            Tests::of(equations.map(&point.u).as_ref(), slope).value(test)
        };
        Some((point, value))
    }
}

/// Solves as it is, and again with damping from the same start where that does not converge.
fn damped_if_need_be(
    u: &mut [f64],
    mut solve: impl FnMut(&mut [f64], NewtonOptions) -> Result<Converged, NewtonError>,
) -> Option<Converged> {
    let start = u.to_vec();
    match solve(u, OPTIONS) {
        Ok(converged) => Some(converged),
        Err(NewtonError::Cancelled { .. }) => None,
        Err(_) => {
            u.copy_from_slice(&start);
            solve(u, DAMPED).ok()
        }
    }
}

/// Whether an orbit is the one that it was looked for from.
fn is_near(newton: &Newton, scale: Scale, [from, to]: [&[f64]; 2]) -> bool {
    let moved: Vec<f64> = to.iter().zip(from).map(|(to, from)| to - from).collect();
    newton.norm().length(scale, &moved) <= FARTHEST
}

/// Where the test function vanishes along the curve of these equations, near a point of a coarser one, by (1).
fn again(
    equations: &mut Equations,
    start: &CurvePoint,
    test: Test,
) -> Option<(CurvePoint, f64, f64)> {
    let mut curve = Curve::new(equations, start);
    let (mut x0, mut x1) = (0.0, APART);
    let mut f0 = curve.at(x0, test)?.1;
    let (mut best, mut f1) = curve.at(x1, test)?;
    for _ in 0..SECANTS {
        if f1 == f0 || f1.abs() <= VANISHED {
            break;
        }
        let next = x1 - f1 * (x1 - x0) / (f1 - f0);
        if next.is_nan() || next.abs() > FARTHEST {
            return None;
        }
        (x0, f0) = (x1, f1);
        x1 = next;
        (best, f1) = curve.at(x1, test)?;
        if (x1 - x0).abs() <= 1e-14 {
            break;
        }
    }
    // Where the test function jumps instead, the last two places may be anywhere.
    (f1.abs() <= VANISHED || (x1 - x0).abs() < APART).then_some((best, f1, 0.0))
}

/// The same where branches cross: the equations are singular there, and are solved at four points around, whose cubic has the zero and the
/// orbit at it. What it leaves out is at most by what points half as far move it, and these are taken as long as that shrinks.
fn crossing(
    equations: &mut Equations,
    start: &CurvePoint,
    test: Test,
) -> Option<(CurvePoint, f64, f64)> {
    let mut curve = Curve::new(equations, start);
    // An arc length times that of the direction.
    let size = dot(&curve.form, &start.tangent);
    let mut beside = (BESIDE * size).max(ASIDE * size.sqrt());
    let mut found = of_cubic(&mut curve, test, beside)?;
    let mut apart = f64::INFINITY;
    for _ in 0..NEARER {
        beside *= 0.5;
        let Some(nearer) = of_cubic(&mut curve, test, beside) else {
            break;
        };
        let [value, before] = [&nearer, &found].map(|(point, _)| point.parameter());
        let moved = (value - before).abs();
        if moved >= apart {
            break;
        }
        (found, apart) = (nearer, moved);
        if moved <= KNOWN * value.abs() {
            break;
        }
    }
    let (point, left) = found;
    apart.is_finite().then_some((point, left, apart))
}

/// By the cubic through points around, the nearer ones as far.
fn of_cubic(curve: &mut Curve<'_>, test: Test, beside: f64) -> Option<(CurvePoint, f64)> {
    let start = curve.start;
    let places = AROUND.map(|part| part * beside);
    let mut points = Vec::with_capacity(places.len());
    for s in places {
        points.push(curve.at(s, test)?);
    }
    let value = |s: f64| {
        let pairs = lagrange(&places, s).into_iter().zip(&points);
        pairs.map(|(l, (_, test))| l * test).sum::<f64>()
    };
    let [a, b] = [1, 2].map(|index: usize| Place {
        x: places[index],
        value: points[index].1,
    });
    let s = roots::root(a, b, VANISHED * beside, value)?;
    let mut point = CurvePoint {
        u: vec![0.0; start.u.len()],
        tangent: vec![0.0; start.u.len()],
        scale: start.scale,
    };
    for (l, (other, _)) in lagrange(&places, s).into_iter().zip(&points) {
        add(&mut point.u, l, &other.u);
        add(&mut point.tangent, l, &other.tangent);
    }
    Some((point, value(s)))
}

/// The polynomials at a place that are one at one of these and zero at the others.
fn lagrange(places: &[f64; 4], s: f64) -> [f64; 4] {
    std::array::from_fn(|i| {
        let others = (0..4).filter(|j| *j != i);
        let factors = others.map(|j| (s - places[j]) / (places[i] - places[j]));
        factors.product()
    })
}

/// Keeps a touch of a level, solved again with more nodes until its value is known.
pub(in crate::contact_equation) fn touch(run: &mut Run<'_>, touch: &Touch) {
    // Where switches of different gaps have passed each other, by equations that have them in their order.
    match run.ordered(&touch.located.point) {
        Some((equations, point)) => run.with(equations, |run| keep_touch(run, touch, &point)),
        None => keep_touch(run, touch, &touch.located.point),
    }
}

/// The same of a touch at a point of the equations that the run has.
fn keep_touch(run: &mut Run<'_>, touch: &Touch, at: &CurvePoint) {
    let Some(mut read) = run.read_event(at) else {
        return;
    };
    // The extreme may be off by as much as the motion, and what is varied by that times how it changes with the extreme.
    let known = read.point.error.is_some_and(f64::is_finite);
    let apart = run
        .screened
        .as_ref()
        .filter(|_| known)
        .map_or(0.0, Screened::apart);
    let height = apart / touch.extreme.size * touch.rate;
    let mut error = touch.error + SAFETY * (read.shift.abs() + height);
    run.equations.compute(&at.u, false);
    let mut u = at.u.clone();
    // A step may lead over a stretch that begins and ends in it, and a touch beside another one may be found before it is watched: equations
    // that have it are those of this orbit.
    let mut former = None;
    if run.watched(&u, &touch.extreme).is_none() {
        if run.equations.failed || run.fits(&at.u) == Fits::No {
            error = f64::INFINITY;
        }
        if let Some((equations, there)) = run.replanned(&u) {
            former = Some(std::mem::replace(&mut run.equations, equations));
            run.equations.compute(&there, false);
            u = there;
        }
    }
    let square = run.watched(&u, &touch.extreme);
    let finer = square.and_then(|(square, _)| with_more_nodes(&mut run.equations, u, square));
    if let Some(former) = former {
        run.equations = former;
    }
    if let Some(Touching {
        mut equations,
        u,
        changed,
    }) = finer.filter(|found| {
        // Farther away it is another touch.
        let apart = (found.u[found.u.len() - 1] - at.parameter()).abs();
        apart <= SAME * error
    }) {
        error = SAFETY * changed;
        equations.compute(&u, false);
        let value = u[u.len() - 1];
        read.point = Point {
            stability: read.point.stability,
            error: Some(run.error_at_event(at, &equations, value)),
            ..run.observed(&equations, value)
        };
    }
    run.record.events.push(Event {
        kind: EventKind::Grazing { turns: touch.turns },
        error: error + TOUCHED * at.parameter().abs(),
        point: read.point,
        test: touch.located.test,
        after: touch.after,
        contacts: touch.contacts,
        tangent: event_tangent::of_states(&mut run.equations, at, run.problem.asked.period),
    });
}

/// An orbit that touches a level, with more nodes, and by how much the last of them have changed its value.
struct Touching {
    equations: Equations,
    u: Vec<f64>,
    changed: f64,
}

/// An orbit of these equations, whose `H` of a pair is at this place, where that is zero: with more nodes until its value is known.
fn with_more_nodes(equations: &mut Equations, mut u: Vec<f64>, square: usize) -> Option<Touching> {
    let mut finer: Option<(Equations, f64)> = None;
    for _ in 0..FINER {
        let from = match &mut finer {
            Some((finer, _)) => finer,
            None => &mut *equations,
        };
        let Some(mut next) = from.finer_at(&u) else {
            break;
        };
        let mut there = from.rearranged(&next, &u);
        there[square] = 0.0;
        let mut newton = Newton::new(&next);
        let (scale, begun) = (solve::scale_at(&newton, &there), there.clone());
        let solved = damped_if_need_be(&mut there, |u, options| {
            solve::with_held(&mut next, &mut newton, u, square, options)
        });
        if solved.is_none() || !is_near(&newton, scale, [&begun, &there]) {
            break;
        }
        let value = there[there.len() - 1];
        let changed = (value - u[u.len() - 1]).abs();
        u = there;
        finer = Some((next, changed));
        if SAFETY * changed <= KNOWN * value.abs() {
            break;
        }
    }
    finer.map(|(equations, changed)| Touching {
        equations,
        u,
        changed,
    })
}
