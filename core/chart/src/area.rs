//! Areas between a line and a base.

use super::svg::{Pixel, Rectangle};

/// The polygons that cover what is between a line and a base. Each is of a part of the line that does not turn back, and all go round in
/// one sense, so that they are one area where they overlap. A `None` interrupts the line.
pub(super) fn below(
    points: impl Iterator<Item = Option<Pixel>>,
    base: f64,
    frame: &Rectangle,
) -> Vec<Vec<Pixel>> {
    let base = base.clamp(frame.top, frame.bottom());
    let mut polygons = Vec::new();
    let mut part: Vec<Pixel> = Vec::new();
    for point in points.chain([None]) {
        let point = point.map(|point| frame.nearest(point));
        let turns = match (point, &part[..]) {
            (Some(here), [.., before, last]) => (here[0] - last[0]) * (last[0] - before[0]) < 0.0,
            (None, _) => true,
            _ => false,
        };
        if turns {
            let last = part.last().copied();
            polygons.extend(closed(std::mem::take(&mut part), base));
            part.extend(last.filter(|_| point.is_some()));
        }
        part.extend(point);
    }
    polygons
}

/// A part of a line, from left to right, and back along the base.
fn closed(mut part: Vec<Pixel>, base: f64) -> Option<Vec<Pixel>> {
    let (&[first, _], &[last, _]) = (part.first()?, part.last()?);
    let (low, high) = if last < first {
        part.reverse();
        (last, first)
    } else {
        (first, last)
    };
    part.extend([[high, base], [low, base]]);
    (high > low).then_some(part)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_line_that_turns_back_is_several_areas_in_one_sense() {
        let frame = Rectangle {
            left: 0.0,
            top: 0.0,
            width: 100.0,
            height: 100.0,
        };
        let line = [[10.0, 50.0], [60.0, 10.0], [40.0, 5.0], [90.0, 60.0]];
        let line = line.map(Some).into_iter().chain([None, Some([95.0, 1.0])]);
        let polygons = below(line, 100.0, &frame);
        // Twice the area by the shoelace formula: trapezia of 50, 20 and 50 pixels.
        let area = |corners: &Vec<Pixel>| -> f64 {
            let next = corners.iter().cycle().skip(1);
            let pairs = corners.iter().zip(next);
            pairs.map(|(a, b)| a[0] * b[1] - b[0] * a[1]).sum()
        };
        let areas: Vec<f64> = polygons.iter().map(area).collect();
        assert_eq!(
            areas,
            [
                50.0 * (50.0 + 90.0),
                20.0 * (90.0 + 95.0),
                50.0 * (95.0 + 40.0)
            ]
        );
    }
}
