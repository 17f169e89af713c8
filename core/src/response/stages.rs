//! The work of one iteration, part by part: what the bench of this name times, and nobody else calls.

use crate::balance::Balance;
use crate::branches::branch::Branch;
use crate::branches::point::Point;
use crate::continuation::jacobian::Jacobian;
use crate::continuation::problem::Problem;

pub use crate::numeric::fourier::crossings::{Crossing, CrossingFinder, NearMiss};

/// The balance of a branch at one of its points, with the core that a run takes.
#[derive(Debug)]
pub struct Stages<'a> {
    balance: Balance<'a>,
    /// The extended unknowns.
    u: Vec<f64>,
    residual: Vec<f64>,
    jacobian: Jacobian,
    /// The border that holds the parameter fast.
    border: Vec<f64>,
}

impl<'a> Stages<'a> {
    /// At a point of a branch; `None` if that is not one of the balance.
    pub fn at(branch: &'a Branch, point: &Point) -> Option<Self> {
        let mut u = point.orbit.series.clone();
        u.push(point.value);
        let context = branch.by_balance()?;
        let core = context.core_for(&u);
        let resolution = context.with_harmonics(point.orbit.harmonics(), core);
        let balance = context.balance(resolution);
        let mut border = vec![0.0; u.len()];
        border[u.len() - 1] = 1.0;
        let mut stages = Self {
            residual: vec![0.0; u.len() - 1],
            jacobian: Jacobian::new(balance.partition()),
            balance,
            u,
            border,
        };
        stages.jacobian();
        Some(stages)
    }

    /// Harmonics that are coupled densely.
    pub fn core(&self) -> usize {
        self.balance.resolution().core
    }

    /// The residual alone.
    pub fn residual(&mut self) -> &[f64] {
        self.balance.evaluate(&self.u, &mut self.residual, None);
        &self.residual
    }

    /// Of the Jacobian, the part from the gaps of the contacts to the series of their forces and derivatives.
    pub fn contacts(&mut self) {
        let unknowns = self.residual.len();
        for contact in 0..self.balance.layout().contacts.len() {
            self.balance
                .contact_derivatives(&self.u[..unknowns], contact);
        }
    }

    /// Residual and Jacobian.
    pub fn jacobian(&mut self) {
        self.jacobian.clear();
        let jacobian = Some(&mut self.jacobian);
        self.balance.evaluate(&self.u, &mut self.residual, jacobian);
        self.jacobian.set_border(&self.border);
    }

    /// Factorises the Jacobian evaluated last, which is then no more. Returns whether it is regular.
    pub fn factorise(&mut self) -> bool {
        self.jacobian.factorise().is_ok()
    }
}
