//! Residual and Jacobian of the harmonic balance.
//!
//! Every coordinate is a series of `K` harmonics of the base frequency `Omega = omega / (divisor period)`. The
//! equations (1) of [`system`](crate::system), projected on the same harmonics, are
//!
//! ```text
//! R = Omega^2 M D^2 u + Omega C D u + K u + sum_c e_c F_c(u) - f                                            (1)
//! ```
//!
//! where `D` differentiates by phase, `(c_k, s_k) -> (k s_k, -k c_k)`, and `F_c` is the series of the force of contact
//! `c` that [`aft`](crate::aft) makes from the series of its gap. Its derivative needs the series of
//! `S = e_c phi_g d_c + Omega e_c phi_r D d_c` and `T = e_c phi_r d_c`: multiplying by a periodic function is a
//! Toeplitz plus a Hankel matrix of its coefficients,
//!
//! ```text
//! 2 <S cos l cos m> = (C_(l-m) + C_(l+m)) / 2,      2 <S cos l sin m> = (S_(l+m) - S_(l-m)) / 2,
//! 2 <S sin l sin m> = (C_(l-m) - C_(l+m)) / 2,      2 <S sin l cos m> = (S_(l+m) + S_(l-m)) / 2              (2)
//! ```
//!
//! with `C` even, `S` odd and `C_0` twice the mean.
//!
//! Source: Cameron and Griffin (1989); Krack and Gross (2019), Harmonic Balance for Nonlinear Vibration Problems,
//! chapter 2 and appendix on Toeplitz and Hankel blocks. Unknowns are ordered coordinate by coordinate, each
//! `[mean, cos 1, sin 1, ..., cos K, sin K]`.

mod blocks;
mod terms;
#[cfg(test)]
mod tests;

use crate::aft::{Aft, Change, ContactDerivatives, ContactInput, Engine};
use crate::continuation::problem::Problem;
use crate::fourier::series;
use crate::layout::Layout;
use crate::linear::Matrix;
use crate::system::{System, Variable};
use blocks::Block;
use terms::{add_derivative, add_inertia, block, block_mut, stretched};
pub(crate) use terms::{gap_series, rate_series};

/// How finely an orbit is represented.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Resolution {
    /// Harmonics of the base frequency.
    pub harmonics: usize,
    /// Samples of one period of the orbit, for methods that sample.
    pub samples: usize,
    /// How contact forces are found.
    pub aft: Aft,
    /// Number of excitation periods in one period of the orbit.
    pub period: usize,
}

/// The harmonic balance of a system, as a function of one variable.
pub struct Balance<'a> {
    system: &'a dyn System,
    layout: Layout,
    resolution: Resolution,
    parameters: Vec<f64>,
    omega: f64,
    variable: Variable,
    drive_factor: f64,
    aft: Engine,
    coefficients: Vec<f64>,
    coefficients_by: Vec<f64>,
    scratch: Scratch,
    blocks: Vec<Block>,
}

/// Series that an evaluation needs, allocated once.
#[derive(Debug)]
struct Scratch {
    arguments: Vec<f64>,
    arguments_by: Vec<f64>,
    gap: Vec<f64>,
    rate: Vec<f64>,
    change_gap: Vec<f64>,
    change_rate: Vec<f64>,
    force: Vec<f64>,
    by_gap: Vec<f64>,
    by_rate: Vec<f64>,
    by_parameter: Vec<f64>,
    product: Vec<f64>,
    column: Vec<f64>,
}

impl Scratch {
    fn new(layout: &Layout, resolution: Resolution) -> Self {
        let Resolution {
            harmonics, period, ..
        } = resolution;
        let highest = |of: fn(&crate::layout::ContactLayout) -> usize| {
            layout.contacts.iter().map(of).max().unwrap_or(0) * period
        };
        let force_wave = highest(crate::layout::ContactLayout::force_harmonic);
        let gap_wave = highest(crate::layout::ContactLayout::gap_harmonic);
        let offset_wave = highest(crate::layout::ContactLayout::offset_harmonic);
        let zeros = |harmonics| vec![0.0; series::length(harmonics)];
        let gap = || zeros((harmonics + gap_wave).max(offset_wave));
        let force = || zeros(harmonics + force_wave);
        let slope = || zeros(2 * harmonics + force_wave + gap_wave);
        let arguments = layout
            .contacts
            .iter()
            .map(|c| c.argument_count)
            .max()
            .unwrap_or(0);
        Self {
            arguments: vec![0.0; arguments],
            arguments_by: vec![0.0; arguments],
            gap: gap(),
            rate: gap(),
            change_gap: gap(),
            change_rate: gap(),
            force: force(),
            by_gap: slope(),
            by_rate: slope(),
            by_parameter: force(),
            product: slope(),
            column: vec![0.0; layout.coordinates * series::length(harmonics)],
        }
    }
}

impl std::fmt::Debug for Balance<'_> {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Balance")
            .field("system", &self.system.facts().name)
            .field("resolution", &self.resolution)
            .field("variable", &self.variable)
            .finish_non_exhaustive()
    }
}

impl<'a> Balance<'a> {
    /// Balances a system at given parameters; `variable` is what the last extended unknown stands for.
    pub fn new(
        system: &'a dyn System,
        parameters: &[f64],
        omega: f64,
        variable: Variable,
        resolution: Resolution,
    ) -> Self {
        let layout = Layout::of(system);
        let mut coefficients = vec![0.0; layout.coefficients];
        system.coefficients(parameters, omega, &mut coefficients);
        Self {
            system,
            resolution,
            parameters: parameters.to_vec(),
            omega,
            variable,
            drive_factor: 1.0,
            aft: Engine::new(resolution.aft, resolution.samples),
            coefficients,
            coefficients_by: vec![0.0; layout.coefficients],
            scratch: Scratch::new(&layout, resolution),
            blocks: blocks::of_layout(&layout, resolution.harmonics),
            layout,
        }
    }

    /// How finely orbits are represented.
    pub fn resolution(&self) -> Resolution {
        self.resolution
    }

    /// Parameters at the last evaluation.
    pub fn parameters(&self) -> &[f64] {
        &self.parameters
    }

    /// Excitation frequency at the last evaluation.
    pub fn omega(&self) -> f64 {
        self.omega
    }

    /// Base frequency at the last evaluation.
    pub fn base(&self) -> f64 {
        self.omega / self.base_divisor()
    }

    pub(crate) fn system(&self) -> &'a dyn System {
        self.system
    }

    pub(crate) fn layout(&self) -> &Layout {
        &self.layout
    }

    pub(crate) fn coefficients(&self) -> &[f64] {
        &self.coefficients
    }

    /// Length of the series of one coordinate.
    pub(crate) fn length(&self) -> usize {
        series::length(self.resolution.harmonics)
    }

    /// Harmonics that the series of a contact force must have room for.
    pub(crate) fn force_harmonics(&self) -> usize {
        series::harmonics(&self.scratch.force)
    }

    /// Harmonics that the series of a gap must have room for.
    pub(crate) fn gap_harmonics(&self) -> usize {
        series::harmonics(&self.scratch.gap)
    }

    /// Multiplies the oscillating part of the load from now on: the homotopy of a start.
    pub(crate) fn set_drive_factor(&mut self, factor: f64) {
        self.drive_factor = factor;
    }

    /// Sets the variable, and evaluates the coefficients there.
    pub(crate) fn set(&mut self, value: f64) {
        match self.variable {
            Variable::Omega => self.omega = value,
            Variable::Parameter(index) => self.parameters[index] = value,
        }
        self.system
            .coefficients(&self.parameters, self.omega, &mut self.coefficients);
    }

    fn base_divisor(&self) -> f64 {
        f64::from(self.system.facts().divisor) * self.resolution.period as f64
    }

    /// Derivative of the base frequency by the variable.
    fn base_by(&self) -> f64 {
        if self.variable == Variable::Omega {
            1.0 / self.base_divisor()
        } else {
            0.0
        }
    }

    /// Writes the series of the force of one contact at the variable set last.
    pub(crate) fn contact_force(&mut self, u: &[f64], contact: usize, force: &mut [f64]) {
        let (base, length, period) = (self.base(), self.length(), self.resolution.period);
        let layout = &self.layout.contacts[contact];
        let s = &mut self.scratch;
        let arguments = &mut s.arguments[..layout.argument_count];
        layout.arguments(&self.coefficients, arguments);
        gap_series(layout, &self.coefficients, period, u, length, &mut s.gap);
        rate_series(&s.gap, base, &mut s.rate);
        let law = self.system.law(layout.law);
        self.aft.force(
            ContactInput {
                law,
                arguments,
                gap: &s.gap,
                rate: &s.rate,
                base,
            },
            force,
        );
    }

    /// Adds the force of one contact, in its direction, to the equations it acts on.
    pub(crate) fn add_in_direction(&self, contact: usize, force: &[f64], residual: &mut [f64]) {
        for e in &self.layout.contacts[contact].force {
            let wave = stretched(e.wave, self.resolution.period);
            let to = block_mut(residual, e.index, self.length());
            series::add_product(force, wave, self.coefficients[e.coefficient], to);
        }
    }

    /// Adds `Omega^2 M D^2 u + Omega C D u + K u - f` for given coefficients.
    fn add_linear(&self, coefficients: &[f64], u: &[f64], residual: &mut [f64]) {
        let (base, length) = (self.base(), self.length());
        for entry in &self.layout.mass {
            let factor = base * base * coefficients[entry.coefficient];
            add_inertia(
                block(u, entry.column, length),
                factor,
                block_mut(residual, entry.row, length),
            );
        }
        self.add_damping(coefficients, base, u, residual);
        self.add_stiffness(coefficients, u, residual);
        self.add_load(coefficients, -1.0, residual);
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

    /// Evaluates one contact and its derivatives into the scratch series. Returns whether it depends on the variable.
    fn contact_derivatives(&mut self, u: &[f64], contact: usize) -> bool {
        let (base, base_by) = (self.base(), self.base_by());
        let (length, period) = (self.length(), self.resolution.period);
        let layout = &self.layout.contacts[contact];
        let s = &mut self.scratch;
        let arguments = &mut s.arguments[..layout.argument_count];
        let arguments_by = &mut s.arguments_by[..layout.argument_count];
        layout.arguments(&self.coefficients, arguments);
        gap_series(layout, &self.coefficients, period, u, length, &mut s.gap);
        rate_series(&s.gap, base, &mut s.rate);
        let own = layout
            .coefficients()
            .any(|index| self.coefficients_by[index] != 0.0);
        let changes = own || base_by != 0.0;
        if changes {
            layout.arguments(&self.coefficients_by, arguments_by);
            gap_series(
                layout,
                &self.coefficients_by,
                period,
                u,
                length,
                &mut s.change_gap,
            );
            rate_series(&s.change_gap, base, &mut s.change_rate);
            // The rate is base times the phase derivative, so it grows with the base frequency by itself over base.
            for (to, rate) in s.change_rate.iter_mut().zip(&s.rate) {
                *to += base_by / base * rate;
            }
        }
        let law = self.system.law(layout.law);
        let change = Change {
            gap: &s.change_gap,
            rate: &s.change_rate,
            arguments: arguments_by,
            base: base_by,
        };
        let mut out = ContactDerivatives {
            by_gap: &mut s.by_gap,
            by_rate: &mut s.by_rate,
            by_parameter: &mut s.by_parameter,
        };
        let input = ContactInput {
            law,
            arguments,
            gap: &s.gap,
            rate: &s.rate,
            base,
        };
        self.aft
            .derivatives(input, changes.then_some(change), &mut s.force, &mut out);
        changes
    }

    /// Puts the scratch series of one contact where they belong.
    fn scatter(&mut self, contact: usize, changes: bool, residual: &mut [f64]) {
        let (base, length, period) = (self.base(), self.length(), self.resolution.period);
        let s = &mut self.scratch;
        for rate in &mut s.by_rate {
            *rate *= base;
        }
        let layout = &self.layout.contacts[contact];
        for e in &layout.force {
            let wave = stretched(e.wave, period);
            let value = self.coefficients[e.coefficient];
            series::add_product(&s.force, wave, value, block_mut(residual, e.index, length));
            let column = block_mut(&mut s.column, e.index, length);
            series::add_product(&s.force, wave, self.coefficients_by[e.coefficient], column);
            if changes {
                series::add_product(&s.by_parameter, wave, value, column);
            }
            for d in &layout.gap {
                let factor = value * self.coefficients[d.coefficient];
                let gap_wave = stretched(d.wave, period);
                if let Some(block) = blocks::find(&mut self.blocks, e.index, d.index) {
                    block.add_by_gap(&s.by_gap, wave, gap_wave, factor, &mut s.product);
                    block.add_by_rate(&s.by_rate, wave, gap_wave, factor, &mut s.product);
                }
            }
        }
    }

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

    /// The derivative of the linear terms with respect to the variable.
    fn linear_by_variable(&mut self, u: &[f64], column: &mut [f64]) {
        let (base, base_by, length) = (self.base(), self.base_by(), self.length());
        column.fill(0.0);
        self.system.coefficients_by(
            self.variable,
            &self.parameters,
            self.omega,
            &mut self.coefficients_by,
        );
        self.add_linear(&self.coefficients_by, u, column);
        if base_by != 0.0 {
            for entry in &self.layout.mass {
                let factor = 2.0 * base * base_by * self.coefficients[entry.coefficient];
                add_inertia(
                    block(u, entry.column, length),
                    factor,
                    block_mut(column, entry.row, length),
                );
            }
            self.add_damping(&self.coefficients, base_by, u, column);
        }
    }

    fn assemble(&self, jacobian: &mut Matrix) {
        let (base, length) = (self.base(), self.length());
        for block in &self.blocks {
            block.add_to(self.resolution.harmonics, jacobian);
        }
        for entry in &self.layout.mass {
            let inertia = base * base * self.coefficients[entry.coefficient];
            for i in 1..length {
                let k = i.div_ceil(2) as f64;
                jacobian.row_mut(entry.row * length + i)[entry.column * length + i] -=
                    inertia * k * k;
            }
        }
        let last = self.layout.coordinates * length;
        for (row, value) in self.scratch.column.iter().enumerate() {
            jacobian.row_mut(row)[last] += value;
        }
    }
}

impl Problem for Balance<'_> {
    fn unknowns(&self) -> usize {
        self.layout.coordinates * self.length()
    }

    fn evaluate(&mut self, u: &[f64], residual: &mut [f64], jacobian: Option<&mut Matrix>) {
        let unknowns = self.unknowns();
        self.set(u[unknowns]);
        let u = &u[..unknowns];
        residual.fill(0.0);
        self.add_linear(&self.coefficients, u, residual);
        let Some(jacobian) = jacobian else {
            let mut force = std::mem::take(&mut self.scratch.force);
            for contact in 0..self.layout.contacts.len() {
                self.contact_force(u, contact, &mut force);
                self.add_in_direction(contact, &force, residual);
            }
            self.scratch.force = force;
            return;
        };
        let mut column = std::mem::take(&mut self.scratch.column);
        self.linear_by_variable(u, &mut column);
        self.scratch.column = column;
        self.start_blocks();
        for contact in 0..self.layout.contacts.len() {
            let changes = self.contact_derivatives(u, contact);
            self.scatter(contact, changes, residual);
        }
        self.assemble(jacobian);
    }

    fn is_mean(&self, unknown: usize) -> bool {
        unknown.is_multiple_of(self.length())
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
