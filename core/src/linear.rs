//! Dense linear systems without allocation.
//!
//! nalgebra's factorisations take their matrix by value and so allocate one at every call; inside Newton's loop the
//! matrix is factorised where it lies.

/// A square matrix, row by row.
#[derive(Debug, Clone)]
pub struct Matrix {
    order: usize,
    entries: Vec<f64>,
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
        Self {
            order,
            entries: vec![0.0; order * order],
        }
    }

    /// Sets every entry to zero.
    pub fn clear(&mut self) {
        self.entries.fill(0.0);
    }

    /// One row.
    pub fn row(&self, row: usize) -> &[f64] {
        &self.entries[row * self.order..][..self.order]
    }

    /// One row, to be written.
    pub fn row_mut(&mut self, row: usize) -> &mut [f64] {
        &mut self.entries[row * self.order..][..self.order]
    }

    /// Two different rows, to be written; `first < second`.
    pub fn two_rows_mut(&mut self, first: usize, second: usize) -> (&mut [f64], &mut [f64]) {
        let (head, tail) = self.entries.split_at_mut(second * self.order);
        (
            &mut head[first * self.order..][..self.order],
            &mut tail[..self.order],
        )
    }
}

/// Factors of `P A = L U`, in place of `A`.
///
/// Source: Golub and Van Loan (2013), Matrix Computations, section 3.4: outer-product elimination with partial
/// pivoting; the pivot is compared relative to the largest entry of its row, so that equations in different units
/// count alike.
#[derive(Debug, Clone)]
pub struct Lu {
    pivots: Vec<usize>,
    scales: Vec<f64>,
}

impl Lu {
    /// Room for matrices of one order.
    pub fn new(order: usize) -> Self {
        Self {
            pivots: vec![0; order],
            scales: vec![0.0; order],
        }
    }

    /// Factorises in place.
    ///
    /// # Errors
    /// [`Singular`] if a pivot is not a number or vanishes relative to its row; the matrix is then partly overwritten.
    pub fn factorise(&mut self, matrix: &mut Matrix) -> Result<(), Singular> {
        let n = matrix.order;
        for (row, scale) in self.scales.iter_mut().enumerate() {
            let largest = matrix.row(row).iter().fold(0.0_f64, |m, x| m.max(x.abs()));
            *scale = if largest > 0.0 { 1.0 / largest } else { 0.0 };
        }
        for column in 0..n {
            let (pivot_row, size) = self.choose_pivot(matrix, column);
            if !(size > f64::EPSILON * 1e-3 && size.is_finite()) {
                return Err(Singular {
                    column,
                    pivot: size,
                });
            }
            self.pivots[column] = pivot_row;
            if pivot_row != column {
                let (a, b) = matrix.two_rows_mut(column, pivot_row);
                a.swap_with_slice(b);
                self.scales.swap(column, pivot_row);
            }
            eliminate_below(matrix, column);
        }
        Ok(())
    }

    fn choose_pivot(&self, matrix: &Matrix, column: usize) -> (usize, f64) {
        let mut best = (column, -1.0);
        for row in column..matrix.order {
            let size = matrix.entries[row * matrix.order + column].abs() * self.scales[row];
            // A NaN becomes the pivot too, and is then reported.
            if size > best.1 || size.is_nan() {
                best = (row, size);
            }
        }
        best
    }

    /// Solves `A x = b` in place with the factors that [`Lu::factorise`] left in `matrix`.
    pub fn solve(&self, matrix: &Matrix, b: &mut [f64]) {
        for (column, &pivot) in self.pivots.iter().enumerate() {
            b.swap(column, pivot);
        }
        for row in 1..matrix.order {
            let known: f64 = dot(&matrix.row(row)[..row], &b[..row]);
            b[row] -= known;
        }
        for row in (0..matrix.order).rev() {
            let entries = matrix.row(row);
            let known: f64 = dot(&entries[row + 1..], &b[row + 1..]);
            b[row] = (b[row] - known) / entries[row];
        }
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

/// Subtracts multiples of the pivot row from the rows below it, and stores the multipliers.
fn eliminate_below(matrix: &mut Matrix, column: usize) {
    let n = matrix.order;
    let (above, below) = matrix.entries.split_at_mut((column + 1) * n);
    let pivot_row = &above[column * n..];
    let reciprocal = 1.0 / pivot_row[column];
    for row in below.chunks_exact_mut(n) {
        let factor = row[column] * reciprocal;
        row[column] = factor;
        if factor != 0.0 {
            for (x, p) in row[column + 1..].iter_mut().zip(&pivot_row[column + 1..]) {
                *x -= factor * p;
            }
        }
    }
}

/// Scalar product, summed in four lanes so that it vectorises.
pub fn dot(a: &[f64], b: &[f64]) -> f64 {
    let mut lanes = [0.0; 4];
    let (a4, b4) = (a.chunks_exact(4), b.chunks_exact(4));
    let rest: f64 = a4
        .remainder()
        .iter()
        .zip(b4.remainder())
        .map(|(x, y)| x * y)
        .sum();
    for (x, y) in a4.zip(b4) {
        for lane in 0..4 {
            lanes[lane] += x[lane] * y[lane];
        }
    }
    (lanes[0] + lanes[1]) + (lanes[2] + lanes[3]) + rest
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn random_matrix(order: usize, entries: &[f64]) -> Matrix {
        let mut matrix = Matrix::zeros(order);
        matrix.entries.copy_from_slice(&entries[..order * order]);
        matrix
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
            let reference = nalgebra::DMatrix::from_row_slice(order, order, &matrix.entries);
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
                let scale = reference.abs() * x.abs() + nalgebra::DVector::from_element(order, 1.0);
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
