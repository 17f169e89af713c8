//! Puts a chart on the page.

use super::axis::{Powers, Range, Scale, Ticks, superscript};
use super::bars;
use super::contents::{Contents, shown};
use super::entries::entries;
use super::legend::Legend;
use super::letters;
use super::prefix::{prefixed, takes_prefix};
use super::svg::{Anchor, INK, Pen, Pixel, Rectangle, Svg, fitted, pen, width_of};
use super::{Axis, Chart, Raster, Series, short};

pub(super) const WIDTH: f64 = 900.0;
pub(super) const HEIGHT: f64 = 600.0;
const MARGIN: f64 = 18.0;
/// Sizes of letters.
const TITLE: f64 = 19.0;
/// A title that had to be smaller than this part of its size has two lines.
const LEGIBLE: f64 = 0.8;
const LABEL: f64 = 16.0;
const TICK: f64 = 14.0;
const REMARK: f64 = 13.0;
/// Width of lines below the chart.
const REMARKS: f64 = WIDTH - 2.0 * MARGIN;

const GRID: Pen = pen("#e6e6e6", 0.8, "");
const AXIS: Pen = pen(INK, 1.1, "");
const MINOR: Pen = pen(INK, 0.7, "");

/// The SVG document of a chart.
pub(super) fn draw(chart: &Chart) -> String {
    let mut remarks = chart.remarks.clone();
    remarks.extend(outside(chart));
    if chart.of_axes.axes.contains(&true) {
        remarks.push(chart.of_axes.text.clone());
    }
    let mut laid = Laid::out(chart, &lines_of(&remarks));
    // Lines more make the frame smaller, which makes no piece longer.
    let short = short::said(&laid.contents.short_pieces(chart), &laid.plot);
    let unseen: Vec<String> = short
        .into_iter()
        .chain(letters::upon_each_other(&laid.contents.letters))
        .collect();
    if !unseen.is_empty() {
        remarks.splice(0..0, unseen);
        laid = Laid::out(chart, &lines_of(&remarks));
    }
    let Laid {
        plot,
        contents,
        legend,
        place,
    } = laid;
    let mut svg = Svg::new(WIDTH, HEIGHT, &chart.title);
    for (row, line) in title_lines(&chart.title).into_iter().enumerate() {
        let size = fitted(line, TITLE, WIDTH - 2.0 * MARGIN);
        let baseline = MARGIN + 0.8 * TITLE + 1.2 * TITLE * row as f64;
        svg.text([WIDTH / 2.0, baseline], size, Anchor::Middle, line);
    }
    if let Some(raster) = &chart.raster {
        raster.draw(&mut svg, &plot.frame);
    }
    plot.draw_axes(&mut svg, chart.raster.is_none());
    contents.draw(&mut svg, chart);
    plot.draw_border(&mut svg);
    draw_remarks(&mut svg, &lines_of(&remarks));
    if !legend.is_empty() {
        legend.draw(&mut svg, place);
    }
    svg.finish()
}

/// Everything with its place.
struct Laid {
    plot: Plot,
    contents: Contents,
    legend: Legend,
    place: Rectangle,
}

impl Laid {
    /// With room for some lines below the frame, and beside it for the legend where that finds no place inside.
    fn out(chart: &Chart, lines: &[String]) -> Self {
        let below = height_of(lines);
        let mut plot = Plot::of(chart, 0.0, below);
        let mut contents = Contents::of(chart, &plot);
        let legend = Legend::new(entries(chart, &contents), 0.6 * WIDTH);
        let place = legend.place(&plot.frame, &contents.everything());
        let place = place.unwrap_or_else(|| {
            plot = Plot::of(chart, legend.width + MARGIN, below);
            contents = Contents::of(chart, &plot);
            let left = plot.frame.right() + MARGIN;
            legend.at(left, plot.frame.top)
        });
        contents.place_names(&plot.frame, &place);
        Self {
            plot,
            contents,
            legend,
            place,
        }
    }
}

/// How many points with letters are outside of the cells, in words; nothing if none is.
fn outside(chart: &Chart) -> Option<String> {
    let Raster { x, y, .. } = chart.raster.as_ref()?;
    let between = |[from, to]: [f64; 2], u: f64| (from.min(to)..=from.max(to)).contains(&u);
    let parts = chart.letters.iter().filter_map(|Series { label, points }| {
        let beyond = points
            .iter()
            .filter(|[u, v]| !between(*x, *u) || !between(*y, *v));
        let beyond = beyond.count();
        (beyond > 0).then(|| format!("{beyond} of the {} points {label}", points.len()))
    });
    let parts: Vec<String> = parts.collect();
    (!parts.is_empty()).then(|| format!("outside of the frame: {}", parts.join(", ")))
}

/// A title as one line, or as two where one had to be small: broken between two of its values, with the longer line as short as can be.
fn title_lines(title: &str) -> Vec<&str> {
    let room = WIDTH - 2.0 * MARGIN;
    if fitted(title, TITLE, room) >= LEGIBLE * TITLE {
        return vec![title];
    }
    let breaks = [": ", ", ", "; "].into_iter().flat_map(|mark| {
        let places = title.match_indices(mark);
        places.map(|(place, mark)| title.split_at(place + mark.len()))
    });
    let length = |(one, other): &(&str, &str)| width_of(one, TITLE).max(width_of(other, TITLE));
    let best = breaks.min_by(|a, b| length(a).total_cmp(&length(b)));
    best.map_or_else(|| vec![title], |(one, other)| vec![one.trim_end(), other])
}

/// Remarks as lines below the chart: short ones share a line.
fn lines_of(remarks: &[String]) -> Vec<String> {
    let mut lines: Vec<String> = Vec::new();
    for remark in remarks {
        match lines.last_mut() {
            Some(line) if width_of(&format!("{line}; {remark}"), REMARK) <= REMARKS => {
                line.push_str("; ");
                line.push_str(remark);
            }
            _ => lines.push(remark.clone()),
        }
    }
    lines
}

/// Height of the lines below the chart.
fn height_of(lines: &[String]) -> f64 {
    1.35 * REMARK * lines.len() as f64
}

fn draw_remarks(svg: &mut Svg, lines: &[String]) {
    for (row, line) in lines.iter().rev().enumerate() {
        let size = fitted(line, REMARK, REMARKS);
        let baseline = HEIGHT - 0.7 * MARGIN - 1.35 * REMARK * row as f64;
        svg.text([MARGIN, baseline], size, Anchor::Start, line);
    }
}

/// The frame and its axes.
pub(super) struct Plot {
    pub(super) frame: Rectangle,
    x: Ruler,
    pub(super) y: Ruler,
    /// Where the label of the horizontal axis stands.
    baseline: f64,
}

/// An axis with what is written at it.
pub(super) struct Ruler {
    label: String,
    pub(super) range: Range,
    labelled: Vec<(f64, String)>,
    minor: Vec<f64>,
    /// Numbers at the axis are to be multiplied by ten to this power.
    power: i32,
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
        let (name, unit) = in_brackets(&axis.label);
        let powers = if takes_prefix(unit) {
            Powers::Thousands
        } else {
            Powers::Any
        };
        let ticks = (3..=10)
            .rev()
            .map(|count| range.ticks(count, powers))
            .find(|ticks| length_of(ticks) < length)
            .unwrap_or_else(|| range.ticks(2, powers));
        let label = match (ticks.power, prefixed(ticks.power, unit)) {
            (0, _) => axis.label.clone(),
            (power, (of_prefix, unit)) if power == of_prefix => format!("{name} [{unit}]"),
            (power, _) => format!("{} (×10{})", axis.label, superscript(power)),
        };
        Self {
            label,
            range,
            labelled: ticks.labelled,
            minor: ticks.minor,
            power: ticks.power,
        }
    }
}

/// A label and the unit in brackets at its end, which is empty if there is none.
fn in_brackets(label: &str) -> (&str, &str) {
    let unit = label
        .strip_suffix(']')
        .and_then(|rest| rest.rsplit_once(" ["));
    unit.unwrap_or((label, ""))
}

impl Ruler {
    /// Names beside rows, at positions from below.
    fn of_rows(label: &str, labelled: Vec<(f64, String)>) -> Self {
        Self {
            label: label.to_owned(),
            range: Range::between(Scale::Linear, [0.0, 1.0]),
            labelled,
            minor: Vec::new(),
            power: 0,
        }
    }
}

impl Plot {
    /// The axes of a chart, with some room left free on the right and below.
    fn of(chart: &Chart, free: f64, below: f64) -> Self {
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
        let y = if chart.bars.is_empty() {
            Ruler::of(&chart.y, y, 0.6 * HEIGHT, |_| TICK)
        } else {
            Ruler::of_rows(&chart.y.label, bars::rows(&chart.bars))
        };
        let x = Ruler::of(&chart.x, x, 0.8 * WIDTH - free, |label| {
            width_of(label, TICK)
        });
        let widest = |ruler: &Ruler| {
            let width = |(_, label): &(f64, String)| width_of(label, TICK);
            ruler.labelled.iter().map(width).fold(0.0, f64::max)
        };
        let left = MARGIN + 1.3 * LABEL + widest(&y) + 12.0;
        let rows = title_lines(&chart.title).len() as f64;
        let top = MARGIN + 1.2 * TITLE * rows + 10.0;
        let right = (MARGIN + free).max(MARGIN + widest(&x) / 2.0);
        let bottom = MARGIN + 1.2 * LABEL + 1.2 * TICK + 16.0 + below;
        let frame = Rectangle {
            left,
            top,
            width: WIDTH - left - right,
            height: HEIGHT - top - bottom,
        };
        Self {
            frame,
            x,
            y,
            baseline: HEIGHT - MARGIN - 0.25 * LABEL - below,
        }
    }

    pub(super) fn pixel(&self, [x, y]: [f64; 2]) -> Option<Pixel> {
        Some(self.at([self.x.range.position(x)?, self.y.range.position(y)?]))
    }

    /// Where a value is along the horizontal axis.
    pub(super) fn across(&self, value: f64) -> Option<f64> {
        self.x.range.position(value)
    }

    /// A value as the horizontal axis has it, to a part of a pixel.
    pub(super) fn along(&self, value: f64) -> String {
        self.x.range.written(value, self.x.power)
    }

    /// The pixel of positions along the axes.
    pub(super) fn at(&self, [x, y]: [f64; 2]) -> Pixel {
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
        svg.text([middle, self.baseline], size, Anchor::Middle, x);
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
