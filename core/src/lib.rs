//! Vibration of oscillators with piecewise power-law forces.
#![deny(missing_docs)]

// Generated code names this crate `::hertzian`; inside the crate itself that name must exist too.
extern crate self as hertzian;

mod aft;
#[cfg(test)]
mod allocations;
mod balance;
pub mod branch;
#[cfg(test)]
mod by_hand;
#[cfg(feature = "plot")]
pub mod chart;
mod continuation;
#[doc(hidden)]
pub mod emitted;
mod error;
pub mod fourier;
pub mod generic;
pub mod law;
mod layout;
mod linear;
mod newton;
pub mod observe;
#[cfg(feature = "plot")]
mod picture;
mod response;
pub mod stability;
mod start;
mod statistics;
pub mod system;
mod truncation;
mod validate;

pub use branch::{Branch, Event, EventKind, Orbit, Point};
pub use continuation::follow::Stop;
pub use error::Error;
pub use hertzian_macros::oscillator;
pub use linear::Singular;
pub use nalgebra::Complex;
pub use newton::NewtonError;
pub use response::FrequencyResponse;
pub use stability::{Stability, Verdict};
pub use statistics::Statistics;
pub use system::System;

// The twenty lines of the README are run as a test.
#[cfg(all(doctest, feature = "plot"))]
#[doc = include_str!("../../README.md")]
struct Readme;
