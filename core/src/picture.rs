//! The chart of a branch.

use crate::branch::{Branch, EventKind, Point};
use crate::chart::{Chart, Curve, Line, Markers, Run};
use crate::stability::Verdict;

impl Branch<'_> {
    /// Peak-to-peak of the first coordinate over what the branch varies: stable solid, unstable dashed, undecided
    /// dotted; folds and symmetry-breaking points are marked, and so are turns that were not confirmed as folds. More can be
    /// added before it is written.
    pub fn chart(&self) -> Chart {
        let coordinate = &self.follower.system.facts().coordinates[0];
        let folds = self
            .folds()
            .map(|fold| place(&fold.point))
            .collect::<Vec<_>>();
        let broken = self
            .events
            .iter()
            .filter(|event| event.kind == EventKind::SymmetryBreaking)
            .map(|event| place(&event.point))
            .collect();
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
                label: "symmetry-breaking".to_owned(),
                points: broken,
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

#[cfg(test)]
mod tests {
    use crate::FrequencyResponse;
    use crate::chart::Line;

    hertzian::oscillator! {
        Spring(x) {
            param zeta in 0.0..;
            /// excitation amplitude
            ///
            /// in units of the static load
            param drive;
            param load;
            ddot(x) + 2*zeta*dot(x) + sgn(x)*|x|^1.5 = drive*cos(omega*t) + load;
        }
    }

    const SPRING: Spring = Spring {
        zeta: 0.01,
        drive: 0.1,
        load: 5.0,
    };

    fn response(system: &Spring) -> FrequencyResponse<'_> {
        FrequencyResponse::of(system).harmonics(5).samples(256)
    }

    #[test]
    fn runs_join_at_the_folds() {
        let branch = response(&SPRING).from(1.0).to(2.2).run().unwrap();
        let runs = branch.runs();
        for pair in runs.windows(2) {
            assert_ne!(pair[0].line, pair[1].line);
            assert_eq!(pair[0].points.last(), pair[1].points.first());
        }
        let folds: Vec<_> = branch
            .folds()
            .map(|fold| super::place(&fold.point))
            .collect();
        assert_eq!(folds.len(), 2);
        let mut all = branch.points.iter().map(super::place).chain(folds);
        assert!(all.all(|place| runs.iter().any(|run| run.points.contains(&place))));
        assert_eq!(runs[0].line, Line::Stable);
        assert!(runs.iter().any(|run| run.line == Line::Unstable));
    }

    #[test]
    fn a_chart_says_what_it_shows() {
        let branch = response(&SPRING).from(1.0).to(2.2).run().unwrap();
        let svg = branch.chart().to_svg();
        for part in [
            "Spring: zeta = 0.01, drive = 0.1, load = 5",
            "excitation frequency ω",
            "peak-to-peak of x",
            "stable",
            "unstable",
            "fold",
        ] {
            assert!(svg.contains(part), "{part}");
        }
        assert!(!svg.contains("unconfirmed"));
    }

    #[test]
    fn a_parameter_is_named_by_its_documentation() {
        let request = response(&SPRING).vary("drive").omega(2.5);
        let chart = request.from(0.01).to(0.02).run().unwrap().chart().to_svg();
        assert!(chart.contains("\"drive (excitation amplitude)\""));
        assert!(chart.contains("Spring: zeta = 0.01, load = 5, omega = 2.5<"));
        let request = response(&SPRING).vary("load").omega(2.5);
        let chart = request.from(5.0).to(5.1).run().unwrap().chart().to_svg();
        assert!(chart.contains("\"load\""));
    }
}
