//! Writing the results to files.

use std::io;
use std::path::Path;

use hertzian::bifurcation::Searched;
use hertzian::shooting::BifurcationCurve;
use hertzian::{Branch, Point, export};
use serde::Serialize;

use super::backbone::Backbone;
use super::structure::Reduction;

/// What `--json` writes: results of the library as they are. `Branch::read_all` (`core/src/report/export/json.rs`) reads `version` and `branches`.
#[derive(Debug, Serialize)]
pub struct Record<'r> {
    /// The version of the form.
    pub version: u32,
    /// The branch that was asked for, and those that were joined or are of its bifurcations.
    pub branches: &'r [Branch],
    /// Where motions were followed until they settled, to find further branches.
    pub searched: &'r [Searched],
    /// Parts of the range without an orbit.
    pub uncovered: &'r [[f64; 2]],
    /// Every orbit at the values that were asked for.
    pub at: &'r [Point],
    /// Curves of bifurcations in two parameters.
    pub tracks: &'r [BifurcationCurve],
    /// Free oscillation and phase resonance.
    pub backbone: &'r Backbone,
    /// What the reduction of a structure of many coordinates changes.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub reduction: Option<&'r Reduction>,
}

/// Writes everything as JSON.
///
/// # Errors
/// If the file cannot be written.
pub fn write_json(path: &Path, record: &Record<'_>) -> io::Result<()> {
    let mut text = serde_json::to_vec(record)?;
    text.push(b'\n');
    export::write(path, text)
}

/// Writes a table.
///
/// # Errors
/// If the file cannot be written.
pub fn write_csv(
    path: &Path,
    fill: impl FnOnce(&mut csv::Writer<Vec<u8>>) -> csv::Result<()>,
) -> io::Result<()> {
    let mut writer = csv::Writer::from_writer(Vec::new());
    fill(&mut writer)?;
    let text = writer
        .into_inner()
        .map_err(csv::IntoInnerError::into_error)?;
    export::write(path, text)
}
