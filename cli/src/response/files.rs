//! Writing the results to files.

use std::io;
use std::path::Path;

use hertzian::bifurcation::Searched;
use hertzian::chart::{Chart, Page};
use hertzian::export::{self, Table};
use hertzian::shooting::BifurcationCurve;
use hertzian::{Branch, Point, System};
use serde::Serialize;

use super::backbone::Backbone;
use super::options::Options;
use super::run::Failure;
use super::sensitive::{self, At};
use super::structure::Reduction;

/// A form in which results are written when all is computed.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Form {
    Picture,
    Table,
    Json,
}

/// Where each form that was asked for is written.
fn forms(options: &Options) -> impl Iterator<Item = (Form, &Path)> {
    let optional = [(Form::Table, &options.csv), (Form::Json, &options.json)];
    let optional = optional.into_iter();
    let optional = optional.filter_map(|(form, path)| Some((form, path.as_deref()?)));
    std::iter::once((Form::Picture, options.svg.as_path())).chain(optional)
}

/// All files that are written, those too that are written on the way.
pub fn paths(options: &Options) -> impl Iterator<Item = &Path> {
    let besides = [
        &options.panels,
        &options.sensitivities,
        &options.tornado,
        &options.keep,
        &options.resume,
    ];
    let besides = besides.into_iter().filter_map(|path| path.as_deref());
    forms(options).map(|(_, path)| path).chain(besides)
}

/// Writes the files that were asked for.
///
/// # Errors
/// If one cannot be written.
pub fn write(
    options: &Options,
    model: &dyn System,
    record: &Record<'_>,
    charts: &[Chart],
    sensitivities: &[At],
) -> Result<(), Failure> {
    for (form, path) in forms(options) {
        let contents = match form {
            Form::Picture => Ok(page(charts.to_vec()).into_bytes()),
            Form::Table => Ok(table(model, record.branches).to_csv().into_bytes()),
            Form::Json if sensitivities.is_empty() => json(record),
            Form::Json => text(&WithSensitivities {
                record,
                sensitivities,
            }),
        };
        contents
            .and_then(|contents| export::write(path, contents))
            .map_err(|error| Failure::File(path.to_path_buf(), error))?;
    }
    sensitive::write(options, record.branches, sensitivities)
}

/// Charts as one picture.
pub fn page(charts: Vec<Chart>) -> String {
    match charts.as_slice() {
        [chart] => chart.to_svg(),
        _ => charts.into_iter().fold(Page::new(2), Page::chart).to_svg(),
    }
}

/// The orbits of all branches.
pub(crate) fn table(model: &dyn System, branches: &[Branch]) -> Table {
    let of = branches.first().and_then(Branch::accuracy_of);
    let mut table = Table::of(model).with_errors_of(of);
    for (number, branch) in branches.iter().enumerate() {
        let points = branch.points.iter();
        points.for_each(|point| table.add(number, point));
    }
    table
}

/// What `--json` writes: results of the library as they are. `Branch::read_all` (`core/src/report/export/json.rs`) reads `version` and `branches`.
#[derive(Debug, Serialize)]
pub struct Record<'r> {
    /// The version of the form.
    pub version: u32,
    /// The branch that was asked for, and those that were joined or are of its bifurcations.
    pub branches: &'r [Branch],
    /// Where motions were followed until they settled, to find further branches.
    pub searched: &'r [Searched],
    /// Parts of the range without an orbit.
    pub uncovered: &'r [[f64; 2]],
    /// Every orbit at the values that were asked for.
    pub at: &'r [Point],
    /// Curves of bifurcations in two parameters.
    pub tracks: &'r [BifurcationCurve],
    /// Free oscillation and phase resonance.
    pub backbone: &'r Backbone,
    /// What the reduction of a structure of many coordinates changes.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub reduction: Option<&'r Reduction>,
}

/// The same, with derivatives by parameters.
#[derive(Debug, Serialize)]
struct WithSensitivities<'r> {
    #[serde(flatten)]
    record: &'r Record<'r>,
    sensitivities: &'r [At],
}

pub(crate) fn json(record: &Record<'_>) -> io::Result<Vec<u8>> {
    text(record)
}

fn text(record: &impl Serialize) -> io::Result<Vec<u8>> {
    let mut text = serde_json::to_vec(record)?;
    text.push(b'\n');
    Ok(text)
}

/// Writes a table.
///
/// # Errors
/// If the file cannot be written.
pub fn write_csv(
    path: &Path,
    fill: impl FnOnce(&mut csv::Writer<Vec<u8>>) -> csv::Result<()>,
) -> io::Result<()> {
    let mut writer = csv::Writer::from_writer(Vec::new());
    fill(&mut writer)?;
    let text = writer
        .into_inner()
        .map_err(csv::IntoInnerError::into_error)?;
    export::write(path, text)
}
