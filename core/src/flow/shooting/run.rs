//! What is done with the curve of orbits that is followed: multipliers and extremes of every orbit, and events.
//!
//! With the map `M` of [`equations`](super::equations) and the slope `l'` of the parameter along the branch:
//!
//! | event | test function |
//! |---|---|
//! | fold | `l'` vanishes, and `det(M - I)` changes its sign with it |
//! | branch point | `det(M - I)` vanishes and `l'` does not; or `l'` does, and `det(M - I)` keeps its sign: a branch that ends on another one, as of twice the period at a period doubling |
//! | period doubling | `det(M + I)` vanishes; with odd symmetry the symmetry breaks there |
//!
//! The bordered matrix of Newton's method has the determinant `det(M - I) / l'`, so these branch points are where it
//! changes its sign.
//!
//! Source: Govaerts (2000), Numerical Methods for Bifurcations of Dynamical Equilibria, chapters 3 and 4 (test functions);
//! Keller (1977) for the determinant.

use std::cell::RefCell;
use std::ops::ControlFlow;

use nalgebra::DMatrix;

use super::companion::Companion;
use super::crossing::locate_crossing;
use super::cycle::{Cycle, CycleEvent, End};
use super::equations::Equations;
use super::extremes::{self, Extremes};
use super::recurrence::{Recurrence, step_on_other_branch};
use super::setting::Setting;
use crate::branch::{EventKind, Turn};
use crate::continuation::follow::{
    Continue, CurvePoint, FollowOptions, Halt, Outcome, Start, Stop, Visit, follow,
};
use crate::continuation::locate::{Located, locate};
use crate::error::Error;
use crate::flow::{FlowError, Stretch, Work};
use crate::newton::{Newton, NewtonError, NewtonOptions};
use crate::stability::Stability;
use crate::statistics::Statistics;

/// Brackets of an event are narrowed until rounding stops it, or this is reached.
const VANISHED: f64 = 1e-14;
/// What rounding leaves in the value of an event.
const ROUNDING: f64 = 4.0 * f64::EPSILON;

/// The test functions at one orbit.
#[derive(Debug, Clone, Copy)]
struct Tests {
    slope: f64,
    /// `det(M - I)`
    minus: f64,
    /// `det(M + I)`
    plus: f64,
}

/// Which of them.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Test {
    Slope,
    Minus,
    Plus,
}

/// What a run has gathered.
pub(super) struct Run<'r, 'a> {
    setting: &'r Setting<'a>,
    options: NewtonOptions,
    companion: Companion<'a>,
    size: f64,
    /// What the branch has met.
    joined: Option<Recurrence>,
    before: Option<Tests>,
    last: Option<Tests>,
    pub(super) cycles: Vec<Cycle>,
    pub(super) events: Vec<CycleEvent>,
    pub(super) turns: Vec<Turn>,
    pub(super) failure: Option<FlowError>,
    pub(super) statistics: Statistics,
    /// Work of flows that are no more.
    pub(super) work: Work,
}

impl<'r, 'a> Run<'r, 'a> {
    pub(super) fn new(
        setting: &'r Setting<'a>,
        options: NewtonOptions,
        companion: Companion<'a>,
        size: f64,
    ) -> Self {
        Self {
            setting,
            options,
            companion,
            size,
            joined: None,
            before: None,
            last: None,
            cycles: Vec::new(),
            events: Vec::new(),
            turns: Vec::new(),
            failure: None,
            statistics: Statistics::default(),
            work: Work::default(),
        }
    }

    /// Follows the branch from near `u` to its end.
    ///
    /// # Errors
    /// If there is no first orbit.
    pub(super) fn follow(
        &mut self,
        equations: &mut Equations<'a>,
        u: Vec<f64>,
        options: FollowOptions,
        visit: &mut dyn FnMut(&Cycle) -> ControlFlow<()>,
    ) -> Result<End, Error> {
        let mut newton = Newton::new(equations);
        let outcome = follow(
            equations,
            &mut newton,
            Start::Near(u),
            options,
            &mut |equations, newton, seen| self.visit(equations, newton, &seen, visit),
        );
        if matches!(
            outcome,
            Err(_) | Ok(Outcome::Stopped(Stop::StepTooShort { .. }))
        ) {
            self.failure = self.failure.or(equations.failure);
        }
        self.statistics += newton.statistics;
        self.statistics += self.companion.newton.statistics;
        add(&mut self.work, equations.flow.work());
        add(&mut self.work, self.companion.work());
        match (outcome, self.joined) {
            (Ok(_), Some(Recurrence { period, odd })) => Ok(End::Joined {
                period,
                symmetric: odd,
            }),
            (Ok(Outcome::Stopped(stop)), None) => Ok(End::Stopped(stop)),
            // A walk by shooting is never resized.
            (Ok(Outcome::Halted(_)), None) => Ok(End::Stopped(Stop::Interrupted)),
            (Err(reason), _) => Err(no_orbit(options.from, reason, self.failure)),
        }
    }

    fn visit(
        &mut self,
        equations: &mut Equations<'a>,
        newton: &mut Newton,
        seen: &Visit<'_>,
        visit: &mut dyn FnMut(&Cycle) -> ControlFlow<()>,
    ) -> Continue {
        match seen {
            Visit::Again(_) => Continue::Continue(()),
            Visit::Point(at) => self.point(equations, at, visit).unwrap_or_else(|failure| {
                self.failure = Some(failure);
                Continue::Break(Halt::Stop)
            }),
            Visit::Between(before, behind) => self.between(equations, newton, before, behind),
        }
    }

    fn point(
        &mut self,
        equations: &mut Equations<'a>,
        at: &CurvePoint,
        visit: &mut dyn FnMut(&Cycle) -> ControlFlow<()>,
    ) -> Result<Continue, FlowError> {
        let span = equations.span;
        let odd = self.setting.odd;
        if !self.cycles.is_empty() && (span.period > 1 || odd) {
            let recurrence = Recurrence::of(equations, &at.u, self.size, odd)?;
            if recurrence.period < span.period || recurrence.odd != span.half {
                // The step that led here is seen next, and is the last one.
                self.joined = Some(recurrence);
                return Ok(Continue::Continue(()));
            }
        }
        let (cycle, map) = self.read(equations, &at.u)?;
        self.before = self.last.take();
        self.last = Some(Tests::of(map.as_ref(), at.parameter_slope()));
        let answer = visit(&cycle);
        self.cycles.push(cycle);
        Ok(if answer.is_break() {
            Continue::Break(Halt::Stop)
        } else {
            Continue::Continue(())
        })
    }

    fn between(
        &mut self,
        equations: &mut Equations<'a>,
        newton: &mut Newton,
        before: &CurvePoint,
        behind: &CurvePoint,
    ) -> Continue {
        if self.joined.is_some() {
            let kind = EventKind::BranchPoint;
            let options = self.options;
            let other = step_on_other_branch(equations, newton, before, behind, options);
            if let Some(other) = other {
                self.event(equations, newton, (behind, &other), Test::Minus, kind);
            }
            return Continue::Break(Halt::Stop);
        }
        if let (Some(a), Some(b)) = (self.before, self.last) {
            for (test, kind) in self.changed(a, b, equations.span.half) {
                self.event(equations, newton, (before, behind), test, kind);
            }
        }
        Continue::Continue(())
    }

    /// The test functions that changed their sign, and what that means.
    fn changed(&self, a: Tests, b: Tests, half: bool) -> Vec<(Test, EventKind)> {
        let turned = (a.slope < 0.0) != (b.slope < 0.0);
        let minus = a.minus * b.minus < 0.0;
        let mut events = Vec::new();
        if turned {
            let kind = if minus || !self.setting.stability {
                EventKind::Fold
            } else {
                EventKind::BranchPoint
            };
            events.push((Test::Slope, kind));
        } else if minus {
            events.push((Test::Minus, EventKind::BranchPoint));
        }
        if a.plus * b.plus < 0.0 {
            let kind = if half {
                EventKind::SymmetryBreaking
            } else {
                EventKind::PeriodDoubling
            };
            events.push((Test::Plus, kind));
        }
        events
    }

    /// Everything that is read off an orbit, and its map if the stability is wanted.
    pub(super) fn read(
        &mut self,
        equations: &mut Equations<'a>,
        u: &[f64],
    ) -> Result<(Cycle, Option<DMatrix<f64>>), FlowError> {
        let value = u[u.len() - 1];
        let setting = self.setting;
        let rate = setting.rate_at(value);
        let mut extremes = vec![Extremes::NONE; equations.order() / 2];
        let see = &mut |stretch: &dyn Stretch| extremes::include(stretch, rate, &mut extremes);
        let map = if setting.stability {
            Some(equations.map(u, see)?)
        } else {
            equations.trace(u, see)?;
            None
        };
        let half = equations.span.half;
        if half {
            for extremes in &mut extremes {
                *extremes = extremes.mirrored();
            }
        }
        let (stability, error) = match &map {
            Some(map) => {
                self.statistics.monodromies += 1;
                let judged = self.companion.judge(u, map);
                (judged.stability, judged.error)
            }
            None => (Stability::unknown(), f64::NAN),
        };
        let cycle = Cycle {
            value,
            parameters: setting.parameters_at(value),
            omega: setting.omega_at(value),
            period: equations.span.period,
            symmetric: half,
            states: equations.states_of(u),
            stability,
            extremes,
            error,
            iterations: 0,
        };
        Ok((cycle, map))
    }

    /// Locates an event between two points.
    fn event(
        &mut self,
        equations: &mut Equations<'a>,
        newton: &mut Newton,
        between: (&CurvePoint, &CurvePoint),
        test: Test,
        kind: EventKind,
    ) {
        let setting = self.setting;
        let options = self.options;
        // The point behind the event has been stored already.
        let after = self.cycles.len() - 1;
        let located = self.located(equations, newton, between, options, (test, kind), VANISHED);
        let Some(located) = located else {
            let value = 0.5 * (between.0.parameter() + between.1.parameter());
            let test = f64::NAN;
            self.turns.push(Turn { value, test, after });
            return;
        };
        let u = &located.point.u;
        let value = located.point.parameter();
        // A slope is relative to the range, and rounding to the value.
        let unit = match test {
            Test::Slope => (value.abs() / located.point.scale.parameter).max(1.0),
            Test::Minus | Test::Plus => 1.0,
        };
        if located.test.abs() <= setting.vanishing() * unit
            && let Ok((cycle, _)) = self.read(equations, u)
        {
            let error = self.error_of_event(between, (test, kind), value);
            self.events.push(CycleEvent {
                kind,
                cycle,
                error,
                test: located.test,
                after,
            });
        } else {
            let test = located.test;
            self.turns.push(Turn { value, test, after });
        }
    }

    /// Where a test function of these equations vanishes.
    fn located(
        &mut self,
        equations: &mut Equations<'a>,
        newton: &mut Newton,
        between: (&CurvePoint, &CurvePoint),
        options: NewtonOptions,
        (test, kind): (Test, EventKind),
        vanished: f64,
    ) -> Option<Located> {
        // The problem is busy while a test function is evaluated.
        let other = equations.again(self.setting).ok()?;
        let other = RefCell::new(other);
        let value = |point: &CurvePoint| {
            if test == Test::Slope {
                return point.parameter_slope();
            }
            let map = other.borrow_mut().map(&point.u, &mut |_| {}).ok();
            Tests::of(map.as_ref(), 0.0).value(test)
        };
        let located = if kind == EventKind::BranchPoint {
            locate_crossing(equations, newton, between, options, value)
        } else {
            locate(equations, newton, between, options, vanished, value)
        };
        add(&mut self.work, other.borrow().flow.work());
        located
    }

    /// Estimated error of an event: the companion's, which is as much further off as its equations are more wrong.
    fn error_of_event(
        &mut self,
        between: (&CurvePoint, &CurvePoint),
        what: (Test, EventKind),
        value: f64,
    ) -> f64 {
        let other = Companion::new(
            self.setting,
            self.companion.equations.span,
            self.companion.equations.frame.clone(),
            between.0.scale.oscillation,
        );
        let Ok(mut other) = other else {
            return f64::INFINITY;
        };
        let vanished = other.vanishing(self.setting.vanishing());
        let located = self.located(
            &mut other.equations,
            &mut other.newton,
            between,
            other.options,
            what,
            vanished,
        );
        self.statistics += other.newton.statistics;
        add(&mut self.work, other.work());
        located.map_or(f64::INFINITY, |other_event| {
            let moved = (other_event.point.parameter() - value).abs();
            other.part * moved + ROUNDING * value.abs()
        })
    }
}

impl Tests {
    fn of(map: Option<&DMatrix<f64>>, slope: f64) -> Self {
        let determinant = |shift: f64| {
            map.map_or(f64::NAN, |map| {
                let shifted = map + DMatrix::identity(map.nrows(), map.ncols()) * shift;
                shifted.determinant()
            })
        };
        Self {
            slope,
            minus: determinant(-1.0),
            plus: determinant(1.0),
        }
    }

    fn value(&self, test: Test) -> f64 {
        match test {
            Test::Slope => self.slope,
            Test::Minus => self.minus,
            Test::Plus => self.plus,
        }
    }
}

/// Why there is no orbit.
pub(super) fn no_orbit(value: f64, reason: NewtonError, failure: Option<FlowError>) -> Error {
    match failure {
        Some(reason) => Error::Motion {
            parameter: value,
            reason,
        },
        None => Error::NoStart {
            parameter: value,
            reason,
        },
    }
}

/// Adds up work.
pub(super) fn add(sum: &mut Work, other: Work) {
    sum.steps += other.steps;
    sum.rejected += other.rejected;
    sum.forces += other.forces;
    sum.switches += other.switches;
}
