//! A map as comma-separated values and as JSON.

use std::path::Path;

#[cfg(feature = "serde")]
use serde::{Deserialize, Serialize};

use crate::bifurcation::{Cell, Map};
use crate::branches::branch::Model;
use crate::error::Error;
#[cfg(feature = "serde")]
use crate::report::error::FileError;
use crate::report::export::csv;
#[cfg(feature = "serde")]
use crate::report::export::json::{JSON_VERSION, read, write};
use crate::report::export::table::{maybe, number};
use crate::report::unit::in_unit;

/// Names of the columns after those of the two parameters and the counts; the first has the unit of the signal.
const COLUMNS: [&str; 4] = ["largest", "periods", "verdict", "reason"];

impl Map {
    /// A table with names of the columns, one row for each cell: the two parameters by their names; `stable`, `unstable`, `undecided`,
    /// `missed`, `motions`, `restless` and `largest` as of [`Cell`]; `periods` of the stable orbits, with spaces; `verdict`, what can be said
    /// of all solutions together; `reason`, why nothing is known. What is not known is empty.
    pub fn to_csv(&self) -> String {
        let own: Vec<&str> = Cell::COUNTED.into_iter().chain(COLUMNS).collect();
        let mut names: Vec<String> = Vec::new();
        for name in &self.names {
            let mut column = name.clone();
            while own.contains(&column.as_str()) {
                column.push('_');
            }
            names.push(in_unit(&column, unit(&self.model, name)));
        }
        names.extend(Cell::COUNTED.map(str::to_owned));
        let [largest, rest @ ..] = COLUMNS;
        names.push(in_unit(largest, self.model.unit_of(&self.signal)));
        names.extend(rest.map(str::to_owned));
        let rows = self.cells.iter().enumerate().map(|(place, cell)| {
            let values = self.at(place).unwrap_or([f64::NAN; 2]).map(number);
            let row = values.into_iter().chain(cells(cell));
            row.collect::<Vec<String>>()
        });
        csv::text(&names, rows)
    }

    /// Writes the [table](Self::to_csv).
    ///
    /// # Errors
    /// If the file cannot be written.
    pub fn write_csv(&self, path: impl AsRef<Path>) -> Result<(), Error> {
        csv::write(path.as_ref(), &self.to_csv())
    }
}

/// The unit of a parameter, or of the frequency.
pub(crate) fn unit<'m>(model: &'m Model, name: &str) -> &'m str {
    if name == "omega" {
        return if model.units.is_empty() { "" } else { "rad/s" };
    }
    let mut parameters = model.parameters.iter();
    let parameter = parameters.find(|parameter| parameter.name == name);
    parameter.map_or("", |parameter| &parameter.unit)
}

/// A cell as the texts of its counts and of [`COLUMNS`].
fn cells(cell: &Cell) -> Vec<String> {
    if let Some(reason) = &cell.reason {
        let mut cells = vec![String::new(); Cell::COUNTED.len() + COLUMNS.len() - 2];
        cells.extend([cell.verdict().to_string(), reason.to_string()]);
        return cells;
    }
    let periods: Vec<String> = cell.periods.iter().map(ToString::to_string).collect();
    let rest = [
        maybe(cell.largest),
        periods.join(" "),
        cell.verdict().to_string(),
        String::new(),
    ];
    let counts = cell.counts().into_iter().map(|count| count.to_string());
    counts.chain(rest).collect()
}

#[cfg(feature = "serde")]
#[derive(Serialize)]
struct Written<'m> {
    version: u32,
    map: &'m Map,
}

#[cfg(feature = "serde")]
#[derive(Deserialize)]
struct Read {
    map: Map,
}

#[cfg(feature = "serde")]
impl Map {
    /// Writes it as JSON: an object with a `version` and the `map`. Fields have the names that they have here, and numbers are written as
    /// those of [a branch](crate::Branch::write).
    ///
    /// # Errors
    /// If the file cannot be written.
    pub fn write(&self, path: impl AsRef<Path>) -> Result<(), Error> {
        let written = Written {
            version: JSON_VERSION,
            map: self,
        };
        Ok(write(path.as_ref(), &written)?)
    }

    /// The map of a file that [`write`](Self::write) or `hertzian map --json` has written. It is equal to what was written.
    ///
    /// # Errors
    /// If the file cannot be read, is none of these, ends early, is of another version, or has not as many cells as values.
    pub fn read(path: impl AsRef<Path>) -> Result<Self, Error> {
        let path = path.as_ref();
        let Read { map } = read(path)?;
        let [columns, rows] = [map.values[0].len(), map.values[1].len()];
        let counts = [map.cells.len(), map.branches.len(), map.lost.len()];
        if counts == [columns * rows, rows, rows] && columns * rows > 0 {
            return Ok(map);
        }
        let (path, cells) = (path.to_path_buf(), map.cells.len());
        let reason = format!("{cells} cells for {columns} values and {rows} rows");
        Err(FileError::Format { path, reason }.into())
    }
}
