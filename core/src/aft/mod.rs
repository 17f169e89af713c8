//! From the gap of a contact to the Fourier series of its force: the alternating frequency/time step.
//!
//! The balance knows only this: a law, a gap as a series, and the series of force and derivatives that come back.

pub(crate) mod sampled;

use crate::law::Law;

/// The gap of one contact, and how the answer shall change with the continuation parameter.
#[derive(Clone, Copy)]
pub(crate) struct ContactInput<'a> {
    pub(crate) law: &'a dyn Law,
    pub(crate) arguments: &'a [f64],
    /// Series of the gap.
    pub(crate) gap: &'a [f64],
    /// Series of its rate, a time derivative.
    pub(crate) rate: &'a [f64],
}

/// Derivatives of gap, rate and arguments with respect to the continuation parameter, the unknowns held fast.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Change<'a> {
    pub(crate) gap: &'a [f64],
    pub(crate) rate: &'a [f64],
    pub(crate) arguments: &'a [f64],
}

/// Series of the derivatives of the force of one contact; each has as many harmonics as it has room for.
#[derive(Debug)]
#[allow(
    clippy::struct_field_names,
    reason = "each is the derivative by something"
)]
pub(crate) struct ContactDerivatives<'a> {
    pub(crate) by_gap: &'a mut [f64],
    pub(crate) by_rate: &'a mut [f64],
    /// With respect to the continuation parameter, where there is a [`Change`].
    pub(crate) by_parameter: &'a mut [f64],
}
