//! Where a run by the contact equation is, as data: what is left of it follows from that.

use super::method::{ContactBranch, DISPLACED, HELD, Last, REFUSALS, SHORTENED};
use crate::branches::branch::Branch;
use crate::branches::engine::Walk;
use crate::contact_equation::equations::Equations;
use crate::contact_equation::equations::setting::Frame;
use crate::contact_equation::problem::{ContactProblem, RESOLUTIONS};
use crate::contact_equation::run::Run;
use crate::contact_equation::run::error_estimate::Screened;
use crate::contact_equation::skeleton::Skeleton;
use crate::contact_equation::skeleton::placement::Placement;

/// What a run goes on from.
#[derive(Debug, Clone, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub(crate) struct Rest {
    pub(in crate::contact_equation) walk: Walk,
    /// Of the equations: where switches are, and what was varied where they were made.
    placement: Placement,
    #[cfg_attr(feature = "serde", serde(with = "crate::serialise"))]
    made: f64,
    #[cfg_attr(feature = "serde", serde(with = "crate::serialise"))]
    reference: Vec<f64>,
    #[cfg_attr(feature = "serde", serde(with = "crate::serialise"))]
    size: f64,
    /// Place among the resolutions.
    resolution: usize,
    #[cfg_attr(feature = "serde", serde(with = "crate::serialise"))]
    known: Vec<Vec<f64>>,
    /// What was varied where the finer equations were made, if there are any.
    #[cfg_attr(feature = "serde", serde(with = "crate::serialise"))]
    finer: Option<f64>,
    screened: Option<Screened>,
    /// The last orbit that was kept.
    last: Option<Last>,
    /// Other equations lead nowhere from the last point.
    stuck: bool,
    /// How often the last point was refused.
    refused: usize,
    /// How often the step to the next one was made again, shorter.
    #[cfg_attr(feature = "serde", serde(default))]
    shortened: usize,
    #[cfg_attr(feature = "serde", serde(default))]
    displaced: usize,
    /// The last orbit that was kept, in the present unknowns, if it is known in them.
    #[cfg_attr(feature = "serde", serde(default, with = "crate::serialise"))]
    kept: Vec<f64>,
    /// Points that are followed before fewer nodes are tried.
    held: usize,
}

impl Rest {
    /// The run that goes on with a branch. `None` where it is no rest of this branch: it may have been read from a file.
    pub(in crate::contact_equation) fn run<'r>(
        &self,
        problem: &'r ContactProblem,
        branch: &Branch,
    ) -> Option<Run<'r>> {
        let coordinates = problem.setting.layout.coordinates;
        let resolution = *RESOLUTIONS.get(self.resolution)?;
        let vectors = [&self.reference, &self.kept].into_iter();
        let vectors = vectors.chain(&self.known);
        let numbers = vectors.flatten().chain([&self.size, &self.made]);
        let mut numbers = numbers.chain(&self.finer);
        let possible = numbers.all(|x| x.is_finite())
            && self.screened.iter().all(Screened::is_possible)
            && self.refused <= REFUSALS
            && self.shortened <= SHORTENED
            && self.displaced <= DISPLACED
            && self.held <= HELD
            && self.size > 0.0
            && self.reference.len() == 2 * coordinates
            && self.placement.resolution == resolution;
        if !possible {
            return None;
        }
        let values = problem.setting.values(self.made)?;
        let fits = self.placement.fits(&values.contacts);
        if !fits || !problem.admits(&self.placement.beginning.recurrence) {
            return None;
        }
        let skeleton = Skeleton::new(
            problem.setting.system.as_ref(),
            &values,
            self.placement.clone(),
        );
        let frame = Frame {
            reference: self.reference.clone(),
            size: self.size,
            resolution,
        };
        let (setting, reference) = (problem.setting.clone(), self.reference.clone());
        let mut equations = Equations::new(setting, self.made, skeleton, reference, self.size)?;
        let unknowns = equations.skeleton.unknowns();
        let is_known = |known: &Vec<f64>| known.is_empty() || known.len() == unknowns + 1;
        let mut known = self.known.iter().chain([&self.kept]);
        if !self.walk.fits(unknowns) || !known.all(is_known) {
            return None;
        }
        if !self
            .last
            .as_ref()
            .is_none_or(|last| last.is_of(values.order()))
        {
            return None;
        }
        let [before, last] = <&[Vec<f64>; 2]>::try_from(&self.known[..]).ok()?;
        equations.known = [before.clone(), last.clone()];
        let mut run = Run::new(problem, frame, self.resolution, equations);
        run.record = branch.kept().at(&self.walk.kept)?;
        run.remember(self.finer, self.screened.clone());
        Some(run)
    }
}

impl ContactBranch<'_, '_> {
    /// Where it is.
    pub(in crate::contact_equation) fn rest(&self, walk: Walk) -> Rest {
        let run = &*self.run;
        let equations = &run.equations;
        let (finer, screened) = run.memory();
        Rest {
            walk,
            placement: equations.skeleton.placement.clone(),
            made: equations.made,
            reference: equations.reference.clone(),
            size: equations.size,
            resolution: run.resolution,
            known: equations.known.to_vec(),
            finer,
            screened,
            last: self.last.clone(),
            stuck: self.stuck,
            refused: self.refused,
            shortened: self.shortened,
            displaced: self.displaced,
            kept: self.kept.clone(),
            held: self.held,
        }
    }

    /// As it was there.
    pub(in crate::contact_equation) fn take_up(&mut self, rest: &Rest) {
        (self.stuck, self.refused, self.held) = (rest.stuck, rest.refused, rest.held);
        (self.shortened, self.displaced) = (rest.shortened, rest.displaced);
        self.kept.clone_from(&rest.kept);
        self.last.clone_from(&rest.last);
    }
}
