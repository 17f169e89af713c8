//! Symmetric sparse equations: `P A P^T = L D L^T` with a fill-reducing permutation.
//!
//! The number of negative entries of `D` is that of negative eigenvalues of `A` (Sylvester's law of inertia), which for
//! `A = K - s^2 M` is the number of modes below `s`.
//!
//! Source: Davis (2006), Direct Methods for Sparse Linear Systems, chapters 4 and 7; Parlett (1998), The Symmetric Eigenvalue Problem,
//! section 3.3 (slicing the spectrum).

use sparse_ldlt::{LdltError, SparseLdlt};

use crate::matrix::SparseMatrix;

/// An order of elimination, of all matrices with the same places.
#[derive(Debug, Clone)]
pub(crate) struct Ordering(Vec<usize>);

impl Ordering {
    /// By approximate minimum degree. Matrices that are too large for it, which no memory would hold, keep their order.
    pub(crate) fn of(pattern: &SparseMatrix) -> Self {
        let (starts, rows, _) = pattern.parts();
        let n = pattern.columns();
        let short = |x: &usize| i32::try_from(*x).ok();
        let starts: Option<Vec<i32>> = starts.iter().map(short).collect();
        let rows: Option<Vec<i32>> = rows.iter().map(short).collect();
        let found = starts.zip(rows).and_then(|(starts, rows)| {
            let control = amd::Control::default();
            amd::order(n as i32, &starts, &rows, &control).ok()
        });
        let order = found.map(|(order, ..)| order.into_iter().map(|x| x as usize).collect());
        Self(order.unwrap_or_else(|| (0..n).collect()))
    }
}

/// A negative eigenvalue of a matrix with a diagonal of ones that is none of the digits that files have.
const ROUNDING: f64 = 1e-6;

/// How many eigenvalues of a matrix are negative by more than rounding, at least one where the elimination fails: those of
/// `D^-1/2 A D^-1/2 + e`, with the diagonal `D` of `A`, and the largest entry of `A` where that is zero. Of a positive semidefinite `A` it
/// is definite, with pivots of `e` at least in any order, however far entries of `A` are apart. It has as many negative eigenvalues as
/// `A + e D` (Sylvester's law of inertia).
pub(crate) fn negative(matrix: &SparseMatrix) -> usize {
    let largest = matrix.largest();
    let size = matrix.columns();
    let unit = |i: usize| {
        let own = matrix.get(i, i).abs();
        if own > 0.0 { own } else { largest }.sqrt()
    };
    let units: Vec<f64> = (0..size).map(unit).collect();
    let (starts, rows, values) = matrix.parts();
    let scaled = (0..size).flat_map(|column| {
        let entries = starts[column]..starts[column + 1];
        let units = &units;
        entries.map(move |k| {
            let row = rows[k];
            (row, column, values[k] / units[row] / units[column])
        })
    });
    let moved = scaled.chain((0..size).map(|i| (i, i, ROUNDING)));
    match SparseMatrix::from_triplets(size, size, moved) {
        Ok(moved) if largest > 0.0 => {
            Factor::of(&moved, &Ordering::of(&moved)).map_or(1, |factor| factor.negative())
        }
        _ => 0,
    }
}

/// Factors of a symmetric matrix.
#[derive(Debug)]
pub(crate) struct Factor(SparseLdlt);

impl Factor {
    /// Of a matrix; it fails where a pivot is zero up to rounding.
    pub(crate) fn of(matrix: &SparseMatrix, order: &Ordering) -> Result<Self, LdltError> {
        let (starts, rows, values) = matrix.parts();
        SparseLdlt::factor_perm(matrix.columns(), starts, rows, values, &order.0).map(Self)
    }

    /// `A^-1 b`; `b` has as many entries as `A` has rows.
    pub(crate) fn solve(&self, b: &[f64]) -> Vec<f64> {
        self.0.solve(b).unwrap_or_default()
    }

    /// The smallest magnitude of a pivot.
    pub(crate) fn least_pivot(&self) -> f64 {
        let pivots = self.0.d().iter().map(|pivot| pivot.abs());
        pivots.fold(f64::INFINITY, f64::min)
    }

    /// Negative eigenvalues of `A`.
    pub(crate) fn negative(&self) -> usize {
        self.0.d().iter().filter(|pivot| **pivot < 0.0).count()
    }
}
