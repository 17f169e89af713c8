//! What goes on beside a motion that leaps over ranges of a table ([`ladder`](super::ladder)).
//!
//! - Perturbations wait where the motion was at the last switch, and are moved to the next one at once: up to there their equation is one.
//! - What is shown of the motion grows over leaps and single ranges up to the length at which nobody has to look closer, or to a switch.

use std::cell::RefCell;

use super::ladder::Ladder;
use super::scalar::Span;
use super::table::Table;
use super::tangent::{self, homogeneous};
use super::terms::Basis;
use super::{Affine, Passed};
use crate::time::{See, Stretch, Tangent};

/// Workspace of leaps, the perturbations that wait, and the stretch that is not yet shown.
#[derive(Debug)]
pub(super) struct Room {
    /// The combination on which perturbations wait, the motion at the place where they are, and by how many cells it is ahead of them now.
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
        // From the beginning, so that a state does not depend on what was looked at before.
        if *at != Some(ranges) {
            z.copy_from_slice(self.z);
            ladder.pass(ranges, z, moved);
            *at = Some(ranges);
        }
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
    fn begin_stretch(&mut self, combination: usize, phase: f64) {
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

    /// Leaps, and tells what waits and what is shown of it.
    pub(super) fn leap_on(
        &mut self,
        combination: usize,
        span: Span,
        done: f64,
        state: &mut [f64],
        see: &mut Option<See<'_>>,
    ) -> Option<Passed> {
        if see.is_some() {
            self.begin_stretch(combination, span.begin + done);
        }
        let passed = self.leap(combination, span, done, state, see.is_some())?;
        self.room.waits(passed.cells);
        let next = passed.goes_on_at.map_or(span.end, |next| span.begin + next);
        self.go_on_stretch(passed.cells, next, see);
        Some(passed)
    }

    /// Moves over ranges of the table of a combination, as many as the motion surely stays on its pieces, and as are `shown` at once. Writes the
    /// state that it comes to; nothing if it has to go range by range.
    fn leap(
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
