//! The states that motions start from, and the order in which they are looked at.

/// Initial states: two entries of the state vary, the others stay; or [any states](Grid::of_states).
///
/// ```
/// use hertzian::attractors::basin::{Axis, Grid};
///
/// // One coordinate and its rate, 64 cells each.
/// let position = Axis::of(0).from(-2.0).to(2.0).cells(64);
/// let rate = Axis::of(1).from(-1.0).to(1.0).cells(64);
/// let grid = Grid::new(vec![0.0, 0.0], position, rate);
/// assert_eq!(grid.cells(), 4096);
/// ```
#[derive(Debug, Clone, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[non_exhaustive]
pub struct Grid {
    /// The state whose two entries are varied.
    #[cfg_attr(feature = "serde", serde(with = "crate::serialise"))]
    pub start: Vec<f64>,
    /// The entry that varies along a row, from column to column.
    pub columns: Axis,
    /// The entry that varies from row to row.
    pub rows: Axis,
    /// The states of the cells, where they are given one by one.
    #[cfg_attr(feature = "serde", serde(with = "crate::serialise"))]
    pub(super) states: Vec<Vec<f64>>,
}

/// One direction of a grid. Its cells divide the range evenly; motions start from their middles.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[non_exhaustive]
pub struct Axis {
    /// Which entry of the state: a coordinate, or with `entry >= n` its rate.
    pub entry: usize,
    /// Where the first cell begins.
    #[cfg_attr(feature = "serde", serde(with = "crate::serialise"))]
    pub from: f64,
    /// Where the last one ends.
    #[cfg_attr(feature = "serde", serde(with = "crate::serialise"))]
    pub to: f64,
    /// Number of cells.
    pub count: usize,
}

/// Each round of the work has a sixteenth of the cells of the next one.
const COARSER: usize = 4;
/// Cells along the longer side that the first round may have.
const FIRST: usize = 8;

impl Axis {
    /// An entry of the state, from -1 to 1 in 256 cells.
    pub fn of(entry: usize) -> Self {
        Self {
            entry,
            from: -1.0,
            to: 1.0,
            count: 256,
        }
    }

    hertzian_contract::setters! { self:
        /// Where the first cell begins.
        from(value: f64) { self.from = value }

        /// Where the last cell ends.
        to(value: f64) { self.to = value }

        /// Number of cells.
        cells(count: usize) { self.count = count }
    }

    /// The middle of a cell.
    pub fn middle(&self, cell: usize) -> f64 {
        let part = (cell as f64 + 0.5) / self.count as f64;
        (1.0 - part) * self.from + part * self.to
    }
}

impl Grid {
    /// States that differ from `start` in the entries of two axes.
    pub fn new(start: Vec<f64>, columns: Axis, rows: Axis) -> Self {
        Self {
            start,
            columns,
            rows,
            states: Vec::new(),
        }
    }

    /// Any states, as random ones: a row of as many cells.
    ///
    /// ```
    /// use hertzian::attractors::basin::{Basin, Grid};
    ///
    /// hertzian::oscillator! {
    ///     TwoWells(x) {
    ///         param drive;
    ///         ddot(x) + 0.5*dot(x) - x + x^3 = drive*cos(omega*t);
    ///     }
    /// }
    ///
    /// let starts = vec![vec![0.9, 0.0], vec![-1.1, 0.0], vec![1.2, 0.1]];
    /// let basin = Basin::of(&TwoWells { drive: 0.05 }).omega(1.0).longest(2);
    /// let basins = basin.grid(Grid::of_states(starts)).run()?;
    /// assert_eq!(basins.attractors.len(), 2);
    /// assert_eq!(basins.fates[0], basins.fates[2]);
    /// # Ok::<(), hertzian::Error>(())
    /// ```
    pub fn of_states(states: Vec<Vec<f64>>) -> Self {
        Self {
            start: states.first().cloned().unwrap_or_default(),
            columns: Axis::of(0).cells(states.len()),
            rows: Axis::of(1).cells(1),
            states,
        }
    }

    /// The states, where they are [given one by one](Self::of_states); none of a grid with rows and columns.
    pub fn given(&self) -> &[Vec<f64>] {
        &self.states
    }

    /// Number of cells.
    pub fn cells(&self) -> usize {
        self.columns.count.saturating_mul(self.rows.count)
    }

    /// Writes the state that the motion of a cell starts from. Cells are counted row by row.
    pub fn state(&self, cell: usize, state: &mut [f64]) {
        if let Some(given) = self.states.get(cell) {
            state.copy_from_slice(given);
            return;
        }
        state.copy_from_slice(&self.start);
        state[self.columns.entry] = self.columns.middle(cell % self.columns.count);
        state[self.rows.entry] = self.rows.middle(cell / self.columns.count);
    }

    /// Whether its states have so many entries, of which two vary.
    pub(crate) fn is_of(&self, order: usize) -> bool {
        let entries = [self.columns.entry, self.rows.entry];
        let mut given = std::iter::once(&self.start).chain(&self.states);
        given.all(|state| state.len() == order) && entries.iter().all(|&entry| entry < order)
    }

    /// The cells in rounds, from coarse to fine; every cell is in one of them. Later rounds find most attractors known.
    pub(super) fn rounds(&self) -> Vec<Vec<usize>> {
        let most = self.columns.count.max(self.rows.count);
        let mut stride = 1;
        while most.div_ceil(stride) > FIRST {
            stride *= COARSER;
        }
        let mut rounds = Vec::new();
        let mut coarser = usize::MAX;
        loop {
            let on = |row: usize, column: usize, stride| {
                row.is_multiple_of(stride) && column.is_multiple_of(stride)
            };
            let rows = (0..self.rows.count).step_by(stride);
            let cells = rows.flat_map(|row| {
                let columns = (0..self.columns.count).step_by(stride);
                let new = columns
                    .filter(move |&column| coarser == usize::MAX || !on(row, column, coarser));
                new.map(move |column| row * self.columns.count + column)
            });
            rounds.push(cells.collect());
            if stride == 1 {
                return rounds;
            }
            coarser = stride;
            stride /= COARSER;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn grid(columns: usize, rows: usize) -> Grid {
        let axis = |entry, count| Axis::of(entry).from(-1.0).to(1.0).cells(count);
        Grid::new(vec![0.0; 2], axis(0, columns), axis(1, rows))
    }

    #[test]
    fn every_cell_is_in_one_round() {
        for (columns, rows) in [(1, 1), (8, 8), (9, 3), (33, 70), (512, 512)] {
            let grid = grid(columns, rows);
            let rounds = grid.rounds();
            assert!(rounds[0].len() <= 64);
            let mut cells: Vec<usize> = rounds.concat();
            cells.sort_unstable();
            assert!(cells.into_iter().eq(0..columns * rows), "{columns} {rows}");
        }
    }

    #[test]
    fn motions_start_from_states_that_are_given() {
        let states: Vec<Vec<f64>> = (0..20).map(|i| vec![f64::from(i), 0.5]).collect();
        let grid = Grid::of_states(states.clone());
        let mut cells: Vec<usize> = grid.rounds().concat();
        cells.sort_unstable();
        assert!(cells.into_iter().eq(0..20));
        let mut state = [0.0; 2];
        for (cell, expected) in states.iter().enumerate() {
            grid.state(cell, &mut state);
            assert_eq!(state, expected[..]);
        }
        assert_eq!(Grid::of_states(Vec::new()).cells(), 0);
    }

    #[test]
    fn motions_start_from_the_middles() {
        let grid = grid(4, 2);
        let mut state = [0.0; 2];
        grid.state(0, &mut state);
        assert_eq!(state, [-0.75, -0.5]);
        grid.state(7, &mut state);
        assert_eq!(state, [0.75, 0.5]);
    }
}
