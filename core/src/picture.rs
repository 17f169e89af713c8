//! The chart of a branch.

use crate::branch::{Branch, Point};
use crate::chart::{Chart, Curve, Line, Markers, Reference, Run};
use crate::stability::Verdict;

impl Branch<'_> {
    /// Peak-to-peak of the first coordinate over what the branch varies: stable solid, unstable dashed, undecided
    /// dotted, folds marked. More can be added before it is written.
    pub fn chart(&self) -> Chart {
        let name = match self.varied.as_str() {
            "omega" => "excitation frequency \u{3c9}",
            other => other,
        };
        let coordinate = &self.follower.system.facts().coordinates[0];
        let folds = self
            .folds()
            .map(|fold| [fold.point.value, fold.point.peak_to_peak()])
            .collect();
        Chart::new(self.follower.system.facts().name.clone())
            .x(name)
            .y(format!("peak-to-peak of {coordinate}"))
            .curve(Curve {
                label: String::new(),
                runs: self.runs(),
            })
            .markers(Markers {
                label: "fold".to_owned(),
                points: folds,
            })
    }

    /// The branch as runs of one stability each; neighbours share the point where they meet.
    pub fn runs(&self) -> Vec<Run> {
        let mut runs: Vec<Run> = Vec::new();
        for (index, point) in self.points.iter().enumerate() {
            let line = line_of(point);
            let here = [point.value, point.peak_to_peak()];
            match runs.last_mut() {
                Some(run) if run.line == line => run.points.push(here),
                Some(run) => {
                    let joint = self.joint(index).unwrap_or(here);
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

    /// The event between a point and the one before it.
    fn joint(&self, index: usize) -> Option<[f64; 2]> {
        let event = self.events.iter().find(|event| event.after == index)?;
        Some([event.point.value, event.point.peak_to_peak()])
    }

    /// Where contact is lost, as a reference line over the points of the branch: see [`loss_of_contact`].
    pub fn reference(&self, label: &str, of: impl Fn(&Point) -> Option<f64>) -> Reference {
        let points = self
            .points
            .iter()
            .filter_map(|point| Some([point.value, of(point)?]))
            .collect();
        Reference {
            label: label.to_owned(),
            points,
        }
    }
}

fn line_of(point: &Point) -> Line {
    match point.stability.verdict {
        Verdict::Stable => Line::Stable,
        Verdict::Unstable => Line::Unstable,
        Verdict::Undecided => Line::Undecided,
    }
}
