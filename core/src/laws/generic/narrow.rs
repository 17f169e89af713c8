//! Narrow places of a law: where it changes within a distance far smaller than a motion.
//!
//! They are looked for along a way: through a range of gaps at rest, or along a motion, on which rates count as much as gaps do.
//!
//! | function | its narrow places are where |
//! |---|---|
//! | `tanh u` | `u` changes its sign |
//! | `exp u` | `u` changes its sign, beside which `exp u` is neither nothing nor all, or is largest, unless `exp u` is nothing there |
//! | a power of `u` that is no whole positive one | `abs u` is least |
//!
//! How narrow is told by samples at the place and beside it: the farthest of them that are still close enough, as
//! [`Scales`] say it. Where the slope itself jumps or ends there is no width, and a level is what says so.

use super::scales::{Kind, Scales, Sight, VANISHED};
use crate::numeric::roots::{Place, root};

/// Operands are sampled at so many gaps of a range, and about each place found at so many, so often.
const SAMPLES: usize = 64;
const CLOSER: usize = 8;
const TIMES: usize = 12;
/// Accuracy of where an operand changes its sign, in parts of the way. A place narrower than this has no width.
const NARROWEST: f64 = 1e-9;
/// Places that are apart by less than this part of their width are one.
const SAME: f64 = 0.1;

/// A place where a law changes fast.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Narrow {
    /// The gap, or the place on a way.
    pub(crate) at: f64,
    /// From here to where the law has changed by a part of itself.
    pub(crate) width: f64,
}

/// Widths on each side of a place that belong to it, and those that a step of a branch may go through, of both together.
const BESIDE: f64 = 2.0;
const STEP: f64 = 1.5;

impl Narrow {
    /// Whether a step of a branch in which an extreme of the gap moves from one value to another goes through more of the place than it may. In widths
    /// from the place, at `s_0` before it and `s_1` behind it, it goes through
    ///
    /// ```text
    /// min(max(s_0, s_1), 2) - max(min(s_0, s_1), -2)
    /// ```
    pub(crate) fn is_leapt_over(&self, [from, to]: [f64; 2]) -> bool {
        let [a, b] = [from, to].map(|gap| (gap - self.at) / self.width);
        a.max(b).min(BESIDE) - a.min(b).max(-BESIDE) > STEP
    }
}

/// A way on one piece, and how it is looked at.
#[derive(Clone, Copy)]
pub(crate) struct Way<'w> {
    /// Gap and rate at a place.
    pub(crate) at: &'w dyn Fn(f64) -> [f64; 2],
    /// From place to place.
    pub(crate) range: [f64; 2],
    /// So many parts of it are looked at.
    pub(crate) parts: usize,
    /// What is as wide as this is not narrow.
    pub(crate) widest: f64,
}

/// Samples of a way.
#[derive(Debug, Default)]
pub(crate) struct Samples {
    pub(crate) places: Vec<f64>,
    pub(crate) gaps: Vec<f64>,
    pub(crate) rates: Vec<f64>,
}

/// What marks a place.
#[derive(Debug, Clone, Copy)]
enum Mark {
    /// The operand changes its sign.
    Passes,
    /// It, or its opposite, is largest here.
    Peak(f64),
}

impl Scales {
    /// Whether the law may have narrow places, for the arguments at hand.
    pub(crate) fn may_be_narrow(&self) -> bool {
        (0..self.pieces()).any(|piece| {
            let mut features = 0..self.features(piece);
            features.any(|at| self.is_sharp(piece, at) && !marks(self.kind(piece, at)).is_empty())
        })
    }

    /// Adds the narrow places in a range of gaps, at rest, to others of the same law.
    pub(crate) fn narrow(&mut self, [low, high]: [f64; 2], to: &mut Vec<Narrow>) {
        for piece in 0..self.pieces() {
            let [below, above] = [0, 1].map(|side| self.level(piece, side));
            let range = [
                below.map_or(low, |level| level.max(low)),
                above.map_or(high, |level| level.min(high)),
            ];
            let way = Way {
                at: &|gap| [gap, 0.0],
                range,
                parts: SAMPLES,
                widest: range[1] - range[0],
            };
            self.narrow_along(piece, way, to);
        }
    }

    /// Adds the narrow places of a piece along a way to others on it.
    pub(crate) fn narrow_along(&mut self, piece: usize, way: Way<'_>, to: &mut Vec<Narrow>) {
        let length = way.range[1] - way.range[0];
        // Not a number is no range either.
        let is_range = length > 0.0 && length.is_finite();
        if !is_range {
            return;
        }
        let samples = way.samples(way.range, way.parts);
        for feature in 0..self.features(piece) {
            if !self.is_sharp(piece, feature) {
                continue;
            }
            for &mark in marks(self.kind(piece, feature)) {
                let sought = Sought {
                    piece,
                    feature,
                    mark,
                };
                self.marked(sought, way, &samples, to);
            }
        }
    }

    /// The narrow places of a function that have a mark.
    fn marked(&mut self, sought: Sought, way: Way<'_>, samples: &Samples, to: &mut Vec<Narrow>) {
        let Sought {
            piece,
            feature,
            mark,
        } = sought;
        let values = self.operand(piece, feature, &samples.gaps, &samples.rates);
        let places = &samples.places;
        let last = places.len() - 1;
        for j in (1..=last).filter(|&j| mark.is_at(&values, j)) {
            let at = match mark {
                Mark::Passes => {
                    let ends = [j - 1, j].map(|j| Place {
                        x: places[j],
                        value: values[j],
                    });
                    self.passage(sought, way, ends)
                }
                Mark::Peak(_) => {
                    let near = [places[j - 1], places[(j + 1).min(last)]];
                    self.peak(sought, way, near)
                }
            };
            let [gap, rate] = (way.at)(at);
            let nothing = self.kind(piece, feature) == Kind::Grows
                && self.operand(piece, feature, &[gap], &[rate])[0] <= -VANISHED;
            let same = |other: &Narrow| (other.at - at).abs() <= SAME * other.width;
            if nothing || to.iter().any(same) {
                continue;
            }
            if let Some(width) = self.width(piece, at, way) {
                to.push(Narrow { at, width });
            }
        }
    }

    /// Where an operand changes its sign, between two places.
    fn passage(&mut self, sought: Sought, way: Way<'_>, [a, b]: [Place; 2]) -> f64 {
        let within = NARROWEST * (way.range[1] - way.range[0]);
        let operand = |place: f64| {
            let [gap, rate] = (way.at)(place);
            self.operand(sought.piece, sought.feature, &[gap], &[rate])[0]
        };
        root(a, b, within, operand).unwrap_or(0.5 * (a.x + b.x))
    }

    /// Where it, or its opposite, is largest, between two places.
    fn peak(&mut self, sought: Sought, way: Way<'_>, mut near: [f64; 2]) -> f64 {
        for _ in 0..TIMES {
            let samples = way.samples(near, CLOSER);
            let values = self.operand(sought.piece, sought.feature, &samples.gaps, &samples.rates);
            let Some(place) = (1..=CLOSER).find(|&j| sought.mark.is_at(&values, j)) else {
                // As near as rounding tells.
                break;
            };
            let places = &samples.places;
            near = [places[place - 1], places[(place + 1).min(CLOSER)]];
        }
        0.5 * (near[0] + near[1])
    }

    /// How far samples about a place may be from it, if that is narrow.
    fn width(&mut self, piece: usize, at: f64, way: Way<'_>) -> Option<f64> {
        let narrowest = NARROWEST * (way.range[1] - way.range[0]);
        let mut width = way.widest;
        while width > narrowest {
            let beside = [at - width, at, at + width].map(way.at);
            let [gaps, rates] = [0, 1].map(|which| beside.map(|of| of[which]));
            if self.look(piece, &gaps, &rates, 1.0) == Sight::Clear {
                return (width < way.widest).then_some(width);
            }
            width *= 0.5;
        }
        None
    }
}

/// What is looked for.
#[derive(Debug, Clone, Copy)]
struct Sought {
    piece: usize,
    feature: usize,
    mark: Mark,
}

impl Way<'_> {
    /// From one place to another, with so many parts between them.
    fn samples(&self, [from, to]: [f64; 2], parts: usize) -> Samples {
        let mut samples = Samples::default();
        for j in 0..=parts {
            let place = from + (to - from) * (j as f64 / parts as f64);
            samples.push(place, (self.at)(place));
        }
        samples
    }
}

impl Samples {
    pub(crate) fn clear(&mut self) {
        self.places.clear();
        self.gaps.clear();
        self.rates.clear();
    }

    pub(crate) fn push(&mut self, place: f64, [gap, rate]: [f64; 2]) {
        self.places.push(place);
        self.gaps.push(gap);
        self.rates.push(rate);
    }
}

impl Mark {
    /// Whether it is at a sample, or between it and the one before.
    fn is_at(self, values: &[f64], j: usize) -> bool {
        let [a, b] = [values[j - 1], values[j]];
        match self {
            Self::Passes => a * b < 0.0 || (b == 0.0 && a != 0.0),
            Self::Peak(sign) => {
                let next = values.get(j + 1).copied().unwrap_or(f64::NAN);
                sign * a < sign * b && sign * b >= sign * next
            }
        }
    }
}

/// What marks the narrow places of a function.
fn marks(kind: Kind) -> &'static [Mark] {
    match kind {
        Kind::Saturates => &[Mark::Passes],
        Kind::Grows => &[Mark::Passes, Mark::Peak(1.0)],
        Kind::Base => &[Mark::Peak(-1.0)],
        Kind::Oscillates | Kind::Bends => &[],
    }
}

#[cfg(test)]
mod tests {
    use std::f64::consts::TAU;

    use super::*;
    use crate::system::System;

    crate::oscillator! {
        Narrows(x) {
            law friction(gap) { tanh(dot(gap)/0.001) }
            law both(gap) { 1/(1 + ((gap + dot(gap))/0.001)^2) }
            ddot(x) + x + friction(x) + both(x) = cos(omega*t);
        }
    }

    /// The places of a law along circles of gap and rate, from the top on.
    fn along_circle(law: usize, radius: f64) -> Vec<Narrow> {
        let system = Narrows {};
        let mut scales = Scales::of(system.law(law)).unwrap();
        scales.set(&[], &[]);
        let at = |turn: f64| {
            let (sine, cosine) = (TAU * turn).sin_cos();
            [radius * cosine, -radius * sine]
        };
        let way = Way {
            at: &at,
            range: [0.05, 0.99],
            parts: 64,
            widest: 0.02,
        };
        let mut found = Vec::new();
        scales.narrow_along(0, way, &mut found);
        found.sort_by(|a, b| a.at.total_cmp(&b.at));
        found
    }

    /// `dot(gap) = 0` half a turn on, and `gap + dot(gap) = 0` after an eighth and five of them: that passes at `2^(1/2)` of the speed.
    #[test]
    fn places_along_a_motion_are_those_of_gap_and_rate() {
        for radius in [1.0, 30.0, 1e3] {
            let width = 0.001 / (TAU * radius);
            let [rate] = along_circle(0, radius)[..] else {
                panic!("{radius}");
            };
            assert!((rate.at - 0.5).abs() < 1e-8, "{rate:?}");
            assert!(rate.width <= 1.01 * width && rate.width > 0.49 * width);
            let [first, last] = along_circle(1, radius)[..] else {
                panic!("{radius}");
            };
            for (place, at) in [(first, 0.125), (last, 0.625)] {
                assert!((place.at - at).abs() < 0.1 * width, "{place:?}");
                assert!(place.width < width && place.width > 0.1 * width);
            }
        }
    }

    /// Slow motions are seen as they are.
    #[test]
    fn places_that_are_wide_along_a_motion_are_none() {
        assert_eq!(along_circle(0, 1e-4), []);
    }

    #[test]
    fn steps_are_told_by_the_widths_that_they_go_through() {
        let place = Narrow {
            at: 1.0,
            width: 0.1,
        };
        let leapt = |from, to| place.is_leapt_over([from, to]);
        assert!(leapt(-5.0, 5.0) && leapt(5.0, -5.0));
        assert!(leapt(0.85, 1.05) && leapt(1.05, 0.85));
        // Up to the place, within it, and far from it.
        assert!(!leapt(-5.0, 0.94) && !leapt(0.95, 1.09) && !leapt(1.2, 7.0));
        assert!(!leapt(f64::NAN, 1.0));
    }
}
