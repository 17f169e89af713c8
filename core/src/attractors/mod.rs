//! What motions settle to: sweeps, Lyapunov exponents, basins of attraction.

pub mod basin;
mod failure;
pub mod log;
pub mod lyapunov;
pub mod sweep;
