//! What is special on a curve of bifurcations in two parameters.
//!
//! | special point | test function |
//! |---|---|
//! | cusp: two folds meet | both parameters turn back at once along the curve |
//! | grazing: the map loses a derivative, and the curve its smoothness | none: the number of crossings changes |
//! | fold and flip: one multiplier is one, another minus one | `det(M + I)` on a curve of folds |
//! | double: two multipliers are one, or minus one | the product of `mu -+ 1` over all but the nearest |
//! | degenerate: what begins at a doubling bends neither way | the coefficient of [`normal_form`](super::normal_form) |
//!
//! A place is looked for once more by the equations of a [`error_reference`](crate::shooting::error_reference), and what that changes is its error.
//!
//! Source: Kuznetsov (2004), Elements of Applied Bifurcation Theory, chapter 9 (bifurcations of codimension two of fixed points).

use super::codimension_one::{Condition, Curve};
use super::generalised_flip::HalfPeriodDifference;
use super::normal_form::CubicCoefficient;
use super::special_search::{
    Counted, Criterion, Function, Place, ReferenceCurve, Search, TestFunctions, Tests, apart,
    values,
};
use super::{Plane, Special, SpecialKind};
use crate::branches::moduli::multipliers;
use crate::branches::observed::{Motion, Observed};
use crate::branches::point::Point;
use crate::branches::stability::Stability;
use crate::continuation::follow::{Continue, CurvePoint, Halt, Outcome, Step, Stop, Visit};
use crate::continuation::newton::{Newton, NewtonError, NewtonOptions};
use crate::error::Error;
use crate::shooting::extremes;
use crate::shooting::problem::ShootingProblem;
use crate::shooting::run::{no_orbit, orbit_of};
use crate::system::Variable;
use crate::time::{FlowError, Stretch};

/// A slope of the second parameter counts as none below this, and that of the first, where the second has none, below the other.
pub(super) const VANISHED: f64 = 1e-9;
const FLAT: f64 = 1e-3;
/// So many times what another distance changes in a coefficient is its error: where rounding makes it, the farther one is the better.
const BENT: f64 = 3.0;
/// A coefficient that is larger than this part of what it is at both ends of a step has not vanished, but jumps.
const JUMPS: f64 = 1e-3;
/// What rounding leaves in the values of a special point, as a part of them.
pub(super) const ROUNDING: f64 = 1e-12;

/// What is looked at along a curve.
pub(super) struct SpecialMonitor<'p, 'a> {
    problem: &'p ShootingProblem,
    plane: &'p Plane<'a>,
    options: NewtonOptions,
    pub(super) functions: TestFunctions<'p>,
    /// The last two points.
    seen: [Option<Tests>; 2],
    pub(super) points: Vec<Point>,
    pub(super) special: Vec<Special>,
    /// What the last orbit has that one of half the period has not, on a curve of folds.
    pub(super) halved: Option<HalfPeriodDifference>,
    /// The largest of these, and the last point.
    pub(super) largest: f64,
    pub(super) last: Option<CurvePoint>,
    /// The orbits have become those of half the period.
    joined: bool,
    /// The first parameter left its range.
    left: bool,
    /// Why a point that was found could not be read.
    failure: Option<FlowError>,
}

/// A place as the equations of the error reference have it.
struct Moved {
    place: Place,
    /// This part of what differs is the error.
    part: f64,
}

impl<'p, 'a> SpecialMonitor<'p, 'a> {
    pub(super) fn new(
        problem: &'p ShootingProblem,
        plane: &'p Plane<'a>,
        options: NewtonOptions,
        curve: &Curve<'a>,
    ) -> Self {
        let shift = match curve.condition {
            Condition::Multiplier(shift) => Some(shift),
            Condition::Grazing(..) => None,
        };
        let coefficient =
            (shift == Some(1.0)).then(|| CubicCoefficient::new(problem, curve, false).ok());
        Self {
            problem,
            plane,
            options,
            functions: TestFunctions {
                problem,
                shift,
                coefficient: coefficient.flatten(),
            },
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
        match *seen {
            Visit::Again(_) | Visit::Failed(..) | Visit::Onward(_) => {}
            Visit::Point(at) => return self.read(curve, at),
            Visit::Between(before, next) => {
                let mut search = Search {
                    curve,
                    newton,
                    options: self.options,
                    step: Step { before, next },
                };
                if self.joined {
                    self.end(&mut search);
                    return Continue::Break(Halt::Stop);
                }
                self.between(&mut search);
            }
        }
        Continue::Continue(())
    }

    /// Reads a point and its test functions.
    fn read(&mut self, curve: &mut Curve<'a>, at: &CurvePoint) -> Continue {
        let [value, _] = values(at);
        let [low, high] = self.plane.ranges[0];
        if value < low.min(high) || value > low.max(high) {
            self.left = true;
            return Continue::Break(Halt::Stop);
        }
        let Some(counted) = Counted::at(curve, &at.u) else {
            self.failure = curve.equations.failure;
            return Continue::Break(Halt::Stop);
        };
        curve.follow(&at.u);
        if self.passes_half_the_period(curve, at) {
            // It belongs to what would follow again.
            self.joined = true;
            return Continue::Continue(());
        }
        match self.point(curve, &at.u, &counted) {
            Ok(point) => self.points.push(point),
            Err(reason) => {
                self.failure = Some(reason);
                return Continue::Break(Halt::Stop);
            }
        }
        let tests = self.functions.at(curve, at, &counted);
        self.seen = [self.seen[1], tests];
        Continue::Continue(())
    }

    /// A point with what is read off it.
    ///
    /// # Errors
    /// If its motion cannot be computed.
    fn point(
        &self,
        curve: &mut Curve<'_>,
        u: &[f64],
        counted: &Counted,
    ) -> Result<Point, FlowError> {
        let last = u.len() - 1;
        let [value, second] = [u[last - 1], u[last]];
        let mut parameters = self.problem.parameters_at(value);
        let mut omega = self.problem.omega_at(value);
        match curve.second {
            Variable::Omega => omega = second,
            Variable::Parameter(index) => parameters[index] = second,
        }
        let rate = omega / f64::from(self.problem.divisor);
        let equations = &mut curve.equations;
        let mut motions = vec![Motion::NONE; equations.order() / 2];
        let see = &mut |stretch: &dyn Stretch| extremes::include(stretch, rate, &mut motions);
        equations.trace(&u[..last], see)?;
        let recurrence = &equations.span.recurrence;
        extremes::over_images(&mut motions, &recurrence.image);
        Ok(Point {
            value,
            parameters,
            stability: Stability {
                multipliers: multipliers(&counted.map, recurrence.parts),
                ..Stability::unknown()
            },
            observed: Observed::extremes(motions, counted.switches * recurrence.parts),
            orbit: orbit_of(equations, &u[..last], omega, rate),
            error: None,
        })
    }

    /// What is special between two points.
    fn between(&mut self, search: &mut Search<'_, 'a>) {
        let [Some(a), Some(b)] = self.seen else {
            return;
        };
        let Step { before, next } = search.step;
        let last = before.u.len() - 1;
        let changed = |entry: usize| before.tangent[entry] * next.tangent[entry] < 0.0;
        if changed(last) && changed(last - 1) {
            self.cusp(search);
        }
        if a.switches != b.switches {
            self.grazing(search, a.switches);
        }
        let fold = self.functions.shift.is_some_and(|shift| shift < 0.0);
        let small = |function| Criterion {
            function,
            tolerance: VANISHED,
            largest: VANISHED,
        };
        if fold && a.other * b.other < 0.0 {
            self.zero(search, SpecialKind::FoldFlip, small(Function::Other));
        }
        if a.rest * b.rest < 0.0 {
            self.zero(search, SpecialKind::Double, small(Function::Rest));
        }
        if a.coefficient * b.coefficient < 0.0 {
            let criterion = Criterion {
                function: Function::CubicCoefficient,
                tolerance: 0.0,
                largest: JUMPS * a.coefficient.abs().min(b.coefficient.abs()),
            };
            self.zero(search, SpecialKind::Degenerate, criterion);
        }
    }

    /// Where the slope of the second parameter vanishes, if that of the first does too.
    fn cusp(&mut self, search: &mut Search<'_, 'a>) {
        let Some(found) = search.turn() else {
            return;
        };
        let last = found.u.len() - 1;
        if (found.tangent[last - 1] / search.curve.units[1]).abs() >= FLAT {
            return;
        }
        let moved = self.reference(search.curve).and_then(|mut reference| {
            let place = Place::at(reference.search(search.step).turn()?);
            let part = reference.part;
            Some(Moved { place, part })
        });
        self.keep(
            SpecialKind::Cusp,
            Some(Place::at(found)),
            moved,
            search.step,
        );
    }

    /// Where levels are not crossed so `many` times any more.
    fn grazing(&mut self, search: &mut Search<'_, 'a>, many: usize) {
        let criterion = Criterion {
            function: Function::CrossedAs(many),
            tolerance: 0.0,
            largest: f64::INFINITY,
        };
        let mut functions = TestFunctions {
            coefficient: None,
            ..self.functions
        };
        let mut find = |search: &mut Search<'_, 'a>| {
            let found = search.zero(&mut functions, criterion);
            let found = found.map(Place::at);
            found.or_else(|| search.bracket(self.problem, many))
        };
        let found = find(search);
        let moved = self.reference(search.curve).and_then(|mut reference| {
            let place = find(&mut reference.search(search.step))?;
            let part = reference.part;
            Some(Moved { place, part })
        });
        self.keep(SpecialKind::Grazing, found, moved, search.step);
    }

    /// Where a test function vanishes.
    fn zero(&mut self, search: &mut Search<'_, 'a>, kind: SpecialKind, criterion: Criterion) {
        let found = search.zero(&mut self.functions, criterion);
        let degenerate = kind == SpecialKind::Degenerate;
        // A jump is none of these.
        if degenerate && found.is_none() {
            return;
        }
        let moved = self.reference(search.curve).and_then(|mut reference| {
            // What is left of the next order at a distance is not proportional to the error of the flow.
            let coefficient = degenerate
                .then(|| CubicCoefficient::new(self.problem, &reference.curve, true).ok());
            let mut functions = TestFunctions {
                coefficient: coefficient.flatten(),
                ..self.functions
            };
            let criterion = Criterion {
                largest: f64::INFINITY,
                ..criterion
            };
            let place = reference
                .search(search.step)
                .zero(&mut functions, criterion)?;
            Some(Moved {
                place: Place::at(place),
                part: if degenerate { BENT } else { reference.part },
            })
        });
        self.keep(kind, found.map(Place::at), moved, search.step);
    }

    /// The same curve by the equations of the error reference.
    pub(super) fn reference(&self, curve: &Curve<'a>) -> Option<ReferenceCurve<'a>> {
        ReferenceCurve::of(self.problem, curve)
    }

    /// Keeps a special point with the error that the reference tells, or in the middle of the step if it was not located.
    fn keep(
        &mut self,
        kind: SpecialKind,
        found: Option<Place>,
        moved: Option<Moved>,
        step: Step<'_>,
    ) {
        let ends = [values(step.before), values(step.next)];
        let unknown = 0.5 * apart(ends[0], ends[1]);
        let width = found.as_ref().map_or(0.0, |found| found.width);
        let beside = moved.as_ref();
        let beside = beside.map_or(0.0, |moved| moved.part * moved.place.width);
        let (values, error) = match found {
            Some(found) => {
                let at = values(&found.point);
                let size = at[0].abs().max(at[1].abs());
                let differs = |moved: Moved| moved.part * apart(at, values(&moved.place.point));
                (at, moved.map_or(unknown, differs) + ROUNDING * size)
            }
            None => (
                [0, 1].map(|entry| 0.5 * (ends[0][entry] + ends[1][entry])),
                unknown,
            ),
        };
        self.special.push(Special {
            kind,
            values,
            error: error + (width + beside),
            // The next point has been stored already.
            after: self.points.len().saturating_sub(1),
        });
    }

    /// Why the curve ended, as following it and what was seen on the way tell; it began at a `value` of the first parameter.
    ///
    /// # Errors
    /// Why following it failed, if nothing else explains the end.
    pub(super) fn end_of(
        &mut self,
        curve: &Curve<'a>,
        outcome: Result<Outcome, NewtonError>,
        value: f64,
    ) -> Result<Stop, Error> {
        let stuck = matches!(outcome, Ok(Outcome::Stopped(Stop::StepTooShort { .. })));
        if stuck && self.is_at_half_the_period(curve) {
            self.joined = true;
        }
        let failure = self.failure.or(curve.equations.failure);
        Ok(match (outcome, failure) {
            (Ok(_), Some(FlowError::Cancelled { .. })) => Stop::Interrupted,
            _ if self.left => Stop::ReachedEnd,
            _ if self.joined => Stop::JoinedDoublings,
            (Err(reason), failure) => return Err(no_orbit(value, reason, failure)),
            (Ok(Outcome::Stopped(Stop::StepTooShort { .. } | Stop::Interrupted)), Some(reason)) => {
                let value = self.points.last().map_or(value, |last| last.value);
                Stop::Motion { value, reason }
            }
            (Ok(Outcome::Stopped(Stop::LeftAtStart)), _) => Stop::ReachedEnd,
            (Ok(Outcome::Stopped(stop)), _) => stop,
            // A curve is never resized.
            (Ok(Outcome::Halted(_)), _) => Stop::Interrupted,
        })
    }
}
