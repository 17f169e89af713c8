//! Vibration of oscillators with piecewise power-law forces.
#![deny(missing_docs)]

// Generated code names this crate `::hertzian`; inside the crate itself that name must exist too.
extern crate self as hertzian;

#[cfg(feature = "plot")]
pub mod chart;
#[doc(hidden)]
pub mod emitted;
pub mod generic;
pub mod law;
pub mod system;

pub use hertzian_macros::oscillator;
