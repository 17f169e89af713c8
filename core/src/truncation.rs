//! What the harmonics and samples that were left out would change.
//!
//! The orbit is put into a balance of twice the harmonics and samples. Harmonics above `K` are there almost free
//! masses, so their part of the residual gives them at once, and the residual that they leave in the first `K` harmonics
//! gives the change of those by one step with the factors at hand:
//!
//! ```text
//! v_k = M^-1 R_k(u, 0) / (k Omega)^2,  k > K;        du = -B^-1 [ R_1..K(u, v) ; 0 ]                          (1)
//! ```
//!
//! Source: the tail as a diagonal follows Grolet and Thouverez (2012), On a new harmonic selection technique for harmonic
//! balance method, where the residual of omitted harmonics steers their number; (1) turns it into a corrected orbit.

use nalgebra::{DMatrix, DVector};

use crate::balance::{Balance, Parity, Resolution};
use crate::continuation::problem::Problem;
use crate::fourier::series;
use crate::newton::Newton;
use crate::system::{System, Variable};

/// The change by the harmonics from `K` to `2 K` times this is that by all above `K`, where it falls as `K^-1.6` or faster.
pub(crate) const BEYOND: f64 = 1.5;
/// Relative error of an event that rounding and the last updates leave.
const ROUNDING: f64 = 1e-12;

/// A finer balance of the same system, and room for its vectors.
#[derive(Debug)]
pub(crate) struct Finer<'a> {
    balance: Balance<'a>,
    coarse: Resolution,
    /// The orbit with its tail, extended.
    orbit: Vec<f64>,
    residual: Vec<f64>,
    /// Residual in the harmonics of the coarse balance, extended by a zero.
    core: Vec<f64>,
}

impl<'a> Finer<'a> {
    pub(crate) fn new(
        system: &'a dyn System,
        parameters: &[f64],
        omega: f64,
        variable: Variable,
        coarse: Resolution,
    ) -> Self {
        let fine = Resolution {
            // An orbit of one odd harmonic has its next one at three.
            harmonics: 2 * coarse.harmonics + usize::from(coarse.parity == Parity::Odd),
            core: 0,
            samples: 2 * coarse.samples,
            ..coarse
        };
        let balance = Balance::new(system, parameters, omega, variable, fine);
        let unknowns = balance.unknowns();
        let coordinates = balance.layout().coordinates;
        Self {
            balance,
            coarse,
            orbit: vec![0.0; unknowns + 1],
            residual: vec![0.0; unknowns],
            core: vec![0.0; coordinates * series::length(coarse.harmonics) + 1],
        }
    }

    /// The finer balance, set to the parameter of the last orbit.
    pub(crate) fn balance(&self) -> &Balance<'a> {
        &self.balance
    }

    /// The series of the last corrected orbit, coordinate by coordinate.
    pub(crate) fn series(&self) -> &[f64] {
        &self.orbit[..self.residual.len()]
    }

    /// The same, extended by the parameter.
    pub(crate) fn extended(&self) -> &[f64] {
        &self.orbit
    }

    /// Adds the tail to an orbit of the coarse balance. Returns the residual that is left in the coarse harmonics,
    /// extended by a zero; `None` if the mass matrix is singular or the residual is not finite.
    pub(crate) fn add_tail(&mut self, u: &[f64], newton: &mut Newton) -> Option<&mut [f64]> {
        let (fine, coarse) = (self.balance.length(), series::length(self.coarse.harmonics));
        let coordinates = self.balance.layout().coordinates;
        self.orbit.fill(0.0);
        for i in 0..coordinates {
            self.orbit[i * fine..][..coarse].copy_from_slice(&u[i * coarse..][..coarse]);
        }
        let last = self.orbit.len() - 1;
        self.orbit[last] = u[u.len() - 1];
        self.balance.evaluate(&self.orbit, &mut self.residual, None);
        self.solve_tail(coarse, fine)?;
        self.balance.evaluate(&self.orbit, &mut self.residual, None);
        newton.statistics.residuals += 2;
        for i in 0..coordinates {
            self.core[i * coarse..][..coarse].copy_from_slice(&self.residual[i * fine..][..coarse]);
        }
        let end = self.core.len() - 1;
        self.core[end] = 0.0;
        self.core
            .iter()
            .all(|x| x.is_finite())
            .then_some(&mut self.core)
    }

    fn solve_tail(&mut self, coarse: usize, fine: usize) -> Option<()> {
        let coordinates = self.balance.layout().coordinates;
        let mut mass: DMatrix<f64> = DMatrix::zeros(coordinates, coordinates);
        for entry in &self.balance.layout().mass {
            mass[(entry.row, entry.column)] += self.balance.coefficients()[entry.coefficient];
        }
        let inverse = mass.try_inverse()?;
        let base = self.balance.base();
        for index in coarse..fine {
            let frequency = base * index.div_ceil(2) as f64;
            let residual = DVector::from_fn(coordinates, |i, _| self.residual[i * fine + index]);
            let tail: DVector<f64> = &inverse * residual / (frequency * frequency);
            for i in 0..coordinates {
                self.orbit[i * fine + index] = tail[i];
            }
        }
        Some(())
    }

    /// Adds the tail and the change of the coarse harmonics, (1); false if that fails.
    pub(crate) fn correct(&mut self, u: &[f64], newton: &mut Newton) -> bool {
        let (fine, coarse) = (self.balance.length(), series::length(self.coarse.harmonics));
        let coordinates = self.balance.layout().coordinates;
        if self.add_tail(u, newton).is_none() {
            return false;
        }
        newton.solve(&mut self.core);
        for i in 0..coordinates {
            for index in 0..coarse {
                self.orbit[i * fine + index] -= self.core[i * coarse + index];
            }
        }
        let last = self.orbit.len() - 1;
        self.orbit[last] -= self.core[self.core.len() - 1];
        self.balance.set(self.orbit[last]);
        self.orbit.iter().all(|x| x.is_finite())
    }

    /// Estimated error of the parameter at a fold, whose factors Newton's method holds.
    pub(crate) fn fold_error(&mut self, u: &[f64], newton: &mut Newton) -> f64 {
        let mut psi = vec![0.0; u.len()];
        newton.left_null_vector(&mut psi);
        let n = u.len() - 1;
        let value = u[n].abs();
        self.add_tail(u, newton).map_or(f64::INFINITY, |core| {
            let change = crate::linear::dot(&psi[..n], &core[..n]).abs();
            BEYOND * change + ROUNDING * value
        })
    }
}
