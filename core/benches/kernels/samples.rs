//! The samples that all contenders read, and the arrays that they write.

use std::f64::consts::TAU;

/// Samples in a batch.
pub const COUNT: usize = 1024;

/// Numbers in a line of the cache.
const LINE: usize = 8;
/// From one array to the next: five lines more than the samples take. With a power of two between them, every store would
/// wait for an unrelated load.
const STRIDE: usize = COUNT + 5 * LINE;

/// Inputs and outputs. Each array begins on a line of the cache, as those of a careful person would.
pub struct Samples {
    pub gap: &'static [f64],
    pub rate: &'static [f64],
    pub force: &'static mut [f64],
    pub by_gap: &'static mut [f64],
    pub by_rate: &'static mut [f64],
    pub by_argument: &'static mut [f64],
}

impl Samples {
    /// One period of an orbit, in memory that is never given back.
    pub fn new() -> Self {
        let memory = vec![0.0; 6 * STRIDE + LINE].leak();
        let start = memory.as_ptr().align_offset(LINE * size_of::<f64>());
        let mut rooms = memory[start..].chunks_exact_mut(STRIDE);
        let mut array = || &mut rooms.next().expect("six rooms")[..COUNT];
        let (gap, rate) = (array(), array());
        for i in 0..COUNT {
            let tau = TAU * i as f64 / COUNT as f64;
            gap[i] = 0.3 + 1.1 * tau.cos() + 0.2 * (2.0 * tau).sin();
            rate[i] = -1.1 * tau.sin() + 0.4 * (2.0 * tau).cos();
        }
        Self {
            gap,
            rate,
            force: array(),
            by_gap: array(),
            by_rate: array(),
            by_argument: array(),
        }
    }

    /// Forgets what was written.
    pub fn clear(&mut self) {
        for output in [
            &mut *self.force,
            self.by_gap,
            self.by_rate,
            self.by_argument,
        ] {
            output.fill(0.0);
        }
    }

    /// What was written.
    pub fn outputs(&self) -> Vec<f64> {
        [&*self.force, self.by_gap, self.by_rate, self.by_argument].concat()
    }
}
