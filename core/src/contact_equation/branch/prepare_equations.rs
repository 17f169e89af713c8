//! Equations that the walk goes on with where the present ones do not fit its last orbit: for other switches, with panels that end elsewhere,
//! or with more nodes.

use super::method::ContactBranch;
use crate::branches::engine::STOPPED;
use crate::contact_equation::equations::Equations;
use crate::continuation::follow::CurvePoint;
use crate::shooting::test_functions::Tests;

/// A step is made again shorter so often at most where the orbit before it has no place in the equations of the point: what disappears between
/// both may do so in any step.
pub(super) const DISPLACED: usize = 3;
/// So many points are followed with more nodes before fewer are tried: a number of nodes that was not enough is not tried again at once.
pub(super) const HELD: usize = 12;

/// What the walk goes on with.
pub(super) struct Next {
    pub(super) equations: Equations,
    pub(super) u: Vec<f64>,
    pub(super) resolution: usize,
    pub(super) same: Same,
}

/// The most that equations have in common with those before.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Same {
    /// The orbit alone.
    Orbit,
    /// Its switches too: panels end elsewhere.
    Switches,
    /// Its panels too: pairs of switches are told by other shapes of their gaps.
    Panels,
}

impl ContactBranch<'_, '_> {
    /// Prepares the equations that fit an orbit. Says whether there are any.
    pub(super) fn prepare(&mut self, u: &[f64], resolution: usize) -> bool {
        let former = std::mem::replace(&mut self.run.resolution, resolution);
        let planned = self.run.replanned(u);
        self.run.resolution = former;
        if resolution > former {
            self.held = HELD;
        }
        self.next = planned.map(|(equations, u)| Next {
            equations,
            u,
            resolution,
            same: Same::Orbit,
        });
        self.next.is_some()
    }

    /// Prepares the same equations with panels that end at the kinks of an orbit. Says whether there are any.
    pub(super) fn prepare_at_kinks(&mut self, u: &[f64]) -> bool {
        let found = self.run.equations.at_kinks(u);
        self.next = found.map(|equations| Next {
            u: self.run.equations.rearranged(&equations, u),
            equations,
            resolution: self.run.resolution,
            same: Same::Switches,
        });
        self.next.is_some()
    }

    /// Prepares the same equations with pairs that are told by the shapes of gaps on an orbit. Says whether these are others.
    pub(super) fn prepare_reshaped(&mut self, at: &CurvePoint) -> bool {
        let skeleton = self.run.reshaped(&at.u);
        let value = self.run.equations.made;
        let found = skeleton.and_then(|skeleton| self.run.equations.on(skeleton, value));
        self.next = found.map(|equations| {
            let (from, to) = (&self.run.equations.skeleton, &equations.skeleton);
            let [u, _] = from.told_by(to, &at.u, &at.tangent);
            Next {
                u,
                equations,
                resolution: self.run.resolution,
                same: Same::Panels,
            }
        });
        self.next.is_some()
    }

    /// Whether the equations that were prepared have a place for the last orbit that was kept, where the present ones have one. Panels that end at the kinks of
    /// another orbit may step over its own, and are to tell the same of its multipliers.
    fn holds_last(&mut self) -> bool {
        let Some(next) = self.next.as_mut().filter(|_| !self.kept.is_empty()) else {
            return true;
        };
        if next.same == Same::Orbit {
            let placed = self.run.transferred(&self.kept, &next.equations, &next.u);
            return placed.is_some();
        }
        let there = self.run.equations.rearranged(&next.equations, &self.kept);
        let Some(last) = self.last.as_ref().filter(|last| !last.map.is_empty()) else {
            return true;
        };
        let map = next.equations.map(&there);
        map.is_none_or(|map| Tests::of(Some(&map), last.slope).tell_as(&last.tests()))
    }

    /// Whether the step to an orbit is to be made again, shorter, since the equations that were prepared there have no place for the orbit before
    /// it: what happened in the step is looked for between points that both have a place in them.
    pub(super) fn is_displaced(&mut self) -> bool {
        if self.displaced >= DISPLACED || self.holds_last() {
            return false;
        }
        let kept = std::mem::take(&mut self.kept);
        // Where a gap hardly passes its level any more, no step is short enough.
        let is_slow = !kept.is_empty() && self.run.slowest(&kept) < STOPPED;
        self.kept = kept;
        if is_slow {
            return false;
        }
        self.next = None;
        self.displaced += 1;
        self.refused = 0;
        true
    }
}
