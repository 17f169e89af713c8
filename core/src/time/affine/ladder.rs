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

use std::cell::RefCell;
use std::f64::consts::TAU;

use super::crossing::value_and_slope;
use super::exponential::{Pair, Workspace};
use super::modes::Modes;
use super::scalar::Span;
use super::table::Table;
use super::tangent::homogeneous;
use super::terms::Basis;
use super::{Affine, Passed};
use crate::numeric::linear::dot;
use crate::time::{See, Stretch, Tangent};

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

    /// The longest step, as `k` in (1), that a motion which begins at `z` surely makes on its pieces, within so many ranges. `shown` if it is looked at on
    /// its way.
    fn step(&mut self, table: &Table, z: &[f64], ranges: f64, shown: bool) -> Option<usize> {
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
        let longest_shown = SHOWN * table.time / table.cell;
        (0..self.count).rev().find(|&k| {
            let count = (1_usize << k) as f64;
            let time = count * shortest;
            let resolved = !shown || time <= longest_shown && modes.beyond(time) <= UNRESOLVED;
            count < ranges && resolved && stays(time)
        })
    }

    /// Moves a motion over `2^k` ranges.
    fn climb(&self, k: usize, z: &[f64], out: &mut [f64]) {
        out.copy_from_slice(z);
        add_product(&self.steps[k].value, z, out);
    }

    /// Moves a motion over some ranges; `room` is workspace.
    fn pass(&self, ranges: usize, z: &mut [f64], room: &mut [f64]) {
        for k in (0..self.count).filter(|k| ranges >> k & 1 == 1) {
            self.climb(k, z, room);
            z.copy_from_slice(room);
        }
    }

    /// Moves perturbations of a motion that begins at `z` over some ranges, the first ones homogeneous, one more the derivative by the variable.
    fn pass_columns(
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

/// Workspace of leaps.
#[derive(Debug)]
pub(super) struct Room {
    /// The motion where perturbations are.
    first: Vec<f64>,
    next: Vec<f64>,
    moved: Vec<f64>,
    seen: Vec<f64>,
    column: Vec<f64>,
}

impl Room {
    pub(super) fn new(basis: &Basis) -> Self {
        let order = || vec![0.0; basis.order()];
        Self {
            first: order(),
            next: order(),
            moved: order(),
            seen: order(),
            column: vec![0.0; 2 * basis.coordinates],
        }
    }
}

/// A stretch over ranges of a table.
struct Leap<'l> {
    table: &'l Table,
    ladder: &'l Ladder,
    /// Where it begins.
    z: &'l [f64],
    phases: (f64, f64),
    /// `nu`
    base: f64,
    room: RefCell<[&'l mut [f64]; 2]>,
}

impl Stretch for Leap<'_> {
    fn phases(&self) -> (f64, f64) {
        self.phases
    }

    fn state(&self, phase: f64, state: &mut [f64]) {
        let Self { table, ladder, .. } = self;
        let [z, moved] = &mut *self.room.borrow_mut();
        z.copy_from_slice(self.z);
        let cells = ((phase - self.phases.0) / table.cell).max(0.0);
        let ranges = (cells / table.range()) as usize;
        ladder.pass(ranges, z, moved);
        let (cell, s) = table.place(cells - ranges as f64 * table.range());
        let n = state.len() / 2;
        for i in 0..n {
            let (value, slope) = value_and_slope(&table.polynomial(cell, i, z), s);
            state[i] = value;
            state[n + i] = slope * (self.base / table.cell);
        }
    }
}

impl Affine {
    /// Moves over ranges of the table of a combination, as many as the motion surely stays on its pieces. Writes the state that it comes to;
    /// nothing if it has to go range by range.
    pub(super) fn leap(
        &mut self,
        combination: usize,
        span: Span,
        done: f64,
        state: &mut [f64],
        tangent: Option<&mut Tangent>,
        see: &mut Option<See<'_>>,
    ) -> Option<Passed> {
        if self.at.iter().any(Option::is_some) {
            return None;
        }
        let base = self.model.terms.base;
        let (table, ladder) = self.model.ladder(combination)?;
        let Room {
            first,
            next,
            moved,
            seen,
            column,
        } = &mut self.room;
        let range = table.range();
        let left = (span.length - done) / table.cell / range;
        let after = |ranges: usize| span.begin + (done + ranges as f64 * range * table.cell);
        first.copy_from_slice(&self.z);
        let mut ranges = 0;
        while let Some(k) = ladder.step(table, &self.z, left - ranges as f64, see.is_some()) {
            ladder.climb(k, &self.z, next);
            if next.iter().any(|x| !x.is_finite()) {
                break;
            }
            let passed = ranges + (1 << k);
            if let Some(see) = see {
                see(&Leap {
                    table,
                    ladder,
                    z: &self.z,
                    phases: (after(ranges), after(passed)),
                    base,
                    room: RefCell::new([seen, moved]),
                });
            }
            ranges = passed;
            self.z.copy_from_slice(next);
            self.work.steps += 1;
        }
        if ranges == 0 {
            return None;
        }
        state.copy_from_slice(&self.z[..state.len()]);
        if let Some(tangent) = tangent {
            let homogeneous = homogeneous(tangent, state.len() / 2);
            let columns = &mut tangent.columns;
            ladder.pass_columns(ranges, first, columns, homogeneous, [column, moved]);
        }
        let cells = ranges as f64 * range;
        Some(Passed {
            goes_on_at: Some(done + cells * table.cell),
            cells,
            switch: None,
        })
    }
}
