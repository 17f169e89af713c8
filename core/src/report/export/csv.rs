//! Tables as comma-separated values (RFC 4180).

use std::fmt::Write;
use std::path::Path;

use crate::branches::branch::Branch;
use crate::error::Error;
use crate::report::error::FileError;

use super::table::Table;

/// Rows of cells below the names of their columns, with a line break after every row.
pub(super) fn text<R: AsRef<[String]>>(
    names: &[String],
    rows: impl IntoIterator<Item = R>,
) -> String {
    let mut text = String::new();
    line(&mut text, names);
    for row in rows {
        line(&mut text, row.as_ref());
    }
    text
}

fn line(text: &mut String, cells: &[String]) {
    for (index, cell) in cells.iter().enumerate() {
        let comma = if index == 0 { "" } else { "," };
        // Writing to a string does not fail.
        let _ = if cell.contains([',', '"', '\n', '\r']) {
            write!(text, "{comma}\"{}\"", cell.replace('"', "\"\""))
        } else {
            write!(text, "{comma}{cell}")
        };
    }
    text.push('\n');
}

/// Writes a text.
///
/// # Errors
/// If the file cannot be written.
pub(super) fn write(path: &Path, text: &str) -> Result<(), Error> {
    hertzian_file::write(path, text).map_err(|source| FileError::not_written(path, &source).into())
}

impl Table {
    /// The text of the table, with a line break after every row.
    pub fn to_csv(&self) -> String {
        text(self.names(), self.rows())
    }
}

impl Branch {
    /// The orbits as a table with names of the columns, one row for each: see [`COLUMNS`](super::COLUMNS).
    pub fn to_csv(&self) -> String {
        Table::of_branch(self).to_csv()
    }

    /// Writes the orbits as a table, one row for each: see [`COLUMNS`](super::COLUMNS).
    ///
    /// # Errors
    /// If the file cannot be written.
    pub fn write_csv(&self, path: impl AsRef<Path>) -> Result<(), Error> {
        write(path.as_ref(), &self.to_csv())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_cell_with_a_comma_is_quoted() {
        let names = ["a,b".to_owned()];
        let row = ["\"".to_owned(), "c".to_owned()];
        assert_eq!(text(&names, [row]), "\"a,b\"\n\"\"\"\",c\n");
    }
}
