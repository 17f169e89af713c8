//! The terms of the balance that come from contacts.

use super::alike::Alike;
use super::terms::{block_mut, gap_series, rate_series, stretched};
use super::{Balance, Resolution, blocks};
use crate::balance::aft::{Change, ContactDerivatives, ContactInput};
use crate::model::layout::Layout;
use crate::numeric::fourier::series;

/// Series that an evaluation needs, allocated once.
#[derive(Debug)]
pub(super) struct Scratch {
    arguments: Vec<f64>,
    arguments_by: Vec<f64>,
    pub(super) gap: Vec<f64>,
    rate: Vec<f64>,
    change_gap: Vec<f64>,
    change_rate: Vec<f64>,
    pub(super) force: Vec<f64>,
    pub(super) by_gap: Vec<f64>,
    pub(super) by_rate: Vec<f64>,
    by_parameter: Vec<f64>,
    product: Vec<f64>,
    pub(super) column: Vec<f64>,
    /// Length of slopes that couple all harmonics, and workspace for them, made when they are first needed.
    full: usize,
    full_by_gap: Vec<f64>,
    full_by_rate: Vec<f64>,
}

impl Scratch {
    /// Workspace for slopes whose harmonics up to `coupling` are needed.
    pub(super) fn new(layout: &Layout, resolution: Resolution, coupling: usize) -> Self {
        let Resolution {
            harmonics, period, ..
        } = resolution;
        let highest = |of: fn(&crate::model::layout::ContactLayout) -> usize| {
            layout.contacts.iter().map(of).max().unwrap_or(0) * period
        };
        let force_wave = highest(crate::model::layout::ContactLayout::force_harmonic);
        let gap_wave = highest(crate::model::layout::ContactLayout::gap_harmonic);
        let offset_wave = highest(crate::model::layout::ContactLayout::offset_harmonic);
        let zeros = |harmonics| vec![0.0; series::length(harmonics)];
        let gap = || zeros((harmonics + gap_wave).max(offset_wave));
        let force = || zeros(harmonics + force_wave);
        let slope = || zeros(coupling + force_wave + gap_wave);
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
            full: series::length(2 * harmonics + force_wave + gap_wave),
            full_by_gap: Vec::new(),
            full_by_rate: Vec::new(),
        }
    }
}

impl Balance<'_> {
    /// Puts arguments, gap and rate of one contact into the scratch series.
    fn load_contact(&mut self, u: &[f64], contact: usize) {
        let (base, length, period) = (self.base(), self.length(), self.resolution.period);
        let layout = &self.layout.contacts[contact];
        let s = &mut self.scratch;
        let arguments = &mut s.arguments[..layout.argument_count];
        layout.arguments(&self.coefficients, arguments);
        gap_series(layout, &self.coefficients, period, u, length, &mut s.gap);
        rate_series(&s.gap, base, &mut s.rate);
    }

    /// The same of the derivatives of arguments and gap by the variable, as far as coefficients make them.
    fn load_change(&mut self, u: &[f64], contact: usize) {
        let (length, period) = (self.length(), self.resolution.period);
        let layout = &self.layout.contacts[contact];
        let s = &mut self.scratch;
        let arguments = &mut s.arguments_by[..layout.argument_count];
        layout.arguments(&self.coefficients_by, arguments);
        let by = &self.coefficients_by;
        gap_series(layout, by, period, u, length, &mut s.change_gap);
    }

    /// The change of the rate, for one of the gap and one of the variable. The rate is base times the phase derivative, so it grows with
    /// the base frequency by itself over base.
    fn load_change_of_rate(&mut self, by: f64) {
        let (base, base_by) = (self.base(), self.base_by());
        let s = &mut self.scratch;
        rate_series(&s.change_gap, base, &mut s.change_rate);
        for (to, rate) in s.change_rate.iter_mut().zip(&s.rate) {
            *to += by * base_by / base * rate;
        }
    }

    /// Evaluates the contact that has been loaded into the scratch series: where the base frequency changes by a number, with the change
    /// that has been loaded; and if asked for, with slopes in full length.
    fn evaluate_contact(&mut self, contact: usize, base_by: Option<f64>, full: bool) {
        let base = self.base();
        let layout = &self.layout.contacts[contact];
        let s = &mut self.scratch;
        let change = base_by.map(|base| Change {
            gap: &s.change_gap,
            rate: &s.change_rate,
            arguments: &s.arguments_by[..layout.argument_count],
            base,
        });
        let slopes = if full {
            [&mut s.full_by_gap, &mut s.full_by_rate]
        } else {
            [&mut s.by_gap, &mut s.by_rate]
        };
        let [by_gap, by_rate] = slopes;
        let mut out = ContactDerivatives {
            by_gap,
            by_rate,
            by_parameter: &mut s.by_parameter,
        };
        let input = ContactInput {
            law: self.system.law(layout.law),
            arguments: &s.arguments[..layout.argument_count],
            gap: &s.gap,
            rate: &s.rate,
            base,
        };
        self.aft.derivatives(input, change, &mut s.force, &mut out);
    }

    /// Writes the series of the force of one contact at the variable set last.
    pub(crate) fn contact_force(&mut self, u: &[f64], contact: usize, force: &mut [f64]) {
        self.load_contact(u, contact);
        let (base, layout, s) = (self.base(), &self.layout.contacts[contact], &self.scratch);
        let input = ContactInput {
            law: self.system.law(layout.law),
            arguments: &s.arguments[..layout.argument_count],
            gap: &s.gap,
            rate: &s.rate,
            base,
        };
        self.aft.force(input, force);
    }

    /// Adds the force of one contact, so many times, in its direction, to the equations it acts on.
    pub(crate) fn add_in_direction(
        &self,
        contact: usize,
        count: f64,
        force: &[f64],
        residual: &mut [f64],
    ) {
        for e in &self.layout.contacts[contact].force {
            let wave = stretched(e.wave, self.resolution.period);
            let to = block_mut(residual, e.index, self.length());
            series::add_product(force, wave, count * self.coefficients[e.coefficient], to);
        }
    }

    /// Evaluates one contact and its derivatives into the scratch series. Returns whether it depends on the variable.
    pub(crate) fn contact_derivatives(&mut self, u: &[f64], contact: usize) -> bool {
        let base_by = self.base_by();
        self.load_contact(u, contact);
        let layout = &self.layout.contacts[contact];
        let own = layout
            .coefficients()
            .any(|index| self.coefficients_by[index] != 0.0);
        let changes = own || base_by != 0.0;
        if changes {
            self.load_change(u, contact);
            self.load_change_of_rate(1.0);
        }
        self.evaluate_contact(contact, changes.then_some(base_by), false);
        changes
    }

    /// Puts the scratch series of one contact where they belong.
    pub(super) fn scatter(&mut self, alike: Alike, changes: bool, residual: &mut [f64]) {
        let Alike { contact, count } = alike;
        let (base, length, period) = (self.base(), self.length(), self.resolution.period);
        let s = &mut self.scratch;
        for rate in &mut s.by_rate {
            *rate *= base;
        }
        let layout = &self.layout.contacts[contact];
        for e in &layout.force {
            let wave = stretched(e.wave, period);
            let value = count * self.coefficients[e.coefficient];
            series::add_product(&s.force, wave, value, block_mut(residual, e.index, length));
            let column = block_mut(&mut s.column, e.index, length);
            let by = count * self.coefficients_by[e.coefficient];
            series::add_product(&s.force, wave, by, column);
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

    /// Adds the derivative of the force of one contact in a direction of the extended unknowns, in its direction, to the
    /// equations it acts on. The derivatives of the coefficients by the variable have been evaluated.
    pub(super) fn add_contact_in(
        &mut self,
        u: &[f64],
        direction: &[f64],
        Alike { contact, count }: Alike,
        derivative: &mut [f64],
    ) {
        let base_by = self.base_by();
        let (length, period) = (self.length(), self.resolution.period);
        let by = direction[direction.len() - 1];
        self.load_contact(u, contact);
        self.load_change(u, contact);
        let layout = &self.layout.contacts[contact];
        let s = &mut self.scratch;
        let arguments_by = &mut s.arguments_by[..layout.argument_count];
        for x in s.change_gap.iter_mut().chain(arguments_by.iter_mut()) {
            *x *= by;
        }
        for term in &layout.gap {
            let wave = stretched(term.wave, period);
            let from = &direction[term.index * length..][..length];
            let value = self.coefficients[term.coefficient];
            series::add_product(from, wave, value, &mut s.change_gap);
        }
        self.load_change_of_rate(by);
        let s = &mut self.scratch;
        s.full_by_gap.resize(s.full, 0.0);
        s.full_by_rate.resize(s.full, 0.0);
        self.evaluate_contact(contact, Some(by * base_by), true);
        let (layout, s) = (&self.layout.contacts[contact], &self.scratch);
        for e in &layout.force {
            let wave = stretched(e.wave, period);
            let to = block_mut(derivative, e.index, length);
            let value = count * self.coefficients[e.coefficient];
            series::add_product(&s.by_parameter, wave, value, to);
            let value = count * by * self.coefficients_by[e.coefficient];
            series::add_product(&s.force, wave, value, to);
        }
    }
}
