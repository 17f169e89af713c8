//! The walk goes over to the equations that were prepared for it, with its last points and the first orbit in their unknowns; and back, where they
//! lead nowhere.

use super::first_orbit::FirstOrbit;
use super::method::ContactBranch;
use super::prepare_equations::{Next, Same};
use crate::contact_equation::equations::Equations;
use crate::continuation::follow::{CurvePoint, Halted};
use crate::continuation::newton::Newton;
use crate::continuation::problem::Scale;

/// What is varied at a point that has no place in other equations: far beyond every range.
const NOWHERE: f64 = f64::MAX;

/// What the walk was followed by before.
pub(super) struct Before {
    equations: Equations,
    resolution: usize,
    /// The first orbit in these equations, where it was remembered.
    first: Vec<f64>,
}

/// A point that no curve passes, in so many extended unknowns.
fn nowhere(scale: Scale, length: usize) -> CurvePoint {
    let mut u = vec![0.0; length];
    u[length - 1] = NOWHERE;
    CurvePoint {
        u,
        tangent: vec![0.0; length],
        scale,
    }
}

/// Beside a touch a tangent in other unknowns is a difference across it, and may lead back. The last step tells which way the walk goes.
fn look_ahead(at: &mut CurvePoint, previous: &CurvePoint, equations: &Equations) {
    let step: Vec<f64> = at.u.iter().zip(&previous.u).map(|(a, b)| a - b).collect();
    let newton = Newton::new(equations);
    if newton.norm().product(at.scale, &step, &at.tangent) < 0.0 {
        at.tangent = step;
    }
}

impl ContactBranch<'_, '_> {
    /// Where the first orbit of a walk is in the equations that it goes on with.
    fn first_in(&mut self, halted: &Halted, next: &Next) -> Option<CurvePoint> {
        let begun = !self.run.record.points.is_empty() && halted.first.parameter() < NOWHERE;
        if self.first.is_none() && begun {
            self.first = FirstOrbit::new(self.run, &halted.first);
        }
        let first = self.first.as_mut()?;
        // Between equations with the same switches unknowns go over as they are.
        if next.same != Same::Orbit && halted.first.parameter() < NOWHERE {
            return self.point_in(&halted.first, next);
        }
        first.placed(self.run, &next.equations, &next.u)
    }

    /// A point of the branch in the equations that the walk goes on with, if it has a place there.
    fn point_in(&mut self, of: &CurvePoint, next: &Next) -> Option<CurvePoint> {
        let Next {
            equations, u, same, ..
        } = next;
        let found = match same {
            Same::Orbit => self.run.point_in(of, equations, u)?,
            Same::Switches => CurvePoint {
                u: self.run.equations.rearranged(equations, &of.u),
                tangent: self.run.equations.rearranged(equations, &of.tangent),
                scale: of.scale,
            },
            Same::Panels => {
                let (from, to) = (&self.run.equations.skeleton, &equations.skeleton);
                let [u, tangent] = from.told_by(to, &of.u, &of.tangent);
                CurvePoint {
                    u,
                    tangent,
                    scale: of.scale,
                }
            }
        };
        let mut numbers = found.u.iter().chain(&found.tangent);
        numbers.all(|x| x.is_finite()).then_some(found)
    }

    /// Whether a halted walk keeps its unknowns, and something else of it changes.
    fn keeps_unknowns(&mut self, halted: &mut Halted) -> bool {
        if std::mem::take(&mut self.passes_first) {
            halted.passes_first();
            self.moved = None;
            self.before = None;
            return true;
        }
        if let Some(found) = self.first_here.take() {
            let first = self.first.as_mut();
            self.moved = first.map(|first| first.is_at(found.u.clone()));
            halted.first = found;
            self.before = None;
            return true;
        }
        false
    }

    /// The walk goes on with what was prepared: its last points as points of that.
    pub(super) fn change_equations(&mut self, halted: &mut Halted) {
        if self.keeps_unknowns(halted) {
            return;
        }
        self.moved = None;
        let Some(next) = self.next.take() else {
            self.before = None;
            return;
        };
        let length = next.u.len();
        let first = self.first_in(halted, &next);
        let mut point = |of: &CurvePoint| self.point_in(of, &next);
        if let Some(known) = point(&halted.point) {
            halted.point.tangent = known.tangent;
        } else {
            halted.point.tangent = vec![0.0; length];
        }
        halted.point.u.clone_from(&next.u);
        halted.previous = halted.previous.as_ref().and_then(&mut point);
        halted.earlier = halted.earlier.as_ref().and_then(&mut point);
        if let Some(previous) = &halted.previous {
            look_ahead(&mut halted.point, previous, &next.equations);
        }
        let here = first
            .as_ref()
            .map_or_else(Vec::new, |first| first.u.clone());
        let place = self.first.as_mut().map(|place| place.is_at(here));
        // A curve is not closed where its first point has no place.
        halted.first = first.unwrap_or_else(|| nowhere(halted.first.scale, length));
        // Before an orbit was kept there is no first one yet.
        if halted.first.parameter() >= NOWHERE && !self.run.record.points.is_empty() {
            halted.loses_first_direction();
        }
        self.kept = match &halted.previous {
            _ if self.refused == 0 => next.u.clone(),
            Some(previous) => previous.u.clone(),
            None => Vec::new(),
        };
        halted.before = None;
        let Next {
            equations,
            u,
            resolution,
            ..
        } = next;
        let former = std::mem::replace(&mut self.run.resolution, resolution);
        let known = std::mem::replace(&mut self.run.equations, equations);
        self.run.equations.known = [u, Vec::new()];
        self.run.clear_finer();
        self.before = Some(Before {
            equations: known,
            resolution: former,
            first: place.unwrap_or_default(),
        });
        self.tested = None;
    }

    /// Goes back to the equations before, since the walk leads nowhere by the others.
    pub(super) fn restore_equations(&mut self) {
        if let (Some(first), Some(former)) = (&mut self.first, self.moved.take()) {
            first.is_at(former);
        }
        if let Some(before) = self.before.take() {
            self.run.equations = before.equations;
            self.run.resolution = before.resolution;
            if let Some(first) = &mut self.first {
                first.is_at(before.first);
            }
            self.run.clear_finer();
            self.tested = None;
            self.kept.clear();
            self.stuck = true;
        }
    }
}
