//! Puts a chart on the page.

use super::axis::{Range, Scale, Ticks, superscript};
use super::cloud::{self, Dots};
use super::legend::{Entry, Legend, Sample};
use super::note::{self, Placed};
use super::polyline::polylines;
use super::shape::{Shape, draw_shape};
use super::svg::{Anchor, INK, Pen, Pixel, Rectangle, Svg, fitted, width_of};
use super::{Axis, Chart, Line};

pub(super) const WIDTH: f64 = 900.0;
pub(super) const HEIGHT: f64 = 600.0;
const MARGIN: f64 = 18.0;
/// Sizes of letters.
const TITLE: f64 = 19.0;
const LABEL: f64 = 16.0;
const TICK: f64 = 14.0;

/// Dark blue, vermilion, sky blue, black, green, orange, purple: the first four differ in lightness too.
const COLOURS: [&str; 7] = [
    "#0b4f8a", "#d55e00", "#56b4e9", "#000000", "#007a5a", "#e69f00", "#aa4f8c",
];
const GRID: Pen = pen("#e6e6e6", 0.8, "");
const AXIS: Pen = pen(INK, 1.1, "");
const MINOR: Pen = pen(INK, 0.7, "");
const REFERENCE: Pen = pen("#666666", 1.4, "12 4 2 4");

const fn pen(colour: &'static str, width: f64, dashes: &'static str) -> Pen {
    Pen {
        colour,
        width,
        dashes,
    }
}

/// The SVG document of a chart.
pub(super) fn draw(chart: &Chart) -> String {
    let mut plot = Plot::of(chart, 0.0);
    let mut contents = Contents::of(chart, &plot);
    let legend = Legend::new(entries(chart, &contents), 0.6 * WIDTH);
    let place = legend.place(&plot.frame, &contents.everything());
    let place = place.unwrap_or_else(|| {
        plot = Plot::of(chart, legend.width + MARGIN);
        contents = Contents::of(chart, &plot);
        let left = plot.frame.right() + MARGIN;
        legend.at(left, plot.frame.top)
    });

    let mut svg = Svg::new(WIDTH, HEIGHT, &chart.title);
    let size = fitted(&chart.title, TITLE, WIDTH - 2.0 * MARGIN);
    let baseline = MARGIN + 0.8 * TITLE;
    svg.text([WIDTH / 2.0, baseline], size, Anchor::Middle, &chart.title);
    if let Some(raster) = &chart.raster {
        raster.draw(&mut svg, &plot.frame);
    }
    plot.draw_axes(&mut svg, chart.raster.is_none());
    contents.draw(&mut svg);
    plot.draw_border(&mut svg);
    if !legend.is_empty() {
        legend.draw(&mut svg, place);
    }
    svg.finish()
}

/// The frame and its axes.
struct Plot {
    frame: Rectangle,
    x: Ruler,
    y: Ruler,
}

/// An axis with what is written at it.
struct Ruler {
    label: String,
    range: Range,
    labelled: Vec<(f64, String)>,
    minor: Vec<f64>,
}

impl Ruler {
    /// A ruler with as many ticks as fit: the labels, with some room between them, are no longer than `length`.
    fn of(axis: &Axis, range: Range, length: f64, size_of: fn(&str) -> f64) -> Self {
        let length_of = |ticks: &Ticks| {
            let sizes = ticks
                .labelled
                .iter()
                .map(|(_, label)| size_of(label) + 1.5 * TICK);
            sizes.sum::<f64>()
        };
        let ticks = (3..=10)
            .rev()
            .map(|count| range.ticks(count))
            .find(|ticks| length_of(ticks) < length)
            .unwrap_or_else(|| range.ticks(2));
        let label = match ticks.power {
            0 => axis.label.clone(),
            power => format!("{} (×10{})", axis.label, superscript(power)),
        };
        Self {
            label,
            range,
            labelled: ticks.labelled,
            minor: ticks.minor,
        }
    }
}

impl Plot {
    /// The axes of a chart, with some room left free on the right.
    fn of(chart: &Chart, free: f64) -> Self {
        let values = |k: usize| shown(chart).map(move |point| point[k]);
        let cells = chart.raster.as_ref().map(|raster| [raster.x, raster.y]);
        let (x, y) = match (cells, chart.limits) {
            // Cells are of one size.
            (Some([x, y]), _) => (
                Range::between(Scale::Linear, x),
                Range::between(Scale::Linear, y),
            ),
            (None, Some([x, y])) => (
                Range::between(chart.x.scale, x),
                Range::between(chart.y.scale, y),
            ),
            (None, None) => (
                Range::of(chart.x.scale, values(0), false),
                Range::of(chart.y.scale, values(1), true),
            ),
        };
        let y = Ruler::of(&chart.y, y, 0.6 * HEIGHT, |_| TICK);
        let x = Ruler::of(&chart.x, x, 0.8 * WIDTH - free, |label| {
            width_of(label, TICK)
        });
        let widest = |ruler: &Ruler| {
            let width = |(_, label): &(f64, String)| width_of(label, TICK);
            ruler.labelled.iter().map(width).fold(0.0, f64::max)
        };
        let left = MARGIN + 1.3 * LABEL + widest(&y) + 12.0;
        let top = MARGIN + 1.2 * TITLE + 10.0;
        let right = (MARGIN + free).max(MARGIN + widest(&x) / 2.0);
        let bottom = MARGIN + 1.2 * LABEL + 1.2 * TICK + 16.0;
        let frame = Rectangle {
            left,
            top,
            width: WIDTH - left - right,
            height: HEIGHT - top - bottom,
        };
        Self { frame, x, y }
    }

    fn pixel(&self, [x, y]: [f64; 2]) -> Option<Pixel> {
        Some(self.at([self.x.range.position(x)?, self.y.range.position(y)?]))
    }

    /// The pixel of positions along the axes.
    fn at(&self, [x, y]: [f64; 2]) -> Pixel {
        let Rectangle { left, width, .. } = self.frame;
        [
            left + x * width,
            self.frame.bottom() - y * self.frame.height,
        ]
    }

    /// Grid, ticks and all that is written at the axes.
    fn draw_axes(&self, svg: &mut Svg, with_grid: bool) {
        let (mut grid, mut minor) = (Vec::new(), Vec::new());
        let frame = &self.frame;
        for (position, label) in &self.x.labelled {
            grid.push(vec![self.at([*position, 0.0]), self.at([*position, 1.0])]);
            let [x, y] = self.at([*position, 0.0]);
            svg.text([x, y + 1.2 * TICK + 4.0], TICK, Anchor::Middle, label);
        }
        for (position, label) in &self.y.labelled {
            grid.push(vec![self.at([0.0, *position]), self.at([1.0, *position])]);
            let [x, y] = self.at([0.0, *position]);
            svg.text([x - 8.0, y + 0.35 * TICK], TICK, Anchor::End, label);
        }
        for &position in &self.x.minor {
            let [x, y] = self.at([position, 0.0]);
            minor.push(vec![[x, y], [x, y - 4.0]]);
        }
        for &position in &self.y.minor {
            let [x, y] = self.at([0.0, position]);
            minor.push(vec![[x, y], [x + 4.0, y]]);
        }
        if with_grid {
            svg.lines(&grid, GRID);
        }
        svg.lines(&minor, MINOR);

        let (x, y) = (&self.x.label, &self.y.label);
        let size = fitted(x, LABEL, frame.width);
        let middle = frame.left + frame.width / 2.0;
        let baseline = HEIGHT - MARGIN - 0.25 * LABEL;
        svg.text([middle, baseline], size, Anchor::Middle, x);
        let size = fitted(y, LABEL, frame.height);
        let middle = frame.top + frame.height / 2.0;
        svg.text([MARGIN + 0.75 * LABEL, middle], size, Anchor::Upwards, y);
    }

    /// The border and the labelled ticks, over the curves.
    fn draw_border(&self, svg: &mut Svg) {
        let corners = [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]];
        svg.polygon(&corners.map(|corner| self.at(corner)), "none", AXIS);
        let x = self.x.labelled.iter().map(|(position, _)| {
            let [x, y] = self.at([*position, 0.0]);
            vec![[x, y], [x, y - 7.0]]
        });
        let y = self.y.labelled.iter().map(|(position, _)| {
            let [x, y] = self.at([0.0, *position]);
            vec![[x, y], [x + 7.0, y]]
        });
        svg.lines(&x.chain(y).collect::<Vec<_>>(), AXIS);
    }
}

/// What is inside the frame, in pixels.
struct Contents {
    references: Vec<Vec<Vec<Pixel>>>,
    runs: Vec<(Pen, Vec<Vec<Pixel>>)>,
    markers: Vec<(Shape, Vec<Pixel>)>,
    traces: Vec<(Pen, Vec<Vec<Pixel>>)>,
    clouds: Vec<Dots>,
    notes: Vec<Placed>,
    /// Everything is covered by coloured cells.
    covered: Option<Rectangle>,
}

impl Contents {
    fn of(chart: &Chart, plot: &Plot) -> Self {
        let lines = |points: &[[f64; 2]]| {
            polylines(points.iter().map(|&point| plot.pixel(point)), &plot.frame)
        };
        let references = chart.references.iter();
        let styles = Styles::of(chart);
        let curves = chart.curves.iter().zip(styles.curves);
        let runs = curves.flat_map(|(curve, style)| {
            let runs = curve.runs.iter();
            runs.map(move |run| (curve_pen(style, run.line), lines(&run.points)))
        });
        let markers = chart.markers.iter().zip(styles.markers);
        let markers = markers.map(|(markers, style)| {
            let points = markers.points.iter();
            let pixels = points.filter_map(|&point| plot.pixel(point));
            let pixels = pixels.filter(|&pixel| plot.frame.grown(0.5).contains(pixel));
            (Shape::of(style), pixels.collect())
        });
        let traces = chart.traces.iter();
        let clouds = chart.clouds.iter();
        let place = |&point: &[f64; 2]| plot.pixel(point).filter(|&p| plot.frame.contains(p));
        let mut contents = Self {
            references: references.map(|line| lines(&line.points)).collect(),
            runs: runs.collect(),
            markers: markers.collect(),
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
        let notes = chart.notes.iter();
        let notes = notes.filter_map(|note| Some((note.label.as_str(), place(&note.point)?)));
        contents.notes = note::place(notes, &plot.frame, &contents.everything());
        contents
    }

    /// All lines, and each marker as a line of one point.
    fn everything(&self) -> Vec<Vec<Pixel>> {
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
            .collect()
    }

    fn draw(&self, svg: &mut Svg) {
        for lines in &self.references {
            svg.lines(lines, REFERENCE);
        }
        for (pen, lines) in &self.runs {
            svg.lines(lines, *pen);
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
            markers: numbered(chart.markers.iter().map(|markers| &*markers.label)),
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
    let dashes = ["", "7 3", "1.5 2.5", "10 3 2 3"][index % 4];
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
fn shown(chart: &Chart) -> impl Iterator<Item = [f64; 2]> {
    let runs = chart.curves.iter().flat_map(|curve| &curve.runs);
    let curves = runs.flat_map(|run| &run.points);
    let markers = chart.markers.iter().flat_map(|markers| &markers.points);
    let traces = chart.traces.iter().flat_map(|trace| &trace.points);
    let clouds = chart.clouds.iter().flat_map(|cloud| &cloud.points);
    let notes = chart.notes.iter().map(|note| &note.point);
    let plain = chart.traces.is_empty() && chart.clouds.is_empty() && chart.notes.is_empty();
    let alone = plain && chart.curves.is_empty() && chart.markers.is_empty();
    let references = chart.references.iter().filter(move |_| alone);
    curves
        .chain(markers)
        .chain(traces)
        .chain(clouds)
        .chain(notes)
        .chain(references.flat_map(|line| &line.points))
        .filter(|point| point.iter().all(|value| value.is_finite()))
        .copied()
}

/// The rows of the legend: the curves if there are several, the kinds of line, references, markers; only what is seen, and
/// nothing twice.
fn entries(chart: &Chart, contents: &Contents) -> Vec<Entry> {
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
    let curves = chart.curves.iter().zip(styles.curves);
    for (curve, style) in curves.filter(|_| several) {
        add(Sample::Line(curve_pen(style, Line::Stable)), &curve.label);
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
    for (colour, label) in chart.raster.iter().flat_map(super::raster::Raster::shown) {
        add(Sample::Area(colour), label);
    }
    for (markers, (shape, pixels)) in chart.markers.iter().zip(&contents.markers) {
        if !pixels.is_empty() && !markers.label.is_empty() {
            add(Sample::Marker(*shape), &markers.label);
        }
    }
    entries
}
