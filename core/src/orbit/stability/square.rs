//! Matrices of order two, for systems of one coordinate: closed forms in place of those of
//! [`magnus`](super::magnus) and [`exponential`](crate::numeric::exponential).
//!
//! Every matrix is `m I + B` with `B = [h, b; c, -h]` traceless. `B^2 = d I` with `d = h^2 + b c`, so
//!
//! ```text
//! exp A = e^m ( cosh sqrt d I + sinh sqrt d / sqrt d B )                                                     (1)
//! ```
//!
//! and a commutator is a vector product,
//!
//! ```text
//! [B_1, B_2] = [ b_1 c_2 - b_2 c_1    2 (h_1 b_2 - h_2 b_1) ]
//!              [ 2 (c_1 h_2 - c_2 h_1)         -"-          ]                                                 (2)
//! ```
//!
//! Source: Hall (2015), Lie Groups, Lie Algebras, and Representations, section 2.1 and exercise 2.5 (for (1)).

/// A matrix, column by column.
pub(super) type Square = [f64; 4];

pub(super) const IDENTITY: Square = [1.0, 0.0, 0.0, 1.0];

/// `[h, b, c]`
#[derive(Debug, Clone, Copy, Default)]
struct Traceless([f64; 3]);

impl Traceless {
    fn of([a, c, b, d]: Square) -> (f64, Self) {
        (0.5 * (a + d), Self([0.5 * (a - d), b, c]))
    }

    fn square(self) -> Square {
        let [h, b, c] = self.0;
        [h, c, b, -h]
    }

    /// (2)
    fn commutator(self, other: Self) -> Self {
        let ([h1, b1, c1], [h2, b2, c2]) = (self.0, other.0);
        Self([
            b1 * c2 - b2 * c1,
            2.0 * (h1 * b2 - h2 * b1),
            2.0 * (c1 * h2 - c2 * h1),
        ])
    }

    /// The sum of multiples.
    fn sum<const N: usize>(terms: [(f64, Self); N]) -> Self {
        let mut sum = [0.0; 3];
        for (factor, Self(term)) in terms {
            for (to, from) in sum.iter_mut().zip(term) {
                *to += factor * from;
            }
        }
        Self(sum)
    }

    fn size(self) -> f64 {
        let [h, b, c] = self.0.map(f64::abs);
        h.max(b).max(c)
    }
}

/// One step, by (1) to (3) of [`magnus`](super::magnus).
#[derive(Debug, Clone, Copy)]
pub(super) struct Step {
    /// `exp Omega`
    pub(super) propagator: Square,
    /// What the fourth order lacks.
    pub(super) lack: Square,
    /// Sizes of the first commutator and of the lack.
    pub(super) sizes: [f64; 2],
    /// Trace of `Omega`.
    pub(super) trace: f64,
}

/// A step with the matrices at the three nodes, each times the step.
pub(super) fn step(scaled: &[Square; 3]) -> Step {
    let [(m1, first), (m2, a1), (m3, third)] = scaled.map(Traceless::of);
    let a2 = Traceless::sum([
        (15.0_f64.sqrt() / 3.0, third),
        (-(15.0_f64.sqrt()) / 3.0, first),
    ]);
    let a3 = Traceless::sum([(10.0 / 3.0, third), (-20.0 / 3.0, a1), (10.0 / 3.0, first)]);
    let c1 = a1.commutator(a2);
    let c2 = a1.commutator(Traceless::sum([(-2.0 / 60.0, a3), (-1.0 / 60.0, c1)]));
    let left = Traceless::sum([(-1.0 / 240.0, a3), (1.0 / 240.0, c1)]);
    let right = Traceless::sum([(1.0, a2), (1.0, c2)]);
    let lack = Traceless::sum([
        (-20.0 / 240.0, a1.commutator(c2)),
        (1.0, left.commutator(right)),
    ]);
    let omega = Traceless::sum([(1.0, a1), (1.0 / 12.0, a3), (-1.0 / 12.0, c1), (1.0, lack)]);
    let mean = m2 + 10.0 / 36.0 * (m3 - 2.0 * m2 + m1);
    Step {
        propagator: exponential_of(mean, omega),
        lack: lack.square(),
        sizes: [c1.size() / 12.0, lack.size()],
        trace: 2.0 * mean,
    }
}

/// `exp A`
pub(super) fn exponential(a: Square) -> Square {
    let (mean, traceless) = Traceless::of(a);
    exponential_of(mean, traceless)
}

/// (1)
fn exponential_of(mean: f64, traceless: Traceless) -> Square {
    let Traceless([half, b, c]) = traceless;
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
        let (sine, cosine) = root.sin_cos();
        (cosine, sine / root)
    };
    let factor = if mean == 0.0 { 1.0 } else { mean.exp() };
    let (cosine, sine_over) = (factor * cosine, factor * sine_over);
    [
        cosine + sine_over * half,
        sine_over * c,
        sine_over * b,
        cosine - sine_over * half,
    ]
}

/// `a b`
pub(super) fn product(a: &Square, b: &Square) -> Square {
    let [a11, a21, a12, a22] = *a;
    let [b11, b21, b12, b22] = *b;
    [
        a11 * b11 + a12 * b21,
        a21 * b11 + a22 * b21,
        a11 * b12 + a12 * b22,
        a21 * b12 + a22 * b22,
    ]
}

#[cfg(test)]
mod tests {
    use super::super::magnus::Magnus;
    use super::*;
    use crate::testing::random::Random;
    use nalgebra::{DMatrix, Matrix2};

    #[test]
    fn exponential_agrees_with_the_library() {
        for a in [
            Matrix2::new(0.0, 1.0, -1.0, 0.0),
            Matrix2::new(0.1, 1.0, 2.0, -0.3),
            Matrix2::new(0.1, 1e-5, 2e-5, 0.1),
            Matrix2::new(-0.2, 0.0, 3.0, -0.2),
            Matrix2::zeros(),
        ] {
            let entries = [a[0], a[1], a[2], a[3]];
            let result = Matrix2::from_column_slice(&exponential(entries));
            let expected = a.exp();
            let error = (result - expected).amax();
            assert!(error < 1e-14 * (1.0 + expected.amax()), "{a}");
        }
    }

    #[test]
    fn steps_agree_with_those_of_any_order() {
        let mut random = Random::seeded(3);
        for size in [0.01, 0.3, 2.0] {
            let scaled: [Square; 3] =
                std::array::from_fn(|_| std::array::from_fn(|_| random.between(-size, size)));
            let mut magnus = Magnus::new(2);
            for (to, from) in magnus.scaled.iter_mut().zip(&scaled) {
                to.copy_from_slice(from);
            }
            let sizes = magnus.step();
            let two = step(&scaled);
            let near = |a: &[f64], b: &DMatrix<f64>| {
                let error = a.iter().zip(b.as_slice()).map(|(x, y)| (x - y).abs());
                assert!(error.fold(0.0, f64::max) < 1e-14 * (1.0 + b.amax()));
            };
            near(&two.propagator, &magnus.propagator);
            near(&two.lack, &magnus.lack);
            assert!((two.trace - magnus.omega.trace()).abs() < 1e-15);
            assert!((two.sizes[0] - sizes[0]).abs() < 1e-14);
            assert!((two.sizes[1] - sizes[1]).abs() < 1e-14);
        }
    }
}
