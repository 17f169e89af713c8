//! What is special on a curve of bifurcations in two parameters.
//!
//! | special point | test function |
//! |---|---|
//! | cusp: two folds meet | both parameters turn back at once along the curve |
//! | grazing: the map loses a derivative, and the curve its smoothness | none: the number of crossings changes |
//! | fold and flip: one multiplier is one, another minus one | `det(M + I)` on a curve of folds |
//! | double: two multipliers are one, or minus one | the product of `mu -+ 1` over all but the nearest |
//! | degenerate: what begins at a doubling bends neither way | the coefficient of [`bend`](super::bend) |
//!
//! A place is looked for once more by the equations of a [`companion`](super::companion), and what that changes is its error.
//!
//! Source: Kuznetsov (2004), Elements of Applied Bifurcation Theory, chapter 9 (bifurcations of codimension two of fixed points).

use std::cell::RefCell;

use nalgebra::{Complex, DMatrix};

use super::bend::Bend;
use super::companion::Companion;
use super::halved::Halved;
use super::setting::Setting;
use super::trace::{Plane, Special, SpecialKind, TrackPoint};
use super::track::{Condition, Curve, determinant};
use crate::continuation::follow::{Continue, CurvePoint, Halt, Visit};
use crate::continuation::locate::{inside, locate};
use crate::continuation::newton::{Newton, NewtonOptions};
use crate::numeric::spectrum::eigenvalues;
use crate::time::FlowError;

/// A slope of the second parameter counts as none below this, and that of the first, where the second has none, below the other.
const VANISHED: f64 = 1e-9;
const FLAT: f64 = 1e-3;
/// So many times what another distance changes in a coefficient is its error: where rounding makes it, the farther one is the better.
const BENT: f64 = 3.0;
/// A coefficient that is larger than this part of what it is at both ends of a step has not vanished, but jumps.
const JUMPS: f64 = 1e-3;
/// What rounding leaves in the values of a special point, as a part of them.
pub(super) const ROUNDING: f64 = 1e-12;
/// A step over a grazing is divided so many times, at the first of these parts where there is a solution: beside it the equations have the
/// root of the distance in them.
const HALVINGS: usize = 60;
const PARTS: [f64; 5] = [0.5, 0.4, 0.6, 0.25, 0.75];

/// What is looked at along a curve.
pub(super) struct Watch<'p, 'a> {
    setting: &'p Setting,
    plane: &'p Plane<'a>,
    options: NewtonOptions,
    symmetric: bool,
    /// `-1` or `1`; `None` on a curve of grazing.
    pub(super) shift: Option<f64>,
    bend: Option<RefCell<Bend>>,
    /// The last two points.
    seen: [Option<At>; 2],
    pub(super) points: Vec<TrackPoint>,
    pub(super) special: Vec<Special>,
    /// What the last orbit has that one of half the period has not, on a curve of folds.
    pub(super) halved: Option<Halved>,
    /// The largest of these, and the last point.
    pub(super) largest: f64,
    pub(super) last: Option<CurvePoint>,
    /// The orbits have become those of half the period.
    pub(super) joined: bool,
    /// The first parameter left its range.
    pub(super) left: bool,
    /// Why a point that was found could not be read.
    pub(super) failure: Option<FlowError>,
}

/// Test functions at a point.
#[derive(Debug, Clone, Copy)]
struct At {
    switches: usize,
    /// The determinant with the other sign.
    other: f64,
    /// The product of what is left without the multiplier that is critical.
    rest: f64,
    /// The coefficient of [`bend`](super::bend) times the slope of the second parameter: where that vanishes the coefficient is infinite.
    bend: f64,
}

impl<'p, 'a> Watch<'p, 'a> {
    pub(super) fn new(
        setting: &'p Setting,
        plane: &'p Plane<'a>,
        options: NewtonOptions,
        curve: &Curve<'a>,
        symmetric: bool,
    ) -> Self {
        let shift = match curve.condition {
            Condition::Multiplier(shift) => Some(shift),
            Condition::Touch(..) => None,
        };
        let bend = (shift == Some(1.0)).then(|| Bend::new(setting, curve, symmetric, false).ok());
        Self {
            setting,
            plane,
            options,
            symmetric,
            shift,
            bend: bend.flatten().map(RefCell::new),
            seen: [None, None],
            points: Vec::new(),
            special: Vec::new(),
            halved: None,
            largest: 0.0,
            last: None,
            joined: false,
            left: false,
            failure: None,
        }
    }

    pub(super) fn visit(
        &mut self,
        curve: &mut Curve<'a>,
        newton: &mut Newton,
        seen: &Visit<'_>,
    ) -> Continue {
        match seen {
            Visit::Again(_) => {}
            Visit::Point(at) => {
                let last = at.u.len() - 1;
                let value = at.u[last - 1];
                let [low, high] = self.plane.ranges[0];
                if value < low.min(high) || value > low.max(high) {
                    self.left = true;
                    return Continue::Break(Halt::Stop);
                }
                let Some((map, switches)) = counted(curve, &at.u) else {
                    self.failure = curve.equations.failure;
                    return Continue::Break(Halt::Stop);
                };
                curve.follow(&at.u);
                if self.passes_half_the_period(curve, at) {
                    // It belongs to what would follow again.
                    self.joined = true;
                    return Continue::Continue(());
                }
                let point = self.point(curve, &at.u, &map, switches);
                self.points.push(point);
                let tests = self.tests(curve, at, (&map, switches), self.bend.as_ref());
                self.seen = [self.seen[1], tests];
            }
            Visit::Between(before, behind) if self.joined => {
                self.end(curve, before, behind);
                return Continue::Break(Halt::Stop);
            }
            Visit::Between(before, behind) => self.between(curve, newton, (before, behind)),
        }
        Continue::Continue(())
    }

    /// A point with what is read off it.
    fn point(
        &self,
        curve: &Curve<'_>,
        u: &[f64],
        map: &DMatrix<f64>,
        switches: usize,
    ) -> TrackPoint {
        let mut multipliers = eigenvalues(map);
        if self.symmetric {
            for m in &mut multipliers {
                *m *= *m;
            }
        }
        let last = u.len() - 1;
        let states = curve.equations.states_of(&u[..last]);
        TrackPoint {
            values: [u[last - 1], u[last]],
            state: states[..curve.equations.order()].to_vec(),
            multipliers,
            switches: switches * if self.symmetric { 2 } else { 1 },
        }
    }

    fn tests(
        &self,
        curve: &Curve<'a>,
        at: &CurvePoint,
        (map, switches): (&DMatrix<f64>, usize),
        bend: Option<&RefCell<Bend>>,
    ) -> Option<At> {
        let shift = self.shift?;
        let bend = bend.and_then(|bend| bend.borrow_mut().at(self.setting, curve, &at.u));
        Some(At {
            switches,
            other: determinant(map, -shift),
            rest: rest(map, -shift),
            bend: bend.unwrap_or(f64::NAN) * at.parameter_slope(),
        })
    }

    /// What is special between two points.
    fn between(
        &mut self,
        curve: &mut Curve<'a>,
        newton: &mut Newton,
        between: (&CurvePoint, &CurvePoint),
    ) {
        let [Some(a), Some(b)] = self.seen else {
            return;
        };
        let (before, behind) = between;
        let last = before.u.len() - 1;
        let changed = |entry: usize| before.tangent[entry] * behind.tangent[entry] < 0.0;
        if changed(last) && changed(last - 1) {
            self.cusp(curve, newton, between);
        }
        if a.switches != b.switches {
            self.grazing(curve, newton, between, a.switches);
        }
        let value = |at: Option<At>, of: fn(At) -> f64| at.map_or(f64::NAN, of);
        let fold = self.shift.is_some_and(|shift| shift < 0.0);
        if fold && a.other * b.other < 0.0 {
            let kind = (SpecialKind::FoldFlip, VANISHED);
            let of = |at| value(at, |at| at.other);
            self.place(curve, newton, between, kind, (VANISHED, of));
        }
        if a.rest * b.rest < 0.0 {
            let kind = (SpecialKind::Double, VANISHED);
            let of = |at| value(at, |at| at.rest);
            self.place(curve, newton, between, kind, (VANISHED, of));
        }
        if a.bend * b.bend < 0.0 {
            let kind = SpecialKind::Degenerate;
            let least = JUMPS * a.bend.abs().min(b.bend.abs());
            let of = |at| value(at, |at| at.bend);
            self.place(curve, newton, between, (kind, 0.0), (least, of));
        }
    }

    /// Where the slope of the second parameter vanishes, if that of the first does too.
    fn cusp(
        &mut self,
        curve: &mut Curve<'a>,
        newton: &mut Newton,
        between: (&CurvePoint, &CurvePoint),
    ) {
        let find = |curve: &mut Curve<'a>, newton: &mut Newton, options| {
            let slope = CurvePoint::parameter_slope;
            // Where the slopes jump, as at a touch, nothing is born.
            locate(curve, newton, between, options, VANISHED, |_, at| slope(at))
                .filter(|found| found.vanishes)
        };
        let Some(found) = find(curve, newton, self.options) else {
            return;
        };
        let last = found.point.u.len() - 1;
        if (found.point.tangent[last - 1] / curve.units[1]).abs() >= FLAT {
            return;
        }
        let other = self
            .companion(curve)
            .and_then(|(mut other, mut newton, options, part)| {
                find(&mut other, &mut newton, options).map(|found| (found.point, part))
            });
        self.keep(SpecialKind::Cusp, Some((found.point, other)), between);
    }

    /// Where levels are not crossed so many times any more.
    fn grazing(
        &mut self,
        curve: &mut Curve<'a>,
        newton: &mut Newton,
        between: (&CurvePoint, &CurvePoint),
        many: usize,
    ) {
        let options = self.options;
        let side = |at: Option<At>| {
            let before = at.is_some_and(|at| at.switches == many);
            if before { 1.0 } else { -1.0 }
        };
        let with = (&mut *curve, &mut *newton, options);
        let exact = |found: CurvePoint| (found, 0.0);
        let looked = (&side, None);
        let found = self.look(with, between, (0.0, f64::INFINITY), looked);
        let found = found
            .map(exact)
            .or_else(|| self.bracket((&mut *curve, newton, options), between, many));
        let other = self
            .companion(curve)
            .and_then(|(mut other, mut newton, options, part)| {
                let with = (&mut other, &mut newton, options);
                let found = self.look(with, between, (0.0, f64::INFINITY), looked);
                let (point, width) = found.map(exact).or_else(|| {
                    let with = (&mut other, &mut newton, options);
                    self.bracket(with, between, many)
                })?;
                Some((point, width, part))
            });
        let width = found.as_ref().map_or(0.0, |(_, width)| *width);
        let beside = other.as_ref().map_or(0.0, |(_, width, part)| part * width);
        let other = other.map(|(point, _, part)| (point, part));
        let located = found.map(|(point, _)| (point, other));
        self.keep(SpecialKind::Grazing, located, between);
        if let Some(special) = self.special.last_mut() {
            special.error += width + beside;
        }
    }

    /// The last point before it, and how far behind that the next one is.
    fn bracket(
        &self,
        (curve, newton, options): (&mut Curve<'a>, &mut Newton, NewtonOptions),
        between: (&CurvePoint, &CurvePoint),
        many: usize,
    ) -> Option<(CurvePoint, f64)> {
        let mut other = curve.again(self.setting).ok()?;
        let (mut before, mut behind) = (between.0.clone(), between.1.clone());
        for _ in 0..HALVINGS {
            let ends = (&before, &behind);
            let mut parts = PARTS.into_iter();
            let point = parts.find_map(|part| inside(curve, newton, ends, part, options));
            let Some(point) = point else { break };
            if counted(&mut other, &point.u).is_some_and(|(_, count)| count == many) {
                before = point;
            } else {
                behind = point;
            }
            let [a, b] = values(&before);
            if apart(values(&before), values(&behind)) <= ROUNDING * a.abs().max(b.abs()) {
                break;
            }
        }
        let width = apart(values(&before), values(&behind));
        Some((before, width))
    }

    /// Keeps the place where a function of the tests changes its sign.
    fn place(
        &mut self,
        curve: &mut Curve<'a>,
        newton: &mut Newton,
        between: (&CurvePoint, &CurvePoint),
        (kind, tolerance): (SpecialKind, f64),
        (least, of): (f64, impl Fn(Option<At>) -> f64),
    ) {
        let with = (&mut *curve, newton, self.options);
        let looked = (&of, self.bend.as_ref());
        let found = self.look(with, between, (tolerance, least), looked);
        // A jump is none of these.
        if kind == SpecialKind::Degenerate && found.is_none() {
            return;
        }
        let other = self
            .companion(curve)
            .and_then(|(mut other, mut newton, options, part)| {
                // What is left of the next order at a distance is not proportional to the error of the flow.
                let bent = kind == SpecialKind::Degenerate;
                let bend = bent.then(|| Bend::new(self.setting, &other, self.symmetric, true));
                let bend = bend.and_then(Result::ok).map(RefCell::new);
                let with = (&mut other, &mut newton, options);
                let looked = (&of, bend.as_ref());
                let place = self.look(with, between, (tolerance, f64::INFINITY), looked)?;
                Some((place, if bent { BENT } else { part }))
            });
        self.keep(kind, found.map(|point| (point, other)), between);
    }

    fn look(
        &self,
        (curve, newton, options): (&mut Curve<'a>, &mut Newton, NewtonOptions),
        between: (&CurvePoint, &CurvePoint),
        (tolerance, least): (f64, f64),
        (of, bend): (&impl Fn(Option<At>) -> f64, Option<&RefCell<Bend>>),
    ) -> Option<CurvePoint> {
        // The curve is busy while a test function is evaluated.
        let other = RefCell::new(curve.again(self.setting).ok()?);
        let value = |_: &mut Curve, at: &CurvePoint| {
            let mut other = other.borrow_mut();
            let counted = counted(&mut other, &at.u);
            let tests = counted.and_then(|(map, many)| self.tests(&other, at, (&map, many), bend));
            of(tests)
        };
        let found = locate(curve, newton, between, options, tolerance, value)?;
        (found.vanishes || found.test.abs() <= least).then_some(found.point)
    }

    /// The same curve by the equations of a companion, and the part of what differs that is an error.
    fn companion(&self, curve: &Curve<'a>) -> Option<(Curve<'a>, Newton, NewtonOptions, f64)> {
        let (span, frame) = (curve.equations.span, curve.equations.frame.clone());
        let companion = Companion::new(self.setting, span, frame, curve.units[0]).ok()?;
        let (options, part) = (companion.options, companion.part);
        let other = curve.with(companion.equations);
        let newton = Newton::new(&other);
        Some((other, newton, options, part))
    }

    /// Keeps a special point with the error that its companion tells, or in the middle of the step if it was not located.
    fn keep(
        &mut self,
        kind: SpecialKind,
        located: Option<(CurvePoint, Option<(CurvePoint, f64)>)>,
        (before, behind): (&CurvePoint, &CurvePoint),
    ) {
        let ends = [values(before), values(behind)];
        let unknown = 0.5 * apart(ends[0], ends[1]);
        let (values, error) = match located {
            Some((point, other)) => {
                let at = values(&point);
                let size = at[0].abs().max(at[1].abs());
                let differs = |(other, part)| part * apart(at, values(&other));
                (at, other.map_or(unknown, differs) + ROUNDING * size)
            }
            None => (
                [0, 1].map(|entry| 0.5 * (ends[0][entry] + ends[1][entry])),
                unknown,
            ),
        };
        self.special.push(Special {
            kind,
            values,
            error,
            // The point behind it has been stored already.
            after: self.points.len().saturating_sub(1),
        });
    }
}

/// Values of both parameters at a point.
fn values(point: &CurvePoint) -> [f64; 2] {
    let last = point.u.len() - 1;
    [point.u[last - 1], point.u[last]]
}

pub(super) fn apart(a: [f64; 2], b: [f64; 2]) -> f64 {
    (a[0] - b[0]).abs().max((a[1] - b[1]).abs())
}

/// `M` at a point, and how often levels are crossed.
fn counted(curve: &mut Curve<'_>, u: &[f64]) -> Option<(DMatrix<f64>, usize)> {
    let before = curve.equations.flow.work().switches;
    let map = curve.map(u)?;
    Some((map, curve.equations.flow.work().switches - before))
}

/// The product of `mu - critical` over all multipliers but the nearest.
fn rest(map: &DMatrix<f64>, critical: f64) -> f64 {
    let mut factors: Vec<Complex<f64>> =
        eigenvalues(map).into_iter().map(|m| m - critical).collect();
    factors.sort_by(|a, b| a.norm().total_cmp(&b.norm()));
    factors.iter().skip(1).product::<Complex<f64>>().re
}
