//! What is done with the curve of orbits: what is read off every orbit, and which equations the next ones have.
//!
//! Unknowns `U(u)` of an orbit in other equations follow from its motion ([`transfer`]). A tangent `t` in these is a central difference,
//!
//! ```text
//! (U(u + e t) - U(u - e t)) / (2 e)                                                                            (1)
//! ```
//!
//! Source: Abramowitz and Stegun (1964), Handbook of Mathematical Functions, section 25.3 (numerical differentiation).

use nalgebra::Complex;

use super::equations::Equations;
use super::gaps::{At, Gaps};
use super::motion::Motion;
use super::placement::Told;
use super::plan::{Frame, Plan};
use super::problem::{ContactProblem, RESOLUTIONS};
use super::reading::Screened;
use super::rest::Rest;
use super::transfer;
use crate::branches::record::Record;
use crate::branches::recurrence::Recurrence;
use crate::continuation::follow::CurvePoint;
use crate::continuation::statistics::Statistics;
use crate::numeric::spectrum::eigenvalues;

/// Tangents in other unknowns are differences over so much of the largest entry.
pub(super) const DIFFERENCE: f64 = 1e-5;
/// A step that changes `H` of a pair by a larger part of it may lead over its touch.
const MOVED: f64 = 0.1;

/// An extreme belongs to a pair of switches whose middle is as near, in parts of the phase to the next extreme if that is less than one.
pub(super) const SAME: f64 = 0.3;

/// What a branch has gathered, and the equations that it is followed by.
pub(super) struct Run<'r> {
    pub(super) problem: &'r ContactProblem,
    pub(super) frame: Frame,
    /// Place among the resolutions.
    pub(super) resolution: usize,
    pub(super) equations: Equations,
    /// The same orbits with more nodes, made when they are asked for.
    pub(super) finer: Option<Equations>,
    /// What the last of them has said.
    pub(super) screened: Option<Screened>,
    pub(super) record: Record,
    pub(super) statistics: Statistics,
    /// What the branch has met.
    pub(super) joined: Option<Recurrence>,
    /// Where it was before the last step.
    pub(super) rest: Option<Box<Rest>>,
}

impl<'r> Run<'r> {
    pub(super) fn new(
        problem: &'r ContactProblem,
        frame: Frame,
        resolution: usize,
        equations: Equations,
    ) -> Self {
        Self {
            problem,
            frame,
            resolution,
            equations,
            finer: None,
            screened: None,
            record: Record::default(),
            statistics: Statistics::default(),
            joined: None,
            rest: None,
        }
    }

    /// What it remembers beside its equations: what was varied where finer ones were made, and what these have said.
    pub(super) fn memory(&self) -> (Option<f64>, Option<Screened>) {
        let finer = self.finer.as_ref().map(|finer| finer.made);
        (finer, self.screened.clone())
    }

    /// Remembers that.
    pub(super) fn remember(&mut self, finer: Option<f64>, screened: Option<Screened>) {
        self.finer = finer.and_then(|made| self.equations.finer_equations(made));
        self.screened = screened;
    }

    /// Forgets the finer equations, since there are others.
    pub(super) fn clear_finer(&mut self) {
        self.finer = None;
        self.screened = None;
    }

    pub(super) fn gaps<'g>(&'g self, at: At<'g>) -> Gaps<'g> {
        Gaps {
            values: &self.equations.values,
            at,
            coordinates: self.equations.values.linear.positions.nrows(),
        }
    }

    /// Looks at the motion at unknowns of the present equations.
    fn at<T>(
        &mut self,
        u: &[f64],
        look: impl FnOnce(&Motion<'_>, &Gaps<'_>) -> Option<T>,
    ) -> Option<T> {
        self.equations.compute(u, false);
        if self.equations.failed {
            return None;
        }
        let motion = Motion::of(&self.equations);
        let at = |phase: f64, state: &mut [f64]| motion.at(phase, state);
        look(&motion, &self.gaps(&at))
    }

    /// Equations that fit the orbit at these unknowns better, and its unknowns there.
    pub(super) fn replanned(&mut self, u: &[f64]) -> Option<(Equations, Vec<f64>)> {
        let frame = Frame {
            resolution: RESOLUTIONS[self.resolution],
            ..self.frame.clone()
        };
        let setting = &self.problem.setting;
        self.at(u, |motion, gaps| {
            let plan: Plan = transfer::replanned(motion, u, gaps);
            plan.equations(setting, u[u.len() - 1], gaps, &frame)
        })
    }

    /// An orbit as unknowns of other equations, in which one near it has the unknowns `near`.
    pub(super) fn transferred(
        &mut self,
        u: &[f64],
        to: &Equations,
        near: &[f64],
    ) -> Option<Vec<f64>> {
        self.at(u, |motion, gaps| {
            transfer::transferred(motion, u, gaps, to, near)
        })
    }

    /// A point of the branch as one of other equations. Its tangent is (1).
    pub(super) fn point_in(
        &mut self,
        point: &CurvePoint,
        to: &Equations,
        near: &[f64],
    ) -> Option<CurvePoint> {
        let u = self.transferred(&point.u, to, near)?;
        let step = DIFFERENCE / point.tangent.iter().fold(1e-3, |m: f64, t| m.max(t.abs()));
        let along = self.beside_touches(point, step);
        let mut beside = |step: f64| {
            let moved = point.u.iter().zip(&along);
            let moved: Vec<f64> = moved.map(|(x, t)| x + step * t).collect();
            self.transferred(&moved, to, near)
        };
        let ends = beside(step).zip(beside(-step));
        let tangent = ends.map_or_else(
            || {
                // The direction of what is varied is known.
                let mut tangent = vec![0.0; u.len()];
                tangent[u.len() - 1] = point.tangent[point.tangent.len() - 1];
                tangent
            },
            |(a, b)| {
                a.iter()
                    .zip(&b)
                    .map(|(x, y)| (x - y) / (2.0 * step))
                    .collect()
            },
        );
        Some(CurvePoint {
            u,
            tangent,
            scale: point.scale,
        })
    }

    /// A tangent along which differences over a step are taken. Where a gap begins to open within a stretch, its ends move as the root of `H`, and
    /// forces at nodes with them, which a tangent does not say; what the opening does to the rest vanishes as that root, so that `H` stays.
    fn beside_touches(&self, point: &CurvePoint, step: f64) -> Vec<f64> {
        let skeleton = &self.equations.skeleton;
        let mut tangent = point.tangent.clone();
        for switch in &skeleton.switches {
            if let Told::First { other, .. } = switch.told {
                let slot = skeleton.slot(other);
                if step * tangent[slot].abs() > MOVED * point.u[slot].abs() {
                    tangent[slot] = 0.0;
                }
            }
        }
        tangent
    }

    /// What the other multipliers make of a determinant that vanishes with the one nearest to a critical value.
    pub(super) fn others(&mut self, at: &CurvePoint, critical: f64) -> f64 {
        let Some(map) = self.map(at) else {
            return 1.0;
        };
        let distance = |m: &Complex<f64>| (m - critical).norm();
        let mut distances: Vec<f64> = eigenvalues(&map).iter().map(distance).collect();
        distances.sort_by(f64::total_cmp);
        let product: f64 = distances.iter().skip(1).product();
        product.max(1.0) * distances.last().copied().unwrap_or(1.0).max(1.0)
    }
}
