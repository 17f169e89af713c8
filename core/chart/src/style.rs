//! What tells the parts of a chart apart: colours, dashes, and numbers of shapes.

use super::svg::{Pen, pen};
use super::{Chart, Line};

/// Dark blue, vermilion, sky blue, black, green, orange, purple: the first four differ in lightness too.
const COLOURS: [&str; 7] = [
    "#0b4f8a", "#d55e00", "#56b4e9", "#000000", "#007a5a", "#e69f00", "#aa4f8c",
];

/// Whether curves have different styles.
pub(super) fn are_told_apart(styles: &[usize]) -> bool {
    styles.iter().any(|style| *style != styles[0])
}

/// Numbers of the styles of what is on a chart: parts with one label look alike.
pub(super) struct Styles {
    pub(super) curves: Vec<usize>,
    pub(super) traces: Vec<usize>,
    pub(super) joined: Vec<usize>,
    pub(super) markers: Vec<usize>,
    pub(super) references: Vec<usize>,
}

impl Styles {
    pub(super) fn of(chart: &Chart) -> Self {
        Self {
            curves: numbered(chart.curves.iter().map(|curve| &*curve.label)),
            traces: numbered(chart.traces.iter().map(|trace| &*trace.label)),
            joined: numbered(chart.joined.iter().map(|joined| &*joined.label)),
            markers: numbered(chart.markers.iter().map(|markers| &*markers.series.label)),
            references: numbered(chart.references.iter().map(|line| &*line.label)),
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

pub(super) fn trace_pen(index: usize) -> Pen {
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

pub(super) fn curve_pen(index: usize, line: Line) -> Pen {
    let colour = COLOURS[index % COLOURS.len()];
    match line {
        Line::Stable => pen(colour, 2.2, ""),
        Line::Unstable => pen(colour, 2.0, "8 4"),
        Line::Undecided => pen(colour, 2.2, "2 3.5"),
    }
}

/// That of a line to compare with. Those without a name are told apart by nothing else either.
pub(super) fn reference_pen(index: usize, label: &str) -> Pen {
    let dashes = ["12 4 2 4", "4 4", "12 4 2 4 2 4", "2 4"];
    let index = if label.is_empty() { 0 } else { index };
    pen("#666666", 1.4, dashes[index % dashes.len()])
}
