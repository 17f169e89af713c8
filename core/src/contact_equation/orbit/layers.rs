//! An interval in closed form in layers, each as long as all before it: what has begun to ring where a contact opened or closed has decayed in most of them. A layer has grids
//! of its own, as fine as what is left of the ringing asks for.
//!
//! Source: Roos, Stynes and Tobiska (2008), Robust Numerical Methods for Singularly Perturbed Differential Equations, section I.2.4 (meshes that are finer in layers).

use std::cell::OnceCell;
use std::f64::consts::TAU;

use super::content::Content;
use super::extremes::SAMPLES;
use super::grid::Grid;
use super::motion::Motion;

/// Grids are at most so many times finer than the load asks for, as a power of two.
const FINEST: usize = 10;
/// Beyond the coarsest one they have no more samples.
const FULLEST: usize = 1 << 14;
/// The fastest that rings decays by this exponent in the first layer, where there are several.
const DECAYS: f64 = 4.0;
/// There are so many more than one at most.
const MOST: i32 = 6;
/// In parts of what the load holds a pair at, what rings by no more is left of Newton's method, as where nothing has been met.
const ROUNDING: f64 = 1e-9;
/// A layer has as many parts at least, and at most.
const FEWEST: usize = 2;
const LARGEST: f64 = 1e6;

/// Grids of a way, each twice as fine as the one before.
#[derive(Debug)]
pub(super) struct Grids {
    ends: [f64; 2],
    /// Parts of the first one.
    parts: usize,
    of: [OnceCell<Box<Grid>>; FINEST + 1],
}

impl Grids {
    pub(super) fn new(ends: [f64; 2], parts: usize) -> Self {
        Self {
            ends,
            parts,
            of: Default::default(),
        }
    }

    /// Samples that are near enough to each other for what turns so fast, by the phase.
    pub(super) fn at(&self, motion: &Motion<'_>, interval: usize, turns: f64) -> &Grid {
        let [from, to] = self.ends;
        let parts = SAMPLES * turns * (to - from) / TAU;
        let level = (parts / self.parts as f64).log2().ceil().max(0.0) as usize;
        let mut level = level.min(FINEST);
        while level > 0 && self.parts << level > FULLEST {
            level -= 1;
        }
        let made = || Grid::new(motion, interval, self.ends, self.parts << level);
        self.of[level].get_or_init(|| Box::new(made()))
    }

    /// At how many phases there are samples.
    #[cfg(test)]
    pub(super) fn count(&self) -> usize {
        let grids = self.of.iter().filter_map(OnceCell::get);
        grids.map(|grid| grid.phases.len()).sum()
    }
}

/// A part of an interval, and what is left in it of each that rings.
#[derive(Debug)]
pub(super) struct Layer {
    pub(super) grids: Grids,
    pub(super) left: Vec<f64>,
}

impl Layer {
    /// Where it begins.
    pub(super) fn begin(&self) -> f64 {
        self.grids.ends[0]
    }

    /// Those of an interval; none where nothing that rings has decayed in most of it.
    pub(super) fn of(motion: &Motion<'_>, interval: usize, content: &Content) -> Vec<Self> {
        let [from, to] = motion.phases(interval);
        let base = motion.equations.values.base;
        let moves = SAMPLES * motion.moves(interval);
        let load = &motion.values(interval).load;
        let held = |r: usize| load.iter().map(move |wave| wave.steady[2 * r][0].norm());
        let rounding = |r: usize| ROUNDING * held(r).sum::<f64>();
        let decay = content.decay(TAU * moves * base, rounding) * (to - from) / base;
        let more = (decay / DECAYS).log2().ceil().clamp(0.0, f64::from(MOST)) as i32;
        if more == 0 {
            return Vec::new();
        }
        let end = |layer: i32| from + (to - from) * 0.5_f64.powi(more - layer);
        let layer = |layer: i32| {
            let begin = if layer == 0 { from } else { end(layer - 1) };
            let end = if layer == more { to } else { end(layer) };
            let parts = (moves * (end - begin)).ceil().min(LARGEST) as usize;
            Self {
                grids: Grids::new([begin, end], parts.max(FEWEST)),
                left: content.left((begin - from) / base),
            }
        };
        (0..=more).map(layer).collect()
    }
}
