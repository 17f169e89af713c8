//! The shapes of markers.

use super::svg::{INK, Pen, Pixel, Svg};

const MARKER: Pen = Pen {
    colour: INK,
    width: 1.6,
    dashes: "",
};

/// Sizes of what is filled, as parts of that of a mark, and its edge.
const FILLED: f64 = 0.9;
const LARGEST: f64 = 1.25;
const STEP: f64 = 0.06;
const EDGE: Pen = Pen {
    colour: "#ffffff",
    width: 1.0,
    dashes: "",
};

/// The shape of one kind of markers.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Shape {
    Circle,
    Square,
    Diamond,
    Triangle,
    Down,
    Cross,
    Plus,
    Crossed,
}

impl Shape {
    pub(super) fn of(index: usize) -> Self {
        [
            Self::Circle,
            Self::Square,
            Self::Diamond,
            Self::Triangle,
            Self::Down,
            Self::Cross,
            Self::Plus,
            Self::Crossed,
        ][index % 8]
    }
}

/// Draws the mark of an event: white inside, so that it shows on a curve.
pub(super) fn draw_open(svg: &mut Svg, shape: Shape, place: Pixel) {
    shape.draw(svg, place, 1.0, "#ffffff", MARKER);
}

/// Draws a point: dark, with a white edge, so that it shows on cells of any lightness.
pub(super) fn draw_filled(svg: &mut Svg, shape: Shape, place: Pixel) {
    shape.draw(svg, place, FILLED, INK, EDGE);
}

/// Draws a point of one of several lines, in its colour: the later the line, the smaller, so that points upon each other are seen.
pub(super) fn draw_joined(svg: &mut Svg, index: usize, place: Pixel, colour: &'static str) {
    let size = LARGEST - STEP * (index % 8) as f64;
    Shape::of(index).draw(svg, place, size, colour, EDGE);
}

impl Shape {
    /// Draws it so many times as large as a marker.
    pub(super) fn draw(self, svg: &mut Svg, [x, y]: Pixel, size: f64, fill: &str, pen: Pen) {
        let mut closed = |corners: &[Pixel]| {
            let corners = corners.iter();
            let corners: Vec<Pixel> = corners.map(|[u, v]| [x + size * u, y + size * v]).collect();
            svg.polygon(&corners, fill, pen);
        };
        match self {
            Self::Circle => svg.circle([x, y], size * 5.0, fill, pen),
            Self::Square => closed(&[[-4.5, -4.5], [4.5, -4.5], [4.5, 4.5], [-4.5, 4.5]]),
            Self::Diamond => closed(&[[0.0, -6.5], [6.5, 0.0], [0.0, 6.5], [-6.5, 0.0]]),
            Self::Triangle => closed(&[[0.0, -6.0], [5.8, 4.2], [-5.8, 4.2]]),
            Self::Down => closed(&[[0.0, 6.0], [5.8, -4.2], [-5.8, -4.2]]),
            Self::Cross => closed(&turned(&PLUS)),
            Self::Plus => closed(&PLUS),
            Self::Crossed => {
                svg.circle([x, y], size * 5.0, fill, pen);
                let bar = |u: f64, v: f64| {
                    let (u, v) = (size * u, size * v);
                    vec![[x - u, y - v], [x + u, y + v]]
                };
                svg.lines(&[bar(3.5, 3.5), bar(3.5, -3.5)], pen);
            }
        }
    }
}

/// The outline of a cross with upright bars.
const PLUS: [Pixel; 12] = [
    [-1.8, -6.0],
    [1.8, -6.0],
    [1.8, -1.8],
    [6.0, -1.8],
    [6.0, 1.8],
    [1.8, 1.8],
    [1.8, 6.0],
    [-1.8, 6.0],
    [-1.8, 1.8],
    [-6.0, 1.8],
    [-6.0, -1.8],
    [-1.8, -1.8],
];

/// Turned by an eighth.
fn turned(corners: &[Pixel]) -> Vec<Pixel> {
    let part = std::f64::consts::FRAC_1_SQRT_2;
    let turn = |[u, v]: &Pixel| [part * (u - v), part * (u + v)];
    corners.iter().map(turn).collect()
}
