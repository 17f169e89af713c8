//! Dense linear systems without allocation.
//!
//! nalgebra's factorisations take their matrix by value and so allocate one at every call; inside Newton's loop the
//! matrix is factorised where it lies.
//!
//! Rows are stored in whole groups of eight entries. Elimination takes eight columns at a time: first among themselves
//! (the panel), then all that they do to the columns on their right, a few rows at once, with the entries in registers.
//! Plain loops over groups, compiled once for each instruction set and chosen at run time. The order of every sum is
//! written out and nothing is fused, so the results are the same on all of them.
//!
//! Source: Golub and Van Loan (2013), Matrix Computations, sections 3.2.11 and 3.4.

mod eliminate;
mod products;
#[cfg(test)]
mod tests;
mod wide;

use eliminate::{eliminate, substitute, substitute_groups};
pub(crate) use products::inlined_dot;
pub use products::{dot, times_columns, weighted_dot};
pub(crate) use wide::{Placed, add_product};

/// Entries are handled in groups of this many; it is the width of a panel too.
pub const LANES: usize = 8;

/// Entries of a row, or of several right-hand sides.
pub type Group = [f64; LANES];

/// A square matrix, row by row.
#[derive(Debug)]
pub struct Matrix {
    order: usize,
    /// Each row is filled up to whole groups, with zeros.
    entries: Vec<f64>,
    /// Where the first group is: on a line of the cache, so that no group lies on two.
    start: usize,
}

/// The matrix could not be factorised.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Singular {
    /// Column without a usable pivot.
    pub column: usize,
    /// The largest candidate there, relative to the row it stands in.
    pub pivot: f64,
}

impl Matrix {
    /// A zero matrix.
    pub fn zeros(order: usize) -> Self {
        let length = order * order.next_multiple_of(LANES);
        let entries = vec![0.0; length + LANES - 1];
        // Bytes in a line, and in an entry.
        let start = (entries.as_ptr().addr().wrapping_neg() % 64) / 8;
        Self {
            order,
            entries,
            start,
        }
    }

    /// Sets every entry to zero.
    pub fn clear(&mut self) {
        self.entries.fill(0.0);
    }

    /// One row.
    pub fn row(&self, row: usize) -> &[f64] {
        &self.entries[self.start + row * self.stride()..][..self.order]
    }

    /// One row, to be written.
    pub fn row_mut(&mut self, row: usize) -> &mut [f64] {
        let stride = self.stride();
        &mut self.entries[self.start + row * stride..][..self.order]
    }

    /// Two different rows, to be written; `first < second`.
    pub fn two_rows_mut(&mut self, first: usize, second: usize) -> (&mut [f64], &mut [f64]) {
        let (start, stride) = (self.start, self.stride());
        let (head, tail) = self.entries.split_at_mut(start + second * stride);
        (
            &mut head[start + first * stride..][..self.order],
            &mut tail[..self.order],
        )
    }

    fn groups(&self) -> &[Group] {
        self.entries[self.start..].as_chunks().0
    }

    fn groups_mut(&mut self) -> &mut [Group] {
        self.entries[self.start..].as_chunks_mut().0
    }

    /// Entries from one row to the next.
    fn stride(&self) -> usize {
        self.order.next_multiple_of(LANES)
    }

    /// Clears what fills the rows. A factor that is not finite writes a NaN there, and always ends in [`Singular`]: the
    /// next column finds it.
    fn clear_fill(&mut self) {
        let (order, width) = (self.order, self.width());
        for groups in self.groups_mut().chunks_exact_mut(width.max(1)) {
            groups.as_flattened_mut()[order..].fill(0.0);
        }
    }

    /// Groups in a row.
    fn width(&self) -> usize {
        self.order.div_ceil(LANES)
    }
}

impl Clone for Matrix {
    fn clone(&self) -> Self {
        let mut copy = Self::zeros(self.order);
        copy.groups_mut().copy_from_slice(self.groups());
        copy
    }

    /// Copies in place if the orders are the same.
    fn clone_from(&mut self, source: &Self) {
        if self.order == source.order {
            self.groups_mut().copy_from_slice(source.groups());
        } else {
            *self = source.clone();
        }
    }
}

/// Factors of `P A = L U`, in place of `A`.
///
/// Pivoting is partial. The pivot is compared relative to the largest entry of its row, so that equations in different
/// units count alike.
#[derive(Debug)]
pub struct Lu {
    pivots: Vec<usize>,
    scales: Vec<f64>,
    /// Of the diagonal of `U`.
    reciprocals: Vec<f64>,
}

impl Clone for Lu {
    fn clone(&self) -> Self {
        Self {
            pivots: self.pivots.clone(),
            scales: self.scales.clone(),
            reciprocals: self.reciprocals.clone(),
        }
    }

    /// Copies in place if the orders are the same.
    fn clone_from(&mut self, source: &Self) {
        self.pivots.clone_from(&source.pivots);
        self.scales.clone_from(&source.scales);
        self.reciprocals.clone_from(&source.reciprocals);
    }
}

impl Lu {
    /// Workspace for matrices of one order.
    pub fn new(order: usize) -> Self {
        Self {
            pivots: vec![0; order],
            scales: vec![0.0; order],
            reciprocals: vec![0.0; order],
        }
    }

    /// Order of its matrices.
    pub fn order(&self) -> usize {
        self.pivots.len()
    }

    /// Factorises in place.
    ///
    /// # Errors
    /// [`Singular`] if a pivot is not a number or vanishes relative to its row; the matrix is then partly overwritten.
    pub fn factorise(&mut self, matrix: &mut Matrix) -> Result<(), Singular> {
        let result = eliminate(matrix, self);
        if result.is_err() {
            matrix.clear_fill();
        }
        result
    }

    /// The largest entry of that row, the last one aside, whose largest entry is smallest; of the matrix before it was factorised.
    pub fn smallest_row(&self) -> f64 {
        let mut last = self.pivots.len().saturating_sub(1);
        for (column, &pivot) in self.pivots.iter().enumerate() {
            if pivot == last {
                last = column;
            } else if column == last {
                last = pivot;
            }
        }
        let others = self
            .scales
            .iter()
            .enumerate()
            .filter(|(row, _)| *row != last);
        others
            .fold(0.0_f64, |most, (_, scale)| most.max(*scale))
            .recip()
    }

    /// Sign of the determinant and logarithm of its size, from the factors that [`Lu::factorise`] left in `matrix`.
    pub fn determinant(&self, matrix: &Matrix) -> (f64, f64) {
        let pivots = self.pivots.iter().enumerate();
        pivots.fold((1.0, 0.0), |(sign, size), (column, &pivot)| {
            let x = matrix.row(column)[column];
            let swapped = if pivot == column { 1.0 } else { -1.0 };
            (sign * swapped * x.signum(), size + x.abs().ln())
        })
    }

    /// Solves `A x = b` in place with the factors that [`Lu::factorise`] left in `matrix`.
    pub fn solve(&self, matrix: &Matrix, b: &mut [f64]) {
        for (column, &pivot) in self.pivots.iter().enumerate() {
            b.swap(column, pivot);
        }
        substitute(matrix, &self.reciprocals, b);
    }

    /// The same for as many right-hand sides at once as a group has entries.
    pub fn solve_groups(&self, matrix: &Matrix, b: &mut [Group]) {
        for (column, &pivot) in self.pivots.iter().enumerate() {
            b.swap(column, pivot);
        }
        substitute_groups(matrix, &self.reciprocals, b);
    }

    /// Solves `A^T x = b` in place with the same factors.
    pub fn solve_transposed(&self, matrix: &Matrix, b: &mut [f64]) {
        let n = matrix.order;
        for column in 0..n {
            let entries = matrix.row(column);
            b[column] /= entries[column];
            let known = b[column];
            for (x, factor) in b[column + 1..].iter_mut().zip(&entries[column + 1..]) {
                *x -= factor * known;
            }
        }
        for column in (1..n).rev() {
            let known = b[column];
            for (x, factor) in b[..column].iter_mut().zip(&matrix.row(column)[..column]) {
                *x -= factor * known;
            }
        }
        for (column, &pivot) in self.pivots.iter().enumerate().rev() {
            b.swap(column, pivot);
        }
    }
}
