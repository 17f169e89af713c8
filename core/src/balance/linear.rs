//! The terms of the balance that are linear in the coordinates, and the load.

use super::Balance;
use super::terms::{add_derivative, add_inertia, block, block_mut, stretched};
use crate::numeric::fourier::series;

impl Balance<'_> {
    /// Adds `Omega^2 M D^2 u + Omega C D u + K u - f` for given coefficients.
    pub(super) fn add_linear(&self, coefficients: &[f64], u: &[f64], residual: &mut [f64]) {
        self.add_motion(coefficients, u, residual);
        self.add_load(coefficients, -1.0, residual);
    }

    /// Adds `Omega^2 M D^2 u + Omega C D u + K u`.
    pub(super) fn add_motion(&self, coefficients: &[f64], u: &[f64], to: &mut [f64]) {
        let base = self.base();
        self.add_inertia(coefficients, base * base, u, to);
        self.add_damping(coefficients, base, u, to);
        self.add_stiffness(coefficients, u, to);
    }

    /// Adds `factor M D^2 u`.
    fn add_inertia(&self, coefficients: &[f64], factor: f64, u: &[f64], to: &mut [f64]) {
        let length = self.length();
        for entry in &self.layout.mass {
            let factor = factor * coefficients[entry.coefficient];
            add_inertia(
                block(u, entry.column, length),
                factor,
                block_mut(to, entry.row, length),
            );
        }
    }

    /// Adds `factor C D u`.
    pub(crate) fn add_damping(&self, coefficients: &[f64], factor: f64, u: &[f64], to: &mut [f64]) {
        let length = self.length();
        for entry in &self.layout.damping {
            let factor = factor * coefficients[entry.coefficient];
            add_derivative(
                block(u, entry.column, length),
                factor,
                block_mut(to, entry.row, length),
            );
        }
    }

    /// Adds `K(tau) u`.
    pub(crate) fn add_stiffness(&self, coefficients: &[f64], u: &[f64], to: &mut [f64]) {
        let length = self.length();
        for entry in &self.layout.stiffness {
            let wave = stretched(entry.wave, self.resolution.period);
            let to = block_mut(to, entry.row, length);
            series::add_product(
                block(u, entry.column, length),
                wave,
                coefficients[entry.coefficient],
                to,
            );
        }
    }

    /// Adds the load times `factor`.
    pub(crate) fn add_load(&self, coefficients: &[f64], factor: f64, to: &mut [f64]) {
        let length = self.length();
        for entry in &self.layout.load {
            let harmonic = entry.wave.harmonic as usize * self.resolution.period;
            let drive = if harmonic == 0 {
                1.0
            } else {
                self.drive_factor
            };
            let value = factor * drive * coefficients[entry.coefficient];
            series::add_wave(
                block_mut(to, entry.row, length),
                harmonic,
                entry.wave.part,
                value,
            );
        }
    }

    /// The derivative of the linear terms with respect to the variable.
    pub(super) fn linear_by_variable(&mut self, u: &[f64], column: &mut [f64]) {
        let (base, base_by) = (self.base(), self.base_by());
        column.fill(0.0);
        self.system.coefficients_by(
            self.variable,
            &self.parameters,
            self.omega,
            &mut self.coefficients_by,
        );
        self.add_linear(&self.coefficients_by, u, column);
        if base_by != 0.0 {
            self.add_inertia(&self.coefficients, 2.0 * base * base_by, u, column);
            self.add_damping(&self.coefficients, base_by, u, column);
        }
    }
}
