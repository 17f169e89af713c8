//! Bands between two lines.

use super::svg::Pixel;

/// The quadrilaterals between two lines, all of which go round in one sense, so that they are one area where they overlap. A `None` on either
/// line interrupts the band.
pub(super) fn between(lines: [Vec<Option<Pixel>>; 2]) -> Vec<Vec<Pixel>> {
    let [one, other] = lines;
    let pairs: Vec<Option<[Pixel; 2]>> = one
        .into_iter()
        .zip(other)
        .map(|(a, b)| Some([a?, b?]))
        .collect();
    let quadrilaterals = pairs.windows(2).filter_map(|pair| {
        let ([a, b], [c, d]) = (pair[0]?, pair[1]?);
        let mut corners = vec![a, c, d, b];
        if area(&corners) < 0.0 {
            corners.reverse();
        }
        Some(corners)
    });
    quadrilaterals.collect()
}

/// Twice the area of a polygon, with its sense (the shoelace formula).
fn area(corners: &[Pixel]) -> f64 {
    let next = corners.iter().cycle().skip(1);
    let pairs = corners.iter().zip(next);
    pairs.map(|(a, b)| a[0] * b[1] - b[0] * a[1]).sum()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_band_is_of_one_sense_and_interrupted() {
        let line = |y: f64| {
            [
                Some([0.0, y]),
                Some([2.0, y]),
                None,
                Some([0.0, y]),
                Some([-1.0, y]),
            ]
        };
        let found = between([line(1.0).to_vec(), line(4.0).to_vec()]);
        let areas: Vec<f64> = found.iter().map(|corners| area(corners)).collect();
        assert_eq!(areas, [12.0, 6.0]);
    }
}
