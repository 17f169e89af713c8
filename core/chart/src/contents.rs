//! What is inside the frame of a chart.

use super::along;
use super::area;
use super::band;
use super::bars;
use super::cloud::{self, Dots};
use super::drawing::Plot;
use super::letters::{self, Letters};
use super::mark::{self, Kind, Merged};
use super::note::{self, Named, Placed};
use super::polyline::polylines;
use super::shape::{Shape, draw_filled, draw_joined, draw_open};
use super::short::{self, Piece};
use super::style::{Styles, are_told_apart, curve_pen, reference_pen, trace_pen};
use super::svg::{Pen, Pixel, Rectangle, Svg, pen};
use super::{Chart, Line, Note, Series};

/// By how much the white line behind one upon cells is wider than it.
const HALO: f64 = 2.8;

/// Points with the line through them.
pub(super) struct Joined {
    pub(super) pen: Pen,
    lines: Vec<Vec<Pixel>>,
    /// Number of its shape.
    pub(super) index: usize,
    pub(super) points: Vec<Pixel>,
}

/// What is inside the frame, in pixels.
pub(super) struct Contents {
    pub(super) references: Vec<(Pen, Vec<Vec<Pixel>>)>,
    areas: Vec<(&'static str, Vec<Vec<Pixel>>)>,
    bands: Vec<Vec<Vec<Pixel>>>,
    bars: Vec<bars::Drawn>,
    runs: Vec<(Pen, Vec<Vec<Pixel>>)>,
    /// Small shapes along curves, with their colour.
    along: Vec<(&'static str, Shape, Vec<Pixel>)>,
    /// Of each kind of markers, in the order of the chart.
    pub(super) markers: Vec<(Shape, Vec<Pixel>)>,
    pub(super) traces: Vec<(Pen, Vec<Vec<Pixel>>)>,
    pub(super) joined: Vec<Joined>,
    /// Points that are letters.
    pub(super) letters: Vec<Letters>,
    clouds: Vec<Dots>,
    /// Names, and those that have found their place.
    named: Vec<Named>,
    notes: Vec<Placed>,
    /// Everything is covered by coloured cells.
    covered: Option<Rectangle>,
}

impl Contents {
    pub(super) fn of(chart: &Chart, plot: &Plot) -> Self {
        let lines = |points: &[[f64; 2]]| {
            polylines(points.iter().map(|&point| plot.pixel(point)), &plot.frame)
        };
        let styles = Styles::of(chart);
        let curves = chart.curves.iter().zip(&styles.curves);
        let runs = curves.flat_map(|(curve, &style)| {
            let runs = curve.runs.iter();
            runs.map(move |run| (curve_pen(style, run.line), lines(&run.points)))
        });
        let traces = chart.traces.iter();
        let references = chart.references.iter().zip(&styles.references);
        let joined = chart.joined.iter().zip(&styles.joined);
        let clouds = chart.clouds.iter();
        let place = |&point: &[f64; 2]| plot.pixel(point).filter(|&p| plot.frame.contains(p));
        let (markers, counts) = markers(chart, plot, &styles);
        let mut contents = Self {
            references: references
                .map(|(line, &style)| (reference_pen(style, &line.label), lines(&line.points)))
                .collect(),
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
            joined: joined
                .map(|(series, &style)| Joined {
                    pen: trace_pen(style),
                    lines: lines(&series.points),
                    index: style,
                    points: series.points.iter().filter_map(place).collect(),
                })
                .collect(),
            letters: chart
                .letters
                .iter()
                .map(|series| Letters::of(&series.label, series.points.iter().filter_map(place)))
                .collect(),
            clouds: clouds
                .map(|cloud| Dots::of(cloud.points.iter().filter_map(place)))
                .collect(),
            named: Vec::new(),
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
        contents.named = notes.chain(texts).chain(counts).collect();
        contents
    }

    /// Finds places for names, where they cover neither what is drawn nor a legend: these can be anywhere around their points, and a legend is
    /// large.
    pub(super) fn place_names(&mut self, frame: &Rectangle, legend: &Rectangle) {
        let mut taken = self.everything();
        taken.extend(legend.scanned());
        self.notes = note::place(std::mem::take(&mut self.named), frame, &taken);
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

    /// All lines, and each marker and each point that has a name as a line of one point.
    pub(super) fn everything(&self) -> Vec<Vec<Pixel>> {
        let references = self.references.iter().flat_map(|(_, lines)| lines);
        let runs = self.runs.iter().flat_map(|(_, lines)| lines);
        let traces = self.traces.iter().flat_map(|(_, lines)| lines);
        let joined = self.joined.iter().flat_map(|joined| &joined.lines);
        let markers = self.markers.iter().flat_map(|(_, pixels)| pixels);
        let points = self.joined.iter().flat_map(|joined| &joined.points);
        let letters = self.letters.iter().flat_map(|letters| &letters.places);
        let markers = markers.chain(points).chain(letters);
        let covered = self.covered.iter().flat_map(Rectangle::scanned);
        references
            .chain(runs)
            .chain(traces)
            .chain(joined)
            .cloned()
            .chain(markers.map(|&pixel| vec![pixel]))
            .chain(self.clouds.iter().flat_map(Dots::lines))
            .chain(covered)
            .chain(self.named.iter().map(|named| vec![named.point]))
            .chain(self.bars.iter().flat_map(bars::Drawn::lines))
            .collect()
    }

    pub(super) fn draw(&self, svg: &mut Svg, chart: &Chart) {
        for (colour, polygons) in &self.areas {
            svg.pale_area(polygons, colour);
        }
        for polygons in &self.bands {
            svg.band(polygons);
        }
        for bar in &self.bars {
            bar.draw(svg);
        }
        for (pen, lines) in &self.references {
            svg.lines(lines, *pen);
        }
        self.draw_curves(svg);
        self.draw_traces(svg);
        for (index, dots) in self.clouds.iter().enumerate() {
            dots.draw(svg, cloud::pen(index, self.clouds.len()));
        }
        letters::draw(svg, &self.letters);
        for (markers, (shape, pixels)) in chart.markers.iter().zip(&self.markers) {
            for &pixel in pixels {
                if markers.event {
                    draw_open(svg, *shape, pixel);
                } else {
                    draw_filled(svg, *shape, pixel);
                }
            }
        }
        for note in &self.notes {
            note.draw(svg);
        }
    }

    fn draw_curves(&self, svg: &mut Svg) {
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
    }

    fn draw_traces(&self, svg: &mut Svg) {
        // Upon cells of any lightness a line is seen by a white one that is wider, and that never lies upon another line.
        if self.covered.is_some() {
            for (Pen { width, .. }, lines) in &self.traces {
                svg.lines(lines, pen("#ffffff", width + HALO, ""));
            }
        }
        for (pen, lines) in &self.traces {
            svg.lines(lines, *pen);
        }
        for joined in &self.joined {
            svg.lines(&joined.lines, joined.pen);
        }
        for Joined {
            pen, index, points, ..
        } in &self.joined
        {
            for &place in points {
                draw_joined(svg, *index, place, pen.colour);
            }
        }
    }

    /// Pieces of curves that marks cover so far that they cannot be read.
    pub(super) fn short_pieces<'c>(&self, chart: &'c Chart) -> Vec<Piece<'c>> {
        let marks: Vec<Pixel> = self
            .markers
            .iter()
            .flat_map(|(_, all)| all.clone())
            .collect();
        let runs = chart.curves.iter().flat_map(|curve| {
            let label = &*curve.label;
            curve.runs.iter().map(move |run| (label, run))
        });
        let short = runs
            .zip(&self.runs)
            .filter_map(|((label, run), (_, lines))| {
                let (first, last) = (run.points.first()?, run.points.last()?);
                short::is_short(lines, &marks).then_some(Piece {
                    label,
                    line: run.line,
                    ends: [first[0], last[0]],
                })
            });
        short.collect()
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
            pixels: if markers.event { pixels } else { &[] },
        })
        .collect();
    let merged = mark::merged(&kinds);
    let all = chart.markers.iter().zip(&pixels).zip(&styles.markers);
    let drawn = all.enumerate().map(|(kind, ((markers, pixels), &style))| {
        let own = merged.iter().filter(|mark| mark.kind == kind);
        let pixels = if markers.event {
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

/// What decides the range of the axes: everything but the references, and without anything else those.
pub(super) fn shown(chart: &Chart) -> impl Iterator<Item = [f64; 2]> {
    let runs = chart.curves.iter().flat_map(|curve| &curve.runs);
    let curves = runs.flat_map(|run| &run.points);
    let markers = chart.markers.iter();
    let markers = markers.flat_map(|markers| &markers.series.points);
    let areas = chart.areas.iter().flat_map(|area| &area.points);
    let traces = chart.traces.iter().flat_map(|trace| &trace.points);
    let points = chart.joined.iter().chain(&chart.letters);
    let points = points.flat_map(|series| &series.points);
    let bands = chart
        .bands
        .iter()
        .flat_map(|band| band.lines.iter().flatten());
    let clouds = chart.clouds.iter().flat_map(|cloud| &cloud.points);
    let notes = chart.notes.iter().chain(&chart.texts);
    let notes = notes.map(|note| &note.point);
    let plain = chart.traces.is_empty()
        && chart.clouds.is_empty()
        && chart.notes.is_empty()
        && chart.joined.is_empty();
    let alone = plain && chart.curves.is_empty() && chart.markers.is_empty();
    let references = chart.references.iter().filter(move |_| alone);
    curves
        .chain(areas)
        .chain(bands)
        .chain(markers)
        .chain(traces)
        .chain(points)
        .chain(clouds)
        .chain(notes)
        .chain(references.flat_map(|line| &line.points))
        .filter(|point| point.iter().all(|value| value.is_finite()))
        .copied()
        .chain(bars::shown(&chart.bars))
}
