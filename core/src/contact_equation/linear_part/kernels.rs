//! Exponentials of all blocks of a linear part at one time, (1) of [`block`](super::block), as loops over arrays: a library takes one sine and one
//! exponential at a time, and many modes are asked for at many instants.
//!
//! An exponential is `2^n e^r` with `|r| <= ln 2 / 2` and the Taylor polynomial of degree 13, whose rest is below half of a unit in the last place.
//! Blocks that do not oscillate are taken one by one.
//!
//! Source: Cody and Waite (1980), Software Manual for the Elementary Functions, chapter 6 (the reduction, in two parts).

#![allow(
    clippy::inline_always,
    reason = "what is not inlined is not compiled for the instruction set of its caller"
)]

use multiversion::multiversion;

use super::block::{Block, Kernel};
use crate::numeric::fourier::kernels::LANES;
use crate::numeric::fourier::phases::sines_and_cosines;

/// Adding this leaves a whole number in the last bits.
const WHOLE: f64 = 6_755_399_441_055_744.0;
/// `ln 2` in two parts.
const LN_2: [f64; 2] = [6.931_471_803_691_238e-1, 1.908_214_929_270_587_7e-10];
/// Exponents farther from zero than this are taken for it: `e^-700` is as good as nothing, and no orbit has what grows by `e^700`.
const FARTHEST: f64 = 700.0;
/// Exponents up to which a series of degree seven has all digits.
const NEAR: f64 = 1.0 / 32.0;
/// What a series in nested form is divided by.
const PER_DEGREE: [f64; 7] = [
    1.0,
    1.0 / 2.0,
    1.0 / 3.0,
    1.0 / 4.0,
    1.0 / 5.0,
    1.0 / 6.0,
    1.0 / 7.0,
];
/// Fewer blocks are taken one by one.
const FEW: usize = 3;

/// What blocks are, as arrays of a multiple of the lanes.
#[derive(Debug, Clone, Default)]
pub(in crate::contact_equation) struct Kernels {
    means: Vec<f64>,
    roots: Vec<f64>,
    per_root: Vec<f64>,
    /// Those that do not oscillate.
    others: Vec<usize>,
}

/// Room, and what was found: `c` and `k` of every block at one time, or of one block at many.
#[derive(Debug, Clone, Default)]
pub(in crate::contact_equation) struct Found {
    angles: Vec<f64>,
    pub(in crate::contact_equation) c: Vec<f64>,
    pub(in crate::contact_equation) k: Vec<f64>,
}

impl Kernels {
    /// Of some blocks.
    pub(in crate::contact_equation) fn of(blocks: &[Block]) -> Self {
        let count = blocks.len().next_multiple_of(LANES);
        let mut kernels = Self {
            means: vec![0.0; count],
            roots: vec![0.0; count],
            per_root: vec![0.0; count],
            others: Vec::new(),
        };
        for (r, block) in blocks.iter().enumerate() {
            let root = block.turns();
            if root > 0.0 && blocks.len() > FEW {
                kernels.means[r] = block.mean();
                kernels.roots[r] = root;
                kernels.per_root[r] = 1.0 / root;
            } else {
                kernels.others.push(r);
            }
        }
        kernels
    }

    /// Finds them of the same blocks at a time.
    pub(in crate::contact_equation) fn find(&self, blocks: &[Block], s: f64, found: &mut Found) {
        let count = self.means.len();
        for room in [&mut found.angles, &mut found.c, &mut found.k] {
            room.resize(count, 0.0);
        }
        if self.others.len() < blocks.len() {
            let angles = found.angles.iter_mut().zip(&self.roots);
            angles.for_each(|(angle, root)| *angle = root * s);
            sines_and_cosines(&found.angles, &mut found.k, &mut found.c);
            decay(&self.means, &self.per_root, s, [&mut found.c, &mut found.k]);
        }
        for &r in &self.others {
            let Kernel { c, k } = blocks[r].kernel(s);
            (found.c[r], found.k[r]) = (c, k);
        }
    }
}

impl Found {
    /// Finds those of one block at parts of a time, in the order of these.
    pub(in crate::contact_equation) fn find(&mut self, block: &Block, parts: &[f64], time: f64) {
        let count = parts.len().next_multiple_of(LANES);
        for room in [&mut self.angles, &mut self.c, &mut self.k] {
            room.resize(count, 0.0);
        }
        let root = block.turns();
        if root == 0.0 {
            for ((part, c), k) in parts.iter().zip(&mut self.c).zip(&mut self.k) {
                let kernel = block.kernel(part * time);
                (*c, *k) = (kernel.c, kernel.k);
            }
            return;
        }
        for (angle, part) in self.angles.iter_mut().zip(parts) {
            *angle = root * (part * time);
        }
        sines_and_cosines(&self.angles, &mut self.k, &mut self.c);
        let factors = [block.mean() / root, 1.0 / root];
        let farthest = parts
            .iter()
            .fold(0.0, |most: f64, part| most.max(part.abs()));
        let tables = [&mut self.c[..], &mut self.k[..]];
        if (block.mean() * time).abs() * farthest <= NEAR {
            decay_little(&self.angles, factors, tables);
        } else {
            decay_by_angle(&self.angles, factors, tables);
        }
    }

    /// That of a block.
    pub(in crate::contact_equation) fn kernel(&self, r: usize) -> Kernel {
        Kernel {
            c: self.c[r],
            k: self.k[r],
        }
    }
}

/// Cosines times what decays, and sines times that over their roots.
#[multiversion(targets("x86_64+avx512f", "x86_64+avx2"))]
fn decay(means: &[f64], per_root: &[f64], s: f64, [c, k]: [&mut [f64]; 2]) {
    let (means, _) = means.as_chunks::<LANES>();
    let (per_root, _) = per_root.as_chunks::<LANES>();
    let (c, _) = c.as_chunks_mut::<LANES>();
    let (k, _) = k.as_chunks_mut::<LANES>();
    for (((means, per_root), c), k) in means.iter().zip(per_root).zip(c).zip(k) {
        let decay = powers(&means.map(|mean| mean * s));
        for j in 0..LANES {
            c[j] *= decay[j];
            k[j] *= decay[j] * per_root[j];
        }
    }
}

/// The same of one block at many angles, with its mean and one in parts of its root.
#[multiversion(targets("x86_64+avx512f", "x86_64+avx2"))]
fn decay_by_angle(angles: &[f64], [mean, per_root]: [f64; 2], [c, k]: [&mut [f64]; 2]) {
    let (angles, _) = angles.as_chunks::<LANES>();
    let (c, _) = c.as_chunks_mut::<LANES>();
    let (k, _) = k.as_chunks_mut::<LANES>();
    for ((angles, c), k) in angles.iter().zip(c).zip(k) {
        let decay = powers(&angles.map(|angle| mean * angle));
        for j in 0..LANES {
            c[j] *= decay[j];
            k[j] *= decay[j] * per_root;
        }
    }
}

/// The same where exponents are near zero.
#[multiversion(targets("x86_64+avx512f", "x86_64+avx2"))]
fn decay_little(angles: &[f64], [mean, per_root]: [f64; 2], [c, k]: [&mut [f64]; 2]) {
    let (angles, _) = angles.as_chunks::<LANES>();
    let (c, _) = c.as_chunks_mut::<LANES>();
    let (k, _) = k.as_chunks_mut::<LANES>();
    for ((angles, c), k) in angles.iter().zip(c).zip(k) {
        let x = angles.map(|angle| mean * angle);
        let mut decay = [1.0; LANES];
        for per in PER_DEGREE.into_iter().rev() {
            decay = lanes(|j| 1.0 + x[j] * per * decay[j]);
        }
        for j in 0..LANES {
            c[j] *= decay[j];
            k[j] *= decay[j] * per_root;
        }
    }
}

/// `e^x` of all lanes.
#[inline(always)]
fn powers<const S: usize>(x: &[f64; S]) -> [f64; S] {
    let x = x.map(|x| x.clamp(-FARTHEST, FARTHEST));
    let shifted = x.map(|x| x * std::f64::consts::LOG2_E + WHOLE);
    let r: [f64; S] = lanes(|j| {
        let n = shifted[j] - WHOLE;
        (x[j] - n * LN_2[0]) - n * LN_2[1]
    });
    let scale = shifted.map(|x| f64::from_bits(x.to_bits().wrapping_add(1023) << 52));
    let powers = exponentials(&r);
    lanes(|j| powers[j] * scale[j])
}

/// `e^r` of all lanes by its series. Each sum is taken of all lanes before the next one, so that these are what instructions work on at once.
#[inline(always)]
fn exponentials<const S: usize>(r: &[f64; S]) -> [f64; S] {
    const PER: [f64; 14] = [
        1.0,
        1.0,
        1.0 / 2.0,
        1.0 / 6.0,
        1.0 / 24.0,
        1.0 / 120.0,
        1.0 / 720.0,
        1.0 / 5040.0,
        1.0 / 40_320.0,
        1.0 / 362_880.0,
        1.0 / 3_628_800.0,
        1.0 / 39_916_800.0,
        1.0 / 479_001_600.0,
        1.0 / 6_227_020_800.0,
    ];
    let square = r.map(|r| r * r);
    let pair = |k: usize| r.map(|r| PER[k] + r * PER[k + 1]);
    let next = |low: [f64; S], high: [f64; S]| lanes(|j| low[j] + square[j] * high[j]);
    let high = next(pair(8), next(pair(10), pair(12)));
    let low = next(pair(0), next(pair(2), next(pair(4), pair(6))));
    let fourth = square.map(|square| square * square);
    lanes(|j| low[j] + fourth[j] * fourth[j] * high[j])
}

/// One number for each lane.
#[inline(always)]
fn lanes<const S: usize>(of: impl Fn(usize) -> f64) -> [f64; S] {
    std::array::from_fn(of)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn all_at_once_are_those_one_by_one() {
        let mut blocks: Vec<Block> = (0..13)
            .map(|r| {
                let w = 1.3_f64.powi(3 * r);
                Block::new([[0.0, 1.0], [-w * w, -0.02 * w]])
            })
            .collect();
        blocks.push(Block::new([[0.0, 1.0], [0.0, 0.0]]));
        blocks.push(Block::new([[-0.3, 2.0], [-2.0, -0.3]]));
        blocks.push(Block::new([[0.0, 1.0], [-1.0, 0.2]]));
        blocks.push(Block::new([[0.0, 1.0], [-1.0, -7.0]]));
        let kernels = Kernels::of(&blocks);
        let mut found = Found::default();
        for s in [-0.7, 0.0, 1e-9, 0.01, 0.8, 3.0, 40.0] {
            kernels.find(&blocks, s, &mut found);
            for (r, block) in blocks.iter().enumerate() {
                let exact = block.kernel(s);
                let size = exact.c.hypot(block.turns() * exact.k);
                // An angle is known to rounding.
                let within = 4.0 * f64::EPSILON * size * (1.0 + block.rate() * s.abs()) + 1e-300;
                assert!((found.c[r] - exact.c).abs() <= within, "{r} {s}");
                let k = (found.k[r] - exact.k).abs();
                assert!(k <= 4.0 * f64::EPSILON * exact.k.abs() || k * block.turns() <= within);
            }
        }
        let parts = [0.0, 0.11, -0.3, 0.5, 1.0];
        let mut others = Found::default();
        for block in &blocks {
            found.find(block, &parts, 0.7);
            for (place, part) in parts.iter().enumerate() {
                kernels.find(&blocks, part * 0.7, &mut others);
                let r = blocks.iter().position(|of| of == block).unwrap();
                let [one, all] = [found.kernel(place), others.kernel(r)];
                let size = all.c.hypot(block.turns() * all.k);
                let within = 4.0 * f64::EPSILON * size * (1.0 + block.rate());
                assert!((one.c - all.c).abs() <= within, "{r} {part}");
                assert!(
                    (one.k - all.k).abs() * block.turns() <= within,
                    "{r} {part}"
                );
            }
        }
    }
}
