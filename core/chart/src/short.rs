//! Pieces of curves that are too short for their line to say what they are: most of such a piece is below marks.

use std::fmt::Write;

use super::Line;
use super::drawing::Plot;
use super::svg::Pixel;

/// What a mark covers, in pixels from its place.
const COVERED: f64 = 6.5;
/// Two dashes with the gap behind each.
const READ: f64 = 24.0;
/// Pieces that are smaller than this in both directions are not to be seen at all.
const SEEN: f64 = 2.0;
/// As many are listed.
const LISTED: usize = 6;

/// A piece with what is said of it.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Piece<'c> {
    /// The name of its curve.
    pub(super) label: &'c str,
    pub(super) line: Line,
    /// Its ends along the horizontal axis.
    pub(super) ends: [f64; 2],
}

/// Whether lines of one stability are too short to be read beside marks.
pub(super) fn is_short(lines: &[Vec<Pixel>], marks: &[Pixel]) -> bool {
    let points = || lines.iter().flatten();
    let extent = |k: usize| {
        let ends = points().fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], point| {
            [low.min(point[k]), high.max(point[k])]
        });
        ends[1] - ends[0]
    };
    extent(0).max(extent(1)) >= SEEN && uncovered(lines, marks) < READ
}

/// The length that no mark covers, looked at pixel by pixel.
fn uncovered(lines: &[Vec<Pixel>], marks: &[Pixel]) -> f64 {
    let mut length = 0.0;
    for pair in lines.iter().flat_map(|line| line.windows(2)) {
        let ([x, y], [u, v]) = (pair[0], pair[1]);
        let whole = (u - x).hypot(v - y);
        let steps = whole.ceil().max(1.0);
        let free = (0..steps as u32).filter(|&step| {
            let part = (f64::from(step) + 0.5) / steps;
            let place = [x + part * (u - x), y + part * (v - y)];
            let distance = |mark: &Pixel| (mark[0] - place[0]).hypot(mark[1] - place[1]);
            marks.iter().all(|mark| distance(mark) > COVERED)
        });
        length += whole * free.count() as f64 / steps;
    }
    length
}

/// What is said below the chart of all of them; nothing if there are none.
pub(super) fn said(pieces: &[Piece<'_>], plot: &Plot) -> Option<String> {
    let mut text = String::new();
    let mut label = None;
    for Piece {
        label: own,
        line,
        ends,
    } in pieces.iter().take(LISTED)
    {
        let [from, to] = [ends[0].min(ends[1]), ends[0].max(ends[1])].map(|end| plot.along(end));
        text += match label {
            None => "short pieces: ",
            Some(last) if last == *own => ", ",
            Some(_) => "; ",
        };
        if label != Some(*own) && !own.is_empty() {
            text += own;
            text += " ";
        }
        label = Some(*own);
        // Writing to a string does not fail.
        let _ = write!(text, "{} between {from} and {to}", line.name());
    }
    let more = pieces.len().saturating_sub(LISTED);
    if more > 0 {
        let _ = write!(text, " and {more} more");
    }
    Some(text).filter(|text| !text.is_empty())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_piece_is_short_by_what_marks_leave_of_it() {
        let line = [vec![[0.0, 0.0], [30.0, 0.0]]];
        assert!(!is_short(&line, &[]));
        // Two marks cover 13 of 30 pixels, one far from it none.
        assert!((uncovered(&line, &[[0.0, 0.0], [30.0, 0.0]]) - 17.0).abs() <= 1.0);
        assert!(is_short(&line, &[[0.0, 0.0], [30.0, 0.0]]));
        assert!(!is_short(&line, &[[0.0, 7.0]]));
        // What is smaller than a line is wide is no piece that anyone sees.
        assert!(!is_short(&[vec![[0.0, 0.0], [1.0, 1.0]]], &[]));
    }
}
