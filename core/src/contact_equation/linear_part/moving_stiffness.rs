//! Stiffness that varies in time as contacts that are always closed.
//!
//! What the linear part solves in closed form is the constant stiffness. Of the rest every column is a contact: its gap is the coordinate,
//! its law is the gap itself, and the column is the direction of its force,
//!
//! ```text
//! K(tau) q = K_0 q + sum_j k_j(tau) phi(q_j),    phi(g) = g,                                                    (1)
//! ```
//!
//! so that forces at nodes over the whole period are its unknowns. It has no levels, and nothing switches.
//!
//! Source: Magnus and Winkler (1966), Hill's Equation, part I (the equation); that its periodic term is a force which feeds back is the
//! contact equation's own idea.

use std::sync::Arc;

use crate::law::{Derivatives, Law, LawFacts, On, Parts, PieceFacts, RateDependence, Variation};
use crate::model::layout::{ContactLayout, Entry, Layout, Term};
use crate::system::{System, SystemFacts, Variable, Wave};

/// A system and the law of (1), whose index comes behind its own. Behind its own coefficients there is one more, which is one.
struct WithSprings {
    system: Arc<dyn System>,
    spring: Spring,
}

impl System for WithSprings {
    fn facts(&self) -> &SystemFacts {
        self.system.facts()
    }

    fn values(&self, values: &mut [f64]) {
        self.system.values(values);
    }

    fn coefficients(&self, parameters: &[f64], omega: f64, coefficients: &mut [f64]) {
        if let Some((one, own)) = coefficients.split_last_mut() {
            self.system.coefficients(parameters, omega, own);
            *one = 1.0;
        }
    }

    fn coefficients_by(
        &self,
        variable: Variable,
        parameters: &[f64],
        omega: f64,
        derivatives: &mut [f64],
    ) {
        if let Some((one, own)) = derivatives.split_last_mut() {
            self.system
                .coefficients_by(variable, parameters, omega, own);
            *one = 0.0;
        }
    }

    fn law(&self, index: usize) -> &dyn Law {
        if index == self.system.facts().laws {
            &self.spring
        } else {
            self.system.law(index)
        }
    }

    fn shared(&self) -> Arc<dyn System> {
        Arc::new(Self {
            system: Arc::clone(&self.system),
            spring: self.spring.clone(),
        })
    }
}

/// `phi(g) = g`
#[derive(Clone)]
struct Spring(LawFacts);

impl Spring {
    fn new() -> Self {
        let piece = PieceFacts::smooth(0).slopes(Variation::Constant, Variation::Zero);
        Self(LawFacts::new("stiffness", [], [piece]).rate(RateDependence::None))
    }
}

impl Law for Spring {
    fn facts(&self) -> &LawFacts {
        &self.0
    }

    fn levels(&self, _: &[f64], _: &mut [f64]) {}

    fn levels_by(&self, _: &[f64], _: usize, _: &mut [f64]) {}

    fn force(&self, _: On, _: &[f64], gap: &[f64], _: &[f64], force: &mut [f64]) {
        force.copy_from_slice(gap);
    }

    fn derivatives(&self, _: On, _: &[f64], gap: &[f64], _: &[f64], out: Derivatives<'_>) {
        out.force.copy_from_slice(gap);
        out.by_gap.fill(1.0);
        out.by_rate.fill(0.0);
    }

    fn derivatives_and_by(
        &self,
        _: usize,
        on: On,
        arguments: &[f64],
        gap: &[f64],
        rate: &[f64],
        out: Derivatives<'_>,
        by_argument: &mut [f64],
    ) {
        self.derivatives(on, arguments, gap, rate, out);
        by_argument.fill(0.0);
    }

    fn parts(&self) -> Option<Parts<'_>> {
        None
    }
}

/// Takes what varies in time out of the stiffness and makes contacts of it. The system that is returned has their law.
pub(in crate::contact_equation) fn as_contacts(
    system: &Arc<dyn System>,
    layout: &mut Layout,
) -> Arc<dyn System> {
    let stiffness = std::mem::take(&mut layout.stiffness);
    let varies = |entry: &Entry| entry.wave.harmonic > 0;
    let (moving, constant): (Vec<_>, Vec<_>) = stiffness.into_iter().partition(varies);
    layout.stiffness = constant;
    if moving.is_empty() {
        return Arc::clone(system);
    }
    let one = layout.coefficients;
    layout.coefficients += 1;
    for column in 0..layout.coordinates {
        let entries = moving.iter().filter(|entry| entry.column == column);
        let force: Vec<Term> = entries
            .map(|entry| Term {
                index: entry.row,
                wave: entry.wave,
                coefficient: entry.coefficient,
            })
            .collect();
        if force.is_empty() {
            continue;
        }
        let coordinate = Term {
            index: column,
            wave: Wave::CONSTANT,
            coefficient: one,
        };
        layout.contacts.push(ContactLayout {
            law: system.facts().laws,
            force,
            gap: vec![coordinate],
            ..ContactLayout::default()
        });
    }
    Arc::new(WithSprings {
        system: Arc::clone(system),
        spring: Spring::new(),
    })
}
