//! A branch as a curve in the plane of what varies and what is measured, its sheets, and the points of these that are nearest to data.
//!
//! With the place `x`, the reading `y` and what counts as one in both, `X` and `Y`, a curve is given by the length `s` of its chords. For a datum
//! `d` with standard deviations `a` and `b` the foot `f` and the distance `r` are
//!
//! ```text
//! f = argmin_s e.e,   e = ((d_x - x(s)) / a, (d_y - y(s)) / b),   r = +-|e|                                  (1)
//! dr/dp = - x'(s) y_p / (a b |(x'/a, y'/b)|)                                                                (2)
//! ```
//!
//! where `y_p` is the derivative of the reading at a fixed place. At a fold `y_p` is unbounded and `x'` is zero; their product is neither.
//! Between folds a curve is a *sheet*. One with an even number of folds before it can be stable; a distance to it may be taken a little beyond
//! its fold, so that it stays smooth there.
//!
//! Source: Boggs, Byrd and Schnabel (1987), SIAM Journal on Scientific and Statistical Computing 8, 1052 (distances across a curve instead
//! of differences along one axis).

use crate::spline::Spline;

/// A point of a branch, or a place where it turns.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Node {
    pub(crate) x: f64,
    pub(crate) y: f64,
    pub(crate) turns: bool,
    /// Number of the point of the branch, or of the event.
    pub(crate) point: Option<usize>,
    pub(crate) event: Option<usize>,
}

/// Nodes joined.
#[derive(Debug, Clone)]
pub(crate) struct Path {
    /// The number of its branch.
    pub(crate) branch: usize,
    pub(crate) nodes: Vec<Node>,
    pub(crate) along: Vec<f64>,
    x: Spline,
    y: Spline,
    size: [f64; 2],
}

/// A part of a path between folds.
#[derive(Debug, Clone, Default)]
pub(crate) struct Sheet {
    /// Nodes at its ends.
    pub(crate) nodes: [usize; 2],
    /// Lengths at its ends, and at those of what is looked at.
    pub(crate) ends: [f64; 2],
    reach: [f64; 2],
    /// The lowest and the highest place.
    pub(crate) range: [f64; 2],
    /// Nodes at which it ends in a fold, at the lowest and the highest place.
    pub(crate) folds: [Option<usize>; 2],
    /// Plus or minus one: the place grows or falls along it.
    pub(crate) direction: f64,
    pub(crate) may_be_stable: bool,
}

/// The point of a sheet that is nearest to a datum.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Foot {
    pub(crate) along: f64,
    pub(crate) x: f64,
    pub(crate) y: f64,
    /// (1)
    pub(crate) distance: f64,
    /// The factor of `y_p x'` in (2).
    pub(crate) weight: f64,
}

/// Parts of a step that are drawn.
const PARTS: usize = 3;
/// Steps towards a foot.
const STEPS: usize = 40;
/// A sheet is looked at beyond a fold by this part of the next one.
const BEYOND: f64 = 0.25;

impl Sheet {
    /// The first and the last node of what is looked at.
    pub(crate) fn within(&self, path: &Path) -> [usize; 2] {
        let [from, to] = self.reach;
        let first = path.along.partition_point(|&along| along < from);
        let last = path.along.partition_point(|&along| along <= to);
        [first, last.saturating_sub(1).max(first)]
    }
}

impl Path {
    /// Through nodes that are not all at one place.
    pub(crate) fn of(branch: usize, nodes: Vec<Node>, size: [f64; 2]) -> Option<Self> {
        let mut along = vec![0.0];
        for pair in nodes.windows(2) {
            let chord =
                ((pair[1].x - pair[0].x) / size[0]).hypot((pair[1].y - pair[0].y) / size[1]);
            along.push(along[along.len() - 1] + chord.max(1e-12));
        }
        if nodes.len() < 3 || along.iter().any(|s| !s.is_finite()) {
            return None;
        }
        let mut x = Spline::through(along.clone(), nodes.iter().map(|node| node.x).collect());
        let y = Spline::through(along.clone(), nodes.iter().map(|node| node.y).collect());
        for (index, node) in nodes.iter().enumerate() {
            if node.turns {
                x.flatten(index);
            }
        }
        Some(Self {
            branch,
            nodes,
            along,
            x,
            y,
            size,
        })
    }

    /// Its parts between folds.
    pub(crate) fn sheets(&self) -> Vec<Sheet> {
        let last = self.nodes.len() - 1;
        let grows = |i: usize| self.nodes[i + 1].x > self.nodes[i].x;
        let mut cuts = vec![0];
        cuts.extend((1..last).filter(|&i| grows(i - 1) != grows(i)));
        cuts.push(last);
        let count = cuts.len() - 1;
        let sheet = |number: usize| {
            let [first, end] = [cuts[number], cuts[number + 1]];
            let grows = grows(first);
            let is_fold = |cut: usize| (1..count).contains(&cut);
            let folds = [
                is_fold(number).then_some(first),
                is_fold(number + 1).then_some(end),
            ];
            let [low, high] = if grows { [first, end] } else { [end, first] };
            let next = |cut: usize| cuts.get(cut).map_or(0.0, |&node| self.along[node]);
            let before = number
                .checked_sub(1)
                .map_or(0.0, |cut| self.along[first] - next(cut));
            let after = (number + 2 <= count).then(|| next(number + 2) - self.along[end]);
            Sheet {
                nodes: [first, end],
                ends: [self.along[first], self.along[end]],
                reach: [
                    self.along[first] - BEYOND * before,
                    self.along[end] + BEYOND * after.unwrap_or(0.0),
                ],
                range: [self.nodes[low].x, self.nodes[high].x],
                folds: if grows { folds } else { [folds[1], folds[0]] },
                direction: if grows { 1.0 } else { -1.0 },
                may_be_stable: number.is_multiple_of(2),
            }
        };
        (0..count).map(sheet).collect()
    }

    /// Place and reading at a length, and their slopes, for which a length along the curve is one.
    pub(crate) fn at(&self, along: f64) -> ([f64; 2], [f64; 2]) {
        let ([x, dx], [y, dy]) = (self.x.of(along), self.y.of(along));
        let speed = (dx / self.size[0])
            .hypot(dy / self.size[1])
            .max(f64::MIN_POSITIVE);
        ([x, y], [dx / speed, dy / speed])
    }

    /// Points of a sheet that a picture joins.
    pub(crate) fn drawn(&self, sheet: &Sheet) -> Vec<[f64; 2]> {
        let [from, to] = sheet.nodes;
        let pairs = self.along[from..=to].windows(2);
        let inside = pairs.flat_map(|pair| {
            (0..PARTS).map(move |k| pair[0] + (pair[1] - pair[0]) * k as f64 / PARTS as f64)
        });
        let along = inside.chain([self.along[to]]);
        along.map(|along| self.at(along).0).collect()
    }

    /// The length at which a sheet is at a place, or its nearest end.
    pub(crate) fn along_at(&self, sheet: &Sheet, place: f64) -> f64 {
        let [mut low, mut high] = sheet.ends;
        let is_before = |along: f64| sheet.direction * (self.x.of(along)[0] - place) < 0.0;
        if !is_before(low) {
            return low;
        }
        if is_before(high) {
            return high;
        }
        for _ in 0..60 {
            let middle = 0.5 * (low + high);
            if is_before(middle) {
                low = middle;
            } else {
                high = middle;
            }
        }
        0.5 * (low + high)
    }

    /// The foot (1) of a datum on a sheet.
    pub(crate) fn foot(&self, sheet: &Sheet, datum: [f64; 2], by: [f64; 2]) -> Foot {
        let apart = |along: f64| {
            let ([x, y], [dx, dy]) = (
                [self.x.of(along)[0], self.y.of(along)[0]],
                [self.x.of(along)[1], self.y.of(along)[1]],
            );
            let e = [(datum[0] - x) / by[0], (datum[1] - y) / by[1]];
            (e, [dx / by[0], dy / by[1]])
        };
        let square = |along: f64| {
            let (e, _) = apart(along);
            e[0] * e[0] + e[1] * e[1]
        };
        let [from, to] = sheet.reach;
        let mut best = self.along_at(sheet, datum[0]);
        let mut least = square(best);
        for pair in self.along.windows(2) {
            for along in [pair[0], 0.5 * (pair[0] + pair[1])] {
                if (from..=to).contains(&along) && square(along) < least {
                    (best, least) = (along, square(along));
                }
            }
        }
        // Gauss and Newton's method along the curve, with shorter steps where one leads away.
        let mut shorter = 1.0;
        for _ in 0..STEPS {
            let (e, t) = apart(best);
            let step = (e[0] * t[0] + e[1] * t[1]) / (t[0] * t[0] + t[1] * t[1]);
            let next = (best + shorter * step).clamp(from, to);
            if !next.is_finite() || (next - best).abs() <= 1e-13 * to.abs() {
                break;
            }
            let there = square(next);
            if there < least {
                (best, least, shorter) = (next, there, 1.0);
            } else {
                shorter *= 0.5;
            }
        }
        self.standing(sheet, best, datum, by)
    }

    /// The distance of a datum from a point of a sheet, with its slope by readings.
    fn standing(&self, sheet: &Sheet, along: f64, datum: [f64; 2], by: [f64; 2]) -> Foot {
        let ([x, y], slopes) = self.at(along);
        let e = [(datum[0] - x) / by[0], (datum[1] - y) / by[1]];
        let t = [slopes[0] / by[0], slopes[1] / by[1]];
        let (length, speed) = (e[0].hypot(e[1]), t[0].hypot(t[1]));
        let side = if sheet.direction * (t[0] * e[1] - t[1] * e[0]) < 0.0 {
            -1.0
        } else {
            1.0
        };
        let reach = sheet.reach;
        let at_end = along <= reach[0] || along >= reach[1];
        // At an end the distance need not be across the curve.
        let weight = if at_end && length > 0.0 && slopes[0] != 0.0 {
            -side * e[1] / length / by[1] / slopes[0]
        } else {
            -sheet.direction / (by[0] * by[1] * speed)
        };
        Foot {
            along,
            x,
            y,
            distance: side * length,
            weight,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// `x = 1 - y^2`: two sheets that meet in a fold at one.
    fn parabola() -> Path {
        let node = |index: i32| {
            let y = f64::from(index) / 20.0;
            Node {
                x: 1.0 - y * y,
                y,
                turns: index == 0,
                point: Some(0),
                event: None,
            }
        };
        Path::of(0, (-20..=20).map(node).collect(), [1.0, 1.0]).expect("a path")
    }

    #[test]
    fn a_distance_is_that_to_the_nearest_point() {
        let path = parabola();
        let sheets = path.sheets();
        assert_eq!(sheets.len(), 2);
        assert_eq!(
            [sheets[0].may_be_stable, sheets[1].may_be_stable],
            [true, false]
        );
        assert_eq!(sheets[0].folds, [None, Some(20)]);
        // Beyond the fold: straight to it.
        let foot = path.foot(&sheets[0], [1.2, 0.0], [1.0, 1.0]);
        assert!((foot.distance.abs() - 0.2).abs() < 1e-6, "{foot:?}");
        // Across the curve at y = -1/2, where its normal is (1, -1).
        let foot = path.foot(&sheets[0], [0.75 + 0.1, -0.5 - 0.1], [1.0, 1.0]);
        assert!(
            (foot.distance.abs() - 0.02_f64.sqrt()).abs() < 1e-4,
            "{foot:?}"
        );
        assert!((foot.x - 0.75).abs() < 1e-3);
        // Where the place is certain the difference is one of readings, by the other deviation.
        let foot = path.foot(&sheets[0], [0.75, -0.4], [1e-6, 0.5]);
        assert!((foot.distance - 0.2).abs() < 1e-4, "{foot:?}");
    }

    #[test]
    fn distances_change_as_their_weights_say() {
        let path = parabola();
        let sheet = &path.sheets()[0];
        for datum in [[0.8, -0.5], [1.1, 0.01], [0.3, -0.7]] {
            let by = [0.3, 0.2];
            let foot = path.foot(sheet, datum, by);
            // All readings grow by one: y_p = 1.
            let step = 1e-5;
            let [a, b] = [-step, step]
                .map(|step| path.foot(sheet, [datum[0], datum[1] - step], by).distance);
            let expected = (b - a) / (2.0 * step);
            assert!(
                (foot.weight * path.at(foot.along).1[0] - expected).abs()
                    < 1e-3 * expected.abs().max(0.1),
                "{foot:?} {expected}"
            );
        }
    }
}
