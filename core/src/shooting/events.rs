//! Events of a branch: where a test function vanishes between two orbits, and how well that is known.
//!
//! The test functions are those of [`tested`](super::tested). A place is reported if it solves the equations and the function was
//! driven to zero there; its error is what a companion makes of it.

use std::cell::RefCell;

use super::companion::{self, Companion, multipliers};
use super::cycle::{Cycle, CycleEvent};
use super::equations::Equations;
use super::run::{Run, add, observe};
use super::setting::Setting;
use super::tested::{Change, Test, Tests};
use crate::continuation::crossing::locate_crossing;
use crate::continuation::follow::CurvePoint;
use crate::continuation::locate::locate;
use crate::continuation::newton::{Newton, NewtonOptions};
use crate::event::{EventKind, Turn};
use crate::numeric::spectrum::{distance, eigenvalues};
use crate::orbit::stability::Stability;

/// Brackets of an event are narrowed until rounding stops it, or this is reached.
const VANISHED: f64 = 1e-14;
/// What rounding leaves in the value of an event.
const ROUNDING: f64 = 4.0 * f64::EPSILON;

/// Where it is zero.
struct Place {
    point: CurvePoint,
    test: f64,
    /// What the search leaves in the parameter.
    error: f64,
}

/// What the other multipliers make of a determinant that vanishes with the one nearest to a critical value, and of its rounding.
fn others(equations: &mut Equations, u: &[f64], critical: f64) -> f64 {
    let Ok(map) = equations.map(u, &mut |_| {}) else {
        return 1.0;
    };
    let mut distances: Vec<f64> = eigenvalues(&map)
        .iter()
        .map(|m| (m - critical).norm())
        .collect();
    distances.sort_by(f64::total_cmp);
    let product: f64 = distances.iter().skip(1).product();
    let largest = distances.last().copied().unwrap_or(1.0);
    product.max(1.0) * largest.max(1.0)
}

/// Whether the pair of multipliers whose product is nearest to one is complex.
fn complex(equations: &mut Equations, u: &[f64]) -> bool {
    let map = equations.map(u, &mut |_| {}).ok();
    map.is_some_and(|map| Tests::of(Some(&map), 0.0).complex)
}

impl Run<'_> {
    /// Locates an event between two points.
    pub(super) fn event(
        &mut self,
        equations: &mut Equations,
        newton: &mut Newton,
        between: (&CurvePoint, &CurvePoint),
        change: Change,
    ) {
        let options = self.options;
        // The point behind the event has been stored already, unless it is on the branch that this one joins.
        let after = self.cycles.len() - usize::from(self.joined.is_none());
        let place = self.place(equations, newton, between, options, change, VANISHED);
        let Some(place) = place else {
            let value = 0.5 * (between.0.parameter() + between.1.parameter());
            let (kind, test) = (change.kind, f64::NAN);
            self.turns.push(Turn {
                kind,
                value,
                test,
                after,
            });
            return;
        };
        // A pair of real multipliers whose product is one is nothing special.
        if change.test == Test::Pairs && !complex(equations, &place.point.u) {
            return;
        }
        let (value, test) = (place.point.parameter(), place.test);
        // A slope is relative to the range, and rounding to the value.
        let unit = match change.test {
            Test::Slope => (value.abs() / place.point.scale.parameter).max(1.0),
            Test::Bordered => {
                others(equations, &place.point.u, 1.0) / place.point.parameter_slope().abs()
            }
            Test::Plus => others(equations, &place.point.u, -1.0),
            Test::Pairs => 1.0,
        };
        let vanishes = test.abs() <= self.setting.vanishing(equations.frame.ratio) * unit;
        let event = vanishes.then(|| self.event_at(equations, between, change, &place));
        match event.flatten() {
            Some(event) => self.events.push(CycleEvent { after, ..event }),
            None => self.turns.push(Turn {
                kind: change.kind,
                value,
                test,
                after,
            }),
        }
    }

    /// Where a test function of these equations vanishes.
    fn place(
        &mut self,
        equations: &mut Equations,
        newton: &mut Newton,
        between: (&CurvePoint, &CurvePoint),
        options: NewtonOptions,
        change: Change,
        vanished: f64,
    ) -> Option<Place> {
        // The problem is busy while a test function is evaluated.
        let other = RefCell::new(equations.again(self.setting).ok()?);
        let value = |point: &CurvePoint| {
            if change.test == Test::Slope {
                return point.parameter_slope();
            }
            let map = other.borrow_mut().map(&point.u, &mut |_| {}).ok();
            Tests::of(map.as_ref(), point.parameter_slope()).value(change.test)
        };
        let place = if change.kind == EventKind::BranchPoint {
            locate_crossing(equations, newton, between, options, value).map(|crossing| Place {
                point: crossing.point,
                test: crossing.test,
                error: crossing.error,
            })
        } else {
            locate(equations, newton, between, options, vanished, value).map(|located| Place {
                point: located.point,
                test: located.test,
                error: 0.0,
            })
        };
        add(&mut self.work, other.borrow().flow.work());
        place
    }

    /// The event at a place, compared with that of the companion.
    fn event_at(
        &mut self,
        equations: &mut Equations,
        between: (&CurvePoint, &CurvePoint),
        change: Change,
        place: &Place,
    ) -> Option<CycleEvent> {
        let (span, frame) = (equations.span, equations.frame.clone());
        let size = between.0.scale.oscillation;
        let Companion {
            equations: mut others,
            mut newton,
            options,
            part,
            finer,
            noise,
        } = Companion::new(self.setting, span, frame, size).ok()?;
        let moved = self.place(&mut others, &mut newton, between, options, change, VANISHED);
        self.statistics += newton.statistics;
        let (event, at) = match &moved {
            None => {
                let (cycle, _) = observe(self.setting, equations, &place.point.u).ok()?;
                ((cycle, f64::INFINITY), place)
            }
            Some(moved) => {
                let (here, there) = ((equations, place), (&mut others, moved));
                // What is reported is the finer one, or the one that is not disturbed.
                let (best, other) = if finer { (there, here) } else { (here, there) };
                let at = best.1;
                (
                    compared(self.setting, change.kind, best, other, (part, noise))?,
                    at,
                )
            }
        };
        add(&mut self.work, others.flow.work());
        let (cycle, error) = event;
        Some(CycleEvent {
            kind: change.kind,
            cycle,
            error,
            test: at.test,
            after: 0,
            direction: at.point.tangent.clone(),
        })
    }
}

/// An event of some equations with its errors, and the error of its value: a part of what it is in others.
fn compared(
    setting: &Setting,
    kind: EventKind,
    (equations, place): (&mut Equations, &Place),
    (others, moved): (&mut Equations, &Place),
    (part, noise): (f64, f64),
) -> Option<(Cycle, f64)> {
    let half = equations.span.half;
    let u = &place.point.u;
    let (mut cycle, map) = observe(setting, equations, u).ok()?;
    let by = (moved.point.parameter() - cycle.value).abs();
    let error = part * by + place.error + moved.error + ROUNDING * cycle.value.abs();
    cycle.error = Some(part * equations.apart(u, &moved.point.u));
    if let Some(map) = map {
        let found = multipliers(&map, half);
        let there = others.map(&moved.point.u, &mut |_| {}).ok()?;
        let there = multipliers(&there, half);
        // One of them is known.
        let critical = match kind {
            EventKind::PeriodDoubling => -1.0,
            _ => 1.0,
        };
        let nearest = found.iter().map(|m| match kind {
            EventKind::NeimarkSacker => (m.norm() - 1.0).abs(),
            _ => (m - critical).norm(),
        });
        let spread = part * distance(&found, &there)
            + nearest.fold(f64::INFINITY, f64::min)
            + companion::moved(&map, &found, half, noise * map.norm().max(1.0));
        cycle.stability = Stability::of(found, spread);
    }
    Some((cycle, error))
}
