//! Fourier series of periodic quantities: their layout, their samples and the places where they cross a level.

pub mod crossings;
pub(crate) mod gauss;
pub(crate) mod grading;
pub(crate) mod kernels;
pub(crate) mod phases;
pub mod sampled;
pub mod series;
