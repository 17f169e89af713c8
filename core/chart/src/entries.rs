//! The rows of the legend.

use super::bars;
use super::cloud;
use super::contents::{Contents, Joined};
use super::legend::{Entry, Sample};
use super::raster::Raster;
use super::shape::Shape;
use super::style::{Styles, are_told_apart, curve_pen};
use super::svg::{BAND, INK, Pen};
use super::{Chart, Line};

/// The rows of the legend: the curves if there are several, the kinds of line, references, markers; only what is seen, and
/// nothing twice.
pub(super) fn entries(chart: &Chart, contents: &Contents) -> Vec<Entry> {
    let mut entries: Vec<Entry> = Vec::new();
    let rows = of_curves(chart)
        .into_iter()
        .chain(of_lines(chart, contents))
        .chain(of_points(chart, contents));
    for (sample, label) in rows {
        let label = label.to_owned();
        let entry = Entry { sample, label };
        if !entry.label.is_empty() && !entries.contains(&entry) {
            entries.push(entry);
        }
    }
    entries
}

/// Names of curves, where there are several, and kinds of line.
fn of_curves(chart: &Chart) -> Vec<(Sample, &str)> {
    let several = chart.curves.len() > 1;
    let styles = Styles::of(chart);
    let shaped = are_told_apart(&styles.curves);
    let curves = chart.curves.iter().zip(styles.curves);
    let curves = curves.filter(|_| several).map(|(curve, style)| {
        let pen = curve_pen(style, Line::Stable);
        let sample = if shaped {
            Sample::Shaped(pen, Shape::of(style))
        } else {
            Sample::Line(pen)
        };
        (sample, &*curve.label)
    });
    let kinds = [Line::Stable, Line::Unstable, Line::Undecided].into_iter();
    let kinds = kinds.filter(|line| {
        let mut runs = chart.curves.iter().flat_map(|curve| &curve.runs);
        runs.any(|run| run.line == *line && !run.points.is_empty())
    });
    let kinds = kinds.map(|line| {
        let pen = curve_pen(0, line);
        let colour = if several { INK } else { pen.colour };
        (Sample::Line(Pen { colour, ..pen }), line.name())
    });
    curves.chain(kinds).collect()
}

/// References, plain lines, and lines through points.
fn of_lines<'c>(chart: &'c Chart, contents: &Contents) -> Vec<(Sample, &'c str)> {
    let references = chart.references.iter().zip(&contents.references);
    let traces = chart.traces.iter().zip(&contents.traces);
    let lines = references.chain(traces);
    let lines = lines.filter(|(_, (_, lines))| !lines.is_empty());
    let lines = lines.map(|(series, (pen, _))| (Sample::Line(*pen), &*series.label));
    let joined = chart.joined.iter().zip(&contents.joined);
    let joined = joined.filter(|(_, joined)| !joined.points.is_empty());
    let joined = joined
        .map(|(series, Joined { pen, index, .. })| (Sample::Joined(*pen, *index), &*series.label));
    lines.chain(joined).collect()
}

/// Clouds, what is filled, and markers.
fn of_points<'c>(chart: &'c Chart, contents: &Contents) -> Vec<(Sample, &'c str)> {
    let clouds = chart.clouds.iter().enumerate();
    let clouds = clouds.filter(|(_, cloud)| !cloud.points.is_empty());
    let clouds = clouds.map(|(index, cloud)| {
        let pen = cloud::pen(index, chart.clouds.len());
        (Sample::Dots(pen), &*cloud.label)
    });
    let filled = filled(chart).map(|(colour, label)| (Sample::Area(colour), label));
    let markers = chart.markers.iter().zip(&contents.markers);
    let markers = markers.filter(|(_, (_, pixels))| !pixels.is_empty());
    let markers = markers.map(|(markers, (shape, _))| {
        let sample = if markers.event {
            Sample::Open(*shape)
        } else {
            Sample::Filled(*shape)
        };
        (sample, &*markers.series.label)
    });
    clouds.chain(filled).chain(markers).collect()
}

/// Names of what is filled, with the colours.
fn filled(chart: &Chart) -> impl Iterator<Item = (&'static str, &str)> {
    let bands = chart.bands.iter().map(|band| (BAND, band.label.as_str()));
    let bars = [bars::LARGER, bars::SMALLER]
        .into_iter()
        .zip(&chart.of_bars);
    let bars = bars.map(|(colour, label)| (colour, label.as_str()));
    let cells = chart.raster.iter().flat_map(Raster::shown);
    bands
        .chain(bars)
        .filter(|(_, label)| !label.is_empty())
        .chain(cells)
}
