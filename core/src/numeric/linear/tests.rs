//! Factors against nalgebra, and what cannot be factorised.

use super::*;
use proptest::prelude::*;

fn random_matrix(order: usize, entries: &[f64]) -> Matrix {
    let mut matrix = Matrix::zeros(order);
    for row in 0..order {
        let entries = &entries[row * order..][..order];
        matrix.row_mut(row).copy_from_slice(entries);
    }
    matrix
}

fn dense(matrix: &Matrix) -> nalgebra::DMatrix<f64> {
    nalgebra::DMatrix::from_fn(matrix.order, matrix.order, |i, j| matrix.row(i)[j])
}

proptest! {
    #[test]
    fn agrees_with_nalgebra(
        order in 1_usize..12,
        entries in prop::collection::vec(-1.0..1.0_f64, 144),
        rhs in prop::collection::vec(-1.0..1.0_f64, 12),
        units in prop::collection::vec(-6..6_i32, 12),
    ) {
        let mut matrix = random_matrix(order, &entries);
        for (row, unit) in (0..order).zip(&units) {
            for x in matrix.row_mut(row) {
                *x *= 10_f64.powi(*unit);
            }
        }
        let reference = dense(&matrix);
        let mut x = rhs[..order].to_vec();
        let mut lu = Lu::new(order);
        let condition = {
            let s = reference.clone().svd(false, false).singular_values;
            s.max() / s.min()
        };
        if lu.factorise(&mut matrix).is_ok() {
            lu.solve(&matrix, &mut x);
            let x = nalgebra::DVector::from_vec(x);
            let residual = &reference * &x - nalgebra::DVector::from_column_slice(&rhs[..order]);
            // |L| |U| is of the size of the largest entry of its row, where the matrix itself may have a zero
            // (Higham (2002), Accuracy and Stability of Numerical Algorithms, theorem 9.4).
            let size = x.abs().sum();
            let scale = nalgebra::DVector::from_fn(order, |i, _| {
                reference.row(i).amax() * size + 1.0
            });
            for (r, s) in residual.iter().zip(scale.iter()) {
                prop_assert!(r.abs() <= 1e-13 * s, "{r:e} of {s:e}");
            }
            let mut groups: Vec<Group> = rhs[..order]
                .iter()
                .map(|b| std::array::from_fn(|l| b * (l as f64 - 3.0)))
                .collect();
            lu.solve_groups(&matrix, &mut groups);
            for (l, times) in (0..LANES).map(|l| (l, l as f64 - 3.0)) {
                let of = nalgebra::DVector::from_fn(order, |i, _| groups[i][l]);
                let residual = &reference * of
                    - nalgebra::DVector::from_column_slice(&rhs[..order]) * times;
                for (r, s) in residual.iter().zip(scale.iter()) {
                    prop_assert!(r.abs() <= 1e-13 * times.abs() * s, "{r:e} of {s:e}");
                }
            }
            let mut y = rhs[..order].to_vec();
            lu.solve_transposed(&matrix, &mut y);
            let y = nalgebra::DVector::from_vec(y);
            let b = nalgebra::DVector::from_column_slice(&rhs[..order]);
            let bound = reference.abs().transpose() * y.abs() + b.abs();
            // Pivoting is by rows, so the transposed system is solved to the norm, not row by row.
            let residual = (reference.transpose() * &y - b).amax();
            prop_assert!(residual <= 1e-11 * bound.amax().max(1.0), "{residual:e}");
        } else {
            prop_assert!(condition > 1e12);
        }
    }
}

/// Tiles and panels, whole ones and what is left of them.
#[test]
fn large_systems_agree_with_nalgebra() {
    for order in [40, 97] {
        let entries: Vec<f64> = (0..order * order)
            .map(|i| (i as f64).powi(2).sin())
            .collect();
        let mut matrix = random_matrix(order, &entries);
        let reference = dense(&matrix);
        let b = nalgebra::DVector::from_fn(order, |i, _| 1.0 + (i as f64).cos());
        let condition = {
            let s = reference.clone().svd(false, false).singular_values;
            s.max() / s.min()
        };
        let mut lu = Lu::new(order);
        lu.factorise(&mut matrix).unwrap();
        let transpose = reference.transpose();
        for (transposed, reference) in [(false, reference), (true, transpose)] {
            let mut x = b.clone();
            if transposed {
                lu.solve_transposed(&matrix, x.as_mut_slice());
            } else {
                lu.solve(&matrix, x.as_mut_slice());
            }
            let expected = reference.lu().solve(&b).unwrap();
            // A backward error of a rounding error for each term, in either solution.
            let bound = 2.0 * f64::EPSILON * order as f64 * condition * expected.norm();
            let difference = (x - expected).norm();
            assert!(difference <= bound, "{difference:e} of {bound:e}");
        }
    }
}

#[test]
fn a_failure_leaves_nothing_behind() {
    let order = 9;
    let mut matrix = Matrix::zeros(order);
    // The multiplier of the second row overflows.
    for row in 0..order {
        matrix
            .row_mut(row)
            .fill(10_f64.powi(if row == 0 { -300 } else { 300 }));
    }
    let mut lu = Lu::new(order);
    assert!(lu.factorise(&mut matrix).is_err());
    for row in 0..order {
        matrix.row_mut(row).fill(0.0);
        matrix.row_mut(row)[order - 1 - row] = 2.0;
    }
    let mut x: Vec<f64> = (0..order).map(|i| i as f64).collect();
    lu.factorise(&mut matrix).unwrap();
    lu.solve(&matrix, &mut x);
    for (i, x) in x.iter().enumerate() {
        assert_eq!(*x, (order - 1 - i) as f64 / 2.0);
    }
}

#[test]
fn refuses_singular_matrices_and_nan() {
    let mut zero_column = random_matrix(2, &[1.0, 0.0, 3.0, 0.0]);
    assert_eq!(
        Lu::new(2).factorise(&mut zero_column).unwrap_err().column,
        1
    );
    let mut nan = random_matrix(2, &[f64::NAN, 1.0, 1.0, 1.0]);
    assert!(Lu::new(2).factorise(&mut nan).is_err());
    assert!(Lu::new(1).factorise(&mut Matrix::zeros(1)).is_err());
}

#[test]
fn the_empty_system_has_the_empty_solution() {
    let mut empty = Matrix::zeros(0);
    let mut lu = Lu::new(0);
    assert!(lu.factorise(&mut empty).is_ok());
    lu.solve(&empty, &mut []);
}
