//! A branch as comma-separated values.

use std::path::Path;

use crate::branches::branch::Branch;
use crate::error::Error;
use crate::report::error::FileError;

use super::table::Table;

impl Branch {
    /// The orbits as a table with names of the columns, one row for each: see [`COLUMNS`](super::COLUMNS).
    pub fn to_csv(&self) -> String {
        let mut table = Table::of_model(&self.model).with_errors_of(self.accuracy_of());
        for point in &self.points {
            table.add(0, point);
        }
        table.to_csv()
    }

    /// Writes the orbits as a table, one row for each: see [`COLUMNS`](super::COLUMNS).
    ///
    /// # Errors
    /// If the file cannot be written.
    pub fn write_csv(&self, path: impl AsRef<Path>) -> Result<(), Error> {
        let path = path.as_ref();
        hertzian_file::write(path, self.to_csv()).map_err(|source| {
            let (path, kind) = (path.to_path_buf(), source.kind());
            FileError::Write { path, kind }.into()
        })
    }
}
