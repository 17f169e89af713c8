//! Null spaces of small matrices, whose rows are given entry by entry.

use std::borrow::Cow;
use std::collections::BTreeMap;

use nalgebra::{DMatrix, DVector};

use crate::model::layout::Layout;
use crate::system::{Part, Wave};

/// Singular values below this, for rows and columns of size one, are zero.
const ZERO: f64 = 1e-14;
/// Factors that differ from one by less are not written.
const WHOLE: f64 = 1e-12;

/// What a row belongs to: where it was begun, a matrix or a contact, its position there, and its wave.
type Key = (usize, usize, usize, u32, bool);

/// Rows of one matrix. Several entries at one place add up.
pub(super) struct Rows {
    n: usize,
    at: usize,
    /// Row by row: sums at each place, and sums of sizes.
    entries: BTreeMap<Key, (Vec<f64>, Vec<f64>)>,
}

impl Rows {
    pub(super) fn new(n: usize) -> Self {
        Self {
            n,
            at: 0,
            entries: BTreeMap::new(),
        }
    }

    /// Rows that follow are not those before.
    pub(super) fn begin(&mut self, at: usize) {
        self.at = at;
    }

    fn add(&mut self, kind: usize, position: usize, wave: Wave, column: usize, value: f64) {
        let key = (
            self.at,
            kind,
            position,
            wave.harmonic,
            wave.part == Part::Sine,
        );
        let zeros = || (vec![0.0; self.n], vec![0.0; self.n]);
        let (row, sizes) = self.entries.entry(key).or_insert_with(zeros);
        row[column] += value;
        sizes[column] += value.abs();
    }

    /// The stiffness and the directions of gaps.
    pub(super) fn add_right(&mut self, layout: &Layout, coefficients: &[f64]) {
        for entry in &layout.stiffness {
            let value = coefficients[entry.coefficient];
            self.add(0, entry.row, entry.wave, entry.column, value);
        }
        for (contact, of) in layout.contacts.iter().enumerate() {
            for term in &of.gap {
                let value = coefficients[term.coefficient];
                self.add(1, contact, term.wave, term.index, value);
            }
        }
    }

    /// The transposed stiffness and the directions of forces.
    pub(super) fn add_left(&mut self, layout: &Layout, coefficients: &[f64]) {
        for entry in &layout.stiffness {
            let value = coefficients[entry.coefficient];
            self.add(0, entry.column, entry.wave, entry.row, value);
        }
        for (contact, of) in layout.contacts.iter().enumerate() {
            for term in &of.force {
                let value = coefficients[term.coefficient];
                self.add(1, contact, term.wave, term.index, value);
            }
        }
    }

    /// The damping.
    pub(super) fn add_damping(&mut self, layout: &Layout, coefficients: &[f64]) {
        for entry in &layout.damping {
            let value = coefficients[entry.coefficient];
            self.add(2, entry.row, entry.wave, entry.column, value);
        }
    }

    /// A basis of the vectors that all rows are orthogonal to, column by column, in reduced echelon form; none if an entry is not
    /// finite. Rows, then columns, are measured in their largest sizes: coordinates may be lengths and angles.
    pub(super) fn null_space(&self) -> DMatrix<f64> {
        let n = self.n;
        let mut rows = Vec::new();
        for (row, sizes) in self.entries.values() {
            let size = sizes.iter().fold(0.0, |m: f64, x| m.max(*x));
            if size.is_nan() || size.is_infinite() {
                return DMatrix::zeros(n, 0);
            }
            if size > 0.0 {
                rows.push(row.iter().map(|x| x / size).collect::<Vec<f64>>());
            }
        }
        let mut matrix = DMatrix::from_fn(rows.len().max(n), n, |i, j| {
            rows.get(i).map_or(0.0, |row| row[j])
        });
        let units = DVector::from_fn(n, |j, _| {
            let largest = matrix.column(j).amax();
            if largest > ZERO { 1.0 / largest } else { 1.0 }
        });
        for (mut column, unit) in matrix.column_iter_mut().zip(&units) {
            column *= *unit;
        }
        let svd = matrix.svd(false, true);
        let Some(vectors) = &svd.v_t else {
            return DMatrix::zeros(n, 0);
        };
        let limit = ZERO * (rows.len().max(n)) as f64;
        let zero: Vec<usize> = (0..n)
            .filter(|&i| svd.singular_values[i] <= limit)
            .collect();
        let mut basis = DMatrix::from_fn(n, zero.len(), |j, i| units[j] * vectors[(zero[i], j)]);
        reduce(&mut basis);
        basis
    }
}

/// Brings columns to reduced echelon form, with the largest entries as pivots.
fn reduce(basis: &mut DMatrix<f64>) {
    for index in 0..basis.ncols() {
        let pivot = basis.column(index).iamax();
        let value = basis[(pivot, index)];
        for x in basis.column_mut(index).iter_mut() {
            *x /= value;
            if x.abs() <= ZERO {
                *x = 0.0;
            }
        }
        let unit = basis.column(index).clone_owned();
        for other in (0..basis.ncols()).filter(|&other| other != index) {
            let factor = basis[(pivot, other)];
            basis.column_mut(other).axpy(-factor, &unit, 1.0);
        }
    }
}

/// An orthonormal basis of what is orthogonal to the columns.
pub(super) fn complement(columns: &DMatrix<f64>) -> DMatrix<f64> {
    let (n, count) = columns.shape();
    let mut all = DMatrix::identity(n, n + count);
    all.columns_mut(0, count).copy_from(columns);
    all.columns_mut(count, n).fill_with_identity();
    let q = all.qr().q();
    q.columns(count, n - count).into_owned()
}

/// A direction as a sum of coordinates.
pub(super) fn described(names: &[Cow<'static, str>], direction: &[f64]) -> String {
    let mut text = String::new();
    let parts = names.iter().zip(direction).filter(|(_, x)| **x != 0.0);
    for (name, &x) in parts {
        text += match (text.is_empty(), x < 0.0) {
            (true, false) => "",
            (true, true) => "-",
            (false, false) => " + ",
            (false, true) => " - ",
        };
        if (x.abs() - 1.0).abs() > WHOLE {
            text += &x.abs().to_string();
            text.push('*');
        }
        text += name;
    }
    text
}
