//! What is inside the frame of a chart.

use super::along;
use super::area;
use super::band;
use super::bars;
use super::cloud::{self, Dots};
use super::drawing::Plot;
use super::legend::{Entry, Sample};
use super::mark::{self, Kind, Merged};
use super::note::{self, Named, Placed};
use super::polyline::polylines;
use super::shape::{Shape, draw_shape};
use super::svg::{BAND, INK, Pen, Pixel, Rectangle, Svg, pen};
use super::{Chart, Line, Note, Series};

/// Dark blue, vermilion, sky blue, black, green, orange, purple: the first four differ in lightness too.
const COLOURS: [&str; 7] = [
    "#0b4f8a", "#d55e00", "#56b4e9", "#000000", "#007a5a", "#e69f00", "#aa4f8c",
];
/// By how much the white line behind one upon cells is wider than it.
const HALO: f64 = 2.8;
const REFERENCE: Pen = pen("#666666", 1.4, "12 4 2 4");

/// What is inside the frame, in pixels.
pub(super) struct Contents {
    references: Vec<Vec<Vec<Pixel>>>,
    areas: Vec<(&'static str, Vec<Vec<Pixel>>)>,
    bands: Vec<Vec<Vec<Pixel>>>,
    bars: Vec<bars::Drawn>,
    runs: Vec<(Pen, Vec<Vec<Pixel>>)>,
    /// Small shapes along curves, with their colour.
    along: Vec<(&'static str, Shape, Vec<Pixel>)>,
    /// Of each kind of markers, in the order of the chart.
    markers: Vec<(Shape, Vec<Pixel>)>,
    traces: Vec<(Pen, Vec<Vec<Pixel>>)>,
    clouds: Vec<Dots>,
    notes: Vec<Placed>,
    /// Everything is covered by coloured cells.
    covered: Option<Rectangle>,
}

impl Contents {
    pub(super) fn of(chart: &Chart, plot: &Plot) -> Self {
        let lines = |points: &[[f64; 2]]| {
            polylines(points.iter().map(|&point| plot.pixel(point)), &plot.frame)
        };
        let references = chart.references.iter();
        let styles = Styles::of(chart);
        let curves = chart.curves.iter().zip(&styles.curves);
        let runs = curves.flat_map(|(curve, &style)| {
            let runs = curve.runs.iter();
            runs.map(move |run| (curve_pen(style, run.line), lines(&run.points)))
        });
        let traces = chart.traces.iter();
        let clouds = chart.clouds.iter();
        let place = |&point: &[f64; 2]| plot.pixel(point).filter(|&p| plot.frame.contains(p));
        let (markers, counts) = markers(chart, plot, &styles);
        let mut contents = Self {
            references: references.map(|line| lines(&line.points)).collect(),
            areas: areas(chart, plot, &styles),
            bands: bands(chart, plot),
            bars: bars::drawn(chart, plot),
            runs: runs.collect(),
            along: Vec::new(),
            markers,
            traces: traces
                .zip(styles.traces)
                .map(|(trace, style)| (trace_pen(style), lines(&trace.points)))
                .collect(),
            clouds: clouds
                .map(|cloud| Dots::of(cloud.points.iter().filter_map(place)))
                .collect(),
            notes: Vec::new(),
            covered: chart.raster.is_some().then_some(plot.frame),
        };
        contents.along = contents.shapes(chart, &styles.curves);
        let named = |note: &Note, dot: bool| {
            let label = note.label.clone();
            place(&note.point).map(|point| Named { label, point, dot })
        };
        let notes = chart.notes.iter().filter_map(|note| named(note, true));
        let texts = chart.texts.iter().filter_map(|text| named(text, false));
        let notes = notes.chain(texts).chain(counts).collect();
        contents.notes = note::place(notes, &plot.frame, &contents.everything());
        contents
    }

    /// Shapes along the curves, where there are several of different styles.
    fn shapes(&self, chart: &Chart, styles: &[usize]) -> Vec<(&'static str, Shape, Vec<Pixel>)> {
        if !are_told_apart(styles) {
            return Vec::new();
        }
        let mut drawn = self.runs.iter();
        let curves = chart.curves.iter().zip(styles);
        let shapes = curves.map(|(curve, &style)| {
            let runs = drawn.by_ref().take(curve.runs.len());
            let places = along::places(runs.flat_map(|(_, lines)| lines), style);
            let Pen { colour, .. } = curve_pen(style, Line::Stable);
            (colour, Shape::of(style), places)
        });
        shapes.collect()
    }

    /// All lines, and each marker as a line of one point.
    pub(super) fn everything(&self) -> Vec<Vec<Pixel>> {
        let references = self.references.iter().flatten();
        let runs = self.runs.iter().flat_map(|(_, lines)| lines);
        let traces = self.traces.iter().flat_map(|(_, lines)| lines);
        let markers = self.markers.iter().flat_map(|(_, pixels)| pixels);
        let covered = self.covered.iter().flat_map(Rectangle::scanned);
        references
            .chain(runs)
            .chain(traces)
            .cloned()
            .chain(markers.map(|&pixel| vec![pixel]))
            .chain(self.clouds.iter().flat_map(Dots::lines))
            .chain(covered)
            .chain(self.notes.iter().flat_map(Placed::lines))
            .chain(self.bars.iter().flat_map(bars::Drawn::lines))
            .collect()
    }

    pub(super) fn draw(&self, svg: &mut Svg) {
        for (colour, polygons) in &self.areas {
            svg.pale_area(polygons, colour);
        }
        for polygons in &self.bands {
            svg.band(polygons);
        }
        for bar in &self.bars {
            bar.draw(svg);
        }
        for lines in &self.references {
            svg.lines(lines, REFERENCE);
        }
        // Two dashed lines upon each other must not look like a solid one: the later covers the earlier. Solid ones come last.
        let (solid, dashed): (Vec<_>, Vec<_>) =
            self.runs.iter().partition(|(pen, _)| pen.dashes.is_empty());
        for (dashes, lines) in dashed {
            let cover = pen("#ffffff", dashes.width, "");
            svg.lines(lines, cover);
            svg.lines(lines, *dashes);
        }
        for (pen, lines) in solid {
            svg.lines(lines, *pen);
        }
        for (colour, shape, places) in &self.along {
            for &place in places {
                along::draw(svg, *shape, place, colour);
            }
        }
        // Upon cells of any lightness a line is seen by a white one that is wider, and that never lies upon another line.
        if self.covered.is_some() {
            for (Pen { width, .. }, lines) in &self.traces {
                svg.lines(lines, pen("#ffffff", width + HALO, ""));
            }
        }
        for (pen, lines) in &self.traces {
            svg.lines(lines, *pen);
        }
        for (index, dots) in self.clouds.iter().enumerate() {
            dots.draw(svg, cloud::pen(index, self.clouds.len()));
        }
        for (shape, pixels) in &self.markers {
            for &pixel in pixels {
                draw_shape(svg, *shape, pixel);
            }
        }
        for note in &self.notes {
            note.draw(svg);
        }
    }
}

/// Places of the markers of each kind, and the counts beside those that stand for several.
fn markers(chart: &Chart, plot: &Plot, styles: &Styles) -> (Vec<(Shape, Vec<Pixel>)>, Vec<Named>) {
    let pixels = chart.markers.iter().map(|markers| {
        let points = markers.series.points.iter();
        let pixels = points.filter_map(|&point| plot.pixel(point));
        let pixels = pixels.filter(|&pixel| plot.frame.grown(0.5).contains(pixel));
        pixels.collect::<Vec<Pixel>>()
    });
    let pixels: Vec<Vec<Pixel>> = pixels.collect();
    let of_kind = chart.markers.iter().zip(&pixels);
    let kinds: Vec<Kind<'_>> = of_kind
        .map(|(markers, pixels)| Kind {
            label: &markers.series.label,
            pixels: if markers.merged { pixels } else { &[] },
        })
        .collect();
    let merged = mark::merged(&kinds);
    let all = chart.markers.iter().zip(&pixels).zip(&styles.markers);
    let drawn = all.enumerate().map(|(kind, ((markers, pixels), &style))| {
        let own = merged.iter().filter(|mark| mark.kind == kind);
        let pixels = if markers.merged {
            own.map(|mark| mark.pixel).collect()
        } else {
            pixels.clone()
        };
        (Shape::of(style), pixels)
    });
    let drawn = drawn.collect();
    let counts = merged.into_iter().filter(|mark| !mark.text.is_empty());
    let counts = counts.map(|Merged { pixel, text, .. }| Named {
        label: text,
        point: pixel,
        dot: false,
    });
    (drawn, counts.collect())
}

/// Filled areas, in the colours of the curves of the same labels.
fn areas(chart: &Chart, plot: &Plot, styles: &Styles) -> Vec<(&'static str, Vec<Vec<Pixel>>)> {
    // Zero has no place on a logarithmic axis.
    let zero = plot.y.range.position(0.0).unwrap_or(0.0);
    let [_, base] = plot.at([0.0, zero]);
    let area = |area: &Series| {
        let mut curves = chart.curves.iter().zip(&styles.curves);
        let own = curves.find(|(curve, _)| curve.label == area.label);
        let style = own.map_or(0, |(_, &style)| style);
        let points = area.points.iter().map(|&point| plot.pixel(point));
        let polygons = area::below(points, base, &plot.frame);
        (curve_pen(style, Line::Stable).colour, polygons)
    };
    chart.areas.iter().map(area).collect()
}

/// Grey bands, within the frame.
fn bands(chart: &Chart, plot: &Plot) -> Vec<Vec<Vec<Pixel>>> {
    let bands = chart.bands.iter().map(|band| {
        let line = |points: &Vec<[f64; 2]>| {
            let points = points.iter();
            let pixels = points.map(|&point| Some(plot.frame.nearest(plot.pixel(point)?)));
            pixels.collect::<Vec<Option<Pixel>>>()
        };
        band::between([line(&band.lines[0]), line(&band.lines[1])])
    });
    bands.collect()
}

/// Whether curves have different styles.
fn are_told_apart(styles: &[usize]) -> bool {
    styles.iter().any(|style| *style != styles[0])
}

/// Numbers of the styles of what is on a chart: parts with one label look alike.
struct Styles {
    curves: Vec<usize>,
    traces: Vec<usize>,
    markers: Vec<usize>,
}

impl Styles {
    fn of(chart: &Chart) -> Self {
        Self {
            curves: numbered(chart.curves.iter().map(|curve| &*curve.label)),
            traces: numbered(chart.traces.iter().map(|trace| &*trace.label)),
            markers: numbered(chart.markers.iter().map(|markers| &*markers.series.label)),
        }
    }
}

/// Labels numbered in the order in which they first appear; empty ones count each for itself.
fn numbered<'l>(labels: impl Iterator<Item = &'l str>) -> Vec<usize> {
    let mut known: Vec<&str> = Vec::new();
    let number = |label: &'l str| {
        let same = known.iter().position(|other| *other == label);
        same.filter(|_| !label.is_empty()).unwrap_or_else(|| {
            known.push(label);
            known.len() - 1
        })
    };
    labels.map(number).collect()
}

fn trace_pen(index: usize) -> Pen {
    let dashes = [
        "",
        "7 3",
        "1.5 2.5",
        "10 3 2 3",
        "16 4",
        "4 2",
        "10 3 2 3 2 3",
        "1.5 6",
    ][index % 8];
    pen(COLOURS[index % COLOURS.len()], 1.2, dashes)
}

fn curve_pen(index: usize, line: Line) -> Pen {
    let colour = COLOURS[index % COLOURS.len()];
    match line {
        Line::Stable => pen(colour, 2.2, ""),
        Line::Unstable => pen(colour, 2.0, "8 4"),
        Line::Undecided => pen(colour, 2.2, "2 3.5"),
    }
}

/// What decides the range of the axes: everything but the references, and without anything else those.
pub(super) fn shown(chart: &Chart) -> impl Iterator<Item = [f64; 2]> {
    let runs = chart.curves.iter().flat_map(|curve| &curve.runs);
    let curves = runs.flat_map(|run| &run.points);
    let markers = chart.markers.iter();
    let markers = markers.flat_map(|markers| &markers.series.points);
    let areas = chart.areas.iter().flat_map(|area| &area.points);
    let traces = chart.traces.iter().flat_map(|trace| &trace.points);
    let bands = chart
        .bands
        .iter()
        .flat_map(|band| band.lines.iter().flatten());
    let clouds = chart.clouds.iter().flat_map(|cloud| &cloud.points);
    let notes = chart.notes.iter().chain(&chart.texts);
    let notes = notes.map(|note| &note.point);
    let plain = chart.traces.is_empty() && chart.clouds.is_empty() && chart.notes.is_empty();
    let alone = plain && chart.curves.is_empty() && chart.markers.is_empty();
    let references = chart.references.iter().filter(move |_| alone);
    curves
        .chain(areas)
        .chain(bands)
        .chain(markers)
        .chain(traces)
        .chain(clouds)
        .chain(notes)
        .chain(references.flat_map(|line| &line.points))
        .filter(|point| point.iter().all(|value| value.is_finite()))
        .copied()
        .chain(bars::shown(&chart.bars))
}

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
    for (line, name) in [
        (Line::Stable, "stable"),
        (Line::Unstable, "unstable"),
        (Line::Undecided, "undecided"),
    ] {
        let mut runs = chart.curves.iter().flat_map(|curve| &curve.runs);
        if runs.any(|run| run.line == line && !run.points.is_empty()) {
            let pen = curve_pen(0, line);
            let colour = if several { INK } else { pen.colour };
            add(Sample::Line(Pen { colour, ..pen }), name);
        }
    }
    for (reference, lines) in chart.references.iter().zip(&contents.references) {
        if !lines.is_empty() && !reference.label.is_empty() {
            add(Sample::Line(REFERENCE), &reference.label);
        }
    }
    for (trace, (pen, lines)) in chart.traces.iter().zip(&contents.traces) {
        if !lines.is_empty() && !trace.label.is_empty() {
            add(Sample::Line(*pen), &trace.label);
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
            add(Sample::Marker(*shape), label);
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
    let cells = chart.raster.iter().flat_map(super::raster::Raster::shown);
    bands
        .chain(bars)
        .filter(|(_, label)| !label.is_empty())
        .chain(cells)
}
