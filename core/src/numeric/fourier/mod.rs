//! Fourier series of periodic quantities.

pub(crate) mod crossings;
pub(crate) mod gauss;
pub(crate) mod grading;
pub(crate) mod kernels;
pub(crate) mod phases;
pub(crate) mod sampled;
pub mod series;
pub(crate) mod taylor;
