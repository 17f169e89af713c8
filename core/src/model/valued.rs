//! A system at values of its parameters that are not its own.

use std::sync::Arc;

use crate::law::Law;
use crate::system::{System, SystemFacts, Variable};

/// A system whose parameters have other values: for whoever has a system of a type that is not known, and not its fields.
///
/// ```
/// use hertzian::{FrequencyResponse, System, Valued};
///
/// hertzian::oscillator! {
///     Linear(x) {
///         param drive = 1;
///         ddot(x) + 0.2*dot(x) + 4*x = drive*cos(omega*t);
///     }
/// }
///
/// let model = Linear::default().shared();
/// let (one, two) = (FrequencyResponse::of(&model), FrequencyResponse::of(&Valued::new(&model, vec![2.0])));
/// let ratio = two.orbit(1.0)?.peak_to_peak() / one.orbit(1.0)?.peak_to_peak();
/// assert!((ratio - 2.0).abs() < 1e-12);
/// # Ok::<(), hertzian::Error>(())
/// ```
#[derive(Debug, Clone)]
pub struct Valued {
    system: Arc<dyn System>,
    values: Vec<f64>,
}

impl Valued {
    /// A system with as many values as it has parameters, in the order of its declaration. Values that are missing are not numbers, which
    /// requests refuse, and further ones are left out.
    pub fn new(system: &Arc<dyn System>, values: Vec<f64>) -> Self {
        let mut values = values;
        values.resize(system.facts().parameters.len(), f64::NAN);
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
