//! The chart of a diagram.

use hertzian_chart::{Chart, Curve};

use crate::bifurcation::diagram::{Diagram, DiagramBranch};
use crate::branches::branch::Branch;
use crate::error::Error;
use crate::report::labels::Labels;
use crate::report::picture::{empty_chart, event_markers, unlocated};

impl Diagram {
    /// Peak-to-peak of the first coordinate over what is varied, one curve for each period: stable solid, unstable dashed,
    /// undecided dotted; events are marked, each kind by a shape of its own, and so are places where an event could not be
    /// located. Title and axes can be changed, and more can be added.
    pub fn chart(&self) -> Chart {
        let Some(first) = self.branches.first() else {
            return Chart::default();
        };
        let mut periods: Vec<usize> = self.branches.iter().map(DiagramBranch::period).collect();
        periods.sort_unstable();
        periods.dedup();
        let curves = periods.iter().map(|&period| Curve {
            label: format!("period {period}"),
            runs: self
                .branches
                .iter()
                .filter(|branch| branch.period() == period)
                .flat_map(|branch| branch.branch.runs())
                .collect(),
        });
        let chart = curves.fold(empty_chart(&Labels::of(&first.branch)), Chart::curve);
        let branches = || self.branches.iter().map(|branch| &branch.branch);
        let turns = branches().flat_map(Branch::unlocated).collect();
        event_markers(branches().flat_map(Branch::marked))
            .chain([unlocated(turns)])
            .fold(chart, Chart::markers)
    }

    /// Draws the [`chart`](Self::chart) as an SVG file.
    ///
    /// # Errors
    /// If the file cannot be written.
    pub fn plot(&self, path: impl AsRef<std::path::Path>) -> Result<(), Error> {
        Ok(self.chart().write(path)?)
    }
}
