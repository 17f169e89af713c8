//! The chart of a branch.

use std::mem::discriminant;
use std::path::Path;

use hertzian_chart::{Chart, ChartError, Curve, Line, Markers, Run};

use crate::branches::branch::Branch;
use crate::branches::point::Point;
use crate::error::Error;
use crate::event::EventKind;
use crate::orbit::stability::Verdict;
use crate::report::error::FileError;
use crate::report::labels::Labels;

impl Branch {
    /// Draws peak-to-peak over what the branch varies, as an SVG file: stable solid, unstable dashed, folds marked.
    ///
    /// # Errors
    /// If the file cannot be written.
    pub fn plot(&self, path: impl AsRef<Path>) -> Result<(), Error> {
        Ok(self.chart().write(path)?)
    }

    /// Peak-to-peak of the first coordinate over what the branch varies: stable solid, unstable dashed, undecided
    /// dotted; events are marked, each kind by a shape of its own, and so are places where an event could not be located.
    /// More can be added before it is written.
    pub fn chart(&self) -> Chart {
        let curve = Curve {
            label: String::new(),
            runs: self.runs(),
        };
        let labels = Labels::of(self).with_period(self.period());
        event_markers(self.marked())
            .chain([unlocated(self.unlocated().collect())])
            .fold(empty_chart(&labels).curve(curve), Chart::markers)
    }

    /// Its events at their places.
    pub(crate) fn marked(&self) -> impl Iterator<Item = (EventKind, [f64; 2])> {
        let events = self.events.iter();
        events.map(|event| (event.kind, place(&event.point)))
    }

    /// Where test functions change their sign without an event.
    pub(crate) fn unlocated(&self) -> impl Iterator<Item = [f64; 2]> {
        self.turns.iter().filter_map(|turn| {
            let [before, behind] = [
                self.points.get(turn.after.checked_sub(1)?)?,
                self.points.get(turn.after)?,
            ];
            let size = 0.5 * (before.peak_to_peak() + behind.peak_to_peak());
            Some([turn.value, size])
        })
    }

    /// The branch as runs of one stability each; neighbours share the point where they meet, which is the event if
    /// there is one between them.
    pub fn runs(&self) -> Vec<Run> {
        self.runs_of(place)
    }

    /// The same with every orbit at a place of one's own.
    pub fn runs_of(&self, place: impl Fn(&Point) -> [f64; 2]) -> Vec<Run> {
        let points = self.points.iter();
        let points = points.map(|point| (place(point), point.stability.verdict));
        let events = self.events.iter();
        let events = events.map(|event| (event.after, place(&event.point)));
        runs(points, &events.collect::<Vec<_>>())
    }
}

/// Points with their verdicts as runs of one stability each, with events, each behind so many points. Neighbours share the point
/// where they meet.
fn runs(
    points: impl Iterator<Item = ([f64; 2], Verdict)>,
    events: &[(usize, [f64; 2])],
) -> Vec<Run> {
    let mut runs: Vec<Run> = Vec::new();
    let mut count = 0;
    for (index, (here, verdict)) in points.enumerate() {
        count = index + 1;
        let line = line_of(verdict);
        let between = events.iter().filter(|(after, _)| *after == index);
        let joints: Vec<_> = between.map(|(_, place)| *place).collect();
        match runs.last_mut() {
            Some(run) if run.line == line => {
                run.points.extend(&joints);
                run.points.push(here);
            }
            Some(run) => {
                let joint = joints.first().copied().unwrap_or(here);
                run.points.push(joint);
                let points = joints.into_iter().chain([here]).collect();
                runs.push(Run { line, points });
            }
            None => runs.push(Run {
                line,
                points: joints.into_iter().chain([here]).collect(),
            }),
        }
    }
    let behind = events.iter().filter(|(after, _)| *after >= count);
    if let Some(run) = runs.last_mut() {
        run.points.extend(behind.map(|(_, place)| place));
    }
    runs
}

fn place(point: &Point) -> [f64; 2] {
    [point.value, point.peak_to_peak()]
}

fn line_of(verdict: Verdict) -> Line {
    match verdict {
        Verdict::Stable => Line::Stable,
        Verdict::Unstable => Line::Unstable,
        Verdict::Undecided => Line::Undecided,
    }
}

impl From<ChartError> for Error {
    fn from(ChartError { path, source, .. }: ChartError) -> Self {
        let kind = source.kind();
        FileError::Write { path, kind }.into()
    }
}

/// A chart with nothing on it yet.
pub(crate) fn empty_chart(labels: &Labels) -> Chart {
    Chart::new(&labels.title).x(&labels.varied).y(&labels.size)
}

/// Markers of bifurcations, one entry for each kind, so that a kind has the same shape in every chart to which no other markers were
/// added before.
///
/// ```
/// use hertzian::EventKind;
/// use hertzian::chart::{Chart, event_markers};
///
/// let markers = event_markers([
///     (EventKind::Fold, [1.0, 2.0]),
///     (EventKind::PeriodDoubling, [1.5, 2.5]),
/// ]);
/// let chart = markers.fold(Chart::new("Two of them"), Chart::markers);
/// assert!(chart.to_svg().contains("</svg>"));
/// ```
pub fn event_markers(
    events: impl IntoIterator<Item = (EventKind, [f64; 2])>,
) -> impl Iterator<Item = Markers> {
    let events: Vec<_> = events.into_iter().collect();
    let kinds = [
        EventKind::Fold,
        EventKind::PeriodDoubling,
        EventKind::SymmetryBreaking,
        EventKind::BranchPoint,
        EventKind::NeimarkSacker,
        EventKind::Grazing { turns: false },
    ];
    kinds.into_iter().map(move |kind| {
        let of_kind = events
            .iter()
            .filter(|(other, _)| discriminant(other) == discriminant(&kind));
        Markers {
            label: kind.to_string(),
            points: of_kind.map(|(_, place)| *place).collect(),
        }
    })
}

/// Markers of places where something was not located.
pub(crate) fn unlocated(points: Vec<[f64; 2]>) -> Markers {
    Markers {
        label: "unlocated".to_owned(),
        points,
    }
}

#[cfg(test)]
mod tests {
    use hertzian_chart::Line;

    use crate::response::FrequencyResponse;

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

    fn response(system: &Spring) -> FrequencyResponse {
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
        assert!(!svg.contains("undecided") && !svg.contains("unlocated"));
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
