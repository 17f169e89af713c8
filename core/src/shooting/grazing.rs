//! Grazing on a branch: where a gap touches a level.
//!
//! There test functions have the root of the distance in them, or jump. But how often levels are crossed is known exactly, so
//! the place is where that number changes, and is halved down to rounding. The numbers are compared between the orbits of the
//! branch: what touches twice within one step, and then is as before, is not seen. The balance has another way, from its series:
//! `balance_branch/run/grazing.rs`.

use super::equations::Equations;
use super::run::{Run, observe};
use crate::branches::point::Event;
use crate::continuation::follow::{CurvePoint, Step};
use crate::continuation::locate::locate;
use crate::continuation::newton::Newton;
use crate::continuation::problem::{AsProblem, Problem};
use crate::event::{EventKind, Turn};

/// What rounding leaves in the value of a grazing, where the distance from a level has a root to be told apart from.
const TOUCHED: f64 = 2e-12;
/// So many levels may be touched in one step.
const MOST: usize = 32;

/// As near to a grazing as was looked: the last orbit before it, and the first next it with its number of crossings, if its
/// motion is known.
struct Bracket {
    before: CurvePoint,
    next: CurvePoint,
    switches: Option<usize>,
}

/// Equations, the same once more to count crossings by, and what they have told so far.
struct Counting<'c> {
    equations: &'c mut Equations,
    other: Equations,
    nearest: Bracket,
}

impl AsProblem for Counting<'_> {
    fn problem(&mut self) -> &mut dyn Problem {
        self.equations
    }
}

impl Counting<'_> {
    /// One where levels are crossed so `many` times, minus one elsewhere.
    fn side(&mut self, point: &CurvePoint, many: usize) -> f64 {
        let half = if self.other.span.half { 2 } else { 1 };
        let before = self.other.flow.work().switches;
        let counted = self.other.trace(&point.u, &mut |_| {});
        let switches = half * (self.other.flow.work().switches - before);
        let switches = counted.is_ok().then_some(switches);
        if switches == Some(many) {
            self.nearest.before = point.clone();
            return 1.0;
        }
        (self.nearest.next, self.nearest.switches) = (point.clone(), switches);
        -1.0
    }
}

impl Run<'_> {
    /// Locates the places between two points where levels begin or cease to be crossed, one after the other.
    pub(super) fn grazings(
        &mut self,
        equations: &mut Equations,
        newton: &mut Newton,
        step: Step<'_>,
    ) {
        let after = self.points.len() - 1;
        let [first, last] =
            [after - 1, after].map(|index| self.points[index].observed.switches.unwrap_or(0));
        let mut switches = first;
        let mut from = step.before.clone();
        for _ in 0..MOST {
            let rest = Step {
                before: &from,
                next: step.next,
            };
            let Some(bracket) = self.bracket(equations, newton, rest, switches) else {
                return;
            };
            self.grazing(equations, step, &bracket);
            match bracket.switches {
                Some(now) if now != last => switches = now,
                _ => return,
            }
            from = bracket.next;
        }
    }

    /// Halves a step to where levels are not crossed so many times any more.
    fn bracket(
        &mut self,
        equations: &mut Equations,
        newton: &mut Newton,
        step: Step<'_>,
        many: usize,
    ) -> Option<Bracket> {
        let mut counting = Counting {
            other: equations.again(self.problem).ok()?,
            equations,
            nearest: Bracket {
                before: step.before.clone(),
                next: step.next.clone(),
                switches: None,
            },
        };
        let side = |counting: &mut Counting<'_>, point: &CurvePoint| counting.side(point, many);
        // Near the place Newton's method may fail: then what is known is the bracket.
        let _ = locate(&mut counting, newton, step, self.options, 0.0, side);
        self.work += counting.other.flow.work();
        Some(counting.nearest)
    }

    /// The event, or what is known where its orbit cannot be read.
    fn grazing(
        &mut self,
        equations: &mut Equations,
        step: Step<'_>,
        Bracket { before, next, .. }: &Bracket,
    ) {
        let after = self.points.len() - 1;
        let Ok((point, _)) = observe(self.problem, equations, &before.u) else {
            let (value, test) = (before.parameter(), f64::NAN);
            self.turns.push(Turn {
                kind: EventKind::Grazing { turns: false },
                value,
                test,
                after,
            });
            return;
        };
        // The orbits have the error of the flow: it is taken from states to the parameter by what both change in the step.
        let [a, b] = step.parameters();
        let change = (b - a).abs();
        let rate = change / equations.apart(&step.before.u, &step.next.u);
        let bracket = (next.parameter() - before.parameter()).abs();
        let of_orbit = self.state_error;
        let error = bracket + of_orbit * rate + TOUCHED * point.value.abs();
        self.events.push(Event {
            kind: EventKind::Grazing {
                turns: before.parameter_slope() * next.parameter_slope() < 0.0,
            },
            point,
            error,
            test: 1.0,
            after,
            contacts: 0,
            tangent: before.tangent.clone(),
        });
    }
}
