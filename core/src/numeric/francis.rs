//! Eigenvalues of a real matrix and nothing else: no vectors are gathered, and what is settled is not turned any more.
//!
//! The matrix goes over to Hessenberg form by reflections, each of which makes zeros below one entry of the subdiagonal,
//!
//! ```text
//! A <- P A P,     P = I - beta v v^T                                                                          (1)
//! ```
//!
//! Then the block between two zeros of the subdiagonal, in the rows `low .. high`, is turned by an implicit double step, whose first column is that of
//!
//! ```text
//! A^2 - s A + t I,     s, t the trace and the determinant of its last two rows and columns                    (2)
//! ```
//!
//! until an entry of the subdiagonal is nothing beside those around it. Columns of the matrix are turned as they lie in memory; of rows, three entries
//! of a column at a time. After so many steps without a zero, [`EXCEPTIONAL`], one has other values for (2), since there are matrices that those leave as
//! they are.
//!
//! Source: Golub and Van Loan (2013), Matrix Computations, algorithms 7.4.2 for (1) and 7.5.1 for (2) (Francis 1961); Ahues and Tisseur (1997), A new
//! deflation criterion for the QR algorithm, LAPACK Working Note 122; Anderson et al. (1999), LAPACK Users' Guide, `dlahqr`, for the exceptional
//! steps, and `dlanv2` for both roots of a block.

#![allow(
    clippy::inline_always,
    reason = "what is not inlined is not compiled for the instruction set of its caller"
)]

use std::ops::Range;

use multiversion::multiversion;
use nalgebra::{Complex, DMatrix};

use super::linear::inlined_dot as dot;

/// Steps that bring no entry to zero before one has other values.
const EXCEPTIONAL: usize = 10;
/// Squares below this may have lost digits to the smallest numbers.
const LEAST: f64 = 1e-280;
/// Steps to a row at most, of the whole matrix.
const STEPS: usize = 30;

/// The eigenvalues, in the order of the diagonal of the Schur form, what is so small beside it being nothing; `None` where they do not settle.
pub(super) fn eigenvalues(mut matrix: DMatrix<f64>, small: f64) -> Option<Vec<Complex<f64>>> {
    let order = matrix.nrows();
    let mut values = vec![Complex::new(0.0, 0.0); order];
    let unit = matrix.amax();
    if unit == 0.0 {
        return Some(values);
    }
    // Products of entries stay in the range of numbers.
    matrix /= unit;
    if !reduced(matrix.as_mut_slice(), order, small, &mut values) {
        return None;
    }
    for value in &mut values {
        *value *= unit;
    }
    Some(values)
}

/// Brings a matrix, column by column, to Hessenberg form and to a triangle of blocks. Says whether all eigenvalues settled.
#[multiversion(targets("x86_64+avx512f", "x86_64+avx2"))]
fn reduced(a: &mut [f64], order: usize, small: f64, values: &mut [Complex<f64>]) -> bool {
    let mut room = vec![0.0; 2 * order];
    hessenberg(a, order, &mut room);
    schur(a, order, small, values)
}

/// (1) for all columns.
#[inline(always)]
fn hessenberg(a: &mut [f64], n: usize, room: &mut [f64]) {
    let (vector, sums) = room.split_at_mut(n);
    for k in 0..n.saturating_sub(2) {
        let first = k + 1;
        let v = &mut vector[first..];
        v.copy_from_slice(&a[k * n + first..][..n - first]);
        let Some((beta, norm)) = reflection(v) else {
            continue;
        };
        a[k * n + first..][..n - first].fill(0.0);
        a[k * n + first] = norm;
        for column in a[first * n..].chunks_exact_mut(n) {
            let rows = &mut column[first..];
            let along = beta * dot(v, rows);
            subtract(along, v, rows);
        }
        sums.fill(0.0);
        for (column, x) in a[first * n..].chunks_exact(n).zip(&*v) {
            subtract(-beta * x, column, sums);
        }
        for (column, x) in a[first * n..].chunks_exact_mut(n).zip(&*v) {
            subtract(*x, sums, column);
        }
    }
}

/// Entries are divided by their size before they are multiplied where they are smaller.
const SMALL: f64 = 1e-100;

/// Makes a column the vector `v` of a reflection that leaves nothing of it but its first entry: `beta`, and what that is then. `None` where that is so
/// already.
#[inline(always)]
fn reflection(v: &mut [f64]) -> Option<(f64, f64)> {
    if v[1..].iter().all(|x| *x == 0.0) {
        return None;
    }
    let square = dot(v, v);
    if square > LEAST {
        return Some(reflection_of(v, square));
    }
    let unit = v.iter().fold(0.0, |m: f64, x| m.max(x.abs()));
    for x in v.iter_mut() {
        *x /= unit;
    }
    let (beta, norm) = reflection_of(v, dot(v, v));
    Some((beta, unit * norm))
}

/// The same of a column whose square is known.
#[inline(always)]
fn reflection_of(v: &mut [f64], square: f64) -> (f64, f64) {
    let norm = -square.sqrt().copysign(v[0]);
    let first = v[0] - norm;
    let per = 1.0 / first;
    v[0] = 1.0;
    for x in &mut v[1..] {
        *x *= per;
    }
    // With the first entry one, 2 / |v|^2.
    (-first / norm, norm)
}

/// All double steps.
#[inline(always)]
fn schur(a: &mut [f64], n: usize, small: f64, values: &mut [Complex<f64>]) -> bool {
    // What the rounding of the smallest numbers leaves.
    let least = f64::MIN_POSITIVE / f64::EPSILON * n as f64;
    let mut high = n;
    let mut idle = 0;
    let mut steps = STEPS * n.max(EXCEPTIONAL);
    while high > 0 {
        let low = settled(a, n, high, small, least);
        let last = high - 1;
        match high - low {
            1 => {
                values[last] = Complex::new(a[last * n + last], 0.0);
                (high, idle) = (low, 0);
                continue;
            }
            2 => {
                let [x, y] = roots(block(a, n, low));
                (values[low], values[last]) = (x, y);
                (high, idle) = (low, 0);
                continue;
            }
            _ => {}
        }
        if steps == 0 {
            return false;
        }
        steps -= 1;
        idle += 1;
        let shifts = shifts(a, n, [low, high], idle);
        double_step(a, n, [low, high], shifts);
    }
    true
}

/// Where the last block begins above which nothing is left below the diagonal, which is made zero there.
#[inline(always)]
fn settled(a: &mut [f64], n: usize, high: usize, small: f64, least: f64) -> usize {
    let mut low = high - 1;
    while low > 0 {
        let at = |i: usize, j: usize| a[j * n + i].abs();
        let below = at(low, low - 1);
        if below <= least {
            break;
        }
        let mut around = at(low - 1, low - 1) + at(low, low);
        if around == 0.0 {
            around += if low >= 2 { at(low - 1, low - 2) } else { 0.0 };
            around += if low + 1 < n { at(low + 1, low) } else { 0.0 };
        }
        if below <= small * around {
            let above = at(low - 1, low);
            let difference = (a[(low - 1) * n + low - 1] - a[low * n + low]).abs();
            let corner = at(low, low);
            let (larger, smaller) = (below.max(above), below.min(above));
            let (most, fewest) = (corner.max(difference), corner.min(difference));
            let sum = most + larger;
            if smaller * (larger / sum) <= least.max(small * (fewest * (most / sum))) {
                break;
            }
        }
        low -= 1;
    }
    if low > 0 {
        a[(low - 1) * n + low] = 0.0;
    }
    low
}

/// Rows and columns of a block of two.
#[inline(always)]
fn block(a: &[f64], n: usize, first: usize) -> [[f64; 2]; 2] {
    let row = |i: usize| [a[first * n + i], a[(first + 1) * n + i]];
    [row(first), row(first + 1)]
}

/// Both eigenvalues of a block of two.
#[inline(always)]
fn roots([[a, b], [c, d]]: [[f64; 2]; 2]) -> [Complex<f64>; 2] {
    let half = 0.5 * (a - d);
    let (larger, smaller) = (b.abs().max(c.abs()), b.abs().min(c.abs()));
    let smaller = smaller * b.signum() * c.signum();
    let unit = half.abs().max(larger);
    if unit == 0.0 {
        return [a, d].map(|x| Complex::new(x, 0.0));
    }
    let square = half / unit * half + larger / unit * smaller;
    if square < 0.0 {
        let (mean, root) = (0.5 * (a + d), unit.sqrt() * (-square).sqrt());
        return [root, -root].map(|im| Complex::new(mean, im));
    }
    let apart = half + (unit.sqrt() * square.sqrt()).copysign(half);
    let other = if apart == 0.0 {
        0.0
    } else {
        larger / apart * smaller
    };
    [d + apart, d - other].map(|x| Complex::new(x, 0.0))
}

/// Two numbers on the diagonal, and the product of those beside it, that (2) is made of.
#[inline(always)]
fn shifts(a: &[f64], n: usize, [low, high]: [usize; 2], idle: usize) -> [f64; 3] {
    // 0.75 and -0.4375 are those of `dlahqr`, and of EISPACK before.
    let exceptional = |corner: f64, below: f64| {
        let x = 0.75 * below + corner;
        [x, x, -0.4375 * below * below]
    };
    let at = |i: usize, j: usize| a[j * n + i];
    if idle.is_multiple_of(2 * EXCEPTIONAL) {
        let below = at(high - 1, high - 2).abs() + at(high - 2, high - 3).abs();
        return exceptional(at(high - 1, high - 1), below);
    }
    if idle.is_multiple_of(EXCEPTIONAL) {
        let below = at(low + 1, low).abs() + at(low + 2, low + 1).abs();
        return exceptional(at(low, low), below);
    }
    let [[x, y], [z, w]] = block(a, n, high - 2);
    [x, w, y * z]
}

/// (2) in the rows and columns of a block.
#[inline(always)]
fn double_step(a: &mut [f64], n: usize, [low, high]: [usize; 2], [x, y, product]: [f64; 3]) {
    let at = |i: usize, j: usize| a[(low + j) * n + low + i];
    let (corner, below) = (at(0, 0), at(1, 0));
    // Products of small entries are nothing; the column counts up to a factor.
    let size = (x - corner).abs() + (y - corner).abs() + below.abs();
    let unit = if size < SMALL && size > 0.0 {
        size
    } else {
        1.0
    };
    let below = below / unit;
    let mut v = [
        (x - corner) * ((y - corner) / unit) - product / unit + at(0, 1) * below,
        below * (corner + at(1, 1) - x - y),
        below * at(2, 1),
    ];
    for k in low..high - 2 {
        if let Some((beta, norm)) = reflection(&mut v) {
            if k > low {
                a[(k - 1) * n + k] = norm;
                a[(k - 1) * n + k + 1] = 0.0;
                a[(k - 1) * n + k + 2] = 0.0;
            }
            turn_rows(&mut a[k * n..high * n], n, k, v, beta);
            let end = high.min(k + 4);
            turn_three(&mut a[k * n..][..3 * n], n, low..end, v, beta);
        }
        let next = &a[k * n + k + 1..];
        v = [next[0], next[1], if k + 3 < high { next[2] } else { 0.0 }];
    }
    let k = high - 2;
    let mut v = [v[0], v[1]];
    if let Some((beta, norm)) = reflection(&mut v) {
        a[(k - 1) * n + k] = norm;
        a[(k - 1) * n + k + 1] = 0.0;
        turn_rows(&mut a[k * n..high * n], n, k, v, beta);
        turn_two(&mut a[k * n..][..2 * n], n, low..high, v, beta);
    }
}

/// A reflection of some rows, in columns one after the other.
#[inline(always)]
fn turn_rows<const N: usize>(columns: &mut [f64], n: usize, first: usize, v: [f64; N], beta: f64) {
    let scaled = v.map(|x| beta * x);
    for column in columns.chunks_exact_mut(n) {
        let Some(rows) = column[first..].first_chunk_mut::<N>() else {
            return;
        };
        let mut sum = 0.0;
        for i in 0..N {
            sum += v[i] * rows[i];
        }
        for i in 0..N {
            rows[i] -= sum * scaled[i];
        }
    }
}

/// A reflection of three columns, in some of their rows.
#[inline(always)]
fn turn_three(columns: &mut [f64], n: usize, rows: Range<usize>, v: [f64; 3], beta: f64) {
    let scaled = v.map(|x| beta * x);
    let (first, others) = columns.split_at_mut(n);
    let (second, third) = others.split_at_mut(n);
    let pairs = first[rows.clone()]
        .iter_mut()
        .zip(&mut second[rows.clone()]);
    for ((x, y), z) in pairs.zip(&mut third[rows]) {
        let sum = v[0] * *x + v[1] * *y + v[2] * *z;
        *x -= sum * scaled[0];
        *y -= sum * scaled[1];
        *z -= sum * scaled[2];
    }
}

/// The same of two.
#[inline(always)]
fn turn_two(columns: &mut [f64], n: usize, rows: Range<usize>, v: [f64; 2], beta: f64) {
    let scaled = v.map(|x| beta * x);
    let (first, second) = columns.split_at_mut(n);
    for (x, y) in first[rows.clone()].iter_mut().zip(&mut second[rows]) {
        let sum = v[0] * *x + v[1] * *y;
        *x -= sum * scaled[0];
        *y -= sum * scaled[1];
    }
}

/// `to - factor of`
#[inline(always)]
fn subtract(factor: f64, of: &[f64], to: &mut [f64]) {
    for (to, x) in to.iter_mut().zip(of) {
        *to -= factor * x;
    }
}

#[cfg(test)]
mod tests {
    use nalgebra::Schur;

    use super::*;
    use crate::numeric::spectrum::{distance, sort};

    fn found(matrix: &DMatrix<f64>) -> Vec<Complex<f64>> {
        sort(eigenvalues(matrix.clone(), f64::EPSILON).expect("they settle"))
    }

    fn number(i: usize) -> f64 {
        (0.7 * (i * i % 1009) as f64).sin()
    }

    /// Turns a matrix by reflections whose vectors have nothing to do with it.
    fn turned(mut matrix: DMatrix<f64>) -> DMatrix<f64> {
        let n = matrix.nrows();
        for k in 0..3 {
            let v = DMatrix::from_fn(n, 1, |i, _| number(31 * k + i));
            let of = DMatrix::identity(n, n) - &v * v.transpose() * (2.0 / v.norm_squared());
            matrix = &of * matrix * &of;
        }
        matrix
    }

    /// Blocks of two with the given real and imaginary parts, and what couples them: normal matrices, and others.
    #[test]
    fn eigenvalues_are_those_that_the_matrix_was_made_of() {
        for n in [3, 4, 7, 8, 17, 40, 41] {
            for couples in [0.0, 0.01] {
                let mut matrix = DMatrix::from_fn(n, n, |i, j| {
                    let above = j > i + 1 || j == i + 1 && j % 2 == 0;
                    if above {
                        couples * number(i + n * j)
                    } else {
                        0.0
                    }
                });
                let mut exact = Vec::new();
                for i in (0..n).step_by(2) {
                    let (re, im) = (number(i + 5), number(i + 6).abs());
                    matrix[(i, i)] = re;
                    if i + 1 == n {
                        exact.push(Complex::new(re, 0.0));
                        break;
                    }
                    matrix[(i + 1, i + 1)] = re;
                    (matrix[(i, i + 1)], matrix[(i + 1, i)]) = (im, -im);
                    exact.extend([Complex::new(re, im), Complex::new(re, -im)]);
                }
                let apart = distance(&found(&turned(matrix)), &exact);
                assert!(apart < 2e-14, "{n}, {couples}: {apart:e}");
            }
        }
    }

    #[test]
    fn eigenvalues_are_those_of_another_program() {
        for n in 3..30 {
            let matrix = DMatrix::from_fn(n, n, |i, j| number(i + n * j + 7));
            let other = Schur::new(matrix.clone());
            let other: Vec<_> = other.complex_eigenvalues().iter().copied().collect();
            let apart = distance(&found(&matrix), &other);
            assert!(apart < 1e-12, "{n}: {apart:e}");
        }
    }

    /// A cycle, which double steps with (2) leave as it is; one eigenvalue as often as there are rows; nothing.
    #[test]
    fn matrices_on_which_steps_may_stand_still() {
        for n in [3, 4, 6, 9] {
            let next = |i: usize, j: usize| f64::from(u8::from(i == (j + 1) % n));
            let cycle = DMatrix::from_fn(n, n, next);
            let roots = (0..n)
                .map(|k| Complex::from_polar(1.0, std::f64::consts::TAU * k as f64 / n as f64));
            assert!(distance(&found(&cycle), &roots.collect::<Vec<_>>()) < 1e-14);
            let same = vec![Complex::new(0.3, 0.0); n];
            let scaled = DMatrix::identity(n, n) * 0.3;
            assert!(distance(&found(&turned(scaled)), &same) < 1e-14);
            let none = vec![Complex::new(0.0, 0.0); n];
            assert_eq!(found(&DMatrix::zeros(n, n)), none);
        }
    }

    /// Products of these entries are beyond the range of numbers.
    #[test]
    fn units_do_not_matter() {
        let matrix = DMatrix::from_fn(6, 6, |i, j| number(i + 6 * j + 7));
        let values = found(&matrix);
        for unit in [1e-200, 1e200] {
            let scaled: Vec<_> = found(&(&matrix * unit)).iter().map(|v| v / unit).collect();
            assert!(distance(&scaled, &values) < 1e-14);
        }
    }
}
