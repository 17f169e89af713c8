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

use super::block::{Block, Pair, Square};
use super::kernels::Kernels;
use super::refined::Pairs;
use crate::numeric::spectrum::{balance, eigenvalues};

/// What is smaller than this part of a matrix is rounding.
const ROUNDING: f64 = 1e-12;
/// Eigenvectors that are dependent up to this part are not told apart.
const DEPENDENT: f64 = 1e-8;
/// Parts of a matrix below which eigenvalues are one, as those of a rotor that is equal in two planes: the first at which there are as many eigenvectors
/// as there should be, since rounding moves eigenvalues by a few units of the largest.
const EQUAL: [f64; 4] = [0.0, 1e-14, 1e-13, 1e-12];
/// What is left of the equation of an eigenvector that was found beside others, at most, as a part of the matrix.
const LEFT: f64 = 1e-11;

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
    /// All blocks at one time.
    pub(in crate::contact_equation) kernels: Kernels,
    /// What is not zero in the rows of `T`, coordinate by coordinate: of a coordinate that is a mode one pair of states.
    pub(in crate::contact_equation) rows: Vec<Vec<Seen>>,
}

/// What a row sees of two states: as a position, and as the rate of that.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(in crate::contact_equation) struct Seen {
    pub(in crate::contact_equation) block: usize,
    pub(in crate::contact_equation) position: Pair,
    pub(in crate::contact_equation) rate: Pair,
}

/// What is not zero in two rows over all states.
pub(in crate::contact_equation) fn seen(
    position: impl Iterator<Item = f64>,
    rate: impl Iterator<Item = f64>,
) -> Vec<Seen> {
    let mut entries = position.zip(rate);
    let mut found = Vec::new();
    for block in 0.. {
        let (Some(first), Some(second)) = (entries.next(), entries.next()) else {
            break;
        };
        let seen = Seen {
            block,
            position: [first.0, second.0],
            rate: [first.1, second.1],
        };
        if seen.position != [0.0; 2] || seen.rate != [0.0; 2] {
            found.push(seen);
        }
    }
    found
}

impl Linear {
    /// Of mass, damping and stiffness; `None` where the mass is singular, or eigenvectors are dependent.
    pub(in crate::contact_equation) fn new(
        m: &DMatrix<f64>,
        c: &DMatrix<f64>,
        k: &DMatrix<f64>,
    ) -> Option<Self> {
        let linear = if m.nrows() == 1 {
            Self::of_one(m[(0, 0)], c[(0, 0)], k[(0, 0)])
        } else {
            Self::by_real_modes(m, c, k).or_else(|| Self::by_complex_modes(m, c, k))
        }?;
        Some(linear.seen())
    }

    /// The same matrix, or one that was found from this one, in other pairs, whose states are `S^-1` of these.
    pub(super) fn in_pairs(&self, pairs: Pairs, dependence: f64) -> Self {
        let Pairs { blocks, to, from } = pairs;
        let linear = Self {
            positions: &self.positions * &to,
            velocities: &self.velocities * &to,
            input: &from * &self.input,
            inverse: &from * &self.inverse,
            blocks,
            dependence,
            kernels: Kernels::default(),
            rows: Vec::new(),
        };
        linear.seen()
    }

    /// With what follows from blocks and `T`.
    fn seen(mut self) -> Self {
        self.kernels = Kernels::of(&self.blocks);
        let pairs = self.positions.row_iter().zip(self.velocities.row_iter());
        self.rows = pairs
            .map(|(position, rate)| seen(position.iter().copied(), rate.iter().copied()))
            .collect();
        self
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
            kernels: Kernels::default(),
            rows: Vec::new(),
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
            kernels: Kernels::default(),
            rows: Vec::new(),
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
        let found = EQUAL.into_iter().find_map(|equal| {
            let (blocks, states) = pairs(&first_order, equal)?;
            let inverse = states.clone().try_inverse()?;
            let dependence = inverse.amax() * states.amax();
            (dependence <= 1.0 / DEPENDENT).then_some((blocks, states, inverse, dependence))
        });
        let (blocks, to, from, dependence) = found?;
        let pairs = Pairs { blocks, to, from };
        let refined = pairs.refined_of(&first_order);
        let Pairs {
            blocks,
            to: mut states,
            from: mut inverse,
        } = refined.unwrap_or(pairs);
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
            kernels: Kernels::default(),
            rows: Vec::new(),
        })
    }

    /// Writes `T` of states.
    pub(in crate::contact_equation) fn write_physical(&self, states: &[f64], physical: &mut [f64]) {
        let (positions, velocities) = physical.split_at_mut(self.rows.len());
        let pairs = positions.iter_mut().zip(velocities);
        for (row, (position, velocity)) in self.rows.iter().zip(pairs) {
            [*position, *velocity] = of_states(row, states);
        }
    }
}

/// A position and its rate in these states.
pub(in crate::contact_equation) fn of_states(row: &[Seen], states: &[f64]) -> [f64; 2] {
    let mut sums = [0.0; 2];
    for seen in row {
        let [x, y] = [states[2 * seen.block], states[2 * seen.block + 1]];
        sums[0] += seen.position[0] * x + seen.position[1] * y;
        sums[1] += seen.rate[0] * x + seen.rate[1] * y;
    }
    sums
}

/// Pairs of states of a first-order system, and `T` of them column by column, where eigenvalues that differ by less than a part of the matrix
/// are one. `None` if there are too few eigenvectors.
fn pairs(matrix: &DMatrix<f64>, equal: f64) -> Option<(Vec<Block>, DMatrix<f64>)> {
    let order = matrix.nrows();
    let mut states = DMatrix::zeros(order, order);
    let mut blocks = Vec::with_capacity(order / 2);
    let mut alone: Option<(f64, DVector<f64>)> = None;
    let mut known: Vec<(Complex<f64>, DVector<Complex<f64>>)> = Vec::new();
    for exponent in grouped(&eigenvalues(matrix), equal * matrix.amax()) {
        if exponent.im < 0.0 {
            continue;
        }
        let others = known.iter().filter(|(of, _)| *of == exponent);
        let others: Vec<_> = others.map(|(_, vector)| vector).collect();
        let vector = eigenvector(matrix, exponent, &others)?;
        known.push((exponent, vector.clone()));
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
        let column = 2 * blocks.len();
        blocks.push(Block::new(block));
        states.set_column(column, &first);
        states.set_column(column + 1, &second);
    }
    (2 * blocks.len() == order).then_some((blocks, states))
}

/// Eigenvalues of which those are the same that are as near to each other: their mean, which rounding does not move as it does each. One that is as
/// near to its conjugate is real.
fn grouped(eigenvalues: &[Complex<f64>], near: f64) -> Vec<Complex<f64>> {
    let real = |z: &Complex<f64>| Complex::new(z.re, if z.im.abs() <= near { 0.0 } else { z.im });
    let mut found: Vec<Complex<f64>> = eigenvalues.iter().map(real).collect();
    let mut done = vec![false; found.len()];
    for first in 0..found.len() {
        let same = |place: &usize| !done[*place] && (found[*place] - found[first]).norm() <= near;
        let group: Vec<usize> = (first..found.len()).filter(same).collect();
        if group.len() > 1 && !done[first] {
            let sum: Complex<f64> = group.iter().map(|place| found[*place]).sum();
            let mean = sum / group.len() as f64;
            for place in group {
                (found[place], done[place]) = (mean, true);
            }
        }
    }
    found
}

/// By inverse iteration (Golub and Van Loan (2013), Matrix Computations, section 7.6.1), across the `others` of the same eigenvalue: what it leads to
/// is in the space of all of them. `None` if there are no more.
fn eigenvector(
    matrix: &DMatrix<f64>,
    exponent: Complex<f64>,
    others: &[&DVector<Complex<f64>>],
) -> Option<DVector<Complex<f64>>> {
    let n = matrix.nrows();
    let beside = exponent * (1.0 + 1e-13) + Complex::new(1e-14 * matrix.amax(), 0.0);
    let complex = matrix.map(|x| Complex::new(x, 0.0));
    let factors = (&complex - DMatrix::identity(n, n) * beside).lu();
    let across = basis(others);
    let turn = 1.0 + others.len() as f64;
    let begin = |i: usize| Complex::new(1.0, 0.1 * ((i as f64 + 1.0) * turn).sin());
    let mut vector = DVector::from_fn(n, |i, _| begin(i));
    for _ in 0..3 {
        vector = factors.solve(&vector)?;
        take_away(&mut vector, &across);
        let largest = vector
            .iter()
            .fold(vector[0], |a, b| if b.norm() > a.norm() { *b } else { a });
        if !(largest.norm() > 0.0 && largest.norm().is_finite()) {
            return None;
        }
        // The largest entry is real then, and a real vector has no imaginary part but rounding.
        vector.iter_mut().for_each(|x| *x /= largest);
    }
    if others.is_empty() {
        return Some(vector);
    }
    let left = complex * &vector - &vector * exponent;
    let most = LEFT * matrix.amax();
    left.iter().all(|x| x.norm() <= most).then_some(vector)
}

/// An orthonormal basis of what vectors span (Golub and Van Loan (2013), section 5.2.8).
fn basis(vectors: &[&DVector<Complex<f64>>]) -> Vec<DVector<Complex<f64>>> {
    let mut basis: Vec<DVector<Complex<f64>>> = Vec::new();
    for vector in vectors {
        let mut vector = (*vector).clone();
        take_away(&mut vector, &basis);
        let length = vector.norm();
        basis.push(vector.unscale(length));
    }
    basis
}

/// Takes from a vector what it has along others, which are orthonormal.
fn take_away(vector: &mut DVector<Complex<f64>>, basis: &[DVector<Complex<f64>>]) {
    for other in basis {
        let part = other.dotc(vector);
        vector.axpy(-part, other, Complex::new(1.0, 0.0));
    }
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

    /// Nothing holds two masses on a spring, which are damped little: exponents zero and -0.007 lie as near to each other, and what both do together
    /// strains the spring by rounding alone.
    #[test]
    fn a_rigid_motion_that_is_damped_little_strains_nothing() {
        let of = |entries: &[f64]| DMatrix::from_row_slice(2, 2, entries);
        let (m, c) = (
            of(&[1.0, 0.0, 0.0, 2.442_710_321_660_337_4]),
            of(&[
                0.055_793_059_273_473_5,
                -0.038_878_283_382_643_666,
                -0.038_878_283_382_643_666,
                0.046_641_777_178_624_9,
            ]),
        );
        let k = 1.499_564_818_068_198_4 * of(&[1.0, -1.0, -1.0, 1.0]);
        let linear = Linear::new(&m, &c, &k).unwrap();
        let mut slow = linear.blocks.iter().enumerate();
        let (r, block) = slow.find(|(_, block)| block.rate() < 0.1).unwrap();
        // The state that stays where it is: a null vector of its block.
        let [[a, b], [d, e]] = block.matrix;
        let rest = if a.abs() + b.abs() > d.abs() + e.abs() {
            [-b, a]
        } else {
            [-e, d]
        };
        let rows = [0, 1].map(|i| {
            (0..2)
                .map(|j| linear.positions[(i, 2 * r + j)] * rest[j])
                .sum::<f64>()
        });
        let strain = (rows[0] - rows[1]).abs() / rows[0].abs();
        assert!(strain < 1e-15, "{strain:e}");
    }

    /// What a rotor has that is equal in two planes: each eigenvalue twice, and three times, with damping that is not proportional, and real
    /// ones where that is large.
    #[test]
    fn eigenvalues_may_be_repeated() {
        for damping in [[0.02, 0.12], [9.0, 0.1]] {
            for copies in [2, 3] {
                let n = 2 * copies;
                let block = |entries: [f64; 4]| {
                    let entry = |i: usize, j: usize| {
                        let same = i % copies == j % copies;
                        let place = 2 * (i / copies) + j / copies;
                        if same { entries[place] } else { 0.0 }
                    };
                    DMatrix::from_fn(n, n, entry)
                };
                let [a, b] = damping;
                let m = block([1.0, 0.1, 0.1, 1.0]);
                let c = block([a, 0.0, 0.0, b]);
                let k = block([2.0, -1.0, -1.0, 2.0]);
                is_right(&m, &c, &k);
                // In directions that are not those of the coordinates.
                let other = |i: usize, j: usize| {
                    let own = if i == j { 2.0 } else { 0.0 };
                    own + (1.7 * (i as f64) + 0.3).sin() * (j as f64 + 0.5).cos()
                };
                let turn = DMatrix::from_fn(n, n, other);
                let [m, c, k] = [m, c, k].map(|of| turn.transpose() * of * &turn);
                is_right(&m, &c, &k);
            }
        }
    }

    /// A mass with critical damping beside another one, which a damping that is not symmetric couples weakly: of a double eigenvalue there is
    /// one eigenvector.
    #[test]
    fn what_has_too_few_eigenvectors_is_refused() {
        let of = |entries: &[f64]| DMatrix::from_row_slice(2, 2, entries);
        let (m, k) = (of(&[1.0, 0.0, 0.0, 1.0]), of(&[1.0, 0.0, 0.0, 2.0]));
        assert!(Linear::new(&m, &of(&[2.0, 0.1, 0.0, 0.1]), &k).is_none());
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
