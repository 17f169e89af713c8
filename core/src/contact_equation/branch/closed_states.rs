//! Whether a walk has come back to its first orbit, told by the states of the orbits that were kept.
//!
//! Unknowns are those of the switches of an orbit. Where contacts change in the very step that passes the first orbit, that has no place in the unknowns of
//! both ends, and whether the step passes it is told by nothing else. With the states `a`, `b`, `c` of the last three orbits at the beginnings of periods and what is
//! varied there, in parts of their sizes, and the distances `r` from `a` to `b` and one from `b` to `c`, it is on the parabola through them,
//!
//! ```text
//! p(s) = b + s (c - b) + s (s - 1) ((c - b) - (b - a) / r) / (1 + r),    0 < s <= 1                            (1)
//! ```
//!
//! Source: Abramowitz and Stegun (1964), Handbook of Mathematical Functions, equation 25.2.26 (Newton's divided differences).

use crate::branches::point::Point;

/// The first orbit is no farther from (1) than this part of the step, and this part of the sizes beside.
const ASIDE: [f64; 2] = [0.05, 1e-5];
/// Iterations for the place on (1) that is as far along the step as the first orbit: a step hardly bends.
const ITERATIONS: usize = 8;

/// Whether the step to the last of these orbits passes the first one in the first direction. What is varied is measured by a unit.
pub(super) fn pass_first(points: &[Point], unit: f64) -> bool {
    let [first, second, .., a, b, c] = points else {
        return false;
    };
    let places = [first, second, a, b, c].map(|point| place(point, first, unit));
    let [first, second, a, b, c] = places.each_ref();
    if places.iter().any(|place| place.len() != first.len()) {
        return false;
    }
    let [step, before] = [minus(c, b), minus(b, a)];
    let [square, other] = [&step, &before].map(|of| product(of, of));
    let onward = product(&step, &minus(second, first)) > 0.0;
    let from = minus(first, b);
    let ahead = product(&from, &step) / square;
    if !(onward && other > 0.0 && ahead > 0.0 && ahead <= 1.0) {
        return false;
    }
    // (1)
    let ratio = (other / square).sqrt();
    let pairs = step.iter().zip(&before);
    let bend: Vec<f64> = pairs
        .map(|(c, b)| (c - b / ratio) / (1.0 + ratio))
        .collect();
    let along = product(&bend, &step) / square;
    let mut part = ahead;
    for _ in 0..ITERATIONS {
        part = ahead - part * (part - 1.0) * along;
    }
    let lines = from.iter().zip(&step).zip(&bend);
    let off = lines.map(|((from, step), bend)| from - part * step - part * (part - 1.0) * bend);
    let off: Vec<f64> = off.collect();
    product(&off, &off).sqrt() <= ASIDE[0] * square.sqrt() + ASIDE[1]
}

/// States of an orbit in parts of the size and the speed of another one, and what is varied.
fn place(point: &Point, of: &Point, unit: f64) -> Vec<f64> {
    let coordinates = of.orbit.coordinates();
    let size = of.size();
    let speed = size * of.orbit.base * of.orbit.period as f64;
    let count = point.orbit.states().count() * 2 * coordinates;
    let per = (1.0 / count.max(1) as f64).sqrt();
    let mut place = Vec::new();
    for state in point.orbit.states() {
        let sizes = (0..state.len()).map(|i| if i < coordinates { size } else { speed });
        let parts = state.iter().zip(sizes);
        place.extend(parts.map(|(x, size)| per * x / size));
    }
    place.push(point.value / unit);
    place
}

fn minus(a: &[f64], b: &[f64]) -> Vec<f64> {
    a.iter().zip(b).map(|(x, y)| x - y).collect()
}

fn product(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(x, y)| x * y).sum()
}
