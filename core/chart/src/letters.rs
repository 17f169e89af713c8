//! Points that are drawn as a letter, or a short word, on a small disc.

use std::cmp::Reverse;

use super::mark::{self, Kind};
use super::svg::{Anchor, INK, Pixel, Svg, pen, width_of};

/// Size of a letter, and the radius of the disc behind it.
const SIZE: f64 = 12.0;
const DISC: f64 = 7.0;

/// Points with one label.
pub(super) struct Letters {
    label: String,
    /// Those that can be told apart.
    pub(super) places: Vec<Pixel>,
    /// How many there are.
    count: usize,
}

impl Letters {
    pub(super) fn of(label: &str, points: impl Iterator<Item = Pixel>) -> Self {
        let points: Vec<Pixel> = points.collect();
        let kind = Kind {
            label,
            pixels: &points,
        };
        let places = mark::merged(&[kind]);
        Self {
            label: label.to_owned(),
            places: places.iter().map(|mark| mark.pixel).collect(),
            count: points.len(),
        }
    }
}

/// Points of which fewer are seen, in words; nothing if there are none.
pub(super) fn upon_each_other(all: &[Letters]) -> Option<String> {
    let parts = all.iter().filter_map(|letters| {
        let (label, count, places) = (&letters.label, letters.count, letters.places.len());
        (places < count).then(|| format!("{count} points {label} at {places} places"))
    });
    let parts: Vec<String> = parts.collect();
    (!parts.is_empty()).then(|| format!("upon each other: {}", parts.join(", ")))
}

/// Draws them, those of few places over those of many.
pub(super) fn draw(svg: &mut Svg, all: &[Letters]) {
    let mut all: Vec<&Letters> = all.iter().collect();
    all.sort_by_key(|letters| Reverse(letters.places.len()));
    for Letters { label, places, .. } in all {
        let radius = (0.5 * width_of(label, SIZE) + 3.0).max(DISC);
        for &[x, y] in places {
            svg.circle([x, y], radius, "#ffffff", pen(INK, 1.0, ""));
            svg.text([x, y + 0.27 * SIZE], SIZE, Anchor::Middle, label);
        }
    }
}
