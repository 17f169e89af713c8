//! Eigenvalues of small matrices, and how far two sets of them are apart.

use nalgebra::{Complex, DMatrix, Schur};

/// Eigenvalues, largest modulus first; of a pair of equal modulus the one with positive imaginary part first.
pub(crate) fn eigenvalues(matrix: &DMatrix<f64>) -> Vec<Complex<f64>> {
    if matrix.iter().any(|x| !x.is_finite()) {
        return Vec::new();
    }
    let mut values: Vec<_> = if matrix.nrows() == 2 {
        eigenvalues_of_two(matrix).to_vec()
    } else {
        // With a bound on the iterations, which the plain call does not have.
        Schur::try_new(matrix.clone(), f64::EPSILON, 10_000)
            .map(|schur| schur.complex_eigenvalues().iter().copied().collect())
            .unwrap_or_default()
    };
    // Products of entries overflow before the entries do: then nothing is known either.
    if values.iter().any(|value| !value.norm().is_finite()) {
        return Vec::new();
    }
    values.sort_by(|a, b| b.norm().total_cmp(&a.norm()).then(b.im.total_cmp(&a.im)));
    values
}

/// Both roots of `z^2 - trace z + determinant`, the smaller one from the product so that it keeps its digits.
fn eigenvalues_of_two(matrix: &DMatrix<f64>) -> [Complex<f64>; 2] {
    let (a, b, c, d) = (
        matrix[(0, 0)],
        matrix[(0, 1)],
        matrix[(1, 0)],
        matrix[(1, 1)],
    );
    let mean = 0.5 * (a + d);
    let half = 0.5 * (a - d);
    let square = half * half + b * c;
    if square < 0.0 {
        let root = (-square).sqrt();
        [Complex::new(mean, root), Complex::new(mean, -root)]
    } else {
        let first = mean + square.sqrt().copysign(mean);
        let second = if first == 0.0 {
            0.0
        } else {
            (a * d - b * c) / first
        };
        [Complex::new(first, 0.0), Complex::new(second, 0.0)]
    }
}

/// Largest distance between the multipliers of two approximations, each matched with its nearest.
pub(crate) fn distance(a: &[Complex<f64>], b: &[Complex<f64>]) -> f64 {
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
