//! Koopman-Hill projection: the monodromy matrix from an exponential of the Hill matrix, without sorting.
//!
//! With the waves `z_k = e^(i k tau) x` of a solution `x` as unknowns, `x' = A(tau) x` is linear with constant coefficients,
//! and its matrix is the Hill matrix `H` of [`hill_matrix`](super::hill_matrix). All waves are known at the start, and the
//! solution is read off at the end,
//!
//! ```text
//! Phi = C e^(2 pi H) W                                                                                       (1)
//! ```
//!
//! where in the basis `[mean, cos 1, sin 1, ...]` `W = [1, 2, 0, 2, 0, ...]` times unit matrices, and `C = [1, 0, 0, ...]`: the
//! direct projection. With waves of half the frequency as well, the sum of all is `x` after a period,
//!
//! ```text
//! Phi = C_1 e^(2 pi H) W + C_2 e^(2 pi H_2) W_2                                                              (2)
//! ```
//!
//! where `H_2` has the harmonics `1/2, 3/2, ...`, `W_2 = [2, 0, 2, 0, ...]`, and `C_1`, `C_2` are one for means and cosines: the
//! subharmonic projection. It takes two exponentials and errs as the square of the direct one.
//!
//! If the complex coefficients of `A` fall as `|A_k| <= a e^(-b k)` with `b > ln 2`, then
//!
//! ```text
//! |error of Phi| <= (2 e^(-b))^H e^(8 pi a)                                                                  (3)
//! ```
//!
//! by (1), and with `2 H` by (2). At a contact that opens, coefficients fall as a power of `k` only: there (3) does not hold, and
//! no bound is given. The estimate is then what it is for [`hill`](super::hill): the determinant, and more harmonics.
//!
//! Cost: one or two exponentials of dense matrices of order `2 n (2 K + 1)`. Their action on the few columns of `W` (Al-Mohy and
//! Higham 2011) was counted and not built: it takes about `5.5 |2 pi H|` products with a vector for each column, and
//! `|H| ~ K`, in all `1.3` times the operations of scaling and squaring whatever `K` and `n`.
//!
//! Sources: Bayer and Leine (2023), Sorting-free Hill-based stability analysis of periodic solutions through Koopman analysis,
//! Nonlinear Dyn. 111, 8439; Bayer, Leine, Thomas and Grolet (2024), Koopman-Hill stability computation of periodic orbits in
//! polynomial dynamical systems using a real-valued quadratic harmonic balance formulation, Int. J. Non-Linear Mech. 167,
//! 104894 (real basis); Bayer and Leine (2025), Explicit error bounds and guaranteed convergence of the Koopman-Hill projection
//! stability method for linear time-periodic dynamics, arXiv 2503.21318 (equations (2) and (3)).

use std::f64::consts::{LN_2, PI, TAU};

use nalgebra::DMatrix;

use super::hill::defect;
use super::hill_matrix::{Coefficients, Lattice, place};
use super::method::{Cost, Floquet, Found, Projection};
use super::orbit::Orbit;
use super::path::Path;
use crate::numeric::exponential::Exponential;
use crate::numeric::spectrum::eigenvalues;

/// Projects orbits, one after the other.
#[derive(Debug)]
pub(super) struct KoopmanHill {
    projection: Projection,
    path: Path,
    cost: Cost,
}

impl KoopmanHill {
    pub(super) fn new(projection: Projection) -> Self {
        Self {
            projection,
            path: Path::default(),
            cost: Cost::default(),
        }
    }

    /// The monodromy matrix of (1) or (2).
    fn monodromy(&mut self, coefficients: &Coefficients) -> DMatrix<f64> {
        match self.projection {
            Projection::Direct => self.projected(coefficients, Lattice::Whole, 1),
            Projection::Subharmonic => {
                let count = |lattice: Lattice| lattice.cosines(coefficients.harmonics());
                let whole = self.projected(coefficients, Lattice::Whole, count(Lattice::Whole));
                let half = self.projected(coefficients, Lattice::Half, count(Lattice::Half));
                whole + half
            }
        }
    }

    /// `C e^(2 pi H) W` where `C` adds up the first few means and cosines.
    fn projected(
        &mut self,
        coefficients: &Coefficients,
        lattice: Lattice,
        cosines: usize,
    ) -> DMatrix<f64> {
        let order = 2 * coefficients.coordinates();
        let length = lattice.length(coefficients.harmonics());
        let mut matrix = coefficients.matrix(lattice);
        matrix *= TAU;
        let mut exponential = DMatrix::zeros(matrix.nrows(), matrix.nrows());
        Exponential::new(matrix.nrows()).of(&matrix, &mut exponential);
        self.cost.exponentials += 1;
        self.cost.order = self.cost.order.max(matrix.nrows());
        let count = lattice.cosines(coefficients.harmonics());
        DMatrix::from_fn(order, order, |i, j| {
            let rows = (0..cosines).map(|row| i * length + place(lattice, row));
            rows.map(|row| {
                let columns = (0..count).map(|column| {
                    let mean = lattice == Lattice::Whole && column == 0;
                    let weight = if mean { 1.0 } else { 2.0 };
                    weight * exponential[(row, j * length + place(lattice, column))]
                });
                columns.sum::<f64>()
            })
            .sum()
        })
    }

    /// (3), for matrices whose halves are scaled such that displacements and velocities are alike; `None` where its assumption
    /// fails or it says nothing.
    fn bound(&mut self, orbit: &Orbit<'_>, coefficients: &Coefficients) -> Option<f64> {
        self.path.load(orbit);
        if !self.path.cuts.is_empty() {
            return None;
        }
        let harmonics = coefficients.harmonics() as f64
            * match self.projection {
                Projection::Direct => 1.0,
                Projection::Subharmonic => 2.0,
            };
        let unit = coefficients.sizes(1.0)[0].sqrt().max(1.0);
        let sizes = coefficients.sizes(unit);
        let logarithm = |b: f64| {
            let scaled = sizes.iter().enumerate();
            let a = scaled
                .map(|(k, size)| size * (b * k as f64).exp())
                .fold(0.0, f64::max);
            harmonics * (LN_2 - b) + 8.0 * PI * a
        };
        // Steeper decay has a larger factor: the least of the bounds.
        let least = (1..400)
            .map(|step| logarithm(LN_2 + 0.02 * f64::from(step)))
            .fold(f64::INFINITY, f64::min);
        (least < 0.0).then(|| least.exp())
    }
}

impl Floquet for KoopmanHill {
    fn multipliers(&mut self, orbit: &Orbit<'_>, _aim: f64) -> Found {
        let Some(coefficients) = Coefficients::of(orbit) else {
            return Found::NOTHING;
        };
        self.cost.contacts += coefficients.contacts;
        self.cost.spectra += 1;
        let matrix = self.monodromy(&coefficients);
        let matrix = orbit
            .rigid
            .map_or_else(|| matrix.clone(), |rigid| rigid.taken_out_of(&matrix));
        let multipliers = eigenvalues(&matrix);
        Found {
            error: defect(&multipliers, coefficients.determinant()),
            multipliers,
            bound: self.bound(orbit, &coefficients),
            matrix: matrix.as_slice().to_vec(),
        }
    }

    fn knows_its_error(&self) -> bool {
        false
    }

    fn cost(&self) -> Cost {
        self.cost
    }
}
