//! The rows of the legend.

use super::bars;
use super::cloud;
use super::contents::Contents;
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
    let mut add = |sample, label: &str| {
        let label = label.to_string();
        let entry = Entry { sample, label };
        if !entries.contains(&entry) {
            entries.push(entry);
        }
    };
    let several = chart.curves.len() > 1;
    let styles = Styles::of(chart);
    let shaped = are_told_apart(&styles.curves);
    let curves = chart.curves.iter().zip(styles.curves);
    let curves = curves.filter(|(curve, _)| several && !curve.label.is_empty());
    for (curve, style) in curves {
        let pen = curve_pen(style, Line::Stable);
        let sample = if shaped {
            Sample::Shaped(pen, Shape::of(style))
        } else {
            Sample::Line(pen)
        };
        add(sample, &curve.label);
    }
    for line in [Line::Stable, Line::Unstable, Line::Undecided] {
        let mut runs = chart.curves.iter().flat_map(|curve| &curve.runs);
        if runs.any(|run| run.line == line && !run.points.is_empty()) {
            let pen = curve_pen(0, line);
            let colour = if several { INK } else { pen.colour };
            add(Sample::Line(Pen { colour, ..pen }), line.name());
        }
    }
    for (reference, (pen, lines)) in chart.references.iter().zip(&contents.references) {
        if !lines.is_empty() && !reference.label.is_empty() {
            add(Sample::Line(*pen), &reference.label);
        }
    }
    for (trace, (pen, lines)) in chart.traces.iter().zip(&contents.traces) {
        if !lines.is_empty() && !trace.label.is_empty() {
            add(Sample::Line(*pen), &trace.label);
        }
    }
    for (series, joined) in chart.joined.iter().zip(&contents.joined) {
        if !joined.points.is_empty() && !series.label.is_empty() {
            add(Sample::Joined(joined.pen, joined.index), &series.label);
        }
    }
    for (index, cloud) in chart.clouds.iter().enumerate() {
        if !cloud.points.is_empty() && !cloud.label.is_empty() {
            let pen = cloud::pen(index, chart.clouds.len());
            add(Sample::Dots(pen), &cloud.label);
        }
    }
    for (colour, label) in filled(chart) {
        add(Sample::Area(colour), label);
    }
    for (markers, (shape, pixels)) in chart.markers.iter().zip(&contents.markers) {
        let label = &markers.series.label;
        if !pixels.is_empty() && !label.is_empty() {
            let sample = if markers.event {
                Sample::Open(*shape)
            } else {
                Sample::Filled(*shape)
            };
            add(sample, label);
        }
    }
    entries
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
