//! Motions over many ranges of a table at once.
//!
//! Where the fastest rate of a system is far above that of its motion, as in structures of many elements, a table reaches over a small part of a
//! period. The exponentials over `2^k` times its range `R`,
//!
//! ```text
//! E_0 = exp(A R) - 1,    E_(k+1) = 2 E_k + E_k^2                                                              (1)
//! ```
//!
//! take a motion over all of them in one product, where no gap can leave its piece meanwhile: the distance `d` of a gap from an end of its piece
//! stays positive over `T` if
//!
//! ```text
//! d(0) + min(0, d'(0)) T - c T^2 > 0,    |d''| <= 2 c                                                         (2)
//! ```
//!
//! with `c` from the [modes](super::modes). Perturbations need as many products as the number of ranges has digits.
//!
//! Source: Higham (2008), Functions of Matrices, section 10.3 (scaling and squaring); (2) is Taylor's formula.

use std::f64::consts::TAU;

use super::exponential::{Pair, Workspace};
use super::modes::Modes;
use super::table::Table;
use crate::numeric::linear::dot;

/// A period of fewer ranges is passed range by range.
const RANGES: f64 = 64.0;
/// Stretches that are shown are at most this part of a period, and modes that turn within them have at most this part of the rates.
const SHOWN: f64 = TAU / 16.0;
const UNRESOLVED: f64 = 1e-3;

/// The exponentials (1) of one table, at present values.
#[derive(Debug, Default)]
pub(super) struct Ladder {
    steps: Vec<Pair>,
    /// `E_k` are filled.
    count: usize,
    modes: Option<Modes>,
    /// The rates of the distances, as rows of `z`.
    slopes: Vec<f64>,
    /// Every distance, its rate, and `c` of (2).
    distances: Vec<[f64; 3]>,
}

/// Whether motions over the ranges of a table are worth a ladder.
pub(super) fn is_needed(table: &Table) -> bool {
    table.range() * table.cell * RANGES < TAU
}

impl Ladder {
    /// Fills all steps of a table that has been filled, from `A`, which is alike in size in these units.
    pub(super) fn fill(
        &mut self,
        table: &Table,
        matrix: &[f64],
        units: &[f64],
        workspace: &Workspace,
        derivatives: bool,
    ) {
        let range = table.range() * table.cell;
        self.count = (TAU / range).log2() as usize + 1;
        let period = TAU * table.time / table.cell;
        while self.steps.len() < self.count {
            self.steps.push(workspace.half.clone());
        }
        workspace.range(&mut self.steps[0], derivatives);
        for k in 1..self.count {
            let (before, after) = self.steps.split_at_mut(k);
            after[0].set_product(&before[k - 1], &before[k - 1], derivatives);
        }
        let order = units.len();
        self.slopes.clear();
        for exit in &table.exits {
            let columns = (0..order).map(|m| matrix[m..].iter().step_by(order).zip(&exit.row));
            self.slopes
                .extend(columns.map(|column| column.map(|(a, w)| a * w).sum::<f64>()));
        }
        let rows = table.exits.iter().map(|exit| &exit.row[..]);
        self.modes = Modes::new(matrix, units, rows, period);
    }

    /// How many ranges of a motion that begins at `z` are shown at once, at most.
    pub(super) fn shown(&mut self, table: &Table, z: &[f64]) -> usize {
        let Some(modes) = &mut self.modes else {
            return 1;
        };
        modes.set(z);
        let shortest = table.range() * table.time;
        let longest = SHOWN * table.time / table.cell;
        let resolved = |&k: &usize| {
            let time = (1_usize << k) as f64 * shortest;
            time <= longest && modes.beyond(time) <= UNRESOLVED
        };
        (0..self.count).rev().find(resolved).map_or(1, |k| 1 << k)
    }

    /// The longest step, as `k` in (1), that a motion which begins at `z` surely makes on its pieces, within so many ranges.
    pub(super) fn step(&mut self, table: &Table, z: &[f64], ranges: f64) -> Option<usize> {
        if ranges <= 2.0 {
            return None;
        }
        let modes = self.modes.as_mut()?;
        modes.set(z);
        self.distances.clear();
        let slopes = self.slopes.chunks_exact(z.len());
        for (index, (exit, slope)) in table.exits.iter().zip(slopes).enumerate() {
            let terms = exit.row.iter().zip(z).map(|(w, x)| w * x);
            let size: f64 = terms.map(f64::abs).sum();
            let distance = dot(&exit.row, z) - 8.0 * f64::EPSILON * size;
            let curved = 0.5 * modes.curvature(index);
            self.distances
                .push([distance, dot(slope, z).min(0.0), curved]);
        }
        let stays = |time: f64| {
            let growth = modes.growth(time);
            let mut distances = self.distances.iter();
            distances.all(|[d, slope, c]| d + slope * time - c * growth * time * time > 0.0)
        };
        let shortest = table.range() * table.time;
        (0..self.count).rev().find(|&k| {
            let count = (1_usize << k) as f64;
            count < ranges && stays(count * shortest)
        })
    }

    /// Moves a motion over `2^k` ranges.
    pub(super) fn climb(&self, k: usize, z: &[f64], out: &mut [f64]) {
        out.copy_from_slice(z);
        add_product(&self.steps[k].value, z, out);
    }

    /// The state after one range of a motion that begins at `z`.
    pub(super) fn pass_range(&self, z: &[f64], state: &mut [f64]) {
        state.copy_from_slice(&z[..state.len()]);
        add_product(&self.steps[0].value, z, state);
    }

    /// Moves a motion over some ranges; `room` is workspace.
    pub(super) fn pass(&self, ranges: usize, z: &mut [f64], room: &mut [f64]) {
        for k in (0..self.count).filter(|k| ranges >> k & 1 == 1) {
            self.climb(k, z, room);
            z.copy_from_slice(room);
        }
    }

    /// Moves perturbations of a motion that begins at `z` over some ranges, the first ones homogeneous, one more the derivative by the variable.
    pub(super) fn pass_columns(
        &self,
        ranges: usize,
        z: &mut [f64],
        columns: &mut [f64],
        homogeneous: usize,
        [column_before, moved]: [&mut [f64]; 2],
    ) {
        let (order, width) = (z.len(), column_before.len());
        for k in (0..self.count).filter(|k| ranges >> k & 1 == 1) {
            let step = &self.steps[k];
            for (index, column) in columns.chunks_exact_mut(width).enumerate() {
                column_before.copy_from_slice(column);
                let rows = step.value.chunks_exact(order);
                for (x, row) in column.iter_mut().zip(rows) {
                    *x += dot(&row[..width], column_before);
                }
                if index >= homogeneous {
                    add_product(&step.by, z, column);
                }
            }
            self.climb(k, z, moved);
            z.copy_from_slice(moved);
        }
    }
}

/// Adds the first rows of `matrix z`, as many as there is room for.
fn add_product(matrix: &[f64], z: &[f64], out: &mut [f64]) {
    for (x, row) in out.iter_mut().zip(matrix.chunks_exact(z.len())) {
        *x += dot(row, z);
    }
}
