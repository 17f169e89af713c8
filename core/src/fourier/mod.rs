//! Fourier series of periodic quantities: their layout, their samples and the places where they cross a level.

pub mod crossings;
pub mod sampled;
pub mod series;
