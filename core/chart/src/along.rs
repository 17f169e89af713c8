//! Small shapes along curves, by which several of them are told apart without colours.

use super::shape::Shape;
use super::svg::{Pen, Pixel, Svg};

/// Length of a curve from one shape to the next, in pixels.
const APART: f64 = 120.0;
/// By how much the first shape is later on each next curve, so that shapes of curves side by side are not at one place.
const LATER: f64 = 37.0;

/// A shape at equal distances along the lines of a curve, the first one later for each next number.
pub(super) fn places<'l>(lines: impl Iterator<Item = &'l Vec<Pixel>>, number: usize) -> Vec<Pixel> {
    let mut places = Vec::new();
    let mut left = (0.5 * APART + LATER * number as f64) % APART;
    for line in lines {
        for pair in line.windows(2) {
            let ([x, y], [u, v]) = (pair[0], pair[1]);
            let length = (u - x).hypot(v - y);
            while left < length {
                let part = left / length;
                places.push([x + part * (u - x), y + part * (v - y)]);
                left += APART;
            }
            left -= length;
        }
    }
    places
}

/// Draws one of them: filled, and smaller than a marker.
pub(super) fn draw(svg: &mut Svg, shape: Shape, place: Pixel, colour: &'static str) {
    let pen = Pen {
        colour,
        width: 1.0,
        dashes: "",
    };
    shape.draw(svg, place, 0.62, colour, pen);
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn shapes_are_at_equal_lengths_across_breaks() {
        let lines = [
            vec![[0.0, 0.0], [100.0, 0.0]],
            vec![[0.0, 50.0], [0.0, 90.0], [200.0, 90.0]],
        ];
        let found = places(lines.iter(), 0);
        // At lengths 60, 180 and 300 of 340.
        assert_eq!(found, [[60.0, 0.0], [40.0, 90.0], [160.0, 90.0]]);
        let next = places(lines.iter(), 1);
        assert_eq!(next[0], [97.0, 0.0]);
    }
}
