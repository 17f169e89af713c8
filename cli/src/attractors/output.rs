//! Tables, arrays and pictures as files.

use std::io;
use std::path::{Path, PathBuf};

use hertzian::{Error, export};

use super::run::Failure;
use crate::response::files;
use crate::response::places;

/// What a task gives.
#[derive(Debug, Clone, PartialEq)]
pub struct Results {
    /// Names of the columns of the table.
    pub names: Vec<String>,
    /// Its rows.
    pub rows: Vec<Vec<String>>,
    /// The array, as a file.
    pub array: Vec<u8>,
    /// The picture.
    pub svg: String,
    /// Lines for people.
    pub summary: String,
    /// Whether all was computed.
    pub complete: bool,
}

/// A table of numbers, and the same as an array.
#[derive(Debug, Clone, PartialEq)]
pub struct Table {
    names: Vec<String>,
    rows: Vec<Vec<String>>,
    array: Vec<f64>,
}

impl Table {
    /// A table without rows.
    pub fn new(names: Vec<String>) -> Self {
        Self {
            array: Vec::new(),
            rows: Vec::new(),
            names,
        }
    }

    /// Adds a row with as many numbers as there are names.
    pub fn row(&mut self, values: &[f64]) {
        self.rows
            .push(values.iter().map(|&value| number(value)).collect());
        self.array.extend(values);
    }

    /// With a picture and a summary.
    ///
    /// # Errors
    /// If a row had not as many numbers as there are names.
    pub fn with(self, svg: String, summary: String, complete: bool) -> Result<Results, Error> {
        Ok(Results {
            array: export::npy(self.names.len(), &self.array)?,
            names: self.names,
            rows: self.rows,
            svg,
            summary,
            complete,
        })
    }
}

/// As short as reads back to the same number.
pub fn number(value: f64) -> String {
    format!("{value:?}")
}

/// Names of the entries of a state: coordinates, then their rates.
pub fn entries(coordinates: &[impl AsRef<str>]) -> Vec<String> {
    let rates = coordinates.iter().map(|name| format!("d{}", name.as_ref()));
    let names = coordinates.iter().map(|name| name.as_ref().to_owned());
    names.chain(rates).collect()
}

/// The three files of a prefix.
pub fn paths(prefix: &Path) -> [PathBuf; 3] {
    ["csv", "npy", "svg"].map(|extension| {
        let mut name = prefix.as_os_str().to_owned();
        name.push(".");
        name.push(extension);
        PathBuf::from(name)
    })
}

/// Whether the files can be written, as far as can be told without touching them.
///
/// # Errors
/// If one cannot.
pub fn check(prefix: &Path) -> Result<(), Failure> {
    let is_folder = prefix
        .as_os_str()
        .to_string_lossy()
        .ends_with(std::path::is_separator);
    if is_folder || prefix.as_os_str().is_empty() {
        let message = "--out is what the names of the files begin with: a folder alone gives none";
        return Err(Failure::Option(message.to_owned()));
    }
    for path in paths(prefix) {
        places::check(&path).map_err(|error| Failure::File(path, error))?;
    }
    Ok(())
}

/// Writes the files.
///
/// # Errors
/// If one cannot be written.
pub fn write(prefix: &Path, results: &Results) -> Result<(), Failure> {
    let [csv, npy, svg] = paths(prefix);
    write_csv(&csv, results).map_err(|error| Failure::File(csv, error))?;
    export::write(&npy, &results.array).map_err(|error| Failure::File(npy, error))?;
    export::write(&svg, &results.svg).map_err(|error| Failure::File(svg, error))
}

fn write_csv(path: &Path, results: &Results) -> io::Result<()> {
    files::write_csv(path, |writer| {
        writer.write_record(&results.names)?;
        results
            .rows
            .iter()
            .try_for_each(|row| writer.write_record(row))
    })
}
