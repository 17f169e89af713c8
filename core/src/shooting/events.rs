//! Events of a branch: where a test function vanishes between two orbits, and how well that is known.
//!
//! The test functions are those of [`tested`](super::tested). A place is reported if it solves the equations and the function was
//! driven to zero there; its error is what a companion makes of it.

use std::cell::RefCell;

use super::companion::{self, Companion, multipliers};
use super::equations::Equations;
use super::method::VANISHED;
use super::run::{Run, observe, relative};
use super::setting::Setting;
use super::tested::{Test, Tests};
use crate::branches::point::{Event, Point};
use crate::branches::problem::{Change, Zero};
use crate::continuation::crossing::locate_crossing;
use crate::continuation::follow::{CurvePoint, Step};
use crate::continuation::locate::locate;
use crate::continuation::newton::{Newton, NewtonOptions};
use crate::event::EventKind;
use crate::numeric::spectrum::{distance, eigenvalues};
use crate::orbit::stability::Stability;

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
pub(super) fn others(equations: &mut Equations, u: &[f64], critical: f64) -> f64 {
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

impl Run<'_> {
    /// Where a test function of these equations vanishes.
    fn place(
        &mut self,
        equations: &mut Equations,
        newton: &mut Newton,
        step: Step<'_>,
        options: NewtonOptions,
        change: Change,
    ) -> Option<Place> {
        // The problem is busy while a test function is evaluated.
        let other = RefCell::new(equations.again(self.setting).ok()?);
        let value = |_: &mut Equations, point: &CurvePoint| {
            let test = Test::of(change.test);
            if test == Test::Slope {
                return point.parameter_slope();
            }
            let map = other.borrow_mut().map(&point.u, &mut |_| {}).ok();
            Tests::of(map.as_ref(), point.parameter_slope()).value(test)
        };
        let place = if change.kind == EventKind::BranchPoint {
            locate_crossing(equations, newton, step, options, value).map(|crossing| Place {
                point: crossing.point,
                test: crossing.test,
                error: crossing.error,
            })
        } else {
            locate(equations, newton, step, options, VANISHED, value).map(|located| Place {
                point: located.point,
                test: located.test,
                error: 0.0,
            })
        };
        self.work += other.borrow().flow.work();
        place
    }

    /// The event at a place, compared with that of the companion.
    pub(super) fn event_at(
        &mut self,
        equations: &mut Equations,
        step: Step<'_>,
        zero: &Zero,
    ) -> Option<Event> {
        let change = zero.change;
        let place = &Place {
            point: zero.located.point.clone(),
            test: zero.located.test,
            error: zero.error,
        };
        let (span, frame) = (equations.span, equations.frame.clone());
        let size = step.before.scale.oscillation;
        let Companion {
            equations: mut others,
            mut newton,
            options,
            part,
            finer,
            noise,
        } = Companion::new(self.setting, span, frame, size).ok()?;
        let moved = self.place(&mut others, &mut newton, step, options, change);
        self.statistics += newton.statistics;
        let (event, at) = match &moved {
            None => {
                let (read, _) = observe(self.setting, equations, &place.point.u).ok()?;
                ((read, f64::INFINITY), place)
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
        self.work += others.flow.work();
        let (read, error) = event;
        Some(Event {
            kind: change.kind,
            point: read,
            error,
            test: at.test,
            after: zero.after,
            contacts: 0,
            tangent: at.point.tangent.clone(),
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
) -> Option<(Point, f64)> {
    let half = equations.span.half;
    let u = &place.point.u;
    let (mut read, map) = observe(setting, equations, u).ok()?;
    let by = (moved.point.parameter() - read.value).abs();
    let error = part * by + place.error + moved.error + ROUNDING * read.value.abs();
    read.error = Some(relative(part * equations.apart(u, &moved.point.u), &read));
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
        read.stability = Stability::of(found, spread);
    }
    Some((read, error))
}
