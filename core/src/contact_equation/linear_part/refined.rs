//! Pairs of states of a matrix once more, from such as are known nearly: rounding of the fastest exponents hides digits of the slowest ones in what a library finds.
//!
//! The matrix is block diagonal with a few products added, as where contacts are closed. With nearly `G S = S L`, `L` block diagonal, as well as it is,
//!
//! ```text
//! G = A - sum_c b_c v_c^T,    E = S^-1 (G S - S L)                                                              (1)
//! L_i' = L_i + E_ii,    S' = S (1 + F),    L_i F_ij - F_ij L_j = -E_ij                                          (2)
//! ```
//!
//! whose errors are of second order in those before. Nothing large is in (1): a product acts on fast states as little as slow ones see of them, and each row is rounded by itself.
//! For blocks of order two, with the characteristic polynomial `p_j` of `L_j`, and `t_j` its trace,
//!
//! ```text
//! p_j(L_i) F_ij = -(L_i E_ij + E_ij L_j - t_j E_ij)                                                            (3)
//! ```
//!
//! Of a whole matrix rounding of (1) would be as large as what is looked for, where two exponents are near to each other, as those of a rigid motion
//! that is damped little: sums of products have twice the digits there.
//!
//! Source: Dongarra, Moler and Wilkinson (1983), Improving the accuracy of computed eigenvalues and eigenvectors, SIAM Journal on Numerical Analysis 20; Schulz (1933),
//! Iterative Berechnung der reziproken Matrix, ZAMM 13 (the inverse of `S'`); (3) by the theorem of Cayley and Hamilton; Ogita, Rump and Oishi (2005), Accurate sum and dot product, SIAM Journal on Scientific
//! Computing 26, algorithm 5.3.

use nalgebra::{DMatrix, DVector};

use super::block::{Block, Square, product, row_times, times};

/// Exponents nearer to each other than this part of them are not told apart: what is between them stays as it is.
const NEAR: f64 = 1e-9;

/// Steps, at most, and what the last one may turn by: its square is rounding.
const STEPS: usize = 5;
const TURNED: f64 = 1e-7;

/// Pairs of states: blocks, `S` and `S^-1`.
#[derive(Debug, Clone)]
pub(super) struct Pairs {
    pub(super) blocks: Vec<Block>,
    pub(super) to: DMatrix<f64>,
    pub(super) from: DMatrix<f64>,
}

impl Pairs {
    /// Steps of (2), where the matrix is those blocks less products of a column and a row, until one turns nothing whose square is more than
    /// rounding: nearly equal pairs of slow states are mixed at first. `None` where none does.
    pub(super) fn refined(&self, own: &[Block], products: &[[DVector<f64>; 2]]) -> Option<Self> {
        let mut found = self.clone();
        for _ in 0..STEPS {
            let (next, turned) = found.step(own, products);
            found = next;
            if turned <= TURNED {
                return Some(found);
            }
        }
        None
    }

    /// The same of a whole matrix: one step of (2), and the blocks once more, since rounding of `S'` moves them. `None` where two blocks
    /// are not told apart, whose vectors may depend on each other, or where it turns far, as where they have one of two real exponents in common.
    pub(super) fn refined_of(&self, matrix: &DMatrix<f64>) -> Option<Self> {
        let error = self.error_of(matrix);
        let turn = self.turn(&error);
        // A comparison with what is no number is false.
        let turns_little = turn.iter().all(|x| x.abs() <= TURNED);
        if !turns_little || !self.are_apart() {
            return None;
        }
        let to = &self.to + &self.to * &turn;
        let from = &self.from - &turn * &self.from;
        let one = DMatrix::identity(to.nrows(), to.nrows());
        let rest = difference([&one, &one], [&to, &from]);
        let turned = Self {
            blocks: self.blocks_with(&error),
            from: &from + &from * rest,
            to,
        };
        Some(Self {
            blocks: turned.blocks_with(&turned.error_of(matrix)),
            ..turned
        })
    }

    /// Whether (3) tells every two blocks apart.
    fn are_apart(&self) -> bool {
        let blocks = || self.blocks.iter().enumerate();
        let nothing = [[0.0; 2]; 2];
        blocks().all(|(i, of)| {
            let mut others = blocks().filter(|(j, _)| *j != i);
            others.all(|(_, other)| solved([of, other], nothing).is_some())
        })
    }

    /// `E` of a whole matrix.
    fn error_of(&self, matrix: &DMatrix<f64>) -> DMatrix<f64> {
        let mut own = DMatrix::zeros(matrix.nrows(), matrix.ncols());
        for (i, block) in self.blocks.iter().enumerate() {
            for (k, row) in block.matrix.into_iter().enumerate() {
                for (l, x) in row.into_iter().enumerate() {
                    own[(2 * i + k, 2 * i + l)] = x;
                }
            }
        }
        &self.from * difference([matrix, &self.to], [&self.to, &own])
    }

    /// `L'`
    fn blocks_with(&self, error: &DMatrix<f64>) -> Vec<Block> {
        let blocks = self.blocks.iter().enumerate();
        let blocks = blocks.map(|(i, block)| Block::new(sum(block.matrix, entries(error, i, i))));
        blocks.collect()
    }

    /// One step of (2), and the largest entry that it turns by.
    fn step(&self, own: &[Block], products: &[[DVector<f64>; 2]]) -> (Self, f64) {
        let error = &self.from * self.left(own, products);
        let turn = self.turn(&error);
        let to = &self.to + &self.to * &turn;
        let from = &self.from - &turn * &self.from;
        let rest = DMatrix::identity(to.nrows(), to.nrows()) - &to * &from;
        let found = Self {
            blocks: self.blocks_with(&error),
            from: &from + &from * rest,
            to,
        };
        (found, turn.amax())
    }

    /// `G S - S L`
    fn left(&self, own: &[Block], products: &[[DVector<f64>; 2]]) -> DMatrix<f64> {
        let to = &self.to;
        let mut left = DMatrix::zeros(to.nrows(), to.ncols());
        for (r, block) in own.iter().enumerate() {
            for j in 0..to.ncols() {
                let moved = times(block.matrix, [0, 1].map(|i| to[(2 * r + i, j)]));
                for i in 0..2 {
                    left[(2 * r + i, j)] = moved[i];
                }
            }
        }
        for [column, row] in products {
            left -= column * (row.transpose() * to);
        }
        for (j, block) in self.blocks.iter().enumerate() {
            for i in 0..to.nrows() {
                let moved = row_times([0, 1].map(|l| to[(i, 2 * j + l)]), block.matrix);
                for l in 0..2 {
                    left[(i, 2 * j + l)] -= moved[l];
                }
            }
        }
        left
    }

    /// `F`
    fn turn(&self, error: &DMatrix<f64>) -> DMatrix<f64> {
        let mut turn = DMatrix::zeros(error.nrows(), error.ncols());
        for (i, of) in self.blocks.iter().enumerate() {
            for (j, other) in self.blocks.iter().enumerate().filter(|(j, _)| *j != i) {
                let between = solved([of, other], entries(error, i, j));
                for (k, row) in between.into_iter().flatten().enumerate() {
                    for (l, x) in row.into_iter().enumerate() {
                        turn[(2 * i + k, 2 * j + l)] = x;
                    }
                }
            }
        }
        turn
    }
}

/// (3); `None` where both blocks have nearly the same exponent.
fn solved([of, other]: [&Block; 2], error: Square) -> Option<Square> {
    let (a, b) = (of.matrix, other.matrix);
    let trace = b[0][0] + b[1][1];
    let determinant = b[0][0] * b[1][1] - b[0][1] * b[1][0];
    // p_j(L_i) = L_i (L_i - t_j) + d_j
    let mut shifted = a;
    let mut polynomial = [[determinant, 0.0], [0.0, determinant]];
    let mut turned = b;
    for i in 0..2 {
        shifted[i][i] -= trace;
        turned[i][i] -= trace;
    }
    polynomial = sum(polynomial, product(a, shifted));
    let known = sum(product(a, error), product(error, turned));
    let [[p, q], [r, s]] = polynomial;
    let whole = p * s - q * r;
    let size = of.rate().max(other.rate());
    if whole.abs() <= (NEAR * size * size).powi(2) {
        return None;
    }
    let inverse = [[-s / whole, q / whole], [r / whole, -p / whole]];
    Some(product(inverse, known))
}

/// `A B - C D`, summed with twice the digits.
fn difference([a, b]: [&DMatrix<f64>; 2], [c, d]: [&DMatrix<f64>; 2]) -> DMatrix<f64> {
    DMatrix::from_fn(a.nrows(), b.ncols(), |i, j| {
        let products = (0..a.ncols()).map(|l| (a[(i, l)], b[(l, j)]));
        let others = (0..c.ncols()).map(|l| (-c[(i, l)], d[(l, j)]));
        let (mut high, mut low) = (0.0_f64, 0.0);
        for (x, y) in products.chain(others) {
            let product = x * y;
            let sum = high + product;
            let added = sum - high;
            low += (high - (sum - added)) + (product - added) + x.mul_add(y, -product);
            high = sum;
        }
        high + low
    })
}

fn sum(a: Square, b: Square) -> Square {
    [0, 1].map(|i| [0, 1].map(|j| a[i][j] + b[i][j]))
}

/// A block of a matrix.
fn entries(matrix: &DMatrix<f64>, i: usize, j: usize) -> Square {
    [0, 1].map(|k| [0, 1].map(|l| matrix[(2 * i + k, 2 * j + l)]))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::contact_equation::linear_part::linear::Linear;

    /// A beam in bending with a spring `k` at its tip: exponents `i w` are zeros of `1 + k sum_r 4 / (w_r^2 - w^2)` (Golub (1973), Some modified matrix
    /// eigenvalue problems, SIAM Review 15), and so is the slowest one, which a library knows to rounding of squares of the fastest.
    #[test]
    fn slow_exponents_beside_fast_ones_are_those_of_the_secular_equation() {
        let n = 20;
        let w = |r: usize| (std::f64::consts::PI * (r as f64 + 0.597)).powi(2);
        let sign = |r: usize| if r.is_multiple_of(2) { 2.0 } else { -2.0 };
        let stiff = 50.0;
        let diagonal = DMatrix::from_fn(n, n, |i, j| if i == j { w(i) * w(i) } else { 0.0 });
        let spring = DMatrix::from_fn(n, n, |i, j| stiff * sign(i) * sign(j));
        let (mass, damping) = (DMatrix::identity(n, n), DMatrix::zeros(n, n));
        let plain = Linear::new(&mass, &damping, &diagonal).unwrap();
        let closed = Linear::new(&mass, &damping, &(&diagonal + spring)).unwrap();
        let states = |linear: &Linear| {
            let mut both = DMatrix::zeros(2 * n, 2 * n);
            both.rows_mut(0, n).copy_from(&linear.positions);
            both.rows_mut(n, n).copy_from(&linear.velocities);
            both
        };
        let known = Pairs {
            to: &plain.inverse * states(&closed),
            from: &closed.inverse * states(&plain),
            blocks: closed.blocks.clone(),
        };
        let input = &plain.input * DVector::from_fn(n, |r, _| sign(r));
        let seen = plain.positions.transpose() * DVector::from_fn(n, |r, _| stiff * sign(r));
        let found = known.refined(&plain.blocks, &[[input, seen]]).unwrap();
        let missed = |block: &Block| {
            let square =
                block.matrix[0][0] * block.matrix[1][1] - block.matrix[0][1] * block.matrix[1][0];
            let gaps = (0..n).map(|r| w(r) * w(r) - square);
            let value = 1.0 + gaps.clone().map(|gap| 4.0 * stiff / gap).sum::<f64>();
            let slope = gaps.map(|gap| 4.0 * stiff / (gap * gap)).sum::<f64>();
            (value / slope / square).abs()
        };
        let slowest = |pairs: &Pairs| {
            let blocks = pairs.blocks.iter();
            missed(blocks.min_by(|a, b| a.rate().total_cmp(&b.rate())).unwrap())
        };
        let most = found.blocks.iter().map(missed).fold(0.0, f64::max);
        assert!(most < 2e-14, "{most:e}, {:e} before", slowest(&known));
        let rest = &found.to * &found.from - DMatrix::identity(2 * n, 2 * n);
        assert!(
            slowest(&found) < 1e-14 && rest.row(0).amax() < 1e-13,
            "{rest}"
        );
    }
}
