//! The search for one special point within a step of a curve, and the test functions that it drives to zero.

use nalgebra::{Complex, DMatrix};

use super::codimension_one::{Curve, determinant};
use super::normal_form::CubicCoefficient;
use super::special_monitor::{ROUNDING, VANISHED};
use crate::continuation::follow::{CurvePoint, Step};
use crate::continuation::locate::{inside, locate};
use crate::continuation::newton::{Newton, NewtonOptions};
use crate::continuation::problem::{AsProblem, Problem};
use crate::numeric::spectrum::eigenvalues;
use crate::shooting::error_reference::ErrorReference;
use crate::shooting::problem::ShootingProblem;

/// A step over a grazing is divided so many times, at the first of these parts where there is a solution: beside it the equations have the
/// root of the distance in them.
const HALVINGS: usize = 60;
const PARTS: [f64; 5] = [0.5, 0.4, 0.6, 0.25, 0.75];

/// The map at a point, and how often levels are crossed there.
pub(super) struct Counted {
    pub(super) map: DMatrix<f64>,
    pub(super) switches: usize,
}

impl Counted {
    pub(super) fn at(curve: &mut Curve<'_>, u: &[f64]) -> Option<Self> {
        let before = curve.equations.flow.work().switches;
        let map = curve.map(u)?;
        let switches = curve.equations.flow.work().switches - before;
        Some(Self { map, switches })
    }
}

/// Values of the test functions at a point.
#[derive(Debug, Clone, Copy)]
pub(super) struct Tests {
    pub(super) switches: usize,
    /// The determinant with the other sign.
    pub(super) other: f64,
    /// The product of what is left without the multiplier that is critical.
    pub(super) rest: f64,
    /// The coefficient of [`normal_form`](super::normal_form) times the slope of the second parameter: where that vanishes the coefficient is infinite.
    pub(super) coefficient: f64,
}

/// What the test functions of a curve are computed with.
pub(super) struct TestFunctions<'p> {
    pub(super) problem: &'p ShootingProblem,
    /// `-1` or `1`; `None` on a curve of grazing.
    pub(super) shift: Option<f64>,
    /// On curves where branches begin, if it is wanted.
    pub(super) coefficient: Option<CubicCoefficient>,
}

impl TestFunctions<'_> {
    pub(super) fn at(
        &mut self,
        curve: &Curve<'_>,
        at: &CurvePoint,
        counted: &Counted,
    ) -> Option<Tests> {
        let shift = self.shift?;
        let coefficient = self.coefficient.as_mut();
        let coefficient =
            coefficient.and_then(|coefficient| coefficient.at(self.problem, curve, &at.u));
        Some(Tests {
            switches: counted.switches,
            other: determinant(&counted.map, -shift),
            rest: rest(&counted.map, -shift),
            coefficient: coefficient.unwrap_or(f64::NAN) * at.parameter_slope(),
        })
    }
}

/// A function whose sign changes at a special point.
#[derive(Debug, Clone, Copy)]
pub(super) enum Function {
    Other,
    Rest,
    CubicCoefficient,
    /// Positive where levels are crossed so many times.
    CrossedAs(usize),
}

impl Function {
    fn value(self, tests: Option<Tests>) -> f64 {
        let of = |of: fn(Tests) -> f64| tests.map_or(f64::NAN, of);
        match self {
            Self::Other => of(|tests| tests.other),
            Self::Rest => of(|tests| tests.rest),
            Self::CubicCoefficient => of(|tests| tests.coefficient),
            Self::CrossedAs(many) if tests.is_some_and(|tests| tests.switches == many) => 1.0,
            Self::CrossedAs(_) => -1.0,
        }
    }
}

/// When a function has vanished.
#[derive(Debug, Clone, Copy)]
pub(super) struct Criterion {
    pub(super) function: Function,
    /// The search ends below this.
    pub(super) tolerance: f64,
    /// What the search leaves is a jump above this.
    pub(super) largest: f64,
}

/// Where something special was located, and how wide the bracket is that it lies in.
pub(super) struct Place {
    pub(super) point: CurvePoint,
    pub(super) width: f64,
}

impl Place {
    pub(super) fn at(point: CurvePoint) -> Self {
        Self { point, width: 0.0 }
    }
}

/// A step of a curve in which something special is looked for.
pub(super) struct Search<'s, 'a> {
    pub(super) curve: &'s mut Curve<'a>,
    pub(super) newton: &'s mut Newton,
    pub(super) options: NewtonOptions,
    pub(super) step: Step<'s>,
}

/// A curve, and once more for its test functions: they must not disturb what Newton's method has computed.
struct Tested<'t, 'a, 'p> {
    curve: &'t mut Curve<'a>,
    other: Curve<'a>,
    functions: &'t mut TestFunctions<'p>,
}

impl AsProblem for Tested<'_, '_, '_> {
    fn problem(&mut self) -> &mut dyn Problem {
        self.curve
    }
}

impl Search<'_, '_> {
    /// Where the slope of the second parameter vanishes. Where it jumps, as at a touch, nothing is born.
    pub(super) fn turn(&mut self) -> Option<CurvePoint> {
        let slope = |_: &mut Curve<'_>, at: &CurvePoint| at.parameter_slope();
        let (curve, newton) = (&mut *self.curve, &mut *self.newton);
        let found = locate(curve, newton, self.step, self.options, VANISHED, slope)?;
        found.vanishes.then_some(found.point)
    }

    /// Where a test function vanishes.
    pub(super) fn zero(
        &mut self,
        functions: &mut TestFunctions<'_>,
        criterion: Criterion,
    ) -> Option<CurvePoint> {
        let other = self.curve.again(functions.problem).ok()?;
        let mut tested = Tested {
            curve: &mut *self.curve,
            other,
            functions,
        };
        let found = locate(
            &mut tested,
            self.newton,
            self.step,
            self.options,
            criterion.tolerance,
            |tested, at| {
                let other = &mut tested.other;
                let counted = Counted::at(other, &at.u);
                let tests = counted.and_then(|counted| tested.functions.at(other, at, &counted));
                criterion.function.value(tests)
            },
        )?;
        (found.vanishes || found.test.abs() <= criterion.largest).then_some(found.point)
    }

    /// The last point before levels are not crossed so `many` times any more, and how far the next one is.
    pub(super) fn bracket(&mut self, problem: &ShootingProblem, many: usize) -> Option<Place> {
        let mut other = self.curve.again(problem).ok()?;
        let (mut before, mut next) = (self.step.before.clone(), self.step.next.clone());
        for _ in 0..HALVINGS {
            let ends = Step {
                before: &before,
                next: &next,
            };
            let (curve, newton) = (&mut *self.curve, &mut *self.newton);
            let mut parts = PARTS.into_iter();
            let point = parts.find_map(|part| inside(curve, newton, ends, part, self.options));
            let Some(point) = point else { break };
            let counted = Counted::at(&mut other, &point.u);
            if counted.is_some_and(|counted| counted.switches == many) {
                before = point;
            } else {
                next = point;
            }
            let [a, b] = values(&before);
            if apart(values(&before), values(&next)) <= ROUNDING * a.abs().max(b.abs()) {
                break;
            }
        }
        let width = apart(values(&before), values(&next));
        Some(Place {
            point: before,
            width,
        })
    }
}

/// The same curve by the equations of an error reference.
pub(super) struct ReferenceCurve<'a> {
    pub(super) curve: Curve<'a>,
    newton: Newton,
    options: NewtonOptions,
    /// This part of what differs is an error.
    pub(super) part: f64,
}

impl<'a> ReferenceCurve<'a> {
    pub(super) fn of(problem: &ShootingProblem, curve: &Curve<'a>) -> Option<Self> {
        let (span, frame) = (curve.equations.span.clone(), curve.equations.frame.clone());
        let reference = ErrorReference::new(problem, span, frame, curve.units[0]).ok()?;
        let (options, part) = (reference.options, reference.part);
        let curve = curve.with(reference.equations);
        Some(Self {
            newton: Newton::new(&curve),
            curve,
            options,
            part,
        })
    }

    /// The same step on it.
    pub(super) fn search<'s>(&'s mut self, step: Step<'s>) -> Search<'s, 'a> {
        Search {
            curve: &mut self.curve,
            newton: &mut self.newton,
            options: self.options,
            step,
        }
    }
}

/// Values of both parameters at a point.
pub(super) fn values(point: &CurvePoint) -> [f64; 2] {
    let last = point.u.len() - 1;
    [point.u[last - 1], point.u[last]]
}

pub(super) fn apart(a: [f64; 2], b: [f64; 2]) -> f64 {
    (a[0] - b[0]).abs().max((a[1] - b[1]).abs())
}

/// The product of `mu - critical` over all multipliers but the nearest.
fn rest(map: &DMatrix<f64>, critical: f64) -> f64 {
    let mut factors: Vec<Complex<f64>> =
        eigenvalues(map).into_iter().map(|m| m - critical).collect();
    factors.sort_by(|a, b| a.norm().total_cmp(&b.norm()));
    factors.iter().skip(1).product::<Complex<f64>>().re
}
