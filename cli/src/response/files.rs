//! Writing the results to files.

use std::io;
use std::path::{Path, PathBuf};

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

/// Whether a file can be written there; one that is there is not touched.
///
/// # Errors
/// If the path is a folder, its folder does not exist, or neither takes what is written.
pub fn check(path: &Path) -> io::Result<()> {
    let folder = path
        .parent()
        .filter(|folder| !folder.as_os_str().is_empty());
    if path.is_dir() {
        return Err(io::ErrorKind::IsADirectory.into());
    }
    if folder.is_some_and(|folder| !folder.is_dir()) {
        return Err(io::Error::new(
            io::ErrorKind::NotFound,
            "its folder does not exist",
        ));
    }
    export::can_write(path)
}

/// A folder for results, made if there is none, and able to take them.
///
/// # Errors
/// What the system says.
pub fn make_folder(folder: &Path) -> io::Result<()> {
    std::fs::create_dir_all(folder)?;
    export::can_write(folder.join("a"))
}

/// A path that leads to the same file as one before it, if there is one. Devices can be written to as often as one likes.
pub fn shared<'p>(paths: impl IntoIterator<Item = &'p Path>) -> Option<&'p Path> {
    let mut seen = Vec::new();
    let mut paths = paths.into_iter();
    paths.find(|path| {
        let place = place(path);
        let is_known = seen.contains(&place);
        seen.push(place);
        is_known && (path.is_file() || !path.exists())
    })
}

/// Where a path leads, whether there is a file or not.
fn place(path: &Path) -> PathBuf {
    let folder = path
        .parent()
        .filter(|folder| !folder.as_os_str().is_empty());
    let of_new = || {
        let folder = folder.unwrap_or(Path::new(".")).canonicalize().ok()?;
        Some(folder.join(path.file_name()?))
    };
    let place = path.canonicalize().ok().or_else(of_new);
    place.unwrap_or_else(|| path.to_path_buf())
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
