//! Where a run by the contact equation is, as data: what is left of it follows from that.

use super::accept_orbit::{REFUSALS, SHORTENED};
use super::first_orbit::Remembered;
use super::method::ContactBranch;
use super::prepare_equations::{DISPLACED, HELD};
use super::test_values::Last;
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
    /// The equations.
    #[cfg_attr(feature = "serde", serde(flatten))]
    made: Made,
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
    /// The first orbit, where equations have changed since.
    #[cfg_attr(feature = "serde", serde(default))]
    first: Option<Remembered>,
}

/// What equations are made from.
#[derive(Debug, Clone, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub(super) struct Made {
    /// Where switches are.
    pub(super) placement: Placement,
    /// What was varied where they were made.
    #[cfg_attr(feature = "serde", serde(rename = "made", with = "crate::serialise"))]
    at: f64,
    #[cfg_attr(feature = "serde", serde(with = "crate::serialise"))]
    reference: Vec<f64>,
    #[cfg_attr(feature = "serde", serde(with = "crate::serialise"))]
    size: f64,
}

/// Whether these are extended unknowns, of so many.
pub(super) fn is_vector(u: &[f64], unknowns: usize) -> bool {
    u.len() == unknowns + 1 && u.iter().all(|x| x.is_finite())
}

impl Made {
    pub(super) fn of(equations: &Equations) -> Self {
        Self {
            placement: equations.skeleton.placement.clone(),
            at: equations.made,
            reference: equations.reference.clone(),
            size: equations.size,
        }
    }

    /// The equations, where there are any of this problem.
    pub(super) fn equations(&self, problem: &ContactProblem) -> Option<Equations> {
        let mut numbers = self.reference.iter().chain([&self.size, &self.at]);
        let possible = numbers.all(|x| x.is_finite())
            && self.size > 0.0
            && self.reference.len() == 2 * problem.setting.layout.coordinates;
        if !possible {
            return None;
        }
        let values = problem.setting.values(self.at)?;
        let fits = self.placement.fits(&values.contacts);
        if !fits || !problem.admits(&self.placement.beginning.recurrence) {
            return None;
        }
        let skeleton = Skeleton::new(
            problem.setting.system.as_ref(),
            &values,
            self.placement.clone(),
        );
        let (setting, reference) = (problem.setting.clone(), self.reference.clone());
        Equations::new(setting, self.at, skeleton, reference, self.size)
    }
}

impl Rest {
    /// The run that goes on with a branch. `None` where it is no rest of this branch: it may have been read from a file.
    pub(in crate::contact_equation) fn run<'r>(
        &self,
        problem: &'r ContactProblem,
        branch: &Branch,
    ) -> Option<Run<'r>> {
        let resolution = *RESOLUTIONS.get(self.resolution)?;
        let vectors = [&self.kept].into_iter().chain(&self.known);
        let mut numbers = vectors.flatten().chain(&self.finer);
        let possible = numbers.all(|x| x.is_finite())
            && self.screened.iter().all(Screened::is_possible)
            && self.refused <= REFUSALS
            && self.shortened <= SHORTENED
            && self.displaced <= DISPLACED
            && self.held <= HELD
            && self.made.placement.resolution == resolution;
        if !possible {
            return None;
        }
        let mut equations = self.made.equations(problem)?;
        let frame = Frame {
            reference: self.made.reference.clone(),
            size: self.made.size,
            resolution,
        };
        let unknowns = equations.skeleton.unknowns();
        let is_known = |known: &Vec<f64>| known.is_empty() || known.len() == unknowns + 1;
        let mut known = self.known.iter().chain([&self.kept]);
        if !self.walk.fits(unknowns) || !known.all(is_known) {
            return None;
        }
        if !self
            .last
            .as_ref()
            .is_none_or(|last| last.is_of(equations.values.order()))
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
        let (finer, screened) = run.memory();
        let first = self.first.as_ref();
        Rest {
            walk,
            made: Made::of(&run.equations),
            resolution: run.resolution,
            known: run.equations.known.to_vec(),
            finer,
            screened,
            last: self.last.clone(),
            stuck: self.stuck,
            refused: self.refused,
            shortened: self.shortened,
            displaced: self.displaced,
            kept: self.kept.clone(),
            held: self.held,
            first: first.map(|first| first.remembered.clone()),
        }
    }

    /// As it was there. Says whether it may be so: it may have been read from a file.
    pub(in crate::contact_equation) fn take_up(&mut self, rest: &Rest) -> bool {
        let unknowns = self.run.equations.skeleton.unknowns();
        let problem = self.run.problem;
        let first = rest.first.as_ref();
        self.first = first.and_then(|first| first.checked(problem, unknowns));
        (self.stuck, self.refused, self.held) = (rest.stuck, rest.refused, rest.held);
        (self.shortened, self.displaced) = (rest.shortened, rest.displaced);
        self.kept.clone_from(&rest.kept);
        self.last.clone_from(&rest.last);
        self.first.is_some() == rest.first.is_some()
    }
}
