//! From points to the polylines that are drawn: interrupted, clipped and thinned out.

use super::svg::{Pixel, Rectangle};

/// How far, in pixels, a drawn line may be from the line through all points.
const TOLERANCE: f64 = 0.05;

/// The visible parts of the line through some points, each simplified. A `None` interrupts the line.
pub(super) fn polylines(
    points: impl Iterator<Item = Option<Pixel>>,
    frame: &Rectangle,
) -> Vec<Vec<Pixel>> {
    let mut lines: Vec<Vec<Pixel>> = Vec::new();
    let mut previous: Option<Pixel> = None;
    for point in points {
        if let (Some(from), Some(to)) = (previous, point)
            && let Some([from, to]) = clip(from, to, frame)
        {
            match lines.last_mut() {
                Some(line) if line.last() == Some(&from) => line.push(to),
                _ => lines.push(vec![from, to]),
            }
        }
        previous = point;
    }
    lines.iter().map(|line| simplify(line)).collect()
}

/// The part of a segment inside the frame (Liang and Barsky 1984): it runs from `from + first (to - from)` to
/// `from + last (to - from)`, and each side of the frame narrows that interval.
fn clip(from: Pixel, to: Pixel, frame: &Rectangle) -> Option<[Pixel; 2]> {
    let along = [to[0] - from[0], to[1] - from[1]];
    let sides = [
        (-along[0], from[0] - frame.left),
        (along[0], frame.right() - from[0]),
        (-along[1], from[1] - frame.top),
        (along[1], frame.bottom() - from[1]),
    ];
    let (mut first, mut last) = (0.0_f64, 1.0_f64);
    for (outwards, room) in sides {
        if outwards < 0.0 {
            first = first.max(room / outwards);
        } else if outwards > 0.0 {
            last = last.min(room / outwards);
        } else if room < 0.0 {
            return None;
        }
    }
    let at = |t: f64| [from[0] + t * along[0], from[1] + t * along[1]];
    // The ends themselves are kept to the bit, so that consecutive segments are seen to join.
    (first <= last).then(|| {
        [
            if first > 0.0 { at(first) } else { from },
            if last < 1.0 { at(last) } else { to },
        ]
    })
}

/// Leaves out points that are within the tolerance of the line through the others.
///
/// From an anchor, the directions that pass every point since then within the tolerance form a sector, which each
/// point narrows. A point outside the sector, or nearer to the anchor than an earlier one, makes the point before it
/// the next anchor. The work is linear in the number of points.
fn simplify(points: &[Pixel]) -> Vec<Pixel> {
    let Some((&first, rest)) = points.split_first() else {
        return Vec::new();
    };
    let mut kept = vec![first];
    let (mut anchor, mut last) = (first, first);
    let mut sector: Option<Sector> = None;
    for &point in rest {
        let narrowed = match sector {
            Some(sector) => sector.narrowed(anchor, point),
            None => Sector::towards(anchor, point),
        };
        if sector.is_some() && narrowed.is_none() {
            kept.push(last);
            anchor = last;
            sector = Sector::towards(anchor, point);
        } else {
            sector = narrowed;
        }
        last = point;
    }
    kept.push(last);
    kept
}

/// Directions from an anchor, as angles relative to a middle one.
#[derive(Clone, Copy)]
struct Sector {
    middle: f64,
    low: f64,
    high: f64,
    /// Distance of the farthest point.
    far: f64,
}

impl Sector {
    /// `None` for a point at the anchor, which any direction passes.
    fn towards(anchor: Pixel, point: Pixel) -> Option<Self> {
        let (middle, far) = direction(anchor, point);
        let half = half_angle(far)?;
        Some(Self {
            middle,
            low: -half,
            high: half,
            far,
        })
    }

    /// `None` for a point that the sector does not bear.
    fn narrowed(self, anchor: Pixel, point: Pixel) -> Option<Self> {
        let (angle, distance) = direction(anchor, point);
        let half = half_angle(distance)?;
        let turn = angle - self.middle;
        let turn = turn - std::f64::consts::TAU * (turn / std::f64::consts::TAU).round();
        let within = (self.low..=self.high).contains(&turn) && distance >= self.far;
        within.then(|| Self {
            low: self.low.max(turn - half),
            high: self.high.min(turn + half),
            far: distance,
            ..self
        })
    }
}

fn direction(from: Pixel, to: Pixel) -> (f64, f64) {
    let (dx, dy) = (to[0] - from[0], to[1] - from[1]);
    (dy.atan2(dx), dx.hypot(dy))
}

/// The angle under which the tolerance is seen from a distance; `None` from within it.
fn half_angle(distance: f64) -> Option<f64> {
    (distance > TOLERANCE).then(|| (TOLERANCE / distance).asin())
}

#[cfg(test)]
mod tests {
    use super::*;

    const FRAME: Rectangle = Rectangle {
        left: 0.0,
        top: 0.0,
        width: 100.0,
        height: 50.0,
    };

    #[test]
    fn a_line_is_clipped_and_interrupted() {
        let points = [
            Some([-50.0, 25.0]),
            Some([150.0, 25.0]),
            None,
            Some([10.0, 10.0]),
            Some([10.0, 80.0]),
            Some([20.0, 80.0]),
            Some([20.0, 10.0]),
        ];
        let expected = vec![
            vec![[0.0, 25.0], [100.0, 25.0]],
            vec![[10.0, 10.0], [10.0, 50.0]],
            vec![[20.0, 50.0], [20.0, 10.0]],
        ];
        assert_eq!(polylines(points.into_iter(), &FRAME), expected);
    }

    #[test]
    fn a_thinned_curve_stays_within_the_tolerance() {
        let curve = |i: u32| {
            let t = f64::from(i) / 1e4;
            [50.0 + 50.0 * (9.0 * t).sin(), 25.0 + 25.0 * (7.0 * t).cos()]
        };
        let points: Vec<Pixel> = (0..100_000).map(curve).collect();
        let thin = simplify(&points);
        assert!(thin.len() < points.len() / 30, "{}", thin.len());
        assert_eq!((thin.first(), thin.last()), (points.first(), points.last()));
        let distance = |point: Pixel| {
            let to = |pair: &[Pixel]| to_segment(point, pair[0], pair[1]);
            thin.windows(2).map(to).fold(f64::INFINITY, f64::min)
        };
        let error = points.iter().step_by(97).map(|&p| distance(p));
        assert!(error.fold(0.0, f64::max) <= 1.01 * TOLERANCE);
    }

    #[test]
    fn a_line_that_turns_back_keeps_its_far_end() {
        let points = [[0.0, 0.0], [5.0, 0.0], [10.0, 0.0], [7.0, 0.0], [2.0, 0.0]];
        assert_eq!(simplify(&points), [[0.0, 0.0], [10.0, 0.0], [2.0, 0.0]]);
    }

    fn to_segment(point: Pixel, from: Pixel, to: Pixel) -> f64 {
        let along = [to[0] - from[0], to[1] - from[1]];
        let off = [point[0] - from[0], point[1] - from[1]];
        let length = along[0] * along[0] + along[1] * along[1];
        let t = ((along[0] * off[0] + along[1] * off[1]) / length).clamp(0.0, 1.0);
        (off[0] - t * along[0]).hypot(off[1] - t * along[1])
    }
}
