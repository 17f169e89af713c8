//! Residual and Jacobian, put together: the balance as a problem of continuation.

use super::alike::Alike;
use super::terms::stretched;
use super::{Balance, blocks};
use crate::continuation::jacobian::{Jacobian, Partition};
use crate::continuation::problem::Problem;

impl Balance<'_> {
    /// Clears the blocks and puts the linear stiffness and damping into them.
    fn start_blocks(&mut self) {
        let base = self.base();
        for block in &mut self.blocks {
            block.clear();
        }
        for entry in &self.layout.stiffness {
            if let Some(block) = blocks::find(&mut self.blocks, entry.row, entry.column) {
                let wave = stretched(entry.wave, self.resolution.period);
                block.add_stiffness(wave, self.coefficients[entry.coefficient]);
            }
        }
        for entry in &self.layout.damping {
            if let Some(block) = blocks::find(&mut self.blocks, entry.row, entry.column) {
                block.add_damping(base * self.coefficients[entry.coefficient]);
            }
        }
    }

    /// The smallest core for which what it leaves out is at most `coupling` of what the tail has on its diagonal, by the
    /// stiffness evaluated last: `S / (M (K Omega)^2) <= coupling`.
    pub(crate) fn core_size(&self, coupling: f64) -> usize {
        let base = self.base();
        let mass = |row: usize| {
            let entries = self.layout.mass.iter().filter(|entry| entry.row == row);
            entries
                .map(|entry| self.coefficients[entry.coefficient].abs())
                .fold(0.0, f64::max)
        };
        let strongest = self
            .blocks
            .iter()
            .map(|block| {
                let (row, stiffness) = block.coupling();
                stiffness / (mass(row) * base * base)
            })
            .filter(|ratio| ratio.is_finite())
            .fold(0.0, f64::max);
        (strongest / coupling).sqrt().ceil().min(1e6) as usize
    }

    fn assemble(&self, jacobian: &mut Jacobian) {
        for block in &self.blocks {
            block.add_to(&self.harmonics, jacobian);
        }
        self.add_masses(jacobian);
        self.add_gauge_to(jacobian);
        jacobian.set_column(&self.scratch.column);
    }

    /// Adds what holds the mean along rigid motions: see [`rigid`](crate::model::rigid).
    fn add_gauge_to(&self, jacobian: &mut Jacobian) {
        let (n, length) = (
            self.layout.coordinates,
            blocks::places(&self.harmonics.core),
        );
        if self.harmonics.core.first() != Some(&0) {
            return;
        }
        for (i, gauge) in self.gauge.chunks_exact(n).enumerate() {
            let row = jacobian.core_mut().row_mut(i * length);
            for (j, value) in gauge.iter().enumerate() {
                row[j * length] += value;
            }
        }
    }

    /// The same in a residual.
    fn add_gauge(&self, u: &[f64], residual: &mut [f64]) {
        let (n, length) = (self.layout.coordinates, self.length());
        for (i, gauge) in self.gauge.chunks_exact(n).enumerate() {
            let means = u.chunks_exact(length).map(|series| series[0]);
            residual[i * length] += gauge.iter().zip(means).map(|(g, x)| g * x).sum::<f64>();
        }
    }

    /// Adds `Omega^2 M D^2`.
    fn add_masses(&self, jacobian: &mut Jacobian) {
        let base = self.base();
        let core = &self.harmonics.core;
        let length = blocks::places(core);
        for entry in &self.layout.mass {
            let inertia = base * base * self.coefficients[entry.coefficient];
            let mut place = 0;
            for &k in core {
                let value = inertia * (k * k) as f64;
                for _ in 0..if k == 0 { 1 } else { 2 } {
                    let row = jacobian.core_mut().row_mut(entry.row * length + place);
                    row[entry.column * length + place] -= value;
                    place += 1;
                }
            }
            for (group, &k) in self.harmonics.tail.iter().enumerate() {
                let value = inertia * (k * k) as f64;
                for part in 0..2 {
                    let row = jacobian.group_mut(group).row_mut(2 * entry.row + part);
                    row[2 * entry.column + part] -= value;
                }
            }
        }
    }
}

impl Problem for Balance<'_> {
    fn unknowns(&self) -> usize {
        self.layout.coordinates * self.length()
    }

    fn partition(&self) -> Partition {
        Balance::partition(self)
    }

    fn is_cancelled(&self) -> bool {
        self.cancel.is_cancelled()
    }

    fn evaluate(&mut self, u: &[f64], residual: &mut [f64], jacobian: Option<&mut Jacobian>) {
        let unknowns = self.unknowns();
        self.set(u[unknowns]);
        let u = &u[..unknowns];
        residual.fill(0.0);
        self.add_linear(&self.coefficients, u, residual);
        self.add_gauge(u, residual);
        let Some(jacobian) = jacobian else {
            let mut force = std::mem::take(&mut self.scratch.force);
            for index in 0..self.alike.len() {
                let Alike { contact, count } = self.alike[index];
                self.contact_force(u, contact, &mut force);
                self.add_in_direction(contact, count, &force, residual);
            }
            self.scratch.force = force;
            self.keep_unknowns(residual);
            return;
        };
        let mut column = std::mem::take(&mut self.scratch.column);
        self.linear_by_variable(u, &mut column);
        self.scratch.column = column;
        self.start_blocks();
        for index in 0..self.alike.len() {
            let alike = self.alike[index];
            let changes = self.contact_derivatives(u, alike.contact);
            self.scatter(alike, changes, residual);
        }
        self.keep_unknowns(residual);
        self.keep_couplings();
        self.assemble(jacobian);
    }

    fn apply(&mut self, u: &[f64], direction: &[f64], derivative: &mut [f64]) {
        let unknowns = self.unknowns();
        self.set(u[unknowns]);
        let u = &u[..unknowns];
        let mut column = std::mem::take(&mut self.scratch.column);
        self.linear_by_variable(u, &mut column);
        derivative.fill(0.0);
        self.add_motion(&self.coefficients, &direction[..unknowns], derivative);
        self.add_gauge(&direction[..unknowns], derivative);
        for (to, by) in derivative.iter_mut().zip(&column) {
            *to += direction[unknowns] * by;
        }
        self.scratch.column = column;
        for index in 0..self.alike.len() {
            self.add_contact_in(u, direction, self.alike[index], derivative);
        }
        self.keep_unknowns(derivative);
    }

    fn terms(&mut self, u: &[f64], terms: &mut [f64]) -> bool {
        self.set(u[self.unknowns()]);
        self.sizes_of_terms(&u[..self.unknowns()], terms);
        true
    }

    fn is_mean(&self, unknown: usize) -> bool {
        unknown.is_multiple_of(self.length())
    }

    fn operations(&self) -> u64 {
        self.aft.operations()
    }

    /// The mean square of the orbit over time and coordinates, by Parseval's identity.
    fn weights(&self, weights: &mut [f64]) {
        let length = self.length();
        let coordinates = self.layout.coordinates as f64;
        for (index, weight) in weights.iter_mut().enumerate() {
            let mean = index % length == 0;
            *weight = if mean { 1.0 } else { 0.5 } / coordinates;
        }
    }
}
