//! What a long computation has done, in a file that grows: a run that was killed goes on from there.
//!
//! The file begins with a line of text that says which computation it belongs to. Each record is its length, a checksum and its
//! bytes, written at once, so that a record cut short by the end of a process is recognised and dropped.
//!
//! Source of the checksum: Fowler, Noll and Vo, FNV-1a, 64 bits.

use std::fs::{File, OpenOptions};
use std::io::{self, ErrorKind, Read, Seek, SeekFrom, Write};
use std::path::{Path, PathBuf};

/// What every such file begins with; the number is that of the format.
const HEAD: &str = "hertzian log 1, ";
/// As much is shown of what another file says it belongs to, in bytes.
const LINE: usize = 1000;

/// An open log.
#[derive(Debug)]
pub(crate) struct Log {
    file: File,
    path: PathBuf,
    records: Vec<Vec<u8>>,
}

/// Why there is no log, or none any more.
#[derive(Clone, PartialEq, Eq, thiserror::Error)]
pub(crate) enum LogError {
    /// The file cannot be read or written.
    #[error("cannot use the checkpoint {}: {kind}", .path.display())]
    File {
        /// Its path.
        path: PathBuf,
        /// What the system said.
        kind: ErrorKind,
    },
    /// The file belongs to another computation, or is no log.
    #[error("{}", of_another(.path, .found))]
    Other {
        /// Its path.
        path: PathBuf,
        /// What it says it belongs to; empty if it is no log.
        found: String,
    },
}

crate::error::room_error! {
    LogError, |_| crate::error::ErrorKind::File;
    File { path, kind }
    Other { path, found }
    ;
}

impl Log {
    /// Opens the log of a computation and reads what it has done; begins one if there is no such file. `identity` is one
    /// line that says everything the result depends on.
    ///
    /// # Errors
    /// If the file cannot be read and written, or belongs to something else.
    pub(super) fn open(path: &Path, identity: &str) -> Result<Self, LogError> {
        let path = path.to_path_buf();
        let failed = |source: io::Error| LogError::File {
            path: path.clone(),
            kind: source.kind(),
        };
        // What is no file, as a device, may have no end, and cannot be cut.
        if path.exists() && !path.is_file() {
            let found = String::new();
            return Err(LogError::Other { path, found });
        }
        let mut options = OpenOptions::new();
        let options = options.read(true).write(true).create(true).truncate(false);
        let mut file = options.open(&path).map_err(failed)?;
        let head = format!("{HEAD}{}\n", identity.replace('\n', " "));
        // Of a file of something else no more than a line is looked at, however long it is.
        let most = head.len().max(LINE) as u64;
        let mut bytes = Vec::new();
        let mut beginning = (&file).take(most);
        beginning.read_to_end(&mut bytes).map_err(failed)?;
        let mut records = Vec::new();
        let mut length = head.len();
        // A head cut short is that of a process that ended before its first record.
        if head.as_bytes().starts_with(&bytes) && bytes.len() < head.len() {
            file.rewind().map_err(failed)?;
            file.write_all(head.as_bytes()).map_err(failed)?;
        } else if bytes.starts_with(head.as_bytes()) {
            file.read_to_end(&mut bytes).map_err(failed)?;
            while let Some(record) = record(&bytes[length..]) {
                length += FRAME + record.len();
                records.push(record.to_vec());
            }
        } else {
            let text = String::from_utf8_lossy(&bytes);
            let line = text.lines().next().and_then(|line| line.strip_prefix(HEAD));
            let found = line.unwrap_or_default().chars().take(LINE).collect();
            return Err(LogError::Other { path, found });
        }
        file.set_len(length as u64).map_err(failed)?;
        file.seek(SeekFrom::Start(length as u64)).map_err(failed)?;
        Ok(Self {
            file,
            path,
            records,
        })
    }

    /// The records that were there when it was opened.
    pub(super) fn records(&self) -> &[Vec<u8>] {
        &self.records
    }

    /// Adds a record.
    ///
    /// # Errors
    /// If it cannot be written.
    pub(super) fn append(&mut self, bytes: &[u8]) -> Result<(), LogError> {
        let mut frame = Vec::with_capacity(FRAME + bytes.len());
        frame.extend((bytes.len() as u64).to_le_bytes());
        frame.extend(checksum(bytes).to_le_bytes());
        frame.extend(bytes);
        self.file
            .write_all(&frame)
            .map_err(|source| LogError::File {
                path: self.path.clone(),
                kind: source.kind(),
            })
    }
}

/// Bytes before each record.
const FRAME: usize = 16;

/// The first record of some bytes, if it is whole.
fn record(bytes: &[u8]) -> Option<&[u8]> {
    let number = |from: usize| {
        let bytes = bytes.get(from..from + 8)?;
        Some(u64::from_le_bytes(bytes.try_into().ok()?))
    };
    let length = usize::try_from(number(0)?).ok()?;
    let record = bytes[FRAME.min(bytes.len())..].get(..length)?;
    (checksum(record) == number(8)?).then_some(record)
}

fn checksum(bytes: &[u8]) -> u64 {
    bytes.iter().fold(0xcbf2_9ce4_8422_2325, |sum, &byte| {
        (sum ^ u64::from(byte)).wrapping_mul(0x0100_0000_01b3)
    })
}

/// Writes numbers into a record.
#[derive(Debug, Default)]
pub(super) struct Writer(pub(super) Vec<u8>);

impl Writer {
    pub(super) fn whole(&mut self, value: usize) {
        self.0.extend((value as u64).to_le_bytes());
    }

    pub(super) fn numbers(&mut self, values: &[f64]) {
        self.whole(values.len());
        for value in values {
            self.0.extend(value.to_le_bytes());
        }
    }
}

/// Reads them back; `None` where a record is not what it should be.
#[derive(Debug)]
pub(super) struct Reader<'a>(pub(super) &'a [u8]);

impl Reader<'_> {
    fn eight(&mut self) -> Option<[u8; 8]> {
        let (head, rest) = self.0.split_first_chunk::<8>()?;
        self.0 = rest;
        Some(*head)
    }

    pub(super) fn whole(&mut self) -> Option<usize> {
        usize::try_from(u64::from_le_bytes(self.eight()?)).ok()
    }

    pub(super) fn numbers(&mut self) -> Option<Vec<f64>> {
        let count = self.whole()?;
        if count > self.0.len() / 8 {
            return None;
        }
        (0..count)
            .map(|_| Some(f64::from_le_bytes(self.eight()?)))
            .collect()
    }
}

fn of_another(path: &Path, found: &str) -> String {
    let path = path.display();
    if found.is_empty() {
        format!("{path} is no checkpoint")
    } else {
        format!("the checkpoint {path} belongs to another computation: {found}")
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn path(name: &str) -> PathBuf {
        let folder = std::env::temp_dir().join(format!("hertzian-log-{}", std::process::id()));
        std::fs::create_dir_all(&folder).expect("a folder");
        let path = folder.join(name);
        let _ = std::fs::remove_file(&path);
        path
    }

    fn read(path: &Path) -> Vec<Vec<u8>> {
        Log::open(path, "this").expect("a log").records().to_vec()
    }

    #[test]
    fn records_come_back_and_a_torn_one_is_dropped() {
        let path = path("torn");
        let mut log = Log::open(&path, "this").expect("a new log");
        assert!(log.records().is_empty());
        log.append(b"one").expect("written");
        log.append(b"").expect("written");
        log.append(b"three").expect("written");
        drop(log);
        let whole = std::fs::read(&path).expect("readable");
        assert_eq!(read(&path), [&b"one"[..], b"", b"three"]);
        for cut in 1..FRAME + 5 {
            std::fs::write(&path, &whole[..whole.len() - cut]).expect("written");
            let mut log = Log::open(&path, "this").expect("a log");
            assert_eq!(log.records(), [&b"one"[..], b""]);
            log.append(b"other").expect("written");
            drop(log);
            assert_eq!(read(&path), [&b"one"[..], b"", b"other"]);
        }
        let mut bad = whole.clone();
        let last = bad.len() - 1;
        bad[last] ^= 1;
        std::fs::write(&path, &bad).expect("written");
        assert_eq!(read(&path).len(), 2);
        std::fs::write(&path, &whole[..7]).expect("written");
        assert!(read(&path).is_empty());
    }

    #[test]
    fn a_log_of_something_else_is_refused() {
        let path = path("other");
        drop(Log::open(&path, "this").expect("a new log"));
        let error = Log::open(&path, "that").expect_err("another identity");
        assert!(
            error.to_string().contains("another computation: this"),
            "{error}"
        );
        std::fs::write(&path, "some text").expect("written");
        let error = Log::open(&path, "that").expect_err("no log");
        assert!(error.to_string().contains("no checkpoint"), "{error}");
        let error = Log::open(&path.join("missing"), "that").expect_err("no folder");
        assert!(error.to_string().contains("cannot use"), "{error}");
        for device in ["/dev/zero", "/dev/null", "/"] {
            let error = Log::open(Path::new(device), "that").expect_err("no file");
            assert!(error.to_string().contains("no checkpoint"), "{error}");
        }
    }

    #[test]
    fn numbers_come_back() {
        let mut writer = Writer::default();
        writer.whole(7);
        writer.numbers(&[1.5, f64::NEG_INFINITY, -0.0]);
        let mut reader = Reader(&writer.0);
        assert_eq!(reader.whole(), Some(7));
        assert_eq!(reader.numbers(), Some(vec![1.5, f64::NEG_INFINITY, -0.0]));
        assert_eq!(reader.whole(), None);
        assert_eq!(Reader(&[255; 8]).numbers(), None);
    }
}
