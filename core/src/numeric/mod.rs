//! What is computed without knowing a model: dense equations, powers, series, small eigenvalues.

pub(crate) mod decimal;
pub(crate) mod exponential;
pub mod fourier;
pub(crate) mod golden;
pub(crate) mod linear;
pub mod power;
pub(crate) mod roots;
pub(crate) mod spectrum;
pub(crate) mod triangular;
