//! Where a walk along a branch is, as data: so that it can be resumed, from a file too.
//!
//! It is taken before each step, and what a step finds follows from it and from the equations alone. A walk that is interrupted within a
//! step makes that step again, and comes to the same points to the last bit.

use super::Engine;
use super::grazing::Bent;
use super::joint::Joint;
use super::narrow::NARROWED;
use super::seen::{Crossed, Former, Seen};
use crate::branches::problem::Test;
use crate::branches::record::Kept;
use crate::continuation::follow::{CurvePoint, FollowOptions, Halted};

/// A walk along a branch before one of its steps.
#[derive(Debug, Clone, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub(crate) struct Walk {
    halted: Halted,
    /// Of Newton's method.
    #[cfg_attr(feature = "serde", serde(with = "crate::serialise"))]
    contraction: f64,
    seen: Vec<Seen>,
    #[cfg_attr(feature = "serde", serde(default))]
    former: Option<Former>,
    #[cfg_attr(feature = "serde", serde(default))]
    earlier: Option<CurvePoint>,
    /// How long the last step was.
    #[cfg_attr(feature = "serde", serde(default, with = "crate::serialise"))]
    way: f64,
    falls: Option<bool>,
    divided: Vec<(usize, Test)>,
    decided: Option<usize>,
    looked: Option<Looked>,
    /// How often the step to the next point was made again for a narrow place.
    #[cfg_attr(feature = "serde", serde(default))]
    narrowed: usize,
    /// Where levels are touched in the step before.
    #[cfg_attr(feature = "serde", serde(with = "crate::serialise"))]
    touched: Vec<f64>,
    /// The last of them, if its level is crossed from there on.
    #[cfg_attr(feature = "serde", serde(default))]
    crossed: Option<Crossed>,
    /// Touches at which the branch bends.
    #[cfg_attr(feature = "serde", serde(default))]
    bent: Vec<Bent>,
    /// The branch point that the last step passed.
    #[cfg_attr(feature = "serde", serde(default))]
    joint: Option<Joint>,
    /// A step that was made again from there, and how short.
    #[cfg_attr(feature = "serde", serde(default))]
    asked: Option<Asked>,
    /// What the branch had then.
    pub(crate) kept: Places,
}

/// Where a corner was looked for last.
#[derive(Debug, Clone, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub(super) struct Looked {
    #[cfg_attr(feature = "serde", serde(with = "crate::serialise"))]
    pub(super) at: Vec<f64>,
    /// How far ahead.
    #[cfg_attr(feature = "serde", serde(with = "crate::serialise"))]
    pub(super) step: f64,
}

/// A step that was to be made again, shorter.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub(super) struct Asked {
    /// Number of points before it.
    pub(super) points: usize,
    /// The length that was asked for last.
    #[cfg_attr(feature = "serde", serde(with = "crate::serialise"))]
    pub(super) step: f64,
}

impl Asked {
    fn is_possible(&self) -> bool {
        self.step.is_finite() && self.step > 0.0
    }
}

/// What a branch had at some time: so many points, and the events and turns at these places.
#[derive(Debug, Clone, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub(crate) struct Places {
    pub(crate) points: usize,
    pub(crate) events: Vec<usize>,
    pub(crate) turns: Vec<usize>,
}

impl Places {
    /// All that there is.
    pub(crate) fn all(kept: Kept<'_>) -> Self {
        Self {
            points: kept.points.len(),
            events: (0..kept.events.len()).collect(),
            turns: (0..kept.turns.len()).collect(),
        }
    }

    /// The places of what is brought into this order.
    pub(crate) fn sorted(places: &mut [usize], order: &[usize]) {
        for place in places {
            if let Some(new) = order.iter().position(|old| old == place) {
                *place = new;
            }
        }
    }
}

impl Walk {
    /// Whether all its vectors are those of so many unknowns, and what it says of the branch can be: it may have been read from a file.
    pub(crate) fn fits(&self, unknowns: usize) -> bool {
        let Halted {
            point,
            previous,
            before,
            first,
            ..
        } = &self.halted;
        let is_vector = |vector: &Vec<f64>| {
            vector.len() == unknowns + 1 && vector.iter().all(|x| x.is_finite())
        };
        let is_point = |point: &CurvePoint| is_vector(&point.u) && is_vector(&point.tangent);
        let points = [point, first].into_iter().chain(previous);
        let seen = self
            .seen
            .iter()
            .chain(self.crossed.as_ref().map(|at| &at.touch));
        let points = points.chain(seen.map(|seen| &seen.point));
        let points = points.chain(&self.earlier);
        let are_points = points.into_iter().all(is_point);
        are_points
            && before.iter().all(is_vector)
            && self.looked.iter().all(|looked| is_vector(&looked.at))
            && self.narrowed <= NARROWED
            && self.touched.iter().all(|value| value.is_finite())
            && self.crossed.iter().all(Crossed::is_possible)
            && self.bent.iter().all(Bent::is_possible)
            && self.joint.as_ref().is_none_or(Joint::is_possible)
            && self.asked.as_ref().is_none_or(Asked::is_possible)
            && self.halted.is_possible()
            && self.contraction.is_finite()
            && self.way.is_finite()
            && self.way >= 0.0
            && self.kept.points > 0
            && self
                .decided
                .is_none_or(|points| (1..=self.kept.points).contains(&points))
    }

    /// Whether its points have so many test functions, and nothing was divided for another one.
    pub(crate) fn tests(&self, tests: usize) -> bool {
        let is_one = |test: &Test| !matches!(test, Test::Watched(index) if *index >= tests);
        let mut seen = self
            .seen
            .iter()
            .chain(self.crossed.as_ref().map(|at| &at.touch));
        seen.all(|seen| seen.values.len() == tests)
            && self.former.iter().all(|former| former.is_possible(tests))
            && self.divided.iter().all(|(_, test)| is_one(test))
    }
}

impl Engine {
    /// Where the walk is, halted like this.
    pub(super) fn here(&self, halted: Halted, contraction: f64, kept: Kept<'_>) -> Walk {
        Walk {
            halted,
            contraction,
            seen: self.seen.clone(),
            former: self.former.clone(),
            earlier: self.earlier.clone(),
            way: self.way,
            falls: self.falls,
            divided: self.divided.clone(),
            decided: self.decided,
            looked: self.looked.clone(),
            narrowed: self.narrowed,
            touched: self.touched.clone(),
            crossed: self.crossed.clone(),
            bent: self.bent.clone(),
            joint: self.joint.clone(),
            asked: self.asked,
            kept: Places::all(kept),
        }
    }

    /// As it was there, with the halted walk and what the last correction left behind.
    pub(super) fn resumed(walk: Walk, options: FollowOptions) -> (Self, Halted, f64) {
        let engine = Self {
            seen: walk.seen,
            former: walk.former,
            earlier: walk.earlier,
            way: walk.way,
            falls: walk.falls,
            divided: walk.divided,
            decided: walk.decided,
            looked: walk.looked,
            narrowed: walk.narrowed,
            touched: walk.touched,
            crossed: walk.crossed,
            bent: walk.bent,
            joint: walk.joint,
            asked: walk.asked,
            ..Self::new(options)
        };
        (engine, walk.halted, walk.contraction)
    }
}
