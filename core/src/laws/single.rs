//! A law at one gap and one rate.

use crate::law::{Derivatives, Law, On};

/// Force and its derivatives.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Single {
    pub(crate) force: f64,
    pub(crate) by_gap: f64,
    pub(crate) by_rate: f64,
}

impl Single {
    pub(crate) fn of(law: &dyn Law, on: On, arguments: &[f64], [gap, rate]: [f64; 2]) -> Self {
        let (mut force, mut by_gap, mut by_rate) = ([0.0], [0.0], [0.0]);
        let out = Derivatives {
            force: &mut force,
            by_gap: &mut by_gap,
            by_rate: &mut by_rate,
        };
        law.derivatives(on, arguments, &[gap], &[rate], out);
        Self {
            force: force[0],
            by_gap: by_gap[0],
            by_rate: by_rate[0],
        }
    }
}

/// The force alone.
pub(crate) fn force(law: &dyn Law, on: On, arguments: &[f64], [gap, rate]: [f64; 2]) -> f64 {
    let mut force = [0.0];
    law.force(on, arguments, &[gap], &[rate], &mut force);
    force[0]
}
