//! Writing the results to files.

use std::fs::File;
use std::io::{self, BufWriter, Write};
use std::path::{Path, PathBuf};

use super::records::Record;

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
