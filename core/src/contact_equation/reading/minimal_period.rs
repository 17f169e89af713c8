//! Whether an orbit comes back in less time than it is followed for: before its period is over, or with coordinates or contacts in each
//! other's place.
//!
//! A motion is told by its state at one phase, since equations of motion have one solution from each. If the state there is as (1) of
//! [`recurrence`](crate::branches::recurrence) asks for, `q(t + j T/m) = S^j q(t)`, it is so for ever. States are compared to ten times the
//! tolerance, from 1e-7 to 1e-4 of the size.

use std::convert::Infallible;
use std::f64::consts::TAU;

use crate::branches::observed::Motion as Extent;
use crate::branches::recurrence::{
    CyclicSymmetry, Recurrence, SignedPermutation, are_near, least, may_be_earlier,
};
use crate::contact_equation::equations::Equations;
use crate::contact_equation::orbit::extents;
use crate::contact_equation::orbit::gaps::At;
use crate::contact_equation::orbit::motion::Motion;
use crate::contact_equation::problem::ContactProblem;
use crate::contact_equation::run::Run;
use crate::continuation::follow::{CurvePoint, Stop};
use crate::shooting::breaks;

/// Two states of a solution that differ by this part of the size are one, at least; the accuracy that is asked for tells more.
const SAME: f64 = 1e-7;
const COARSEST: f64 = 1e-4;
/// The same in parts of the tolerance.
const TOLERANCES: f64 = 10.0;
/// At a branch point states are known to the root of what the value is known to.
const NEAR: f64 = 1e-4;

/// What a state is compared by: a phase where it is taken, and the unit of velocities.
#[derive(Clone, Copy)]
pub(in crate::contact_equation) struct Compared {
    pub(in crate::contact_equation) begin: f64,
    pub(in crate::contact_equation) rate: f64,
    /// States that differ by less are one.
    pub(in crate::contact_equation) most: f64,
    pub(in crate::contact_equation) coordinates: usize,
}

impl Compared {
    /// The states of the solution of the last pass, which may be smaller than those that its equations began with.
    pub(in crate::contact_equation) fn of(equations: &Equations, part: f64) -> Self {
        let motion = Motion::of(equations);
        let extents = extents::sampled(&motion);
        let ranges = extents.iter().map(Extent::peak_to_peak);
        let size = 0.5 * ranges.fold(0.0, f64::max);
        Self {
            begin: equations.skeleton.begin,
            rate: equations.values.base,
            most: part * equations.size.min(size),
            coordinates: equations.skeleton.order / 2,
        }
    }

    /// Whether two states are one.
    fn are_one(&self, state: &[f64], other: &[f64]) -> bool {
        are_near(state, other, self.most, self.rate)
    }

    /// Those permutations that leave a state alone.
    fn held<'p>(
        &self,
        state: &[f64],
        images: &'p [SignedPermutation],
    ) -> Vec<&'p SignedPermutation> {
        let holds = |image: &&SignedPermutation| image.holds(state, self.most, self.rate);
        images.iter().filter(holds).collect()
    }

    /// How a motion comes back in less time than it is given to, the least that there is; `None` if it does not.
    pub(in crate::contact_equation) fn earlier(
        &self,
        at: At<'_>,
        given: &Recurrence,
        symmetries: &[CyclicSymmetry],
    ) -> Option<Recurrence> {
        let state = |phase: f64| {
            let mut state = vec![0.0; 2 * self.coordinates];
            at(phase, &mut state);
            state
        };
        let first = state(self.begin);
        let comes_back = |symmetry: usize, steps: usize, recurrence: &Recurrence| {
            let part = steps as f64 / symmetries[symmetry].parts as f64;
            let image = recurrence.image.of_states(&first, self.coordinates);
            Ok(self.are_one(&state(self.begin + TAU * part), &image))
        };
        let Ok(least) = least::<Infallible>(given, symmetries, comes_back);
        least
    }
}

impl ContactProblem {
    /// By what part of the size two states of solutions differ that are one.
    pub(in crate::contact_equation) fn same(&self) -> f64 {
        (TOLERANCES * self.tolerance).clamp(SAME, COARSEST)
    }

    /// How the orbit of the last pass comes back in less time than it is followed for.
    pub(in crate::contact_equation) fn earlier(
        &self,
        equations: &Equations,
        part: f64,
    ) -> Option<Recurrence> {
        let given = equations.skeleton.recurrence();
        if !self.may_be_earlier(given) {
            return None;
        }
        let motion = Motion::of(equations);
        let at = |phase: f64, state: &mut [f64]| motion.at(phase, state);
        Compared::of(equations, part).earlier(&at, given, &self.asked.symmetries)
    }

    /// Whether there may be orbits that come back in less time.
    pub(super) fn may_be_earlier(&self, given: &Recurrence) -> bool {
        may_be_earlier(given, &self.asked.symmetries)
    }

    /// Whether orbits may come back like this.
    pub(in crate::contact_equation) fn admits(&self, recurrence: &Recurrence) -> bool {
        let whole = Recurrence::whole(self.asked.period);
        let mut symmetries = self.asked.symmetries.iter();
        *recurrence == whole
            || symmetries.any(|symmetry| {
                let mut within = symmetry.within(&whole);
                within.any(|(_, other)| other == *recurrence)
            })
    }

    /// Permutations of coordinates that the orbit of the last pass has at every time.
    pub(in crate::contact_equation) fn at_once(
        &self,
        equations: &Equations,
        part: f64,
    ) -> Vec<&SignedPermutation> {
        if self.asked.at_once.is_empty() {
            return Vec::new();
        }
        let compared = Compared::of(equations, part);
        let mut state = vec![0.0; 2 * compared.coordinates];
        Motion::of(equations).at(compared.begin, &mut state);
        compared.held(&state, &self.asked.at_once)
    }
}

impl Run<'_> {
    /// How the orbit at a point comes back in less time than it is followed for, or that it has a permutation which the last one has not.
    pub(in crate::contact_equation) fn earlier(&mut self, at: &CurvePoint) -> Option<Recurrence> {
        let given = self.equations.skeleton.recurrence();
        let problem = self.problem;
        let any = problem.may_be_earlier(given) || !problem.asked.at_once.is_empty();
        if self.record.points.is_empty() || !any {
            return None;
        }
        self.equations.compute(&at.u, problem.asked.stability);
        self.met(problem.same())
    }

    /// The same of the last pass.
    fn met(&self, part: f64) -> Option<Recurrence> {
        let given = self.equations.skeleton.recurrence();
        if self.equations.failed || !self.equations.is_in_order() {
            return None;
        }
        let earlier = self.problem.earlier(&self.equations, part);
        earlier.or_else(|| {
            let had = self.had();
            let has = self.problem.at_once(&self.equations, part);
            let gains = has.iter().any(|image| !had.contains(image));
            gains.then(|| given.clone())
        })
    }

    /// The permutations that the last orbit has.
    fn had(&self) -> Vec<&SignedPermutation> {
        let Some(last) = self.record.points.last() else {
            return Vec::new();
        };
        let compared = Compared::of(&self.equations, self.problem.same());
        compared.held(&last.orbit.state(), &self.problem.asked.at_once)
    }

    /// Whether orbits without a permutation begin at the crossing that the last orbit has.
    pub(in crate::contact_equation) fn breaks_symmetry(&mut self, u: &[f64]) -> bool {
        if self.problem.asked.at_once.is_empty() {
            return false;
        }
        let Some(map) = self.equations.map(u) else {
            return false;
        };
        breaks(&map, self.had().into_iter())
    }

    /// Why the branch ends at the last event, if the orbit there is more regular than asked for: what follows is the same orbits again,
    /// looked at from elsewhere.
    pub(in crate::contact_equation) fn meets(&mut self, u: &[f64]) -> Option<Stop> {
        let given = self.equations.skeleton.recurrence();
        if !self.problem.may_be_earlier(given) && self.problem.asked.at_once.is_empty() {
            return None;
        }
        self.equations.compute(u, false);
        let met = self.met(self.problem.same().max(NEAR));
        let event = self.record.events.last()?;
        let (after, value) = (event.after, event.point.value);
        self.joined = met;
        let stop = self.joined.as_ref()?.joined_at(value);
        // The orbits behind the point are those before it.
        self.record.points.truncate(after);
        self.record.is_joint(after);
        Some(stop)
    }
}
