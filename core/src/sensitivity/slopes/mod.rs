//! Signals of a motion at one instant, and their derivatives along any direction: with the state, with a variable, with the phase.
//!
//! With the coefficients `c`, waves `w` of the phase and the base frequency `Omega`, all of which may move by `c'`, `w'` and `Omega'`,
//!
//! ```text
//! g  = sum d w q - sum delta w,          r  = sum d (w v + Omega w_tau q) - sum delta Omega w_tau               (1)
//! f  = phi(g, r; a),                     f' = phi_g g' + phi_r r' + sum_a phi_a a'                              (2)
//! M a = sum l w - C v - K q - sum e f,   M a' = ( sum l w - C v - K q - sum e f )' - M' a                       (3)
//! ```
//!
//! and the derivative of every sum is by the rule of products. Each contact is on a stated piece of its law, so that one-sided limits at
//! switches have derivatives too.
//!
//! [`instant`] has the motion itself, [`directional_derivatives`] its derivatives along a direction, [`signals`] what is read off both.

mod directional_derivatives;
mod instant;
pub(super) mod signals;

use std::cell::Cell;
use std::sync::Arc;

use nalgebra::DMatrix;

use self::signals::{Asked, Product};
use crate::laws::single::Single;
use crate::model::layout::{Entry, Layout};
use crate::system::{Signal, System, Variable, Wave};

/// What is known of a contact at these values.
#[derive(Debug, Clone)]
struct Contact {
    arguments: Vec<f64>,
    levels: Vec<f64>,
}

/// Derivatives of all coefficients, and of the base frequency, by one variable.
#[derive(Debug, Clone)]
pub(super) struct By {
    pub(super) coefficients: Vec<f64>,
    pub(super) base: f64,
}

/// A motion at one instant.
#[derive(Debug, Clone)]
pub(super) struct Instant {
    phase: f64,
    state: Vec<f64>,
    pieces: Vec<usize>,
    /// Gap and rate of each contact.
    pub(super) gaps: Vec<[f64; 2]>,
    forces: Vec<Single>,
    pub(super) acceleration: Vec<f64>,
    /// The waves of the system with their derivatives.
    waves: Vec<[f64; 3]>,
    /// Derivatives of forces by arguments, contact by contact, as far as they have been asked for.
    by_arguments: Vec<Cell<Option<f64>>>,
    loads: Vec<f64>,
}

/// Workspace for how forces and accelerations move.
#[derive(Debug, Clone)]
pub(super) struct Moved {
    acceleration: Vec<f64>,
    forces: Vec<f64>,
    loads: Vec<f64>,
}

/// In what direction a derivative is taken.
#[derive(Debug, Clone, Copy)]
pub(super) struct Direction<'d> {
    /// How the state moves.
    pub(super) state: &'d [f64],
    /// What moves besides.
    pub(super) by: Option<&'d By>,
    /// How much the phase moves.
    pub(super) phase: f64,
}

/// Signals of a system at values of its parameters and of `omega`.
pub(super) struct Slopes {
    system: Arc<dyn System>,
    layout: Layout,
    values: Vec<f64>,
    omega: f64,
    pub(super) base: f64,
    coefficients: Vec<f64>,
    contacts: Vec<Contact>,
    inverse_mass: DMatrix<f64>,
    mass: Vec<Entry>,
    /// All waves but the constant one, once each.
    waves: Vec<Wave>,
    /// The first of the arguments of each contact among those of all.
    first_argument: Vec<usize>,
    asked: Vec<Asked>,
    sums: Vec<Vec<Product>>,
    /// Whether a sum has an acceleration or a force.
    has_forces: bool,
}

impl Slopes {
    pub(super) fn new(system: &Arc<dyn System>, asked: &[Asked]) -> Self {
        let layout = Layout::of(system);
        let contacts = layout.contacts.iter().map(|contact| Contact {
            arguments: vec![0.0; contact.argument_count],
            levels: vec![0.0; system.law(contact.law).facts().levels.len()],
        });
        let n = layout.coordinates;
        let mut slopes = Self {
            values: vec![0.0; system.facts().parameters.len()],
            omega: 1.0,
            base: 1.0,
            coefficients: vec![0.0; layout.coefficients],
            contacts: contacts.collect(),
            inverse_mass: DMatrix::identity(n, n),
            mass: layout.mass.clone(),
            waves: Vec::new(),
            first_argument: Vec::new(),
            asked: asked.to_vec(),
            sums: Vec::new(),
            has_forces: false,
            system: Arc::clone(system),
            layout,
        };
        slopes.sums = asked.iter().map(|&asked| slopes.products(asked)).collect();
        slopes.has_forces = slopes
            .sums
            .iter()
            .flatten()
            .any(|product| matches!(product.of, Signal::Acceleration(_) | Signal::Force(_)));
        slopes.number();
        slopes
    }

    /// Numbers the waves and the arguments of contacts.
    fn number(&mut self) {
        let layout = &self.layout;
        let loads = layout.load.iter().map(|e| e.wave);
        let matrices = layout.stiffness.iter().map(|e| e.wave);
        let of_contacts = layout.contacts.iter().flat_map(|contact| {
            let terms = contact.gap.iter().chain(&contact.offset);
            terms.chain(&contact.force).map(|term| term.wave)
        });
        let of_sums = self.sums.iter().flatten().map(|product| product.wave);
        for wave in loads.chain(matrices).chain(of_contacts).chain(of_sums) {
            if wave != Wave::CONSTANT && !self.waves.contains(&wave) {
                self.waves.push(wave);
            }
        }
        let mut first = 0;
        for contact in &layout.contacts {
            self.first_argument.push(first);
            first += contact.argument_count;
        }
    }

    /// Room for motions at one instant.
    pub(super) fn instant(&self) -> Instant {
        let (n, count) = (self.layout.coordinates, self.contacts.len());
        let arguments = self.layout.contacts.iter().map(|c| c.argument_count).sum();
        Instant {
            phase: 0.0,
            state: vec![0.0; 2 * n],
            pieces: vec![0; count],
            gaps: Vec::with_capacity(count),
            forces: Vec::with_capacity(count),
            acceleration: vec![0.0; n],
            waves: vec![[0.0; 3]; self.waves.len()],
            by_arguments: vec![Cell::new(None); arguments],
            loads: vec![0.0; n],
        }
    }

    /// Room for how forces and accelerations move.
    pub(super) fn moved(&self) -> Moved {
        let (n, count) = (self.layout.coordinates, self.contacts.len());
        Moved {
            acceleration: vec![0.0; n],
            forces: vec![0.0; count],
            loads: vec![0.0; n],
        }
    }

    /// Goes over to other values.
    pub(super) fn set(&mut self, values: &[f64], omega: f64) {
        self.values.copy_from_slice(values);
        self.omega = omega;
        self.base = omega / f64::from(self.system.facts().divisor);
        self.system
            .coefficients(values, omega, &mut self.coefficients);
        let n = self.layout.coordinates;
        let mass = self.layout.mass(&self.coefficients);
        self.inverse_mass = mass
            .try_inverse()
            .unwrap_or_else(|| DMatrix::from_element(n, n, f64::NAN));
        for (contact, layout) in self.contacts.iter_mut().zip(&self.layout.contacts) {
            layout.arguments(&self.coefficients, &mut contact.arguments);
            let law = self.system.law(layout.law);
            law.levels(&contact.arguments, &mut contact.levels);
        }
    }

    /// Entries of a state.
    pub(super) fn order(&self) -> usize {
        2 * self.layout.coordinates
    }

    /// Number of signals.
    pub(super) fn count(&self) -> usize {
        self.sums.len()
    }

    /// Number of contacts.
    pub(super) fn contacts(&self) -> usize {
        self.contacts.len()
    }

    /// Derivatives of the coefficients by a variable.
    pub(super) fn by(&self, variable: Variable) -> By {
        let mut coefficients = vec![0.0; self.layout.coefficients];
        self.system
            .coefficients_by(variable, &self.values, self.omega, &mut coefficients);
        let base = match variable {
            Variable::Omega => 1.0 / f64::from(self.system.facts().divisor),
            Variable::Parameter(_) => 0.0,
        };
        By { coefficients, base }
    }

    /// A level of the law of a contact.
    pub(super) fn level(&self, contact: usize, level: usize) -> f64 {
        self.contacts[contact].levels[level]
    }

    /// Whether the force of a contact jumps at a level, even without a rate.
    pub(super) fn jumps(&self, contact: usize, level: usize) -> bool {
        let law = self.system.law(self.layout.contacts[contact].law);
        law.facts().levels[level].force_jumps
    }

    /// Number of levels of the law of a contact.
    pub(super) fn levels(&self, contact: usize) -> usize {
        self.contacts[contact].levels.len()
    }
}
