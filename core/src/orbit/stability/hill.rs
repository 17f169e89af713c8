//! Hill's method: Floquet exponents as eigenvalues of the Hill matrix.
//!
//! Without truncation every exponent `sigma` has copies `sigma + i j`, which give the same multiplier `e^(2 pi sigma)` and whose
//! eigenvectors are shifted by `j` harmonics. A truncated matrix has as many good ones as there are exponents, and others that
//! the truncation spoils the more the farther their eigenvectors are from the middle. Which are good is a matter of
//! [`Sorting`]:
//!
//! - by the smallest `|Im sigma|`. With real negative multipliers, whose exponents have copies at `+1/2` and at `-1/2`, it may
//!   take the two copies of one and miss the other;
//! - by the weighted mean of the eigenvector, with `v_k` its part of harmonic `k` in the complex form, smallest
//!
//! ```text
//! | sum_k k |v_k| | / sum_k |v_k|                                                                            (1)
//! ```
//!
//! - by symmetry: those with the smallest (1) of which none is a shifted copy of another.
//!
//! Whether the choice can be right is checked by Liouville's formula: the product of the multipliers is the determinant that the
//! mean of the damping gives, and what it misses by, as an error of one of them, is the error stated. The truncation
//! itself shows when the orbit is given more harmonics.
//!
//! Cost: all eigenvalues of a dense matrix of order `2 n (2 K + 1)`, for the sortings by eigenvectors these too.
//!
//! Sources: Guillot, Lazarus, Thomas, Vergez and Cochelin (2020), A purely frequency based Floquet-Hill formulation for the
//! efficient stability computation of periodic solutions of ordinary differential systems, J. Comput. Phys. 416, 109477,
//! equation (26) is (1); Moore (2005), Floquet theory as a computational tool, SIAM J. Numer. Anal. 42 (which are good).

use std::f64::consts::TAU;

use nalgebra::{Complex, Schur};

use super::hill_matrix::{Coefficients, Lattice};
use super::method::{Cost, Floquet, Found, Sorting};
use super::orbit::Orbit;
use crate::numeric::spectrum::{ITERATIONS, sort};
use crate::numeric::triangular::eigenvectors;

/// Overlap of an eigenvector, shifted, with another one from which on they are copies, of a unit.
const OVERLAP: f64 = 0.7;
/// Difference of their exponents up to which they agree.
const AGREEMENT: f64 = 0.1;

/// Computes eigenvalues of Hill matrices.
#[derive(Debug)]
pub(super) struct Hill {
    sorting: Sorting,
    cost: Cost,
}

/// An eigenvalue of the Hill matrix, and the size of its eigenvector's parts from harmonic `-H` to `H`.
struct Mode {
    exponent: Complex<f64>,
    /// Part by part, each a vector of displacements and velocities.
    parts: Vec<Vec<Complex<f64>>>,
    /// (1)
    mean: f64,
}

impl Hill {
    pub(super) fn new(sorting: Sorting) -> Self {
        Self {
            sorting,
            cost: Cost::default(),
        }
    }

    fn exponents(&self, coefficients: &Coefficients) -> Option<Vec<Complex<f64>>> {
        let wanted = 2 * coefficients.coordinates();
        let matrix = coefficients.matrix(Lattice::Whole);
        let schur = Schur::try_new(matrix, f64::EPSILON, ITERATIONS * wanted)?;
        if self.sorting == Sorting::ImaginaryPart {
            let mut all: Vec<_> = schur.complex_eigenvalues().iter().copied().collect();
            all.sort_by(|a, b| {
                a.im.abs()
                    .total_cmp(&b.im.abs())
                    .then(b.re.total_cmp(&a.re))
            });
            all.truncate(wanted);
            return Some(all);
        }
        let (vectors, triangular) = schur.unpack();
        let mut modes: Vec<_> = eigenvectors(&vectors, &triangular)
            .into_iter()
            .map(|(exponent, vector)| Mode::of(exponent, &vector, coefficients))
            .collect();
        modes.sort_by(|a, b| {
            let by_mean = a.mean.total_cmp(&b.mean);
            by_mean.then(a.exponent.im.abs().total_cmp(&b.exponent.im.abs()))
        });
        let mut chosen: Vec<&Mode> = Vec::new();
        for mode in &modes {
            let copied =
                self.sorting == Sorting::Symmetry && chosen.iter().any(|other| mode.is_copy(other));
            if !copied && chosen.len() < wanted {
                chosen.push(mode);
            }
        }
        Some(chosen.into_iter().map(|mode| mode.exponent).collect())
    }
}

impl Mode {
    fn of(exponent: Complex<f64>, vector: &[Complex<f64>], coefficients: &Coefficients) -> Self {
        let harmonics = coefficients.harmonics();
        let length = Lattice::Whole.length(harmonics);
        let mut parts = vec![Vec::new(); length];
        for series in vector.chunks_exact(length) {
            parts[harmonics].push(series[0]);
            for (index, pair) in series[1..].chunks_exact(2).enumerate() {
                // c cos + s sin = (c - i s)/2 e^(i k tau) + (c + i s)/2 e^(-i k tau)
                let (cosine, sine): (Complex<f64>, Complex<f64>) = (pair[0], pair[1]);
                let turned = Complex::<f64>::i() * sine;
                parts[harmonics + index + 1].push((cosine - turned).scale(0.5));
                parts[harmonics - index - 1].push((cosine + turned).scale(0.5));
            }
        }
        let (mut weighted, mut sum) = (0.0, 0.0);
        for (index, part) in parts.iter().enumerate() {
            let size = part.iter().map(Complex::norm_sqr).sum::<f64>().sqrt();
            weighted += (index as f64 - harmonics as f64) * size;
            sum += size;
        }
        Self {
            exponent,
            parts,
            mean: (weighted / sum).abs(),
        }
    }

    /// Whether this is another mode, shifted by some harmonics: then the exponents differ by `i` times their number.
    fn is_copy(&self, other: &Self) -> bool {
        let difference = other.exponent - self.exponent;
        let shift = difference.im.round();
        if shift == 0.0 || (difference - Complex::new(0.0, shift)).norm() > AGREEMENT {
            return false;
        }
        // e^(sigma tau) v_k e^(i k tau): a larger exponent goes with lower harmonics.
        let shift = shift as isize;
        let (mut product, mut sizes) = (Complex::new(0.0, 0.0), [0.0; 2]);
        for (index, part) in self.parts.iter().enumerate() {
            let place = index as isize - shift;
            sizes[0] += part.iter().map(Complex::norm_sqr).sum::<f64>();
            let Some(shifted) = usize::try_from(place)
                .ok()
                .and_then(|place| other.parts.get(place))
            else {
                continue;
            };
            sizes[1] += shifted.iter().map(Complex::norm_sqr).sum::<f64>();
            product += part
                .iter()
                .zip(shifted)
                .map(|(a, b)| a.conj() * b)
                .sum::<Complex<f64>>();
        }
        product.norm() > OVERLAP * (sizes[0] * sizes[1]).sqrt()
    }
}

/// What the product of multipliers misses the determinant by, as an error of one of them: of two the smaller, whose relative error
/// is the larger; of more it may be any, so that the largest is taken.
pub(super) fn defect(multipliers: &[Complex<f64>], determinant: f64) -> f64 {
    let (Some(first), Some(last)) = (multipliers.first(), multipliers.last()) else {
        return f64::INFINITY;
    };
    let product: Complex<f64> = multipliers.iter().product();
    let size = if multipliers.len() == 2 { last } else { first }.norm();
    let error = size * (Complex::new(1.0, 0.0) - Complex::new(determinant, 0.0) / product).norm();
    if error.is_nan() { f64::INFINITY } else { error }
}

/// Takes those out that are nearest to one: there is no matrix to take them out of.
fn take_out(multipliers: &mut Vec<Complex<f64>>, count: usize) {
    for _ in 0..count {
        let apart = multipliers.iter().map(|m| (m - 1.0).norm()).enumerate();
        let nearest = apart.min_by(|a, b| a.1.total_cmp(&b.1));
        if let Some((index, _)) = nearest {
            multipliers.remove(index);
        }
    }
}

impl Floquet for Hill {
    fn multipliers(&mut self, orbit: &Orbit<'_>, _aim: f64) -> Found {
        let Some(coefficients) = Coefficients::of(orbit) else {
            return Found::NOTHING;
        };
        let length = Lattice::Whole.length(coefficients.harmonics());
        self.cost += Cost {
            contacts: coefficients.contacts,
            spectra: 1,
            order: 2 * coefficients.coordinates() * length,
            ..Cost::default()
        };
        let Some(exponents) = self.exponents(&coefficients) else {
            return Found::NOTHING;
        };
        let multipliers = exponents.iter().map(|exponent| (exponent.scale(TAU)).exp());
        let mut multipliers = sort(multipliers.collect());
        let error = defect(&multipliers, coefficients.determinant());
        if let Some(rigid) = orbit.rigid {
            take_out(&mut multipliers, rigid.multipliers());
        }
        Found {
            multipliers,
            error,
            ..Found::NOTHING
        }
    }

    fn knows_its_error(&self) -> bool {
        false
    }

    fn cost(&self) -> Cost {
        self.cost
    }
}
