//! The chart of a branch.

use std::path::Path;

use hertzian_chart::{Chart, ChartError, Curve, Run, Scale, Series};

use crate::branches::branch::{Branch, Model};
use crate::error::Error;
use crate::event::EventKind;
use crate::report::drawn::Drawn;
use crate::report::error::FileError;
use crate::report::labels::Labels;
use crate::report::view::View;

impl Branch {
    /// Draws the [`chart`](Self::chart) as an SVG file: stable solid, unstable dashed, folds marked.
    ///
    /// # Errors
    /// If the file cannot be written.
    pub fn plot(&self, path: impl AsRef<Path>) -> Result<(), Error> {
        Ok(self.chart().write(path)?)
    }

    /// [What leads](Self::leading) over what the branch varies: stable solid, unstable dashed, undecided
    /// dotted; events are marked, each kind by a shape of its own, and so are places where an event could not be located.
    /// More can be added before it is written.
    pub fn chart(&self) -> Chart {
        let view = View::new();
        let drawn = Drawn::of(view.seen(self, self.leading()));
        alone(&view, drawn)
    }

    /// The same of what one asks for.
    ///
    /// # Errors
    /// If nothing has the name that was asked for, or what is measured is not one of it; or it takes the model, and the branch was read from
    /// a file and has [none](Self::attach).
    pub fn chart_of(&self, view: &View) -> Result<Chart, Error> {
        let mut drawn = Drawn::of(view.on(self)?);
        view.check(std::slice::from_mut(&mut drawn))?;
        Ok(alone(view, drawn))
    }
}

/// The chart of one branch.
fn alone(view: &View, drawn: Drawn<'_>) -> Chart {
    let branch = drawn.seen.branch;
    let labels = Labels::of(&drawn.seen).with_period(branch.period());
    chart_of(view, &labels, &[drawn], &[String::new()])
}

/// The chart of some branches, with curves that have names.
pub(crate) fn chart_of(
    view: &View,
    labels: &Labels,
    drawn: &[Drawn<'_>],
    names: &[String],
) -> Chart {
    let chart = empty_chart(labels).scales(Scale::Linear, view.scale);
    let mut distinct: Vec<&String> = Vec::new();
    for name in names {
        if !distinct.contains(&name) {
            distinct.push(name);
        }
    }
    let mut chart = chart;
    let lines = view.harmonics.max(1);
    for line in 0..lines {
        for name in &distinct {
            let label = match (view.harmonics, distinct.len()) {
                (0, _) => (*name).clone(),
                (_, 1) => harmonic(line),
                _ => format!("{}, {name}", harmonic(line)),
            };
            let own = drawn.iter().zip(names).filter(|(_, own)| own == name);
            let runs: Vec<Run> = own
                .flat_map(|(drawn, _)| drawn.runs(line, view.scale))
                .collect();
            if view.harmonics > 0 && view.scale == Scale::Linear {
                let between = [[f64::NAN; 2]];
                let points = runs
                    .iter()
                    .flat_map(|run| run.points.iter().chain(&between));
                chart = chart.area(Series {
                    label: label.clone(),
                    points: points.copied().collect(),
                });
            }
            chart = chart.curve(Curve { label, runs });
        }
    }
    plain(view.marked(chart, drawn), drawn)
}

/// Says of numbers without units that this is what they are.
pub(crate) fn plain(chart: Chart, drawn: &[Drawn<'_>]) -> Chart {
    let mut models = drawn.iter().map(|drawn| &drawn.seen.branch.model);
    if models.all(Model::is_plain) {
        return chart.remark_on_axes(PLAIN);
    }
    chart
}

/// What is said of charts of a model that declares no units.
pub(crate) const PLAIN: &str = "plain numbers: no units are declared";

impl Model {
    /// Whether nothing has a unit.
    pub(crate) fn is_plain(&self) -> bool {
        let parameters = self.parameters.iter().map(|parameter| &parameter.unit);
        let outputs = self.outputs.iter().map(|output| &output.unit);
        self.units.is_empty() && parameters.chain(outputs).all(String::is_empty)
    }
}

/// The name of a harmonic, by its frequency.
pub(crate) fn harmonic(line: usize) -> String {
    match line {
        0 => "amplitude at ω".to_owned(),
        _ => format!("amplitude at {} ω", line + 1),
    }
}

impl From<ChartError> for Error {
    fn from(ChartError { path, source, .. }: ChartError) -> Self {
        FileError::not_written(&path, &source).into()
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
/// let chart = markers.fold(Chart::new("Two of them"), Chart::marks);
/// assert!(chart.to_svg().contains("</svg>"));
/// ```
pub fn event_markers(
    events: impl IntoIterator<Item = (EventKind, [f64; 2])>,
) -> impl Iterator<Item = Series> {
    let events: Vec<_> = events.into_iter().collect();
    EventKind::ALL.into_iter().map(move |kind| {
        let of_kind = events.iter().filter(|(other, _)| other.is_like(kind));
        Series {
            label: kind.to_string(),
            points: of_kind.map(|(_, place)| *place).collect(),
        }
    })
}

#[cfg(test)]
mod tests {
    use hertzian_chart::Line;

    use crate::report::drawn::place;
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
        let folds: Vec<_> = branch.folds().map(|fold| place(&fold.point)).collect();
        assert_eq!(folds.len(), 2);
        let mut all = branch.points.iter().map(place).chain(folds);
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
        assert!(chart.contains("Spring: zeta = 0.01, load = 5, ω = 2.5<"));
        let request = response(&SPRING).vary("load").omega(2.5);
        let chart = request.from(5.0).to(5.1).run().unwrap().chart().to_svg();
        assert!(chart.contains("\"load\""));
    }
}
