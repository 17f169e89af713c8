//! One step of a linear differential equation by Magnus' expansion, sixth order.
//!
//! For `Y' = A(s) Y` and a step `h` with `A_1, A_2, A_3` at the three Gauss-Legendre nodes of the step,
//!
//! ```text
//! a_1 = h A_2,    a_2 = h sqrt(15)/3 (A_3 - A_1),    a_3 = h 10/3 (A_3 - 2 A_2 + A_1)                        (1)
//! C_1 = [a_1, a_2],    C_2 = -[a_1, 2 a_3 + C_1] / 60                                                        (2)
//! Omega = a_1 + a_3/12 + [-20 a_1 - a_3 + C_1, a_2 + C_2] / 240,    Y(h) = exp(Omega) Y(0)                   (3)
//! ```
//!
//! Source: Blanes, Casas, Oteo and Ros (2009), The Magnus expansion and some of its applications, Physics Reports 470,
//! section 5. A constant `A` is integrated exactly.

use nalgebra::allocator::Allocator;
use nalgebra::{DMatrix, DefaultAllocator, Dim, OMatrix};

/// Nodes of the three-point Gauss-Legendre rule on `[0, 1]`.
pub(super) const NODES: [f64; 3] = [0.112_701_665_379_258_31, 0.5, 0.887_298_334_620_741_7];

/// `exp(Omega)` of (3) for the matrices at the three nodes, each already multiplied by the step.
pub(super) fn step<D: Dim>(scaled: &[OMatrix<f64, D, D>; 3]) -> OMatrix<f64, D, D>
where
    DefaultAllocator: Allocator<D, D>,
{
    let [first, a1, third] = scaled;
    let a2 = (third - first) * (15.0_f64.sqrt() / 3.0);
    let a3 = (third - a1 * 2.0 + first) * (10.0 / 3.0);
    let c1 = commutator(a1, &a2);
    let c2 = commutator(a1, &(&a3 * 2.0 + &c1)) * (-1.0 / 60.0);
    let inner = commutator(&(&c1 - a1 * 20.0 - &a3), &(a2 + c2));
    exponential(&(a1 + a3 * (1.0 / 12.0) + inner * (1.0 / 240.0)))
}

fn commutator<D: Dim>(a: &OMatrix<f64, D, D>, b: &OMatrix<f64, D, D>) -> OMatrix<f64, D, D>
where
    DefaultAllocator: Allocator<D, D>,
{
    a * b - b * a
}

/// Matrix exponential: in closed form for order two, otherwise nalgebra's (Higham's scaling and squaring).
pub(super) fn exponential<D: Dim>(a: &OMatrix<f64, D, D>) -> OMatrix<f64, D, D>
where
    DefaultAllocator: Allocator<D, D>,
{
    let mut result = a.clone();
    if a.nrows() == 2 {
        let entries = exponential_of_two([a[(0, 0)], a[(0, 1)], a[(1, 0)], a[(1, 1)]]);
        for (index, value) in entries.into_iter().enumerate() {
            result[(index / 2, index % 2)] = value;
        }
    } else {
        let dense = dense_exponential(&DMatrix::from_fn(a.nrows(), a.ncols(), |i, j| a[(i, j)]));
        for j in 0..a.ncols() {
            for i in 0..a.nrows() {
                result[(i, j)] = dense[(i, j)];
            }
        }
    }
    result
}

/// The library squares as often as the logarithm of the norm says, without end if the norm overflows; a step as large as
/// this bound would have no accuracy left anyway.
const LARGEST_NORM: f64 = 1e8;

/// The library's exponential, where it can be trusted to end.
fn dense_exponential(a: &DMatrix<f64>) -> DMatrix<f64> {
    if a.iter().all(|x| x.abs() < LARGEST_NORM) {
        a.exp()
    } else {
        a.map(|_| f64::NAN)
    }
}

/// For `A = m I + B` with `B` traceless, `B^2 = d I`, so `exp A = e^m (cosh sqrt d I + sinh sqrt d / sqrt d B)`.
fn exponential_of_two([a, b, c, d]: [f64; 4]) -> [f64; 4] {
    let mean = 0.5 * (a + d);
    let half = 0.5 * (a - d);
    let square = half * half + b * c;
    let (cosine, sine_over) = if square.abs() < 1e-6 {
        (
            1.0 + square * (0.5 + square / 24.0),
            1.0 + square * (1.0 / 6.0 + square / 120.0),
        )
    } else if square > 0.0 {
        let root = square.sqrt();
        (root.cosh(), root.sinh() / root)
    } else {
        let root = (-square).sqrt();
        (root.cos(), root.sin() / root)
    };
    let factor = mean.exp();
    let (cosine, sine_over) = (factor * cosine, factor * sine_over);
    [
        cosine + sine_over * half,
        sine_over * b,
        sine_over * c,
        cosine - sine_over * half,
    ]
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::{Matrix2, Matrix3};

    #[test]
    fn closed_form_of_order_two_agrees_with_the_series() {
        for a in [
            Matrix2::new(0.0, 1.0, -1.0, 0.0),
            Matrix2::new(0.1, 1.0, 2.0, -0.3),
            Matrix2::new(0.1, 1e-5, 2e-5, 0.1),
            Matrix2::new(-0.2, 0.0, 3.0, -0.2),
            Matrix2::zeros(),
        ] {
            let expected = a.exp();
            assert!(
                (exponential(&a) - expected).amax() < 1e-14 * (1.0 + expected.amax()),
                "{a}"
            );
        }
    }

    #[test]
    fn larger_orders_go_to_the_library() {
        let a = Matrix3::new(0.0, 1.0, 0.0, -1.0, 0.0, 0.0, 0.0, 0.0, 2.0);
        let result = exponential(&a);
        assert!((result[(0, 0)] - 1.0_f64.cos()).abs() < 1e-14);
        assert!((result[(2, 2)] - 2.0_f64.exp()).abs() < 1e-13);
    }

    /// Airy's equation `y'' = s y`: the error falls with the sixth power of the step.
    #[test]
    fn order_is_six() {
        let matrix = |s: f64| Matrix2::new(0.0, 1.0, s, 0.0);
        let integrate = |steps: usize| {
            let h = 2.0 / steps as f64;
            let mut y = Matrix2::identity();
            for k in 0..steps {
                let scaled = NODES.map(|node| matrix((k as f64 + node) * h) * h);
                y = step(&scaled) * y;
            }
            y
        };
        // From the series solutions of Airy's equation, summed in exact arithmetic: y1(2) and y2(2).
        let y1: f64 = (1..40)
            .fold((1.0, 1.0), |(sum, term), k| {
                let k3 = 3.0 * f64::from(k);
                let term = term * 8.0 / (k3 * (k3 - 1.0));
                (sum + term, term)
            })
            .0;
        let error = |steps| (integrate(steps)[(0, 0)] - y1).abs();
        let order = (error(4) / error(8)).log2();
        assert!((5.5..6.8).contains(&order), "{order}");
        assert!(error(64) < 1e-11 * y1);
    }
}
