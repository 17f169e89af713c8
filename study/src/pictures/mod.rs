//! Pictures of a table: maps over two parameters, fans of curves, histograms of places.

mod fan;
mod histogram;
mod linear;
mod map;
mod tracks;

use std::path::{Path, PathBuf};

use hertzian::Cancel;
use hertzian::chart::Chart;

use crate::error::StudyError;
use crate::folder::Folder;
use crate::merge::Source;
use crate::plan::{Picture, Shown, What, Which};
use crate::study::Prepared;
use crate::table::Value;

impl Prepared {
    /// Draws the pictures that the study asks for, of all blocks of these folders, into the first one. Curves that are tracked over a map, and
    /// linear propagation, end where the token is cancelled.
    ///
    /// # Errors
    /// If one cannot be drawn or written.
    pub fn draw(&self, folders: &[Folder], cancel: &Cancel) -> Result<Vec<PathBuf>, StudyError> {
        let Some(into) = folders.first().map(Folder::path) else {
            return Ok(Vec::new());
        };
        let source = Source::new(self, folders);
        let mut files = Vec::new();
        for (place, picture) in self.plan.pictures.iter().enumerate() {
            let path = into.join(name(picture, place));
            let failed = |error| StudyError::io(into.join("blocks"), error);
            let chart = match picture.what {
                Shown::Map => {
                    let map = map::map(&source).map_err(failed)?;
                    let chart = map::chart(&map, picture);
                    if picture.tracks {
                        tracks::over(chart, &map, self, cancel)
                    } else {
                        chart
                    }
                }
                Shown::Histogram => histogram::chart(&source, picture, cancel).map_err(failed)?,
                Shown::Fan => fan::chart(&source, picture).map_err(failed)?,
            };
            write(&chart, &path)?;
            files.push(path);
        }
        Ok(files)
    }
}

fn write(chart: &Chart, path: &Path) -> Result<(), StudyError> {
    hertzian_file::write(path, chart.to_svg()).map_err(|error| StudyError::io(path, error))
}

/// The name of the file of a picture.
fn name(picture: &Picture, place: usize) -> PathBuf {
    let word = match picture.what {
        Shown::Map => "map",
        Shown::Histogram => "histogram",
        Shown::Fan => "fan",
    };
    picture
        .file
        .clone()
        .unwrap_or_else(|| PathBuf::from(format!("{word}-{}.svg", place + 1)))
}

/// Whether the pictures can be drawn.
///
/// # Errors
/// Why one cannot.
pub(crate) fn check(study: &Prepared) -> Result<(), StudyError> {
    let what = study.plan.request.what;
    for (place, picture) in study.plan.pictures.iter().enumerate() {
        let key = format!("pictures, {}", place + 1);
        let refused = |message: &str| Err(StudyError::value(key.as_str(), message));
        match picture.what {
            Shown::Map if what != What::Solutions || study.designed.side().is_none() => {
                return refused(
                    "a map needs what = \"solutions\", and a grid over one parameter besides what varies along the rows",
                );
            }
            Shown::Map if cells(study) > MOST_CELLS => {
                let message = format!(
                    "a map of {} cells: at most {MOST_CELLS} are drawn; draw parts of it, or fewer values",
                    cells(study)
                );
                return refused(&message);
            }
            Shown::Histogram if what == What::Solutions => {
                return refused("a histogram needs events, which solutions have not");
            }
            Shown::Histogram if picture.linear && study.designed.moments().is_none() => {
                return refused(
                    "`linear` needs distributions: design = \"sobol\", \"latin-hypercube\" or \"random\"",
                );
            }
            Shown::Map | Shown::Fan if picture.linear => {
                return refused("`linear` belongs to what = \"histogram\"");
            }
            Shown::Fan if what == What::Solutions || study.at.len() < 2 => {
                return refused("a fan needs orbits at values: give `keep.at` at least two");
            }
            _ => {}
        }
        let outside = |part: &f64| !(0.0..=1.0).contains(part);
        if let Some(part) = picture
            .quantiles
            .iter()
            .flatten()
            .find(|part| outside(part))
        {
            return refused(&format!("quantile {part} is not between 0 and 1"));
        }
        if let Some(signal) = &picture.of
            && picture.what == Shown::Fan
            && !study
                .signals
                .iter()
                .any(|known| known.to_string() == *signal)
        {
            return refused(&format!("`{signal}` is none of keep.signals"));
        }
    }
    Ok(())
}

/// Cells of a map: values along the rows, times those of the grid.
fn cells(study: &Prepared) -> usize {
    let side = study.designed.side().map_or(0, |(_, side)| side.len());
    study.at.len().saturating_mul(side)
}

/// Cells of a map that is drawn: all of them are held at once, and each is a rectangle of the picture.
const MOST_CELLS: usize = 1 << 18;

/// Quantiles that are shown.
fn quantiles(picture: &Picture) -> Vec<f64> {
    let mut parts = picture
        .quantiles
        .clone()
        .unwrap_or_else(|| vec![0.05, 0.25, 0.5, 0.75, 0.95]);
    parts.sort_by(f64::total_cmp);
    parts
}

/// A quantile of values in increasing order, the seventh definition of Hyndman and Fan (1996); not a number of none.
fn quantile(sorted: &[f64], part: f64) -> f64 {
    let place = part * sorted.len().saturating_sub(1) as f64;
    let below = place.floor() as usize;
    let (Some(low), Some(high)) = (
        sorted.get(below),
        sorted.get((below + 1).min(sorted.len().saturating_sub(1))),
    ) else {
        return f64::NAN;
    };
    low + (place - below as f64) * (high - low)
}

/// A quantile in words.
fn percent(part: f64) -> String {
    match part {
        0.5 => "median".to_owned(),
        part => format!("{} %", (1e6 * part).round() / 1e4),
    }
}

/// A number of a row.
fn number(row: &[Value], place: usize) -> Option<f64> {
    match row.get(place)? {
        Value::Number(value) => Some(*value),
        Value::Whole(value) => Some(*value as f64),
        _ => None,
    }
}

/// Whether a text stands in a row.
fn is(row: &[Value], place: usize, text: &str) -> bool {
    matches!(row.get(place), Some(Value::Text(found)) if found == text)
}

/// Of two values the one that is asked for.
fn better(which: Which, known: Option<f64>, value: f64) -> f64 {
    known.map_or(value, |known| match which {
        Which::Highest => known.max(value),
        Which::Lowest => known.min(value),
    })
}

/// The place of a column that is there.
fn place(study: &Prepared, name: &str) -> usize {
    let mut columns = study.columns.iter();
    columns
        .position(|column| column.name == name)
        .unwrap_or(usize::MAX)
}

/// What varies along branches, with its unit.
fn along(study: &Prepared) -> String {
    let name = &study.plan.request.vary;
    let shown = if name == "omega" {
        "excitation frequency ω"
    } else {
        name
    };
    match hertzian::Model::of(&*study.system).unit_of_varied(name) {
        "" => shown.to_owned(),
        unit => format!("{shown} [{unit}]"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The values that R gives for `quantile(c(1, 2, 4, 8), c(0, 0.1, 0.5, 1))`, by its default.
    #[test]
    fn quantiles_are_those_of_the_seventh_definition() {
        let sorted = [1.0, 2.0, 4.0, 8.0];
        let found = [0.0, 0.1, 0.5, 1.0].map(|part| quantile(&sorted, part));
        for (found, expected) in found.into_iter().zip([1.0, 1.3, 3.0, 8.0]) {
            assert!((found - expected).abs() < 1e-15);
        }
        assert!(quantile(&[], 0.5).is_nan());
        assert_eq!(quantile(&[3.0], 0.9), 3.0);
    }
}
