//! The divergence of the motion: the rate at which volumes of states grow.
//!
//! Of the equations of motion in first order form, only the velocities' part has derivatives on the diagonal:
//!
//! ```text
//! div = -trace M^-1 ( C + sum_c e_c(tau) (d phi_c / d g_c') d_c(tau)^T )                                (1)
//! ```
//!
//! By Liouville's theorem the logarithm of the determinant of a tangent map is the integral of (1) over time, and so is the sum
//! of all Lyapunov exponents. Switches do not change that: gaps depend on coordinates and not on rates, so the saltation
//! has determinant one.
//!
//! Source: Guckenheimer and Holmes (1983), Nonlinear Oscillations, section 1.4.

use std::f64::consts::FRAC_PI_2;

use nalgebra::DMatrix;

use super::Stretch;
use super::gap::{Gap, value};
use crate::fourier::gauss;
use crate::law::{Derivatives, On};
use crate::layout::{ContactLayout, Layout, Term};
use crate::system::System;

/// Phase over which one Gauss rule is enough.
const PANEL: f64 = FRAC_PI_2;
const NODES: usize = 12;

/// The divergence of a system at given values.
pub struct Divergence<'a> {
    system: &'a dyn System,
    contacts: Vec<(ContactLayout, Gap)>,
    coefficients: Vec<f64>,
    inverse: DMatrix<f64>,
    /// `-trace M^-1 C`
    constant: f64,
    /// `omega / divisor`
    base: f64,
    arguments: Vec<f64>,
    state: Vec<f64>,
}

impl<'a> Divergence<'a> {
    /// The divergence at values of the parameters and of `omega`; `None` if the mass matrix is singular.
    pub fn new(system: &'a dyn System, parameters: &[f64], omega: f64) -> Option<Self> {
        let layout = Layout::of(system);
        let n = layout.coordinates;
        let mut coefficients = vec![0.0; layout.coefficients];
        system.coefficients(parameters, omega, &mut coefficients);
        let mut mass = DMatrix::zeros(n, n);
        for entry in &layout.mass {
            mass[(entry.row, entry.column)] += coefficients[entry.coefficient];
        }
        let inverse = mass.try_inverse()?;
        let damping = layout.damping.iter();
        let trace: f64 = damping
            .map(|c| inverse[(c.column, c.row)] * coefficients[c.coefficient])
            .sum();
        let base = omega / f64::from(system.facts().divisor);
        let most = layout.contacts.iter().map(|contact| contact.argument_count);
        let most = most.max().unwrap_or(0);
        let contacts = layout.contacts.into_iter().map(|contact| {
            let gap = Gap::new(&contact, &coefficients, base);
            (contact, gap)
        });
        Some(Self {
            system,
            arguments: vec![0.0; most],
            contacts: contacts.collect(),
            coefficients,
            inverse,
            constant: -trace,
            base,
            state: vec![0.0; 2 * n],
        })
    }

    /// The divergence at a phase and a state, per unit of time.
    pub fn at(&mut self, phase: f64, state: &[f64]) -> f64 {
        let mut sum = self.constant;
        for (contact, gap) in &self.contacts {
            let arguments = &mut self.arguments[..contact.argument_count];
            contact.arguments(&self.coefficients, arguments);
            let wave = |term: &Term| self.coefficients[term.coefficient] * value(term.wave, phase);
            let (gap, rate) = gap.at(phase, state);
            let (mut force, mut by_gap, mut by_rate) = ([0.0], [0.0], [0.0]);
            let out = Derivatives {
                force: &mut force,
                by_gap: &mut by_gap,
                by_rate: &mut by_rate,
            };
            let law = self.system.law(contact.law);
            law.derivatives(On::AllPieces, arguments, &[gap], &[rate], out);
            for e in &contact.force {
                for d in &contact.gap {
                    sum -= self.inverse[(d.index, e.index)] * wave(e) * wave(d) * by_rate[0];
                }
            }
        }
        sum
    }

    /// Its integral over the time of a stretch.
    pub fn over(&mut self, stretch: &dyn Stretch) -> f64 {
        let (from, to) = stretch.phases();
        let panels = ((to - from) / PANEL).ceil().max(1.0);
        let width = (to - from) / panels;
        let rule = gauss::rule(NODES);
        let mut state = std::mem::take(&mut self.state);
        let mut sum = 0.0;
        for panel in 0..panels as usize {
            for (node, weight) in rule.nodes.iter().zip(&rule.weights) {
                let phase = from + width * (panel as f64 + node);
                stretch.state(phase, &mut state);
                sum += weight * self.at(phase, &state);
            }
        }
        self.state = state;
        sum * width / self.base
    }
}
