//! The attractors that are known.

use super::attractor::Attractor;

/// Attractors in the order in which they were found.
#[derive(Debug, Clone, Default)]
pub(super) struct Catalogue(pub(super) Vec<Attractor>);

impl Catalogue {
    /// The attractor that a motion from a state is known to end on.
    pub(super) fn find(&self, state: &[f64]) -> Option<usize> {
        self.0.iter().position(|attractor| attractor.holds(state))
    }

    /// The number of an attractor, which is added unless it is there already.
    pub(super) fn add(&mut self, new: Attractor) -> usize {
        let same = |known: &Attractor| {
            known.period == new.period && new.points.iter().any(|point| known.holds(point))
        };
        self.0.iter().position(same).unwrap_or_else(|| {
            self.0.push(new);
            self.0.len() - 1
        })
    }
}
