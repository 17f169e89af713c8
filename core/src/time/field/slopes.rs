//! Derivatives of the accelerations at several instants, by the state and by variables.

use super::Field;
use super::batch::{Batch, Samples, add_product, add_times, add_times_wave, add_wave};
use crate::law::{Derivatives, On};
use crate::system::Variable;

/// The derivatives (3) at the instants of a batch, row by row of the matrices, and those by variables, one after the other.
#[derive(Debug)]
pub(crate) struct Slopes<const S: usize> {
    pub(crate) by_q: Vec<[f64; S]>,
    pub(crate) by_v: Vec<[f64; S]>,
    pub(crate) by_variable: Vec<[f64; S]>,
    /// Before multiplication with `M^-1`.
    rows: Vec<[f64; S]>,
    pub(crate) coefficients: Vec<f64>,
}

impl<const S: usize> Slopes<S> {
    pub(crate) fn new(field: &Field) -> Self {
        let n = field.coordinates();
        Self {
            by_q: vec![[0.0; S]; n * n],
            by_v: vec![[0.0; S]; n * n],
            by_variable: Vec::new(),
            rows: vec![[0.0; S]; n],
            coefficients: vec![0.0; field.coefficients.len()],
        }
    }
}

impl Field {
    /// Writes the derivatives (3) at a batch whose accelerations are known, and by variables at fixed phase and state.
    pub(crate) fn linearise<const S: usize>(
        &self,
        batch: &mut Batch<S>,
        pieces: &[usize],
        by: &[Variable],
        out: &mut Slopes<S>,
    ) {
        let n = self.coordinates();
        for row in out.by_q.iter_mut().chain(&mut out.by_v) {
            *row = [0.0; S];
        }
        // Forces first, one row for each pair of an equation and a coordinate; then M^-1, column by column.
        for item in &self.stiffness {
            let factor = -self.coefficients[item.coefficient];
            let to = &mut out.by_q[item.row * n + item.column];
            add_wave(to, factor, &batch.waves, item.wave);
        }
        for item in &self.damping {
            let factor = -self.coefficients[item.coefficient];
            add_wave(&mut out.by_v[item.row * n + item.column], factor, &[], None);
        }
        for index in 0..self.contacts.len() {
            self.add_contact_slopes(batch, index, pieces[index], out);
        }
        self.divide_columns_by_mass(out);
        out.by_variable.resize(by.len() * n, [0.0; S]);
        for (index, &variable) in by.iter().enumerate() {
            self.by_variable(batch, pieces, variable, index, out);
        }
    }

    /// Adds the derivatives of the force of a contact on a piece, before they are divided by the mass.
    fn add_contact_slopes<const S: usize>(
        &self,
        batch: &mut Batch<S>,
        index: usize,
        piece: usize,
        out: &mut Slopes<S>,
    ) {
        let n = self.coordinates();
        self.slopes_of_law(&mut batch.contacts[index], index, piece, None);
        let contact = &self.contacts[index];
        let samples = &batch.contacts[index];
        let waves = &batch.waves;
        for e in &contact.force {
            let factor = -self.coefficients[e.coefficient];
            let (mut stiffness, mut damping) = ([0.0; S], [0.0; S]);
            add_times_wave(&mut stiffness, factor, &samples.by_gap, waves, e.wave);
            add_times_wave(&mut damping, factor, &samples.by_rate, waves, e.wave);
            for d in &contact.gap {
                let value = self.coefficients[d.coefficient];
                let to = e.row * n + d.row;
                add_times_wave(&mut out.by_q[to], value, &stiffness, waves, d.wave);
                add_times_wave(&mut out.by_v[to], value, &damping, waves, d.wave);
                if let Some((wave, part)) = d.wave {
                    let (factor, slope) = self.slope(waves, wave, part);
                    let factor = factor * value * self.base;
                    add_product(&mut out.by_q[to], factor, &damping, slope);
                }
            }
        }
    }

    /// Forces become accelerations, column by column.
    fn divide_columns_by_mass<const S: usize>(&self, out: &mut Slopes<S>) {
        let n = self.coordinates();
        for j in 0..n {
            for matrix in [&mut out.by_q, &mut out.by_v] {
                for i in 0..n {
                    out.rows[i] = matrix[i * n + j];
                }
                for i in 0..n {
                    matrix[i * n + j] = [0.0; S];
                }
                for &(row, column, value) in &self.inverse_mass {
                    add_times(&mut matrix[row * n + j], value, &out.rows[column]);
                }
            }
        }
    }

    /// Derivatives of the force of a contact by gap and rate, and by an argument.
    fn slopes_of_law<const S: usize>(
        &self,
        samples: &mut Samples<S>,
        index: usize,
        piece: usize,
        argument: Option<usize>,
    ) {
        let contact = &self.contacts[index];
        let law = self.system.law(contact.law);
        let out = Derivatives {
            force: &mut samples.force,
            by_gap: &mut samples.by_gap,
            by_rate: &mut samples.by_rate,
        };
        let (on, arguments) = (On::Piece(piece), &contact.arguments);
        match argument {
            None => law.derivatives(on, arguments, &samples.gap, &samples.rate, out),
            Some(argument) => law.derivatives_and_by(
                argument,
                on,
                arguments,
                &samples.gap,
                &samples.rate,
                out,
                &mut samples.by_argument,
            ),
        }
    }

    /// `M^-1 (dr/dp - dM/dp a)`, the derivative of (1) by a variable `p`.
    fn by_variable<const S: usize>(
        &self,
        batch: &mut Batch<S>,
        pieces: &[usize],
        variable: Variable,
        index: usize,
        out: &mut Slopes<S>,
    ) {
        let n = self.coordinates();
        let to = index * n..(index + 1) * n;
        let by = &mut out.coefficients;
        self.coefficients_by(variable, by);
        for row in &mut out.rows {
            *row = [0.0; S];
        }
        let rows = &mut out.rows;
        for item in &self.load {
            let slope = by[item.coefficient];
            add_wave(&mut rows[item.row], slope, &batch.waves, item.wave);
        }
        for item in &self.damping {
            let v = &batch.v[item.column];
            add_times(&mut rows[item.row], -by[item.coefficient], v);
        }
        for item in &self.stiffness {
            let (slope, q) = (-by[item.coefficient], &batch.q[item.column]);
            add_times_wave(&mut rows[item.row], slope, q, &batch.waves, item.wave);
        }
        for entry in &self.layout.mass {
            let a = &batch.a[entry.column];
            add_times(&mut rows[entry.row], -by[entry.coefficient], a);
        }
        for (index, contact) in self.contacts.iter().enumerate() {
            let force = self.force_by(batch, index, pieces[index], variable, by);
            for e in &contact.force {
                let (value, slope) = (self.coefficients[e.coefficient], by[e.coefficient]);
                let (to, waves) = (&mut rows[e.row], &batch.waves);
                add_times_wave(to, -value, &force, waves, e.wave);
                let force = &batch.contacts[index].force;
                add_times_wave(to, -slope, force, waves, e.wave);
            }
        }
        self.divide_by_mass(&out.rows, &mut out.by_variable[to]);
    }

    /// The derivative of the force of a contact by a variable, at fixed phase and state.
    fn force_by<const S: usize>(
        &self,
        batch: &mut Batch<S>,
        index: usize,
        piece: usize,
        variable: Variable,
        by: &[f64],
    ) -> [f64; S] {
        let contact = &self.contacts[index];
        let mut force = [0.0; S];
        for &(argument, coefficient) in &self.layout.contacts[index].arguments {
            if by[coefficient] != 0.0 {
                let samples = &mut batch.contacts[index];
                self.slopes_of_law(samples, index, piece, Some(argument));
                add_times(&mut force, by[coefficient], &samples.by_argument);
            }
        }
        let base_by = self.base_by(variable);
        let (mut gap, mut rate) = ([0.0; S], [0.0; S]);
        for d in &contact.gap {
            let (value, change) = (self.coefficients[d.coefficient], by[d.coefficient]);
            let (q, v) = (&batch.q[d.row], &batch.v[d.row]);
            add_times_wave(&mut gap, change, q, &batch.waves, d.wave);
            add_times_wave(&mut rate, change, v, &batch.waves, d.wave);
            if let Some((wave, part)) = d.wave {
                let (factor, slope) = self.slope(&batch.waves, wave, part);
                let factor = factor * (change * self.base + value * base_by);
                add_product(&mut rate, factor, q, slope);
            }
        }
        for delta in &contact.offset {
            let (value, change) = (self.coefficients[delta.coefficient], by[delta.coefficient]);
            add_wave(&mut gap, -change, &batch.waves, delta.wave);
            if let Some((wave, part)) = delta.wave {
                let (factor, slope) = self.slope(&batch.waves, wave, part);
                let factor = factor * (change * self.base + value * base_by);
                add_times(&mut rate, -factor, slope);
            }
        }
        let samples = &batch.contacts[index];
        add_product(&mut force, 1.0, &samples.by_gap, &gap);
        add_product(&mut force, 1.0, &samples.by_rate, &rate);
        force
    }
}
