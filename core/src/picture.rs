//! The chart of a branch.

use crate::branch::{Branch, Point};
use crate::chart::{Chart, Curve, Line, Markers, Run};
use crate::stability::Verdict;

impl Branch<'_> {
    /// Peak-to-peak of the first coordinate over what the branch varies: stable solid, unstable dashed, undecided
    /// dotted; folds are marked, and so are turns that were not confirmed as folds. More can be added before it is written.
    pub fn chart(&self) -> Chart {
        let coordinate = &self.follower.system.facts().coordinates[0];
        let folds = self
            .folds()
            .map(|fold| place(&fold.point))
            .collect::<Vec<_>>();
        let turns = self.turns.iter().filter_map(|turn| {
            let [before, behind] = [
                self.points.get(turn.after.checked_sub(1)?)?,
                self.points.get(turn.after)?,
            ];
            let size = 0.5 * (before.peak_to_peak() + behind.peak_to_peak());
            Some([turn.value, size])
        });
        Chart::new(self.title())
            .x(self.name_of_varied())
            .y(format!("peak-to-peak of {coordinate}"))
            .curve(Curve {
                label: String::new(),
                runs: self.runs(),
            })
            .markers(Markers {
                label: "fold".to_owned(),
                points: folds,
            })
            .markers(Markers {
                label: "turn, unconfirmed".to_owned(),
                points: turns.collect(),
            })
    }

    /// The branch as runs of one stability each; neighbours share the point where they meet, which is the fold if
    /// there is one between them.
    pub fn runs(&self) -> Vec<Run> {
        let mut runs: Vec<Run> = Vec::new();
        for (index, point) in self.points.iter().enumerate() {
            let line = line_of(point);
            let here = place(point);
            let folds = self.folds().filter(|fold| fold.after == index);
            let joint = folds.map(|fold| place(&fold.point)).next();
            match runs.last_mut() {
                Some(run) if run.line == line => {
                    run.points.extend(joint);
                    run.points.push(here);
                }
                Some(run) => {
                    let joint = joint.unwrap_or(here);
                    run.points.push(joint);
                    runs.push(Run {
                        line,
                        points: vec![joint, here],
                    });
                }
                None => runs.push(Run {
                    line,
                    points: vec![here],
                }),
            }
        }
        runs
    }

    /// The system and everything that is the same all along the branch.
    fn title(&self) -> String {
        let facts = self.follower.system.facts();
        let Some(point) = self.points.first() else {
            return facts.name.to_string();
        };
        let parameters = facts
            .parameters
            .iter()
            .zip(&point.parameters)
            .filter(|(parameter, _)| parameter.name != self.varied)
            .map(|(parameter, value)| format!("{} = {value}", parameter.name));
        let omega = (self.varied != "omega").then(|| format!("omega = {}", point.omega()));
        let period = Some(point.orbit.period).filter(|&period| period > 1);
        let values: Vec<String> = parameters
            .chain(omega)
            .chain(period.map(|period| format!("period {period}")))
            .collect();
        if values.is_empty() {
            facts.name.to_string()
        } else {
            format!("{}: {}", facts.name, values.join(", "))
        }
    }

    /// What is written at the horizontal axis: a parameter by its name and the first line of its documentation.
    fn name_of_varied(&self) -> String {
        if self.varied == "omega" {
            return "excitation frequency ω".to_owned();
        }
        let facts = self.follower.system.facts();
        let parameter = facts.parameters.iter().find(|p| p.name == self.varied);
        let documentation = parameter.and_then(|p| p.documentation.lines().next());
        match documentation.map(str::trim).filter(|line| !line.is_empty()) {
            Some(line) => format!("{} ({line})", self.varied),
            None => self.varied.clone(),
        }
    }
}

fn place(point: &Point) -> [f64; 2] {
    [point.value, point.peak_to_peak()]
}

fn line_of(point: &Point) -> Line {
    match point.stability.verdict {
        Verdict::Stable => Line::Stable,
        Verdict::Unstable => Line::Unstable,
        Verdict::Undecided => Line::Undecided,
    }
}
