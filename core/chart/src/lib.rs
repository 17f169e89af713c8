//! Charts of response curves, as SVG.
//!
//! Stable parts of a curve are solid, unstable ones dashed, undecided ones dotted, so that a chart says the same in
//! black and white; the colours are ones that colour-blind readers tell apart as well, and the first four
//! differ in lightness. Where there are several curves, small shapes along them tell them apart without colours. Marks of events are white
//! inside, other points dark. Pieces of a curve that marks cover are said below the chart.
//!
//! The SVG is written here, by a small writer of its own, rather than through a plotting library. By its source, the
//! one considered (plotters 0.3) would have rounded every point to a whole pixel, which puts steps into a smooth curve,
//! written each dash as an element of its own, and estimated the width of text by its number of bytes, so that a label
//! with a Greek letter is misplaced.
//!
//! ```
//! use hertzian_chart::{Chart, Curve, Line, Run};
//!
//! let stable = Run { line: Line::Stable, points: vec![[0.6, 0.2], [0.9, 1.0]] };
//! let unstable = Run { line: Line::Unstable, points: vec![[0.9, 1.0], [0.8, 1.4]] };
//! let svg = Chart::new("Response")
//!     .x("excitation frequency ω")
//!     .y("peak-to-peak")
//!     .curve(Curve { label: String::new(), runs: vec![stable, unstable] })
//!     .to_svg();
//! assert!(svg.starts_with("<svg"));
//! ```

mod along;
mod area;
mod axis;
mod band;
mod bars;
mod cloud;
mod contents;
mod drawing;
mod entries;
mod glyphs;
mod legend;
mod letters;
mod mark;
mod note;
mod page;
mod polyline;
mod prefix;
mod raster;
mod shape;
mod short;
mod smooth;
mod style;
mod svg;
#[cfg(test)]
mod tests;

use std::fmt;
use std::path::{Path, PathBuf};

pub use axis::Scale;
pub use bars::Bar;
pub use page::Page;
pub use prefix::{prefixed, takes_prefix};
pub use raster::{Colour, Raster, STEPS};
pub use smooth::{Bend, smoothed};

/// A chart that is put together by parts and then written. Without any part it is an empty frame.
///
/// Points that are not finite are not drawn and interrupt their line. The axes show all curves and markers; a
/// reference line is cut off at the frame.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Chart {
    title: String,
    x: Axis,
    y: Axis,
    curves: Vec<Curve>,
    references: Vec<Series>,
    areas: Vec<Series>,
    bands: Vec<Band>,
    bars: Vec<Bar>,
    of_bars: [String; 2],
    markers: Vec<Markers>,
    traces: Vec<Series>,
    joined: Vec<Series>,
    letters: Vec<Series>,
    clouds: Vec<Series>,
    notes: Vec<Note>,
    texts: Vec<Note>,
    remarks: Vec<String>,
    of_axes: OfAxes,
    raster: Option<Raster>,
    limits: Option<[[f64; 2]; 2]>,
}

/// A curve made of runs, each of one stability.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Curve {
    /// What the legend says of it, if there are several curves.
    pub label: String,
    /// Its parts. Where two of them join, both have the common point.
    pub runs: Vec<Run>,
}

/// A part of a curve.
#[derive(Debug, Clone, PartialEq)]
pub struct Run {
    /// What the line says.
    pub line: Line,
    /// Points `[x, y]` in the order of the curve.
    pub points: Vec<[f64; 2]>,
}

/// What a line says of the solutions it shows.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[non_exhaustive]
pub enum Line {
    /// Stable: solid.
    Stable,
    /// Unstable: dashed.
    Unstable,
    /// Neither is certain: dotted.
    Undecided,
}

/// Points under one name. How they are drawn says the method of [`Chart`] that takes them: as a [reference](Chart::reference), a
/// [trace](Chart::trace), a [cloud](Chart::cloud) or [markers](Chart::markers).
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Series {
    /// What the legend says of them; nothing if it is empty.
    pub label: String,
    /// Points `[x, y]`, of a line in its order.
    pub points: Vec<[f64; 2]>,
}

impl Series {
    /// Points under a name.
    pub fn new(label: impl Into<String>, points: impl Into<Vec<[f64; 2]>>) -> Self {
        let (label, points) = (label.into(), points.into());
        Self { label, points }
    }
}

/// The area between two lines of as many points.
#[derive(Debug, Clone, PartialEq, Default)]
struct Band {
    label: String,
    lines: [Vec<[f64; 2]>; 2],
}

/// A point with its name written beside it, where it covers nothing.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Note {
    /// The name.
    pub label: String,
    /// The point `[x, y]`.
    pub point: [f64; 2],
}

/// Markers, and whether they are of events, of which those upon each other are one.
#[derive(Debug, Clone, PartialEq)]
struct Markers {
    series: Series,
    event: bool,
}

/// What is said below of the axes, and which of them still have the label of which it is said.
#[derive(Debug, Clone, PartialEq, Default)]
struct OfAxes {
    text: String,
    axes: [bool; 2],
}

/// Why a chart was not written.
#[derive(thiserror::Error)]
#[error("cannot write the chart {}", .path.display())]
#[non_exhaustive]
pub struct ChartError {
    /// The path of its file.
    pub path: PathBuf,
    /// What the system said.
    pub source: std::io::Error,
}

/// The sentence with its source, as of every error, and with `{:#?}` what it consists of.
impl fmt::Debug for ChartError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { path, source } = self;
        if !f.alternate() {
            return write!(f, "{self}: {source}");
        }
        let mut parts = f.debug_struct("ChartError");
        parts.field("path", path).field("source", source).finish()
    }
}

#[derive(Debug, Clone, PartialEq, Default)]
struct Axis {
    label: String,
    scale: Scale,
}

impl Line {
    /// What it says, in a word.
    const fn name(self) -> &'static str {
        match self {
            Self::Stable => "stable",
            Self::Unstable => "unstable",
            Self::Undecided => "undecided",
        }
    }
}

impl Chart {
    /// An empty chart.
    pub fn new(title: impl Into<String>) -> Self {
        Self {
            title: title.into(),
            ..Self::default()
        }
    }

    /// Changes the title.
    #[must_use]
    pub fn title(mut self, title: impl Into<String>) -> Self {
        self.title = title.into();
        self
    }

    /// Labels the horizontal axis; a unit belongs to the label. Where it stands at the end, in brackets, numbers that are small or large
    /// have a prefix of the unit: `tip [um]`.
    #[must_use]
    pub fn x(mut self, label: impl Into<String>) -> Self {
        self.x.label = label.into();
        self.of_axes.axes[0] = false;
        self
    }

    /// Labels the vertical axis, as the [horizontal](Chart::x) one.
    #[must_use]
    pub fn y(mut self, label: impl Into<String>) -> Self {
        self.y.label = label.into();
        self.of_axes.axes[1] = false;
        self
    }

    /// Chooses the scale of each axis; both are linear unless said otherwise.
    #[must_use]
    pub fn scales(mut self, x: Scale, y: Scale) -> Self {
        self.x.scale = x;
        self.y.scale = y;
        self
    }

    /// Shows this part of the plane, whatever there is to show. An end that has no place on a logarithmic axis is ignored.
    #[must_use]
    pub fn limits(mut self, x: [f64; 2], y: [f64; 2]) -> Self {
        self.limits = Some([x, y]);
        self
    }

    /// Adds a curve.
    #[must_use]
    pub fn curve(mut self, curve: Curve) -> Self {
        self.curves.push(curve);
        self
    }

    /// Adds a line to compare with, such as the limit of permanent contact: thin, grey and dash-dotted.
    #[must_use]
    pub fn reference(mut self, reference: Series) -> Self {
        self.references.push(reference);
        self
    }

    /// Adds points: dark shapes, circles for the first kind added to a chart, then squares, diamonds, triangles, and these upside
    /// down or crossed.
    #[must_use]
    pub fn markers(mut self, markers: Series) -> Self {
        self.markers.push(Markers {
            series: markers,
            event: false,
        });
        self
    }

    /// Adds marks of events: shapes as those of [`markers`](Self::markers), but white inside; and marks upon each other are drawn as one, with
    /// a count beside it, and with names where they are of several kinds.
    #[must_use]
    pub fn marks(mut self, marks: Series) -> Self {
        self.markers.push(Markers {
            series: marks,
            event: true,
        });
        self
    }

    /// Adds points with the line through them, as of what was measured at several settings: a shape, a colour and dashes for each label. A
    /// point that is not finite interrupts the line.
    #[must_use]
    pub fn joined(mut self, points: Series) -> Self {
        self.joined.push(points);
        self
    }

    /// Adds points that are drawn as their label, a letter or a number, each on a small white disc; the legend says nothing of them.
    #[must_use]
    pub fn letters(mut self, points: Series) -> Self {
        self.letters.push(points);
        self
    }

    /// Fills the area between a line and zero, or the lower end of a logarithmic axis, behind everything else. It has the colour of the
    /// curve with the same label, and no row in the legend. A line that turns back covers what is below any part of it.
    #[must_use]
    pub fn area(mut self, area: Series) -> Self {
        self.areas.push(area);
        self
    }

    /// Fills the band between two lines of as many points, in grey behind the curves. A point that is not finite interrupts it.
    #[must_use]
    pub fn band(mut self, label: impl Into<String>, lines: [Vec<[f64; 2]>; 2]) -> Self {
        let label = label.into();
        self.bands.push(Band { label, lines });
        self
    }

    /// Shows bars, a row for each, the first on top, with their labels in place of a vertical axis. The legend has names for the dark and for the
    /// pale parts.
    #[must_use]
    pub fn bars(mut self, bars: impl Into<Vec<Bar>>, [dark, pale]: [&str; 2]) -> Self {
        self.bars = bars.into();
        self.of_bars = [dark, pale].map(str::to_owned);
        self
    }

    /// Adds a plain line, such as a motion: the first solid, the others dashed or dotted.
    #[must_use]
    pub fn trace(mut self, trace: Series) -> Self {
        self.traces.push(trace);
        self
    }

    /// Adds a cloud: many points, drawn as dots. Of several clouds the last is dark and drawn over the others, which are lighter and
    /// have larger dots.
    #[must_use]
    pub fn cloud(mut self, cloud: Series) -> Self {
        self.clouds.push(cloud);
        self
    }

    /// Adds a named point.
    #[must_use]
    pub fn note(mut self, note: Note) -> Self {
        self.notes.push(note);
        self
    }

    /// Adds a text beside a point, which is not drawn itself.
    #[must_use]
    pub fn text(mut self, text: Note) -> Self {
        self.texts.push(text);
        self
    }

    /// Adds a line of text below the chart: what is not shown, and why.
    #[must_use]
    pub fn remark(mut self, remark: impl Into<String>) -> Self {
        self.remarks.push(remark.into());
        self
    }

    /// Adds a line of text below the chart about both axes. It goes once both have other labels.
    #[must_use]
    pub fn remark_on_axes(mut self, remark: impl Into<String>) -> Self {
        self.of_axes = OfAxes {
            text: remark.into(),
            axes: [true; 2],
        };
        self
    }

    /// Puts coloured cells behind everything else. The axes then show them and nothing beyond.
    #[must_use]
    pub fn raster(mut self, raster: Raster) -> Self {
        self.raster = Some(raster);
        self
    }

    /// Writes the chart to a file.
    ///
    /// # Errors
    /// If the file cannot be written.
    pub fn write(&self, path: impl AsRef<Path>) -> Result<(), ChartError> {
        let path = path.as_ref();
        hertzian_file::write(path, self.to_svg()).map_err(|source| ChartError {
            path: path.to_path_buf(),
            source,
        })
    }

    /// The chart as the text of an SVG document.
    pub fn to_svg(&self) -> String {
        drawing::draw(self)
    }
}
