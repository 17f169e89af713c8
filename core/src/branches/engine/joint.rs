//! The way to a branch point at which a branch ends on one of more regular orbits.
//!
//! A step that leads onto the other branch has no end of its own, and what happens in it up to the branch point shows between no two points.
//! So the branch point is located along the other branch, and the step made again, shorter, until a small part of it is left. The
//! branch runs into the point with its parameter as the square of the way that is left: of the range of the parameter less than that is.
//!
//! Source: Govaerts (2000), Numerical Methods for Bifurcations of Dynamical Equilibria, chapter 8 (the square at a pitchfork).

use super::Engine;
use crate::branches::problem::BranchProblem;
use crate::continuation::follow::Step;
use crate::continuation::newton::Newton;

/// This part of the way to the branch point is gone in one step, and half of it where that leads onto the other branch again.
const PART: f64 = 0.7;
/// The part of the first distance from it that may be left.
const LEFT: f64 = 0.05;
/// A step that leads no nearer to the branch point than to this part of the way began where the one before did.
const NEARER: f64 = 0.9;
/// Steps that are made again, at most.
const AGAIN: usize = 8;

/// A branch point that a step has passed.
#[derive(Debug, Clone, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub(super) struct Joint {
    /// How far it was from the last point when it was passed first, and is now.
    #[cfg_attr(feature = "serde", serde(with = "crate::serialise"))]
    whole: f64,
    #[cfg_attr(feature = "serde", serde(with = "crate::serialise"))]
    left: f64,
    /// Steps that were made again.
    again: usize,
    /// How many of them from the last point.
    halved: i32,
}

impl Joint {
    /// Whether it is of numbers that a walk can have: it may have been read from a file.
    pub(super) fn is_possible(&self) -> bool {
        let positive = |x: f64| x.is_finite() && x > 0.0;
        positive(self.whole)
            && positive(self.left)
            && self.again <= AGAIN
            && (0..=AGAIN as i32).contains(&self.halved)
    }
}

impl Engine {
    /// Has a step onto another branch be made again, shorter, unless it began just before the branch point. Says whether.
    pub(super) fn comes_nearer(
        &mut self,
        problem: &mut dyn BranchProblem,
        newton: &mut Newton,
        step: Step<'_>,
    ) -> bool {
        let known = self.joint.take();
        if known.as_ref().is_some_and(|joint| joint.again == AGAIN) {
            return false;
        }
        let Some(point) = problem.joint(newton, step, self.options.newton) else {
            return false;
        };
        let way = Step {
            before: step.before,
            next: &point,
        };
        let left = newton.norm().length(step.before.scale, &way.difference());
        let joint = match known {
            None => Joint {
                whole: left,
                left,
                again: 1,
                halved: 0,
            },
            Some(joint) => Joint {
                left,
                again: joint.again + 1,
                halved: if left < NEARER * joint.left {
                    0
                } else {
                    joint.halved + 1
                },
                ..joint
            },
        };
        if !joint.is_possible() || left <= LEFT * joint.whole {
            return false;
        }
        // A branch point that lies beyond the step is none of it.
        let whole = newton.norm().length(step.before.scale, &step.difference());
        let length = PART * 0.5_f64.powi(joint.halved) * left.min(whole);
        if length < self.options.steps.smallest {
            return false;
        }
        self.back = Some((step.before.clone(), length));
        self.joint = Some(joint);
        problem.goes_on();
        true
    }
}
