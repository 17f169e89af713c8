//! The motion on one combination of pieces, tabulated: exact at any phase, with few operations.
//!
//! From `z' = A z` ([`equations`](super::equations)) a coordinate is a row of `exp(A t) z(0)`. About every multiple `j` of a
//! time `h` there is a cell that reaches half as far to either side, and in it, with `s` in units of `h`,
//!
//! ```text
//! q_i(s) = sum_k X_ik (s - j)^k,    X_ik = e_i (A h)^k / k! exp(A h j) z(0)                                   (1)
//! ```
//!
//! The first cell begins in its middle, so that a motion much shorter than a cell is a series in small numbers. The range of the
//! table ends at the right end of the last cell.
//!
//! The cells are so short, compared with the fastest rate of the system, that the series ends below rounding after
//! [`COEFFICIENTS`] terms. The rows of (1) are tabulated for all cells, so a motion is a few products with `z(0)`. Nothing here
//! divides by a difference of frequencies or by a stiffness: resonance, critical damping, no stiffness and the neighbourhood of
//! each keep their digits.
//!
//! An *exit level* is the distance of a gap from one end of its piece, positive inside. Its values at the beginning and at the ends of
//! the cells are tabulated too, and a bound on its second derivative, `|d''| <= bound . |z(0)|` in the unit of a cell.
//!
//! Source of (1): Van Loan (1978), Computing integrals involving the matrix exponential, IEEE Trans. Automatic Control 23.

use multiversion::multiversion;

use super::crossing::value_and_slope;
use super::exponential::{Workspace, add_row_times, fill_derivatives, fill_series};
use super::terms::Basis;

/// Terms of the series (1).
pub(super) const COEFFICIENTS: usize = 13;

/// Length of a cell, in units of the fastest rate: at its ends `0.225^12 / 12! = 4e-17` is the first term left out of a
/// velocity.
const CELL: f64 = 0.45;

/// The coefficients of a polynomial in the phase from the middle of a cell, in cells.
pub(super) type Polynomial = [f64; COEFFICIENTS];

/// The distance of a gap from one end of its piece.
#[derive(Debug, Clone)]
pub(super) struct ExitLevel {
    pub(super) contact: usize,
    pub(super) level: usize,
    /// The level is the upper end of the piece: the distance is the level less the gap.
    pub(super) upper: bool,
    /// The distance as a row of `z`.
    pub(super) row: Vec<f64>,
    /// Its values at the beginning and at the ends of cells, `cells + 1` of them for every entry of `z`.
    pub(super) ends: Vec<f64>,
    /// Its polynomials, by cell and entry of `z`.
    pub(super) series: Vec<Polynomial>,
    /// `|d''| <= bound . |z(0)|`
    pub(super) bound: Vec<f64>,
}

/// The motion on one combination of pieces.
#[derive(Debug)]
pub(super) struct Table {
    /// Number of cells.
    pub(super) cells: usize,
    /// Phase of one cell.
    pub(super) cell: f64,
    /// `h`
    pub(super) time: f64,
    /// Coordinates.
    coordinates: usize,
    /// Tabulated rows: the coordinates, and the waves if an offset moves.
    pub(super) rows: usize,
    /// Entries of `z`.
    pub(super) order: usize,
    /// The rows of (1), by cell, row and entry of `z`.
    pub(super) series: Vec<Polynomial>,
    /// Their derivatives by a variable; empty until asked for.
    pub(super) series_by: Vec<Polynomial>,
    pub(super) exits: Vec<ExitLevel>,
}

impl Table {
    pub(super) fn new(basis: &Basis, rows: usize, exits: Vec<ExitLevel>) -> Self {
        let order = basis.order();
        let cells = cells(order);
        Self {
            cells,
            cell: 0.0,
            time: 0.0,
            coordinates: basis.coordinates,
            rows,
            order,
            series: vec![[0.0; COEFFICIENTS]; cells * rows * order],
            series_by: Vec::new(),
            exits,
        }
    }

    /// Position in `z` of what a row tabulates.
    pub(super) fn entry(&self, row: usize) -> usize {
        entry(self.coordinates, row)
    }

    /// Time of a cell for a fastest rate.
    pub(super) fn time_for(rate: f64) -> f64 {
        CELL / rate
    }

    /// Fills the table from `A` and the rows of its exit levels, for cells of a time and the phase that passes in it, and its derivatives if that of
    /// `A` is given.
    pub(super) fn fill(
        &mut self,
        matrix: &[f64],
        by: Option<&[f64]>,
        [time, cell]: [f64; 2],
        workspace: &mut Workspace,
    ) {
        (self.time, self.cell) = (time, cell);
        workspace.set(matrix, by, time);
        workspace.exponentials(by.is_some());
        workspace.taylor(self, by.is_some());
        fill_series(&mut self.series, workspace);
        for exit in &mut self.exits {
            exit.fill(&self.series, self.rows, self.coordinates, workspace);
        }
        if by.is_some() {
            let length = self.series.len();
            self.series_by.resize(length, [0.0; COEFFICIENTS]);
            fill_derivatives(&mut self.series_by, workspace);
        }
    }

    /// The cell that a phase lies in, in cells, and where in it.
    pub(super) fn place(&self, cells: f64) -> (usize, f64) {
        let cell = ((cells + 0.5).max(0.0) as usize).min(self.cells - 1);
        (cell, cells - cell as f64)
    }

    /// Where the table ends, in cells.
    pub(super) fn range(&self) -> f64 {
        self.cells as f64 - 0.5
    }

    /// The polynomial of an exit level's distance in a cell, for a motion that begins at `z`.
    pub(super) fn distance(&self, exit: &ExitLevel, cell: usize, z: &[f64]) -> Polynomial {
        let mut sum = [[0.0; COEFFICIENTS]];
        let series = &exit.series[cell * self.order..][..self.order];
        add_combination(series, z, &mut sum);
        sum[0]
    }

    /// Writes what a unit of each coordinate and of each velocity makes of all of them, at a place in a cell: `2 n` columns, one after the other.
    /// `rate` is velocity by slope.
    pub(super) fn propagator(&self, cell: usize, s: f64, rate: f64, out: &mut [f64]) {
        let n = self.coordinates;
        let series = &self.series[cell * self.rows * self.order..];
        for (i, row) in series.chunks_exact(self.order).take(n).enumerate() {
            for (column, polynomial) in out.chunks_exact_mut(2 * n).zip(row) {
                let (value, slope) = value_and_slope(polynomial, s);
                column[i] = value;
                column[n + i] = slope * rate;
            }
        }
    }

    /// Writes the state after some cells of a motion that begins at `z`; `base` is phase per time.
    pub(super) fn state(&self, cells: f64, z: &[f64], base: f64, state: &mut [f64]) {
        let (cell, s) = self.place(cells);
        let series = &self.series[cell * self.rows * self.order..];
        write_state(series, z, [s, base / self.cell], state);
    }

    /// The polynomials of all rows in a cell, for a motion that begins at `z`.
    pub(super) fn polynomials(&self, cell: usize, z: &[f64], out: &mut [Polynomial]) {
        combine(&self.series[cell * self.rows * self.order..], z, out);
    }

    /// Adds to polynomials what the derivative of the table makes of `z`.
    pub(super) fn add_derivatives(&self, cell: usize, z: &[f64], out: &mut [Polynomial]) {
        add_combination(&self.series_by[cell * self.rows * self.order..], z, out);
    }
}

/// Cells of a table. Fewer for large systems, whose tables would not fit into a cache.
pub(super) const fn cells(order: usize) -> usize {
    if order <= 16 { 16 } else { 4 }
}

/// Position in `z` of what a row tabulates: coordinates, then waves.
fn entry(coordinates: usize, row: usize) -> usize {
    if row < coordinates {
        row
    } else {
        row + coordinates + 1
    }
}

fn combine(series: &[Polynomial], z: &[f64], out: &mut [Polynomial]) {
    out.fill([0.0; COEFFICIENTS]);
    add_combination(series, z, out);
}

#[multiversion(targets("x86_64+avx512f", "x86_64+avx2"))]
fn add_combination(series: &[Polynomial], z: &[f64], out: &mut [Polynomial]) {
    for (out, row) in out.iter_mut().zip(series.chunks_exact(z.len())) {
        *out = sum(*out, row, z);
    }
}

/// A polynomial with those of a row added, as many times as `z` says.
#[inline(always)]
#[allow(
    clippy::inline_always,
    reason = "what is not inlined is not compiled for the instruction set of its caller"
)]
fn sum(mut sum: Polynomial, row: &[Polynomial], z: &[f64]) -> Polynomial {
    for (term, factor) in row.iter().zip(z) {
        for k in 0..COEFFICIENTS {
            sum[k] += term[k] * factor;
        }
    }
    sum
}

/// Writes positions and velocities at a place in a cell, of a motion that begins at `z`; `rate` is velocity by slope.
#[multiversion(targets("x86_64+avx512f", "x86_64+avx2"))]
fn write_state(series: &[Polynomial], z: &[f64], [s, rate]: [f64; 2], state: &mut [f64]) {
    let (positions, velocities) = state.split_at_mut(state.len() / 2);
    let rows = series.chunks_exact(z.len());
    for ((position, velocity), row) in positions.iter_mut().zip(velocities).zip(rows) {
        let polynomial = sum([0.0; COEFFICIENTS], row, z);
        let (mut value, mut slope) = (0.0, 0.0);
        for x in polynomial.iter().rev() {
            (value, slope) = (value * s + x, slope * s + value);
        }
        *position = value;
        *velocity = slope * rate;
    }
}

impl ExitLevel {
    /// Sets the row from the direction and the waves of the gap, and from the level.
    pub(super) fn set_row(&mut self, gap: &[f64], offset: &[f64], level: f64) {
        let sign = if self.upper { -1.0 } else { 1.0 };
        let (state, waves) = self.row.split_at_mut(2 * gap.len());
        for (out, d) in state.iter_mut().zip(gap) {
            *out = sign * d;
        }
        for (out, delta) in waves.iter_mut().zip(offset) {
            *out = -sign * delta;
        }
        waves[0] -= sign * level;
    }

    /// Tabulates the distance at the ends of cells, and the bound on its second derivative.
    fn fill(
        &mut self,
        series: &[Polynomial],
        rows: usize,
        coordinates: usize,
        workspace: &mut Workspace,
    ) {
        let (order, width) = (self.row.len(), workspace.middles.len() + 1);
        workspace.row.copy_from_slice(&self.row);
        add_row_times(&self.row, &workspace.half.value, &mut workspace.row);
        self.ends.resize(order * width, 0.0);
        for (m, &x) in self.row.iter().enumerate() {
            self.ends[m * width] = x;
        }
        for (j, middle) in workspace.middles.iter().enumerate() {
            workspace.other.copy_from_slice(&workspace.row);
            add_row_times(&workspace.row, &middle.value, &mut workspace.other);
            for (m, &x) in workspace.other.iter().enumerate() {
                self.ends[m * width + j + 1] = x;
            }
        }
        self.bound.clear();
        self.bound.resize(order, 0.0);
        self.series.clear();
        for cell in series.chunks_exact(rows * order) {
            self.add_distances(cell, rows, coordinates);
            for (m, bound) in self.bound.iter_mut().enumerate() {
                let size = |row: usize| {
                    let weight = self.row[entry(coordinates, row)].abs();
                    weight * second_derivative_bound(&cell[row * order + m])
                };
                *bound = bound.max((0..rows).map(size).sum());
            }
        }
    }
}

impl ExitLevel {
    /// Adds the polynomials of the distance in a cell, from those of its rows.
    fn add_distances(&mut self, cell: &[Polynomial], rows: usize, coordinates: usize) {
        let order = self.row.len();
        let from = self.series.len();
        self.series.resize(from + order, [0.0; COEFFICIENTS]);
        let distances = &mut self.series[from..];
        for (row, polynomials) in cell.chunks_exact(order).take(rows).enumerate() {
            let weight = self.row[entry(coordinates, row)];
            for (sum, polynomial) in distances.iter_mut().zip(polynomials) {
                for (sum, x) in sum.iter_mut().zip(polynomial) {
                    *sum += weight * x;
                }
            }
        }
        let constant = 2 * coordinates;
        distances[constant][0] += self.row[constant];
    }
}

/// `k (k - 1) / 2^(k - 2)`
const SECOND: Polynomial = {
    let mut weights = [0.0; COEFFICIENTS];
    let (mut k, mut power) = (2, 1.0);
    while k < COEFFICIENTS {
        weights[k] = (k * (k - 1)) as f64 * power;
        power *= 0.5;
        k += 1;
    }
    weights
};

/// A bound on the second derivative within the cell.
pub(super) fn second_derivative_bound(polynomial: &Polynomial) -> f64 {
    let sizes = polynomial.iter().zip(&SECOND);
    sizes.map(|(x, weight)| x.abs() * weight).sum()
}
