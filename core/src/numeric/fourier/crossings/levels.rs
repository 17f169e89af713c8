//! The period of a series, cut wherever it crosses one of several levels.
//!
//! Each crossing is found by itself, to rounding. So two levels that nearly coincide may seem to be crossed in the wrong
//! order, and the piece after them would be wrong for as long as the next segment. Continuity decides then: a series can cross
//! a level only from the piece beside it. One piece is certain, that of the longest segment, and from there every crossing
//! that comes next is the first one that can.

use std::f64::consts::TAU;

use super::{Crossing, CrossingFinder, NearMiss};
use crate::numeric::fourier::series;

/// How far from the real axis singularities may be for a cut, as a phase: those farther away cost fewer nodes than a cut.
const NEAR: f64 = 0.15;
/// Where near misses are looked for, in parts of the size of the series' oscillation.
const REACH: f64 = 0.05;

/// The series crosses a level.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Switch {
    pub(crate) tau: f64,
    pub(crate) level: usize,
    pub(crate) rising: bool,
}

impl Switch {
    /// The piece that ends here.
    fn before(self) -> usize {
        self.level + usize::from(!self.rising)
    }

    /// The piece that begins here.
    fn after(self) -> usize {
        self.level + usize::from(self.rising)
    }
}

/// A part of the period on which the series stays on one piece: between two levels, or beyond the last.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Segment {
    /// From this phase
    pub(crate) start: f64,
    /// to this one, at most a period later.
    pub(crate) end: f64,
    /// As many levels lie below it.
    pub(crate) piece: usize,
    /// The levels that its ends are on; none where it is the whole period.
    pub(crate) levels: Option<[usize; 2]>,
}

/// Switches and segments of the series cut last; after the first calls nothing is allocated.
#[derive(Debug, Default)]
pub(crate) struct Cuts {
    found: Vec<Crossing>,
    misses: Vec<NearMiss>,
    switches: Vec<Switch>,
    segments: Vec<Segment>,
}

impl Cuts {
    /// Cuts the period of a series at levels in increasing order. The finder has sampled the series; without one there are no
    /// crossings.
    pub(crate) fn apply(
        &mut self,
        finder: Option<&CrossingFinder>,
        series: &[f64],
        levels: &[f64],
    ) {
        self.find(finder, series, levels);
        self.fill_segments(series[0], levels);
    }

    /// Finds the switches alone, as [`Cuts::apply`] does.
    pub(crate) fn find(&mut self, finder: Option<&CrossingFinder>, series: &[f64], levels: &[f64]) {
        self.switches.clear();
        for (level, &value) in levels.iter().enumerate() {
            self.found.clear();
            if let Some(finder) = finder {
                finder.crossings(value, &mut self.found);
            }
            let found = self.found.iter();
            self.switches
                .extend(found.map(|&Crossing { tau, rising }| Switch { tau, level, rising }));
        }
        self.switches
            .sort_unstable_by(|a, b| a.tau.total_cmp(&b.tau).then(a.level.cmp(&b.level)));
        let broken = |(a, b): (&Switch, &Switch)| a.after() != b.before();
        let next = self.switches.iter().cycle().skip(1);
        if self.switches.iter().zip(next).any(broken) {
            self.put_in_order(series, levels);
        }
    }

    /// Phases near which a broken power of the distance from a level needs a cut although nothing switches. Near an extremum that misses
    /// the level by a small distance `d` with curvature `c`, the power has its singularities beside the real axis, at
    /// `tau +- i sqrt(2 d / c)`. The finder has sampled the series.
    pub(crate) fn near_misses(
        &mut self,
        finder: &CrossingFinder,
        series: &[f64],
        level: f64,
    ) -> impl Iterator<Item = f64> {
        let size: f64 = series[1..].iter().map(|x| x.abs()).sum();
        self.misses.clear();
        finder.near_misses(level, REACH * size, &mut self.misses);
        let near = |miss: &&NearMiss| 2.0 * miss.distance < NEAR * NEAR * miss.curvature;
        self.misses.iter().filter(near).map(|miss| miss.tau)
    }

    pub(crate) fn switches(&self) -> &[Switch] {
        &self.switches
    }

    pub(crate) fn segments(&self) -> &[Segment] {
        &self.segments
    }

    /// Orders the crossings such that each is one that can come next; phases keep their order.
    fn put_in_order(&mut self, series: &[f64], levels: &[f64]) {
        let count = self.switches.len();
        let length = |i: usize| {
            let next = self.switches[(i + 1) % count].tau;
            (next - self.switches[i].tau).rem_euclid(TAU)
        };
        let longest = (0..count).fold(0, |a, b| if length(b) > length(a) { b } else { a });
        let middle = self.switches[longest].tau + 0.5 * length(longest);
        let value = series::value(series, middle);
        let mut piece = levels.iter().filter(|&&level| value > level).count();
        for step in 1..=count {
            let here = (longest + step) % count;
            let can_come = |&ahead: &usize| self.switches[(here + ahead) % count].before() == piece;
            let ahead = (0..=count - step).find(can_come).unwrap_or(0);
            // What was passed over comes next, at the phases that are left.
            for back in (0..ahead).rev() {
                let (a, b) = ((here + back) % count, (here + back + 1) % count);
                let (first, second) = (self.switches[a].tau, self.switches[b].tau);
                self.switches.swap(a, b);
                (self.switches[a].tau, self.switches[b].tau) = (first, second);
            }
            piece = self.switches[here].after();
        }
    }

    fn fill_segments(&mut self, mean: f64, levels: &[f64]) {
        self.segments.clear();
        let Some(&last) = self.switches.last() else {
            // It may touch a level, but its mean lies on the piece.
            self.segments.push(Segment {
                start: 0.0,
                end: TAU,
                piece: levels.iter().filter(|&&level| mean > level).count(),
                levels: None,
            });
            return;
        };
        let mut from = Switch {
            tau: last.tau - TAU,
            ..last
        };
        for &to in &self.switches {
            if to.tau > from.tau {
                self.segments.push(Segment {
                    start: from.tau,
                    end: to.tau,
                    piece: from.after(),
                    levels: Some([from.level, to.level]),
                });
            }
            from = to;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::testing::random::Random;

    /// Every segment lies on the piece that its middle says, but for rounding, and the segments make up the period.
    fn assert_right(series: &[f64], levels: &[f64]) -> usize {
        let mut finder = CrossingFinder::new(series::harmonics(series));
        finder.sample(series);
        let mut cuts = Cuts::default();
        cuts.apply(Some(&finder), series, levels);
        let size: f64 = series.iter().map(|x| x.abs()).sum();
        let rounding = 8.0 * f64::EPSILON * size;
        let mut length = 0.0;
        for segment in cuts.segments() {
            length += segment.end - segment.start;
            let value = series::value(series, 0.5 * (segment.start + segment.end));
            let low = segment.piece.checked_sub(1).map(|index| levels[index]);
            let high = levels.get(segment.piece).copied();
            assert!(
                low.is_none_or(|low| value > low - rounding)
                    && high.is_none_or(|high| value < high + rounding),
                "{value} on {segment:?}, {levels:?}, {series:?}"
            );
        }
        assert!((length - TAU).abs() < 1e-14);
        for (a, b) in cuts
            .switches()
            .iter()
            .zip(&cuts.switches()[1.min(cuts.switches().len())..])
        {
            assert!(a.tau <= b.tau && a.after() == b.before(), "{a:?} {b:?}");
        }
        cuts.switches().len()
    }

    #[test]
    fn levels_as_near_as_rounding_are_crossed_in_order() {
        let mut random = Random::seeded(11);
        let mut crossed = 0;
        for _ in 0..20_000 {
            let series: Vec<f64> = (0..7).map(|_| random.between(-1.0, 1.0)).collect();
            let level = random.between(-1.0, 1.0);
            // From the same number to some units in the last place.
            let mut levels = vec![level];
            for _ in 0..3 {
                let steps = random.between(0.0, 3.0) as u64;
                let last = *levels.last().unwrap();
                levels.push((0..steps).fold(last, |x, _| x.next_up()));
            }
            crossed += assert_right(&series, &levels);
        }
        assert!(crossed > 20_000, "{crossed}");
    }

    #[test]
    fn levels_that_are_met_at_the_end_of_the_period_are_in_order() {
        // A rise through zero at phase zero, whichever side rounding puts each crossing on.
        for phase in -20..=20 {
            let tau = f64::from(phase) * 1e-16;
            let series = [0.0, -tau.sin(), tau.cos()];
            for step in [0.0, 1e-17, 1e-16, 4e-16] {
                assert_eq!(assert_right(&series, &[0.0, step, 2.0 * step]), 6);
            }
        }
    }

    #[test]
    fn crossings_out_of_order_are_put_in_order() {
        let switch = |tau, level, rising| Switch { tau, level, rising };
        let series = [0.0, 0.0, 1.0];
        let levels = [0.0, 1e-20, 2e-20];
        // The highest level seems to be crossed first, before the end of the period.
        let mut cuts = Cuts {
            switches: vec![
                switch(0.0, 1, true),
                switch(1e-16, 0, true),
                switch(3.13, 1, false),
                switch(3.15, 0, false),
                switch(3.16, 2, false),
                switch(6.27, 2, true),
            ],
            ..Cuts::default()
        };
        cuts.put_in_order(&series, &levels);
        let order: Vec<_> = cuts.switches.iter().map(|s| (s.tau, s.level)).collect();
        assert_eq!(
            order,
            [
                (0.0, 1),
                (1e-16, 2),
                (3.13, 2),
                (3.15, 1),
                (3.16, 0),
                (6.27, 0)
            ]
        );
    }
}
