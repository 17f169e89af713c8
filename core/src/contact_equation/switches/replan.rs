//! An orbit of a branch, and the branch beside it, in other equations.
//!
//! Unknowns `U(u)` of an orbit in other equations follow from its motion ([`transfer`]). A tangent `t` in these is a central difference,
//!
//! ```text
//! (U(u + e t) - U(u - e t)) / (2 e)                                                                            (1)
//! ```
//!
//! Source: Abramowitz and Stegun (1964), Handbook of Mathematical Functions, section 25.3 (numerical differentiation).

use super::plan::Plan;
use super::transfer;
use crate::contact_equation::equations::Equations;
use crate::contact_equation::equations::setting::Frame;
use crate::contact_equation::problem::RESOLUTIONS;
use crate::contact_equation::run::{Run, difference_step};
use crate::contact_equation::skeleton::placement::Told;
use crate::continuation::follow::CurvePoint;

/// A step that changes `H` of a pair by a larger part of it may lead over its touch.
const MOVED: f64 = 0.1;

impl Run<'_> {
    /// Equations that fit the orbit at these unknowns better, and its unknowns there.
    pub(in crate::contact_equation) fn replanned(
        &mut self,
        u: &[f64],
    ) -> Option<(Equations, Vec<f64>)> {
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
    pub(in crate::contact_equation) fn transferred(
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
    pub(in crate::contact_equation) fn point_in(
        &mut self,
        point: &CurvePoint,
        to: &Equations,
        near: &[f64],
    ) -> Option<CurvePoint> {
        let u = self.transferred(&point.u, to, near)?;
        let step = difference_step(&self.equations.skeleton, &point.u, &point.tangent);
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
}
