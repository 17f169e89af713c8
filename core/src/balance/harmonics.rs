//! Which harmonics are unknowns, and how their equations are coupled.

use super::blocks::places;
use super::{Lattice, Resolution};
use crate::continuation::jacobian::Partition;
use crate::numeric::fourier::series;

/// The harmonics of every coordinate, in increasing order.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct Harmonics {
    /// Coupled densely.
    pub(super) core: Vec<usize>,
    /// Each by itself and to the core.
    pub(super) tail: Vec<usize>,
}

impl Harmonics {
    pub(super) fn of(resolution: Resolution) -> Self {
        let Resolution {
            harmonics, core, ..
        } = resolution;
        let Lattice { first, step } = resolution.lattice();
        let (core, tail) = (first..=harmonics)
            .step_by(step)
            .partition(|&k| k <= core.max(first));
        Self { core, tail }
    }

    /// The highest harmonic that couples harmonics: that of the core and the highest of all, together.
    pub(super) fn coupling(&self) -> usize {
        let core = self.core.last().copied().unwrap_or(0);
        core + self.tail.last().copied().unwrap_or(core)
    }

    /// The unknowns in the order of the rows of the Jacobian: the core coordinate by coordinate, the tail harmonic by
    /// harmonic.
    pub(super) fn partition(&self, coordinates: usize, harmonics: usize) -> Partition {
        let length = series::length(harmonics);
        let of = |coordinate: usize, k: usize| {
            let first = coordinate * length + if k == 0 { 0 } else { 2 * k - 1 };
            first..first + if k == 0 { 1 } else { 2 }
        };
        let core: Vec<usize> = (0..coordinates)
            .flat_map(|i| self.core.iter().flat_map(move |&k| of(i, k)))
            .collect();
        debug_assert_eq!(core.len(), coordinates * places(&self.core));
        let tail = self.tail.iter();
        Partition {
            unknowns: coordinates * length,
            core,
            tail: tail
                .flat_map(|&k| (0..coordinates).flat_map(move |i| of(i, k)))
                .collect(),
            group: 2 * coordinates,
            chained: 0,
            pairs: 0,
        }
    }
}
