//! Following a curve of bifurcations in two parameters, both ways from one of them, and what is special on it.
//!
//! | special point | what happens |
//! |---|---|
//! | cusp | two folds meet: both parameters turn back at once along the curve |
//! | grazing | a gap touches a level: the map loses a derivative, and the curve its smoothness |
//! | fold and flip | one multiplier is one, another minus one |
//!
//! Source: Kuznetsov (2004), Elements of Applied Bifurcation Theory, chapter 9 (bifurcations of codimension two of fixed points).

use nalgebra::Complex;

use super::cycle::CycleEvent;
use super::equations::{Equations, Frame, Span};
use super::run::no_orbit;
use super::setting::Setting;
use super::solve;
use super::track::{Curve, determinant};
use crate::branch::EventKind;
use crate::continuation::follow::{
    Continue, CurvePoint, FollowOptions, Halt, Outcome, Start, Stop, Visit, follow,
};
use crate::continuation::locate::locate;
use crate::continuation::step::StepControl;
use crate::error::Error;
use crate::newton::{Newton, NewtonOptions};
use crate::stability::eigenvalues;
use crate::system::Variable;

/// A curve of bifurcations in the plane of two parameters.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct Track {
    /// What bifurcates.
    pub kind: EventKind,
    /// Names of the two parameters.
    pub names: [String; 2],
    /// Period of the orbits in periods of the declaration.
    pub period: usize,
    /// The curve in its order.
    pub points: Vec<TrackPoint>,
    /// Its special points, in the order of the curve.
    pub special: Vec<Special>,
    /// Why it ended on both sides.
    pub ends: [TrackEnd; 2],
}

/// One bifurcation of a curve.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct TrackPoint {
    /// Values of the two parameters.
    pub values: [f64; 2],
    /// The state `(q, dq/dt)` at phase zero.
    pub state: Vec<f64>,
    /// Floquet multipliers over the period, largest modulus first.
    pub multipliers: Vec<Complex<f64>>,
    /// How often a gap crosses a level in a period.
    pub switches: usize,
}

/// A special point of a curve.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct Special {
    /// What is special.
    pub kind: SpecialKind,
    /// Values of the two parameters.
    pub values: [f64; 2],
    /// Estimated error of them, from where it was looked for.
    pub error: f64,
    /// Number of points of the curve before it.
    pub after: usize,
}

/// What is special about a point of a curve of bifurcations.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum SpecialKind {
    /// Two folds meet and vanish.
    Cusp,
    /// A gap touches a level.
    Grazing,
    /// A multiplier is one and another minus one.
    FoldFlip,
}

/// Why a curve ended on one side.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub enum TrackEnd {
    /// A parameter left its range.
    Left,
    /// The curve closed upon itself.
    Closed,
    /// Following it ended otherwise.
    Stopped(Stop),
}

impl std::fmt::Display for TrackEnd {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::Left => f.write_str("left the range"),
            Self::Closed => f.write_str("closed"),
            Self::Stopped(stop) => stop.fmt(f),
        }
    }
}

impl std::fmt::Display for SpecialKind {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(match self {
            Self::Cusp => "cusp",
            Self::Grazing => "grazing",
            Self::FoldFlip => "fold-flip",
        })
    }
}

/// Ranges of the two parameters: the first is what the setting varies.
#[derive(Debug, Clone)]
pub(super) struct Plane {
    pub(super) second: Variable,
    pub(super) name: String,
    pub(super) ranges: [[f64; 2]; 2],
}

/// No half of a curve has more points.
const POINTS: usize = 600;
/// Shorter steps lead nowhere: where orbits graze, a determinant has the root of the distance in it, and no tangent.
const SHORTEST: f64 = 1e-5;
/// A slope of the second parameter counts as none below this, and that of the first, where the second has none, below the other.
const VANISHED: f64 = 1e-9;
const FLAT: f64 = 1e-3;

/// Half of a curve, as it is followed.
struct Half {
    points: Vec<TrackPoint>,
    special: Vec<Special>,
    end: TrackEnd,
}

/// The curve of bifurcations through an event.
///
/// # Errors
/// If events of that kind are on no such curve, or the event does not solve its equations.
pub(super) fn track(
    setting: &Setting<'_>,
    event: &CycleEvent,
    plane: &Plane,
) -> Result<Track, Error> {
    let shift = match event.kind {
        EventKind::Fold => -1.0,
        EventKind::PeriodDoubling | EventKind::SymmetryBreaking => 1.0,
        kind => {
            let value = event.cycle.value;
            return Err(Error::NoBranch { kind, value });
        }
    };
    let at = [event.cycle.value, second_of(event, plane.second)];
    for ((value, range), name) in at.into_iter().zip(plane.ranges).zip(["from", "within"]) {
        if value < range[0].min(range[1]) || value > range[0].max(range[1]) {
            let must = "is the value at the event, and must be inside the range of the curve";
            return Err(Error::Option { name, value, must });
        }
    }
    let [mut back, forth] = [-1.0, 1.0].map(|side| half(setting, event, plane, shift, side));
    let (back, mut forth) = (back.as_mut().map_err(|e| e.clone())?, forth?);
    let count = back.points.len();
    back.points.reverse();
    back.special.reverse();
    // The first point of both is the event.
    let mut points = std::mem::take(&mut back.points);
    points.extend(forth.points.drain(..).skip(1));
    let mut special = std::mem::take(&mut back.special);
    for special in &mut special {
        special.after = count - special.after;
    }
    special.extend(forth.special.drain(..).map(|special| Special {
        after: special.after + count - 1,
        ..special
    }));
    Ok(Track {
        kind: event.kind,
        names: [setting.varied.clone(), plane.name.clone()],
        period: event.cycle.period,
        points,
        special,
        ends: [back.end, forth.end],
    })
}

/// From the event towards larger values of the second parameter, or smaller ones.
fn half(
    setting: &Setting<'_>,
    event: &CycleEvent,
    plane: &Plane,
    shift: f64,
    side: f64,
) -> Result<Half, Error> {
    let (mut curve, mut u) = curve(setting, event, plane, shift)?;
    let mut newton = Newton::new(&curve);
    let options = setting.newton(setting.source.tolerance, 1.0);
    solve::at_value(&mut curve, &mut newton, &mut u, options)
        .map_err(|reason| no_orbit(event.cycle.value, reason, curve.equations.failure))?;
    let [_, second] = plane.ranges;
    let range = (second[1] - second[0]).abs();
    let scale = newton.norm().scale_at(&u, range, &mut [0.0; 2]);
    let mut tangent = vec![0.0; u.len()];
    newton.tangent(&mut curve, &u, &mut tangent, true);
    let sign = side * tangent[tangent.len() - 1];
    let length = newton.norm().length(scale, &tangent) * sign.signum();
    for t in &mut tangent {
        *t /= length;
    }
    let start = Start::Along(Box::new(CurvePoint { u, tangent, scale }));
    let options = FollowOptions {
        from: second[0].min(second[1]),
        to: second[0].max(second[1]),
        points: setting.points.min(POINTS),
        steps: StepControl {
            smallest: SHORTEST,
            ..setting.steps
        },
        newton: options,
    };
    let mut watch = Watch {
        setting,
        plane,
        options: options.newton,
        symmetric: event.cycle.symmetric,
        shift,
        points: Vec::new(),
        special: Vec::new(),
        left: false,
    };
    let outcome = follow(
        &mut curve,
        &mut newton,
        start,
        options,
        &mut |curve, newton, seen| watch.visit(curve, newton, &seen),
    );
    let end = match outcome {
        _ if watch.left => TrackEnd::Left,
        Err(reason) => {
            return Err(no_orbit(event.cycle.value, reason, curve.equations.failure));
        }
        Ok(Outcome::Stopped(Stop::ReachedEnd | Stop::LeftAtStart)) => TrackEnd::Left,
        Ok(Outcome::Stopped(Stop::Closed)) => TrackEnd::Closed,
        Ok(Outcome::Stopped(stop)) => TrackEnd::Stopped(stop),
        // A curve is never resized.
        Ok(Outcome::Halted(_)) => TrackEnd::Stopped(Stop::Interrupted),
    };
    Ok(Half {
        points: watch.points,
        special: watch.special,
        end,
    })
}

/// The value of the second parameter at an event.
fn second_of(event: &CycleEvent, second: Variable) -> f64 {
    match second {
        Variable::Omega => event.cycle.omega,
        Variable::Parameter(index) => event.cycle.parameters[index],
    }
}

/// The problem of the curve, and the event as its unknowns.
fn curve<'a>(
    setting: &Setting<'a>,
    event: &CycleEvent,
    plane: &Plane,
    shift: f64,
) -> Result<(Curve<'a>, Vec<f64>), Error> {
    let cycle = &event.cycle;
    let order = 2 * cycle.extremes.len();
    let span = Span {
        period: cycle.period,
        half: cycle.symmetric,
        segments: cycle.states.len() / order,
    };
    let frame = Frame {
        variable: setting.variable,
        reference: vec![0.0; order / 2],
        omega: cycle.omega,
        ratio: 1.0,
    };
    let equations = Equations::new(setting, setting.source.tolerance, span, frame)?;
    let mut u = equations.unknowns_of(&cycle.states, cycle.value);
    u.push(second_of(event, plane.second));
    let size = 0.5
        * cycle
            .extremes
            .iter()
            .fold(0.0, |m: f64, e| m.max(e.peak_to_peak()));
    let size = if size > 0.0 { size } else { 1.0 };
    let [first, second] = plane.ranges.map(|range| (range[1] - range[0]).abs());
    let curve = Curve::new(equations, plane.second, shift, [size, first, second]);
    Ok((curve, u))
}

/// What is looked at along a curve.
struct Watch<'p, 'a> {
    setting: &'p Setting<'a>,
    plane: &'p Plane,
    options: NewtonOptions,
    symmetric: bool,
    shift: f64,
    points: Vec<TrackPoint>,
    special: Vec<Special>,
    left: bool,
}

impl<'a> Watch<'_, 'a> {
    fn visit(&mut self, curve: &mut Curve<'a>, newton: &mut Newton, seen: &Visit<'_>) -> Continue {
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
                let Some((point, _)) = self.point(curve, &at.u) else {
                    return Continue::Break(Halt::Stop);
                };
                self.points.push(point);
            }
            Visit::Between(before, behind) => self.between(curve, newton, (before, behind)),
        }
        Continue::Continue(())
    }

    /// A point with what is read off it, and the test function of a fold that is a flip as well.
    fn point(&self, curve: &mut Curve<'_>, u: &[f64]) -> Option<(TrackPoint, f64)> {
        let before = curve.equations.flow.work().switches;
        let map = curve.map(u)?;
        let switches = curve.equations.flow.work().switches - before;
        let mut multipliers = eigenvalues(&map);
        if self.symmetric {
            for m in &mut multipliers {
                *m *= *m;
            }
        }
        let last = u.len() - 1;
        let states = curve.equations.states_of(&u[..last]);
        let point = TrackPoint {
            values: [u[last - 1], u[last]],
            state: states[..curve.equations.order()].to_vec(),
            multipliers,
            switches: switches * if self.symmetric { 2 } else { 1 },
        };
        Some((point, determinant(&map, -self.shift)))
    }

    /// What is special between two points.
    fn between(
        &mut self,
        curve: &mut Curve<'a>,
        newton: &mut Newton,
        between: (&CurvePoint, &CurvePoint),
    ) {
        let (before, behind) = between;
        let last = before.u.len() - 1;
        let changed = |entry: usize| before.tangent[entry] * behind.tangent[entry] < 0.0;
        if changed(last) && changed(last - 1) {
            let slope = CurvePoint::parameter_slope;
            let found = locate(curve, newton, between, self.options, VANISHED, slope);
            // Where the slopes jump, as at a touch, nothing is born.
            if let Some(found) = found.filter(|found| found.vanishes) {
                let other = found.point.tangent[last - 1] / curve.units[1];
                if other.abs() < FLAT {
                    self.keep(SpecialKind::Cusp, Some(found.point), between);
                }
            }
        }
        let [Some(a), Some(b)] = [before, behind].map(|at| self.point(curve, &at.u)) else {
            return;
        };
        if a.0.switches != b.0.switches {
            let found = self.grazing(curve, newton, between, a.0.switches);
            self.keep(SpecialKind::Grazing, found, between);
        }
        if a.1 * b.1 < 0.0 && self.shift < 0.0 {
            self.keep(SpecialKind::FoldFlip, None, between);
        }
    }

    /// The place where a gap touches a level, by halving: behind it levels are not crossed `switches` times.
    fn grazing(
        &self,
        curve: &mut Curve<'a>,
        newton: &mut Newton,
        between: (&CurvePoint, &CurvePoint),
        switches: usize,
    ) -> Option<CurvePoint> {
        let other = curve.again(self.setting).ok()?;
        let other = std::cell::RefCell::new(other);
        let side = |at: &CurvePoint| {
            let point = self.point(&mut other.borrow_mut(), &at.u);
            let before = point.is_some_and(|(point, _)| point.switches == switches);
            if before { 1.0 } else { -1.0 }
        };
        let found = locate(curve, newton, between, self.options, 0.0, side);
        found.map(|found| found.point)
    }

    /// Keeps a special point, in the middle of the step if it was not located.
    fn keep(
        &mut self,
        kind: SpecialKind,
        located: Option<CurvePoint>,
        (before, behind): (&CurvePoint, &CurvePoint),
    ) {
        let last = before.u.len() - 1;
        let ends = [last - 1, last].map(|entry| [before.u[entry], behind.u[entry]]);
        let (values, error) = match located {
            Some(point) => {
                // A slope that counts as none, over a step of the length that counts as one.
                let [first, second] = self.plane.ranges.map(|r| (r[1] - r[0]).abs());
                let flow = if self.setting.source.exact {
                    0.0
                } else {
                    self.setting.source.tolerance
                };
                let error = (VANISHED + 10.0 * flow) * first.max(second);
                ([point.u[last - 1], point.u[last]], error)
            }
            None => (
                ends.map(|[a, b]| 0.5 * (a + b)),
                ends.iter()
                    .fold(0.0, |m: f64, [a, b]| m.max(0.5 * (a - b).abs())),
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
