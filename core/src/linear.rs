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
#![allow(
    clippy::inline_always,
    reason = "what is not inlined is not compiled for the instruction set of its caller"
)]

use std::hint::select_unpredictable;

use multiversion::multiversion;

/// Entries are handled in groups of this many; it is the width of a panel too.
const LANES: usize = 8;

/// Rows that meet the panel at once: with a group of the panel they fill sixteen registers of four entries.
const TILE: usize = 6;

type Group = [f64; LANES];

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
#[non_exhaustive]
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
#[derive(Debug, Clone)]
pub struct Lu {
    pivots: Vec<usize>,
    scales: Vec<f64>,
    /// Of the diagonal of `U`.
    reciprocals: Vec<f64>,
}

impl Lu {
    /// Room for matrices of one order.
    pub fn new(order: usize) -> Self {
        Self {
            pivots: vec![0; order],
            scales: vec![0.0; order],
            reciprocals: vec![0.0; order],
        }
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

#[multiversion(targets("x86_64+avx512f", "x86_64+avx2"))]
fn eliminate(matrix: &mut Matrix, lu: &mut Lu) -> Result<(), Singular> {
    let width = matrix.width();
    for (row, scale) in lu.scales.iter_mut().enumerate() {
        let mut sizes = [0.0; LANES];
        for x in &matrix.groups()[row * width..][..width] {
            for l in 0..LANES {
                sizes[l] = not_less(x[l].abs(), sizes[l]);
            }
        }
        for half in [4, 2, 1] {
            for l in 0..half {
                sizes[l] = not_less(sizes[l], sizes[l + half]);
            }
        }
        let largest = sizes[0];
        *scale = if largest > 0.0 { 1.0 / largest } else { 0.0 };
    }
    for panel in 0..width {
        eliminate_panel(matrix, panel, lu)?;
        if panel + 1 < width {
            let (above, below) = matrix
                .groups_mut()
                .split_at_mut((panel + 1) * LANES * width);
            let pivot_rows = &mut above[panel * LANES * width..];
            eliminate_right(pivot_rows, width, panel);
            let mut tiles = below.chunks_exact_mut(TILE * width);
            for rows in &mut tiles {
                eliminate_below::<TILE>(rows, pivot_rows, width, panel);
            }
            for row in tiles.into_remainder().chunks_exact_mut(width) {
                eliminate_below::<1>(row, pivot_rows, width, panel);
            }
        }
    }
    Ok(())
}

/// The larger of two numbers; the second if the first is a NaN.
#[inline(always)]
fn not_less(x: f64, y: f64) -> f64 {
    if x > y { x } else { y }
}

/// A row and the size of its candidate for the pivot.
#[derive(Clone, Copy)]
struct Candidate {
    row: usize,
    /// Numbers that are not negative are in the order of their bits, and a NaN is above them all: it becomes the pivot,
    /// and is then reported.
    size: u64,
}

impl Candidate {
    const NONE: Self = Self { row: 0, size: 0 };

    #[inline(always)]
    fn or(self, row: usize, entry: f64, scale: f64) -> Self {
        let size = (entry * scale).abs().to_bits();
        let larger = size > self.size;
        Self {
            row: select_unpredictable(larger, row, self.row),
            size: select_unpredictable(larger, size, self.size),
        }
    }
}

/// Eliminates the columns of one panel from each other, and exchanges whole rows.
#[inline(always)]
fn eliminate_panel(matrix: &mut Matrix, panel: usize, lu: &mut Lu) -> Result<(), Singular> {
    let (pivots, scales) = (&mut lu.pivots[..], &mut lu.scales[..]);
    let (n, width) = (matrix.order, matrix.width());
    let first = panel * LANES;
    let mut best = Candidate::NONE;
    for row in first..n {
        best = best.or(row, matrix.groups()[row * width + panel][0], scales[row]);
    }
    for column in first..n.min(first + LANES) {
        let (pivot_row, size) = (best.row, f64::from_bits(best.size));
        if !(size > f64::EPSILON * 1e-3 && size.is_finite()) {
            return Err(Singular {
                column,
                pivot: size,
            });
        }
        pivots[column] = pivot_row;
        if pivot_row != column {
            let (head, tail) = matrix.groups_mut().split_at_mut(pivot_row * width);
            head[column * width..][..width].swap_with_slice(&mut tail[..width]);
            scales.swap(column, pivot_row);
        }
        let lane = column - first;
        let (above, below) = matrix.groups_mut().split_at_mut((column + 1) * width);
        let pivot = &above[column * width + panel];
        lu.reciprocals[column] = 1.0 / pivot[lane];
        best = eliminate_column(below, pivot, lane, (width, panel), &scales[column + 1..]);
        best.row += column + 1;
    }
    Ok(())
}

/// Subtracts multiples of the pivot row from the rows below it, within a panel, and stores the multipliers. Returns the
/// best candidate of the next column.
#[inline(always)]
fn eliminate_column(
    below: &mut [Group],
    pivot: &Group,
    lane: usize,
    (width, panel): (usize, usize),
    scales: &[f64],
) -> Candidate {
    let reciprocal = 1.0 / pivot[lane];
    // The multipliers of the columns before stay: nothing is subtracted. The new one comes out of `0 - factor (-1)`.
    let (mut kept, mut subtrahend) = ([1.0; LANES], *pivot);
    for l in 0..LANES {
        kept[l] = if l == lane { 0.0 } else { 1.0 };
        let fixed = if l == lane { -1.0 } else { 0.0 };
        subtrahend[l] = if l > lane { pivot[l] } else { fixed };
    }
    let next = (lane + 1) % LANES;
    let mut best = Candidate::NONE;
    for (row, (groups, scale)) in below.chunks_exact_mut(width).zip(scales).enumerate() {
        let x = &mut groups[panel];
        let factor = x[lane] * reciprocal;
        // The same operations as below, apart, so that the candidate need not wait for the group to be stored.
        best = best.or(row, x[next] - factor * pivot[next], *scale);
        for l in 0..LANES {
            x[l] = x[l] * kept[l] - factor * subtrahend[l];
        }
    }
    best
}

/// Eliminates the panel from its own rows, to the right of it: `U = L^-1 A`.
#[inline(always)]
fn eliminate_right(pivot_rows: &mut [Group], width: usize, panel: usize) {
    let factors: [Group; LANES] = std::array::from_fn(|row| pivot_rows[row * width + panel]);
    for g in panel + 1..width {
        let mut x: [Group; LANES] = std::array::from_fn(|row| pivot_rows[row * width + g]);
        for row in 1..LANES {
            for k in 0..row {
                for l in 0..LANES {
                    x[row][l] -= factors[row][k] * x[k][l];
                }
            }
        }
        for row in 1..LANES {
            pivot_rows[row * width + g] = x[row];
        }
    }
}

/// Eliminates the panel from `R` rows below it, to the right of it.
#[inline(always)]
fn eliminate_below<const R: usize>(
    rows: &mut [Group],
    pivot_rows: &[Group],
    width: usize,
    panel: usize,
) {
    let factors: [Group; R] = std::array::from_fn(|r| rows[r * width + panel]);
    for g in panel + 1..width {
        let mut x: [Group; R] = std::array::from_fn(|r| rows[r * width + g]);
        for k in 0..LANES {
            let u = pivot_rows[k * width + g];
            for r in 0..R {
                for l in 0..LANES {
                    x[r][l] -= factors[r][k] * u[l];
                }
            }
        }
        for r in 0..R {
            rows[r * width + g] = x[r];
        }
    }
}

/// Solves `L U x = b` in place.
///
/// What is known from other groups is a sum in lanes, which need not wait for the row before; what is known from the
/// group of the row itself is subtracted one by one, the latest last.
#[multiversion(targets("x86_64+avx512f", "x86_64+avx2"))]
fn substitute(matrix: &Matrix, reciprocals: &[f64], b: &mut [f64]) {
    let (n, width) = (matrix.order, matrix.width());
    for (row, groups) in matrix.groups().chunks_exact(width.max(1)).enumerate() {
        let panel = row / LANES;
        let (known, here) = b.split_at_mut(panel * LANES);
        let sum = add_products([0.0; LANES], &groups[..panel], known.as_chunks().0);
        let (here, value) = here[..=row % LANES].split_at_mut(row % LANES);
        value[0] -= total(&sum);
        for (x, factor) in here.iter().zip(&groups[panel]) {
            value[0] -= factor * x;
        }
    }
    // The last group, filled up with zeros.
    let mut last = [0.0; LANES];
    for (row, groups) in (0..n).zip(matrix.groups().chunks_exact(width.max(1))).rev() {
        let (panel, lane) = (row / LANES, row % LANES);
        let (here, known) = b[panel * LANES..].split_at_mut(LANES.min(n - panel * LANES));
        let mut sum = [0.0; LANES];
        if panel + 1 < width {
            sum = add_products(sum, &groups[panel + 1..], known.as_chunks().0);
            if n % LANES > 0 {
                sum = add_products(sum, &groups[width - 1..], &[last]);
            }
        }
        let (value, here) = here[lane..].split_at_mut(1);
        value[0] -= total(&sum);
        for (x, factor) in here.iter().zip(&groups[panel][lane + 1..]).rev() {
            value[0] -= factor * x;
        }
        value[0] *= reciprocals[row];
        if panel + 1 == width {
            last[lane] = value[0];
        }
    }
}

/// Scalar product, summed in lanes.
#[multiversion(targets("x86_64+avx512f", "x86_64+avx2"))]
pub fn dot(a: &[f64], b: &[f64]) -> f64 {
    let ((a, a_rest), (b, b_rest)) = (a.as_chunks(), b.as_chunks());
    let rest: f64 = a_rest.iter().zip(b_rest).map(|(x, y)| x * y).sum();
    total(&add_products([0.0; LANES], a, b)) + rest
}

/// Scalar product of three lists, as long as the shortest, summed in lanes.
#[multiversion(targets("x86_64+avx512f", "x86_64+avx2"))]
pub fn weighted_dot(weights: &[f64], a: &[f64], b: &[f64]) -> f64 {
    let n = weights.len().min(a.len()).min(b.len());
    let ((w, w_rest), (a, a_rest), (b, b_rest)) = (
        weights[..n].as_chunks::<LANES>(),
        a[..n].as_chunks::<LANES>(),
        b[..n].as_chunks::<LANES>(),
    );
    let rest = w_rest.iter().zip(a_rest).zip(b_rest);
    let rest: f64 = rest.map(|((w, x), y)| w * x * y).sum();
    let mut sum = [0.0; LANES];
    for ((w, x), y) in w.iter().zip(a).zip(b) {
        for l in 0..LANES {
            sum[l] += w[l] * x[l] * y[l];
        }
    }
    total(&sum) + rest
}

/// Adds the products of two lists of groups, lane by lane; the longer one is cut.
#[inline(always)]
fn add_products(mut sum: Group, a: &[Group], b: &[Group]) -> Group {
    for (x, y) in a.iter().zip(b) {
        for l in 0..LANES {
            sum[l] += x[l] * y[l];
        }
    }
    sum
}

#[inline(always)]
fn total(lanes: &Group) -> f64 {
    ((lanes[0] + lanes[4]) + (lanes[2] + lanes[6]))
        + ((lanes[1] + lanes[5]) + (lanes[3] + lanes[7]))
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn random_matrix(order: usize, entries: &[f64]) -> Matrix {
        let mut matrix = Matrix::zeros(order);
        for row in 0..order {
            let entries = &entries[row * order..][..order];
            matrix.row_mut(row).copy_from_slice(entries);
        }
        matrix
    }

    fn dense(matrix: &Matrix) -> nalgebra::DMatrix<f64> {
        nalgebra::DMatrix::from_fn(matrix.order, matrix.order, |i, j| matrix.row(i)[j])
    }

    proptest! {
        #[test]
        fn agrees_with_nalgebra(
            order in 1_usize..12,
            entries in prop::collection::vec(-1.0..1.0_f64, 144),
            rhs in prop::collection::vec(-1.0..1.0_f64, 12),
            units in prop::collection::vec(-6..6_i32, 12),
        ) {
            let mut matrix = random_matrix(order, &entries);
            for (row, unit) in (0..order).zip(&units) {
                for x in matrix.row_mut(row) {
                    *x *= 10_f64.powi(*unit);
                }
            }
            let reference = dense(&matrix);
            let mut x = rhs[..order].to_vec();
            let mut lu = Lu::new(order);
            let condition = {
                let s = reference.clone().svd(false, false).singular_values;
                s.max() / s.min()
            };
            if lu.factorise(&mut matrix).is_ok() {
                lu.solve(&matrix, &mut x);
                let x = nalgebra::DVector::from_vec(x);
                let residual = &reference * &x - nalgebra::DVector::from_column_slice(&rhs[..order]);
                // |L| |U| is of the size of the largest entry of its row, where the matrix itself may have a zero
                // (Higham (2002), Accuracy and Stability of Numerical Algorithms, theorem 9.4).
                let size = x.abs().sum();
                let scale = nalgebra::DVector::from_fn(order, |i, _| {
                    reference.row(i).amax() * size + 1.0
                });
                for (r, s) in residual.iter().zip(scale.iter()) {
                    prop_assert!(r.abs() <= 1e-13 * s, "{r:e} of {s:e}");
                }
                let mut y = rhs[..order].to_vec();
                lu.solve_transposed(&matrix, &mut y);
                let y = nalgebra::DVector::from_vec(y);
                let b = nalgebra::DVector::from_column_slice(&rhs[..order]);
                let bound = reference.abs().transpose() * y.abs() + b.abs();
                // Pivoting is by rows, so the transposed system is solved to the norm, not row by row.
                let residual = (reference.transpose() * &y - b).amax();
                prop_assert!(residual <= 1e-11 * bound.amax().max(1.0), "{residual:e}");
            } else {
                prop_assert!(condition > 1e12);
            }
        }
    }

    /// Tiles and panels, whole ones and what is left of them.
    #[test]
    fn large_systems_agree_with_nalgebra() {
        for order in [40, 97] {
            let entries: Vec<f64> = (0..order * order)
                .map(|i| (i as f64).powi(2).sin())
                .collect();
            let mut matrix = random_matrix(order, &entries);
            let reference = dense(&matrix);
            let b = nalgebra::DVector::from_fn(order, |i, _| 1.0 + (i as f64).cos());
            let condition = {
                let s = reference.clone().svd(false, false).singular_values;
                s.max() / s.min()
            };
            let mut lu = Lu::new(order);
            lu.factorise(&mut matrix).unwrap();
            let transpose = reference.transpose();
            for (transposed, reference) in [(false, reference), (true, transpose)] {
                let mut x = b.clone();
                if transposed {
                    lu.solve_transposed(&matrix, x.as_mut_slice());
                } else {
                    lu.solve(&matrix, x.as_mut_slice());
                }
                let expected = reference.lu().solve(&b).unwrap();
                // A backward error of a rounding error for each term, in either solution.
                let bound = 2.0 * f64::EPSILON * order as f64 * condition * expected.norm();
                let difference = (x - expected).norm();
                assert!(difference <= bound, "{difference:e} of {bound:e}");
            }
        }
    }

    #[test]
    fn a_failure_leaves_nothing_behind() {
        let order = 9;
        let mut matrix = Matrix::zeros(order);
        // The multiplier of the second row overflows.
        for row in 0..order {
            matrix
                .row_mut(row)
                .fill(10_f64.powi(if row == 0 { -300 } else { 300 }));
        }
        let mut lu = Lu::new(order);
        assert!(lu.factorise(&mut matrix).is_err());
        for row in 0..order {
            matrix.row_mut(row).fill(0.0);
            matrix.row_mut(row)[order - 1 - row] = 2.0;
        }
        let mut x: Vec<f64> = (0..order).map(|i| i as f64).collect();
        lu.factorise(&mut matrix).unwrap();
        lu.solve(&matrix, &mut x);
        for (i, x) in x.iter().enumerate() {
            assert_eq!(*x, (order - 1 - i) as f64 / 2.0);
        }
    }

    #[test]
    fn refuses_singular_matrices_and_nan() {
        let mut zero_column = random_matrix(2, &[1.0, 0.0, 3.0, 0.0]);
        assert_eq!(
            Lu::new(2).factorise(&mut zero_column).unwrap_err().column,
            1
        );
        let mut nan = random_matrix(2, &[f64::NAN, 1.0, 1.0, 1.0]);
        assert!(Lu::new(2).factorise(&mut nan).is_err());
        assert!(Lu::new(1).factorise(&mut Matrix::zeros(1)).is_err());
    }

    #[test]
    fn the_empty_system_has_the_empty_solution() {
        let mut empty = Matrix::zeros(0);
        let mut lu = Lu::new(0);
        assert!(lu.factorise(&mut empty).is_ok());
        lu.solve(&empty, &mut []);
    }
}
