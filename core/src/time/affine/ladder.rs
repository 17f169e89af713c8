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

use super::exponential::{Pair, Workspace};
use super::modes::Modes;
use super::scalar::Span;
use super::table::Table;
use super::tangent::{self, homogeneous};
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

    /// How many ranges of a motion that begins at `z` are shown at once, at most.
    fn shown(&mut self, table: &Table, z: &[f64]) -> usize {
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
    fn step(&mut self, table: &Table, z: &[f64], ranges: f64) -> Option<usize> {
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
    fn climb(&self, k: usize, z: &[f64], out: &mut [f64]) {
        out.copy_from_slice(z);
        add_product(&self.steps[k].value, z, out);
    }

    /// The state after one range of a motion that begins at `z`.
    pub(super) fn pass_range(&self, z: &[f64], state: &mut [f64]) {
        state.copy_from_slice(&z[..state.len()]);
        add_product(&self.steps[0].value, z, state);
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

/// Workspace of leaps, the perturbations that wait, and the stretch that is not yet shown.
#[derive(Debug)]
pub(super) struct Room {
    /// The combination on which perturbations wait, the motion where they are, and by how many cells that is ahead of them.
    combination: Option<usize>,
    first: Vec<f64>,
    cells: f64,
    stretch: Growing,
    next: Vec<f64>,
    moved: Vec<f64>,
    seen: Vec<f64>,
    column: Vec<f64>,
}

/// A stretch that grows: on a combination, from a motion on, over so many cells, as far as it is shown at once.
#[derive(Debug)]
struct Growing {
    combination: Option<usize>,
    from: Vec<f64>,
    phases: (f64, f64),
    cells: f64,
    most: f64,
}

impl Room {
    pub(super) fn new(basis: &Basis) -> Self {
        let order = || vec![0.0; basis.order()];
        Self {
            combination: None,
            first: order(),
            cells: 0.0,
            stretch: Growing {
                combination: None,
                from: order(),
                phases: (0.0, 0.0),
                cells: 0.0,
                most: 0.0,
            },
            next: order(),
            moved: order(),
            seen: order(),
            column: vec![0.0; 2 * basis.coordinates],
        }
    }

    /// No perturbations wait, and nothing is to be shown.
    pub(super) fn begin(&mut self) {
        self.combination = None;
        self.stretch.combination = None;
    }

    /// The motion has gone on by some cells.
    pub(super) fn waits(&mut self, cells: f64) {
        self.cells += cells;
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
    seen: RefCell<Seen<'l>>,
}

/// The motion at the beginning of the range that was looked at last, if any was, and workspace.
struct Seen<'l> {
    ranges: Option<usize>,
    z: &'l mut [f64],
    moved: &'l mut [f64],
}

impl Stretch for Leap<'_> {
    fn phases(&self) -> (f64, f64) {
        self.phases
    }

    fn state(&self, phase: f64, state: &mut [f64]) {
        let Self { table, ladder, .. } = self;
        let Seen {
            ranges: at,
            z,
            moved,
        } = &mut *self.seen.borrow_mut();
        let cells = ((phase - self.phases.0) / table.cell).max(0.0);
        let ranges = (cells / table.range()) as usize;
        let before = at.filter(|&at| at <= ranges).unwrap_or_else(|| {
            z.copy_from_slice(self.z);
            0
        });
        ladder.pass(ranges - before, z, moved);
        *at = Some(ranges);
        let cells = cells - ranges as f64 * table.range();
        table.state(cells, z, self.base, state);
    }
}

impl Affine {
    /// Lets perturbations wait where a motion is on a combination whose table has a ladder: up to the next switch they are moved at once.
    pub(super) fn wait(&mut self, combination: usize) {
        let (_, ladder) = self.model.at(combination).tabulated();
        if ladder.is_some() && self.room.combination.is_none() {
            self.room.combination = Some(combination);
            self.room.first.copy_from_slice(&self.z);
            self.room.cells = 0.0;
        }
    }

    /// Moves perturbations that wait to where the motion is.
    pub(super) fn catch_up(&mut self, tangent: &mut Option<&mut Tangent>) {
        let Room {
            combination,
            first,
            cells,
            moved,
            column,
            ..
        } = &mut self.room;
        let (Some(combination), Some(tangent)) = (combination.take(), tangent.as_deref_mut())
        else {
            return;
        };
        let (table, Some(ladder)) = self.model.at(combination).tabulated() else {
            return;
        };
        let model = &self.model;
        let homogeneous = homogeneous(tangent, model.basis.coordinates);
        let mut advance = |z: &[f64], cells: f64, tangent: &mut Tangent| {
            let workspace = tangent::Workspace {
                rows: &mut self.rows[..table.rows],
                rows_by: &mut self.rows_by[..table.rows],
                column: &mut self.column,
                propagator: &mut self.propagator,
            };
            tangent::advance(model, table, z, cells, tangent, workspace);
        };
        let ranges = (*cells / table.range()) as usize;
        if ranges == 1 {
            // The series of a table has fewer rounding errors than the product (1).
            advance(first, table.range(), tangent);
            ladder.pass(1, first, moved);
        } else {
            let columns = &mut tangent.columns;
            ladder.pass_columns(ranges, first, columns, homogeneous, [column, moved]);
        }
        advance(first, *cells - ranges as f64 * table.range(), tangent);
    }

    /// Begins to show a stretch of a motion on a combination whose table has a ladder.
    pub(super) fn begin_stretch(&mut self, combination: usize, phase: f64) {
        if self.room.stretch.combination.is_some() {
            return;
        }
        let Some((table, ladder)) = self.model.ladder(combination) else {
            return;
        };
        let stretch = &mut self.room.stretch;
        stretch.combination = Some(combination);
        stretch.from.copy_from_slice(&self.z);
        stretch.phases = (phase, phase);
        stretch.cells = 0.0;
        stretch.most = ladder.shown(table, &self.z) as f64 * table.range();
    }

    /// The motion has gone on by some cells, to a phase; shows the stretch if it is long enough.
    pub(super) fn go_on_stretch(&mut self, cells: f64, phase: f64, see: &mut Option<See<'_>>) {
        let stretch = &mut self.room.stretch;
        stretch.cells += cells;
        stretch.phases.1 = phase;
        if stretch.cells >= stretch.most {
            self.show(see);
        }
    }

    /// Shows the stretch that has grown, if there is one.
    pub(super) fn show(&mut self, see: &mut Option<See<'_>>) {
        let Room {
            stretch,
            seen,
            moved,
            ..
        } = &mut self.room;
        let (Some(combination), Some(see)) = (stretch.combination.take(), see.as_mut()) else {
            return;
        };
        let (table, Some(ladder)) = self.model.at(combination).tabulated() else {
            return;
        };
        if stretch.cells > 0.0 {
            see(&Leap {
                table,
                ladder,
                z: &stretch.from,
                phases: stretch.phases,
                base: self.model.terms.base,
                seen: RefCell::new(Seen {
                    ranges: None,
                    z: seen,
                    moved,
                }),
            });
        }
    }

    /// Moves over ranges of the table of a combination, as many as the motion surely stays on its pieces, and as are `shown` at once. Writes the
    /// state that it comes to; nothing if it has to go range by range.
    pub(super) fn leap(
        &mut self,
        combination: usize,
        span: Span,
        done: f64,
        state: &mut [f64],
        shown: bool,
    ) -> Option<Passed> {
        if self.at.iter().any(Option::is_some) {
            return None;
        }
        let (table, ladder) = self.model.ladder(combination)?;
        let Room { next, stretch, .. } = &mut self.room;
        let range = table.range();
        let mut left = (span.length - done) / table.cell / range;
        if shown {
            // A step ends before what is left, here with it.
            left = left.min((stretch.most - stretch.cells) / range + 0.5);
        }
        let mut ranges: usize = 0;
        while let Some(k) = ladder.step(table, &self.z, left - ranges as f64) {
            ladder.climb(k, &self.z, next);
            if next.iter().any(|x| !x.is_finite()) {
                break;
            }
            ranges += 1 << k;
            self.z.copy_from_slice(next);
            self.work.steps += 1;
        }
        if ranges == 0 {
            return None;
        }
        state.copy_from_slice(&self.z[..state.len()]);
        let cells = ranges as f64 * range;
        Some(Passed {
            goes_on_at: Some(done + cells * table.cell),
            cells,
            switch: None,
        })
    }
}
