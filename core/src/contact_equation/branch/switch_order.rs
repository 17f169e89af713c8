//! Orbits between two points of a branch that have the switches of different gaps in another order.
//!
//! Equations are exact while their switches are in the order that they are told in. Where that changes within a step, those of either end are
//! right to first order beyond the change alone: test functions there, and events, are those of equations that are told in the order of the
//! orbit itself, which is solved for again with them. What the order is of is in [`skeleton`](crate::contact_equation::skeleton), why a wrong one is right to
//! first order at the pass of an interval ([`pass`](crate::contact_equation::equations::pass)).

use nalgebra::{Complex, DMatrix};

use super::events;
use crate::branches::moduli;
use crate::branches::point::Event;
use crate::branches::problem::Zero;
use crate::contact_equation::equations::Equations;
use crate::contact_equation::run::Run;
use crate::continuation::follow::{CurvePoint, Step};
use crate::continuation::newton::{Border, Newton, NewtonOptions};
use crate::event::EventKind;
use crate::numeric::linear::dot;

/// What the order changes is small.
const OPTIONS: NewtonOptions = NewtonOptions {
    tolerance: 1e-11,
    iterations: 8,
    damped: false,
};

/// The slope of a branch along what is varied where a fold may be near.
const NEAR_FOLD: f64 = 0.1;

/// Solves for an orbit, and its tangent: at its value, or near a fold, where no value tells one, in the plane across its tangent. Says whether
/// it was found.
fn solve(equations: &mut Equations, point: &mut CurvePoint) -> bool {
    let mut newton = Newton::new(equations);
    let last = point.u.len() - 1;
    let mut row = vec![0.0; point.u.len()];
    let near_fold = point.parameter_slope().abs() < NEAR_FOLD;
    if near_fold {
        // Where only the direction of what is varied is known, it tells no orbit.
        if point.tangent[..last].iter().all(|t| *t == 0.0) {
            return false;
        }
        let norm = newton.norm();
        norm.linear_form(point.scale, &point.tangent, &mut row);
    } else {
        row[last] = 1.0 / point.scale.parameter;
    }
    let border = Border {
        row: &row,
        value: dot(&row, &point.u),
    };
    let corrected = newton.correct(equations, &mut point.u, border, point.scale, OPTIONS);
    let mut tangent = vec![0.0; point.u.len()];
    if corrected.is_err() || !newton.tangent(equations, &point.u, &mut tangent, true) {
        return false;
    }
    let norm = newton.norm();
    // Beside a touch a tangent in other unknowns is a difference across it, and may lead back; what is varied does not.
    let along = if near_fold {
        norm.product(point.scale, &tangent, &point.tangent)
    } else {
        tangent[last] * point.tangent[last]
    };
    let length = norm.length(point.scale, &tangent).copysign(along);
    let taken = tangent.iter().map(|t| t / length);
    point
        .tangent
        .iter_mut()
        .zip(taken)
        .for_each(|(t, taken)| *t = taken);
    true
}

impl Run<'_> {
    /// Equations with the switches of an orbit in their order, and the orbit by them. Nothing where the present ones have them so, or where
    /// none are found.
    pub(super) fn ordered(&mut self, at: &CurvePoint) -> Option<(Equations, CurvePoint)> {
        self.equations.compute(&at.u, false);
        if self.equations.failed || self.equations.is_in_order() {
            return None;
        }
        let (mut equations, near) = self.replanned(&at.u)?;
        let mut point = self.point_in(at, &equations, &near)?;
        if !solve(&mut equations, &mut point) {
            return None;
        }
        equations.compute(&point.u, false);
        let fits = !equations.failed && equations.is_in_order();
        fits.then_some((equations, point))
    }

    /// The map over the period, by equations that have the switches in their order.
    pub(in crate::contact_equation) fn map(&mut self, at: &CurvePoint) -> Option<DMatrix<f64>> {
        let map = self.equations.map(&at.u);
        map.or_else(|| {
            let (mut equations, point) = self.ordered(at)?;
            equations.map(&point.u)
        })
    }

    /// What the other multipliers make of a determinant that vanishes with the one nearest to a critical value.
    pub(in crate::contact_equation) fn others(&mut self, at: &CurvePoint, critical: f64) -> f64 {
        let Some(map) = self.map(at) else {
            return 1.0;
        };
        let distance = |m: &Complex<f64>| (m - critical).norm();
        let mut distances: Vec<f64> = moduli::of_map(&map).iter().map(distance).collect();
        distances.sort_by(f64::total_cmp);
        let product: f64 = distances.iter().skip(1).product();
        product.max(1.0) * distances.last().copied().unwrap_or(1.0).max(1.0)
    }

    /// The slope of what is varied, by equations that have the switches in their order.
    pub(in crate::contact_equation) fn slope(&mut self, at: &CurvePoint) -> f64 {
        let ordered = self.ordered(at);
        ordered.map_or_else(
            || at.parameter_slope(),
            |(_, point)| point.parameter_slope(),
        )
    }

    /// The event at a zero, by equations that have the switches in their order there. Crossings of branches, which lie in the direction of the
    /// step and its unknowns, are those of the present equations.
    pub(in crate::contact_equation) fn event(
        &mut self,
        step: Step<'_>,
        zero: &Zero,
        kind: EventKind,
    ) -> Option<Event> {
        let crosses = zero.change.kind == EventKind::BranchPoint;
        let at = &zero.root.located.point;
        let ordered = if crosses { None } else { self.ordered(at) };
        let Some((equations, point)) = ordered else {
            return events::event(self, step, zero, kind);
        };
        let mut zero = zero.clone();
        zero.root.located.point = point;
        self.with(equations, |run| events::event(run, step, &zero, kind))
    }

    /// Does something with other equations.
    pub(in crate::contact_equation) fn with<T>(
        &mut self,
        equations: Equations,
        work: impl FnOnce(&mut Self) -> T,
    ) -> T {
        let former = std::mem::replace(&mut self.equations, equations);
        let kept = (self.finer.take(), self.screened.take());
        let done = work(self);
        self.equations = former;
        (self.finer, self.screened) = kept;
        done
    }
}
