//! Narrow places of a law: gaps about which it changes within a distance far smaller than a motion.
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

/// Operands are sampled at so many gaps of a range, and about each place found at so many, so often.
const SAMPLES: usize = 64;
const CLOSER: usize = 8;
const TIMES: usize = 12;
/// A place wider than the range is none, and one narrower than this part of it has no width.
const NARROWEST: f64 = 1e-9;
/// Places that are apart by less than this part of their width are one.
const SAME: f64 = 0.1;

/// A place where a law changes fast.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Narrow {
    /// The gap.
    pub(crate) at: f64,
    /// From here to where the law has changed by a part of itself.
    pub(crate) width: f64,
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
            let length = range[1] - range[0];
            // Not a number is no range either.
            let is_range = length > 0.0 && length.is_finite();
            if !is_range {
                continue;
            }
            for feature in 0..self.features(piece) {
                if !self.is_sharp(piece, feature) {
                    continue;
                }
                for &mark in marks(self.kind(piece, feature)) {
                    self.marked(piece, feature, mark, range, to);
                }
            }
        }
    }

    /// The narrow places of a function that have a mark.
    fn marked(
        &mut self,
        piece: usize,
        feature: usize,
        mark: Mark,
        range: [f64; 2],
        to: &mut Vec<Narrow>,
    ) {
        let samples = samples(range, SAMPLES);
        let values = self.operand(piece, feature, &samples);
        for j in (1..=SAMPLES).filter(|&j| mark.is_at(&values, j)) {
            let near = [samples[j - 1], samples[(j + 1).min(SAMPLES)]];
            let at = self.closer(piece, feature, near, mark);
            let nothing = self.kind(piece, feature) == Kind::Grows
                && self.operand(piece, feature, &[at])[0] <= -VANISHED;
            let same = |other: &Narrow| (other.at - at).abs() <= SAME * other.width;
            if nothing || to.iter().any(same) {
                continue;
            }
            if let Some(width) = self.width(piece, at, range[1] - range[0]) {
                to.push(Narrow { at, width });
            }
        }
    }

    /// Where a mark is, between two gaps.
    fn closer(&mut self, piece: usize, feature: usize, mut near: [f64; 2], mark: Mark) -> f64 {
        for _ in 0..TIMES {
            let samples = samples(near, CLOSER);
            let values = self.operand(piece, feature, &samples);
            let Some(place) = (1..=CLOSER).find(|&j| mark.is_at(&values, j)) else {
                // As near as rounding tells.
                break;
            };
            near = [samples[place - 1], samples[(place + 1).min(CLOSER)]];
        }
        0.5 * (near[0] + near[1])
    }

    /// How far samples about a place may be from it, if that is less than the length of a range.
    fn width(&mut self, piece: usize, at: f64, length: f64) -> Option<f64> {
        let mut width = length;
        while width > NARROWEST * length {
            let gap = [at - width, at, at + width];
            if self.look(piece, &gap, &[0.0; 3], 1.0) == Sight::Clear {
                return (width < length).then_some(width);
            }
            width *= 0.5;
        }
        None
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

/// Gaps from one to another, with so many parts between them.
fn samples([from, to]: [f64; 2], parts: usize) -> Vec<f64> {
    let part = |j: usize| j as f64 / parts as f64;
    (0..=parts).map(|j| from + (to - from) * part(j)).collect()
}
