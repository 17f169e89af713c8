//! The first end of a piece that a motion meets, within the range of its table.
//!
//! An interval of length `l` with distances `a, b >= 0` at its ends and `|d''| <= 2 c` in it holds no zero if
//!
//! ```text
//! a (1 - s) + b s - c l^2 s (1 - s) > 0  for  0 < s < 1,    for which  a + b > c l^2  suffices                (1)
//! ```
//!
//! also if `a = 0` because the motion begins at the level. The other cells are searched one by one, see
//! [`crossing`](super::crossing).

use super::crossing::first_zero;
use super::table::{ExitLevel, Table};

/// Cells of the largest table, and one more.
const ENDS: usize = 17;

/// An end of a piece is met.
#[derive(Debug, Clone, Copy)]
pub(super) struct Hit {
    /// Which of the exit levels.
    pub(super) exit: usize,
    /// When, in cells.
    pub(super) at: f64,
}

impl Table {
    /// The first end of a piece that is met within a range, in cells. `begins` tells of an exit level whether the motion begins at it.
    pub(super) fn first_hit(
        &self,
        z: &[f64],
        range: f64,
        begins: impl Fn(&ExitLevel) -> bool,
    ) -> Option<Hit> {
        let mut first = None;
        let mut range = range;
        for (index, exit) in self.exits.iter().enumerate() {
            let found = self.first_meeting(exit, z, range, begins(exit));
            if let Some(at) = found.filter(|&at| first.is_none() || at < range) {
                first = Some(Hit { exit: index, at });
                range = at;
            }
        }
        first
    }

    fn first_meeting(&self, exit: &ExitLevel, z: &[f64], range: f64, begins: bool) -> Option<f64> {
        let width = self.cells + 1;
        let mut ends = [0.0; ENDS];
        for (column, factor) in exit.ends.chunks_exact(width).zip(z) {
            for (end, x) in ends.iter_mut().zip(column) {
                *end += x * factor;
            }
        }
        if begins {
            ends[0] = 0.0;
        }
        let sizes = exit.bound.iter().zip(z);
        let curved = 0.5 * sizes.map(|(bound, x)| bound * x.abs()).sum::<f64>();
        for cell in 0..self.cells {
            let (from, bound) = if cell == 0 {
                (0.0, 0.25 * curved)
            } else {
                (-0.5, curved)
            };
            let middle = cell as f64;
            if middle + from >= range {
                break;
            }
            let (a, b) = (ends[cell], ends[cell + 1]);
            if a >= 0.0 && b > 0.0 && a + b > bound {
                continue;
            }
            let distance = self.distance(exit, cell, z);
            let to = (range - middle).min(0.5);
            let noise = self.noise(exit, z, cell);
            let found = first_zero(&distance, from, to, begins && cell == 0, noise);
            if let Some(s) = found {
                return Some(middle + s);
            }
        }
        None
    }

    /// The rounding error of a distance in a cell.
    fn noise(&self, exit: &ExitLevel, z: &[f64], cell: usize) -> f64 {
        let columns = exit.ends.chunks_exact(self.cells + 1).zip(z);
        let sizes =
            columns.map(|(column, x)| (column[cell].abs() + column[cell + 1].abs()) * x.abs());
        4.0 * f64::EPSILON * sizes.sum::<f64>()
    }
}
