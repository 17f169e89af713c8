//! The first orbit of a branch whose equations have changed since. Whether the branch closes is told by where that orbit is in the present
//! unknowns.
//!
//! It stays in its own equations, and is looked up anew in those that the walk goes over to. Where these have no place for it, or one that an orbit
//! far away tells, it is looked for again when the walk comes near it.

use super::resume_state::{Made, is_vector};
use crate::contact_equation::equations::Equations;
use crate::contact_equation::problem::{ContactProblem, RESOLUTIONS};
use crate::contact_equation::run::Run;
use crate::continuation::follow::CurvePoint;
use crate::continuation::newton::Newton;

/// A walk may pass in one step what is no farther ahead than so many of its last steps.
const AHEAD: f64 = 4.0;
/// Places of one orbit differ by less than this, in units of the orbit.
const SAME: f64 = 1e-6;

/// The first orbit as data.
#[derive(Debug, Clone, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub(in crate::contact_equation) struct Remembered {
    made: Made,
    /// As a point of its equations.
    point: CurvePoint,
    /// Its present unknowns, as the walk has them; empty where it has no place in them.
    #[cfg_attr(feature = "serde", serde(with = "crate::serialise"))]
    here: Vec<f64>,
}

impl Remembered {
    /// With its equations, where it may be one of this problem and has a place in so many present unknowns: it may have been read from a file.
    pub(super) fn checked(&self, problem: &ContactProblem, unknowns: usize) -> Option<FirstOrbit> {
        if !RESOLUTIONS.contains(&self.made.placement.resolution) {
            return None;
        }
        let equations = self.made.equations(problem)?;
        let own = equations.skeleton.unknowns();
        let CurvePoint { u, tangent, scale } = &self.point;
        let positive = |x: f64| x.is_finite() && x > 0.0;
        let possible = is_vector(u, own)
            && is_vector(tangent, own)
            && (self.here.is_empty() || is_vector(&self.here, unknowns))
            && [scale.oscillation, scale.mean, scale.parameter].map(positive) == [true; 3];
        possible.then(|| FirstOrbit {
            remembered: self.clone(),
            equations,
        })
    }
}

/// The first orbit with its equations.
pub(in crate::contact_equation) struct FirstOrbit {
    pub(super) remembered: Remembered,
    equations: Equations,
}

impl FirstOrbit {
    /// As a point of equations which the walk is about to leave.
    pub(super) fn new(run: &Run<'_>, point: &CurvePoint) -> Option<Self> {
        let made = Made::of(&run.equations);
        let equations = made.equations(run.problem)?;
        Some(Self {
            remembered: Remembered {
                made,
                point: point.clone(),
                here: point.u.clone(),
            },
            equations,
        })
    }

    /// Its present unknowns become these, or it has no place in them. Returns the former ones.
    pub(super) fn is_at(&mut self, here: Vec<f64>) -> Vec<f64> {
        std::mem::replace(&mut self.remembered.here, here)
    }

    /// It as a point of other equations, in which an orbit has the unknowns `near`.
    pub(super) fn placed(
        &mut self,
        run: &mut Run<'_>,
        to: &Equations,
        near: &[f64],
    ) -> Option<CurvePoint> {
        std::mem::swap(&mut run.equations, &mut self.equations);
        let found = run.point_in(&self.remembered.point, to, near);
        std::mem::swap(&mut run.equations, &mut self.equations);
        let found = found?;
        let mut numbers = found.u.iter().chain(&found.tangent);
        numbers.all(|x| x.is_finite()).then_some(found)
    }

    /// It as a point of the present equations, where the next step after the one from `before` to `at` may pass it and it is not known to be there.
    pub(super) fn ahead(
        &mut self,
        run: &mut Run<'_>,
        before: &[f64],
        at: &CurvePoint,
    ) -> Option<CurvePoint> {
        if before.len() != at.u.len() {
            return None;
        }
        let newton = Newton::new(&run.equations);
        let apart = |a: &[f64], b: &[f64]| {
            let difference: Vec<f64> = a.iter().zip(b).map(|(x, y)| x - y).collect();
            newton.norm().length(at.scale, &difference)
        };
        let farthest = AHEAD * apart(before, &at.u);
        let ahead = self.remembered.point.parameter() - at.parameter();
        if ahead.abs() > farthest * at.scale.parameter {
            return None;
        }
        std::mem::swap(&mut run.equations, &mut self.equations);
        let found = run.point_in(&self.remembered.point, &self.equations, &at.u);
        std::mem::swap(&mut run.equations, &mut self.equations);
        let found = found?;
        let here = &self.remembered.here;
        let is_near = apart(&found.u, &at.u) <= farthest;
        let is_known = !here.is_empty() && apart(&found.u, here) <= SAME;
        (is_near && !is_known).then_some(found)
    }
}
