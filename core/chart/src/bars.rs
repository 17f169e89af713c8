//! Bars to both sides of a value, one row for each name.

use super::Chart;
use super::drawing::Plot;
use super::svg::{Anchor, INK, Pixel, Rectangle, Svg, pen, width_of};

/// Fillings, dark and pale, which print in grey tells apart.
pub(super) const LARGER: &str = "#0b4f8a";
pub(super) const SMALLER: &str = "#c9dcec";
/// Part of a row that a bar fills.
const THICK: f64 = 0.56;
/// Size of the letters beside bars, and their distance.
const SIZE: f64 = 13.0;
const APART: f64 = 6.0;
/// Room for texts at both ends, as a part of what bars take.
const ROOM: f64 = 0.3;

/// A row of a chart of [bars](super::Chart::bars).
///
/// ```
/// use hertzian_chart::{Bar, Chart};
///
/// let bar = Bar {
///     label: "damping ± 1 %".to_owned(),
///     middle: 2.0,
///     ends: [1.9, 2.1],
///     texts: ["−0.1".to_owned(), "+0.1".to_owned()],
/// };
/// let svg = Chart::new("What moves it").bars([bar], ["more of it", "less of it"]).to_svg();
/// assert!(svg.contains("damping ± 1 %") && svg.contains("less of it"));
/// ```
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Bar {
    /// What stands at the left of the row.
    pub label: String,
    /// Where the bar begins to both sides.
    pub middle: f64,
    /// Where its dark and its pale part end.
    pub ends: [f64; 2],
    /// What is written beside each of these ends.
    pub texts: [String; 2],
}

/// A bar in pixels.
pub(super) struct Drawn {
    parts: Vec<(&'static str, Rectangle)>,
    texts: Vec<(Pixel, Anchor, String)>,
}

/// Where bars are to be seen, with room for what is written beside them. The first row is on top.
pub(super) fn shown(bars: &[Bar]) -> impl Iterator<Item = [f64; 2]> {
    let ends = bars
        .iter()
        .flat_map(|bar| [bar.middle, bar.ends[0], bar.ends[1]]);
    let ends = ends.filter(|end| end.is_finite());
    let (low, high) = ends.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), end| {
        (low.min(end), high.max(end))
    });
    let room = ROOM * (high - low);
    [low - room, high + room]
        .into_iter()
        .filter(|end| end.is_finite())
        .map(|end| [end, 0.0])
}

/// The middle of each row, from below, as a part of the height, with its label.
pub(super) fn rows(bars: &[Bar]) -> Vec<(f64, String)> {
    let count = bars.len() as f64;
    let rows = bars.iter().enumerate();
    rows.map(|(row, bar)| (1.0 - (row as f64 + 0.5) / count, bar.label.clone()))
        .collect()
}

/// The bars of a chart where they are drawn.
pub(super) fn drawn(chart: &Chart, plot: &Plot) -> Vec<Drawn> {
    let height = THICK * plot.frame.height / chart.bars.len().max(1) as f64;
    let rows = rows(&chart.bars);
    let bars = chart.bars.iter().zip(rows);
    bars.map(|(bar, (middle, _))| drawn_one(bar, middle, height, plot))
        .collect()
}

fn drawn_one(bar: &Bar, row: f64, height: f64, plot: &Plot) -> Drawn {
    let mut drawn = Drawn {
        parts: Vec::new(),
        texts: Vec::new(),
    };
    let across = |value: f64| plot.across(value).map(|x| plot.at([x, row]));
    let Some([from, y]) = across(bar.middle) else {
        return drawn;
    };
    let rightmost = bar.ends[0].max(bar.ends[1]);
    let ends = bar.ends.into_iter().zip([LARGER, SMALLER]).zip(&bar.texts);
    for (index, ((end, colour), text)) in ends.enumerate() {
        let Some([to, _]) = across(end) else { continue };
        drawn.parts.push((
            colour,
            Rectangle {
                left: from.min(to),
                top: y - 0.5 * height,
                width: (to - from).abs(),
                height,
            },
        ));
        // Bars without length have their texts on both sides all the same.
        let right = if bar.ends[0] == bar.ends[1] {
            index == 1
        } else {
            end == rightmost
        };
        let (x, anchor) = if right {
            (to + APART, Anchor::Start)
        } else {
            (to - APART, Anchor::End)
        };
        drawn
            .texts
            .push(([x, y + 0.35 * SIZE], anchor, text.clone()));
    }
    drawn
}

impl Drawn {
    /// Lines so close that nothing fits between them.
    pub(super) fn lines(&self) -> Vec<Vec<Pixel>> {
        let parts = self.parts.iter().flat_map(|(_, part)| part.scanned());
        let texts = self.texts.iter().map(|([x, y], anchor, text)| {
            let width = width_of(text, SIZE);
            let left = if *anchor == Anchor::End {
                x - width
            } else {
                *x
            };
            vec![[left, *y], [left + width, *y]]
        });
        parts.chain(texts).collect()
    }

    pub(super) fn draw(&self, svg: &mut Svg) {
        for (colour, part) in &self.parts {
            let (right, bottom) = (part.right(), part.bottom());
            let [left, top] = [part.left, part.top];
            let corners = [[left, top], [right, top], [right, bottom], [left, bottom]];
            svg.polygon(&corners, colour, pen(INK, 0.8, ""));
        }
        for (place, anchor, text) in &self.texts {
            svg.text(*place, SIZE, *anchor, text);
        }
    }
}
