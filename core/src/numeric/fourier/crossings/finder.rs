//! The search of one period.
//!
//! A phase is *decided* if the series is on one side of the level there by more than rounding. The period is walked from
//! a decided phase to itself, by ends of pieces and by those extrema that might lie across the level. Between two
//! successive decided phases on different sides is one crossing. So a series that touches the level has none, crossings
//! rise and fall in turns, and their number is even.

use std::f64::consts::TAU;

use super::grid::Grid;
use super::pieces::{Point, Shape, pieces};
use super::roots;
use super::waves::{Waves, highest};
use super::{Crossing, NearMiss};

/// Finds all crossings of a series with levels. After the first calls nothing is allocated, if the caller keeps the
/// vectors.
///
/// A value within `4 f64::EPSILON (|mean| + sum of amplitudes)` of the level is on neither side: a pair of crossings
/// between which the series goes no further is none. A series with a coefficient that is not finite has no crossings.
#[derive(Debug)]
pub struct CrossingFinder {
    waves: Waves,
    grid: Grid,
}

impl CrossingFinder {
    /// Prepares for series whose harmonics above `harmonics` are zero.
    pub fn new(harmonics: usize) -> Self {
        Self {
            waves: Waves::new(harmonics),
            grid: Grid::new(harmonics),
        }
    }

    /// Takes a series and samples it. One with more harmonics than were prepared for allocates for them.
    pub fn sample(&mut self, series: &[f64]) {
        let highest = highest(series);
        if highest > self.grid.harmonics() {
            *self = Self::new(highest);
        }
        self.waves.load(series, highest);
        if !self.is_constant() {
            self.grid.sample(&self.waves);
        }
    }

    fn is_constant(&self) -> bool {
        self.waves.pairs().is_empty()
    }

    /// Appends the crossings of the sampled series with a level, in order of phase.
    pub fn crossings(&self, level: f64, found: &mut Vec<Crossing>) {
        if self.is_constant() {
            return;
        }
        let target = self.waves.target(level);
        let tolerance = self.waves.bounds().tolerance;
        let decided = |&x: &f64| (x - target).abs() > tolerance;
        let Some(first) = self.grid.values().iter().position(decided) else {
            return;
        };
        let before = found.len();
        let (last, _) = self.grid.interval(first);
        let mut search = Search {
            waves: &self.waves,
            target,
            above: last.x > target,
            last,
            found,
        };
        let intervals = self.grid.intervals();
        let (low, high) = self.grid.ranges();
        for (start, range) in [(0, first..intervals), (intervals, 0..first)] {
            for index in range {
                if low[index] <= target && target <= high[index] {
                    let (left, right) = self.grid.interval(start + index);
                    search.search(left, right);
                }
            }
        }
        into_one_period(&mut found[before..], |crossing| &mut crossing.tau);
    }

    /// Appends, in order of phase, the extrema of the sampled series that come within `distance` of a level without
    /// crossing it: minima above and maxima below.
    pub fn near_misses(&self, level: f64, distance: f64, found: &mut Vec<NearMiss>) {
        if self.is_constant() {
            return;
        }
        let target = self.waves.target(level);
        let reach = self.waves.scaled(distance);
        let outside = |low: f64, high: f64| !(low <= target + reach && target - reach <= high);
        let before = found.len();
        let (low, high) = self.grid.ranges();
        for (index, (&low, &high)) in low.iter().zip(high).enumerate() {
            if !outside(low, high) {
                let (left, right) = self.grid.interval(index);
                pieces(&self.waves, left, right, outside, |a, b, shape| {
                    found.extend(self.near_miss(target, reach, a, b, shape));
                });
            }
        }
        into_one_period(&mut found[before..], |miss| &mut miss.tau);
    }

    fn near_miss(
        &self,
        target: f64,
        reach: f64,
        a: &Point,
        b: &Point,
        shape: Shape,
    ) -> Option<NearMiss> {
        if !has_extremum(a, b, shape) {
            return None;
        }
        let (extremum, curvature) = roots::extremum(&self.waves, a, b);
        let side = if a.slope > 0.0 { -1.0 } else { 1.0 };
        let beyond = side * (extremum.x - target);
        (beyond >= -self.waves.bounds().tolerance && beyond.abs() <= reach).then(|| NearMiss {
            tau: extremum.tau,
            distance: self.waves.unscaled(beyond.abs()),
            curvature: self.waves.unscaled((side * curvature).max(0.0)),
        })
    }
}

/// Takes what lies beyond the end of the period, which is last, back to its beginning.
fn into_one_period<T>(found: &mut [T], tau: impl Fn(&mut T) -> &mut f64) {
    let mut beyond = 0;
    for one in &mut *found {
        let tau = tau(one);
        if *tau >= TAU {
            *tau -= TAU;
            beyond += 1;
        }
    }
    found.rotate_right(beyond);
}

/// Slopes that are zero count as falling, at the end of one piece as at the start of the next.
fn has_extremum(a: &Point, b: &Point, shape: Shape) -> bool {
    matches!(shape, Shape::Curved | Shape::Flat) && (a.slope > 0.0) != (b.slope > 0.0)
}

struct Search<'a> {
    waves: &'a Waves,
    target: f64,
    /// The last phase that was decided, and its side.
    last: Point,
    above: bool,
    found: &'a mut Vec<Crossing>,
}

impl Search<'_> {
    fn search(&mut self, left: Point, right: Point) {
        let (waves, target) = (self.waves, self.target);
        self.visit(&left);
        let outside = |low: f64, high: f64| !(low <= target && target <= high);
        pieces(waves, left, right, outside, |a, b, shape| {
            if has_extremum(a, b, shape) && self.may_cross(a, b) {
                let (extremum, _) = roots::extremum(waves, a, b);
                self.visit(&extremum);
            }
            self.visit(b);
        });
    }

    /// The side of a phase, if it is decided.
    fn side(&self, point: &Point) -> Option<bool> {
        let distance = point.x - self.target;
        (distance.abs() > self.waves.bounds().tolerance).then_some(distance > 0.0)
    }

    /// Whether the extremum between two phases may lie on a side on which neither of them is.
    fn may_cross(&self, a: &Point, b: &Point) -> bool {
        let maximum = a.slope > 0.0;
        match (self.side(a), self.side(b)) {
            (Some(a), Some(b)) => a == b && a != maximum,
            _ => true,
        }
    }

    fn visit(&mut self, point: &Point) {
        let Some(above) = self.side(point) else {
            return;
        };
        if above != self.above {
            self.found.push(Crossing {
                tau: roots::crossing(self.waves, self.target, &self.last, point),
                rising: above,
            });
        }
        (self.last, self.above) = (*point, above);
    }
}
