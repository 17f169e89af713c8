//! What sweeps and basins are asked alike: of which system, how exactly its motions are followed, and how far.

use std::sync::Arc;

use crate::cancel::Cancel;
use crate::error::Error;
use crate::system::System;
use crate::time::{self, Flow};

/// A system, and the options of its motions.
#[derive(Clone)]
pub(super) struct Request {
    pub(super) system: Arc<dyn System>,
    /// The excitation frequency, if it was given.
    pub(super) omega: Option<f64>,
    /// A state with an entry beyond this has escaped.
    pub(super) escape: f64,
    /// Of the flow, where it is not in closed form.
    pub(super) tolerance: f64,
    pub(super) cancel: Cancel,
}

/// Everything that a result depends on.
impl std::fmt::Debug for Request {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Request")
            .field("system", &self.system.facts().name)
            .field("omega", &self.omega)
            .field("escape", &self.escape)
            .field("tolerance", &self.tolerance)
            .finish_non_exhaustive()
    }
}

impl Request {
    pub(super) fn of(system: &dyn System) -> Self {
        Self {
            system: system.shared(),
            omega: None,
            escape: 1e6,
            tolerance: 1e-10,
            cancel: Cancel::new(),
        }
    }

    /// The flow at these values of the parameters.
    ///
    /// # Errors
    /// If one of them, the frequency or the tolerance cannot be used.
    pub(super) fn flow(&self, parameters: &[f64], omega: f64) -> Result<Box<dyn Flow>, Error> {
        let mut flow = time::at(&self.system, parameters, omega, self.tolerance)?;
        flow.until(&self.cancel);
        Ok(flow)
    }
}
