//! What a branch has gathered, and the equations that it is followed by: what finer ones have shown of errors ([`error_estimate`]), and which contacts
//! are in each other's place when an orbit has come back ([`images`]). What is read off an orbit is in [`reading`](super::reading), how other
//! equations come about in [`switches`](super::switches).

pub(super) mod error_estimate;
pub(super) mod images;

use std::ops::Range;

use self::error_estimate::Screened;
use super::equations::Equations;
use super::equations::setting::Frame;
use super::linear_part::contact::Contact;
use super::orbit::gaps::{At, Gaps};
use super::orbit::motion::Motion;
use super::problem::{ContactProblem, RESOLUTIONS};
use super::reading::overlooked::Sharp;
use super::skeleton::Skeleton;
use crate::branches::moduli::LastMap;
use crate::branches::point::Point;
use crate::branches::record::Record;
use crate::branches::recurrence::Recurrence;
use crate::continuation::statistics::Statistics;
use crate::laws::generic::scales::Scales;

/// Differences along a tangent move no unknown by more than this part of the largest of its kind: forces may be 1e10 and gaps 1.
const DIFFERENCE: f64 = 1e-5;
/// Nor do they go farther than this in units of the orbit.
const FARTHEST: f64 = 1e-2;

/// How far along a tangent differences go.
pub(super) fn difference_step(skeleton: &Skeleton, u: &[f64], tangent: &[f64]) -> f64 {
    let (order, told, all) = (skeleton.order, skeleton.told(), skeleton.unknowns());
    let largest = |of: &[f64]| of.iter().fold(0.0, |most: f64, x| most.max(x.abs()));
    let part = |kind: Range<usize>| {
        let [moved, size] = [tangent, u].map(|of| largest(&of[kind.clone()]));
        if size > 0.0 { moved / size } else { 0.0 }
    };
    let kinds = [0..order, told..all, all..all + 1].map(part);
    // Switches are phases.
    let most = kinds
        .into_iter()
        .fold(largest(&tangent[order..told]), f64::max);
    (DIFFERENCE / most).min(FARTHEST)
}

/// Multipliers may be wrong by so many times as much as peak-to-peak. Where they are wrong by more than they are away from the unit circle,
/// events are seen that are none.
pub(super) const MULTIPLIERS: f64 = 100.0;

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
    pub(super) last_map: LastMap,
    pub(super) record: Record,
    pub(super) statistics: Statistics,
    /// Errors of the orbit that was read last, and of its multipliers, apart from those of its value, where these cannot be as small as is asked
    /// for: the branch is vertical, and no nodes make its value better known than rounding.
    pub(super) own_errors: Option<[f64; 2]>,
    /// What the branch has met.
    pub(super) joined: Option<Recurrence>,
    /// Where the law of each contact may have narrow places.
    pub(super) sharp: Vec<Option<Sharp>>,
}

impl<'r> Run<'r> {
    pub(super) fn new(
        problem: &'r ContactProblem,
        frame: Frame,
        resolution: usize,
        equations: Equations,
    ) -> Self {
        let contacts = equations.values.contacts.iter();
        let law = |contact: &Contact| equations.setting.system.law(contact.law);
        let sharp = contacts.map(|contact| Scales::of(law(contact)).map(Sharp::of));
        Self {
            sharp: sharp.collect(),
            problem,
            frame,
            resolution,
            equations,
            finer: None,
            screened: None,
            last_map: LastMap::default(),
            record: Record::default(),
            statistics: Statistics::default(),
            own_errors: None,
            joined: None,
        }
    }

    /// How many times as large as the tolerance the errors of a point are, of those that nodes decide.
    pub(super) fn excess(&self, point: &Point) -> f64 {
        let sizes = point.stability.multipliers.iter().map(|m| m.norm());
        let largest = sizes.fold(1.0, f64::max);
        let asked = self.problem.asked.stability;
        let stated = [point.error.unwrap_or(0.0), point.stability.error];
        let [error, of_multipliers] = self.own_errors.unwrap_or(stated);
        let spread = if asked { of_multipliers } else { 0.0 };
        let errors = [error, spread / (MULTIPLIERS * largest)];
        errors[0].max(errors[1]) / self.problem.tolerance
    }

    /// Whether the errors of a point ask for more nodes, and there are more. They are of no use where no force is unknown.
    pub(super) fn is_coarse(&self, point: &Point) -> bool {
        let has_nodes = self.equations.skeleton.forces > 0;
        // What rounding has grown to is as large with more of them.
        let rounding = self.grown() / self.problem.tolerance;
        let may_be_finer = has_nodes && self.resolution + 1 < RESOLUTIONS.len();
        may_be_finer && self.excess(point) > 1.0 + rounding
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
    pub(super) fn at<T>(
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
}
