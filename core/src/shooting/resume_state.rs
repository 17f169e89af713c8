//! Where a run of shooting is, as data: what is left of it follows from that.

use super::equations::{Equations, Frame, Span};
use super::method::ShootingBranch;
use super::problem::ShootingProblem;
use super::run::Run;
use super::start::First;
use crate::branches::branch::Branch;
use crate::branches::engine::Walk;
use crate::error::Error;

/// What a run goes on from.
#[derive(Debug, Clone, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub(crate) struct Rest {
    pub(super) walk: Walk,
    span: Span,
    frame: Frame,
    #[cfg_attr(feature = "serde", serde(with = "crate::serialise"))]
    size: f64,
    /// Of Newton's method for the reference.
    #[cfg_attr(feature = "serde", serde(with = "crate::serialise"))]
    contraction: f64,
    #[cfg_attr(feature = "serde", serde(with = "crate::serialise"))]
    state_error: f64,
}

impl Rest {
    /// The equations that it goes on with. `None` where it is no rest of this branch: it may have been read from a file.
    ///
    /// # Errors
    /// If there is no flow.
    pub(super) fn first(
        &self,
        problem: &ShootingProblem,
        branch: &Branch,
    ) -> Result<Option<First>, Error> {
        let (Some(point), Frame { reference, .. }) = (branch.points.first(), &self.frame) else {
            return Ok(None);
        };
        let orbit = &point.orbit;
        let order = 2 * orbit.coordinates;
        let positive = |x: f64| x.is_finite() && x > 0.0;
        let of_branch = self.span.recurrence == orbit.recurrence()
            && self.span.segments.checked_mul(order) == Some(orbit.states.len())
            && self.frame.variable == problem.variable
            && reference.len() == orbit.coordinates
            && reference.iter().all(|x| x.is_finite())
            && self.contraction.is_finite()
            && [self.frame.omega, self.frame.ratio, self.size]
                .into_iter()
                .all(positive)
            && self.walk.fits(orbit.states.len());
        if !of_branch {
            return Ok(None);
        }
        let (span, frame) = (self.span.clone(), self.frame.clone());
        let equations = Equations::new(problem, problem.source.tolerance, span, frame)?;
        let u = equations.unknowns_of(&orbit.states, point.value);
        let size = self.size;
        Ok(Some(First { equations, u, size }))
    }
}

impl ShootingBranch<'_, '_> {
    /// Where it is.
    pub(super) fn rest(&self, walk: Walk) -> Rest {
        Rest {
            walk,
            span: self.equations.span.clone(),
            frame: self.equations.frame.clone(),
            size: self.run.size,
            contraction: self.run.reference.newton.contraction(),
            state_error: self.run.state_error,
        }
    }
}

impl Run<'_> {
    /// Takes up what the branch had. Says whether it has that.
    pub(super) fn take_up(&mut self, rest: &Rest, branch: &Branch) -> bool {
        let Some(record) = branch.kept().at(&rest.walk.kept) else {
            return false;
        };
        self.record = record;
        self.state_error = rest.state_error;
        self.reference.newton.remember_contraction(rest.contraction);
        true
    }
}
