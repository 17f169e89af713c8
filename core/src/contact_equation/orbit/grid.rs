//! What moves on an interval without forces at nodes, on an even grid of it: of every pair of states what it does by itself, of every wave the angle. A signal there is a sum of
//! rows of these, with no exponential of its own. With `e^(A h)` for steps of twice as many each, of `n` samples,
//!
//! ```text
//! y(t_(k + m)) = e^(A m h) y(t_k),    k < m,    m = 1, 2, 4, ..                                                (1)
//! ```
//!
//! so that a sample has the rounding of `log2 n` products. Pairs are followed when a signal sees them.
//!
//! Source: Moler and Van Loan (2003), Nineteen Dubious Ways to Compute the Exponential of a Matrix, Twenty-Five Years Later, method 3 (powers by squares).

use std::cell::OnceCell;

use super::motion::Motion;
use crate::contact_equation::linear_part::block::{Block, Pair, Square, add_both};
use crate::contact_equation::linear_part::linear::Seen;
use crate::contact_equation::linear_part::values::{pair, turn};

/// Samples at even distances.
#[derive(Debug)]
pub(super) struct Grid {
    pub(super) phases: Vec<f64>,
    /// Cosines and sines of every wave that is not in resonance.
    waves: Vec<[Vec<f64>; 2]>,
    pairs: Vec<OnceCell<[Vec<f64>; 2]>>,
}

impl Grid {
    /// Of so many parts.
    pub(super) fn new(motion: &Motion<'_>, interval: usize, parts: usize) -> Self {
        let [from, to] = motion.phases(interval);
        let values = motion.values(interval);
        let phase = |sample: usize| from + (to - from) * (sample as f64 / parts as f64);
        let phases: Vec<f64> = (0..=parts).map(phase).collect();
        let waves = values.load.iter().filter(|wave| !wave.is_resonant());
        let waves = waves.map(|wave| {
            let step = wave.harmonic * (to - from) / parts as f64;
            let begin = turn(wave.harmonic * from);
            let turned = |m: usize| {
                let turned = turn(step * m as f64);
                [[turned.re, -turned.im], [turned.im, turned.re]]
            };
            doubled([begin.re, begin.im], parts, turned)
        });
        Self {
            waves: waves.collect(),
            pairs: (0..values.linear.blocks.len())
                .map(|_| OnceCell::new())
                .collect(),
            phases,
        }
    }

    /// Adds what a wave of this amplitude is, and its rate where it turns so fast.
    pub(super) fn add_wave(
        &self,
        wave: usize,
        [re, im]: [f64; 2],
        turns: f64,
        [values, rates]: [&mut [f64]; 2],
    ) {
        let [cosines, sines] = &self.waves[wave];
        add_both([cosines, sines], [re, -im], values);
        add_both([cosines, sines], [-turns * im, -turns * re], rates);
    }

    /// Adds what a row sees of a pair.
    pub(super) fn add_pair(
        &self,
        motion: &Motion<'_>,
        interval: usize,
        seen: &Seen,
        [values, rates]: [&mut [f64]; 2],
    ) {
        let [first, second] = self.pairs[seen.block].get_or_init(|| {
            let [from, to] = motion.phases(interval);
            let of = motion.values(interval);
            let block: &Block = &of.linear.blocks[seen.block];
            let parts = self.phases.len() - 1;
            let step = (to - from) / of.base / parts as f64;
            let free = pair(&motion.equations.passed[interval].free, seen.block);
            doubled(free, parts, |m| block.exponential(step * m as f64))
        });
        add_both([first, second], seen.position, values);
        add_both([first, second], seen.rate, rates);
    }
}

/// (1)
fn doubled(begin: Pair, parts: usize, power: impl Fn(usize) -> Square) -> [Vec<f64>; 2] {
    let mut both = begin.map(|x| {
        let mut of = vec![0.0; parts + 1];
        of[0] = x;
        of
    });
    let mut known = 1;
    while known <= parts {
        let more = known.min(parts + 1 - known);
        let by = power(known);
        let [first, second] = &mut both;
        let (first, first_next) = first.split_at_mut(known);
        let (second, second_next) = second.split_at_mut(known);
        let known_ones = [&first[..more], &second[..more]];
        add_both(known_ones, by[0], &mut first_next[..more]);
        add_both(known_ones, by[1], &mut second_next[..more]);
        known += more;
    }
    both
}
