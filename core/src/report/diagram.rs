//! The chart of a diagram.

use crate::bifurcation::diagram::{Diagram, Limb};
use crate::branches::branch::Branch;
use crate::chart::{Chart, Curve};
use crate::error::Error;
use crate::report::labels::Labels;

impl Diagram {
    /// Peak-to-peak of the first coordinate over what is varied, one curve for each period: stable solid, unstable dashed,
    /// undecided dotted; events are marked, each kind by a shape of its own, and so are places where an event could not be
    /// located. Title and axes can be changed, and more can be added.
    pub fn chart(&self) -> Chart {
        let Some(first) = self.branches.first() else {
            return Chart::default();
        };
        let mut periods: Vec<usize> = self.branches.iter().map(Limb::period).collect();
        periods.sort_unstable();
        periods.dedup();
        let curves = periods.iter().map(|&period| Curve {
            label: format!("period {period}"),
            runs: self
                .branches
                .iter()
                .filter(|limb| limb.period() == period)
                .flat_map(|limb| limb.branch.runs())
                .collect(),
        });
        let chart = curves.fold(Labels::of(&first.branch).chart(), Chart::curve);
        let branches = || self.branches.iter().map(|limb| &limb.branch);
        chart
            .events(branches().flat_map(Branch::marked))
            .unlocated(branches().flat_map(Branch::unlocated).collect())
    }

    /// Draws the [`chart`](Self::chart) as an SVG file.
    ///
    /// # Errors
    /// If the file cannot be written.
    pub fn plot(&self, path: impl AsRef<std::path::Path>) -> Result<(), Error> {
        Ok(self.chart().write(path)?)
    }
}
