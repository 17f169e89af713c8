//! What a run does with the curve it follows: orbits with their stability, folds, and orbits at a value.

use std::ops::ControlFlow;

use crate::balance::{Balance, Resolution};
use crate::branch::{Event, EventKind, Orbit, Point, Turn};
use crate::continuation::follow::{CurvePoint, FollowOptions, Visit};
use crate::continuation::locate::locate;
use crate::continuation::problem::{Norm, Problem};
use crate::error::Error;
use crate::newton::{Newton, NewtonOptions};
use crate::observe::observe;
use crate::stability::Stability;
use crate::stability::judge::Judge;
use crate::start::StartRequest;
use crate::system::{System, Variable};
use crate::truncation::Finer;

/// The test function of a fold is driven below this.
const FOLD_TOLERANCE: f64 = 1e-10;
/// A value asked for is met to this part of the range.
const VALUE_TOLERANCE: f64 = 1e-13;

/// What it takes to compute further orbits of a branch.
#[derive(Clone)]
pub(crate) struct Follower<'a> {
    pub(crate) system: &'a dyn System,
    pub(crate) parameters: Vec<f64>,
    pub(crate) omega: f64,
    pub(crate) variable: Variable,
    pub(crate) resolution: Resolution,
    pub(crate) newton: NewtonOptions,
    pub(crate) stability: bool,
    pub(crate) from: f64,
    pub(crate) to: f64,
}

impl std::fmt::Debug for Follower<'_> {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Follower")
            .field("variable", &self.variable)
            .finish_non_exhaustive()
    }
}

impl<'a> Follower<'a> {
    pub(crate) fn balance(&self) -> Balance<'a> {
        Balance::new(
            self.system,
            &self.parameters,
            self.omega,
            self.variable,
            self.resolution,
        )
    }

    fn finer(&self) -> Finer<'a> {
        Finer::new(
            self.system,
            &self.parameters,
            self.omega,
            self.variable,
            self.resolution,
        )
    }

    fn judge(&self) -> Option<Judge<'a>> {
        self.stability.then(|| Judge::new(self.finer()))
    }

    pub(crate) fn start_request(&self, options: FollowOptions) -> StartRequest<'_> {
        StartRequest {
            system: self.system,
            parameters: &self.parameters,
            omega: self.omega,
            variable: self.variable,
            value: options.from,
            resolution: self.resolution,
            newton: options.newton,
        }
    }

    /// See [`Branch::at`].
    pub(crate) fn at(
        &self,
        points: &[Point],
        events: &[Event],
        value: f64,
    ) -> Result<Vec<Point>, Error> {
        let mut balance = self.balance();
        let mut newton = Newton::new(&balance);
        let mut judge = self.judge();
        let mut found: Vec<Point> = Vec::new();
        // Between folds the branch is monotonic, so every part of this chain passes a value at most once.
        let chain = chain(points, events);
        for (index, point) in chain.iter().enumerate() {
            let solution = if point.value == value {
                Some((*point).clone())
            } else {
                match chain.get(index + 1) {
                    Some(next)
                        if next.value != value && (point.value < value) != (next.value < value) =>
                    {
                        let u = self.between(&mut balance, &mut newton, (point, next), value)?;
                        Some(point_of(&mut balance, &mut newton, judge.as_mut(), &u))
                    }
                    _ => None,
                }
            };
            // A closed branch ends where it began.
            found.extend(
                solution.filter(|new| !found.iter().any(|old| is_same(&old.orbit, &new.orbit))),
            );
        }
        Ok(found)
    }

    /// The orbit at a value between those of two neighbours, searched along the chord of the two.
    fn between(
        &self,
        balance: &mut Balance<'_>,
        newton: &mut Newton,
        (a, b): (&Point, &Point),
        value: f64,
    ) -> Result<Vec<f64>, Error> {
        let extended = |point: &Point| {
            let mut u = point.orbit.series.clone();
            u.push(point.value);
            u
        };
        let (from, to) = (extended(a), extended(b));
        let range = (self.to - self.from).abs();
        let norm: &Norm = newton.norm();
        let mut largest = [0.0; 2];
        norm.scale_at(&to, range, &mut largest);
        let scale = norm.scale_at(&from, range, &mut largest);
        let mut tangent: Vec<f64> = to.iter().zip(&from).map(|(x, y)| x - y).collect();
        let length = norm.length(scale, &tangent);
        for t in &mut tangent {
            *t /= length;
        }
        let first = CurvePoint {
            u: from,
            tangent: tangent.clone(),
            scale,
        };
        let second = CurvePoint {
            u: to,
            tangent,
            scale,
        };
        let offset = |point: &CurvePoint| (point.parameter() - value) / range;
        let located = locate(
            balance,
            newton,
            (&first, &second),
            self.newton,
            VALUE_TOLERANCE,
            offset,
        );
        let lost = Error::Lost {
            value,
            from: a.value,
            to: b.value,
        };
        let mut u = located
            .filter(|located| located.vanishes)
            .ok_or(lost)?
            .point
            .u;
        let last = u.len() - 1;
        u[last] = value;
        Ok(u)
    }
}

/// Points and folds of a branch in their order along it.
fn chain<'p>(points: &'p [Point], events: &'p [Event]) -> Vec<&'p Point> {
    let mut chain = Vec::with_capacity(points.len() + events.len());
    for (index, point) in points.iter().enumerate() {
        let folds = events
            .iter()
            .filter(|event| event.after == index && event.kind == EventKind::Fold);
        chain.extend(folds.map(|event| &event.point));
        chain.push(point);
    }
    chain
}

/// Whether two orbits are one to nine digits.
fn is_same(a: &Orbit, b: &Orbit) -> bool {
    let size = a.series.iter().fold(0.0, |m: f64, x| m.max(x.abs()));
    a.omega == b.omega
        && a.series
            .iter()
            .zip(&b.series)
            .all(|(x, y)| (x - y).abs() <= 1e-9 * size)
}

/// What a run has gathered.
pub(crate) struct Run<'a> {
    pub(crate) judge: Option<Judge<'a>>,
    finer: Finer<'a>,
    pub(crate) points: Vec<Point>,
    pub(crate) events: Vec<Event>,
    pub(crate) turns: Vec<Turn>,
}

impl<'a> Run<'a> {
    pub(crate) fn new(follower: &Follower<'a>) -> Self {
        Self {
            judge: follower.judge(),
            finer: follower.finer(),
            points: Vec::new(),
            events: Vec::new(),
            turns: Vec::new(),
        }
    }

    pub(crate) fn visit(
        &mut self,
        balance: &mut Balance<'_>,
        newton: &mut Newton,
        seen: &Visit<'_>,
        options: NewtonOptions,
        visit: &mut impl FnMut(&Point) -> ControlFlow<()>,
    ) -> ControlFlow<()> {
        match seen {
            Visit::Point(at) => {
                let point = point_of(balance, newton, self.judge.as_mut(), &at.u);
                let answer = visit(&point);
                self.points.push(point);
                answer
            }
            Visit::Turn(before, behind) => {
                self.turn(balance, newton, (before, behind), options);
                ControlFlow::Continue(())
            }
        }
    }

    /// Locates the fold between two points, or the jump that is there instead.
    fn turn(
        &mut self,
        balance: &mut Balance<'_>,
        newton: &mut Newton,
        between: (&CurvePoint, &CurvePoint),
        options: NewtonOptions,
    ) {
        // The point behind the turn has been stored already.
        let after = self.points.len() - 1;
        let slope = CurvePoint::parameter_slope;
        match locate(balance, newton, between, options, FOLD_TOLERANCE, slope) {
            Some(located) if located.vanishes => {
                let u = &located.point.u;
                let error = self.finer.fold_error(u, newton);
                let point = point_of(balance, newton, self.judge.as_mut(), u);
                let kind = EventKind::Fold;
                self.events.push(Event {
                    kind,
                    point,
                    error,
                    test: located.test,
                    after,
                });
            }
            Some(located) => {
                let value = located.point.parameter();
                self.turns.push(Turn {
                    value,
                    test: located.test,
                    after,
                });
            }
            None => {
                let value = 0.5 * (between.0.parameter() + between.1.parameter());
                self.turns.push(Turn {
                    value,
                    test: between.0.parameter_slope(),
                    after,
                });
            }
        }
    }
}

/// Everything that is read off a solution, whose factors Newton's method holds.
fn point_of(
    balance: &mut Balance<'_>,
    newton: &mut Newton,
    judge: Option<&mut Judge<'_>>,
    u: &[f64],
) -> Point {
    let n = balance.unknowns();
    balance.set(u[n]);
    let stability = judge.map_or_else(Stability::unknown, |judge| {
        judge.stability(balance, newton, u)
    });
    let orbit = Orbit {
        series: u[..n].to_vec(),
        coordinates: balance.layout().coordinates,
        omega: balance.omega(),
        base: balance.base(),
        period: balance.resolution().period,
    };
    let observed = observe(balance, u);
    Point {
        value: u[n],
        parameters: balance.parameters().to_vec(),
        orbit,
        stability,
        observed,
    }
}
