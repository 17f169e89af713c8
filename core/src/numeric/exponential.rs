//! Exponentials of dense matrices by scaling and squaring, without allocation.
//!
//! `exp A = r(A / 2^s)^(2^s)` with the diagonal Pade approximant `r = p/q` of degree
//! `m`, `q(A) = p(-A)`. Before, halves of the state are scaled so that both off-diagonal blocks have one size: for
//! displacements and velocities the norm is then a frequency, and not its square.
//!
//! Source: Higham (2005), The scaling and squaring method for the matrix exponential revisited, SIAM J. Matrix Anal. Appl.
//! 26, table 2.3 (largest norms) and equation (2.2) (coefficients).

use nalgebra::DMatrix;

/// Degrees, and the largest norm for which each is exact to rounding.
const DEGREES: [(usize, f64); 5] = [
    (3, 1.495_585_217_958_292e-2),
    (5, 2.539_398_330_063_23e-1),
    (7, 9.504_178_996_162_932e-1),
    (9, 2.097_847_961_257_068),
    (13, 5.371_920_351_148_152),
];
/// Larger norms have no accuracy left, and would be squared without end if they overflow.
const LARGEST_NORM: f64 = 1e8;

/// Workspace for exponentials of one order.
#[derive(Debug)]
pub(crate) struct Exponential {
    scaled: DMatrix<f64>,
    /// Even powers, the square first.
    powers: [DMatrix<f64>; 4],
    even: DMatrix<f64>,
    odd: DMatrix<f64>,
    workspace: DMatrix<f64>,
    pivots: Vec<usize>,
}

impl Exponential {
    pub(crate) fn new(order: usize) -> Self {
        let zeros = || DMatrix::zeros(order, order);
        Self {
            scaled: zeros(),
            powers: std::array::from_fn(|_| zeros()),
            even: zeros(),
            odd: zeros(),
            workspace: zeros(),
            pivots: Vec::new(),
        }
    }

    /// Writes `exp A`; not a number if the norm of `A` is beyond all use.
    pub(crate) fn of(&mut self, a: &DMatrix<f64>, result: &mut DMatrix<f64>) {
        self.scaled.copy_from(a);
        let balance = balance(&mut self.scaled);
        let norm = norm(&self.scaled);
        if norm.is_nan() || norm > LARGEST_NORM {
            result.fill(f64::NAN);
            return;
        }
        let squarings = self.approximant(norm, result);
        for _ in 0..squarings {
            self.workspace.gemm(1.0, result, result, 0.0);
            result.copy_from(&self.workspace);
        }
        scale_halves(result, 1.0 / balance);
    }

    /// Writes `r(A / 2^s)` and returns `s`.
    fn approximant(&mut self, norm: f64, result: &mut DMatrix<f64>) -> u32 {
        let last = DEGREES[DEGREES.len() - 1];
        let (degree, _) = DEGREES
            .into_iter()
            .find(|&(_, largest)| norm <= largest)
            .unwrap_or(last);
        let squarings = (norm / last.1).log2().ceil().max(0.0) as u32;
        self.scaled.scale_mut(0.5_f64.powi(squarings as i32));
        let c = coefficients(degree);
        let [square, fourth, sixth, eighth] = &mut self.powers;
        square.gemm(1.0, &self.scaled, &self.scaled, 0.0);
        if degree > 3 {
            fourth.gemm(1.0, square, square, 0.0);
        }
        if degree > 5 {
            sixth.gemm(1.0, fourth, square, 0.0);
        }
        if degree == 9 {
            eighth.gemm(1.0, fourth, fourth, 0.0);
        }
        let highest = if degree == 13 { 6 } else { degree / 2 * 2 };
        for (parity, sum) in [&mut self.even, &mut self.odd].into_iter().enumerate() {
            sum.fill(0.0);
            if degree == 13 {
                // The powers above the sixth, as the sixth times lower ones.
                result.fill(0.0);
                for (power, matrix) in self.powers[..3].iter().enumerate() {
                    add_scaled(result, c[2 * power + 8 + parity], matrix);
                }
                sum.gemm(1.0, &self.powers[2], result, 0.0);
            }
            for (power, matrix) in self.powers[..highest / 2].iter().enumerate() {
                add_scaled(sum, c[2 * power + 2 + parity], matrix);
            }
            for i in 0..sum.nrows() {
                sum[(i, i)] += c[parity];
            }
        }
        // p = V + U and q = V - U with U the odd part.
        self.workspace.gemm(1.0, &self.scaled, &self.odd, 0.0);
        result.copy_from(&self.even);
        add_scaled(result, 1.0, &self.workspace);
        add_scaled(&mut self.even, -1.0, &self.workspace);
        solve(&mut self.even, result, &mut self.pivots);
        squarings
    }
}

/// `c_0` to `c_m` of the approximant of degree `m`, the last one being one: `c_(j+1) = c_j (m - j) / ((2 m - j) (j + 1))`.
fn coefficients(degree: usize) -> [f64; 14] {
    let m = degree as f64;
    let mut c = [0.0; 14];
    c[0] = 1.0;
    for j in 0..degree {
        let k = j as f64;
        c[j + 1] = c[j] * (m - k) / ((2.0 * m - k) * (k + 1.0));
    }
    c
}

fn add_scaled(to: &mut DMatrix<f64>, factor: f64, matrix: &DMatrix<f64>) {
    for (to, from) in to.as_mut_slice().iter_mut().zip(matrix.as_slice()) {
        *to += factor * from;
    }
}

/// Largest sum of a column's sizes.
fn norm(a: &DMatrix<f64>) -> f64 {
    let sums = a
        .as_slice()
        .chunks_exact(a.nrows())
        .map(|column| column.iter().map(|x| x.abs()).sum::<f64>());
    sums.fold(0.0, |m, sum| if sum > m || sum.is_nan() { sum } else { m })
}

/// Scales the second half of the state so that both off-diagonal blocks are equally large; returns the factor, a power of two.
fn balance(a: &mut DMatrix<f64>) -> f64 {
    let order = a.nrows();
    if !order.is_multiple_of(2) {
        return 1.0;
    }
    let half = order / 2;
    let (mut upper, mut lower) = (0.0_f64, 0.0_f64);
    for i in 0..half {
        for j in 0..half {
            upper = upper.max(a[(i, half + j)].abs());
            lower = lower.max(a[(half + i, j)].abs());
        }
    }
    let ratio = (lower / upper).sqrt();
    if !(ratio.is_finite() && ratio > 0.0) {
        return 1.0;
    }
    let factor = ratio.log2().round().clamp(-500.0, 500.0).exp2();
    scale_halves(a, factor);
    factor
}

/// Multiplies the upper right block and divides the lower left one.
fn scale_halves(a: &mut DMatrix<f64>, factor: f64) {
    let half = a.nrows() / 2;
    if factor == 1.0 {
        return;
    }
    for i in 0..half {
        for j in 0..half {
            a[(i, half + j)] *= factor;
            a[(half + i, j)] /= factor;
        }
    }
}

/// Solves `A X = B` in place, by elimination with partial pivoting.
fn solve(a: &mut DMatrix<f64>, b: &mut DMatrix<f64>, pivots: &mut Vec<usize>) {
    let order = a.nrows();
    pivots.clear();
    for k in 0..order {
        let pivot = (k..order)
            .max_by(|&i, &j| a[(i, k)].abs().total_cmp(&a[(j, k)].abs()))
            .unwrap_or(k);
        a.swap_rows(k, pivot);
        pivots.push(pivot);
        let inverse = 1.0 / a[(k, k)];
        for i in k + 1..order {
            a[(i, k)] *= inverse;
        }
        let (left, right) = a.as_mut_slice().split_at_mut((k + 1) * order);
        let factors = &left[k * order..];
        for column in right.chunks_exact_mut(order) {
            eliminate(column, factors, k);
        }
    }
    for (k, &pivot) in pivots.iter().enumerate() {
        b.swap_rows(k, pivot);
    }
    for column in b.as_mut_slice().chunks_exact_mut(order) {
        for k in 0..order {
            eliminate(column, &a.as_slice()[k * order..][..order], k);
        }
        for k in (0..order).rev() {
            let factors = &a.as_slice()[k * order..][..order];
            column[k] /= factors[k];
            let value = column[k];
            for (x, factor) in column[..k].iter_mut().zip(factors) {
                *x -= value * factor;
            }
        }
    }
}

/// Subtracts the multiple of a column of factors below place `k`.
fn eliminate(column: &mut [f64], factors: &[f64], k: usize) {
    let value = column[k];
    for (x, factor) in column[k + 1..].iter_mut().zip(&factors[k + 1..]) {
        *x -= value * factor;
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::testing::random::Random;

    /// Every degree, with and without squaring, for matrices as they come and for those of oscillators.
    #[test]
    fn other_orders_agree_with_the_library() {
        let mut random = Random::seeded(5);
        for order in [2, 3, 4, 6, 10] {
            let mut workspace = Exponential::new(order);
            for norm in [1e-3, 0.1, 0.5, 1.5, 4.0, 20.0] {
                for stiffness in [1.0, 1e4] {
                    let mut a = DMatrix::from_fn(order, order, |_, _| random.between(-1.0, 1.0));
                    a *= norm / super::norm(&a);
                    if order.is_multiple_of(2) {
                        scale_halves(&mut a, 1.0 / stiffness);
                    }
                    let mut result = DMatrix::zeros(order, order);
                    workspace.of(&a, &mut result);
                    let mut expected = a.clone();
                    if order.is_multiple_of(2) {
                        scale_halves(&mut expected, stiffness);
                    }
                    let mut expected = expected.exp();
                    let scale = expected.amax();
                    if order.is_multiple_of(2) {
                        scale_halves(&mut expected, 1.0 / stiffness);
                        scale_halves(&mut result, stiffness);
                        scale_halves(&mut expected, stiffness);
                    }
                    let error = (&result - &expected).amax() / scale;
                    assert!(error < 2e-14, "{order} {norm} {stiffness} {error:e}");
                }
            }
        }
    }

    #[test]
    fn a_norm_without_end_is_not_a_number() {
        let a = DMatrix::from_element(3, 3, 1e300);
        let mut result = DMatrix::zeros(3, 3);
        Exponential::new(3).of(&a, &mut result);
        assert!(result.iter().all(|x| x.is_nan()));
    }
}
