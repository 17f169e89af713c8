//! The exponentials that tables are made from, with their derivatives by a variable.
//!
//! With `X = A h / 2`, of norm below one,
//!
//! ```text
//! exp(X) - 1 = X/1 (1 + X/2 (1 + X/3 (...)))                                                                  (1)
//! exp(a + b) - 1 = E_a + E_b + E_a E_b,    E = exp - 1                                                        (2)
//! ```
//!
//! and by (2) the exponentials over 1, 2, 4, ... cells, and from these that over every number of cells. Less the unit matrix, an
//! exponential has rounding errors relative to what it changes. In full they would double with every squaring: without damping,
//! energies would drift by twenty times as much.
//!
//! Source: Moler and Van Loan (2003), Nineteen dubious ways to compute the exponential of a matrix, SIAM Review 45, method 3
//! (scaling and squaring).

use multiversion::multiversion;

use super::table::{COEFFICIENTS, Polynomial, Table, cells};
use super::terms::Basis;

/// Terms of the exponential over half a cell: `0.225^14 / 14! = 1e-20` is left out.
const TERMS: usize = 13;

/// Rows and columns of a block of a product.
const ROWS: usize = 4;
const LANES: usize = 8;

/// Workspace to make tables: matrices of the order of `z`.
#[derive(Debug)]
pub(super) struct Workspace {
    /// `A h`
    scaled: Vec<f64>,
    scaled_by: Vec<f64>,
    /// Those over half a cell, the exponentials over 1, 2, 4, ... cells, and those up to the middle of every cell.
    pub(super) half: Pair,
    powers: Vec<Pair>,
    pub(super) middles: Vec<Pair>,
    next: Pair,
    /// `e_i (A h)^k / k!` for the tabulated rows, by row and column: a polynomial for every entry.
    rows: Vec<Polynomial>,
    rows_by: Vec<Polynomial>,
    pub(super) row: Vec<f64>,
    pub(super) other: Vec<f64>,
    row_by: Vec<f64>,
    other_by: Vec<f64>,
}

/// An exponential less the unit matrix, so that rounding errors are relative to what it changes; and its derivative by a variable.
#[derive(Debug, Clone)]
pub(super) struct Pair {
    pub(super) value: Vec<f64>,
    pub(super) by: Vec<f64>,
}

impl Workspace {
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
            next: pair,
            rows: vec![[0.0; COEFFICIENTS]; rows * order],
            rows_by: vec![[0.0; COEFFICIENTS]; rows * order],
            row: vec![0.0; order],
            other: vec![0.0; order],
            row_by: vec![0.0; order],
            other_by: vec![0.0; order],
        }
    }

    pub(super) fn set(&mut self, matrix: &[f64], by: Option<&[f64]>, time: f64) {
        for (out, x) in self.scaled.iter_mut().zip(matrix) {
            *out = x * time;
        }
        for (out, x) in self.scaled_by.iter_mut().zip(by.unwrap_or(&[])) {
            *out = x * time;
        }
    }

    /// The exponentials over half a cell, over powers of two of cells, and up to the middle of every cell.
    pub(super) fn exponentials(&mut self, derivatives: bool) {
        // (1)
        self.half.value.fill(0.0);
        self.half.by.fill(0.0);
        for k in (1..=TERMS).rev() {
            let factor = 0.5 / k as f64;
            self.next.value.copy_from_slice(&self.scaled);
            add_products(&self.scaled, &self.half.value, &mut self.next.value);
            scale(&mut self.next.value, factor);
            if derivatives {
                self.next.by.copy_from_slice(&self.scaled_by);
                add_products(&self.scaled_by, &self.half.value, &mut self.next.by);
                add_products(&self.scaled, &self.half.by, &mut self.next.by);
                scale(&mut self.next.by, factor);
            }
            std::mem::swap(&mut self.half, &mut self.next);
        }
        self.middles[0].value.fill(0.0);
        self.middles[0].by.fill(0.0);
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

    /// The exponential over the range of a table: to the end of its last cell.
    pub(super) fn range(&self, out: &mut Pair, derivatives: bool) {
        let last = &self.middles[self.middles.len() - 1];
        out.set_product(last, &self.half, derivatives);
    }

    /// The rows `e_i (A h)^k / k!`.
    pub(super) fn taylor(&mut self, table: &Table, derivatives: bool) {
        let order = table.order;
        for index in 0..table.rows {
            self.row.fill(0.0);
            self.row[table.entry(index)] = 1.0;
            self.row_by.fill(0.0);
            for k in 0..COEFFICIENTS {
                let entries = index * order..(index + 1) * order;
                for (polynomial, x) in self.rows[entries.clone()].iter_mut().zip(&self.row) {
                    polynomial[k] = *x;
                }
                for (polynomial, x) in self.rows_by[entries].iter_mut().zip(&self.row_by) {
                    polynomial[k] = *x;
                }
                let factor = 1.0 / (k + 1) as f64;
                row_times(&self.row, &self.scaled, &mut self.other);
                scale(&mut self.other, factor);
                if derivatives {
                    row_times(&self.row_by, &self.scaled, &mut self.other_by);
                    add_row_times(&self.row, &self.scaled_by, &mut self.other_by);
                    scale(&mut self.other_by, factor);
                    std::mem::swap(&mut self.row_by, &mut self.other_by);
                }
                std::mem::swap(&mut self.row, &mut self.other);
            }
        }
    }
}

impl Pair {
    /// (2)
    pub(super) fn set_product(&mut self, a: &Self, b: &Self, derivatives: bool) {
        sum(&a.value, &b.value, &mut self.value);
        add_products(&a.value, &b.value, &mut self.value);
        if derivatives {
            sum(&a.by, &b.by, &mut self.by);
            add_products(&a.by, &b.value, &mut self.by);
            add_products(&a.value, &b.by, &mut self.by);
        }
    }
}

fn sum(a: &[f64], b: &[f64], out: &mut [f64]) {
    for ((out, a), b) in out.iter_mut().zip(a).zip(b) {
        *out = a + b;
    }
}

/// The series of every cell: rows times the exponential up to its middle.
pub(super) fn fill_series(series: &mut [Polynomial], workspace: &Workspace) {
    let cells = series.chunks_exact_mut(workspace.rows.len());
    for (cell, middle) in cells.zip(&workspace.middles) {
        cell.copy_from_slice(&workspace.rows);
        add_series(cell, &workspace.rows, &middle.value);
    }
}

/// The derivatives of the series of every cell.
pub(super) fn fill_derivatives(series: &mut [Polynomial], workspace: &Workspace) {
    let cells = series.chunks_exact_mut(workspace.rows.len());
    for (cell, middle) in cells.zip(&workspace.middles) {
        cell.copy_from_slice(&workspace.rows_by);
        add_series(cell, &workspace.rows_by, &middle.value);
        add_series(cell, &workspace.rows, &middle.by);
    }
}

#[multiversion(targets("x86_64+avx512f", "x86_64+avx2"))]
fn add_series(cell: &mut [Polynomial], rows: &[Polynomial], middle: &[f64]) {
    let order = middle.len().isqrt();
    for (out, row) in cell.chunks_exact_mut(order).zip(rows.chunks_exact(order)) {
        for (m, out) in out.iter_mut().enumerate() {
            // In registers, as long as it grows.
            let mut sum = *out;
            for (polynomial, factors) in row.iter().zip(middle.chunks_exact(order)) {
                let factor = factors[m];
                for k in 0..COEFFICIENTS {
                    sum[k] += factor * polynomial[k];
                }
            }
            *out = sum;
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

#[multiversion(targets("x86_64+avx512f", "x86_64+avx2"))]
pub(super) fn add_row_times(row: &[f64], matrix: &[f64], out: &mut [f64]) {
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

/// Adds the product of two matrices, row by row, in blocks of rows and columns whose sums stay in registers.
#[multiversion(targets("x86_64+avx512f", "x86_64+avx2"))]
fn add_products(a: &[f64], b: &[f64], out: &mut [f64]) {
    let order = a.len().isqrt();
    let whole = order - order % ROWS;
    let (rows, rest) = a.split_at(whole * order);
    let (out, out_rest) = out.split_at_mut(whole * order);
    for (a, out) in (rows.chunks_exact(ROWS * order)).zip(out.chunks_exact_mut(ROWS * order)) {
        add_rows::<ROWS>(order, a, b, out);
    }
    for (a, out) in rest
        .chunks_exact(order)
        .zip(out_rest.chunks_exact_mut(order))
    {
        add_rows::<1>(order, a, b, out);
    }
}

/// The same of some rows: columns by lanes, and those that are left at once.
#[inline(always)]
#[allow(
    clippy::inline_always,
    reason = "what is not inlined is not compiled for the instruction set of its caller"
)]
fn add_rows<const COUNT: usize>(order: usize, a: &[f64], b: &[f64], out: &mut [f64]) {
    let whole = order - order % LANES;
    for column in (0..whole).step_by(LANES) {
        add_block::<COUNT, LANES>(order, column, a, b, out);
    }
    // Orders are odd: two for each coordinate and each wave, and the constant.
    match order - whole {
        1 => add_block::<COUNT, 1>(order, whole, a, b, out),
        3 => add_block::<COUNT, 3>(order, whole, a, b, out),
        5 => add_block::<COUNT, 5>(order, whole, a, b, out),
        7 => add_block::<COUNT, 7>(order, whole, a, b, out),
        _ => {
            for column in whole..order {
                add_block::<COUNT, 1>(order, column, a, b, out);
            }
        }
    }
}

/// The same of so many columns from one on.
#[inline(always)]
#[allow(
    clippy::inline_always,
    reason = "what is not inlined is not compiled for the instruction set of its caller"
)]
fn add_block<const COUNT: usize, const WIDTH: usize>(
    order: usize,
    column: usize,
    a: &[f64],
    b: &[f64],
    out: &mut [f64],
) {
    let mut sums = [[0.0; WIDTH]; COUNT];
    for (sums, out) in sums.iter_mut().zip(out.chunks_exact(order)) {
        sums.copy_from_slice(&out[column..][..WIDTH]);
    }
    for (k, b) in b.chunks_exact(order).enumerate() {
        let b = &b[column..][..WIDTH];
        for (row, sums) in sums.iter_mut().enumerate() {
            let factor = a[row * order + k];
            for l in 0..WIDTH {
                sums[l] += factor * b[l];
            }
        }
    }
    for (out, sums) in out.chunks_exact_mut(order).zip(&sums) {
        out[column..][..WIDTH].copy_from_slice(sums);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::testing::random::Random;

    #[test]
    fn products_are_those_of_three_loops() {
        let mut random = Random::seeded(5);
        for order in 1..=20 {
            let mut matrix = || -> Vec<f64> {
                (0..order * order)
                    .map(|_| random.between(-1.0, 1.0))
                    .collect()
            };
            let (a, b, mut out) = (matrix(), matrix(), matrix());
            let mut expected = out.clone();
            for i in 0..order {
                for j in 0..order {
                    for k in 0..order {
                        expected[i * order + j] += a[i * order + k] * b[k * order + j];
                    }
                }
            }
            add_products(&a, &b, &mut out);
            assert_eq!(out, expected, "{order}");
        }
    }
}
