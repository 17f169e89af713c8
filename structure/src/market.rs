//! Matrix Market files: `coordinate`, `real` or `integer`, `general`, `symmetric` or `skew-symmetric`.
//!
//! A file is read line by line, and nothing is reserved for what its header claims, so that memory follows what the file holds.
//!
//! Source: Boisvert, Pozo and Remington (1996), The Matrix Market Exchange Formats: Initial Design, NISTIR 5935.

use std::io::{self, BufRead, Read};

use crate::matrix::{MatrixError, SparseMatrix, can_stand};

/// A line that is longer than this many bytes holds no entry.
const LONGEST: u64 = 1024;
/// A matrix of more rows or columns than this has at least an entry for so many of them: what is held of each, also of an empty one, follows what
/// the file holds.
const EMPTY: usize = 1_000_000;
const PER_ENTRY: usize = 16;
/// A structure of more coordinates is beyond what one factorisation can hold.
pub const MOST_COORDINATES: usize = 20_000_000;

/// What is wrong with a file, and in which line.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum MarketError {
    /// It cannot be read.
    #[error("{0}")]
    Read(#[from] io::Error),
    /// It does not begin as such a file does.
    #[error(
        "line 1: `{found}`: a Matrix Market file begins with `%%MatrixMarket matrix coordinate real symmetric` or another of its kinds"
    )]
    Header {
        /// The first line, or its beginning.
        found: String,
    },
    /// It is of a kind that holds no matrix of a structure.
    #[error("line 1: `{word}`: entries must be {expected}")]
    Kind {
        /// The word.
        word: String,
        /// What is read.
        expected: &'static str,
    },
    /// A line is not what must stand there.
    #[error("line {line}: `{found}`: expected {expected}")]
    Line {
        /// Its number, from one.
        line: usize,
        /// What it says, or its beginning.
        found: String,
        /// What must stand there.
        expected: &'static str,
    },
    /// The matrix is too large.
    #[error("line {line}: {rows} by {columns}: at most {MOST_COORDINATES} rows and columns")]
    Size {
        /// Line of the sizes.
        line: usize,
        /// Rows.
        rows: usize,
        /// Columns.
        columns: usize,
    },
    /// Nearly all of its rows or columns are empty.
    #[error("line {line}: {rows} by {columns}, with {entries} entries: nearly all rows are empty")]
    Empty {
        /// Line of the sizes.
        line: usize,
        /// Rows.
        rows: usize,
        /// Columns.
        columns: usize,
        /// Entries.
        entries: usize,
    },
    /// An entry cannot be part of the matrix.
    #[error("line {line}: {source}")]
    Entry {
        /// Its line.
        line: usize,
        /// Why.
        source: MatrixError,
    },
    /// Of a symmetric matrix only one triangle is written.
    #[error(
        "line {line}: row {row}, column {column} of a symmetric matrix stands above the diagonal: such files hold the lower triangle"
    )]
    Triangle {
        /// Its line.
        line: usize,
        /// Row, from one.
        row: usize,
        /// Column, from one.
        column: usize,
    },
    /// There are fewer or more entries than the file says.
    #[error("line {line}: the file says {claimed} entries, and has {found}{}", if .found < .claimed { "" } else { " or more" })]
    Count {
        /// The last line.
        line: usize,
        /// As it says.
        claimed: usize,
        /// As many as there are.
        found: usize,
    },
}

/// What a file says of the triangle that it does not hold.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Mirror {
    None,
    Same,
    Negative,
}

/// The lines of a file, with their numbers.
struct Lines<R> {
    reader: R,
    number: usize,
    text: Vec<u8>,
}

impl<R: BufRead> Lines<R> {
    /// The next line without its end; `None` at the end of the file.
    fn next(&mut self) -> Result<Option<&str>, MarketError> {
        self.text.clear();
        self.number += 1;
        let mut limited = (&mut self.reader).take(LONGEST);
        limited.read_until(b'\n', &mut self.text)?;
        if self.text.is_empty() {
            return Ok(None);
        }
        let is_comment = self.text.first() == Some(&b'%');
        if self.text.len() as u64 == LONGEST && self.text.last() != Some(&b'\n') {
            if !is_comment {
                return Err(self.unreadable("a line of at most 1024 bytes"));
            }
            self.skip_line()?;
        }
        match std::str::from_utf8(&self.text) {
            Ok(text) => Ok(Some(text.trim())),
            // Comments may be in any encoding.
            Err(_) if is_comment => Ok(Some("%")),
            Err(_) => Err(self.unreadable("text")),
        }
    }

    fn unreadable(&self, expected: &'static str) -> MarketError {
        MarketError::Line {
            line: self.number,
            found: shortened(&String::from_utf8_lossy(&self.text)),
            expected,
        }
    }

    fn skip_line(&mut self) -> io::Result<()> {
        loop {
            let held = self.reader.fill_buf()?;
            let end = held.iter().position(|&byte| byte == b'\n');
            let (count, done) = match end {
                Some(place) => (place + 1, true),
                None => (held.len(), held.is_empty()),
            };
            self.reader.consume(count);
            if done {
                return Ok(());
            }
        }
    }

    /// The next line that is no comment and not empty.
    fn next_filled(&mut self) -> Result<Option<String>, MarketError> {
        loop {
            match self.next()? {
                None => return Ok(None),
                Some(text) if text.is_empty() || text.starts_with('%') => {}
                Some(text) => return Ok(Some(text.to_owned())),
            }
        }
    }
}

/// What is shown of a line.
fn shortened(text: &str) -> String {
    let text = text.trim();
    if text.chars().count() > 60 {
        let mut short: String = text.chars().take(60).collect();
        short.push_str("..");
        short
    } else {
        text.to_owned()
    }
}

/// Reads a matrix.
///
/// ```
/// let text = "%%MatrixMarket matrix coordinate real symmetric\n2 2 3\n1 1 2.0\n2 1 -1.0\n2 2 1.0\n";
/// let matrix = hertzian_structure::market::read(text.as_bytes())?;
/// assert_eq!(matrix.get(0, 1), -1.0);
/// # Ok::<(), hertzian_structure::market::MarketError>(())
/// ```
///
/// # Errors
/// What is wrong, with the number of its line.
pub fn read(reader: impl BufRead) -> Result<SparseMatrix, MarketError> {
    let mut lines = Lines {
        reader,
        number: 0,
        text: Vec::new(),
    };
    let mirror = header(lines.next()?.unwrap_or_default())?;
    let sizes = lines.next_filled()?;
    let line = lines.number;
    let sizes = sizes.unwrap_or_default();
    let numbers: Option<Vec<usize>> = sizes.split_whitespace().map(|x| x.parse().ok()).collect();
    let Some(&[rows, columns, claimed]) = numbers.as_deref() else {
        return Err(MarketError::Line {
            line,
            found: shortened(&sizes),
            expected: "numbers of rows, columns and entries",
        });
    };
    if rows.max(columns) > MOST_COORDINATES {
        return Err(MarketError::Size {
            line,
            rows,
            columns,
        });
    }
    let triplets = entries(&mut lines, claimed, [rows, columns], mirror)?;
    let entries = triplets.len();
    if rows.max(columns) > EMPTY.saturating_add(PER_ENTRY.saturating_mul(entries)) {
        return Err(MarketError::Empty {
            line,
            rows,
            columns,
            entries,
        });
    }
    let line = lines.number;
    SparseMatrix::from_triplets(rows, columns, triplets)
        .map_err(|source| MarketError::Entry { line, source })
}

fn entries<R: BufRead>(
    lines: &mut Lines<R>,
    claimed: usize,
    [rows, columns]: [usize; 2],
    mirror: Mirror,
) -> Result<Vec<(usize, usize, f64)>, MarketError> {
    let mut triplets = Vec::new();
    let mut found = 0;
    while let Some(text) = lines.next()? {
        if text.is_empty() || text.starts_with('%') {
            continue;
        }
        let Some((row, column, value)) = entry(text) else {
            let found = shortened(text);
            return Err(MarketError::Line {
                line: lines.number,
                found,
                expected: "a row and a column, counted from one, and a number",
            });
        };
        let line = lines.number;
        found += 1;
        if found > claimed {
            return Err(MarketError::Count {
                line,
                claimed,
                found,
            });
        }
        let (r, c) = (row - 1, column - 1);
        let possible = can_stand(r, c, value, [rows, columns]);
        possible.map_err(|source| MarketError::Entry { line, source })?;
        triplets.push((r, c, value));
        let sign = match mirror {
            Mirror::None => continue,
            _ if r < c => return Err(MarketError::Triangle { line, row, column }),
            Mirror::Same => 1.0,
            Mirror::Negative => -1.0,
        };
        if r != c {
            triplets.push((c, r, sign * value));
        }
    }
    if found < claimed {
        return Err(MarketError::Count {
            line: lines.number,
            claimed,
            found,
        });
    }
    Ok(triplets)
}

fn entry(text: &str) -> Option<(usize, usize, f64)> {
    let mut words = text.split_ascii_whitespace();
    let mut index = || {
        words
            .next()?
            .parse()
            .ok()
            .filter(|&index: &usize| index > 0)
    };
    let (row, column) = (index()?, index()?);
    let value = words.next()?.parse().ok()?;
    words.next().is_none().then_some((row, column, value))
}

fn header(text: &str) -> Result<Mirror, MarketError> {
    let lower = text.to_lowercase();
    let words: Vec<&str> = lower.split_whitespace().collect();
    let &["%%matrixmarket", "matrix", format, field, symmetry] = words.as_slice() else {
        let found = shortened(text);
        return Err(MarketError::Header { found });
    };
    let kind = |word: &str, expected| MarketError::Kind {
        word: word.to_owned(),
        expected,
    };
    if format != "coordinate" {
        return Err(kind(
            format,
            "given by row and column (`coordinate`); a full array can be an NPY file",
        ));
    }
    if !["real", "integer", "double"].contains(&field) {
        return Err(kind(field, "`real` or `integer`"));
    }
    match symmetry {
        "general" => Ok(Mirror::None),
        "symmetric" => Ok(Mirror::Same),
        "skew-symmetric" => Ok(Mirror::Negative),
        word => Err(kind(word, "`general`, `symmetric` or `skew-symmetric`")),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    const SOUND: &str = "%%MatrixMarket matrix coordinate real symmetric\n% of a test\n\n3 3 4\n1 1 2\n2 1 -1e0\n2 2 +2.0\n3 3 1.5\n";

    fn said(text: &str) -> String {
        read(text.as_bytes()).expect_err("it is faulty").to_string()
    }

    #[test]
    fn kinds_of_symmetry_are_completed() {
        let matrix = read(SOUND.as_bytes()).unwrap();
        assert_eq!((matrix.get(0, 1), matrix.get(1, 0)), (-1.0, -1.0));
        let skew = "%%MatrixMarket matrix coordinate integer skew-symmetric\r\n2 2 1\r\n2 1 3\r\n";
        let matrix = read(skew.as_bytes()).unwrap();
        assert_eq!((matrix.get(0, 1), matrix.get(1, 0)), (-3.0, 3.0));
        let general = "%%MatrixMarket matrix coordinate real general\n1 2 1\n1 2 4\n";
        assert_eq!(read(general.as_bytes()).unwrap().get(0, 1), 4.0);
    }

    #[test]
    fn faults_are_said_with_their_line() {
        let swapped = |from: &str, to: &str| said(&SOUND.replace(from, to));
        assert!(swapped("coordinate real", "array real").starts_with("line 1: `array`"));
        assert!(swapped("real", "complex").starts_with("line 1: `complex`"));
        assert!(swapped("%%", "").starts_with("line 1:"));
        assert!(swapped("3 3 4", "3 3 1000000000").contains("says 1000000000 entries, and has 4"));
        assert!(swapped("3 3 4", "1000000000 1000000000 4").contains("at most"));
        assert!(
            swapped("3 3 4", "20000000 20000000 4")
                .starts_with("line 4: 20000000 by 20000000, with 5 entries")
        );
        assert!(swapped("3 3 4", "3 3").starts_with("line 4: `3 3`: expected numbers"));
        assert!(swapped("3 3 1.5", "").contains("has 3"));
        assert!(swapped("3 3 1.5", "3 3 1.5\n1 1 1").contains("has 5 or more"));
        assert!(swapped("3 3 1.5", "3 3 nan").starts_with("line 8:"));
        assert!(swapped("3 3 1.5", "4 3 1").contains("line 8: an entry stands in row 3"));
        assert!(swapped("3 3 1.5", "0 3 1").contains("counted from one"));
        assert!(swapped("2 1 -1e0", "1 2 -1").contains("above the diagonal"));
        assert!(swapped("1.5", "1.5x").starts_with("line 8: `3 3 1.5x`"));
        assert!(said("").starts_with("line 1:"));
        let long = format!("{SOUND}{}", "1 ".repeat(2000));
        assert!(said(&long).contains("at most 1024 bytes"));
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(500))]

        /// Bytes that are cut, changed or put in end in a matrix or a sentence.
        #[test]
        fn damaged_files_are_read_or_refused(at in 0..SOUND.len(), cut in 0..9_usize, put in prop::collection::vec(any::<u8>(), 0..9)) {
            let mut bytes = SOUND.as_bytes().to_vec();
            let end = (at + cut).min(bytes.len());
            bytes.splice(at..end, put);
            match read(bytes.as_slice()) {
                Ok(matrix) => prop_assert!(matrix.entries() < 100),
                Err(error) => prop_assert!(!error.to_string().contains('\n')),
            }
        }
    }
}
