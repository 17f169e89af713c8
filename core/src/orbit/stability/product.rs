//! Eigenvalues of a product of matrices, over any number of decades.
//!
//! A product that is formed knows its eigenvalues to a rounding error of the largest one. The factors know each of them to a
//! relative one, if none of the factors by itself is far from a multiple of an orthogonal matrix. So the product `A_P ... A_1` is
//! brought to triangular form without being formed: orthogonal bases are carried around,
//!
//! ```text
//! A_j Q_(j-1) = Q_j R_j,    Q_0^T (A_P ... A_1) Q_0 = G R_P ... R_1,    G = Q_0^T Q_P                          (1)
//! ```
//!
//! and `Q_P` is the next `Q_0`. This is the QR iteration on the product, without shifts: the entries of `G` below the diagonal
//! fall with the ratio of the moduli on either side. Where a lower left block of `G` has fallen to rounding, a relative error of
//! one factor, the eigenvalues part into those of the two diagonal blocks, and a block of the product is the product of the
//! blocks. What does not part has moduli so close that its product may be formed.
//!
//! Source: Bojanczyk, Golub and Van Dooren (1992), The periodic Schur decomposition, SPIE 1770; Watkins (2005), Product
//! eigenvalue problems, SIAM Review 47, sections 2 and 6 (the implicit iteration, and why relative errors are small).

use nalgebra::{Complex, DMatrix, QR};

use crate::numeric::spectrum::eigenvalues;
use crate::numeric::spectrum::sort;

/// Size of an entry of an orthogonal matrix that has vanished.
const VANISHED: f64 = 1e-14;
/// Sweeps at most.
const SWEEPS: usize = 150;
/// Relative difference of the moduli of a block that need not part: its product is as good.
const CLOSE: f64 = 0.1;

/// Eigenvalues of `factors[P - 1] ... factors[0]`, largest modulus first; empty if they are not finite.
pub(super) fn eigenvalues_of_product(factors: &[DMatrix<f64>]) -> Vec<Complex<f64>> {
    let Some(order) = factors.first().map(DMatrix::nrows) else {
        return Vec::new();
    };
    if factors.iter().flatten().any(|x| !x.is_finite()) {
        return Vec::new();
    }
    let mut first = DMatrix::identity(order, order);
    let mut triangular = factors.to_vec();
    let mut found = Vec::new();
    for _ in 0..SWEEPS {
        let mut basis = first.clone();
        for (factor, triangular) in factors.iter().zip(&mut triangular) {
            let qr = QR::new(factor * &basis);
            (basis, *triangular) = (qr.q(), qr.r());
        }
        let turn = first.transpose() * &basis;
        first = basis;
        found.clear();
        let (mut start, mut done) = (0, true);
        for end in 1..=order {
            if end == order || parts(&turn, end) {
                let block = of_block(&turn, &triangular, start, end - start);
                done &= are_close(&block);
                found.extend(block);
                start = end;
            }
        }
        if done {
            break;
        }
    }
    if found.len() == order {
        sort(found)
    } else {
        Vec::new()
    }
}

/// Whether no modulus is far smaller than another.
fn are_close(values: &[Complex<f64>]) -> bool {
    let sizes = values.iter().map(|value| value.norm());
    let (least, largest) = sizes.fold((f64::INFINITY, 0.0_f64), |(a, b), x| (a.min(x), b.max(x)));
    least >= CLOSE * largest
}

/// Whether the entries below and to the left of a split have vanished.
fn parts(turn: &DMatrix<f64>, split: usize) -> bool {
    let order = turn.nrows();
    let block = turn.view((split, 0), (order - split, split));
    block.iter().all(|x| x.abs() < VANISHED)
}

/// Eigenvalues of one diagonal block of the product, whose size is kept in a logarithm.
fn of_block(
    turn: &DMatrix<f64>,
    triangular: &[DMatrix<f64>],
    start: usize,
    size: usize,
) -> Vec<Complex<f64>> {
    let block = |matrix: &DMatrix<f64>| matrix.view((start, start), (size, size)).into_owned();
    let mut product = DMatrix::identity(size, size);
    let mut logarithm = 0.0;
    for factor in triangular.iter().map(block).chain([block(turn)]) {
        product = factor * product;
        let scale = product.amax();
        if scale > 0.0 {
            product /= scale;
            logarithm += scale.ln();
        }
    }
    let scaled = eigenvalues(&product).into_iter();
    scaled.map(|value| value.scale(logarithm.exp())).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::testing::random::Random;

    /// Factors `X_(j+1) D_j X_j^(-1)` with block diagonal `D_j`: the eigenvalues of their product are known.
    fn factors(moduli: &[f64], angles: &[f64], count: usize, seed: u32) -> Vec<DMatrix<f64>> {
        let mut random = Random::seeded(seed.into());
        let order: usize = angles
            .iter()
            .map(|&angle| if angle == 0.0 { 1 } else { 2 })
            .sum();
        let mut basis = || {
            DMatrix::from_fn(order, order, |i, j| {
                random.between(-0.3, 0.3) + f64::from(u8::from(i == j))
            })
        };
        let first = basis();
        let mut from = first.clone();
        (0..count)
            .map(|j| {
                let to = if j + 1 == count {
                    first.clone()
                } else {
                    basis()
                };
                let mut diagonal = DMatrix::zeros(order, order);
                let mut place = 0;
                for (modulus, &angle) in moduli.iter().zip(angles) {
                    let root = modulus.powf(1.0 / count as f64);
                    let (s, c) = (angle / count as f64).sin_cos();
                    diagonal[(place, place)] = root * c;
                    if angle != 0.0 {
                        diagonal[(place, place + 1)] = -root * s;
                        diagonal[(place + 1, place)] = root * s;
                        diagonal[(place + 1, place + 1)] = root * c;
                        place += 1;
                    }
                    place += 1;
                }
                let factor = &to * diagonal * from.clone().try_inverse().unwrap();
                from = to;
                factor
            })
            .collect()
    }

    fn check(moduli: &[f64], angles: &[f64], allowed: f64) {
        let factors = factors(moduli, angles, 24, 7);
        let found = eigenvalues_of_product(&factors);
        let mut index = 0;
        for (&modulus, &angle) in moduli.iter().zip(angles) {
            for sign in if angle == 0.0 {
                &[1.0][..]
            } else {
                &[1.0, -1.0]
            } {
                let expected = Complex::from_polar(modulus, sign * angle);
                let error = (found[index] - expected).norm() / modulus;
                assert!(
                    error < allowed,
                    "{index} {} {expected}: {error:e}",
                    found[index]
                );
                index += 1;
            }
        }
    }

    #[test]
    fn moduli_over_many_decades_keep_their_digits() {
        check(&[1e6, 1e-6], &[0.0, 0.0], 1e-11);
        check(&[1e6, 0.99, 1e-6], &[0.0, 1.3, 0.0], 1e-11);
        check(
            &[1e9, 30.0, 1.0, 1e-3, 1e-12],
            &[0.4, 0.0, 2.0, 0.0, 0.7],
            1e-10,
        );
        // The product itself has lost the small ones.
        let factors = factors(&[1e9, 1e-9], &[0.0, 0.0], 24, 7);
        let product = factors.iter().fold(DMatrix::identity(2, 2), |p, f| f * p);
        let naive = eigenvalues(&product);
        assert!((naive[1].norm() / 1e-9 - 1.0).abs() > 0.1, "{}", naive[1]);
    }

    #[test]
    fn close_moduli_stay_together() {
        check(&[1.0, 0.95, 0.9], &[0.3, 1.1, 0.0], 1e-11);
        check(&[1e4, 1.0, 0.97], &[0.0, 0.8, 0.5], 1e-10);
    }

    #[test]
    fn what_overflows_is_unknown() {
        assert!(eigenvalues_of_product(&[]).is_empty());
        let large = DMatrix::identity(2, 2) * 1e200;
        assert!(eigenvalues_of_product(&[large.clone(), large]).is_empty());
        let nothing = DMatrix::from_element(2, 2, f64::NAN);
        assert!(eigenvalues_of_product(&[nothing]).is_empty());
    }
}
