//! A neighbourhood of a stable periodic point from which motions are known to end on it.
//!
//! Let `Q` be the map over the period, `p` its fixed point, `J` its derivative there with spectral radius `rho < 1`. In the norm
//!
//! ```text
//! |y|^2 = y^T H y,    H = sum_k (J^T)^k D J^k / r^(2 k),    rho < r < 1                                 (1)
//! |J y| <= r |y|                                                                                        (2)
//! ```
//!
//! the derivative contracts; `D` weighs the entries of a state by their sizes. With `m` so large that `|J^m| <= 1/8`, the ellipsoid
//! `|y| <= R` is grown from one so small that the derivative decides, in steps of a factor of at most two, as long as
//!
//! ```text
//! |Q^m(p + y) - p| < R  for all y with |y| = 2 R                                                        (3)
//! ```
//!
//! as far as a set of directions `y` shows. By induction all motions from within the larger ellipsoid enter the smaller one, and
//! then the ones before; for one coordinate it is enough to look at the boundary, since the map is a homeomorphism of the
//! plane, and the image of the inside is the inside of the image. As nothing is known between the directions, the
//! ellipsoid that is kept is half as large as the last one that passed.
//!
//! Source: Giesl and Hafner (2015), Discrete and Continuous Dynamical Systems B 20, 2291 (Lyapunov functions for fixed points).

use std::f64::consts::TAU;

use nalgebra::{Cholesky, DMatrix, DVector};

use crate::attractors::log::{Reader, Writer};
use crate::time::stroboscope::Stroboscope;

/// Directions that are looked at for one coordinate, and for each entry of larger states.
const DIRECTIONS: usize = 32;
/// The norm of `J^m`.
const CONTRACTION: f64 = 0.125;
/// Size of the first ellipsoid, relative to the states.
const FIRST: f64 = 1e-5;
/// Periods that one motion may be followed in (3).
const LONGEST: usize = 4000;
/// Times that the ellipsoid may grow.
const GROWTHS: usize = 400;

/// An ellipsoid.
#[derive(Debug, Clone, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub(super) struct Ball {
    #[cfg_attr(feature = "serde", serde(with = "crate::serialise"))]
    centre: Vec<f64>,
    /// `H / R^2`, row by row.
    #[cfg_attr(feature = "serde", serde(with = "crate::serialise"))]
    form: Vec<f64>,
    /// How far it reaches from the centre, entry by entry.
    #[cfg_attr(feature = "serde", serde(with = "crate::serialise"))]
    reach: Vec<f64>,
}

impl Ball {
    /// Whether a state is inside.
    pub(super) fn contains(&self, state: &[f64]) -> bool {
        let order = self.centre.len();
        // It may have been read from a file.
        if [state.len(), self.reach.len()] != [order; 2] {
            return false;
        }
        let off = |i: usize| state[i] - self.centre[i];
        if (0..order).any(|i| off(i).abs() > self.reach[i]) {
            return false;
        }
        let rows = self.form.chunks_exact(order).enumerate();
        let square: f64 = rows
            .map(|(i, row)| {
                let sum: f64 = row.iter().enumerate().map(|(j, h)| h * off(j)).sum();
                off(i) * sum
            })
            .sum();
        square <= 1.0
    }

    /// The neighbourhood of a point of some period with the derivative `jacobian` of the map over it; `None` where not even the
    /// smallest one is mapped into itself. `size` is that of the entries of a state.
    pub(super) fn grow(
        map: &mut Stroboscope,
        centre: &[f64],
        period: usize,
        jacobian: &DMatrix<f64>,
        size: &[f64],
    ) -> Option<Self> {
        let order = centre.len();
        let norm = norm(jacobian, size)?;
        let factor = Cholesky::new(norm.clone())?;
        let (times, contraction) = times(jacobian, &factor, LONGEST.div_ceil(period));
        let step = (1.0 / contraction).sqrt().min(2.0);
        // Vectors of length one in the norm: L^T y = u.
        let directions: Option<Vec<DVector<f64>>> = directions(order)
            .into_iter()
            .map(|u| factor.l().transpose().solve_upper_triangular(&u))
            .collect();
        let directions = directions?;
        let mut state = vec![0.0; order];
        let mut enters = |radius: f64, into: f64| {
            directions.iter().all(|y| {
                for i in 0..order {
                    state[i] = centre[i] + radius * y[i];
                }
                let moves = (0..period * times).all(|_| map.map(&mut state).is_ok());
                let off = DVector::from_iterator(order, (0..order).map(|i| state[i] - centre[i]));
                let square = off.dot(&(&norm * &off));
                moves && square < into * into
            })
        };
        let mut radius = FIRST;
        if !enters(radius, radius / step) {
            return None;
        }
        for _ in 0..GROWTHS {
            if !enters(radius * step, radius) {
                break;
            }
            radius *= step;
        }
        radius /= 2.0;
        let inverse = factor.inverse();
        Some(Self {
            centre: centre.to_vec(),
            form: (&norm / (radius * radius)).transpose().as_slice().to_vec(),
            reach: (0..order)
                .map(|i| radius * inverse[(i, i)].sqrt())
                .collect(),
        })
    }

    pub(super) fn written(&self, writer: &mut Writer) {
        for numbers in [&self.centre, &self.form, &self.reach] {
            writer.numbers(numbers);
        }
    }

    pub(super) fn read(reader: &mut Reader<'_>) -> Option<Self> {
        let (centre, form, reach) = (reader.numbers()?, reader.numbers()?, reader.numbers()?);
        let order = centre.len();
        let fits = form.len() == order * order && reach.len() == order;
        fits.then_some(Self {
            centre,
            form,
            reach,
        })
    }
}

/// The matrix (1), by doubling the number of terms of the sum (Smith 1968).
fn norm(jacobian: &DMatrix<f64>, size: &[f64]) -> Option<DMatrix<f64>> {
    let rho = crate::numeric::spectrum::eigenvalues(jacobian)
        .first()?
        .norm();
    let rate = (rho + 0.2 * (1.0 - rho)).max(0.3);
    let mut power = jacobian / rate;
    let mut sum = DMatrix::from_diagonal(&DVector::from_iterator(
        size.len(),
        size.iter().map(|size| 1.0 / (size * size)),
    ));
    for _ in 0..64 {
        let more = power.transpose() * &sum * &power;
        let done = more.norm() <= 1e-12 * sum.norm();
        sum += more;
        power = &power * &power;
        if done {
            return Some(0.5 * (&sum + sum.transpose()));
        }
    }
    None
}

/// The number `m` of (3), at most `most`, and the norm of `J^m`.
fn times(
    jacobian: &DMatrix<f64>,
    factor: &Cholesky<f64, nalgebra::Dyn>,
    most: usize,
) -> (usize, f64) {
    // |J y| over |y| is the spectral norm of L^T J L^-T.
    let lower = factor.l();
    let upper = lower.transpose();
    let inverse = upper.clone().try_inverse().unwrap_or_else(|| upper.clone());
    let single = &upper * jacobian * inverse;
    let mut power = single.clone();
    let mut count = 1;
    loop {
        let size = power.singular_values().max();
        if size <= CONTRACTION || count >= most {
            return (count, size);
        }
        power = &power * &single;
        count += 1;
    }
}

/// Directions in a space, of length one: evenly around a circle, or spread over the sphere.
fn directions(order: usize) -> Vec<DVector<f64>> {
    if order == 2 {
        let angle = |i: usize| TAU * i as f64 / DIRECTIONS as f64;
        let on_circle = |i| DVector::from_vec(vec![f64::cos(angle(i)), f64::sin(angle(i))]);
        return (0..DIRECTIONS).map(on_circle).collect();
    }
    // Both ways along every entry, then points of a sequence that fills the cube evenly: multiples of the powers of the
    // root of x^(order + 1) = x + 1 (Roberts 2018), which is the golden section for order one.
    let root = (0..60).fold(1.5, |x: f64, _| (1.0 + x).powf(1.0 / (order + 1) as f64));
    let entry = |i: usize, j: usize| 2.0 * ((i + 1) as f64 / root.powi(j as i32 + 1)).fract() - 1.0;
    let along = |i: usize, j: usize| f64::from(u8::from(i / 2 == j)) * [1.0, -1.0][i % 2];
    let at = |i: usize, j: usize| {
        if i < 2 * order {
            along(i, j)
        } else {
            entry(i, j)
        }
    };
    let count = DIRECTIONS * order;
    let point = |i: usize| DVector::from_iterator(order, (0..order).map(|j| at(i, j)));
    let points = (0..count).map(point).filter(|point| point.norm() > 0.1);
    points.map(|point| point.normalize()).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::time::affine::Affine;

    crate::oscillator! {
        Linear(x) {
            param zeta in 0.0..;
            param drive;
            ddot(x) + 2*zeta*dot(x) + 4*x = drive*cos(omega*t);
        }
    }

    /// For a linear map every ellipsoid passes: it grows as long as it may.
    #[test]
    fn for_a_linear_map_there_is_no_end() {
        let model = Linear {
            zeta: 0.05,
            drive: 0.0,
        };
        let flow = Affine::new(&model, &[0.05, 0.0], 1.0).expect("affine");
        let mut map = Stroboscope::new(Box::new(flow));
        let mut tangent = crate::time::Tangent::of_state(1, None);
        map.map_with(&mut [0.0, 0.0], &mut tangent)
            .expect("a motion");
        let jacobian = DMatrix::from_vec(2, 2, tangent.columns);
        let ball = Ball::grow(&mut map, &[0.0; 2], 1, &jacobian, &[1.0; 2]).expect("a ball");
        assert!(ball.contains(&[1e50, -1e50]));
        let mut writer = Writer::default();
        ball.written(&mut writer);
        assert_eq!(Ball::read(&mut Reader(&writer.0)), Some(ball));
    }

    /// The norm contracts as (2) says, also where the matrix is far from normal.
    #[test]
    fn the_norm_contracts() {
        let jacobian = DMatrix::from_row_slice(2, 2, &[0.9, 100.0, 0.0, 0.9]);
        let norm = norm(&jacobian, &[1.0, 1.0]).expect("a norm");
        let mapped = jacobian.transpose() * &norm * &jacobian;
        let rate: f64 = 0.9 + 0.2 * 0.1;
        let left = norm * (rate * rate) - mapped;
        assert!(Cholesky::new(left).is_some());
    }

    #[test]
    fn directions_have_length_one_and_cover_the_sphere() {
        for order in [2, 4, 6] {
            let all = directions(order);
            assert!(all.len() >= DIRECTIONS);
            for i in 0..order {
                assert!(all.iter().any(|u| u[i] > 0.6) && all.iter().any(|u| u[i] < -0.6));
            }
            assert!(all.iter().all(|u| (u.norm() - 1.0).abs() < 1e-12));
        }
    }
}
