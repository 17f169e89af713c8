//! The legend: its entries, a place where it covers nothing, and how it is drawn.

use super::along;
use super::shape::{Shape, draw_filled, draw_joined, draw_open};
use super::svg::{Anchor, Pen, Pixel, Rectangle, Svg, fitted, width_of};

const SIZE: f64 = 14.0;
const ROW: f64 = 21.0;
/// Length of the sample of a line.
const SAMPLE: f64 = 40.0;
const MARGIN: f64 = 10.0;
/// Distance to keep from the frame and from what is drawn in it.
const CLEARANCE: f64 = 8.0;

/// A row of the legend.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Entry {
    pub(super) sample: Sample,
    pub(super) label: String,
}

/// What a row explains.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Sample {
    Line(Pen),
    /// A line with small shapes along it.
    Shaped(Pen, Shape),
    /// A line through points, with the number of their shape.
    Joined(Pen, usize),
    /// The mark of an event.
    Open(Shape),
    /// A point.
    Filled(Shape),
    Dots(Pen),
    /// A colour of cells.
    Area(&'static str),
}

/// Entries with the room they take.
pub(super) struct Legend {
    entries: Vec<Entry>,
    /// Size of the letters: smaller than usual if a label is very long.
    size: f64,
    pub(super) width: f64,
    height: f64,
}

impl Legend {
    /// A legend of at most the given width.
    pub(super) fn new(entries: Vec<Entry>, width: f64) -> Self {
        let room = width - SAMPLE - 3.0 * MARGIN;
        let size = |entry: &Entry| fitted(&entry.label, SIZE, room);
        let size = entries.iter().map(size).fold(SIZE, f64::min);
        let text = entries.iter().map(|entry| width_of(&entry.label, size));
        Self {
            width: text.fold(0.0, f64::max) + SAMPLE + 3.0 * MARGIN,
            height: ROW * entries.len() as f64 + MARGIN,
            size,
            entries,
        }
    }

    pub(super) fn is_empty(&self) -> bool {
        self.entries.is_empty()
    }

    /// A place in the frame where the legend covers none of the lines and markers: a corner if possible, then the
    /// middle of a side, then anywhere.
    pub(super) fn place(&self, frame: &Rectangle, drawn: &[Vec<Pixel>]) -> Option<Rectangle> {
        let free = Rectangle {
            left: frame.left + CLEARANCE,
            top: frame.top + CLEARANCE,
            width: frame.width - self.width - 2.0 * CLEARANCE,
            height: frame.height - self.height - 2.0 * CLEARANCE,
        };
        if free.width < 0.0 || free.height < 0.0 {
            return None;
        }
        let sides = [(1.0, 0.0), (0.0, 0.0), (1.0, 1.0), (0.0, 1.0)];
        let middles = [(0.5, 0.0), (0.5, 1.0), (1.0, 0.5), (0.0, 0.5)];
        let anywhere = (0..100).map(|i| (f64::from(i % 10) / 9.0, f64::from(i / 10) / 9.0));
        sides
            .into_iter()
            .chain(middles)
            .chain(anywhere)
            .map(|(across, down)| {
                let left = free.left + across * free.width;
                self.at(left, free.top + down * free.height)
            })
            .find(|place| {
                let kept_free = place.grown(CLEARANCE);
                !drawn.iter().any(|line| crosses(line, &kept_free))
            })
    }

    /// The room it takes at a place.
    pub(super) fn at(&self, left: f64, top: f64) -> Rectangle {
        Rectangle {
            left,
            top,
            width: self.width,
            height: self.height,
        }
    }

    pub(super) fn draw(&self, svg: &mut Svg, place: Rectangle) {
        let background = Pen {
            colour: "#bbbbbb",
            width: 0.8,
            dashes: "",
        };
        let (left, top) = (place.left, place.top);
        let (right, bottom) = (place.right(), place.bottom());
        let corners = [[left, top], [right, top], [right, bottom], [left, bottom]];
        svg.polygon(&corners, "#ffffff", background);
        for (row, entry) in self.entries.iter().enumerate() {
            let middle = top + MARGIN / 2.0 + ROW * (row as f64 + 0.5);
            let start = left + MARGIN;
            match entry.sample {
                Sample::Line(pen) => {
                    svg.lines(&[vec![[start, middle], [start + SAMPLE, middle]]], pen);
                }
                Sample::Shaped(pen, shape) => {
                    svg.lines(&[vec![[start, middle], [start + SAMPLE, middle]]], pen);
                    along::draw(svg, shape, [start + SAMPLE / 2.0, middle], pen.colour);
                }
                Sample::Joined(pen, index) => {
                    svg.lines(&[vec![[start, middle], [start + SAMPLE, middle]]], pen);
                    draw_joined(svg, index, [start + SAMPLE / 2.0, middle], pen.colour);
                }
                Sample::Open(shape) => draw_open(svg, shape, [start + SAMPLE / 2.0, middle]),
                Sample::Filled(shape) => draw_filled(svg, shape, [start + SAMPLE / 2.0, middle]),
                Sample::Dots(pen) => {
                    let dot = |i: f64| vec![[start + i * SAMPLE / 4.0, middle]];
                    svg.dots(&[dot(1.0), dot(2.0), dot(3.0)], pen);
                }
                Sample::Area(colour) => {
                    let (left, right) = (start + 0.25 * SAMPLE, start + 0.75 * SAMPLE);
                    let (top, bottom) = (middle - 6.0, middle + 6.0);
                    let corners = [[left, top], [right, top], [right, bottom], [left, bottom]];
                    svg.polygon(&corners, colour, background);
                }
            }
            let text = [start + SAMPLE + MARGIN, middle + 0.35 * self.size];
            svg.text(text, self.size, Anchor::Start, &entry.label);
        }
    }
}

/// Whether a polyline (a single point for a marker) meets a rectangle, looked at every few pixels.
pub(super) fn crosses(line: &[Pixel], rectangle: &Rectangle) -> bool {
    let on_segment = |pair: &[Pixel]| {
        let [from, to] = [pair[0], pair[1]];
        let steps = ((to[0] - from[0]).hypot(to[1] - from[1]) / 4.0)
            .ceil()
            .max(1.0);
        (0..steps as u32).any(|i| {
            let t = f64::from(i) / steps;
            rectangle.contains([
                from[0] + t * (to[0] - from[0]),
                from[1] + t * (to[1] - from[1]),
            ])
        })
    };
    line.last().is_some_and(|&last| rectangle.contains(last)) || line.windows(2).any(on_segment)
}
