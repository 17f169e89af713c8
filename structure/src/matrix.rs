//! Sparse matrices, column by column.

/// A sparse matrix: of each column the rows in ascending order, each once.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct SparseMatrix {
    rows: usize,
    starts: Vec<usize>,
    row_of: Vec<usize>,
    values: Vec<f64>,
}

/// Why entries make no matrix.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum MatrixError {
    /// An entry stands outside.
    #[error(
        "an entry stands in row {row} and column {column}, counted from zero; the matrix is {rows} by {columns}"
    )]
    Outside {
        /// Its row.
        row: usize,
        /// Its column.
        column: usize,
        /// Rows of the matrix.
        rows: usize,
        /// Columns of the matrix.
        columns: usize,
    },
    /// An entry is infinite or not a number.
    #[error("the entry in row {row} and column {column}, counted from zero, is {value}")]
    NotFinite {
        /// Its row.
        row: usize,
        /// Its column.
        column: usize,
        /// The number.
        value: f64,
    },
}

/// Whether an entry can stand in a matrix of so many rows and columns.
///
/// # Errors
/// If it stands outside, or is not finite.
pub(crate) fn can_stand(
    row: usize,
    column: usize,
    value: f64,
    [rows, columns]: [usize; 2],
) -> Result<(), MatrixError> {
    if row >= rows || column >= columns {
        return Err(MatrixError::Outside {
            row,
            column,
            rows,
            columns,
        });
    }
    if !value.is_finite() {
        return Err(MatrixError::NotFinite { row, column, value });
    }
    Ok(())
}

impl SparseMatrix {
    /// From entries `(row, column, value)`, counted from zero, in any order. Several at one place add up, as those of finite elements do.
    ///
    /// ```
    /// use hertzian_structure::SparseMatrix;
    ///
    /// // Two springs in a row.
    /// let element = |first| [(first, first, 1.0), (first + 1, first, -1.0), (first, first + 1, -1.0), (first + 1, first + 1, 1.0)];
    /// let stiffness = SparseMatrix::from_triplets(3, 3, (0..2).flat_map(element))?;
    /// assert_eq!(stiffness.times(&[0.0, 1.0, 2.0]), [-1.0, 0.0, 1.0]);
    /// # Ok::<(), hertzian_structure::MatrixError>(())
    /// ```
    ///
    /// # Errors
    /// If an entry stands outside of the matrix, or is not finite.
    pub fn from_triplets(
        rows: usize,
        columns: usize,
        triplets: impl IntoIterator<Item = (usize, usize, f64)>,
    ) -> Result<Self, MatrixError> {
        let mut entries = Vec::new();
        for (row, column, value) in triplets {
            can_stand(row, column, value, [rows, columns])?;
            entries.push((column, row, value));
        }
        // Stable, so that sums of entries do not depend on the method of sorting.
        entries.sort_by_key(|&(column, row, _)| (column, row));
        let mut matrix = Self {
            rows,
            starts: Vec::with_capacity(columns + 1),
            row_of: Vec::with_capacity(entries.len()),
            values: Vec::with_capacity(entries.len()),
        };
        let mut last = None;
        for (column, row, value) in entries {
            if last == Some((column, row)) {
                if let Some(sum) = matrix.values.last_mut() {
                    *sum += value;
                }
                continue;
            }
            matrix.begin(column);
            matrix.row_of.push(row);
            matrix.values.push(value);
            last = Some((column, row));
        }
        matrix.begin(columns);
        Ok(matrix)
    }

    /// Begins the columns up to this one.
    fn begin(&mut self, column: usize) {
        while self.starts.len() <= column {
            self.starts.push(self.row_of.len());
        }
    }

    /// Rows.
    pub fn rows(&self) -> usize {
        self.rows
    }

    /// Columns.
    pub fn columns(&self) -> usize {
        self.starts.len().saturating_sub(1)
    }

    /// How many entries are stored.
    pub fn entries(&self) -> usize {
        self.values.len()
    }

    /// Rows and values of a column.
    pub fn column(&self, column: usize) -> impl Iterator<Item = (usize, f64)> {
        let range = self.starts[column]..self.starts[column + 1];
        let rows = self.row_of[range.clone()].iter().copied();
        rows.zip(self.values[range].iter().copied())
    }

    /// All entries, `(row, column, value)`.
    pub fn triplets(&self) -> impl Iterator<Item = (usize, usize, f64)> {
        let of = |column| {
            self.column(column)
                .map(move |(row, value)| (row, column, value))
        };
        (0..self.columns()).flat_map(of)
    }

    /// An entry; zero where none is stored.
    pub fn get(&self, row: usize, column: usize) -> f64 {
        let range = self.starts[column]..self.starts[column + 1];
        let place = self.row_of[range.clone()].binary_search(&row);
        place.map_or(0.0, |place| self.values[range][place])
    }

    /// The product with a vector.
    pub fn times(&self, x: &[f64]) -> Vec<f64> {
        let mut y = vec![0.0; self.rows];
        for (column, &x) in x.iter().enumerate().filter(|(_, x)| **x != 0.0) {
            for (row, value) in self.column(column) {
                y[row] += value * x;
            }
        }
        y
    }

    /// The largest magnitude of an entry.
    pub fn largest(&self) -> f64 {
        self.values.iter().fold(0.0, |m: f64, x| m.max(x.abs()))
    }

    /// Where it differs most from its transpose times a sign: row, column, and by how much.
    pub(crate) fn asymmetry(&self, sign: f64) -> (usize, usize, f64) {
        let off = self.triplets().map(|(row, column, value)| {
            let other = self.get(column, row);
            (row, column, (value - sign * other).abs())
        });
        off.fold(
            (0, 0, 0.0),
            |worst, next| {
                if next.2 > worst.2 { next } else { worst }
            },
        )
    }

    /// The sum of multiples of matrices of one size.
    pub(crate) fn sum(terms: &[(f64, &Self)]) -> Self {
        let size = terms.first().map_or(0, |(_, matrix)| matrix.rows);
        let mut sum = Self {
            rows: size,
            ..Self::default()
        };
        let mut held = vec![0.0; size];
        let mut rows: Vec<usize> = Vec::new();
        let columns = terms.first().map_or(0, |(_, matrix)| matrix.columns());
        for column in 0..columns {
            sum.starts.push(sum.row_of.len());
            rows.clear();
            for (factor, matrix) in terms {
                for (row, value) in matrix.column(column) {
                    held[row] += factor * value;
                    rows.push(row);
                }
            }
            rows.sort_unstable();
            rows.dedup();
            for &row in &rows {
                sum.row_of.push(row);
                sum.values.push(std::mem::take(&mut held[row]));
            }
        }
        sum.starts.push(sum.row_of.len());
        sum
    }

    /// Starts of columns, rows and values.
    pub(crate) fn parts(&self) -> (&[usize], &[usize], &[f64]) {
        (&self.starts, &self.row_of, &self.values)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn entries_add_up(entries in prop::collection::vec((0..5_usize, 0..4_usize, -1e3..1e3), 0..40)) {
            let matrix = SparseMatrix::from_triplets(5, 4, entries.clone()).unwrap();
            for row in 0..5 {
                for column in 0..4 {
                    let here = entries.iter().filter(|(r, c, _)| (*r, *c) == (row, column));
                    let sum: f64 = here.map(|(_, _, x)| x).sum();
                    prop_assert!((matrix.get(row, column) - sum).abs() < 1e-9);
                }
            }
            let twice = SparseMatrix::sum(&[(3.0, &matrix), (-1.0, &matrix)]);
            let x = [1.0, -2.0, 0.5, 3.0];
            for (a, b) in twice.times(&x).iter().zip(matrix.times(&x)) {
                prop_assert!((a - 2.0 * b).abs() < 1e-9);
            }
        }
    }

    #[test]
    fn what_stands_outside_is_refused() {
        let of = |entry| SparseMatrix::from_triplets(2, 2, [entry]);
        assert!(matches!(
            of((2, 0, 1.0)),
            Err(MatrixError::Outside { row: 2, .. })
        ));
        assert!(matches!(
            of((0, 1, f64::NAN)),
            Err(MatrixError::NotFinite { column: 1, .. })
        ));
        let empty = SparseMatrix::from_triplets(0, 0, []).unwrap();
        assert_eq!((empty.rows(), empty.columns(), empty.entries()), (0, 0, 0));
    }
}
