//! A system at values of its parameters that are not its own.

use std::sync::Arc;

use crate::law::Law;
use crate::system::{System, SystemFacts, Variable};

/// A system whose parameters have other values.
#[derive(Debug, Clone)]
pub(crate) struct Valued {
    system: Arc<dyn System>,
    values: Vec<f64>,
}

impl Valued {
    /// A system with as many values as it has parameters.
    pub(crate) fn new(system: &Arc<dyn System>, values: Vec<f64>) -> Self {
        Self {
            system: Arc::clone(system),
            values,
        }
    }
}

// All but the values is the system's own; another wrapper, which interprets its laws, says so in the same words.
impl System for Valued {
    fn facts(&self) -> &SystemFacts {
        self.system.facts()
    }

    fn values(&self, values: &mut [f64]) {
        values.copy_from_slice(&self.values);
    }

    fn coefficients(&self, parameters: &[f64], omega: f64, coefficients: &mut [f64]) {
        self.system.coefficients(parameters, omega, coefficients);
    }

    fn coefficients_by(
        &self,
        variable: Variable,
        parameters: &[f64],
        omega: f64,
        derivatives: &mut [f64],
    ) {
        self.system
            .coefficients_by(variable, parameters, omega, derivatives);
    }

    fn law(&self, index: usize) -> &dyn Law {
        self.system.law(index)
    }

    fn shared(&self) -> Arc<dyn System> {
        Arc::new(self.clone())
    }
}
