//! What motions settle to: sweeps, Lyapunov exponents, basins of attraction.

pub mod basin;
pub(crate) mod log;
pub mod lyapunov;
mod request;
pub mod sweep;
