//! Eigenvalues of small matrices, and how far two sets of them are apart.

use nalgebra::linalg::balancing::balance_parlett_reinsch;
use nalgebra::{Complex, DMatrix, DVector, Schur};

use super::francis;

/// More iterations for eigenvalues are never made.
pub(crate) const ITERATIONS: usize = 10_000;

/// So many roundings are nothing below the diagonal of a Schur form: the first that leads to one, since entries of repeated eigenvalues need not come
/// below one of them.
const ROUNDINGS: [f64; 3] = [1.0, 8.0, 64.0];

/// Eigenvalues, largest modulus first; of a pair of equal modulus the one with positive imaginary part first.
pub(crate) fn eigenvalues(matrix: &DMatrix<f64>) -> Vec<Complex<f64>> {
    eigenvalues_by(matrix, |matrix, small| {
        // With a bound on the iterations, which the plain call does not have.
        let schur = Schur::try_new(matrix, small, ITERATIONS)?;
        Some(schur.complex_eigenvalues().iter().copied().collect())
    })
}

/// The same of a map, of which a branch has several at every point: by [`francis`].
pub(crate) fn eigenvalues_of_map(map: &DMatrix<f64>) -> Vec<Complex<f64>> {
    eigenvalues_by(map, francis::eigenvalues)
}

/// Those of a matrix of more than two rows by a method, which is told what is nothing below the diagonal.
fn eigenvalues_by(
    matrix: &DMatrix<f64>,
    method: impl Fn(DMatrix<f64>, f64) -> Option<Vec<Complex<f64>>>,
) -> Vec<Complex<f64>> {
    if matrix.iter().any(|x| !x.is_finite()) {
        return Vec::new();
    }
    if matrix.nrows() < 2 {
        return matrix
            .iter()
            .map(|value| Complex::new(*value, 0.0))
            .collect();
    }
    if matrix.nrows() == 2 {
        let [a, c, b, d] = [0, 1, 2, 3].map(|index| matrix[index]);
        let values = eigenvalues_of_two([[a, b], [c, d]], a * d - b * c);
        return values.map_or(Vec::new(), |values| values.to_vec());
    }
    let mut matrix = matrix.clone();
    balance(&mut matrix);
    let values = ROUNDINGS
        .into_iter()
        .find_map(|roundings| method(matrix.clone(), roundings * f64::EPSILON));
    sort(values.unwrap_or_default())
}

/// Makes rows and columns of the same number alike in size, by powers of two, as unlike as the units of states are: `A` becomes `D^-1 A D`,
/// with the diagonal `D` that is returned. Eigenvalues are known to rounding of the largest entry, which may hide a small damping.
///
/// Source: Parlett and Reinsch (1969), Balancing a matrix for calculation of eigenvalues and eigenvectors, Numer. Math. 13.
pub(crate) fn balance(matrix: &mut DMatrix<f64>) -> DVector<f64> {
    let squares = matrix.norm_squared();
    // Sums of squares are compared.
    if !squares.is_finite() {
        return DVector::from_element(matrix.nrows(), 1.0);
    }
    balance_parlett_reinsch(matrix)
}

/// Sorts multipliers as [`eigenvalues`] does; none if one is not finite: products of entries overflow before the entries do,
/// and then nothing is known.
pub(crate) fn sort(mut values: Vec<Complex<f64>>) -> Vec<Complex<f64>> {
    if values.iter().any(|value| !value.norm().is_finite()) {
        return Vec::new();
    }
    values.sort_by(|a, b| b.norm().total_cmp(&a.norm()).then(b.im.total_cmp(&a.im)));
    values
}

/// Both roots of `z^2 - trace z + determinant`, largest modulus first, for a matrix whose determinant may be known better than its
/// entries tell: the smaller one comes from it, so that it keeps its digits. `None` if they are not finite.
pub(crate) fn eigenvalues_of_two(
    [[a, b], [c, d]]: [[f64; 2]; 2],
    determinant: f64,
) -> Option<[Complex<f64>; 2]> {
    let mean = 0.5 * (a + d);
    let half = 0.5 * (a - d);
    let square = half * half + b * c;
    let values = if square < 0.0 {
        let root = (-square).sqrt();
        [Complex::new(mean, root), Complex::new(mean, -root)]
    } else {
        let first = mean + square.sqrt().copysign(mean);
        let second = if first == 0.0 {
            0.0
        } else {
            determinant / first
        };
        [Complex::new(first, 0.0), Complex::new(second, 0.0)]
    };
    let finite = values.iter().all(|value| value.norm().is_finite());
    finite.then_some(values)
}

/// Signs of the blocks of an error of a matrix, column by column: as it is, and with those of its second half of columns and of rows
/// changed. The changes that they make of a trace do not all vanish while the diagonal of the error does not.
const SIGNS: [[f64; 4]; 3] = [
    [1.0, 1.0, 1.0, 1.0],
    [1.0, 1.0, -1.0, -1.0],
    [1.0, -1.0, 1.0, -1.0],
];

/// How far multipliers move for an error of their matrix, whatever its signs. All are column by column; of order two, the
/// determinant is as the multipliers have it.
pub(crate) fn spread(
    multipliers: &[Complex<f64>],
    matrix: &[f64],
    error: impl Fn(usize) -> f64,
) -> f64 {
    let order = multipliers.len();
    let half = order / 2;
    let block =
        |index: usize| 2 * usize::from(index / order >= half) + usize::from(index % order >= half);
    let mut largest = 0.0_f64;
    for signs in SIGNS {
        let moved = |index: usize| matrix[index] + signs[block(index)] * error(index);
        let apart = if let &[first, second] = multipliers {
            let others = eigenvalues_of_two(
                [[moved(0), moved(2)], [moved(1), moved(3)]],
                (first * second).re,
            );
            others.map_or(f64::INFINITY, |others| distance(multipliers, &others))
        } else {
            let other = DMatrix::from_fn(order, order, |i, j| moved(j * order + i));
            distance(multipliers, &eigenvalues(&other))
        };
        largest = largest.max(apart);
    }
    largest
}

/// Largest distance between the multipliers of two approximations, each matched with its nearest.
pub(crate) fn distance(a: &[Complex<f64>], b: &[Complex<f64>]) -> f64 {
    if let ([a, c], [b, d]) = (a, b) {
        let straight = (a - b).norm().max((c - d).norm());
        let crossed = (a - d).norm().max((c - b).norm());
        return straight.min(crossed);
    }
    let mut free: Vec<_> = b.to_vec();
    let mut largest = if a.len() == b.len() {
        0.0_f64
    } else {
        f64::INFINITY
    };
    for x in a {
        let nearest =
            (0..free.len()).min_by(|&i, &j| (free[i] - x).norm().total_cmp(&(free[j] - x).norm()));
        if let Some(index) = nearest {
            largest = largest.max((free.swap_remove(index) - x).norm());
        }
    }
    largest
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn eigenvalues_that_overflow_are_unknown() {
        let matrix = DMatrix::from_row_slice(2, 2, &[1e200, 0.0, 0.0, -1e200]);
        assert_eq!(eigenvalues(&matrix), Vec::new());
    }

    /// Of the companion matrix of `(z + 0.01)(z^2 + 0.02 z + 1)` in units of time that make its entries unlike.
    #[test]
    fn eigenvalues_do_not_depend_on_units() {
        for unit in [1.0, 1e-5, 1e5] {
            let row = [-0.01, -1.0002, -0.03];
            let matrix = DMatrix::from_row_slice(
                3,
                3,
                &[
                    0.0,
                    unit,
                    0.0, //
                    0.0,
                    0.0,
                    unit, //
                    row[0] / unit / unit,
                    row[1] / unit,
                    row[2],
                ],
            );
            let exact = [
                Complex::new(-0.01, 0.9999_f64.sqrt()),
                Complex::new(-0.01, -0.9999_f64.sqrt()),
                Complex::new(-0.01, 0.0),
            ];
            assert!(distance(&eigenvalues(&matrix), &exact) < 1e-14, "{unit}");
        }
    }

    #[test]
    fn eigenvalues_of_different_size_keep_their_digits() {
        let matrix = DMatrix::from_row_slice(2, 2, &[1e8, 1.0, 0.0, 1e-8]);
        let values = eigenvalues(&matrix);
        assert_eq!(values[0].re, 1e8);
        assert!((values[1].re - 1e-8).abs() < 1e-22);
        let rotation = DMatrix::from_row_slice(2, 2, &[0.6, -0.8, 0.8, 0.6]);
        assert_eq!(
            eigenvalues(&rotation),
            [Complex::new(0.6, 0.8), Complex::new(0.6, -0.8)]
        );
        assert_eq!(
            eigenvalues(&DMatrix::zeros(2, 2)),
            [Complex::new(0.0, 0.0); 2]
        );
    }

    #[test]
    fn distance_matches_the_nearest() {
        let a = [Complex::new(1.0, 0.0), Complex::new(-1.0, 0.0)];
        let b = [Complex::new(-1.1, 0.0), Complex::new(1.01, 0.0)];
        assert!((distance(&a, &b) - 0.1).abs() < 1e-12);
        assert!(distance(&a, &b[..1]).is_infinite());
    }
}
