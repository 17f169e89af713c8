//! Events of a branch: where a test function vanishes between two orbits, and how well that is known.
//!
//! The test functions are those of [`test_functions`](super::test_functions). A place is reported if it solves the equations and the function was
//! driven to zero there; its error is what an error reference makes of it.

use nalgebra::DMatrix;

use super::equations::Equations;
use super::error_reference::{self, ErrorReference};
use super::method::VANISHED;
use super::output_error::{self, At, output_error};
use super::problem::ShootingProblem;
use super::run::{Run, observe, relative};
use super::test_functions::{Test, Tests};
use crate::branches::engine::{self, Aim};
use crate::branches::moduli::{self, multipliers};
use crate::branches::point::{Event, Point};
use crate::branches::problem::{Change, Root, Touch, Zero};
use crate::continuation::follow::{CurvePoint, Step};
use crate::continuation::newton::{Newton, NewtonOptions};
use crate::continuation::problem::{AsProblem, Problem};
use crate::event::{EventKind, Turn};
use crate::orbit::observe::Accuracy;

/// What rounding leaves in the value of a touch, where the distance from a level has a root to be told apart from.
const TOUCHED: f64 = 2e-12;
/// A test function of which more than this part is left, of what it is at an end of the step, jumps.
const LEFT: f64 = 1e-3;
/// What rounding leaves in the value of an event.
const ROUNDING: f64 = 4.0 * f64::EPSILON;

/// Equations, and the same once more for test functions: they must not disturb what Newton's method has computed.
struct Tested<'t> {
    equations: &'t mut Equations,
    other: Equations,
}

impl AsProblem for Tested<'_> {
    fn problem(&mut self) -> &mut dyn Problem {
        self.equations
    }
}

/// A place where an event is by some equations.
struct Place<'e, 'r> {
    equations: &'e mut Equations,
    root: &'r Root,
}

/// What errors of an event are, of what differs between two of its places, and of the entries of its map.
#[derive(Clone, Copy)]
struct Errors {
    part: f64,
    noise: f64,
}

/// What the other multipliers make of a determinant that vanishes with the one nearest to a critical value, and of its rounding.
pub(super) fn others(equations: &mut Equations, u: &[f64], critical: f64) -> f64 {
    let Ok(map) = equations.map(u, &mut |_| {}) else {
        return 1.0;
    };
    let mut distances: Vec<f64> = moduli::of_map(&map)
        .iter()
        .map(|m| (m - critical).norm())
        .collect();
    distances.sort_by(f64::total_cmp);
    let product: f64 = distances.iter().skip(1).product();
    let largest = distances.last().copied().unwrap_or(1.0);
    product.max(1.0) * largest.max(1.0)
}

impl Run<'_> {
    /// Keeps a touch of a level, or what is known where its orbit cannot be read.
    pub(super) fn touch(&mut self, equations: &mut Equations, step: Step<'_>, touch: &Touch) {
        let kind = EventKind::Grazing { turns: touch.turns };
        let (at, after) = (&touch.located.point, touch.after);
        let Ok((point, _)) = observe(self.problem, equations, &at.u) else {
            self.record.turns.push(Turn {
                kind,
                value: at.parameter(),
                test: f64::NAN,
                after,
            });
            return;
        };
        // The orbits have the error of the flow: it is taken from states to the parameter by what both change in the step, and from the
        // extreme by how it rises at the touch. Where it just reaches the level, it hardly does.
        let [a, b] = step.parameters();
        let of_states = (b - a).abs() / equations.apart(&step.before.u, &step.next.u);
        let rate = of_states.max(touch.rate / touch.extreme.size);
        let error = touch.error + self.state_error * rate + TOUCHED * point.value.abs();
        self.record.events.push(Event {
            kind,
            point,
            error,
            test: touch.located.test,
            after,
            contacts: touch.contacts,
            tangent: at.tangent.clone(),
        });
    }

    /// Where a test function of these equations vanishes, which is known to vanish in the step by other equations.
    fn root(
        &mut self,
        equations: &mut Equations,
        newton: &mut Newton,
        step: Step<'_>,
        options: NewtonOptions,
        change: Change,
    ) -> Option<Root> {
        let other = equations.again(self.problem).ok()?;
        let mut tested = Tested { equations, other };
        let aim = if change.kind == EventKind::BranchPoint {
            Aim::Crossing
        } else {
            Aim::Beside(VANISHED)
        };
        let test = Test::of(change.test);
        let value = |tested: &mut Tested<'_>, point: &CurvePoint| {
            if test == Test::Slope {
                return point.parameter_slope();
            }
            let map = tested.other.map(&point.u, &mut |_| {}).ok();
            Tests::of(map.as_ref(), point.parameter_slope()).value(test)
        };
        let root = engine::root(&mut tested, newton, step, options, aim, value);
        self.work += tested.other.flow.work();
        root
    }

    /// The event at a place, compared with that of the reference.
    pub(super) fn event_at(
        &mut self,
        equations: &mut Equations,
        step: Step<'_>,
        zero: &Zero,
        kind: EventKind,
    ) -> Option<Event> {
        let change = zero.change;
        let (span, frame) = (equations.span.clone(), equations.frame.clone());
        let size = step.before.scale.oscillation;
        let ErrorReference {
            equations: mut others,
            mut newton,
            options,
            part,
            finer,
            noise,
            rounding,
        } = ErrorReference::new(self.problem, span, frame, size).ok()?;
        let moved = self.root(&mut others, &mut newton, step, options, change);
        // Where it jumps in these equations alone nothing is known of the error.
        let jumps = |root: &Root| root.located.test.abs() > LEFT * zero.least;
        let moved = moved.filter(|moved| !jumps(moved) || jumps(&zero.root));
        self.statistics += newton.statistics;
        let root = &zero.root;
        let (read, error, root) = match &moved {
            None => {
                let (read, _) = observe(self.problem, equations, &root.located.point.u).ok()?;
                (read, f64::INFINITY, root)
            }
            Some(moved) => {
                let here = Place { equations, root };
                let there = Place {
                    equations: &mut others,
                    root: moved,
                };
                // What is reported is the finer one, or the one that is not disturbed.
                let (best, other) = if finer { (there, here) } else { (here, there) };
                let root = best.root;
                let errors = Errors { part, noise };
                let (read, error) = compared(self.problem, kind, best, other, errors)?;
                (read, error, root)
            }
        };
        self.work += others.flow.work();
        // What the search leaves of a test function, and what rounding makes of it.
        let test = root.located.test.abs();
        let left = match Test::of(change.test) {
            Test::Modulus(_) => rounding + test,
            Test::Plus => test + rounding_of_plus(equations, &root.located.point.u),
            Test::Slope | Test::Bordered => 0.0,
        };
        let error = error + left / zero.steepness;
        Some(Event {
            kind,
            point: read,
            error,
            test: root.located.test,
            after: zero.after,
            contacts: 0,
            tangent: root.located.point.tangent.clone(),
        })
    }
}

/// What rounding of a map `M` leaves in `det(M + I)`, also where that vanishes: with the singular values `s` of `M + I`,
///
/// ```text
/// |d det| <= |adj(M + I)| |d M|,    |adj(M + I)|^2 = sum_i prod_(j != i) s_j^2                                  (1)
/// ```
///
/// in Frobenius norms. That the orbit is rounded too is seen from the other equations.
///
/// Source: Ipsen and Rehman (2008), Perturbation bounds for determinants and characteristic polynomials, SIAM Journal on Matrix Analysis
/// and Applications 30, section 2.
fn rounding_of_plus(equations: &mut Equations, u: &[f64]) -> f64 {
    let Ok(map) = equations.map(u, &mut |_| {}) else {
        return f64::INFINITY;
    };
    let by = error_reference::ROUNDING * map.norm();
    let (rows, columns) = map.shape();
    let singular = (map + DMatrix::identity(rows, columns)).singular_values();
    let minors = (0..rows).map(|i| {
        let others = singular.iter().enumerate().filter(|(j, _)| *j != i);
        others.map(|(_, value)| value * value).product::<f64>()
    });
    by * minors.sum::<f64>().sqrt()
}

/// An event of some equations with its errors, and the error of its value: a part of what it is in others.
fn compared(
    problem: &ShootingProblem,
    kind: EventKind,
    best: Place<'_, '_>,
    other: Place<'_, '_>,
    Errors { part, noise }: Errors,
) -> Option<(Point, f64)> {
    let Place { equations, root } = best;
    let Place {
        equations: others,
        root: moved,
    } = other;
    let there = &moved.located.point.u;
    let parts = equations.span.recurrence.parts;
    let u = &root.located.point.u;
    let (mut read, map) = observe(problem, equations, u).ok()?;
    let by = (moved.located.point.parameter() - read.value).abs();
    let error = part * by + root.error + moved.error + ROUNDING * read.value.abs();
    let apart = part * equations.apart(u, there);
    read.error = Some(match problem.accuracy {
        Accuracy::Output(output) => {
            let errors = output_error::Errors {
                part,
                states: 0.0,
                size: read.size(),
            };
            let (best, other) = (
                At { equations, u },
                At {
                    equations: others,
                    u: there,
                },
            );
            output_error(problem, output, &read.observed, best, other, errors).ok()?
        }
        accuracy => relative(apart, &read, accuracy),
    });
    if let Some(map) = map {
        let found = multipliers(&map, parts);
        let there = others.map(there, &mut |_| {}).ok()?;
        let there = multipliers(&there, parts);
        // One of them is known.
        let critical = match kind {
            EventKind::PeriodDoubling if !parts.is_multiple_of(2) => -1.0,
            _ => 1.0,
        };
        let nearest = found.iter().map(|m| match kind {
            EventKind::NeimarkSacker => (m.norm() - 1.0).abs(),
            _ => (m - critical).norm(),
        });
        let spread = part * moduli::distance(&found, &there, map.nrows())
            + nearest.fold(f64::INFINITY, f64::min)
            + error_reference::moved(&map, &found, parts, noise * map.norm().max(1.0));
        read.stability = problem.stability(found, map.nrows(), spread);
    }
    Some((read, error))
}
