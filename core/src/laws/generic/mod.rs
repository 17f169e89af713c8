//! The same laws, interpreted: the oracle of the generated code, and what it is benchmarked against.
//!
//! A law is a list of nodes in which every operand comes before its use, and, for each piece, the nodes that are its
//! force and its derivatives. The data come from the same front end as the generated code, so the two cannot drift.

mod consistent;
mod law;
pub(crate) mod narrow;
mod program;
pub(crate) mod scales;
#[cfg(test)]
mod tests;
#[cfg(feature = "text")]
mod text;

use std::sync::Arc;

use crate::law::Law;
use crate::system::{System, SystemFacts, Variable};

#[doc(hidden)]
pub use consistent::DataError;
#[doc(hidden)]
pub use hertzian_contract::data::{LawData, LevelData, Node, PieceData};
#[doc(hidden)]
pub use law::InterpretedLaw;
#[cfg(feature = "text")]
pub use text::{Declaration, DeclarationError, Fault, law_from_text};

/// A system whose laws are interpreted; everything else is the system's own, and so is a law that has no
/// [data](Law::data), or data that do not describe it.
///
/// It computes what the system computes, from the same declaration, without the generated kernels.
#[derive(Debug, Clone)]
pub struct Interpreted {
    system: Arc<dyn System>,
    /// In the order of the system's; `None` where it has no data.
    laws: Vec<Option<InterpretedLaw>>,
}

impl Interpreted {
    /// The same system at the values that its parameters have now, its laws interpreted.
    pub fn of(system: &dyn System) -> Self {
        let laws = (0..system.facts().laws)
            .map(|index| InterpretedLaw::of(system.law(index)))
            .collect();
        Self {
            system: system.shared(),
            laws,
        }
    }
}

// All but the laws is the system's own; another wrapper, which changes its values, says so in the same words.
impl System for Interpreted {
    fn facts(&self) -> &SystemFacts {
        self.system.facts()
    }

    fn values(&self, values: &mut [f64]) {
        self.system.values(values);
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
        match &self.laws[index] {
            Some(law) => law,
            None => self.system.law(index),
        }
    }

    fn shared(&self) -> Arc<dyn System> {
        Arc::new(self.clone())
    }
}
