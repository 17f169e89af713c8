//! Samples of a signal in pieces, each with what rings in it and with how far its samples go, block by block of ways between two samples: most blocks are far from the largest
//! value, and are left without a look at their samples.
//!
//! Source: Land and Doig (1960), An automatic method of solving discrete programming problems, Econometrica 28 (bounds).

#![allow(
    clippy::inline_always,
    reason = "what is not inlined is not compiled for the instruction set of its caller"
)]

use multiversion::multiversion;

use super::content::{Fast, Ripples, unless_rounding};
use super::extremes::Samples;
use super::signal::{Look, Signal};
use crate::numeric::linear::LANES;
use crate::numeric::roots::Place;

/// Ways of which it is known together how far they go.
pub(super) const TOGETHER: usize = 32;

/// Two samples beside each other.
#[derive(Debug, Clone, Copy)]
pub(super) struct Way {
    /// Place among the signals, and among the pieces of one.
    pub(super) part: usize,
    pub(super) piece: usize,
    pub(super) ends: [Look; 2],
}

/// A signal on an interval, and its samples piece by piece.
pub(super) struct Part<'m, 'e> {
    pub(super) signal: Signal<'m, 'e>,
    pub(super) pieces: Vec<Piece<'m>>,
}

impl Part<'_, '_> {
    pub(super) fn ripples(&self, piece: usize) -> &Ripples {
        let own = self.pieces[piece].ripples.as_ref();
        own.unwrap_or_else(|| self.signal.ripples())
    }

    /// What rings too fast for samples that are so far apart, while a piece lasts.
    pub(super) fn fast(&self, piece: usize, time: f64) -> Fast {
        self.ripples(piece).fast(time, self.signal.size)
    }

    /// The same in a way, from its beginning on.
    pub(super) fn fast_in(&self, way: &Way, time: f64) -> Fast {
        let begin = self.pieces[way.piece].begin;
        let later = (way.ends[0].x - begin) / self.signal.base();
        unless_rounding(self.fast(way.piece, time).after(later), self.signal.size)
    }
}

/// Samples from a phase on, and what rings then if that is not what rings where the interval begins.
pub(super) struct Piece<'m> {
    pub(super) samples: Samples<'m>,
    pub(super) ripples: Option<Ripples>,
    pub(super) begin: f64,
    /// What there is at most in every so many ways.
    pub(super) most: Vec<Most>,
}

impl<'m> Piece<'m> {
    pub(super) fn new(samples: Samples<'m>, ripples: Option<Ripples>, begin: f64) -> Self {
        Self {
            most: most(&samples.values, &samples.rates),
            samples,
            ripples,
            begin,
        }
    }

    /// The samples that are lowest and highest.
    pub(super) fn ends(&self) -> [Place; 2] {
        [-1.0, 1.0].map(|sign| {
            let farther = |a: &Most, b: &Most| a.highest(sign).total_cmp(&b.highest(sign));
            let places = 0..self.most.len();
            let block = places.max_by(|a, b| farther(&self.most[*a], &self.most[*b]));
            let first = block.unwrap_or(0) * TOGETHER;
            let last = (first + TOGETHER).min(self.samples.values.len() - 1);
            let of = |place: &usize| sign * self.samples.values[*place];
            let place = (first..=last).max_by(|a, b| of(a).total_cmp(&of(b)));
            let place = place.unwrap_or(first);
            Place {
                x: self.samples.phases[place],
                value: self.samples.values[place],
            }
        })
    }
}

/// The lowest and the highest sample at the ends of some ways, and the largest rate.
#[derive(Debug, Clone, Copy)]
pub(super) struct Most {
    ends: [f64; 2],
    pub(super) rate: f64,
}

impl Most {
    /// Of values with a sign.
    pub(super) fn highest(&self, sign: f64) -> f64 {
        if sign > 0.0 {
            self.ends[1]
        } else {
            -self.ends[0]
        }
    }
}

#[inline(always)]
fn less(a: f64, b: f64) -> f64 {
    if a < b { a } else { b }
}

/// What there is at most in every so many ways.
#[multiversion(targets("x86_64+avx512f", "x86_64+avx2"))]
fn most(values: &[f64], rates: &[f64]) -> Vec<Most> {
    let ways = values.len() - 1;
    let blocks = (0..ways).step_by(TOGETHER).map(|first| {
        let last = (first + TOGETHER).min(ways);
        let of = [values, rates].map(|of| of[first..=last].as_chunks::<LANES>());
        let [(values, others), (rates, other_rates)] = of;
        let (mut low, mut high) = ([f64::INFINITY; LANES], [f64::NEG_INFINITY; LANES]);
        let mut steep = [0.0; LANES];
        for (value, rate) in values.iter().zip(rates) {
            for l in 0..LANES {
                low[l] = less(value[l], low[l]);
                high[l] = -less(-value[l], -high[l]);
                steep[l] = -less(-rate[l].abs(), -steep[l]);
            }
        }
        let low = low
            .iter()
            .chain(others)
            .fold(f64::INFINITY, |m, x| less(*x, m));
        let high = high
            .iter()
            .chain(others)
            .fold(f64::INFINITY, |m, x| less(-x, m));
        let steep = steep
            .iter()
            .chain(other_rates)
            .fold(0.0, |m, x| less(-x.abs(), m));
        Most {
            ends: [low, -high],
            rate: -steep,
        }
    });
    blocks.collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn blocks_are_as_far_as_the_farthest_of_their_samples() {
        for count in [2, 7, 33, 34, 100] {
            let value = |i: usize| ((7 * i) % 23) as f64 - 11.0;
            let rate = |i: usize| ((5 * i) % 17) as f64 - 12.0;
            let values: Vec<f64> = (0..count).map(value).collect();
            let rates: Vec<f64> = (0..count).map(rate).collect();
            let found = most(&values, &rates);
            assert_eq!(found.len(), (count - 1).div_ceil(TOGETHER));
            for (block, found) in found.iter().enumerate() {
                let first = block * TOGETHER;
                let last = (first + TOGETHER).min(count - 1);
                let of = |of: &dyn Fn(usize) -> f64| (first..=last).map(of).fold(-1e9, f64::max);
                assert_eq!(found.highest(1.0), of(&value));
                assert_eq!(found.highest(-1.0), of(&|i| -value(i)));
                assert_eq!(found.rate, of(&|i| rate(i).abs()));
            }
        }
    }
}
