//! Writing the results to files.

use std::fs::File;
use std::io::{self, BufWriter, Write};
use std::path::{Path, PathBuf};

use super::records::{PointRecord, Record};

/// Columns of the CSV file; each multiplier has two.
pub const COLUMNS: [&str; 21] = [
    "omega",
    "drive",
    "peak_to_peak",
    "max",
    "min",
    "mean",
    "rms",
    "stability",
    "multiplier_1_re",
    "multiplier_1_im",
    "multiplier_2_re",
    "multiplier_2_im",
    "contact_fraction",
    "contacts",
    "peak_force",
    "dissipated_power",
    "harmonics",
    "error",
    "branch",
    "period",
    "value",
];

/// Whether a file can be written there, as far as can be told without touching it.
///
/// # Errors
/// If the path is a folder, or its folder does not exist.
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
    Ok(())
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

/// Writes everything as JSON. A number that is not finite becomes `null`.
///
/// # Errors
/// If the file cannot be written.
pub fn write_json(path: &Path, record: &Record) -> io::Result<()> {
    let mut file = BufWriter::new(File::create(path)?);
    serde_json::to_writer(&mut file, record)?;
    writeln!(file)?;
    file.flush()
}

/// Writes one row per point.
///
/// # Errors
/// If the file cannot be written.
pub fn write_csv(path: &Path, points: &[PointRecord]) -> io::Result<()> {
    let mut writer = csv::Writer::from_path(path)?;
    writer.write_record(COLUMNS)?;
    for point in points {
        writer.write_record(row(point))?;
    }
    writer.flush()
}

/// A point as the texts of [`COLUMNS`]; what is not known is empty.
pub fn row(point: &PointRecord) -> Vec<String> {
    // As short as reads back to the same number.
    let number = |value: f64| format!("{value:?}");
    let known = |value: Option<f64>| value.map_or(String::new(), number);
    let part = |index: usize, part: usize| {
        let multiplier = point.multipliers.get(index);
        multiplier.map_or(String::new(), |multiplier| number(multiplier[part]))
    };
    vec![
        number(point.omega),
        number(point.drive),
        number(point.peak_to_peak),
        number(point.max),
        number(point.min),
        number(point.mean),
        number(point.rms),
        point.stability.clone(),
        part(0, 0),
        part(0, 1),
        part(1, 0),
        part(1, 1),
        known(point.contact_fraction),
        point
            .contacts
            .map_or(String::new(), |count| count.to_string()),
        known(point.peak_force),
        number(point.dissipated_power),
        point.harmonics.to_string(),
        known(point.error),
        point.branch.to_string(),
        point.period.to_string(),
        number(point.value),
    ]
}
