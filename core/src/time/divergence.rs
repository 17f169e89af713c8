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
//! A stretch begins and ends on levels, where (1) may be a broken power of the distance. It is integrated in a variable that
//! makes such powers analytic (`fourier::grading`), by Gauss rules on panels that are halved until the highest Legendre
//! coefficients of the integrand vanish; their sum is the error.
//!
//! Source: Guckenheimer and Holmes (1983), Nonlinear Oscillations, section 1.4; Davis and Rabinowitz (1984), Methods of Numerical
//! Integration, sections 2.12 and 6.

use std::f64::consts::FRAC_PI_2;
use std::sync::Arc;

use nalgebra::DMatrix;

use super::Stretch;
use super::gap::{Gap, Waves};
use super::integrated::rule::Rule;
use crate::error::Error;
use crate::law::{LawFacts, On, Quantity, Variation};
use crate::laws::single::Single;
use crate::model::error::ModelError;
use crate::model::layout::{ContactLayout, Layout, Term};
use crate::model::validate;
use crate::numeric::estimate::Estimate;
use crate::numeric::fourier::grading;
use crate::numeric::fourier::grading::Grading;
use crate::system::System;

/// Phase of a panel to begin with.
const PANEL: f64 = FRAC_PI_2;
const NODES: usize = 12;
/// The error of a panel, in parts of the largest divergence times the length of the stretch, at which it is not halved.
const ENOUGH: f64 = 1e-13;
/// Panels of one stretch, and how often one is halved.
const MOST_PANELS: usize = 2000;
const MOST_HALVINGS: i32 = 50;

/// The divergence of a system at given values.
#[derive(Debug)]
pub(crate) struct Divergence {
    system: Arc<dyn System>,
    contacts: Vec<(ContactLayout, Gap)>,
    coefficients: Vec<f64>,
    inverse: DMatrix<f64>,
    /// `-trace M^-1 C`
    constant: f64,
    /// `omega / divisor`
    base: f64,
    arguments: Vec<f64>,
    state: Vec<f64>,
    rule: Rule<NODES>,
    /// What makes the divergence analytic at the ends of a stretch.
    grading: Grading,
    /// Panels that wait: where they begin, and how often they have been halved.
    panels: Vec<(f64, i32)>,
}

impl Divergence {
    /// The divergence at values of the parameters and of `omega`.
    ///
    /// # Errors
    /// If parameters or the frequency are outside their ranges, levels are out of order, or the mass matrix is singular.
    pub(crate) fn new(system: &dyn System, parameters: &[f64], omega: f64) -> Result<Self, Error> {
        validate::values(system, parameters, omega)?;
        let layout = Layout::of(system);
        let n = layout.coordinates;
        let mut coefficients = vec![0.0; layout.coefficients];
        system.coefficients(parameters, omega, &mut coefficients);
        let mass = layout.mass(&coefficients);
        let determinant = mass.determinant();
        let inverse = mass.try_inverse();
        let inverse = inverse.ok_or(ModelError::SingularMass { determinant })?;
        let damping = layout.damping.iter();
        let trace: f64 = damping
            .map(|c| inverse[(c.column, c.row)] * coefficients[c.coefficient])
            .sum();
        let base = omega / f64::from(system.facts().divisor);
        let most = layout.contacts.iter().map(|contact| contact.argument_count);
        let most = most.max().unwrap_or(0);
        let mut arguments = vec![0.0; most];
        let powers = layout.contacts.iter().map(|contact| {
            let arguments = &mut arguments[..contact.argument_count];
            contact.arguments(&coefficients, arguments);
            power(system.law(contact.law).facts(), arguments)
        });
        let power = powers.max().unwrap_or(1);
        let contacts = layout.contacts.into_iter().map(|contact| {
            let gap = Gap::new(&contact, &coefficients, base);
            (contact, gap)
        });
        Ok(Self {
            system: system.shared(),
            arguments,
            rule: Rule::new(),
            grading: Grading {
                start: power,
                end: power,
            },
            panels: Vec::new(),
            contacts: contacts.collect(),
            coefficients,
            inverse,
            constant: -trace,
            base,
            state: vec![0.0; 2 * n],
        })
    }

    /// The divergence at a phase and a state, per unit of time.
    fn at(&mut self, phase: f64, state: &[f64]) -> f64 {
        let mut sum = self.constant;
        let mut waves = Waves::at(phase);
        for (contact, gap) in &self.contacts {
            let arguments = &mut self.arguments[..contact.argument_count];
            contact.arguments(&self.coefficients, arguments);
            let mut wave =
                |term: &Term| self.coefficients[term.coefficient] * waves.value(term.wave);
            let (gap, rate) = gap.at(phase, state);
            let law = self.system.law(contact.law);
            let by_rate = Single::of(law, On::AllPieces, arguments, [gap, rate]).by_rate;
            for e in &contact.force {
                for d in &contact.gap {
                    sum -= self.inverse[(d.index, e.index)] * wave(e) * wave(d) * by_rate;
                }
            }
        }
        sum
    }

    /// Its integral over the time of a stretch. The error is rounding, and what the nodes do not resolve; that of the motion itself is not
    /// in it.
    pub(crate) fn over(&mut self, stretch: &dyn Stretch) -> Estimate {
        let (from, to) = stretch.phases();
        let count = ((to - from).abs() / PANEL * self.grading.stretch()).ceil();
        let first = 1.0 / count.max(1.0);
        let mut panels = std::mem::take(&mut self.panels);
        panels.extend(
            (0..count.max(1.0) as usize)
                .rev()
                .map(|k| (k as f64 * first, 0)),
        );
        let (mut sum, mut size, mut seen) = (Estimate::default(), 0.0_f64, 0);
        while let Some((start, halvings)) = panels.pop() {
            let width = first * 0.5_f64.powi(halvings);
            let values = self.values(stretch, start, width);
            size = values.iter().fold(size, |m, x| m.max(x.abs()));
            let error = width * self.rule.tail(&values);
            seen += 1;
            let may_halve = seen < MOST_PANELS && halvings < MOST_HALVINGS;
            if error > ENOUGH * size && may_halve {
                panels.push((start + 0.5 * width, halvings + 1));
                panels.push((start, halvings + 1));
                continue;
            }
            let products = values.iter().zip(&self.rule.weights);
            sum.add(Estimate {
                value: width * products.map(|(x, weight)| weight * x).sum::<f64>(),
                error: error + width * f64::EPSILON * size,
            });
        }
        self.panels = panels;
        sum.over(self.base / (to - from))
    }

    /// The divergence at the nodes of a panel, times the slope of the phase by the variable of the panels.
    fn values(&mut self, stretch: &dyn Stretch, start: f64, width: f64) -> [f64; NODES] {
        let (from, to) = stretch.phases();
        let mut state = std::mem::take(&mut self.state);
        let values = self.rule.nodes.map(|node| {
            let (distance, slope, from_start) = self.grading.distance(start + width * node);
            let phase = if from_start {
                from + (to - from) * distance
            } else {
                to - (to - from) * distance
            };
            stretch.state(phase, &mut state);
            slope * self.at(phase, &state)
        });
        self.state = state;
        values
    }
}

/// The power that makes what a law adds to the divergence analytic at all its levels; one if it is constant on every piece.
fn power(law: &LawFacts, arguments: &[f64]) -> u32 {
    let varying = law.pieces.iter();
    if !varying
        .clone()
        .any(|piece| piece.by_rate == Variation::Varying)
    {
        return 1;
    }
    let terms = varying.flat_map(|piece| piece.terms.iter());
    let ends = terms.filter(|term| matches!(term.of, Quantity::Force | Quantity::ByRate));
    let exponents =
        ends.flat_map(|term| [(term.lower, term.logarithm), (term.upper, term.logarithm)]);
    grading::power_for(
        &exponents.map(|(exponent, logarithm)| (exponent.value(arguments), logarithm)),
    )
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::time::{Flow, Integrated, Tangent};

    crate::oscillator! {
        /// A damping that is a power of the penetration.
        Damped(x) {
            param alpha > 0;
            param zeta in 0.0..;
            law contact(gap, a) { gap > 0 => gap^1.5 + zeta*gap^a*dot(gap), else => 0 }
            ddot(x) + contact(x, alpha) = 1 + 0.5*cos(omega*t);
        }
    }

    /// `x = tau` over a part of a period.
    struct Straight;

    impl Stretch for Straight {
        fn phases(&self) -> (f64, f64) {
            (0.0, 2.0)
        }

        fn state(&self, phase: f64, state: &mut [f64]) {
            state.copy_from_slice(&[phase, 1.0]);
        }
    }

    /// The integral of `-zeta tau^a` is `-zeta 2^(a + 1) / (a + 1)`.
    #[test]
    fn powers_are_integrated_to_rounding() {
        for alpha in [0.1, 0.25, 0.5, 0.6, 1.0, 1.37, 1.5, 2.0] {
            let model = Damped { alpha, zeta: 0.3 };
            let mut divergence = Divergence::new(&model, &[alpha, 0.3], 1.0).expect("values");
            let found = divergence.over(&Straight);
            let exact = -0.3 * 2_f64.powf(alpha + 1.0) / (alpha + 1.0);
            let error = (found.value - exact).abs();
            assert!(
                error < 1e-14 && error <= found.error,
                "{alpha} {error:e} {found:?}"
            );
            assert!(found.error < 1e-12, "{alpha} {found:?}");
        }
    }

    /// The tangent of a motion contracts areas by the exponential of the integral.
    fn check_areas(system: &dyn System, values: &[f64], periods: f64) {
        let mut flow = Integrated::new(system, values, 0.9, 1e-13).expect("a flow");
        let mut divergence = Divergence::new(system, values, 0.9).expect("values");
        let (mut state, mut tangent) = ([1.2, 1.4], Tangent::of_state(1, None));
        let mut sum = Estimate::default();
        let mut see = |stretch: &dyn Stretch| sum.add(divergence.over(stretch));
        let to = periods * std::f64::consts::TAU;
        flow.advance(0.0, to, &mut state, Some(&mut tangent), Some(&mut see))
            .expect("a motion");
        assert!(flow.work().switches > 1, "{:?}", flow.work());
        let [a, b, c, d] = tangent.columns[..] else {
            unreachable!()
        };
        let error = (a * d - b * c) / f64::exp(sum.value) - 1.0;
        assert!(error.abs() < 1e-10, "{values:?}: {error:e} {sum:?}");
        assert!(sum.error < 1e-11, "{values:?}: {sum:?}");
    }

    #[test]
    fn areas_shrink_by_a_damping_that_is_a_power() {
        for alpha in [0.25, 0.5, 1.5] {
            let model = Damped { alpha, zeta: 0.3 };
            check_areas(&model, &[alpha, 0.3], 3.0);
        }
    }
}
