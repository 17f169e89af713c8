//! What other programs were measured to do on the same problems: `peers.csv` beside this file.
//!
//! Rows with a full date are from `benches/peers/curves.sh`, which writes the file. The others were measured by the authors in 2026, as
//! times of a point of the curve, and are given for as many points as ours has.

use super::method::Reference;
use super::problem::Problem;

/// What was measured, with a line of names first.
pub const FILE: &str = include_str!("peers.csv");

/// One program at one setting.
#[derive(Debug, Clone, PartialEq)]
pub struct Peer {
    /// The program, with its version where that is known.
    pub name: String,
    /// Its setting.
    pub setting: String,
    /// When it was measured.
    pub measured: String,
    /// Points of its curve.
    pub points: usize,
    /// Median, least and largest time of the curve, in seconds.
    pub seconds: [f64; 3],
    /// Error of its fold that comes nearest to that of largest amplitude.
    pub fold: Option<f64>,
    /// Relative error of peak-to-peak of the orbit of comparison.
    pub peak_to_peak: Option<f64>,
    /// What went wrong.
    pub failure: Option<String>,
    /// How it was run.
    pub note: String,
}

/// The programs that were measured on a problem.
pub fn on(problem: &Problem, reference: &Reference) -> Vec<Peer> {
    let mut reader = csv::Reader::from_reader(FILE.as_bytes());
    let rows = reader.records().filter_map(Result::ok);
    rows.filter(|row| row.get(0) == Some(problem.id))
        .filter_map(|row| read(&row, reference))
        .collect()
}

fn read(row: &csv::StringRecord, reference: &Reference) -> Option<Peer> {
    let text = |index: usize| row.get(index).map(str::to_owned);
    let number = |index: usize| row.get(index)?.parse::<f64>().ok();
    let exact = reference.folds.first();
    Some(Peer {
        name: text(1)?,
        setting: text(2)?,
        measured: text(3)?,
        points: row.get(4)?.parse().ok()?,
        seconds: [number(5)?, number(6)?, number(7)?],
        fold: exact.and_then(|exact| Some((number(8)? - exact).abs())),
        peak_to_peak: number(9).map(|size| (size / reference.peak_to_peak - 1.0).abs()),
        failure: text(10).filter(|text| !text.is_empty()),
        note: text(11)?,
    })
}
