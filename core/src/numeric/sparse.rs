//! Matrices of which most entries may be zero, row by row, and their products with vectors.
//!
//! Source: Saad (2003), Iterative Methods for Sparse Linear Systems, section 3.4 (compressed sparse rows).

/// The entries of a matrix that are not zero.
#[derive(Debug, Clone, Default)]
pub(crate) struct SparseRows {
    /// Where the entries of every row end.
    ends: Vec<usize>,
    columns: Vec<usize>,
    values: Vec<f64>,
}

impl SparseRows {
    /// Of a matrix with these entries.
    pub(crate) fn of(rows: usize, columns: usize, entry: impl Fn(usize, usize) -> f64) -> Self {
        let mut sparse = Self::default();
        for row in 0..rows {
            for column in 0..columns {
                let value = entry(row, column);
                if value != 0.0 {
                    sparse.columns.push(column);
                    sparse.values.push(value);
                }
            }
            sparse.ends.push(sparse.values.len());
        }
        sparse
    }

    /// The entries of a row, each with its column.
    pub(crate) fn row(&self, row: usize) -> impl Iterator<Item = (usize, f64)> + '_ {
        let first = row.checked_sub(1).map_or(0, |before| self.ends[before]);
        let place = first..self.ends[row];
        let columns = self.columns[place.clone()].iter().copied();
        columns.zip(self.values[place].iter().copied())
    }

    /// The product with a vector.
    pub(crate) fn times(&self, vector: &[f64], to: &mut [f64]) {
        for (row, to) in to.iter_mut().enumerate().take(self.ends.len()) {
            *to = self.row(row).map(|(column, x)| x * vector[column]).sum();
        }
    }

    /// The product of the transposed matrix with a vector.
    pub(crate) fn times_transposed(&self, vector: &[f64], to: &mut [f64]) {
        to.fill(0.0);
        for (row, factor) in vector.iter().enumerate().take(self.ends.len()) {
            for (column, x) in self.row(row) {
                to[column] += factor * x;
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn products_are_those_of_the_matrix() {
        let matrix = [[0.0, 2.0, 0.0], [0.0; 3], [1.0, 0.0, -3.0]];
        let sparse = SparseRows::of(3, 3, |i, j| matrix[i][j]);
        assert_eq!(sparse.values.len(), 3);
        let mut to = [9.0; 3];
        sparse.times(&[1.0, 10.0, 100.0], &mut to);
        assert_eq!(to, [20.0, 0.0, -299.0]);
        sparse.times_transposed(&[1.0, 10.0, 100.0], &mut to);
        assert_eq!(to, [100.0, 2.0, -300.0]);
    }
}
