//! Whether a symmetry breaks where branches cross: coordinates that are in each other's place at every time cease to be.
//!
//! The map over the part that is followed commutes with such a permutation `S` of coordinates, where the orbits of a branch have it. A
//! multiplier of one whose direction has it too is a crossing of orbits alike; of one that has not, orbits without the symmetry begin, which
//! `S` takes into each other.
//!
//! Source: Golubitsky, Stewart and Schaeffer (1988), Singularities and Groups in Bifurcation Theory II, chapter XIII (block structure).

use nalgebra::{DMatrix, DVector};

use super::equations::Equations;
use super::minimal_period::SameState;
use super::run::Run;
use crate::branches::recurrence::SignedPermutation;

/// A direction that is farther from its image than this part of its length has not the symmetry.
const APART: f64 = 0.5;

impl Run<'_> {
    /// The permutations that the last orbit has.
    fn had(&self, equations: &Equations) -> impl Iterator<Item = &SignedPermutation> {
        let same = self.same_state(equations);
        let last = self.record.points.last().map(|point| point.orbit.state());
        let images = self.problem.at_once.iter();
        images.filter(move |image| {
            let state = last.as_ref();
            state.is_some_and(|state| has(equations, state, image, same))
        })
    }

    /// Whether orbits without a permutation begin at the crossing `u` that the last orbit has.
    pub(super) fn breaks_symmetry(&self, equations: &mut Equations, u: &[f64]) -> bool {
        if self.problem.at_once.is_empty() {
            return false;
        }
        let Ok(map) = equations.map(u, &mut |_| {}) else {
            return false;
        };
        breaks(&map, self.had(equations))
    }

    /// Whether the state of an orbit has a permutation that the last one has not: the branch has met one of orbits with it.
    pub(super) fn gains_symmetry(
        &self,
        equations: &Equations,
        state: &[f64],
        same: SameState,
    ) -> bool {
        let had: Vec<_> = self.had(equations).collect();
        let mut images = self.problem.at_once.iter();
        images.any(|image| !had.contains(&image) && has(equations, state, image, same))
    }
}

/// Whether the direction in which the map leaves states alone has not one of these permutations.
pub(crate) fn breaks<'p>(
    map: &DMatrix<f64>,
    mut had: impl Iterator<Item = &'p SignedPermutation>,
) -> bool {
    let identity = DMatrix::<f64>::identity(map.nrows(), map.ncols());
    let svd = (map - identity).svd(false, true);
    let smallest = svd.singular_values.imin();
    let Some(v) = svd.v_t.map(|v| v.row(smallest).transpose()) else {
        return false;
    };
    let coordinates = v.len() / 2;
    had.any(|image| {
        let moved = image.of_states(v.as_slice(), coordinates);
        (DVector::from_vec(moved) - &v).norm() > APART
    })
}

/// Whether a state is its image.
fn has(equations: &Equations, state: &[f64], image: &SignedPermutation, same: SameState) -> bool {
    image.holds(state, same.part * same.size, equations.frame.omega)
}
