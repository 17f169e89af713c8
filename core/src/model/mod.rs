//! A system at values of its parameters: where its coefficients stand, what is checked, structures given as matrices.

pub(crate) mod conservative;
pub(crate) mod error;
pub(crate) mod layout;
pub mod remarks;
pub(crate) mod request;
pub(crate) mod rigid;
pub mod structure;
pub(crate) mod validate;
pub(crate) mod valued;

use crate::system::System;

/// The values that the parameters of a system have now.
pub(crate) fn values(system: &dyn System) -> Vec<f64> {
    let mut values = vec![0.0; system.facts().parameters.len()];
    system.values(&mut values);
    values
}
