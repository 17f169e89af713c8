//! Where a curve of folds of an even period ends: its orbits become orbits of half the period, at a degenerate doubling, and would
//! follow again half a period later.
//!
//! The state half a period later less the state, `d`, passes through zero there, along one direction, while the two parameters `p` turn
//! back: with `s` the length of `d`,
//!
//! ```text
//! p = p_0 + c s^2 + O(s^4),      p_0 = p - s p' / (2 s') + O(s^4)                                               (1)
//! ```
//!
//! where a prime is a derivative along the curve. Of `p_0` from two places, the nearer and the farther one,
//!
//! ```text
//! p_0 = p_0n + r / (1 - r) (p_0n - p_0f) + O(s^6),      r = (s_n / s_f)^4                                        (2)
//! ```
//!
//! is Richardson's extrapolation. The points of the curve itself may be at equal distances from the end, where (2) says nothing. So both places are
//! orbits computed inside of the step that passes the end, at distances of an eighth and a quarter of the step from it, on the side where more of
//! the step is. Where these cannot be computed, both ends of the step are taken.
//!
//! Source: Kuznetsov (2004), Elements of Applied Bifurcation Theory, section 9.3 (generalised flip: the curve of folds of twice the
//! period, and its order of contact).

use super::codimension_one::Curve;
use super::special_monitor::{ROUNDING, SpecialMonitor};
use super::special_search::{self, Search, apart};
use super::{Special, SpecialKind};
use crate::continuation::follow::{CurvePoint, Step};
use crate::continuation::locate::inside;
use crate::shooting::equations::Equations;

/// Two differences point opposite ways if the cosine of their angle is below this.
const OPPOSITE: f64 = -0.9;
/// Places that are as far from the end differ by rounding, which (2) makes larger by at most so much.
const MOST: f64 = 10.0;
/// Their error is what (2) would change, at most so many times by how much they differ.
const LARGEST: f64 = 1e6;

/// How far from the end both places are, in parts of the step.
const BESIDE: [f64; 2] = [0.125, 0.25];

/// Ratio of the differences at both: of others one place is on another curve, as that of the doublings.
const HALVED: std::ops::Range<f64> = 0.25..0.75;

/// What orbits have that those of half the period have not is as good as nothing below this part of what it was.
const NEARLY: f64 = 0.05;

/// The difference of an orbit, velocities in units of the frequency.
#[derive(Debug, Clone)]
pub(super) struct HalfPeriodDifference(Vec<f64>);

impl HalfPeriodDifference {
    /// Of an orbit whose last two unknowns are the parameters; `None` if half of its period is not a whole number of segments.
    pub(super) fn of(equations: &Equations, u: &[f64]) -> Option<Self> {
        let states = equations.states_of(&u[..u.len() - 1]);
        Self::between(equations, &states)
    }

    fn between(equations: &Equations, states: &[f64]) -> Option<Self> {
        let order = equations.order();
        let segments = states.len() / order;
        // The period of a declaration alone has no half that orbits may come back after without a sign.
        let recurrence = &equations.span.recurrence;
        let halves = recurrence.parts > 1 || recurrence.period.is_multiple_of(2);
        if !recurrence.image.is_identity() || !halves || !segments.is_multiple_of(2) {
            return None;
        }
        let later = &states[segments / 2 * order..][..order];
        let pairs = later.iter().zip(&states[..order]).enumerate();
        let difference = pairs.map(|(i, (x, y))| {
            let unit = if i < order / 2 {
                1.0
            } else {
                equations.frame.omega
            };
            (x - y) / unit
        });
        Some(Self(difference.collect()))
    }

    fn dot(&self, other: &Self) -> f64 {
        crate::numeric::linear::dot(&self.0, &other.0)
    }

    /// Whether it passed through zero on the way to another one.
    pub(super) fn passes(&self, other: &Self) -> bool {
        self.dot(other) < OPPOSITE * (self.dot(self) * other.dot(other)).sqrt()
    }

    /// The parameters (1), seen from a point of which this is the difference.
    pub(super) fn end(&self, equations: &Equations, point: &CurvePoint) -> Option<[f64; 2]> {
        let last = point.u.len() - 1;
        let along = Self::between(equations, &point.tangent[..last - 1])?;
        // s / s', with s' = d . d' / s
        let part = self.dot(self) / self.dot(&along);
        let value = |entry: usize| point.u[entry] - 0.5 * part * point.tangent[entry];
        Some([value(last - 1), value(last)])
    }

    /// How long it is.
    pub(super) fn size(&self) -> f64 {
        self.dot(self).sqrt()
    }
}

impl<'a> SpecialMonitor<'_, 'a> {
    /// Whether an orbit of half the period lies between the last point and this one.
    pub(super) fn passes_half_the_period(&mut self, curve: &Curve<'_>, at: &CurvePoint) -> bool {
        if self.functions.shift != Some(-1.0) {
            return false;
        }
        let now = HalfPeriodDifference::of(&curve.equations, &at.u);
        let pair = self.halved.as_ref().zip(now.as_ref());
        if pair.is_some_and(|(before, now)| before.passes(now)) {
            return true;
        }
        self.largest = now
            .as_ref()
            .map_or(0.0, HalfPeriodDifference::size)
            .max(self.largest);
        self.last = Some(at.clone());
        self.halved = now;
        false
    }

    /// Whether a curve that leads no further is as good as at such an orbit, where the equations are singular.
    pub(super) fn is_at_half_the_period(&mut self, curve: &Curve<'_>) -> bool {
        let Some((halved, last)) = self.halved.as_ref().zip(self.last.as_ref()) else {
            return false;
        };
        if halved.size() > NEARLY * self.largest {
            return false;
        }
        let Some(end) = halved.end(&curve.equations, last) else {
            return false;
        };
        let entry = last.u.len() - 1;
        let here = [last.u[entry - 1], last.u[entry]];
        self.special.push(Special {
            kind: SpecialKind::Degenerate,
            values: end,
            error: apart(end, here) + ROUNDING * end[0].abs().max(end[1].abs()),
            after: self.points.len(),
        });
        true
    }

    /// The degenerate doubling within a step. What the flow leaves in it shows by the equations of the error reference.
    pub(super) fn end(&mut self, search: &mut Search<'_, 'a>) {
        let Some(found) = degenerate(search) else {
            return;
        };
        let DegenerateEnd { values, error, .. } = found;
        let reference = self.reference(search.curve).filter(|_| found.beside);
        let moved = reference.and_then(|mut reference| {
            let part = reference.part;
            let moved = degenerate(&mut reference.search(search.step))?;
            moved.beside.then(|| part * apart(values, moved.values))
        });
        // As of other special points that the reference does not find.
        let Step { before, next } = search.step;
        let unknown = || 0.5 * apart(special_search::values(before), special_search::values(next));
        self.special.push(Special {
            kind: SpecialKind::Degenerate,
            values,
            error: error + moved.unwrap_or_else(unknown),
            after: self.points.len(),
        });
    }
}

/// What two places beside the end say of it, extrapolated by (2), and the error: by how much they differ, or what that changes if it is more.
fn degenerate(search: &mut Search<'_, '_>) -> Option<DegenerateEnd> {
    let Step { before, next } = search.step;
    let [a, b] = [before, next].map(|point| seen_from(search.curve, point));
    let (a, b) = (a?, b?);
    let places = places_beside(search, a.0 / (a.0 + b.0));
    let beside = places.is_some();
    let (near, far) = places.unwrap_or(if a.0 < b.0 { (a, b) } else { (b, a) });
    let share = (near.0 / far.0).powi(4);
    let wanted = share / (1.0 - share);
    let factor = wanted.min(MOST);
    let values = [0, 1].map(|i| near.1[i] + factor * (near.1[i] - far.1[i]));
    let size = values[0].abs().max(values[1].abs());
    let error = wanted.clamp(1.0, LARGEST) * apart(near.1, far.1) + ROUNDING * size;
    Some(DegenerateEnd {
        values,
        error,
        beside,
    })
}

/// The nearer and the farther place on the longer side of the end, which is at a part of a step.
fn places_beside(search: &mut Search<'_, '_>, end: f64) -> Option<(Seen, Seen)> {
    let onward = if end < 0.5 { 1.0 } else { -1.0 };
    let mut place = |part: f64| {
        let part = end + onward * part;
        let point = inside(
            search.curve,
            search.newton,
            search.step,
            part,
            search.options,
        )?;
        seen_from(search.curve, &point)
    };
    let (near, far) = (place(BESIDE[0])?, place(BESIDE[1])?);
    let halved = HALVED.contains(&(near.0 / far.0)) && near.1.iter().all(|x| x.is_finite());
    halved.then_some((near, far))
}

/// What a step says of the end within it.
struct DegenerateEnd {
    values: [f64; 2],
    error: f64,
    /// By orbits beside it, not by the ends of the step.
    beside: bool,
}

/// How large the difference is, and the parameters (1).
type Seen = (f64, [f64; 2]);

fn seen_from(curve: &Curve<'_>, point: &CurvePoint) -> Option<Seen> {
    let halved = HalfPeriodDifference::of(&curve.equations, &point.u)?;
    Some((halved.size(), halved.end(&curve.equations, point)?))
}
