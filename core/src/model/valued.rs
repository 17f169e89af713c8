//! A system that another one stands behind: with other values of its parameters, or with other laws.

use std::fmt;
use std::sync::Arc;

use crate::law::Law;
use crate::system::{System, SystemFacts, Variable};

/// A system at other values of its parameters, in the order of its declaration: for whoever has a system of a type that is not known, and not
/// its fields. Values that are missing are not numbers, which requests refuse, and further ones are left out.
///
/// ```
/// use hertzian::{FrequencyResponse, with_values};
///
/// hertzian::oscillator! {
///     Linear(x) {
///         param drive = 1;
///         ddot(x) + 0.2*dot(x) + 4*x = drive*cos(omega*t);
///     }
/// }
///
/// let model = Linear::default();
/// let (one, two) = (FrequencyResponse::of(&model), FrequencyResponse::of(&with_values(&model, vec![2.0])));
/// let ratio = two.orbit(1.0)?.peak_to_peak() / one.orbit(1.0)?.peak_to_peak();
/// assert!((ratio - 2.0).abs() < 1e-12);
/// # Ok::<(), hertzian::Error>(())
/// ```
pub fn with_values(system: &dyn System, mut values: Vec<f64>) -> Arc<dyn System> {
    values.resize(system.facts().parameters.len(), f64::NAN);
    Arc::new(Other {
        system: system.shared(),
        values: Some(values),
        laws: Arc::default(),
    })
}

/// A system with other laws, in the order of its own, which stay where there is `None`.
pub(crate) fn with_laws(system: &dyn System, laws: Vec<Option<Box<dyn Law>>>) -> Arc<dyn System> {
    Arc::new(Other {
        system: system.shared(),
        values: None,
        laws: laws.into(),
    })
}

/// All but these values and laws is the system's own.
#[derive(Clone)]
struct Other {
    system: Arc<dyn System>,
    values: Option<Vec<f64>>,
    laws: Arc<[Option<Box<dyn Law>>]>,
}

impl fmt::Debug for Other {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Other")
            .field("system", &self.system)
            .field("values", &self.values)
            .finish_non_exhaustive()
    }
}

impl System for Other {
    fn facts(&self) -> &SystemFacts {
        self.system.facts()
    }

    fn values(&self, values: &mut [f64]) {
        match &self.values {
            Some(own) => values.copy_from_slice(own),
            None => self.system.values(values),
        }
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
        match self.laws.get(index) {
            Some(Some(law)) => law.as_ref(),
            _ => self.system.law(index),
        }
    }

    fn shared(&self) -> Arc<dyn System> {
        Arc::new(self.clone())
    }
}
