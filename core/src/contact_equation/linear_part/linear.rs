//! The linear part of a system as pairs of states that are not coupled: its modes.
//!
//! ```text
//! y' = A y + T^-1 [0; M^-1 f],    [q; q'] = T y,    A block diagonal with blocks of order two                  (1)
//! ```
//!
//! - One coordinate is its own pair.
//! - With symmetric `M` and `K` and a damping matrix that the modes of `K x = w^2 M x` make diagonal, a pair is the amplitude of a mode
//!   and its rate, whatever its damping: rigid modes too.
//! - Else a pair is the real and the imaginary part of an eigenvector of the first-order system, or two real ones.
//!
//! Source: Meirovitch (2001), Fundamentals of Vibrations, sections 7.9 and 7.15 (proportional and general viscous damping).

use nalgebra::{Complex, DMatrix, DVector};

use super::block::{Block, Square, add};
use crate::numeric::spectrum::{balance, eigenvalues};

/// What is smaller than this part of a matrix is rounding.
const ROUNDING: f64 = 1e-12;
/// Eigenvectors that are dependent up to this part are not told apart.
const DEPENDENT: f64 = 1e-8;

/// (1)
#[derive(Debug, Clone)]
pub(in crate::contact_equation) struct Linear {
    pub(in crate::contact_equation) blocks: Vec<Block>,
    /// The upper and the lower half of `T`: positions and velocities.
    pub(in crate::contact_equation) positions: DMatrix<f64>,
    pub(in crate::contact_equation) velocities: DMatrix<f64>,
    /// `T^-1 [0; M^-1]`
    pub(in crate::contact_equation) input: DMatrix<f64>,
    /// `T^-1`
    pub(in crate::contact_equation) inverse: DMatrix<f64>,
    /// The product of the largest entries of `T` and `T^-1` in balanced coordinates, where pairs are eigenvectors; else one.
    pub(super) dependence: f64,
}

impl Linear {
    /// Of mass, damping and stiffness; `None` where the mass is singular, or eigenvectors are dependent.
    pub(in crate::contact_equation) fn new(
        m: &DMatrix<f64>,
        c: &DMatrix<f64>,
        k: &DMatrix<f64>,
    ) -> Option<Self> {
        if m.nrows() == 1 {
            return Self::of_one(m[(0, 0)], c[(0, 0)], k[(0, 0)]);
        }
        Self::by_real_modes(m, c, k).or_else(|| Self::by_complex_modes(m, c, k))
    }

    fn of_one(m: f64, c: f64, k: f64) -> Option<Self> {
        let row = |a: f64, b: f64| DMatrix::from_row_slice(1, 2, &[a, b]);
        (m != 0.0).then(|| Self {
            blocks: vec![Block::new([[0.0, 1.0], [-k / m, -c / m]])],
            positions: row(1.0, 0.0),
            velocities: row(0.0, 1.0),
            input: DMatrix::from_row_slice(2, 1, &[0.0, 1.0 / m]),
            inverse: DMatrix::identity(2, 2),
            dependence: 1.0,
        })
    }

    fn by_real_modes(m: &DMatrix<f64>, c: &DMatrix<f64>, k: &DMatrix<f64>) -> Option<Self> {
        let n = m.nrows();
        let symmetric = |a: &DMatrix<f64>| (a - a.transpose()).amax() <= ROUNDING * a.amax();
        if !symmetric(m) || !symmetric(k) {
            return None;
        }
        let root = m.clone().cholesky()?.l();
        let scaled = root.solve_lower_triangular(k)?;
        let scaled = root.solve_lower_triangular(&scaled.transpose())?;
        let scaled = 0.5 * (&scaled + scaled.transpose());
        let modes = scaled.symmetric_eigen();
        let shapes = root
            .transpose()
            .solve_upper_triangular(&modes.eigenvectors)?;
        let modal = shapes.transpose() * c * &shapes;
        let others = &modal - DMatrix::from_diagonal(&modal.diagonal());
        if others.amax() > ROUNDING * modal.amax() {
            return None;
        }
        let (mut positions, mut velocities) = (DMatrix::zeros(n, 2 * n), DMatrix::zeros(n, 2 * n));
        let mut input = DMatrix::zeros(2 * n, n);
        let mut inverse = DMatrix::zeros(2 * n, 2 * n);
        // phi^T M maps positions to amplitudes.
        let left = shapes.transpose() * m;
        let mut blocks = Vec::with_capacity(n);
        let zero = |x: f64, largest: f64| {
            if x.abs() <= ROUNDING * largest {
                0.0
            } else {
                x
            }
        };
        for r in 0..n {
            let stiffness = zero(modes.eigenvalues[r], modes.eigenvalues.amax());
            let damping = zero(modal[(r, r)], modal.amax());
            blocks.push(Block::new([[0.0, 1.0], [-stiffness, -damping]]));
            positions.set_column(2 * r, &shapes.column(r));
            velocities.set_column(2 * r + 1, &shapes.column(r));
            input.set_row(2 * r + 1, &shapes.column(r).transpose());
            inverse.view_mut((2 * r, 0), (1, n)).copy_from(&left.row(r));
            inverse
                .view_mut((2 * r + 1, n), (1, n))
                .copy_from(&left.row(r));
        }
        Some(Self {
            blocks,
            positions,
            velocities,
            input,
            inverse,
            dependence: 1.0,
        })
    }

    fn by_complex_modes(m: &DMatrix<f64>, c: &DMatrix<f64>, k: &DMatrix<f64>) -> Option<Self> {
        let n = m.nrows();
        let mass = m.clone().lu();
        let (stiffness, damping) = (mass.solve(k)?, mass.solve(c)?);
        let mut first_order = DMatrix::zeros(2 * n, 2 * n);
        first_order
            .view_mut((0, n), (n, n))
            .copy_from(&DMatrix::identity(n, n));
        first_order.view_mut((n, 0), (n, n)).copy_from(&-stiffness);
        first_order.view_mut((n, n), (n, n)).copy_from(&-damping);
        let scales = balance(&mut first_order);
        let mut states = DMatrix::zeros(2 * n, 2 * n);
        let mut blocks = Vec::with_capacity(n);
        let mut alone: Option<(f64, DVector<f64>)> = None;
        for exponent in eigenvalues(&first_order) {
            if exponent.im < 0.0 {
                continue;
            }
            let vector = eigenvector(&first_order, exponent)?;
            let column = 2 * blocks.len();
            let (block, first, second) = if exponent.im > 0.0 {
                let Complex { re, im } = exponent;
                let square: Square = [[re, im], [-im, re]];
                (square, vector.map(|z| z.re), vector.map(|z| z.im))
            } else if let Some((other, of_other)) = alone.take() {
                let square: Square = [[other, 0.0], [0.0, exponent.re]];
                (square, of_other, vector.map(|z| z.re))
            } else {
                alone = Some((exponent.re, vector.map(|z| z.re)));
                continue;
            };
            blocks.push(Block::new(block));
            states.set_column(column, &first);
            states.set_column(column + 1, &second);
        }
        if blocks.len() != n {
            return None;
        }
        let mut inverse = states.clone().try_inverse()?;
        let dependence = inverse.amax() * states.amax();
        if dependence > 1.0 / DEPENDENT {
            return None;
        }
        for (state, scale) in scales.iter().enumerate() {
            states.row_mut(state).scale_mut(*scale);
            inverse.column_mut(state).unscale_mut(*scale);
        }
        let mass = mass.try_inverse()?;
        Some(Self {
            input: inverse.columns(n, n) * mass,
            positions: states.rows(0, n).into_owned(),
            velocities: states.rows(n, n).into_owned(),
            inverse,
            blocks,
            dependence,
        })
    }

    /// Writes `T` of states, column by column: rows of these matrices lie apart in memory. Sums have the order that they have row by row.
    pub(in crate::contact_equation) fn write_physical(&self, states: &[f64], physical: &mut [f64]) {
        physical.fill(0.0);
        let halves = physical.split_at_mut(self.positions.nrows());
        for (matrix, half) in [(&self.positions, halves.0), (&self.velocities, halves.1)] {
            for (column, state) in matrix.column_iter().zip(states) {
                add(half, *state, column.as_slice());
            }
        }
    }

    /// `T^-1` of positions and velocities.
    pub(in crate::contact_equation) fn states(&self, physical: &[f64]) -> Vec<f64> {
        let product = &self.inverse * DVector::from_column_slice(physical);
        product.as_slice().to_vec()
    }
}

/// By inverse iteration (Golub and Van Loan (2013), Matrix Computations, section 7.6.1).
fn eigenvector(matrix: &DMatrix<f64>, exponent: Complex<f64>) -> Option<DVector<Complex<f64>>> {
    let n = matrix.nrows();
    let beside = exponent * (1.0 + 1e-13) + Complex::new(1e-14 * matrix.amax(), 0.0);
    let shifted = matrix.map(|x| Complex::new(x, 0.0)) - DMatrix::identity(n, n) * beside;
    let factors = shifted.lu();
    let mut vector = DVector::from_fn(n, |i, _| Complex::new(1.0, 0.1 * (i as f64 + 1.0).sin()));
    for _ in 0..3 {
        vector = factors.solve(&vector)?;
        let largest = vector
            .iter()
            .fold(vector[0], |a, b| if b.norm() > a.norm() { *b } else { a });
        if !(largest.norm() > 0.0 && largest.norm().is_finite()) {
            return None;
        }
        // The largest entry is real then, and a real vector has no imaginary part but rounding.
        vector.iter_mut().for_each(|x| *x /= largest);
    }
    Some(vector)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// `T A T^-1` is the matrix of the first-order system.
    fn is_right(m: &DMatrix<f64>, c: &DMatrix<f64>, k: &DMatrix<f64>) {
        let linear = Linear::new(m, c, k).unwrap();
        let n = m.nrows();
        let mut a = DMatrix::zeros(2 * n, 2 * n);
        for (r, block) in linear.blocks.iter().enumerate() {
            for i in 0..2 {
                for j in 0..2 {
                    a[(2 * r + i, 2 * r + j)] = block.matrix[i][j];
                }
            }
        }
        let mass = m.clone().try_inverse().unwrap();
        let q = &linear.positions * &a * &linear.inverse;
        let v = &linear.velocities * &a * &linear.inverse;
        let near = |x: &DMatrix<f64>, y: &DMatrix<f64>| (x - y).amax() < 1e-10 * (1.0 + y.amax());
        assert!(near(
            &q.columns(n, n).into_owned(),
            &DMatrix::identity(n, n)
        ));
        assert!(near(&v.columns(0, n).into_owned(), &(-&mass * k)));
        assert!(near(&v.columns(n, n).into_owned(), &(-&mass * c)));
        assert!(near(&(&linear.velocities * &linear.input), &mass));
        assert!((&linear.positions * &linear.input).amax() < 1e-10);
    }

    #[test]
    fn pairs_are_the_linear_part() {
        let of = |entries: &[f64]| {
            let n = entries.len().isqrt();
            DMatrix::from_row_slice(n, n, entries)
        };
        let m = of(&[2.0, 0.3, 0.3, 1.0]);
        let k = of(&[3.0, -1.0, -1.0, 1.0]);
        let rigid = of(&[1.0, -1.0, -1.0, 1.0]);
        is_right(&m, &(0.1 * &m + 0.02 * &k), &k);
        is_right(&m, &(0.05 * &rigid), &rigid);
        is_right(&m, &of(&[0.3, 0.0, 0.0, 0.0]), &k);
        is_right(&m, &of(&[8.0, 0.0, 0.0, 0.1]), &k);
        is_right(
            &of(&[1.0, 0.0, 0.0, 1.0]),
            &of(&[0.1, 0.7, -0.7, 0.1]),
            &of(&[1.0, 0.0, 0.0, 1.3]),
        );
        is_right(&of(&[2.0]), &of(&[0.0]), &of(&[0.0]));
    }

    /// In seconds a period may be short, and what damps it small beside its frequency: its digits are those of other units.
    #[test]
    fn pairs_are_the_same_in_other_units() {
        let of = |entries: &[f64]| DMatrix::from_row_slice(2, 2, entries);
        let (m, c, k) = (
            of(&[1.0, 0.0, 0.0, 1.0]),
            of(&[1.1e-2, -4e-3, -4e-3, 1.4e-2]),
            of(&[2.0, -1.0, -1.0, 1.0]),
        );
        let exponents = |linear: &Linear| {
            let pairs = linear.blocks.iter().map(|block| block.matrix);
            let mut pairs: Vec<_> = pairs.map(|[[re, im], _]| [re, im]).collect();
            pairs.sort_by(|a, b| a[1].total_cmp(&b[1]));
            pairs.concat()
        };
        let known = exponents(&Linear::new(&m, &c, &k).unwrap());
        for rate in [1e-6, 1e5, 1e9] {
            let (c, k) = (rate * &c, rate * rate * &k);
            let found = exponents(&Linear::new(&m, &c, &k).unwrap());
            for (found, known) in found.iter().zip(&known) {
                let off = (found / rate - known).abs();
                assert!(off < 1e-12 * known.abs(), "{rate:e}: {off:e} of {known}");
            }
        }
    }
}
