//! Error over time, both logarithmic.

use hertzian::chart::{Chart, Note, Scale, Series};

use super::measure::Measured;
use super::method::Family;
use super::multipliers::{Answer, names};
use super::peer::Peer;
use super::problem::Problem;

/// Errors below this are drawn as this: closed forms reach rounding.
const FLOOR: f64 = 1e-16;
/// What stands at settings that failed, and what that is.
const FAILED: &str = "×";
const OF_FAILED: &str = "failed: it finds other folds than there are, or does not end";

/// The chart of one quantity.
pub fn chart(
    problem: &Problem,
    measured: &[Measured],
    label: &str,
    error: impl Fn(&Measured) -> Option<f64>,
) -> Chart {
    let mut chart = Chart::new(format!("{}: {label}", problem.title))
        .x("time of the curve without multipliers, milliseconds")
        .y(label)
        .scales(Scale::Logarithmic, Scale::Logarithmic);
    let place = |one: &Measured| {
        let time = 1e3 * one.median()?;
        Some([time, error(one)?.max(FLOOR)])
    };
    for family in Family::ALL {
        let own: Vec<&Measured> = measured.iter().filter(|one| one.family == family).collect();
        // Of samples and harmonics both are swept: a line for each number of samples.
        let lines = own.chunk_by(|a, b| a.setting.samples() == b.setting.samples());
        let points = lines.flat_map(|line| {
            let right = line.iter().filter(|one| one.failure.is_none());
            right.filter_map(|one| place(one)).chain([[f64::NAN; 2]])
        });
        chart = chart.joined(Series::new(family.name(), points.collect::<Vec<_>>()));
    }
    let failed = measured.iter().filter(|one| one.failure.is_some());
    let failed: Vec<[f64; 2]> = failed.filter_map(place).collect();
    if !failed.is_empty() {
        chart = chart.remark(format!("{FAILED}: any method, {OF_FAILED}"));
    }
    chart.letters(Series::new(FAILED, failed))
}

/// The same with the points of other programs, failures as well.
pub fn with_peers(chart: Chart, peers: &[Peer], error: impl Fn(&Peer) -> Option<f64>) -> Chart {
    let shown = |peer: &&Peer| error(peer).is_some() && peer.failure.is_some();
    let chart = if peers.iter().any(|peer| shown(&peer)) {
        chart.remark(format!("other programs, {OF_FAILED}"))
    } else {
        chart
    };
    peers.iter().fold(chart, |chart, peer| {
        let Some(error) = error(peer) else {
            return chart;
        };
        let harmonics = peer.setting.starts_with("K =").then_some(&peer.setting);
        let setting = harmonics.map_or_else(String::new, |setting| format!(", {setting}"));
        let failed = peer.failure.as_ref().map_or("", |_| ", failed");
        let name = peer.name.split(' ').next().unwrap_or_default();
        chart.note(Note {
            label: format!("{name}{setting}{failed}"),
            point: [1e3 * peer.seconds[0], error.max(FLOOR)],
        })
    })
}

/// Errors of multipliers over the time that they take.
pub fn multipliers(problem: &Problem, answers: &[Answer]) -> Chart {
    let mut chart = Chart::new(format!("{}: multipliers", problem.title))
        .x("time of one orbit's multipliers, milliseconds")
        .y("largest error of a multiplier")
        .scales(Scale::Logarithmic, Scale::Logarithmic);
    for (method, name) in names().enumerate() {
        let right = answers
            .iter()
            .filter(|one| one.method == method && one.failure.is_none());
        let points: Vec<[f64; 2]> = right
            .map(|one| [1e3 * one.seconds, one.error.max(FLOOR)])
            .collect();
        chart = chart.joined(Series::new(name, points));
    }
    chart
}
