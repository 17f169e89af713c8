//! Vibration of oscillators with piecewise power-law forces: contacts that open, springs of any exponent, play, stops.
//!
//! [`oscillator!`] turns an equation of motion into a type with public parameters and into specialised code for its forces
//! and their derivatives. [`FrequencyResponse`] follows its periodic orbits as the excitation frequency or a parameter
//! varies, and returns a [`Branch`]: orbits, their [`Stability`], folds, and what it cost.
//!
//! ```
//! use hertzian::FrequencyResponse;
//!
//! hertzian::oscillator! {
//!     Duffing(x) {
//!         /// damping ratio
//!         param zeta in 0.0..;
//!         /// excitation amplitude
//!         param drive;
//!         ddot(x) + 2*zeta*dot(x) + x + x^3 = drive*cos(omega*t);
//!     }
//! }
//!
//! let model = Duffing { zeta: 0.05, drive: 0.2 };
//! let branch = FrequencyResponse::of(&model).from(0.5).to(2.0).harmonics(7).samples(64).run()?;
//! assert_eq!(branch.folds().count(), 2);
//! # Ok::<(), hertzian::Error>(())
//! ```
//!
//! Time has the unit that the equation has it in; frequencies are angles per time. Orbits are Fourier series, laid out as
//! [`fourier::series`] says. Nothing panics on the values of parameters or options: what is wrong comes back as an
//! [`Error`] before any work, and a branch that ends early comes back with what was computed and with the reason.
//!
//! [`Shooting`] finds the same orbits in the time domain, without any truncation, and refines what the balance has found.
//!
//! The modules [`system`] and [`law`](mod@law) are the contract between generated code and the runtime; a system written by hand
//! against them is as good as a declared one. [`generic`] interprets the same declarations.
#![deny(missing_docs)]
#![warn(missing_debug_implementations)]

// Generated code names this crate `::hertzian`; inside the crate itself that name must exist too.
extern crate self as hertzian;

mod aft;
#[cfg(test)]
mod allocations;
pub mod backbone;
mod balance;
pub mod bifurcation;
mod block;
pub mod branch;
#[cfg(test)]
mod by_hand;
#[cfg(feature = "plot")]
pub mod chart;
mod continuation;
#[doc(hidden)]
pub mod emitted;
pub mod error;
pub mod export;
pub mod flow;
mod follower;
pub mod fourier;
pub mod generic;
#[cfg(doctest)]
mod guide;
mod harmonics;
mod jacobian;
pub mod law;
mod layout;
mod linear;
mod newton;
pub mod observe;
#[cfg(feature = "plot")]
mod picture;
pub mod power;
#[cfg(test)]
mod random;
mod reader;
mod response;
mod run;
pub mod stability;
#[doc(hidden)]
pub mod stages;
mod start;
mod statistics;
pub mod structure;
mod subharmonics;
mod symmetry;
pub mod system;
mod truncation;
mod validate;

pub use aft::Aft;
pub use bifurcation::Bifurcations;
pub use branch::{Branch, Event, EventKind, Orbit, Point, Turn};
pub use continuation::follow::Stop;
pub use error::Error;
pub use flow::shooting::{Cycle, CycleBranch, CycleEvent, End, Shooting, Side};
pub use hertzian_macros::{law, oscillator};
pub use nalgebra::Complex;
pub use response::FrequencyResponse;
pub use stability::{Method, Stability, Verdict};
pub use statistics::Statistics;
pub use system::System;

// The twenty lines of the README are run as a test.
#[cfg(all(doctest, feature = "plot"))]
#[doc = include_str!("../../README.md")]
struct Readme;
