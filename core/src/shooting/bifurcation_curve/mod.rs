//! Following a curve of bifurcations in two parameters, both ways from one of them.
//!
//! [`codimension_one`] has its equations, with that of a touch in [`grazing_condition`]. What is special on it is told by
//! [`special_monitor`] and located by [`special_search`]: by the coefficient of the [`normal_form`], or as a [`generalised_flip`].

mod codimension_one;
mod generalised_flip;
mod grazing_condition;
mod normal_form;
mod special_monitor;
mod special_search;

use self::codimension_one::{Condition, Curve};
use self::grazing_condition::GrazingCondition;
use self::special_monitor::SpecialMonitor;
use super::branch_switch::is_crossing;
use super::problem::ShootingProblem;
use super::run::no_orbit;
use super::start;
use crate::branches::error::OrbitError;
use crate::branches::point::{Event, Point};
use crate::branches::progress::{Progress, See, Stage};
use crate::branches::solve;
use crate::continuation::follow::{Continue, CurvePoint, FollowOptions, Halt, Start, Stop, follow};
use crate::continuation::newton::Newton;
use crate::continuation::step_control::StepControl;
use crate::error::Error;
use crate::event::EventKind;
use crate::model::request::RequestError;
use crate::numeric::decimal::Decimal;
use crate::system::{System, Variable};

/// A curve of bifurcations in the plane of two parameters.
#[derive(Debug, Clone, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[non_exhaustive]
pub struct BifurcationCurve {
    /// What bifurcates.
    pub kind: EventKind,
    /// Names of the two parameters.
    pub names: [String; 2],
    /// Period of the orbits in periods of the declaration.
    pub period: usize,
    /// Values of the two parameters, in the order of the curve.
    #[cfg_attr(feature = "serde", serde(with = "crate::serialise"))]
    pub values: Vec<[f64; 2]>,
    /// The orbits there, with their extremes and multipliers. The critical one is on the unit circle, so that no verdict is given.
    pub points: Vec<Point>,
    /// Its special points, in the order of the curve.
    pub special: Vec<Special>,
    /// Why it ended on both sides.
    pub ends: [Stop; 2],
}

/// A special point of a curve.
#[derive(Debug, Clone, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[non_exhaustive]
pub struct Special {
    /// What is special.
    pub kind: SpecialKind,
    /// Values of the two parameters.
    #[cfg_attr(feature = "serde", serde(with = "crate::serialise"))]
    pub values: [f64; 2],
    /// Estimated error of them: what a flow of another accuracy makes of the place. Where the place was not located, half of the
    /// step that passed it.
    #[cfg_attr(feature = "serde", serde(with = "crate::serialise"))]
    pub error: f64,
    /// Number of points of the curve before it.
    pub after: usize,
}

impl std::fmt::Display for Special {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let [a, b] = self.values.map(|value| Decimal::rounded(value, 12));
        write!(f, "{} at {a}, {b} (error {:.0e})", self.kind, self.error)
    }
}

/// What is special about a point of a curve of bifurcations.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(rename_all = "kebab-case"))]
#[non_exhaustive]
pub enum SpecialKind {
    /// Two folds meet and vanish.
    Cusp,
    /// A gap touches a level.
    Grazing,
    /// A multiplier is one and another minus one.
    FoldFlip,
    /// Two multipliers are one on a curve of folds, or minus one on one of period doublings or of broken symmetry (strong resonance
    /// 1:1 or 1:2): a curve of Neimark-Sacker bifurcations may end there.
    Double,
    /// The branch that begins at a period doubling, or where a symmetry breaks, bends neither way: on one side of this point it
    /// begins towards larger values, on the other towards smaller ones. A curve of its folds ends there.
    Degenerate,
}

impl std::fmt::Display for SpecialKind {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(match self {
            Self::Cusp => "cusp",
            Self::Grazing => "grazing",
            Self::FoldFlip => "fold-flip",
            Self::Double => "double",
            Self::Degenerate => "degenerate",
        })
    }
}

/// Ranges of the two parameters: the first is what the problem varies.
pub(crate) struct Plane<'a> {
    pub(crate) system: &'a dyn System,
    pub(crate) second: Variable,
    pub(crate) name: String,
    pub(crate) ranges: [[f64; 2]; 2],
}

/// No half of a curve has more points.
const POINTS: usize = 600;
/// Shorter steps lead nowhere: where orbits graze, a determinant has the root of the distance in it, and no tangent.
const SHORTEST: f64 = 1e-5;

/// Half of a curve, as it is followed.
struct Half {
    points: Vec<Point>,
    special: Vec<Special>,
    end: Stop,
}

impl Half {
    fn interrupted() -> Self {
        Self {
            points: Vec::new(),
            special: Vec::new(),
            end: Stop::Interrupted,
        }
    }

    /// Points and special points of this half from its end to the event, and of the other one from there on.
    fn joined(mut self, forth: Self) -> (Vec<Point>, Vec<Special>) {
        let count = self.points.len();
        self.points.reverse();
        self.special.reverse();
        // The first point of both is the event.
        self.points.extend(forth.points.into_iter().skip(1));
        for special in &mut self.special {
            special.after = count - special.after;
        }
        let forth = forth.special.into_iter().map(|special| Special {
            after: special.after + count - 1,
            ..special
        });
        self.special.extend(forth);
        (self.points, self.special)
    }
}

/// The curve of bifurcations through an event.
///
/// # Errors
/// If events of that kind are on no such curve, or the event does not solve its equations.
pub(crate) fn track(
    problem: &ShootingProblem,
    event: &Event,
    plane: &Plane<'_>,
    visit: See<'_>,
) -> Result<BifurcationCurve, Error> {
    check_inside(event, plane)?;
    let mut back = half(problem, event, plane, -1.0, visit)?;
    let values = |point: &Point| [point.value, second_of(point, plane.second)];
    let track = |points: Vec<Point>, special, ends| BifurcationCurve {
        kind: event.kind,
        names: [problem.varied.clone(), plane.name.clone()],
        period: event.point.orbit.period,
        values: points.iter().map(values).collect(),
        points,
        special,
        ends,
    };
    if back.end == Stop::Closed {
        // The other way leads through the same points.
        let first = back.points.first().cloned();
        back.points.extend(first);
        return Ok(track(back.points, back.special, [Stop::Closed; 2]));
    }
    let interrupted = back.end == Stop::Interrupted;
    // Without the other half there is the event, where both begin.
    let forth = if interrupted {
        Half::interrupted()
    } else {
        match half(problem, event, plane, 1.0, visit) {
            Err(_) if problem.cancel.is_cancelled() => Half::interrupted(),
            forth => forth?,
        }
    };
    let ends = [back.end, forth.end];
    let (points, special) = back.joined(forth);
    Ok(track(points, special, ends))
}

/// The event is inside the ranges of both parameters.
fn check_inside(event: &Event, plane: &Plane<'_>) -> Result<(), Error> {
    let at = [event.point.value, second_of(&event.point, plane.second)];
    for ((value, range), name) in at.into_iter().zip(plane.ranges).zip(["from", "within"]) {
        if value < range[0].min(range[1]) || value > range[0].max(range[1]) {
            let must = "is the value at the event, and must be inside the range of the curve";
            return Err(RequestError::Option { name, value, must }.into());
        }
    }
    Ok(())
}

/// From the event towards larger values of the second parameter, or smaller ones.
fn half(
    problem: &ShootingProblem,
    event: &Event,
    plane: &Plane<'_>,
    side: f64,
    visit: See<'_>,
) -> Result<Half, Error> {
    let (mut curve, mut u) = curve(problem, event, plane)?;
    let mut newton = Newton::new(&curve);
    let newton_options = problem.newton(problem.source.tolerance, 1.0);
    let value = event.point.value;
    solve::at_value(&mut curve, &mut newton, &mut u, newton_options)
        .map_err(|reason| no_orbit(value, reason, curve.equations.failure))?;
    let [_, [a, b]] = plane.ranges;
    let first = first_point(&mut curve, &mut newton, u, side, (b - a).abs());
    let options = FollowOptions {
        from: a.min(b),
        to: a.max(b),
        points: problem.points.min(POINTS),
        steps: StepControl {
            smallest: SHORTEST,
            ..problem.steps
        },
        newton: newton_options,
    };
    let mut monitor = SpecialMonitor::new(problem, plane, newton_options, &curve);
    let mut interrupted = false;
    let outcome = follow(
        &mut curve,
        &mut newton,
        Start::Along(Box::new(first)),
        options,
        &mut |curve, newton, seen| {
            let known = monitor.points.len();
            monitor.visit(curve, newton, &seen)?;
            let shown = monitor.points[known..].iter().zip(known + 1..);
            let mut shown = shown.map(|(point, done)| Progress {
                point: Some(point),
                ..Progress::at(Stage::Curve, done, point.value)
            });
            if shown.any(|progress| visit(progress).is_break()) {
                interrupted = true;
                return Continue::Break(Halt::Stop);
            }
            Continue::Continue(())
        },
    );
    let end = if interrupted {
        Stop::Interrupted
    } else {
        monitor.end_of(&curve, outcome, value)?
    };
    Ok(Half {
        points: monitor.points,
        special: monitor.special,
        end,
    })
}

/// The solution `u` with its tangent, towards larger values of the second parameter, whose range has this length, for a positive side.
fn first_point(
    curve: &mut Curve<'_>,
    newton: &mut Newton,
    u: Vec<f64>,
    side: f64,
    range: f64,
) -> CurvePoint {
    let scale = newton.norm().scale_at(&u, range, &mut [0.0; 2]);
    let mut tangent = vec![0.0; u.len()];
    newton.tangent(curve, &u, &mut tangent, true);
    let sign = side * tangent[tangent.len() - 1];
    let length = newton.norm().length(scale, &tangent) * sign.signum();
    for t in &mut tangent {
        *t /= length;
    }
    CurvePoint { u, tangent, scale }
}

/// The value of the second parameter at an orbit.
fn second_of(point: &Point, second: Variable) -> f64 {
    match second {
        Variable::Omega => point.orbit.omega,
        Variable::Parameter(index) => point.parameters[index],
    }
}

/// The problem of the curve, and the event as its unknowns.
fn curve<'a>(
    problem: &ShootingProblem,
    event: &Event,
    plane: &Plane<'a>,
) -> Result<(Curve<'a>, Vec<f64>), Error> {
    let point = &event.point;
    let (mut equations, mut u) = start::of_point(problem, point)?;
    let nothing = OrbitError::NoBranch {
        kind: event.kind,
        value: point.value,
    };
    let condition = match event.kind {
        EventKind::Fold => Condition::Multiplier(-1.0),
        EventKind::SymmetryBreaking if is_crossing(problem, event)? => return Err(nothing.into()),
        EventKind::PeriodDoubling | EventKind::SymmetryBreaking => Condition::Multiplier(1.0),
        EventKind::Grazing { .. } => {
            let grazing =
                GrazingCondition::of(plane.system, problem, &mut equations, &u).ok_or(nothing)?;
            Condition::Grazing(Box::new(grazing), problem.omega)
        }
        _ => return Err(nothing.into()),
    };
    u.push(second_of(point, plane.second));
    let size = point.size();
    let [first, second] = plane.ranges.map(|range| (range[1] - range[0]).abs());
    let curve = Curve::new(equations, plane.second, condition, [size, first, second]);
    Ok((curve, u))
}
