//! Error over time, both logarithmic.

use hertzian::chart::{Chart, Scale, Series};

use super::measure::Measured;
use super::method::Family;
use super::multipliers::{Answer, names};
use super::peer::Peer;
use super::problem::Problem;

/// Errors below this are drawn as this: closed forms reach rounding.
const FLOOR: f64 = 1e-16;
/// What stands at settings that failed, and what that is.
const FAILED: &str = "F";
const OF_FAILED: &str =
    "F: failed, by finding other folds than there are, or by ending early or never";

/// The chart of one quantity.
pub fn chart(
    problem: &Problem,
    measured: &[Measured],
    label: &str,
    error: impl Fn(&Measured) -> Option<f64>,
) -> Chart {
    let mut chart = Chart::new(problem.title)
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
    chart.letters(Series::new(FAILED, failed))
}

/// The same with the points of other programs, failures as well: each the first letter of its program, and its harmonics if it has them.
pub fn with_peers(
    chart: Chart,
    measured: &[Measured],
    peers: &[Peer],
    error: impl Fn(&Peer) -> Option<f64>,
) -> Chart {
    let shown: Vec<(&Peer, f64)> = peers
        .iter()
        .filter_map(|peer| Some((peer, error(peer)?)))
        .collect();
    let mut chart = chart;
    for program in shown.chunk_by(|(a, _), (b, _)| a.name == b.name) {
        let mut letters = Vec::new();
        for (peer, error) in program {
            let harmonics = peer.setting.strip_prefix("K = ").unwrap_or_default();
            let letter = format!("{}{harmonics}", peer.name.get(..1).unwrap_or_default());
            let point = [1e3 * peer.seconds[0], error.max(FLOOR)];
            chart = chart.letters(Series::new(&letter, [point]));
            letters.push(letter);
        }
        let name = &program[0].0.name;
        let failed = program.iter().all(|(peer, _)| peer.failure.is_some());
        let failed = if failed { ", failed" } else { "" };
        chart = chart.remark(format!("{}: {name}{failed}", letters.join(", ")));
    }
    let failures = measured.iter().map(|one| &one.failure);
    let mut failures = failures.chain(shown.iter().map(|(peer, _)| &peer.failure));
    if failures.any(Option::is_some) {
        chart = chart.remark(OF_FAILED);
    }
    chart
}

/// Errors of multipliers over the time that they take.
pub fn multipliers(problem: &Problem, answers: &[Answer]) -> Chart {
    let mut chart = Chart::new(problem.title)
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
