//! How multipliers move.
//!
//! With the matrix `M` over the period, `M v = mu v` and `w M = mu w`,
//!
//! ```text
//! mu' = w M' v / w v,        M' v = sum_i M_m .. M_(i+1) X_i (s_i', p')                                        (1)
//! ```
//!
//! where `M_i` are the matrices over the segments, and `X_i` is (1) of [`change`](super::change) along `v_i = M_(i-1) .. M_1 v`.
//! Where a multiplier is repeated, `w v` vanishes, or the derivative is not one of a single number: it does not exist. One that the flow does not
//! tell from another has none that could be known.
//!
//! Source: Seyranian and Mailybaev (2003), Multiparameter Stability Theory with Mechanical Applications, chapters 2 and 9.

use nalgebra::{Complex, DMatrix, DVector, Schur};

use super::change::{Centre, Change};
use super::cycle::Cycle;
use super::error::SensitivityError;
use super::orbit::finite;
use super::reader::Along;
use super::{Measured, Missing, Sensitivities};
use crate::numeric::estimate::Estimate;
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
        self.gap <= SAME * self.value.norm() || self.condition <= DEFECTIVE
    }

    /// Whether the flow leaves more in the matrix than another one is away.
    fn is_noise(&self) -> bool {
        self.gap <= NOISE * self.size
    }

    /// How it moves with an orbit of which the matrices over the segments are known.
    ///
    /// # Errors
    /// As those of [`Centre::change`].
    pub(super) fn bend(
        &self,
        cycle: &mut Cycle,
        centre: &Centre<'_>,
        matrices: &[DMatrix<f64>],
    ) -> Result<Bend, SensitivityError> {
        let complex = |matrix: &DMatrix<f64>| matrix.map(|x| Complex::new(x, 0.0));
        let (mut right, mut left) = (self.right.clone(), self.left.clone());
        let mut rights = Vec::with_capacity(cycle.unknowns());
        // (1) is linear in each `v_i`: of length one all segments are differenced over steps that suit them.
        let mut lengths = Vec::with_capacity(matrices.len());
        for matrix in matrices {
            let length = Some(right.norm())
                .filter(|length| *length > 0.0)
                .unwrap_or(1.0);
            rights.extend(right.iter().map(|x| x / length));
            lengths.push(length);
            right = complex(matrix) * right;
        }
        let mut lefts = Vec::with_capacity(matrices.len());
        for matrix in matrices.iter().rev() {
            lefts.push(left.clone());
            left = complex(matrix).tr_mul(&left);
        }
        lefts.reverse();
        for (left, length) in lefts.iter_mut().zip(lengths) {
            left.scale_mut(length);
        }
        let part = |of: fn(&Complex<f64>) -> f64| {
            DVector::from_iterator(rights.len(), rights.iter().map(of))
        };
        let mut directions = vec![part(|x| x.re)];
        if self.value.im != 0.0 {
            directions.push(part(|x| x.im));
        }
        let changes = directions.iter();
        let changes = changes.map(|direction| centre.change(cycle, direction));
        Ok(Bend {
            changes: changes.collect::<Result<_, _>>()?,
            lefts,
            product: self.left.dot(&self.right),
            turned: 2.0 * NOISE * self.size / self.gap,
        })
    }
}

/// A multiplier with what (1) takes.
pub(super) struct Bend {
    /// Along the real part of `v`, and along its imaginary part if there is one.
    changes: Vec<Change>,
    /// `w M_m .. M_(i+1)`, times the length of `v_i`.
    lefts: Vec<DVector<Complex<f64>>>,
    /// `w v`
    product: Complex<f64>,
    /// How far noise turns the vectors.
    turned: f64,
}

impl Bend {
    /// (1) along a direction, and its error, to which the same by another flow adds; infinite without that.
    fn slope_of(&self, along: &Along, other: Option<&Along>) -> (Complex<f64>, f64) {
        let (slope, error) = self.slope(along);
        let apart = other.map_or(f64::INFINITY, |other| {
            let (beside, _) = self.slope(other);
            (slope - beside).norm()
        });
        (slope, finite(error + apart))
    }

    /// (1) along a direction, and its error.
    pub(super) fn slope(&self, along: &Along) -> (Complex<f64>, f64) {
        let mut sum = Complex::new(0.0, 0.0);
        let mut error = 0.0;
        let parts = [Complex::new(1.0, 0.0), Complex::i()];
        let longest = self
            .lefts
            .iter()
            .fold(0.0, |m: f64, left| m.max(left.norm()));
        for (change, part) in self.changes.iter().zip(parts) {
            for (segment, left) in self.lefts.iter().enumerate() {
                let moved = change.over(segment, along).map(|x| part * x);
                sum += left.dot(&moved);
            }
            // The vectors are those of a matrix with noise, which counts the more the nearer another multiplier is.
            let [size, own] = change.bounds(along);
            error += longest * (own + self.turned * size);
        }
        let count = self.lefts.len() as f64;
        (sum / self.product, count * error / self.product.norm())
    }
}

/// Adds the derivatives of the multipliers of an orbit along directions as rows, or says which have none. Each direction is given as two flows
/// have it: where the orbit is hardly determined, they are what is known least.
///
/// # Errors
/// As those of [`Centre::change`].
pub(super) fn add(
    cycle: &mut Cycle,
    centre: &Centre<'_>,
    matrices: &[DMatrix<f64>],
    directions: &[(&Along, Option<&Along>)],
    told: &mut Sensitivities,
) -> Result<(), SensitivityError> {
    let all = of(&product(matrices));
    if all.is_empty() {
        let why = "they could not be computed";
        told.missing.push(Missing::new("multipliers", why));
    }
    let mut rows = Vec::new();
    let mut missing = Vec::new();
    let mut before: Vec<(Complex<f64>, f64)> = Vec::new();
    for (index, multiplier) in all.iter().enumerate() {
        let name = format!("multiplier_{}", index + 1);
        let why = if multiplier.is_repeated() {
            Some("it is a repeated one, which has no derivatives")
        } else if multiplier.is_noise() {
            Some(
                "it is so near another one, and so small, that the motion does not tell them apart",
            )
        } else {
            None
        };
        if let Some(why) = why {
            missing.push(Missing::new(name, why));
            continue;
        }
        let is_second = index > 0 && multiplier.value.im < 0.0;
        let slopes: Vec<(Complex<f64>, f64)> =
            if is_second && all[index - 1].value == multiplier.value.conj() {
                before
                    .iter()
                    .map(|(slope, error)| (slope.conj(), *error))
                    .collect()
            } else {
                let bend = multiplier.bend(cycle, centre, matrices)?;
                directions
                    .iter()
                    .map(|(along, other)| bend.slope_of(along, *other))
                    .collect()
            };
        for part in ["re", "im"] {
            let of = |value: Complex<f64>| if part == "re" { value.re } else { value.im };
            // A simple real multiplier stays real.
            let is_real = part == "im" && multiplier.value.im == 0.0;
            let by = slopes.iter().map(|&(value, error)| Estimate {
                value: of(value),
                error: if is_real { 0.0 } else { error },
            });
            rows.push(Measured {
                name: format!("{name}_{part}"),
                unit: String::new(),
                value: of(multiplier.value),
                by: by.collect(),
            });
        }
        before = slopes;
    }
    told.measured.extend(rows);
    told.missing.extend(missing);
    Ok(())
}

/// The matrix over the period.
pub(super) fn product(matrices: &[DMatrix<f64>]) -> DMatrix<f64> {
    let order = matrices.first().map_or(0, DMatrix::nrows);
    let one = DMatrix::identity(order, order);
    matrices.iter().fold(one, |product, own| own * product)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Small multipliers are apart by their own size; below what the flow leaves nothing tells them apart; and one that stands twice is repeated.
    #[test]
    fn small_multipliers_are_told_apart_as_far_as_they_are_known() {
        let diagonal = |values: [f64; 3]| of(&DMatrix::from_diagonal(&values.to_vec().into()));
        let told = |all: &[Multiplier]| -> Vec<[bool; 2]> {
            let all = all.iter();
            all.map(|one| [one.is_repeated(), one.is_noise()]).collect()
        };
        let apart = diagonal([0.5, 2e-9, 1e-9]);
        assert_eq!(told(&apart), [[false; 2]; 3]);
        let noise = diagonal([0.5, 2e-13, 1e-13]);
        assert_eq!(told(&noise), [[false; 2], [false, true], [false, true]]);
        let repeated = diagonal([0.5, 0.3, 0.3 + 1e-9]);
        assert!(repeated[1].is_repeated() && repeated[2].is_repeated());
    }
}
