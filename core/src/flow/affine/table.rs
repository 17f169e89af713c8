//! The motion on one combination of pieces, tabulated: exact at any phase, with few operations.
//!
//! From `dz/dtau = A z` ([`equations`](super::equations)) a coordinate is a row of `exp(A tau) z(0)`. The phase is divided into cells
//! of length `h`, and in the cell `j` about its middle, with `s` in cells,
//!
//! ```text
//! q_i(s) = sum_k X_ik (s - j - 1/2)^k,    X_ik = e_i (A h)^k / k! exp(A h (j + 1/2)) z(0)                     (1)
//! ```
//!
//! The cells are so short, compared with the fastest rate of the system, that the series ends below rounding after
//! [`COEFFICIENTS`] terms. The rows of (1) are tabulated for all cells, so a motion is a few products with `z(0)`. Nothing here
//! divides by a difference of frequencies or by a stiffness: resonance, critical damping, no stiffness and the neighbourhood of
//! each keep their digits.
//!
//! A *watch* is the distance of a gap from one end of its piece, positive inside. Its values at the ends of the cells are
//! tabulated too, and a bound on its second derivative, `|d''| <= bound . |z(0)|` in the unit of a cell.
//!
//! Source: Moler and Van Loan (2003), Nineteen dubious ways to compute the exponential of a matrix, SIAM Review 45, method 3
//! (scaling and squaring).

use super::equations::Basis;

/// Terms of the series (1).
pub(super) const COEFFICIENTS: usize = 12;

/// Length of a cell, in units of the fastest rate: `0.225^12 / 12! = 4e-17` is the first term left out at its ends.
const CELL: f64 = 0.45;

/// Terms of the exponential over half a cell: `0.225^15 / 15! = 1e-22`.
const TERMS: usize = 15;

/// The coefficients of a polynomial in the phase about the middle of a cell, in cells.
pub(super) type Polynomial = [f64; COEFFICIENTS];

/// The distance of a gap from one end of its piece.
#[derive(Debug, Clone)]
pub(super) struct Watch {
    pub(super) contact: usize,
    pub(super) level: usize,
    /// The level is the upper end of the piece: the distance is the level less the gap.
    pub(super) upper: bool,
    /// The distance as a row of `z`.
    pub(super) row: Vec<f64>,
    /// Its values at the ends of cells, `cells + 1` of them for every entry of `z`.
    pub(super) ends: Vec<f64>,
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
    pub(super) watches: Vec<Watch>,
}

/// Room to make tables: matrices of the order of `z`.
#[derive(Debug)]
pub(super) struct Room {
    /// `A h`
    scaled: Vec<f64>,
    scaled_by: Vec<f64>,
    /// `exp(A h / 2)`, the exponentials over 1, 2, 4, ... cells, and those up to the middle of every cell; with derivatives.
    half: Pair,
    powers: Vec<Pair>,
    middles: Vec<Pair>,
    term: Pair,
    next: Pair,
    /// `e_i (A h)^k / k!`, by term and row.
    rows: Vec<f64>,
    rows_by: Vec<f64>,
    row: Vec<f64>,
    other: Vec<f64>,
}

/// A matrix and its derivative by a variable.
#[derive(Debug, Clone)]
struct Pair {
    value: Vec<f64>,
    by: Vec<f64>,
}

impl Table {
    pub(super) fn new(basis: &Basis, rows: usize, watches: Vec<Watch>) -> Self {
        let order = basis.order();
        let cells = cells(order);
        Self {
            cells,
            cell: 0.0,
            coordinates: basis.coordinates,
            rows,
            order,
            series: vec![[0.0; COEFFICIENTS]; cells * rows * order],
            series_by: Vec::new(),
            watches,
        }
    }

    /// Position in `z` of what a row tabulates.
    pub(super) fn entry(&self, row: usize) -> usize {
        entry(self.coordinates, row)
    }

    /// Position of the constant in `z`.
    pub(super) fn constant(&self) -> usize {
        2 * self.coordinates
    }

    /// Fills the table from `A`, whose fastest rate is known, and the rows of its watches.
    pub(super) fn fill(&mut self, matrix: &[f64], rate: f64, room: &mut Room) {
        self.cell = CELL / rate;
        room.set(matrix, None, self.cell);
        room.exponentials(false);
        room.taylor(self, false);
        fill_series(&mut self.series, self.rows, &room.rows, &room.middles);
        let coordinates = self.coordinates;
        for watch in &mut self.watches {
            watch.fill(&self.series, self.rows, coordinates, room);
        }
    }

    /// Fills the derivatives by a variable; `by` is the derivative of the matrix that the table was filled from.
    pub(super) fn differentiate(&mut self, matrix: &[f64], by: &[f64], room: &mut Room) {
        let length = self.series.len();
        self.series_by.resize(length, [0.0; COEFFICIENTS]);
        room.set(matrix, Some(by), self.cell);
        room.exponentials(true);
        room.taylor(self, true);
        fill_derivatives(&mut self.series_by, self.rows, room);
    }

    /// The cell that a phase lies in, in cells, and where in it.
    pub(super) fn place(&self, cells: f64) -> (usize, f64) {
        let cell = (cells.max(0.0) as usize).min(self.cells - 1);
        (cell, cells - cell as f64 - 0.5)
    }

    /// The polynomial of one row in a cell.
    pub(super) fn polynomial(&self, cell: usize, row: usize, z: &[f64]) -> Polynomial {
        let mut sum = [[0.0; COEFFICIENTS]];
        let from = (cell * self.rows + row) * self.order;
        add_combination(&self.series[from..][..self.order], z, &mut sum);
        sum[0]
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
pub(super) fn cells(order: usize) -> usize {
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

fn add_combination(series: &[Polynomial], z: &[f64], out: &mut [Polynomial]) {
    for (sum, row) in out.iter_mut().zip(series.chunks_exact(z.len())) {
        for (term, factor) in row.iter().zip(z) {
            for (sum, term) in sum.iter_mut().zip(term) {
                *sum += term * factor;
            }
        }
    }
}

impl Watch {
    /// Tabulates the distance at the ends of cells, and the bound on its second derivative.
    fn fill(&mut self, series: &[Polynomial], rows: usize, coordinates: usize, room: &mut Room) {
        let (order, width) = (self.row.len(), room.middles.len() + 1);
        row_times(&self.row, &room.half.value, &mut room.row);
        self.ends.resize(order * width, 0.0);
        for (m, &x) in self.row.iter().enumerate() {
            self.ends[m * width] = x;
        }
        for (j, middle) in room.middles.iter().enumerate() {
            row_times(&room.row, &middle.value, &mut room.other);
            for (m, &x) in room.other.iter().enumerate() {
                self.ends[m * width + j + 1] = x;
            }
        }
        self.bound.clear();
        self.bound.resize(order, 0.0);
        for cell in series.chunks_exact(rows * order) {
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

/// A bound on the second derivative within the cell.
fn second_derivative_bound(polynomial: &Polynomial) -> f64 {
    let terms = polynomial.iter().enumerate().skip(2);
    let sizes = terms.scan(1.0, |power, (k, x)| {
        let size = (k * (k - 1)) as f64 * x.abs() * *power;
        *power *= 0.5;
        Some(size)
    });
    sizes.sum()
}

impl Room {
    pub(super) fn new(basis: &Basis, rows: usize) -> Self {
        let order = basis.order();
        let square = || vec![0.0; order * order];
        let pair = Pair {
            value: square(),
            by: square(),
        };
        let cells = cells(order);
        Self {
            scaled: square(),
            scaled_by: square(),
            half: pair.clone(),
            powers: vec![pair.clone(); cells.ilog2() as usize],
            middles: vec![pair.clone(); cells],
            term: pair.clone(),
            next: pair,
            rows: vec![0.0; COEFFICIENTS * rows * order],
            rows_by: vec![0.0; COEFFICIENTS * rows * order],
            row: vec![0.0; order],
            other: vec![0.0; order],
        }
    }

    fn set(&mut self, matrix: &[f64], by: Option<&[f64]>, cell: f64) {
        for (out, x) in self.scaled.iter_mut().zip(matrix) {
            *out = x * cell;
        }
        for (out, x) in self.scaled_by.iter_mut().zip(by.unwrap_or(&[])) {
            *out = x * cell;
        }
    }

    /// The exponentials over half a cell, over powers of two of cells, and up to the middle of every cell.
    fn exponentials(&mut self, derivatives: bool) {
        let order = self.scaled.len().isqrt();
        self.term.set_identity(order);
        self.half.set_identity(order);
        for k in 1..=TERMS {
            let factor = 0.5 / k as f64;
            product(&self.term.value, &self.scaled, &mut self.next.value);
            if derivatives {
                product(&self.term.by, &self.scaled, &mut self.next.by);
                add_products(&self.term.value, &self.scaled_by, &mut self.next.by);
            }
            std::mem::swap(&mut self.term, &mut self.next);
            self.term.scale(factor);
            self.half.add(&self.term);
        }
        self.middles[0].clone_from(&self.half);
        self.powers[0].set_product(&self.half, &self.half, derivatives);
        for m in 1..self.powers.len() {
            let (before, after) = self.powers.split_at_mut(m);
            after[0].set_product(&before[m - 1], &before[m - 1], derivatives);
        }
        for j in 1..self.middles.len() {
            let m = j.ilog2() as usize;
            let (before, after) = self.middles.split_at_mut(j);
            after[0].set_product(&self.powers[m], &before[j - (1 << m)], derivatives);
        }
    }

    /// The rows `e_i (A h)^k / k!`.
    fn taylor(&mut self, table: &Table, derivatives: bool) {
        let (order, count) = (table.order, table.rows);
        self.rows.fill(0.0);
        self.rows_by.fill(0.0);
        for row in 0..count {
            self.rows[row * order + table.entry(row)] = 1.0;
        }
        for k in 1..COEFFICIENTS {
            let (before, after) = self.rows.split_at_mut(k * count * order);
            let before = &before[(k - 1) * count * order..];
            for row in 0..count {
                let from = &before[row * order..][..order];
                let out = &mut after[row * order..][..order];
                row_times(from, &self.scaled, out);
                scale(out, 1.0 / k as f64);
            }
            if derivatives {
                let (before_by, after_by) = self.rows_by.split_at_mut(k * count * order);
                let before_by = &before_by[(k - 1) * count * order..];
                for row in 0..count {
                    let out = &mut after_by[row * order..][..order];
                    row_times(&before_by[row * order..][..order], &self.scaled, out);
                    add_row_times(&before[row * order..][..order], &self.scaled_by, out);
                    scale(out, 1.0 / k as f64);
                }
            }
        }
    }
}

impl Pair {
    fn set_identity(&mut self, order: usize) {
        self.by.fill(0.0);
        self.value.fill(0.0);
        for i in 0..order {
            self.value[i * order + i] = 1.0;
        }
    }

    fn scale(&mut self, factor: f64) {
        scale(&mut self.value, factor);
        scale(&mut self.by, factor);
    }

    fn add(&mut self, other: &Self) {
        for (out, x) in self.value.iter_mut().zip(&other.value) {
            *out += x;
        }
        for (out, x) in self.by.iter_mut().zip(&other.by) {
            *out += x;
        }
    }

    fn set_product(&mut self, a: &Self, b: &Self, derivatives: bool) {
        product(&a.value, &b.value, &mut self.value);
        if derivatives {
            product(&a.by, &b.value, &mut self.by);
            add_products(&a.value, &b.by, &mut self.by);
        }
    }
}

/// The series of every cell: rows times the exponential up to its middle.
fn fill_series(series: &mut [Polynomial], count: usize, rows: &[f64], middles: &[Pair]) {
    let order = middles[0].value.len().isqrt();
    series.fill([0.0; COEFFICIENTS]);
    for (cell, middle) in series.chunks_exact_mut(count * order).zip(middles) {
        add_series(cell, count, rows, &middle.value);
    }
}

/// The derivatives of the series of every cell.
fn fill_derivatives(series: &mut [Polynomial], count: usize, room: &Room) {
    let order = room.half.value.len().isqrt();
    series.fill([0.0; COEFFICIENTS]);
    for (cell, middle) in series.chunks_exact_mut(count * order).zip(&room.middles) {
        add_series(cell, count, &room.rows_by, &middle.value);
        add_series(cell, count, &room.rows, &middle.by);
    }
}

fn add_series(cell: &mut [Polynomial], count: usize, rows: &[f64], middle: &[f64]) {
    let order = middle.len().isqrt();
    for (index, row) in rows.chunks_exact(order).enumerate() {
        let (k, i) = (index / count, index % count);
        for (factor, from) in row.iter().zip(middle.chunks_exact(order)) {
            if *factor == 0.0 {
                continue;
            }
            for (m, x) in from.iter().enumerate() {
                cell[i * order + m][k] += factor * x;
            }
        }
    }
}

fn scale(out: &mut [f64], factor: f64) {
    for x in out {
        *x *= factor;
    }
}

/// `row^T matrix`
fn row_times(row: &[f64], matrix: &[f64], out: &mut [f64]) {
    out.fill(0.0);
    add_row_times(row, matrix, out);
}

fn add_row_times(row: &[f64], matrix: &[f64], out: &mut [f64]) {
    for (factor, from) in row.iter().zip(matrix.chunks_exact(row.len())) {
        // Many entries are zeros: the constant and the waves are not moved by the others.
        if *factor == 0.0 {
            continue;
        }
        for (out, x) in out.iter_mut().zip(from) {
            *out += factor * x;
        }
    }
}

fn product(a: &[f64], b: &[f64], out: &mut [f64]) {
    let order = a.len().isqrt();
    for (row, out) in a.chunks_exact(order).zip(out.chunks_exact_mut(order)) {
        row_times(row, b, out);
    }
}

fn add_products(a: &[f64], b: &[f64], out: &mut [f64]) {
    let order = a.len().isqrt();
    for (row, out) in a.chunks_exact(order).zip(out.chunks_exact_mut(order)) {
        add_row_times(row, b, out);
    }
}
