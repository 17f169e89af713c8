//! The shapes of markers.

use super::svg::{INK, Pen, Pixel, Svg};

const MARKER: Pen = Pen {
    colour: INK,
    width: 1.6,
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

/// Draws a marker: white inside, so that it shows on a curve.
pub(super) fn draw_shape(svg: &mut Svg, shape: Shape, [x, y]: Pixel) {
    let mut closed = |corners: &[Pixel]| {
        let corners: Vec<Pixel> = corners.iter().map(|[u, v]| [x + u, y + v]).collect();
        svg.polygon(&corners, "#ffffff", MARKER);
    };
    match shape {
        Shape::Circle => svg.circle([x, y], 5.0, "#ffffff", MARKER),
        Shape::Square => closed(&[[-4.5, -4.5], [4.5, -4.5], [4.5, 4.5], [-4.5, 4.5]]),
        Shape::Diamond => closed(&[[0.0, -6.5], [6.5, 0.0], [0.0, 6.5], [-6.5, 0.0]]),
        Shape::Triangle => closed(&[[0.0, -6.0], [5.8, 4.2], [-5.8, 4.2]]),
        Shape::Down => closed(&[[0.0, 6.0], [5.8, -4.2], [-5.8, -4.2]]),
        Shape::Cross => closed(&turned(&PLUS)),
        Shape::Plus => closed(&PLUS),
        Shape::Crossed => {
            svg.circle([x, y], 5.0, "#ffffff", MARKER);
            let bar = |u: f64, v: f64| vec![[x - u, y - v], [x + u, y + v]];
            svg.lines(&[bar(3.5, 3.5), bar(3.5, -3.5)], MARKER);
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
