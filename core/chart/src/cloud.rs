//! Many points as few dots: those that would be drawn over each other are drawn once.

use std::collections::BTreeSet;

use super::svg::{Pen, Pixel, Svg};

/// Dots stand on a grid of this distance, in pixels.
const GRID: f64 = 0.5;

/// Dots and vertical rows of dots.
#[derive(Debug, Clone, Default)]
pub(super) struct Dots {
    /// Column, and the rows where it begins and ends.
    rows: Vec<[i32; 3]>,
}

/// How one of several clouds is drawn.
pub(super) fn pen(index: usize, count: usize) -> Pen {
    let (colour, width) = match count - 1 - index {
        0 => ("#000000", 1.1),
        1 => ("#e8873a", 2.6),
        _ => ("#8fc6ea", 4.0),
    };
    Pen {
        colour,
        width,
        dashes: "",
    }
}

impl Dots {
    pub(super) fn of(points: impl Iterator<Item = Pixel>) -> Self {
        let on_grid = |[x, y]: Pixel| [(x / GRID).round() as i32, (y / GRID).round() as i32];
        let places: BTreeSet<[i32; 2]> = points.map(on_grid).collect();
        let mut rows: Vec<[i32; 3]> = Vec::new();
        for [x, y] in places {
            match rows.last_mut() {
                Some([column, _, end]) if *column == x && *end + 1 == y => *end = y,
                _ => rows.push([x, y, y]),
            }
        }
        Self { rows }
    }

    /// Each row as a line, of one point for a single dot.
    pub(super) fn lines(&self) -> impl Iterator<Item = Vec<Pixel>> {
        let at = |i: i32| f64::from(i) * GRID;
        self.rows.iter().map(move |&[x, from, to]| {
            let start = [at(x), at(from)];
            if from == to {
                vec![start]
            } else {
                vec![start, [at(x), at(to)]]
            }
        })
    }

    pub(super) fn draw(&self, svg: &mut Svg, pen: Pen) {
        svg.dots(&self.lines().collect::<Vec<_>>(), pen);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn dots_at_one_place_are_one_and_neighbours_are_a_line() {
        let points = [
            [1.0, 1.0],
            [1.1, 1.1],
            [1.0, 1.5],
            [1.0, 2.0],
            [1.0, 4.0],
            [3.0, 1.0],
        ];
        let dots = Dots::of(points.into_iter());
        let lines: Vec<_> = dots.lines().collect();
        assert_eq!(
            lines,
            [
                vec![[1.0, 1.0], [1.0, 2.0]],
                vec![[1.0, 4.0]],
                vec![[3.0, 1.0]]
            ]
        );
    }
}
