//! The charts of a branch by shooting, and of a diagram.

use hertzian_chart::{Chart, Curve, Run};

use crate::bifurcation::diagram::{Diagram, Limb};
use crate::error::Error;
use crate::event::EventKind;
use crate::report::picture::{empty_chart, event_markers, runs, unlocated};
use crate::shooting::{Cycle, CycleBranch};

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
                .flat_map(|limb| limb.branch.runs(place))
                .collect(),
        });
        let chart = curves.fold(empty_chart(&first.branch.labels), Chart::curve);
        let branches = || self.branches.iter().map(|limb| &limb.branch);
        let turns = branches().flat_map(CycleBranch::unlocated).collect();
        event_markers(branches().flat_map(CycleBranch::marked))
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

fn place(cycle: &Cycle) -> [f64; 2] {
    [cycle.value, cycle.peak_to_peak()]
}

impl CycleBranch {
    /// Peak-to-peak of the first coordinate over what the branch varies, drawn as [`Branch::chart`](crate::response::branch::Branch::chart) draws a
    /// branch of the balance.
    pub fn chart(&self) -> Chart {
        let curve = Curve {
            label: String::new(),
            runs: self.runs(place),
        };
        let period = self.cycles.first().map_or(1, |cycle| cycle.period);
        let labels = self.labels.clone().with_period(period);
        event_markers(self.marked())
            .chain([unlocated(self.unlocated().collect())])
            .fold(empty_chart(&labels).curve(curve), Chart::markers)
    }

    /// Draws the [`chart`](Self::chart) as an SVG file.
    ///
    /// # Errors
    /// If the file cannot be written.
    pub fn plot(&self, path: impl AsRef<std::path::Path>) -> Result<(), Error> {
        Ok(self.chart().write(path)?)
    }

    /// Runs of one stability each for a chart, with every orbit at its place; neighbours share the point where they meet, which is the
    /// event if there is one between them.
    #[must_use]
    pub fn runs(&self, place: impl Fn(&Cycle) -> [f64; 2]) -> Vec<Run> {
        let cycles = self.cycles.iter();
        let cycles = cycles.map(|cycle| (place(cycle), cycle.stability.verdict));
        let events = self.events.iter();
        let events = events.map(|event| (event.after, place(&event.cycle)));
        runs(cycles, &events.collect::<Vec<_>>())
    }

    fn marked(&self) -> impl Iterator<Item = (EventKind, [f64; 2])> {
        let events = self.events.iter();
        events.map(|event| (event.kind, place(&event.cycle)))
    }

    /// Where test functions change their sign without an event.
    fn unlocated(&self) -> impl Iterator<Item = [f64; 2]> {
        self.turns.iter().filter_map(|turn| {
            let [before, behind] = [
                self.cycles.get(turn.after.checked_sub(1)?)?,
                self.cycles.get(turn.after)?,
            ];
            let size = 0.5 * (before.peak_to_peak() + behind.peak_to_peak());
            Some([turn.value, size])
        })
    }
}
