//! The chart of a diagram.

use hertzian_chart::{Chart, Note};

use crate::bifurcation::diagram::{Diagram, DiagramBranch};
use crate::error::Error;
use crate::orbit::observe::Wanted;
use crate::report::drawn::Drawn;
use crate::report::labels::Labels;
use crate::report::picture;
use crate::report::view::View;

/// Of so many branches the numbers are written beside them; more would cover each other.
const NAMED: usize = 8;

impl Diagram {
    /// What [leads](crate::Branch::leading) on the first branch over what is varied, one curve for each period: stable solid, unstable dashed,
    /// undecided dotted; events are marked, each kind by a shape of its own, and so are places where an event could not be
    /// located. Title and axes can be changed, and more can be added.
    pub fn chart(&self) -> Chart {
        let first = self.branches.first().map(|first| &first.branch);
        first.map_or_else(Chart::default, |first| {
            let view = View::new();
            let drawn = self.drawn(&view, &first.leading());
            self.put_together(&view, &drawn)
        })
    }

    /// The same of what one asks for.
    ///
    /// # Errors
    /// As of [`Branch::chart_of`](crate::Branch::chart_of).
    pub fn chart_of(&self, view: &View) -> Result<Chart, Error> {
        let Some(first) = self.branches.first() else {
            return Ok(Chart::default());
        };
        let mut drawn = self.drawn(view, &view.on(&first.branch)?.wanted);
        view.check(&mut drawn)?;
        Ok(self.put_together(view, &drawn))
    }

    /// All branches as the first one is seen.
    fn drawn(&self, view: &View, wanted: &Wanted) -> Vec<Drawn<'_>> {
        let all = self.branches.iter();
        all.map(|found| Drawn::of(view.seen(&found.branch, wanted.clone())))
            .collect()
    }

    /// One curve for each period, with the numbers of branches as what is said of them has it, from one on.
    fn put_together(&self, view: &View, drawn: &[Drawn<'_>]) -> Chart {
        let Some(first) = drawn.first() else {
            return Chart::default();
        };
        let periods = self.branches.iter().map(DiagramBranch::period);
        let names: Vec<String> = periods.map(|period| format!("period {period}")).collect();
        let chart = picture::chart_of(view, &Labels::of(&first.seen), drawn, &names);
        if !(2..=NAMED).contains(&drawn.len()) {
            return chart;
        }
        drawn
            .iter()
            .enumerate()
            .fold(chart, |chart, (number, drawn)| {
                let label = format!("branch {}", number + 1);
                match drawn.clear_place() {
                    Some(point) => chart.text(Note { label, point }),
                    None => chart,
                }
            })
    }

    /// Draws the [`chart`](Self::chart) as an SVG file.
    ///
    /// # Errors
    /// If the file cannot be written.
    pub fn plot(&self, path: impl AsRef<std::path::Path>) -> Result<(), Error> {
        Ok(self.chart().write(path)?)
    }
}
