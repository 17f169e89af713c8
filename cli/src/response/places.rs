//! Where results are written: whether a path can take them, and which paths are one file.

use std::io;
use std::path::{Path, PathBuf};

use hertzian::export;

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
