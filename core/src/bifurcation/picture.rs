//! The chart of a diagram.

use super::diagram::Diagram;
use crate::branch::EventKind;
use crate::chart::{Chart, Curve, Line, Markers, Run};
use crate::flow::shooting::{Cycle, CycleBranch};
use crate::stability::Verdict;

/// Whether events of a kind are chosen.
type Chosen = fn(EventKind) -> bool;

impl Diagram {
    /// Peak-to-peak of the first coordinate over what is varied, one curve for each period: stable solid, unstable dashed,
    /// undecided dotted; bifurcations and grazing are marked. Titles and axes can be added.
    pub fn chart(&self) -> Chart {
        let mut periods: Vec<usize> = self.branches.iter().map(super::Limb::period).collect();
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
        let chart = curves.fold(Chart::new(""), Chart::curve);
        let kinds: [(&str, Chosen); 5] = [
            ("fold", |kind| kind == EventKind::Fold),
            ("period doubling", |kind| kind == EventKind::PeriodDoubling),
            ("broken symmetry", |kind| {
                kind == EventKind::SymmetryBreaking
            }),
            ("Neimark-Sacker", |kind| kind == EventKind::NeimarkSacker),
            ("grazing", |kind| matches!(kind, EventKind::Grazing { .. })),
        ];
        let all = || self.branches.iter().flat_map(|limb| &limb.branch.events);
        kinds.into_iter().fold(chart, |chart, (label, chosen)| {
            let points: Vec<_> = all()
                .filter(|e| chosen(e.kind))
                .map(|event| place(&event.cycle))
                .collect();
            if points.is_empty() {
                return chart;
            }
            chart.markers(Markers {
                label: label.to_owned(),
                points,
            })
        })
    }
}

fn place(cycle: &Cycle) -> [f64; 2] {
    [cycle.value, cycle.peak_to_peak()]
}

impl CycleBranch {
    /// Runs of one stability each for a chart, with every orbit at its place; neighbours share the point where they meet, which is the
    /// bifurcation if there is one between them.
    #[must_use]
    pub fn runs(&self, place: impl Fn(&Cycle) -> [f64; 2]) -> Vec<Run> {
        let mut runs: Vec<Run> = Vec::new();
        for (index, cycle) in self.cycles.iter().enumerate() {
            let line = match cycle.stability.verdict {
                Verdict::Stable => Line::Stable,
                Verdict::Unstable => Line::Unstable,
                Verdict::Undecided => Line::Undecided,
            };
            let between = self.events.iter().filter(|event| event.after == index);
            let joints: Vec<_> = between.map(|event| place(&event.cycle)).collect();
            match runs.last_mut() {
                Some(run) if run.line == line => {
                    run.points.extend(&joints);
                    run.points.push(place(cycle));
                }
                Some(run) => {
                    let joint = joints.first().copied().unwrap_or(place(cycle));
                    run.points.push(joint);
                    let points = joints.into_iter().chain([place(cycle)]).collect();
                    runs.push(Run { line, points });
                }
                None => runs.push(Run {
                    line,
                    points: joints.into_iter().chain([place(cycle)]).collect(),
                }),
            }
        }
        let behind = self
            .events
            .iter()
            .filter(|event| event.after >= self.cycles.len());
        if let Some(run) = runs.last_mut() {
            run.points.extend(behind.map(|event| place(&event.cycle)));
        }
        runs
    }
}
