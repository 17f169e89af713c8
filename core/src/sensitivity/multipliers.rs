//! How multipliers move.
//!
//! With the matrix `M` over the period, `M v = mu v` and `w M = mu w`,
//!
//! ```text
//! mu' = w M' v / w v.                                                                                          (1)
//! ```
//!
//! Where a multiplier is repeated, `w v` vanishes, or the derivative is not one of a single number: it does not exist.
//!
//! Source: Seyranian and Mailybaev (2003), Multiparameter Stability Theory with Mechanical Applications, chapters 2 and 9.

use nalgebra::{Complex, DMatrix, DVector, Schur};

use super::change::Change;
use super::{Derivative, Measured, Missing, Sensitivities};
use crate::numeric::spectrum::ITERATIONS;
use crate::numeric::triangular::eigenvectors;

/// Multipliers that differ by less than this part of their size are one.
const SAME: f64 = 1e-7;
/// And so are two where `w v` is below this, of vectors of length one.
const DEFECTIVE: f64 = 1e-6;
/// What the flow leaves in the matrix, as a part of it.
const NOISE: f64 = 1e-11;

/// A multiplier with its vectors.
#[derive(Debug, Clone)]
pub(super) struct Multiplier {
    pub(super) value: Complex<f64>,
    right: DVector<Complex<f64>>,
    left: DVector<Complex<f64>>,
    /// `|w v|`, of vectors of length one.
    condition: f64,
    /// Distance from the nearest other one.
    gap: f64,
    /// The norm of the matrix.
    size: f64,
}

/// All multipliers, largest modulus first, of a pair that with positive imaginary part first; none if they cannot be computed.
pub(super) fn of(matrix: &DMatrix<f64>) -> Vec<Multiplier> {
    let (Some(right), Some(left)) = (vectors(matrix), vectors(&matrix.transpose())) else {
        return Vec::new();
    };
    let values: Vec<Complex<f64>> = right.iter().map(|(value, _)| *value).collect();
    let found = right.into_iter().enumerate();
    let found = found.filter_map(|(index, (value, right))| {
        let apart = |other: &Complex<f64>| (other - value).norm();
        let others = values.iter().enumerate();
        let others = others.filter(|(other, _)| *other != index);
        let gap = others.fold(f64::INFINITY, |m: f64, (_, other)| m.min(apart(other)));
        let nearest = left
            .iter()
            .min_by(|a, b| apart(&a.0).total_cmp(&apart(&b.0)));
        let left = nearest?.1.clone();
        Some(Multiplier {
            value,
            condition: left.dot(&right).norm(),
            right,
            left,
            gap,
            size: matrix.norm(),
        })
    });
    let mut found: Vec<Multiplier> = found.collect();
    found.sort_by(|a, b| {
        let [x, y] = [a.value, b.value];
        y.norm().total_cmp(&x.norm()).then(y.im.total_cmp(&x.im))
    });
    found
}

type Pair = (Complex<f64>, DVector<Complex<f64>>);

/// Eigenvalues with vectors of length one.
fn vectors(matrix: &DMatrix<f64>) -> Option<Vec<Pair>> {
    let finite = matrix.iter().all(|x| x.is_finite());
    let schur = finite.then(|| Schur::try_new(matrix.clone(), f64::EPSILON, ITERATIONS));
    let (q, t) = schur.flatten()?.unpack();
    let found = eigenvectors(&q, &t).into_iter();
    Some(
        found
            .map(|(value, vector)| (value, DVector::from_vec(vector)))
            .collect(),
    )
}

impl Multiplier {
    /// Whether another one is the same, so that it has no derivative.
    pub(super) fn is_repeated(&self) -> bool {
        self.gap <= SAME * (1.0 + self.value.norm()) || self.condition <= DEFECTIVE
    }

    /// (1), and its error.
    pub(super) fn slope(&self, change: &Change) -> (Complex<f64>, f64) {
        let matrix = change.matrix.map(|x| Complex::new(x, 0.0));
        let value = self.left.dot(&(matrix * &self.right)) / self.left.dot(&self.right);
        // The vectors are those of a matrix with noise, which counts the more the nearer another multiplier is.
        let turned = 2.0 * NOISE * self.size / self.gap;
        let error = change.error + turned * change.matrix.norm();
        (value, error / self.condition)
    }
}

/// Adds the derivatives of multipliers as rows, or says which have none.
pub(super) fn add(all: &[Multiplier], changes: &[Change], told: &mut Sensitivities) {
    if all.is_empty() {
        let why = "they could not be computed";
        told.missing.push(Missing::new("multipliers", why));
    }
    for (index, multiplier) in all.iter().enumerate() {
        let name = format!("multiplier_{}", index + 1);
        if multiplier.is_repeated() {
            let why = "it is a repeated one, which has no derivatives";
            told.missing.push(Missing::new(name, why));
            continue;
        }
        let slopes: Vec<_> = changes
            .iter()
            .map(|change| multiplier.slope(change))
            .collect();
        for part in ["re", "im"] {
            let of = |value: Complex<f64>| if part == "re" { value.re } else { value.im };
            let by = slopes.iter().map(|&(value, error)| Derivative {
                value: of(value),
                error,
            });
            told.measured.push(Measured {
                name: format!("{name}_{part}"),
                unit: String::new(),
                value: of(multiplier.value),
                by: by.collect(),
            });
        }
    }
}
