//! Files that are whole or not there.
//!
//! Contents are written beside the file and take its place when they are complete and on the disk: where the disk is full or the
//! program ends, the path holds what it held before. What is no regular file, as a pipe or a terminal, is written to as it is.

use std::fs::{self, File, OpenOptions, Permissions};
use std::io::{self, ErrorKind, Write};
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicUsize, Ordering};

/// Writes a file. It takes the place of one that is there only when it is complete.
///
/// ```
/// # let folder = std::env::temp_dir().join(format!("hertzian-write-{}", std::process::id()));
/// # std::fs::create_dir_all(&folder)?;
/// let path = folder.join("orbit.txt");
/// hertzian_file::write(&path, "0.5 1.25\n")?;
/// assert_eq!(std::fs::read_to_string(&path)?, "0.5 1.25\n");
/// # std::fs::remove_dir_all(&folder)?;
/// # Ok::<(), std::io::Error>(())
/// ```
///
/// # Errors
/// What the system says. A file that was there is then as it was.
pub fn write(path: impl AsRef<Path>, contents: impl AsRef<[u8]>) -> io::Result<()> {
    replace(path.as_ref(), |file| file.write_all(contents.as_ref()))
}

/// Writes a file piece by piece, by what `fill` does to it: for what is too long to be held. It takes the place of one that is there only
/// when `fill` has gone well.
///
/// ```
/// # let folder = std::env::temp_dir().join(format!("hertzian-filled-{}", std::process::id()));
/// # std::fs::create_dir_all(&folder)?;
/// use std::io::{BufWriter, Write};
///
/// let path = folder.join("numbers.txt");
/// hertzian_file::write_with(&path, |file| {
///     let mut to = BufWriter::new(file);
///     for number in 0..3 {
///         writeln!(to, "{number}")?;
///     }
///     to.flush()
/// })?;
/// assert_eq!(std::fs::read_to_string(&path)?, "0\n1\n2\n");
/// # std::fs::remove_dir_all(&folder)?;
/// # Ok::<(), std::io::Error>(())
/// ```
///
/// # Errors
/// What the system or `fill` says. A file that was there is then as it was.
pub fn write_with(
    path: impl AsRef<Path>,
    fill: impl FnOnce(&mut File) -> io::Result<()>,
) -> io::Result<()> {
    replace(path.as_ref(), fill)
}

/// Whether a file could be written there now. A file that is there is not changed, and none is left.
///
/// # Errors
/// Why not, as the system says.
pub fn can_write(path: impl AsRef<Path>) -> io::Result<()> {
    match Place::of(path.as_ref())? {
        Place::Stream => Ok(()),
        Place::File { path, before } => match beside(&path) {
            Ok((part, _)) => fs::remove_file(part),
            Err(error) if before.is_some() && is_closed(&error) => Ok(()),
            Err(error) => Err(error),
        },
    }
}

/// What a path leads to.
enum Place {
    /// Something that cannot be replaced.
    Stream,
    /// A file behind all links, and how it may be used if it is there.
    File {
        path: PathBuf,
        before: Option<Permissions>,
    },
}

impl Place {
    fn of(path: &Path) -> io::Result<Self> {
        let data = match fs::metadata(path) {
            Ok(data) => data,
            Err(error) if error.kind() == ErrorKind::NotFound => {
                // A link to nothing is followed, as it is where something is there.
                let path = fs::read_link(path).map_or_else(
                    |_| path.to_path_buf(),
                    |link| path.parent().unwrap_or(Path::new("")).join(link),
                );
                return Ok(Self::File { path, before: None });
            }
            Err(error) => return Err(error),
        };
        if data.is_dir() {
            return Err(ErrorKind::IsADirectory.into());
        }
        // Behind such names are files that are open already, whose other users keep what is there now.
        let is_open = path.starts_with("/dev") || path.starts_with("/proc");
        if !data.is_file() || is_open {
            return Ok(Self::Stream);
        }
        // A file that may not be written is not replaced either.
        OpenOptions::new().write(true).open(path)?;
        Ok(Self::File {
            path: path.canonicalize()?,
            before: Some(data.permissions()),
        })
    }
}

/// Fills a file and puts it in its place.
fn replace(path: &Path, fill: impl FnOnce(&mut File) -> io::Result<()>) -> io::Result<()> {
    let Place::File { path, before } = Place::of(path)? else {
        return fill(&mut OpenOptions::new().write(true).open(path)?);
    };
    let (part, mut file) = match beside(&path) {
        Ok(opened) => opened,
        // A file in a folder that takes no other one can only be written over.
        Err(error) if before.is_some() && is_closed(&error) => {
            return fill(&mut File::create(path)?);
        }
        Err(error) => return Err(error),
    };
    let filled = fill(&mut file)
        .and_then(|()| before.map_or(Ok(()), |before| file.set_permissions(before)))
        // Some file systems say only here that there is no room.
        .and_then(|()| file.sync_all())
        .and_then(|()| fs::rename(&part, path));
    if filled.is_err() {
        // What was said first is worth more than what is said of this.
        let _ = fs::remove_file(part);
    }
    filled
}

/// A new file in the same folder. One of its name may be left of a process that was killed and had the same number.
fn beside(path: &Path) -> io::Result<(PathBuf, File)> {
    static COUNT: AtomicUsize = AtomicUsize::new(0);
    let folder = path.parent().unwrap_or(Path::new(""));
    loop {
        let number = COUNT.fetch_add(1, Ordering::Relaxed);
        let part = folder.join(format!(".hertzian-{}-{number}.part", std::process::id()));
        let opened = OpenOptions::new().write(true).create_new(true).open(&part);
        match opened {
            Err(error) if error.kind() == ErrorKind::AlreadyExists => {}
            opened => return Ok((part, opened?)),
        }
    }
}

/// Whether a folder takes no new files.
fn is_closed(error: &io::Error) -> bool {
    matches!(
        error.kind(),
        ErrorKind::PermissionDenied | ErrorKind::ReadOnlyFilesystem
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    fn folder(name: &str) -> PathBuf {
        let folder = std::env::temp_dir().join(format!("hertzian-{name}-{}", std::process::id()));
        let _ = fs::remove_dir_all(&folder);
        fs::create_dir_all(&folder).expect("a folder");
        folder
    }

    fn names(folder: &Path) -> Vec<String> {
        let entries = fs::read_dir(folder).expect("a folder");
        let name = |entry: io::Result<fs::DirEntry>| entry.expect("an entry").file_name();
        let mut names: Vec<String> = entries
            .map(|entry| name(entry).to_string_lossy().into_owned())
            .collect();
        names.sort();
        names
    }

    /// Parts that a killed process has left, whose number this one has now.
    #[test]
    fn what_was_left_is_in_nobodys_way() {
        let folder = folder("left");
        let left = |number: usize| format!(".hertzian-{}-{number}.part", std::process::id());
        for number in 0..100 {
            fs::write(folder.join(left(number)), "half").expect("a file");
        }
        let path = folder.join("a");
        write(&path, "whole").expect("written");
        assert_eq!(fs::read(&path).expect("a file"), b"whole");
        assert_eq!(names(&folder).len(), 101);
        fs::remove_dir_all(folder).expect("removed");
    }

    /// As where the disk is full: a part is written, then no more.
    #[test]
    fn what_cannot_be_written_whole_leaves_what_was_there() {
        let folder = folder("whole");
        let path = folder.join("a");
        let half = |file: &mut File| {
            file.write_all(b"{\"points\": [")?;
            Err(ErrorKind::StorageFull.into())
        };
        let error = replace(&path, half).expect_err("a full disk");
        assert_eq!(error.kind(), ErrorKind::StorageFull);
        assert!(names(&folder).is_empty());
        write(&path, "before").expect("written");
        replace(&path, half).expect_err("a full disk");
        assert_eq!(fs::read(&path).expect("a file"), b"before");
        assert_eq!(names(&folder), ["a"]);
        write(&path, "after").expect("written");
        assert_eq!(fs::read(&path).expect("a file"), b"after");
        fs::remove_dir_all(folder).expect("removed");
    }

    #[test]
    fn a_look_changes_nothing() {
        let folder = folder("look");
        let path = folder.join("a");
        can_write(&path).expect("a folder that takes files");
        assert!(names(&folder).is_empty());
        write(&path, "some").expect("written");
        can_write(&path).expect("a file");
        assert_eq!(fs::read(&path).expect("a file"), b"some");
        assert_eq!(names(&folder), ["a"]);
        let error = can_write(&folder).expect_err("a folder");
        assert_eq!(error.kind(), ErrorKind::IsADirectory);
        assert!(can_write(folder.join("none/a")).is_err());
        assert!(can_write(path.join("a")).is_err());
        fs::remove_dir_all(folder).expect("removed");
    }

    #[cfg(unix)]
    #[test]
    fn links_and_modes_stay() {
        use std::os::unix::fs::{PermissionsExt, symlink};
        let folder = folder("links");
        let (file, link, ahead) = (folder.join("a"), folder.join("b"), folder.join("c"));
        fs::write(&file, "before").expect("written");
        fs::set_permissions(&file, Permissions::from_mode(0o640)).expect("a mode");
        symlink("a", &link).expect("a link");
        write(&link, "after").expect("written");
        assert_eq!(fs::read(&file).expect("a file"), b"after");
        let mode = fs::metadata(&file).expect("a file").permissions().mode();
        assert_eq!(mode & 0o777, 0o640);
        symlink("d", &ahead).expect("a link");
        write(&ahead, "new").expect("written");
        assert_eq!(fs::read(folder.join("d")).expect("a file"), b"new");
        assert_eq!(names(&folder), ["a", "b", "c", "d"]);
        fs::remove_dir_all(folder).expect("removed");
    }

    #[cfg(target_os = "linux")]
    #[test]
    fn a_device_is_written_to() {
        write("/dev/null", "some").expect("written");
        let error = write("/dev/full", "some").expect_err("no room");
        assert_eq!(error.kind(), ErrorKind::StorageFull);
    }
}
